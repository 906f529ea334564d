// SPDX-License-Identifier: MIT
#pragma once

// moving(x, way): a set, or an index over one, all of whose shapes go along one vector. Nothing is copied or rebuilt: shapes
// are put on their way as they are read, and the boxes of an index grow by the way where they are looked at.

#include <concepts>
#include <cstddef>
#include <utility>

#include <abut/shape/aabb.hpp>
#include <abut/shape/box_lanes.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>
#include <abut/shape/swept.hpp>
#include <abut/shape/view.hpp>
#include <abut/shape/volume.hpp>

namespace abut {

/// @addtogroup sets
///@{

/// A set or an index, and the way of all of its shapes. Shares the object's storage, as a copy of it does.
template <class Object>
struct moved_object {
    using scalar_type = typename Object::scalar_type;    ///< float or double
    using memory_space = typename Object::memory_space;  ///< where the memory lies

    Object object;          ///< where its shapes are at t = 0
    vec3<scalar_type> way;  ///< where they go by t = 1

    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return object.size(); }
};

/// Whether a type is a set or an index that goes along a vector.
///@{
template <class X>
inline constexpr bool is_moved = false;
template <class Object>
inline constexpr bool is_moved<moved_object<Object>> = true;
///@}

/// `object`, all shapes of which go along `way` from t = 0 to 1, as an argument of `any`, `count`, `pairs`, `for_each_pair` and
/// `first_impact`, and as shapes of `sweep`. It is a set, a view of one, a bvh or a grid, posed or not, of points, segments,
/// triangles, spheres, capsules, cylinders, cones, boxes, oriented boxes, hulls, planes or half spaces. Nothing is copied but what a copy of the object copies.
///
/// Nothing is thrown here. Queries throw invalid_geometry where the way is not finite.
///
///     const auto lowered = abut::moving(index, abut::vec3<float>{0, 0, -2});
template <class Object>
    requires(!shape<Object> && !is_moved<Object> && requires { typename Object::memory_space; })
[[nodiscard]] moved_object<Object> moving(Object object, const vec3<typename Object::scalar_type>& way) {
    return {std::move(object), way};
}

/// The shapes of a view on their way.
template <shape_view V>
struct moved_view {
    using scalar_type = typename V::scalar_type;        ///< float or double
    using shape_type = swept<typename V::shape_type>;   ///< a shape on its way
    using memory_space = typename V::memory_space;      ///< where the memory lies

    V shapes;               ///< where they are at t = 0
    vec3<scalar_type> way;  ///< where they go by t = 1

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return shapes.size(); }
    /// Shape i on its way, by value.
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return {shapes[i], way}; }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const { detail::prefetch_shape(shapes, i, step); }
};

///@}

namespace detail {

/// What boxes become where all in them goes along a way: theirs, and so much more on each side. Sums are rounded to the
/// nearest number. What is no farther than a number is so after rounding, too, so that comparisons of two boxes keep all that
/// they have to.
template <scalar T>
struct box_growth {
    vec3<T> down, up;  ///< 0 or less, and 0 or more

    /// Of boxes in the world.
    ABUT_HD static box_growth by(const vec3<T>& way) {
        const vec3<T> none{0, 0, 0};
        return {least(way, none), greatest(way, none)};
    }
    /// Of boxes in the frame of an object that is posed, whose rows are orthonormal within 2^-10. The way there is that of the
    /// inverse. The transposed one is off from it by less than 2^-8 of its length, of which twice as much is added.
    ABUT_HD static box_growth in_frame(const rigid<T>& pose, const vec3<T>& way) {
        const vec3<T> seen{dot(column(pose.rotation, 0), way), dot(column(pose.rotation, 1), way),
                           dot(column(pose.rotation, 2), way)};
        const T off = T(0x1p-7) * (absolute(way.x) + absolute(way.y) + absolute(way.z)) + 8 * smallest_normal<T>;
        const vec3<T> slack{off, off, off}, none{0, 0, 0};
        return {least(seen - slack, none), greatest(seen + slack, none)};
    }

    [[nodiscard]] ABUT_INLINE ABUT_HD aabb<T> operator()(const aabb<T>& box) const { return {box.lower + down, box.upper + up}; }
    template <class Register>
    [[nodiscard]] ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T, Register>& boxes) const {
        const box_lanes<T, Register> by = box_lanes<T, Register>::all({down, up});
        return box_lanes<T, Register>{boxes.lower + by.lower, boxes.upper + by.upper};
    }
    template <class Volume>
    [[nodiscard]] ABUT_INLINE ABUT_HD aabb<T> operator()(const Volume& volume) const {
        return (*this)(bounds(volume));
    }
};

/// Boxes of two trees of which one goes along a way, as Frames compares them: volumes by their boxes.
template <bool FirstGoes, class Frames, scalar T>
struct boxes_on_way {
    Frames frames;
    box_growth<T> grown;

    template <class Volume>
    ABUT_INLINE ABUT_HD auto operator()(const Volume& a, const Volume& b) const {
        if constexpr (FirstGoes) {
            return frames(grown(a), as_box(b));
        } else {
            return frames(as_box(a), grown(b));
        }
    }

private:
    template <class Register>
    ABUT_INLINE ABUT_HD static const box_lanes<T, Register>& as_box(const box_lanes<T, Register>& boxes) {
        return boxes;
    }
    template <class Volume>
    ABUT_INLINE ABUT_HD static aabb<T> as_box(const Volume& volume) {
        return bounds(volume);
    }
};

}  // namespace detail

}  // namespace abut
