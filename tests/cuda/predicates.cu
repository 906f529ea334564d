// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <cstdio>
#include <cstring>
#include <vector>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/samples.hpp"

using namespace abut;

namespace {

/// Every stage's answer for pair i of a family, in one byte, and a checksum of the generated input: a device may neither
/// decide nor generate differently from the host, bit for bit.
template <class T>
struct answers {
    test::family family;
    std::uint8_t* decisions;
    std::uint32_t* inputs;

    static ABUT_HD std::uint32_t checksum(const T* values, int n) {
        std::uint32_t sum = 0;
        for (int i = 0; i < n; ++i) {
            std::uint32_t words[2] = {0, 0};
            std::memcpy(words, &values[i], sizeof(T));
            sum = (sum * 31 + words[0]) * 31 + words[1];
        }
        return sum;
    }

    ABUT_HD void operator()(std::size_t i) const {
        const auto pair = test::make_pair<T>(test::seed, family, i);
        const T values[] = {pair.s.center.x, pair.s.center.y, pair.s.center.z, pair.s.radius, pair.t.a.x, pair.t.a.y, pair.t.a.z,
                            pair.t.b.x,      pair.t.b.y,      pair.t.b.z,      pair.t.c.x,    pair.t.c.y, pair.t.c.z};
        inputs[i] = checksum(values, 13);
        // In a kernel of the user's own the answer is whole: all stages, the widest too, run on the device.
        const int filtered_answer = intersects<filtered>(pair.s, pair.t), exact_answer = intersects<exact>(pair.t, pair.s);
        decisions[i] = static_cast<std::uint8_t>(filtered_answer | exact_answer << 1);
    }
};

template <class T>
void check_family(test::family f, std::size_t n) {
    const abut::cuda on;
    execution::buffer_of<abut::cuda, std::uint8_t> decisions(on, n);
    execution::buffer_of<abut::cuda, std::uint32_t> inputs(on, n);
    for_each_index(on, n, answers<T>{f, decisions.data(), inputs.data()});
    std::vector<std::uint8_t> device_decisions(n), host_decisions(n);
    std::vector<std::uint32_t> device_inputs(n), host_inputs(n);
    decisions.read(device_decisions.data());
    inputs.read(device_inputs.data());
    for_each_index(openmp{}, n, answers<T>{f, host_decisions.data(), host_inputs.data()});
    std::size_t other_inputs = 0, other_decisions = 0, hits = 0, split = 0;
    for (std::size_t i = 0; i < n; ++i) {
        other_inputs += device_inputs[i] != host_inputs[i];
        other_decisions += device_decisions[i] != host_decisions[i];
        split += device_decisions[i] != 0 && device_decisions[i] != 3;
        hits += device_decisions[i] & 1;
    }
    std::printf("%-16s %-6s n %zu, hits %5.1f %%, inputs that differ %zu, decisions that differ %zu, filtered against exact %zu\n",
                test::name_of(f), sizeof(T) == 4 ? "float" : "double", n,
                100.0 * static_cast<double>(hits) / static_cast<double>(n), other_inputs, other_decisions, split);
    CHECK(other_inputs == 0);
    CHECK(other_decisions == 0);
    CHECK(split == 0);
    CHECK(hits > n / 1000);
    CHECK(hits < n);
}

struct self_test_on_device {
    std::uint32_t* failed;
    ABUT_HD void operator()(std::size_t) const { *failed = self_test().passed() ? 0 : 1; }
};

}  // namespace

TEMPLATE_TEST_CASE("predicates: cuda decides every family as the host does", "", float, double) {
    for (int f = 0; f < test::family_count; ++f) check_family<TestType>(static_cast<test::family>(f), test::sample_count());
}

TEST_CASE("arithmetic: the self-test passes on the device") {
    const abut::cuda on;
    execution::buffer_of<abut::cuda, std::uint32_t> failed(on, 1);
    for_each_index(on, 1, self_test_on_device{failed.data()});
    std::uint32_t value = 1;
    failed.read(&value);
    CHECK(value == 0);
}
