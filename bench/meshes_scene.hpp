// SPDX-License-Identifier: MIT
#pragma once

// Two meshes for bench/meshes.cpp and its peers: one from a file or a torus, and a copy of it that is turned by 30 degrees
// about (1, 2, 3) through the middle of its box, then moved by 0.3 in x.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "../tests/support/scenes.hpp"
#include "mesh_file.hpp"

namespace meshes_scene {

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};

/// A mesh from a PLY or OBJ file.
inline surface read_surface(const std::string& path) { return bench::read_surface<surface>(path); }

struct mesh_pair {
    surface a, b;
    abut::rigid<float> pose;  ///< takes a to where b is
};

/// A torus in a box of side 1, of as many triangles as the full scan of the armadillo or about that.
inline surface unit_torus() {
    const abut::test::torus<float> shape(588, 294, 0.35, 0.15);
    return {shape.vertices, shape.faces};
}

/// The turn by 30 degrees about (1, 2, 3) through the middle of the surface's box, then a shift in x.
inline abut::rigid<float> turned(const surface& s, double shift_x) {
    auto box = abut::empty_box<float>();
    for (const auto& p : s.vertices) box = abut::merge(box, abut::bounds(p));
    const double middle[3] = {(double(box.lower.x) + double(box.upper.x)) / 2,
                              (double(box.lower.y) + double(box.upper.y)) / 2,
                              (double(box.lower.z) + double(box.upper.z)) / 2};
    const double n = std::sqrt(14.0), axis[3] = {1 / n, 2 / n, 3 / n}, angle = std::acos(-1.0) / 6;
    const double c = std::cos(angle), si = std::sin(angle);
    abut::rigid<float> pose;
    double shift[3];
    for (int i = 0; i < 3; ++i) {
        shift[i] = middle[i] + (i == 0 ? shift_x : 0);
        for (int j = 0; j < 3; ++j) {
            const double cross = i == j ? 0 : (j == (i + 1) % 3 ? -1 : 1) * axis[3 - i - j];
            const double turn = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j] + si * cross;
            shift[i] -= turn * middle[j];
            pose.rotation[3 * i + j] = static_cast<float>(turn);
        }
    }
    pose.translation = {static_cast<float>(shift[0]), static_cast<float>(shift[1]), static_cast<float>(shift[2])};
    return pose;
}

/// The surface where a pose puts it, rounded as queries of posed sets round.
inline surface baked(surface s, const abut::rigid<float>& pose) {
    for (auto& p : s.vertices) p = abut::place(pose, p);
    return s;
}

inline mesh_pair make_pair(surface a) {
    const auto pose = turned(a, 0.3);
    auto b = baked(a, pose);
    return {std::move(a), std::move(b), pose};
}

/// Set by main before any benchmark runs.
inline const mesh_pair* the_pair = nullptr;

/// Peers add themselves here; benchmarks are registered when the scene is known.
inline std::vector<void (*)()>& peers() {
    static std::vector<void (*)()> all;
    return all;
}

}  // namespace meshes_scene
