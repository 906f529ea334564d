// SPDX-License-Identifier: MIT
#pragma once

// The first stage of distances and contacts between points, segments, spheres, capsules and boxes: closed forms in plain
// doubles, each operation rounded by itself, so that all compilers and devices find the same numbers, and all choose alike
// whether those are good enough. Where they are not, what nearest_ways.hpp and round_contact.hpp compute is the answer. Not
// for decisions that rounding leaves open: those are left open here too.
//
// Let a0, e and b0, f be the first ends and the edges of both axes, d the way from a0 to b0, and
//     w(s, t) = d + t f - s e,    s, t in [0, 1],
// which is least for s from the lines' nearest points, t from the foot of that, and s from the foot of that, each brought
// to [0, 1] (C. Ericson, Real-Time Collision Detection (2005), 5.1.9). Why a way that passes is good enough: u = 2^-53; D is
// the largest distance of two points of both shapes, so that d and way are no longer than D, and e and f than 2D.
//
// Whatever s and t are, they name two points of the cores. Rounding d (uD), e and f (2uD each), their products (2uD each),
// and the sums (uD each) leaves w within 11uD of the way between these. Its length is within 2.5u of itself, radii add 2uD:
// the distance is no more than 15.5uD below the true one.
//
// Nor is it above. Let r bound what is left of the slope, |w.e| / |e| for s inside, or what of it leads into [0, 1] at its
// ends, and alike of f. For the least w* and v = w - w*, convexity gives |w|^2 - |w*|^2 = 2 w.v - |v|^2, and w.v is no more
// than r (|ds e| + |dt f|) <= 2 r |v| / sin, where sin is that of the angle between the axes. So the difference is below
// 4 r^2 / sin^2. With r <= 2^-48 size <= 2^-44 D, sin^2 >= 2^-10 and |w| >= 2^-20 size the way is longer than the least one
// by less than u D / 16. Here `size` is the sum of the magnitudes of d, e, f and of the radii: D <= size <= 10D.
//
// Axes at smaller angles are tried at their ends, where each foot is well-conditioned, and the way w from there, taken
// orthogonal to edges inside which it ends, bounds all others by the same convexity: none is shorter by more than the sum of
// |w.e| and |w.f|, as far as they lead into [0, 1], over |w|. That is to be no more than size u / 4. Axes that cross are
// left.
//
// So shapes are surely apart, or surely touch, where length and radii differ by more than 16u size.
//
// Sizes are between 2^-200 and 2^200 (of float 2^100, so that points do not leave its range), and axes not below 2^-30 of
// that, or nothing is said: what underflows is nothing beside the rest.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/aabb_sphere.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/form.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// y - x in double, rounded once. In constant expressions, where nothing may overflow, a number that is as far out of range.
/// Hidden from a compiler that would read two coordinates at once, which waits long where a caller has just written them.
template <scalar T>
ABUT_HD constexpr double plain_step_from(T x, T y) {
    const auto from = static_cast<double>(x), to = static_cast<double>(y);
    if (ABUT_CONSTANT_EVALUATED() && absolute(to / 4 - from / 4) > 0x1p900) return 0x1p900;
    return rounded(plain_sum(to, -from));
}
template <scalar T>
ABUT_HD constexpr vec3<double> plain_way_to(const vec3<T>& from, const vec3<T>& to) {
    return {plain_step_from(from.x, to.x), plain_step_from(from.y, to.y), plain_step_from(from.z, to.z)};
}

/// x v, coordinate by coordinate.
ABUT_HD constexpr vec3<double> plain_times(double x, const vec3<double>& v) {
    return {plain_product(x, v.x), plain_product(x, v.y), plain_product(x, v.z)};
}

ABUT_HD constexpr double plain_magnitudes(const vec3<double>& v) {
    return plain_sum(plain_sum(absolute(v.x), absolute(v.y)), absolute(v.z));
}
/// Whether nothing leaves the range that is computed from lengths of this sum.
template <scalar T>
ABUT_HD constexpr bool are_plain_sizes(double size) {
    return size > 0x1p-200 && size < (std::same_as<T, float> ? 0x1p100 : 0x1p200);
}

/// x where it lies in [0, 1], or the end that it is beyond; 0 for NaN. Hidden, so that what asks for the ends later does not
/// become branches here, which nobody can predict.
ABUT_HD constexpr double into_unit_of_doubles(double x) { return rounded(least(greatest(x, 0.0), 1.0)); }

