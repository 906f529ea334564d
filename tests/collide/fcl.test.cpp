// SPDX-License-Identifier: MIT
#include <abut/collide/query.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

#include <fcl/fcl.h>

#include <abut/index/lbvh.hpp>

#include "support/catch.hpp"
#include "support/fcl_model.hpp"
#include "support/scenes.hpp"

// FCL's BVH model of a mesh against spheres, in double and in general position: spheres whose set of triangles would change
// if the radius were `margin` smaller or larger are left out, since FCL is wrong in exact contact.

TEST_CASE("queries: a mesh against spheres agrees with FCL in general position") {
    using namespace abut;
    constexpr double margin = 1e-9;
    constexpr std::uint64_t seed = 77;
    const test::torus<double> shape(48, 24, 2, 1);
    const mesh<double> surface(shape.vertices, shape.faces);
    test::uniform random(seed);
    std::vector<sphere<double>> balls, smaller, larger;
    for (int i = 0; i < 3000; ++i) {
        const sphere<double> s{random.point<double>(-3, 3), random(0.01, 0.4)};
        balls.push_back(s);
        smaller.push_back({s.center, s.radius - margin});
        larger.push_back({s.center, s.radius + margin});
    }
    const auto tree = make_bvh(serial{}, surface);
    const auto faces_of = [&](const std::vector<sphere<double>>& set) {
        std::vector<std::vector<int>> faces(set.size());
        for (const auto [face, ball] : to_host(pairs(serial{}, tree, spheres<double>(set)))) {
            faces[ball].push_back(static_cast<int>(face));
        }
        return faces;
    };
    const auto ours = faces_of(balls), inner = faces_of(smaller), outer = faces_of(larger);

    const test::fcl_model model = test::make_fcl_model(surface.view());
    std::size_t compared = 0, near_tangency = 0, hits = 0, wrong = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        if (inner[i] != outer[i]) {
            ++near_tangency;
            continue;
        }
        const fcl::Sphered ball(balls[i].radius);
        fcl::Transform3d pose = fcl::Transform3d::Identity();
        pose.translation() = fcl::Vector3d(balls[i].center.x, balls[i].center.y, balls[i].center.z);
        fcl::CollisionResultd result;
        fcl::collide(model.get(), fcl::Transform3d::Identity(), &ball, pose, fcl::CollisionRequestd(100'000, false), result);
        std::vector<int> theirs;
        for (std::size_t k = 0; k < result.numContacts(); ++k) theirs.push_back(static_cast<int>(result.getContact(k).b1));
        std::sort(theirs.begin(), theirs.end());
        theirs.erase(std::unique(theirs.begin(), theirs.end()), theirs.end());
        ++compared;
        hits += theirs.size();
        wrong += theirs != ours[i];
    }
    std::printf("FCL: %zu spheres, seed %llu, %zu pairs; %zu within %g of tangency left out\n", compared,
                static_cast<unsigned long long>(seed), hits, near_tangency, margin);
    CHECK(compared > 2900);
    CHECK(hits > 3000);
    CHECK(wrong == 0);
}
