// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/inside_cases.hpp"
#include "collide/raycast_cases.hpp"
#include "collide/winding_cases.hpp"
#include "out_of_memory.hpp"
#include "support/catch.hpp"

TEST_CASE("raycast: cuda") {
    const abut::cuda on;
    abut::test::check_raycast<float>(on);
    abut::test::check_raycast<double>(on);
    abut::test::check_near_times<float>(on);
    abut::test::check_near_times<double>(on);
    abut::test::check_watertight<float>(on);
    abut::test::check_watertight<double>(on);
    abut::test::check_raycast_scales<float>(on);
    abut::test::check_raycast_scales<double>(on);
}

TEST_CASE("inside: cuda") {
    const abut::cuda on;
    abut::test::check_inside<float>(on);
    abut::test::check_inside<double>(on, 1);
}

TEST_CASE("winding number: cuda") {
    const abut::cuda on;
    abut::test::check_winding<float>(on);
    abut::test::check_winding_bits<double>(on);
}

TEST_CASE("raycast: out of memory, cuda") {
    const abut::cuda on;
    const abut::test::torus<float> ring(512, 256, 2, 0.5f);
    const abut::mesh<float> mesh(ring.vertices, ring.faces);
    std::vector<abut::ray<float>> rays;
    for (const auto& v : ring.vertices) rays.push_back({{v.x, v.y, 2}, {0, 0, -1}});
    abut::test::check_out_of_device_memory("raycast", on, [&] {
        std::uint64_t sum = 0;
        for (const auto& hit : to_host(raycast(on, make_bvh(on, mesh), abut::rays<float>(rays)))) sum += hit.id;
        return sum;
    });
}
