// SPDX-License-Identifier: MIT
#pragma once

// The first stage of contacts of a cylinder or a cone with boxes, hulls, segments, capsules and each other: the least move in
// doubles whose operations are rounded one by one, with a certificate at its end. Not for decisions, and not for shapes that
// hardly touch: where it knows nothing, revolution_contact.hpp and what belongs to it are asked.
//
// Let K be the differences of a point of b and one of a, and h(m) how far K reaches along m, times the length of m. The least
// move is the least of h over unit vectors. A polytope in K (plain_depth.hpp) bounds h from below along all ways, but where K
// is round it would take very many corners. So the least is looked for near a face, by Newton's method, and a cap of ways
// around it is certified otherwise:
//
// Let n be the way found, d = h(n), and v orthogonal to n. What reaches along n + v does so at least as far as the points that do
// along n, and a rim goes along: of a rim with radius R around an axis, q what n has across that and t the unit vector
// across both, R |q + w| >= R (|q| + w.q / |q|) + R (t.v)^2 / (2 (|q| + r)) for all |v| <= r. Where two points a way k apart
// reach as far along n, as the ends of a side or an edge, the greater one is, for any share x of the second, at least their
// mean by shares and min(x, 1 - x) |k.v|, which is at least min(x, 1 - x) (k.v)^2 / (|k| r). (Where one of the two lies on a rim and
// the other does not, seven parts of the rim's term count, and one of this.) With the share that makes the terms linear in v
// vanish, h(n + v) >= d + Q(v) / 2. If no eigenvalue of Q is less than d, that is at least d sqrt(1 + v.v): no way within the cap
// has a shorter move. What is left of terms linear in v, and of k.n, is taken off d. All other ways the polytope has to tell.

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

/// The farthest point along a way, how it goes as that turns, and another one that is about as far.
struct plain_bend {
    vec3<double> at, other;
    vec3<double> aside{0, 0, 0};          ///< the tangent of a rim, of length 1
    double bend = 0, bend_of_other = 0;  ///< the rim's radius, over `across`
    double across = 1;                    ///< what the way has across the axis
    bool is_smooth = true;                ///< else it is of a flat end
};

/// Along a unit vector.
///@{
ABUT_HD constexpr plain_bend bend_of(const plain_solid& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    using namespace contact_math;
    plain_bend found{};
    const point turned = plain_cross(s.axis, n);
    found.across = root(one_double{plain_dot(turned, turned)}).high;
    found.is_smooth = found.across > 0x1p-12;
    if (!found.is_smooth) return found;
    const double per = 1 / found.across, bend = plain_product(s.radius, per);
    found.aside = plain_times(per, turned);
    const point out = plain_times(s.radius, plain_cross(found.aside, s.axis));
    const point first = s.is_cone ? s.end[0] : plain_step(s.end[0], 1, out), last = plain_step(s.end[1], 1, out);
    const bool is_last = plain_dot(n, last) > plain_dot(n, first);
    found.at = is_last ? last : first, found.other = is_last ? first : last;
    found.bend = s.is_cone && !is_last ? 0 : bend;
    found.bend_of_other = s.is_cone && is_last ? 0 : bend;
    return found;
}
ABUT_HD constexpr plain_bend bend_of(const plain_core<2>& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    const int k = contact_math::plain_dot(n, s.at[1]) > contact_math::plain_dot(n, s.at[0]) ? 1 : 0;
    return {s.at[k], s.at[1 - k]};
}
ABUT_HD constexpr plain_bend bend_of(const plain_box& s, const vec3<double>& n, const vec3<double> (&)[3]) {
    plain_bend found{s.farthest(n), s.farthest(n)};
    const vec3<double> loss = absolute(vec3<double>{plain_product(n.x, plain_sum(s.upper.x, -s.lower.x)),
                                                    plain_product(n.y, plain_sum(s.upper.y, -s.lower.y)),
                                                    plain_product(n.z, plain_sum(s.upper.z, -s.lower.z))});
    if (loss.x <= loss.y && loss.x <= loss.z) {
        found.other.x = n.x > 0 ? s.lower.x : s.upper.x;
    } else if (loss.y <= loss.z) {
        found.other.y = n.y > 0 ? s.lower.y : s.upper.y;
    } else {
        found.other.z = n.z > 0 ? s.lower.z : s.upper.z;
    }
    return found;
}
/// The other one is of a few that are given.
template <scalar T>
ABUT_HD constexpr plain_bend bend_of(const plain_points<T>& s, const vec3<double>& n, const vec3<double> (&few)[3]) {
    plain_bend found{s.farthest(n), {}};
    found.other = found.at;
    double most = -infinity<double>;
    for (const vec3<double>& p : few) {
        const double reach = contact_math::plain_dot(n, p);
        if (reach > most && !(p == found.at)) most = reach, found.other = p;
    }
    return found;
}
///@}

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
        bool is_settled = false;
        int of = -1;
        for (int step = 0; step < most_steps; ++step) {
            if (!look(n, few)) return false;
            if (is_settled) {
                normal = n, depth = d_;
                return find_cap(of, enough);
            }
            flat v{0, 0};
            of = -1;
            const double xx = plain_sum(sum(bend_[0], t_[0].x, t_[0].x, bend_[1], t_[1].x, t_[1].x), -d_),
                         xy = sum(bend_[0], t_[0].x, t_[0].y, bend_[1], t_[1].x, t_[1].y),
                         yy = plain_sum(sum(bend_[0], t_[0].y, t_[0].y, bend_[1], t_[1].y, t_[1].y), -d_),
                         det = minor(xx, yy, xy, xy);
            bool is_free = xx > 0 && det > 0;
            if (is_free) {
                v = {minor(xy, w_.y, yy, w_.x) / det, minor(xy, w_.x, xx, w_.y) / det};
                is_free = dot(k_[0], v) <= gap_[0] && dot(k_[1], v) <= gap_[1];
            }
            if (!is_free) {
                of = nearer_kink();
                if (of < 0) return false;
                const flat& k = k_[of];
                const double square = dot(k, k), per = 1 / root(one_double{square}).high, share = share_of(of);
                const flat along{-k.y * per, k.x * per};
                const double to = gap_[of] / square;
                const double ta = dot(t_[0], along), tb = dot(t_[1], along), ba = bend_with(0, of, share), bb = bend_with(1, of, share);
                const double curved = plain_sum(sum(ba, ta, ta, bb, tb, tb), -d_);
                if (!(curved > 0)) return false;
                const double rise = plain_sum(dot(along, w_), plain_product(to, sum(ba, ta, dot(t_[0], k), bb, tb, dot(t_[1], k))));
                const double by = -rise / curved;
                v = {plain_sum(plain_product(to, k.x), plain_product(by, along.x)),
                     plain_sum(plain_product(to, k.y), plain_product(by, along.y))};
            }
            const double square = dot(v, v);
            if (!(square < 0.25)) return false;
            is_settled = square < 0x1p-56;
            n = plain_step(plain_step(n, v.x, u_[0]), v.y, u_[1]);
            n = plain_times(1 / root(one_double{plain_dot(n, n)}).high, n);
        }
        return false;
    }

