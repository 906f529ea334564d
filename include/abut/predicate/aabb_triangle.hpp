// SPDX-License-Identifier: MIT
#pragma once

// Does a triangle or a segment touch a solid box with faces along the axes? The stages are those of sphere_triangle.hpp.

#include <concepts>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_box.hpp>
#include <abut/predicate/exact_box.hpp>
#include <abut/shape/corners.hpp>

namespace abut {

namespace detail {

/// The lower and the upper corner of a box and the ends of a segment.
template <scalar T>
ABUT_HD constexpr auto values_of(const aabb<T>& box, const segment<T>& t) {
    return in_a_row(box.lower, box.upper, t.a, t.b);
}

/// Triangles and segments of the scalar type T, and what is asked of a box and one.
template <class S, class T>
concept face_or_edge = (corners_of_shape<S> > 1) && std::same_as<scalar_type_of<S>, T>;
template <class S>
using box_meets = std::conditional_t<corners_of_shape<S> == 3, box_meets_triangle, box_meets_segment>;

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle. A box has lower <= upper.
template <arithmetic A, scalar T, detail::face_or_edge<T> S>
ABUT_HD constexpr verdict decide(const aabb<T>& box, const S& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::box_meets<S>>(detail::values_of(box, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_box(box, t);
    } else {
        return to_verdict(detail::approximate_box(box, t));
    }
}

/// The last stage: decides every finite input.
template <scalar T, detail::face_or_edge<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const aabb<T>& box, const S& t) {
    return decide_at_any_span<detail::box_meets<S>>(detail::values_of(box, t).value);
}

}  // namespace abut
