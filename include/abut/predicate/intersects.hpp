// SPDX-License-Identifier: MIT
#pragma once

// `intersects`: does one shape touch another? The face over the stages `decide` and `resolve` of each pair of shapes, in
// either order of arguments.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/aabb_aabb.hpp>
#include <abut/predicate/aabb_capsule.hpp>
#include <abut/predicate/aabb_sphere.hpp>
#include <abut/predicate/aabb_triangle.hpp>
#include <abut/predicate/as_hull.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/capsule_triangle.hpp>
#include <abut/predicate/half_space.hpp>
#include <abut/predicate/hull_hull.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/plane_hull.hpp>
#include <abut/predicate/plane_plane.hpp>
#include <abut/predicate/ray_hull.hpp>
#include <abut/predicate/ray_solid.hpp>
#include <abut/predicate/ray_triangle.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_hull.hpp>
#include <abut/predicate/revolution_pair.hpp>
#include <abut/predicate/segment_triangle.hpp>
#include <abut/predicate/sphere_sphere.hpp>
#include <abut/predicate/sphere_triangle.hpp>
#include <abut/predicate/triangle_triangle.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// @defgroup one_pair One pair of shapes
///
/// `intersects`, `contact_of`, `nearest_point`, `time_of_impact` and `weights_at`: of two shapes, or a shape and a point,
/// without a set or a policy.
///
/// @par Memory
/// Arguments and results are values. Nothing is allocated, but by `time_of_impact`, which may.
///
/// @par Errors
/// None are thrown, but `std::bad_alloc` by `time_of_impact`. Numbers have to be finite and radii not negative: that is not
/// checked here.
///
/// @par Synchronisation
/// Pure functions, on hosts and devices; `time_of_impact` on hosts alone. Any number of threads may call them.
///
/// @par Example
/// @snippet queries.cpp one_pair

/// A pair of shapes, in this order, that has the stages `decide<A>` for each arithmetic A and `resolve`, which answers
/// whatever input they leave; between them a pair may have `decide_late<A>` for `fast` and `filtered`. All are pure, and run
/// on hosts and devices. For `fast` the last of them never says `unknown`.
template <class S, class U>
concept decidable_pair = requires(const S& s, const U& t) {
    { decide<fast>(s, t) } -> std::same_as<verdict>;
    { decide<filtered>(s, t) } -> std::same_as<verdict>;
    { decide<exact>(s, t) } -> std::same_as<verdict>;
    { resolve(s, t) } -> std::same_as<bool>;
};

namespace detail {

/// The shape as it lies in memory. g++ 12, when it vectorises, drops the rounding of double to float where the float is
/// widened again: a caller's `static_cast<float>(x)` would reach the filter as x itself, and the integers as the float. And
/// a caller's product may be contracted into the filter's differences. The barrier claims to write, so that the compiler
/// reads from memory again; nothing is written or copied.
template <class Shape>
ABUT_HD constexpr const Shape& as_stored(const Shape& shape) {
#if !ABUT_DEVICE_CODE
    if (!ABUT_CONSTANT_EVALUATED()) ABUT_REREAD(const_cast<Shape&>(shape));
#endif
    return shape;
}

/// What the first stage left, in registers: by the pair's `decide_late`, if it has one, then in integers.
template <arithmetic A, class S, class U>
ABUT_HD constexpr verdict decide_open(const S& s, const U& t) {
    if constexpr (!std::same_as<A, exact> && requires { decide_late<A>(s, t); }) {
        if (std::same_as<A, fast> || !ABUT_CONSTANT_EVALUATED()) {
            const verdict v = decide_late<A>(s, t);
            if (std::same_as<A, fast> || v != verdict::unknown) return v;
        }
    }
    return decide<exact>(s, t);
}

/// Calls what queries call of two shapes, for the verb require_callable: of functions of the host, which a shape of the
/// caller's own may have by mistake, nothing would be left on a device. Its name is what nvcc says then.
template <class S, class U>
struct functions_of_shapes_have_to_be_marked_ABUT_HD {
    ABUT_DEVICE void operator()(const S* s, const U* t) const {
        (void)bounds(*s), (void)bounds(*t);
        if constexpr (decidable_pair<S, U>) {
            (void)decide<filtered>(*s, *t);
        } else {
            (void)decide<filtered>(*t, *s);
        }
    }
};

/// All stages that follow the filter. They are out of line themselves, so that they cost callers neither registers nor a
/// stack frame. This function must not be: with one more call in between, ptxas of CUDA 13.0 lost the address of a shape.
template <arithmetic A, class S, class U>
ABUT_HD constexpr bool intersects_exactly(const S& s, const U& t) {
    const verdict v = decide_open<A>(s, t);
    return v == verdict::unknown ? resolve(s, t) : v == verdict::yes;
}

}  // namespace detail

/// Whether two closed shapes have a point in common: triangles, segments, rays, points (vec3) and planes, and spheres,
/// boxes, oriented boxes, capsules, cylinders, cones, convex hulls and half spaces, which are solid, in the pairs that
/// docs/numerics/last-stage.md lists. With `filtered` and `exact` the answer is right for every finite input and the same on
/// each compiler and device; `fast` is approximate. Constant expressions are decided in integers.
///
///     static_assert(abut::intersects(abut::sphere<float>{{0, 0, 5}, 5},
///                                    abut::triangle<float>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}));
/// @ingroup one_pair
template <arithmetic A = filtered, class S, class U>
[[nodiscard]] ABUT_HD constexpr bool intersects(const S& s, const U& t) {
    if constexpr (decidable_pair<S, U>) {
        if constexpr (std::same_as<A, fast>) {
            const verdict v = decide<fast>(s, t);
            return v == verdict::unknown ? detail::decide_open<fast>(s, t) == verdict::yes : v == verdict::yes;
        } else {
            const S& stored_s = detail::as_stored(s);
            const U& stored_t = detail::as_stored(t);
            if (std::same_as<A, filtered> && !ABUT_CONSTANT_EVALUATED()) {
                const verdict v = decide<filtered>(stored_s, stored_t);
                if (v != verdict::unknown) return v == verdict::yes;
            }
            return detail::intersects_exactly<A>(stored_s, stored_t);
        }
    } else if constexpr (decidable_pair<U, S>) {
        return intersects<A>(t, s);
    } else {
        static_assert(decidable_pair<S, U>,
                      "abut::intersects does not support this pair of shapes (both of one scalar type)");
        return false;
    }
}

}  // namespace abut
