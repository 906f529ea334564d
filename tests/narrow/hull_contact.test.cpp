// SPDX-License-Identifier: MIT
#include <abut/narrow/hull_contact.hpp>

#include <abut/narrow/contact.hpp>
#include <abut/predicate/within.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <vector>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/hull_pairs.hpp"
#include "support/hulls.hpp"
#include "support/samples.hpp"

// Contacts of convex hulls against the definition, in 300 bits: what holds of any contact (support/contact_oracles.hpp), and
// the least of all moves that separate, by brute force.

namespace {

using namespace abut;
using test::wide;
using test::wide_point;

constexpr vec3<double> die[8] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {0, 0, 4}, {4, 0, 4}, {0, 4, 4}, {4, 4, 4}};
constexpr vec3<double> tip[4] = {{1, 1, 3}, {2, 1, 9}, {1, 2, 9}, {3, 3, 9}};
constexpr hull<double> die_hull(die, 8), tip_hull(tip, 4);

// In constant expressions: out of a face, across edges, and round shapes inside and outside of the die.
static_assert(contact_of(tip_hull, die_hull) == contact<double>{0, 0, {1, 1, 3}, {0, 0, 1}, 1});
static_assert(contact_of(die_hull, tip_hull)->normal == vec3<double>{0, 0, -1});
static_assert(contact_of(die_hull, sphere<double>{{2, 2, 5}, 1.5}) == contact<double>{0, 0, {2, 2, 4}, {0, 0, -1}, 0.5});
static_assert(contact_of(sphere<double>{{2, 2, 3}, 1.5}, die_hull)->depth == 2.5);
static_assert(contact_of(die_hull, vec3<double>{4, 1, 1})->depth == 0 && !contact_of(die_hull, vec3<double>{4.5, 1, 1}));
static_assert(contact_of(die_hull, plane<double>{{0, 0, 3}, 3}) == contact<double>{0, 0, {0, 0, 1}, {0, 0, 1}, 1});

template <class S>
wide radius_of(const S& s) {
    return wide(detail::radius_around_core(s));
}

/// The least of all moves that separate.
template <scalar T, class U>
wide least_move(const hull<T>& h, const U& u, bool cores_meet) {
    const test::wide_hull a = test::hull_of(h), b = test::hull_of(u);
    if (!cores_meet) {
        std::vector<wide_point> w;
        for (const wide_point& p : a.corners) {
            for (const wide_point& q : b.corners) w.push_back(p - q);
        }
        const wide over = radius_of(u) - sqrt(test::square_of_gap(w));
        return over > 0 ? over : wide(0);
    }
    test::least_of least(h, u);
    test::offer_all_features(least, a, b);
    return least.none() ? radius_of(u) : least.value();
}

template <scalar T, class U>
bool do_cores_meet(const hull<T>& h, const U& u) {
    const auto core = detail::core_points_of(u);
    return intersects<exact>(h, core.as_hull());
}

/// Along the axes of the lowest three bits, unless the fourth is set.
template <scalar T>
void flatten(test::hull_pair<T>& both, std::uint64_t axes) {
    for (test::point_list<T>* points : {&both.a, &both.b}) {
        for (vec3<T>& p : *points) {
            if (axes < 8 && axes % 2 == 1) p.x = 1;
            if (axes < 8 && axes / 2 % 2 == 1) p.y = 1;
            if (axes < 8 && axes / 4 == 1) p.z = 1;
        }
    }
}

template <scalar T, class U>
bool is_same_hull(const hull<T>& h, const U& u) {
    if constexpr (std::same_as<U, hull<T>>) {
        return std::equal(h.points, h.points + h.count, u.points, u.points + u.count);
    } else {
        return false;
    }
}

/// One pair that touches.
template <scalar T, class U>
const char* wrong_with_pair(const hull<T>& h, const U& u, const contact<T>& found, test::contact_tally& tally) {
    const char* const wrong = test::wrong_with(h, u, found, tally);
    if (wrong != nullptr) return wrong;
    const auto reversed = contact_of<exact>(u, h);
    const bool same = is_same_hull(h, u);  // then the other order is the same question
    if (!reversed || !(*reversed == (same ? found : detail::reversed(found)))) return "the other order has another contact";
    const wide bound = wide(contact_bound(h, u));
    return test::compare_depth(found.depth, least_move(h, u, do_cores_meet(h, u)), bound, tally);
}

constexpr test::hull_family families_in_contact[] = {
    test::hull_family::general,  test::hull_family::far_away,  test::hull_family::lattice,
    test::hull_family::flat,     test::hull_family::line,      test::hull_family::touching,
    test::hull_family::step_off, test::hull_family::exponents, test::hull_family::denormal};
constexpr int kinds = test::kinds_around_points;

