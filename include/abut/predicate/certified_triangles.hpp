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
// |w|, of which what is computed falls short by 20e at most. The code takes 10e. Contraction only lowers the errors. Few
// vectors are measured, two edges of each triangle and one or two that join them: a way from corner to corner is no longer
// than the sum of the ways that it could be replaced by. Underflow, and numbers flushed to zero: let m be the smallest
// normal number and B >= 1 a bound on all differences. An input or a result flushed to zero is off by m, a difference by 4m;
// what that makes of the determinant is less than 89 m B^2. With B = 2^29, m = 2^-126 that is below 2^-61, with B = 2^300,
// m = 2^-1022 below 2^-415: `flushed` is more. The sum of the five magnitudes has to be below B / 2, and no difference is
// more than that. What overflows fails that test, and so does NaN.

#include <cstddef>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/lone_corner.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

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

/// Two edges of a triangle, from its first corner. No two of its points are more than `size` apart.
template <bool Certified, scalar T>
struct edges_of {
    vec3<T> f, g;
    T size, product;

    ABUT_HD constexpr explicit edges_of(const triangle<T>& t)
        : f(between(t.a, t.b)), g(between(t.a, t.c)), size(0), product(0) {
        if constexpr (Certified) {
            const T to_b = magnitudes(f), to_c = magnitudes(g);
            size = to_b + to_c;
            product = determinant_error<T> * (to_b * to_c);
        }
    }
    [[nodiscard]] ABUT_HD constexpr vec3<T> normal() const { return cross(f, g); }
};

/// Three corners above or below a plane, by determinants of which none is off by more than `error`.
template <scalar T>
struct heights {
    T a, b, c, error;

    /// Positive if all are certainly on one side.
    [[nodiscard]] ABUT_HD constexpr T gap() const { return greatest(least(a, b, c), -greatest(a, b, c)) - error; }
    /// Positive if it is certain for each corner on which side it is.
    [[nodiscard]] ABUT_HD constexpr T certainty() const { return least(absolute(a), absolute(b), absolute(c)) - error; }
    /// A bit for each corner that is above.
    [[nodiscard]] ABUT_HD constexpr unsigned above() const {
        return static_cast<unsigned>(a > 0) | static_cast<unsigned>(b > 0) << 1 | static_cast<unsigned>(c > 0) << 2;
    }
};

/// Corner k of a triangle. A host reads it where it lies; a device has no indexed registers, and would go through memory.
template <class T>
ABUT_HD constexpr vec3<T> corner(const triangle<T>& t, unsigned k) {
#if ABUT_DEVICE_CODE
    const auto pick = [k](T a, T b, T c) { return k == 0 ? a : k == 1 ? b : c; };
    return {pick(t.a.x, t.b.x, t.c.x), pick(t.a.y, t.b.y, t.c.y), pick(t.a.z, t.b.z, t.c.z)};
#else
    if (ABUT_CONSTANT_EVALUATED()) return k == 0 ? t.a : k == 1 ? t.b : t.c;
    static_assert(sizeof(t) == 9 * sizeof(T));
    const T* const x = reinterpret_cast<const T*>(&t) + 3 * k;
    return {x[0], x[1], x[2]};
#endif
}

/// A triangle's corners in the order that `lone_corner` finds.
template <scalar T>
struct turned {
    vec3<T> alone, next, last;

    ABUT_HD constexpr turned(const triangle<T>& t, unsigned above, unsigned other_above) {
        const lone_corner k(above, other_above);
        alone = corner(t, k.alone);
        next = corner(t, k.next);
        last = corner(t, k.last);
    }
};

