// SPDX-License-Identifier: MIT
#pragma once

// The first stage of contacts of a cylinder or a cone with boxes, hulls, segments, capsules and each other: the least move
// in doubles whose operations are rounded one by one, with a certificate at its end. Not for decisions, and not for shapes
// that hardly touch: where it knows nothing, revolution_contact.hpp and what belongs to it are asked.
//
// Let K be the differences of a point of b and one of a, and h(m) how far K reaches along m, times the length of m. The
// least move is the least of h over unit vectors. A polytope in K (plain_depth.hpp) bounds h from below along all ways, but
// where K is round it would take very many corners. So the least is looked for near a face, by Newton's method, and a cap of
// ways around it is certified otherwise:
//
// Let n be the way found, d = h(n), and v orthogonal to n. What reaches along n + v does so at least as far as the points
// that do along n, and a rim goes along: of a rim with radius R around an axis, q what n has across that and t the unit
// vector across both, R |q + w| >= R (|q| + w.q / |q|) + R (t.v)^2 / (2 (|q| + r)) for all |v| <= r. Where two points a way
// k apart reach as far along n, as the ends of a side or an edge, the greater one is, for any share x of the second, at
// least their mean by shares and min(x, 1 - x) |k.v|, which is at least min(x, 1 - x) (k.v)^2 / (|k| r). (Where one of the
// two lies on a rim and the other does not, seven parts of the rim's term count, and one of this.) With the share that makes
// the terms linear in v vanish, h(n + v) >= d + Q(v) / 2. If no eigenvalue of Q is less than d, that is at least d sqrt(1 +
// v.v): no way within the cap has a shorter move. What is left of terms linear in v, and of k.n, is taken off d. All other
// ways the polytope has to tell.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_depth.hpp>
#include <abut/narrow/plain_distance.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// The farthest point along a way, how it goes as that turns, and others that are about as far.
struct plain_bend {
    vec3<double> at, other[2];
    vec3<double> aside{0, 0, 0};         ///< the tangent of a rim, of length 1
    double bend = 0, bend_of_other = 0;  ///< the rim's radius, over `across`
    double across = 1;                   ///< what the way has across the axis
    double flat = 0;                     ///< where the way is along an axis, the radius of the flat end, whose centre counts
    bool is_triangle = false;            ///< which the three make up; else a sum of two edges, from `at` to the others
};

/// Along a unit vector.
///@{
ABUT_HD constexpr plain_bend bend_of(const plain_solid& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    using namespace contact_math;
    plain_bend found{};
    const point turned = plain_cross(s.axis, n);
    found.across = root(one_double{plain_dot(turned, turned)}).high;
    if (found.across < 0x1p-40) {
        const int k = plain_dot(n, s.axis) > 0 ? 1 : 0;
        found.at = found.other[0] = found.other[1] = s.end[k];
        found.flat = s.is_cone && k == 0 ? 0 : s.radius;
        return found;
    }
    const double per = 1 / found.across, bend = plain_product(s.radius, per);
    found.aside = plain_times(per, turned);
    const point out = plain_times(s.radius, plain_cross(found.aside, s.axis));
    const point first = s.is_cone ? s.end[0] : plain_step(s.end[0], 1, out), last = plain_step(s.end[1], 1, out);
    const bool is_last = plain_dot(n, last) > plain_dot(n, first);
    found.at = found.other[1] = is_last ? last : first, found.other[0] = is_last ? first : last;
    found.bend = s.is_cone && !is_last ? 0 : bend;
    found.bend_of_other = s.is_cone && is_last ? 0 : bend;
    return found;
}
ABUT_HD constexpr plain_bend bend_of(const plain_core<2>& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    const int k = contact_math::plain_dot(n, s.at[1]) > contact_math::plain_dot(n, s.at[0]) ? 1 : 0;
    return {s.at[k], {s.at[1 - k], s.at[k]}};
}
/// Across the two faces along which that is the least loss.
ABUT_HD constexpr plain_bend bend_of(const plain_box& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    const vec3<double> p = s.farthest(n);
    const vec3<double> loss = absolute(vec3<double>{plain_product(n.x, plain_sum(s.upper.x, -s.lower.x)),
                                                    plain_product(n.y, plain_sum(s.upper.y, -s.lower.y)),
                                                    plain_product(n.z, plain_sum(s.upper.z, -s.lower.z))});
    const vec3<double> x{n.x > 0 ? s.lower.x : s.upper.x, p.y, p.z}, y{p.x, n.y > 0 ? s.lower.y : s.upper.y, p.z},
        z{p.x, p.y, n.z > 0 ? s.lower.z : s.upper.z};
    if (loss.x >= loss.y && loss.x >= loss.z) return {p, {y, z}};
    return loss.y >= loss.z ? plain_bend{p, {x, z}} : plain_bend{p, {x, y}};
}
/// The others are of a few that are given.
template <scalar T>
ABUT_HD constexpr plain_bend bend_of(const plain_points<T>& s, const vec3<double>& n, const vec3<double> (&few)[3]) {
    const vec3<double> p = s.farthest(n);
    plain_bend found{p, {p, p}};
    found.is_triangle = true;
    int count = 0;
    for (const vec3<double>& q : few) {
        if (count < 2 && !(q == p) && !(q == found.other[0])) found.other[count++] = q;
    }
    return found;
}
///@}

