// SPDX-License-Identifier: MIT
#pragma once

// What bench/sweep.cpp and bench/sweep.cu share: balls and capsules that go along the rays of raycast_scene.hpp, three times as long as
// the mesh is far. Their radius is 2^-10 of the mesh's longest side.

#include <cmath>
#include <cstddef>
#include <vector>

#include "raycast_scene.hpp"

namespace sweep_scene {

struct rows {
    std::vector<abut::segment<float>> lines;  ///< the ways themselves
    std::vector<abut::sphere<float>> balls;
    std::vector<abut::capsule<float>> capsules;  ///< twice as long as thick
    std::vector<abut::vec3<float>> ways;

    /// side * side of them, along rays of one of raycast_scene::kinds.
    rows(const scene::surface<float>& mesh, std::size_t kind, std::size_t side) {
        const float half = raycast_scene::around(mesh).half, radius = half * 0x1p-9f;
        for (const auto& r : raycast_scene::rays_at(mesh, kind, side)) {
            const float length = std::sqrt(dot(r.direction, r.direction));
            const abut::vec3<float> way = (6 * half / length) * r.direction, end = r.origin + way;
            lines.push_back({r.origin, end});
            balls.push_back({r.origin, radius});
            capsules.push_back({{r.origin, r.origin + abut::vec3<float>{0, 0, 2 * radius}}, radius});
            ways.push_back(way);
        }
    }
};

}  // namespace sweep_scene
