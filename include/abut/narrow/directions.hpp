// SPDX-License-Identifier: MIT
#pragma once

// In which direction two touching shapes come apart, and how far they have to go. Moved by t along a unit vector n, a shape
// is apart from another if t exceeds their overlap along n, max n.q - min n.p over points q of the one that stays and p of
// the one that goes. So any direction has an honest depth, whatever rounding did to the direction, and the contact's is the
// least over a few candidates.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/half_space.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// Where two shapes touch: shape `a` of a query's first argument and `b` of its second. `point` is a point of both;
/// `normal` has length 1 and points from b to a; a moved by `depth` along it is apart from b. All but for rounding, which
/// docs/contacts.md bounds.
template <scalar T>
struct contact {
    std::uint32_t a;  ///< id of the first shape; 0 of a single pair
    std::uint32_t b;  ///< id of the second one; 0 of a single pair
    vec3<T> point;    ///< of both shapes, in the world
    vec3<T> normal;   ///< of length 1, from b to a
    T depth;          ///< 0 or more, in units of length

    friend constexpr bool operator==(const contact&, const contact&) = default;
};

namespace detail {

template <scalar T>
ABUT_HD constexpr contact<T> reversed(const contact<T>& c) {
    return {c.b, c.a, c.point, {-c.normal.x, -c.normal.y, -c.normal.z}, c.depth};
}

}  // namespace detail

namespace detail::contact_math {

/// Largest magnitudes of the numbers that shapes are made of.
template <scalar T>
ABUT_HD constexpr T magnitude_of(const vec3<T>& p) {
    return greatest(absolute(p.x), absolute(p.y), absolute(p.z));
}
template <class S>
    requires(corners_of_core<S> > 0)
ABUT_HD constexpr auto magnitude_of(const S& s) {
    auto most = radius_around_core(s);
    for (const auto& p : core_of(s).at) most = greatest(most, magnitude_of(p));
    return most;
}
template <scalar T>
ABUT_HD constexpr T magnitude_of(const cylinder<T>& s) {
    return magnitude_of(capsule<T>{s.axis, s.radius});
}
template <scalar T>
ABUT_HD constexpr T magnitude_of(const cone<T>& s) {
    return magnitude_of(capsule<T>{{s.apex, s.base_center}, s.radius});
}
template <scalar T>
ABUT_HD constexpr T magnitude_of(const aabb<T>& s) {
    return greatest(magnitude_of(s.lower), magnitude_of(s.upper));
}
template <scalar T>
ABUT_HD constexpr T magnitude_of(const hull<T>& h) {
    T most = 0;
    for (std::size_t i = 0; i < h.count; ++i) most = greatest(most, magnitude_of(h[i]));
    return most;
}
template <seen_as_hull S>
ABUT_HD constexpr auto magnitude_of(const S& s) {
    const auto points = points_of(s);
    return magnitude_of(points.as_hull());
}
/// Of a plane or a half space no point counts: it reaches everywhere.
///@{
template <scalar T>
ABUT_HD constexpr T magnitude_of(const plane<T>&) {
    return 0;
}
template <scalar T>
ABUT_HD constexpr T magnitude_of(const half_space<T>&) {
    return 0;
}
///@}

/// The power of two that brings two shapes to [-2, 2): numbers that leave room for products. It rounds only what is
/// 2^-1021 times as large as the largest number, or smaller.
struct common_scale {
    int exponent = 0;