/// Along which axis a way nearly is; 0 where along none.
template <class S>
ABUT_HD constexpr vec3<double> flat_way_near(const S& s, const vec3<double>& n) {
    if constexpr (std::same_as<S, plain_solid>) {
        const double along = contact_math::plain_dot(n, s.axis);
        if (absolute(along) > 0.75) return along > 0 ? s.axis : contact_math::negated(s.axis);
    }
    return {0, 0, 0};
}

/// Looks for a least move from a way near by, and for a cap of ways, around that, of which it is the least.
template <class A, class B>
class plain_least_move {
    using point = vec3<double>;
    struct flat {
        double x, y;
    };

public:
    point normal{0, 0, 1};
    double depth = infinity<double>;
    plain_cap cap;

    ABUT_HD constexpr plain_least_move(const A& a, const B& b) : a_(a), b_(b) {}

    /// False where it finds none. `few` are points of b near by; `enough` is what may be left.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool settle(point n, const point (&few)[3], double enough) {
        using namespace contact_math;
        constexpr int most_steps = 10;
        for (const point& along : {negated(flat_way_near(a_, negated(n))), flat_way_near(b_, n)}) {
            if (!is_zero(along) && look(along, few) && find_cap(along, -1, -1, enough)) return true;
        }
        bool is_settled = false;
        int i = -1, j = -1;
        for (int step = 0; step < most_steps; ++step) {
            if (!look(n, few) || flat_ > 0) return false;
            if (is_settled) return find_cap(n, i, j, enough);
            flat v{0, 0};
            if (!step_on(i, j, v)) return false;
            const double square = dot(v, v);
            if (!(square < 0.25)) return false;
            is_settled = square < 0x1p-56;
            n = plain_step(plain_step(n, v.x, u_[0]), v.y, u_[1]);
            n = plain_times(1 / root(one_double{plain_dot(n, n)}).high, n);
        }
        return false;
    }

