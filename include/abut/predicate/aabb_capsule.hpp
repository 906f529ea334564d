// SPDX-License-Identifier: MIT
#pragma once

// Does a solid capsule touch a solid box with faces along the axes, that is: is its axis within the radius of the box? The
// stages are those of `within`, with distance 0.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/box_within.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// One stage of the decision, as for a sphere and a triangle. A box has lower <= upper, and a capsule has radius >= 0.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const aabb<T>& box, const capsule<T>& s) {
    return detail::decide_within<A>(box, s, 0);
}

/// What the first stage left.
template <arithmetic A, scalar T>
    requires(!std::same_as<A, exact>)
ABUT_HD constexpr verdict decide_late(const aabb<T>& box, const capsule<T>& s) {
    return detail::decide_within_late<A>(box, s, 0);
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool resolve(const aabb<T>& box, const capsule<T>& s) {
    return detail::resolve_within(box, s, 0);
}

}  // namespace abut
