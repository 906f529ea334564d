// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include <cmath>
#include <cstdio>

#include <fcl/narrowphase/detail/primitive_shape_algorithm/sphere_triangle.h>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/samples.hpp"

// FCL as an oracle, where it can be one: its test for spheres and triangles is right in double, for triangles with an area,
// at 1e-12 or more of the scene's size from tangency, and wrong in exact contact. Pairs nearer than `margin` are left out.

TEST_CASE("sphere and triangle: agrees with FCL in general position") {
    using namespace abut;
    constexpr double margin = 1e-9;
    std::uint64_t compared = 0, near_tangency = 0, hits = 0, wrong = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        const auto [s, t] = test::make_pair<double>(test::seed, test::family::random, k);
        const auto smaller = sphere<double>{s.center, s.radius - margin},
                   larger = sphere<double>{s.center, s.radius + margin};
        if (s.radius < margin || intersects<exact>(smaller, t) != intersects<exact>(larger, t)) {
            ++near_tangency;
            continue;
        }
        const auto point = [](const vec3<double>& v) { return fcl::Vector3d(v.x, v.y, v.z); };
        fcl::Transform3d pose = fcl::Transform3d::Identity();
        pose.translation() = point(s.center);
        const bool theirs = fcl::detail::sphereTriangleIntersect<double>(fcl::Sphered(s.radius), pose, point(t.a),
                                                                         point(t.b), point(t.c), nullptr, nullptr, nullptr);
        ++compared;
        hits += theirs;
        wrong += intersects(s, t) != theirs || intersects<exact>(s, t) != theirs || intersects<fast>(s, t) != theirs;
    }
    std::printf("FCL: %llu pairs, seed %llu, %llu hits; %llu within %g of tangency left out\n",
                static_cast<unsigned long long>(compared), static_cast<unsigned long long>(test::seed),
                static_cast<unsigned long long>(hits), static_cast<unsigned long long>(near_tangency), margin);
    CHECK(compared + near_tangency >= test::sample_count());
    CHECK(near_tangency * 100 < compared);
    CHECK(hits * 20 > compared);
    CHECK(wrong == 0);
}
