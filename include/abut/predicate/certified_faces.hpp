// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of face_face.hpp: faces that share one vertex or two, in general position, with a bound on errors
// (`filtered`) or without (`fast`). What a bound leaves open is for exact_faces.hpp. In a mesh these are most of all pairs
// that come near each other, and nearly none of them meet in more than what they share: the first test of each is cheap and
// says no of most, also where faces lie in one plane.
//
// `filtered` computes in double, also for float input. With e = 2^-52, the relative error of an operation in any rounding
// mode: a product of two differences, or a sum or difference of two such, or of three, is off by less than 5e times what the
// magnitudes make of it, which is less than the product of both vectors' sums of magnitudes; the code takes 16e.
// Determinants are those of certified_triangles.hpp: 10e. Contraction only lowers the errors.
//
// What is flushed to zero, if a processor is told to: let m be the smallest normal number of the input, and r the sum of the
// magnitudes of all differences. A difference is off by 3m, which is 9m for three coordinates. A product of two differences
// loses less than 9m r + 81m^2, one of three less than 27m (r + 36m)^2. Double input loses up to m in each operation
// besides: 5m in a sum of two products of two, 3m r + 5m in a determinant. Products of floats do not underflow in double.
// With a unit of 64m (float) or 1 (double), 16m (r + unit) and 128m (r + unit)^2 are more than that.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_triangles.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Where the filter computes.
template <bool Certified, scalar T>
using filter_scalar = std::conditional_t<Certified, double, T>;

template <bool Certified, scalar T>
ABUT_HD constexpr vec3<filter_scalar<Certified, T>> edge_between(const vec3<T>& from, const vec3<T>& to) {
    if constexpr (Certified) {
        return between(widened(from), widened(to));
    } else {
        return between(from, to);
    }
}

/// What is lost where numbers are flushed to zero, in products of two differences and of three, whose magnitudes add up to
/// r.
template <scalar T>
inline constexpr double least_input = static_cast<double>(smallest_normal<T>);
template <scalar T>
inline constexpr double unit_of_flushed = std::same_as<T, float> ? 0x1p-120 : 1;
template <scalar T>
ABUT_HD constexpr double flushed_in_two(double r) {
    return 16 * least_input<T> * (r + unit_of_flushed<T>);
}
template <scalar T>
ABUT_HD constexpr double flushed_in_three(double r) {
    return 128 * least_input<T> * (r + unit_of_flushed<T>)*(r + unit_of_flushed<T>);
}

inline constexpr double product_error = 0x1p-48;

/// Positive if both are certainly on one side, by heights of which none is off by more than `error`.
template <scalar F>
ABUT_HD constexpr F gap_of(F a, F b, F error) {
    return greatest(least(a, b), -greatest(a, b)) - error;
}

/// Faces that share their first corner.
template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_beyond_vertex(const triangle<T>& s, const triangle<T>& t) {
    using F = filter_scalar<Certified, T>;
    const vec3<F> a = edge_between<Certified>(s.a, s.b), b = edge_between<Certified>(s.a, s.c);
    const vec3<F> c = edge_between<Certified>(t.a, t.b), d = edge_between<Certified>(t.a, t.c);
    F error = 0, error_of_s = 0, error_of_t = 0;
    if constexpr (Certified) {
        const F to_a = magnitudes(a), to_b = magnitudes(b), to_c = magnitudes(c), to_d = magnitudes(d);
        const F reach = (to_a + to_b) + (to_c + to_d);
        if (!(reach < difference_limit<F>)) return verdict::unknown;
        error = product_error * (reach * reach) + flushed_in_two<T>(reach);
        error_of_s = determinant_error<F> * ((to_c * to_d) * (to_a + to_b)) + flushed_in_three<T>(reach);
        error_of_t = determinant_error<F> * ((to_a * to_b) * (to_c + to_d)) + flushed_in_three<T>(reach);
    }
    // A plane through the vertex with one face strictly above and the other one below, if it is one; any will do.
    const vec3<F> up = (a + b) - (c + d);
    if (least(dot(up, a), dot(up, b), -dot(up, c), -dot(up, d)) > error) return verdict::no;

    const vec3<F> m = cross(a, b), n = cross(c, d);
    const F of_a = dot(n, a), of_b = dot(n, b), of_c = dot(m, c), of_d = dot(m, d);
    if (greatest(gap_of(of_a, of_b, error_of_s), gap_of(of_c, of_d, error_of_t)) > 0) return verdict::no;
    const bool certain =
        least(absolute(of_a), absolute(of_b)) > error_of_s && least(absolute(of_c), absolute(of_d)) > error_of_t;
    return certain ? to_verdict((of_b > 0) != (of_d > 0)) : verdict::unknown;
}

/// Positive if one is certainly positive and the other negative.
template <scalar F>
ABUT_HD constexpr F opposition(F x, F error_of_x, F y, F error_of_y) {
    return greatest(least(x - error_of_x, -y - error_of_y), least(-x - error_of_x, y - error_of_y));
}

/// Faces that share their first two corners. They meet in the edge alone where their third corners are on two sides of it,
/// seen along any axis, since then a plane through the edge is between them; and where the corners are not in one plane.
template <bool Certified, scalar T>
ABUT_HD constexpr verdict decide_beyond_edge(const triangle<T>& s, const triangle<T>& t) {
    using F = filter_scalar<Certified, T>;
    const vec3<F> along = edge_between<Certified>(s.a, s.b);
    const vec3<F> to_s = edge_between<Certified>(s.a, s.c), to_t = edge_between<Certified>(s.a, t.c);
    F error_of_s = 0, error_of_t = 0, error = 0;
    if constexpr (Certified) {
        const F length = magnitudes(along), reach_s = magnitudes(to_s), reach_t = magnitudes(to_t);
        const F reach = length + (reach_s + reach_t);
        if (!(reach < difference_limit<F>)) return verdict::unknown;
        error_of_s = product_error * (length * reach_s) + flushed_in_two<T>(reach);
        error_of_t = product_error * (length * reach_t) + flushed_in_two<T>(reach);
        error = determinant_error<F> * (length * (reach_s * reach_t)) + flushed_in_three<T>(reach);
    }
    const vec3<F> m = cross(along, to_s), n = cross(along, to_t);
    const F apart = greatest(opposition(m.x, error_of_s, n.x, error_of_t), opposition(m.y, error_of_s, n.y, error_of_t),
                             opposition(m.z, error_of_s, n.z, error_of_t));
    if (apart > 0 || absolute(dot(m, to_t)) > error) return verdict::no;
    return verdict::unknown;
}

}  // namespace abut::detail
