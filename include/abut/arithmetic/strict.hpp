// SPDX-License-Identifier: MIT
#pragma once

// Refuses the compiler settings under which floating-point arithmetic is not IEEE 754's. Included by every header that
// promises an exact answer. Contraction (-march=native, -ffp-contract=fast, nvcc's --fmad=true) is legal: the code holds
// under it. What no macro shows (flush-to-zero, rounding modes) is for arithmetic/self_test.hpp.

#include <abut/config.hpp>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ == 1) || defined(_M_FP_FAST)
#error "abut: exact decisions need IEEE arithmetic: compile without -ffast-math, -Ofast, -ffinite-math-only and the like"
#endif
// 2 and -1: intermediate results may have more digits than their type, as under -mfpmath=387.
#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ == 2 || __FLT_EVAL_METHOD__ < 0)
#error "abut: results need the precision of their types: compile without -mfpmath=387 and -mfpmath=both"
#endif
// clang defines no macro for parts of -ffast-math. But in a function that may look at the floating-point environment it
// takes none of -fassociative-math, -freciprocal-math, -fno-signed-zeros, -fapprox-func, or the pragmas of the same effect:
// "illegal when precise is disabled", and it prints the line. The function is never called.
#if defined(__clang__) && !ABUT_DEVICE_CODE
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wignored-pragmas"  // on processors where it has no such functions, and refuses nothing
namespace abut::detail {
inline void unsafe_math_is_refused() {
#pragma STDC FENV_ACCESS ON  // abut: exact decisions need IEEE arithmetic: without -funsafe-math-optimizations and its parts
}
}  // namespace abut::detail
#pragma clang diagnostic pop
#endif
