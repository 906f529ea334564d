// SPDX-License-Identifier: MIT
#include <abut/predicate/triangle_triangle.hpp>

#include <cmath>
#include <cstdio>
#include <limits>

#include "support/catch.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"
#include "support/triangle_families.hpp"

// Every stage against the oracle, family by family: the table goes to stdout, and to triangle-triangle.md in the folder that
// ABUT_RESULTS names. And what must not change an answer: orders, moves, powers of two, mirrors, rounding modes.

namespace {

using namespace abut;
using test::triangle_family;

// Constant expressions. Closed sets: touching counts.
constexpr triangle<float> flat{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

constexpr triangle<float> above(float height) { return {{1, 1, height}, {1, 2, height + 1}, {2, 1, height + 1}}; }
static_assert(intersects(flat, above(0)) && intersects<exact>(above(0), flat));             // a vertex in the face
static_assert(!intersects(flat, above(0x1p-149f)) && intersects(flat, above(-0x1p-149f)));  // one step above, below
static_assert(intersects<fast>(flat, above(-0.5f)) && !intersects<fast>(flat, above(0.5f)));

constexpr triangle<double> wall(double x) { return {{x, 1, -1}, {x, 1, 1}, {x + 1, 1, 0}}; }
static_assert(intersects(triangle<double>{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, wall(3)));  // edge on edge
static_assert(!intersects(triangle<double>{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, wall(0x1.8000000000001p1)));

static_assert(intersects(flat, flat));
static_assert(intersects(flat, triangle<float>{{4, 0, 0}, {5, 0, 1}, {5, 0, -1}}));       // a shared vertex
static_assert(intersects(flat, triangle<float>{{4, 0, 0}, {0, 0, 0}, {0, -1, 5}}));       // a shared edge
static_assert(intersects(flat, triangle<float>{{2, 0, 0}, {5, -3, 1}, {5, -3, -1}}));     // a vertex on an edge
static_assert(intersects(flat, triangle<float>{{1, 1, 0}, {1.5f, 1, 0}, {1, 1.5f, 0}}));  // nested in one plane
static_assert(intersects(flat, triangle<float>{{4, -1, 0}, {4, 1, 0}, {5, 0, 0}}));       // in one plane, touching
static_assert(!intersects(flat, triangle<float>{{2.5f, 2, 0}, {5, 0, 0}, {5, 5, 0}}));    // in one plane, apart
static_assert(intersects(flat, triangle<float>{{3, 0, 0}, {9, 0, 0}, {6, -1, 0}}));       // edges on one line
static_assert(!intersects(flat, triangle<float>{{4.5f, 0, 0}, {9, 0, 0}, {6, -1, 0}}));

// Segments and points, however they are written
constexpr triangle<float> point{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, other_point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
constexpr triangle<float> in_line{{0, 0, 0}, {2, 2, 0}, {1, 1, 0}}, upright{{1, 1, -1}, {1, 1, 1}, {1, 1, -1}},
    skew{{1, 0, -1}, {1, 0, 1}, {1, 0, 1}};
static_assert(intersects(flat, point) && !intersects(flat, other_point) && intersects(point, point));
static_assert(!intersects(point, other_point) && intersects(in_line, point) && !intersects(in_line, other_point));
static_assert(intersects(in_line, flat) && intersects(upright, in_line) && intersects(upright, other_point));
static_assert(!intersects(skew, in_line) && intersects(skew, flat) && intersects(upright, flat));

// The whole range at once
constexpr float huge = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
constexpr triangle<float> sheet{{-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}};
static_assert(intersects(sheet, triangle<float>{{0, 0, 0}, {1, 1, huge}, {-1, 1, huge}}));
static_assert(!intersects(sheet, triangle<float>{{0, 0, least}, {1, 1, huge}, {-1, 1, huge}}));
static_assert(intersects(sheet, triangle<float>{{0, 0, -least}, {1, 1, huge}, {-1, 1, huge}}));

static_assert(decidable_pair<triangle<float>, triangle<float>> && decidable_pair<triangle<double>, triangle<double>>);
static_assert(!decidable_pair<triangle<float>, triangle<double>>);

/// The dimension of the hull: 0, 1 or 2, for coordinates that are small integers
template <scalar T>
int dimension(const triangle<T>& t) {
    const vec3<T> none{0, 0, 0}, ab = t.b - t.a, ac = t.c - t.a;
    return cross(ab, ac) != none ? 2 : ab != none || ac != none ? 1 : 0;
}

template <scalar T, class Map>
triangle<T> mapped(const triangle<T>& t, Map map) {
    return {map(t.a), map(t.b), map(t.c)};
}

template <scalar T, class Map>
triangle<T> each_coordinate(const triangle<T>& t, Map map) {
    return mapped(t, [&](const vec3<T>& v) { return vec3<T>{map(v.x, 0), map(v.y, 1), map(v.z, 2)}; });
}

struct changes {
    std::uint64_t pairs = 0, hits = 0, asked = 0, wrong = 0;
    changes& operator+=(const changes& o) {
        pairs += o.pairs, hits += o.hits, asked += o.asked, wrong += o.wrong;
        return *this;
    }
};

/// Runs `check(pair, draws, answer, tally)` for some pairs of every family, where `answer` is what `intersects` says.
template <scalar T, class Check>
void check_changes(const char* what, Check check) {
    changes all;
    for (int i = 0; i < test::triangle_family_count; ++i) {
        const auto f = static_cast<triangle_family>(i);
        const std::uint64_t count = test::sample_count() / 10;
        const changes c = test::in_threads<changes>(count, [&](std::uint64_t first, std::uint64_t last, changes& sum) {
            for (std::uint64_t k = first; k < last; ++k) {
                const auto p = test::make_triangle_pair<T>(test::sample_seed, f, k);
                test::draws d(test::sample_seed, 300 + static_cast<std::uint64_t>(i), k);
                const bool answer = intersects(p.a, p.b);
                ++sum.pairs;
                sum.hits += answer;
                check(p, d, answer, sum);
            }
        });
        INFO(what << ", " << test::name_of(f));
        CHECK(c.wrong == 0);
        all += c;
    }
    std::printf("%s, %s: %llu pairs of %d families, seed %llu, hits %.1f %%, asked again %llu times\n", what,
                sizeof(T) == 4 ? "float" : "double", static_cast<unsigned long long>(all.pairs), test::triangle_family_count,
                static_cast<unsigned long long>(test::sample_seed), test::percent(all.hits, all.pairs),
                static_cast<unsigned long long>(all.asked));
    CHECK(all.asked * 5 > all.pairs);
    CHECK(test::percent(all.hits, all.pairs) > 20);
    CHECK(test::percent(all.hits, all.pairs) < 80);
}

template <scalar T>
void ask_again(const triangle<T>& s, const triangle<T>& t, bool answer, changes& sum) {
    sum.asked += 2;
    sum.wrong += intersects(s, t) != answer;
    sum.wrong += intersects<exact>(t, s) != answer;
}

}  // namespace

TEST_CASE("triangle and triangle: every stage is right in every family") {
    test::check_every_family<triangle_family>(
        "Triangle against triangle", "triangle-triangle.md", true, test::triangle_family_count,
        [](triangle_family f) { return test::name_of(f); },
        []<class T>(T, triangle_family f, std::uint64_t k, test::stage_tally& sum) {
            const auto [s, t] = test::make_triangle_pair<T>(test::sample_seed, f, k);
            test::examine_stages<detail::triangle_meets_triangle>(s, t, detail::values_of(s, t).value,
                                                                  test::oracle::intersects(s, t), k, sum);
        });
}

TEMPLATE_TEST_CASE("triangle and triangle: triangles, segments and points, each against each", "", float, double) {
    std::uint64_t pairs[3][3] = {}, hits[3][3] = {}, wrong = 0;
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        const auto [s, t] = test::make_triangle_pair<TestType>(test::sample_seed, triangle_family::degenerate, k);
        const bool truth = test::oracle::intersects(s, t);
        wrong += intersects(s, t) != truth || intersects<exact>(s, t) != truth;
        ++pairs[dimension(s)][dimension(t)];
        hits[dimension(s)][dimension(t)] += truth;
    }
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            std::printf("dimensions %d and %d, %s: %llu pairs, %llu hits\n", i, j,
                        sizeof(TestType) == 4 ? "float" : "double", static_cast<unsigned long long>(pairs[i][j]),
                        static_cast<unsigned long long>(hits[i][j]));
            CHECK(hits[i][j] * 50 > pairs[i][j]);
            CHECK(hits[i][j] * 50 < 49 * pairs[i][j]);
        }
    }
    CHECK(wrong == 0);
}

// What makes dense ties cheap; without it the integers would give the same answers.
TEMPLATE_TEST_CASE("triangle and triangle: ties on a coarse grid and at shared corners are decided before the integers", "",
                   float, double) {
    using T = TestType;
    std::uint64_t left = 0, undecided = 0, shared = 0, missed = 0;
    for (const triangle_family f : {triangle_family::lattice_4, triangle_family::lattice_16, triangle_family::lattice_256}) {
        for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
            auto [s, t] = test::make_triangle_pair<T>(test::sample_seed, f, k);
            // Anywhere on the grid, of any unit, and with the largest number that has 16 bits
            const T unit = std::ldexp(T(1), static_cast<int>(k % 181) - 90), off = static_cast<T>(0xffff - 256);
            const auto placed = [&](T x, int) { return (k % 2 == 0 ? x + off : x) * unit; };
            s = each_coordinate(s, placed), t = each_coordinate(t, placed);
            if (decide<filtered>(s, t) != verdict::unknown) continue;
            ++left;
            undecided += decide_late<filtered>(s, t) != to_verdict(test::oracle::intersects(s, t));
        }
    }
    for (const triangle_family f : {triangle_family::shared_vertex, triangle_family::shared_edge, triangle_family::copied}) {
        for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
            const auto [s, t] = test::make_triangle_pair<T>(test::sample_seed, f, k);
            bool any = false;
            for (const vec3<T>& p : {s.a, s.b, s.c}) any = any || p == t.a || p == t.b || p == t.c;
            shared += any;
            missed += any && decide_late<filtered>(s, t) != verdict::yes;
        }
    }
    std::printf("ties, %s: %llu on grids, %llu at shared corners\n", sizeof(T) == 4 ? "float" : "double",
                static_cast<unsigned long long>(left), static_cast<unsigned long long>(shared));
    CHECK(left * 10 > test::sample_count());
    CHECK(undecided == 0);
    CHECK(shared * 2 > test::sample_count());
    CHECK(missed == 0);
}

