// SPDX-License-Identifier: MIT
#pragma once

// Views of coordinates that lie in separate arrays: all x, all y, all z. Shapes are put together as they are read, and
// nothing is copied. For arrays whose coordinates lie side by side there is view.hpp.

#include <cstddef>
#include <cstdint>

#include <abut/shape/view.hpp>

namespace abut {

/// @addtogroup sets
///@{

/// Points of three arrays of coordinates.
template <scalar T, memory_space Space = host_space>
struct xyz_points_view {
    using scalar_type = T;       ///< float or double
    using shape_type = vec3<T>;  ///< what a shape is
    using memory_space = Space;  ///< where the memory lies

    const T* x = nullptr;   ///< the first of `count` numbers in a row
    const T* y = nullptr;   ///< likewise
    const T* z = nullptr;   ///< likewise
    std::size_t count = 0;  ///< number of points

    /// Of no point.
    xyz_points_view() = default;
    /// Over the caller's arrays of `n` numbers each, which have to outlive every use of the view.
    ABUT_HD xyz_points_view(const T* first_x, const T* first_y, const T* first_z, std::size_t n)
        : x(first_x), y(first_y), z(first_z), count(n) {}

    /// Number of points.
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    /// Point i, by value.
    [[nodiscard]] ABUT_HD vec3<T> operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step = 0) const {
        if (step != 0) return;
        ABUT_PREFETCH(x + i);
        ABUT_PREFETCH(y + i);
        ABUT_PREFETCH(z + i);
    }
};

/// Spheres of three arrays of centre coordinates, with an array of radii or one radius for all.
template <scalar T, memory_space Space = host_space>
struct xyz_spheres_view {
    using scalar_type = T;         ///< float or double
    using shape_type = sphere<T>;  ///< what a shape is
    using memory_space = Space;    ///< where the memory lies

    xyz_points_view<T, Space> centers;  ///< one for each sphere
    const T* radii = nullptr;           ///< one for each sphere, or null
    T radius = 0;                       ///< of all, where there are no `radii`

    /// Of no sphere.
    xyz_spheres_view() = default;
    /// Over the caller's arrays of `n` numbers each, which have to outlive every use of the view.
    ABUT_HD xyz_spheres_view(const T* first_x, const T* first_y, const T* first_z, const T* first_radius, std::size_t n)
        : centers(first_x, first_y, first_z, n), radii(first_radius) {}
    /// The same with one radius for all.
    ABUT_HD xyz_spheres_view(const T* first_x, const T* first_y, const T* first_z, std::size_t n, T radius_of_all)
        : centers(first_x, first_y, first_z, n), radius(radius_of_all) {}

    /// Number of spheres.
    [[nodiscard]] ABUT_HD std::size_t size() const { return centers.count; }
    /// Sphere i, by value.
    [[nodiscard]] ABUT_HD sphere<T> operator[](std::size_t i) const {
        return {centers[i], radii != nullptr ? radii[i] : radius};
    }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        centers.prefetch(i, step);
        if (step == 0 && radii != nullptr) ABUT_PREFETCH(radii + i);
    }
};

/// Triangles as faces over vertices of three arrays of coordinates.
template <scalar T, memory_space Space = host_space>
struct xyz_mesh_view {
    using scalar_type = T;           ///< float or double
    using shape_type = triangle<T>;  ///< what a shape is
    using memory_space = Space;      ///< where the memory lies

    xyz_points_view<T, Space> vertices;  ///< by which faces name their corners
    detail::strided<face> faces;         ///< first one, number and stride

    /// Of no face.
    xyz_mesh_view() = default;
    /// Over the caller's arrays, which have to outlive every use of the view. Faces are those of mesh_view: three integers
    /// of 32 bits each (shape/rows.hpp), or one by one; their stride is in bytes.
    template <class F>
    ABUT_HD xyz_mesh_view(const xyz_points_view<T, Space>& corners, const F* first_face, std::size_t face_count,
                          std::size_t face_stride = detail::row_stride<face, F>)
        : vertices(corners), faces(first_face, face_count, face_stride) {
        (void)detail::is_index_row<3, F>();
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

///@}

}  // namespace abut
