// SPDX-License-Identifier: MIT
#include <abut/predicate/revolution.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include <abut/predicate/intersects.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/reach.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/revolution_oracle.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"

namespace {

using namespace abut;

constexpr cylinder<float> drum{{{0, 0, 0}, {0, 0, 2}}, 5};
constexpr cone<double> tip{{0, 0, 0}, {0, 0, 4}, 3};

// Constant expressions, in either order: points of a rim, of the side and of an end.
static_assert(intersects(drum, vec3<float>{3, 4, 2}) && intersects(vec3<float>{-4, 3, 1}, drum));
static_assert(!intersects(drum, vec3<float>{3, 0x1.000002p2f, 2}) && !intersects(drum, vec3<float>{0, 0, 0x1.000002p1f}));
static_assert(intersects<exact>(tip, vec3<double>{0, 0, 0}) && intersects(vec3<double>{3, 0, 4}, tip));
static_assert(!intersects(tip, vec3<double>{0, 0, -0x1p-1074}) && !intersects(tip, vec3<double>{0x1.8000000000001p1, 0, 4}));
// Tangents of a side and of a rim, and faces along them.
static_assert(intersects(drum, segment<float>{{5, -9, 0}, {5, 9, 2}}) &&
              intersects(drum, segment<float>{{7, -1, 2}, {-1, 7, 2}}) ==
                  intersects(drum, triangle<float>{{7, -1, 2}, {-1, 7, 2}, {9, 9, 2}}));
static_assert(intersects(drum, triangle<float>{{7, 1, 2}, {-1, 7, 2}, {9, 9, 9}}));  // 3 x + 4 y = 25 at the rim
static_assert(intersects(segment<double>{{3, -1, 4}, {3, 1, 4}}, tip) &&
              intersects(segment<double>{{0, 0, 0}, {6, 0, 8}}, tip));
static_assert(!intersects(segment<double>{{3, 0x1p-50, 4}, {3, 1, 4}}, tip));
// The axis through a face, and faces that cross one end alone.
static_assert(intersects(tip, triangle<double>{{9, 9, 2}, {-9, 0, 2}, {0, -9, 2}}));
static_assert(intersects(tip, triangle<double>{{2, -9, 3}, {2, 9, 3}, {2, 0, 9}}));
static_assert(!intersects(tip, triangle<double>{{4, -9, 3}, {4, 9, 3}, {4, 0, 9}}));
// Balls beside the side, a rim, an end and the apex.
static_assert(intersects(drum, sphere<float>{{8, 0, 6}, 5}) && !intersects(drum, sphere<float>{{8, 0, 6}, 0x1.3ffffep2f}));
static_assert(intersects(drum, sphere<float>{{8, 0, 1}, 3}) && intersects(sphere<float>{{1, 1, 5}, 3}, drum));
static_assert(intersects(tip, sphere<double>{{7, 0, 1}, 5}) && !intersects(tip, sphere<double>{{7, 0, 1}, 4.9999}));
static_assert(intersects(tip, sphere<double>{{0, 3, -4}, 5}) &&
              !intersects(tip, sphere<double>{{0, 3, -4}, 0x1.3ffffffffffffp2}));
// Boxes and planes.
static_assert(intersects(aabb<float>{{3, 4, 2}, {9, 9, 9}}, drum) && !intersects(drum, aabb<float>{{4, 4, 0}, {9, 9, 9}}));
static_assert(intersects(drum, aabb<float>{{-9, -9, -9}, {9, 9, 9}}) &&
              intersects(drum, aabb<float>{{5, -9, -9}, {9, 9, 9}}));
static_assert(intersects(plane<double>{{0, 0, 1}, 4}, tip) && intersects(tip, plane<double>{{4, 0, 3}, 24}));
static_assert(!intersects(tip, plane<double>{{4, 0, 3}, 0x1.8000000000001p4}) &&
              !intersects(tip, plane<double>{{0, 0, 0}, 1}));
// Without radius they are segments, without length balls.
static_assert(intersects(cylinder<double>{{{0, 0, 0}, {3, 3, 3}}, 0}, vec3<double>{1, 1, 1}));
static_assert(!intersects(cone<double>{{0, 0, 0}, {3, 3, 3}, 0}, vec3<double>{1, 1, 0x1.0000000000001p0}));
static_assert(intersects(cylinder<float>{{{1, 1, 1}, {1, 1, 1}}, 5}, segment<float>{{4, 5, -9}, {4, 5, 9}}));
static_assert(intersects<fast>(cone<float>{{1, 1, 1}, {1, 1, 1}, 5}, plane<float>{{0, 0, 1}, 6}));
static_assert(!intersects<exact>(cone<float>{{1, 1, 1}, {1, 1, 1}, 5}, aabb<float>{{7, 0, 0}, {8, 1, 1}}));
static_assert(intersects(cone<float>{{1, 1, 1}, {1, 1, 1}, 5}, sphere<float>{{7, 1, 1}, 1}));

static_assert(decidable_pair<cylinder<float>, triangle<float>> && decidable_pair<cone<double>, aabb<double>>);
static_assert(!decidable_pair<triangle<float>, cylinder<float>> && !decidable_pair<cone<float>, triangle<double>>);
static_assert(decidable_pair<cylinder<float>, cylinder<float>> && !decidable_pair<cylinder<float>, cone<float>>);
static_assert(!decidable_pair<capsule<float>, cone<float>> && !decidable_pair<capsule<float>, cylinder<float>>);
static_assert(decidable_pair<cylinder<float>, capsule<float>> && !decidable_pair<cylinder<float>, cylinder<double>>);
static_assert(!decidable_pair<cone<float>, ray<float>> && decidable_pair<ray<float>, cylinder<float>>);
static_assert(!decidable_pair<hull<double>, cone<double>> && decidable_pair<cylinder<double>, hull<double>>);

using tally = test::decision_tally;

/// Every stage against the oracle; `fast` is counted where it is unlike.
template <class S, class U>
void examine(const S& s, const U& t, tally& sum) {
    if (!is_valid(s) || !is_valid(t)) return;
    const bool truth = test::oracle::meets(s, t);
    const verdict lie = to_verdict(!truth), by_filter = decide<filtered>(s, t);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += intersects<fast>(t, s) != truth;
    // What culls may not lose it.
    sum.wrong += truth && !(overlaps(bounds(s), bounds(t)) && reach_of(s)(bounds(t)) && reach_of(t)(bounds(s)));
    sum.wrong += by_filter == lie || decide<exact>(s, t) == lie || resolve(s, t) != truth || intersects(s, t) != truth ||
                 intersects(t, s) != truth || intersects<exact>(t, s) != truth;
}

template <class Solid>
void examine_case(test::revolution_family f, std::uint64_t k, tally (&sum)[6]) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    const auto c = test::make_revolution_case<T>(test::sample_seed, f, k, is_cone);
    const Solid s = test::solid_of<Solid>(c.axis, c.radius);
    const triangle<T> t{c.corner[0], c.corner[1], c.corner[2]};
    examine(s, t.a, sum[0]);
    examine(s, segment<T>{t.a, t.b}, sum[1]);
    examine(s, t, sum[2]);
    examine(s, k % 2 == 0 ? bounds(t) : bounds(segment<T>{t.a, t.b}), sum[3]);
    // Their oracle takes long.
    if (k % 10 == 0) examine(s, test::ball_beside(c, is_cone, k / 10), sum[4]);
    if (k % 10 == 0) examine(s, test::plane_beside(c, k / 10), sum[5]);
}