TEMPLATE_TEST_CASE("triangle and triangle: one answer in all 72 orders", "", float, double) {
    check_changes<TestType>("orders", [](const auto& p, test::draws&, bool answer, changes& sum) {
        for (int k = 0; k < 36; ++k) ask_again(test::reordered(p.a, k % 6), test::reordered(p.b, k / 6), answer, sum);
    });
}

TEMPLATE_TEST_CASE("triangle and triangle: one answer where both are mirrored or axes are exchanged", "", float, double) {
    check_changes<TestType>("mirrors and axes", [](const auto& p, test::draws&, bool answer, changes& sum) {
        for (unsigned k = 0; k < 48; ++k) {
            const auto map = [k](const vec3<TestType>& v) {
                const TestType c[3] = {k & 8 ? -v.x : v.x, k & 16 ? -v.y : v.y, k & 32 ? -v.z : v.z};
                const unsigned i = k % 3, j = (i + 1 + k / 3 % 2) % 3;
                return vec3<TestType>{c[i], c[j], c[3 - i - j]};
            };
            ask_again(mapped(p.a, map), mapped(p.b, map), answer, sum);
        }
    });
}

// Where a coordinate would be rounded, or leave the range, the pair is not asked again.

TEMPLATE_TEST_CASE("triangle and triangle: one answer at every power of two", "", float, double) {
    using T = TestType;
    constexpr int reach = std::numeric_limits<T>::max_exponent;
    check_changes<T>("powers of two", [](const auto& p, test::draws& d, bool answer, changes& sum) {
        for (int n = 0; n < 8; ++n) {
            const int k = d.below(n % 2 == 0 ? 41 : 2 * reach) - (n % 2 == 0 ? 20 : reach);
            bool same = true;
            const auto map = [&](T x, int) {
                const T scaled = std::ldexp(x, k);
                same = same && std::isfinite(scaled) && std::ldexp(scaled, -k) == x;
                return scaled;
            };
            const triangle<T> s = each_coordinate(p.a, map), t = each_coordinate(p.b, map);
            if (same) ask_again(s, t, answer, sum);
        }
    });
}

