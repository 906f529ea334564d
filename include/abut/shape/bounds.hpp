// SPDX-License-Identifier: MIT
#pragma once

// Axis-aligned boxes around shapes. No box is ever too small: where arithmetic rounds, it rounds outward, to infinity where
// no number is large enough.
//
// Denormals. A thread may read denormal numbers as zero. Let z(x) be what it reads: 0 where |x| is below the smallest normal
// number m, and else x. z is monotone: from x <= y follows z(x) <= z(y). So comparing a shape's lower end with another's
// upper end keeps all that it kept before, and more. Nor does it matter that minima and maxima of denormal numbers are any
// of them, or 0: their z is right, and comparisons see no more. What is computed with such an end is off by less than m.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// @addtogroup shapes
///@{

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

/// The smallest box around a triangle. Exact.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const triangle<T>& t) {
    return {detail::least(detail::least(t.a, t.b), t.c), detail::greatest(detail::greatest(t.a, t.b), t.c)};
}

/// A point, a segment and a box are as large as their boxes. Exact.
///@{
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const vec3<T>& p) {
    return {p, p};
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const segment<T>& s) {
    return {detail::least(s.a, s.b), detail::greatest(s.a, s.b)};
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const aabb<T>& box) {
    return box;
}
///@}

/// The smallest representable box around a sphere.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const sphere<T>& s) {
    const vec3<T>& c = s.center;
    const T r = s.radius;
    return {{add_down(c.x, -r), add_down(c.y, -r), add_down(c.z, -r)}, {add_up(c.x, r), add_up(c.y, r), add_up(c.z, r)}};
}
/// And around a capsule: around its two ends, and not around the box of its axis, since a minimum of denormal numbers is any
/// of them where they are read as zero.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const capsule<T>& s) {
    return merge(bounds(sphere<T>{s.axis.a, s.radius}), bounds(sphere<T>{s.axis.b, s.radius}));
}
/// Around the capsule that a cylinder is a part of: so the box holds also what `place` makes of the cylinder, whose axis may
/// turn where its ends are rounded. Much too large for a flat disc alone.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const cylinder<T>& s) {
    return bounds(capsule<T>{s.axis, s.radius});
}
/// Around the apex and a ball, which the base is a part of, for the same reason.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const cone<T>& s) {
    return merge(bounds(s.apex), bounds(sphere<T>{s.base_center, s.radius}));
}

/// All of space: few planes have a smaller box.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const plane<T>&) {
    constexpr T far = infinity<T>;
    return {{-far, -far, -far}, {far, far, far}};
}

/// From the origin to infinity along each axis on which the ray moves, which it is told by the direction's bits.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const ray<T>& r) {
    constexpr T far = infinity<T>;
    const auto lower = [](T from, T along) { return !detail::is_zero(along) && detail::has_sign(along) ? -far : from; };
    const auto upper = [](T from, T along) { return !detail::is_zero(along) && !detail::has_sign(along) ? far : from; };
    const vec3<T>&o = r.origin, &d = r.direction;
    return {{lower(o.x, d.x), lower(o.y, d.y), lower(o.z, d.z)}, {upper(o.x, d.x), upper(o.y, d.y), upper(o.z, d.z)}};
}

///@}

}  // namespace abut
