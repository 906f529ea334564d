// SPDX-License-Identifier: MIT
#include <abut/predicate/intersects.hpp>

#include <cfenv>
#include <cmath>
#include <cstdio>

#include <rapidcheck.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/hulls.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"
#include "support/triangle_families.hpp"

// The other pairs of shapes against the oracle, and what must not change an answer: the order of arguments and of corners,
// powers of two, mirrors, and when it is computed.

namespace {

using namespace abut;
using test::family;
using test::triangle_family;

constexpr triangle<float> corner{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
constexpr sphere<double> unit_ball{{0, 0, 0}, 1};

// Constant expressions, in either order; closed sets; the whole range.
static_assert(intersects(sphere<float>{{0, 0, 5}, 5}, corner));
static_assert(!intersects(sphere<float>{{0, 0, 5}, 0x1.3ffffep2f}, corner));
static_assert(intersects<exact>(corner, sphere<float>{{0, 0, -5}, 5}));
static_assert(intersects<fast>(corner, sphere<float>{{0, 0, -4}, 5}));
static_assert(intersects(vec3<float>{0, 0, 0}, corner) && !intersects(corner, vec3<float>{0, 0, 0x1p-149f}));
static_assert(intersects(unit_ball, sphere<double>{{2, 0, 0}, 1}) &&
              !intersects(unit_ball, sphere<double>{{2, 0x1p-1074, 0}, 1}));
static_assert(intersects(segment<double>{{1, -5, 0}, {1, 5, 0}}, unit_ball));
static_assert(!intersects(segment<double>{{0x1.0000000000001p0, -5, 0}, {0x1.0000000000001p0, 5, 0}}, unit_ball));

static_assert(decidable_pair<sphere<float>, triangle<float>> && decidable_pair<vec3<double>, triangle<double>>);
static_assert(decidable_pair<triangle<float>, triangle<float>> && decidable_pair<segment<double>, triangle<double>>);
static_assert(!decidable_pair<sphere<float>, triangle<double>>);  // mixed scalars
static_assert(!decidable_pair<triangle<float>, triangle<double>> && !decidable_pair<segment<float>, triangle<double>>);
static_assert(!decidable_pair<triangle<double>, sphere<float>>);

struct tally {
    std::uint64_t pairs = 0, hits = 0, wrong = 0;
    tally& operator+=(const tally& o) {
        pairs += o.pairs, hits += o.hits, wrong += o.wrong;
        return *this;
    }
};

template <class S, class U>
void examine(const S& s, const U& t, bool truth, std::uint64_t index, tally& sum) {
    ++sum.pairs;
    sum.hits += truth;
    bool wrong = intersects(s, t) != truth || intersects(t, s) != truth || intersects<exact>(s, t) != truth;
    wrong = wrong || decide<filtered>(s, t) == to_verdict(!truth) || decide<exact>(s, t) == to_verdict(!truth);
    if (index % 16 == 0) wrong = wrong || resolve(s, t) != truth;
    sum.wrong += wrong;
}

template <class Family, class MakePair, class Examine>
void check_all(const char* what, int family_count, MakePair make_pair, Examine check_pair, double least_share) {
    tally all;
    for (int i = 0; i < family_count; ++i) {
        const auto f = static_cast<Family>(i);
        const tally t =
            test::in_threads<tally>(test::sample_count(), [&](std::uint64_t first, std::uint64_t last, tally& sum) {
                for (std::uint64_t k = first; k < last; ++k) check_pair(make_pair(f, k), k, sum);
            });
        INFO(what << ", " << test::name_of(f));
        CHECK(t.pairs >= test::sample_count());
        CHECK(t.wrong == 0);
        all += t;
    }
    const double share = static_cast<double>(all.hits) / static_cast<double>(all.pairs);
    std::printf("%s: %llu pairs of %d families, seed %llu, hits %.1f %%\n", what, static_cast<unsigned long long>(all.pairs),
                family_count, static_cast<unsigned long long>(test::seed), 100 * share);
    CHECK(share > least_share);
    CHECK(share < 0.95);
}

/// Every family, read as pairs of other shapes.
template <scalar T, class Examine>
void check_families(const char* what, Examine check_pair) {
    const auto make_pair = [](family f, std::uint64_t k) { return test::make_pair<T>(test::seed, f, k); };
    check_all<family>(what, test::family_count, make_pair, check_pair, 0.05);
}

template <scalar T, class Examine>
void check_triangle_families(const char* what, Examine check_pair, double least_share) {
    const auto make_pair = [](triangle_family f, std::uint64_t k) { return test::make_triangle_pair<T>(test::seed, f, k); };
    check_all<triangle_family>(what, test::triangle_family_count, make_pair, check_pair, least_share);
}

}  // namespace

TEMPLATE_TEST_CASE("sphere and segment: every stage is right in every family", "", float, double) {
    check_families<TestType>("sphere and segment", [](const auto& p, std::uint64_t k, tally& sum) {
        const segment<TestType> e{p.t.a, p.t.b};
        examine(p.s, e, test::oracle::intersects(p.s, e), k, sum);
    });
}

TEMPLATE_TEST_CASE("sphere and sphere: every stage is right in every family", "", float, double) {
    check_families<TestType>("sphere and sphere", [](const auto& p, std::uint64_t k, tally& sum) {
        // The other ball's radius is 0, or a share of the first one's, which it then lacks.
        const TestType share = k % 2 == 0 ? TestType(0) : p.s.radius / 4;
        const sphere<TestType> s{p.s.center, p.s.radius - share}, o{p.t.a, share};
        examine(s, o, test::oracle::intersects(s, o), k, sum);
    });
}

TEMPLATE_TEST_CASE("point and triangle: a sphere of radius 0", "", float, double) {
    tally all;
    for (const family f : {family::radius_zero, family::lattice_4, family::degenerate, family::all_bit_patterns}) {
        for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
            const auto p = test::make_pair<TestType>(test::seed, f, k);
            const sphere<TestType> point{p.s.center, 0};
            examine(p.s.center, p.t, test::oracle::intersects(point, p.t), k, all);
        }
    }
    CHECK(all.wrong == 0);
    CHECK(all.hits * 20 > all.pairs);
}

