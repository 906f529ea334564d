// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include <limits>
#include <vector>

#include "../../docs/examples/cylinder.hpp"
#include "collide/advise_cases.hpp"
#include "collide/nearest_cases.hpp"
#include "collide/set_cases.hpp"
#include "shape/feature_cases.hpp"
#include "support/catch.hpp"
#include "support/pair_orders.hpp"

static_assert(abut::test::pairs_have_their_orders<float> && abut::test::pairs_have_their_orders<double>);

TEST_CASE("nearest: cuda") {
    abut::test::check_all_nearest<float>(abut::cuda{});
    abut::test::check_nearest_to_mesh<double>(abut::cuda{});
    abut::test::check_nearest_scales<double>(abut::cuda{});
}

TEST_CASE("advise: cuda") {
    abut::test::check_advice_of_floats(abut::cuda{});
    abut::test::check_same_advice<float>(abut::cuda{});
    abut::test::check_same_advice<double>(abut::cuda{});
}

TEST_CASE("queries: trees of oriented boxes, cuda") {
    using namespace abut;
    test::uniform random(65);
    const abut::cuda on;
    const triangle_soup<float> here(test::random_triangles<float>(500, random)),
        there(test::random_triangles<float>(400, random));
    const auto a = make_bvh(on, here), b = make_bvh(on, there);
    const auto expected = count(on, a, b);
    CHECK(expected > 0);
    CHECK(count(on, oriented(on, a), oriented(on, b)) == expected);
}

TEST_CASE("queries: sets of other shapes, cuda") {
    using namespace abut;
    test::check_pair_of_shapes<sphere<float>, sphere<float>>(abut::cuda{}, 61);
    test::check_pair_of_shapes<vec3<float>, triangle<float>>(abut::cuda{}, 62);
    test::check_pair_of_shapes<capsule<double>, triangle<double>>(abut::cuda{}, 63);
    test::check_pair_of_shapes<cylinder<float>, triangle<float>>(abut::cuda{}, 66);
}

TEST_CASE("queries: a caller's own shape, cuda") {
    using namespace abut;
    test::uniform random(64);
    std::vector<plant::cylinder<float>> cylinders;
    for (int i = 0; i < 200; ++i) cylinders.push_back({random.point<float>(-1, 1), 0.2f, 0.5f});
    const triangle_soup<float> soup(test::random_triangles<float>(300, random));
    CHECK(test::check_sets_of(abut::cuda{}, shapes<plant::cylinder<float>>(cylinders), soup) > 100);
}

TEST_CASE("sets: of shapes in motion, on the host in a .cu file") {
    using namespace abut;
    const vec3<float> o{0, 0, 0}, bad{0, 0, std::numeric_limits<float>::infinity()};
    CHECK_THROWS_WITH(shapes(std::vector<motion<vec3<float>>>{{o, bad}}),
                      "abut::moving: at t = 1: point 0: z is not finite (inf)");
    CHECK_THROWS_WITH(shapes(std::vector<motion<vec3<float>>>{{bad, o}}),
                      "abut::moving: at t = 0: point 0: z is not finite (inf)");
}

TEMPLATE_TEST_CASE("features: cuda", "", float, double) {
    abut::test::check_all_features<TestType>(abut::cuda{}, 20);
    abut::test::check_features_in_queries<TestType>(abut::cuda{});
}
