// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include <algorithm>
#include <cstdio>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/samples.hpp"
#include "support/triangle_families.hpp"

// A second oracle, on a sample: CGAL's exact kernel, for triangles that are not degenerate.

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;

template <abut::scalar T>
kernel::Point_3 point(const abut::vec3<T>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

template <abut::scalar T>
kernel::Triangle_3 theirs(const abut::triangle<T>& t) {
    return {point(t.a), point(t.b), point(t.c)};
}

}  // namespace

TEMPLATE_TEST_CASE("sphere and triangle: agrees with CGAL's exact squared distance", "", float, double) {
    using namespace abut;
    using test::family;
    std::uint64_t compared = 0, hits = 0, wrong = 0;
    const std::uint64_t count = std::min<std::uint64_t>(test::sample_count() / 10, 20000);
    for (const family f : {family::random, family::tangent_vertex, family::tangent_edge, family::tangent_face,
                           family::needle_1e6, family::radius_zero, family::lattice_4, family::tenths_16, family::largest}) {
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = test::make_pair<TestType>(test::sample_seed, f, k);
            const kernel::Triangle_3 face = theirs(t);
            if (face.is_degenerate()) continue;
            const kernel::FT r(static_cast<double>(s.radius));
            const bool touch = CGAL::compare(CGAL::squared_distance(point(s.center), face), r * r) != CGAL::LARGER;
            ++compared;
            hits += touch;
            wrong += intersects(s, t) != touch || intersects<exact>(s, t) != touch;
        }
    }
    std::printf("CGAL, spheres: %llu pairs, seed %llu, %llu hits\n", static_cast<unsigned long long>(compared),
                static_cast<unsigned long long>(test::sample_seed), static_cast<unsigned long long>(hits));
    CHECK(compared > 8 * count);
    CHECK(hits * 5 > compared);
    CHECK(hits * 5 < 4 * compared);
    CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE("triangle and triangle: agrees with CGAL's exact kernel", "", float, double) {
    using namespace abut;
    using test::triangle_family;
    std::uint64_t compared = 0, degenerate = 0, hits = 0, wrong = 0;
    const std::uint64_t count = std::min<std::uint64_t>(test::sample_count() / 4, 20000);
    for (int i = 0; i < test::triangle_family_count; ++i) {
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = test::make_triangle_pair<TestType>(test::sample_seed, static_cast<triangle_family>(i), k);
            const kernel::Triangle_3 their_s = theirs(s), their_t = theirs(t);
            if (their_s.is_degenerate() || their_t.is_degenerate()) {
                ++degenerate;
                continue;
            }
            const bool touch = CGAL::do_intersect(their_s, their_t);
            ++compared;
            hits += touch;
            wrong += intersects(s, t) != touch || intersects<exact>(s, t) != touch;
        }
    }
    std::printf("CGAL, triangles: %llu pairs of %d families, seed %llu, %llu hits; %llu degenerate ones left out\n",
                static_cast<unsigned long long>(compared), test::triangle_family_count,
                static_cast<unsigned long long>(test::sample_seed), static_cast<unsigned long long>(hits),
                static_cast<unsigned long long>(degenerate));
    CHECK(compared > 33 * count);
    CHECK(hits * 5 > compared);
    CHECK(hits * 5 < 4 * compared);
    CHECK(wrong == 0);
}
