// SPDX-License-Identifier: MIT
#pragma once

// Does a shape touch a half space? It does if a point of it lies there, any one, or if it touches the plane at which the
// half space ends: no shape gets from one side to the other without that. So all stages but those of a point are the
// plane's, and a shape that has these needs no more. Planes and half spaces touch each other if their normals are not
// parallel, or by their offsets.

#include <concepts>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/predicate/as_hull.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/plane_plane.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/half_space.hpp>

namespace abut {

namespace detail {

/// Degree 2. The values of a plane and a point (plane_core.hpp).
struct half_space_holds_point {
    static constexpr int degree = 2, points = 0;
    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[8]) {
        const vec3<N> normal{value[0], value[1], value[2]}, p{value[5], value[6], value[7]};
        return sign(dot(normal, p) - value[3] * value[4]) <= 0;
    }
};

/// Degree 3: whether a half space touches a plane (`Solid`: another half space), whose numbers are the last four. Where
/// normals are parallel, m of the first and n of the second, m.x is (m.n) / (n.n) times n.x. It states no degree: sums of
/// three products, times a number, are too much for words.
template <bool Solid>
struct half_space_meets_plane {
    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[8]) {
        const vec3<N> m{value[0], value[1], value[2]}, n{value[4], value[5], value[6]};
        const auto across = cross(m, n);
        if (sign(across.x) != 0 || sign(across.y) != 0 || sign(across.z) != 0) return true;
        const auto square = dot(n, n), product = dot(m, n);
        if (sign(square) == 0) return Solid ? sign(value[7]) >= 0 : sign(value[7]) == 0;
        return (Solid && sign(product) > 0) || sign(product * value[7] - square * value[3]) <= 0;
    }
};

/// Shapes of the scalar type T that have stages with planes, and a point of one.
///@{
template <class S, class T>
concept beside_plane = has_core_points<S, T> || (solid_of_revolution<S> && std::same_as<scalar_type_of<S>, T>);
template <class S>
ABUT_HD constexpr vec3<scalar_type_of<S>> any_point_of(const S& s) {
    if constexpr (solid_of_revolution<S>) {
        return axis_of(s).a;
    } else {
        return core_points_of(s).as_hull()[0];
    }
}
///@}

template <class S>
inline constexpr bool is_half_space = false;
template <scalar T>
inline constexpr bool is_half_space<half_space<T>> = true;
/// A plane or another half space.
template <class S, class T>
concept flat_or_half_space = std::same_as<S, plane<T>> || std::same_as<S, half_space<T>>;

}  // namespace detail

/// One stage of the decision, as for a plane and the shape.
///@{
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const half_space<T>& s, const vec3<T>& p) {
    const auto values = detail::values_of(detail::surface_of(s), p);
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<detail::half_space_holds_point>(values.value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_heights<false, true>(detail::surface_of(s), detail::core_of(p), 0);
    } else {
        return to_verdict(detail::half_space_holds_point::holds(values.value));
    }
}
template <arithmetic A, scalar T, detail::beside_plane<T> S>
ABUT_HD constexpr verdict decide(const half_space<T>& s, const S& t) {
    const verdict v = decide<A>(s, detail::any_point_of(t));
    return v == verdict::yes ? v : v || detail::decide_in_place<A>(detail::surface_of(s), t);
}
template <arithmetic A, scalar T, detail::flat_or_half_space<T> S>
ABUT_HD constexpr verdict decide(const half_space<T>& s, const S& t) {
    using predicate = detail::half_space_meets_plane<detail::is_half_space<S>>;
    const auto values = detail::in_a_row(s.normal, s.offset, t.normal, t.offset);
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<predicate>(values.value);
    } else if constexpr (std::same_as<A, filtered>) {
        return detail::certified_normals(detail::surface_of(s), plane<T>{t.normal, t.offset});
    } else {
        return to_verdict(predicate::holds(values.value));
    }
}
///@}

/// The last stage: decides every finite input.
///@{
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const half_space<T>& s, const vec3<T>& p) {
    return decide_at_any_span<detail::half_space_holds_point>(detail::values_of(detail::surface_of(s), p).value);
}
template <scalar T, detail::beside_plane<T> S>
ABUT_HD constexpr bool resolve(const half_space<T>& s, const S& t) {
    return resolve(s, detail::any_point_of(t)) || detail::resolve_in_place(detail::surface_of(s), t);
}
template <scalar T, detail::flat_or_half_space<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const half_space<T>& s, const S& t) {
    using predicate = detail::half_space_meets_plane<detail::is_half_space<S>>;
    return decide_at_any_span<predicate>(detail::in_a_row(s.normal, s.offset, t.normal, t.offset).value);
}
///@}

}  // namespace abut
