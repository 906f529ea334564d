// SPDX-License-Identifier: MIT
#include <abut/abut.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "collide/hull_cases.hpp"
#include "support/catch.hpp"

namespace {

using namespace abut;

static_assert(shape_set<hulls<float>> && shape_view<hulls_view<double>> && placeable<hull<float>>);

const std::vector<vec3<float>> two_tetrahedra{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                              {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};

}  // namespace

TEST_CASE("hulls: queries, serial") { test::check_hulls<float>(serial{}); }
TEST_CASE("hulls: queries, openmp") { test::check_hulls<double>(openmp{3}); }
TEST_CASE("hulls: more queries, serial") { test::check_more_of_hulls<double>(serial{}); }
TEST_CASE("hulls: more queries, openmp") { test::check_more_of_hulls<float>(openmp{3}); }

TEST_CASE("hulls: scenes, serial") { test::check_scenes_of_hulls<float>(serial{}); }
TEST_CASE("hulls: scenes, openmp") { test::check_scenes_of_hulls<double>(openmp{3}); }

TEST_CASE("hulls: with cylinders and cones") {
    test::check_hulls_and_solids<cylinder<float>>(serial{});
    test::check_hulls_and_solids<cylinder<double>>(openmp{3});
    test::check_hulls_and_solids<cone<double>>(serial{});
    test::check_hulls_and_solids<cone<float>>(openmp{3});
}

TEST_CASE("hulls: against one shape, themselves, lists, and bodies") {
    const hulls<float> set(two_tetrahedra, std::vector<std::uint32_t>{0, 4, 8});
    CHECK(to_host(pairs(serial{}, set, vec3<float>{5.25f, 0.25f, 0.5f})) == std::vector<index_pair>{{1, 0}});
    CHECK(count(serial{}, set, aabb<float>{{-1, -1, -1}, {7, 7, 7}}) == 2);
    CHECK(any(serial{}, hull<float>(two_tetrahedra.data(), 4), set));
    CHECK(count(serial{}, segment<float>{{0.25f, 0.25f, 0.25f}, {9, 0.25f, 0.25f}}, set) == 2);
    const std::vector<std::vector<vec3<float>>> lists{{{0, 0, 0}, {1, 0, 0}}, {{0.5f, -1, 0}, {0.5f, 1, 0}}, {{9, 9, 9}}};
    const hulls<float> rods(lists);
    CHECK(to_host(self_pairs(serial{}, rods)) == std::vector<index_pair>{{0, 1}});
    const auto tree = make_bvh(serial{}, set);
    const rigid<float> here, there{.translation = {0.5f, 0, 0}};
    const auto bodies = make_bodies(serial{}, std::vector{posed(tree, here), posed(tree, there)});
    CHECK(count(serial{}, bodies) == 2);
    const auto how = to_host(contacts(serial{}, bodies));
    REQUIRE(how.size() == 2);
    // Half of the side of a tetrahedron, out of the long face of the other one.
    CHECK(std::abs(how[0].depth - 0.5f / std::sqrt(3.0f)) < 1e-6f);
    std::size_t visited = 0;
    for_each_pair(serial{}, set, rods, [&visited](const index_pair&) {
        ++visited;
        return visit::proceed;
    });
    CHECK(visited == 2);
}

TEST_CASE("hulls: other libraries' arrays, views and copies") {
    const std::vector<float> numbers{0, 0, 0, 1, 0, 0, 9, 9, 9};
    const std::vector<long long> offsets{0, 2, 3};
    const hulls<float> set(numbers, offsets);
    REQUIRE(set.size() == 2);
    CHECK(set.view()[0].count == 2);
    CHECK(set.view()[1][0] == vec3<float>{9, 9, 9});
    struct row {
        vec3<float> p;
        float other;
    };
    const std::vector<row> rows{{{0, 0, 0}, 7}, {{1, 0, 0}, 7}, {{9, 9, 9}, 7}};
    const std::vector<std::uint32_t> from{0, 2, 3};
    const hulls_view<float> view(&rows[0].p, 3, from.data(), 2, sizeof(row));
    CHECK(to_host(pairs(serial{}, view, set)) == std::vector<index_pair>{{0, 0}, {1, 1}});
    const hulls<float> copy = copy_to(serial{}, view);
    CHECK(to_host(pairs(serial{}, copy, set)) == std::vector<index_pair>{{0, 0}, {1, 1}});
    CHECK(hulls<float>().size() == 0);
    CHECK(count(serial{}, hulls<float>(), set) == 0);
    CHECK(hulls<float>(std::vector<vec3<float>>{}, std::vector<std::uint32_t>{0}).size() == 0);
}

TEST_CASE("hulls: what is no set of hulls is refused") {
    using offsets = std::vector<std::uint32_t>;
    const auto refused = [](const std::vector<vec3<float>>& points, const offsets& from) -> std::string {
        try {
            (void)hulls<float>(points, from);
        } catch (const error& e) {
            return e.what();
        }
        return "accepted";
    };
    constexpr float infinite = std::numeric_limits<float>::infinity();
    CHECK(refused({{0, 0, 0}, {0, infinite, 0}}, {0, 2}) == "abut::hulls: hull 0: point 1: y is not finite (inf)");
    CHECK(refused({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 0, infinite}, {0, 3, 0}}, {0, 1, 3, 5}) ==
          "abut::hulls: hull 2: point 3: z is not finite (inf)");
    try {
        (void)hulls<float>(std::vector<vec3<float>>{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {infinite, 3, 0}}, offsets{0, 3, 4});
        FAIL_CHECK("accepted");
    } catch (const invalid_geometry& e) {
        CHECK(e.index() == 1);
    }
    CHECK(refused({{0, 0, 0}}, {0, 1, 1}) ==
          "abut::hulls: hull 1: it has no point: the next one begins at the same offset (1)");
    CHECK(refused({{0, 0, 0}, {0, 0, 0}}, {0, 2, 1, 2}) ==
          "abut::hulls: hull 1: the next one begins before it does, at 1 (2)");
    CHECK(refused({{0, 0, 0}}, {1, 1}) == "abut::hulls: offset 0: the first one has to be 0 (1)");
    CHECK(refused({{0, 0, 0}, {0, 0, 0}}, {0, 1}) ==
          "abut::hulls: offset 1: the last one has to be the number of points, which is 2 (1)");
    CHECK(refused({{0, 0, 0}}, {}) ==
          "abut::hulls: 1 points and no offset; expected one for each hull, and the number of points");
    CHECK_THROWS_WITH(hulls<float>(std::vector<vec3<float>>{{0, 0, 0}}, std::vector<int>{0, -1, 1}),
                      "abut::hulls: offset 1: out of range, there are 1 points (-1)");
    CHECK_THROWS_AS(any(serial{}, hulls<float>(), hull<float>()), invalid_geometry);
    // A pose that takes a point to infinity.
    const hulls<float> far_out(std::vector<vec3<float>>{{3e38f, 0, 0}, {0, 0, 0}}, offsets{0, 2});
    const rigid<float> further{.translation = {3e38f, 0, 0}};
    CHECK_THROWS_WITH(any(serial{}, posed(far_out, further), far_out), "abut::any: posed hull 0: point 0: x is not finite (inf)");
}
