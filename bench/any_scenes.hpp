// SPDX-License-Identifier: MIT
#pragma once

// Scenes for the question whether two meshes touch at all. A hit deep inside, a graze and a near miss are of one mesh
// against its copy, turned by 30 degrees about (1, 2, 3) through the middle of its box and shifted in x, the latter two as
// far as bisection on the exact number of pairs says; and two icospheres, one close inside the other.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "../tests/support/surfaces.hpp"
#include "meshes_scene.hpp"

namespace meshes_scene {

/// Set by main before any benchmark runs.
struct any_scene {
    std::string name;
    mesh_pair pair;
    std::uint64_t pairs;  ///< triangles that touch

    /// Whether `b` is `a` where the pose puts it, rather than another mesh.
    [[nodiscard]] bool is_copy() const { return name != "shells"; }
};
inline std::vector<any_scene> any_scenes;

inline std::vector<any_scene> make_any_scenes(const surface& s) {
    const abut::serial on;
    const auto tree = make_bvh(on, abut::mesh<float>(s.vertices, s.faces));
    const auto pairs_at = [&](double shift) { return count(on, tree, posed(tree, turned(s, shift))); };
    const auto box = tree.bounds();
    const double side = double(box.upper.x) - double(box.lower.x);
    // The shift at which the pairs become no more than `most`: one of them, since they do not only fall on the way.
    const auto shift_to = [&](std::uint64_t most) {
        double many = 0, few = 4 * side;
        for (int step = 0; step < 32; ++step) {
            const double middle = (many + few) / 2;
            (pairs_at(middle) > most ? many : few) = middle;
        }
        return few;
    };
    const auto turned_by = [&](const char* name, double shift) {
        const auto pose = turned(s, shift);
        return any_scene{name, {s, baked(s, pose), pose}, pairs_at(shift)};
    };
    std::vector<any_scene> scenes{turned_by("hit", 0), turned_by("graze", shift_to(45)),
                                  turned_by("near_miss", shift_to(0) + side / 1000)};
    const auto shell = [](double radius) {
        const auto ball = abut::test::icosphere<float>(6, radius);
        return surface{ball.vertices, ball.faces};
    };
    scenes.push_back({"shells", {shell(1), shell(0.98), {}}, 0});
    return scenes;
}

}  // namespace meshes_scene
