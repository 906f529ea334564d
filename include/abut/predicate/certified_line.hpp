// SPDX-License-Identifier: MIT
#pragma once

// The filter of lines and solids: whether a line meets a solid, and two times between which it enters, in double with
// bounds. A ball and a box have filters of their own; what these leave of a ball, and all other solids, are asked of
// estimates (line_solid.hpp).
//
// Let u = 2^-52, at least the relative error of an operation in any rounding mode, m the smallest normal number of the
// input's type, and f = 4 m, which is more than what a flush of denormal numbers to zero takes from a difference of two.
//
// A box. A time is a difference times the inverse of another one: 5 roundings, of which 2^-49 of it is taken, and f times
// the inverse. Coordinates of the direction are 0, by their bits, or held above 2^54 f, so that their own flush is no more
// than a rounding. What overflows is infinite or no number, and an end that is no number leaves the question open. Begins
// are compared with the ends in other coordinates alone: in their own they are in order, also if the box is flat.
//
// A ball. Sums of magnitudes of w and e are W and E. Coordinates of w and e are off by u of themselves, so b is off by less
// than 6u W E, and c by less than 8u (|w|^2 + r^2). Those of w x e are off by less than 5u W E together, and W E <= 3 |w|
// |e|: so m is off by less than 2 * 15u |w|^2 |e|^2 and 5u of each of its terms, in all less than 2^-46 (|w|^2 + r^2) |e|^2.
// The time c / (v - b) is that of two numbers above 0. Twice the sum of their relative errors is taken, if that is below a
// half: so it is more than their quotient's. Where both sums of squares are above `least_square`, what is flushed is less
// than 2^-8 u of any of this.
//
// A capsule, a cylinder and a cone are nowhere farther than r from their axis. The line of the axis is passed at more than r
// if (w . g)^2 > r^2 |g|^2 for g = e x d. With sums of magnitudes W, E and D the left one's root is off by less than 12u W E
// D, of which 2^-48 is taken, and |g|^2 by less than 2 * 5u (E D)^2 + 25u^2 (E D)^2 and its own rounding, of which 2^-47 is
// taken, as for what is left. W, E and D are in the middle of the range, and r is taken longer by more than a flush.

#include <concepts>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/line_solid.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Whether a line meets a solid, and if so two times between which it does first: 0 and 0, or both above 0.
struct entry_bounds {
    verdict met;
    double first, last;
};

/// Of a time above 0 that may be off by a share of itself and has to be before the last one.
ABUT_HD constexpr entry_bounds bounds_before(double time, double relative, double last) {
    const double first = time - relative * time, later = time + relative * time;
    if (first > last) return {verdict::no, 0, 0};
    const bool is_certain =
        relative < 0.5 && first > smallest_normal<double> && later <= least(last, largest_finite<double>);
    return is_certain ? entry_bounds{verdict::yes, first, later} : entry_bounds{verdict::unknown, 0, 0};
}

/// A ball.
template <scalar T>
ABUT_HD constexpr entry_bounds enter_ball(const line_of<T>& l, const sphere<T>& s) {
    constexpr double least_square = std::same_as<T, float> ? 0x1p-120 : 0x1p-400;
    constexpr entry_bounds no{verdict::no, 0, 0}, unknown{verdict::unknown, 0, 0};
    const vec3<double> w = widened(l.origin) - widened(s.center), e = widened(l.end) - widened(l.start);
    const double r = static_cast<double>(s.radius), rr = r * r, ww = dot(w, w), a = dot(e, e), sum = ww + rr;
    if (!(sum > least_square && sum < 0x1p400 && a > least_square && a < 0x1p400)) return unknown;
    const double c = ww - rr, error_of_c = 0x1p-48 * sum;
    if (c < -error_of_c) return {verdict::yes, 0, 0};
    if (!(c > error_of_c)) return unknown;
    const double b = dot(w, e), error_of_b = 0x1p-48 * (magnitudes(w) * magnitudes(e));
    if (b > error_of_b) return no;
    const vec3<double> across = cross(w, e);
    const double m = rr * a - dot(across, across), error_of_m = 0x1p-46 * (sum * a);
    if (m < -error_of_m) return no;
    if (!(m > error_of_m && b < -error_of_b)) return unknown;
    const double v = square_root(m), below = v - b;
    const double relative = error_of_c / c + (error_of_m / v + error_of_b) / below;
    return bounds_before(c / below, 2 * relative + 0x1p-49, l.last);
}

