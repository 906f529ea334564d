// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <cstdint>
#include <vector>

#include "support/catch.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

// Cylinders and cones with convex hulls. revolution_gap.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t hull_seed = 20261128;

template <class Solid>
void check_gaps() {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    gap_tally near, few;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        for (std::uint64_t k = 0; k < some_samples(800); ++k) {
            const auto c = make_revolution_case<T>(hull_seed, f, k, is_cone);
            const Solid s = solid_of<Solid>(c.axis, c.radius);
            std::vector<vec3<T>> corners{c.corner[0], c.corner[1], c.corner[2], c.corner[0] + (c.corner[1] - c.corner[2])};
            const hull<T> small(corners.data(), 1 + k % 4);
            if (is_valid(s) && is_valid(small)) check_gap(name_of(f), k, s, small, few);
            const auto points = points_beside(hull_seed, c, k);
            const hull<T> h(points.data(), points.size());
            if (is_valid(s) && is_valid(h)) check_gap(name_of(f), k, s, h, near);
        }
    }
    check_total("a solid and a hull of few points", few);
    check_total("a solid and a hull", near);
}

}  // namespace

TEST_CASE("distance: cylinders and cones from hulls, by hand") {
    const std::vector<vec3<double>> cube{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0},
                                         {0, 0, 2}, {2, 0, 2}, {0, 2, 2}, {2, 2, 2}};
    const hull<double> h(cube.data(), cube.size());
    CHECK(distance(cylinder<double>{{{1, 1, 4}, {1, 1, 5}}, 0.5}, h).distance == 2);
    CHECK(distance(h, cylinder<double>{{{5, -9, 1}, {5, 9, 1}}, 1}).distance == 2);
    CHECK(distance(cone<double>{{5, 6, 2}, {9, 12, 2}, 1}, h).distance == 5);
    const auto inside = distance(cylinder<double>{{{0.5, 1, 1}, {1, 1, 1}}, 0.25}, h);
    CHECK(inside.distance == 0);
    CHECK(intersects(inside.point_a, h));
    const auto around = distance(cylinder<double>{{{-9, 1, 1}, {9, 1, 1}}, 5}, h);
    CHECK(around.distance == 0);
    // Without length a ball.
    CHECK(distance(cylinder<double>{{{5, 1, 1}, {5, 1, 1}}, 1}, h).distance == 2);
}

TEST_CASE("distance: a flat tetrahedron of differences tells no point off the shapes") {
    // A place on the rim is a unit in the last place inside of the triangle.
    const cone<double> s{{3, 2, 2}, {3, 14, 2}, 20};
    const std::vector<vec3<double>> corners{{-20, 17, 16}, {-15, 14, 26}, {0x1.0000000000001p+1, 11, 20}};
    gap_tally tally;
    check_gap("nudged", 0, s, hull<double>(corners.data(), 3), tally);
    CHECK(tally.touching == 1);
}

TEMPLATE_TEST_CASE("distance: cylinders and cones from hulls, against 300 bits", "", cylinder<float>, cylinder<double>,
                   cone<float>, cone<double>) {
    check_gaps<TestType>();
}

}  // namespace abut::test
