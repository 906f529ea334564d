// SPDX-License-Identifier: MIT
#pragma once

// When a ray meets a triangle: the least t >= 0 at which origin + t direction is in it; and a segment alike, as a + t (b -
// a).
//
// `filtered` and `exact` give the true t, rounded to the nearest double; of two that are as near the lesser. So equal times
// are equal numbers, however they were computed: two faces at an edge are met at one time by a ray through the edge. A pair
// of doubles tells nearly always how t is rounded. Where it does not, integers do (narrow/exact_hit_time.hpp).
//
// Which of two shapes is met first needs less: single doubles tell two times between which t lies (`hit_time_bounds`), and
// only where these overlap is t rounded.
//
// Errors. Let p be the product of the sums of magnitudes of three vectors whose determinant is computed: sums of products of
// pairs are off by less than 32 2^-106 p in all, of which 2^-98 is taken, for the numerator and the denominator. In doubles
// they are off by less than 20 2^-53 p (predicate/certified_triangles.hpp), of which 2^-48 is taken. Vectors have magnitudes
// between 2^-200 and 2^200, so nothing underflows that matters beside that.

#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/exact_hit_time.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// When a line crosses a plane, and by what share of itself that may be off: 1 where nothing is known.
template <class N>
struct plane_crossing {
    N time;
    double relative;
};

/// In numbers N, whose determinants are off by `error` times the product of magnitudes.
template <class N, scalar T>
ABUT_HD constexpr plane_crossing<N> cross_plane(const line_of<T>& l, const triangle<T>& t, double error) {
    using contact_math::between;
    using contact_math::rounded_off;
    if (std::same_as<T, float> && any_subnormal(in_a_row(l.origin, t.a, t.b, t.c, l.end, l.start).value)) return {{}, 1};
    const vec3<double> a = widened(t.a);
    const auto to_a = between<N>(widened(l.origin), a), f = between<N>(a, widened(t.b)), g = between<N>(a, widened(t.c)),
               along = between<N>(widened(l.start), widened(l.end));
    const double apart = magnitudes(rounded_off(to_a)), length = magnitudes(rounded_off(along)),
                 side = magnitudes(rounded_off(f)), other = magnitudes(rounded_off(g));
    if (!(least(apart, length, side, other) > 0x1p-200 && greatest(apart, length, side, other) < 0x1p200)) return {{}, 1};
    const auto n = cross(f, g);
    const N height = dot(n, to_a), speed = dot(n, along), time = height / speed;
    const double off = error * (side * other);
    const double relative = off * apart / absolute(height.high) + off * length / absolute(speed.high) + error;
    return {time, relative < 0.5 ? 2 * relative : 1};
}

/// The time at which the line crosses the plane, or a negative number if pairs of doubles do not tell how it is rounded.
template <scalar T>
ABUT_HD constexpr double crossing_in_pairs(const line_of<T>& l, const triangle<T>& t) {
    const auto [time, relative] = cross_plane<contact_math::two_doubles>(l, t, 0x1p-98);
    if (!(relative < 0x1p-59)) return -1;
    const double lost = relative * time.high;
    const bool is_certain = plain_sum(time.high, plain_sum(time.low, lost)) == time.high &&
                            plain_sum(time.high, plain_sum(time.low, -lost)) == time.high;
    return is_certain && time.high > smallest_normal<double> && time.high <= largest_finite<double> ? time.high : -1;
}

/// Two times between which a shape is met, or a negative `first` if it is not met.
struct time_bounds {
    double first, last;

    [[nodiscard]] ABUT_HD constexpr bool is_one() const { return first == last; }
};

/// Around a time that may be off by a share of itself, or negative ones where that leaves the range.
ABUT_HD constexpr time_bounds bounds_around(double time, double relative) {
    const double lost = plain_product(relative, time);
    const time_bounds between{plain_sum(time, -lost), plain_sum(time, lost)};
    return between.first > smallest_normal<double> && between.last <= largest_finite<double> ? between : time_bounds{-1, -1};
}

/// The same in doubles: two times between which the line crosses the plane, or negative ones if nothing is known.
template <scalar T>
ABUT_HD constexpr time_bounds crossing_in_doubles(const line_of<T>& l, const triangle<T>& t) {
    const auto [time, relative] = cross_plane<contact_math::one_double>(l, t, 0x1p-48);
    if (!(relative < 0x1p-8)) return {-1, -1};
    return bounds_around(time.high, relative);
}

