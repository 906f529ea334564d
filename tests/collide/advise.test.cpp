// SPDX-License-Identifier: MIT
#include <abut/collide/advise.hpp>

#include "collide/advise_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEST_CASE("advise: serial") { test::check_all_advice(serial{}); }
TEST_CASE("advise: openmp") { test::check_all_advice(openmp{.threads = 3}); }

TEST_CASE("advise: a mesh, its index, and a view") {
    const mesh<float> box{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const advice said = advise(serial{}, box);
    CHECK(said.fast_is_exact);
    CHECK(said.grid_exponent == 2);
    CHECK(said.grid_extent == 1);
    CHECK(advise(serial{}, make_bvh(serial{}, box), box.view()).fast_is_exact);
}
