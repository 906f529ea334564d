// SPDX-License-Identifier: MIT
#pragma once

// When a ray or a segment meets a solid: a ball, a box, a capsule, a cylinder or a cone. It is 0 where it begins inside, and
// else the time at which it enters. And `hit_time_of`, the face over this, hit_time.hpp and hull_hit_time.hpp.
//
// `filtered` and `exact` give the true time as hit_time.hpp does, rounded to the nearest double, of two that are as near the
// lesser. It is a quotient of differences or a root of a quadratic (predicate/line_solid.hpp). Estimates in double give
// bounds; estimates in pairs of doubles tell nearly always how it is rounded. Where they do not, integers do
// (predicate/exact_line_solid.hpp): a quotient is divided out, and a root is at most halfway between two doubles or it is
// not, so that it is found among all doubles by halving their number.
//
// Errors of pairs. With u = 2^-53 a sum is off by less than 5 u^2 of itself, a product by 8 u^2, a quotient by 16 u^2 and a
// root by 16 u^2 (numbers.hpp); 32 u^2 = 2^-101 is taken for each.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/hull_hit_time.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/certified_line.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/line_solid.hpp>
#include <abut/predicate/ray_solid.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A pair of doubles that is within `error` of a number: as `estimate`.
struct fine_estimate {
    contact_math::two_doubles value;
    double error;

    static constexpr double roundoff = 0x1p-101;

    ABUT_HD friend constexpr fine_estimate operator+(const fine_estimate& a, const fine_estimate& b) {
        const auto v = a.value + b.value;
        return {v, (a.error + b.error) + roundoff * absolute(v.high)};
    }
    ABUT_HD friend constexpr fine_estimate operator-(const fine_estimate& a) { return {-a.value, a.error}; }
    ABUT_HD friend constexpr fine_estimate operator-(const fine_estimate& a, const fine_estimate& b) { return a + -b; }
    ABUT_HD friend constexpr fine_estimate operator*(const fine_estimate& a, const fine_estimate& b) {
        const auto v = a.value * b.value;
        const double lost = absolute(a.value.high) * b.error + a.error * (absolute(b.value.high) + b.error);
        return {v, (1 + 0x1p-50) * lost + roundoff * absolute(v.high)};
    }
    ABUT_HD friend constexpr fine_estimate operator/(const fine_estimate& a, const fine_estimate& b) {
        const double divisor = (1 - 0x1p-50) * absolute(b.value.high) - (1 + 0x1p-30) * b.error;
        const auto v = a.value / b.value;
        const double size = absolute(v.high);
        if (a.value.high == 0 && a.error == 0 && divisor > 0) return {{0, 0}, 0};
        if (!(divisor > 0 && size > 0x1p-900 && size < 0x1p900)) return {{0, 0}, infinity<double>};
        return {v, (1 + 0x1p-50) * (a.error + size * b.error) / divisor + roundoff * size};
    }
};
ABUT_HD constexpr fine_estimate root_of(const fine_estimate& x) {
    if (x.value.high == 0) return {{0, 0}, 0};
    const auto v = root(x.value);
    return {v, x.error / v.high * (1 + 0x1p-50) + fine_estimate::roundoff * v.high};
}
ABUT_HD constexpr double value_of(const fine_estimate& x) { return x.value.high; }
ABUT_HD constexpr int sign_or_unknown(const fine_estimate& x) {
    return sign_or_unknown(estimate{x.value.high, (1 + 0x1p-30) * x.error + 0x1p-50 * absolute(x.value.high)});
}

struct make_fine_estimate {
    ABUT_HD constexpr fine_estimate operator()(double x) const { return {contact_math::two_doubles::of(x), 0}; }
};

/// By pairs of doubles, as estimated_entry.
template <scalar T, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr line_entry<fine_estimate> entry_in_pairs(const line_of<T>& l, const S& s) {
    return entry_in<101>(l, s, make_fine_estimate{});
}

/// An entry's time, or a negative number if it is not certain how it is rounded.
ABUT_HD constexpr double rounded_time(const line_entry<fine_estimate>& entry) {
    if (entry.met != verdict::yes) return -1;
    if (entry.at_start()) return 0;
    const auto& [high, low] = entry.time.value;
    const double lost = (1 + 0x1p-30) * entry.time.error;
    const bool is_certain = lost < 0x1p-59 * high && plain_sum(high, plain_sum(low, lost)) == high &&
                            plain_sum(high, plain_sum(low, -lost)) == high;
    return is_certain && high > smallest_normal<double> && high <= largest_finite<double> ? high : -1;
}

