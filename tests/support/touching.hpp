// SPDX-License-Identifier: MIT
#pragma once

// Posed shapes that meet in the world, or nearly do, with boxes around them that end where they meet: for the culling of
// posed sets, which may not lose a pair to any rounding. Hosts only.

#include <cmath>

#include <abut/shape/bounds.hpp>
#include <abut/shape/rigid.hpp>

#include "draws.hpp"
#include "hulls.hpp"
#include "poses.hpp"

namespace abut::test {

/// Two triangles of a few units in the last place, each in the frame of its object, and a box around each.
template <scalar T>
struct posed_contact {
    rigid<T> pose_a, pose_b;
    triangle<T> a, b;
    construction::point side_a{0, 0, 0},
        side_b{0, 0, 0};   ///< away from the other, each in its own frame; 0 where all is one
    aabb<T> box_a, box_b;  ///< end at the triangles, and reach to these sides

    /// Whether the placed triangles meet, exactly.
    [[nodiscard]] bool meet() const {
        const triangle<T> s = place(pose_a, a), t = place(pose_b, b);
        if (s.a == t.a) return true;
        return detail::is_finite(detail::magnitudes(s.a) + detail::magnitudes(s.b) + detail::magnitudes(s.c)) &&
               detail::is_finite(detail::magnitudes(t.a) + detail::magnitudes(t.b) + detail::magnitudes(t.c)) &&
               oracle::intersects(s, t);
    }
};

namespace construction {

inline double largest_of(const point& p) { return std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z))); }

template <scalar T>
point turned_by(const rigid<T>& pose, const point& p) {
    const T* const r = pose.rotation;
    const auto at = [&](int i) { return product({double(r[3 * i]), double(r[3 * i + 1]), double(r[3 * i + 2])}, p); };
    return {at(0), at(1), at(2)};
}
template <scalar T>
point turned_back_by(const rigid<T>& pose, const point& p) {
    const T* const r = pose.rotation;
    const auto at = [&](int i) { return product({double(r[i]), double(r[3 + i]), double(r[6 + i])}, p); };
    return {at(0), at(1), at(2)};
}

