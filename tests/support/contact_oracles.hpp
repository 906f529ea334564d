// SPDX-License-Identifier: MIT
#pragma once

// What a contact has to be, by definition, in numbers of 300 bits that share no formula with the library's, and by the exact
// predicates. Each check returns null, or words for what is wrong.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <abut/narrow/contact.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/zero_area.hpp>
#include <abut/shape/hull.hpp>

#include "catch.hpp"

namespace abut::test {

using wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<300, boost::multiprecision::digit_base_2, void, std::int32_t, -100000, 100000>,
    boost::multiprecision::et_off>;
using wide_point = vec3<wide>;

template <scalar T>
wide_point widest(const vec3<T>& p) {
    return {wide(p.x), wide(p.y), wide(p.z)};
}

inline wide length_of(const wide_point& v) { return sqrt(dot(v, v)); }

/// By how much a point may be off that is rounded to its scalar.
template <scalar T>
wide rounding_of(const vec3<T>& p) {
    const wide_point q = widest(p);
    return wide(unit_roundoff<T>) * (abs(q.x) + abs(q.y) + abs(q.z)) + 4 * wide(std::numeric_limits<T>::denorm_min());
}

/// The corners of a shape, and the radius around them.
struct wide_hull {
    std::vector<wide_point> corners;
    wide radius = 0;

    wide upper(const wide_point& n) const {
        wide r = dot(n, corners[0]);
        for (const auto& p : corners) r = std::max(r, dot(n, p));
        return r + radius * length_of(n);
    }
    wide lower(const wide_point& n) const { return -upper({-n.x, -n.y, -n.z}); }
};

template <scalar T>
wide_hull hull_of(const triangle<T>& t) {
    return {{widest(t.a), widest(t.b), widest(t.c)}};
}
template <scalar T>
wide_hull hull_of(const segment<T>& s) {
    return {{widest(s.a), widest(s.b)}};
}
template <scalar T>
wide_hull hull_of(const vec3<T>& p) {
    return {{widest(p)}};
}
template <scalar T>
wide_hull hull_of(const sphere<T>& s) {
    return {{widest(s.center)}, wide(s.radius)};
}
template <scalar T>
wide_hull hull_of(const capsule<T>& s) {
    return {{widest(s.axis.a), widest(s.axis.b)}, wide(s.radius)};
}
template <scalar T>
wide_hull hull_of(const aabb<T>& box) {
    wide_hull h;
    for (int k = 0; k < 8; ++k) {
        h.corners.push_back(widest(vec3<T>{k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y,
                                           k & 4 ? box.upper.z : box.lower.z}));
    }
    return h;
}

template <scalar T>
wide_hull hull_of(const hull<T>& h) {
    wide_hull r;
    for (std::size_t i = 0; i < h.count; ++i) r.corners.push_back(widest(h[i]));
    return r;
}

/// How far a has to go along n, of any length, to be apart from b.
inline wide overlap_along(const wide_hull& a, const wide_hull& b, const wide_point& n) {
    return (b.upper(n) - a.lower(n)) / length_of(n);
}

/// The distance of a point from the hull of up to three corners.
inline wide distance_from(const wide_point& x, const wide_hull& h) {
    wide least = -1;
    const auto offer = [&](const wide_point& y) {
        const wide d = length_of(x - y);
        if (least < 0 || d < least) least = d;
    };
    for (const auto& p : h.corners) offer(p);
    for (std::size_t i = 0; i < h.corners.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const wide_point e = h.corners[j] - h.corners[i];
            const wide square = dot(e, e);
            if (square == 0) continue;
            const wide s = dot(e, x - h.corners[i]) / square;
            if (s > 0 && s < 1) offer(h.corners[i] + s * e);
        }
    }
    if (h.corners.size() == 3) {
        const wide_point ab = h.corners[1] - h.corners[0], ac = h.corners[2] - h.corners[0], ax = x - h.corners[0];
        const wide_point n = cross(ab, ac);
        const wide square = dot(n, n);
        if (square > 0) {
            const wide v = dot(cross(ax, ac), n) / square, w = dot(cross(ab, ax), n) / square;
            if (v >= 0 && w >= 0 && v + w <= 1) offer(h.corners[0] + v * ab + w * ac);
        }
    }
    return least > h.radius ? least - h.radius : wide(0);
}
template <scalar T>
wide distance_from(const wide_point& x, const aabb<T>& box) {
    const auto beyond = [](const wide& v, T low, T high) { return v < low ? low - v : v > high ? v - high : wide(0); };
    return length_of({beyond(x.x, box.lower.x, box.upper.x), beyond(x.y, box.lower.y, box.upper.y),
                      beyond(x.z, box.lower.z, box.upper.z)});
}
/// Of the origin from the hull of some points that it is not in.
inline wide square_of_gap(const std::vector<wide_point>& w) {
    wide least = -1;
    const auto offer = [&](const wide_point& q) {
        const wide square = dot(q, q);
        if (least < 0 || square < least) least = square;
    };
    for (std::size_t i = 0; i < w.size(); ++i) {
        offer(w[i]);
        for (std::size_t j = i + 1; j < w.size(); ++j) {
            const wide_point e = w[j] - w[i];
            const wide ee = dot(e, e), s = -dot(e, w[i]);
            if (s > 0 && s < ee) offer(w[i] + (s / ee) * e);
            for (std::size_t k = j + 1; k < w.size(); ++k) {
                const wide_point f = w[k] - w[i];
                const wide ff = dot(f, f), ef = dot(e, f), t = -dot(f, w[i]), d = ee * ff - ef * ef;
                if (!(d > 0)) continue;
                const wide u = (s * ff - t * ef) / d, v = (t * ee - s * ef) / d;
                if (u > 0 && v > 0 && u + v < 1) offer(w[i] + u * e + v * f);
            }
        }
    }
    return least;
}

