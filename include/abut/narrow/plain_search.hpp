// SPDX-License-Identifier: MIT
#pragma once

// How far apart two convex shapes are, and where, by the search of Gilbert, Johnson and Keerthi (predicate/gjk.hpp) in
// doubles whose operations are rounded one by one, which certifies what it ends with. Each shape tells its farthest point
// along a way, and no more. Not for decisions: where this does not know, others are asked.
//
// At any step there are a mean of differences, which is as long as two points of the shapes are far apart, and a way, along
// which no difference is less than the farthest one back. The distance is between both numbers. The search ends where these
// agree to 2^-51 D, so that what is promised of a distance holds, rounding included; or without an answer. So it never
// matters what rounding does to the choice of a feature, or to the way. That is taken from the feature and not from the
// mean: across a face, or an edge, it is known to all digits however near the shapes are.
//
// Points are seen from one of the first shape, and so no farther away than D, but for its own size. Along a way n, two
// points are told by products that are off by less than 4u |n| D each; a place on a rim is known to 8u D. So a lower bound
// is off by less than 2^-47 D, and shapes whose bound is above 2^-43 of `size` are apart for sure.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/predicate/kept_points.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

// --- shapes as seen from some point, which tell any point, and the farthest one along a way of any length ------------------

/// A cylinder or a cone whose axis has a length.
struct plain_solid {
    using point = vec3<double>;
    point axis, end[2];  ///< of a cone the apex first
    double radius, size;
    bool is_cone;

    template <solid_of_revolution S>
    ABUT_HD constexpr plain_solid(const S& s, const point& origin) : radius(s.radius), is_cone(requires { s.apex; }) {
        using namespace contact_math;
        const auto ends = axis_of(s);
        const point first = widened(ends.a), last = widened(ends.b);
        axis = unit_vector(between<one_double>(first, last));
        end[0] = plain_difference(first, origin);
        end[1] = plain_difference(last, origin);
        size = greatest(largest_of(end[0]), largest_of(end[1]), radius);
    }
    [[nodiscard]] ABUT_HD constexpr point farthest(const point& n) const {
        const double first = contact_math::plain_dot(n, end[0]), last = contact_math::plain_dot(n, end[1]);
        const point across = part_across(n, axis);
        const double length = contact_math::root(contact_math::one_double{contact_math::plain_dot(across, across)}).high;
        const int k = plain_sum(last, is_cone ? plain_product(radius, length) : 0) > first ? 1 : 0;
        if ((is_cone && k == 0) || !(length > 0)) return end[k];
        return plain_step(end[k], radius / length, across);
    }
    [[nodiscard]] ABUT_HD constexpr point any() const { return contact_math::middle_of({end[0], end[1]}); }

    /// Where a foot lies: inside of a flat end, on a rim, inside of a side, or at an apex.
    enum class part : unsigned char { disc, rim, side, apex };
    struct foot {
        point at, normal;  ///< outwards, of any length; from a rim or an apex it is the way, and no better known
        part on;
        int of_end;
    };
    /// The foot of a point that is outside.
    [[nodiscard]] ABUT_HD constexpr foot foot_of(const point& p) const {
        using namespace contact_math;
        const point seen = plain_difference(p, end[0]);
        const double s = plain_dot(seen, axis);
        const point across = plain_step(seen, -s, axis);
        const double rho = root(one_double{plain_dot(across, across)}).high;
        const double height = plain_dot(plain_difference(end[1], end[0]), axis);
        const auto at_rim = [&](int k) {
            const point at = plain_step(end[k], rho > 0 ? radius / rho : 0, across);
            return foot{at, plain_difference(p, at), part::rim, k};
        };
        const auto at_disc = [&](int k) {
            const double over = k == 0 ? s : plain_sum(s, -height);
            return foot{plain_step(p, -over, axis), k == 0 ? negated(axis) : axis, part::disc, k};
        };
        if (!is_cone) {
            if (s > 0 && s < height) {
                const double back = rho > radius ? plain_sum(radius / rho, -1.0) : 0;
                return {plain_step(p, back, across), across, part::side, 0};
            }
            const int k = s > 0 ? 1 : 0;
            return rho > radius ? at_rim(k) : at_disc(k);
        }
        if (s > height && !(rho > radius)) return at_disc(1);
        const double ahead = plain_sum(plain_product(s, height), plain_product(rho, radius)),
                     square = plain_sum(plain_product(height, height), plain_product(radius, radius));
        if (!(ahead > 0 && square > 0)) return {end[0], seen, part::apex, 0};
        if (!(ahead < square)) return at_rim(1);
        const double t = ahead / square;
        const point out = rho > 0 ? plain_step({0, 0, 0}, 1 / rho, across) : point{0, 0, 0};
        return {plain_step(plain_step(end[0], plain_product(t, height), axis), plain_product(t, radius), out),
                plain_step(plain_step({0, 0, 0}, height, out), -radius, axis), part::side, 0};
    }
};