private:
    static constexpr int kinks = 3;
    const A& a_;
    const B& b_;
    // As seen along a way: of both shapes, and in two directions across it.
    point u_[2]{};
    double d_ = 0, flat_ = 0, bend_[2]{}, other_[2]{}, across_[2]{}, gap_[kinks]{};
    flat w_{}, t_[2]{}, k_[kinks]{};  ///< k: from the farthest point of K to others, of a and twice of b
    bool is_triangle_ = false;

    ABUT_HD static constexpr double sum(double a, double b, double c, double p, double q, double r) {
        return plain_sum(plain_product(plain_product(a, b), c), plain_product(plain_product(p, q), r));
    }
    ABUT_HD static constexpr double minor(double a, double b, double c, double d) {
        return plain_sum(plain_product(a, b), -plain_product(c, d));
    }
    ABUT_HD static constexpr double dot(const flat& a, const flat& b) {
        return plain_sum(plain_product(a.x, b.x), plain_product(a.y, b.y));
    }
    [[nodiscard]] ABUT_HD constexpr flat seen(const point& p) const {
        return {contact_math::plain_dot(u_[0], p), contact_math::plain_dot(u_[1], p)};
    }
    /// False where K does not hold the origin.
    [[nodiscard]] ABUT_HD constexpr bool look(const point& n, const point (&few)[3]) {
        using namespace contact_math;
        const plain_bend f = bend_of(a_, negated(n), few), g = bend_of(b_, n, few);
        const point size = absolute(n);
        const point other = size.x <= size.y && size.x <= size.z ? point{1, 0, 0}
                            : size.y <= size.z                   ? point{0, 1, 0}
                                                                 : point{0, 0, 1};
        u_[0] = plain_cross(n, other);
        u_[0] = plain_times(1 / root(one_double{plain_dot(u_[0], u_[0])}).high, u_[0]);
        u_[1] = plain_cross(n, u_[0]);
        const point w = plain_difference(g.at, f.at);
        const point k[kinks] = {plain_difference(f.at, f.other[0]), plain_difference(g.other[0], g.at),
                                plain_difference(g.other[1], g.at)};
        for (int i = 0; i < kinks; ++i) k_[i] = seen(k[i]), gap_[i] = absolute(plain_dot(n, k[i]));
        d_ = plain_dot(n, w);
        w_ = seen(w);
        t_[0] = seen(f.aside), t_[1] = seen(g.aside);
        bend_[0] = f.bend, bend_[1] = g.bend, other_[0] = f.bend_of_other, other_[1] = g.bend_of_other;
        across_[0] = f.across, across_[1] = g.across;
        flat_ = plain_sum(f.flat, g.flat);
        is_triangle_ = g.is_triangle;
        return d_ > 0;
    }
    /// A step of Newton's method: to where up to two others are as far, and from there to the least.
    [[nodiscard]] ABUT_HD constexpr bool step_on(int& i, int& j, flat& v) const {
        i = j = -1;
        const double xx = plain_sum(sum(bend_[0], t_[0].x, t_[0].x, bend_[1], t_[1].x, t_[1].x), -d_),
                     xy = sum(bend_[0], t_[0].x, t_[0].y, bend_[1], t_[1].x, t_[1].y),
                     yy = plain_sum(sum(bend_[0], t_[0].y, t_[0].y, bend_[1], t_[1].y, t_[1].y), -d_),
                     det = minor(xx, yy, xy, xy);
        if (xx > 0 && det > 0) {
            v = {minor(xy, w_.y, yy, w_.x) / det, minor(xy, w_.x, xx, w_.y) / det};
            if (passes_none(v, -1)) return true;
        }
        i = nearest_kink(-1);
        if (i < 0) return false;
        const flat& k = k_[i];
        const double square = dot(k, k), per = 1 / contact_math::root(contact_math::one_double{square}).high,
                     share = into_unit_of_doubles(-dot(w_, k) / square), to = gap_[i] / square;
        const flat along{-plain_product(per, k.y), plain_product(per, k.x)};
        const double ta = dot(t_[0], along), tb = dot(t_[1], along), ba = bend_with(0, i, share),
                     bb = bend_with(1, i, share);
        const double curved = plain_sum(sum(ba, ta, ta, bb, tb, tb), -d_);
        if (curved > 0) {
            const double rise =
                plain_sum(dot(along, w_), plain_product(to, sum(ba, ta, dot(t_[0], k), bb, tb, dot(t_[1], k))));
            const double by = -rise / curved;
            v = {plain_sum(plain_product(to, k.x), plain_product(by, along.x)),
                 plain_sum(plain_product(to, k.y), plain_product(by, along.y))};
            if (passes_none(v, i)) return true;
        }
        j = nearest_kink(i);
        if (j < 0) return false;
        const flat& l = k_[j];
        const double both = minor(k.x, l.y, k.y, l.x);
        if (!(both * both > 0x1p-30 * square * dot(l, l))) return false;
        v = {minor(gap_[i], l.y, gap_[j], k.y) / both, minor(k.x, gap_[j], l.x, gap_[i]) / both};
        return true;
    }
    /// Whether none but one of the others gets farther.
    [[nodiscard]] ABUT_HD constexpr bool passes_none(const flat& v, int but) const {
        for (int i = 0; i < kinks; ++i) {
            if (i != but && dot(k_[i], v) > gap_[i]) return false;
        }
        return true;
    }
    /// Which of the others but one is soonest as far, or -1.
    [[nodiscard]] ABUT_HD constexpr int nearest_kink(int but) const {
        int best = -1;
        double least_gap = 0, least_square = 0;  // gap / |k|, squared
        for (int i = 0; i < kinks; ++i) {
            const double square = dot(k_[i], k_[i]), gap = plain_product(gap_[i], gap_[i]);
            if (i == but || !(square > 0)) continue;
            if (best >= 0 && !(plain_product(gap, least_square) < plain_product(least_gap, square))) continue;
            best = i, least_gap = gap, least_square = square;
        }
        return best;
    }
    [[nodiscard]] ABUT_HD constexpr double bend_with(int of, int i, double share) const {
        return i == of ? plain_sum(plain_product(1 - share, bend_[of]), plain_product(share, other_[of])) : bend_[of];
    }
    /// Around n, where others i and j are as far; -1 is none.
    [[nodiscard]] ABUT_HD constexpr bool find_cap(const point& n, int i, int j, double enough) {
        using namespace contact_math;
        constexpr double narrowest = 0x1p-7;
        double share_i = 0, share_j = 0;
        if (j >= 0) {
            const double both = minor(k_[i].x, k_[j].y, k_[i].y, k_[j].x);
            share_i = into_unit_of_doubles(minor(k_[j].x, w_.y, k_[j].y, w_.x) / both);
            share_j = into_unit_of_doubles(minor(k_[i].y, w_.x, k_[i].x, w_.y) / both);
        } else if (i >= 0) {
            share_i = into_unit_of_doubles(-dot(w_, k_[i]) / dot(k_[i], k_[i]));
        }
        // What moves from one point to another at will.
        const double rest_of_i = is_triangle_ && i > 0 && j > 0 ? plain_sum(1 - share_i, -share_j) / 2 : 1 - share_i,
                     rest_of_j = is_triangle_ && i > 0 && j > 0 ? rest_of_i : 1 - share_j;
        const auto is_mixed = [&](int of) { return (i == of || j == of) && bend_[of] != other_[of]; };
        const auto rise = [&](int of, double share, double rest) {
            return of < 0 ? 0 : plain_product(of < 2 && is_mixed(of) ? 0.25 : 2, least(share, rest));
        };
        const double rise_i = rise(i, share_i, rest_of_i), rise_j = rise(j, share_j, rest_of_j);
        const flat ki = i >= 0 ? k_[i] : flat{0, 0}, kj = j >= 0 ? k_[j] : flat{0, 0};
        const flat rest{plain_sum(w_.x, plain_sum(plain_product(share_i, ki.x), plain_product(share_j, kj.x))),
                        plain_sum(w_.y, plain_sum(plain_product(share_i, ki.y), plain_product(share_j, kj.y)))};
        const double left = root(one_double{dot(rest, rest)}).high,
                     gap = plain_sum(i >= 0 ? gap_[i] : 0, j >= 0 ? gap_[j] : 0);
        if (rise_i < 0 || rise_j < 0 || !(flat_ > 0 ? left < flat_ : plain_sum(left, gap) <= enough)) return false;
        const auto part_of = [&](int of) {
            const double bend = i == of ? bend_with(of, i, share_i) : bend_with(of, j, share_j);
            return plain_product(plain_product(is_mixed(of) ? 0.875 : 1, bend), across_[of]);
        };
        const double ba = part_of(0), bb = part_of(1), around = 2 * greatest(plain_sum(flat_, -left), 0.0),
                     most = plain_product(1 + 0x1p-20, d_);
        const double ii = root(one_double{dot(ki, ki)}).high, jj = root(one_double{dot(kj, kj)}).high;
        const double per_i = ii > 0 ? rise_i / ii : 0, per_j = jj > 0 ? rise_j / jj : 0;
        for (double r = 1; r >= narrowest; r /= 2) {
            const double a = ba / plain_sum(across_[0], r), b = bb / plain_sum(across_[1], r),
                         less = plain_sum(around / r, -most);
            const auto entry = [&](double at, double bt, double ik, double jk, double as, double bs, double is, double js) {
                return plain_sum(sum(a, at, as, b, bt, bs), sum(per_i / r, ik, is, per_j / r, jk, js));
            };
            const double xx = plain_sum(entry(t_[0].x, t_[1].x, ki.x, kj.x, t_[0].x, t_[1].x, ki.x, kj.x), less),
                         xy = entry(t_[0].x, t_[1].x, ki.x, kj.x, t_[0].y, t_[1].y, ki.y, kj.y),
                         yy = plain_sum(entry(t_[0].y, t_[1].y, ki.y, kj.y, t_[0].y, t_[1].y, ki.y, kj.y), less);
            if (!(xx > 0 && yy > 0 && minor(xx, yy, xy, xy) > 0)) continue;
            const double cosine = 1 / root(one_double{plain_sum(1.0, plain_product(r, r))}).high;
            normal = n, depth = d_;
            cap = {n, cosine, plain_product(r, cosine)};
            return true;
        }
        return false;
    }
};