template <scalar T>
std::vector<wide_point> differences(const std::vector<vec3<T>>& a, const std::vector<vec3<T>>& b) {
    std::vector<wide_point> w;
    for (const vec3<T>& p : a) {
        for (const vec3<T>& q : b) w.push_back(widest(q) - widest(p));
    }
    return w;
}

/// x has coordinates of type T.
template <scalar T>
wide distance_from(const wide_point& x, const hull<T>& h) {
    const vec3<T> p{static_cast<T>(x.x), static_cast<T>(x.y), static_cast<T>(x.z)};
    if (intersects<exact>(h, p)) return 0;
    std::vector<wide_point> w;
    for (const wide_point& q : hull_of(h).corners) w.push_back(q - x);
    return sqrt(square_of_gap(w));
}

template <class S>
wide distance_from(const wide_point& x, const S& s) {
    return distance_from(x, hull_of(s));
}

// --- moved along the normal, as a caller would, each operation rounded ----------------------------------------------------

template <scalar T>
vec3<T> moved_by(const vec3<T>& p, const vec3<T>& n, T by) {
    const volatile T x = n.x * by, y = n.y * by, z = n.z * by;
    const volatile T px = p.x + x, py = p.y + y, pz = p.z + z;
    return {px, py, pz};
}
template <scalar T>
triangle<T> moved_by(const triangle<T>& t, const vec3<T>& n, T by) {
    return {moved_by(t.a, n, by), moved_by(t.b, n, by), moved_by(t.c, n, by)};
}
template <scalar T>
segment<T> moved_by(const segment<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.a, n, by), moved_by(s.b, n, by)};
}
template <scalar T>
sphere<T> moved_by(const sphere<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.center, n, by), s.radius};
}
template <scalar T>
capsule<T> moved_by(const capsule<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.axis, n, by), s.radius};
}
template <scalar T>
aabb<T> moved_by(const aabb<T>& s, const vec3<T>& n, T by) {
    return {moved_by(s.lower, n, by), moved_by(s.upper, n, by)};
}

/// Of points that live until the next call.
template <scalar T>
hull<T> moved_by(const hull<T>& h, const vec3<T>& n, T by) {
    static thread_local std::vector<vec3<T>> points;
    points.clear();
    for (std::size_t i = 0; i < h.count; ++i) points.push_back(moved_by(h[i], n, by));
    return hull<T>(points.data(), points.size());
}