/// Whether a line passes the line of an axis at more than r; only if that is certain.
template <scalar T>
ABUT_HD constexpr bool passes_axis(const line_of<T>& l, const segment<T>& axis, T radius) {
    constexpr double bottom = std::same_as<T, float> ? 0x1p-60 : 0x1p-150, top = 0x1p150;
    const vec3<double> first = widened(axis.a), w = widened(l.origin) - first, d = widened(axis.b) - first,
                       e = widened(l.end) - widened(l.start);
    const double to_origin = magnitudes(w), of_line = magnitudes(e), of_axis = magnitudes(d);
    if (!(least(to_origin, of_line, of_axis) > bottom && greatest(to_origin, of_line, of_axis) < top)) return false;
    const vec3<double> g = cross(e, d);
    const double area = of_line * of_axis, apart = absolute(dot(w, g)) - 0x1p-48 * (to_origin * area);
    const double r = static_cast<double>(radius) + (std::same_as<T, float> ? 0x1p-120 : 0x1p-300);
    return r < top && apart > 0x1p-100 * area &&
           apart * apart > r * r * ((1 + 0x1p-47) * dot(g, g) + 0x1p-47 * (area * area));
}

/// When a line is between two planes, from a time between two to a time between two.
struct plane_times {
    double begin_after, begin_before, end_after, end_before;
};

/// A box.
template <scalar T>
ABUT_HD constexpr entry_bounds enter_box(const line_of<T>& l, const aabb<T>& box) {
    constexpr double flushed = 4 * static_cast<double>(smallest_normal<T>), none = infinity<double>;
    constexpr entry_bounds no{verdict::no, 0, 0}, unknown{verdict::unknown, 0, 0};
    bool is_known = true, is_beside = false;
    const auto pass = [&](T vec3<T>::*x) -> plane_times {
        const T origin = l.origin.*x, low = box.lower.*x, high = box.upper.*x;
        if (ordered_bits(l.end.*x) == ordered_bits(l.start.*x)) {
            const auto o = ordered_bits(origin);
            is_beside = is_beside || o < ordered_bits(low) || o > ordered_bits(high);
            return {-none, -none, none, none};
        }
        const double at = static_cast<double>(origin), e = static_cast<double>(l.end.*x) - static_cast<double>(l.start.*x),
                     size = absolute(e), inverse = 1 / e;
        is_known = is_known && size > 0x1p54 * flushed && size < 0x1p1000;
        const double s = (static_cast<double>(low) - at) * inverse, t = (static_cast<double>(high) - at) * inverse,
                     tiny = flushed * absolute(inverse) + 2 * smallest_normal<double>;
        const double begin = e > 0 ? s : t, end = e > 0 ? t : s, error_of_begin = 0x1p-49 * absolute(begin) + tiny,
                     error_of_end = 0x1p-49 * absolute(end) + tiny;
        return {begin - error_of_begin, begin + error_of_begin, end - error_of_end, end + error_of_end};
    };
    const plane_times x = pass(&vec3<T>::x), y = pass(&vec3<T>::y), z = pass(&vec3<T>::z);
    if (is_beside) return no;
    if (!is_known) return unknown;
    const double first = greatest(x.begin_after, y.begin_after, z.begin_after, 0.0);
    if (first > least(x.end_before, y.end_before, z.end_before, l.last)) return no;
    const double later = greatest(x.begin_before, y.begin_before, z.begin_before);
    const bool is_before_ends = x.begin_before <= least(y.end_after, z.end_after) &&
                                y.begin_before <= least(x.end_after, z.end_after) &&
                                z.begin_before <= least(x.end_after, y.end_after) && x.end_after >= 0 && y.end_after >= 0 &&
                                z.end_after >= 0 && later <= l.last;
    if (!(is_before_ends && later <= largest_finite<double>)) return unknown;
    if (later <= 0) return {verdict::yes, 0, 0};
    return first > 0 ? entry_bounds{verdict::yes, first, later} : unknown;
}

/// A line and a solid.
template <scalar T, line_solid S>
ABUT_HD constexpr entry_bounds certified_line(const line_of<T>& l, const S& s) {
    if constexpr (std::same_as<S, aabb<T>>) {
        return enter_box(l, s);
    } else {
        if constexpr (std::same_as<S, sphere<T>>) {
            const entry_bounds found = enter_ball(l, s);
            if (found.met != verdict::unknown) return found;
        } else {
            if (passes_axis(l, axis_within(s), s.radius)) return {verdict::no, 0, 0};
        }
        const line_entry<estimate> entry = estimated_entry(l, s);
        if (entry.met != verdict::yes) return {entry.met, 0, 0};
        if (entry.at_start()) return {verdict::yes, 0, 0};
        const double time = entry.time.value, lost = (1 + 0x1p-30) * entry.time.error + 0x1p-51 * time, first = time - lost;
        return first > smallest_normal<double> ? entry_bounds{verdict::yes, first, time + lost}
                                               : entry_bounds{verdict::unknown, 0, 0};
    }
}

}  // namespace abut::detail
