// SPDX-License-Identifier: MIT
#include <abut/narrow/hull_hit_time.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/hull_families.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/ray_oracle.hpp"
#include "support/samples.hpp"

// Rays and segments against convex hulls. The oracle: a line that begins outside enters through a triangle of three of the
// points, and each triangle is asked by linear programming in rationals; it begins inside if its origin is in the hull.

namespace {

using namespace abut;
using test::rational;

constexpr vec3<double> gem_points[6] = {{4, 0, 0}, {-4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {0, 0, 4}, {0, 0, -4}};
constexpr hull<double> gem(gem_points, 6);

// Constant expressions: through a face, an edge, a corner, along an edge, past one, from inside, and away.
static_assert(detail::hit_time<exact>(ray<double>{{-3, 1, 9}, {0, 0, -2}}, gem) == 4.5);
static_assert(detail::hit_time<filtered>(ray<double>{{-9, 1, 0}, {1, 0, 0}}, gem) == 6);
static_assert(detail::hit_time<filtered>(ray<double>{{0, 0, 9}, {0, 0, -1}}, gem) == 5);
static_assert(detail::hit_time<filtered>(ray<double>{{9, -5, 0}, {-1, 1, 0}}, gem) == 5);
static_assert(detail::hit_time<filtered>(segment<double>{{0, 0, 9}, {0, 0, 3.5}}, gem) == 10.0 / 11);
static_assert(detail::hit_time<filtered>(segment<double>{{0, 0, 9}, {0, 0, 4.5}}, gem) < 0);
static_assert(intersects(ray<double>{{1, 1, 1}, {1, 2, 3}}, gem) && !intersects(gem, ray<double>{{2, 2, 2}, {1, 2, 3}}));
static_assert(!intersects<exact>(ray<double>{{9, -4, 0}, {-1, 1, 0x1p-1074}}, gem) &&
              decidable_pair<ray<float>, hull<float>>);

template <scalar T, class Line>
std::optional<rational> true_time(const Line& line, const test::point_list<T>& p, const vec3<T>& origin) {
    if (test::oracle::hulls_intersect<T>({origin}, p)) return rational(0);
    std::optional<rational> least;
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = i; j < p.size(); ++j) {
            for (std::size_t k = j; k < p.size(); ++k) {
                if (j == i && k != j) continue;
                const auto t = test::first_time(line, triangle<T>{p[i], p[j], p[k]});
                if (t && (!least || *t < *least)) least = t;
            }
        }
    }
    return least;
}

template <scalar T, class Line>
const char* wrong_with_time(const Line& line, const test::point_list<T>& points, const vec3<T>& origin, bool& hit) {
    const auto truth = true_time(line, points, origin);
    const hull<T> h = test::hull_over(points);
    hit = truth.has_value();
    if (intersects(line, h) != hit || intersects<exact>(h, line) != hit) return "whether it meets the hull is wrong";
    if (detail::is_met<filtered>(line, h) != hit) return "is_met is wrong";
    const double by_filter = detail::hit_time<filtered>(line, h), by_integers = detail::hit_time<exact>(line, h);
    if (by_filter != by_integers) return "arithmetics differ";
    if ((by_filter >= 0) != hit) return "there is a time exactly where they meet";
    if (hit && *truth == 0 && by_filter != 0) return "it begins inside";
    if (hit && !test::is_rounded(by_filter, *truth)) return "the time is another one";
    return nullptr;
}
template <scalar T>
const char* wrong_with_ray(const ray<T>& r, const test::point_list<T>& points, bool truth) {
    const hull<T> h = test::hull_over(points);
    for (const verdict v : {decide<filtered>(r, h), decide_late<filtered>(r, h), decide<exact>(r, h)}) {
        if (v == to_verdict(!truth)) return "a stage is wrong";
    }
    return resolve(r, h) == truth && decide_late<fast>(r, h) != verdict::unknown ? nullptr : "the last stage is wrong";
}

}  // namespace

