// SPDX-License-Identifier: MIT
#pragma once

// When a shape that goes along a vector touches another one first, in doubles: between which times, or that it does not, or
// nothing. Where it says nothing, or more is asked, integers answer (predicate/exact_sweep.hpp).
//
// Let D be the hull of all differences of points of the core that is met and points of the core that goes, w the way and r
// the sum of the radii. The shapes touch at t if t w is within r of D. That distance is a convex function of t. So the search
// goes from a time to one that is not too late: along the way from t w to its nearest point of D, no difference is less than
// some one, and until that comes within reach the shapes are apart (G. van den Bergen, Ray casting against general convex
// objects, 2004; E. Gilbert, D. Johnson, S. Keerthi, 1988, for the nearest point).
//
// It stops a little before they touch: where the distance is 2^-16 of the shapes' size, or r if that is more, the nearest
// feature of D is well known. It is one, two or three differences. When the line meets what is within r of that feature is a
// root of a quadratic, or a quotient, in numbers with running errors (arithmetic/estimate.hpp); the foot has to be inside for
// certain. The feature is a part of D, so they touch no later than that. Across it, all other differences are compared: so
// they touch no sooner than some other time. If both agree but for rounding, they are the bounds. If not, the search goes on
// nearer to D.
//
// If each difference that is no part of the feature is behind it for certain, the time is that of the feature, to all digits.
// Pairs of doubles nearly always tell how that is rounded.
//
// Errors. Let u = 2^-53 and s the largest coordinate of a point, seen from one of the core that goes, or of the way. Points
// are off by u of themselves, a product of three terms with a direction n by less than 4u of the magnitudes' products, so
// n . d by less than 16u |n| s. The code takes 2^-46 |n| s, as for what is added to it.
//
// All operations are rounded one by one, so that points and normals have the same bits everywhere.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/narrow/plain_sweep.hpp>
#include <abut/narrow/solid_hit_time.hpp>
#include <abut/predicate/exact_sweep.hpp>
#include <abut/predicate/line_solid.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// The points of a core as they are seen from some point; the first few are kept.
template <scalar T>
class core_seen {
public:
    using point = vec3<double>;
    ABUT_HD constexpr core_seen(const hull<T>& h, const point& from) : of_(h), from_(from) {
        const std::size_t n = least(h.count, room);
        for (std::size_t i = 0; i < n; ++i) kept_[i] = contact_math::plain_difference(widened(h[i]), from);
    }
    [[nodiscard]] ABUT_HD constexpr std::uint32_t size() const { return static_cast<std::uint32_t>(of_.count); }
    [[nodiscard]] ABUT_HD constexpr point operator[](std::uint32_t i) const {
        return i < room ? kept_[i] : contact_math::plain_difference(widened(of_[i]), from_);
    }
    [[nodiscard]] ABUT_HD constexpr double largest() const {
        double far = 0;
        for (std::uint32_t i = 0; i < size(); ++i) far = greatest(far, contact_math::largest_of((*this)[i]));
        return far;
    }
    /// The first of those farthest along a way.
    [[nodiscard]] ABUT_HD constexpr std::uint32_t farthest(const point& n) const {
        std::uint32_t best = 0;
        double most = contact_math::plain_dot(n, kept_[0]);
        for (std::uint32_t i = 1; i < size(); ++i) {
            const double x = contact_math::plain_dot(n, (*this)[i]);
            if (x > most) most = x, best = i;
        }
        return best;
    }

private:
    static constexpr std::size_t room = 8;
    const hull<T>& of_;
    point from_, kept_[room]{};
};

/// An `estimate` whose operations are rounded one by one, so that what it decides is decided alike everywhere: what a point and
/// a normal are made of depends on it.
struct plain_estimate {
    double value, error;

