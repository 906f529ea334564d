// SPDX-License-Identifier: MIT
#pragma once

// The point of a shape that is nearest to a given one, and how far it is. Everything is computed in double, relative to the
// given point, one rounded operation after another: the same bits under every compiler, flag and device that rounds to
// nearest and keeps subnormals. Not for the nearest points of two shapes: those are in nearest.hpp.
//
// Two things hold for every way that `way_to` returns, from the query to a point of the shape. It never leaves the box
// around the shape, whose corners are brought into the frame of the query by the same rounded operations. So its square is
// never less than that of the way to the box: rounding is monotone, and culling by boxes loses nothing. And it ends on the
// shape but for a few units of roundoff of its own length and of the shape's size, whatever the shape: combinations of
// corners have weights in [0, 1].
//
// A triangle's nearest point is one of seven candidates: three corners, three edges, the face. Let h be the least height of
// the triangle, L its size, d the distance and u the roundoff. The normal is tilted by some u L / h, so the face's point is
// off by d u L / h across the triangle, or by h, since it does not leave it: by e, the lesser of both. Along the triangle it
// is off by u (d + L). The distance is least there, so it is off by no more than e^2 / d, which is below u L for any h. The
// same is true where a poor normal takes an edge for the face or the face for an edge. So needles need no special care.

#include <concepts>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/narrow/hull_distance.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

namespace detail {

/// x in a box. With a box around the way's end, in the frame of the query.
ABUT_HD constexpr vec3<double> held(const vec3<double>& x, const vec3<double>& lower, const vec3<double>& upper) {
    return least(greatest(x, lower), upper);
}
template <scalar T>
ABUT_HD constexpr vec3<double> held(const vec3<double>& way, const aabb<T>& box, const vec3<T>& p,
                                    const length_unit<T>& unit) {
    return held(way, way_between(p, box.lower, unit), way_between(p, box.upper, unit));
}

// --- in the frame of the query, which is the origin ----------------------------------------------------------------------

using contact_math::plain_difference;
using contact_math::plain_dot;

/// The point of a segment that is nearest to the origin, seen from the end that is nearer to it. So both triangles at an
/// edge find the same bits.
ABUT_HD constexpr vec3<double> foot_on_edge(const vec3<double>& nearer, const vec3<double>& farther) {
    const vec3<double> edge = plain_difference(farther, nearer);
    const double along = -plain_dot(nearer, edge), length = plain_dot(edge, edge);
    if (!(along > 0 && length > 0)) return nearer;
    const double t = along / length;
    return plain_step(nearer, t < 1 ? t : 1, edge);
}
ABUT_HD constexpr vec3<double> foot_on_segment(const vec3<double>& a, const vec3<double>& b) {
    const bool b_is_nearer = plain_dot(b, b) < plain_dot(a, a);
    const vec3<double> foot = b_is_nearer ? foot_on_edge(b, a) : foot_on_edge(a, b);
    return held(foot, least(a, b), greatest(a, b));
}

/// A triangle's face by two of its edges, from a to b and to c, for the foot of the origin on it.
struct face_of_edges {
    vec3<double> ab, ac, n;
    double nn;

