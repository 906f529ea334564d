// SPDX-License-Identifier: MIT
#include <abut/predicate/revolution_pair.hpp>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/cylinder_pair_families.hpp"
#include "support/cylinder_pair_oracle.hpp"
#include "support/modes.hpp"
#include "support/round_tally.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using test::examine_with_truth, test::finding, test::known, test::round_family, test::round_tally;

constexpr cylinder<float> barrel{{{0, 0, 0}, {0, 0, 2}}, 5};

// Constant expressions: side by side, rim on rim, end on end, sides that cross, and a step before that.
static_assert(intersects(barrel, cylinder<float>{{{9, 12, -1}, {9, 12, 1}}, 10}));
static_assert(intersects(barrel, cylinder<float>{{{6, 8, 2}, {6, 8, 3}}, 5}));
static_assert(intersects<exact>(cylinder<double>{{{0, 0, 0}, {0, 0, 1}}, 1}, cylinder<double>{{{1, 1, 1}, {1, 1, 2}}, 1}));
static_assert(intersects(cylinder<double>{{{-9, 0, 0}, {9, 0, 0}}, 1}, cylinder<double>{{{0, -9, 3}, {0, 9, 3}}, 2}));
static_assert(!intersects(cylinder<double>{{{-9, 0, 0}, {9, 0, 0}}, 1},
                          cylinder<double>{{{0, -9, 3}, {0, 9, 3}}, 0x1.fffffffffffffp0}));
// A capsule's end on a rim, and its side on an end.
static_assert(intersects(barrel, capsule<float>{{{8, 0, 6}, {9, 0, 9}}, 5}));
static_assert(!intersects(capsule<float>{{{8, 0, 6}, {9, 0, 9}}, 0x1.3ffffep2f}, barrel));
static_assert(intersects(capsule<float>{{{-9, 3, 3}, {9, 3, 3}}, 1}, barrel));

static_assert(decidable_pair<cylinder<float>, cylinder<float>> && decidable_pair<cylinder<double>, capsule<double>>);

template <class Other>
void examine_round_case(round_family f, std::uint64_t k, round_tally& sum) {
    const auto c = test::make_round_pair<Other>(test::sample_seed, f, k);
    auto s = test::first_of(c);
    Other t = test::second_of<Other>(c);
    if (!is_valid(s) || !is_valid(t)) return;
    if (f == round_family::near_contact && c.truth != known::nothing) {
        // Both sides of the least radius with contact.
        for (const int step : {0, 1, -1, -2}) {
            if (c.is_first_least) s.radius = test::construction::moved(c.first_radius, step);
            if (!c.is_first_least) t.radius = test::construction::moved(c.second_radius, step);
            if (is_valid(s) && is_valid(t)) examine_with_truth(s, t, step >= 0, sum);
        }
        return;
    }
    // Where pairs are made to touch the oracle takes its longest.
    bool truth = c.truth == known::yes;
    if (c.truth == known::nothing || k % 8 == 0) {
        const finding found = test::oracle::examine_round(s, t);
        sum.touching += found == finding::touching;
        sum.failed += found == finding::failed;
        if (found == finding::failed) return;
        const bool met = found != finding::no;
        sum.failed += c.truth != known::nothing && met != truth;
        truth = met;
    }
    examine_with_truth(s, t, truth, sum);
}

template <class Other>
std::uint64_t round_cases_of(round_family f) {
    // Numbers of thousands of digits take long, and so does the search for a radius.
    const bool is_double = sizeof(scalar_type_of<Other>) == 8;
    const std::uint64_t part = f == round_family::all_bit_patterns ? (is_double ? 500 : 100)
                               : f == round_family::near_contact   ? (is_double ? 500 : 200)
                                                                   : 10;
    return test::sample_count() / part + 1;
}

/// x to -z, y to x, z to -y: a mirror and a turn.
template <class T>
vec3<T> mirrored(const vec3<T>& v) {
    return {-v.z, v.x, -v.y};
}

template <class T>
T rounded_power(int exponent) {
    return test::construction::rounded_to<T>(std::ldexp(1.0, exponent));
}

}  // namespace

