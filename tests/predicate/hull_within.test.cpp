// SPDX-License-Identifier: MIT
#include <abut/predicate/hull_within.hpp>

#include <abut/predicate/within.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/hull_pairs.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"
#include "support/solid_pairs.hpp"

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
              !distance_decidable<hull<float>, ray<float>>);

/// A hull and another shape: which are within a distance of each other.
template <class T, class U>
struct question {
    const hull<T>& h;
    const U& other;
    bool meet;

    question(const hull<T>& a, const U& b)
        : h(a), other(b), meet(test::oracle::hulls_intersect(test::corners_of(a), test::corners_of(b))) {}
    [[nodiscard]] double least_distance() const { return meet ? 0 : test::exact_gap(h, other).least_double(); }
    [[nodiscard]] bool truth(double d) const { return meet || test::exact_gap(h, other).compared_with(d) <= 0; }
};
template <class T>
struct question<T, plane<T>> {
    const hull<T>& h;
    const plane<T>& other;

    [[nodiscard]] double least_distance() const {
        return test::construction::least_number<double>([this](double d) { return truth(d); });
    }
    [[nodiscard]] bool truth(double d) const { return test::oracle::within_distance(other, h, d); }
};

constexpr int kinds = test::kinds_around_points + 1;

/// Calls f(hull, other shape), of shape number `kind`: made of the points of b. The last is a plane.
template <scalar T, class F>
void with_pair_of_kind(int kind, const test::hull_pair<T>& points, std::uint64_t index, const F& f) {
    const vec3<T> p = points.b[0], q = points.b[1 % points.b.size()];
    if (kind == test::kinds_around_points) return f(test::hull_over(points.a), plane<T>{p, static_cast<T>(dot(p, q))});
    test::draws d(test::sample_seed, 8, index);
    const T radius = d.below(3) == 0 ? T(0) : static_cast<T>(d.uniform(0, 0.5));
    test::with_shapes_of_kind(kind, points, radius, f);
}

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
    const question<T, U> ask{h, other};
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

constexpr test::hull_family families_apart[] = {
    test::hull_family::general,  test::hull_family::far_away,  test::hull_family::lattice,
    test::hull_family::flat,     test::hull_family::line,      test::hull_family::touching,
    test::hull_family::step_off, test::hull_family::exponents, test::hull_family::denormal};

template <scalar T>
test::hull_pair<T> make_few_points(std::uint64_t seed, test::hull_family f, std::uint64_t index) {
    auto both = test::make_hull_pair<T>(seed, f, index);
    if (both.a.size() > 5) both.a.resize(5);
    if (both.b.size() > 4) both.b.resize(4);
    // Not too many meet: those that do are asked of `intersects`.
    if (index % 4 != 0 && f != test::hull_family::exponents) {
        T width = 0;
        for (const auto* points : {&both.a, &both.b}) {
            for (const vec3<T>& p : *points) width = std::max(width, detail::absolute(p.x - both.a[0].x));
        }
        for (vec3<T>& p : both.b) p.x += width;
    }
    return both;
}

}  // namespace

TEMPLATE_TEST_CASE("within, hulls: every stage is right in every family", "", float, double) {
    using T = TestType;
    std::printf("hulls within a distance, seed %llu\n| family | pairs | hits %% | filter %% | wrong |\n",
                static_cast<unsigned long long>(test::sample_seed));
    std::uint64_t hits[kinds] = {}, all[kinds] = {};
    for (const test::hull_family f : families_apart) {
        hull_within_tally sum;
        const std::uint64_t samples = test::sample_count() / (f == test::hull_family::exponents ? 64 : 12);
        for (std::uint64_t k = 0; k < samples; ++k) {
            const auto kind = static_cast<int>(k % kinds);
            const auto both = make_few_points<T>(test::sample_seed + 7, f, k);
            const std::uint64_t before = sum.hits;
            with_pair_of_kind(kind, both, k,
                              [&](const auto& h, const auto& other) { examine_hull_within(h, other, k / kinds, sum); });
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
    for (const test::hull_family f : families_apart) {
        for (std::uint64_t k = 0; k < 5 * kinds; ++k) {
            const auto both = make_few_points<T>(test::sample_seed + 8, f, k);
            with_pair_of_kind(static_cast<int>(k % kinds), both, k, [&](const auto& h, const auto& other) {
                const question<T, std::remove_cvref_t<decltype(other)>> ask{h, other};
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