    ABUT_HD constexpr face_of_edges(const vec3<double>& to_b, const vec3<double>& to_c)
        : ab(to_b), ac(to_c), n(plain_cross(to_b, to_c)), nn(plain_dot(n, n)) {}
    /// Whether there is a foot on the face of a triangle whose corner a is there. The weight of c is that of a height, and
    /// may be poor; that of b makes up for it along the triangle, whatever it is. Where the product of four lengths comes
    /// near underflow, all lengths are taken 2^300 times.
    ABUT_HD constexpr bool has_foot(const vec3<double>& a, vec3<double>& foot) const {
        double of_c = 0;
        if (nn > 0x1p-900) {
            of_c = -plain_dot(plain_cross(n, ab), a);
            if (!(of_c > 0 && of_c < nn)) return false;
            of_c /= nn;
        } else {
            const auto larger = [](const vec3<double>& v) {
                return vec3<double>{plain_product(v.x, 0x1p300), plain_product(v.y, 0x1p300), plain_product(v.z, 0x1p300)};
            };
            const vec3<double> large_ab = larger(ab), m = plain_cross(large_ab, larger(ac));
            const double mm = plain_dot(m, m);
            if (!(mm > 0)) return false;
            of_c = -plain_dot(plain_cross(m, large_ab), larger(a)) / mm;
        }
        if (!(of_c > 0 && of_c < 1)) return false;
        const vec3<double> at_height = plain_step(a, of_c, ac);
        const double of_b = -plain_dot(at_height, ab) / plain_dot(ab, ab);
        foot = plain_step(at_height, of_b, ab);
        return of_b > 0 && plain_sum(of_b, of_c) < 1;
    }
};

/// The point of a triangle that is nearest to the origin. Long, and seldom called: out of line.
ABUT_NOINLINE ABUT_HD constexpr vec3<double> foot_on_triangle(vec3<double> a, vec3<double> b, vec3<double> c) {
    const vec3<double> lower = least(least(a, b), c), upper = greatest(greatest(a, b), c);
    double aa = plain_dot(a, a), bb = plain_dot(b, b), cc = plain_dot(c, c);
    // The corner that is nearest comes first.
    if (bb < aa && !(cc < bb)) {
        const vec3<double> first = b;
        b = a, a = first;
        const double square = bb;
        bb = aa, aa = square;
    } else if (cc < aa) {
        const vec3<double> first = c;
        c = b, b = a, a = first;
        const double square = cc;
        cc = bb, bb = aa, aa = square;
    }
    const vec3<double> ab = plain_difference(b, a), ac = plain_difference(c, a);
    const double along_ab = -plain_dot(a, ab), along_ac = -plain_dot(a, ac);
    vec3<double> nearest = a;
    if ((along_ab > 0 || along_ac > 0) && !face_of_edges(ab, ac).has_foot(a, nearest)) {
        nearest = a;
        double least_square = aa;
        const auto offer = [&](const vec3<double>& foot) {
            const double square = plain_dot(foot, foot);
            if (square < least_square) least_square = square, nearest = foot;
        };
        if (along_ab > 0) offer(foot_on_edge(a, b));
        if (along_ac > 0) offer(foot_on_edge(a, c));
        const bool c_is_nearer = cc < bb;
        offer(foot_on_edge(c_is_nearer ? c : b, c_is_nearer ? b : c));
    }
    return held(nearest, lower, upper);
}

/// What is known of how far a triangle is from p, before its foot is computed: surely farther than the root of `limit`, if a
/// plane has p in front of it, that far away, and all three corners behind it. Most of what a walk meets is told so, in a
/// fraction of the time that the foot takes.
///
/// The plane is orthogonal to w, the sum of the corners as p sees them, as it is rounded. A corner's product with w is off
/// by less than 5u |w| |corner|. The least product is at least |w| |corner| / 32 for each of them, or nothing is said, so
/// that it is off by 160u of itself; squares, and the foot's own square, by less than 2^-14. What underflows is nothing
/// beside 2^-100 (or 2^-900), and what overflows says nothing, or is greater than any limit.
template <scalar T>
struct distance_bounds {
    T product, of_w, all;  ///< the least product; squares: of w, of all corners' ways in sum

    ABUT_HD constexpr distance_bounds(const triangle<T>& t, const vec3<T>& p) {
        const vec3<T> a = t.a - p, b = t.b - p, c = t.c - p, w = a + b + c;
        const T aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
        product = least(dot(w, a), dot(w, b), dot(w, c));
        of_w = dot(w, w);
        all = aa + bb + cc;
    }
    /// Whether it is surely farther than the root of `limit`.
    [[nodiscard]] ABUT_HD constexpr bool are_beyond(T limit) const {
        const T square = product * product, far = T(0x1p-10) * all, near = T(1 + 0x1p-13) * limit;
        return product > 0 && square > tiny && square > of_w * (near > far ? near : far);
    }

private:
    static constexpr T tiny = std::same_as<T, float> ? T(0x1p-100) : T(0x1p-900);
};

/// From the origin to a ball around `center`; nothing if it is inside.
ABUT_HD constexpr vec3<double> way_to_ball(const vec3<double>& center, double radius) {
    const double length = contact_math::root(contact_math::one_double{plain_dot(center, center)}).high;
    const double gap = plain_sum(length, -radius);
    if (!(gap > 0)) return {0, 0, 0};
    const double t = gap / length;
    return {plain_product(t, center.x), plain_product(t, center.y), plain_product(t, center.z)};
}

// --- the way from p to each shape ----------------------------------------------------------------------------------------

template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const vec3<T>& q, const vec3<T>& p, const length_unit<T>& unit) {
    return way_between(p, q, unit);
}
template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const segment<T>& s, const vec3<T>& p, const length_unit<T>& unit) {
    return foot_on_segment(way_between(p, s.a, unit), way_between(p, s.b, unit));
}
template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const triangle<T>& t, const vec3<T>& p, const length_unit<T>& unit) {
    return foot_on_triangle(way_between(p, t.a, unit), way_between(p, t.b, unit), way_between(p, t.c, unit));
}
template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const sphere<T>& s, const vec3<T>& p, const length_unit<T>& unit) {
    return held(way_to_ball(way_between(p, s.center, unit), unit.of(s.radius)), bounds(s), p, unit);
}
template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const capsule<T>& s, const vec3<T>& p, const length_unit<T>& unit) {
    return held(way_to_ball(way_to(s.axis, p, unit), unit.of(s.radius)), bounds(s), p, unit);
}
template <scalar T>
ABUT_HD constexpr vec3<double> way_to(const aabb<T>& box, const vec3<T>& p, const length_unit<T>& unit) {
    return held(vec3<double>{0, 0, 0}, box, p, unit);
}
template <solid_of_revolution S, scalar T>
ABUT_HD constexpr vec3<double> way_to(const S& s, const vec3<T>& p, const length_unit<T>& unit) {
    const segment<T> axis = axis_of(s);
    if (is_point(axis)) return way_to(ball_around(s), p, unit);
    const vec3<double> way = way_from_solid(revolution_profile(s, unit), way_between(axis.a, p, unit)).way;
    return held(vec3<double>{-way.x, -way.y, -way.z}, bounds(s), p, unit);
}