template <class S>
bool is_finite_shape(const S& s) {
    return detail::is_finite(detail::contact_math::magnitude_of(s));
}

/// Worst figures seen, as fractions of contact_bound.
struct contact_tally {
    std::uint64_t touching = 0, moved = 0;
    double gap = 0, depth = 0, excess = 0, length = 0;

    contact_tally& operator+=(const contact_tally& t) {
        touching += t.touching;
        moved += t.moved;
        gap = std::max(gap, t.gap);
        depth = std::max(depth, t.depth);
        excess = std::max(excess, t.excess);
        length = std::max(length, t.length);
        return *this;
    }
};

/// Where a test ends: nearly all contacts could be moved apart without overflow, and there were enough of them.
inline void check_total(const char* name, const contact_tally& tally, std::uint64_t at_least) {
    std::printf("%s: %llu contacts; of contact_bound, gaps take %.3f, overlaps %.3f, depths %.3f\n", name,
                static_cast<unsigned long long>(tally.touching), tally.gap, tally.excess, tally.depth);
    CHECK(tally.touching > at_least);
    CHECK(tally.moved > tally.touching / 10 * 9);
}

/// What holds of the contact of any two shapes but planes.
template <class S, class U, scalar T>
const char* wrong_with(const S& s, const U& t, const contact<T>& c, contact_tally& tally) {
    ++tally.touching;
    for (const T x : {c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z, c.depth}) {
        if (!detail::is_finite(x)) return "a number is not finite";
    }
    if (c.a != 0 || c.b != 0) return "ids are not 0";
    if (c.depth < 0) return "depth is negative";
    const T bound = contact_bound(s, t);
    const wide_point x = widest(c.point), n = widest(c.normal);
    const wide gap = std::max(distance_from(x, s), distance_from(x, t));
    tally.gap = std::max(tally.gap, static_cast<double>(gap / wide(bound)));
    if (gap > wide(bound)) return "the point is off the shapes";
    const wide off = abs(length_of(n) - 1);
    tally.length = std::max(tally.length, static_cast<double>(off / wide(unit_roundoff<T>)));
    if (off > 2 * wide(unit_roundoff<T>)) return "the normal is no unit vector";
    const wide overlap = std::min<wide>(overlap_along(hull_of(s), hull_of(t), n), wide(largest_finite<T>));  // it saturates
    tally.excess = std::max(tally.excess, static_cast<double>(abs(overlap - wide(c.depth)) / wide(bound)));
    if (abs(overlap - wide(c.depth)) > wide(bound)) return "depth is not the overlap along the normal";
    const S moved = moved_by(s, c.normal, static_cast<T>(c.depth + bound));
    if (c.depth < largest_finite<T> && is_finite_shape(moved)) {
        ++tally.moved;
        if (intersects<exact>(moved, t)) return "the moved pair is not disjoint";
    }
    return nullptr;
}

/// The exact normal of a triangle, of any length; 0 if its corners are on a line.
template <scalar T>
wide_point wide_normal(const triangle<T>& t) {
    const wide_point a = widest(t.a);
    return cross(widest(t.b) - a, widest(t.c) - a);
}

/// Whether a triangle's normal is known in these numbers: it has none, or its corners span few enough bits.
template <scalar T>
bool has_known_normal(const triangle<T>& t) {
    const wide_point a = widest(t.a);
    const wide most = length_of(widest(t.b) - a) * length_of(widest(t.c) - a);
    return length_of(wide_normal(t)) > most * wide(0x1p-230) || has_zero_area(t);
}

template <scalar T>
const char* compare_depth(T depth, const wide& least, const wide& bound, contact_tally& tally) {
    const wide off = abs(wide(depth) - std::min<wide>(least, wide(largest_finite<T>)));  // it saturates
    tally.depth = std::max(tally.depth, static_cast<double>(off / bound));
    return off > bound ? "depth is not the least of those that it is documented to be the least of" : nullptr;
}

