// SPDX-License-Identifier: MIT
#pragma once

// The embedded scene: a closed torus in a cloud of equal spheres, the size of the scene in Lee and Hsieh, 2019 (62,976
// triangles, 1,703,244 spheres of radius 3, 39,709 pairs that touch). The examples and the benchmarks share it. It is the
// same on every machine: nothing in it depends on how a standard library makes random numbers.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/shape/view.hpp>

namespace scene {

inline constexpr std::size_t sphere_count = 1'703'244;
inline constexpr std::uint64_t seed = 2019;
inline constexpr double radius = 3;
/// Side of the cube around the origin in which the centers lie; in float the scene then has 39,708 pairs.
inline constexpr double cube_side = 870.45;
inline constexpr std::uint32_t torus_around = 192, torus_across = 164;
inline constexpr double torus_major_radius = 100, torus_minor_radius = 40;

/// Number `counter` of the sequence that `start` names, uniform in [0, 1) in steps of 2^-53. It has no state, so numbers may
/// be made in any order (the output function of SplitMix64: Steele, Lea and Flood, 2014).
inline double uniform(std::uint64_t start, std::uint64_t counter) {
    std::uint64_t bits = start * 0xd1342543de82ef95u + (counter + 1) * 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    bits ^= bits >> 31;
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// `count` points, uniform in a box. The fma keeps compilers from choosing how the last digit is rounded.
template <abut::scalar T>
std::vector<abut::vec3<T>> points_in(const abut::aabb<double>& box, std::size_t count, std::uint64_t start = seed) {
    const auto between = [](double lower, double upper, double u) {
        return static_cast<T>(std::fma(u, upper - lower, lower));
    };
    std::vector<abut::vec3<T>> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        points[i] = {between(box.lower.x, box.upper.x, uniform(start, 3 * i)),
                     between(box.lower.y, box.upper.y, uniform(start, 3 * i + 1)),
                     between(box.lower.z, box.upper.z, uniform(start, 3 * i + 2))};
    }
    return points;
}

/// The first `count` centers of the scene's spheres.
template <abut::scalar T>
std::vector<abut::vec3<T>> centers(std::size_t count = sphere_count, double side = cube_side) {
    const double half = side / 2;
    return points_in<T>({{-half, -half, -half}, {half, half, half}}, count);
}

/// Vertices and faces of a closed surface.
template <abut::scalar T>
struct surface {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
};

/// The scene's torus: a ring of tubes of quads, two triangles each, facing outwards.
template <abut::scalar T>
surface<T> torus(std::uint32_t around = torus_around, std::uint32_t across = torus_across) {
    constexpr double turn = 6.283185307179586;
    surface<T> made;
    made.vertices.reserve(std::size_t{around} * across);
    made.faces.reserve(std::size_t{2} * around * across);
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = turn * i / around, v = turn * j / across;
            const double from_axis = torus_major_radius + torus_minor_radius * std::cos(v);
            made.vertices.push_back({static_cast<T>(from_axis * std::cos(u)), static_cast<T>(from_axis * std::sin(u)),
                                     static_cast<T>(torus_minor_radius * std::sin(v))});
            const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
            const std::uint32_t a = i * across + j, b = next_i * across + j;
            const std::uint32_t c = next_i * across + next_j, d = i * across + next_j;
            made.faces.push_back({a, b, c});
            made.faces.push_back({a, c, d});
        }
    }
    return made;
}

}  // namespace scene
