// SPDX-License-Identifier: MIT
#include <abut/predicate/hull_within.hpp>

#include <abut/predicate/within.hpp>

#include <cstdint>
#include <cstdio>

#include "support/catch.hpp"
#include "support/hull_families.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"

// Convex hulls within a distance of each other and of other shapes: every stage against the oracle, for distances that are
// the least double that is enough, a step below and above, and far away. The oracle: hulls meet, by linear programming; or
// else the support of the differences' nearest point is found on their Gram matrix, in unbounded integers.

namespace {

using namespace abut;

constexpr vec3<float> tent_points[5] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}, {2, 2, 2}};
constexpr hull<float> tent(tent_points, 5);

// From a face, an edge and a corner, one step less, and with radii; the distance is a double.
static_assert(within(tent, vec3<float>{1, 2, -0.5f}, 0.5) && !within(tent, vec3<float>{1, 2, -0.5f}, 0x1.fffffffffffffp-2));
static_assert(within(segment<float>{{-3, 9, -4}, {-3, -9, -4}}, tent, 5));
static_assert(!within<exact>(tent, segment<float>{{-3, 9, -4}, {-3, -9, -4}}, 0x1.3ffffffffffffp2));
static_assert(within(sphere<float>{{-2, -3, -6}, 2}, tent, 5) &&
              !within(tent, sphere<float>{{-2, -3, -6}, 2}, 0x1.3ffffffffffffp2));
static_assert(within(tent, plane<float>{{0, 0, 2}, 10}, 3) &&
              !within(plane<float>{{0, 0, 2}, 10}, tent, 0x1.7ffffffffffffp1));
static_assert(within(tent, tent, 0) && distance_decidable<capsule<double>, hull<double>> &&
              distance_decidable<hull<float>, aabb<float>> && !distance_decidable<hull<float>, vec3<double>> &&
              !distance_decidable<hull<float>, ray<double>>);

constexpr int kinds = test::kinds_beside_hulls;

struct hull_within_tally {
    std::uint64_t pairs = 0, hits = 0, filter = 0, wrong = 0;
};

template <class H, class U>
verdict late_stage(const H& h, const U& u, double d) {
    if constexpr (requires { detail::decide_within_late<filtered>(h, u, d); }) {
        return detail::decide_within_late<filtered>(h, u, d);
    } else {
        return verdict::unknown;
    }
}
/// A plane comes first.
template <class H, class T>
verdict late_stage(const H&, const plane<T>&, double) {
    return verdict::unknown;
}
template <class A, class H, class U>
verdict first_stage(const H& h, const U& u, double d) {
    if constexpr (detail::within_as_given<H, U>) {
        return detail::decide_within<A>(h, u, d);
    } else {
        return detail::decide_within<A>(u, h, d);
    }
}

template <class T, class U>
void examine_hull_within(const hull<T>& h, const U& other, std::uint64_t index, hull_within_tally& sum) {
    const test::hull_question<T, U> ask{h, other};
    const double d = test::distance_near(ask.least_distance(), index);
    const bool truth = ask.truth(d);
    const verdict lie = to_verdict(!truth), by_filter = first_stage<filtered>(h, other, d);
    ++sum.pairs;
    sum.hits += truth;
    sum.filter += by_filter != verdict::unknown;
    bool wrong = by_filter == lie || late_stage(h, other, d) == lie || first_stage<exact>(h, other, d) == lie;
    wrong = wrong || within(h, other, d) != truth || within<exact>(other, h, d) != truth;
    wrong = wrong || first_stage<fast>(h, other, d) == verdict::unknown;
    if (index % 8 == 0) {
        if constexpr (detail::within_as_given<hull<T>, U>) {
            wrong = wrong || detail::resolve_within(h, other, d) != truth;
        } else {
            wrong = wrong || detail::resolve_within(other, h, d) != truth;
        }
    }
    sum.wrong += wrong;
}

}  // namespace

TEMPLATE_TEST_CASE("within, hulls: every stage is right in every family", "", float, double) {
    using T = TestType;
    std::printf("hulls within a distance, seed %llu\n| family | pairs | hits %% | filter %% | wrong |\n",
                static_cast<unsigned long long>(test::sample_seed));
    std::uint64_t hits[kinds] = {}, all[kinds] = {};
    for (const test::hull_family f : test::families_of_few_points) {
        hull_within_tally sum;
        const std::uint64_t samples = test::sample_count() / (f == test::hull_family::exponents ? 64 : 12);
        for (std::uint64_t k = 0; k < samples; ++k) {
            const auto kind = static_cast<int>(k % kinds);
            const auto both = test::make_few_points<T>(test::sample_seed + 7, f, k);
            const std::uint64_t before = sum.hits;
            test::with_shape_beside_hull(
                kind, both, k, [&](const auto& h, const auto& other) { examine_hull_within(h, other, k / kinds, sum); });
            hits[kind] += sum.hits - before;
            ++all[kind];
        }
        const auto percent = [&sum](std::uint64_t n) {
            return 100.0 * static_cast<double>(n) / static_cast<double>(sum.pairs);
        };
        std::printf("| %s | %llu | %.1f | %.1f | %llu |\n", test::name_of(f), static_cast<unsigned long long>(sum.pairs),
                    percent(sum.hits), percent(sum.filter), static_cast<unsigned long long>(sum.wrong));
        INFO(test::name_of(f));
        CHECK(sum.wrong == 0);
        CHECK(percent(sum.hits) > 10);
        CHECK(percent(sum.hits) < 95);
    }
    for (int kind = 0; kind < kinds; ++kind) {
        CAPTURE(kind, hits[kind], all[kind]);
        CHECK(hits[kind] * 10 > all[kind]);
        CHECK(hits[kind] * 10 < 9 * all[kind]);
    }
}

TEMPLATE_TEST_CASE("within, hulls: right in every floating-point mode, and with 0 as intersects", "", float, double) {
    using T = TestType;
    std::uint64_t wrong = 0, hits = 0, pairs = 0;
    const auto modes = test::floating_modes();
    for (const test::hull_family f : test::families_of_few_points) {
        for (std::uint64_t k = 0; k < 5 * kinds; ++k) {
            const auto both = test::make_few_points<T>(test::sample_seed + 8, f, k);
            test::with_shape_beside_hull(static_cast<int>(k % kinds), both, k, [&](const auto& h, const auto& other) {
                const test::hull_question<T, std::remove_cvref_t<decltype(other)>> ask{h, other};
                const double d = test::distance_near(ask.least_distance(), k);
                const bool truth = ask.truth(d);
                for (const test::floating_mode& mode : modes) {
                    bool answer = !truth;
                    verdict by_filter{}, late{};
                    test::in_mode(mode, [&] {
                        answer = within(h, other, d);
                        by_filter = first_stage<filtered>(h, other, d);
                        late = late_stage(h, other, d);
                    });
                    wrong += answer != truth || by_filter == to_verdict(!truth) || late == to_verdict(!truth);
                }
                wrong += within(h, other, 0) != intersects(h, other);
                hits += truth;
                ++pairs;
            });
        }
    }
    CHECK(wrong == 0);
    CHECK(hits * 5 > pairs);
    CHECK(hits * 5 < 4 * pairs);
}