struct tallies {
    tally of[6];
    tallies& operator+=(const tallies& o) {
        for (int i = 0; i < 6; ++i) of[i] += o.of[i];
        return *this;
    }
};

template <class Solid>
void check_every_stage() {
    std::uint64_t pairs[6] = {}, hits[6] = {};
    for (int i = 0; i < test::revolution_family_count; ++i) {
        const auto f = static_cast<test::revolution_family>(i);
        // Rationals of thousands of digits take long.
        const bool is_long = f == test::revolution_family::all_bit_patterns && sizeof(scalar_type_of<Solid>) == 8;
        const std::uint64_t count = test::sample_count() / (is_long ? 400 : 20) + 1;
        const auto all = test::in_threads<tallies>(count, [f](std::uint64_t first, std::uint64_t last, tallies& sum) {
            for (std::uint64_t k = first; k < last; ++k) examine_case<Solid>(f, k, sum.of);
        });
        std::printf("%-16s", test::name_of(f));
        for (int j = 0; j < 6; ++j) {
            const tally& sum = all.of[j];
            CAPTURE(test::name_of(f), j);
            CHECK(sum.wrong == 0);
            if (f == test::revolution_family::random) CHECK(sum.unlike * 20 <= sum.pairs);
            pairs[j] += sum.pairs, hits[j] += sum.hits;
            std::printf(" | %6llu %6llu %6llu %6llu", static_cast<unsigned long long>(sum.pairs),
                        static_cast<unsigned long long>(sum.hits), static_cast<unsigned long long>(sum.open),
                        static_cast<unsigned long long>(sum.unlike));
        }
        std::printf("\n");
    }
    for (int j = 0; j < 6; ++j) {
        CHECK(test::is_share_above(0.05, hits[j], pairs[j]));
        CHECK(test::is_share_above(0.05, pairs[j] - hits[j], pairs[j]));
    }
}

