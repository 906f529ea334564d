// SPDX-License-Identifier: MIT
#pragma once

// When a ray meets a triangle: the least t >= 0 at which origin + t direction is in it; and a segment alike, as a + t (b - a).
//
// `filtered` and `exact` give the true t, rounded to the nearest double; of two that are as near the lesser. So equal times
// are equal numbers, however they were computed: two faces at an edge are met at one time by a ray through the edge. A pair
// of doubles tells nearly always how t is rounded. Where it does not, integers say which numbers t is between.
//
// The pairs. Let p be the product of the sums of magnitudes of three vectors whose determinant is computed: sums of products
// of pairs are off by less than 32 2^-106 p in all, of which 2^-98 is taken, for the numerator and the denominator. Vectors
// have magnitudes between 2^-200 and 2^200, so nothing underflows that matters beside that.

#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/exact_ray.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A ray or a segment as origin + t (end - start).
template <scalar T>
struct line_of {
    vec3<T> origin, end, start;
    double last;  ///< time

    ABUT_HD constexpr line_of(const ray<T>& r) : origin(r.origin), end(r.direction), start{0, 0, 0}, last(infinity<double>) {}
    ABUT_HD constexpr line_of(const segment<T>& s) : origin(s.a), end(s.b), start(s.a), last(1) {}

    [[nodiscard]] ABUT_HD constexpr vec3<T> direction() const { return end - start; }
};

template <class Predicate, scalar T, std::size_t V>
ABUT_HD constexpr bool holds_exactly(const T (&values)[V]) {
    const verdict v = decide_in_limbs<Predicate>(values);
    return v == verdict::unknown ? decide_at_any_span<Predicate>(values) : v == verdict::yes;
}

/// The time at which the line crosses the plane, or a negative number if pairs of doubles do not tell how it is rounded.
template <scalar T>
ABUT_HD constexpr double crossing_in_pairs(const line_of<T>& l, const triangle<T>& t) {
    using number = contact_math::two_doubles;
    using contact_math::between;
    using contact_math::rounded_off;
    if (std::same_as<T, float> && any_subnormal(in_a_row(l.origin, t.a, t.b, t.c, l.end, l.start).value)) return -1;
    const vec3<double> a = widened(t.a);
    const auto to_a = between<number>(widened(l.origin), a), f = between<number>(a, widened(t.b)),
               g = between<number>(a, widened(t.c)), along = between<number>(widened(l.start), widened(l.end));
    const double apart = magnitudes(rounded_off(to_a)), length = magnitudes(rounded_off(along)),
                 side = magnitudes(rounded_off(f)), other = magnitudes(rounded_off(g));
    if (!(least(apart, length, side, other) > 0x1p-200 && greatest(apart, length, side, other) < 0x1p200)) return -1;
    const auto n = cross(f, g);
    const number height = dot(n, to_a), speed = dot(n, along), time = height / speed;
    const double error = 0x1p-98 * (side * other);
    const double relative = error * apart / absolute(height.high) + error * length / absolute(speed.high) + 0x1p-98;
    if (!(relative < 0x1p-60)) return -1;
    const double lost = 2 * relative * time.high;
    const bool is_certain = plain_sum(time.high, plain_sum(time.low, lost)) == time.high &&
                            plain_sum(time.high, plain_sum(time.low, -lost)) == time.high;
    return is_certain && time.high > smallest_normal<double> && time.high <= largest_finite<double> ? time.high : -1;
}

/// A float as a double, by its bits if it is subnormal: a processor may be told to read such a number as zero.
ABUT_HD constexpr double widened_by_bits(float x) {
    if (!is_subnormal(x)) return static_cast<double>(x);
    const double size = static_cast<double>(__builtin_bit_cast(std::uint32_t, x) & 0x7fffff) * 0x1p-149;
    return has_sign(x) ? -size : size;
}
ABUT_HD constexpr double widened_by_bits(double x) { return x; }
template <scalar T>
ABUT_HD constexpr vec3<double> widened_by_bits(const vec3<T>& p) {
    return {widened_by_bits(p.x), widened_by_bits(p.y), widened_by_bits(p.z)};
}
/// Whether two numbers differ, by their bits.
template <scalar T>
ABUT_HD constexpr bool differ(T x, T y) {
    using word = typename float_format<T>::word;
    return !(is_zero(x) && is_zero(y)) && __builtin_bit_cast(word, x) != __builtin_bit_cast(word, y);
}

/// Coordinates in another order, which begins with the one after.
template <scalar T>
ABUT_HD constexpr vec3<T> turned_once(const vec3<T>& p) {
    return {p.y, p.z, p.x};
}
template <scalar T>
ABUT_HD constexpr line_of<T> turned_once(line_of<T> l) {
    l.origin = turned_once(l.origin), l.end = turned_once(l.end), l.start = turned_once(l.start);
    return l;
}
template <scalar T>
ABUT_HD constexpr triangle<T> turned_once(const triangle<T>& t) {
    return {turned_once(t.a), turned_once(t.b), turned_once(t.c)};
}

