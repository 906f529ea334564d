// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/impact_cases.hpp"
#include "collide/safe_step_cases.hpp"
#include "out_of_memory.hpp"
#include "support/catch.hpp"

using abut::test::ways;

TEST_CASE("impacts: cuda, float") {
    abut::test::check_all_impacts<float, ways::conservative_too>(abut::cuda{});
    abut::test::check_small_impacts<float, ways::conservative_too>(abut::cuda{});
    abut::test::check_first_of_many<float>(abut::cuda{});
}

TEST_CASE("impacts: cuda, float, thousands of faces") { abut::test::check_large_impacts<float>(abut::cuda{}); }

TEST_CASE("impacts: cuda, candidates that find no room") { abut::test::check_many_candidates<float>(abut::cuda{}); }

TEST_CASE("impact_details: cuda") { abut::test::check_details<float>(abut::cuda{}); }

TEST_CASE("safe_step, safe_steps: cuda") {
    abut::test::check_safe_step(abut::cuda{}, 10);
    abut::test::check_safe_steps(abut::cuda{}, 10);
}

TEST_CASE("vertices and faces in motion in a query: cuda") {
    for (const auto& c : abut::test::impact_cases<float>()) {
        if (!c.follows) abut::test::check_moving_pairs(abut::cuda{}, c);
    }
}

TEST_CASE("impacts: out of memory, cuda") {
    const abut::cuda on;
    const abut::test::torus<float> ring(512, 256, 2, 0.5f);
    const abut::mesh<float> mesh(ring.vertices, ring.faces);
    auto pushed = ring.vertices;  // one side, through the other wall of the tube
    for (auto& v : pushed) v.x = v.x > 2.25f ? v.x - 1 : v.x;
    abut::test::check_out_of_device_memory("self_impacts", on, [&] {
        return to_host(self_impacts(on, moving(mesh, mesh.with_vertices(abut::serial{}, pushed)))).size();
    });
}
