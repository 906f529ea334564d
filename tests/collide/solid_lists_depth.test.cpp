// SPDX-License-Identifier: MIT
//
// Patches, depths and distances of solids in lists and scenes: bricks, of which they are known, and what two alone are told of.

#include <abut/collide/contact_patches.hpp>
#include <abut/collide/hausdorff.hpp>
#include <abut/collide/penetration.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "collide/patch_cases.hpp"
#include "collide/solid_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

namespace {

using brick_tree = decltype(make_bvh(serial{}, mesh<double>()));

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
int overlap_along(const brick& a, const brick& b, std::size_t axis) { return std::min(a.to[axis], b.to[axis]) - std::max(a.from[axis], b.from[axis]); }
/// The least move that separates two whose interiors meet; else 0.
int depth_of(const brick& a, const brick& b) {
    int least = 99;
    for (std::size_t k = 0; k < 3; ++k) {
        if (overlap_along(a, b, k) <= 0) return 0;
        least = std::min({least, a.to[k] - b.from[k], b.to[k] - a.from[k]});
    }
    return least;
}

struct brick_scene {
    std::vector<brick> bricks;
    std::vector<posed_object<brick_tree>> bodies;
    template <class Policy>
    brick_scene(const Policy& on, std::uint64_t k, int n) {
        draws d(20271202, 1, k);
        for (int i = 0; i < n; ++i) {
            brick b{};
            for (std::size_t c = 0; c < 3; ++c) {
                b.from[c] = d.below(5);
                b.to[c] = b.from[c] + 1 + d.below(3);
            }
            bricks.push_back(b);
            bodies.push_back(posed(make_bvh(on, surface_of<double>(b.units(), {}, d)), rigid<double>{}));
        }
    }
};

template <class Policy>
void check_patches_and_depths(const Policy& on) {
    const brick_scene scene(on, 1, 9);
    const auto n = static_cast<std::uint32_t>(scene.bricks.size());
    std::vector<posed_pair<brick_tree>> list;
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
        unlike += !are_same(patches[e], contact_patches(serial{}, list[e].a, list[e].b));
        if (touch) {
            REQUIRE(met < of_scene.size());
            const auto& [a, b, some] = of_scene[met++];
            wrong += a != i || b != j;
            unlike += !are_same(some, contact_patches(serial{}, list[e].a, list[e].b, {.most_points = 4}));
        }
        wrong += bounds[e].overlap != (depth[e] > 0) || bounds[e].least > depth[e] || bounds[e].most < depth[e];
        unlike += bounds[e] != penetration(serial{}, list[e].a, list[e].b, {.tolerance = 0.125});
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

}  // namespace

TEST_CASE("solids in lists and scenes: patches and depths of bricks") {
    check_patches_and_depths(serial{});
    check_patches_and_depths(openmp{.threads = 3});
}

TEST_CASE("solids in lists and scenes: how far surfaces are apart, and what is wrong") {
    const serial on;
    draws d(20271202, 2, 0);
    const auto cube = make_bvh(on, surface_of<double>(brick{{0, 0, 0}, {1, 1, 1}}.units(), {}, d));
    std::vector<posed_pair<brick_tree>> list;
    for (int by = 1; by < 4; ++by) {
        rigid<double> there;
        there.translation = {static_cast<double>(by), 0, 0};
        list.push_back({posed(cube, rigid<double>{}), posed(cube, there)});
    }
    const auto far = hausdorff(on, list, {.tolerance = 0.01});
    REQUIRE(far.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const double truth = static_cast<double>(i) + 1;
        CHECK((far[i].lower() <= truth && truth <= far[i].upper() && far[i].upper() - far[i].lower() <= 0.01));
        CHECK(far[i].lower() == hausdorff(on, list[i].a, list[i].b, {.tolerance = 0.01}).lower());
    }
    CHECK_THROWS_AS(hausdorff(on, list, {.tolerance = -1}), error);
    CHECK_THROWS_AS(penetration(on, list, {.tolerance = -1}), error);
    CHECK_THROWS_AS(contact_patches(on, list, {.most_points = 3}), invalid_geometry);
    const auto open = make_bvh(on, mesh<double>({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}));
    list[1].b = posed(open, rigid<double>{});
    CHECK_THROWS_WITH(contact_patches(on, list), Catch::Matchers::StartsWith("abut::contact_patches: entry 1, face"));
    CHECK_THROWS_WITH(penetration(on, list), Catch::Matchers::StartsWith("abut::penetration: entry 1, face"));
}

}  // namespace abut::test
