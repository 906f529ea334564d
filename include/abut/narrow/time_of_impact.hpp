// SPDX-License-Identifier: MIT
#pragma once

// When two moving features first touch: a vertex and a triangle, or two edges.
//
// For `filtered` and `exact` the time is by definition the largest multiple of 2^-40 that is not above the true one: so it is never
// later, within 10^-12, and the same bits however it was found. In registers f is followed to its root in double; then its
// signs on both sides of the multiple are made sure of in pairs of doubles. What these leave open is found in integers.

#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/motion.hpp>

namespace abut {

/// For times of impact alone: never misses a contact, never reports one later than it is, and reports more than there are.
/// impact_options says how many.
struct conservative {};

/// How features are decided in motion.
template <class A>
concept motion_arithmetic = arithmetic<A> || std::same_as<A, conservative>;

/// What `conservative` promises.
struct conservative_bounds {
    /// A time that is reported is at most this much before features come within `separation`; or before it is known that they do
    /// not, where they come closer than floating point can tell.
    double tolerance = 1e-6;
    /// Features that come so close are reported, in the unit of the coordinates: 0 for those that touch.
    double separation = 0;
};

namespace detail {

/// A time of impact as a multiple of 2^-40, or what is known of it.
struct time_in_bits {
    static constexpr int none = -1, unknown = -2;
    std::int64_t count;
};
inline constexpr double last_time_bit = 0x1p-40;
static_assert(time_bits == 40);

/// The sign of f at a time, as far as pairs of doubles tell; 0 where they do not.
template <bool Edges, scalar T>
ABUT_HD constexpr int sign_of_volume(const moving_points<T>& p, double t, double error) {
    using number = contact_math::two_doubles;
    constexpr int from[3] = {Edges ? 0 : 1, Edges ? 2 : 1, Edges ? 0 : 1}, to[3] = {Edges ? 1 : 2, 3, Edges ? 2 : 0};
    vec3<number> x[3]{};
    for (int i = 0; i < 3; ++i) {
        const auto at_0 = contact_math::between<number>(widened(p.t0[from[i]]), widened(p.t0[to[i]]));
        const auto at_1 = contact_math::between<number>(widened(p.t1[from[i]]), widened(p.t1[to[i]]));
        x[i] = at_0 + number::of(t) * (at_1 - at_0);
    }
    const double f = dot(cross(x[0], x[1]), x[2]).high;
    return f > error ? 1 : f < -error ? -1 : 0;
}

/// In registers. Not inlined: it is asked about few pairs, and takes many.
template <bool Edges, scalar T>
ABUT_NOINLINE ABUT_HD constexpr time_in_bits filtered_time(const moving_points<T>& p) {
    const motion_filter<Edges> filter(p);
    const auto found = filter.search(true, shared_coordinates<Edges>(p));
    if (found.touch == verdict::no) return {time_in_bits::none};
    if (found.touch == verdict::unknown) {
        return {touch_at_start<Edges>(p) == verdict::yes ? 0 : time_in_bits::unknown};
    }
    // The root within the interval, by Newton's iteration in a bracket.
    const volume_in_time f = filter.volume(found.j, found.depth);
    const double c0 = f.k[0], c1 = 3 * (f.k[1] - f.k[0]), c2 = 3 * (f.k[2] - 2 * f.k[1] + f.k[0]),
                 c3 = f.k[3] - 3 * (f.k[2] - f.k[1]) - f.k[0];
    double low = 0, high = 1, x = c0 / (c0 - f.k[3]);
    for (int i = 0; i < 64; ++i) {
        const double value = c0 + x * (c1 + x * (c2 + x * c3)), slope = c1 + x * (2 * c2 + 3 * x * c3);
        ((value < 0) == (c0 < 0) ? low : high) = x;
        const double newton = x - value / slope, next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (absolute(next - x) <= 0x1p-52) break;
        x = next;
    }
    const double width = 1 / static_cast<double>(std::uint32_t{1} << found.depth);
    const std::int64_t one = std::int64_t{1} << time_bits, least_count = (one >> found.depth) * found.j,
                       most_count = least_count + (one >> found.depth);
    auto count = static_cast<std::int64_t>((static_cast<double>(found.j) + x) * width * static_cast<double>(one));
    const double error = filter.volume_error(0x1p-90);
    const int at_start = c0 < 0 ? -1 : 1;
    for (int step = 0; step < 4; ++step) {
        if (count < least_count || count >= most_count) break;
        const int before = sign_of_volume<Edges>(p, static_cast<double>(count) * last_time_bit, error);
        const int after = sign_of_volume<Edges>(p, static_cast<double>(count + 1) * last_time_bit, error);
        if (before == 0 || after == 0) break;
        if (before == at_start && after == -at_start) return {count};
        count += before == at_start ? 1 : -1;
    }
    return {time_in_bits::unknown};
}

/// In registers; `unknown` only of filtered and exact.
template <motion_arithmetic A, bool Edges, scalar T>
ABUT_HD constexpr double time_in_registers(const moving_points<T>& p, const conservative_bounds& bounds) {
    if constexpr (std::same_as<A, fast>) {
        return static_cast<double>(fast_motion<Edges, T>(p).time());
    } else if constexpr (std::same_as<A, conservative>) {
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
template <motion_arithmetic A = filtered, class S, class U>
    requires detail::are_features<S, U>
[[nodiscard]] double time_of_impact(const S& s, const U& t, const conservative_bounds& bounds = {}) {
    return detail::time_on_host<A, detail::is_moving_edge<S>>(detail::points_of(s, t), bounds);
}

}  // namespace abut
