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

}  // namespace abut::test