/// Halfway between a double of 0 or more, given by its bits, and the next one.
template <int Room>
ABUT_HD constexpr void set_halfway(std::uint64_t bits, long_fraction<Room>& to) {
    const int biased = static_cast<int>(bits >> 52), exponent = (biased > 1 ? biased : 1) - 1076;
    const auto mantissa =
        static_cast<std::int64_t>((bits & ((std::uint64_t{1} << 52) - 1)) | std::uint64_t{biased > 0} << 52);
    constexpr int limbs = 18;
    to.over.clear(limbs);
    to.under.clear(limbs);
    add_shifted(to.over.limb, limbs, 2 * mantissa + 1, exponent > 0 ? exponent : 0, false);
    add_shifted(to.under.limb, limbs, 1, exponent < 0 ? -exponent : 0, false);
}

/// A root rounded to the nearest double, of two that are as near to the lesser; or the largest one.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr double rounded_root(const line_in_solid<T>& in) {
    std::uint64_t low = 0, high = 0x7fefffffffffffff;
    ABUT_ROLLED
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        typename line_in_solid<T>::fraction halfway;
        set_halfway(middle, halfway);
        if (in.has_met_at(halfway)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return ABUT_BIT_CAST(double, low);
}

/// By integers, of any finite input; negative where it is not met.
template <scalar T, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr double exact_entry(const line_of<T>& l, const S& s) {
    double time = infinity<double>;
    each_first_met(l, s, [&](first_met met, auto& in) {
        if (met == first_met::root) time = least(time, rounded_root(in));
        if (met == first_met::fraction) time = least(time, rounded_quotient(in.first().over, in.first().under));
    });
    return time < infinity<double> ? time : -1;
}

/// When a ray or a segment meets a solid, or a negative number if it does not.
template <arithmetic A, class Line, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr double hit_time(const Line& line, const S& s) {
    const line_of<scalar_type_of<S>> l(line);
    if constexpr (std::same_as<A, fast>) {
        const line_entry<double> entry = plain_entry(l, s);
        return entry.met != verdict::yes ? -1 : entry.at_start() ? 0 : is_finite(entry.time) ? entry.time : 0;
    } else {
        if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
            const line_of<scalar_type_of<S>> stored(as_stored(line));
            const entry_bounds bounds = certified_line(stored, as_stored(s));
            if (bounds.met == verdict::no) return -1;
            if (bounds.met == verdict::yes && bounds.last == 0) return 0;
            const double time = rounded_time(entry_in_pairs(stored, as_stored(s)));
            if (time >= 0) return time;
        }
        return exact_entry(l, s);
    }
}
template <arithmetic A, class Line, line_solid S>
ABUT_HD constexpr double hit_time_apart(const Line& line, const S& s) {
    return hit_time<A>(line, s);
}

/// Bounds of what hit_time gives; nearly always in single doubles.
template <arithmetic A, class Line, line_solid S>
ABUT_HD constexpr time_bounds hit_time_bounds(const Line& line, const S& s) {
    if constexpr (std::same_as<A, filtered>) {
        if (!ABUT_CONSTANT_EVALUATED()) {
            const entry_bounds bounds = certified_line(line_of<scalar_type_of<S>>(as_stored(line)), as_stored(s));
            if (bounds.met == verdict::no) return {-1, -1};
            if (bounds.met == verdict::yes) return {bounds.first, bounds.last};
        }
    }
    const double time = hit_time_apart<A>(line, s);
    return {time, time};
}

/// Whether it does at all.
template <arithmetic A, class Line, line_solid S>
ABUT_HD constexpr bool is_met(const Line& line, const S& s) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<A, fast>) {
        return plain_entry(line_of<T>(line), s).met == verdict::yes;
    } else {
        if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
            const verdict met = certified_line(line_of<T>(as_stored(line)), as_stored(s)).met;
            if (met != verdict::unknown) return met == verdict::yes;
        }
        return meets_exactly(line_of<T>(line), s);
    }
}

/// Shapes that lines meet at a time. One of the caller's own has `hit_time<A>(line, s)` beside it: when it is met, rounded,
/// or a negative number.
template <class S, class Line>
concept has_hit_time = requires(const Line& line, const S& s) {
    { hit_time<filtered>(line, s) } -> std::same_as<double>;
};

}  // namespace abut::detail

namespace abut {

/// When a ray or a segment meets a shape first, as `raycast` defines it: t, where origin + t direction (a + t (b - a) of a
/// segment) is in the shape, rounded to the nearest double; or a negative number where they do not meet. Shapes are those
/// that `raycast` looks for. The same bits on every device for `filtered` and `exact`; `fast` is approximate.
/// @ingroup one_pair
template <arithmetic A = filtered, class Line, class S>
[[nodiscard]] ABUT_HD constexpr double hit_time_of(const Line& line, const S& s) {
    constexpr bool is = detail::has_hit_time<S, Line>;
    static_assert(is, "abut: no ray meets such a shape, for want of hit_time(line, shape)");
    if constexpr (is) {
        using namespace detail;  // and what is beside a shape of the caller's own
        return hit_time<A>(line, s);
    } else {
        return -1;
    }
}

}  // namespace abut
