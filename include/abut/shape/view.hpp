// SPDX-License-Identifier: MIT
#pragma once

// Views: how algorithms read sets of shapes. A view is a few pointers and sizes, trivially copyable into a kernel; it owns
// nothing and checks nothing. Views over the caller's own arrays, strides included, are made here too; queries and indices
// check those when they get them.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/execution/policy.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rows.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

/// @addtogroup sets
///@{

/// Three vertex indices.
using face = std::array<std::uint32_t, 3>;

/// Two vertex indices.
using edge = std::array<std::uint32_t, 2>;

/// A view: `size()` shapes, `view[i]` returns shape i by value; both may run wherever its memory can be read. It may have
/// `prefetch(i, step)`, a hint on the host that shape i will be read soon: step 0 first, and some time later step 1, which
/// may read what step 0 asks for.
///
/// Of an array of another library's type, queries see all that was written before they are called. `view[i]` by itself sees
/// what was written before the view was made; compilers take types for a proof that memory differs, and may miss the rest.
template <class V>
concept shape_view = std::is_trivially_copyable_v<V> && memory_space<typename V::memory_space> &&
    shape<typename V::shape_type> && std::same_as<typename V::scalar_type, scalar_type_of<typename V::shape_type>> &&
    requires(const V& v) {
    { v.size() } -> std::convertible_to<std::size_t>;
    { v[std::size_t{}] } -> std::same_as<typename V::shape_type>;
};

namespace detail {

/// `count` elements of type T, `stride` bytes apart.
template <class T>
struct strided {
    const std::byte* data = nullptr;
    std::size_t count = 0;
    std::size_t stride = sizeof(T);

    strided() = default;
    template <class P>
    ABUT_HD strided(const P* first, std::size_t n, std::size_t step)
        : data(reinterpret_cast<const std::byte*>(first)), count(n), stride(step) {
        if constexpr (!std::same_as<P, T>) see_writes_to(first);
    }
    // By way of const void*: a reinterpret_cast would be warned of under -Wcast-align=strict.
    [[nodiscard]] ABUT_HD const T* first() const { return static_cast<const T*>(static_cast<const void*>(data)); }
    ABUT_HD const T& operator[](std::size_t i) const {
        return *static_cast<const T*>(static_cast<const void*>(data + i * stride));
    }
    /// From the first to the last byte, which may lie on two cache lines.
    ABUT_INLINE void prefetch(std::size_t i) const {
        ABUT_PREFETCH(data + i * stride);
        ABUT_PREFETCH(data + i * stride + sizeof(T) - 1);
    }
};

/// The vertices of face or edge i. Not by std::array's operator[]: that is a host function, and this also runs on devices.
template <std::size_t N>
ABUT_HD const std::uint32_t* corners_at(const strided<std::array<std::uint32_t, N>>& elements, std::size_t i) {
    return static_cast<const std::uint32_t*>(static_cast<const void*>(elements.data + i * elements.stride));
}

/// The vertices of a face. Not abut::face, whose operator[] is a host function.
struct corner_ids {
    std::uint32_t of[3];
};
/// The vertices of triangle i of a view; of one that has no faces the number of each corner.
template <class View>
ABUT_HD corner_ids vertices_of_shape(const View& v, std::uint32_t i) {
    if constexpr (requires { corners_at(v.faces, i); }) {
        const std::uint32_t* const corner = corners_at(v.faces, i);
        return {{corner[0], corner[1], corner[2]}};
    } else if constexpr (requires { v.triangles; }) {
        return vertices_of_shape(v.triangles, i);
    } else if constexpr (requires { v.shapes[i]; }) {
        return vertices_of_shape(v.shapes, i);
    } else {
        return {{3 * i, 3 * i + 1, 3 * i + 2}};
    }
}

}  // namespace detail

/// Shapes as they are, each with all its numbers: triangles that share nothing, spheres each with its own radius, any shape.
template <shape Shape, memory_space Space = host_space>
struct shapes_view {
    using scalar_type = scalar_type_of<Shape>;  ///< float or double
    using shape_type = Shape;                   ///< what a shape is
    using memory_space = Space;                 ///< where the memory lies

    detail::strided<Shape> shapes;  ///< first one, number and stride