/// The least overlap along directions of any length, both ways; none where all are 0.
class least_of {
public:
    template <class S, class U>
    least_of(const S& s, const U& t) : a_(hull_of(s)), b_(hull_of(t)) {}
    void offer(const wide_point& n) {
        if (length_of(n) == 0) return;
        for (const wide_point& d : {n, wide_point{-n.x, -n.y, -n.z}}) {
            const wide overlap = overlap_along(a_, b_, d);
            if (least_ < 0 || overlap < least_) least_ = overlap;
        }
    }
    [[nodiscard]] bool none() const { return least_ < 0; }
    [[nodiscard]] wide value() const { return least_; }

private:
    wide_hull a_, b_;
    wide least_ = -1;
};

/// Along face normals of two hulls whose cores touch, and across an edge of each: all planes through three corners and all
/// lines through two, since other directions are no wrong ones.
inline void offer_all_features(least_of& least, const wide_hull& a, const wide_hull& b) {
    std::vector<wide_point> edges[2];
    for (const wide_hull* h : {&a, &b}) {
        const auto& p = h->corners;
        for (std::size_t i = 0; i < p.size(); ++i) {
            for (std::size_t j = i + 1; j < p.size(); ++j) {
                edges[h == &b].push_back(p[j] - p[i]);
                for (std::size_t k = j + 1; k < p.size(); ++k) least.offer(cross(p[j] - p[i], p[k] - p[i]));
            }
        }
    }
    for (const wide_point& e : edges[0]) {
        for (const wide_point& f : edges[1]) least.offer(cross(e, f));
    }
}

/// Along face normals of either triangle.
template <scalar T>
const char* wrong_with_depth(const triangle<T>& s, const triangle<T>& t, const contact<T>& c, contact_tally& tally) {
    if (!has_known_normal(s) || !has_known_normal(t)) return nullptr;
    least_of least(s, t);
    if (!has_zero_area(s)) least.offer(wide_normal(s));
    if (!has_zero_area(t)) least.offer(wide_normal(t));
    if (least.none()) return nullptr;
    return compare_depth(c.depth, least.value(), wide(contact_bound(s, t)), tally);
}

/// Along the box's axes and the triangle's normal.
template <scalar T>
const char* wrong_with_depth(const aabb<T>& s, const triangle<T>& t, const contact<T>& c, contact_tally& tally) {
    if (!has_known_normal(t)) return nullptr;
    least_of least(s, t);
    if (!has_zero_area(t)) least.offer(wide_normal(t));
    for (const wide_point& axis : {wide_point{1, 0, 0}, wide_point{0, 1, 0}, wide_point{0, 0, 1}}) least.offer(axis);
    return compare_depth(c.depth, least.value(), wide(contact_bound(s, t)), tally);
}

/// The distance of a segment from a triangle.
inline wide segment_distance(const wide_hull& s, const wide_hull& t) {
    wide least = -1;
    const auto offer = [&](const wide& d) {
        if (least < 0 || d < least) least = d;
    };
    for (const auto& p : s.corners) offer(distance_from(p, {t.corners}));
    for (const auto& p : t.corners) offer(distance_from(p, {s.corners}));
    const wide_point &p = s.corners[0], &q = s.corners[1], u = q - p;
    for (std::size_t i = 0; i < 3; ++i) {
        const wide_point &a = t.corners[i], &b = t.corners[(i + 1) % 3], v = b - a, n = cross(u, v);
        const wide square = dot(n, n);
        if (square == 0) continue;
        const wide x = dot(cross(a - p, v), n) / square, y = dot(cross(a - p, u), n) / square;
        if (x >= 0 && x <= 1 && y >= 0 && y <= 1) offer(length_of(p + x * u - a - y * v));
    }
    const wide_point n = cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    const wide from = dot(n, p - t.corners[0]), to = dot(n, q - t.corners[0]);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) offer(distance_from(p + from / (from - to) * u, {t.corners}));
    return least;
}

