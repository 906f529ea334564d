// SPDX-License-Identifier: MIT
#pragma once

// What two triangles that touch have in common, by its corners: a point, a segment or a convex polygon, each corner told by
// what of either triangle it lies in: a corner, a side, or the inside. Here are names alone; where the corners lie is told by
// narrow/crossing_points.hpp. The questions are signs of determinants, written once over a number type, as in
// exact_triangles.hpp, whose cases these are:
//
// Neither triangle in the other's plane. The line in which the planes cross has a chord of each: from a corner in the plane,
// or from a side that the plane cuts, to another. Each end of a chord is on a side from the lone corner. The determinant of
// two such sides, one of each triangle, tells the order of their ends along the line: the two of Devillers and Guigue, and the
// two others. The ends of what the chords share follow.
//
// Both in one plane, or without area. Seen along an axis that keeps the area of the plane, or the length of the line, which
// both are in, the corners of the common part are: corners of either that are in the other one, and where two sides pass
// each other, inside of both. There are no more, and none twice, since each is named by the least that it lies in. Two of
// them are neighbours if both lie on one side of a triangle, and come in the order in which that side runs.
//
// One without area that is not in the other's plane: its segment meets that plane in one point.
//
// A triangle without area is the segment between its two corners that are farthest apart, or its first corner.
//
// Checked against CGAL's exact kernel, and in rational numbers (tests/predicate/shared_corners.test.cpp).

#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/predicate/coarse_grid.hpp>
#include <abut/predicate/exact_triangles.hpp>
#include <abut/predicate/triangle_triangle.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// What of a triangle a point lies in: k < 3, corner k; k - 3, the side from there to the next corner; the inside.
using place_in_triangle = unsigned;
inline constexpr place_in_triangle side_of_triangle = 3, inside_of_triangle = 6, outside_of_triangle = 7;

/// Up to six corners of a common part, by their places in the first and in the second triangle.
struct shared_corners {
    std::uint64_t bits = 0;  ///< their number in three bits, then six for each, then whether all is in one plane

    ABUT_HD static constexpr shared_corners unknown() { return {7}; }
    [[nodiscard]] ABUT_HD constexpr bool is_known() const { return count() != 7; }
    [[nodiscard]] ABUT_HD constexpr int count() const { return static_cast<int>(bits & 7); }
    /// Whether both triangles are in one plane.
    [[nodiscard]] ABUT_HD constexpr bool is_flat() const { return (bits & flat) != 0; }
    [[nodiscard]] ABUT_HD constexpr place_in_triangle in_first(int i) const { return field(3 + 6 * i); }
    [[nodiscard]] ABUT_HD constexpr place_in_triangle in_second(int i) const { return field(6 + 6 * i); }
    [[nodiscard]] ABUT_HD constexpr place_in_triangle in(bool second, int i) const { return field((second ? 6 : 3) + 6 * i); }
    ABUT_HD constexpr void add(place_in_triangle in_s, place_in_triangle in_t) {
        bits |= std::uint64_t{in_s | in_t << 3} << (3 + 6 * count());
        ++bits;
    }

    friend constexpr bool operator==(const shared_corners&, const shared_corners&) = default;

    static constexpr std::uint64_t flat = std::uint64_t{1} << 40;

private:
    [[nodiscard]] ABUT_HD constexpr place_in_triangle field(int at) const { return static_cast<unsigned>(bits >> at & 7); }
};

/// The side between two corners.
ABUT_HD constexpr place_in_triangle side_between(unsigned i, unsigned j) {
    return side_of_triangle + (i + j == 2 ? 2 : i < j ? i : j);
}

/// What a triangle has in common with the other one's plane, which it crosses: from one place to another. `alone` is its lone
/// corner; a bit of `in_plane` says that a corner lies in that plane.
struct chord_places {
    place_in_triangle next, last, middle;  ///< its ends on the sides to `next` and `last`, and what is between

    ABUT_HD constexpr chord_places(const lone_corner& k, unsigned in_plane)
        : next(end_of(k.alone, k.next, in_plane)), last(end_of(k.alone, k.last, in_plane)), middle(inside_of_triangle) {
        if (next == last) middle = next;
        else if (next < side_of_triangle && last < side_of_triangle) middle = side_between(next, last);
    }

private:
    ABUT_HD static constexpr place_in_triangle end_of(unsigned alone, unsigned other, unsigned in_plane) {
        return (in_plane >> alone & 1) != 0 ? alone : (in_plane >> other & 1) != 0 ? other : side_between(alone, other);
    }
};

