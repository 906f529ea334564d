// SPDX-License-Identifier: MIT
#pragma once

// Prune functors: how far a query reaches. `reach(box)` is false only if nothing in the box can touch the query; rounding
// may keep a box too many and never loses one. These stay as they are while a traversal runs; those that tighten, as better
// is found, are in ordered_walk.hpp. Those of the library's shapes are in the files of these.

#include <concepts>

#include <abut/shape/primitive.hpp>

namespace abut {

/// `reach.bounds()` is a box around all that it reaches. Both may run wherever the traversal runs, and take constant time.
template <class R, class T>
concept prune_functor = requires(R& reach, const aabb<T>& box) {
    { reach(box) } -> std::same_as<bool>;
    { reach.bounds() } -> std::same_as<aabb<T>>;
};

}  // namespace abut