/// As of polytopes, where one is round.
template <class A, class B>
ABUT_NOINLINE ABUT_HD constexpr plain_way_out least_move_in_doubles(const A& a, const B& b, const plain_simplex& at,
                                                                    double size) {
    plain_way_out found;
    plain_polytope<A, B> polytope(a, b, at);
    plain_cap cap;
    const double enough = plain_product(0x1p-50, size);
    double near = 0.5;
    while (polytope.is_closed()) {
        const int f = polytope.open_face(plain_sum(found.depth, -2 * enough), cap);
        if (f < 0) {
            found.is_sure = found.depth > 0x1p-20 * size;
            break;
        }
        const vec3<double> n = polytope.normal_of(f);
        const double depth = polytope.look(n);
        if (depth < plain_sum(found.depth, -enough)) {
            found.depth = depth, found.normal = n, cap = {};
            if (plain_sum(depth, -polytope.distance_of(f)) <= enough) continue;
        }
        if (cap.cosine > 1 && plain_sum(depth, -polytope.distance_of(f)) <= plain_product(near, depth)) {
            near /= 4;
            const vec3<double> few[3] = {polytope.on_b(f, 0), polytope.on_b(f, 1), polytope.on_b(f, 2)};
            plain_least_move<A, B> move(a, b);
            if (move.settle(n, few, enough) && move.depth <= plain_sum(found.depth, enough)) {
                found.depth = move.depth, found.normal = move.normal, cap = move.cap;
                continue;
            }
        }
        if (!polytope.grow(f)) break;
    }
    return found;
}

