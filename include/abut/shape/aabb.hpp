// SPDX-License-Identifier: MIT
#pragma once

// Boxes along the axes: solids, and what is around shapes. No box is ever too small: where arithmetic rounds, it rounds
// outward, to infinity where no number is large enough.
//
// Denormals. A thread may read denormal numbers as zero. Let z(x) be what it reads: 0 where |x| is below the smallest normal
// number m, and else x. z is monotone: from x <= y follows z(x) <= z(y). So comparing a shape's lower end with another's
// upper end keeps all that it kept before, and more. Nor does it matter that minima and maxima of denormal numbers are any
// of them, or 0: their z is right, and comparisons see no more. What is computed with such an end is off by less than m.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/form.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// A solid box with faces along the axes, lower <= upper in each coordinate.
template <scalar T>
struct aabb {
    vec3<T> lower;  ///< the corner with the least coordinates
    vec3<T> upper;  ///< the corner with the greatest
};

/// The box that every box contains: merging it in changes nothing, and nothing overlaps it.
template <scalar T>
ABUT_HD constexpr aabb<T> empty_box() {
    constexpr T far = infinity<T>;
    return {{far, far, far}, {-far, -far, -far}};
}

/// The smallest box around both. Exact. A coordinate of b that is NaN is passed over, as that of a box around infinite
/// boxes' middles may be (index/top_down.hpp).
template <scalar T>
ABUT_HD constexpr aabb<T> merge(const aabb<T>& a, const aabb<T>& b) {
    return {detail::least(b.lower, a.lower), detail::greatest(b.upper, a.upper)};
}

/// Whether the closed boxes share a point. Exact. One branch and not six, since none of the six could be predicted.
template <scalar T>
ABUT_HD constexpr bool overlaps(const aabb<T>& a, const aabb<T>& b) {
    const auto at_most = [](T x, T y) { return static_cast<unsigned>(x <= y); };
    return (at_most(a.lower.x, b.upper.x) & at_most(b.lower.x, a.upper.x) & at_most(a.lower.y, b.upper.y) &
            at_most(b.lower.y, a.upper.y) & at_most(a.lower.z, b.upper.z) & at_most(b.lower.z, a.upper.z)) != 0;
}

/// Whether `inner` lies in `outer`. Exact.
template <scalar T>
ABUT_HD constexpr bool contains(const aabb<T>& outer, const aabb<T>& inner) {
    return outer.lower.x <= inner.lower.x && inner.upper.x <= outer.upper.x && outer.lower.y <= inner.lower.y &&
           inner.upper.y <= outer.upper.y && outer.lower.z <= inner.lower.z && inner.upper.z <= outer.upper.z;
}

/// A point and a box are as large as their boxes. Exact.
///@{
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const vec3<T>& p) {
    return {p, p};
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const aabb<T>& box) {
    return box;
}
///@}

/// That a number is not finite, or a box inside out.
template <scalar T>
ABUT_HD constexpr shape_flaw flaw_of(const aabb<T>& box) {
    if (const shape_flaw flaw = detail::flaw_of_points(box.lower, box.upper)) return flaw;
    if (!(box.lower.x <= box.upper.x)) return {"lower x is above upper x", static_cast<double>(box.lower.x)};
    if (!(box.lower.y <= box.upper.y)) return {"lower y is above upper y", static_cast<double>(box.lower.y)};
    if (!(box.lower.z <= box.upper.z)) return {"lower z is above upper z", static_cast<double>(box.lower.z)};
    return {};
}

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<aabb<T>>{"box", "abut::boxes", 6};

/// It is its own core, which is no hull of few corners.
template <scalar T>
ABUT_HD constexpr aabb<T> core_of(const aabb<T>& box) {
    return box;
}

/// A box, exactly.
template <scalar T>
struct box_reach {
    aabb<T> query;
    box_reach() = default;
    ABUT_HD explicit box_reach(const aabb<T>& box) : query(box) {}
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return query; }
    ABUT_HD bool operator()(const aabb<T>& box) const { return overlaps(query, box); }
};

}  // namespace detail

///@}

}  // namespace abut