/// A radius for a shape among these points.
template <scalar T>
T radius_among(const test::point_list<T>& points, test::draws& d) {
    const auto size = static_cast<double>(detail::contact_math::magnitude_of(test::hull_over(points)));
    return d.below(4) == 0 ? T(0) : static_cast<T>(size * (d.below(2) == 0 ? 1 : d.uniform(0, 0.5)));
}

/// Pair k of a family, if it touches.
template <scalar T>
void check_pair(test::hull_family f, std::uint64_t k, test::contact_tally& tally, std::uint64_t& deep) {
    auto both = test::make_hull_pair<T>(test::sample_seed + 5, f, k);
    if (both.a.size() > 6) both.a.resize(6);
    if (both.b.size() > 5) both.b.resize(5);
    if (f == test::hull_family::lattice) flatten(both, k / 2 % 16);
    test::draws d(test::sample_seed, 9, k);
    const auto kind = static_cast<int>(k % (kinds + 3));
    const T radius = radius_among(both.b, d);
    test::with_shapes_of_kind(kind < kinds ? kind : 0, both, radius, [&](const auto& h, const auto& u) {
        const auto found = contact_of(h, u);
        INFO(test::name_of(f) << " " << k);
        if (found.has_value() != intersects<exact>(h, u)) FAIL_CHECK("there is one exactly where they touch");
        if (!found) return;
        const char* const wrong = wrong_with_pair(h, u, *found, tally);
        deep += found->depth > contact_bound(h, u);
        if (wrong != nullptr) FAIL_CHECK(wrong);
    });
}

}  // namespace

TEMPLATE_TEST_CASE("contacts of hulls: as by definition, in every family", "", float, double) {
    using T = TestType;
    std::printf("contacts of hulls, seed %llu\n", static_cast<unsigned long long>(test::sample_seed));
    test::contact_tally total;
    std::uint64_t deep = 0;
    for (const test::hull_family f : families_in_contact) {
        test::contact_tally tally;
        const std::uint64_t samples = test::sample_count() / (f == test::hull_family::exponents ? 80 : 20);
        for (std::uint64_t k = 0; k < samples; ++k) check_pair<T>(f, k, tally, deep);
        INFO(test::name_of(f));
        CHECK(tally.touching * 12 > samples);
        test::check_total(test::name_of(f), tally, 5);
        total += tally;
    }
    CHECK(deep * 5 > total.touching);
}

TEST_CASE("contacts of hulls: pairs whose normals were longer or shorter than is promised") {
    constexpr struct {
        test::hull_family family;
        std::uint64_t k;
    } once_wrong[] = {{test::hull_family::general, 8434},   {test::hull_family::general, 14675},
                      {test::hull_family::far_away, 12434}, {test::hull_family::far_away, 33314},
                      {test::hull_family::exponents, 3240}, {test::hull_family::exponents, 5744},
                      {test::hull_family::exponents, 8896}, {test::hull_family::exponents, 10630}};
    test::contact_tally tally;
    std::uint64_t deep = 0;
    for (const auto& pair : once_wrong) check_pair<double>(pair.family, pair.k, tally, deep);
    CHECK(tally.touching == std::size(once_wrong));
}

TEMPLATE_TEST_CASE("contacts of hulls: with planes", "", float, double) {
    using T = TestType;
    std::uint64_t touching = 0, deep = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 8; ++k) {
        const auto f = k % 2 == 0 ? test::hull_family::lattice : test::hull_family::general;
        const auto both = test::make_hull_pair<T>(test::sample_seed + 6, f, k);
        const vec3<T>& normal = both.a.front();
        const plane<T> p{normal, static_cast<T>(dot(normal, both.b.front()))};
        const hull<T> h = test::hull_over(both.b);
        const auto found = contact_of(h, p);
        INFO(k);
        REQUIRE(found.has_value() == intersects<exact>(p, h));
        const wide_point n = test::widest(normal);
        if (!found || dot(n, n) == 0) continue;
        ++touching;
        CHECK(*contact_of(p, h) == detail::reversed(*found));
        // Heights over the plane, of the points and of the contact's.
        const wide length = test::length_of(n);
        wide lowest = 0, highest = 0;
        for (std::size_t i = 0; i < h.count; ++i) {
            const wide height = (dot(n, test::widest(h[i])) - wide(p.offset)) / length;
            lowest = i == 0 ? height : std::min(lowest, height);
            highest = i == 0 ? height : std::max(highest, height);
        }
        const wide bound = wide(contact_bound(h, p)), least = std::min<wide>(-lowest, highest);
        CHECK(abs(wide(found->depth) - least) <= bound);
        CHECK(abs((dot(n, test::widest(found->point)) - wide(p.offset)) / length) <= bound);
        CHECK(test::distance_from(test::widest(found->point), h) <= bound);
        const wide along = dot(n, test::widest(found->normal)) / length;
        CHECK(abs(abs(along) - 1) < wide(4 * unit_roundoff<T>));
        if (-lowest + bound < highest) CHECK(along > 0);
        if (highest + bound < -lowest) CHECK(along < 0);
        deep += least > bound;
    }
    CHECK(touching > 100);
    CHECK(deep * 3 > touching);
}

