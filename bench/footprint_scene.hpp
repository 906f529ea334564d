// SPDX-License-Identifier: MIT
#pragma once

// Scenes from the least to the richest, to see what each step costs: what is not asked for costs nothing. A scene is one
// query; its program is compiled with nothing else where FOOTPRINT_SCENE says which (bench/footprint.py does that).

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "../docs/examples/scene.hpp"

namespace footprint {

/// Spheres against a mesh, a mesh against another, a mesh in motion against itself.
enum asked : int {
    spheres_any_no_index,
    spheres_any,
    spheres_count,
    spheres_own_radii,
    spheres_pairs,
    spheres_posed,
    spheres_contacts,
    meshes_any_no_index,
    meshes_any,
    meshes_count,
    meshes_pairs,
    meshes_posed,
    meshes_contacts,
    moving_first,
    moving_all,
    moving_conservative,
    scenes
};

inline constexpr const char* name_of[scenes] = {
    "spheres/any, equal radii, no index",
    "spheres/any, equal radii",
    "spheres/count, equal radii",
    "spheres/count, own radii",
    "spheres/pairs, own radii",
    "spheres/pairs, own radii, posed",
    "spheres/contacts, own radii, posed",
    "meshes/any, no index",
    "meshes/any",
    "meshes/count",
    "meshes/pairs",
    "meshes/pairs, posed",
    "meshes/contacts, posed",
    "moving/first impact",
    "moving/all impacts",
    "moving/all impacts, `conservative`",
};

/// What is measured of a scene beside its time.
struct sizes {
    double elements = 0;     ///< of the sets that are asked about
    double set_bytes = 0;    ///< of all of them
    double index_bytes = 0;  ///< of trees
    double answer = 0;       ///< so that nothing is optimised away, and for a look
};

inline constexpr abut::rigid<float> pose{{1, 0, 0, 0, 0.8f, -0.6f, 0, 0.6f, 0.8f}, {5, 6, 7}};
inline constexpr std::size_t few_balls = 1000, balls = 100'000;

template <class Policy>
auto torus_mesh(const Policy& on, float shift = 0, std::uint32_t around = 96, std::uint32_t across = 82) {
    auto torus = scene::torus<float>(around, across);
    for (auto& v : torus.vertices) v = {v.x + shift, v.y + shift / 2, v.z + shift / 3};
    return abut::mesh<float>(torus.vertices, torus.faces).copied_to(on);
}

template <class Mesh>
double bytes_of(const Mesh& mesh) {
    return static_cast<double>(sizeof(abut::vec3<float>) * mesh.view().vertices.count + sizeof(abut::face) * mesh.size());
}

/// A query that can be asked again, with the sizes of what it asks about.
struct prepared {
    std::function<double()> ask;
    sizes of;
};

template <int Scene, class Policy>
prepared prepare(const Policy& on) {
    const auto number = [](auto n) { return static_cast<double>(n); };
    if constexpr (Scene <= spheres_contacts) {
        const auto mesh = torus_mesh(on);
        constexpr bool no_index = Scene == spheres_any_no_index, own = Scene >= spheres_own_radii;
        const std::size_t n = no_index ? few_balls : balls;
        // With `any` all balls are away from the torus, so that all of them are looked at.
        auto centers = scene::centers<float>(n);
        if (Scene <= spheres_any) {
            for (auto& c : centers) c.z += c.z < 0 ? -100 : 100;
        }
        const auto with_spheres = [&](const auto& set, double bytes) {
            sizes of{number(n), bytes, 0, 0};
            if constexpr (no_index) {
                return prepared{[=] { return number(abut::any(on, mesh, set)); }, of};
            } else {
                const auto tree = abut::make_bvh(on, mesh);
                of.index_bytes = number(tree.bytes());
                const auto ask = [=] {
                    if constexpr (Scene == spheres_any)
                        return number(abut::any(on, tree, set));
                    else if constexpr (Scene <= spheres_own_radii)
                        return number(abut::count(on, tree, set));
                    else if constexpr (Scene == spheres_pairs)
                        return number(abut::pairs(on, tree, set).size());
                    else if constexpr (Scene == spheres_posed)
                        return number(abut::pairs(on, abut::posed(tree, pose), set).size());
                    else
                        return number(abut::contacts(on, abut::posed(tree, pose), set).size());
                };
                return prepared{ask, of};
            }
        };
        if constexpr (own) {
            std::vector<abut::sphere<float>> all;
            for (std::size_t i = 0; i < n; ++i) all.push_back({centers[i], static_cast<float>(1 + i % 5)});
            return with_spheres(abut::spheres<float>(all).copied_to(on), number(n * sizeof(abut::sphere<float>)));
        } else {
            return with_spheres(abut::equal_spheres<float>(centers, 3).copied_to(on), number(n * sizeof(abut::vec3<float>)));
        }
    } else if constexpr (Scene <= meshes_contacts) {
        // A copy that meets the other in a ring, or where `any` is asked none.
        constexpr bool no_index = Scene == meshes_any_no_index;
        constexpr std::uint32_t part = no_index ? 4 : 1;
        const auto a = torus_mesh(on, 0, 96 / part, 82 / part);
        const auto b = torus_mesh(on, Scene <= meshes_any ? 400.0f : 30.0f, 96 / part, 82 / part);
        sizes of{number(a.size() + b.size()), bytes_of(a) + bytes_of(b), 0, 0};
        if constexpr (no_index) {
            return {[=] { return number(abut::any(on, a, b)); }, of};
        } else {
            const auto of_a = abut::make_bvh(on, a), of_b = abut::make_bvh(on, b);
            of.index_bytes = number(of_a.bytes() + of_b.bytes());
            const auto ask = [=] {
                if constexpr (Scene == meshes_any)
                    return number(abut::any(on, of_a, of_b));
                else if constexpr (Scene == meshes_count)
                    return number(abut::count(on, of_a, of_b));
                else if constexpr (Scene == meshes_pairs)
                    return number(abut::pairs(on, of_a, of_b).size());
                else if constexpr (Scene == meshes_posed)
                    return number(abut::pairs(on, of_a, abut::posed(of_b, pose)).size());
                else
                    return number(abut::contacts(on, of_a, abut::posed(of_b, pose)).size());
            };
            return {ask, of};
        }
    } else {
        // A torus whose one side is pushed through the other in the middle.
        auto torus = scene::torus<float>(96, 82);
        const abut::mesh<float> before(torus.vertices, torus.faces);
        auto later = torus.vertices;
        for (auto& v : later) {
            if (v.x > 0) v.x -= 130 * std::exp(-v.y * v.y / 1000);
        }
        const auto step = abut::moving(before, before.with_vertices(abut::serial{}, later)).copied_to(on);
        const auto index = abut::make_impact_index(on, step);
        const sizes of{number(before.size()), 2 * bytes_of(before) - number(sizeof(abut::face) * before.size()), 0, 0};
        const auto ask = [=] {
            if constexpr (Scene == moving_first)
                return number(abut::first_self_impact(on, index).has_value());
            else if constexpr (Scene == moving_all)
                return number(abut::self_impacts(on, index).size());
            else
                return number(abut::self_impacts<abut::conservative>(on, index).size());
        };
        return {ask, of};
    }
}

/// visit(name, scene) for all scenes, or for the one that is compiled alone.
template <class Policy, class Visit>
void for_each_scene(const Policy& on, const Visit& visit) {
#ifdef FOOTPRINT_SCENE
    visit(name_of[FOOTPRINT_SCENE], prepare<FOOTPRINT_SCENE>(on));
#else
    [&]<std::size_t... I>(std::index_sequence<I...>) { (visit(name_of[I], prepare<static_cast<int>(I)>(on)), ...); }
    (std::make_index_sequence<scenes>{});
#endif
}

}  // namespace footprint
