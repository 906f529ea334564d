// SPDX-License-Identifier: MIT
#include <abut/predicate/intersects.hpp>

#include <atomic>
#include <cstdint>
#include <type_traits>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/pair_orders.hpp"
#include "support/samples.hpp"
#include "support/solid_pairs.hpp"
#include "support/stages.hpp"

// Pairs of shapes of which none is a triangle: every stage against the oracle, family by family, by turns of all kinds.

namespace {

using namespace abut;

// Constant expressions, in either order: what touches in one point, and what is a step away from that.
constexpr float below_1 = 0x1.fffffep-1f;
static_assert(intersects(vec3<float>{1, 2, 2}, vec3<float>{1, 2, 2}) &&
              !intersects(vec3<float>{1, 2, 2}, vec3<float>{below_1, 2, 2}));
static_assert(intersects(segment<float>{{0, 0, 0}, {2, 4, 4}}, vec3<float>{1, 2, 2}) &&
              !intersects(vec3<float>{below_1, 2, 2}, segment<float>{{0, 0, 0}, {2, 4, 4}}));
static_assert(intersects(capsule<float>{{{-9, 0, 2}, {9, 0, 2}}, 1}, capsule<float>{{{0, -9, 0}, {0, 9, 0}}, 1}) &&
              !intersects(capsule<float>{{{-9, 0, 2}, {9, 0, 2}}, 1}, capsule<float>{{{0, -9, 0}, {0, 9, 0}}, below_1}));
static_assert(intersects(aabb<float>{{0, 0, 0}, {1, 1, 1}}, aabb<float>{{1, 1, 1}, {2, 2, 2}}) &&
              !intersects(aabb<float>{{0, 0, 0}, {1, 1, below_1}}, aabb<float>{{1, 1, 1}, {2, 2, 2}}));
static_assert(intersects(sphere<double>{{3, 4, 5}, 5}, aabb<double>{{-1, -1, 0}, {0, 0, 9}}) &&
              !intersects<exact>(aabb<double>{{-1, -1, 0}, {0, 0, 9}}, sphere<double>{{3, 4, 5}, 0x1.3ffffffffffffp2}));
// A capsule across an edge of a box, and one through it.
static_assert(intersects(aabb<double>{{-1, -1, -9}, {0, 0, 9}}, capsule<double>{{{7, 1, -5}, {-1, 7, 5}}, 5}) &&
              !intersects(aabb<double>{{-1, -1, -9}, {0, 0, 9}},
                          capsule<double>{{{7, 1, -5}, {-1, 7, 5}}, 0x1.3ffffffffffffp2}));
static_assert(intersects(capsule<float>{{{-9, 1, 1}, {9, 1, 2}}, 0}, aabb<float>{{0, 0, 0}, {3, 3, 3}}));
static_assert(intersects(plane<float>{{1, 2, 2}, 9}, sphere<float>{{0, 0, 0}, 3}) &&
              !intersects(sphere<float>{{0, 0, 0}, 3}, plane<float>{{1, 2, 2}, 0x1.200002p3f}));
static_assert(intersects(plane<float>{{1, 1, 1}, 3}, aabb<float>{{0, 0, 0}, {1, 1, 1}}) &&
              !intersects(plane<float>{{-1, -1, -1}, 1}, aabb<float>{{0, 0, 0}, {1, 1, 1}}));
// Planes are everything, nothing, one, parallel, or meet in a line.
static_assert(intersects(plane<float>{{0, 0, 0}, 0}, plane<float>{{1, 2, 3}, 4}) &&
              !intersects(plane<float>{{0, 0, 0}, 1}, plane<float>{{0, 0, 0}, 0}) &&
              intersects(plane<float>{{1, 2, 3}, 4}, plane<float>{{-2, -4, -6}, -8}) &&
              !intersects(plane<float>{{1, 2, 3}, 4}, plane<float>{{-2, -4, -6}, 8}) &&
              intersects(plane<float>{{1, 2, 3}, 4}, plane<float>{{1, 2, 4}, 4}));

static_assert(test::pairs_have_their_orders<float> && test::pairs_have_their_orders<double>);
static_assert(decidable_pair<aabb<float>, capsule<float>> && !decidable_pair<aabb<float>, capsule<double>>);
static_assert(!decidable_pair<ray<float>, segment<float>> && !decidable_pair<segment<float>, ray<float>>);

template <class S, class U>
bool touch_by_oracle(const S& s, const U& t) {
    return test::oracle::within_distance(s, t, 0);
}
template <class T>
bool touch_by_oracle(const plane<T>& a, const plane<T>& b) {
    return test::oracle::planes_meet(a, b);
}

/// How many digits the integers need; of comparisons 0.
template <class S, class U>
int width_of_values(const S& s, const U& t) {
    const auto width = [](const auto& row) { return aligned<std::extent_v<decltype(row.value)>>(row.value).width(); };
    if constexpr (detail::pair_of_boxes<S, U>) {
        return 0;
    } else if constexpr (requires { t.radius; } || detail::pair_without_faces<S, U>) {
        if constexpr (requires { detail::nearest_in_box(s, t).radius; }) {
            return width(detail::values_of(detail::nearest_in_box(s, t), t));
        } else if constexpr (requires { s.normal; }) {
            return width(detail::values_over(s, t, 0.0));
        } else {
            return width(detail::values_within(s, t, 0));
        }
    } else {
        return width(detail::values_of(s, t));
    }
}

/// Tries every stage on one pair.
template <class S, class U>
void examine_solids(const S& s, const U& t, std::uint64_t index, test::stage_tally& sum) {
    const int width = width_of_values(s, t);
    const bool truth = touch_by_oracle(s, t), quick = intersects<fast>(s, t);
    const verdict by_filter = decide<filtered>(s, t), late = test::late_verdict(s, t), by_limbs = decide<exact>(s, t);
    bool wrong = sum.count(truth, quick, by_filter, late, by_limbs, width);
    wrong = wrong || (by_limbs == verdict::unknown && width <= 124);
    wrong = wrong || intersects(s, t) != truth || intersects(t, s) != truth || intersects<exact>(t, s) != truth;
    if (by_limbs == verdict::unknown || index % 16 == 0) wrong = wrong || resolve(s, t) != truth;
    sum.wrong += wrong;
}

}  // namespace

