// SPDX-License-Identifier: MIT
#pragma once

// posed(object, pose): a set, or an index over one, where a pose puts it. Nothing is copied or rebuilt: shapes are placed as
// they are read, and trees stay in the frames of their objects (relative_pose.hpp).

#include <cstddef>
#include <string>
#include <utility>

#include <abut/execution/policy.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// A set or an index, and its pose. Shares the object's storage, as a copy of it does.
template <class Object>
struct posed_object {
    using scalar_type = typename Object::scalar_type;
    using memory_space = typename Object::memory_space;

    Object object;
    rigid<scalar_type> pose;

    [[nodiscard]] std::size_t size() const { return object.size(); }
};

template <class X>
inline constexpr bool is_posed = false;
template <class Object>
inline constexpr bool is_posed<posed_object<Object>> = true;

/// `object` (mesh, triangle_soup, spheres, equal_spheres, a view of one, a bvh or a grid) moved by `pose`, as an argument of
/// queries. What touches is decided exactly, about shapes whose points `place` has rounded to the world's coordinates.
/// Queries throw invalid_geometry where the rotation is not one within 16 units in the last place, and where a placed
/// coordinate overflows. Of a posed object make one with the composed pose: `compose`.
template <class Object>
    requires(!is_posed<Object>)
[[nodiscard]] posed_object<Object> posed(Object object, const rigid<typename Object::scalar_type>& pose) {
    return {std::move(object), pose};
}

/// The placed shapes of a view.
template <shape_view V>
struct posed_view {
    using scalar_type = typename V::scalar_type;
    using shape_type = typename V::shape_type;
    using memory_space = typename V::memory_space;

    V shapes;
    rigid<scalar_type> pose;

    [[nodiscard]] ABUT_HD std::size_t size() const { return shapes.size(); }
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return place(pose, shapes[i]); }
    ABUT_INLINE void prefetch(std::size_t i, int step) const { detail::prefetch_shape(shapes, i, step); }
};

namespace detail {

template <shape_view V>
struct bad_shape {
    V shapes;
    ABUT_HD std::size_t operator()(std::size_t i) const { return is_good(shapes[i]) ? static_cast<std::size_t>(-1) : i; }
};

template <shape_view V>
struct fetch_shape {
    V shapes;
    std::size_t which;
    typename V::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = shapes[which]; }
};

/// Whether placed coordinates overflow. Looks at every shape.
template <class Policy, shape_view V>
void check(const Policy& on, const posed_view<V>& placed, const char* function) {
    const std::size_t none = static_cast<std::size_t>(-1);
    const std::size_t bad = reduce(on, placed.size(), none, minimum{}, bad_shape<posed_view<V>>{placed});
    if (bad == none) return;
    execution::buffer_of<Policy, typename V::shape_type> copy(on, 1);
    for_each_index(on, 1, fetch_shape<posed_view<V>>{placed, bad, copy.data()});
    typename V::shape_type shape;
    download(on, copy.data(), 1, &shape);
    refuse(function, "posed shape", bad, shape);
}

}  // namespace detail

}  // namespace abut
