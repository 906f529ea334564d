// SPDX-License-Identifier: MIT
#include <abut/predicate/revolution_hull.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/reach.hpp>

#include "support/catch.hpp"
#include "support/hulls.hpp"
#include "support/modes.hpp"
#include "support/revolution_oracle.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"
#include "support/stages.hpp"

namespace {

using namespace abut;

constexpr vec3<double> cube[8] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {0, 0, 2}, {2, 0, 2}, {0, 2, 2}, {2, 2, 2}};

// Constant expressions: inside, on a face, at a corner, beside an edge.
constexpr bool touches_cube(const cylinder<double>& s) { return intersects(hull<double>(cube, 8), s); }
static_assert(touches_cube({{{0.5, 1, 1}, {1.5, 1, 1}}, 0.25}) && touches_cube({{{-9, 1, 1}, {9, 1, 1}}, 5}));
static_assert(touches_cube({{{1, 1, 2}, {1, 1, 3}}, 5}) && !touches_cube({{{1, 1, 0x1.0000000000001p1}, {1, 1, 3}}, 5}));
static_assert(touches_cube({{{5, 6, 2}, {5, 6, 9}}, 5}) && !touches_cube({{{5, 6, 2}, {5, 6, 9}}, 0x1.3ffffffffffffp2}));
static_assert(touches_cube({{{1, -1, 3}, {5, -1, 3}}, 1.5}) && !touches_cube({{{1, -1, 3}, {5, -1, 3}}, 1.25}));
static_assert(intersects(cone<double>{{2, 2, 2}, {4, 4, 4}, 1}, hull<double>(cube, 8)) &&
              !intersects(cone<double>{{2, 2, 0x1.0000000000001p1}, {4, 4, 4}, 1}, hull<double>(cube, 8)));

static_assert(!resolve(cylinder<double>{{{9, 1, 0}, {9, 1, 2}}, 1}, hull<double>(cube, 8)));
// Inside of a tetrahedron no triangle of its tetrahedron_corners tells.
constexpr vec3<double> tetrahedron_corners[4] = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
static_assert(resolve(cylinder<double>{{{1, 1, 1}, {2, 1, 1}}, 0.25}, hull<double>(tetrahedron_corners, 4)));
static_assert(touches_cube({{{0.5, 1, 1}, {1.5, 1, 1}}, 0.25}) &&
              intersects(cone<double>{{1, 1, 1}, {2, 1, 1}, 0.25}, hull<double>(tetrahedron_corners, 4)));

/// The axis meets the hull, or some triangle of three points, which may be equal, meets the solid; in rationals.
template <class Solid, scalar T>
bool truth_with_hull(const Solid& s, const std::vector<vec3<T>>& points) {
    const segment<T> axis = detail::axis_of(s);
    if (test::oracle::hulls_intersect<T>({axis.a, axis.b}, points)) return true;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i; j < n; ++j) {
            for (std::size_t k = j == i ? i : j + 1; k < n; ++k) {
                if (j == i && k > i) break;
                if (test::oracle::meets(s, triangle<T>{points[i], points[j], points[k]})) return true;
            }
            if (test::oracle::meets(s, segment<T>{points[i], points[j]})) return true;
        }
    }
    return false;
}

template <class Solid>
void examine_hull_case(test::revolution_family f, std::uint64_t k, test::decision_tally& sum) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    const auto c = test::make_revolution_case<T>(test::sample_seed + 12, f, k, is_cone);
    const Solid s = test::solid_of<Solid>(c.axis, c.radius);
    const vec3<T>&p = c.corner[0], &q = c.corner[1], &r = c.corner[2];
    std::vector<vec3<T>> points{p, q, r, p + (q - r), q + (r - p), r + r - q};
    points.resize(1 + k % 6);
    const hull<T> h(points.data(), points.size());
    if (!is_valid(s) || !is_valid(h)) return;
    const bool truth = truth_with_hull(s, points);
    const verdict lie = to_verdict(!truth), by_filter = decide<filtered>(s, h);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += intersects<fast>(h, s) != truth;
    sum.wrong += truth && !(overlaps(bounds(s), bounds(h)) && reach_of(s)(bounds(h)) && reach_of(h)(bounds(s)));
    sum.wrong += by_filter == lie || decide<exact>(s, h) == lie || resolve(s, h) != truth || intersects(s, h) != truth ||
                 intersects<exact>(h, s) != truth;
}

template <class Solid>
void check_every_stage_with_hulls() {
    test::decision_tally all;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        const auto f = static_cast<test::revolution_family>(i);
        // Rationals of thousands of digits take long.
        const bool is_long = f == test::revolution_family::all_bit_patterns && sizeof(scalar_type_of<Solid>) == 8;
        const std::uint64_t count = test::sample_count() / (is_long ? 5000 : 100) + 1;
        const auto sum = test::in_threads<test::decision_tally>(
            count, [f](std::uint64_t first, std::uint64_t last, test::decision_tally& of) {
                for (std::uint64_t k = first; k < last; ++k) examine_hull_case<Solid>(f, k, of);
            });
        CAPTURE(test::name_of(f));
        CHECK(sum.wrong == 0);
        if (f == test::revolution_family::random) CHECK(sum.unlike * 20 <= sum.pairs);
        std::printf("%-16s | %6llu %6llu %6llu %6llu\n", test::name_of(f), static_cast<unsigned long long>(sum.pairs),
                    static_cast<unsigned long long>(sum.hits), static_cast<unsigned long long>(sum.open),
                    static_cast<unsigned long long>(sum.unlike));
        all += sum;
    }
    CHECK(test::is_share_above(0.1, all.hits, all.pairs));
    CHECK(test::is_share_above(0.1, all.pairs - all.hits, all.pairs));
}

}  // namespace