private:
    const A& a_;
    const B& b_;
    // As seen along a way: of both shapes, and in two directions across it.
    point u_[2]{};
    double d_ = 0, bend_[2]{}, other_[2]{}, across_[2]{}, gap_[2]{};
    flat w_{}, t_[2]{}, k_[2]{};

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
    /// False at flat ends, and where K does not hold the origin.
    [[nodiscard]] ABUT_HD constexpr bool look(const point& n, const point (&few)[3]) {
        using namespace contact_math;
        const plain_bend f = bend_of(a_, negated(n), few), g = bend_of(b_, n, few);
        if (!f.is_smooth || !g.is_smooth) return false;
        const point size = absolute(n);
        const point other = size.x <= size.y && size.x <= size.z ? point{1, 0, 0} : size.y <= size.z ? point{0, 1, 0} : point{0, 0, 1};
        u_[0] = plain_cross(n, other);
        u_[0] = plain_times(1 / root(one_double{plain_dot(u_[0], u_[0])}).high, u_[0]);
        u_[1] = plain_cross(n, u_[0]);
        const point w = plain_difference(g.at, f.at), ka = plain_difference(f.at, f.other), kb = plain_difference(g.other, g.at);
        d_ = plain_dot(n, w);
        w_ = seen(w);
        t_[0] = seen(f.aside), t_[1] = seen(g.aside);
        k_[0] = seen(ka), k_[1] = seen(kb);
        gap_[0] = greatest(-plain_dot(n, ka), 0.0), gap_[1] = greatest(-plain_dot(n, kb), 0.0);
        bend_[0] = f.bend, bend_[1] = g.bend, other_[0] = f.bend_of_other, other_[1] = g.bend_of_other;
        across_[0] = f.across, across_[1] = g.across;
        return d_ > 0;
    }
    /// Of which shape the other point soonest is as far, or -1.
    [[nodiscard]] ABUT_HD constexpr int nearer_kink() const {
        const double of_a = dot(k_[0], k_[0]), of_b = dot(k_[1], k_[1]);
        if (!(of_a > 0) && !(of_b > 0)) return -1;
        // gap / |k|, squared
        const double a = plain_product(plain_product(gap_[0], gap_[0]), of_b), b = plain_product(plain_product(gap_[1], gap_[1]), of_a);
        return of_a > 0 && (!(of_b > 0) || a < b) ? 0 : 1;
    }
    /// Of the other point, so that nothing is left along k.
    [[nodiscard]] ABUT_HD constexpr double share_of(int of) const {
        return into_unit_of_doubles(-dot(w_, k_[of]) / dot(k_[of], k_[of]));
    }
    [[nodiscard]] ABUT_HD constexpr double bend_with(int i, int of, double share) const {
        return i == of ? plain_sum(plain_product(1 - share, bend_[i]), plain_product(share, other_[i])) : bend_[i];
    }
    [[nodiscard]] ABUT_HD constexpr bool find_cap(int of, double enough) {
        using namespace contact_math;
        constexpr double narrowest = 0x1p-7;
        double share = 0, rise = 0, gap = 0, per = 0, part = 1;
        flat rest = w_, k{0, 0};
        if (of >= 0) {
            share = share_of(of);
            gap = gap_[of];
            const double square = dot(k_[of], k_[of]), length = root(one_double{square}).high;
            per = 1 / length;
            k = {plain_product(per, k_[of].x), plain_product(per, k_[of].y)};
            rest = {plain_sum(w_.x, plain_product(share, k_[of].x)), plain_sum(w_.y, plain_product(share, k_[of].y))};
            part = bend_[of] == other_[of] ? 1 : 0.875;
            rise = plain_product(part == 1 ? 2 : 0.25, plain_product(least(share, 1 - share), length));
        }
        const double left = root(one_double{dot(rest, rest)}).high;
        if (!(plain_sum(left, gap) <= enough)) return false;
        const double ba = plain_product(of == 0 ? part : 1, bend_with(0, of, share)),
                     bb = plain_product(of == 1 ? part : 1, bend_with(1, of, share));
        for (double r = 1; r >= narrowest; r /= 2) {
            const double a = plain_product(ba, across_[0]) / plain_sum(across_[0], r), b = plain_product(bb, across_[1]) / plain_sum(across_[1], r),
                         c = rise / r, most = plain_product(1 + 0x1p-20, d_);
            const double xx = plain_sum(plain_sum(sum(a, t_[0].x, t_[0].x, b, t_[1].x, t_[1].x), plain_product(c, plain_product(k.x, k.x))), -most),
                         xy = plain_sum(sum(a, t_[0].x, t_[0].y, b, t_[1].x, t_[1].y), plain_product(c, plain_product(k.x, k.y))),
                         yy = plain_sum(plain_sum(sum(a, t_[0].y, t_[0].y, b, t_[1].y, t_[1].y), plain_product(c, plain_product(k.y, k.y))), -most);
            if (!(xx > 0 && yy > 0 && minor(xx, yy, xy, xy) > 0)) continue;
            const double cosine = 1 / root(one_double{plain_sum(1.0, plain_product(r, r))}).high;
            cap = {normal, cosine, plain_product(r, cosine)};
            return true;
        }
        return false;
    }
};

