// SPDX-License-Identifier: MIT
#pragma once

// What makes a type a shape: the concepts, and what every shape is asked. All of these functions are called unqualified and
// found by argument-dependent lookup, so a shape of the caller's own has them beside it, in the caller's namespace;
// docs/extending.md shows one from start to end. Not for how two shapes meet: that is decidable_pair
// (predicate/intersects.hpp).

#include <concepts>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/error_free.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace abut {

/// @addtogroup shapes
///@{

namespace detail {

template <class S>
struct named_scalar {};
template <class S>
    requires requires { typename S::scalar_type; }
struct named_scalar<S> {
    using type = typename S::scalar_type;
};
template <template <class> class S, scalar T>
    requires(!requires { typename S<T>::scalar_type; })
struct named_scalar<S<T>> {
    using type = T;
};

}  // namespace detail

/// float or double: what a type names as its `scalar_type`, or else T of a template S<T>.
template <class S>
using scalar_type_of = typename detail::named_scalar<S>::type;

/// Has `bounds(s)`: a box around all of the shape, of all space if need be. It may be larger than the shape and is never
/// smaller: where arithmetic rounds, it rounds outward. On hosts and devices, in constant time, or in time that is linear in
/// what the shape is made of.
template <class S>
concept boundable = scalar<scalar_type_of<S>> && requires(const S& s) {
    { bounds(s) } -> std::same_as<aabb<scalar_type_of<S>>>;
};

/// A closed set of points, as plain data. Copies go to other threads and to devices, and arrays of it are read as they are.
template <class S>
concept shape = std::is_trivially_copyable_v<S> && std::default_initializable<S> && boundable<S>;

/// Has `place(pose, s)`: the shape where a pose puts it, which may be of another type. Each of its points may be off by no
/// more than `place` of a point is (rigid.hpp), or culling under poses would lose pairs: place the points that the shape is
/// made of and keep its lengths. Planes have none.
template <class S>
concept placeable = shape<S> && requires(const rigid<scalar_type_of<S>>& pose, const S& s) {
    { place(pose, s) } -> shape;
};
/// What a shape is under a pose: of a box along the axes or an oriented one a `placed_box`, else what it was.
template <placeable S>
using placed_shape = decltype(place(std::declval<const rigid<scalar_type_of<S>>&>(), std::declval<const S&>()));

/// Whether the numbers make a shape: they are finite, radii are not negative, boxes not inside out. What is not valid is
/// refused when a set or an index is made of it, and where it is posed.
///@{
template <scalar T>
ABUT_HD constexpr bool is_valid(const vec3<T>& p) {
    return detail::is_finite(p.x) && detail::is_finite(p.y) && detail::is_finite(p.z);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const triangle<T>& t) {
    return is_valid(t.a) && is_valid(t.b) && is_valid(t.c);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const sphere<T>& s) {
    return is_valid(s.center) && detail::is_finite(s.radius) && s.radius >= 0;
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const segment<T>& s) {
    return is_valid(s.a) && is_valid(s.b);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const aabb<T>& box) {
    return is_valid(box.lower) && is_valid(box.upper) && box.lower.x <= box.upper.x && box.lower.y <= box.upper.y &&
           box.lower.z <= box.upper.z;
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const plane<T>& p) {
    return is_valid(p.normal) && detail::is_finite(p.offset);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const ray<T>& r) {
    return is_valid(r.origin) && is_valid(r.direction);
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const capsule<T>& s) {
    return is_valid(s.axis) && detail::is_finite(s.radius) && s.radius >= 0;
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const cylinder<T>& s) {
    return is_valid(s.axis) && detail::is_finite(s.radius) && s.radius >= 0;
}
template <scalar T>
ABUT_HD constexpr bool is_valid(const cone<T>& s) {
    return is_valid(s.apex) && is_valid(s.base_center) && detail::is_finite(s.radius) && s.radius >= 0;
}
///@}
/// A shape that does not say otherwise is valid if its box is.
template <shape S>
ABUT_HD constexpr bool is_valid(const S& s) {
    return is_valid(bounds(s));
}

namespace detail {

template <scalar T>
struct reach_of_box {
    aabb<T> box;
    ABUT_HD bool operator()(const aabb<T>& other) const { return overlaps(box, other); }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return box; }
};

}  // namespace detail

namespace detail {

/// Whether a shape refers to memory that it does not hold: then a copy of it says nothing where that memory cannot be read.
template <class S>
inline constexpr bool refers_to_memory = false;

}  // namespace detail

/// How far a shape reaches, as a prune functor (shape/reach.hpp). A shape that does not say otherwise reaches what
/// overlaps its box.
template <shape S>
ABUT_HD auto reach_of(const S& s) {
    return detail::reach_of_box<scalar_type_of<S>>{bounds(s)};
}

///@}

}  // namespace abut
