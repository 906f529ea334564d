// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/revolution_contacts.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

constexpr std::uint64_t contact_seed = 20261127;

}  // namespace

TEMPLATE_TEST_CASE("contacts of cylinders and cones are what they say, in each family", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::printf("contacts: seed %llu\n", static_cast<unsigned long long>(contact_seed));
    std::array<contact_figures, kinds_beside.size()> sums;
    each_revolution_case<TestType>(contact_seed, 125, [&](const std::string& name, std::uint64_t k, const auto& c) {
        const auto s = solid_of<TestType>(c.axis, c.radius);
        each_beside(c, k, is_cone, [&](std::size_t kind, const auto& t) { check_contact(name, k, s, t, sums[kind]); });
    });
    for (std::size_t kind = 0; kind < sums.size(); ++kind) {
        check_figures(kinds_beside[kind], sums[kind]);
        CHECK(sums[kind].moved * 10 > sums[kind].touching * 8);
        CHECK(sums[kind].touching > 20);
    }
}

TEST_CASE("contacts of cylinders and cones: by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr cone<double> tip{{0, 0, 4}, {0, 0, 0}, 3};
    static_assert(contact_of(rod, vec{0.5, 0, 1.75}) == contact<double>{0, 0, {0.5, 0, 1.75}, {0, 0, -1}, 0.25});
    static_assert(contact_of(vec{0.875, 0, 1}, rod) == contact<double>{0, 0, {0.875, 0, 1}, {1, 0, 0}, 0.125});
    static_assert(contact_of(rod, segment<double>{{0.75, -5, 1}, {0.75, 5, 1}})->depth == 0.25);
    static_assert(contact_of(rod, triangle<double>{{-5, -5, 1.75}, {5, -5, 1.75}, {0, 9, 1.75}})->depth == 0.25);
    static_assert(contact_of(aabb<double>{{-5, -5, -1}, {5, 5, 0.5}}, rod)->normal == vec{0, 0, -1});
    static_assert(contact_of(rod, sphere<double>{{2, 0, 1}, 1.5}) == contact<double>{0, 0, {1, 0, 1}, {-1, 0, 0}, 0.5});
    static_assert(contact_of(rod, sphere<double>{{0, 0, 1.75}, 1})->depth == 1.25);
    static_assert(contact_of(plane<double>{{0, 0, 2}, 3}, rod)->depth == 0.5);
    static_assert(contact_of(rod, plane<double>{{0, 0, 0}, 0}) ==
                  contact<double>{0, 0, {0, 0, 2}, {0, 0, 1}, std::numeric_limits<double>::max()});
    static_assert(contact_of(tip, vec{0, 0, 0.25})->depth == 0.25);
    static_assert(contact_of(tip, plane<double>{{0, 0, 1}, 3.5})->depth == 0.5);
    static_assert(!contact_of(tip, vec{3, 0, 1}));
    CHECK(contact_of(tip, vec{1, 0, 2.5})->depth == Approx(0.1));  // across the side
    // Without length they are balls.
    static_assert(contact_of(cylinder<double>{{{0, 0, 0}, {0, 0, 0}}, 2}, vec{0, 0, 1}) ==
                  contact<double>{0, 0, {0, 0, 1}, {0, 0, -1}, 1});
    static_assert(contact_of(aabb<double>{{1, -1, -1}, {4, 1, 1}}, cone<double>{{0, 0, 0}, {0, 0, 0}, 2})->depth == 1);
    static_assert(detail::contact_pair<cylinder<float>, triangle<float>> &&
                  detail::contact_pair<cone<double>, plane<double>>);
}

// An edge that is seen nearly on the larger axis of the ellipse that a rim is: the ways out on both sides of the axis are as
// long, and the triangle lies on one of them. What is moved by less than a bound changes no depth by more.
TEMPLATE_TEST_CASE("contacts of cylinders and cones: an edge next to the larger axis of a rim", "", cylinder<double>, cone<double>) {
    using vec = vec3<double>;
    const double a = 0.5, b = 0.25;  // of a rim of radius 0.5 whose axis leans by 60 degrees from the edge's direction, y
    const vec axis{std::sqrt(3.0) / 2, 0.5, 0};
    std::size_t pairs = 0;
    for (const double x : {0.3, 0.34, 0.36}) {  // below (a^2 - b^2) / a
        double depth[2] = {};
        for (const double y : {0.0, 1e-4, 1e-8, 1e-10, 1e-13, 1e-16, 1e-25, 1e-80}) {
            for (const double side : {-1.0, 1.0}) {
                for (const double of_y : {-1.0, 1.0}) {
                    const vec p{of_y * y, 0, x};
                    const triangle<double> t{p - vec{0, 3, 0}, p + vec{0, 3, 0}, p + vec{side, 0, 0}};
                    TestType solid{};
                    if constexpr (std::same_as<TestType, cone<double>>) {
                        solid = {-4.0 * axis, {0, 0, 0}, a};
                    } else {
                        solid = {{-4.0 * axis, {0, 0, 0}}, a};
                    }
                    const double found = contact_of(solid, t)->depth;
                    double& at_zero = depth[side > 0 ? 1 : 0];
                    if (y == 0) at_zero = found;
                    CAPTURE(x, y, side, of_y);
                    CHECK(std::abs(found - at_zero) <= y + 1e-15);
                    ++pairs;
                }
            }
        }
        CHECK(std::min(depth[0], depth[1]) < b);
    }
    CHECK(pairs == 96);
}

}  // namespace abut::test
