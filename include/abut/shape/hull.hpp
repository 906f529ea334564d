// SPDX-License-Identifier: MIT
#pragma once

// The convex hull of points as a shape. It refers to its points, which lie elsewhere, as those of a set do (hulls.hpp): so
// it can have any number of them. No faces are made, and none are needed: whatever is asked of a hull is asked of its
// points. A set may have edges beside them (collide/hull_edges.hpp), by which the farthest one is found sooner.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// The convex hull of one point or more, in any order: solid where it has a volume, and else the polygon, segment or point
/// that it is. Points inside of it and repeated ones change nothing. The points are the caller's, or those of a set: they
/// have to outlive the hull and lie in memory of who reads it. A pose is kept, and applied to each point as it is read.
template <scalar T>
struct hull {
    const vec3<T>* points = nullptr;       ///< the first one
    std::size_t count = 0;                 ///< how many, 1 or more
    std::size_t stride = sizeof(vec3<T>);  ///< in bytes
    bool is_placed = false;                ///< whether `pose` is applied
    rigid<T> pose;                         ///< from the points' frame to the world's
    const std::uint32_t* edges = nullptr;  ///< those that `with_edges` made for these points, if it did

    /// Of no point, which is no shape yet.
    hull() = default;
    /// Of `n` points, `step` bytes apart.
    ABUT_HD constexpr hull(const vec3<T>* first, std::size_t n, std::size_t step = sizeof(vec3<T>),
                           const std::uint32_t* its_edges = nullptr)
        : points(first), count(n), stride(step), edges(its_edges) {}

    /// Point i, where it is in the world.
    [[nodiscard]] ABUT_HD constexpr vec3<T> operator[](std::size_t i) const {
        const vec3<T> p = unplaced(i);
        return is_placed ? place(pose, p) : p;
    }
    /// The same where the points are.
    [[nodiscard]] ABUT_HD constexpr vec3<T> unplaced(std::size_t i) const {
        return stride == sizeof(vec3<T>) ? points[i] : far_point(i);
    }
    /// The hull of `n` of the points, from number `first` on, under the same pose and without edges.
    [[nodiscard]] ABUT_HD constexpr hull part(std::size_t first, std::size_t n) const {
        hull some = *this;
        some.points = stride == sizeof(vec3<T>) ? points + first : &far_point(first);
        some.count = n;
        some.edges = nullptr;
        return some;
    }

private:
    [[nodiscard]] ABUT_HD const vec3<T>& far_point(std::size_t i) const {
        const void* const first = points;
        return *static_cast<const vec3<T>*>(static_cast<const void*>(static_cast<const unsigned char*>(first) + i * stride));
    }
};

/// The smallest box around the points. Exact, and linear in their number.
template <scalar T>
ABUT_HD constexpr aabb<T> bounds(const hull<T>& h) {
    aabb<T> box = empty_box<T>();
    for (std::size_t i = 0; i < h.count; ++i) box = merge(box, bounds(h[i]));
    return box;
}

/// Each point is placed as a point alone is. Of a hull that is placed already the poses are composed (`compose`).
template <scalar T>
ABUT_HD constexpr hull<T> place(const rigid<T>& pose, const hull<T>& h) {
    hull<T> placed = h;
    placed.pose = h.is_placed ? compose(pose, h.pose) : pose;
    placed.is_placed = true;
    return placed;
}

/// There is a point, and all are finite.
template <scalar T>
ABUT_HD constexpr bool is_valid(const hull<T>& h) {
    bool good = h.count > 0;
    for (std::size_t i = 0; i < h.count; ++i) good = good && is_valid(h[i]);
    return good;
}

namespace detail {

template <scalar T>
inline constexpr bool refers_to_memory<hull<T>> = true;

}  // namespace detail

///@}

}  // namespace abut
