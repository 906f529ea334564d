// SPDX-License-Identifier: MIT
#pragma once

// When a shape that goes along a vector touches a plane or a half space first, and where. For shapes that have a core of points; and
// for planes and half spaces that go, which the others meet as if these went back.
//
// Let n . x = d be the plane, w the way, and r the radius around the core. A point p of the core is at the height n . p - d, times the
// length of n, and rises by n . w. So of all points the lowest comes to the plane first from above, and the highest from below. The
// shape has come there where that height is r |n|. That is a quotient of sums of products, or with a radius a root of a quadratic:
// narrow/solid_hit_time.hpp says how such times are rounded. Doubles tell two times between which it is, pairs of doubles how it is
// rounded, and where these do not, integers do. A root is found among all doubles by halving their number: at the time t it has been
// passed if the height is not above 0, or its square not above that of r n.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/solid_hit_time.hpp>
#include <abut/narrow/sweep_search.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/half_space.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/swept.hpp>

namespace abut::detail {

template <class S>
concept flat = flat_or_half_space<S, scalar_type_of<S>>;

/// A shape with a core, and a plane or a half space, of one scalar type; either goes.
///@{
template <class S, class U>
concept sweepable_to_flat = flat<U> && has_core_points<S, scalar_type_of<U>>;
template <class S, class U>
concept sweepable_flat = sweepable_to_flat<S, U> || sweepable_to_flat<U, S>;
///@}

/// A core that goes along a way, the radius around it, and a plane, or all below it.
template <scalar T>
struct flat_on_way {
    const hull<T>& core;
    T radius;
    vec3<T> way;
    plane<T> met;
    bool is_solid;

    /// Whether products of four numbers neither overflow nor lose anything to underflow. Zeros are zeros by their bits.
    [[nodiscard]] ABUT_HD constexpr bool is_moderate() const {
        bool is = is_moderate(met.normal) && is_moderate(met.offset) && is_moderate(way) && is_moderate(radius);
        for (std::size_t i = 0; i < core.count && is; ++i) is = is_moderate(core[i]);
        return is;
    }

private:
    ABUT_HD static constexpr bool is_moderate(T x) {
        const double size = absolute(static_cast<double>(x));
        return is_zero(x) || (size > 0x1p-200 && size < 0x1p200);
    }
    ABUT_HD static constexpr bool is_moderate(const vec3<T>& v) { return is_moderate(v.x) && is_moderate(v.y) && is_moderate(v.z); }
};

/// f(flat_on_way) of a shape on its way and a plane or a half space, or the other way round.
template <class S, class U, class F>
ABUT_HD constexpr auto with_flat_on_way(const swept<S>& s, const U& t, const F& f) {
    using T = scalar_type_of<S>;
    constexpr bool goes_back = flat<S>;
    const auto points = [&] {
        if constexpr (goes_back) {
            return core_points_of(t);
        } else {
            return core_points_of(s.start);
        }
    }();
    const hull<T>& core = points.as_hull();
    if constexpr (goes_back) {
        const vec3<T> back{-s.way.x, -s.way.y, -s.way.z};
        const flat_on_way<T> both{core, radius_around_core(t), back, {s.start.normal, s.start.offset}, is_half_space<S>};
        return f(both);
    } else {
        const flat_on_way<T> both{core, radius_around_core(s.start), s.way, {t.normal, t.offset}, is_half_space<U>};
        return f(both);
    }
}

/// When the plane is reached, and whether: at the start if `time` is 0, and perhaps after 1.
template <class E>
struct flat_entry {
    verdict met = verdict::unknown;
    E time{};
};

ABUT_HD constexpr double value_of(const plain_estimate& x) { return x.value; }

template <scalar T, class Make>
ABUT_HD constexpr auto flat_entry_of(const flat_on_way<T>& x, const Make& make) {
    using E = decltype(make(1.0));
    flat_entry<E> entry;
    if (!x.is_moderate()) return entry;
    const auto in = [&](const vec3<T>& v) {
        return vec3<E>{make(static_cast<double>(v.x)), make(static_cast<double>(v.y)), make(static_cast<double>(v.z))};
    };
    const vec3<E> n = in(x.met.normal);
    const E offset = make(static_cast<double>(x.met.offset));
    E lowest = dot(n, in(x.core[0])) - offset, highest = lowest;
    double lost = lowest.error;
    for (std::size_t i = 1; i < x.core.count; ++i) {
        const E height = dot(n, in(x.core[i])) - offset;
        if (value_of(height - lowest) < 0) lowest = height;
        if (value_of(height - highest) > 0) highest = height;
        lost = greatest(lost, height.error);
    }
    lowest.error = lost, highest.error = lost;
    const E reach = make(static_cast<double>(x.radius)) * root_of(dot(n, n)), speed = dot(n, in(x.way)), over = lowest - reach,
            under = -highest - reach;
    const verdict above = is_positive(over), below = x.is_solid ? verdict::no : is_positive(under);
    if (above == verdict::no && below == verdict::no) {
        entry.met = verdict::yes;
        return entry;
    }
    if (above != verdict::yes && below != verdict::yes) return entry;
    const E ahead = above == verdict::yes ? -speed : speed;
    entry.met = is_positive(ahead);
    if (entry.met == verdict::yes) entry.time = (above == verdict::yes ? over : under) / ahead;
    return entry;
}

/// In doubles: negative if they do not touch until then, and any time from 0 to infinity where doubles do not tell.
template <scalar T>
ABUT_HD constexpr time_bounds flat_time_bounds(const flat_on_way<T>& x, double until) {
    const auto entry = flat_entry_of(x, [](double v) { return plain_estimate{v, 0}; });
    if (entry.met == verdict::no) return {-1, -1};
    if (entry.met == verdict::unknown) return {0, infinity<double>};
    const double at = entry.time.value, lost = plain_product(1 + 0x1p-30, entry.time.error);
    const time_bounds between{greatest(plain_sum(at, -lost), 0.0), plain_sum(at, lost)};
    if (between.first > until) return {-1, -1};
    return between.last <= 1 ? between : time_bounds{0, infinity<double>};
}

/// n . (p - q) > 0
struct higher_along {
    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[9]) {
        const vec3<N> n = point_at(value, 0), p = point_at(value, 1), q = point_at(value, 2);
        return sign(dot(n, p - q)) > 0;
    }
};
/// The first of the lowest points over a plane, or of the highest ones for a sense of 1.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr vec3<T> outermost(const hull<T>& h, const vec3<T>& normal, int sense) {
    vec3<T> best = h[0];
    for (std::size_t i = 1; i < h.count; ++i) {
        const vec3<T> p = h[i];
        const auto values = sense > 0 ? in_a_row(normal, p, best) : in_a_row(normal, best, p);
        if (decide_at_any_length<higher_along>(values.value)) best = p;
    }
    return best;
}

