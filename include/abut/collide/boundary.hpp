// SPDX-License-Identifier: MIT
#pragma once

// boundary: the surface of a convex solid with flat faces, as a closed mesh, for queries that take meshes. Not of round
// shapes, whose surface no mesh is.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/hull_edges.hpp>
#include <abut/error.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

template <class S>
inline constexpr bool is_polytope = seen_as_hull<S>;
template <scalar T>
inline constexpr bool is_polytope<aabb<T>> = true;
template <scalar T>
inline constexpr bool is_polytope<hull<T>> = true;
template <class Shape>
inline constexpr bool is_polytope<posed_object<Shape>> = is_polytope<Shape>;

/// The points that a polytope is the hull of.
template <class S>
auto corners_of_polytope(const S& shape) {
    std::vector<vec3<scalar_type_of<S>>> corners;
    if constexpr (requires { shape.points; }) {
        for (std::size_t i = 0; i < shape.count; ++i) corners.push_back(shape[i]);
    } else {
        for (const auto& p : points_of(shape).at) corners.push_back(p);
    }
    return corners;
}

template <class S>
auto boundary_of(const S& shape, const char* function) {
    if constexpr (is_posed<S>) {
        check(shape.pose, function);
        return boundary_of(place(shape.pose, shape.object), function);
    } else {
        check(serial{}, single_view<S>{shape}, function);
        using T = scalar_type_of<S>;
        const std::vector<vec3<T>> points = corners_of_polytope(shape);
        hull_surface<T> surface(points);
        if (!surface.wrap()) {
            throw invalid_geometry(function, "shape", 0, "a solid has a volume, and this shape has none; the number of its points is",
                                   static_cast<double>(points.size()));
        }
        auto faces = surface.triangles();
        std::vector<std::uint32_t> number(points.size(), 0);
        for (const auto& f : faces) {
            for (const std::uint32_t corner : f) number[corner] = 1;
        }
        std::vector<vec3<T>> vertices;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (number[i] == 0) continue;
            number[i] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(points[i]);
        }
        for (auto& f : faces) {
            for (std::uint32_t& corner : f) corner = number[corner];
        }
        return mesh<T>(vertices, faces);
    }
}

/// An argument of a query of solids: a polytope by its boundary in the policy's memory, anything else as it is.
template <class Policy, class X>
decltype(auto) as_solid(const Policy& on, const X& x, const char* function) {
    if constexpr (is_polytope<X>) {
        return copy_to(on, boundary_of(x, function));
    } else {
        return (x);
    }
}

}  // namespace detail

/// @addtogroup solids
///@{

/// The surface of a box, an oriented box or a hull, posed or not, as a closed mesh in host memory, whose triangles are turned
/// outwards. Exact: its vertices are corners of the shape, in their order, and its solid is the shape. Points of a hull that
/// lie inside of it, of an edge, or twice in a place are left out; of those within a face some may be there. Under a pose the
/// corners are placed first. Takes O(n log n) time for most hulls of n points and O(n^2) at worst, and some 200 bytes a point.
/// Throws invalid_geometry where the shape is none, or has no volume.
///
///     const auto crate = abut::boundary(abut::aabb<float>{{0, 0, 0}, {1, 1, 1}});
template <class Shape>
    requires detail::is_polytope<Shape>
[[nodiscard]] auto boundary(const Shape& shape) {
    return detail::boundary_of(shape, "abut::boundary");
}

///@}

}  // namespace abut