/// The contact of two shapes as the search sees them, b with a radius around it. Where these do not touch, they go apart
/// along the way between the points that are nearest to each other.
template <scalar T, class A, class B>
ABUT_NOINLINE ABUT_HD constexpr contact_in_doubles<T> find_contact_as_seen(const A& a, const B& b, double radius, const vec3<double>& origin,
                                                                bool may_be_apart) {
    using namespace contact_math;
    // Points found from the middle, or an end, may lie in one plane with the origin, which leaves a polytope no room.
    plain_simplex at;
    contact_in_doubles<T> known;
    if (may_be_apart && are_clearly_beyond(a, b, radius)) {
        known.touch = verdict::no;
        return known;
    }
    const plain_nearest nearest = search_in_doubles(a, b, at, {0.36, -0.48, 0.8}, radius);
    if (nearest.are_surely_beyond(radius)) known.touch = verdict::no;
    if (!nearest.knows_shared_point()) return known;
    plain_way_out out{negated(nearest.along), -nearest.length, nearest.length > 0x1p-20 * nearest.size && radius > 0};
    if (nearest.meet) out = least_move_in_doubles(a, b, at, nearest.size);
    if (!out.is_sure) return known;
    const point n = plain_normal<T>(unit_vector(as<one_double>(out.normal)));
    const double overlap = plain_dot(n, plain_difference(b.farthest(n), a.farthest(negated(n)))),
                 enough = plain_product(0x1p-50 + 2 * static_cast<double>(unit_roundoff<T>), nearest.size);
    if (!(plain_sum(overlap, -out.depth) <= enough)) return known;
    known.is_known = true;
    if (known.touch == verdict::unknown) known.touch = touch_of_cores(nearest, out.depth, radius);
    known.found = plain_contact(from_seen<T>(origin, nearest.on_a), n, 0);
    known.found.depth = rounded_within<T>(greatest(plain_sum(overlap, radius), 0.0));
    return known;
}

/// The same of shapes whose axes have a length.
template <class S, class U>
    requires searched_plainly<S, U>
ABUT_HD constexpr auto find_contact_in_doubles(const S& s, const U& t, bool may_be_apart = false) {
    using T = scalar_type_of<S>;
    const vec3<double> origin = widened(axis_of(s).a);
    double radius = 0;
    if constexpr (!solid_of_revolution<U>) radius = static_cast<double>(radius_around_core(t));
    return with_seen_plainly(s, t, origin, [&](const auto& a, const auto& b) { return find_contact_as_seen<T>(a, b, radius, origin, may_be_apart); });
}

}  // namespace abut::detail
