// SPDX-License-Identifier: MIT
#include <abut/index/quality.hpp>

#include <cstddef>
#include <utility>
#include <vector>

#include <abut/index/lbvh.hpp>
#include <abut/index/refit.hpp>

#include "support/catch.hpp"

using namespace abut;

TEST_CASE("quality: of trees that can be counted by hand") {
    const auto quality_of = [](const std::vector<triangle<float>>& triangles) {
        return quality(serial{}, make_bvh(serial{}, triangle_soup<float>(triangles)));
    };
    const auto none = quality_of({});
    CHECK(none.shapes == 0);
    CHECK(none.sah_cost == 0);
    CHECK(none.bytes_per_shape == 0);
    // Boxes of side 1, 1 and 2 in a row: half surfaces of 3 and 5 for one and two of them.
    const auto cube = [](float x) { return triangle<float>{{x, 0, 0}, {x + 1, 1, 0}, {x, 0, 1}}; };
    const auto one = quality_of({cube(0)});
    CHECK(one.shapes == 1);
    CHECK(one.sah_cost == 1);
    CHECK(one.greatest_depth == 0);
    CHECK(one.mean_depth == 0);
    CHECK(one.overlap == 0);
    CHECK(one.bytes_per_shape == sizeof(bvh_root<float>));
    const auto two = quality_of({cube(0), cube(1)});
    CHECK(two.sah_cost == Approx(1 + 3 / 5.0 + 3 / 5.0));
    CHECK(two.greatest_depth == 1);
    CHECK(two.mean_depth == 1);
    CHECK(two.overlap == Approx(1 / 5.0));  // they share a face
    const auto three = quality_of({cube(0), cube(1), cube(7)});
    CHECK(three.sah_cost == Approx(1 + (5 + 3 + 3 + 3) / 17.0));
    CHECK(three.mean_depth == Approx(5 / 3.0));
    CHECK(three.overlap == Approx(1 / (17.0 + 5)));
    // In one place, and without a surface.
    CHECK(quality_of({cube(0), cube(0), cube(0), cube(0)}).overlap == 1);
    CHECK(quality_of({cube(0), cube(0), cube(0), cube(0)}).sah_cost == 7);
    const triangle<float> point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    CHECK(quality_of({point, point, point}).sah_cost == 5);
    const auto at = [](float x) { return triangle<float>{{x, 1, 1}, {x, 1, 1}, {x, 1, 1}}; };
    CHECK(quality_of({at(1), at(2), at(3)}).overlap == 0);
    // Numbers whose squares are none.
    for (const double scale : {0x1p-1060, 0x1p-600, 0x1p-100, 0x1p100, 0x1p600, 0x1p1022}) {
        CAPTURE(scale);
        const auto scaled = [&](double x) {
            return triangle<double>{{x * scale, 0, 0}, {(x + 1) * scale, scale, 0}, {x * scale, 0, scale}};
        };
        CHECK(quality(make_bvh(serial{}, triangle_soup<double>({scaled(0), scaled(1)}))).sah_cost == Approx(2.2));
    }
}

TEST_CASE("needs_rebuild: where shapes have changed places, and not where they have moved a little") {
    const serial on;
    constexpr std::size_t side = 32;
    const auto row = [](float scale, float jitter) {
        std::vector<sphere<float>> made;
        for (std::size_t i = 0; i < side * side; ++i) {
            const auto x = static_cast<float>(i % side), y = static_cast<float>(i / side);
            made.push_back({{scale * (x + jitter * y / side), scale * y, 0}, 0.4f * scale});
        }
        return made;
    };
    const auto shuffled = [](std::vector<sphere<float>> made) {
        for (std::size_t i = 0; i < made.size(); ++i) std::swap(made[i], made[(i * 7919 + 13) % made.size()]);
        return made;
    };
    const auto tree = make_bvh(on, spheres<float>(row(1, 0)));
    const auto when_built = quality(tree);
    CHECK(when_built.surface == Approx(when_built.sah_cost * 2 * (31.8 * 31.8 + 2 * 31.8 * 0.8)));
    const auto after = [&](const std::vector<sphere<float>>& now) { return quality(refit(on, tree, spheres<float>(now))); };
    CHECK_FALSE(needs_rebuild(when_built, when_built));
    CHECK_FALSE(needs_rebuild(when_built, after(row(1, 0.5f))));
    CHECK(needs_rebuild(when_built, after(shuffled(row(1, 0)))));
    CHECK(needs_rebuild(when_built, after(shuffled(row(0.01f, 0)))));
    // One shape far away makes the root so large that beside it all other boxes are small.
    auto far = shuffled(row(1, 0));
    far[0].center.z = 1e4f;
    const auto now = after(far);
    CHECK(now.sah_cost < when_built.sah_cost);
    CHECK(needs_rebuild(when_built, now));
    CHECK(needs_rebuild(when_built, after(row(1, 0.5f)), 1.0));
    const auto again = quality(make_bvh(on, spheres<float>(shuffled(row(1, 0)))));
    CHECK_FALSE(needs_rebuild(when_built, again));
}
