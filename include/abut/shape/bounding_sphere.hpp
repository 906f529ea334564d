// SPDX-License-Identifier: MIT
#pragma once

// Balls as bounding volumes. All is computed in double and rounded outward; a ball that no number is large enough for has
// an infinite radius.
//
// Overlap. For points p and q of the balls with p = R q + t + error (relative_pose.hpp), the way D = R c_b + t - c_a
// between the centres is no longer than r_a + |error| + |R| r_b, and |R| is below 1 + 1.5 dev(R), since R^T R - 1 stretches
// by no more than 3 dev(R). Rounding D takes e_d (8.8 |c_b| + 5.1 (|t| + |c_a|)), with e_d of double.

#include <cstddef>
#include <type_traits>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut {

/// @addtogroup volumes
///@{

namespace detail {

/// Not less than the distance between two points, in T.
template <scalar T>
ABUT_HD constexpr T distance_above(const vec3<T>& a, const vec3<T>& b) {
    return rounded_up<T>(length_above(widened(b) - widened(a)));
}

/// A centre in the box, in registers: what is measured from it has to be measured from the number that is stored.
template <scalar T>
ABUT_HD constexpr vec3<T> center_in(const aabb<T>& box, const vec3<T>& p) {
    const vec3<T> c = least(greatest(p, box.lower), box.upper);
    return {rounded(c.x), rounded(c.y), rounded(c.z)};
}

/// Whether |way| <= reach is possible, by squares in units of the reach, which neither overflow nor underflow for what is
/// near. `size` is a sum of magnitudes that bounds all coordinates in it.
ABUT_HD constexpr bool within_reach(const vec3<double>& way, double reach, double size) {
    constexpr double e = 2 * unit_roundoff<double>;
    reach += e * (10 * size + 4 * reach) + 8 * smallest_normal<double>;
    if (!(size + reach < largest_finite<double> / 64)) return true;
    const vec3<double> units = (1 / reach) * way;
    return !(dot(units, units) > 1 + 16 * e);
}

}  // namespace detail

/// A ball around triangles, at least one: around the centre of their box, or a better one that some steps towards the
/// farthest corner find (M. Badoiu, K. Clarkson, Smaller core-sets for balls, 2003).
template <scalar T, class Triangles>
ABUT_HD constexpr sphere<T> around_all(std::type_identity<sphere<T>>, const Triangles& triangles) {
    const aabb<T> box = detail::box_around<T>(triangles);
    vec3<T> center = detail::center_in(box, T(0.5) * box.lower + T(0.5) * box.upper);
    sphere<T> best{center, infinity<T>};
    for (int step = 0; step < 8; ++step) {
        T radius = 0;
        vec3<T> farthest = center;
        detail::for_each_corner<T>(triangles, [&](const vec3<T>& p) {
            const T r = detail::distance_above(center, p);
            if (!(r > radius)) return;
            radius = r;
            farthest = p;
        });
        if (radius < best.radius) best = {center, radius};
        const T w = T(1) / static_cast<T>(step + 2);
        center = detail::center_in(box, (1 - w) * center + w * farthest);
    }
    return best;
}

/// A ball around both: one of them, if it certainly holds the other. Its centre may be anywhere, the radius is made for it.
template <scalar T>
ABUT_HD constexpr sphere<T> merge(const sphere<T>& a, const sphere<T>& b) {
    const T apart = detail::distance_above(a.center, b.center);
    if (a.radius >= add_up(apart, b.radius)) return a;
    if (b.radius >= add_up(apart, a.radius)) return b;
    const T half = T(0.5), w = half + half * ((b.radius - a.radius) / apart);
    const T part = w >= 0 && w <= 1 ? w : half;
    const vec3<T> center =
        detail::center_in(bounds(segment<T>{a.center, b.center}), (1 - part) * a.center + part * b.center);
    return {center, detail::greatest(add_up(detail::distance_above(center, a.center), a.radius),
                                     add_up(detail::distance_above(center, b.center), b.radius))};
}

/// Whether the balls may share a point. False is certain.
template <scalar T>
ABUT_HD constexpr bool overlaps(const sphere<T>& a, const sphere<T>& b) {
    using namespace detail;
    const vec3<double> from = widened(a.center), to = widened(b.center);
    const double flushed = 16 * static_cast<double>(smallest_normal<T>);
    const double reach = static_cast<double>(a.radius) + static_cast<double>(b.radius) + flushed;
    return within_reach(to - from, reach, magnitudes(from) + magnitudes(to));
}

/// Whether balls, each in the frame of its object, may hold shapes that meet in the world, as for boxes (relative_pose.hpp).
template <scalar T>
ABUT_HD constexpr bool overlaps(const sphere<T>& a, const relative_pose<T>& pose, const sphere<T>& b) {
    using namespace detail;
    const vec3<double> from = widened(a.center), to = widened(b.center), t = widened(pose.translation);
    const vec3<double> way = vec3<double>{dot(widened(pose.rotation[0]), to), dot(widened(pose.rotation[1]), to),
                                          dot(widened(pose.rotation[2]), to)} +
                             (t - from);
    const double r = static_cast<double>(b.radius), stretch = 1.6 * static_cast<double>(pose.deviation);
    const double reach = static_cast<double>(a.radius) + (r + stretch * r) + static_cast<double>(pose.slack);
    return within_reach(way, reach, magnitudes(from) + magnitudes(to) + magnitudes(t));
}

///@}

}  // namespace abut
