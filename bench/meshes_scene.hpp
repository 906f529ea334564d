// SPDX-License-Identifier: MIT
#pragma once

// Two meshes for bench/meshes.cpp and its peers: one from a file or a torus, and a copy of it that is turned by 30 degrees
// about (1, 2, 3) through the middle of its box, then moved by 0.3 in x, and rounded to float.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "../tests/support/scenes.hpp"

namespace meshes_scene {

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};

/// A mesh from a PLY or OBJ file.
inline surface read_surface(const std::string& path) {
    const auto mesh = abut::io::read_mesh<float>(path);
    const auto view = mesh.view();
    surface s;
    for (std::size_t i = 0; i < view.vertices.count; ++i) s.vertices.push_back(view.vertices[i]);
    for (std::size_t i = 0; i < view.faces.count; ++i) s.faces.push_back(view.faces[i]);
    return s;
}

struct mesh_pair {
    surface a, b;
    abut::rigid<float> pose;  ///< takes a to where b is, but for rounding
};

/// A torus in a box of side 1, of as many triangles as the full scan of the armadillo or about that.
inline surface unit_torus() {
    const abut::test::torus<float> shape(588, 294, 0.35, 0.15);
    return {shape.vertices, shape.faces};
}

inline mesh_pair make_pair(surface a) {
    auto box = abut::empty_box<float>();
    for (const auto& p : a.vertices) box = abut::merge(box, abut::bounds(p));
    const double middle[3] = {(double(box.lower.x) + double(box.upper.x)) / 2,
                              (double(box.lower.y) + double(box.upper.y)) / 2,
                              (double(box.lower.z) + double(box.upper.z)) / 2};
    const double n = std::sqrt(14.0), axis[3] = {1 / n, 2 / n, 3 / n}, angle = std::acos(-1.0) / 6;
    const double c = std::cos(angle), s = std::sin(angle);
    double turn[3][3];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double cross = i == j ? 0 : (j == (i + 1) % 3 ? -1 : 1) * axis[3 - i - j];
            turn[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j] + s * cross;
        }
    }
    mesh_pair pair;
    double shift[3];
    for (int i = 0; i < 3; ++i) {
        shift[i] = middle[i] + (i == 0 ? 0.3 : 0);
        for (int j = 0; j < 3; ++j) {
            shift[i] -= turn[i][j] * middle[j];
            pair.pose.rotation[3 * i + j] = static_cast<float>(turn[i][j]);
        }
    }
    pair.pose.translation = {static_cast<float>(shift[0]), static_cast<float>(shift[1]), static_cast<float>(shift[2])};
    pair.b.faces = a.faces;
    for (const auto& p : a.vertices) {
        const auto at = [&](int i) {
            return static_cast<float>(turn[i][0] * double(p.x) + turn[i][1] * double(p.y) + turn[i][2] * double(p.z) +
                                      shift[i]);
        };
        pair.b.vertices.push_back({at(0), at(1), at(2)});
    }
    pair.a = std::move(a);
    return pair;
}

/// Set by main before any benchmark runs.
inline const mesh_pair* the_pair = nullptr;

/// Peers add themselves here; benchmarks are registered when the scene is known.
inline std::vector<void (*)()>& peers() {
    static std::vector<void (*)()> all;
    return all;
}

}  // namespace meshes_scene