/// Of all directions: straight away; or out of the polytope of differences, if the axis meets the triangle.
template <scalar T>
const char* wrong_with_depth(const capsule<T>& s, const triangle<T>& t, const contact<T>& c, contact_tally& tally) {
    const wide bound = wide(contact_bound(s, t)), distance = segment_distance(hull_of(s), hull_of(t));
    if (distance > bound / 1000) return compare_depth(c.depth, wide(s.radius) - distance, bound, tally);
    least_of least(s, t);
    if (!has_known_normal(t) || has_zero_area(t)) return nullptr;
    least.offer(wide_normal(t));
    const wide_point along = widest(s.axis.b) - widest(s.axis.a);
    least.offer(cross(along, widest(t.b) - widest(t.a)));
    least.offer(cross(along, widest(t.c) - widest(t.b)));
    least.offer(cross(along, widest(t.a) - widest(t.c)));
    return compare_depth(c.depth, least.value(), bound, tally);
}

/// Of all directions.
template <scalar T, class U>
    requires(!detail::pair_of_round_contact<sphere<T>, U>)
const char* wrong_with_depth(const sphere<T>& s, const U& t, const contact<T>& c, contact_tally& tally) {
    const wide_hull h = hull_of(t);
    const wide distance = distance_from(widest(s.center), {h.corners}), least = wide(s.radius) + h.radius - distance;
    if constexpr (std::same_as<U, triangle<T>>) {
        const wide farther = length_of(widest(c.point) - widest(s.center)) - distance;
        if (farther > wide(contact_bound(s, t))) return "the point is not the nearest one";
    }
    return compare_depth(c.depth, least, wide(contact_bound(s, t)), tally);
}
template <scalar T>
const char* wrong_with_depth(const vec3<T>& s, const triangle<T>& t, const contact<T>& c, contact_tally& tally) {
    return compare_depth(c.depth, wide(0), wide(contact_bound(s, t)), tally);
}
template <scalar T>
const char* wrong_with_depth(const segment<T>& s, const triangle<T>& t, const contact<T>& c, contact_tally& tally) {
    return wrong_with_depth(triangle<T>{s.a, s.b, s.b}, t, c, tally);
}

/// The least distance of the cores, less which the radii are.
template <class S, class U, scalar T>
    requires detail::pair_of_round_contact<S, U>
const char* wrong_with_depth(const S& s, const U& t, const contact<T>& c, contact_tally& tally) {
    const wide_hull a = hull_of(s), b = hull_of(t);
    const wide_hull flat{{b.corners.front(), b.corners.back(), b.corners.back()}};
    const wide distance = segment_distance({{a.corners.front(), a.corners.back()}}, flat);
    return compare_depth(c.depth, a.radius + b.radius - distance, wide(contact_bound(s, t)), tally);
}
/// Along the axes alone.
template <scalar T, class U>
    requires(std::same_as<U, aabb<T>> || std::same_as<U, vec3<T>> || std::same_as<U, segment<T>>)
const char* wrong_with_depth(const aabb<T>& s, const U& t, const contact<T>& c, contact_tally& tally) {
    least_of least(s, t);
    for (const wide_point& axis : {wide_point{1, 0, 0}, wide_point{0, 1, 0}, wide_point{0, 0, 1}}) least.offer(axis);
    return compare_depth(c.depth, least.value(), wide(contact_bound(s, t)), tally);
}

/// Of all directions: straight away; or out of the sum of the box and the axis, if they meet.
template <scalar T, class U>
    requires requires(const U& t) { t.radius; }
const char* wrong_with_depth(const aabb<T>& s, const U& t, const contact<T>& c, contact_tally& tally) {
    const wide_hull box = hull_of(s), h = hull_of(t);
    const auto core = detail::core_of(t);
    const segment<T> axis{core.at[0], core.at[detail::corners_of_core<U> - 1]};
    const wide bound = wide(contact_bound(s, t));
    const wide_hull flat{{widest(axis.a), widest(axis.b), widest(axis.b)}};
    wide distance = std::min(distance_from(widest(axis.a), s), distance_from(widest(axis.b), s));
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t along = 1; along < 8; along *= 2) {
            if ((i & along) != 0) continue;
            distance = std::min(distance, segment_distance({{box.corners[i], box.corners[i | along]}}, flat));
        }
    }
    const bool meet = intersects<exact>(s, axis);
    if (!meet && distance > bound / 1000) return compare_depth(c.depth, wide(t.radius) - distance, bound, tally);
    if (!meet) return nullptr;
    least_of least(s, t);
    const wide_point d = widest(axis.b) - widest(axis.a);
    for (const wide_point& e : {wide_point{1, 0, 0}, wide_point{0, 1, 0}, wide_point{0, 0, 1}}) {
        least.offer(e);
        least.offer(cross(e, d));
    }
    return compare_depth(c.depth, least.value(), bound, tally);
}

