// SPDX-License-Identifier: MIT
//
// What nvcc 12 would be asked, of this one. (One program: the self-test's 24 kinds take a minute to compile.)
// long to compile
#define ABUT_ALLOW_UNTESTED_NVCC 1
#include <abut/cuda.hpp>

#include "support/catch.hpp"

using namespace abut;

namespace {

/// Says that a pair touches that does not.
struct wrong_table {
    detail::known_pairs<detail::meet_in_kernels, sphere<float>, triangle<float>> of(std::uint64_t touch) const {
        return {"sphere, triangle", touch ^ 1u};
    }
};

}  // namespace

TEST_CASE("device self-test: the first call on a device asks, and this compiler passes") {
    const abut::cuda on;
    const execution::buffer<float, device_space> any_call(on, 10);
    CHECK_NOTHROW(detail::require_right_decisions(on, "test"));
    detail::for_each_known([&](const auto& known) {
        CAPTURE(known.name);
        CHECK(detail::wrong_of(on, known) == 0);
    });
}

TEST_CASE("device self-test: a wrong answer is seen") {
    const abut::cuda on;
    detail::for_each_known([&]<class Question, class S, class U>(const detail::known_pairs<Question, S, U>& known) {
        if constexpr (std::same_as<S, sphere<float>> && std::same_as<U, triangle<float>> &&
                      std::same_as<Question, detail::meet_in_kernels>) {
            CHECK(detail::wrong_of(on, wrong_table{}.of(known.touch)) == 1);
        }
    });
}