/// Two cores of one or two corners, the one of fewer first, and the least way from the first to the second.
template <int N, int M>
struct plain_cores {
    vec3<double> d, e{0, 0, 0}, f{0, 0, 0};
    double ee = 0, ef = 0, ff = 0;                      ///< products of edges
    double per_ee = 0, per_ff = 0, per_determinant = 0;  ///< 1 / them
    double part_a = 0, part_b = 0;                                ///< where it begins and ends, in parts of the edges
    vec3<double> way;
    double length = 0, size;
    bool is_good = false;

    template <scalar T>
    ABUT_INLINE ABUT_HD constexpr plain_cores(const corner_hull<T, N>& a, const corner_hull<T, M>& b, double radii)
        : d(plain_way_to(a.at[0], b.at[0])), way(d), size(plain_sum(plain_magnitudes(d), radii)) {
        using contact_math::plain_dot;
        if constexpr (M > 1) {
            f = plain_way_to(b.at[0], b.at[M - 1]);
            size = plain_sum(size, plain_magnitudes(f));
        }
        if constexpr (N > 1) {
            e = plain_way_to(a.at[0], a.at[N - 1]);
            size = plain_sum(size, plain_magnitudes(e));
        }
        if (!are_plain_sizes<T>(size)) return;
        const double all = plain_product(size, size);
        is_good = true;
        if constexpr (M > 1) {
            ff = plain_dot(f, f);
            per_ff = inverse(ff);
            is_good = ff > 0x1p-60 * all;
            const double df = plain_dot(d, f);
            if constexpr (N > 1) {
                ee = plain_dot(e, e);
                per_ee = inverse(ee);
                ef = plain_dot(e, f);
                const double de = plain_dot(d, e), whole = plain_product(ee, ff);
                const double determinant = plain_sum(whole, -plain_product(ef, ef));
                per_determinant = inverse(determinant);
                const double first = plain_sum(plain_product(de, ff), -plain_product(df, ef));
                part_a = into_unit_of_doubles(plain_product(first, per_determinant));
                part_b = into_unit_of_doubles(plain_product(plain_sum(plain_product(part_a, ef), -df), per_ff));
                part_a = into_unit_of_doubles(plain_product(plain_sum(plain_product(part_b, ef), de), per_ee));
                way = plain_step(plain_step(d, part_b, f), -part_a, e);
                is_good = is_good && ee > 0x1p-60 * all;
                if (determinant >= 0x1p-10 * whole) {
                    const double most = 0x1p-96 * all, of_e = slope_a(way), of_f = slope_b(way);
                    is_good = is_good && of_e * of_e <= most * ee && of_f * of_f <= most * ff;
                } else if (is_good) {
                    plain_cores ends = *this;  // a copy, so that this need not lie in memory
                    is_good = ends.take_ends(de, df);
                    part_a = ends.part_a, part_b = ends.part_b, way = ends.way;
                }
            } else {
                part_b = into_unit_of_doubles(-plain_product(df, per_ff));
                way = plain_step(d, part_b, f);
            }
        }
        const double square = plain_dot(way, way);
        is_good = is_good && square > 0x1p-40 * all;
        if (!is_good) return;
        length = contact_math::root(contact_math::one_double{square}).high;
    }

    /// The way again, orthogonal to edges inside which it ends but for roundings of its own length.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<double> straightened() const {
        using contact_math::plain_dot;
        if constexpr (M == 1) return way;
        // Of edges inside which it does not end nothing counts. Without branches, which nobody can predict.
        const double on_b = (part_b > 0) & (part_b < 1), rest_f = plain_product(on_b, plain_dot(way, f));
        if constexpr (N == 1) return plain_step(way, -plain_product(rest_f, per_ff), f);
        const double on_a = (part_a > 0) & (part_a < 1), rest_e = plain_product(on_a, plain_dot(way, e));
        const double both = on_a * on_b, mixed = plain_product(both, ef);
        const double per =
            plain_sum(plain_product(both, per_determinant), plain_product(1 - both, plain_product(per_ee, per_ff)));
        const double of_e = plain_sum(plain_product(rest_e, ff), -plain_product(rest_f, mixed));
        const double of_f = plain_sum(plain_product(rest_e, mixed), -plain_product(rest_f, ee));
        return plain_step(plain_step(way, plain_product(of_f, per), f), -plain_product(of_e, per), e);
    }
    /// How far a has to go along n to be apart from b, but for radii.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double overlap(const vec3<double>& n) const {
        double most = contact_math::plain_dot(n, d);
        if constexpr (M > 1) most = plain_sum(most, greatest(contact_math::plain_dot(n, f), 0.0));
        if constexpr (N > 1) most = plain_sum(most, -least(contact_math::plain_dot(n, e), 0.0));
        return most;
    }

