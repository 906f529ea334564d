// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/narrow/distance.hpp>
#include <abut/shape/hull.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/revolution_ties.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"
#include "support/within_pairs.hpp"

// Cylinders and cones within a distance of segments, capsules, triangles, boxes and hulls. Two oracles that share no formula
// with the library: bounds of the distance in 300 bits, by farthest points along directions alone; and for exact ties a
// plane of whole numbers that touches the solid at a point, and another that is parallel to it and touches the other shape
// exactly opposite, a whole number away.

namespace {

namespace revolution_core_within {

using namespace abut;

constexpr cylinder<float> drum{{{0, 0, 0}, {0, 0, 2}}, 5};
constexpr cone<double> tip{{0, 0, 0}, {0, 0, 4}, 3};
constexpr double below_5 = 0x1.3ffffffffffffp2, below_3 = 0x1.7ffffffffffffp1;

// The side, a rim, and an end; a capsule, and either order.
static_assert(within(drum, segment<float>{{8, -9, 1}, {8, 9, 1}}, 3) &&
              !within(segment<float>{{8, -9, 1}, {8, 9, 1}}, drum, below_3));
static_assert(within(drum, segment<float>{{8, -9, 6}, {8, 9, 6}}, 5) &&
              !within<exact>(drum, segment<float>{{8, -9, 6}, {8, 9, 6}}, below_5));
static_assert(within(drum, segment<float>{{-1, 0, 5}, {1, 1, 5}}, 3) &&
              !within(drum, segment<float>{{-1, 0, 5}, {1, 1, 5}}, below_3));
static_assert(within(capsule<float>{{{8, -9, 6}, {8, 9, 6}}, 2}, drum, 3) &&
              !within(drum, capsule<float>{{{8, -9, 6}, {8, 9, 6}}, 2}, below_3));
// A cone's side, the apex and the rim.
static_assert(within(tip, segment<double>{{5.5, -9, -1}, {5.5, 9, -1}}, 5) &&
              !within(tip, segment<double>{{5.5, -9, -1}, {5.5, 9, -1}}, below_5));
static_assert(within(tip, segment<double>{{-1, 2, -3}, {1, -2, -3}}, 3) &&
              !within(tip, segment<double>{{-1, 2, -3}, {1, -2, -3}}, below_3));
static_assert(within(tip, segment<double>{{6, -9, 8}, {6, 9, 8}}, 5) &&
              !within(tip, segment<double>{{6, -9, 8}, {6, 9, 8}}, below_5));
// Inside of a face, over the rim.
static_assert(within(drum, triangle<float>{{8, -9, 6}, {8, 9, 6}, {40, 0, -18}}, 5) &&
              within(drum, triangle<float>{{4, -9, 9}, {4, 9, 9}, {36, 0, -15}}, 5) &&
              !within(drum, triangle<float>{{4, -9, 9}, {4, 9, 9}, {36, 0, -15}}, below_5));

static_assert(distance_decidable<cylinder<float>, segment<float>> && distance_decidable<triangle<double>, cone<double>> &&
              distance_decidable<cone<float>, capsule<float>> && distance_decidable<aabb<float>, cylinder<float>> &&
              distance_decidable<hull<double>, cylinder<double>> && distance_decidable<cone<float>, hull<float>> &&
              !distance_decidable<cone<float>, hull<double>>);

using core_tally = test::within_tally;

/// Every stage; `fast` is counted where it is unlike.
template <class S, class U>
void examine_stages(const S& s, const U& t, double d, bool truth, std::uint64_t index, core_tally& sum) {
    const verdict lie = to_verdict(!truth), by_filter = detail::decide_within<filtered>(s, t, d),
                  late = detail::decide_within_late<filtered>(s, t, d), by_limbs = detail::decide_within<exact>(s, t, d);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += within<fast>(t, s, d) != truth;
    bool wrong = by_filter == lie || late == lie || by_limbs == lie || within(s, t, d) != truth ||
                 within<exact>(t, s, d) != truth || detail::decide_within<fast>(s, t, d) == verdict::unknown;
    if (index % 16 == 0) wrong = wrong || detail::resolve_within(s, t, d) != truth;
    if (wrong && sum.wrong < 3) {
        std::printf("wrong: index %llu d %a truth %d filter %d late %d limbs %d\n", static_cast<unsigned long long>(index), d,
                    truth, static_cast<int>(by_filter), static_cast<int>(late), static_cast<int>(by_limbs));
    }
    sum.wrong += wrong;
}

/// Beside the distance, as it is measured; where the bounds of the oracle do not tell, nothing is asked.
template <class S, class U>
void examine(const S& s, const U& t, std::uint64_t index, core_tally& sum) {
    if (!is_valid(s)) return;
    if constexpr (!std::same_as<U, hull<scalar_type_of<S>>>) {
        if (!is_valid(t)) return;
    }
    const bool touch = intersects<exact>(s, t);
    double least = 0;
    if (!touch && detail::is_point(detail::axis_of(s))) {
        least = static_cast<double>(distance(s, t).distance);
    } else if (!touch) {
        if constexpr (detail::contact_pair<S, U>) {
            least = detail::distance_apart(s, t).distance;
        } else {
            least = detail::distance_apart(t, s).distance;
        }
    }
    const double d = test::distance_beside(least, index);
    if (touch) return examine_stages(s, t, d, true, index, sum);
    const test::wide_gap_of_solid gap = test::gap_of_solid(s, t);
    const test::wide off = ldexp(gap.farthest, -150);  // of the bounds, where what cancels is far larger
    const bool is_near = gap.distance.upper + off <= d;
    if (!is_near && d + off >= gap.distance.lower) {
        ++sum.untold;
        return;
    }
    examine_stages(s, t, d, is_near, index, sum);
}

constexpr int kinds = 5;
constexpr const char* name_of_kind[kinds] = {"segments", "triangles", "boxes", "capsules", "hulls"};

template <class Solid>
void examine_case(const test::revolution_case<scalar_type_of<Solid>>& c, std::uint64_t k, core_tally (&sum)[kinds]) {
    using T = scalar_type_of<Solid>;
    const Solid s = test::solid_of<Solid>(c.axis, c.radius);
    const triangle<T> t{c.corner[0], c.corner[1], c.corner[2]};
    const segment<T> side{t.a, t.b};
    examine(s, side, k, sum[0]);
    examine(s, t, k / 2, sum[1]);
    if (k % 2 == 0) examine(s, k % 4 == 0 ? bounds(t) : bounds(side), k / 2, sum[2]);
    const T radius = std::fabs(c.corner[2].x) / (k % 3 == 0 ? T(64) : T(4));
    if (k % 2 == 1) examine(s, capsule<T>{side, radius}, k / 2, sum[3]);
    if (k % 4 != 0) return;
    const auto points = test::points_beside(test::sample_seed, c, k);
    bool finite = true;
    for (const vec3<T>& p : points) finite = finite && is_valid(p);
    if (finite) examine(s, hull<T>(points.data(), points.size()), k / 4, sum[4]);
}

// --- exact ties
// ------------------------------------------------------------------------------------------------------------------------

/// Shapes of each kind on the far side of the parallel plane, with a point in it opposite; a capsule's radius is taken off.
template <class Solid>
void examine_tie(std::uint64_t k, core_tally (&sum)[kinds]) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    test::draws draw(test::sample_seed, is_cone ? 96 : 95, k);
    const test::construction::lattice_frame f(draw);
    const test::lattice_touch x = test::touch_in_lattice(draw, is_cone);
    const int far = draw.below(4), apart = far * x.length * f.unit();
    const auto place = [&](int a, int b, int out) {
        const auto at = [&](int i) {
            return x.at[i] + (far + out) * x.normal[i] + a * x.across[0][i] + b * x.across[1][i];
        };
        return f.at<T>(at(0), at(1), at(2));
    };
    const Solid s = test::solid_of<Solid>({f.at<T>(0, 0, 0), f.at<T>(0, 0, x.height)}, static_cast<T>(x.radius * f.unit()));
    const auto some = [&] { return draw.below(5) - 2; };
    const int i = some(), j = some(), out = draw.below(2), more = draw.below(2);
    const vec3<T> p = place(0, 0, 0), q = place(-i, -j, 0), r = place(some(), some(), out);
    // q, p and the first corner are on a line; or p is a corner, or inside of the face.
    const segment<T> edge{place(2 * i, 2 * j, 0), out == 0 ? q : p};
    const int a = some(), b = some();
    const triangle<T> inside{place(a, b, 0), place(i, j, 0), place(-a - i, -b - j, 0)};
    const triangle<T> face = more == 0 ? inside : triangle<T>{edge.a, r, q};
    const auto check = [&](const auto& t, double radius, int kind) {
        const double d = apart;
        for (const double at : {d, std::nextafter(d, -1.0), std::nextafter(d, 1e9)}) {
            if (at - radius < 0 || static_cast<double>(at - radius) + radius != at) continue;
            examine_stages(s, t, at - radius, at >= d, k, sum[kind]);
        }
    };
    check(edge, 0, 0);
    check(face, 0, 1);
    const vec3<T> n = place(0, 0, 1) - p;
    const auto side = [&](T from, T along) {
        const T size = static_cast<T>(1 + draw.below(30));
        return segment<T>{{along > 0 ? from : from - size, 0, 0}, {along < 0 ? from : from + size, 0, 0}};
    };
    const segment<T> along_x = side(p.x, n.x), along_y = side(p.y, n.y), along_z = side(p.z, n.z);
    check(aabb<T>{{along_x.a.x, along_y.a.x, along_z.a.x}, {along_x.b.x, along_y.b.x, along_z.b.x}}, 0, 2);
    if (far > 0) {
        const int radius = 1 + draw.below(apart);
        check(capsule<T>{edge, static_cast<T>(radius)}, radius, 3);
    }
    std::vector<vec3<T>> points{face.a, face.b, face.c};
    for (int m = 0; m < 8; ++m) points.push_back(place(some(), some(), draw.below(3)));
    check(hull<T>(points.data(), points.size()), 0, 4);
}

}  // namespace revolution_core_within

}  // namespace

