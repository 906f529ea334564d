// SPDX-License-Identifier: MIT
#pragma once

// Rays through a wide tree, in a source for g++ and in one for nvcc of one program. Each compiler makes registers of its own
// kind of four numbers; what both compile has to be of two names, or alike.

#include <abut/abut.hpp>

#include <array>
#include <cstdint>
#include <vector>

std::vector<std::uint32_t> hits_by_cpp();
std::vector<std::uint32_t> hits_by_cu();

template <class Arithmetic>
std::vector<std::uint32_t> hits_of_rays() {
    std::vector<abut::vec3<float>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const float x = float(i % 10), y = float(i / 10 % 10), z = float(i / 100);
        vertices.insert(vertices.end(), {{x, y, z}, {x + 1, y, z + 0.25f}, {x, y + 1, z - 0.25f}});
        faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const abut::serial on;
    const abut::mesh<float> mesh(vertices, faces);
    std::vector<abut::ray<float>> rays;
    for (int i = 0; i < 200; ++i) {
        const float u = float(i % 20) - 9.5f, v = float(i / 20) - 4.5f;
        rays.push_back({{5 - u, 5 + v, i % 2 == 0 ? -3.0f : 6.0f}, {u / 4, -v / 4, i % 2 == 0 ? 1.0f : -1.0f}});
    }
    const auto tree = abut::wide(on, abut::make_bvh(on, mesh));
    std::vector<std::uint32_t> ids;
    for (const auto& hit : abut::raycast<Arithmetic>(on, tree, abut::rays<float>(rays))) ids.push_back(hit.id);
    for (const auto& hit : abut::raycast<Arithmetic>(on, mesh, abut::rays<float>(rays))) ids.push_back(hit.id);
    return ids;
}