/// Whether what chords share comes in the other order than along the cross product of the first triangle's normal and the
/// second one's. A bit for each corner that is above the other's plane, as of lone_corner.
ABUT_HD constexpr bool runs_backwards(unsigned above_s, unsigned above_t) {
    constexpr unsigned lone_one_is_above = 0b0001'0110u;
    return (lone_one_is_above >> above_s & 1) == (lone_one_is_above >> above_t & 1);
}

/// What two chords of one line share. Their ends by the sides from the lone corners: the sign of next_last tells whether the
/// end of s on the side to `next` comes behind that of t on the side to `last`, and so forth. The chord of s runs from `next`
/// to `last`, that of t from `last` to `next`, and they share something.
ABUT_HD constexpr shared_corners shared_by_chords(const chord_places& s, const chord_places& t, int next_next, int next_last,
                                                  int last_next, int last_last, bool backwards) {
    shared_corners all;
    if (next_next == 0) {
        all.add(s.next, t.next);
    } else if (last_last == 0) {
        all.add(s.last, t.last);
    } else {
        const place_in_triangle first_s = next_last >= 0 ? s.next : s.middle, first_t = next_last <= 0 ? t.last : t.middle;
        const place_in_triangle end_s = last_next <= 0 ? s.last : s.middle, end_t = last_next >= 0 ? t.next : t.middle;
        if (first_s == end_s && first_t == end_t) {
            all.add(first_s, first_t);
        } else if (backwards) {
            all.add(end_s, end_t);
            all.add(first_s, first_t);
        } else {
            all.add(first_s, first_t);
            all.add(end_s, end_t);
        }
    }
    return all;
}

/// Of triangles whose planes cross in a line, of which they share something.
template <class N>
ABUT_HD constexpr shared_corners shared_along_line(const three_points<N>& s, const plane_sides& of_s, const three_points<N>& t,
                                                   const plane_sides& of_t) {
    const unsigned above_s = of_s.upper_part(), above_t = of_t.upper_part();
    const lone_corner k(above_s, above_t), l(above_t, above_s);
    const vec3<N> p = corner(s, k.alone), q = corner(t, l.alone);
    const auto across = q - p, to_next = corner(t, l.next) - p, to_last = corner(t, l.last) - p;
    const auto by_next = cross(corner(s, k.next) - p, across), by_last = cross(corner(s, k.last) - p, across);
    const chord_places chord_s(k, 0b111 & ~(of_s.above | of_s.below)), chord_t(l, 0b111 & ~(of_t.above | of_t.below));
    return shared_by_chords(chord_s, chord_t, sign_of_dot(by_next, to_next), sign_of_dot(by_next, to_last),
                            sign_of_dot(by_last, to_next), sign_of_dot(by_last, to_last), runs_backwards(above_s, above_t));
}

// --- in one plane, one coordinate left out

/// A triangle, a segment or a point seen along an axis that keeps it, by corners of a triangle.
template <class N>
struct flat_hull {
    flat_point<N> at[3];
    unsigned id[3];
    int count, sense;  ///< of corners; in which sense the three turn

    [[nodiscard]] ABUT_HD constexpr int sides() const { return count == 3 ? 3 : count - 1; }
    [[nodiscard]] ABUT_HD constexpr int next(int i) const { return i + 1 == count ? 0 : i + 1; }
    [[nodiscard]] ABUT_HD constexpr place_in_triangle side(int i) const { return side_between(id[i], id[next(i)]); }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int side_of(int i, const flat_point<N>& p) const { return turn(at[i], at[next(i)], p); }
};

template <class N>
ABUT_HD constexpr int compare(const flat_point<N>& p, const flat_point<N>& q) {
    const int x = sign(p.x - q.x);
    return x != 0 ? x : sign(p.y - q.y);
}
template <class N>
ABUT_HD constexpr int compare(const vec3<N>& p, const vec3<N>& q) {
    const int x = sign(p.x - q.x), y = sign(p.y - q.y);
    return x != 0 ? x : y != 0 ? y : sign(p.z - q.z);
}

/// The corners that a triangle is the hull of: all, if it has an area.
struct hull_corners {
    unsigned id[3] = {0, 1, 2};
    int count = 3;

    template <class N>
    ABUT_HD constexpr hull_corners(const three_points<N>& s, bool has_area) {
        if (has_area) return;
        unsigned least = 0, most = 0;
        for (unsigned i = 1; i < 3; ++i) {
            if (compare(s.at[i], s.at[least]) < 0) least = i;
            if (compare(s.at[i], s.at[most]) > 0) most = i;
        }
        count = least == most ? 1 : 2;
        id[0] = least < most ? least : most;
        id[1] = least < most ? most : least;
    }
};

