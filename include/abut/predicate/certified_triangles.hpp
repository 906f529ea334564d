// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the predicates between triangles and segments: pairs in general position, by signs of
// orientation determinants with a bound on their error (`filtered`) or without (`fast`). What a bound leaves open, and what
// is degenerate or touches, is for exact_triangles.hpp.
//
// The test. Each triangle's corners against the other's plane; if no sign is 0 and neither is on one side, one corner of
// each is alone on its side: p of s, u of t. The line in which the planes meet runs through both triangles, and two
// determinants say whether the two intervals on it overlap: O. Devillers, P. Guigue, Faster triangle-triangle intersection
// tests (2002), INRIA RR-4488, section 4. Degenerate input never gets that far: its signs are 0, and never certain.
//
// The bound. Let e = 2u be the relative error of an operation in any rounding mode, and |v| the sum of a vector's
// magnitudes. A determinant (f x g) . w is computed from differences (1+e) as products (1+e) of them, differences of those
// (1+e), products (1+e) and two sums (1+e)^2: no more than eight factors on any path, so its error is below 8.01e |f| |g|
// |w|, which as computed falls short by 13e at most. The code takes 10e. Contraction only lowers the errors. Underflow, and
// numbers flushed to zero: let m be the smallest normal number and B >= 1 a bound on all differences. An input or a result
// flushed to zero is off by m, a difference by 4m; what that makes of the determinant is less than 89 m B^2. With B = 2^29,
// m = 2^-126 that is below 2^-61, with B = 2^300, m = 2^-1022 below 2^-415: `flushed` is more. Differences that are looked
// at have to be below B / 2, and all others are between those. What overflows fails that test, and so does NaN.

#include <abut/arithmetic/absolute.hpp>
#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <scalar F>
ABUT_HD constexpr F lesser_of(F a, F b) {
    return a < b ? a : b;
}
template <scalar F>
ABUT_HD constexpr F greater_of(F a, F b) {
    return a > b ? a : b;
}

template <scalar T>
inline constexpr T determinant_error = 20 * unit_roundoff<T>;
template <scalar T>
inline constexpr T difference_limit = std::same_as<T, float> ? T(0x1p28) : T(0x1p299);
template <scalar T>
inline constexpr T flushed = std::same_as<T, float> ? T(0x1p-60) : T(0x1p-400);

/// to - from. A number that a caller computes as a product, inlined to here, must not be contracted into this difference:
/// the bound would speak of another number than the integers. On a device nothing else prevents that; on a host `intersects`
/// reads its arguments from memory.
template <scalar T>
ABUT_HD constexpr vec3<T> between(const vec3<T>& from, const vec3<T>& to) {
    return {plain_sum(to.x, -from.x), plain_sum(to.y, -from.y), plain_sum(to.z, -from.z)};
}

/// The error of (f x g) . w for all w with |w| <= reach; 0 unless `Certified`. `largest` bounds all differences in it.
template <bool Certified, scalar T>
struct error_of_determinant {
    T largest, error;

    ABUT_HD constexpr error_of_determinant(const vec3<T>& f, const vec3<T>& g, T reach) : largest(0), error(0) {
        if constexpr (Certified) {
            const T a = magnitudes(f), b = magnitudes(g);
            largest = greater_of(greater_of(a, b), reach);
            error = determinant_error<T> * (a * b) * reach + flushed<T>;
        }
    }
    [[nodiscard]] ABUT_HD constexpr bool holds() const { return !Certified || largest < difference_limit<T>; }
};

/// Three corners against a plane: positive, negative, or within `error` of neither.
template <bool Certified, scalar T>
struct sides_of_plane {
    T a, b, c;
    error_of_determinant<Certified, T> bound;

    ABUT_HD constexpr sides_of_plane(const triangle<T>& plane, const triangle<T>& t)
        : sides_of_plane(between(plane.a, plane.b), between(plane.a, plane.c), between(plane.a, t.a), between(plane.a, t.b),
                         between(plane.a, t.c)) {}
    ABUT_HD constexpr sides_of_plane(const vec3<T>& f, const vec3<T>& g, const vec3<T>& p, const vec3<T>& q,
                                     const vec3<T>& r)
        : a(0), b(0), c(0), bound(f, g, greater_of(greater_of(magnitudes(p), magnitudes(q)), magnitudes(r))) {
        const vec3<T> n = cross(f, g);
        a = dot(n, p);
        b = dot(n, q);
        c = dot(n, r);
    }
    [[nodiscard]] ABUT_HD constexpr bool on_one_side() const {
        const T least = lesser_of(lesser_of(a, b), c), most = greater_of(greater_of(a, b), c);
        return static_cast<int>(least > bound.error) | static_cast<int>(most < -bound.error);  // one branch, not two
    }
    [[nodiscard]] ABUT_HD constexpr bool certain() const {
        return lesser_of(lesser_of(absolute(a), absolute(b)), absolute(c)) > bound.error;
    }
    /// Which corner is alone on its side, where two are on the other.
    [[nodiscard]] ABUT_HD constexpr int lone() const {
        const bool up = a > 0;
        return up == (b > 0) ? 2 : up == (c > 0) ? 1 : 0;
    }
};

