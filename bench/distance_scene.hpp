// SPDX-License-Identifier: MIT
#pragma once

// The scenes of bench/distance.*: two meshes, and poses of the second in the frame of the first. Poses in which they touch
// are apart from those in which they do not.
//
//   robot       env.obj and rob.obj (FCL's own test data), at random places of the room
//   scan        armadillo_27674.ply and itself, beside each other
//   large_scan  armadillo_345944.ply alike
//   torus       a torus of 8,192 triangles and itself; where no folder of meshes is given, this alone

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "mesh_file.hpp"

namespace distance_scene {

struct surface {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};
using pose = abut::rigid<float>;

struct scene {
    std::string name;
    surface a, b;
    std::vector<pose> apart, touching;
};

inline abut::mesh<float> mesh_of(const surface& s) { return {s.vertices, s.faces}; }

inline surface torus() {
    surface s;
    constexpr int major = 64, minor = 64;
    for (int i = 0; i < major; ++i) {
        for (int j = 0; j < minor; ++j) {
            const double u = 2 * std::numbers::pi * i / major, v = 2 * std::numbers::pi * j / minor,
                         r = 2 + 0.5 * std::cos(v);
            s.vertices.push_back({float(r * std::cos(u)), float(r * std::sin(u)), float(0.5 * std::sin(v))});
            const auto at = [](int k, int l) { return static_cast<std::uint32_t>(k % major * minor + l % minor); };
            s.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return s;
}

/// A turn that is any, to float's digits.
inline pose random_turn(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    double q[4], n = 0;
    for (double& x : q) x = normal(random), n += x * x;
    for (double& x : q) x /= std::sqrt(n);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    pose p;
    for (int i = 0; i < 9; ++i) p.rotation[i] = float(m[i]);
    return p;
}

/// `place(random)` is a translation.
template <class Place>
scene make_scene(std::string name, surface a, surface b, std::size_t poses, const Place& place) {
    scene s{std::move(name), std::move(a), std::move(b), {}, {}};
    const abut::serial on;
    const auto tree_a = make_bvh(on, mesh_of(s.a)), tree_b = make_bvh(on, mesh_of(s.b));
    std::mt19937_64 random(20261124);
    for (std::size_t i = 0; i < poses; ++i) {
        pose p = random_turn(random);
        p.translation = place(random);
        (abut::any(on, tree_a, posed(tree_b, p)) ? s.touching : s.apart).push_back(p);
    }
    return s;
}

/// Beside each other: from about where they touch to a size farther.
inline scene beside(std::string name, const surface& mesh, std::size_t poses) {
    const auto box = make_bvh(abut::serial{}, mesh_of(mesh)).bounds();
    const auto size = box.upper - box.lower;
    const double most = std::sqrt(double(dot(size, size)));
    return make_scene(std::move(name), mesh, mesh, poses, [&](std::mt19937_64& random) {
        std::normal_distribution<double> normal;
        const double x = normal(random), y = normal(random), z = normal(random), n = std::sqrt(x * x + y * y + z * z);
        const double away = most * std::uniform_real_distribution<double>(0.4, 1.4)(random) / n;
        return abut::vec3<float>{float(away * x), float(away * y), float(away * z)};
    });
}

/// `folder`: where the meshes are; empty for none.
inline std::vector<scene> make_scenes(const std::string& folder) {
    std::vector<scene> all;
    if (folder.empty()) {
        all.push_back(beside("torus", torus(), 100));
        return all;
    }
    const auto read = [&](const char* file) { return bench::read_surface<surface>(folder + "/" + file); };
    all.push_back(make_scene("robot", read("env.obj"), read("rob.obj"), 2000, [](std::mt19937_64& random) {
        std::uniform_real_distribution<double> side(-3000, 3000), height(0, 1000);
        const double x = side(random), y = side(random);
        return abut::vec3<float>{float(x), float(y), float(height(random))};
    }));
    all.push_back(beside("scan", read("armadillo_27674.ply"), 100));
    all.push_back(beside("large_scan", read("armadillo_345944.ply"), 20));
    return all;
}

}  // namespace distance_scene
