// SPDX-License-Identifier: MIT
// long to compile
//
// Sets of convex hulls on ranks that work on a device: what tests/distributed/hulls.test.cpp says of hosts, where parts,
// messages and results lie in device memory.
#include <abut/cuda.hpp>
#include <abut/mpi.hpp>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "cuda/aware_mpi.hpp"
#include "distributed/world.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("distributed: convex hulls, cuda") {
    make_mpi_aware(GENERATE(false, true));
    const distributed on(world(), cuda{});
    const auto& ranks = on.ranks();
    std::mt19937 random(42);
    std::uniform_real_distribution<float> place(0, 6), off(-0.4f, 0.4f);
    std::uniform_int_distribution<int> points(1, 40);
    std::vector<triangle<float>> triangles;
    std::vector<std::vector<vec3<float>>> lists;
    for (int i = 0; i < 600; ++i) {
        const float x = place(random), y = place(random), z = place(random);
        triangles.push_back({{x, y, z}, {x + 0.5f, y, z}, {x, y + 0.5f, z + 0.5f}});
        std::vector<vec3<float>> some;
        for (int n = points(random); n > 0; --n) {
            const float dx = off(random), dy = off(random), dz = off(random);
            some.push_back({z + dx, x + dy, y + dz});
        }
        lists.push_back(some);
    }
    const triangle_soup<float> whole_a(triangles), a(part_of(triangles, division::even, on.rank(), on.size()));
    const hulls<float> whole(lists), part(part_of(lists, division::uneven, on.rank(), on.size()));
    const auto tree = make_bvh(on.local(), a);
    const auto there = copy_to(on.local(), part);
    rigid<float> pose;
    pose.translation = {0.25f, -0.5f, 0.125f};

    const auto expected = in_all_parts(to_host(pairs(serial{}, whole_a, whole)));
    CHECK(expected.size() > 300);
    CHECK(lists_of_all(ranks, to_host(pairs(on, tree, there))) == expected);
    const auto placed = in_all_parts(to_host(pairs(serial{}, whole_a, posed(whole, pose))));
    CHECK(placed != expected);
    CHECK(lists_of_all(ranks, to_host(pairs(on, tree, posed(make_bvh(on.local(), there), pose)))) == placed);

    const auto anew = redistribute(on, there);
    const auto ids = lists_of_all(ranks, anew.ids.to_host());
    std::vector<global_pair> found;
    for (const global_pair& p : lists_of_all(ranks, to_host(pairs(on, tree, anew.set)))) found.push_back({p.a, ids[p.b]});
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
    CHECK((messages_on_devices > 0) == (mpi_is_aware && on.size() > 1));
}

}  // namespace abut::test