/// Corner k of a triangle. A device has no indexed registers, and would go through memory.
template <class T>
ABUT_HD constexpr vec3<T> corner(const triangle<T>& t, int k) {
#if ABUT_DEVICE_CODE
    const auto pick = [k](T a, T b, T c) { return k == 0 ? a : k == 1 ? b : c; };
    return {pick(t.a.x, t.b.x, t.c.x), pick(t.a.y, t.b.y, t.c.y), pick(t.a.z, t.b.z, t.c.z)};
#else
    const vec3<T> corners[3] = {t.a, t.b, t.c};
    return corners[k];
#endif
}

/// A triangle's corners from the one that is alone on its side, in the order in which the other's lone corner is above.
template <scalar T>
struct turned {
    vec3<T> alone, next, last;

    ABUT_HD constexpr turned(const triangle<T>& t, int k, bool other_is_above) {
        const int after_k = k == 2 ? 0 : k + 1, before_k = k == 0 ? 2 : k - 1;
        alone = corner(t, k);
        next = corner(t, other_is_above ? after_k : before_k);
        last = corner(t, other_is_above ? before_k : after_k);
    }
};

/// f x g . h and its error.
template <bool Certified, scalar T>
struct oriented {
    T value, error;

    ABUT_HD constexpr oriented(const vec3<T>& f, const vec3<T>& g, const vec3<T>& h) {
        value = dot(cross(f, g), h);
        error = error_of_determinant<Certified, T>(f, g, magnitudes(h)).error;
    }
    [[nodiscard]] ABUT_HD constexpr bool positive() const { return value > error; }
    [[nodiscard]] ABUT_HD constexpr bool negative() const { return value < -error; }
};

template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_in_general_position(const triangle<T>& s, const triangle<T>& t) {
    const sides_of_plane<Certified, T> of_s(t, s);
    if (of_s.on_one_side() && of_s.bound.holds()) return verdict::no;
    const sides_of_plane<Certified, T> of_t(s, t);
    if (!of_s.bound.holds() || !of_t.bound.holds()) return verdict::unknown;
    if (of_t.on_one_side()) return verdict::no;
    if (!of_s.certain() || !of_t.certain()) return verdict::unknown;

    const int i = of_s.lone(), j = of_t.lone();
    const bool s_up = (i == 0 ? of_s.a : i == 1 ? of_s.b : of_s.c) > 0;
    const bool t_up = (j == 0 ? of_t.a : j == 1 ? of_t.b : of_t.c) > 0;
    const turned<T> p(s, i, t_up), u(t, j, s_up);
    const vec3<T> across = between(p.alone, u.alone);
    const oriented<Certified, T> first(between(p.alone, p.next), across, between(p.alone, u.next));
    if (first.positive()) return verdict::no;
    const oriented<Certified, T> second(between(p.alone, p.last), between(p.alone, u.last), across);
    if (second.positive()) return verdict::no;
    return first.negative() && second.negative() ? verdict::yes : verdict::unknown;
}

/// A segment against a triangle: its ends against the plane, then its line against the three sides.
template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_in_general_position(const segment<T>& s, const triangle<T>& t) {
    const vec3<T> f = between(t.a, t.b), g = between(t.a, t.c), p = between(t.a, s.a), q = between(t.a, s.b);
    const error_of_determinant<Certified, T> bound(f, g, greater_of(magnitudes(p), magnitudes(q)));
    if (!bound.holds()) return verdict::unknown;
    const vec3<T> n = cross(f, g);
    const T a = dot(n, p), b = dot(n, q), error = bound.error;
    if (lesser_of(a, b) > error || greater_of(a, b) < -error) return verdict::no;
    if (!(lesser_of(absolute(a), absolute(b)) > error)) return verdict::unknown;

    const vec3<T> along = between(s.a, s.b), to_a = between(s.a, t.a), to_b = between(s.a, t.b), to_c = between(s.a, t.c);
    const oriented<Certified, T> ab(along, to_a, to_b), bc(along, to_b, to_c), ca(along, to_c, to_a);
    const bool left = ab.positive() || bc.positive() || ca.positive();
    const bool right = ab.negative() || bc.negative() || ca.negative();
    if (left && right) return verdict::no;
    const bool all = (ab.positive() && bc.positive() && ca.positive()) || (ab.negative() && bc.negative() && ca.negative());
    return all ? verdict::yes : verdict::unknown;
}

// The same in double for input in float. A float that is subnormal may be widened to zero, if the processor is told to, so
// it is left to the integers. Differences and products of others do not underflow in double.

ABUT_HD constexpr vec3<double> widened(const vec3<float>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
ABUT_HD constexpr triangle<double> widened(const triangle<float>& t) { return {widened(t.a), widened(t.b), widened(t.c)}; }
ABUT_HD constexpr segment<double> widened(const segment<float>& s) { return {widened(s.a), widened(s.b)}; }

ABUT_HD constexpr bool has_subnormal(const vec3<float>& v) {
    return is_subnormal(v.x) || is_subnormal(v.y) || is_subnormal(v.z);
}
ABUT_HD constexpr bool has_subnormal(const triangle<float>& t) {
    return has_subnormal(t.a) || has_subnormal(t.b) || has_subnormal(t.c);
}
ABUT_HD constexpr bool has_subnormal(const segment<float>& s) { return has_subnormal(s.a) || has_subnormal(s.b); }

template <class Shape>
ABUT_HD constexpr verdict decide_widened(const Shape& s, const triangle<float>& t) {
    if (has_subnormal(s) || has_subnormal(t)) return verdict::unknown;
    return decide_in_general_position<true>(widened(s), widened(t));
}

}  // namespace abut::detail