template <class N>
ABUT_HD constexpr flat_hull<N> seen_along(const three_points<N>& s, const hull_corners& of, int axis) {
    const flat_points<N> all = flattened(s, axis);
    flat_hull<N> flat{};
    flat.count = of.count;
    for (int i = 0; i < of.count; ++i) {
        flat.id[i] = of.id[i];
        flat.at[i] = all.at[of.id[i]];
    }
    flat.sense = of.count == 3 ? turn(flat.at[0], flat.at[1], flat.at[2]) : 0;
    return flat;
}

/// Where a point of the plane, or of the line, lies in a hull.
template <class N>
ABUT_HD constexpr place_in_triangle place_of(const flat_point<N>& p, const flat_hull<N>& h) {
    for (int i = 0; i < h.count; ++i) {
        if (compare(p, h.at[i]) == 0) return h.id[i];
    }
    if (h.count == 1) return outside_of_triangle;
    if (h.count == 2) {
        const bool between = h.side_of(0, p) == 0 && compare(p, h.at[0]) == compare(h.at[1], p);
        return between ? h.side(0) : outside_of_triangle;
    }
    place_in_triangle in = inside_of_triangle;
    for (int i = 0; i < 3; ++i) {
        const int side = h.side_of(i, p);
        if (side == 0) in = h.side(i);
        if (side == -h.sense) return outside_of_triangle;
    }
    return in;
}

/// Of corners on one side of a hull, which are two: whether the first comes before the second as the side runs.
template <class N>
ABUT_HD constexpr bool in_order_on_side(const shared_corners& all, int c, int d, const flat_hull<N>& h, int i, bool second,
                                        const flat_hull<N>& other) {
    const int j = h.next(i);
    const place_in_triangle in_c = all.in(second, c), in_d = all.in(second, d);
    if (in_c == h.id[i] || in_d == h.id[j]) return true;
    if (in_c == h.id[j] || in_d == h.id[i]) return false;
    // Where the side passes one of the other's, it comes in or leaves.
    for (int e = 0; e < other.sides(); ++e) {
        const bool passes_c = all.in(!second, c) == other.side(e), passes_d = all.in(!second, d) == other.side(e);
        if (passes_c != passes_d) return (other.side_of(e, h.at[i]) == -other.sense) == passes_c;
    }
    // Corners of the other one.
    flat_point<N> at_c = h.at[i], at_d = h.at[j];
    for (int e = 0; e < other.count; ++e) {
        if (all.in(!second, c) == other.id[e]) at_c = other.at[e];
        if (all.in(!second, d) == other.id[e]) at_d = other.at[e];
    }
    return compare(at_c, at_d) == compare(h.at[i], h.at[j]);
}

/// Corners of a polygon one after another, as the corners of s turn.
template <class N>
ABUT_HD constexpr shared_corners in_turn(const shared_corners& all, const flat_hull<N>& s, const flat_hull<N>& t) {
    int after_it[6] = {0, 0, 0, 0, 0, 0};
    for (int side = 0; side < 6; ++side) {
        const bool second = side >= 3;
        const int i = second ? side - 3 : side;
        const flat_hull<N>&h = second ? t : s, &other = second ? s : t;
        int on[2] = {0, 0}, found = 0;
        for (int c = 0; c < all.count(); ++c) {
            const place_in_triangle in = all.in(second, c);
            if ((in == h.id[i] || in == h.id[h.next(i)] || in == h.side(i)) && found < 2) on[found++] = c;
        }
        if (found < 2) continue;
        const bool as_it_runs = in_order_on_side(all, on[0], on[1], h, i, second, other);
        if (as_it_runs == (h.sense == s.sense)) after_it[on[0]] = on[1];
        else after_it[on[1]] = on[0];
    }
    shared_corners sorted{shared_corners::flat};
    for (int k = 0, c = 0; k < all.count(); ++k, c = after_it[c]) sorted.add(all.in_first(c), all.in_second(c));
    return sorted;
}

/// Of hulls in one plane, or on one line.
template <class N>
ABUT_HD constexpr shared_corners shared_in_plane(const flat_hull<N>& s, const flat_hull<N>& t) {
    shared_corners all{shared_corners::flat};
    for (int i = 0; i < s.count; ++i) {
        if (const place_in_triangle in = place_of(s.at[i], t); in != outside_of_triangle) all.add(s.id[i], in);
    }
    for (int i = 0; i < t.count; ++i) {
        const place_in_triangle in = place_of(t.at[i], s);
        if (in != outside_of_triangle && in >= side_of_triangle) all.add(in, t.id[i]);
    }
    for (int i = 0; i < s.sides(); ++i) {
        for (int j = 0; j < t.sides(); ++j) {
            if (s.side_of(i, t.at[j]) * s.side_of(i, t.at[t.next(j)]) < 0 &&
                t.side_of(j, s.at[i]) * t.side_of(j, s.at[s.next(i)]) < 0)
                all.add(s.side(i), t.side(j));
        }
    }
    return all.count() < 3 ? all : in_turn(all, s, t);
}

