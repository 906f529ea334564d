// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include <abut/narrow/measure_apart.hpp>

#include "support/catch.hpp"
#include "support/cone_pair_families.hpp"
#include "support/cylinder_pair_families.hpp"
#include "support/revolution_gap.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_ties.hpp"
#include "support/samples.hpp"

// Cylinders and cones within a distance of each other. Oracles are those of revolution_core_within.test.cpp: bounds in 300
// bits, and parallel planes of whole numbers that touch both.

namespace {

namespace revolution_pair_within {

using namespace abut;

constexpr cylinder<float> drum{{{0, 0, 0}, {0, 0, 2}}, 5};
constexpr cone<double> tip{{0, 0, 0}, {0, 0, 4}, 3};

static_assert(distance_decidable<cylinder<float>, cylinder<float>> && distance_decidable<cylinder<double>, cone<double>> &&
              distance_decidable<cone<float>, cone<float>> && !distance_decidable<cone<float>, cone<double>>);
static_assert(within(drum, cylinder<float>{{{0, 0, 5}, {0, 0, 6}}, 1}, 3) &&
              !within(drum, cylinder<float>{{{0, 0, 5}, {0, 0, 6}}, 1}, 0x1.7ffffffffffffp1));
// Without an axis, or a radius.
static_assert(within(cylinder<double>{{{7, 0, 1}, {7, 0, 1}}, 1}, tip, 5) &&
              within(tip, cylinder<double>{{{6, -9, 8}, {6, 9, 8}}, 0}, 5) &&
              !within(tip, cylinder<double>{{{6, -9, 8}, {6, 9, 8}}, 0}, 0x1.3ffffffffffffp2));

using tally = test::within_tally;

template <class S, class U>
void examine_stages(const S& s, const U& t, double d, bool truth, tally& sum) {
    const verdict lie = to_verdict(!truth), by_filter = detail::decide_within<filtered>(s, t, d),
                  by_bits = detail::decide_within<exact>(s, t, d);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += within<fast>(t, s, d) != truth;
    sum.wrong += by_filter == lie || by_bits == lie || within(s, t, d) != truth || within<exact>(t, s, d) != truth ||
                 detail::resolve_within(s, t, d) != truth || within(s, t, 0) != intersects(s, t);
    // The search has an end, but for a few ties.
    const bool are_solids = !detail::is_point(detail::axis_of(s)) && !detail::is_point(detail::axis_of(t)) && s.radius > 0 &&
                            t.radius > 0;
    if (are_solids && d > 0) sum.without_end += by_bits == verdict::unknown, sum.wrong += by_bits == verdict::unknown && !truth;
}

template <class S, class U>
void examine(const S& s, const U& t, std::uint64_t index, tally& sum) {
    if (!is_valid(s) || !is_valid(t)) return;
    const bool touch = intersects(s, t);
    const double least = touch ? 0 : static_cast<double>(detail::measure_apart{}.measure(s, t, infinity<double>));
    const double d = test::distance_beside(least, index);
    if (touch) return examine_stages(s, t, d, true, sum);
    const test::wide_gap_of_solid gap = test::gap_of_solid(s, t);
    const test::wide off = ldexp(gap.farthest, -150);
    const bool is_near = gap.distance.upper + off <= d;
    if (!is_near && d + off >= gap.distance.lower) {
        ++sum.untold;
        return;
    }
    examine_stages(s, t, d, is_near, sum);
}

/// As the family has it, and moved away.
template <class S, class U, scalar T>
void examine_case(test::pair_of_rounds<T> c, std::uint64_t k, tally& sum) {
    const S s = test::round_shape<S>(c.first, c.first_radius);
    if (k % 2 == 1) {
        const vec3<T> away = k % 4 == 1 ? c.first.b - c.first.a : vec3<T>{c.first_radius, c.second_radius, c.first_radius};
        c.second = {c.second.a + away, c.second.b + away};
    }
    examine(s, test::round_shape<U>(c.second, c.second_radius), k / 4, sum);
}

/// Two solids of whole numbers, the second seen in a mirror point, with equal normals where they are to be nearest.
template <class S, class U>
void examine_tie(std::uint64_t k, tally& sum) {
    using T = scalar_type_of<S>;
    constexpr bool is_cone = std::same_as<S, cone<T>>, is_other_cone = std::same_as<U, cone<T>>;
    test::draws draw(test::sample_seed, is_cone ? is_other_cone ? 99 : 98 : 97, k);
    const test::construction::lattice_frame f(draw);
    const test::lattice_touch x = test::touch_in_lattice(draw, is_cone);
    test::lattice_touch y;
    int turn = 0;
    bool found = false;
    for (int i = 0; i < 400 && !found; ++i) {
        y = test::touch_in_lattice(draw, is_other_cone);
        turn = draw.below(3);
        found = true;
        for (int n = 0; n < 3; ++n) found = found && x.normal[n] * y.length == y.normal[(n + turn) % 3] * x.length;
    }
    if (!found) return;
    const int far = 1 + draw.below(4);
    const auto place = [&](int at) {  // of the second, on its axis
        const auto coordinate = [&](int n) {
            const int m = (n + turn) % 3;
            return x.at[n] + far * x.normal[n] + y.at[m] - (m == 2 ? at : 0);
        };
        return f.at<T>(coordinate(0), coordinate(1), coordinate(2));
    };
    const auto radius = [&](int r) { return static_cast<T>(r * f.unit()); };
    const S s = test::round_shape<S>(segment<T>{f.at<T>(0, 0, 0), f.at<T>(0, 0, x.height)}, radius(x.radius));
    const U t = test::round_shape<U>(segment<T>{place(0), place(y.height)}, radius(y.radius));
    const double d = far * x.length * f.unit();
    for (const double at : {d, std::nextafter(d, 0.0), std::nextafter(d, 1e9)}) examine_stages(s, t, at, at >= d, sum);
}

template <class S, class U>
void check_pairs() {
    using T = scalar_type_of<S>;
    tally total;
    for (int i = 0; i < test::round_family_count + test::cone_family_count; ++i) {
        tally sum;
        const bool is_round = i < test::round_family_count;
        const auto f = static_cast<test::round_family>(i);
        const auto g = static_cast<test::cone_family>(i - test::round_family_count);
        for (std::uint64_t k = 0; k < test::some_samples(250); ++k) {
            if (is_round) {
                examine_case<S, U>(test::make_round_pair<cylinder<T>>(test::sample_seed + 11, f, k), k, sum);
            } else {
                examine_case<S, U>(test::make_cone_pair<cone<T>>(test::sample_seed + 11, g, k), k, sum);
            }
        }
        const char* const name = is_round ? test::name_of(f) : test::name_of(g);
        CAPTURE(name);
        CHECK(sum.wrong == 0);
        test::print(name, sum);
        total += sum;
    }
    test::print("all", total);
    CHECK(total.untold * 10 <= total.pairs);
    CHECK(test::is_share_above(0.15, total.hits, total.pairs));
    CHECK(test::is_share_above(0.15, total.pairs - total.hits, total.pairs));
    tally ties;
    for (std::uint64_t k = 0; k < test::some_samples(10); ++k) examine_tie<S, U>(k, ties);
    test::print("ties", ties);
    CHECK(ties.wrong == 0);
    CHECK(total.without_end * 100 <= total.pairs);
    CHECK(ties.without_end * 50 <= ties.pairs);
    CHECK(ties.pairs > 0);
    CHECK(ties.hits * 3 == ties.pairs * 2);
}

}  // namespace revolution_pair_within

}  // namespace

TEMPLATE_TEST_CASE("within, cylinders and cones with each other: families against 300 bits, and exact ties", "", float,
                   double) {
    using namespace abut;
    revolution_pair_within::check_pairs<cylinder<TestType>, cylinder<TestType>>();
    revolution_pair_within::check_pairs<cone<TestType>, cylinder<TestType>>();
    revolution_pair_within::check_pairs<cone<TestType>, cone<TestType>>();
}
