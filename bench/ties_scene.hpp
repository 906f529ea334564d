// SPDX-License-Identifier: MIT
#pragma once

// Scenes of bench/ties.cpp and bench/ties.cu in which nearly all pairs are ties, which no error bound decides: pairs of
// triangles on lattices and with corners in common, voxel models against themselves and against copies that are moved, and a
// mesh onto itself.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <abut/predicate/intersects.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/set.hpp>

#include "../tests/support/draws.hpp"
#include "../tests/support/scenes.hpp"
#include "../tests/support/triangle_families.hpp"

namespace ties_scene {

using abut::test::triangle_family;

inline constexpr std::uint64_t seed = 2012;

/// `random` is the yardstick: it has no ties.
inline constexpr triangle_family families[] = {
    triangle_family::random,      triangle_family::lattice_4,        triangle_family::lattice_16,
    triangle_family::lattice_256, triangle_family::tenths_4,         triangle_family::tenths_16,
    triangle_family::tenths_256,  triangle_family::shared_vertex,    triangle_family::shared_edge,
    triangle_family::copied,      triangle_family::coplanar_aligned, triangle_family::coplanar_nested};

template <abut::scalar T>
struct surface {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;

    [[nodiscard]] abut::triangle<T> triangle(std::size_t f) const {
        return {vertices[faces[f][0]], vertices[faces[f][1]], vertices[faces[f][2]]};
    }
};

/// The surface of `side`^3 voxels of which a seeded half is full: two triangles for each face between full and empty.
template <abut::scalar T>
surface<T> voxels(int side, T cell) {
    abut::test::uniform random(seed);
    std::vector<bool> full(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (std::size_t i = 0; i < full.size(); ++i) full[i] = random() < 0.5;
    const auto is_full = [&](const std::array<int, 3>& v) {
        for (const int x : v) {
            if (x < 0 || x >= side) return false;
        }
        return bool(full[static_cast<std::size_t>((v[2] * side + v[1]) * side + v[0])]);
    };
    surface<T> made;
    std::map<std::array<int, 3>, std::uint32_t> index;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [found, fresh] = index.try_emplace(p, static_cast<std::uint32_t>(made.vertices.size()));
        if (fresh) {
            made.vertices.push_back({static_cast<T>(p[0]) * cell, static_cast<T>(p[1]) * cell, static_cast<T>(p[2]) * cell});
        }
        return found->second;
    };
    std::array<int, 3> v{};
    for (v[2] = 0; v[2] < side; ++v[2]) {
        for (v[1] = 0; v[1] < side; ++v[1]) {
            for (v[0] = 0; v[0] < side; ++v[0]) {
                for (std::size_t axis = 0; is_full(v) && axis < 3; ++axis) {
                    for (const int end : {0, 1}) {
                        auto neighbour = v;
                        neighbour[axis] += 2 * end - 1;
                        if (is_full(neighbour)) continue;
                        const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
                        std::uint32_t corner[4];
                        for (int k = 0; k < 4; ++k) {
                            auto p = v;
                            p[axis] += end;
                            p[i] += k == 1 || k == 2;
                            p[j] += k >= 2;
                            corner[k] = vertex(p);
                        }
                        made.faces.push_back({corner[0], corner[1], corner[2]});
                        made.faces.push_back({corner[0], corner[2], corner[3]});
                    }
                }
            }
        }
    }
    return made;
}

template <abut::scalar T>
surface<T> moved(surface<T> s, T x, T y, T z) {
    for (auto& p : s.vertices) p = p + abut::vec3<T>{x, y, z};
    return s;
}

/// The pairs of triangles whose boxes touch, as a query meets them: at most `most`.
template <abut::scalar T>
std::vector<abut::test::triangle_pair<T>> candidates(const surface<T>& a, const surface<T>& b, std::size_t most) {
    std::vector<abut::aabb<T>> boxes;
    for (std::size_t j = 0; j < b.faces.size(); ++j) boxes.push_back(abut::bounds(b.triangle(j)));
    std::vector<abut::test::triangle_pair<T>> pairs;
    for (std::size_t i = 0; i < a.faces.size(); ++i) {
        const auto t = a.triangle(i);
        const auto box = abut::bounds(t);
        for (std::size_t j = 0; j < b.faces.size(); ++j) {
            if (!abut::overlaps(box, boxes[j])) continue;
            pairs.push_back({t, b.triangle(j)});
            if (pairs.size() == most) return pairs;
        }
    }
    return pairs;
}

template <abut::scalar T>
struct scene {
    std::string name;
    surface<T> a, b;
};

/// Two voxel models of `side`^3; and a mesh onto itself, or a torus if there is none.
template <abut::scalar T>
std::vector<scene<T>> scenes(int side, const surface<T>* mesh) {
    const auto whole = voxels<T>(side, T(1)), tenths = voxels<T>(side, T(0.1));
    const abut::test::torus<T> torus(200, 100, 2, 1);
    const surface<T> round{torus.vertices, torus.faces};
    const surface<T>& onto_itself = mesh != nullptr ? *mesh : round;
    return {{"voxels onto themselves", whole, whole},
            {"voxels moved by a cell", whole, moved(whole, T(1), T(0), T(0))},
            {"voxels moved by half cells", whole, moved(whole, T(0.5), T(0.5), T(0))},
            {"voxels of 0.1 onto themselves", tenths, tenths},
            {"voxels of 0.1 moved by 0.05", tenths, moved(tenths, T(0.05), T(0.05), T(0))},
            {mesh != nullptr ? "mesh onto itself" : "torus onto itself", onto_itself, onto_itself}};
}

}  // namespace ties_scene