/// x to -z, y to x, z to -y: a mirror and a turn.
template <class T>
vec3<T> turned(const vec3<T>& v) {
    return {-v.z, v.x, -v.y};
}

}  // namespace

TEMPLATE_TEST_CASE("cylinder and cone: every stage is right in every family", "", cylinder<float>, cylinder<double>,
                   cone<float>, cone<double>) {
    check_every_stage<TestType>();
}

TEMPLATE_TEST_CASE("cylinder and cone: one answer for every order of corners, mirror and direction", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::uint64_t differing = 0;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 20; ++k) {
            const auto f = static_cast<test::revolution_family>(i);
            const auto c = test::make_revolution_case<T>(test::sample_seed + 1, f, k, is_cone);
            const auto s = test::solid_of<TestType>(c.axis, c.radius);
            const vec3<T>&p = c.corner[0], &q = c.corner[1], &r = c.corner[2];
            const bool answer = intersects(s, triangle<T>{p, q, r}), edge = intersects(s, segment<T>{p, q});
            const triangle<T> orders[] = {{p, r, q}, {q, p, r}, {q, r, p}, {r, p, q}, {r, q, p}};
            for (const triangle<T>& t : orders) differing += intersects(t, s) != answer;
            differing += intersects(s, segment<T>{q, p}) != edge || intersects(s, triangle<T>{p, q, q}) != edge;
            const auto there = test::solid_of<TestType>({turned(c.axis.a), turned(c.axis.b)}, c.radius);
            differing += intersects(there, triangle<T>{turned(p), turned(q), turned(r)}) != answer;
            const sphere<T> point{p, T(0)};
            differing += intersects(s, point) != intersects(s, p);
            const aabb<T> box = bounds(triangle<T>{p, q, r});
            const aabb<T> turned_box = bounds(segment<T>{turned(box.lower), turned(box.upper)});
            differing += intersects(there, turned_box) != intersects(s, box);
            if constexpr (!is_cone) {
                const TestType back{{c.axis.b, c.axis.a}, c.radius};
                differing += intersects(back, triangle<T>{p, q, r}) != answer || intersects(back, box) != intersects(s, box);
                const plane<T> flat = test::plane_beside(c, k);
                differing += intersects(back, flat) != intersects(s, flat);
            }
        }
    }
    CHECK(differing == 0);
}

TEMPLATE_TEST_CASE("cylinder and cone: right in every floating-point mode", "", cylinder<float>, cylinder<double>,
                   cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::uint64_t wrong = 0;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 100; ++k) {
            const auto f = static_cast<test::revolution_family>(i);
            const auto c = test::make_revolution_case<T>(test::sample_seed + 2, f, k, is_cone);
            const auto s = test::solid_of<TestType>(c.axis, c.radius);
            const auto check = [&](const auto& t) {
                if (!is_valid(t)) return;
                const bool truth = intersects<exact>(s, t);
                wrong += test::modes_in_which(
                    [&] { return intersects(s, t) != truth || decide<filtered>(s, t) == to_verdict(!truth); });
            };
            check(triangle<T>{c.corner[0], c.corner[1], c.corner[2]});
            check(segment<T>{c.corner[0], c.corner[1]});
            check(c.corner[0]);
            check(bounds(segment<T>{c.corner[0], c.corner[1]}));
            check(test::ball_beside(c, is_cone, k));
            check(test::plane_beside(c, k));
        }
    }
    CHECK(wrong == 0);
}