/// As of polytopes, where one is round.
template <class A, class B>
ABUT_NOINLINE ABUT_HD constexpr plain_way_out least_move_in_doubles(const A& a, const B& b, const plain_simplex& at, double size) {
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

/// The contact of two shapes as the search sees them, b with a radius around it. Where these do not touch, they go apart along the way
/// between the points that are nearest to each other. False where doubles do not know it.
template <scalar T, class A, class B>
ABUT_NOINLINE ABUT_HD constexpr bool find_contact_as_seen(const A& a, const B& b, double radius, const vec3<double>& origin,
                                                          contact<T>& found) {
    using namespace contact_math;
    plain_simplex at;
    const plain_nearest nearest = search_in_doubles(a, b, at);
    if (!nearest.knows_shared_point()) return false;
    plain_way_out out{negated(nearest.along), -nearest.length, nearest.length > 0x1p-20 * nearest.size && radius > 0};
    if (nearest.meet) out = least_move_in_doubles(a, b, at, nearest.size);
    if (!out.is_sure) return false;
    const point n = plain_normal<T>(unit_vector(as<one_double>(out.normal)));
    const double overlap = plain_dot(n, plain_difference(b.farthest(n), a.farthest(negated(n)))),
                 enough = plain_product(0x1p-50 + static_cast<double>(unit_roundoff<T>) / 2, nearest.size);
    if (!(plain_sum(overlap, -out.depth) <= enough)) return false;
    found = plain_contact(from_seen<T>(origin, nearest.on_a), n, plain_sum(overlap, radius));
    return true;
}

/// The same of shapes whose axes have a length.
template <class S, class U>
    requires searched_plainly<S, U>
ABUT_HD constexpr bool find_contact_in_doubles(const S& s, const U& t, contact<scalar_type_of<S>>& found) {
    const vec3<double> origin = widened(axis_of(s).a);
    double radius = 0;
    if constexpr (!solid_of_revolution<U>) radius = static_cast<double>(radius_around_core(t));
    return with_seen_plainly(s, t, origin, [&](const auto& a, const auto& b) {
        return find_contact_as_seen(a, b, radius, origin, found);
    });
}

}  // namespace abut::detail