    ABUT_HD friend constexpr plain_estimate operator+(const plain_estimate& a, const plain_estimate& b) {
        return sum(plain_sum(a.value, b.value), plain_sum(a.error, b.error));
    }
    ABUT_HD friend constexpr plain_estimate operator-(const plain_estimate& a) { return {-a.value, a.error}; }
    ABUT_HD friend constexpr plain_estimate operator-(const plain_estimate& a, const plain_estimate& b) { return a + -b; }
    ABUT_HD friend constexpr plain_estimate operator*(const plain_estimate& a, const plain_estimate& b) {
        return sum(plain_product(a.value, b.value),
                   plain_sum(plain_product(absolute(a.value), b.error),
                             plain_product(a.error, plain_sum(absolute(b.value), b.error))));
    }
    ABUT_HD friend constexpr plain_estimate operator/(const plain_estimate& a, const plain_estimate& b) {
        const double divisor = plain_sum(absolute(b.value), -plain_product(1 + 0x1p-30, b.error)), v = a.value / b.value,
                     size = absolute(v);
        if (a.value == 0 && a.error == 0 && divisor > 0) return {0, 0};
        if (!(divisor > 0 && size > 0x1p-900 && size < 0x1p900)) return {0, infinity<double>};
        return sum(v, plain_sum(a.error, plain_product(size, b.error)) / divisor);
    }

private:
    /// With what rounding may add.
    ABUT_HD static constexpr plain_estimate sum(double v, double lost) {
        return {v, plain_sum(lost, plain_product(estimate::roundoff, absolute(v)))};
    }
};
ABUT_HD constexpr plain_estimate root_of(const plain_estimate& x) {
    if (x.value == 0) return {0, 0};
    const double v = contact_math::root(contact_math::one_double{x.value}).high;
    return {v, plain_sum(x.error / v, plain_product(estimate::roundoff, v))};
}
ABUT_HD constexpr int sign_or_unknown(const plain_estimate& x) {
    const double error = plain_product(1 + 0x1p-30, x.error);
    return x.value > error ? 1 : x.value < -error ? -1 : x.error == 0 ? 0 : unknown_sign;
}

/// Up to three differences of points b and a, by their numbers.
struct sweep_feature {
    std::uint32_t a[3]{}, b[3]{};
    int count = 0;
};

/// When the origin, going along `way`, comes within r of a feature with the differences p, and whether it does for certain:
/// its foot is inside then. In estimates of some kind.
template <class E>
struct feature_entry {
    verdict met = verdict::unknown;
    E time{};

    ABUT_HD constexpr feature_entry(const vec3<E> (&p)[3], int count, const vec3<E>& way, const E& r) {
        const E rr = r * r;
        if (count == 1) {
            meet(dot(way, way), dot(p[0], way), dot(p[0], p[0]), rr, squared(cross(way, p[0])));
        } else if (count == 2) {
            const vec3<E> e = p[1] - p[0], across = cross(way, e), from = cross(p[0], e);
            const E ee = dot(e, e), height = dot(p[0], across);
            meet(dot(across, across), dot(from, across), dot(from, from), rr * ee, ee * (height * height));
            if (met != verdict::yes) return;
            const E along = time * dot(way, e) - dot(p[0], e);
            met = is_positive(along) && is_positive(ee - along);
        } else {
            const vec3<E> u = p[1] - p[0], v = p[2] - p[0], n = cross(u, v);
            E height = dot(n, p[0]), speed = dot(n, way);
            const int side = sign_or_unknown(height);
            if (side != 1 && side != -1) return;
            if (side < 0) height = -height, speed = -speed;
            const E nn = dot(n, n), over = height - r * root_of(nn);
            if (is_positive(nn) != verdict::yes || is_positive(over) != verdict::yes || is_positive(speed) != verdict::yes) return;
            time = over / speed;
            const vec3<E> c{time * way.x - p[0].x, time * way.y - p[0].y, time * way.z - p[0].z};
            const E along_u = dot(n, cross(c, v)), along_v = dot(n, cross(u, c));
            met = is_positive(along_u) && is_positive(along_v) && is_positive(nn - along_u - along_v);
        }
        if (met == verdict::no) met = verdict::unknown;
    }

private:
    ABUT_HD static constexpr E squared(const vec3<E>& v) { return dot(v, v); }
    /// The lesser root of ww t^2 - 2 wp t + pp - rr, where `off` is ww pp - wp wp.
    ABUT_HD constexpr void meet(const E& ww, const E& wp, const E& pp, const E& rr, const E& off) {
        const E outside = pp - rr, inside = rr * ww - off;
        if (is_positive(outside) != verdict::yes || is_positive(wp) != verdict::yes || is_positive(inside) != verdict::yes) return;
        time = outside / (wp + root_of(inside));
        met = verdict::yes;
    }
};

