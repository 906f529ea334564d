// SPDX-License-Identifier: MIT
#include <abut/collide/self_pairs.hpp>
#include <abut/experimental/breadth_first.hpp>

#include "collide/self_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("pairs within a set: serial and openmp", "", float, double) {
    check_all_self<TestType>(serial{});
    check_all_self<TestType>(openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("pairs within a set of other shapes", "", float, double) {
    check_self_shapes<TestType>(serial{});
    check_self_shapes<TestType>(openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("welded: one vertex for each place", "", float, double) {
    check_all_welded<TestType>(serial{});
    check_all_welded<TestType>(openmp{.threads = 3});
}

TEST_CASE("pairs within a set: what is refused") {
    const std::vector<vec3<float>> vertices{{0, 0, 0}, {1, 0, 0}};
    const std::vector<face> faces{{0, 1, 2}};
    CHECK_THROWS_AS(self_pairs(serial{}, mesh_view<float>(vertices.data(), 2, faces.data(), 1)), invalid_geometry);
    CHECK_THROWS_AS(welded(serial{}, mesh_view<float>(vertices.data(), 2, faces.data(), 1)), invalid_geometry);
    const self_options<keep_all, traversal::breadth_first> too_deep{.start_depth = most_start_depth + 1};
    CHECK_THROWS_AS(self_pairs(serial{}, triangle_soup<float>(), too_deep), error);
}

}  // namespace abut::test
