// SPDX-License-Identifier: MIT
#pragma once

// Does a segment touch a triangle? Both are closed; a segment is a triangle with two equal corners. The stages are those of
// triangle_triangle.hpp.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/predicate/triangle_triangle.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr triangle<T> as_triangle(const segment<T>& s) {
    return {s.a, s.b, s.b};
}

}  // namespace detail

/// One stage of the decision, as for two triangles.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const segment<T>& s, const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide<exact>(detail::as_triangle(s), t);
    } else {
        return detail::decide_in_general_position<std::same_as<A, filtered>>(s, t);
    }
}

/// What the first stage left, as for two triangles.
///@{
template <arithmetic A, scalar T>
    requires std::same_as<A, fast>
ABUT_HD constexpr verdict decide_late(const segment<T>& s, const triangle<T>& t) {
    return decide_late<fast>(detail::as_triangle(s), t);
}

template <arithmetic A, scalar T>
    requires std::same_as<A, filtered>
ABUT_NOINLINE ABUT_HD constexpr verdict decide_late(const segment<T>& s, const triangle<T>& t) {
    const verdict v = detail::decide_ties(detail::as_triangle(s), t);
    if constexpr (std::same_as<T, float>) {
        if (v == verdict::unknown) return detail::decide_widened(s, t, detail::in_a_row(s.a, s.b, t.a, t.b, t.c));
    }
    return v;
}
///@}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool resolve(const segment<T>& s, const triangle<T>& t) {
    return resolve(detail::as_triangle(s), t);
}

}  // namespace abut