// Of triangle pairs: the first one's corners in turn, and the edges between them.

TEMPLATE_TEST_CASE("segment and triangle: every stage is right in every family of triangles", "", float, double) {
    check_triangle_families<TestType>(
        "segment and triangle",
        [](const auto& p, std::uint64_t k, tally& sum) {
            const triangle<TestType> turned = test::reordered(p.a, static_cast<int>(k % 6));
            const segment<TestType> e{turned.a, turned.b};
            examine(e, p.b, test::oracle::intersects(e, p.b), k, sum);
        },
        0.1);
}

TEMPLATE_TEST_CASE("point and triangle: every stage is right in every family of triangles", "", float, double) {
    check_triangle_families<TestType>(
        "point and triangle",
        [](const auto& p, std::uint64_t k, tally& sum) {
            const vec3<TestType> vertex = test::reordered(p.a, static_cast<int>(k % 3)).a;
            examine(vertex, p.b, test::oracle::intersects(vertex, p.b), k, sum);
        },
        0.02);
}

TEMPLATE_TEST_CASE("answers do not depend on the order of corners, on powers of two, or on mirrors", "", float, double) {
    using T = TestType;
    CHECK(rc::check("sphere and triangle", [] {
        const auto f = static_cast<family>(*rc::gen::inRange(0, test::family_count));
        const auto index = *rc::gen::arbitrary<std::uint32_t>();
        const auto [s, t] = test::make_pair<T>(test::seed, f, index);
        const bool answer = intersects(s, t);

        const triangle<T> orders[] = {{t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
        for (const triangle<T>& o : orders) RC_ASSERT(intersects(o, s) == answer);

        const auto swapped = [](const vec3<T>& v) { return vec3<T>{-v.z, v.x, -v.y}; };
        RC_ASSERT(intersects(sphere<T>{swapped(s.center), s.radius},
                             triangle<T>{swapped(t.a), swapped(t.b), swapped(t.c)}) == answer);

        const T scale = std::ldexp(T(1), *rc::gen::inRange(-20, 20));
        bool exact_scale = true;
        const auto scaled = [&](T x) {
            exact_scale = exact_scale && (x * scale) / scale == x;
            return x * scale;
        };
        const auto scaled_point = [&](const vec3<T>& v) { return vec3<T>{scaled(v.x), scaled(v.y), scaled(v.z)}; };
        const sphere<T> s2{scaled_point(s.center), scaled(s.radius)};
        const triangle<T> t2{scaled_point(t.a), scaled_point(t.b), scaled_point(t.c)};
        if (exact_scale) RC_ASSERT(intersects(s2, t2) == answer);
    }));
}

TEST_CASE("the filter is right in every rounding mode") {
    std::uint64_t wrong = 0;
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        for (const family f :
             {family::random, family::tangent_face, family::needle_1e6, family::radius_tiny, family::lattice_4}) {
            for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
                const auto p = test::make_pair<float>(test::seed, f, k);
                const auto q = test::make_pair<double>(test::seed, f, k);
                std::fesetround(mode);
                const bool single = intersects(p.s, p.t), twice = intersects(q.s, q.t);
                std::fesetround(FE_TONEAREST);
                wrong += single != test::oracle::intersects(p.s, p.t);
                wrong += twice != test::oracle::intersects(q.s, q.t);
            }
        }
    }
    CHECK(wrong == 0);
}

#if defined(__SSE2__)
TEST_CASE("the filter is right where denormals are flushed to zero") {
    std::uint64_t wrong = 0;
    for (int i = 0; i < test::family_count; ++i) {
        for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
            const auto p = test::make_pair<float>(test::seed, static_cast<family>(i), k);
            const auto q = test::make_pair<double>(test::seed, static_cast<family>(i), k);
            const unsigned before = _mm_getcsr();
            _mm_setcsr(before | 0x8040);
            const bool single = intersects(p.s, p.t), twice = intersects(q.s, q.t);
            _mm_setcsr(before);
            wrong += single != test::oracle::intersects(p.s, p.t);
            wrong += twice != test::oracle::intersects(q.s, q.t);
        }
    }
    CHECK(wrong == 0);
}
#endif
