// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <type_traits>
#include <utility>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/revolution_oracle.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"
#include "support/within_pairs.hpp"

// Cylinders and cones within a distance of points, spheres and planes: every stage against an oracle of thousands of binary
// digits.

namespace {

namespace revolution_within {

using namespace abut;

constexpr cylinder<float> drum{{{0, 0, 0}, {0, 0, 2}}, 5};
constexpr cone<double> tip{{0, 0, 0}, {0, 0, 4}, 3};

// Constant expressions, in either order: beside a rim, the side, an end, a cone's side and its apex.
static_assert(within(drum, vec3<float>{8, 0, 6}, 5) && !within(vec3<float>{8, 0, 6}, drum, 0x1.3ffffffffffffp2));
static_assert(within(drum, sphere<float>{{8, 0, 6}, 2}, 3) && !within<exact>(drum, sphere<float>{{8, 0, 6}, 2}, 2.9999999));
static_assert(within(vec3<float>{0, 8, 1}, drum, 3) && !within(vec3<float>{0, 8, 1}, drum, 0x1.7ffffffffffffp1));
static_assert(within(drum, vec3<float>{1, 1, -4}, 4) && within(drum, vec3<float>{1, 1, 1}, 0));
static_assert(within(tip, vec3<double>{7, 0, 1}, 5) && !within(tip, vec3<double>{7, 0, 1}, 4.9999));
static_assert(within(tip, sphere<double>{{0, 3, -4}, 2}, 3) && !within(tip, sphere<double>{{0, 3, -4}, 2}, 2.9999));
// A sum that no double is: 4 + 2^-60, at an end that is as far.
static_assert(within(cylinder<double>{{{0, 0, -0x1p-60}, {0, 0, -1}}, 1}, sphere<double>{{0, 0, 5}, 5}, 0x1p-60) &&
              !within(cylinder<double>{{{0, 0, -0x1p-60}, {0, 0, -1}}, 1}, sphere<double>{{0, 0, 5}, 5}, 0x1p-61));
static_assert(!within(cone<float>{{0, 0, -0x1p-60f}, {0, 0, -1}, 1}, sphere<float>{{0, 0, 5}, 5}, 0x1.fffffffffffffp-61));
// Planes: an apex, a rim, through a base, and an end along the plane.
static_assert(within(tip, plane<double>{{0, 0, -7}, 21}, 3) &&
              !within(tip, plane<double>{{0, 0, -7}, 21}, 0x1.7ffffffffffffp1));
static_assert(within(plane<double>{{4, 0, 3}, 49}, tip, 5) && !within<exact>(plane<double>{{4, 0, 3}, 49}, tip, 4.9999));
static_assert(within(drum, plane<float>{{0, 3, 4}, 33}, 2) &&
              !within(drum, plane<float>{{0, 3, 4}, 33}, 0x1.fffffffffffffp0));
static_assert(within(drum, plane<float>{{0, 0, 2}, 10}, 3) && within(drum, plane<float>{{1, 1, 1}, 0}, 0));
static_assert(within(drum, plane<float>{{0, 0, 0}, 0}, 0) && !within(drum, plane<float>{{0, 0, 0}, 1}, 1e300));
// Without length they are balls.
static_assert(within(cylinder<float>{{{1, 1, 1}, {1, 1, 1}}, 2}, plane<float>{{3, 0, 4}, 32}, 3) &&
              !within(cone<float>{{1, 1, 1}, {1, 1, 1}, 2}, plane<float>{{3, 0, 4}, 32}, 2.9999999));
static_assert(within(cylinder<float>{{{1, 1, 1}, {1, 1, 1}}, 2}, sphere<float>{{4, 5, 1}, 1}, 2) &&
              !within(cone<float>{{1, 1, 1}, {1, 1, 1}, 2}, vec3<float>{4, 5, 1}, 2.9999999));

static_assert(distance_decidable<cylinder<float>, vec3<float>> && distance_decidable<sphere<double>, cone<double>>);
static_assert(!distance_decidable<cylinder<float>, vec3<double>>);
static_assert(distance_decidable<plane<float>, cone<float>>);

using tally = test::decision_tally;

/// Integers as devices ask them, where there is an axis.
template <class S, class U>
verdict decide_as_devices(const S& s, const U& t, double d) {
    if (detail::is_point(detail::axis_of(s))) return detail::decide_within<exact>(s, t, d);
    using T = scalar_type_of<S>;
    using question = std::conditional_t<std::same_as<U, plane<T>>, detail::asked_over_plane<S>, detail::asked_within<S>>;
    return detail::decide_at_short_length<detail::asked_exactly<question>>(detail::values_within(s, t, d).value);
}

/// Every stage, whatever the order; `fast` is counted where it is unlike.
template <class S, class U>
void examine_stages(const S& s, const U& t, double d, bool truth, tally& sum) {
    const verdict lie = to_verdict(!truth), by_filter = detail::decide_within<filtered>(s, t, d),
                  by_limbs = detail::decide_within<exact>(s, t, d);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += within<fast>(t, s, d) != truth;
    sum.wrong += by_filter == lie || by_limbs == lie || detail::resolve_within(s, t, d) != truth ||
                 within(s, t, d) != truth || within(t, s, d) != truth || within<exact>(t, s, d) != truth ||
                 decide_as_devices(s, t, d) != by_limbs;
}

template <class S, class U>
void examine(const S& s, const U& t, double d, tally& sum) {
    if (!is_valid(s) || !is_valid(t)) return;
    const bool truth = test::oracle::within_distance(s, t, d);
    examine_stages(s, t, d, truth, sum);
    if constexpr (requires { t.center; }) {
        if (t.radius == 0) examine_stages(s, t.center, d, truth, sum);
    }
}

/// A ball that is to touch a feature, or nearly, of which a part becomes a distance: of whole numbers exactly so far away.
/// Or distances beside the least one.
template <class Solid>
void examine_case(test::revolution_family f, std::uint64_t k, tally& sum) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    const auto c = test::make_revolution_case<T>(test::sample_seed + 7, f, k, is_cone);
    const Solid s = test::solid_of<Solid>(c.axis, c.radius);
    sphere<T> ball = test::ball_beside(c, is_cone, k / 4);
    if (!is_valid(s) || !is_valid(ball)) return;
    const T whole = ball.radius;
    ball.radius = k % 4 == 0 ? T(0) : k % 4 == 1 ? whole / 4 : k % 4 == 2 ? whole / 3 : whole;
    const double rest = static_cast<double>(whole) - static_cast<double>(ball.radius);
    examine(s, ball, rest, sum);
    if (k % 2 == 0) examine(s, ball, test::distance_near(test::oracle::least_distance(s, ball), k / 4), sum);
    if (k % 3 != 0) return;
    const plane<T> flat = test::plane_beside(c, k / 3);
    examine(s, flat, test::distance_near(test::oracle::least_distance(s, flat), k / 3), sum);
}

template <class Solid>
void check_every_family() {
    tally total;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        const auto f = static_cast<test::revolution_family>(i);
        const bool is_long = f == test::revolution_family::all_bit_patterns;
        const std::uint64_t count = test::sample_count() / (is_long ? 400 : 100) + 1;
        const auto sum = test::in_threads<tally>(count, [f](std::uint64_t first, std::uint64_t last, tally& of) {
            for (std::uint64_t k = first; k < last; ++k) examine_case<Solid>(f, k, of);
        });
        CAPTURE(test::name_of(f));
        CHECK(sum.wrong == 0);
        if (f == test::revolution_family::random) CHECK(sum.unlike * 2 <= sum.pairs);  // half are ties
        std::printf("%-16s | %6llu %6llu %6llu %6llu\n", test::name_of(f), static_cast<unsigned long long>(sum.pairs),
                    static_cast<unsigned long long>(sum.hits), static_cast<unsigned long long>(sum.open),
                    static_cast<unsigned long long>(sum.unlike));
        total += sum;
    }
    CHECK(test::is_share_above(0.2, total.hits, total.pairs));
    CHECK(test::is_share_above(0.2, total.pairs - total.hits, total.pairs));
}