/// A line, or a circle, along which the place that is nearest to a solid is looked for: an edge, an axis, a rim.
struct plain_curve {
    using point = vec3<double>;
    point at, along;   ///< where x is 0, and how it goes on there
    point center;      ///< of a circle, of which x is the tangent of an angle
    double lower, upper;
    bool is_circle;

    ABUT_HD static constexpr plain_curve line(const point& a, const point& b) {
        return {a, contact_math::plain_difference(b, a), a, 0, 1, false};
    }
    ABUT_HD static constexpr plain_curve rim(const plain_solid& s, int k, const point& on) {
        return {on, plain_cross(s.axis, contact_math::plain_difference(on, s.end[k])), s.end[k], -1, 1, true};
    }
    [[nodiscard]] ABUT_HD constexpr double place_of(const point& p) const {
        using contact_math::plain_dot;
        if (is_circle) return 0;
        const double x = plain_dot(contact_math::plain_difference(p, at), along) / plain_dot(along, along);
        return x > 0 ? least(x, 1.0) : 0;
    }

    struct place {
        double x, slope;  ///< of the distance, times the length of what is `along`
        point at, along;
        plain_solid::foot foot;
    };
    [[nodiscard]] ABUT_HD constexpr place look(double x, const plain_solid& s) const {
        using namespace contact_math;
        place p{x, 0, plain_step(at, x, along), along, {}};
        if (is_circle) {
            const double stretch = 1 / root(one_double{plain_sum(1.0, plain_product(x, x))}).high;
            const point none{0, 0, 0}, out = plain_difference(at, center);
            p.at = plain_step(plain_step(center, stretch, out), plain_product(stretch, x), along);
            p.along = plain_step(plain_step(none, stretch, along), -plain_product(stretch, x), out);
        }
        p.foot = s.foot_of(p.at);
        const point& n = p.foot.normal;
        const double length = root(one_double{plain_dot(n, n)}).high;
        if (length > 0) p.slope = plain_dot(n, p.along) / length;
        return p;
    }
    /// From a place near by, with the chord of slopes.
    [[nodiscard]] ABUT_HD constexpr place nearest_to(const plain_solid& s, double from) const {
        using namespace contact_math;
        constexpr int most_steps = 7;
        const double square = plain_dot(along, along), enough = 0x1p-51 * root(one_double{square}).high;
        place now = look(from, s);
        if (!(square > 0)) return now;
        const point way = plain_difference(now.at, now.foot.at);
        double step = -plain_product(root(one_double{plain_dot(way, way)}).high, now.slope) / square;
        for (int k = 0; k < most_steps; ++k) {
            const double x = greatest(least(plain_sum(now.x, step), upper), lower);
            if (!(absolute(now.slope) > enough) || !(absolute(plain_sum(x, -now.x)) > 0x1p-50)) break;
            const place next = look(x, s);
            const double bend = plain_sum(now.slope, -next.slope);
            step = bend != 0 ? plain_product(plain_sum(next.x, -now.x), next.slope) / bend : 0;
            now = next;
        }
        return now;
    }
};

