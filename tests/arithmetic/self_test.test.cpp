// SPDX-License-Identifier: MIT
#include <abut/arithmetic/self_test.hpp>

#include <cfenv>
#include <cmath>

#include "support/catch.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

TEST_CASE("self test: passes on an ordinary thread") {
    const abut::arithmetic_report r = abut::self_test();
    CHECK(r.gradual_underflow);
    CHECK(r.denormal_inputs);
    CHECK(r.round_to_nearest);
    CHECK(r.error_free);
    CHECK(r.infinities_and_nan);
    CHECK(r.passed());
}

/// A product whose fma rounds a b to 64 digits first, as the one of mingw-w64 does.
struct rounds_twice {
    abut::error_free<double> operator()(double a, double b) const {
        const double p = a * b;
        int exponent = 0;
        std::frexp(p, &exponent);
        const double error = std::ldexp(std::fma(a, b, -p), 64 - exponent);  // in units of the last of 64 digits
        return {p, std::ldexp(std::nearbyint(error), exponent - 64)};
    }
};

TEST_CASE("self test: sees a product whose error is rounded twice") {
    CHECK(abut::detail::products_are_right<float>(abut::detail::two_prod_of{}));
    CHECK(abut::detail::products_are_right<double>(abut::detail::two_prod_of{}));
    CHECK_FALSE(abut::detail::products_are_right<double>(rounds_twice{}));
}

TEST_CASE("self test: sees another rounding mode") {
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        std::fesetround(mode);
        const abut::arithmetic_report r = abut::self_test();
        std::fesetround(FE_TONEAREST);
        CHECK_FALSE(r.round_to_nearest);
        CHECK_FALSE(r.passed());
    }
}

#if defined(__SSE2__)
TEST_CASE("self test: sees flush-to-zero and denormals-are-zero") {
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8000);
    const abut::arithmetic_report flushed = abut::self_test();
    _mm_setcsr(before | 0x0040);
    const abut::arithmetic_report zeroed = abut::self_test();
    _mm_setcsr(before);
    CHECK_FALSE(flushed.gradual_underflow);
    CHECK_FALSE(zeroed.denormal_inputs);
}
#endif