/// An upright solid whose first end, or whose side, is exactly r + d from a centre, where that sum has more digits than a
/// double; then d is one step off.
template <class Solid>
void examine_sum(std::uint64_t k, tally& sum) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    test::draws draw(test::sample_seed, is_cone ? 92 : 91, k);
    const T r = static_cast<T>(draw.uniform(1, 2)), gap = static_cast<T>(std::ldexp(draw.uniform(1, 2), -draw.below(70)));
    const T radius = static_cast<T>(1 + draw.below(3)), length = static_cast<T>(1 + draw.below(5));
    const int kind = draw.below(is_cone ? 2 : 3);
    segment<T> axis{{0, 0, -gap}, {0, 0, -gap - length}};
    vec3<T> center{0, 0, r};
    if (kind == 1) std::swap(axis.a, axis.b);  // of a cone the base
    if (kind == 1 && draw.below(2) == 0) center.x = radius;
    if (kind == 2) {
        axis = {{-gap, 0, -length}, {-gap, 0, length}};
        center = {r + radius, 0, 0};
    }
    const T far = center.x - radius;  // rounded in the last kind
    const sphere<T> ball{center, kind == 2 ? (far > 0 ? far : T(0)) : r};
    // Any axis of space up.
    const int turns = draw.below(3);
    const auto turned = [turns](const vec3<T>& v) {
        return turns == 0 ? v : turns == 1 ? vec3<T>{v.y, v.z, v.x} : vec3<T>{v.z, v.x, v.y};
    };
    const Solid s = test::solid_of<Solid>({turned(axis.a), turned(axis.b)}, radius);
    const sphere<T> t{turned(ball.center), ball.radius};
    const auto exactly = static_cast<double>(gap);
    const double most = exactly * 2;
    for (const double d : {exactly, std::nextafter(exactly, 0.0), std::nextafter(exactly, most)}) {
        tally one;
        examine(s, t, d, one);
        // All of these are so far apart.
        one.wrong += (one.hits > 0) != (d >= exactly);
        sum += one;
    }
}