/// A box along the axes.
struct plain_box {
    using point = vec3<double>;
    point lower, upper;
    double size;

    template <scalar T>
    ABUT_HD constexpr plain_box(const aabb<T>& box, const point& origin)
        : lower(contact_math::plain_difference(widened(box.lower), origin)),
          upper(contact_math::plain_difference(widened(box.upper), origin)),
          size(greatest(contact_math::largest_of(lower), contact_math::largest_of(upper))) {}
    [[nodiscard]] ABUT_HD constexpr point farthest(const point& n) const {
        return {n.x > 0 ? upper.x : lower.x, n.y > 0 ? upper.y : lower.y, n.z > 0 ? upper.z : lower.z};
    }
    [[nodiscard]] ABUT_HD constexpr point any() const { return contact_math::middle_of({lower, upper}); }
};

/// A few points.
template <int N>
struct plain_core {
    using point = vec3<double>;
    point at[std::size_t{N}]{};
    double size = 0;

    template <scalar T>
    ABUT_HD constexpr plain_core(const vec3<T> (&corner)[std::size_t{N}], const point& origin) {
        for (int i = 0; i < N; ++i) {
            at[i] = contact_math::plain_difference(widened(corner[i]), origin);
            size = greatest(size, contact_math::largest_of(at[i]));
        }
    }
    [[nodiscard]] ABUT_HD constexpr point farthest(const point& n) const {
        int best = 0;
        double most = contact_math::plain_dot(n, at[0]);
        for (int i = 1; i < N; ++i) {
            const double x = contact_math::plain_dot(n, at[i]);
            if (x > most) most = x, best = i;
        }
        return at[best];
    }
    [[nodiscard]] ABUT_HD constexpr point any() const { return contact_math::middle_of({at[0], at[N - 1]}); }
};

/// Points, of any number.
template <scalar T>
struct plain_points {
    using point = vec3<double>;
    const hull<T>& of;
    point origin;
    double size = 0;
    kept_points<double, T> kept;

    ABUT_HD constexpr plain_points(const hull<T>& h, const point& from) : of(h), origin(from), kept(h, decltype(kept)::fewest_climbed_for_numbers) {
        using namespace contact_math;
        kept.see_from(origin);
        size = kept.largest();
        for (std::size_t i = kept.size(); i < h.count; ++i) size = greatest(size, largest_of(seen(i)));
    }
    [[nodiscard]] ABUT_HD constexpr point farthest(const point& n) const {
        const point back = contact_math::negated(n);
        double least = infinity<double>;
        std::uint32_t first = 0;
        kept.look_back(back, least, first);
        for (std::size_t i = kept.size(); i < of.count; ++i) {
            const double x = contact_math::plain_dot(back, seen(i));
            if (x < least) least = x, first = static_cast<std::uint32_t>(i);
        }
        return first < kept.size() ? kept[first] : seen(first);
    }
    [[nodiscard]] ABUT_HD constexpr point any() const { return seen(0); }

private:
    [[nodiscard]] ABUT_HD constexpr point seen(std::size_t i) const {
        return contact_math::plain_difference(widened(of[i]), origin);
    }
};

/// A point that was seen from an origin.
template <scalar T>
ABUT_HD constexpr vec3<T> from_seen(const vec3<double>& origin, const vec3<double>& p) {
    return {rounded_within<T>(plain_sum(origin.x, p.x)), rounded_within<T>(plain_sum(origin.y, p.y)),
            rounded_within<T>(plain_sum(origin.z, p.z))};
}

// --- the search -----------------------------------------------------------------------------------------------------------

