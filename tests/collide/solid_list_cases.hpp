// SPDX-License-Identifier: MIT
#pragma once

// Bricks of a grid in lists and scenes, of which relations, contact areas and depths are known.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/collide/contact_patches.hpp>
#include <abut/collide/penetration.hpp>

#include "collide/patch_cases.hpp"
#include "collide/solid_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

/// A brick of a grid.
struct brick {
    grid_place from, to;
    [[nodiscard]] cells units() const {
        cells c;
        for (int x = from[0]; x < to[0]; ++x) {
            for (int y = from[1]; y < to[1]; ++y) {
                for (int z = from[2]; z < to[2]; ++z) c.in.insert({x, y, z});
            }
        }
        return c;
    }
};
/// By how much two reach over each other along an axis: negative where they are apart.
inline int overlap_along(const brick& a, const brick& b, std::size_t axis) { return std::min(a.to[axis], b.to[axis]) - std::max(a.from[axis], b.from[axis]); }
/// The least move that separates two whose interiors meet; else 0.
inline int depth_of(const brick& a, const brick& b) {
    int least = 99;
    for (std::size_t k = 0; k < 3; ++k) {
        if (overlap_along(a, b, k) <= 0) return 0;
        least = std::min({least, a.to[k] - b.from[k], b.to[k] - a.from[k]});
    }
    return least;
}

template <class Policy>
using brick_tree = decltype(make_bvh(std::declval<const Policy&>(), copy_to(std::declval<const Policy&>(), mesh<double>())));

/// Bricks, and bodies of them on a policy and on the host.
template <class Policy>
struct brick_scene {
    std::vector<brick> bricks;
    std::vector<posed_object<brick_tree<Policy>>> bodies;
    std::vector<posed_object<brick_tree<serial>>> on_host;
    brick_scene(const Policy& on, std::uint64_t k, int n) {
        draws d(20271202, 1, k);
        for (int i = 0; i < n; ++i) {
            brick b{};
            for (std::size_t c = 0; c < 3; ++c) {
                b.from[c] = d.below(5);
                b.to[c] = b.from[c] + 1 + d.below(3);
            }
            bricks.push_back(b);
            const mesh<double> surface = surface_of<double>(b.units(), {}, d);
            bodies.push_back(posed(make_bvh(on, copy_to(on, surface)), rigid<double>{}));
            on_host.push_back(posed(make_bvh(serial{}, surface), rigid<double>{}));
        }
    }
};

/// Patches and depths of a list and of a scene: what is known of bricks, and what the host says of two alone.
template <class Policy>
void check_patches_and_depths(const Policy& on) {
    const brick_scene<Policy> scene(on, 1, 9);
    const auto n = static_cast<std::uint32_t>(scene.bricks.size());
    std::vector<posed_pair<brick_tree<Policy>>> list;
    std::vector<solid_relation> truth;
    std::vector<int> depth;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = i + 1; j < n; ++j) {
            list.push_back({scene.bodies[i], scene.bodies[j]});
            truth.push_back(truth_of(scene.bricks[i].units(), scene.bricks[j].units()));
            depth.push_back(depth_of(scene.bricks[i], scene.bricks[j]));
        }
    }
    const auto patches = contact_patches(on, list);
    const auto of_scene = contact_patches(on, make_bodies(on, scene.bodies), {.known_solid = true, .most_points = 4});
    const auto bounds = penetration(on, list, {.known_solid = true, .tolerance = 0.125});
    const auto deep = penetration(on, scene.bodies, {.tolerance = 0.125});
    std::size_t met = 0, deep_ones = 0, wrong = 0, unlike = 0;
    REQUIRE((patches.size() == list.size() && bounds.size() == list.size()));
    for (std::size_t e = 0, i = 0, j = 1; e < list.size(); ++e) {
        const auto r = truth[e];
        const bool touch = r != solid_relation::disconnected && r != solid_relation::nontangential_part && r != solid_relation::nontangential_part_inverse;
        wrong += patches[e].empty() == touch;
        // Cubes that touch in a side have that for an area.
        if (r == solid_relation::externally_connected) {
            double area = 1;
            for (std::size_t k = 0; k < 3; ++k) {
                if (const int over = overlap_along(scene.bricks[i], scene.bricks[j], k); over != 0) area *= over;
            }
            int sides = 0;
            for (std::size_t k = 0; k < 3; ++k) sides += overlap_along(scene.bricks[i], scene.bricks[j], k) == 0;
            if (sides == 1) wrong += patches[e].size() != 1 || patches[e][0].area != area || patches[e][0].depth != 0;
        }
        unlike += !are_same(patches[e], contact_patches(serial{}, scene.on_host[i], scene.on_host[j]));
        if (touch) {
            REQUIRE(met < of_scene.size());
            const auto& [a, b, some] = of_scene[met++];
            wrong += a != i || b != j;
            unlike += !are_same(some, contact_patches(serial{}, scene.on_host[i], scene.on_host[j], {.most_points = 4}));
        }
        wrong += bounds[e].overlap != (depth[e] > 0) || bounds[e].least > depth[e] || bounds[e].most < depth[e];
        unlike += bounds[e] != penetration(serial{}, scene.on_host[i], scene.on_host[j], {.tolerance = 0.125});
        if (depth[e] > 0) {
            REQUIRE(deep_ones < deep.size());
            wrong += deep[deep_ones].body_a != i || deep[deep_ones].body_b != j;
            unlike += deep[deep_ones++].bounds != bounds[e];
        }
        if (++j == n) j = ++i + 1;
    }
    CHECK(wrong == 0);
    CHECK(unlike == 0);
    CHECK((met == of_scene.size() && deep_ones == deep.size()));
    CHECK((deep_ones > 3 && met > deep_ones && met < list.size()));
}

}  // namespace abut::test