// Many points: directions at random have no lesser overlap, but for what the bound on the polytope's corners leaves.
// A sphere around a place that is as far from a corner as it is wide, but for what is rounded: whether there is a contact is told
// by no search in doubles.
TEMPLATE_TEST_CASE("contacts of hulls: spheres that all but touch", "", float, double) {
    using T = TestType;
    const vec3<T> points[] = {{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {0, 0, 3}, {0, 0, -3}, {0, 0, 0}};
    const hull<T> h(points, 7);
    test::draws d(test::sample_seed, 31, 0);
    int touching = 0, wrong = 0;
    for (int k = 0; k < 400; ++k) {
        const double y = d.uniform(-0.25, 0.25), z = d.uniform(-0.25, 0.25), length = std::sqrt(1 + y * y + z * z), r = d.uniform(0.5, 2);
        const auto radius = static_cast<T>(r);
        const vec3<double> way{r / length, r * y / length, r * z / length};
        const sphere<T> s{{static_cast<T>(3 + way.x), static_cast<T>(way.y), static_cast<T>(way.z)}, radius};
        const bool touch = intersects<exact>(h, s);
        touching += touch ? 1 : 0;
        wrong += contact_of(h, s).has_value() != touch || contact_of(s, h).has_value() != touch ? 1 : 0;
    }
    CHECK(wrong == 0);
    CHECK((touching > 100 && touching < 300));
}

TEMPLATE_TEST_CASE("contacts of hulls: of many points, deep in each other", "", float, double) {
    using T = TestType;
    double worst = 0, worst_shallow = 0;
    for (int k = 0; k < 24; ++k) {
        test::draws d(test::sample_seed, 10, static_cast<std::uint64_t>(k));
        const double apart = k % 2 == 0 ? d.uniform(0, 0.2) : d.uniform(1.2, 1.95);
        const auto side = test::construction::unit(test::construction::cube(d, 1));
        test::point_list<T> a, b;
        for (int i = 0; i < 300; ++i) {
            a.push_back(test::construction::round_to<T>(test::construction::unit(test::construction::cube(d, 1))));
            const auto p = test::construction::unit(test::construction::cube(d, 1));
            b.push_back(test::construction::round_to<T>(test::construction::along(p, apart, side)));
        }
        const hull<T> h = test::hull_over(a), u = test::hull_over(b);
        const auto found = contact_of(h, u);
        REQUIRE(found);
        const T bound = contact_bound(h, u);
        CHECK(!intersects<exact>(test::moved_by(h, found->normal, static_cast<T>(found->depth + bound)), u));
        CHECK((within<exact>(h, found->point, bound) && within<exact>(found->point, u, bound)));
        CHECK(*contact_of(u, h) == detail::reversed(*found));
        // Among directions at random, each improved by smaller and smaller steps.
        double least = 1e9;
        const auto product = [](const test::construction::point& n, const vec3<T>& p) {
            return n.x * static_cast<double>(p.x) + n.y * static_cast<double>(p.y) + n.z * static_cast<double>(p.z);
        };
        const auto overlap = [&](const test::construction::point& n) {
            double most = -1e9, lowest = 1e9;
            for (const auto& q : b) most = std::max(most, product(n, q));
            for (const auto& p : a) lowest = std::min(lowest, product(n, p));
            return most - lowest;
        };
        for (int start = 0; start < 12; ++start) {
            auto n = test::construction::unit(test::construction::cube(d, 1));
            if (start == 0) n = {-side.x, -side.y, -side.z};
            double at_n = overlap(n);
            for (double step = 0.5; step > 1e-4; step *= 0.9) {
                const auto m = test::construction::unit(test::construction::along(n, step, test::construction::cube(d, 1)));
                const double at_m = overlap(m);
                if (at_m < at_n) n = m, at_n = at_m;
            }
            least = std::min(least, at_n);
        }
        const double excess = static_cast<double>(found->depth) / least - 1;
        (k % 2 == 0 ? worst : worst_shallow) = std::max(k % 2 == 0 ? worst : worst_shallow, excess);
    }
    std::printf("contacts of hulls of 300 points: depth above the least one found by %.2g, less deep ones by %.2g\n", worst,
                worst_shallow);
    CHECK(worst < 0.05);
    CHECK(worst_shallow < 1e-3);
}
