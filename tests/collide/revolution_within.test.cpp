// SPDX-License-Identifier: MIT
#include <abut/collide/within.hpp>

#include <vector>


#include "collide/within_cases.hpp"

// Queries of cylinders and cones within a distance of shapes with edges and of each other, against all pairs one by one.
// Whether those are decided rightly is for tests/predicate.

using namespace abut;

TEST_CASE("within: cylinders and cones, with segments, capsules, triangles and boxes") {
    const openmp on{.threads = 3};
    std::printf("within, cylinders and cones: seeds 321 to 328\n");
    test::check_within_of<cylinder<float>, segment<float>>(on, 321);
    test::check_within_of<triangle<double>, cylinder<double>>(serial{}, 322);
    test::check_within_of<cone<float>, triangle<float>>(on, 323);
    test::check_within_of<capsule<double>, cone<double>>(serial{}, 324);
    test::check_within_of<cylinder<float>, aabb<float>>(on, 325);
    test::check_posed_within_of<cylinder<float>, capsule<float>>(on, 326);
    test::check_posed_within_of<cone<double>, segment<double>>(serial{}, 327);
}

TEST_CASE("within: cylinders and cones, with each other") {
    const openmp on{.threads = 3};
    test::check_within_of<cylinder<float>, cylinder<float>>(on, 329);
    test::check_within_of<cone<double>, cylinder<double>>(serial{}, 330);
    test::check_within_of<cone<float>, cone<float>>(on, 331);
    test::check_self_within<cylinder<float>>(on, 332);
}

TEST_CASE("within: cylinders and cones, with convex hulls") {
    const openmp on{.threads = 2};
    const cones<float> tips(std::vector<cone<float>>{{{0, 0, 0}, {0, 0, 4}, 3}, {{20, 0, 0}, {20, 0, -4}, 3}});
    const hulls<float> blocks(std::vector<vec3<float>>{{6, -9, 8}, {6, 9, 8}, {9, 0, 12}, {20, 0, 2}, {21, 1, 9}, {19, 1, 9}},
                              std::vector<std::uint32_t>{0, 3, 6});
    const auto both = make_bvh(on, blocks);
    CHECK(to_host(within(on, tips, both, 5)) == std::vector<index_pair>{{0, 0}, {1, 1}});
    CHECK(to_host(within(on, both, make_bvh(on, tips), 0x1.3ffffffffffffp2)) == std::vector<index_pair>{{1, 1}});
    CHECK(count_within(serial{}, tips, blocks, 2) == 1);
    CHECK(count_within(serial{}, tips, blocks, 0x1.fffffffffffffp0) == 0);
}

TEST_CASE("within: rays, with triangles, hulls and cylinders") {
    const openmp on{.threads = 2};
    const rays<float> lines(std::vector<ray<float>>{{{8, -9, 6}, {0, 1, 0}}, {{8, -9, 6}, {0, -1, 0}}, {{0, 0, 9}, {0, 0, -1}}});
    const cylinders<float> drums(std::vector<cylinder<float>>{{{{0, 0, 0}, {0, 0, 2}}, 5}, {{{90, 0, 0}, {90, 0, 2}}, 5}});
    const auto tree = make_bvh(on, drums);
    CHECK(to_host(within(on, lines, tree, 5)) == std::vector<index_pair>{{0, 0}, {2, 0}});
    CHECK(to_host(within(on, tree, lines, 0x1.3ffffffffffffp2)) == std::vector<index_pair>{{0, 2}});
    CHECK(to_host(within(on, lines, tree, 0)) == to_host(pairs(on, lines, tree)));
    const triangle<float> flat{{4, -9, 9}, {4, -4, 9}, {36, 0, -15}};
    for (const double d : {0.5, 2.0, 4.0, 9.0}) {
        CHECK(to_host(within(on, lines, flat, d)) == test::within_by_definition(lines.view(), shapes<triangle<float>>({flat}).view(), d));
    }
}