/// About when the line meets what `What` says, if nothing overflows or vanishes on the way.
template <met What, scalar T>
ABUT_HD constexpr double approximate_time(const line_of<T>& l, const triangle<T>& t) {
    using number = contact_math::two_doubles;
    const auto way = [](const vec3<T>& from, const vec3<T>& to) {
        return contact_math::between<number>(widened_by_bits(from), widened_by_bits(to));
    };
    const auto to_a = way(l.origin, t.a), side = way(t.a, t.b), along = way(l.start, l.end);
    if constexpr (What == met::plane) {
        const auto n = cross(side, way(t.a, t.c));
        return (dot(n, to_a) / dot(n, along)).high;
    } else if constexpr (What == met::side) {
        const auto z_of = [](const auto& a, const auto& b) { return a.x * b.y - a.y * b.x; };
        return (z_of(to_a, side) / z_of(along, side)).high;
    } else {
        return (to_a.x / along.x).high;
    }
}

/// The time at which the line meets what `What` says, which is not negative: among the doubles in their order, by halves.
template <met What, scalar T>
ABUT_HD constexpr double rounded_time(const line_of<T>& l, const triangle<T>& t) {
    const auto is_above_mean = [&](double x, double y) {
        return holds_exactly<time_is_above_mean<What>>(
            in_a_row(widened_by_bits(l.origin), widened_by_bits(t.a), widened_by_bits(t.b), widened_by_bits(t.c),
                     widened_by_bits(l.end), widened_by_bits(l.start), x, y, 1.0)
                .value);
    };
    const auto number = [](std::uint64_t bits) { return __builtin_bit_cast(double, bits); };
    std::uint64_t low = 0, high = __builtin_bit_cast(std::uint64_t, largest_finite<double>);
    // It is what doubles make of it, nearly always, or next to that.
    const double guess = approximate_time<What>(l, t);
    if (guess > smallest_normal<double> && guess < largest_finite<double> / 2) {
        const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, guess);
        for (std::uint64_t at = bits - 1; at <= bits + 1; ++at) {
            if (!is_above_mean(number(at), number(at + 1)) && is_above_mean(number(at - 1), number(at))) return number(at);
        }
    }
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (is_above_mean(number(middle), number(middle + 1))) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return number(low);
}

/// Of a line that meets the triangle.
template <class Line, scalar T>
ABUT_NOINLINE ABUT_HD constexpr double exact_hit_time(const Line& line, const triangle<T>& t) {
    line_of<T> l(line);
    if (intersects<exact>(l.origin, t)) return 0;
    if (holds_exactly<line_crosses_plane>(in_a_row(l.origin, t.a, t.b, t.c, l.end, l.start).value)) {
        return rounded_time<met::plane>(l, t);
    }
    double first = infinity<double>;
    triangle<T> sides = t;
    for (int i = 0; i < 3; ++i, sides = {sides.b, sides.c, sides.a}) {
        if (!intersects<exact>(line, triangle<T>{sides.a, sides.b, sides.b})) continue;
        triangle<T> side = sides;
        bool is_known = false;
        for (int axis = 0; axis < 3 && !is_known; ++axis, l = turned_once(l), side = turned_once(side)) {
            if (!holds_exactly<line_turns_to_side>(in_a_row(l.origin, side.a, side.b, side.c, l.end, l.start).value)) continue;
            first = least(rounded_time<met::side>(l, side), first);
            is_known = true;
        }
        l = line_of<T>(line);
        if (is_known) continue;
        // On one line, and the origin is not between the ends: the nearer one is met first.
        side = sides;
        while (!differ(l.end.x, l.start.x)) l = turned_once(l), side = turned_once(side);
        first = least(rounded_time<met::corner>(l, side), first);
        side.a = side.b;
        first = least(rounded_time<met::corner>(l, side), first);
        l = line_of<T>(line);
    }
    return first;
}

/// When a ray or a segment meets a triangle, or a negative number if it does not.
template <arithmetic A, class Line, scalar T>
ABUT_HD constexpr double hit_time(const Line& line, const triangle<T>& t) {
    const line_of<T> l(line);
    if constexpr (std::same_as<A, fast>) {
        if (!intersects<fast>(line, t)) return -1;
        const vec3<T> n = cross(t.b - t.a, t.c - t.a);
        const T time = dot(n, t.a - l.origin) / dot(n, l.direction());
        return time >= 0 && is_finite(time) ? static_cast<double>(time) : 0;
    } else {
        if (std::same_as<A, filtered> && !__builtin_is_constant_evaluated()) {
            const verdict v = decide<filtered>(as_stored(line), as_stored(t));
            if (v == verdict::no) return -1;
            if (v == verdict::yes) {
                const double time = crossing_in_pairs(l, t);
                if (time >= 0) return time;
                return exact_hit_time(line, t);
            }
        }
        return intersects_exactly<A>(line, t) ? exact_hit_time(line, t) : -1;
    }
}

}  // namespace abut::detail
