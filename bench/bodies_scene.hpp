// SPDX-License-Identifier: MIT
#pragma once

// The scene of bench/bodies.cpp and bench/bodies.cu: bodies of 1,000 triangles each, which share ten tori with waves on
// their tubes, turned at random in a cube in which about three pairs of boxes meet for each body; and where they are a step
// later.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"

namespace bodies_scene {

inline constexpr std::size_t kinds = 10;
inline constexpr std::uint64_t seed = 15;
/// Side of the cube for one body; it grows with the cube root of their number.
inline constexpr double side_of_one = 3.205;
/// How far bodies go in a step, and by what angle they turn.
inline constexpr double step = 0.02;

/// 25 by 20 quads around a ring of radius 1.
inline abut::mesh<float> shape(std::size_t kind) {
    const double k = static_cast<double>(kind), thickness = 0.2 + 0.02 * k;
    auto made = scene::torus<float>(25, 20);
    for (auto& p : made.vertices) {
        const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
        const double from_axis = std::hypot(x, y), u = std::atan2(y, x);
        const double tube = thickness * (1 + 0.2 * std::sin((2 + k) * u)) / scene::torus_minor_radius;
        const double to = 1 + tube * (from_axis - scene::torus_major_radius);
        p = {static_cast<float>(to * x / from_axis), static_cast<float>(to * y / from_axis),
             static_cast<float>(tube * static_cast<double>(p.z))};
    }
    return {made.vertices, made.faces};
}

/// Bodies by the numbers of their shapes, and their poses at two times.
struct bodies {
    std::vector<std::uint32_t> kind;
    std::vector<abut::rigid<float>> now, later;
};

/// The rotation by a quaternion, which need not have length 1.
inline abut::rigid<float> pose_of(double w, double x, double y, double z, const abut::vec3<double>& at) {
    const double s = 2 / (w * w + x * x + y * y + z * z);
    const double m[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                         s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                         s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
    abut::rigid<float> pose;
    for (int i = 0; i < 9; ++i) pose.rotation[i] = static_cast<float>(m[i]);
    pose.translation = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
    return pose;
}

inline bodies make(std::size_t n) {
    bodies all;
    const double side = side_of_one * std::cbrt(static_cast<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
        const auto draw = [i](std::uint64_t k) { return scene::uniform(seed, 16 * i + k); };
        const auto around = [&](double size, std::uint64_t k) { return size * (2 * draw(k) - 1); };
        all.kind.push_back(static_cast<std::uint32_t>(i % kinds));
        // Uniform in all rotations (K. Shoemake, Uniform random rotations, 1992).
        const double u = draw(0), v = 6.283185307179586 * draw(1), t = 6.283185307179586 * draw(2);
        const double w = std::sqrt(1 - u) * std::sin(v), x = std::sqrt(1 - u) * std::cos(v);
        const double y = std::sqrt(u) * std::sin(t), z = std::sqrt(u) * std::cos(t);
        const abut::vec3<double> at{side * draw(3), side * draw(4), side * draw(5)};
        all.now.push_back(pose_of(w, x, y, z, at));
        constexpr double turn = step / 2;
        all.later.push_back(pose_of(w + around(turn, 6), x + around(turn, 7), y + around(turn, 8), z + around(turn, 9),
                                    {at.x + around(step, 10), at.y + around(step, 11), at.z + around(step, 12)}));
    }
    return all;
}

/// Pairs of bodies whose boxes meet.
template <class Policy, class Bodies>
std::size_t near(const Policy& on, const Bodies& all) {
    const int bits = abut::detail::id_bits(all.tree().size());
    return abut::detail::find_near(on, all.tree(), {bits, bits}, true).size();
}

}  // namespace bodies_scene
