// SPDX-License-Identifier: MIT
#pragma once

// Has a triangle no area, that is, do its corners lie on one line? The normal (b - a) x (c - a) is 0 then, and only then.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

struct corners_on_a_line {
    static constexpr int degree = 2, points = 3;

    template <class N>
    ABUT_HD static constexpr bool holds(const N (&v)[9]) {
        const vec3<N> a{v[0], v[1], v[2]}, b{v[3], v[4], v[5]}, c{v[6], v[7], v[8]};
        const auto normal = cross(b - a, c - a);
        return sign(normal.x) == 0 && sign(normal.y) == 0 && sign(normal.z) == 0;
    }
};

/// to - from in double. The barriers keep a product that the caller has just made out of the difference.
template <scalar T>
ABUT_HD constexpr vec3<double> difference(const vec3<T>& from, const vec3<T>& to) {
    const auto minus = [](T x, T y) { return plain_sum(static_cast<double>(rounded(x)), -static_cast<double>(rounded(y))); };
    return {minus(to.x, from.x), minus(to.y, from.y), minus(to.z, from.z)};
}

/// In double, also for float input: `no`, or `unknown`. With e = 2^-52, the relative error of an operation in any rounding
/// mode, a coordinate of the normal is a difference (1+e) of products (1+e) of differences (1+e), so its error is
/// below 4.01e times the sum of both products' magnitudes, which as computed falls short by 4e at most. The code takes 16e.
/// Contraction only lowers the error. What is flushed to zero, if a processor is told to: let m be the smallest normal
/// number of the input. Two inputs and a difference lose 3m, which costs a product 3m times the other factor and 9m^2;
/// products of doubles and their difference may lose m each, those of floats in double lose nothing. The code takes 16m (|f|
/// + |g|), and 64m^2 (float) or 16m (double). Nothing overflows where the differences are below 2^500, which no NaN is; a
/// rounding mode may make a finite number of what has overflowed.
template <scalar T>
ABUT_HD constexpr verdict certified_area(const triangle<T>& t) {
    constexpr bool narrow = std::same_as<T, float>;
    constexpr double relative = 0x1p-48, flushed = narrow ? 0x1p-122 : 0x1p-1018, least = narrow ? 0x1p-246 : 0x1p-1018;
    const vec3<double> f = difference(t.a, t.b), g = difference(t.a, t.c);
    const vec3<double> normal = absolute(cross(f, g)), size_f = absolute(f), size_g = absolute(g);
    const vec3<double> size{size_f.y * size_g.z + size_f.z * size_g.y, size_f.z * size_g.x + size_f.x * size_g.z,
                            size_f.x * size_g.y + size_f.y * size_g.x};
    const double reach = magnitudes(f) + magnitudes(g), floor = flushed * reach + least;
    const bool positive =
        normal.x > relative * size.x + floor || normal.y > relative * size.y + floor || normal.z > relative * size.z + floor;
    return positive && reach < 0x1p500 ? verdict::no : verdict::unknown;
}

}  // namespace detail

/// One stage of the decision, as for pairs of shapes: `filtered` says `no` or `unknown`; `exact` leaves `unknown` only spans
/// of exponents beyond 124 bits.
template <arithmetic A, scalar T>
    requires(!std::same_as<A, fast>)
ABUT_HD constexpr verdict decide_zero_area(const triangle<T>& t) {
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::corners_on_a_line>(detail::in_a_row(t.a, t.b, t.c).value);
    } else {
        return detail::certified_area(t);
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_zero_area(const triangle<T>& t) {
    return decide_at_any_span<detail::corners_on_a_line>(detail::in_a_row(t.a, t.b, t.c).value);
}

/// Whether the corners of a triangle lie on one line or in one point. Right for every finite input, with `filtered` and with
/// `exact`. Pure, for hosts and devices; constant expressions are decided in integers.
///
///     static_assert(abut::has_zero_area(abut::triangle<float>{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}));
template <arithmetic A = filtered, scalar T>
    requires(!std::same_as<A, fast>)
[[nodiscard]] ABUT_HD constexpr bool has_zero_area(const triangle<T>& t) {
    if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
        if (decide_zero_area<filtered>(t) == verdict::no) return false;
    }
    const verdict v = decide_zero_area<exact>(t);
    return v == verdict::unknown ? resolve_zero_area(t) : v == verdict::yes;
}

}  // namespace abut