/// Where two shapes are nearest, as seen.
struct plain_nearest {
    vec3<double> on_a{0, 0, 0}, on_b{0, 0, 0}, way{0, 0, 0};  ///< from a to b
    vec3<double> along{0, 0, 0};                              ///< as the way, of any length, and better known where that is short
    double length = 0;                                        ///< of the way
    double least = 0;                                         ///< the distance is no less, but for rounding
    double size = 0;                                          ///< no more than D, and not much less
    bool meet = false;                                        ///< seemingly; then on_a and on_b are one point but for rounding
    bool is_sure = false;                                     ///< else it is as long as the distance, as is promised

    /// Whether the point on a is one of both, of shapes that touch.
    [[nodiscard]] ABUT_HD constexpr bool knows_shared_point() const {
        const vec3<double> gap = contact_math::plain_difference(on_a, on_b);
        return is_sure || (meet && contact_math::largest_of(gap) <= 0x1p-51 * size);
    }
    /// Whether they are farther apart than some length, for sure.
    [[nodiscard]] ABUT_HD constexpr bool are_surely_beyond(double far) const {
        return least > plain_sum(far, plain_product(0x1p-43, plain_sum(size, far)));
    }
};

/// What doubles know of a contact: whether two shapes touch, if that is sure; and if they do, it is `found` where that is known.
template <scalar T>
struct contact_in_doubles {
    contact<T> found{};
    verdict touch = verdict::unknown;
    bool is_known = false;
};

/// Of shapes whose cores are found to meet so deep at least, or to be so far apart where there is a radius around one.
ABUT_HD constexpr verdict touch_of_cores(const plain_nearest& nearest, double depth, double radius) {
    const double less = 0x1p-20 * plain_sum(nearest.size, radius);
    return (nearest.meet ? depth : plain_sum(radius, -nearest.length)) > less ? verdict::yes : verdict::unknown;
}

/// Up to four differences of points of b and a, and where their hull is nearest to the origin.
struct plain_simplex {
    using point = vec3<double>;
    point w[4]{}, on_a[4]{}, on_b[4]{};
    double weight[4] = {1, 0, 0, 0};
    int count = 0;
    point mean{0, 0, 0}, along{0, 0, 0};
    double square = infinity<double>;

    enum class result : unsigned char { nearer, no_nearer, holds_origin };
    /// Appends a difference. Of the features with it the nearest one is left, if that is nearer than what was; or all four
    /// corners, if they hold the origin.
    ABUT_HD constexpr result append(const point& p_of_a, const point& p_of_b, const point& difference) {
        w[count] = difference, on_a[count] = p_of_a, on_b[count] = p_of_b;
        ++count;
        return reduce();
    }
    [[nodiscard]] ABUT_HD constexpr point mean_of(const point (&at)[4]) const {
        point sum = at[0];
        for (int k = 1; k < count; ++k) sum = plain_step(sum, weight[k], contact_math::plain_difference(at[k], at[0]));
        return sum;
    }

private:
    ABUT_HD constexpr result reduce() {
        using namespace contact_math;
        const int last = count - 1;
        const point p = w[last];
        point e[3]{};
        double of_p[3]{}, of_e[3]{};
        best_ = {plain_dot(p, p), p, p, -1, -1, 0, 0};
        for (int i = 0; i < last; ++i) {
            e[i] = plain_difference(w[i], p);
            of_p[i] = -plain_dot(p, e[i]);
            of_e[i] = plain_dot(e[i], e[i]);
            if (of_p[i] > 0 && of_p[i] < of_e[i]) {
                const double t = of_p[i] / of_e[i];
                const point v = plain_step(p, t, e[i]);
                offer({plain_dot(v, v), v, v, i, -1, t, 0});
            }
        }
        bool is_inside = count == 4;
        for (int i = 0; i < last; ++i) {
            for (int j = i + 1; j < last; ++j) {
                const point n = plain_cross(e[i], e[j]);
                const double height = plain_dot(n, p), square_of_n = plain_dot(n, n);
                if (count == 4) {
                    const double other = plain_product(height, plain_dot(n, e[3 - i - j]));
                    if (other < 0) continue;
                    is_inside = false;
                }
                const point m = plain_cross(n, p);
                const double s = -plain_dot(m, e[j]), t = plain_dot(m, e[i]);
                if (!(s > 0 && t > 0 && plain_sum(s, t) < square_of_n)) continue;
                const double share = s / square_of_n, other = t / square_of_n;
                const point v = plain_step(plain_step(p, share, e[i]), other, e[j]);
                offer({plain_dot(v, v), v, height < 0 ? negated(n) : n, i, j, share, other});
            }
        }
        if (is_inside) {
            hold(e, p);
            return result::holds_origin;
        }
        if (!(best_.square < square)) {
            --count;
            return result::no_nearer;
        }
        take(e);
        return best_.square > 0 ? result::nearer : result::holds_origin;
    }
    struct feature {
        double square;
        point mean, along;
        int i, j;
        double of_i, of_j;
    } best_{};

