// SPDX-License-Identifier: MIT
#include <abut/arithmetic/self_test.hpp>

#include <cfenv>

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
    CHECK(r.passed());
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