template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_in_general_position(const triangle<T>& s, const triangle<T>& t) {
    const edges_of<Certified, T> of_s(s), of_t(t);
    const vec3<T> to_s = between(t.a, s.a), to_t = between(s.a, t.a);
    T error_of_s = 0, error_of_t = 0;
    if constexpr (Certified) {
        const T apart = magnitudes(to_s);
        if (!(apart + (of_s.size + of_t.size) < difference_limit<T>)) return verdict::unknown;
        error_of_s = of_t.product * (apart + of_s.size) + flushed<T>;
        error_of_t = of_s.product * (apart + of_t.size) + flushed<T>;
    }
    const vec3<T> m = of_t.normal(), n = of_s.normal();
    const heights<T> p{dot(m, to_s), dot(m, between(t.a, s.b)), dot(m, between(t.a, s.c)), error_of_s};
    const heights<T> q{dot(n, to_t), dot(n, between(s.a, t.b)), dot(n, between(s.a, t.c)), error_of_t};
    // One branch for both triangles: it is cheaper than a second one that is hard to predict.
    if (greatest(p.gap(), q.gap()) > 0) return verdict::no;
    if (!(least(p.certainty(), q.certainty()) > 0)) return verdict::unknown;

    const turned<T> v(s, p.above(), q.above()), w(t, q.above(), p.above());
    const vec3<T> across = between(v.alone, w.alone);
    const T first = dot(cross(between(v.alone, v.next), across), between(v.alone, w.next));
    const T second = dot(cross(between(v.alone, v.last), between(v.alone, w.last)), across);
    const T most = greatest(first, second);
    T error = 0;
    if constexpr (Certified) {
        const T apart = magnitudes(across);
        error = determinant_error<T> * of_s.size * (apart * (apart + of_t.size)) + flushed<T>;
    }
    return absolute(most) > error ? to_verdict(most < 0) : verdict::unknown;
}

/// A segment against a triangle: its ends against the plane, then its line against the three sides.
template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_in_general_position(const segment<T>& s, const triangle<T>& t) {
    const edges_of<Certified, T> of_t(t);
    const vec3<T> to_s = between(t.a, s.a), along = between(s.a, s.b);
    T error_of_s = 0, error = 0;
    if constexpr (Certified) {
        const T apart = magnitudes(to_s), length = magnitudes(along), reach = apart + (length + of_t.size);
        if (!(reach < difference_limit<T>)) return verdict::unknown;
        error_of_s = of_t.product * (apart + length) + flushed<T>;
        error = determinant_error<T> * length * (reach * reach) + flushed<T>;
    }
    const vec3<T> m = of_t.normal();
    const T a = dot(m, to_s), b = dot(m, between(t.a, s.b));
    if (greatest(least(a, b), -greatest(a, b)) > error_of_s) return verdict::no;
    if (!(least(absolute(a), absolute(b)) > error_of_s)) return verdict::unknown;

    const vec3<T> to_a = between(s.a, t.a), to_b = between(s.a, t.b), to_c = between(s.a, t.c);
    const T ab = dot(cross(along, to_a), to_b), bc = dot(cross(along, to_b), to_c), ca = dot(cross(along, to_c), to_a);
    const T lowest = least(ab, bc, ca), highest = greatest(ab, bc, ca);
    if (lowest < -error && highest > error) return verdict::no;
    return lowest > error || highest < -error ? verdict::yes : verdict::unknown;
}

// The same in double for input in float. A float that is subnormal may be widened to zero, if the processor is told to, so
// it is left to the integers. Differences and products of others do not underflow in double.

ABUT_HD constexpr triangle<double> widened(const triangle<float>& t) { return {widened(t.a), widened(t.b), widened(t.c)}; }
ABUT_HD constexpr segment<double> widened(const segment<float>& s) { return {widened(s.a), widened(s.b)}; }

/// `values` are the numbers of both shapes.
template <class Shape, std::size_t V>
ABUT_HD constexpr verdict decide_widened(const Shape& s, const triangle<float>& t, const row_of<float, V>& values) {
    if (any_subnormal(values.value)) return verdict::unknown;
    return decide_in_general_position<true>(widened(s), widened(t));
}

}  // namespace abut::detail
