// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

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
    std::printf("contacts with hulls: seed %llu\n", static_cast<unsigned long long>(hull_contact_seed));
    contact_figures few, many;
    each_revolution_case<TestType>(hull_contact_seed, 100, [&](const std::string& name, std::uint64_t k, const auto& c) {
        // Numbers of all exponents in one pair may take seconds.
        if (name == name_of(revolution_family::all_bit_patterns) && k % 10 != 0) return;
        const auto s = solid_of<TestType>(c.axis, c.radius);
        const std::vector<vec3<T>> corners{c.corner[0], c.corner[1], c.corner[2], c.corner[0] + (c.corner[1] - c.corner[2])};
        check_contact(name, k / 4, s, hull<T>(corners.data(), 1 + k % 4), few);
        const auto points = points_beside(hull_contact_seed, c, k);
        check_contact(name, k, s, hull<T>(points.data(), points.size()), many);
    });
    check_figures("hulls of few points", few);
    check_figures("hulls", many);
    for (const contact_figures& sum : {few, many}) {
        CHECK(sum.touching * 80 > some_samples(100) * revolution_family_count);
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