/// A solid and a plane that is a whole number from it, over an end, a rim, an apex or along the side: all lengths are whole.
template <class Solid>
void examine_plane(std::uint64_t k, tally& sum) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    test::draws draw(test::sample_seed, is_cone ? 94 : 93, k);
    const test::construction::lattice_frame f(draw);
    constexpr int triples[5][3] = {{0, 1, 1}, {1, 0, 1}, {3, 4, 5}, {-4, 3, 5}, {5, -12, 13}};
    const int* const way = triples[draw.below(5)];  // across the axis, along it, and its length
    const int height = 1 + draw.below(5), radius = draw.below(6), apart = draw.below(4);
    const vec3<T> o = f.at<T>(0, 0, 0), first = f.at<T>(0, 0, 0), last = f.at<T>(0, 0, height),
                  n = f.at<T>(way[0], 0, way[1]) - o;
    const T rim = static_cast<T>(radius * f.unit() * (way[0] < 0 ? -way[0] : way[0]));
    const T high = std::max(dot(n, last) + rim, dot(n, first) + (is_cone ? T(0) : rim));
    const plane<T> p{n, high + static_cast<T>(apart * f.unit() * way[2])};
    const Solid s = test::solid_of<Solid>({first, last}, static_cast<T>(radius));
    const double d = apart;
    for (const double at : {d, std::nextafter(d, -1.0), std::nextafter(d, 9.0)}) {
        if (at < 0) continue;
        tally one;
        examine(s, k % 2 == 0 ? p : plane<T>{o - f.at<T>(way[0], 0, way[1]), -p.offset}, at, one);
        one.wrong += (one.hits > 0) != (at >= d);
        sum += one;
    }
}

}  // namespace revolution_within

}  // namespace

TEMPLATE_TEST_CASE("within, cylinders and cones: every stage is right in every family", "", abut::cylinder<float>,
                   abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    revolution_within::check_every_family<TestType>();
}

