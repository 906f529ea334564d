// SPDX-License-Identifier: MIT
#pragma once

// Scenes of the benchmarks of motion: a mesh at two times, from two files of a folder, frame0.ply and frame1.ply, or made.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <abut/collide/features.hpp>
#include <abut/io/read.hpp>
#include <abut/shape/motion.hpp>

namespace motion_scene {

/// Filters of queries of one kind of features within a mesh.
struct share_no_vertex_with_face {
    abut::detail::strided<abut::face> faces;
    ABUT_HD bool operator()(std::uint32_t v, std::uint32_t f) const {
        return abut::detail::share_no_vertex(v, abut::detail::corners_at(faces, f));
    }
};
struct share_no_vertex_with_edge {
    abut::detail::strided<abut::edge> edges;
    ABUT_HD bool operator()(std::uint32_t i, std::uint32_t j) const {
        return abut::detail::share_no_vertex(abut::detail::corners_at(edges, i), abut::detail::corners_at(edges, j));
    }
};

struct frames {
    std::string name;
    std::vector<abut::vec3<double>> t0, t1;
    std::vector<abut::face> faces;

    /// Whether all positions are floats.
    [[nodiscard]] bool is_single() const {
        const auto all_of = [](const std::vector<abut::vec3<double>>& points) {
            const auto is = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
            for (const auto& p : points) {
                if (!is(p.x) || !is(p.y) || !is(p.z)) return false;
            }
            return true;
        };
        return all_of(t0) && all_of(t1);
    }
    template <abut::scalar T>
    [[nodiscard]] static std::vector<abut::vec3<T>> as(const std::vector<abut::vec3<double>>& points) {
        std::vector<abut::vec3<T>> same;
        for (const auto& p : points) same.push_back({static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
        return same;
    }
};

inline frames read_frames(const std::string& folder) {
    frames scene;
    scene.name = std::filesystem::path(folder).filename().string();
    const auto first = abut::io::read_mesh<double>(folder + "/frame0.ply"),
               second = abut::io::read_mesh<double>(folder + "/frame1.ply");
    const auto a = first.view(), b = second.view();
    for (std::size_t i = 0; i < a.vertices.count; ++i) scene.t0.push_back(a.vertices[i]);
    for (std::size_t i = 0; i < b.vertices.count; ++i) scene.t1.push_back(b.vertices[i]);
    for (std::size_t i = 0; i < a.size(); ++i) scene.faces.push_back(a.faces[i]);
    return scene;
}

/// A ball of `rings` x 2 rings quads, in triangles.
inline void add_ball(frames& scene, std::uint32_t rings, const abut::vec3<double>& at, double radius,
                     const abut::vec3<double>& moves, double turns) {
    const auto first = static_cast<std::uint32_t>(scene.t0.size());
    const std::uint32_t around = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) {
            const double up = 3.141592653589793 * i / rings, turn = 6.283185307179586 * j / around;
            const auto point = [&](double angle) {
                return abut::vec3<double>{at.x + radius * std::sin(up) * std::cos(angle), at.y + radius * std::cos(up),
                                          at.z + radius * std::sin(up) * std::sin(angle)};
            };
            scene.t0.push_back(point(turn));
            scene.t1.push_back(point(turn + turns) + moves);
        }
    }
    for (std::uint32_t i = 0; i < rings; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) {
            const std::uint32_t a = first + i * around + j, b = first + i * around + (j + 1) % around;
            if (i > 0) scene.faces.push_back({a, b, a + around});
            if (i + 1 < rings) scene.faces.push_back({b, b + around, a + around});
        }
    }
}

/// A stand-in for the BART museum of the literature, which could not be had: as many small things flying about in a room as
/// make some `triangles`.
inline frames flying_things(std::size_t triangles) {
    frames scene;
    scene.name = "flying_things_" + std::to_string(triangles);
    std::uint64_t state = 1;
    const auto next = [&state] {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(state >> 40) * 0x1p-24;
    };
    const double room = std::cbrt(static_cast<double>(triangles) / 24);
    while (scene.faces.size() < triangles) {
        const abut::vec3<double> at{room * next(), room * next(), room * next()};
        const abut::vec3<double> moves{next() - 0.5, next() - 0.5, next() - 0.5};
        add_ball(scene, 3, at, 0.3 + 0.2 * next(), moves, next() - 0.5);
    }
    return scene;
}

}  // namespace motion_scene