TEMPLATE_TEST_CASE("rays and hulls: times are the true ones, rounded once, in every family", "", float, double) {
    using T = TestType;
    for (const test::hull_family f : test::families_of_few_points) {
        std::uint64_t hits = 0, lines = 0, unknown = 0;
        const std::uint64_t samples = test::sample_count() / (f == test::hull_family::exponents ? 150 : 50);
        for (std::uint64_t k = 0; k < samples; ++k) {
            const auto c = test::make_line_case<T>(test::sample_seed, f, k);
            bool hit = false;
            const char* wrong = wrong_with_time(c.r, c.points, c.r.origin, hit);
            hits += hit;
            if (wrong == nullptr) wrong = wrong_with_ray(c.r, c.points, hit);
            if (wrong == nullptr) wrong = wrong_with_time(c.s, c.points, c.s.a, hit);
            hits += hit;
            unknown += decide<filtered>(c.r, test::hull_over(c.points)) == verdict::unknown;
            lines += 2;
            INFO(test::name_of(f) << " " << k);
            if (wrong != nullptr) FAIL_CHECK(wrong);
        }
        std::printf("%s: %llu lines, %llu meet, the filter leaves %.0f %% of rays\n", test::name_of(f),
                    static_cast<unsigned long long>(lines), static_cast<unsigned long long>(hits),
                    200.0 * static_cast<double>(unknown) / static_cast<double>(lines));
        INFO(test::name_of(f));
        if (f == test::hull_family::general) CHECK(unknown * 20 < lines * 9);
        CHECK(hits * 5 > lines);
        CHECK(hits * 20 < lines * 19);
    }
}

TEMPLATE_TEST_CASE("rays and hulls: right in every rounding mode, and where denormals are flushed", "", float, double) {
    using T = TestType;
    std::uint64_t wrong = 0;
    for (const test::hull_family f : test::families_of_few_points) {
        for (std::uint64_t k = 0; k < 27; ++k) {
            const auto c = test::make_line_case<T>(test::sample_seed + 1, f, k);
            const hull<T> h = test::hull_over(c.points);
            const bool truth = intersects<exact>(c.r, h);
            for (const test::floating_mode& mode : test::floating_modes()) {
                bool answer = !truth;
                verdict first{};
                test::in_mode(mode, [&] {
                    answer = intersects(c.r, h);
                    first = decide<filtered>(c.r, h);
                });
                wrong += answer != truth || first == to_verdict(!truth);
            }
        }
    }
    CHECK(wrong == 0);
}

// Of many points on a sphere and of a fine mesh of a box, all of whose faces are in six planes: steps end.
TEST_CASE("rays and hulls: of many points") {
    test::point_list<double> ball, box;
    test::draws d(test::sample_seed, 13, 0);
    for (int i = 0; i < 500; ++i) {
        ball.push_back(test::construction::round_to<double>(test::construction::unit(test::construction::cube(d, 1))));
    }
    for (int i = 0; i < 6 * 49; ++i) {
        const double u = i % 7, v = i / 7 % 7, w = i / 49 % 2 == 0 ? 0 : 6;
        box.push_back(i / 98 == 0 ? vec3<double>{u, v, w} : i / 98 == 1 ? vec3<double>{u, w, v} : vec3<double>{w, u, v});
    }
    const hull<double> round = test::hull_over(ball), square = test::hull_over(box);
    std::uint64_t hits = 0;
    for (int i = 0; i < 200; ++i) {
        const ray<double> r{{0, 0, -4}, {d.uniform(-0.2, 0.2), d.uniform(-0.2, 0.2), 1}};
        const double time = detail::hit_time<filtered>(r, round);
        if (time >= 0) {
            ++hits;
            // It is on the hull, and what is before it is not.
            const auto at = [&](double t) { return vec3<double>{t * r.direction.x, t * r.direction.y, t - 4}; };
            CHECK(!intersects(round, at(time * (1 - 0x1p-40))));
            CHECK(intersects(round, at(time * (1 + 0x1p-40))));
        }
        const vec3<double> to{0.5 * d.below(13), 0.5 * d.below(13), 6};
        const vec3<double> side{d.below(5) - 2.0, d.below(5) - 2.0, -1.0};
        CHECK(detail::hit_time<filtered>(ray<double>{to - 4.0 * side, side}, square) == 4);
        CHECK(detail::hit_time<filtered>(ray<double>{{to.x, to.y, 6}, {0, 0, 1}}, square) == 0);
        CHECK(detail::hit_time<filtered>(ray<double>{{to.x, to.y, 6.5}, {1, 0, 0}}, square) < 0);
        CHECK(detail::hit_time<filtered>(ray<double>{{-3, to.y, 6}, {2, 0, 0}}, square) == 1.5);
    }
    CHECK(hits > 100);
}