TEMPLATE_TEST_CASE("within, cylinders and cones: the radius and the distance are added exactly", "", abut::cylinder<float>,
                   abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    using namespace abut;
    revolution_within::tally sum;
    for (std::uint64_t k = 0; k < test::sample_count() / 25; ++k) revolution_within::examine_sum<TestType>(k, sum);
    CHECK(sum.wrong == 0);
    CHECK(sum.hits * 3 == sum.pairs * 2);
}

TEMPLATE_TEST_CASE("within, cylinders and cones: planes that are exactly as far", "", abut::cylinder<float>,
                   abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    using namespace abut;
    revolution_within::tally sum;
    for (std::uint64_t k = 0; k < test::sample_count() / 25; ++k) revolution_within::examine_plane<TestType>(k, sum);
    CHECK(sum.wrong == 0);
    CHECK(sum.pairs > sum.hits);
    CHECK(sum.hits * 2 > sum.pairs);
}

TEMPLATE_TEST_CASE("within, cylinders and cones: right in every floating-point mode, and with 0 as intersects", "",
                   abut::cylinder<float>, abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    using namespace abut;
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::uint64_t wrong = 0, hits = 0, pairs = 0;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 20; ++k) {
            const auto f = static_cast<test::revolution_family>(i);
            const auto c = test::make_revolution_case<T>(test::sample_seed + 8, f, k, is_cone);
            const auto s = test::solid_of<TestType>(c.axis, c.radius);
            sphere<T> ball = test::ball_beside(c, is_cone, k);
            if (!is_valid(s) || !is_valid(ball)) continue;
            const double d = k % 3 == 0 ? static_cast<double>(ball.radius) : static_cast<double>(ball.radius) / 2;
            ball.radius = k % 3 == 0 ? T(0) : ball.radius / 2;
            const auto check = [&](const auto& t) {
                const bool truth = within<exact>(s, t, d), meets = intersects<exact>(s, t);
                hits += truth;
                ++pairs;
                wrong += test::modes_in_which([&] {
                    return within(s, t, d) != truth || detail::decide_within<filtered>(s, t, d) == to_verdict(!truth) ||
                           within(t, s, 0) != meets || within<exact>(s, t, 0) != meets;
                });
            };
            check(ball);
            check(ball.center);
            check(test::plane_beside(c, k));
        }
    }
    CHECK(wrong == 0);
    CHECK(test::is_share_above(0.1, hits, pairs));
    CHECK(test::is_share_above(0.1, pairs - hits, pairs));
}

TEST_CASE("within, cylinders and cones: the least and the greatest distances") {
    using namespace abut;
    constexpr double most = largest_finite<double>, least = 0x1p-1074;
    const cylinder<float> rod{{{0, 0, 0}, {0, 0, 1}}, 1};
    const cone<double> spike{{0, 0, 0}, {0, 0, 1}, 1}, vast{{-most, 0, 0}, {-most / 2, 0, 0}, most};
    CHECK(within(rod, vec3<float>{largest_finite<float>, 0, 0}, most));
    CHECK_FALSE(within(rod, vec3<float>{largest_finite<float>, 0, 0}, 1e38));
    CHECK_FALSE(within(rod, vec3<float>{0, 0, -0x1p-149f}, least));
    CHECK(within(rod, vec3<float>{0, 0, -0x1p-149f}, 0x1p-149));
    CHECK(within(spike, vec3<double>{0, 0, -least}, least));
    CHECK_FALSE(within(spike, vec3<double>{0, 0, -2 * least}, least));
    CHECK(within(spike, sphere<double>{{0, 0, -most}, most}, least));
    CHECK(within(spike, sphere<double>{{0, 0, -most}, most / 2}, most / 2));
    CHECK_FALSE(within(spike, sphere<double>{{0, 0, -most}, most / 2}, most / 4));
    CHECK(within(vast, sphere<double>{{most, 0, 0}, most}, most / 2));
    CHECK_FALSE(within(vast, sphere<double>{{most, 0, 0}, most}, most / 4));
}
