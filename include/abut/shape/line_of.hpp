// SPDX-License-Identifier: MIT
#pragma once

// A ray and a segment as one: what asks when a line meets a shape takes either.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A ray or a segment as origin + t (end - start).
template <scalar T>
struct line_of {
    vec3<T> origin, end, start;
    double last;  ///< time

    ABUT_HD constexpr line_of(const ray<T>& r)
        : origin(r.origin), end(r.direction), start{0, 0, 0}, last(infinity<double>) {}
    ABUT_HD constexpr line_of(const segment<T>& s) : origin(s.a), end(s.b), start(s.a), last(1) {}

    /// A ray's own, to the bit: where a processor takes denormal numbers for 0, a difference from 0 would be 0. That of a
    /// segment may be off by twice the least normal number, and so may its points; what is culled by it allows for that.
    [[nodiscard]] ABUT_HD constexpr vec3<T> direction() const { return has_end() ? end - start : end; }
    [[nodiscard]] ABUT_HD constexpr bool has_end() const { return last == 1; }
};

}  // namespace abut::detail
