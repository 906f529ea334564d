// SPDX-License-Identifier: MIT
#include <abut/collide/contacts.hpp>

#include <cstdint>

#include "collide/contact_cases.hpp"
#include "collide/set_cases.hpp"
#include "support/catch.hpp"

// Contacts of cylinders and cones in sets and indices, posed and not, against plain loops. What a contact has to be is
// tests/narrow's.

using namespace abut;

namespace {

template <class Solid, class Policy>
void check_contacts_of_solids(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<Solid>;
    CAPTURE(seed);
    test::uniform random(seed);
    std::size_t found = 0;
    for (const bool on_lattice : {false, true}) {
        const shapes<Solid> set(test::shape_maker<Solid>(random, on_lattice)(70));
        const triangle_soup<T> soup(test::shape_maker<triangle<T>>(random, on_lattice)(60));
        const spheres<T> balls(test::shape_maker<sphere<T>>(random, on_lattice)(50));
        const segments<T> wires(test::shape_maker<segment<T>>(random, on_lattice)(50));
        const rigid<T> turned{{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(0.25), 0, T(0.125)}};
        found += test::check_contacts(on, set, turned, soup, rigid<T>{});
        found += test::check_contacts(on, balls, rigid<T>{}, set, turned);
        found += test::check_contacts(on, wires, turned, set, turned);
        const boxes<T> crates(test::shape_maker<aabb<T>>(random, on_lattice)(40));
        const shapes<plane<T>> walls(test::shape_maker<plane<T>>(random, on_lattice)(20));
        const auto there = copy_to(on, set);
        const auto tree = make_bvh(on, there);
        const auto in_crates = test::true_contacts(set.view(), crates.view());
        CHECK(test::same_bits(to_host(contacts(on, tree, copy_to(on, crates))), in_crates));
        CHECK(test::same_bits(to_host(contacts(on, there, make_bvh(on, copy_to(on, crates)))), in_crates));
        CHECK(
            test::same_bits(to_host(contacts(on, copy_to(on, walls), tree)), test::true_contacts(walls.view(), set.view())));
        CHECK(to_host(contacts(on, tree, copy_to(on, walls))).size() == count(on, tree, copy_to(on, walls)));
        found += in_crates.size();
    }
    CHECK(found > 300);
}

/// With a set of round solids.
template <class Solid, class Other, class Policy>
void check_contacts_of_rounds(const Policy& on, std::uint64_t seed) {
    using T = scalar_type_of<Solid>;
    CAPTURE(seed);
    test::uniform random(seed);
    std::size_t found = 0;
    for (const bool on_lattice : {false, true}) {
        const shapes<Solid> a(test::shape_maker<Solid>(random, on_lattice)(50));
        const shapes<Other> b(test::shape_maker<Other>(random, on_lattice)(50));
        const rigid<T> turned{{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(0.25), 0, T(0.125)}};
        found += test::check_contacts(on, a, turned, b, rigid<T>{});
    }
    CHECK(found > 100);
}

}  // namespace

TEST_CASE("contacts: sets of cylinders and cones") {
    check_contacts_of_solids<cylinder<float>>(serial{}, 301);
    check_contacts_of_solids<cylinder<double>>(openmp{3}, 302);
    check_contacts_of_solids<cone<float>>(openmp{3}, 303);
    check_contacts_of_solids<cone<double>>(serial{}, 304);
}

TEST_CASE("contacts: sets of cylinders, cones and capsules with each other") {
    check_contacts_of_rounds<cylinder<float>, cylinder<float>>(openmp{3}, 305);
    check_contacts_of_rounds<cone<double>, cone<double>>(serial{}, 306);
    check_contacts_of_rounds<cylinder<double>, cone<double>>(serial{}, 307);
    check_contacts_of_rounds<capsule<float>, cone<float>>(openmp{3}, 308);
}

TEST_CASE("contacts: a can on a table, by hand") {
    const cylinder<float> can{{{0, 0, -0.125f}, {0, 0, 2}}, 0.5f};
    const aabb<float> table{{-1, -1, -1}, {1, 1, 0}};
    const auto on_table = to_host(contacts(serial{}, can, table));
    REQUIRE(on_table.size() == 1);
    CHECK(on_table[0].depth == 0.125f);
    CHECK(on_table[0].normal == vec3<float>{0, 0, 1});
    const vec3<float> p = on_table[0].point;  // any one of both
    CHECK((p.z >= -0.125f && p.z <= 0 && p.x * p.x + p.y * p.y <= 0.25f));
    const mesh<float> ground(std::vector<vec3<float>>{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}},
                             std::vector<face>{{0, 1, 2}, {0, 2, 3}});
    const cone<float> tip{{0.5f, -0.25f, -0.25f}, {0.5f, -0.25f, 3}, 1};
    const auto in_ground = to_host(contacts(serial{}, ground, tip));
    REQUIRE(in_ground.size() == 1);
    CHECK(in_ground[0].depth == 0.25f);
    CHECK(in_ground[0].normal == vec3<float>{0, 0, -1});
}
