// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "support/catch.hpp"
#include "support/cone_pair_families.hpp"
#include "support/cylinder_pair_families.hpp"
#include "support/draws.hpp"
#include "support/revolution_contacts.hpp"
#include "support/samples.hpp"

// Cylinders and cones with each other and with capsules. revolution_contacts.hpp has the oracle.

namespace abut::test {

namespace {

constexpr std::uint64_t pair_contact_seed = 20261127;

/// Two axes through about one place, of solids that are thin, flat or neither: deep in each other, or hardly.
template <scalar T>
pair_of_rounds<T> through_each_other(std::uint64_t k) {
    using namespace construction;
    draws d(pair_contact_seed, 90 + sizeof(T), k);
    pair_of_rounds<T> c{};
    const point at = cube(d, d.below(2) == 0 ? 0 : 1);
    const double apart = d.below(4) == 0 ? d.power_of_ten(-6, 0) : d.uniform(0, 1);
    point last{0, 0, 1};
    for (int i = 0; i < 2; ++i) {
        const bool is_thin = d.below(4) == 0, is_flat = d.below(4) == 0;
        const double height = is_flat ? d.power_of_ten(-4, 0) : d.uniform(0.5, 2),
                     radius = is_thin ? d.power_of_ten(-4, 0) : d.uniform(0.2, 1), part = d.uniform(-0.1, 1.1);
        point axis = unit(cube(d, 1));
        const int like = i == 0 ? 3 : d.below(6);  // about parallel, or about square, to the first
        if (like == 0) axis = unit(along(last, d.power_of_ten(-12, 0), axis));
        if (like == 1) axis = unit(along(unit(cross_product(last, axis)), d.power_of_ten(-12, 0), axis));
        last = axis;
        const point from = along(along(at, apart * radius, cube(d, 1)), -part * height, axis);
        (i == 0 ? c.first : c.second) = segment<T>{round_to<T>(from), round_to<T>(along(from, height, axis))};
        (i == 0 ? c.first_radius : c.second_radius) = rounded_to<T>(radius);
    }
    return c;
}

template <class First, class Second, scalar T>
void check_pair(const std::string& name, std::uint64_t k, const pair_of_rounds<T>& c, contact_figures& sum) {
    check_contact(name, k, round_shape<First>(c.first, c.first_radius), other_of<Second>(c), sum);
}

template <class First, class Second>
void check_all(const char* name) {
    using T = scalar_type_of<First>;
    contact_figures sum;
    if constexpr (std::same_as<First, cone<T>>) {
        for (int i = 0; i < cone_family_count; ++i) {
            const auto f = static_cast<cone_family>(i);
            for (std::uint64_t k = 0; k < some_samples(f == cone_family::near_contact ? 500 : 125); ++k) {
                check_pair<First, Second>(name_of(f), k, make_cone_pair<Second>(pair_contact_seed, f, k), sum);
            }
        }
    } else {
        for (int i = 0; i < round_family_count; ++i) {
            const auto f = static_cast<round_family>(i);
            for (std::uint64_t k = 0; k < some_samples(f == round_family::near_contact ? 500 : 125); ++k) {
                check_pair<First, Second>(name_of(f), k, make_round_pair<Second>(pair_contact_seed, f, k), sum);
            }
        }
    }
    for (std::uint64_t k = 0; k < some_samples(25); ++k) {
        check_pair<First, Second>("through each other", k, through_each_other<T>(k), sum);
    }
    check_figures(name, sum);
    CHECK(sum.touching * 10 > some_samples(125) * cone_family_count);
    CHECK(sum.moved * 10 > sum.touching * 5);
}

/// A cylinder or a cone of ordinary proportions, in any direction, near the origin.
template <class S>
S ordinary_solid(draws& d) {
    using namespace construction;
    using T = scalar_type_of<S>;
    const point at = cube(d, 0.75);
    const segment<T> axis{round_to<T>(at), round_to<T>(along(at, d.uniform(0.5, 2), unit(cube(d, 1))))};
    return round_shape<S>(axis, rounded_to<T>(d.uniform(0.25, 1)));
}
/// How many of those that touch are known in plain doubles; some of them are looked at by the oracle.
template <class S, class U>
void check_first_stage(const char* name, std::uint64_t kind) {
    using namespace construction;
    using T = scalar_type_of<S>;
    contact_figures sum;
    std::size_t touching = 0, known = 0;
    for (std::uint64_t k = 0; k < some_samples(10); ++k) {
        draws d(pair_contact_seed, 200 + 2 * kind + sizeof(T) / 8, k);
        const S s = ordinary_solid<S>(d);
        const point at = cube(d, 1);
        U t{};
        if constexpr (std::same_as<U, aabb<T>>) {
            t = {round_to<T>(along(at, -d.uniform(0.1, 1), {1, 1, 0.5})),
                 round_to<T>(along(at, d.uniform(0.1, 1), {0.5, 1, 1}))};
        } else if constexpr (std::same_as<U, sphere<T>>) {
            t = {round_to<T>(at), rounded_to<T>(d.uniform(0, 1))};
        } else {
            t = ordinary_solid<U>(d);
        }
        if (!intersects(s, t)) continue;
        ++touching;
        if constexpr (std::same_as<U, sphere<T>>) {
            known += detail::first_contact_of(s, t, detail::plain_pair<S, U>(s, t)).touch == verdict::yes ? 1 : 0;
        } else {
            known += detail::find_contact_in_doubles(s, t).is_known ? 1 : 0;
        }
        if (k % 4 == 0) check_contact(name, k, s, t, sum);
    }
    std::printf("%s: %zu of %zu known in doubles\n", name, known, touching);
    CHECK(touching * 5 > some_samples(10));
    CHECK(is_share_above(0.98, known, touching));
    check_figures(name, sum);
}

}  // namespace

TEMPLATE_TEST_CASE("contacts of ordinary cylinders and cones are known in plain doubles", "", float, double) {
    using T = TestType;
    check_first_stage<cylinder<T>, sphere<T>>("cylinder, sphere", 0);
    check_first_stage<cone<T>, sphere<T>>("cone, sphere", 1);
    check_first_stage<cylinder<T>, capsule<T>>("cylinder, capsule", 2);
    check_first_stage<cone<T>, capsule<T>>("cone, capsule", 3);
    check_first_stage<cylinder<T>, cylinder<T>>("two cylinders", 4);
    check_first_stage<cone<T>, cylinder<T>>("cone, cylinder", 5);
    check_first_stage<cone<T>, cone<T>>("two cones", 6);
    check_first_stage<cylinder<T>, aabb<T>>("cylinder, box", 7);
    check_first_stage<cone<T>, aabb<T>>("cone, box", 8);
}

TEMPLATE_TEST_CASE("contacts of cylinders, cones and capsules are what they say, in each family", "", float, double) {
    using T = TestType;
    std::printf("contacts of pairs: seed %llu\n", static_cast<unsigned long long>(pair_contact_seed));
    check_all<cylinder<T>, cylinder<T>>("two cylinders");
    check_all<cylinder<T>, capsule<T>>("cylinder, capsule");
    check_all<cone<T>, cone<T>>("two cones");
    check_all<cone<T>, cylinder<T>>("cone, cylinder");
    check_all<cone<T>, capsule<T>>("cone, capsule");
}

TEST_CASE("contacts of cylinders, cones and capsules: by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr cone<double> tip{{0, 0, 4}, {0, 0, 0}, 3};
    // One on the other.
    static_assert(contact_of(rod, cylinder<double>{{{0.5, 0, 1.75}, {0.5, 0, 9}}, 2})->depth == 0.25);
    static_assert(contact_of(rod, cylinder<double>{{{0.5, 0, 1.75}, {0.5, 0, 9}}, 2})->normal == vec{0, 0, -1});
    // Side by side, and across.
    static_assert(contact_of(rod, cylinder<double>{{{1.5, 0, 0}, {1.5, 0, 2}}, 1})->depth == 0.5);
    static_assert(contact_of(rod, capsule<double>{{{1.75, -5, 1}, {1.75, 5, 1}}, 1})->normal == vec{-1, 0, 0});
    static_assert(contact_of(capsule<double>{{{1.75, -5, 1}, {1.75, 5, 1}}, 1}, rod)->depth == 0.25);
    static_assert(contact_of(tip, cone<double>{{0, 0, -4}, {0, 0, 0.5}, 1})->depth == 0.5);
    static_assert(contact_of(tip, capsule<double>{{{0, 0, -3}, {0, 0, -0.75}}, 1})->depth == 0.25);
    static_assert(!contact_of(tip, cylinder<double>{{{3, 0, 1}, {9, 0, 1}}, 0.5}));
    CHECK(contact_of(tip, capsule<double>{{{4, 0, 5}, {1.6, 0, 3.2}}, 1})->depth == Approx(0.2));  // across the side
    // Without length they are balls.
    static_assert(contact_of(cylinder<double>{{{0, 0, 0}, {0, 0, 0}}, 2}, cone<double>{{3, 0, 0}, {3, 0, 0}, 2})->depth ==
                  1);
    static_assert(contact_of(rod, cone<double>{{0, 0, 2.5}, {0, 0, 2.5}, 1})->depth == 0.5);
    static_assert(contact_of(tip, capsule<double>{{{0, 0, -0.5}, {0, 0, -0.5}}, 1})->depth == 0.5);
    static_assert(detail::contact_pair<cylinder<float>, cylinder<float>> &&
                  detail::contact_pair<cone<double>, capsule<double>>);
}

}  // namespace abut::test
