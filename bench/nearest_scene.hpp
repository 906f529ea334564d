// SPDX-License-Identifier: MIT
#pragma once

// What bench/nearest.cpp and bench/nearest.cu ask of meshes: points far from the torus of the embedded scene, close to it and
// in its tube; and points in the box of a mesh and close to it, where a file is named.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"
#include "mesh_file.hpp"

namespace nearest_scene {

using surface = scene::surface<float>;
using point_list = std::vector<abut::vec3<float>>;

struct question {
    std::string name;  ///< what rows begin with
    std::vector<std::size_t> counts;
    const surface* mesh;
    point_list (*points)(const surface&, std::size_t);
};

/// Close: no farther than this share of the longest side of the mesh's box.
inline constexpr double close = 1e-3;

inline abut::aabb<double> box_of(const surface& mesh) {
    auto box = abut::empty_box<float>();
    for (const auto& p : mesh.vertices) box = abut::merge(box, abut::bounds(p));
    return {{box.lower.x, box.lower.y, box.lower.z}, {box.upper.x, box.upper.y, box.upper.z}};
}

inline point_list far_points(const surface&, std::size_t n) { return scene::centers<float>(n); }
inline point_list points_in_box(const surface& mesh, std::size_t n) { return scene::points_in<float>(box_of(mesh), n); }

/// Of each triangle as many, at random, off its plane by at most `close` of the size.
inline point_list close_points(const surface& mesh, std::size_t n) {
    const auto box = box_of(mesh);
    const double size = std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
    point_list points(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto uniform = [&](std::uint64_t k) { return scene::uniform(scene::seed + 1, 4 * i + k); };
        const auto which = static_cast<std::size_t>(uniform(0) * static_cast<double>(mesh.faces.size()));
        double s = uniform(1), t = uniform(2);
        if (s + t > 1) s = 1 - s, t = 1 - t;
        const auto corner = [&](std::uint32_t id) {
            const auto& p = mesh.vertices[id];
            return abut::vec3<double>{p.x, p.y, p.z};
        };
        const auto& face = mesh.faces[which];
        const auto a = corner(face[0]), ab = corner(face[1]) - a, ac = corner(face[2]) - a, normal = cross(ab, ac);
        const double length = std::sqrt(dot(normal, normal)), off = close * size * (2 * uniform(3) - 1);
        const auto at = a + s * ab + t * ac + (length > 0 ? off / length : 0) * normal;
        points[i] = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
    }
    return points;
}

/// In the tube of the torus of the embedded scene.
inline point_list points_in_tube(const surface&, std::size_t n) {
    point_list points(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto uniform = [&](std::uint64_t k) { return scene::uniform(scene::seed + 2, 3 * i + k); };
        const double turn = 2 * std::acos(-1.0);
        const double along = turn * uniform(0), across = turn * uniform(1);
        const double r = scene::torus_minor_radius * std::sqrt(uniform(2)), out = scene::torus_major_radius + r * std::cos(across);
        points[i] = {static_cast<float>(out * std::cos(along)), static_cast<float>(out * std::sin(along)),
                     static_cast<float>(r * std::sin(across))};
    }
    return points;
}

/// `path`: of a mesh, or empty for none. Meshes live as long as the program.
inline std::vector<question> questions(const std::string& path) {
    static const surface torus = scene::torus<float>();
    const std::vector<std::size_t> few{100'000};
    std::vector<question> all{{"nearest", {100'000, scene::sphere_count}, &torus, far_points},
                              {"nearest_close", few, &torus, close_points},
                              {"nearest_tube", few, &torus, points_in_tube}};
    if (path.empty()) return all;
    static const surface mesh = bench::read_surface<surface>(path);
    all.push_back({"nearest_mesh_box", few, &mesh, points_in_box});
    all.push_back({"nearest_mesh_close", few, &mesh, close_points});
    return all;
}

}  // namespace nearest_scene
