// SPDX-License-Identifier: MIT
#pragma once

// posed(object, pose): a set, or an index over one, where a pose puts it. Nothing is copied or rebuilt: shapes are placed as
// they are read, and trees stay in the frames of their objects (relative_pose.hpp).

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/execution/policy.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// @addtogroup sets
///@{

/// A set or an index, and its pose. Shares the object's storage, as a copy of it does.
template <class Object>
struct posed_object {
    static_assert(!std::is_const_v<Object>,
                  "abut: posed_object of the type of a const index: leave out const where the index is made, or write "
                  "posed_object<std::remove_const_t<decltype(index)>>");
    using scalar_type = typename Object::scalar_type;    ///< float or double
    using memory_space = typename Object::memory_space;  ///< where the memory lies

    Object object;            ///< in its own frame
    rigid<scalar_type> pose;  ///< from that frame to the world's

    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return object.size(); }
};

/// One shape and its pose.
template <shape Shape>
struct posed_object<Shape> {
    /// float or double
    using scalar_type = scalar_type_of<Shape>;

    Shape object;             ///< in its own frame
    rigid<scalar_type> pose;  ///< from that frame to the world's

    /// Number of shapes: 1.
    [[nodiscard]] std::size_t size() const { return 1; }
};

namespace detail {

template <class Object>
struct shape_of_object {
    using type = typename Object::shape_type;
};
template <shape Shape>
struct shape_of_object<Shape> {
    using type = Shape;
};

}  // namespace detail

/// Whether a type is a posed object.
///@{
template <class X>
inline constexpr bool is_posed = false;
template <class Object>
inline constexpr bool is_posed<posed_object<Object>> = true;
///@}

/// `object`, moved by `pose`, as an argument of queries: a set, a view of one, a bvh, a grid, or one shape. Nothing is
/// copied but what a copy of the object copies.
///
/// What touches is decided exactly, about shapes whose points `place` has rounded to the world's coordinates. The pose's
/// numbers as they are define where these lie. A rotation that is not quite orthonormal stretches or shears a mesh as much
/// as it is off. Radii stay. A box becomes the hull of its eight corners, each of which is placed (`placed_box`). Of a posed
/// object make one with the composed pose: `compose`.
///
/// Nothing is thrown here. Queries throw invalid_geometry where the product of two rows is off from 0, or that of a row with
/// itself from 1, by more than `rotation_tolerance` (2^-10). They also do so where the rotation reflects, and where a placed
/// coordinate overflows. `orthonormalised` makes a rotation of a matrix that is refused.
template <class Object>
    requires(!is_posed<Object>)
[[nodiscard]] posed_object<Object> posed(Object object, const rigid<scalar_type_of<Object>>& pose) {
    static_assert(placeable<typename detail::shape_of_object<Object>::type>,
                  "abut: such shapes cannot be posed, for want of place(pose, shape): write it beside the shape (docs/extending.md)");
    return {std::move(object), pose};
}

/// The placed shapes of a view.
template <shape_view V>
struct posed_view {
    using scalar_type = typename V::scalar_type;              ///< float or double
    using shape_type = placed_shape<typename V::shape_type>;  ///< what a shape is where it is placed
    using memory_space = typename V::memory_space;            ///< where the memory lies

    V shapes;                 ///< in the frame of their object
    rigid<scalar_type> pose;  ///< from that frame to the world's

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return shapes.size(); }
    /// Shape i in the world, by value.
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return place(pose, shapes[i]); }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const { detail::prefetch_shape(shapes, i, step); }
};

namespace detail {

/// Whether placed coordinates overflow. Looks at every shape.
template <class Policy, shape_view V>
void check(const Policy& on, const posed_view<V>& placed, const char* function) {
    check_shapes(on, placed, function, "posed shape");
}

}  // namespace detail

///@}

}  // namespace abut