/// What is known of a sweep.
template <scalar T>
class sweep_search {
    using point = vec3<double>;

public:
    verdict met = verdict::unknown;       ///< yes: they touch at a time from first to last; no: not until the end
    double first = 0, last = 1;           ///< times
    double time = 0;                      ///< where the search came to
    sweep_feature feature;                ///< of the differences there
    point normal{0, 0, 0};                ///< from the shape that goes to the other one, of any length; zero if it is not known
    point on_b{0, 0, 0};                  ///< where on the core that is met, if it is settled
    double gap_at_start = infinity<double>;  ///< between the cores, where they touch at the start
    bool is_settled = false;              ///< whether time and feature are those of the first touch, but for rounding

    /// Looks for a touch until `until`, which is 1 or less.
    ABUT_HD constexpr sweep_search(const cores_on_way<T>& x, double until)
        : x_(x), from_(widened(x.a[0])), a_(x.a, from_), b_(x.b, from_), way_(widened(x.way)),
          r_(plain_sum(static_cast<double>(x.radius_a), static_cast<double>(x.radius_b))) {
        extent_ = greatest(a_.largest(), b_.largest());
        size_ = greatest(extent_, contact_math::largest_of(way_), r_);
        if (is_searched(size_)) look(until);
    }

    /// Before that they do not touch, for certain.
    [[nodiscard]] ABUT_HD constexpr double apart_until() const { return apart_until_; }
    /// When they touch, rounded to the nearest double, where pairs of doubles tell; else a negative number.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr double rounded_time() const {
        if (met != verdict::yes) return -1;
        if (last == 0) return 0;
        if (!is_settled || !is_alone()) return -1;
        const feature_entry<fine_estimate> entry = enter<101>(make_fine_estimate{});
        return detail::rounded_time(line_entry<fine_estimate>{entry.met, 0, entry.time});
    }

    /// Where they are nearest at a time at which they touch, where nothing better is known.
    ABUT_NOINLINE ABUT_HD constexpr void come_near(double at) {
        using namespace contact_math;
        if (is_settled || !is_searched(size_)) return;
        plain_simplex s;
        point along = is_zero(normal) ? way_between_first() : normal;
        for (int step = 0; step < 48; ++step) {
            const std::uint32_t i = a_.farthest(along), j = b_.farthest(negated(along));
            const point tag{static_cast<double>(i), static_cast<double>(j), 0};
            bool is_there = false;
            for (int k = 0; k < s.count; ++k) is_there = is_there || s.on_a[k] == tag;
            if (is_there || s.append(tag, tag, plain_step(plain_difference(b_[j], a_[i]), -at, way_)) != plain_simplex::result::nearer) break;
            along = s.along;
        }
        point sum = b_[numbers_in(s, 0).b];
        for (int k = 1; k < s.count; ++k) sum = plain_step(sum, s.weight[k], plain_difference(b_[numbers_in(s, k).b], b_[numbers_in(s, 0).b]));
        on_b = sum;
        if (s.count < 4 && s.square > plain_product(plain_product(0x1p-60, size_), size_)) normal = s.mean;
        if (s.count == 4 && at == 0) normal = {0, 0, 0};
        if (at == 0) gap_at_start = s.count < 4 ? root(one_double{s.square}).high : 0;
    }

