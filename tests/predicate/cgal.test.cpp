// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include <algorithm>
#include <cstdio>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/samples.hpp"

// A second oracle, on a sample: CGAL's squared distance in its exact kernel, for triangles that are not degenerate.

TEMPLATE_TEST_CASE("sphere and triangle: agrees with CGAL's exact squared distance", "", float, double) {
    using namespace abut;
    using test::family;
    using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    std::uint64_t compared = 0, hits = 0, wrong = 0;
    const std::uint64_t count = std::min<std::uint64_t>(test::sample_count() / 10, 20000);
    for (const family f : {family::random, family::tangent_vertex, family::tangent_edge, family::tangent_face,
                           family::needle_1e6, family::radius_zero, family::lattice_4, family::tenths_16, family::largest}) {
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = test::make_pair<TestType>(test::seed, f, k);
            const auto point = [](const vec3<TestType>& v) {
                return kernel::Point_3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
            };
            const kernel::Triangle_3 theirs(point(t.a), point(t.b), point(t.c));
            if (theirs.is_degenerate()) continue;
            const kernel::FT r(static_cast<double>(s.radius));
            const bool touch = CGAL::compare(CGAL::squared_distance(point(s.center), theirs), r * r) != CGAL::LARGER;
            ++compared;
            hits += touch;
            wrong += intersects(s, t) != touch || intersects<exact>(s, t) != touch;
        }
    }
    std::printf("CGAL: %llu pairs, seed %llu, %llu hits\n", static_cast<unsigned long long>(compared),
                static_cast<unsigned long long>(test::seed), static_cast<unsigned long long>(hits));
    CHECK(compared > 8 * count);
    CHECK(hits * 5 > compared);
    CHECK(hits * 5 < 4 * compared);
    CHECK(wrong == 0);
}