TEST_CASE("cylinders and hulls, float") { check_every_stage_with_hulls<cylinder<float>>(); }
TEST_CASE("cylinders and hulls, double") { check_every_stage_with_hulls<cylinder<double>>(); }
TEST_CASE("cones and hulls, float") { check_every_stage_with_hulls<cone<float>>(); }
TEST_CASE("cones and hulls, double") { check_every_stage_with_hulls<cone<double>>(); }

// Nearly a face: what the search leaves is asked of triangles.
TEST_CASE("cylinders and hulls, a step apart") {
    for (const double step : {-0x1p-52, 0.0, 0x1p-52}) {
        // The side beside an edge of the cube, turned by a Pythagorean angle, and an end over a corner.
        const double out = 2 + 2 * step;
        const cylinder<double> over{{{1, 1, out}, {1, 1, 9}}, 0.5},
            beside{{{-9, 6, 2 + 3 + 4 * step}, {9, 6, 2 + 3 + 4 * step}}, 5};
        const hull<double> h(cube, 8);
        CHECK(intersects(over, h) == (step <= 0));
        CHECK(intersects<exact>(h, over) == (step <= 0));
        CHECK(intersects(beside, h) == (step <= 0));
        CHECK(resolve(beside, h) == (step <= 0));
    }
}

// The squares of a way across an edge are below the smallest number.
TEST_CASE("cylinders and hulls, small ones") {
    const vec3<double> points[] = {{-0x1p-187, 0x1p-190, 0x1.4p-188}, {0x1p-187, 0x1p-189, 0x1.4p-188}};
    const hull<double> h(points, 2);
    const cylinder<double> s{{{0x1p-190, -0x1p-187, 0}, {-0x1p-190, 0x1p-187, 0}}, 0x1.6p-188};
    CHECK(decide<filtered>(s, h) != verdict::no);
    CHECK(decide<exact>(s, h) != verdict::no);
    CHECK(intersects(s, h));
}

// An axis that is read as another one where denormal numbers are read as 0.
TEST_CASE("cylinders and hulls, a short axis in each mode") {
    const vec3<float> point{-4e5f, 8e5f, 0};
    const cylinder<float> s{{{0, 0, 0}, {0x1p-126f, 0x1p-127f, 0}}, 1e6f};
    const hull<float> h(&point, 1);
    const auto touch = [&] { return intersects(s, h) && intersects<exact>(s, h) && resolve(s, h); };
    CHECK(test::modes_in_which(touch) == test::floating_modes().size());
}

// Points in a row beside a rim, a step away: without the tangent of the rim all triangles would be asked.
TEST_CASE("cylinders and hulls, a row of points beside a rim") {
    std::vector<vec3<double>> points;
    for (int i = 0; i < 128; ++i) {
        const double t = i - 63.5;
        points.push_back({3 + t, 4 + 3 * t, 1 - 3 * t});
    }
    const hull<double> h(points.data(), points.size());
    CHECK_FALSE(intersects(cylinder<double>{{{0, 0, 0}, {0, 0, 1}}, std::nextafter(5.0, 0.0)}, h));
    CHECK(intersects(cylinder<double>{{{0, 0, 0}, {0, 0, 1}}, 5}, h));
}

// With numbers of all exponents the search in double tells little, and integers are asked of edges and faces, each once: as of all
// triangles, one by one.
TEMPLATE_TEST_CASE("hulls and solids: of all exponents, as triangle by triangle", "", abut::cylinder<double>, abut::cone<double>) {
    using S = TestType;
    int touching = 0, near = 0, all = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 100; ++k) {
        test::draws d(test::sample_seed, 51, k);
        const int range = k % 4 == 0 ? 1000 : k % 4 == 1 ? 200 : k % 4 == 2 ? 40 : 5;
        const auto number = [&] {
            const double x = std::ldexp(d.uniform(1, 2), d.below(2 * range + 1) - range);
            return d.below(2) == 0 ? x : -x;
        };
        const auto point = [&] { return vec3<double>{number(), number(), number()}; };
        std::vector<vec3<double>> p;
        for (int n = 3 + d.below(4); n > 0; --n) p.push_back(point());
        S s{};
        if constexpr (requires { s.apex; }) {
            s = S{point(), point(), std::abs(number())};
        } else {
            s = S{{point(), point()}, std::abs(number())};
        }
        const hull<double> h(p.data(), p.size());
        const double distance = std::abs(number());
        bool touch = intersects(h, detail::axis_of(s)), is_near = false;
        for (std::size_t i = 0; i < p.size(); ++i) {
            for (std::size_t j = i + 1; j < p.size(); ++j) {
                for (std::size_t l = j + 1; l < p.size(); ++l) {
                    const triangle<double> t{p[i], p[j], p[l]};
                    touch = touch || intersects(s, t);
                    is_near = is_near || within(s, t, distance);
                }
            }
        }
        is_near = is_near || touch;
        INFO(k);
        CHECK(intersects(s, h) == touch);
        CHECK(resolve(s, h) == touch);
        CHECK(within(s, h, distance) == is_near);
        ++all;
        touching += touch;
        near += is_near;
    }
    CHECK(touching * 5 > all);
    CHECK(near > touching);
    CHECK(near < all);
}