TEMPLATE_TEST_CASE("within, cylinders and cones: edges, faces and hulls in every family, against 300 bits", "",
                   abut::cylinder<float>, abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    using namespace abut;
    using namespace revolution_core_within;
    using T = scalar_type_of<TestType>;
    core_tally total[kinds];
    const auto add = [&](const char* name, const core_tally(&sum)[kinds]) {
        core_tally of_family;
        for (int i = 0; i < kinds; ++i) of_family += sum[i], total[i] += sum[i];
        CAPTURE(name);
        CHECK(of_family.wrong == 0);
        test::print(name, of_family);
    };
    for (int i = 0; i < test::revolution_family_count; ++i) {
        const auto f = static_cast<test::revolution_family>(i);
        const bool is_long = f >= test::revolution_family::mixed_exponents;
        core_tally sum[kinds];
        for (std::uint64_t k = 0; k < test::some_samples(is_long ? 1000 : 250); ++k) {
            examine_case<TestType>(
                test::make_revolution_case<T>(test::sample_seed + 9, f, k, std::same_as<TestType, cone<T>>), k, sum);
        }
        add(test::name_of(f), sum);
    }
    core_tally sum[2][kinds];
    for (std::uint64_t k = 0; k < test::some_samples(100); ++k) {
        examine_case<TestType>(test::nearly_parallel<TestType>(k), k, sum[0]);
        examine_case<TestType>(test::over_needle<TestType>(k), k, sum[1]);
    }
    add("nearly parallel", sum[0]);
    add("needles", sum[1]);
    for (int i = 0; i < kinds; ++i) {
        test::print(name_of_kind[i], total[i]);
        CHECK(total[i].untold * 20 <= total[i].pairs);
        CHECK(test::is_share_above(0.15, total[i].hits, total[i].pairs));
        CHECK(test::is_share_above(0.15, total[i].pairs - total[i].hits, total[i].pairs));
    }
}

TEMPLATE_TEST_CASE("within, cylinders and cones: edges, faces and hulls that are exactly as far", "", abut::cylinder<float>,
                   abut::cylinder<double>, abut::cone<float>, abut::cone<double>) {
    using namespace abut;
    using namespace revolution_core_within;
    core_tally sum[kinds];
    for (std::uint64_t k = 0; k < test::some_samples(50); ++k) examine_tie<TestType>(k, sum);
    for (int i = 0; i < kinds; ++i) {
        CAPTURE(name_of_kind[i]);
        test::print(name_of_kind[i], sum[i]);
        CHECK(sum[i].wrong == 0);
        CHECK(sum[i].hits * 10 >= sum[i].pairs * 6);
        CHECK(sum[i].pairs > sum[i].hits);
    }
}
