// SPDX-License-Identifier: MIT
#include <abut/experimental/pair_rules.hpp>

#include "collide/pair_rule_cases.hpp"

#include <cstddef>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/ccd_scene.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("pair rules: serial and openmp", "", float, double) {
    check_all_rules<TestType>(serial{});
    check_all_rules<TestType>(openmp{.threads = 3});
}

// Vertices of no face look for faces, where the other rule has a tree of vertices: boxes that are as far apart as the
// separation, but for rounding, have to be near by both or by neither.
TEMPLATE_TEST_CASE("pair rules: boxes at the distance that is asked for", "", float, double) {
    using T = TestType;
    const serial on;
    uniform random(20270305);
    const impact_options options{.bounds = {.tolerance = 0.01, .separation = 0.1}};
    std::size_t found = 0;
    for (int k = 0; k < 200; ++k) {
        const auto tenth = [&] { return static_cast<T>(random.below(8)) * static_cast<T>(0.1); };
        std::vector<vec3<T>> t0(12), t1(12);
        for (auto* const all : {&t0, &t1}) {
            for (vec3<T>& p : *all) p = {tenth(), tenth(), tenth()};
        }
        const mesh<T> first(t0, {{0, 1, 2}, {3, 4, 5}});
        const auto step = moving(first, first.with_vertices(on, t1));
        const auto expected = to_host(self_impacts<conservative>(on, step, options));
        const auto same = [&](const auto& index) {
            return to_host(self_impacts<conservative>(on, index, options)) == expected;
        };
        CAPTURE(k);
        CHECK(same(make_impact_index<pair_rule::representative_triangles>(on, step)));
        CHECK(same(make_impact_index<pair_rule::orphan_sets>(on, step)));
        found += expected.size();
    }
    CHECK(found > 1000);
}

TEST_CASE("pair rules: orphans of known meshes") {
    const auto count = [](const topology& of) {
        uniform random(20270304);
        const auto index = make_impact_index<pair_rule::orphan_sets>(serial{}, drawn_step<double>(of, random));
        const truth_of_pairs found = orphans_of(index);
        return std::pair(found.vertex_face.size(), found.edge_edge.size());
    };
    const topology tetrahedron{"tetrahedron", 4, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    CHECK(count(tetrahedron) ==
          std::pair<std::size_t, std::size_t>(4, 3));  // each vertex and the opposite face, opposite edges
    // All pairs without a common vertex: each of the n + 1 vertices of the rim with n - 1 or n - 2 faces; spokes with the
    // rim's edges, and those with each other.
    const std::size_t n = 9;
    CHECK(count(fan(n, false)).first == 2 * (n - 1) + (n - 1) * (n - 2));
    CHECK(count(fan(n, false)).second == 2 * (n - 1) + (n - 1) * (n - 2) + (n - 1) * (n - 2) / 2);
    CHECK(count({"two faces", 6, {{0, 1, 2}, {3, 4, 5}}}) == std::pair<std::size_t, std::size_t>(0, 0));
    CHECK(count({"vertices alone", 6, {}}) == std::pair<std::size_t, std::size_t>(0, 0));
}

TEST_CASE("pair rules: scenes of simulations") {
    const char* const names[] = {"cloth-funnel", "cloth-ball", "armadillo-rollers"};
    for (const char* const name : names) {
        if (!ccd_folder(name)) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    }
    for (const char* const name : names) {
        const ccd_scene scene = read_ccd_scene(*ccd_folder(name));
        const std::vector<face> faces(scene.faces.begin(), scene.faces.end());
        const mesh<double> first(scene.t0, faces);
        const auto step = moving(first, first.with_vertices(serial{}, scene.t1));
        const openmp on{.threads = 2};
        const auto expected = to_host(self_impacts(on, step));
        const auto orphans = make_impact_index<pair_rule::orphan_sets>(on, step);
        CHECK(to_host(self_impacts(on, make_impact_index<pair_rule::representative_triangles>(on, step))) == expected);
        CHECK(to_host(self_impacts(on, orphans)) == expected);
        std::printf("pair rules, %s: %zu impacts, %zu orphans of %zu faces\n", name, expected.size(),
                    orphans.orphans().keys.size(), faces.size());
        CHECK(expected.size() > 100);
    }
}

}  // namespace abut::test
