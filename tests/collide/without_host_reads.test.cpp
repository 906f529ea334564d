// SPDX-License-Identifier: MIT

// Queries whose memory the host may not read, as on a device: what reads it where it must not ends here, and needs no device
// to be found.

#include <cmath>
#include <vector>

#include <abut/abut.hpp>

#include "collide/contact_cases.hpp"
#include "collide/hull_cases.hpp"
#include "collide/set_cases.hpp"
#include "support/catch.hpp"
#include "support/fenced.hpp"
#include "support/scenes.hpp"

using namespace abut;

static_assert(execution_policy<test::fenced>);

TEST_CASE("queries: memory that only loops may read") {
    const test::fenced on;
    test::uniform random(20261125);
    const triangle_soup<float> soup(test::random_triangles<float>(150, random));
    const auto there = copy_to(on, soup);
    const auto tree = make_bvh(on, there);
    const auto expected = test::all_that_touch(soup.view(), soup.view());
    CHECK(to_host(pairs(on, tree, there)) == expected);
    CHECK(to_host(pairs(on, tree, tree)) == expected);
    CHECK(to_host(pairs<exact>(on, make_grid(on, there), soup)) == expected);
    CHECK(count(on, there, there) == expected.size());
    CHECK(any(on, tree, there));
    CHECK(to_host(self_pairs(on, tree)) == to_host(self_pairs(serial{}, soup)));

    rigid<float> pose;
    pose.translation = {0.25f, -0.125f, 0.5f};
    const spheres<float> balls(test::shape_maker<sphere<float>>(random, false)(60));
    CHECK(test::check_contacts(on, test::dense_triangles<float>(40, random), rigid<float>{}, balls, pose) > 10);
}

// Coordinates that are too far apart for integers in registers: the host decides, and fetches the shapes.
TEST_CASE("queries: memory that only loops may read, and the host resolves") {
    const test::fenced on;
    test::uniform random(20261126);
    std::vector<triangle<double>> triangles;
    for (int i = 0; i < 60; ++i) {
        const auto corner = [&] {
            const auto number = [&] { return std::ldexp(random(-1, 1), static_cast<int>(random(-120, 120))); };
            return vec3<double>{number(), number(), number()};
        };
        triangles.push_back({corner(), corner(), corner()});
    }
    const triangle_soup<double> soup(triangles);
    const auto expected = test::all_that_touch(soup.view(), soup.view());
    CHECK(expected.size() > 100);
    CHECK(to_host(pairs(on, make_bvh(on, copy_to(on, soup)), soup)) == expected);

    // Hulls refer to points, which it fetches too.
    std::vector<vec3<double>> points;
    std::vector<std::uint32_t> offsets(1, 0);
    for (std::size_t i = 0; i + 1 < triangles.size(); i += 2) {
        const triangle<double>&s = triangles[i], &t = triangles[i + 1];
        points.insert(points.end(), {s.a, s.b, s.c, t.a, t.b, t.c});
        offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    const hulls<double> solids(points, offsets);
    const auto there = copy_to(on, solids);
    CHECK(to_host(pairs(on, make_bvh(on, there), soup)) == test::all_that_touch(solids.view(), soup.view()));
    rigid<double> pose;
    pose.translation = {1, 0, 0};
    const posed_view<hulls<double>::view_type> placed{solids.view(), pose};
    CHECK(to_host(pairs(on, there, posed(there, pose))) == test::all_that_touch(solids.view(), placed));
}

TEST_CASE("queries: hulls in memory that only loops may read") { test::check_hulls<float>(test::fenced{}); }
