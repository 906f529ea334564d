// SPDX-License-Identifier: MIT
#pragma once

// When two moving features first touch: a vertex and a triangle, or two edges.
//
// For `filtered` and `exact` the time is by definition the largest multiple of 2^-40 that is not above the true one: so it
// is never later, within 10^-12, and the same bits however it was found. In registers f is followed to its root in double;
// then its signs on both sides of the multiple are made sure of, in double or in pairs of doubles. What these leave open is
// found in integers.

#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/motion.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// For times of impact alone: never misses a contact, never reports one later than it is, and reports more than there are,
/// as conservative_bounds says.
struct conservative {};

/// How features are decided in motion.
template <class A>
concept motion_arithmetic = arithmetic<A> || std::same_as<A, conservative>;

/// What `conservative` promises. Without a separation, and with a tolerance below 1/16, times are mostly those of `filtered`.
struct conservative_bounds {
    /// A time that is reported is at most this much before features come within `separation`. Features that pass each other
    /// are reported as well if they come nearer than `separation` and half of what they move relative to each other in a
    /// time of `tolerance`. Less than 2^-50 is taken for 2^-50; and where more than 2^14 parts of the step would have to be
    /// looked at, the time is that of the first that is not known. Features whose corners differ by 2^200 or more in a
    /// coordinate may be reported at time 0, however far apart they are.
    double tolerance = 1e-6;
    /// Features that come so close are reported, in the unit of the coordinates: 0 for those that touch.
    double separation = 0;
};

///@}

