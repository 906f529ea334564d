// SPDX-License-Identifier: MIT

// What docs/migrating.md says of FCL's contacts of two meshes beside ours: its depths are never smaller, and the sign of its
// normals tells nothing. FCL is no oracle here.

#include "support/fcl_model.hpp"

#include <cstdio>
#include <map>

#include "collide/mesh_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEST_CASE("contacts of meshes: FCL's depths are not smaller, and its normals point either way") {
    const torus<double> ring(48, 24, 2, 0.7);
    const mesh<double> a(ring.vertices, ring.faces), b = as_mesh(ball_surface<double>(4, 1.5));
    const auto tree_a = make_bvh(serial{}, a), tree_b = make_bvh(serial{}, b);
    const auto model_a = make_fcl_model(a.view());
    const fcl::Transform3d identity = fcl::Transform3d::Identity();
    std::size_t compared = 0, smaller = 0, as_documented = 0;
    for (std::uint64_t k = 0; k < 30; ++k) {
        const auto pose = pose_within<double>(20261204, k, {-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5});
        fcl::CollisionResultd result;
        fcl::collide(model_a.get(), identity, make_fcl_model(b.view(), pose).get(), identity,
                     fcl::CollisionRequestd(100'000'000, true), result);
        std::map<index_pair, fcl::Contactd> theirs;
        for (std::size_t i = 0; i < result.numContacts(); ++i) {
            const auto& c = result.getContact(i);
            theirs.try_emplace({static_cast<std::uint32_t>(c.b1), static_cast<std::uint32_t>(c.b2)}, c);
        }
        for (const auto& ours : contacts(serial{}, tree_a, posed(tree_b, pose))) {
            const auto found = theirs.find({ours.a, ours.b});
            if (found == theirs.end()) continue;
            const auto& [normal, depth] = std::pair(found->second.normal, found->second.penetration_depth);
            ++compared;
            if (depth < ours.depth - 1e-9) ++smaller;
            // Ours points from b to a; FCL says that its own points from a to b.
            if (normal[0] * ours.normal.x + normal[1] * ours.normal.y + normal[2] * ours.normal.z < 0) ++as_documented;
        }
    }
    std::printf("FCL: %zu contacts compared, %zu less deep than ours, %zu normals as documented\n", compared, smaller,
                as_documented);
    CHECK(compared > 3000);
    CHECK(smaller == 0);
    CHECK(10 * as_documented > compared);
    CHECK(10 * as_documented < 9 * compared);
}

}  // namespace abut::test
