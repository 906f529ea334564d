// SPDX-License-Identifier: MIT
#pragma once

// Axis-aligned boxes around shapes. No box is ever too small: where arithmetic rounds, it rounds outward, to infinity where
// no number is large enough.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <class T>
ABUT_HD constexpr T lesser(T a, T b) {
    return b < a ? b : a;
}
template <class T>
ABUT_HD constexpr T greater(T a, T b) {
    return a < b ? b : a;
}
template <class T>
ABUT_HD constexpr vec3<T> lesser(const vec3<T>& a, const vec3<T>& b) {
    return {lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)};
}
template <class T>
ABUT_HD constexpr vec3<T> greater(const vec3<T>& a, const vec3<T>& b) {
    return {greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)};
}

}  // namespace detail

/// The box that every box contains: merging it in changes nothing, and nothing overlaps it.
template <scalar T>
ABUT_HD constexpr aabb<T> empty_box() {
    constexpr T far = infinity<T>;
    return {{far, far, far}, {-far, -far, -far}};
}

/// The smallest box around both. Exact.
template <scalar T>
ABUT_HD constexpr aabb<T> merge(const aabb<T>& a, const aabb<T>& b) {
    return {detail::lesser(a.lower, b.lower), detail::greater(a.upper, b.upper)};
}

/// Whether the closed boxes share a point. Exact. One branch and not six: which of the comparisons fails is anyone's guess.
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
    return {detail::lesser(detail::lesser(t.a, t.b), t.c), detail::greater(detail::greater(t.a, t.b), t.c)};
}

/// A point, a segment and a box are as large as their boxes. Exact.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const vec3<T>& p) {
    return {p, p};
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const segment<T>& s) {
    return {detail::lesser(s.a, s.b), detail::greater(s.a, s.b)};
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const aabb<T>& box) {
    return box;
}

namespace detail {

template <scalar T>
ABUT_HD constexpr aabb<T> grown(const aabb<T>& box, T by) {
    return {{sub_down(box.lower.x, by), sub_down(box.lower.y, by), sub_down(box.lower.z, by)},
            {add_up(box.upper.x, by), add_up(box.upper.y, by), add_up(box.upper.z, by)}};
}

}  // namespace detail

/// The smallest representable box around a sphere or a capsule.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const sphere<T>& s) {
    return detail::grown(bounds(s.center), s.radius);
}
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const capsule<T>& s) {
    return detail::grown(bounds(s.axis), s.radius);
}

/// All of space: few planes have a smaller box.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const plane<T>&) {
    constexpr T far = infinity<T>;
    return {{-far, -far, -far}, {far, far, far}};
}

}  // namespace abut