namespace detail {

/// A time of impact as a multiple of 2^-40, or what is known of it.
struct time_in_bits {
    static constexpr int none = -1, unknown = -2;
    std::int64_t count;
};
inline constexpr double last_time_bit = 0x1p-40;
static_assert(time_bits == 40);
inline constexpr double longest_halving = 0x1p-4;  ///< below this tolerance halving takes longer than the exact time

// Signs at a time, as far as pairs of doubles tell; 0 where they do not.

ABUT_HD constexpr int sign_beyond(double x, double error) { return x > error ? 1 : x < -error ? -1 : 0; }

/// From point i to point j at a time.
template <scalar T>
ABUT_HD constexpr vec3<contact_math::two_doubles> difference_at(const moving_points<T>& p, int i, int j, double t) {
    using number = contact_math::two_doubles;
    const auto at_0 = contact_math::between<number>(widened(p.t0[i]), widened(p.t0[j]));
    const auto at_1 = contact_math::between<number>(widened(p.t1[i]), widened(p.t1[j]));
    return at_0 + number::of(t) * (at_1 - at_0);
}
/// Of f.
template <bool Edges, scalar T>
ABUT_HD constexpr int sign_of_volume(const moving_points<T>& p, double t, double error) {
    constexpr int first = Edges ? 0 : 1;
    const auto u = difference_at(p, first, Edges ? 1 : 2, t), v = difference_at(p, Edges ? 2 : 1, 3, t),
               w = difference_at(p, first, Edges ? 2 : 0, t);
    return sign_beyond(dot(cross(u, v), w).high, error);
}
/// Of the area of a condition (motion_filter), in one of its senses.
template <bool Edges, scalar T>
ABUT_HD constexpr int sign_of_area(const moving_points<T>& p, int condition, int axis, double t, double error) {
    constexpr int three[4][3] = {{0, Edges ? 2 : 1, 3}, {Edges ? 2 : 0, Edges ? 0 : 1, Edges ? 1 : 2}, {Edges ? 1 : 0, 2, 3}, {3, 0, 1}};
    const int* const of = three[condition];
    const auto n = cross(difference_at(p, of[0], of[1], t), difference_at(p, of[0], of[2], t));
    return sign_beyond(coordinate_along({n.x.high, n.y.high, n.z.high}, axis), error);
}

/// The time as a multiple of 2^-40, given in which part of an interval it seems to be, and sign_at(t), which has one sign,
/// `start`, before it in the interval and the other after it.
template <class Sign>
ABUT_HD constexpr time_in_bits count_of_time(std::uint32_t j, int depth, double part, int start, const Sign& sign_at) {
    const std::int64_t width = std::int64_t{1} << (time_bits - depth), first = width * j;
    std::int64_t low = first, high = first + width, step = 1;
    auto count = static_cast<std::int64_t>((static_cast<double>(j) + part) * static_cast<double>(width));
    if (count <= low) count = low + 1;
    for (int tries = 0; tries < 32; ++tries) {
        if (count <= low || count >= high) count = low + (high - low) / 2;
        const int sign = sign_at(static_cast<double>(count) * last_time_bit);
        if (sign == 0) break;
        (sign == start ? low : high) = count;
        if (high - low == 1) return {low};
        count += sign == start ? step : -step;
        step *= 2;
    }
    return {time_in_bits::unknown};
}

/// In registers. Not inlined: it is asked about few pairs, and takes many.
template <bool Edges, scalar T>
ABUT_NOINLINE ABUT_HD constexpr time_in_bits filtered_time(const moving_points<T>& p) {
    const motion_filter<Edges> filter(p);
    const std::uint32_t shared = shared_coordinates<Edges>(p);
    const int axis = axis_of_plane<Edges>(shared);
    const auto at_start = [&] { return filter.start_apart() ? verdict::no : touch_at_start<Edges>(p); };
    const auto known = [](verdict v) {
        return time_in_bits{v == verdict::yes ? 0 : v == verdict::no ? time_in_bits::none : time_in_bits::unknown};
    };
    if (come_together(p)) {
        const verdict start = at_start();
        return start == verdict::no ? time_in_bits{std::int64_t{1} << time_bits} : known(start);
    }
    if (axis >= 0) {
        const verdict start = at_start();
        if (start != verdict::no) return known(start);
        const auto found = filter.search_in_plane(axis);
        if (found.touch != verdict::yes) return known(found.touch);
        const area_in_time a = filter.area(found, axis);
        const double part = root_of_cubic({a.first, a.twice_middle - 2 * a.first, a.first - a.twice_middle + a.last, 0}, a.last);
        const double error = filter.area_error(0x1p-90);
        const auto sign_at = [&](double t) { return sign_of_area<Edges>(p, found.condition, axis, t, error); };
        const int before = sign_at(static_cast<double>(found.j) / static_cast<double>(std::uint32_t{1} << found.depth));
        return before == 0 ? known(verdict::unknown) : count_of_time(found.j, found.depth, part, before, sign_at);
    }
    const auto found = filter.search(true, shared);
    if (found.touch == verdict::unknown) return known(at_start() == verdict::yes ? verdict::yes : verdict::unknown);
    if (found.touch == verdict::no) return known(verdict::no);
    const double error = filter.volume_error(0x1p-90);
    return count_of_time(found.j, found.depth, found.part, found.before, [&](double t) {
#if !ABUT_DEVICE_CODE  // which would be more code there, for what few pairs ask
        if (const int sign = filter.sign_of_volume(t); sign != 0) return sign;
#endif
        return sign_of_volume<Edges>(p, t, error);
    });
}

/// In registers; `unknown` only of filtered and exact.
template <motion_arithmetic A, bool Edges, scalar T>
ABUT_HD constexpr double time_in_registers(const moving_points<T>& p, const conservative_bounds& bounds) {
    if constexpr (std::same_as<A, fast>) {
        return static_cast<double>(fast_motion<Edges, T>(p).time());
    } else if constexpr (std::same_as<A, conservative>) {
        if (bounds.separation == 0 && bounds.tolerance >= last_time_bit && bounds.tolerance < longest_halving) {
            const std::int64_t count = filtered_time<Edges>(p).count;
            if (count != time_in_bits::unknown) return count < 0 ? -1 : static_cast<double>(count) * last_time_bit;
        }
        return motion_filter<Edges>(p).conservative_time(bounds.separation, bounds.tolerance);
    } else if constexpr (std::same_as<A, exact>) {
        return time_in_bits::unknown;
    } else {
        const std::int64_t count = filtered_time<Edges>(p).count;
        return count < 0 ? static_cast<double>(count) : static_cast<double>(count) * last_time_bit;
    }
}

template <motion_arithmetic A, bool Edges, scalar T>
double time_on_host(const moving_points<T>& p, const conservative_bounds& bounds) {
    const double t = time_in_registers<A, Edges>(p, bounds);
    if (t != time_in_bits::unknown) return t;
    const std::int64_t count = exact_time<Edges>(p);
    return count < 0 ? -1 : static_cast<double>(count) * last_time_bit;
}

}  // namespace detail

/// The earliest time in [0, 1] at which two moving features touch, or -1 if they do not: motion<vec3<T>> and
/// motion<triangle<T>>, or two motion<segment<T>>. All are closed, and degenerate ones are what they span.
///
/// With `filtered` and `exact` right for every finite input, and within 10^-12 below the true time; 0 and 1 are told as
/// such. `fast` promises nothing. `conservative` is within its bounds. On hosts alone; it may allocate.
///
///     const auto falls = abut::moving(abut::vec3<double>{0.2, 0.2, 1}, abut::vec3<double>{0.2, 0.2, -3});
///     const auto floor = abut::triangle<double>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
///     const double t = abut::time_of_impact(falls, abut::moving(floor, floor));  // 0.25
/// @ingroup one_pair
template <motion_arithmetic A = filtered, class S, class U>
    requires detail::are_features<S, U>
[[nodiscard]] double time_of_impact(const S& s, const U& t, const conservative_bounds& bounds = {}) {
    return detail::time_on_host<A, detail::is_moving_edge<S>>(detail::points_of(s, t), bounds);
}

}  // namespace abut