    ABUT_HD constexpr void offer(const feature& f) {
        if (f.square < best_.square) best_ = f;
    }
    ABUT_HD constexpr void take(const point (&e)[3]) {
        const int last = count - 1;
        square = best_.square;
        mean = best_.mean;
        along = best_.along;
        if (best_.i >= 0 && best_.j < 0) {  // across the edge, also where the way is short
            along = plain_cross(e[best_.i], plain_cross(w[last], e[best_.i]));
        }
        int kept = 0;
        const int of[3] = {best_.i, best_.j, last};
        const double share[3] = {best_.of_i, best_.of_j, plain_sum(1.0, -plain_sum(best_.of_i, best_.of_j))};
        for (int k = 0; k < 3; ++k) {
            if (of[k] < 0) continue;
            w[kept] = w[of[k]], on_a[kept] = on_a[of[k]], on_b[kept] = on_b[of[k]];
            weight[kept++] = share[k];
        }
        count = kept;
    }
    /// All four, by volumes; and again, for what rounding left of the origin.
    ABUT_HD constexpr void hold(const point (&e)[3], const point& p) {
        using contact_math::plain_dot;
        const point across[3] = {plain_cross(e[1], e[2]), plain_cross(e[2], e[0]), plain_cross(e[0], e[1])};
        const double whole = plain_dot(e[0], across[0]);
        if (whole == 0) return;
        point left = p;
        for (int k = 0; k < 3; ++k) weight[k] = -plain_dot(p, across[k]) / whole;
        for (int k = 0; k < 3; ++k) left = plain_step(left, weight[k], e[k]);
        double rest = 1;
        for (int k = 0; k < 3; ++k) {
            weight[k] = plain_sum(weight[k], -plain_dot(left, across[k]) / whole);
            rest = plain_sum(rest, -weight[k]);
        }
        weight[3] = rest;
        square = 0;
        bring_within();
    }
    /// Of a flat tetrahedron volumes tell little, and a weight may be below 0: then the mean would lie off the shapes.
    ABUT_HD constexpr void bring_within() {
        double sum = 0;
        for (int k = 0; k < 4; ++k) sum = plain_sum(sum, weight[k] > 0 ? weight[k] : 0);
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0 && weight[3] >= 0) return;
        for (int k = 0; k < 4; ++k) weight[k] = weight[k] > 0 ? weight[k] / sum : 0;
    }
};

/// The pair of points that the search comes near to, in closed forms or along one curve, and a way to certify it.
struct plain_guess {
    vec3<double> on_a, on_b, along;
    bool is = false;
};

