// SPDX-License-Identifier: MIT
#pragma once

// |x| without a branch, on hosts, on devices and in constant expressions. `x < 0 ? -x : x` will not do: it keeps the sign of
// -0.0, so compilers may not make it a mask, and g++ jumps.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::detail {

ABUT_HD constexpr float absolute(float x) { return __builtin_fabsf(x); }
ABUT_HD constexpr double absolute(double x) { return __builtin_fabs(x); }

template <scalar F>
ABUT_HD constexpr vec3<F> absolute(const vec3<F>& v) {
    return {absolute(v.x), absolute(v.y), absolute(v.z)};
}

/// The sum of the coordinates' magnitudes: not less than any of them, nor than the length. NaN and infinity pass through,
/// which a maximum of comparisons does not promise.
template <scalar F>
ABUT_HD constexpr F magnitudes(const vec3<F>& v) {
    return absolute(v.x) + absolute(v.y) + absolute(v.z);
}

}  // namespace abut::detail
