// SPDX-License-Identifier: MIT
#include <abut/predicate/hull_hull.hpp>

#include <abut/predicate/intersects.hpp>

#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/hull_pairs.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"

// Every stage against linear programming in unbounded integers.

namespace {

using namespace abut;

constexpr vec3<float> block[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
constexpr vec3<float> above_corner[4] = {{1, 1, 1}, {2, 2, 2}, {2, 1, 1}, {1, 2, 3}};
constexpr vec3<float> next_above[4] = {{0x1.000002p0f, 1, 1}, {2, 2, 2}, {2, 1, 1}, {0x1.8p0f, 2, 3}};
constexpr hull<float> cube_of_points(block, 8);

// Constant expressions: a corner at a corner and one step off it; each other shape, in either order.
static_assert(intersects(cube_of_points, hull<float>(above_corner, 4)));
static_assert(!intersects(cube_of_points, hull<float>(next_above, 4)));
static_assert(intersects<exact>(vec3<float>{0.5f, 0.5f, 1}, cube_of_points));
static_assert(!intersects(cube_of_points, vec3<float>{0.5f, 0.5f, 0x1.000002p0f}));
static_assert(intersects(segment<float>{{-1, 1, 2}, {1, 1, 0}}, cube_of_points));
static_assert(intersects(cube_of_points, triangle<float>{{2, 0, 0}, {0, 2, 0}, {2, 2, 0}}));
static_assert(!intersects(cube_of_points, triangle<float>{{0x1.000002p1f, 0, 0}, {0, 2, 0}, {2, 2, 0}}));
static_assert(intersects(aabb<float>{{1, 1, 1}, {2, 2, 2}}, cube_of_points));
static_assert(!intersects(aabb<float>{{1, 1, 0x1.000002p0f}, {2, 2, 2}}, cube_of_points));
static_assert(intersects<fast>(cube_of_points, cube_of_points));

static_assert(decidable_pair<hull<float>, hull<float>> && decidable_pair<hull<double>, triangle<double>> &&
              decidable_pair<hull<float>, aabb<float>> && !decidable_pair<hull<float>, hull<double>>);

struct hull_tally {
    std::uint64_t pairs = 0, hits = 0, filter = 0, fast_wrong = 0, any_span = 0, wrong = 0;

    hull_tally& operator+=(const hull_tally& o) {
        pairs += o.pairs, hits += o.hits, filter += o.filter, fast_wrong += o.fast_wrong, any_span += o.any_span,
            wrong += o.wrong;
        return *this;
    }
};

/// Hull b, and the other shapes that are hulls of as many points.
template <scalar T>
void examine_hulls(const test::hull_pair<T>& both, std::uint64_t index, hull_tally& sum) {
    const hull<T> a = test::hull_over(both.a), b = test::hull_over(both.b);
    const bool truth = test::oracle::hulls_intersect(both.a, both.b);
    const verdict by_filter = decide<filtered>(a, b), by_limbs = decide<exact>(a, b);
    const auto contradicts = [truth](verdict v) { return v == to_verdict(!truth); };
    bool wrong = contradicts(by_filter) || contradicts(by_limbs) || decide<fast>(a, b) == verdict::unknown;
    wrong = wrong || intersects(a, b) != truth || intersects(b, a) != truth || intersects<exact>(b, a) != truth;
    if (by_limbs == verdict::unknown || index % 16 == 0) wrong = wrong || resolve(a, b) != truth;
    const auto& p = both.b;
    if (p.size() == 1) wrong = wrong || intersects(p[0], a) != truth;
    if (p.size() == 2) wrong = wrong || intersects(segment<T>{p[0], p[1]}, a) != truth;
    if (p.size() == 3) wrong = wrong || intersects<exact>(a, triangle<T>{p[0], p[1], p[2]}) != truth;
    ++sum.pairs;
    sum.hits += truth;
    sum.filter += by_filter != verdict::unknown;
    sum.fast_wrong += intersects<fast>(a, b) != truth;
    sum.any_span += by_limbs == verdict::unknown;
    sum.wrong += wrong;
}

template <scalar T>
hull_tally examine_hull_family(test::hull_family f) {
    const std::uint64_t samples = test::sample_count() / test::thinned_by(f) + 20;
    return test::in_threads<hull_tally>(samples, [&](std::uint64_t first, std::uint64_t last, hull_tally& sum) {
        for (std::uint64_t k = first; k < last; ++k) examine_hulls(test::make_hull_pair<T>(test::sample_seed, f, k), k, sum);
    });
}

}  // namespace

TEMPLATE_TEST_CASE("hull and hull: every stage is right in every family", "", float, double) {
    std::printf("hulls, seed %llu, %s\n| family | pairs | hits %% | fast wrong %% | filter %% | any span %% | wrong |\n",
                static_cast<unsigned long long>(test::sample_seed), sizeof(TestType) == 4 ? "float" : "double");
    for (int i = 0; i < test::hull_family_count; ++i) {
        const auto f = static_cast<test::hull_family>(i);
        const hull_tally t = examine_hull_family<TestType>(f);
        const auto percent = [&t](std::uint64_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(t.pairs); };
        std::printf("| %s | %llu | %.1f | %.2f | %.2f | %.2f | %llu |\n", test::name_of(f),
                    static_cast<unsigned long long>(t.pairs), percent(t.hits), percent(t.fast_wrong), percent(t.filter),
                    percent(t.any_span), static_cast<unsigned long long>(t.wrong));
        INFO(test::name_of(f));
        CHECK(t.wrong == 0);
        // A family in which everything touches, or nothing, tests nothing.
        CHECK(percent(t.hits) > 5);
        CHECK(percent(t.hits) < 95);
        // The filter has to decide what is in general position.
        if (f == test::hull_family::general || f == test::hull_family::many) CHECK(percent(t.filter) > 98);
    }
}

TEMPLATE_TEST_CASE("hull and hull: right in every rounding mode, and where denormals are flushed", "", float, double) {
    std::vector<test::hull_pair<TestType>> pairs;
    std::vector<bool> truths;
    for (int i = 0; i < test::hull_family_count; ++i) {
        const auto f = static_cast<test::hull_family>(i);
        for (std::uint64_t k = 0; k < test::sample_count() / 25 / test::thinned_by(f) + 2; ++k) {
            pairs.push_back(test::make_hull_pair<TestType>(test::sample_seed + 1, f, k));
            truths.push_back(test::oracle::hulls_intersect(pairs.back().a, pairs.back().b));
        }
    }
    for (const test::floating_mode& mode : test::floating_modes()) {
        std::size_t wrong = 0;
        test::in_mode(mode, [&] {
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const hull<TestType> a = test::hull_over(pairs[i].a), b = test::hull_over(pairs[i].b);
                wrong += intersects(a, b) != truths[i] || intersects<exact>(b, a) != truths[i];
            }
        });
        INFO(mode.name);
        CHECK(wrong == 0);
    }
}

