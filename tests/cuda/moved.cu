// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/moved_cases.hpp"
#include "support/catch.hpp"

TEST_CASE("sets and indices that go: cuda") {
    const abut::cuda on;
    abut::test::uniform random(211);
    const abut::test::moved_scene<float> a(random, 40, {0, 0, 0}, true), b(random, 33, {4, -3, 5}, true);
    abut::test::check_moved_sets<false>(on, abut::spheres<float>(a.balls), abut::triangle_soup<float>(b.triangles),
                                        abut::vec3<float>{4, -3, 5});
}

TEST_CASE("contacts at the start of a sweep: cuda") { abut::test::check_start_contacts(abut::cuda{}); }