/// Points that do not touch a solid: where those of the second shape at which the search is make up a corner, an edge, or a
/// face.
template <class B>
ABUT_NOINLINE ABUT_HD constexpr plain_guess finish_search(const plain_solid& a, const B&, const plain_simplex& at) {
    using namespace contact_math;
    point corner[3] = {at.on_b[0], {}, {}};
    int count = 1;
    for (int k = 1; k < at.count; ++k) {
        if (at.on_b[k] == corner[0] || (count > 1 && at.on_b[k] == corner[1])) continue;
        corner[count++] = at.on_b[k];
    }
    if (count == 1) {
        const plain_solid::foot f = a.foot_of(corner[0]);
        return {f.at, corner[0], f.normal, true};
    }
    if (count == 2) {
        const plain_curve edge = plain_curve::line(corner[0], corner[1]);
        const plain_curve::place p = edge.nearest_to(a, edge.place_of(at.mean_of(at.on_b)));
        const point& n = p.foot.normal;
        const double rest = plain_dot(n, edge.along) / plain_dot(edge.along, edge.along);
        return {p.foot.at, p.at, p.x > 0 && p.x < 1 ? plain_step(n, -rest, edge.along) : n, true};
    }
    const point ab = plain_difference(corner[1], corner[0]), ac = plain_difference(corner[2], corner[0]);
    point n = plain_cross(ab, ac);
    if (plain_dot(n, at.along) < 0) n = negated(n);
    const point p = a.farthest(n);
    const point seen = plain_difference(corner[0], p), way = foot_on_triangle(seen, plain_difference(corner[1], p), plain_difference(corner[2], p));
    return {p, plain_step(p, 1, way), n, true};
}
/// Two solids.
ABUT_NOINLINE ABUT_HD constexpr plain_guess finish_search(const plain_solid& a, const plain_solid& b, const plain_simplex& at) {
    using namespace contact_math;
    using part = plain_solid::part;
    const auto guess = [](const plain_solid::foot& on_a, const plain_solid::foot& on_b) {
        const bool by_a = on_a.on == part::disc || (on_a.on == part::side && on_b.on != part::disc);
        return plain_guess{on_a.at, on_b.at, by_a ? on_a.normal : negated(on_b.normal), true};
    };
    plain_solid::foot on_a = a.foot_of(at.mean_of(at.on_b)), on_b = b.foot_of(on_a.at);
    on_a = a.foot_of(on_b.at);
    if (on_a.on == part::disc) {
        on_b = b.foot_of(a.foot_of(b.farthest(negated(on_a.normal))).at);
        on_a = a.foot_of(on_b.at);
        return guess(on_a, on_b);
    }
    if (on_b.on == part::disc) {
        on_a = a.foot_of(b.foot_of(a.farthest(negated(on_b.normal))).at);
        on_b = b.foot_of(on_a.at);
        return guess(on_a, on_b);
    }
    if (on_a.on == part::apex || on_b.on == part::apex) return guess(on_a, on_b);
    const bool by_a = on_a.on == part::rim || (on_b.on != part::rim && !a.is_cone);
    const plain_solid &of = by_a ? a : b, &other = by_a ? b : a;
    const plain_solid::foot& on = by_a ? on_a : on_b;
    if (on.on == part::side && of.is_cone) return {};
    const plain_curve curve =
        on.on == part::rim ? plain_curve::rim(of, on.of_end, on.at) : plain_curve::line(of.end[0], of.end[1]);
    const plain_solid::foot there = curve.nearest_to(other, curve.place_of(on.at)).foot, here = of.foot_of(there.at);
    return by_a ? guess(here, there) : guess(there, here);
}

/// A way that is no longer tells nothing: squares of its part across an axis might underflow.
inline constexpr double shortest_usable_way = 0x1p-400;