TEMPLATE_TEST_CASE("hull and hull: a placed hull is the hull of its placed points", "", float, double) {
    using T = TestType;
    const double s = 0.6, c = 0.8;
    rigid<T> pose;
    pose.rotation[0] = static_cast<T>(c), pose.rotation[1] = static_cast<T>(-s);
    pose.rotation[3] = static_cast<T>(s), pose.rotation[4] = static_cast<T>(c);
    pose.translation = {T(0.25), T(-0.5), T(0.125)};
    std::uint64_t wrong = 0, hits = 0;
    const std::uint64_t pairs = test::sample_count() / 5;
    for (std::uint64_t k = 0; k < pairs; ++k) {
        const auto both = test::make_hull_pair<T>(test::sample_seed, test::hull_family::touching, k);
        test::point_list<T> placed;
        for (const vec3<T>& p : both.a) placed.push_back(place(pose, p));
        const hull<T> a = place(pose, test::hull_over(both.a)), b = test::hull_over(both.b);
        for (std::size_t i = 0; i < placed.size(); ++i) wrong += a[i] != placed[i];
        const bool truth = test::oracle::hulls_intersect(placed, both.b);
        hits += truth;
        wrong += intersects(a, b) != truth || intersects<exact>(b, a) != truth;
        const aabb<T> box = bounds(a), of_points = bounds(test::hull_over(placed));
        wrong += box.lower != of_points.lower || box.upper != of_points.upper;
    }
    CHECK(wrong == 0);
    CHECK(hits * 20 > pairs);
    CHECK(hits < pairs);
}

TEST_CASE("hull: points may lie apart from each other in memory") {
    struct row {
        vec3<float> p;
        float other;
    };
    const row rows[4] = {{{0, 0, 0}, 7}, {{1, 0, 0}, 7}, {{0, 1, 0}, 7}, {{0, 0, 1}, 7}};
    const hull<float> h(&rows[0].p, 4, sizeof(row));
    CHECK(h[3] == vec3<float>{0, 0, 1});
    CHECK(intersects(h, vec3<float>{0.25f, 0.25f, 0.5f}));
    CHECK_FALSE(intersects(h, vec3<float>{0.25f, 0.25f, 0.75f}));
    CHECK_FALSE(is_valid(hull<float>()));
}
