// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <cstdio>
#include <string>
#include <type_traits>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/plain_pairs.hpp"
#include "support/samples.hpp"
#include "support/solid_pairs.hpp"

namespace abut::test {

constexpr std::uint64_t solid_contacts_seed = 20261126;

/// Contacts of one kind of pair in every family in which enough of them touch.
template <class S, class U>
contact_tally check_solid_contacts(const char* name, std::uint64_t wanted) {
    contact_tally tally;
    for (int f = 0; f < solid_family_count; ++f) {
        const auto family = static_cast<solid_family>(f);
        contact_tally of_family;
        for (std::uint64_t i = 0; i < 20 * wanted && of_family.touching < wanted; ++i) {
            const auto p = make_solid_pair<S, U>(solid_contacts_seed, family, i);
            const char* const wrong = check_contact(p.s, p.t, of_family);
            if (wrong != nullptr) FAIL_CHECK(name << ", " << name_of(family) << ", pair " << i << ": " << wrong);
        }
        tally += of_family;
    }
    std::printf("%s: %llu\n", name, static_cast<unsigned long long>(tally.touching));
    CHECK(tally.touching > 2 * wanted);
    return tally;
}

TEMPLATE_TEST_CASE("contacts without a triangle are what they say, in each family", "", float, double) {
    using T = TestType;
    using point = vec3<T>;
    std::printf("contacts without a triangle: seed %llu\n", static_cast<unsigned long long>(solid_contacts_seed));
    contact_tally total;
    total += check_solid_contacts<point, point>("point, point", 10);
    total += check_solid_contacts<point, segment<T>>("point, segment", 10);
    total += check_solid_contacts<point, sphere<T>>("point, sphere", 20);
    total += check_solid_contacts<point, capsule<T>>("point, capsule", 20);
    total += check_solid_contacts<segment<T>, segment<T>>("segment, segment", 10);
    total += check_solid_contacts<segment<T>, capsule<T>>("segment, capsule", 20);
    total += check_solid_contacts<sphere<T>, capsule<T>>("sphere, capsule", 40);
    total += check_solid_contacts<capsule<T>, capsule<T>>("capsule, capsule", 40);
    total += check_solid_contacts<aabb<T>, point>("box, point", 20);
    total += check_solid_contacts<aabb<T>, segment<T>>("box, segment", 20);
    total += check_solid_contacts<aabb<T>, aabb<T>>("box, box", 40);
    total += check_solid_contacts<aabb<T>, sphere<T>>("box, sphere", 40);
    total += check_solid_contacts<aabb<T>, capsule<T>>("box, capsule", 80);
    total += check_solid_contacts<plane<T>, point>("plane, point", 10);
    total += check_solid_contacts<plane<T>, segment<T>>("plane, segment", 20);
    total += check_solid_contacts<plane<T>, sphere<T>>("plane, sphere", 40);
    total += check_solid_contacts<plane<T>, capsule<T>>("plane, capsule", 40);
    total += check_solid_contacts<plane<T>, aabb<T>>("plane, box", 40);
    check_total("contacts without a triangle", total, 3000);
}

/// The depth is the least move in any direction, out of the polytope of the corners.
template <scalar T>
const char* wrong_with_ball_in_box(const sphere<T>& s, const hull<T>& h, contact_tally& tally) {
    const auto c = contact_of(s, h), back = contact_of(h, s);
    if (c.has_value() != intersects<exact>(s, h) || back.has_value() != c.has_value()) return "found is not what touches";
    if (!c) return nullptr;
    if (back.value() != detail::reversed(c.value())) return "the other order is not the reverse";
    if (const char* const wrong = wrong_with(s, h, *c, tally)) return wrong;
    const wide gap = distance_from(widest(s.center), h), bound = wide(contact_bound(s, h));
    if (gap > 0) return compare_depth(c->depth, wide(s.radius) - gap, bound, tally);
    least_of least(s, h);
    offer_all_features(least, hull_of(h), hull_of(s));
    return least.none() ? nullptr : compare_depth(c->depth, least.value(), bound, tally);
}

TEMPLATE_TEST_CASE("contacts of pairs that a closed form just knows, or not", "", float, double) {
    using T = TestType;
    contact_tally capsules, balls;
    std::uint64_t known = 0, of_boxes = 0;
    for (std::uint64_t i = 0; i < sample_count(); ++i) {
        const auto [s, t] = make_plain_capsules<T>(i);
        INFO("pair " << i);
        const char* const wrong = check_contact(s, t, capsules);
        if (wrong != nullptr) FAIL_CHECK(wrong);
        known += detail::first_contact_in_any_order<T>(s, t).touch == verdict::yes;
        if (i % 2 == 0) continue;
        const char* const of_ball = check_contact(sphere<T>{s.axis.a, s.radius}, t, capsules);
        if (of_ball != nullptr) FAIL_CHECK(of_ball);
    }
    contact_tally beside;
    for (std::uint64_t i = 0; i < sample_count() / 4; ++i) {
        const auto [box, rod] = make_plain_box_and_capsule<T>(i);
        INFO("box and capsule " << i);
        const char* const wrong = check_contact(box, rod, beside);
        if (wrong != nullptr) FAIL_CHECK(wrong);
    }
    check_total("capsules beside boxes", beside, sample_count() / 16);
    for (std::uint64_t i = 0; i < sample_count() / 4; ++i) {
        const auto [box, ball] = make_plain_box_and_ball<T>(i);
        const auto corners = detail::points_of(box);
        INFO("box " << i);
        const char* const wrong = wrong_with_ball_in_box(ball, corners.as_hull(), balls);
        if (wrong != nullptr) FAIL_CHECK(wrong);
        of_boxes += detail::first_contact_in_any_order<T>(box, ball).touch == verdict::yes;
        CHECK(contact_of(box, ball) == contact_of(corners.as_hull(), ball));
    }
    check_total("capsules, as near as can be", capsules, sample_count() / 8);
    check_total("balls and boxes under a pose", balls, sample_count() / 16);
    std::printf("of them first known: %llu, %llu\n", static_cast<unsigned long long>(known), static_cast<unsigned long long>(of_boxes));
    CHECK(known > sample_count() / 8);
    CHECK(of_boxes > sample_count() / 40);
    CHECK(of_boxes < balls.touching);
}

TEST_CASE("contacts without a triangle: by hand, and in constant expressions") {
    using box = aabb<double>;
    using pill = capsule<double>;
    constexpr box cube{{0, 0, 0}, {4, 4, 4}};
    static_assert(contact_of(cube, box{{3, 1, 1}, {9, 2, 2}}) == contact<double>{0, 0, {3.5, 1.5, 1.5}, {-1, 0, 0}, 1});
    static_assert(contact_of(cube, sphere<double>{{2, 2, 5}, 2}) == contact<double>{0, 0, {2, 2, 4}, {0, 0, -1}, 1});
    static_assert(contact_of(sphere<double>{{2, 2, 3}, 2}, cube) == contact<double>{0, 0, {2, 2, 3}, {0, 0, 1}, 3});
    static_assert(contact_of(cube, pill{{{-9, 2, 5}, {9, 2, 5}}, 2})->depth == 1);
    static_assert(contact_of(pill{{{-1, 0, 3}, {1, 0, 3}}, 2}, pill{{{0, -1, 0}, {0, 1, 0}}, 2}) ==
                  contact<double>{0, 0, {0, 0, 1.5}, {0, 0, 1}, 1});
    static_assert(contact_of(plane<double>{{0, 0, 2}, 2}, sphere<double>{{3, 4, 2}, 2}) ==
                  contact<double>{0, 0, {3, 4, 1}, {0, 0, -1}, 1});
    static_assert(contact_of(plane<double>{{0, 0, 2}, 2}, cube) == contact<double>{0, 0, {2, 2, 1}, {0, 0, -1}, 1});
}

}  // namespace abut::test
