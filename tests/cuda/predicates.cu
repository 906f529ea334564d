// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <string>

#include "cuda/decisions.hpp"
#include "support/catch.hpp"
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

template <class T, class Pairs>
void check_families() {
    const auto n = static_cast<std::size_t>(test::sample_count());
    const int first = test::first_family();
    REQUIRE(first >= 0);
    REQUIRE(first < Pairs::families);
    for (int f = first; f < Pairs::families; ++f) {
        const std::size_t hits = test::check_decisions<T>(Pairs{static_cast<decltype(Pairs::family)>(f)}, n).hits;
        CHECK(test::is_share_above(0.05, hits, n));
        CHECK(test::is_share_above(0.05, n - hits, n));
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

TEST_CASE("arithmetic: the self-test passes on the device") {
    const abut::cuda on;
    execution::buffer_of<abut::cuda, std::uint32_t> failed(on, 1);
    for_each_index(on, 1, self_test_on_device{failed.data()});
    std::uint32_t value = 1;
    failed.read(&value);
    CHECK(value == 0);
}