/// A point that is placed near `target`: by the transposed rotation, over again for what is missing, since that is no
/// inverse where the rotation is far from orthonormal.
template <scalar T>
vec3<T> taken_back(const rigid<T>& pose, const vec3<T>& target) {
    const T* const r = pose.rotation;
    const long double to[3] = {static_cast<long double>(target.x) - static_cast<long double>(pose.translation.x),
                               static_cast<long double>(target.y) - static_cast<long double>(pose.translation.y),
                               static_cast<long double>(target.z) - static_cast<long double>(pose.translation.z)};
    long double at[3] = {0, 0, 0};
    for (int round = 0; round < 8; ++round) {
        long double missing[3];
        for (int i = 0; i < 3; ++i) missing[i] = to[i] - (r[3 * i] * at[0] + r[3 * i + 1] * at[1] + r[3 * i + 2] * at[2]);
        for (int i = 0; i < 3; ++i) at[i] += r[i] * missing[0] + r[3 + i] * missing[1] + r[6 + i] * missing[2];
    }
    return round_to<T>({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
}

/// A point that is placed at `target`, or near it: taken back, or a neighbour of that.
template <scalar T>
vec3<T> placed_at(draws& d, const rigid<T>& pose, const vec3<T>& target) {
    const vec3<T> start = taken_back(pose, target);
    vec3<T> q = start;
    for (int tries = 0; tries < 40; ++tries) {
        if (place(pose, q) == target) return q;
        q = {moved(start.x, d.below(5) - 2), moved(start.y, d.below(5) - 2), moved(start.z, d.below(5) - 2)};
    }
    return start;
}

/// A triangle whose first corner is p, and the others within `size` of it.
template <scalar T>
triangle<T> triangle_at(draws& d, const vec3<T>& p, double size) {
    const point v = cube(d, size), w = cube(d, size);
    return {p, round_to<T>({static_cast<double>(p.x) + v.x, static_cast<double>(p.y) + v.y, static_cast<double>(p.z) + v.z}),
            round_to<T>({static_cast<double>(p.x) + w.x, static_cast<double>(p.y) + w.y, static_cast<double>(p.z) + w.z})};
}

/// The box, longer towards the side that `away` points to; along axes that it is orthogonal to, on one side or both.
template <scalar T>
aabb<T> extended(draws& d, const aabb<T>& box, const point& away, double size) {
    const auto side = [&](T& lower, T& upper, double along) {
        const double by = size * d.power_of_ten(-3, 0);
        const bool neither = std::fabs(along) < 1e-4, some = neither && d.below(2) == 0;
        if (along < 0 || some) lower = rounded_to<T>(static_cast<double>(lower) - by);
        if (along >= 0 || (neither && !some)) upper = rounded_to<T>(static_cast<double>(upper) + by);
    };
    aabb<T> r = box;
    side(r.lower.x, r.upper.x, away.x);
    side(r.lower.y, r.upper.y, away.y);
    side(r.lower.z, r.upper.z, away.z);
    return r;
}

}  // namespace construction

/// Scales and offsets are moderate, or anything that leaves room to compute in double (float) or range (double).
template <scalar T>
posed_contact<T> make_posed_contact(draws& d, bool extreme) {
    using namespace construction;
    const double scale = extreme ? d.power_of_ten(sizeof(T) == 4 ? -44 : -300, sizeof(T) == 4 ? 33 : 295) : 1;
    const auto size = [&] { return scale * d.power_of_ten(-4, 4); };
    posed_contact<T> c;
    const double from_origin = size(), translation_a = d.below(4) == 0 ? 0 : size(), translation_b = size();
    c.pose_a = make_loose_pose<T>(d, translation_a);
    c.pose_b = make_loose_pose<T>(d, d.below(4) == 0 ? 0 : translation_b);
    const vec3<T> p = round_to<T>(construction::cube(d, from_origin));
    const vec3<T> w = place(c.pose_a, p);
    if (d.below(3) == 0) {  // b's origin is near: what is lost there is lost of a alone
        const double off = from_origin * d.power_of_ten(-6, 0);
        c.pose_b.translation = round_to<T>(along(widened(w), 1, cube(d, off)));
    }
    const vec3<T> q = placed_at(d, c.pose_b, w);

    constexpr double sizes[] = {0, 0, 1, 3, 30, 1e4};
    const double world = largest_of(widened(w)), ulp = 2 * static_cast<double>(unit_roundoff<T>);
    const double jitter = sizes[d.below(6)] * ulp;
    c.a = triangle_at(d, p, jitter * std::fmax(world, largest_of(widened(p))));
    c.b = triangle_at(d, q, jitter * std::fmax(world, largest_of(widened(q))));
    c.box_a = bounds(c.a);
    c.box_b = bounds(c.b);
    const int axis = d.below(6);  // of which the boxes lie on two sides: none; any; a face of a; a face of b; two edges
    if (axis == 0) return c;
    const auto unit_axis = [&] {
        point e{0, 0, 0};
        const int i = d.below(3);
        (i == 0 ? e.x : i == 1 ? e.y : e.z) = 1 - 2 * d.below(2);
        return e;
    };
    const point of_a = turned_by(c.pose_a, unit_axis()), of_b = turned_by(c.pose_b, unit_axis());
    const point between = axis == 1 ? cube(d, 1) : axis == 2 ? of_a : axis == 3 ? of_b : cross_product(of_a, of_b);
    const double longest = scale * d.power_of_ten(-8, 4);
    const double l = std::fmax(length(between), 1e-300);  // edges may be parallel
    c.side_a = turned_back_by(c.pose_a, {-between.x / l, -between.y / l, -between.z / l});
    c.side_b = turned_back_by(c.pose_b, {between.x / l, between.y / l, between.z / l});
    c.box_a = extended(d, c.box_a, c.side_a, longest);
    c.box_b = extended(d, c.box_b, c.side_b, longest);
    return c;
}

}  // namespace abut::test
