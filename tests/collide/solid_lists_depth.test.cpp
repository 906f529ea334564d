// SPDX-License-Identifier: MIT
//
// Patches, depths and distances of solids in lists and scenes: bricks, of which they are known, and what two alone are told of.

#include <abut/collide/contact_patches.hpp>
#include <abut/collide/hausdorff.hpp>
#include <abut/collide/penetration.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

#include <abut/abut.hpp>

#include "collide/solid_list_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("solids in lists and scenes: patches and depths of bricks") {
    check_patches_and_depths(serial{});
    check_patches_and_depths(openmp{.threads = 3});
}

TEST_CASE("solids in lists and scenes: how far surfaces are apart, and what is wrong") {
    const serial on;
    draws d(20271202, 2, 0);
    const auto cube = make_bvh(on, surface_of<double>(brick{{0, 0, 0}, {1, 1, 1}}.units(), {}, d));
    std::vector<posed_pair<brick_tree<serial>>> list;
    for (int by = 1; by < 4; ++by) {
        rigid<double> there;
        there.translation = {static_cast<double>(by), 0, 0};
        list.push_back({posed(cube, rigid<double>{}), posed(cube, there)});
    }
    const auto far = hausdorff(on, list, {.tolerance = 0.01});
    REQUIRE(far.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const double truth = static_cast<double>(i) + 1;
        CHECK((far[i].lower() <= truth && truth <= far[i].upper() && far[i].upper() - far[i].lower() <= 0.01));
        CHECK(far[i].lower() == hausdorff(on, list[i].a, list[i].b, {.tolerance = 0.01}).lower());
    }
    // Surfaces that bound no solid.
    const auto soup = make_bvh(on, triangle_soup<double>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
    using soup_tree = std::remove_const_t<decltype(soup)>;
    const auto of_soup = hausdorff(on, std::vector<posed_pair<soup_tree, brick_tree<serial>>>{{posed(soup, rigid<double>{}), list[1].b}}, {.tolerance = 0.01});
    const auto alone = hausdorff(on, soup, list[1].b, {.tolerance = 0.01});
    CHECK((of_soup[0].a_from_b == alone.a_from_b && of_soup[0].b_from_a == alone.b_from_a && alone.lower() > 2));
    CHECK_THROWS_AS(hausdorff(on, list, {.tolerance = -1}), error);
    CHECK_THROWS_AS(penetration(on, list, {.tolerance = -1}), error);
    CHECK_THROWS_AS(contact_patches(on, list, {.most_points = 3}), invalid_geometry);
    const auto open = make_bvh(on, mesh<double>({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}));
    list[1].b = posed(open, rigid<double>{});
    CHECK_THROWS_WITH(contact_patches(on, list), Catch::Matchers::StartsWith("abut::contact_patches: entry 1, face"));
    CHECK_THROWS_WITH(penetration(on, list), Catch::Matchers::StartsWith("abut::penetration: entry 1, face"));
}

}  // namespace abut::test
