// SPDX-License-Identifier: MIT
#pragma once

// Refuses the compiler settings under which floating-point arithmetic is not IEEE 754's. Included by every header that
// promises an exact answer. Contraction (-march=native, -ffp-contract=fast, nvcc's --fmad=true) is legal: the code holds
// under it. What no macro shows (flush-to-zero, rounding modes) is for arithmetic/self_test.hpp.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ == 1) || defined(_M_FP_FAST)
#error "abut: exact decisions need IEEE arithmetic: compile without -ffast-math, -Ofast, -ffinite-math-only and the like"
#endif
// 2 and -1: intermediate results may have more digits than their type, as under -mfpmath=387.
#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ == 2 || __FLT_EVAL_METHOD__ < 0)
#error "abut: results need the precision of their types: compile without -mfpmath=387 and -mfpmath=both"
#endif