    /// Of no shape.
    shapes_view() = default;
    /// Over the caller's array, which has to outlive every use of the view; the stride is in bytes and keeps the shapes
    /// aligned.
    ABUT_HD shapes_view(const Shape* first, std::size_t count, std::size_t stride = sizeof(Shape))
        : shapes(first, count, stride) {}
    /// Over an array of another type that holds the same numbers in the same order (shape/rows.hpp), as std::array<T, 3> for
    /// points, or T itself; `count` is that of the shapes.
    template <class P>
    ABUT_HD shapes_view(const P* first, std::size_t count, std::size_t stride = detail::row_stride<Shape, P>)
        : shapes(first, count, stride) {
        (void)detail::is_row<Shape, P>();
    }

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return shapes.count; }
    /// Shape i, by value.
    [[nodiscard]] ABUT_HD Shape operator[](std::size_t i) const { return shapes[i]; }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        if (step == 0) shapes.prefetch(i);
    }
};

/// Views of triangles, balls, points, segments, capsules, cylinders, cones, boxes, oriented boxes or rays, each with all its
/// numbers.
///@{
template <scalar T, memory_space Space = host_space>
using triangle_soup_view = shapes_view<triangle<T>, Space>;
template <scalar T, memory_space Space = host_space>
using spheres_view = shapes_view<sphere<T>, Space>;
template <scalar T, memory_space Space = host_space>
using points_view = shapes_view<vec3<T>, Space>;
template <scalar T, memory_space Space = host_space>
using segments_view = shapes_view<segment<T>, Space>;
template <scalar T, memory_space Space = host_space>
using capsules_view = shapes_view<capsule<T>, Space>;
template <scalar T, memory_space Space = host_space>
using cylinders_view = shapes_view<cylinder<T>, Space>;
template <scalar T, memory_space Space = host_space>
using cones_view = shapes_view<cone<T>, Space>;
template <scalar T, memory_space Space = host_space>
using boxes_view = shapes_view<aabb<T>, Space>;
template <scalar T, memory_space Space = host_space>
using oriented_boxes_view = shapes_view<oriented_box<T>, Space>;
template <scalar T, memory_space Space = host_space>
using rays_view = shapes_view<ray<T>, Space>;
///@}

/// Triangles as faces over shared vertices.
template <scalar T, memory_space Space = host_space>
struct mesh_view {
    using scalar_type = T;           ///< float or double
    using shape_type = triangle<T>;  ///< what a shape is
    using memory_space = Space;      ///< where the memory lies

    detail::strided<vec3<T>> vertices;  ///< first one, number and stride
    detail::strided<face> faces;        ///< likewise

    /// Of no face.
    mesh_view() = default;
    /// Over the caller's arrays, which have to outlive every use of the view; strides are in bytes.
    ABUT_HD mesh_view(const vec3<T>* first_vertex, std::size_t vertex_count, const face* first_face, std::size_t face_count,
                      std::size_t vertex_stride = sizeof(vec3<T>), std::size_t face_stride = sizeof(face))
        : vertices(first_vertex, vertex_count, vertex_stride), faces(first_face, face_count, face_stride) {}
    /// Over arrays of other types that hold three T and three integers of 32 bits (shape/rows.hpp), or one by one; the
    /// counts are those of vertices and faces. A negative index is refused as one that is out of range.
    template <class P, class F>
    ABUT_HD mesh_view(const P* first_vertex, std::size_t vertex_count, const F* first_face, std::size_t face_count,
                      std::size_t vertex_stride = detail::row_stride<vec3<T>, P>,
                      std::size_t face_stride = detail::row_stride<face, F>)
        : vertices(first_vertex, vertex_count, vertex_stride), faces(first_face, face_count, face_stride) {
        (void)(detail::is_row<vec3<T>, P>() && detail::is_index_row<3, F>());
    }

    /// Number of faces.
    [[nodiscard]] ABUT_HD std::size_t size() const { return faces.count; }
    /// Face i as a triangle, by value.
    [[nodiscard]] ABUT_HD triangle<T> operator[](std::size_t i) const {
        const std::uint32_t* const corner = detail::corners_at(faces, i);
        return {vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]};
    }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        if (step == 0) return faces.prefetch(i);
        for (const std::uint32_t k : faces[i]) vertices.prefetch(k);
    }
};

/// Segments as edges over shared vertices.
template <scalar T, memory_space Space = host_space>
struct edge_mesh_view {
    using scalar_type = T;          ///< float or double
    using shape_type = segment<T>;  ///< what a shape is
    using memory_space = Space;     ///< where the memory lies

    detail::strided<vec3<T>> vertices;  ///< first one, number and stride
    detail::strided<edge> edges;        ///< likewise

