// SPDX-License-Identifier: MIT
//
// Depths and Hausdorff distances on a device: the bits of the host.

#include <abut/cuda.hpp>

#include <cstdint>

#include "collide/depth_cases.hpp"
#include "collide/solid_list_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("depth: cuda has the host's bits", "", float, double) {
    const cuda on;
    const serial host;
    for (std::uint64_t k = 0; k < 12; ++k) {
        draws d(20270901, 1, k);
        const auto a = draw_soup(d, 1 + d.below(40), 12).soup(TestType(1)), b = draw_soup(d, 1 + d.below(40), 12).soup(TestType(1));
        const bound_options bounds{.tolerance = 0.01, .most_pieces = std::uint64_t{1} << 14};
        const hausdorff_distance there = hausdorff(on, make_bvh(on, copy_to(on, a)), copy_to(on, b), bounds),
                                 here = hausdorff(host, a, b, bounds);
        CHECK((there.a_from_b == here.a_from_b && there.b_from_a == here.b_from_a));
        const auto t = [&](int x) { return static_cast<TestType>(x); };
        const auto box = [&] {
            const int x = d.below(4), y = d.below(4), z = d.below(4);
            return aabb<TestType>{{t(x), t(y), t(z)}, {t(x + 1 + d.below(3)), t(y + 1 + d.below(3)), t(z + 1 + d.below(3))}};
        };
        const auto p = box(), q = box();
        CHECK(penetration(on, p, q) == penetration(host, p, q));
    }
}

TEST_CASE("depth: lists and scenes of bricks, cuda") {
    check_patches_and_depths(cuda{});
}

}  // namespace abut::test