    template <class S, class U>
    ABUT_HD constexpr common_scale(const S& s, const U& t) {
        const double largest = static_cast<double>(greatest(magnitude_of(s), magnitude_of(t)));
        if (largest > 0) exponent = exponent_of(largest);
    }
    template <scalar T>
    ABUT_HD constexpr double operator()(T x) const {
        return scaled(static_cast<double>(x), -exponent);
    }
    template <scalar T>
    ABUT_HD constexpr point operator()(const vec3<T>& p) const {
        return {(*this)(p.x), (*this)(p.y), (*this)(p.z)};
    }
    template <scalar T>
    ABUT_HD constexpr corners operator()(const triangle<T>& t) const {
        return {{(*this)(t.a), (*this)(t.b), (*this)(t.c)}};
    }
    /// Back, rounded to T; no further than the largest number.
    template <scalar T>
    ABUT_HD constexpr T back(double x) const {
        return rounded_within<T>(scaled(x, exponent));
    }
    template <scalar T>
    ABUT_HD constexpr vec3<T> back(const point& p) const {
        return {back<T>(p.x), back<T>(p.y), back<T>(p.z)};
    }
};

/// What gaps pass for none, squared, at the common scale: 2 units of roundoff for double; for float less than one.
template <scalar T>
ABUT_HD constexpr double tolerable_square() {
    constexpr double gap = (std::same_as<T, float> ? 0.5 : 4) * static_cast<double>(unit_roundoff<T>);
    return gap * gap;
}

/// A direction rounded to T, as contacts hold it.
template <scalar T>
ABUT_HD constexpr point as_stored_direction(const point& n) {
    return {static_cast<double>(rounded(static_cast<T>(n.x))), static_cast<double>(rounded(static_cast<T>(n.y))),
            static_cast<double>(rounded(static_cast<T>(n.z)))};
}

/// The way from one corner of a shape to another, brought to one and not rounded: what a common scale loses of short edges
/// stays. `exponent` tells lengths apart: times 2^exponent it is that way. Of equal corners it is 0.
struct edge {
    vec3<two_doubles> direction;
    int exponent;

    ABUT_HD constexpr bool is_longer_than(const edge& e) const {
        return exponent != e.exponent ? exponent > e.exponent
                                      : largest_of(rounded_off(direction)) > largest_of(rounded_off(e.direction));
    }
};
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr edge edge_between(const vec3<T>& from, const vec3<T>& to) {
    const point p = widened(from), q = widened(to);
    // By a quarter where the difference might overflow. What this rounds is nothing beside such a length.
    const point half{plain_sum(q.x / 2, -p.x / 2), plain_sum(q.y / 2, -p.y / 2), plain_sum(q.z / 2, -p.z / 2)};
    const bool far = largest_of(half) >= 0x1p1022;
    const vec3<two_doubles> way = far ? between<two_doubles>(scaled(p, -2), scaled(q, -2)) : between<two_doubles>(p, q);
    const double largest = largest_of(rounded_off(way));
    if (!(largest > 0)) return {way, -2000};
    const int exponent = exponent_of(largest);
    return {scaled_vector(way, -exponent), exponent + (far ? 2 : 0)};
}
/// From corner i to the next.
template <scalar T>
ABUT_HD constexpr edge edge_of(const triangle<T>& t, int i) {
    return edge_between(i == 0 ? t.a : i == 1 ? t.b : t.c, i == 0 ? t.b : i == 1 ? t.c : t.a);
}

/// The unit vector along u x v, rounded once; zero where they are parallel. Both have been brought to one.
ABUT_HD constexpr point unit_cross(const vec3<two_doubles>& u, const vec3<two_doubles>& v) {
    return unit_vector(accurate_cross(u, v));
}

/// (b - a) x (c - a), of any length: of a needle from its shortest edge and the next one, between which the sine is largest.
/// Zero for a triangle that is a segment or a point.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr vec3<two_doubles> face_direction(const triangle<T>& t) {
    const vec3<two_doubles> n = cross(edge_between(t.a, t.b).direction, edge_between(t.a, t.c).direction);
    if (largest_of(rounded_off(n)) > 0x1p-40) return n;
    int shortest = 0;
    for (int i = 1; i < 3; ++i) {
        if (edge_of(t, shortest).is_longer_than(edge_of(t, i))) shortest = i;
    }
    return accurate_cross(edge_of(t, shortest).direction, edge_of(t, shortest == 2 ? 0 : shortest + 1).direction);
}

/// The unit normal of a triangle, rounded to T: (b - a) x (c - a). Zero for one that is a segment or a point.
template <scalar T>
ABUT_HD constexpr point face_normal(const triangle<T>& t) {
    if constexpr (std::same_as<T, float>) {  // in doubles, where they lose no more than 2^-29
        const point a = widened(t.a);
        const auto ab = between<one_double>(a, widened(t.b)), ac = between<one_double>(a, widened(t.c));
        const auto n = cross(ab, ac);
        const double square = dot(n, n).high, most = (dot(ab, ab) * dot(ac, ac)).high;
        if (square > 0x1p-40 * most) return as_stored_direction<T>(unit_vector(n));
    }
    return as_stored_direction<T>(unit_vector(face_direction(t)));
}