TEMPLATE_TEST_CASE("cylinders with cylinders and capsules: every stage is right in every family", "", cylinder<float>,
                   cylinder<double>, capsule<float>, capsule<double>) {
    std::uint64_t pairs = 0, hits = 0;
    std::printf("%-16s | %9s %9s %9s %9s %9s\n", "family", "pairs", "hits", "open", "unlike", "touching");
    for (int i = 0; i < test::round_family_count; ++i) {
        const auto f = static_cast<round_family>(i);
        const auto sum = test::in_threads<round_tally>(round_cases_of<TestType>(f),
                                                       [f](std::uint64_t first, std::uint64_t last, round_tally& t) {
                                                           for (std::uint64_t k = first; k < last; ++k)
                                                               examine_round_case<TestType>(f, k, t);
                                                       });
        CAPTURE(test::name_of(f));
        CHECK(sum.pairs > 0);
        CHECK(sum.wrong == 0);
        // Numbers of all exponents may need more digits than there is time for.
        CHECK(sum.failed * 5 <= (f == round_family::all_bit_patterns ? sum.pairs + 10 : 0));
        CHECK(sum.touching * 20 <= sum.pairs);
        CHECK(test::is_share_above(0.05, sum.hits, sum.pairs));
        CHECK(test::is_share_above(0.05, sum.pairs - sum.hits, sum.pairs));
        if (f == round_family::random) CHECK(sum.unlike * 20 <= sum.pairs);
        if (f == round_family::touching) CHECK(sum.open > 0);
        std::printf("%-16s | %9llu %9llu %9llu %9llu %9llu\n", test::name_of(f), static_cast<unsigned long long>(sum.pairs),
                    static_cast<unsigned long long>(sum.hits), static_cast<unsigned long long>(sum.open),
                    static_cast<unsigned long long>(sum.unlike), static_cast<unsigned long long>(sum.touching));
        std::fflush(stdout);
        pairs += sum.pairs, hits += sum.hits;
    }
    CHECK(test::is_share_above(0.2, hits, pairs));
    CHECK(test::is_share_above(0.2, pairs - hits, pairs));
}

TEMPLATE_TEST_CASE("cylinders with cylinders and capsules: one answer for every order, mirror and scale", "",
                   cylinder<float>, cylinder<double>, capsule<float>, capsule<double>) {
    using T = scalar_type_of<TestType>;
    std::uint64_t differing = 0, scaled_pairs = 0;
    for (int i = 0; i < test::round_family_count; ++i) {
        const auto f = static_cast<round_family>(i);
        const std::uint64_t count = round_cases_of<TestType>(f) / (f == round_family::near_contact ? 8 : 2);
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto c = test::make_round_pair<TestType>(test::sample_seed + 1, f, k);
            const auto s = test::first_of(c);
            const auto t = test::second_of<TestType>(c);
            if (!is_valid(s) || !is_valid(t)) continue;
            const bool answer = intersects(s, t);
            const cylinder<T> back{{s.axis.b, s.axis.a}, s.radius};
            const TestType other{{t.axis.b, t.axis.a}, t.radius};
            differing += intersects(t, s) != answer || intersects(back, t) != answer || intersects(other, s) != answer ||
                         intersects<exact>(back, other) != answer;
            const cylinder<T> there{{mirrored(s.axis.a), mirrored(s.axis.b)}, s.radius};
            differing += intersects(TestType{{mirrored(t.axis.a), mirrored(t.axis.b)}, t.radius}, there) != answer;
            // By a power of two that loses no digit.
            auto larger = c;
            const T scale = rounded_power<T>(k % 2 == 0 ? 20 : -20), inverse = 1 / scale;
            bool is_lossless = true;
            for (int n = 0; n < 14; ++n) {
                T& x = *test::construction::number_of(larger, n);
                const T before = x;
                x *= scale;
                is_lossless = is_lossless && x * inverse == before;
            }
            if (!is_lossless || !is_valid(test::first_of(larger)) || !is_valid(test::second_of<TestType>(larger))) continue;
            ++scaled_pairs;
            differing += intersects(test::first_of(larger), test::second_of<TestType>(larger)) != answer;
        }
    }
    CHECK(differing == 0);
    CHECK(scaled_pairs * 2 > test::sample_count() / 40 * test::round_family_count);
}

TEMPLATE_TEST_CASE("cylinders with cylinders and capsules: right in every floating-point mode", "", cylinder<float>,
                   cylinder<double>, capsule<float>, capsule<double>) {
    std::uint64_t wrong = 0;
    for (int i = 0; i < test::round_family_count; ++i) {
        const auto f = static_cast<round_family>(i);
        const std::uint64_t count = round_cases_of<TestType>(f) / 5;
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto c = test::make_round_pair<TestType>(test::sample_seed + 2, f, k);
            const auto s = test::first_of(c);
            const auto t = test::second_of<TestType>(c);
            if (!is_valid(s) || !is_valid(t)) continue;
            const bool truth = intersects<exact>(s, t);
            wrong += test::modes_in_which(
                [&] { return intersects(s, t) != truth || decide<filtered>(s, t) == to_verdict(!truth); });
        }
    }
    CHECK(wrong == 0);
}