/// Its nearest feature is found in integers; nothing if p is inside. Where p is that near that integers leave it out, the
/// way is still no shorter than that to the box, on which walks rely.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr vec3<double> way_to(const hull<T>& h, const vec3<T>& p, const length_unit<T>& unit) {
    const hull<T> here(&p, 1);
    const nearest_in_hulls<T> found(here, h);
    if (found.length == 0) return held(vec3<double>{0, 0, 0}, bounds(h), p, unit);
    vec3<double> way{0, 0, 0}, lower{}, upper{};
    for (int k = 0; k < found.at.count; ++k) {
        const vec3<double> w = way_between(p, h[found.at.b[k]], unit);
        way = plain_step(way, found.weight[k], w);
        lower = k == 0 ? w : least(lower, w);
        upper = k == 0 ? w : greatest(upper, w);
    }
    return held(way, lower, upper);
}

template <seen_as_hull S, scalar T>
ABUT_HD constexpr vec3<double> way_to(const S& s, const vec3<T>& p, const length_unit<T>& unit) {
    const auto points = points_of(s);
    return way_to(points.as_hull(), p, unit);
}

/// Shapes that the library measures by itself.
template <class S>
concept has_way_to = requires(const S& s, const vec3<scalar_type_of<S>>& p, const length_unit<scalar_type_of<S>>& unit) {
    way_to(s, p, unit);
};

/// p plus the way, in T, and in the shape's box, as far as T has numbers: a cylinder may reach farther, and its rim may be
/// the nearest there.
template <scalar T>
ABUT_HD constexpr vec3<T> end_of_way(const vec3<T>& p, const vec3<double>& way, const aabb<T>& box,
                                     const length_unit<T>& unit) {
    const auto one = [&](T x, double d) {
        return rounded(static_cast<T>(unit.length(plain_sum(unit.of(x), d))));  // in the unit, where nothing overflows
    };
    constexpr T far = largest_finite<T>;
    const vec3<T> lower = greatest(box.lower, vec3<T>{-far, -far, -far}), upper = least(box.upper, vec3<T>{far, far, far});
    return least(greatest(vec3<T>{one(p.x, way.x), one(p.y, way.y), one(p.z, way.z)}, lower), upper);
}
/// Where the way leads to a corner it is the corner, and of a box nothing is rounded.
template <class S, scalar T>
ABUT_HD constexpr vec3<T> end_of_way(const S& s, const vec3<T>& p, const vec3<double>& way, const length_unit<T>& unit) {
    if constexpr (seen_as_hull<S>) {
        const auto points = points_of(s);
        return end_of_way(points.as_hull(), p, way, unit);
    }
    if constexpr (std::same_as<S, aabb<T>>) return least(greatest(p, s.lower), s.upper);
    if constexpr (std::same_as<S, hull<T>>) {
        for (std::size_t i = 0; i < s.count; ++i) {
            if (way == way_between(p, s[i], unit)) return s[i];
        }
    }
    if constexpr (corners_of_shape<S> > 1) {
        for (const vec3<T>& corner : core_of(s).at) {
            if (way == way_between(p, corner, unit)) return corner;
        }
    }
    return end_of_way(p, way, bounds(s), unit);
}