/// Which edge of a triangle is the longest, by the corner that it starts from: what a degenerate triangle is.
template <scalar T>
ABUT_HD constexpr int longest_edge(const triangle<T>& t) {
    int longest = 0;
    for (int i = 1; i < 3; ++i) {
        if (edge_of(t, i).is_longer_than(edge_of(t, longest))) longest = i;
    }
    return longest;
}

/// A unit vector orthogonal to v, which has been brought to one; of 0, the z axis.
ABUT_HD constexpr point any_orthogonal(const vec3<two_doubles>& v) {
    const point size = absolute(rounded_off(v));
    if (is_zero(size)) return {0, 0, 1};
    const bool x = size.x <= size.y && size.x <= size.z, y = !x && size.y <= size.z;
    return unit_cross(v, as<two_doubles>({x ? 1.0 : 0.0, y ? 1.0 : 0.0, x || y ? 0.0 : 1.0}));
}

/// The direction in which two degenerate triangles come apart: across both segments, or across one and any way, or along z.
template <scalar T>
ABUT_HD constexpr point across_both(const triangle<T>& s, const triangle<T>& t) {
    const vec3<two_doubles> along_s = edge_of(s, longest_edge(s)).direction, along_t = edge_of(t, longest_edge(t)).direction;
    const point both = unit_cross(along_s, along_t);
    if (!is_zero(both)) return both;
    return any_orthogonal(is_zero(along_s) ? along_t : along_s);
}

/// The extent of a shape along a direction: from the least to the greatest n.(p - origin).
struct extent {
    double lower, upper;
};
template <std::size_t K>
ABUT_HD constexpr extent extent_of(const point (&corner)[K], const point& n, const point& origin) {
    extent e{infinity<double>, -infinity<double>};
    for (int i = 0; i < int{K}; ++i) {
        const double height = plain_dot(n, plain_difference(corner[i], origin));
        e = {least(e.lower, height), greatest(e.upper, height)};
    }
    return e;
}

/// The candidate direction with the least overlap; of equals the first.
struct least_overlap {
    point normal{0, 0, 1};
    double depth = infinity<double>;

    ABUT_HD constexpr void offer(const point& n, double overlap) {
        if (overlap < depth) depth = overlap, normal = n;
    }
    /// n and -n, or first -n where wanted.
    ABUT_HD constexpr void offer_both(const point& n, const extent& a, const extent& b, bool negative_first = false) {
        const double along = plain_sum(b.upper, -a.lower), against = plain_sum(a.upper, -b.lower);
        if (negative_first) offer(negated(n), against);
        offer(n, along);
        if (!negative_first) offer(negated(n), against);
    }
};

/// The contact from its parts at the common scale.
template <scalar T>
ABUT_HD constexpr contact<T> assembled(const common_scale& scale, const point& where, const least_overlap& way) {
    const point& n = way.normal;
    const double depth = way.depth > 0 ? way.depth : 0;
    return {
        0, 0, scale.back<T>(where), {static_cast<T>(n.x), static_cast<T>(n.y), static_cast<T>(n.z)}, scale.back<T>(depth)};
}

ABUT_HD constexpr point middle_of(const two_points& p) {
    return {plain_sum(p.on_a.x, p.on_b.x) / 2, plain_sum(p.on_a.y, p.on_b.y) / 2, plain_sum(p.on_a.z, p.on_b.z) / 2};
}

}  // namespace detail::contact_math

/// The rounding that is left in a contact of these two shapes, as a distance. The contact's point is no farther than this
/// from either shape. Its depth is no farther than this from what it stands for. Moved by depth + bound along the normal,
/// each coordinate rounded, a is apart from b. It is 32 units of roundoff (float: 2^-19, double: 2^-48) of the largest
/// magnitude among the shapes' coordinates and radii, and 16 times the least positive number.
template <class S, class U>
[[nodiscard]] ABUT_HD constexpr auto contact_bound(const S& s, const U& t) {
    auto largest = detail::greatest(detail::contact_math::magnitude_of(s), detail::contact_math::magnitude_of(t));
    using T = decltype(largest);
    constexpr T least_positive = ABUT_BIT_CAST(T, typename detail::float_format<T>::word{1});
    return detail::plain_sum(detail::plain_product(largest, 32 * unit_roundoff<T>), 16 * least_positive);
}

}  // namespace abut