/// Of a segment or a point that is not in the plane of t, whose sides its corners are on.
template <class N>
ABUT_HD constexpr place_in_triangle place_of_piercing(three_points<N> s, const hull_corners& of, const three_points<N>& t) {
    // Its line passes the sides of t in senses: none for a corner's two sides, and no other.
    if (of.id[0] == 1) rotate(s.at[0], s.at[1], s.at[2]);
    if (of.id[0] == 0 && of.id[1] == 2) s.at[1] = s.at[2];
    place_in_triangle in = inside_of_triangle;
    int zeros = 0;
    bool left = false, right = false;
    three_points<N> turned = t;
    for (unsigned i = 0; i < 3; ++i) {
        const int sense = passing_sense(s, turned);
        left |= sense < 0;
        right |= sense > 0;
        if (sense == 0) {
            // On sides 0 and 1 it is at corner 1, on 1 and 2 at 2, on 2 and 0 at 0.
            in = ++zeros == 1 ? side_of_triangle + i : in == side_of_triangle && i == 2 ? 0 : i;
        }
        turn_corners(turned);
    }
    return left && right ? outside_of_triangle : in;
}

/// Of which one at least has no area.
template <class N>
ABUT_HD constexpr shared_corners shared_without_area(const three_points<N>& s, const plane_sides& of_s,
                                                     const three_points<N>& t, const plane_sides& of_t) {
    const int axis_s = axis_of_area(s), axis_t = axis_of_area(t);
    const hull_corners hull_s(s, axis_s < 3), hull_t(t, axis_t < 3);
    shared_corners all;
    if (axis_s < 3 || axis_t < 3) {
        const bool second = axis_s < 3;  // is the segment
        const plane_sides& sides = second ? of_t : of_s;
        if (sides.all_zero()) {
            const int axis = second ? axis_s : axis_t;
            return shared_in_plane(seen_along(s, hull_s, axis), seen_along(t, hull_t, axis));
        }
        const hull_corners& segment = second ? hull_t : hull_s;
        if (segment.count < 2) return all;
        const unsigned i = segment.id[0], j = segment.id[1], in_plane = ~(sides.above | sides.below);
        const bool starts_there = (in_plane >> i & 1) != 0, ends_there = (in_plane >> j & 1) != 0;
        if (!starts_there && !ends_there && (sides.above >> i & 1) == (sides.above >> j & 1)) return all;
        const place_in_triangle of_segment = starts_there ? i : ends_there ? j : side_between(i, j);
        const place_in_triangle in = second ? place_of_piercing(t, segment, s) : place_of_piercing(s, segment, t);
        if (in == outside_of_triangle) return all;
        if (second) all.add(in, of_segment);
        else all.add(of_segment, in);
        return all;
    }
    if (!segments_meet(s, t)) return all;
    const vec3<N> p = s.at[hull_s.id[0]], q = t.at[hull_t.id[0]];
    const auto along_s = s.at[hull_s.id[hull_s.count - 1]] - p, along_t = t.at[hull_t.id[hull_t.count - 1]] - q;
    const auto normal = cross(along_s, along_t);
    int axis = sign(normal.x) != 0 ? 0 : sign(normal.y) != 0 ? 1 : sign(normal.z) != 0 ? 2 : 3;
    if (axis == 3) {  // on one line: seen along any axis but its own
        const bool has_x = sign(along_s.x) != 0 || sign(along_t.x) != 0, has_y = sign(along_s.y) != 0 || sign(along_t.y) != 0;
        axis = has_x || has_y ? 2 : 0;
        // Two points, which are one.
        if (hull_s.count == 1 && hull_t.count == 1) axis = 0;
    }
    return shared_in_plane(seen_along(s, hull_s, axis), seen_along(t, hull_t, axis));
}

