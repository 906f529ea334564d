// SPDX-License-Identifier: MIT
#include <abut/predicate/zero_area.hpp>

#include <cstdio>
#include <iterator>
#include <vector>

#include "support/catch.hpp"
#include "support/flat_triangles.hpp"
#include "support/modes.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;

static_assert(has_zero_area(triangle<float>{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}));
static_assert(!has_zero_area(triangle<float>{{0, 0, 0}, {1, 2, 3}, {2, 4, 0x1.800002p2f}}));
static_assert(has_zero_area(triangle<double>{{7, 0, 0}, {7, 0, 0}, {1, 2, 3}}));
static_assert(!has_zero_area<exact>(triangle<double>{{0, 0, 0}, {0x1p-1074, 0, 0}, {0, 0x1p1023, 0}}));
static_assert(has_zero_area<exact>(triangle<double>{{0, 0, 0}, {0x1p-1074, 0, 0}, {-0x1p1023, 0, 0}}));

/// The corners are on a line if and only if Gram's determinant of two sides is 0: no cross product.
template <class T>
bool truly_flat(const triangle<T>& t) {
    const std::vector<test::integer> v =
        test::to_integers(std::vector<T>{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z});
    const test::integer_point f{v[3] - v[0], v[4] - v[1], v[5] - v[2]}, g{v[6] - v[0], v[7] - v[1], v[8] - v[2]};
    const test::integer fg = inner(f, g);
    return inner(f, f) * inner(g, g) == fg * fg;
}

struct area_tally {
    std::uint64_t triangles = 0, flat = 0, filtered = 0, wide = 0, wrong = 0;
};

template <class T>
void examine(const triangle<T>& t, bool truth, area_tally& sum) {
    const verdict by_filter = decide_zero_area<filtered>(t), by_limbs = decide_zero_area<exact>(t);
    ++sum.triangles;
    sum.flat += truth;
    sum.filtered += by_filter != verdict::unknown;
    sum.wide += by_limbs == verdict::unknown;
    for (const verdict v : {by_filter, by_limbs}) sum.wrong += v != verdict::unknown && v != to_verdict(truth);
    sum.wrong += resolve_zero_area(t) != truth;
    sum.wrong += has_zero_area(t) != truth;
    sum.wrong += has_zero_area<exact>(t) != truth;
}

/// What the families are made to hit: how many in a hundred are flat, at least and at most.
struct share {
    int least, most;
};
constexpr share flat_share[] = {
    {0, 0},      // random
    {4, 8},      // lattice
    {3, 8},      // tenth_lattice
    {100, 100},  // collinear
    {1, 10},     // collinear_scaled
    {0, 2},      // one_ulp_off
    {0, 1},      // rounded_line
    {4, 8},      // far_off
    {80, 98},    // points
    {8, 20},     // denormals
    {100, 100},  // partly_denormal
    {2, 20},     // largest
    {55, 80},    // across
    {100, 100},  // mixed_exponents
    {10, 40},    // mixed_off
    {40, 80},    // along_axis
    {0, 1}       // any_bits
};
static_assert(std::size(flat_share) == test::flat_family_count);

}  // namespace

TEMPLATE_TEST_CASE("zero area: every stage is right in every family", "", float, double) {
    using T = TestType;
    for (int k = 0; k < test::flat_family_count; ++k) {
        area_tally sum;
        for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
            const auto t = test::make_flat_triangle<T>(test::sample_seed, static_cast<test::flat_family>(k), i);
            examine(t, truly_flat(t), sum);
        }
        const double percent = 100.0 / static_cast<double>(sum.triangles);
        std::printf("zero area, %s, family %2d: %5.1f %% flat, filter decides %5.1f %%, any span %5.1f %%\n",
                    sizeof(T) == 4 ? "float " : "double", k, percent * static_cast<double>(sum.flat),
                    percent * static_cast<double>(sum.filtered), percent * static_cast<double>(sum.wide));
        CAPTURE(k);
        CHECK(sum.wrong == 0);
        CHECK(percent * static_cast<double>(sum.flat) >= flat_share[k].least);
        CHECK(percent * static_cast<double>(sum.flat) <= flat_share[k].most);
        if (k == 0) CHECK(sum.filtered == sum.triangles);
    }
}

TEMPLATE_TEST_CASE("zero area: right in every floating-point mode", "", float, double) {
    for (int k = 0; k < test::flat_family_count; ++k) {
        std::vector<triangle<TestType>> triangles;
        std::vector<char> truth;
        for (std::uint64_t i = 0; i < test::sample_count() / 5; ++i) {
            triangles.push_back(
                test::make_flat_triangle<TestType>(test::sample_seed + 1, static_cast<test::flat_family>(k), i));
            truth.push_back(truly_flat(triangles.back()));
        }
        const std::uint64_t wrong = test::modes_in_which([&] {
            area_tally sum;
            for (std::size_t i = 0; i < triangles.size(); ++i) examine(triangles[i], truth[i] != 0, sum);
            return sum.wrong != 0;
        });
        CAPTURE(k);
        CHECK(wrong == 0);
    }
}