private:
    static constexpr double share = share_of_sweeps;

    [[nodiscard]] ABUT_HD constexpr point way_between_first() const {
        const point along = contact_math::plain_difference(b_[0], a_[0]);
        return contact_math::is_zero(along) ? point{1, 0, 0} : along;
    }

    /// Whether the face of a triangle is what is touched, which is then settled: most often it is. Its normal, towards the triangle,
    /// becomes the direction with which the search begins.
    ABUT_HD constexpr bool face_comes_first(point& along, double until) {
        using namespace contact_math;
        const point e = plain_difference(b_[1], b_[0]), f = plain_difference(b_[2], b_[0]), across = plain_cross(e, f);
        const double nn = plain_dot(across, across);
        if (!(nn > 0)) return false;
        const point n = plain_dot(across, plain_difference(b_[0], a_[0])) < 0 ? negated(across) : across;
        along = n;
        const std::uint32_t i = a_.farthest(n);
        const point from = plain_difference(b_[0], a_[i]);
        const double over = plain_sum(plain_dot(n, from), -plain_product(r_, root(one_double{nn}).high)), speed = plain_dot(n, way_);
        if (!(over >= 0 && over < plain_product(until, speed))) return false;
        const point c = plain_difference(plain_step({0, 0, 0}, over / speed, way_), from);
        const double along_e = plain_dot(across, plain_cross(c, f)), along_f = plain_dot(across, plain_cross(e, c));
        if (!(along_e > 0 && along_f > 0 && plain_sum(along_e, along_f) < nn)) return false;
        feature = {{i, i, i}, {0, 1, 2}, 3};
        return settle(until);
    }

    ABUT_HD constexpr void look(double until) {
        using namespace contact_math;
        point along = way_between_first();
        if (b_.size() == 3) {
            const point corners[3] = {b_[0], b_[1], b_[2]};
            if (apart_from_triangle(a_, corners, way_, r_, size_, until) == infinity<double>) {
                met = verdict::no;
                return;
            }
            if (face_comes_first(along, until)) return;
        }
        double stop = greatest(r_, plain_product(0x1p-16, extent_));
        plain_simplex s;
        for (int step = 0; step < 96; ++step) {
            const double of_n = root(one_double{plain_dot(along, along)}).high;
            if (!(of_n > 0x1p-600)) return stop_at(s);
            const std::uint32_t i = a_.farthest(along), j = b_.farthest(negated(along));
            const point d = plain_difference(b_[j], a_[i]);
            const double ahead = plain_dot(along, d), speed = plain_dot(along, way_),
                         off = plain_product(plain_product(share, of_n), size_);
            const double gap = plain_sum(plain_sum(ahead, -plain_product(r_, of_n)), -off);
            if (are_apart(gap, speed, off, until)) {
                met = verdict::no;
                return;
            }
            const double reach = plain_product(stop, of_n), beyond = plain_sum(plain_sum(ahead, -plain_product(time, speed)), -reach);
            const bool advances = speed > 0 && beyond > plain_sum(plain_product(0x1p-20, reach), off);
            if (advances) {
                normal = along;
                time = least(plain_sum(ahead, -reach) / speed, 1.0);
                s = plain_simplex();
            }
            const point seen = plain_step(d, -time, way_);
            const point tag{static_cast<double>(i), static_cast<double>(j), 0};
            bool has_come = false;
            if (s.count > 0) {
                const double length = root(one_double{s.square}).high;
                has_come = plain_sum(length, -(plain_dot(along, seen) / of_n)) <= plain_product(0x1p-48, size_);
                for (int k = 0; k < s.count; ++k) has_come = has_come || s.on_a[k] == tag;
            }
            if (!has_come) {
                const auto result = s.append(tag, tag, seen);
                if (result == plain_simplex::result::holds_origin) return stop_at(s);
                along = s.along;
                has_come = result == plain_simplex::result::no_nearer;
            }
            if (!has_come) continue;
            if (time == 0 && touch_at_start(s)) return;
            keep(s);
            if (settle(until)) return;
            if (!(stop > r_) || stop < plain_product(0x1p-40, size_)) return stop_at(s);
            stop = greatest(r_, plain_product(0x1p-6, stop));
        }
        stop_at(s);
    }

    /// Whether a way along which all differences are `gap` farther ahead than r at the start, for certain, and come nearer at
    /// a speed, proves that they are apart until then. From a time until which they are known to be, which it may advance.
    ABUT_HD constexpr bool are_apart(double gap, double speed, double off, double until) {
        const auto apart_at = [&](double t) { return plain_sum(gap, -plain_product(t, speed)) > 0; };
        if (!apart_at(apart_until_)) return false;
        if (apart_at(until)) return true;
        apart_until_ = greatest(apart_until_, plain_product(gap / plain_sum(speed, off), 1 - 0x1p-50));
        return false;
    }

    /// Where cores overlap, or nothing more is found out.
    ABUT_HD constexpr void stop_at(const plain_simplex& s) {
        if (s.count == 4 && time == 0 && hold_origin<T>(s.w)) met = verdict::yes, last = 0;
    }
    struct pair_of_numbers {
        std::uint32_t a, b;
    };
    ABUT_HD static constexpr pair_of_numbers numbers_in(const plain_simplex& s, int k) {
        return {static_cast<std::uint32_t>(s.on_a[k].x), static_cast<std::uint32_t>(s.on_a[k].y)};
    }
    ABUT_HD constexpr void keep(const plain_simplex& s) {
        feature.count = least(s.count, 3);
        for (int k = 0; k < feature.count; ++k) {
            const pair_of_numbers of = numbers_in(s, k);
            feature.a[k] = of.a, feature.b[k] = of.b;
        }
    }
    /// Whether the nearest points are within r at the start for certain.
    ABUT_HD constexpr bool touch_at_start(const plain_simplex& s) {
        using namespace contact_math;
        const double length = root(one_double{s.square}).high;
        if (!(plain_sum(length, plain_product(share, size_)) < r_)) return false;
        met = verdict::yes;
        last = 0;
        return true;
    }

    /// The entry into the feature, by numbers as they were given.
    template <int Digits, class Make>
    [[nodiscard]] ABUT_HD constexpr auto enter(const Make& make) const {
        using E = decltype(make(1.0));
        T value[23]{};
        for (int k = 0; k < 3; ++k) {
            const int of = k < feature.count ? k : 0;
            const vec3<T> p = x_.a[feature.a[of]], q = x_.b[feature.b[of]];
            const T numbers[] = {p.x, p.y, p.z, q.x, q.y, q.z};
            for (int c = 0; c < 6; ++c) value[6 * k + c] = numbers[c];
        }
        value[18] = x_.way.x, value[19] = x_.way.y, value[20] = x_.way.z, value[21] = x_.radius_a, value[22] = x_.radius_b;
        const double unit = unit_of_estimates<8, Digits>(value);
        const auto number = [&](int i) { return make(plain_product(static_cast<double>(value[i]), unit == 0 ? 1 : unit)); };
        vec3<E> p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = {number(6 * k + 3) - number(6 * k), number(6 * k + 4) - number(6 * k + 1), number(6 * k + 5) - number(6 * k + 2)};
        }
        feature_entry<E> entry(p, feature.count, {number(18), number(19), number(20)}, number(21) + number(22));
        if (unit == 0) entry.met = verdict::unknown;
        return entry;
    }

    /// Whether the feature is the one that is touched first: then bounds are set, if they do not hold the end.
    ABUT_HD constexpr bool settle(double until) {
        using namespace contact_math;
        const feature_entry<plain_estimate> entry = enter<52>([](double v) { return plain_estimate{v, 0}; });
        if (entry.met != verdict::yes) return false;
        const double at = entry.time.value, lost = plain_product(1 + 0x1p-30, entry.time.error);
        if (!(lost < infinity<double> && at < 4)) return false;
        // Across the feature, where the line comes to it.
        point p[3]{};
        for (int k = 0; k < feature.count; ++k) p[k] = plain_difference(b_[feature.b[k]], a_[feature.a[k]]);
        const point seen = plain_step(p[0], -at, way_), e = plain_difference(p[1], p[0]);
        point n = seen;
        double weight[3] = {0, 0, 0};
        if (feature.count == 2) {
            weight[1] = -plain_dot(seen, e) / plain_dot(e, e);
            n = plain_cross(e, plain_cross(seen, e));
        } else if (feature.count == 3) {
            const point f = plain_difference(p[2], p[0]), c = negated(seen);
            n = plain_cross(e, f);
            const double nn = plain_dot(n, n);
            weight[1] = plain_dot(n, plain_cross(c, f)) / nn;
            weight[2] = plain_dot(n, plain_cross(e, c)) / nn;
            if (plain_dot(n, p[0]) < 0) n = negated(n);
        }
        const double of_n = root(one_double{plain_dot(n, n)}).high, speed = plain_dot(n, way_);
        if (!(of_n > 0x1p-600)) return false;
        const std::uint32_t i = a_.farthest(n), j = b_.farthest(negated(n));
        const double ahead = plain_dot(n, plain_difference(b_[j], a_[i])), off = plain_product(plain_product(share, of_n), size_);
        const double gap = plain_sum(plain_sum(ahead, -plain_product(r_, of_n)), -off);
        if (are_apart(gap, speed, off, until)) {
            met = verdict::no;
            return true;
        }
        if (!(speed > off)) return false;
        const double soonest = apart_until_;
        // The axis is known to some digits. Where the feature is not touched first, another one is ahead by more than that.
        if (!(plain_sum(at, -soonest) <= plain_sum(plain_product(0x1p-36, at), 64 * off / speed))) return false;
        is_settled = true;
        time = least(at, 1.0);
        normal = n;
        on_b = b_[feature.b[0]];
        for (int k = 1; k < feature.count; ++k) on_b = plain_step(on_b, weight[k], plain_difference(b_[feature.b[k]], b_[feature.b[0]]));
        first = soonest;
        last = plain_sum(at, lost);
        if (first > 1) met = verdict::no;
        if (last <= 1) met = verdict::yes;
        return true;
    }

    /// Whether all other differences are behind the feature, for certain. Those of the feature are at one height if its points
    /// are linked, each to the next by a point that both have.
    [[nodiscard]] ABUT_HD constexpr bool is_alone() const {
        using namespace contact_math;
        int of_a = 0, of_b = 0;
        for (int k = 0; k < feature.count; ++k) {
            bool new_a = true, new_b = true;
            for (int l = 0; l < k; ++l) {
                new_a = new_a && feature.a[l] != feature.a[k];
                new_b = new_b && feature.b[l] != feature.b[k];
            }
            of_a += new_a ? 1 : 0, of_b += new_b ? 1 : 0;
        }
        if (of_a + of_b != feature.count + 1) return false;
        const double off = 2 * plain_product(plain_product(share, root(one_double{plain_dot(normal, normal)}).high), size_);
        return are_behind(a_, feature.a, negated(normal), off) && are_behind(b_, feature.b, normal, off);
    }
    /// Whether all points but those of the feature are ahead along a way.
    [[nodiscard]] ABUT_HD constexpr bool are_behind(const core_seen<T>& c, const std::uint32_t (&of)[3], const point& n,
                                                    double off) const {
        const double height = contact_math::plain_dot(n, c[of[0]]);
        for (std::uint32_t i = 0; i < c.size(); ++i) {
            const point p = c[i];
            bool is_of = false;
            for (int k = 0; k < feature.count; ++k) is_of = is_of || of[k] == i;
            if (!is_of && !(plain_sum(contact_math::plain_dot(n, p), -height) > off)) return false;
        }
        return true;
    }

    const cores_on_way<T>& x_;
    point from_;
    core_seen<T> a_, b_;
    point way_;
    double r_, extent_ = 0, size_ = 0, apart_until_ = 0;
};

}  // namespace abut::detail