private:
    /// 1 / x, where that is in range.
    ABUT_HD static constexpr double inverse(double x) { return x > 0x1p-900 ? 1 / x : 0; }
    /// Of axes that are nearly parallel, the least way from an end. Whether it is the least of all.
    ABUT_NOINLINE ABUT_HD constexpr bool take_ends(double de, double df) {
        double least_square = infinity<double>;
        const auto offer = [&](double at_a, double at_b) {
            const vec3<double> w = plain_step(plain_step(d, at_b, f), -at_a, e);
            const double square = contact_math::plain_dot(w, w);
            if (square < least_square) least_square = square, way = w, part_a = at_a, part_b = at_b;
        };
        for (int end = 0; end < 2; ++end) {
            offer(end, into_unit_of_doubles(plain_product(plain_sum(end * ef, -df), per_ff)));
            offer(into_unit_of_doubles(plain_product(plain_sum(end * ef, de), per_ee)), end);
        }
        const vec3<double> w = straightened();
        const double slopes = plain_sum(absolute(slope_a(w)), absolute(slope_b(w))), most = 0x1p-55 * size;
        return slopes * slopes <= most * most * least_square;
    }
    /// What is left of the slopes along the edges.
    ///@{
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double slope_a(const vec3<double>& w) const { return slope(contact_math::plain_dot(w, e), part_a); }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double slope_b(const vec3<double>& w) const { return slope(-contact_math::plain_dot(w, f), part_b); }
    ///@}
    /// What is left of a slope that should be 0, or at 0 not above, or at 1 not below.
    ABUT_INLINE ABUT_HD static constexpr double slope(double x, double at) {
        return least(greatest(x, at <= 0 ? 0 : -infinity<double>), at >= 1 ? 0 : infinity<double>);
    }
};

/// What a pair of shapes knows of the way between their cores: `length`, `size` and `way`, and whether these are good.
struct plain_gap {
    double radius_a, radius_b, length = 0, size = 0;
    bool is_good = false;

    [[nodiscard]] ABUT_HD constexpr double radii() const { return plain_sum(radius_a, radius_b); }
    /// Whether the shapes touch, where that is sure.
    [[nodiscard]] ABUT_HD constexpr verdict touch() const {
        if (!is_good) return verdict::unknown;
        const double gap = plain_sum(length, -radii()), open = 0x1p-49 * size;
        return gap > open ? verdict::no : gap < -open ? verdict::yes : verdict::unknown;
    }
};

/// A point that is not rounded: from a corner of a shape.
template <scalar T>
struct plain_place {
    vec3<T> from;
    vec3<double> along{0, 0, 0};

    /// Rounded, and so far along a way from there.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<T> at(double part, const vec3<double>& way) const {
        const vec3<double> v = part == 0 ? along : plain_step(along, part, way);
        const auto one = [](T x, double step) { return rounded(static_cast<T>(plain_sum(static_cast<double>(x), step))); };
        return {one(from.x, v.x), one(from.y, v.y), one(from.z, v.z)};
    }
};

/// Of shapes in the order of their contacts.
template <class S, class U>
struct plain_pair;

/// Points, segments, spheres and capsules.
template <class S, class U>
    requires(corners_of_core<S> >= 1 && corners_of_core<S> <= corners_of_core<U> && corners_of_core<U> <= 2 &&
             std::same_as<scalar_type_of<S>, scalar_type_of<U>>)
struct plain_pair<S, U> : plain_gap {
    using T = scalar_type_of<S>;
    plain_cores<corners_of_core<S>, corners_of_core<U>> cores;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const S& s, const U& t)
        : plain_gap{static_cast<double>(radius_around_core(s)), static_cast<double>(radius_around_core(t))},
          cores(core_of(s), core_of(t), plain_step_from(-radius_a, radius_b)) {
        length = cores.length, size = cores.size, is_good = cores.is_good;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return cores.way; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_a(const S& s) const {
        return place_in(core_of(s), cores.part_a, cores.e);
    }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const {
        return place_in(core_of(t), cores.part_b, cores.f);
    }

private:
    template <int N>
    ABUT_INLINE ABUT_HD static constexpr plain_place<T> place_in(const corner_hull<T, N>& core, double part, const vec3<double>& edge) {
        if constexpr (N == 1) return {core.at[0]};
        const auto from = [&](T first, T last) { return part == 1 ? last : first; };
        const vec3<T>&a = core.at[0], &b = core.at[N - 1];
        return {{from(a.x, b.x), from(a.y, b.y), from(a.z, b.z)}, plain_times(part == 1 ? 0 : part, edge)};
    }
};

