// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/extremes.hpp"
#include "support/families.hpp"
#include "support/other_shapes.hpp"
#include "support/samples.hpp"
#include "support/triangle_families.hpp"

using namespace abut;

namespace {

/// The families of a kind of pairs; `make(i)` runs on hosts and devices.
template <class T>
struct sphere_triangle_pairs {
    test::family family;
    static constexpr int families = test::family_count;
    [[nodiscard]] std::string name() const { return test::name_of(family); }
    ABUT_HD test::sphere_triangle_pair<T> make(std::size_t i) const {
        return test::make_pair<T>(test::sample_seed, family, i);
    }
};

template <class T>
struct triangle_pairs {
    test::triangle_family family;
    static constexpr int families = test::triangle_family_count;
    [[nodiscard]] std::string name() const { return test::name_of(family); }
    ABUT_HD test::triangle_pair<T> make(std::size_t i) const {
        return test::make_triangle_pair<T>(test::sample_seed, family, i);
    }
};

/// A box, a plane or a capsule, and a triangle.
template <class T, template <class> class Shape>
struct shape_pairs {
    test::shape_family family;
    static constexpr int families = test::shape_family_count;
    [[nodiscard]] std::string name() const { return "other shape, " + std::to_string(static_cast<int>(family)); }
    ABUT_HD test::shape_triangle_pair<Shape, T> make(std::size_t i) const {
        return test::make_shape_pair<Shape, T>(test::sample_seed, family, i);
    }
};

template <class T, class Kind>
struct extreme_pairs {
    test::extreme_step step;
    [[nodiscard]] std::string name() const { return test::name_of(step.what) + (' ' + std::to_string(step.value)); }
    ABUT_HD auto make(std::size_t i) const { return test::make_extreme_pair<Kind, T>(test::sample_seed, step, i); }
};

/// Every stage's answer for pair first + i of a family, in one byte, and a checksum of the generated input: a device may
/// neither decide nor generate differently from the host, bit for bit.
template <class T, class Pairs>
struct answers {
    Pairs pairs;
    std::size_t first;
    std::uint8_t* decisions;
    std::uint32_t* inputs;

    template <class Pair>
    static ABUT_HD std::uint32_t checksum(const Pair& pair) {
        std::uint32_t words[sizeof(Pair) / 4], sum = 0;
        std::memcpy(words, &pair, sizeof(Pair));
        for (const std::uint32_t word : words) sum = sum * 31 + word;
        return sum;
    }

    ABUT_HD void operator()(std::size_t i) const {
        const auto pair = pairs.make(first + i);
        const auto& [s, t] = pair;
        inputs[i] = checksum(pair);
        // In a kernel of the user's own the answer is whole: all stages, the widest too, run on the device.
        const int filtered_answer = intersects<filtered>(s, t), exact_answer = intersects<exact>(t, s);
        decisions[i] = static_cast<std::uint8_t>(filtered_answer | exact_answer << 1);
    }
};

/// The number of hits.
template <class T, class Pairs>
std::size_t check_family(const Pairs& pairs, std::size_t n) {
    constexpr std::size_t most = 10'000'000;  // at a time
    const abut::cuda on;
    std::size_t other_inputs = 0, other_decisions = 0, hits = 0, split = 0;
    for (std::size_t first = 0; first < n; first += most) {
        const std::size_t count = n - first < most ? n - first : most;
        execution::buffer_of<abut::cuda, std::uint8_t> decisions(on, count);
        execution::buffer_of<abut::cuda, std::uint32_t> inputs(on, count);
        for_each_index(on, count, answers<T, Pairs>{pairs, first, decisions.data(), inputs.data()});
        std::vector<std::uint8_t> device_decisions(count), host_decisions(count);
        std::vector<std::uint32_t> device_inputs(count), host_inputs(count);
        for_each_index(openmp{}, count, answers<T, Pairs>{pairs, first, host_decisions.data(), host_inputs.data()});
        decisions.read(device_decisions.data());
        inputs.read(device_inputs.data());
        for (std::size_t i = 0; i < count; ++i) {
            other_inputs += device_inputs[i] != host_inputs[i];
            other_decisions += device_decisions[i] != host_decisions[i];
            split += device_decisions[i] != 0 && device_decisions[i] != 3;
            hits += device_decisions[i] & 1;
        }
    }
    std::printf(
        "%-18s %-6s n %zu, hits %5.1f %%, inputs that differ %zu, decisions that differ %zu, filtered against exact %zu\n",
        pairs.name().c_str(), sizeof(T) == 4 ? "float" : "double", n,
        100.0 * static_cast<double>(hits) / static_cast<double>(n), other_inputs, other_decisions, split);
    std::fflush(stdout);
    CHECK(other_inputs == 0);
    CHECK(other_decisions == 0);
    CHECK(split == 0);
    return hits;
}

template <class T, class Pairs>
void check_families() {
    const auto n = static_cast<std::size_t>(test::sample_count());
    for (int f = 0; f < Pairs::families; ++f) {
        const std::size_t hits = check_family<T>(Pairs{static_cast<decltype(Pairs::family)>(f)}, n);
        CHECK(hits > n / 1000);
        CHECK(hits < n);
    }
}

/// tests/collide/extremes.test.cpp says that the host is right.
template <class T, class Kind>
void check_extremes() {
    const std::size_t n = static_cast<std::size_t>(test::sample_count()) / 5 + 1;
    for (const test::extreme what : test::extremes) {
        std::size_t hits = 0, total = 0;
        for (const test::extreme_step& step : test::steps_of<T>(what)) {
            hits += check_family<T>(extreme_pairs<T, Kind>{step}, n);
            total += n;
        }
        CHECK(hits > total / 20);
        CHECK(hits < total);
    }
}

struct self_test_on_device {
    std::uint32_t* failed;
    ABUT_HD void operator()(std::size_t) const { *failed = self_test().passed() ? 0 : 1; }
};

}  // namespace

TEMPLATE_TEST_CASE("spheres and triangles: cuda decides every family as the host does", "", float, double) {
    check_families<TestType, sphere_triangle_pairs<TestType>>();
}

TEMPLATE_TEST_CASE("triangles and triangles: cuda decides every family as the host does", "", float, double) {
    check_families<TestType, triangle_pairs<TestType>>();
}

TEMPLATE_TEST_CASE("other shapes and triangles: cuda decides every family as the host does", "", float, double) {
    check_families<TestType, shape_pairs<TestType, aabb>>();
    check_families<TestType, shape_pairs<TestType, plane>>();
    check_families<TestType, shape_pairs<TestType, capsule>>();
}

TEMPLATE_TEST_CASE("pairs at extremes: cuda decides every step as the host does", "", float, double) {
    check_extremes<TestType, test::extreme_triangles>();
    check_extremes<TestType, test::extreme_balls>();
}

TEST_CASE("arithmetic: the self-test passes on the device") {
    const abut::cuda on;
    execution::buffer_of<abut::cuda, std::uint32_t> failed(on, 1);
    for_each_index(on, 1, self_test_on_device{failed.data()});
    std::uint32_t value = 1;
    failed.read(&value);
    CHECK(value == 0);
}