/// A unit for one shape and one point.
template <scalar T>
ABUT_HD constexpr length_unit<T> unit_for(const aabb<T>& box, const vec3<T>& p) {
    if constexpr (std::same_as<T, double>) {
        const vec3<double> most = greatest(greatest(absolute(box.lower), absolute(box.upper)), absolute(p));
        return length_unit<double>(least(greatest(most.x, most.y, most.z), largest_finite<double>));
    } else {
        return {};
    }
}

}  // namespace detail

/// The point of a shape that is nearest to `p`: of a point (vec3), segment, triangle, sphere, capsule, cylinder, cone, box,
/// oriented box or convex hull; the last seven are solid, and p itself is nearest where it is inside. It lies in the box
/// around the shape. docs/numerics/distances.md says how accurate it is. p and the shape are finite.
///
///     const auto q = abut::nearest_point(abut::segment<float>{{0, 0, 0}, {4, 0, 0}}, {1, 2, 0});   // (1, 0, 0)
/// @ingroup one_pair
template <detail::has_way_to S>
[[nodiscard]] ABUT_HD vec3<scalar_type_of<S>> nearest_point(const S& s, const vec3<scalar_type_of<S>>& p) {
    const auto unit = detail::unit_for(bounds(s), p);
    return detail::end_of_way(s, p, detail::way_to(s, p, unit), unit);
}

/// Has `nearest_point(s, p)`: the point of s that is nearest to p, found by argument-dependent lookup. Pure, on hosts and
/// devices. The result is taken into the box of the shape.
template <class S>
concept approachable = shape<S> && requires(const S& s, const vec3<scalar_type_of<S>>& p) {
    { nearest_point(s, p) } -> std::same_as<vec3<scalar_type_of<S>>>;
};

/// The id of no shape.
inline constexpr std::uint32_t no_id = static_cast<std::uint32_t>(-1);

/// A shape near a point, where on it, and how far that is. Where there are no shapes: `no_id`, the point asked about and
/// infinity. A distance that T has no number for is infinite too.
template <scalar T>
struct neighbor {
    std::uint32_t id;  ///< of the shape in its set
    vec3<T> point;     ///< on the shape, in the world
    T distance;        ///< from the point asked about, rounded to T

    friend constexpr bool operator==(const neighbor&, const neighbor&) = default;
};

namespace detail {

/// The way from p to any shape; to one of the caller's own by the point that it names.
template <approachable S, scalar T>
ABUT_HD vec3<double> way_from(const vec3<T>& p, const S& s, const length_unit<T>& unit) {
    if constexpr (has_way_to<S>) {
        return way_to(s, p, unit);
    } else {
        return held(way_between(p, nearest_point(s, p), unit), bounds(s), p, unit);
    }
}

/// The square of that way.
template <approachable S, scalar T>
ABUT_HD double squared_distance(const vec3<T>& p, const S& s, const length_unit<T>& unit) {
    const vec3<double> way = way_from(p, s, unit);
    return plain_dot(way, way);
}

/// A square in its unit as one of lengths in T, for comparisons: what is lost to underflow is added.
template <scalar T>
ABUT_HD T square_from(const length_unit<T>& unit, double square) {
    return static_cast<T>(unit.length(unit.length(square + 4 * smallest_normal<double>)));
}

template <approachable S, scalar T>
ABUT_HD neighbor<T> neighbor_of(const vec3<T>& p, const S& s, std::uint32_t id, const length_unit<T>& unit) {
    const vec3<double> way = way_from(p, s, unit);
    const double length = contact_math::root(contact_math::one_double{plain_dot(way, way)}).high;
    return {id, end_of_way(s, p, way, unit), rounded(static_cast<T>(unit.length(length)))};
}

/// Shapes whose distance takes long to compute, and is bounded in less.
template <class S>
concept has_distance_bounds = std::same_as<S, triangle<scalar_type_of<S>>>;

/// Measures squared distances.
template <scalar T>
struct measure_distance {
    length_unit<T> unit;
    /// Where the distance is surely above `bound`, infinity will do.
    template <approachable S>
    ABUT_HD double measure(const S& s, const vec3<T>& p, double bound) const {
        if constexpr (has_distance_bounds<S>) {
            if (distance_bounds<T>(s, p).are_beyond(square_from(unit, bound))) return infinity<double>;
        }
        return measure(s, p);
    }
    template <approachable S>
    ABUT_HD double measure(const S& s, const vec3<T>& p) const {
        return squared_distance(p, s, unit);
    }
};

}  // namespace detail

}  // namespace abut
