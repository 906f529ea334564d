// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <concepts>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/revolution_contacts.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

// Cylinders and cones with convex hulls. revolution_contacts.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t hull_contact_seed = 20261127;

}  // namespace

TEMPLATE_TEST_CASE("contacts of cylinders and cones with hulls are what they say, in each family", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::printf("contacts with hulls: seed %llu\n", static_cast<unsigned long long>(hull_contact_seed));
    contact_figures few, many;
    for (int i = 0; i < revolution_family_count + 3; ++i) {
        const bool is_thin = i == revolution_family_count, is_parallel = i == revolution_family_count + 1,
                   is_through = i == revolution_family_count + 2;
        const std::string name = is_thin       ? "thin"
                                 : is_parallel ? "nearly parallel"
                                 : is_through  ? "through"
                                               : name_of(static_cast<revolution_family>(i));
        // Numbers of all exponents in one pair may take seconds.
        const bool is_slow = i == static_cast<int>(revolution_family::all_bit_patterns);
        for (std::uint64_t k = 0; k < some_samples(is_through ? 20 : is_slow ? 2000 : 250); ++k) {
            const auto c = is_thin       ? over_needle<TestType>(k)
                           : is_parallel ? nearly_parallel<TestType>(k)
                           : is_through
                               ? through<TestType>(hull_contact_seed, k)
                               : make_revolution_case<T>(hull_contact_seed, static_cast<revolution_family>(i), k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            const std::vector<vec3<T>> corners{c.corner[0], c.corner[1], c.corner[2],
                                               c.corner[0] + (c.corner[1] - c.corner[2])};
            check_contact(name, k / 4, s, hull<T>(corners.data(), 1 + k % 4), few);
            const auto points = points_beside(hull_contact_seed, c, k);
            check_contact(name, k, s, hull<T>(points.data(), points.size()), many);
        }
    }
    check_figures("hulls of few points", few);
    check_figures("hulls", many);
    for (const contact_figures& sum : {few, many}) {
        CHECK(sum.touching > 100);
        CHECK(sum.moved * 10 > sum.touching * 8);
    }
}

TEST_CASE("contacts of cylinders and cones with hulls: by hand, and in constant expressions") {
    using vec = vec3<double>;
    static constexpr vec cube[8] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {0, 0, 2}, {2, 0, 2}, {0, 2, 2}, {2, 2, 2}};
    constexpr hull<double> h(cube, 8);
    static_assert(contact_of(cylinder<double>{{{1, 1, 1.75}, {1, 1, 5}}, 0.5}, h)->depth == 0.25);
    static_assert(contact_of(h, cylinder<double>{{{1, 1, 1.75}, {1, 1, 5}}, 0.5})->normal == vec{0, 0, -1});
    static_assert(contact_of(cylinder<double>{{{-9, 1, 2.75}, {9, 1, 2.75}}, 1}, h)->depth == 0.25);
    static_assert(contact_of(cone<double>{{1, 1, 1.5}, {1, 1, 5}, 1}, h)->depth == 0.5);
    static_assert(!contact_of(cone<double>{{1, 1, 2.5}, {1, 1, 5}, 1}, h));
    static_assert(contact_of(cylinder<double>{{{1, 1, 2.5}, {1, 1, 2.5}}, 1}, h)->depth == 0.5);  // a ball
    const auto deep = contact_of(cylinder<double>{{{0.5, 1, 1}, {1.5, 1, 1}}, 0.25}, h);
    CHECK(deep->depth == Approx(1.25));
    CHECK(intersects(deep->point, h));
}

}  // namespace abut::test