/// Of any two triangles; none where they do not touch.
template <class N>
ABUT_HD constexpr shared_corners corners_shared(const three_points<N>& s, const three_points<N>& t) {
    const plane_sides of_s(s, t), of_t(t, s);
    if (of_s.strictly_one() || of_t.strictly_one()) return {};
    if (!of_s.all_zero() && !of_t.all_zero()) {
        return intervals_meet(s, of_s.upper_part(), t, of_t.upper_part()) ? shared_along_line(s, of_s, t, of_t)
                                                                           : shared_corners{};
    }
    const int axis = axis_of_area(s);
    if (axis < 3 && axis_of_area(t) < 3) {
        const flat_hull<N> p = seen_along(s, hull_corners(s, true), axis), q = seen_along(t, hull_corners(t, true), axis);
        return shared_in_plane(p, q);
    }
    return shared_without_area(s, of_s, t, of_t);
}

/// How the question's values lie in an array of any number type, as in triangle_meets_triangle.
struct corners_of_triangles {
    static constexpr int degree = 3, points = 6;

    template <class N>
    ABUT_HD static constexpr shared_corners holds(const N (&v)[18]) {
        const three_points<N> s{{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}}};
        const three_points<N> t{{{v[9], v[10], v[11]}, {v[12], v[13], v[14]}, {v[15], v[16], v[17]}}};
        return corners_shared(s, t);
    }
};

// --- stages

/// In general position, by determinants of which all signs are certain (certified_triangles.hpp has the bounds): the ends of
/// a segment, each on a side of one triangle and inside the other. Else unknown.
ABUT_HD constexpr shared_corners corners_in_general_position(const triangle<double>& s, const triangle<double>& t) {
    const edges_of<true, double> of_s(s), of_t(t);
    const vec3<double> to_s = between(t.a, s.a), to_t = between(s.a, t.a);
    const double apart = magnitudes(to_s);
    if (!(apart + (of_s.size + of_t.size) < difference_limit<double>)) return shared_corners::unknown();
    const vec3<double> m = of_t.normal(), n = of_s.normal();
    const heights<double> p{dot(m, to_s), dot(m, between(t.a, s.b)), dot(m, between(t.a, s.c)),
                            of_t.product * (apart + of_s.size) + flushed<double>};
    const heights<double> q{dot(n, to_t), dot(n, between(s.a, t.b)), dot(n, between(s.a, t.c)),
                            of_s.product * (apart + of_t.size) + flushed<double>};
    if (!(least(p.certainty(), q.certainty()) > 0)) return shared_corners::unknown();
    const unsigned above_s = p.above(), above_t = q.above();
    if (above_s == 0 || above_s == 0b111 || above_t == 0 || above_t == 0b111) return {};
    const lone_corner k(above_s, above_t), l(above_t, above_s);
    const vec3<double> alone = corner(s, k.alone), other = corner(t, l.alone), across = between(alone, other);
    const vec3<double> by_next = cross(between(alone, corner(s, k.next)), across);
    const vec3<double> by_last = cross(between(alone, corner(s, k.last)), across);
    const vec3<double> to_next = between(alone, corner(t, l.next)), to_last = between(alone, corner(t, l.last));
    const double next_next = dot(by_next, to_next), next_last = dot(by_next, to_last), last_next = dot(by_last, to_next),
                 last_last = dot(by_last, to_last), distance = magnitudes(across);
    const double error = determinant_error<double> * of_s.size * (distance * (distance + of_t.size)) + flushed<double>;
    if (!(least(least(absolute(next_next), absolute(next_last)), least(absolute(last_next), absolute(last_last))) > error))
        return shared_corners::unknown();
    if (next_next > 0 || last_last < 0) return {};
    const auto side = [](double x) { return x > 0 ? 1 : -1; };
    return shared_by_chords(chord_places(k, 0), chord_places(l, 0), side(next_next), side(next_last), side(last_next),
                            side(last_last), runs_backwards(above_s, above_t));
}
template <scalar T>
ABUT_HD constexpr shared_corners certified_corners(const triangle<T>& s, const triangle<T>& t) {
    if constexpr (std::same_as<T, float>) {
        if (any_subnormal(values_of(s, t).value)) return shared_corners::unknown();
        return corners_in_general_position(widened(s), widened(t));
    } else {
        return corners_in_general_position(s, t);
    }
}

/// Without certificates; leaves `unknown` only spans of exponents beyond 124 bits.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr shared_corners exact_corners(const triangle<T>& s, const triangle<T>& t) {
    if (on_coarse_grid(s, t)) return corners_shared(corners_of<double>(s), corners_of<double>(t));
    return decide_in_limbs<corners_of_triangles>(values_of(s, t).value);
}
/// The last word, as `resolve`.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr shared_corners corners_at_any_span(const triangle<T>& s, const triangle<T>& t) {
    return decide_at_any_span<corners_of_triangles>(values_of(s, t).value);
}

}  // namespace abut::detail