// All points are in one plane with the line: a few of a small lattice, so that the line goes through points, along sides and
// past all of them, in planes of any direction.
TEMPLATE_TEST_CASE("rays and hulls: in one plane, times are the true ones, rounded once", "", float, double) {
    using T = TestType;
    std::uint64_t hits = 0, lines = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
        test::draws d(test::sample_seed, 14, k);
        const auto whole = [&](int n) { return static_cast<T>(d.below(2 * n + 1)) - static_cast<T>(n); };
        const vec3<T> u{whole(3), whole(3), whole(3)}, v{whole(3), whole(3), whole(3)};
        const T unit = k % 3 == 0 ? std::ldexp(T(1), k % 2 == 0 ? 40 : -60) : T(1);  // of some of the points
        const auto point = [&](int n, T scale) { return scale * (whole(n) * u + whole(n) * v); };
        test::point_list<T> p;
        for (std::uint64_t n = 1 + d.below(7); n > 0; --n) p.push_back(point(2, n % 2 == 0 ? unit : T(1)));
        const ray<T> r{point(3, T(1)), point(2, unit)};
        const segment<T> s{r.origin, d.below(2) == 0 ? point(3, T(1)) : p[0]};
        bool hit = false;
        const char* wrong = wrong_with_time(r, p, r.origin, hit);
        hits += hit;
        if (wrong == nullptr) wrong = wrong_with_ray(r, p, hit);
        if (wrong == nullptr) wrong = wrong_with_time(s, p, s.a, hit);
        hits += hit;
        lines += 2;
        INFO(k);
        if (wrong != nullptr) FAIL_CHECK(wrong);
    }
    CHECK(hits * 5 > lines);
    CHECK(hits * 5 < lines * 4);
}

// Of many points in one plane with the line, the side is found by looking at each a few times, in whatever order they come.
TEST_CASE("rays and hulls: of many points in one plane") {
    for (const int n : {50, 2000, 20000}) {
        for (int kind = 0; kind < 6; ++kind) {
            test::draws d(test::sample_seed, 15, static_cast<std::uint64_t>(6 * n + kind));
            test::point_list<double> p;
            for (int i = 0; i < n; ++i) {
                const double angle = 6.283185307179586 * i / n, x = i - n / 2;
                const double far = std::ldexp(i % 2 == 0 ? 1.0 : -1.0, i * 400 / n);
                const vec3<double> all[6] = {{std::cos(angle), std::sin(angle), 0.25},
                                             {x * x, x, 0.25},
                                             {-x * x, 0.25, -x},
                                             {d.uniform(-1, 1), d.uniform(-1, 1), 0.25},
                                             {0.25, d.uniform(-1, 1) * std::cos(angle), std::sin(angle)},
                                             {far * far, far, 0.25}};
                p.push_back(all[kind]);
            }
            for (int order = 0; order < 3; ++order) {
                if (order == 1) std::reverse(p.begin(), p.end());
                if (order == 2) {
                    for (std::size_t i = p.size() - 1; i > 0; --i) std::swap(p[i], p[d.below(static_cast<int>(i + 1))]);
                }
                const vec3<double> to = 0.5 * p[0] + 0.5 * p[p.size() / 3];
                const vec3<double> way{kind == 4 ? 0.0 : 1.0, kind == 4 ? 1.0 : 0.0, kind == 2 ? 0.25 : kind == 4 ? 1.0 : 0.0};
                const ray<double> r{to - 0x1p40 * way, 0x1p40 * way};
                const hull<double> h = test::hull_over(p);
                detail::line_and_hull<detail::limbs_of_any<double>, true, double> both(h, r.origin, r.direction, {0, 0, 0});
                detail::hull_triangle at;
                REQUIRE(both.find(at) == verdict::yes);
                REQUIRE(both.is_flat());
                const auto looks = both.find_first(at);
                INFO(n << " points, kind " << kind << ", order " << order << ": " << static_cast<double>(looks) / n);
                CHECK(looks <= static_cast<std::uint64_t>((kind == 3 || kind == 4 ? 8 : 4) * n));
                const double time = detail::hit_time<filtered>(r, h);
                REQUIRE(time >= 0);
                if (kind == 5) continue;
                // No point is before the side.
                const vec3<double> a = p[at.corner[0]], b = p[at.corner[1]];
                bool is_first = true;
                for (const vec3<double>& q : p) {
                    is_first = is_first && detail::hit_time<filtered>(r, triangle<double>{a, b, q}) >= time;
                }
                CHECK(is_first);
            }
        }
    }
}