/// Whether a guess is as near as the shapes are, but for `enough`; if so it is what is found.
template <class A, class B>
ABUT_HD constexpr bool settles(const A& a, const B& b, const plain_guess& g, double enough, plain_nearest& found) {
    using namespace contact_math;
    const point way = plain_difference(g.on_b, g.on_a);
    const double length = root(one_double{plain_dot(way, way)}).high,
                 of_along = root(one_double{plain_dot(g.along, g.along)}).high;
    if (!g.is || !(of_along > shortest_usable_way)) return false;
    const point back = plain_difference(b.farthest(negated(g.along)), a.farthest(g.along));
    const double ahead = plain_dot(g.along, back) / of_along;
    if (!(plain_sum(length, -ahead) <= enough)) return false;
    found.length = length, found.least = ahead, found.is_sure = true;
    found.on_a = g.on_a, found.on_b = g.on_b, found.way = way, found.along = g.along;
    return true;
}

/// Sizes in whose range no square overflows, and what underflows is nothing beside the rest.
ABUT_HD constexpr bool is_searched(double size) { return size > 0x1p-150 && size < 0x1p150; }

/// Looks for it, from the farthest points along a way, or from any, until they are farther apart than `far` for sure. Of a device
/// one function, out of line.
template <class A, class B>
ABUT_NOINLINE ABUT_HD constexpr plain_nearest search_in_doubles(const A& a, const B& b, plain_simplex& at, vec3<double> along = {0, 0, 0},
                                                                double far = infinity<double>) {
    using namespace contact_math;
    constexpr int most_steps = 40;
    plain_nearest found;
    found.size = greatest(a.size, b.size);
    if (!is_searched(found.size)) return found;
    const double enough = 0x1p-51 * found.size;
    const bool from_any = is_zero(along);
    double near = 0x1p-3;
    for (int step = 0; step < most_steps; ++step) {
        const bool is_any = step == 0 && from_any;
        const point p = is_any ? a.any() : a.farthest(along), q = is_any ? b.any() : b.farthest(negated(along)),
                    w = plain_difference(q, p);
        if (step > 0) {
            const double of_along = root(one_double{plain_dot(along, along)}).high;
            if (!(of_along > shortest_usable_way)) break;
            const double ahead = plain_dot(along, w) / of_along;
            if (ahead > found.least) found.least = ahead;
            if (plain_sum(found.length, -found.least) <= enough) {
                found.is_sure = true;
                break;
            }
            if (found.are_surely_beyond(far)) break;
        }
        const auto result = at.append(p, q, w);
        found.meet = result == plain_simplex::result::holds_origin;
        if (result != plain_simplex::result::nearer) break;
        along = at.along;
        found.length = root(one_double{at.square}).high;
        if constexpr (requires { finish_search(a, b, at); }) {
            if (step > 0 && plain_sum(found.length, -found.least) < plain_product(near, found.length)) {
                near = plain_product(near, 0x1p-6);
                if (settles(a, b, finish_search(a, b, at), enough, found)) return found;
            }
        }
    }
    if (!found.meet && !found.is_sure) return found;
    found.on_a = at.mean_of(at.on_a);
    found.on_b = at.mean_of(at.on_b);
    found.way = at.mean;
    found.along = at.along;
    return found;
}

/// Whether a way from a point of one to a point of the other tells that they are farther apart than that.
template <class A, class B>
ABUT_HD constexpr bool are_clearly_beyond(const A& a, const B& b, double far) {
    using namespace contact_math;
    const point along = plain_difference(b.any(), a.any());
    const double length = root(one_double{plain_dot(along, along)}).high;
    plain_nearest found;
    found.size = greatest(a.size, b.size);
    if (!is_searched(found.size) || !(length > shortest_usable_way)) return false;
    found.least = plain_dot(along, plain_difference(b.farthest(negated(along)), a.farthest(along))) / length;
    return found.are_surely_beyond(far);
}

template <class A, class B>
ABUT_HD constexpr plain_nearest search_in_doubles(const A& a, const B& b) {
    plain_simplex at;
    return search_in_doubles(a, b, at);
}

}  // namespace abut::detail
