// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"
#include "support/within_pairs.hpp"

// Every stage against the oracle, family by family, for distances that are exactly those of the pairs, one step below and
// above, and far away.

namespace {

using namespace abut;

// Constant expressions, in either order: a corner over the face, edges that cross, parallel faces, rounded shapes.
constexpr triangle<float> low{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
constexpr double below_3 = 0x1.7ffffffffffffp1;
static_assert(within(low, triangle<float>{{1, 1, 3}, {1, 2, 5}, {2, 1, 5}}, 3));
static_assert(!within(triangle<float>{{1, 1, 3}, {1, 2, 5}, {2, 1, 5}}, low, below_3));
static_assert(within<exact>(triangle<double>{{0, -1, 0}, {0, 1, 0}, {-5, 0, -5}},
                            triangle<double>{{-1, 0, 3}, {1, 0, 3}, {0, 5, 9}}, 3));
static_assert(!within<exact>(triangle<double>{{0, -1, 0}, {0, 1, 0}, {-5, 0, -5}},
                             triangle<double>{{-1, 0, 3}, {1, 0, 3}, {0, 5, 9}}, below_3));
static_assert(within(low, triangle<float>{{-5, -5, 3}, {9, -5, 3}, {0, 9, 3}}, 3));
static_assert(within(sphere<float>{{1, 1, 9}, 2}, low, 7) && !within(low, sphere<float>{{1, 1, 9}, 2}, 0x1.bffffffffffffp2));
static_assert(within(sphere<double>{{1, 0, 0}, 2}, sphere<double>{{11, 0, 0}, 3}, 5));
static_assert(!within(sphere<double>{{1, 0, 0}, 2}, sphere<double>{{11, 0, 0}, 3}, 0x1.3ffffffffffffp2));
static_assert(within(capsule<float>{{{-9, 1, 5}, {9, 1, 5}}, 1}, segment<float>{{0, -9, 0}, {0, 9, 0}}, 4));
static_assert(within(vec3<float>{3, 4, 0}, vec3<float>{0, 0, 0}, 5) && !within(vec3<float>{3, 4, 1}, vec3<float>{0, 0, 0}, 5));
// A double stays one beside floats.
static_assert(within(vec3<float>{1, 0, 0}, vec3<float>{0, 0, 0}, 1) &&
              !within(vec3<float>{1, 0, 0}, vec3<float>{0, 0, 0}, 0x1.fffffffffffffp-1));
// What crosses is within any distance.
static_assert(within(low, triangle<float>{{1, 1, -2}, {1, 1, 2}, {9, 9, 0}}, 0));
static_assert(within<fast>(low, triangle<float>{{1, 1, -2}, {1, 1, 2}, {9, 9, 0}}, 0));
static_assert(detail::decide_within_late<filtered>(low, triangle<float>{{1, 0.5f, -2}, {1, 0.5f, 2}, {9, 9, 1}}, 0x1p-40) ==
              verdict::yes);
// Degenerate triangles are the segments and points that they span.
static_assert(within(triangle<float>{{0, 0, 5}, {0, 0, 5}, {0, 0, 5}}, triangle<float>{{-1, -1, 0}, {3, 3, 0}, {1, 1, 0}}, 5));
static_assert(!within(triangle<float>{{0, 0, 5}, {0, 0, 5}, {0, 0, 5}}, triangle<float>{{-1, -1, 0}, {3, 3, 0}, {1, 1, 0}},
                      0x1.3ffffffffffffp2));

static_assert(distance_decidable<vec3<float>, capsule<float>> && distance_decidable<segment<double>, segment<double>>);
static_assert(!distance_decidable<vec3<float>, vec3<double>> && !distance_decidable<ray<float>, segment<float>>);

struct within_tally : test::stage_tally {
    std::uint64_t ties = 0;
    within_tally& operator+=(const within_tally& o) {
        test::stage_tally::operator+=(o);
        ties += o.ties;
        return *this;
    }
};

/// Tries every stage on one pair, whose cores are in order.
template <class S, class U>
void examine_within(const S& s, const U& t, double d, bool truth, std::uint64_t index, test::stage_tally& sum) {
    constexpr int n = detail::corners_of_core<S>, m = detail::corners_of_core<U>;
    const bool quick = within<fast>(s, t, d);
    const verdict by_filter = detail::decide_within<filtered>(s, t, d), by_limbs = detail::decide_within<exact>(s, t, d);
    verdict late = verdict::unknown;
    if constexpr (n > 1) late = detail::decide_within_late<filtered>(s, t, d);
    const auto values = detail::values_within(s, t, d);
    const aligned<std::size_t{3 * (n + m) + 3}> integers(values.value);
    const int width = integers.width();

    bool wrong = sum.count(truth, quick, by_filter, late, by_limbs, width);
    wrong = wrong || (by_limbs == verdict::unknown) != (width > 124);
    wrong = wrong || within(s, t, d) != truth || within<exact>(t, s, d) != truth;
    if (by_limbs == verdict::unknown ? index % 4 == 0 : index % 16 == 0) {
        wrong = wrong || detail::resolve_within(s, t, d) != truth;
    }
    if (width <= 60 && index % 4 == 0) {
        using predicate = detail::hulls_within<n, m>;
        wrong = wrong || holds_in_limbs<predicate, 1>(integers) != truth || holds_in_limbs<predicate, 2>(integers) != truth;
    }
    sum.wrong += wrong;
}

const char* name_of_within(int family) {
    return family < test::triangle_family_count ? test::name_of(static_cast<test::triangle_family>(family))
                                                : "whole distances";
}

}  // namespace

TEST_CASE("within: every stage is right in every family") {
    std::atomic<std::uint64_t> ties{0}, ties_of_whole{0};
    test::check_every_family<int>(
        "Within a distance", "within.md", true, test::within_family_count, name_of_within,
        [&]<class T>(T, int family, std::uint64_t k, test::stage_tally& sum) {
            test::with_shapes(test::make_round_pair<T>(test::sample_seed, family, k), k, [&](const auto& s, const auto& t) {
                const test::exact_gap gap(s, t);
                const double d = test::distance_near(gap.least_double(), k / 6);
                const int sign = gap.compared_with(d);
                examine_within(s, t, d, sign <= 0, k, sum);
                (family < test::triangle_family_count ? ties : ties_of_whole) += sign == 0;
            });
        },
        8);
    std::printf("exact ties: %llu, and of whole distances %llu\n", static_cast<unsigned long long>(ties),
                static_cast<unsigned long long>(ties_of_whole));
    CHECK(ties > test::sample_count() / 16);
    CHECK(ties_of_whole > test::sample_count() / 80);
}

TEMPLATE_TEST_CASE("within: right in every floating-point mode", "", float, double) {
    using T = TestType;
    for (const test::floating_mode& mode : test::floating_modes()) {
        CAPTURE(mode.name);
        std::uint64_t wrong = 0, hits = 0, pairs = 0;
        for (int family = 0; family < test::within_family_count; ++family) {
            for (std::uint64_t k = 0; k < test::sample_count() / 80; ++k) {
                const auto p = test::make_round_pair<T>(test::sample_seed + 2, family, k);
                test::with_shapes(p, k, [&](const auto& s, const auto& t) {
                    const test::exact_gap gap(s, t);
                    const double d = test::distance_near(gap.least_double(), k / 6);
                    const bool truth = gap.compared_with(d) <= 0;
                    bool answer = !truth;
                    verdict by_filter{}, late = verdict::unknown;
                    test::in_mode(mode, [&] {
                        answer = within(s, t, d);
                        by_filter = detail::decide_within<filtered>(s, t, d);
                        if constexpr (!requires { s.center; }) late = detail::decide_within_late<filtered>(s, t, d);
                    });
                    wrong += answer != truth || by_filter == to_verdict(!truth) || late == to_verdict(!truth);
                    hits += truth;
                    ++pairs;
                });
            }
        }
        CHECK(wrong == 0);
        CHECK(hits * 4 > pairs);
        CHECK(hits * 4 < 3 * pairs);
    }
}

TEMPLATE_TEST_CASE("within: distance 0 is intersects, and no radius and no length are points and segments", "", float,
                   double) {
    using T = TestType;
    std::uint64_t wrong = 0, hits = 0, asked = 0;
    for (int family = 0; family < test::within_family_count; ++family) {
        for (std::uint64_t k = 0; k < test::sample_count() / 20; ++k) {
            const auto [a, b] = test::make_round_pair<T>(test::sample_seed + 3, family, k);
            const bool flat = intersects(a.flat, b.flat), rod = intersects(a.rod, b.flat), ball = intersects(a.ball, b.ball);
            wrong += within(a.flat, b.flat, 0) != flat || within(b.flat, a.rod, 0) != rod || within(a.ball, b.ball, 0) != ball;
            wrong += within(a.ball, b.flat, 0) != intersects(a.ball, b.flat);
            hits += static_cast<std::uint64_t>(flat) + rod + ball;
            asked += 3;
            // Radius 0, and radii as distances.
            const auto r = static_cast<double>(a.ball.radius);
            wrong += within(a.ball.center, b.flat, r) != intersects(a.ball, b.flat);
            wrong += within(a.rod.axis, b.flat, r) != rod;
            wrong += within(b.ball.center, a.ball, static_cast<double>(b.ball.radius)) != ball;
            wrong += within(a.rod.axis.a, a.rod.axis.b, r) != intersects(sphere<T>{a.rod.axis.a, a.ball.radius},
                                                                         sphere<T>{a.rod.axis.b, T(0)});
        }
    }
    CHECK(wrong == 0);
    CHECK(hits * 20 > asked);
}