/// A point and a radius around it that come to a plane from above, or for a sense of -1 from below, in integers.
template <scalar T>
class flat_in_integers {
    static constexpr int most = float_format<T>::max_exponent + float_format<T>::digits - float_format<T>::min_exponent,
                         room = (most + spare_bits_of_length + 63) / 64, time_room = 18;
    using fraction = long_fraction<time_room>;

public:
    ABUT_HD constexpr flat_in_integers(const flat_on_way<T>& x, const vec3<T>& p, int sense) {
        const auto values = in_a_row(x.met.normal, x.met.offset, T(1), p, x.way, x.radius);
        const aligned<12> a(values.value);
        const int width = a.width() > 0 ? a.width() : 0, limbs = (width + spare_bits_of_length + 63) / 64;
        rolled_int<room> n[3], from[3], way[3], offset, one, radius;
        const auto set = [&](rolled_int<room>& to, int i) {
            to.begin(limbs);
            to.add(a, i);
        };
        for (int k = 0; k < 3; ++k) set(n[k], k), set(from[k], 5 + k), set(way[k], 8 + k);
        set(offset, 3), set(one, 4), set(radius, 11);
        height_.clear(2 * limbs);
        ahead_.clear(2 * limbs);
        for (int k = 0; k < 3; ++k) {
            height_.add(n[k], from[k], sense < 0);
            ahead_.add(n[k], way[k], sense > 0);
        }
        height_.add(offset, one, sense > 0);
        rolled_int<2 * room> nn, rr;
        nn.clear(2 * limbs);
        for (int k = 0; k < 3; ++k) nn.add(n[k], n[k]);
        rr.clear(2 * limbs);
        rr.add(radius, radius);
        reach_.clear(4 * limbs);
        reach_.add(nn, rr);
        is_point_ = rr.sign() == 0;
    }
    /// Whether it has not come there at the start.
    [[nodiscard]] ABUT_HD constexpr bool is_clear() const {
        fraction start;
        start.set(0, 1);
        return !has_come_by(start);
    }
    [[nodiscard]] ABUT_HD constexpr bool comes() const {
        fraction end;
        end.set(1, 1);
        return ahead_.sign() > 0 && has_come_by(end);
    }
    /// When it comes there, which it does, rounded to the nearest double, of two that are as near to the lesser.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr double time() {
        if (is_point_) return rounded_quotient(height_, ahead_);
        std::uint64_t low = 0, high = 0x3ff0000000000000;
        ABUT_ROLLED
        while (low < high) {
            const std::uint64_t middle = low + (high - low) / 2;
            fraction halfway;
            set_halfway(middle, halfway);
            if (has_come_by(halfway)) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        return ABUT_BIT_CAST(double, low);
    }

private:
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool has_come_by(const fraction& z) const {
        rolled_int<2 * room + time_room> height;
        height.clear(height_.count + z.under.count);
        height.add(height_, z.under);
        height.add(ahead_, z.over, true);
        if (height.sign() <= 0) return true;
        if (is_point_) return false;
        rolled_int<2 * time_room> under;
        rolled_int<4 * room + 2 * time_room> left;
        set_product(under, z.under, z.under);
        left.clear(reach_.count + under.count);
        left.add(height, height);
        left.add(reach_, under, true);
        return left.sign() <= 0;
    }

