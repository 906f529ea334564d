// SPDX-License-Identifier: MIT
#pragma once

// The scene of bench/mixed_bodies.cpp, and what it asks of a peer: which of 1,000 bodies touch, a tenth of them meshes and
// the rest capsules, boxes, cylinders and spheres, turned at random in a cube; and that after they have moved.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "../bodies_scene.hpp"

namespace mixed_scene {

enum class kind : unsigned char { mesh, box, capsule, cylinder, sphere };
inline constexpr std::size_t kinds = 5;

struct body {
    kind of;
    double radius, half_length;  ///< along z
    abut::vec3<double> half;     ///< of a box
};
using poses = std::vector<abut::rigid<double>>;

struct crowd {
    std::vector<abut::vec3<double>> vertices;  ///< of the mesh that all meshes share
    std::vector<abut::face> faces;
    std::vector<body> bodies;  ///< meshes first, then boxes and so on
    poses now, later;
};

inline crowd make(std::size_t n) {
    crowd s;
    const auto torus = scene::torus<double>(25, 20);
    for (const auto& p : torus.vertices) s.vertices.push_back(0.01 * p);
    s.faces = torus.faces;
    const auto as_double = [](const abut::rigid<float>& pose) {
        abut::rigid<double> wide;
        wide.translation = {0.7 * double(pose.translation.x), 0.7 * double(pose.translation.y),
                            0.7 * double(pose.translation.z)};
        for (int i = 0; i < 9; ++i) wide.rotation[i] = static_cast<double>(pose.rotation[i]);
        return wide;
    };
    const auto places = bodies_scene::make(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto size = [i](std::uint64_t k) { return 0.3 + 0.7 * ::scene::uniform(99, 8 * i + k); };
        const std::size_t meshes = n / 10;
        const auto of = i < meshes ? kind::mesh : static_cast<kind>(1 + 4 * (i - meshes) / (n - meshes));
        s.bodies.push_back({of, 0.8 * size(0), size(1), {size(0), size(1), size(2)}});
        s.now.push_back(as_double(places.now[i]));
        s.later.push_back(as_double(places.later[i]));
    }
    return s;
}

/// A library that holds the bodies.
struct holder {
    std::function<void(const poses&)> move;
    std::function<std::vector<abut::index_pair>()> touching;  ///< each two that touch once, a < b, in any order
};
struct peer {
    std::string name;
    holder (*make)(const crowd&);
    std::string version{};  ///< of a library
};
/// A body's shape, by the classes of a library.
template <class Shape, class Box, class Capsule, class Cylinder, class Sphere>
std::shared_ptr<Shape> shape_of(const body& b, const std::shared_ptr<Shape>& mesh) {
    switch (b.of) {
        case kind::mesh:
            return mesh;
        case kind::box:
            return std::make_shared<Box>(2 * b.half.x, 2 * b.half.y, 2 * b.half.z);
        case kind::capsule:
            return std::make_shared<Capsule>(b.radius, 2 * b.half_length);
        case kind::cylinder:
            return std::make_shared<Cylinder>(b.radius, 2 * b.half_length);
        case kind::sphere:
            break;
    }
    return std::make_shared<Sphere>(b.radius);
}
/// What holds bodies as `objects` in a `tree`, and finds those that touch.
template <class Held>
holder holder_of(const crowd& s) {
    const auto all = std::make_shared<Held>(s);
    return {[=](const poses& at) {
                for (std::size_t i = 0; i < at.size(); ++i) {
                    all->objects[i]->setTransform(Held::placed(at[i]));
                    all->objects[i]->computeAABB();
                }
                all->tree.update();
            },
            [=] {
                all->found.clear();
                all->find();
                return all->found;
            }};
}
inline std::vector<peer>& peers() {
    static std::vector<peer> all;
    return all;
}

}  // namespace mixed_scene