/// The same of what the filter of a ray and a triangle knows.
ABUT_HD constexpr time_bounds crossing_of(const plane_approach& met) {
    const double relative =
        2 * (met.error_of_height / absolute(met.height) + met.error_of_speed / absolute(met.speed) + 0x1p-48);
    if (!(relative < 0x1p-7)) return {-1, -1};
    return bounds_around(met.height / met.speed, relative);
}

/// The same by integers.
template <class Line, scalar T>
ABUT_NOINLINE ABUT_HD constexpr double exact_hit_time(const Line& line, const triangle<T>& t) {
    const line_of<T> l(line);
    exact_line<T> met(aligned<18>(in_a_row(l.origin, t.a, t.b, t.c, l.end, l.start).value), l.has_end());
    return met.first_time();
}

/// When a line that meets a triangle does, in plain numbers: 0 where these do not tell.
template <scalar T>
ABUT_HD constexpr double plain_time(const line_of<T>& l, const triangle<T>& t) {
    const vec3<T> n = cross(t.b - t.a, t.c - t.a);
    const T time = dot(n, t.a - l.origin) / dot(n, l.direction());
    return time >= 0 && is_finite(time) ? static_cast<double>(time) : 0;
}

/// When a ray or a segment meets a triangle, or a negative number if it does not.
template <arithmetic A, class Line, scalar T>
ABUT_HD constexpr double hit_time(const Line& line, const triangle<T>& t) {
    const line_of<T> l(line);
    if constexpr (std::same_as<A, fast>) {
        return intersects<fast>(line, t) ? plain_time(l, t) : -1;
    } else {
        if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
            const verdict v = decide<filtered>(as_stored(line), as_stored(t));
            if (v == verdict::no) return -1;
            if (v == verdict::yes) {
                const double time = crossing_in_pairs(l, t);
                if (time >= 0) return time;
            }
        }
        return exact_hit_time(line, t);
    }
}

/// hit_time, not inlined: for where it is seldom asked for.
template <arithmetic A, class Line, scalar T>
ABUT_NOINLINE ABUT_HD constexpr double hit_time_apart(const Line& line, const triangle<T>& t) {
    return hit_time<A>(line, t);
}

/// The same as far as plain numbers tell: from 0 to infinity where they do not. Nothing is called out of line.
template <arithmetic A, class Line, scalar T>
requires(!std::same_as<A, exact>) ABUT_HD time_bounds plain_hit_time_bounds(const Line& line, const triangle<T>& t) {
    constexpr time_bounds any_time{0, infinity<double>};
    time_bounds times{-1, -1};
    if constexpr (std::same_as<A, fast>) {
        const verdict v = decide<fast>(line, t);
        if (v == verdict::no) return times;
        if (v == verdict::unknown) return any_time;
        const double time = plain_time(line_of<T>(line), t);
        return {time, time};
    } else if constexpr (std::same_as<Line, ray<T>>) {
        plane_approach met{};
        const verdict v = decide_by_sides(as_stored(line), as_stored(t), met);
        if (v == verdict::no) return times;
        if (v == verdict::yes) times = crossing_of(met);
    } else {
        const verdict v = decide<filtered>(as_stored(line), as_stored(t));
        if (v == verdict::no) return times;
        if (v == verdict::yes) times = crossing_in_doubles(line_of<T>(line), t);
    }
    return times.first >= 0 ? times : any_time;
}

/// Bounds of what hit_time gives; nearly always in single doubles.
template <arithmetic A, class Line, scalar T>
ABUT_HD constexpr time_bounds hit_time_bounds(const Line& line, const triangle<T>& t) {
    if constexpr (std::same_as<A, filtered>) {
        if (!ABUT_CONSTANT_EVALUATED()) {
            const time_bounds times = plain_hit_time_bounds<A>(line, t);
            if (times.last < infinity<double>) return times;
        }
        const double time = hit_time_apart<A>(line, t);
        return {time, time};
    } else {
        const double time = hit_time<A>(line, t);
        return {time, time};
    }
}

/// Whether it does at all.
template <arithmetic A, class Line, scalar T>
ABUT_HD constexpr bool is_met(const Line& line, const triangle<T>& t) {
    if constexpr (std::same_as<A, fast>) {
        return intersects<fast>(line, t);
    } else {
        if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
            const verdict v = decide<filtered>(as_stored(line), as_stored(t));
            if (v != verdict::unknown) return v == verdict::yes;
        }
        return exact_hit_time(line, t) >= 0;
    }
}

}  // namespace abut::detail
