// SPDX-License-Identifier: MIT
#include <abut/collide/first_sweep.hpp>

#include <string>

#include "collide/moved_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEST_CASE("sets and indices that go: serial") {
    test::check_moved_scenes<float, true>(serial{}, 40);
    test::check_moved_single(serial{});
}

TEST_CASE("sets and indices that go, at the ends of the range") { test::check_moved_scales<float>(serial{}); }

TEST_CASE("sets and indices that go: openmp on 3 threads") { test::check_moved_scenes<float, false>(openmp{3}, 90); }

TEST_CASE("sets and indices that go: a way that is not finite") {
    const spheres<float> balls{{{0, 0, 2}, 1}};
    const float bad = std::numeric_limits<float>::infinity();
    try {
        (void)any(serial{}, moving(balls, vec3<float>{0, bad, 0}), balls);
        FAIL_CHECK("a way without end was taken");
    } catch (const invalid_geometry& e) {
        CHECK(std::string(e.what()) == "abut::any: way 0: y is not finite (inf)");
    }
}
