// SPDX-License-Identifier: MIT
#pragma once

// Rays at a mesh, the same for each program and peer: `coherent` ones from a camera beside it, a row of pixels after the
// other, and `scattered` ones from points on a ball around it to points inside that ball. And points in the box around it.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"

namespace raycast_scene {

inline constexpr std::array<const char*, 2> kinds{"coherent", "scattered"};

/// The box around a surface by its middle and half of its longest side.
struct place {
    abut::vec3<float> middle;
    float half;
};
inline place around(const scene::surface<float>& mesh) {
    auto box = abut::empty_box<float>();
    for (const auto& p : mesh.vertices) box = merge(box, abut::bounds(p));
    const abut::vec3<float> size = box.upper - box.lower;
    return {0.5f * box.lower + 0.5f * box.upper, 0.5f * std::fmax(size.x, std::fmax(size.y, size.z))};
}

/// side * side rays of a kind.
inline std::vector<abut::ray<float>> rays_at(const scene::surface<float>& mesh, std::size_t kind, std::size_t side) {
    const place at = around(mesh);
    std::vector<abut::ray<float>> rays;
    rays.reserve(side * side);
    for (std::size_t i = 0; i < side * side; ++i) {
        if (kind == 0) {
            const auto pixel = [&](std::size_t k) { return (static_cast<float>(k) + 0.5f) / static_cast<float>(side) - 0.5f; };
            rays.push_back({at.middle + at.half * abut::vec3<float>{0.3f, 0.2f, 3}, {pixel(i % side), pixel(i / side), -1.2f}});
        } else {
            const auto u = [&](std::size_t k) { return static_cast<float>(2 * scene::uniform(17, 8 * i + k) - 1); };
            const abut::vec3<float> out{u(0), u(1), u(2)}, in{0.7f * u(3), 0.7f * u(4), 0.7f * u(5)};
            const float length = std::sqrt(dot(out, out)) + 1e-6f;
            const abut::vec3<float> origin = (2 / length) * out;
            rays.push_back({at.middle + at.half * origin, in - origin});
        }
    }
    return rays;
}

inline constexpr std::size_t default_side = 1024;

/// Points in the box around a mesh.
inline std::vector<abut::vec3<float>> points_in(const scene::surface<float>& mesh) {
    auto box = abut::empty_box<float>();
    for (const auto& p : mesh.vertices) box = merge(box, abut::bounds(p));
    std::vector<abut::vec3<float>> points;
    for (std::size_t i = 0; i < 100000; ++i) {
        const auto between = [&](float lower, float upper, std::size_t k) {
            return lower + (upper - lower) * static_cast<float>(scene::uniform(18, 4 * i + k));
        };
        points.push_back({between(box.lower.x, box.upper.x, 0), between(box.lower.y, box.upper.y, 1),
                          between(box.lower.z, box.upper.z, 2)});
    }
    return points;
}

}  // namespace raycast_scene
