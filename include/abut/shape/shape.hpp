// SPDX-License-Identifier: MIT
#pragma once

// What makes a type a shape: the concepts, and what every shape is asked. All of these functions are called unqualified and
// found by argument-dependent lookup, so a shape of the caller's own has them beside it, in the caller's namespace;
// docs/extending.md shows one from start to end. Not for how two shapes meet: that is decidable_pair
// (predicate/intersects.hpp).

#include <concepts>
#include <type_traits>
#include <utility>

#include <abut/shape/form.hpp>
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

/// Has `flaw_of(s)`, which says what is wrong with the numbers, if anything is: all shapes of the library have.
template <class S>
concept tells_flaw = requires(const S& s) {
    { flaw_of(s) } -> std::same_as<shape_flaw>;
};

/// Whether the numbers make a shape: they are finite, radii are not negative, boxes not inside out. What is not valid is
/// refused when a set or an index is made of it, and where it is posed. A shape that does not say otherwise is valid if its
/// box is.
template <shape S>
ABUT_HD constexpr bool is_valid(const S& s) {
    if constexpr (tells_flaw<S>) {
        return !flaw_of(s);
    } else {
        return !flaw_of(bounds(s));
    }
}

namespace detail {

/// Whether a shape refers to memory that it does not hold: then a copy of it says nothing where that memory cannot be read.
template <class S>
inline constexpr bool refers_to_memory = false;

}  // namespace detail

/// How far a shape reaches, as a prune functor (shape/reach.hpp). A shape that does not say otherwise reaches what
/// overlaps its box.
template <shape S>
ABUT_HD auto reach_of(const S& s) {
    return detail::box_reach<scalar_type_of<S>>(bounds(s));
}

///@}

}  // namespace abut