TEST_CASE("pairs without a triangle: every stage is right in every family") {
    std::atomic<std::uint64_t> hits[test::solid_pair_kinds]{}, all[test::solid_pair_kinds]{};
    test::check_every_family<test::solid_family>(
        "Pairs without a triangle", "without-triangle.md", true, test::solid_family_count,
        [](test::solid_family f) { return test::name_of(f); },
        [&]<class T>(T, test::solid_family family, std::uint64_t k, test::stage_tally& sum) {
            const int kind = static_cast<int>(k % test::solid_pair_kinds);
            test::with_solid_pair<T>(kind, test::sample_seed, family, k / test::solid_pair_kinds,
                                     [&](const auto& s, const auto& t) {
                                         const std::uint64_t before = sum.hits;
                                         examine_solids(s, t, k, sum);
                                         hits[kind] += sum.hits - before;
                                         ++all[kind];
                                     });
        });
    // Of each kind of pair some touch and some do not.
    for (int kind = 0; kind < test::solid_pair_kinds; ++kind) {
        CAPTURE(kind, hits[kind].load(), all[kind].load());
        CHECK(hits[kind] * 20 > all[kind]);
        CHECK(hits[kind] * 20 < 19 * all[kind]);
    }
}

TEMPLATE_TEST_CASE("pairs without a triangle: near contact far from the origin", "", float, double) {
    using T = TestType;
    test::stage_tally sum;
    const auto examine = [&]<class S, class U>(S*, U*, std::uint64_t k) {
        auto p = test::make_solid_pair<S, U>(test::sample_seed + 3, test::solid_family::offset_1e6, k);
        test::draws d(test::sample_seed, 8899, k);
        test::construction::bring_to_contact(d, p.s, p.t);
        examine_solids(p.s, p.t, k, sum);
    };
    constexpr sphere<T>* a_sphere = nullptr;
    constexpr capsule<T>* a_capsule = nullptr;
    for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
        examine(static_cast<plane<T>*>(nullptr), a_sphere, k);
        examine(static_cast<plane<T>*>(nullptr), a_capsule, k);
        examine(static_cast<aabb<T>*>(nullptr), a_capsule, k);
    }
    CHECK(sum.wrong == 0);
    CHECK(sum.hits * 5 > sum.pairs);
    CHECK(sum.hits * 5 < 4 * sum.pairs);
}

TEMPLATE_TEST_CASE("pairs without a triangle: right in every floating-point mode", "", float, double) {
    using T = TestType;
    for (const test::floating_mode& mode : test::floating_modes()) {
        CAPTURE(mode.name);
        std::uint64_t wrong = 0, hits = 0, pairs = 0;
        for (int i = 0; i < test::solid_family_count; ++i) {
            for (std::uint64_t k = 0; k < test::sample_count() / 20; ++k) {
                test::with_solid_pair<T>(static_cast<int>(k % test::solid_pair_kinds), test::sample_seed + 2,
                                         static_cast<test::solid_family>(i), k, [&](const auto& s, const auto& t) {
                                             const bool truth = touch_by_oracle(s, t);
                                             bool answer = !truth;
                                             verdict by_filter{}, late{};
                                             test::in_mode(mode, [&] {
                                                 answer = intersects(s, t);
                                                 by_filter = decide<filtered>(s, t);
                                                 late = test::late_verdict(s, t);
                                             });
                                             wrong += answer != truth || by_filter == to_verdict(!truth) ||
                                                      late == to_verdict(!truth);
                                             hits += truth;
                                             ++pairs;
                                         });
            }
        }
        CHECK(wrong == 0);
        CHECK(hits * 10 > pairs);
        CHECK(hits * 10 < 9 * pairs);
    }
}
