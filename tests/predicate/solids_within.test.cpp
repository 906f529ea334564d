// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <atomic>
#include <cstdint>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"
#include "support/solid_pairs.hpp"
#include "support/stages.hpp"

// Boxes and planes within a distance of other shapes: every stage against the oracle, for distances that are the least
// double that is enough, a step below and above, and far away.

namespace {

using namespace abut;

static_assert(within(aabb<float>{{0, 0, 0}, {1, 1, 1}}, aabb<float>{{4, 5, 1}, {6, 6, 6}}, 5) &&
              !within<exact>(aabb<float>{{0, 0, 0}, {1, 1, 1}}, aabb<float>{{4, 5, 1}, {6, 6, 6}}, 0x1.3ffffffffffffp2));
static_assert(within(triangle<float>{{-9, -9, 3}, {9, -9, 3}, {0, 9, 3}}, aabb<float>{{0, 0, 0}, {1, 1, 1}}, 2) &&
              !within(triangle<float>{{-9, -9, 3}, {9, -9, 3}, {0, 9, 3}}, aabb<float>{{0, 0, 0}, {1, 1, 1}}, 1));
static_assert(within(plane<float>{{2, 3, 6}, 0}, sphere<float>{{2, 3, 6}, 1}, 6) &&
              !within(sphere<float>{{2, 3, 6}, 1}, plane<float>{{2, 3, 6}, 0}, 0x1.7ffffffffffffp2));
static_assert(!distance_decidable<plane<float>, plane<float>> && !distance_decidable<ray<float>, plane<float>>);

template <class S, class U>
verdict late_within(const S& s, const U& t, double d) {
    if constexpr (requires { detail::decide_within_late<filtered>(s, t, d); }) {
        return detail::decide_within_late<filtered>(s, t, d);
    } else {
        return verdict::unknown;
    }
}

/// Tries every stage on one pair.
template <class S, class U>
void examine_solids_within(const S& s, const U& t, double d, bool truth, std::uint64_t index, test::stage_tally& sum) {
    const bool quick = within<fast>(s, t, d);
    const verdict by_filter = detail::decide_within<filtered>(s, t, d), late = late_within(s, t, d),
                  by_limbs = detail::decide_within<exact>(s, t, d);
    // How many digits the integers need is not asked here: two limbs, or more.
    const int width = by_limbs != verdict::unknown ? 124 : 125;
    bool wrong = sum.count(truth, quick, by_filter, late, by_limbs, width);
    wrong = wrong || within(s, t, d) != truth || within<exact>(t, s, d) != truth;
    if (by_limbs == verdict::unknown || index % 16 == 0) wrong = wrong || detail::resolve_within(s, t, d) != truth;
    sum.wrong += wrong;
}

}  // namespace

TEST_CASE("within, boxes and planes: every stage is right in every family") {
    std::atomic<std::uint64_t> hits[test::within_pair_kinds]{}, all[test::within_pair_kinds]{};
    test::check_every_family<test::solid_family>(
        "Boxes and planes within a distance", "solids-within.md", true, test::solid_family_count,
        [](test::solid_family f) { return test::name_of(f); },
        [&]<class T>(T, test::solid_family family, std::uint64_t k, test::stage_tally& sum) {
            const int kind = static_cast<int>(k % test::within_pair_kinds);
            test::with_within_pair<T>(
                kind, test::sample_seed + 5, family, k / test::within_pair_kinds,
                [&](const auto& s, const auto& t) {
                    const double d = test::distance_near(test::oracle::least_distance(s, t), k / test::within_pair_kinds);
                    const bool truth = test::oracle::within_distance(s, t, d);
                    examine_solids_within(s, t, d, truth, k, sum);
                    hits[kind] += truth;
                    ++all[kind];
                });
        },
        32);
    for (int kind = 0; kind < test::within_pair_kinds; ++kind) {
        CAPTURE(kind, hits[kind].load(), all[kind].load());
        CHECK(hits[kind] * 10 > all[kind]);
        CHECK(hits[kind] * 10 < 9 * all[kind]);
    }
}

TEMPLATE_TEST_CASE("within, boxes and planes: right in every floating-point mode, and with 0 as intersects", "", float,
                   double) {
    using T = TestType;
    for (const test::floating_mode& mode : test::floating_modes()) {
        CAPTURE(mode.name);
        std::uint64_t wrong = 0, hits = 0, pairs = 0;
        for (int i = 0; i < test::solid_family_count; ++i) {
            for (std::uint64_t k = 0; k < test::sample_count() / 640; ++k) {
                test::with_within_pair<T>(
                    static_cast<int>(k % test::within_pair_kinds), test::sample_seed + 6,
                    static_cast<test::solid_family>(i), k, [&](const auto& s, const auto& t) {
                        const double d = test::distance_near(test::oracle::least_distance(s, t), k);
                        const bool truth = test::oracle::within_distance(s, t, d);
                        bool answer = !truth;
                        verdict by_filter{}, late{};
                        test::in_mode(mode, [&] {
                            answer = within(s, t, d);
                            by_filter = detail::decide_within<filtered>(s, t, d);
                            late = late_within(s, t, d);
                        });
                        wrong += answer != truth || by_filter == to_verdict(!truth) || late == to_verdict(!truth);
                        wrong += within(s, t, 0) != intersects(s, t);
                        hits += truth;
                        ++pairs;
                    });
            }
        }
        CHECK(wrong == 0);
        CHECK(hits * 5 > pairs);
        CHECK(hits * 5 < 4 * pairs);
    }
}