/// A plane and another shape, whose first corner is what it has of a plane that is everything.
template <scalar T, class U>
const char* wrong_with(const plane<T>& s, const U& t, const contact<T>& c, contact_tally& tally) {
    ++tally.touching;
    const wide_point given = widest(s.normal), n = widest(c.normal);
    const wide length = length_of(given), bound = wide(contact_bound(s, t));
    const wide_hull h = hull_of(t);
    if (length == 0) {
        const bool in_shape = distance_from(widest(c.point), t) == 0;
        const bool as_said = in_shape && c.normal == vec3<T>{0, 0, 1} && c.depth == largest_finite<T>;
        return as_said ? nullptr : "not what is said of planes of normal 0";
    }
    const auto height = [&](const wide_point& p) -> wide { return (dot(given, p) - wide(s.offset)) / length; };
    const wide gap = std::max<wide>(distance_from(widest(c.point), t), abs(height(widest(c.point))));
    // The foot of a round shape may lie where T has no number.
    const bool is_there = detail::contact_math::magnitude_of(c.point) < largest_finite<T>;
    if (gap > bound && is_there) return "the point is off the shapes";
    if (abs(length_of(n) - 1) > 2 * wide(unit_roundoff<T>)) return "the normal is no unit vector";
    if (is_there) tally.gap = std::max(tally.gap, static_cast<double>(gap / bound));
    const wide above = (h.upper(given) - wide(s.offset)) / length, below = (h.lower(given) - wide(s.offset)) / length;
    const char* wrong = compare_depth(c.depth, std::min<wide>(above, -below), bound, tally);
    if (wrong != nullptr) return wrong;
    ++tally.moved;
    const U moved = moved_by(t, vec3<T>{-c.normal.x, -c.normal.y, -c.normal.z}, c.depth + contact_bound(s, t));
    if (is_finite_shape(moved) && intersects<exact>(s, moved)) return "the moved pair is not disjoint";
    return nullptr;
}
template <scalar T, class U>
const char* wrong_with_depth(const plane<T>&, const U&, const contact<T>&, contact_tally&) {
    return nullptr;  // in wrong_with
}

/// Both orders of a pair, and what is said of contacts in each.
template <class S, class U>
const char* check_contact(const S& s, const U& t, contact_tally& tally) {
    const auto c = contact_of(s, t);
    const auto back = contact_of(t, s);
    const bool touch = intersects<exact>(s, t);
    if (c.has_value() != touch || back.has_value() != touch) return "found is not what touches";
    if (!touch) return nullptr;
    if constexpr (!std::same_as<S, U>) {
        if (back.value() != detail::reversed(c.value())) return "the other order is not the reverse";
    }
    const char* wrong = wrong_with(s, t, *c, tally);
    return wrong != nullptr ? wrong : wrong_with_depth(s, t, *c, tally);
}

/// Pairs of a family until enough of them touch. `make(i)` is called with pair(s, t).
template <class Make>
contact_tally check_family(const std::string& name, std::uint64_t wanted, const Make& make) {
    contact_tally tally;
    for (std::uint64_t i = 0; i < 12 * wanted && tally.touching < wanted; ++i) {
        const auto p = make(i);
        const char* const wrong = check_contact(p.first, p.second, tally);
        if (wrong != nullptr) FAIL_CHECK(name << ", pair " << i << ": " << wrong);
    }
    if (std::getenv("ABUT_VERBOSE") != nullptr) {
        std::printf("%-28s %5llu touch, %5llu moved, gap %.3f, overlap %.3f, depth %.3f, length %.3f\n", name.c_str(),
                    static_cast<unsigned long long>(tally.touching), static_cast<unsigned long long>(tally.moved), tally.gap,
                    tally.excess, tally.depth, tally.length);
    }
    INFO(name);
    CHECK(tally.touching > 0);
    return tally;
}

}  // namespace abut::test
