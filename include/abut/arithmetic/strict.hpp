// SPDX-License-Identifier: MIT
#pragma once

// Refuses the compiler settings under which floating-point arithmetic is not IEEE 754's. Included by every header that
// promises an exact answer. Contraction (-march=native, -ffp-contract=fast, nvcc's --fmad=true) is legal: the code holds
// under it. What no macro shows (flush-to-zero, rounding modes) is for arithmetic/self_test.hpp.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ == 1) || defined(_M_FP_FAST)
#error "abut: exact decisions need IEEE arithmetic: compile without -ffast-math, -Ofast, -ffinite-math-only and the like"
#endif
