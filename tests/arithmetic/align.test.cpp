// SPDX-License-Identifier: MIT
#include <abut/arithmetic/align.hpp>

#include <cmath>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;

template <scalar T>
bool is_taken_apart(T x) {
    const binary_parts p = take_apart(x);
    if (x == 0) return p.mantissa == 0 && p.exponent == 0;
    const std::int64_t m = p.mantissa < 0 ? -p.mantissa : p.mantissa;
    return p.mantissa % 2 != 0 && m < (std::int64_t{1} << p.bits) &&
           std::ldexp(static_cast<double>(p.mantissa), p.exponent) == static_cast<double>(x);
}

}  // namespace

TEMPLATE_TEST_CASE("take_apart: odd mantissa times a power of two, for every finite number", "", float, double) {
    using namespace test::construction;
    test::draws d(test::sample_seed, 1, sizeof(TestType));
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) wrong += !is_taken_apart(any_finite<TestType>(d));
    CHECK(wrong == 0);
    const TestType tiny = least_denormal<TestType>, huge = largest_number<TestType>;
    for (const TestType x : {TestType(0), -TestType(0), TestType(1), TestType(-3), tiny, -5 * tiny, huge, -huge}) {
        CHECK(is_taken_apart(x));
    }
}

TEST_CASE("aligned: the width is that of the span, whatever the unit") {
    const auto width = [](auto... x) { return aligned<sizeof...(x)>({x...}).width(); };
    CHECK(width(1.0, 2.0, 256.0) <= 53 + 8);
    CHECK(width(1.0f, 3.0f) <= 25);
    CHECK(width(0.1f, 0.2f, 25.6f) <= 60);
    CHECK(width(0x1p-1074, 0x1p1023) == 2098);
    CHECK(width(0x1p-149f, 0x1p127f) == 277);
    CHECK(width(0.0, -0.0) < 0);
}