    rolled_int<2 * room> height_, ahead_;
    rolled_int<4 * room> reach_;
    bool is_point_ = false;
};

/// f(the point that comes there first, in integers) where they do not touch at the start; else `at_start`.
template <scalar T, class R, class F>
ABUT_HD constexpr R with_first_to_come(const flat_on_way<T>& x, R at_start, const F& f) {
    flat_in_integers<T> from_above(x, outermost(x.core, x.met.normal, -1), 1);
    if (from_above.is_clear()) return f(from_above);
    if (x.is_solid) return at_start;
    flat_in_integers<T> from_below(x, outermost(x.core, x.met.normal, 1), -1);
    return from_below.is_clear() ? f(from_below) : at_start;
}
/// By integers, of any finite input; negative if they do not touch by 1.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr double exact_flat_time(const flat_on_way<T>& x) {
    return with_first_to_come(x, 0.0, [](flat_in_integers<T>& first) { return first.comes() ? first.time() : -1; });
}
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool touches_flat(const flat_on_way<T>& x) {
    return with_first_to_come(x, true, [](flat_in_integers<T>& first) { return first.comes(); });
}

/// When they touch first, as sweep_time.
template <arithmetic A, scalar T>
ABUT_HD constexpr double flat_time(const flat_on_way<T>& x) {
    if (!std::same_as<A, exact> && !ABUT_CONSTANT_EVALUATED()) {
        const time_bounds between = flat_time_bounds(x, 1);
        if (between.first < 0 || between.last == 0) return between.first;
        if (between.last <= 1) {
            if constexpr (std::same_as<A, fast>) return plain_sum(0.5 * between.first, 0.5 * between.last);
            const auto entry = flat_entry_of(x, make_fine_estimate{});
            const double time = rounded_time(line_entry<fine_estimate>{entry.met, 0, entry.time});
            if (time >= 0) return time;
        }
    }
    return exact_flat_time(x);
}

/// Where a core that goes touches a plane at a time: on the plane, as seen from the core's first point, and the normal to the side that
/// the core comes from. In doubles, in one order of operations.
struct flat_place {
    vec3<double> on, normal;
};
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr flat_place flat_place_of(const flat_on_way<T>& x, double time) {
    using namespace contact_math;
    const point none{0, 0, 0}, given = widened(x.met.normal), from = widened(x.core[0]), gone = plain_step(none, time, widened(x.way));
    if (largest_of(given) == 0) return {none, none};
    const int of_normal = exponent_of(largest_of(given));
    const point n = scaled(given, -of_normal);
    const double length = root(one_double{plain_dot(n, n)}).high, offset = scaled(static_cast<double>(x.met.offset), -of_normal) / length;
    const point unit{n.x / length, n.y / length, n.z / length};
    const auto height_of = [&](const point& p) { return plain_sum(plain_dot(unit, p), -offset); };
    point low = from, high = from;
    for (std::size_t i = 1; i < x.core.count; ++i) {
        const point p = widened(x.core[i]);
        if (plain_dot(unit, p) < plain_dot(unit, low)) low = p;
        if (plain_dot(unit, p) > plain_dot(unit, high)) high = p;
    }
    const double lowest = height_of(low), highest = height_of(high);
    const bool comes = time > 0, falls = plain_dot(unit, gone) < 0, is_over = x.is_solid || (comes ? falls : lowest >= 0 && highest > 0),
               is_under = !is_over && (comes || (highest <= 0 && lowest < 0));
    const auto seen = [&](const point& p) { return plain_step(plain_difference(p, from), 1.0, gone); };
    if (!is_over && !is_under) {
        const double rise = plain_sum(highest, -lowest);
        return {plain_step(seen(low), rise > 0 ? -lowest / rise : 0, plain_difference(high, low)), none};
    }
    const point nearest = is_over ? low : high;
    const double height = height_of(plain_step(nearest, 1.0, gone));
    const bool is_inside = x.is_solid && height < 0;
    return {plain_step(seen(nearest), is_inside ? 0 : -height, unit), is_over ? unit : negated(unit)};
}

}  // namespace abut::detail