/// A box, and a point or a sphere. The way is from the box's point with coordinates of the box or of the centre, and so but
/// rounded once in each coordinate. It has no length if and only if the centre is in the box.
template <scalar T, class U>
    requires(corners_of_core<U> == 1 && std::same_as<scalar_type_of<U>, T>)
struct plain_pair<aabb<T>, U> : plain_gap {
    vec3<T> nearest;
    vec3<double> from_box;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const aabb<T>& s, const U& t)
        : plain_gap{0, static_cast<double>(radius_around_core(t))},
          nearest(nearest_in_box(s, core_of(t).at[0])),
          from_box(plain_way_to(nearest, core_of(t).at[0])) {
        size = plain_step_from(-radius_b, plain_magnitudes(from_box));
        if (!are_plain_sizes<T>(size)) return;
        const double square = contact_math::plain_dot(from_box, from_box);
        length = contact_math::root(contact_math::one_double{square}).high;
        is_good = square > 0x1p-40 * plain_product(size, size);
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return from_box; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_a(const aabb<T>&) const { return {nearest}; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const { return {core_of(t).at[0]}; }
};

/// A box and an edge, seen from where the edge begins, and its place that is nearest to the box: there the slope of the
/// squared distance, which rises along the edge and is straight between the places where coordinates enter or leave the box,
/// passes 0. Only the last test is trusted: as of edges that are nearly parallel, no other way is shorter by more than is
/// left of the slope, over the way's length.
struct plain_box_and_edge {
    vec3<double> lower, upper, e;
    double part = 0, size = 0;
    vec3<double> way{}, ahead{};  ///< the same, orthogonal to the edge inside of which it ends
    bool is_good = false;

    template <scalar T>
    ABUT_NOINLINE ABUT_HD constexpr plain_box_and_edge(const aabb<T>& box, const corner_hull<T, 2>& edge, double radius)
        : lower(plain_way_to(edge.at[0], box.lower)),
          upper(plain_way_to(edge.at[0], box.upper)),
          e(plain_way_to(edge.at[0], edge.at[1])),
          size(plain_step_from(-radius, plain_magnitudes(greatest(absolute(lower), absolute(upper))))) {
        using contact_math::plain_dot;
        size = plain_sum(size, plain_magnitudes(e));
        if (!are_plain_sizes<T>(size)) return;
        double from = 0, to = 1;
        const auto look = [&](double start, double step) {
            const double x = absolute(step) > 0x1p-800 ? start / step : 0;
            if (x > from && x < to) (plain_dot(outside(x), e) <= 0 ? from : to) = x;
        };
        if (plain_dot(outside(0), e) >= 0) {
            to = 0;
        } else if (plain_dot(outside(1), e) <= 0) {
            from = 1;
        } else {
            look(lower.x, e.x), look(upper.x, e.x);
            look(lower.y, e.y), look(upper.y, e.y);
            look(lower.z, e.z), look(upper.z, e.z);
        }
        part = from == 1 ? 1 : 0;
        if (from < to && to > 0 && from < 1) {
            // Straight between both: of the coordinates that are outside in the middle.
            const vec3<double> amid = outside((from + to) / 2);
            double along = 0, square = 0;
            const auto add = [&](double off, double low, double high, double step) {
                if (off == 0) return;
                along = plain_sum(along, plain_product(step, off < 0 ? low : high));
                square = plain_sum(square, plain_product(step, step));
            };
            add(amid.x, lower.x, upper.x, e.x), add(amid.y, lower.y, upper.y, e.y), add(amid.z, lower.z, upper.z, e.z);
            part = square > 0 ? least(greatest(along / square, from), to) : from;
            way = outside(part);
            const vec3<double> active{way.x == 0 ? 0 : e.x, way.y == 0 ? 0 : e.y, way.z == 0 ? 0 : e.z};
            const double active_square = plain_dot(active, active);
            if (!(active_square > 0x1p-900)) return;
            ahead = plain_step(way, -plain_dot(way, active) / active_square, active);
        } else {
            way = ahead = part == 1 ? outside_of(plain_way_to(edge.at[1], box.lower), plain_way_to(edge.at[1], box.upper))
                                    : outside(0);
        }
        const double slope = plain_dot(ahead, e), left = part <= 0   ? least(slope, 0.0)
                                                         : part >= 1 ? greatest(slope, 0.0)
                                                                     : slope;
        const double square = plain_dot(way, way), most = 0x1p-55 * size;
        is_good = left * left <= most * most * square && square > 0x1p-40 * plain_product(size, size) &&
                  ahead.x * way.x >= 0 && ahead.y * way.y >= 0 && ahead.z * way.z >= 0;
    }
    /// How far the box has to go along n.
    [[nodiscard]] ABUT_HD constexpr double overlap(const vec3<double>& n) const {
        const vec3<double> first{n.x > 0 ? lower.x : upper.x, n.y > 0 ? lower.y : upper.y, n.z > 0 ? lower.z : upper.z};
        return plain_sum(greatest(contact_math::plain_dot(n, e), 0.0), -contact_math::plain_dot(n, first));
    }

private:
    /// From the box to a place on the edge, in each coordinate.
    [[nodiscard]] ABUT_HD constexpr vec3<double> outside(double x) const {
        const vec3<double> p = plain_times(x, e);
        return contact_math::plain_difference(p, least(greatest(p, lower), upper));
    }
    ABUT_HD static constexpr vec3<double> outside_of(const vec3<double>& low, const vec3<double>& high) {
        return contact_math::negated(least(greatest(vec3<double>{0, 0, 0}, low), high));
    }
};

/// A box, and a segment or a capsule.
template <scalar T, class U>
    requires(corners_of_core<U> == 2 && std::same_as<scalar_type_of<U>, T>)
struct plain_pair<aabb<T>, U> : plain_gap {
    plain_box_and_edge box;
    vec3<T> start;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const aabb<T>& s, const U& t)
        : plain_gap{0, static_cast<double>(radius_around_core(t))}, box(s, core_of(t), radius_b), start(core_of(t).at[0]) {
        size = box.size, is_good = box.is_good;
        if (is_good) length = contact_math::root(contact_math::one_double{contact_math::plain_dot(box.way, box.way)}).high;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return box.way; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_a(const aabb<T>& s) const {
        plain_place<T> place{start, plain_times(box.part, box.e)};
        const auto hold = [](double off, T low, T high, T& from, double& along) {
            if (off != 0) from = off < 0 ? low : high, along = 0;
        };
        hold(box.way.x, s.lower.x, s.upper.x, place.from.x, place.along.x);
        hold(box.way.y, s.lower.y, s.upper.y, place.from.y, place.along.y);
        hold(box.way.z, s.lower.z, s.upper.z, place.from.z, place.along.z);
        return place;
    }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const {
        const auto core = core_of(t);
        if (box.part == 1) return {core.at[1]};
        return {core.at[0], plain_times(box.part, box.e)};
    }
};

template <class S, class U>
concept has_plain_pair = requires { sizeof(plain_pair<S, U>); };

/// n again, a vector that is a few units of roundoff off from length 1, within 1.5 units. What it is off is n.n - 1, in which
/// squares of halves are exact, and the sums lose 2^-53.
ABUT_INLINE ABUT_HD constexpr vec3<double> plain_unit(const vec3<double>& n) {
    const auto half = [](double x) { return ABUT_BIT_CAST(double, ABUT_BIT_CAST(std::uint64_t, x) & ~std::uint64_t{0x7ffffff}); };
    const vec3<double> h{half(n.x), half(n.y), half(n.z)}, rest = contact_math::plain_difference(n, h);
    const double high = plain_sum(plain_sum(plain_sum(plain_product(h.x, h.x), -1.0), plain_product(h.y, h.y)), plain_product(h.z, h.z));
    const double low = plain_sum(plain_product(2.0, contact_math::plain_dot(h, rest)), contact_math::plain_dot(rest, rest));
    return plain_step(n, -plain_sum(high, low) / 2, n);
}

/// What a closed form knows of two shapes: whether they touch, and if so their contact.
template <scalar T>
struct first_contact {
    verdict touch = verdict::unknown;
    contact<T> found{};
};

/// A unit vector along one whose length is 1 but for a few roundings, as contacts hold it.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr contact_math::point plain_normal(const contact_math::point& n) {
    return std::same_as<T, float> ? contact_math::as_stored_direction<T>(n) : plain_unit(n);
}
template <scalar T>
ABUT_INLINE ABUT_HD constexpr contact<T> plain_contact(const vec3<T>& where, const contact_math::point& n, double depth) {
    const auto one = [](double x) { return static_cast<T>(plain_sum(x, 0.0)); };  // not -0
    return {0, 0, where, {one(n.x), one(n.y), one(n.z)}, rounded(static_cast<T>(greatest(depth, 0.0)))};
}

}  // namespace abut::detail
