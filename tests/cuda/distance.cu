// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/distance_cases.hpp"
#include "collide/within_cases.hpp"
#include "out_of_memory.hpp"
#include "support/catch.hpp"

TEST_CASE("distance: cuda") {
    const abut::cuda on;
    abut::test::check_distance_of_meshes<float>(on);
    abut::test::check_distance_below<float>(on);
    abut::test::check_distance_of_lists<float>(on);
}

TEST_CASE("distance: a scene of many triangles, cuda and serial say the same") {
    const abut::cuda on;
    const abut::serial host;
    const abut::test::torus<float> ring(256, 128, 2, 0.5f);
    const abut::mesh<float> mesh(ring.vertices, ring.faces);
    const auto tree = make_bvh(host, mesh);
    const auto there = make_bvh(on, copy_to(on, mesh));
    for (const float away : {5.0f, 5.5f, 9.0f, 4.9f}) {
        const abut::rigid<float> pose{{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {away, 0.25f, 0.125f}};
        abut::test::check_same(distance(on, there, posed(there, pose)), distance(host, tree, posed(tree, pose)));
    }
}

TEST_CASE("within: cuda") {
    const abut::cuda on;
    abut::test::check_within_of<abut::vec3<float>, abut::triangle<float>>(on, 151);
    abut::test::check_within_of_meshes<float>(on);
    abut::test::check_within_by_hand(on);
}

TEST_CASE("within: a scene of many triangles and its vertices, cuda and serial say the same") {
    const abut::cuda on;
    const abut::serial host;
    const abut::test::torus<float> ring(128, 64, 2, 0.5f);
    const abut::mesh<float> mesh(ring.vertices, ring.faces);
    const abut::points<float> cloud(ring.vertices);
    const auto tree = make_bvh(host, mesh);
    const auto there = make_bvh(on, copy_to(on, mesh));
    const abut::rigid<float> pose{{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {4.9f, 0.25f, 0.125f}};
    for (const double distance : {0.0, 0.01, 0.2}) {
        const auto expected = to_host(within(host, tree, posed(tree, pose), distance));
        CHECK(to_host(within(on, there, posed(there, pose), distance)) == expected);
        CHECK(to_host(self_within(on, make_bvh(on, copy_to(on, cloud)), distance)) ==
              to_host(self_within(host, make_bvh(host, cloud), distance)));
        if (distance > 0.1) CHECK(expected.size() > 1000);
    }
}

TEST_CASE("distance and within: out of memory, cuda") {
    const abut::cuda on;
    const abut::test::torus<float> ring(512, 256, 2, 0.5f);
    const abut::mesh<float> mesh(ring.vertices, ring.faces);
    const abut::rigid<float> aside{{0.6f, -0.8f, 0, 0.8f, 0.6f, 0, 0, 0, 1}, {5.5f, 0.25f, 0.125f}};
    abut::test::check_out_of_device_memory("distance and within", on, [&] {
        const auto tree = make_bvh(on, mesh);
        const auto apart = distance(on, tree, posed(tree, aside));
        return count_within(on, tree, posed(tree, aside), 1.25 * apart->distance);
    });
}