TEMPLATE_TEST_CASE("triangle and triangle: one answer after moves by representable amounts", "", float, double) {
    using T = TestType;
    check_changes<T>("moves", [](const auto& p, test::draws& d, bool, changes& sum) {
        // Rounded to multiples of the last digit but four of the largest, the pair may be moved by as many of these as that.
        int exponent = std::numeric_limits<T>::min_exponent;
        each_coordinate(p.a, [&](T x, int) { return exponent = x != 0 ? std::max(exponent, std::ilogb(x)) : exponent, x; });
        each_coordinate(p.b, [&](T x, int) { return exponent = x != 0 ? std::max(exponent, std::ilogb(x)) : exponent, x; });
        const int unit = exponent - std::numeric_limits<T>::digits + 4;
        const auto coarse = [&](T x, int) { return std::ldexp(std::nearbyint(std::ldexp(x, -unit)), unit); };
        const triangle<T> s = each_coordinate(p.a, coarse), t = each_coordinate(p.b, coarse);
        const bool answer = intersects(s, t);
        for (int n = 0; n < 8; ++n) {
            T by[3];
            for (T& x : by) x = std::ldexp(std::nearbyint(static_cast<T>(d.uniform(-1, 1)) * T(1 << 20)), exponent - 20);
            if (n == 0) by[0] = -s.a.x, by[1] = -s.a.y, by[2] = -s.a.z;
            bool same = true;
            const auto map = [&](T x, int k) {
                const T moved = x + by[k];
                same = same && moved - by[k] == x && moved - x == by[k];
                return moved;
            };
            const triangle<T> moved_s = each_coordinate(s, map), moved_t = each_coordinate(t, map);
            if (same) ask_again(moved_s, moved_t, answer, sum);
        }
    });
}

TEMPLATE_TEST_CASE("triangle and triangle: right in every floating-point mode", "", float, double) {
    check_changes<TestType>("floating-point modes", [](const auto& p, test::draws&, bool, changes& sum) {
        const bool truth = test::oracle::intersects(p.a, p.b);
        ++sum.asked;
        sum.wrong += test::modes_in_which([&] { return intersects(p.a, p.b) != truth; });
    });
}