    /// Of no edge.
    edge_mesh_view() = default;
    /// Over the caller's arrays, which have to outlive every use of the view; strides are in bytes.
    ABUT_HD edge_mesh_view(const vec3<T>* first_vertex, std::size_t vertex_count, const edge* first_edge,
                           std::size_t edge_count, std::size_t vertex_stride = sizeof(vec3<T>),
                           std::size_t edge_stride = sizeof(edge))
        : vertices(first_vertex, vertex_count, vertex_stride), edges(first_edge, edge_count, edge_stride) {}
    /// Over arrays of other types, as of mesh_view.
    template <class P, class E>
    ABUT_HD edge_mesh_view(const P* first_vertex, std::size_t vertex_count, const E* first_edge, std::size_t edge_count,
                           std::size_t vertex_stride = detail::row_stride<vec3<T>, P>,
                           std::size_t edge_stride = detail::row_stride<edge, E>)
        : vertices(first_vertex, vertex_count, vertex_stride), edges(first_edge, edge_count, edge_stride) {
        (void)(detail::is_row<vec3<T>, P>() && detail::is_index_row<2, E>());
    }

    /// Number of edges.
    [[nodiscard]] ABUT_HD std::size_t size() const { return edges.count; }
    /// Edge i as a segment, by value.
    [[nodiscard]] ABUT_HD segment<T> operator[](std::size_t i) const {
        const std::uint32_t* const end = detail::corners_at(edges, i);
        return {vertices[end[0]], vertices[end[1]]};
    }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        if (step == 0) return edges.prefetch(i);
        for (const std::uint32_t k : edges[i]) vertices.prefetch(k);
    }
};

/// Spheres of one radius, which is stored once.
template <scalar T, memory_space Space = host_space>
struct equal_spheres_view {
    using scalar_type = T;         ///< float or double
    using shape_type = sphere<T>;  ///< what a shape is
    using memory_space = Space;    ///< where the memory lies

    detail::strided<vec3<T>> centers;  ///< first one, number and stride
    T radius = 0;                      ///< of all, 0 or more

    /// Of no sphere.
    equal_spheres_view() = default;
    /// Over the caller's array, which has to outlive every use of the view; the stride is in bytes.
    ABUT_HD equal_spheres_view(const vec3<T>* first_center, std::size_t count, T radius_of_all,
                               std::size_t stride = sizeof(vec3<T>))
        : centers(first_center, count, stride), radius(radius_of_all) {}
    /// Over an array of another type, as of shapes_view.
    template <class P>
    ABUT_HD equal_spheres_view(const P* first_center, std::size_t count, T radius_of_all,
                               std::size_t stride = detail::row_stride<vec3<T>, P>)
        : centers(first_center, count, stride), radius(radius_of_all) {
        (void)detail::is_row<vec3<T>, P>();
    }

    /// Number of spheres.
    [[nodiscard]] ABUT_HD std::size_t size() const { return centers.count; }
    /// Sphere i, by value.
    [[nodiscard]] ABUT_HD sphere<T> operator[](std::size_t i) const { return {centers[i], radius}; }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        if (step == 0) centers.prefetch(i);
    }
};

/// One shape, which the view carries: a set of one in any memory.
template <shape Shape, memory_space Space = host_space>
struct single_view {
    using scalar_type = scalar_type_of<Shape>;  ///< float or double
    using shape_type = Shape;                   ///< what a shape is
    using memory_space = Space;                 ///< where the memory lies

    Shape shape;  ///< the one

    /// Number of shapes: 1.
    [[nodiscard]] ABUT_HD std::size_t size() const { return 1; }
    /// The shape, by value.
    [[nodiscard]] ABUT_HD Shape operator[](std::size_t) const { return shape; }
};

namespace detail {

/// The hint to a view, or to what reads views by other indices, that has it. Inlined by force, like all hints: g++ takes a
/// call of a function that only prefetches for one without effect, and drops it.
template <class V, class Index>
ABUT_INLINE void prefetch_shape(const V& shapes, const Index& i, int step) {
    if constexpr (requires { shapes.prefetch(i, step); }) shapes.prefetch(i, step);
}

/// Where a set's shapes lie in memory one after another, as they are; null where they do not.
template <shape_view V>
const typename V::shape_type* shapes_in_memory(const V&) {
    return nullptr;
}
template <shape Shape, memory_space Space>
const Shape* shapes_in_memory(const shapes_view<Shape, Space>& v) {
    return v.shapes.stride == sizeof(Shape) ? v.shapes.first() : nullptr;
}

}  // namespace detail

///@}

}  // namespace abut
