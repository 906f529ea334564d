// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <fcl/narrowphase/detail/primitive_shape_algorithm/sphere_triangle.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/samples.hpp"
#include "support/triangle_families.hpp"

// FCL as an oracle, where it can be one. Its test for spheres and triangles is right in double, for triangles with an area,
// at 1e-12 or more of the scene's size from tangency, and wrong in exact contact: pairs nearer than `margin` are left out.
// Its test for two triangles (with an area) is right in general position, on lattices of small integers, and near contact
// where floats were widened to double, so that it rounds little; elsewhere near contact it is wrong.

namespace {

template <abut::scalar T>
fcl::Vector3d point(const abut::vec3<T>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace

TEST_CASE("sphere and triangle: agrees with FCL in general position") {
    using namespace abut;
    constexpr double margin = 1e-9;
    std::uint64_t compared = 0, near_tangency = 0, hits = 0, wrong = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        const auto [s, t] = test::make_pair<double>(test::sample_seed, test::family::random, k);
        const auto smaller = sphere<double>{s.center, s.radius - margin},
                   larger = sphere<double>{s.center, s.radius + margin};
        if (s.radius < margin || intersects<exact>(smaller, t) != intersects<exact>(larger, t)) {
            ++near_tangency;
            continue;
        }
        fcl::Transform3d pose = fcl::Transform3d::Identity();
        pose.translation() = point(s.center);
        const bool theirs = fcl::detail::sphereTriangleIntersect<double>(fcl::Sphered(s.radius), pose, point(t.a),
                                                                         point(t.b), point(t.c), nullptr, nullptr, nullptr);
        ++compared;
        hits += theirs;
        wrong += intersects(s, t) != theirs || intersects<exact>(s, t) != theirs || intersects<fast>(s, t) != theirs;
    }
    std::printf("FCL, spheres: %llu pairs, seed %llu, %llu hits; %llu within %g of tangency left out\n",
                static_cast<unsigned long long>(compared), static_cast<unsigned long long>(test::sample_seed),
                static_cast<unsigned long long>(hits), static_cast<unsigned long long>(near_tangency), margin);
    CHECK(compared + near_tangency >= test::sample_count());
    CHECK(near_tangency * 100 < compared);
    CHECK(hits * 20 > compared);
    CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE("triangle and triangle: agrees with FCL where it is right", "", float, double) {
    using namespace abut;
    using test::triangle_family;
    using F = triangle_family;
    std::vector<F> families{F::random,     F::offset_1e3,  F::offset_1e6, F::scaled_1e_minus_13, F::scaled_1e_minus_4,
                            F::scaled_1e6, F::scaled_1e13, F::lattice_4,  F::lattice_16,         F::lattice_256};
    if (sizeof(TestType) == 4) {
        for (const F f : {F::vertex_on_face, F::edge_on_edge, F::shared_vertex, F::coplanar_tilted, F::needle_1e6})
            families.push_back(f);
    }
    std::uint64_t compared = 0, degenerate = 0, hits = 0, wrong = 0;
    const std::uint64_t count = std::min<std::uint64_t>(test::sample_count(), 100000);
    for (const F f : families) {
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = test::make_triangle_pair<TestType>(test::sample_seed, f, k);
            const fcl::Vector3d a[] = {point(s.a), point(s.b), point(s.c)}, b[] = {point(t.a), point(t.b), point(t.c)};
            if ((a[1] - a[0]).cross(a[2] - a[0]).isZero(0) || (b[1] - b[0]).cross(b[2] - b[0]).isZero(0)) {
                ++degenerate;
                continue;
            }
            const bool theirs = fcl::detail::Intersect<double>::intersect_Triangle(a[0], a[1], a[2], b[0], b[1], b[2]);
            ++compared;
            hits += theirs;
            wrong += intersects(s, t) != theirs || intersects<exact>(s, t) != theirs;
        }
    }
    std::printf("FCL, triangles: %llu pairs of %zu families, seed %llu, %llu hits; %llu degenerate ones left out\n",
                static_cast<unsigned long long>(compared), families.size(),
                static_cast<unsigned long long>(test::sample_seed), static_cast<unsigned long long>(hits),
                static_cast<unsigned long long>(degenerate));
    CHECK(compared * 10 > 9 * count * families.size());
    CHECK(hits * 5 > compared);
    CHECK(hits * 5 < 4 * compared);
    CHECK(wrong == 0);
}
