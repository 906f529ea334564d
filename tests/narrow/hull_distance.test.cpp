// SPDX-License-Identifier: MIT
#include <abut/narrow/hull_distance.hpp>

#include <abut/narrow/distance.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/hull_pairs.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/sweep_oracle.hpp"

// The distance of convex hulls against the definition, in 300 bits: hulls that do not meet are nearest to each other at a
// feature of their differences, which is one of them, a line between two, or a triangle of three. All are tried.

namespace {

using namespace abut;
using test::wide;
using test::wide_point;

constexpr vec3<double> slab[8] = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {8, 8, 0}, {0, 0, 1}, {8, 0, 1}, {0, 8, 1}, {8, 8, 1}};
constexpr vec3<double> spike[4] = {{4, 4, 5}, {3, 3, 9}, {5, 3, 9}, {4, 9, 9}};
constexpr auto slab_and_spike = distance(hull<double>(slab, 8), hull<double>(spike, 4));
static_assert(slab_and_spike.distance == 4 && slab_and_spike.point_a == vec3<double>{4, 4, 1} &&
              slab_and_spike.point_b == vec3<double>{4, 4, 5});
static_assert(distance(sphere<double>{{-3, -4, 0.5}, 2}, hull<double>(slab, 8)).distance == 3);
static_assert(distance(hull<double>(slab, 8), vec3<double>{4, 4, 0.5}).distance == 0);

template <scalar T>
test::point_list<T> points_of_hull(const hull<T>& h) {
    return {h.points, h.points + h.count};
}
template <scalar T>
wide hull_rounding_of(const vec3<T>& p) {
    const wide_point q = test::widest(p);
    return wide(unit_roundoff<T>) * (abs(q.x) + abs(q.y) + abs(q.z)) + 4 * wide(test::construction::least_denormal<T>);
}

/// The nearest point of a hull to points on the other one, which may be inside. Errors in units of 2^-53 D.
template <scalar T>
const char* wrong_with_nearest(const hull<T>& h, const test::point_list<T>& points, double& worst) {
    for (const vec3<T>& p : points) {
        const auto unit = detail::unit_for(bounds(h), p);
        const vec3<double> way = detail::way_to(h, p, unit), to_box = detail::way_to(bounds(h), p, unit);
        const double square = detail::plain_dot(way, way);
        if (detail::plain_dot(to_box, to_box) > square) return "its box is farther than the hull";
        const vec3<T> q = nearest_point(h, p);
        if (!contains(bounds(h), bounds(q))) return "the nearest point is outside of the box";
        if (intersects<exact>(h, p)) {
            if (square != 0 || q != p) return "a point inside is not its own nearest one";
            continue;
        }
        const auto w = test::differences<T>({p}, points_of_hull(h));
        wide farthest = 0, size = test::length_of(test::widest(p));
        const wide gap = test::square_of_gap(w);
        std::vector<wide_point> others;
        for (const wide_point& to : w) {
            farthest = std::max(farthest, test::length_of(to));
            if (dot(to, to) != gap) others.push_back(to);
        }
        // A point of the hull, and not one between others.
        bool is_corner = others.empty() || (others.size() < w.size() && test::square_of_gap(others) > gap);
        const wide truth = sqrt(gap), steps = farthest * wide(0x1p-53);
        const wide found = test::length_of({wide(way.x), wide(way.y), wide(way.z)}) * wide(unit.length(1));
        worst = std::max(worst, static_cast<double>(abs(found - truth) / steps));
        const wide last = hull_rounding_of(q), off = test::distance_from(test::widest(q), h) - last;
        worst = std::max(worst, static_cast<double>(off / steps));
        // Nearer than that, as a step off a point is in some pairs, the integers leave it out (narrow/hull_distance.hpp).
        is_corner = is_corner && truth > (size + farthest) * wide(0x1p-118);
        if (is_corner && test::square_of_gap(test::differences<T>({q}, points_of_hull(h))) != 0) return "it is no corner";
    }
    return nullptr;
}

struct hull_distance_tally {
    std::uint64_t pairs = 0, touching = 0;
    double distance = 0, point = 0,
           nearest = 0;  ///< the worst ones, less the last rounding to T, in units of 2^-53 D (docs/numerics/distances.md)
};

template <scalar T>
const char* wrong_with_hulls(const separation<T>& found, const test::point_list<T>& a, const test::point_list<T>& b,
                             T radius_a, bool touch, hull_distance_tally& sum) {
    wide farthest = 0;
    for (const wide_point& way : test::differences(a, b)) farthest = std::max(farthest, test::length_of(way));
    const wide unit = (farthest + wide(radius_a)) * wide(0x1p-53) + wide(test::construction::least_denormal<T>);
    ++sum.pairs;
    sum.touching += touch;
    if (touch != (found.distance == 0)) return "it is 0 where they do not touch, or is not where they do";
    // How far the points are from their hulls.
    const auto off = [&](const vec3<T>& p, const test::point_list<T>& points, T radius) {
        // The differences of a hull that p is in have no nearest feature; then a corner of them is not behind.
        if (intersects(hull<T>(points.data(), points.size()), p)) return wide(0);
        const wide d = sqrt(test::square_of_gap(test::differences<T>({p}, points))) - wide(radius);
        return d > 0 ? d : wide(0);
    };
    const wide in_a = hull_rounding_of(found.point_a), in_b = hull_rounding_of(found.point_b);
    const wide off_points = std::max<wide>(off(found.point_a, a, radius_a) - in_a, off(found.point_b, b, T(0)) - in_b);
    sum.point = std::max(sum.point, static_cast<double>(off_points / unit));
    if (touch) return found.point_a == found.point_b ? nullptr : "what touches has two points";
    const wide truth = sqrt(test::square_of_gap(test::differences(a, b))) - wide(radius_a);
    const wide last = wide(unit_roundoff<T>) * wide(found.distance);
    const wide error = abs(wide(found.distance) - truth) - last,
               way = test::length_of(test::widest(found.point_b) - test::widest(found.point_a));
    sum.distance = std::max(sum.distance, static_cast<double>(error / unit));
    sum.point = std::max(sum.point, static_cast<double>((abs(way - truth) - in_a - in_b) / unit));
    return nullptr;
}

/// A plane and a hull, against the exact heights of its points. Errors in units of 2^-53 of the farthest point's distance
/// from the origin and the plane.
template <scalar T>
const char* wrong_with_plane(const plane<T>& s, const test::point_list<T>& points, hull_distance_tally& sum) {
    const hull<T> h = test::hull_over(points);
    const separation<T> found = distance(s, h), other = distance(h, s);
    const bool touch = intersects<exact>(s, h);
    ++sum.pairs;
    sum.touching += touch;
    if (!(found == separation<T>{0, 0, other.point_b, other.point_a, other.distance}))
        return "the other order has another answer";
    if (touch != (found.distance == 0)) return "it is 0 where they do not touch, or is not where they do";
    const wide_point n = test::widest(s.normal);
    const auto height = [&](const vec3<T>& p) -> wide {
        return abs(dot(n, test::widest(p)) - wide(s.offset)) / test::length_of(n);
    };
    wide least = height(points[0]), far = 0;
    bool is_point = false;
    for (const vec3<T>& p : points) {
        least = std::min(least, height(p));
        far = std::max(far, test::length_of(test::widest(p)));
        is_point = is_point || p == found.point_b;
    }
    const wide unit = (far + least) * wide(0x1p-53) + wide(test::construction::least_denormal<T>);
    const wide off = height(found.point_a) - hull_rounding_of(found.point_a);
    sum.point = std::max(sum.point, static_cast<double>(off / unit));
    if (touch) return found.point_a == found.point_b ? nullptr : "what touches has two points";
    if (!is_point) return "the point of the hull is none of its points";
    const wide error = abs(wide(found.distance) - least) - wide(unit_roundoff<T>) * wide(found.distance);
    sum.distance = std::max(sum.distance, static_cast<double>(error / unit));
    sum.nearest = std::max(sum.nearest, static_cast<double>((height(found.point_b) - least) / unit));
    return nullptr;
}

constexpr test::hull_family hull_families[] = {
    test::hull_family::general, test::hull_family::far_away, test::hull_family::lattice,  test::hull_family::flat,
    test::hull_family::line,    test::hull_family::touching, test::hull_family::step_off, test::hull_family::exponents};

}  // namespace

TEMPLATE_TEST_CASE("distance of hulls: as by definition, in every family", "", float, double) {
    using T = TestType;
    std::printf("distances of hulls, seed %llu: errors in units of 2^-53 D\n",
                static_cast<unsigned long long>(test::sample_seed));
    for (const test::hull_family f : hull_families) {
        hull_distance_tally sum;
        for (std::uint64_t k = 0; k < test::sample_count() / 80 / (f == test::hull_family::exponents ? 4 : 1); ++k) {
            auto both = test::make_hull_pair<T>(test::sample_seed + 3, f, k);
            if (both.a.size() > 5) both.a.resize(5);
            if (both.b.size() > 5) both.b.resize(5);
            const hull<T> a = test::hull_over(both.a), b = test::hull_over(both.b);
            INFO(test::name_of(f) << " " << k);
            const separation<T> found = distance(a, b), other = distance(b, a);
            const char* wrong = wrong_with_hulls(found, both.a, both.b, T(0), intersects<exact>(a, b), sum);
            if (wrong == nullptr) wrong = wrong_with_hulls(other, both.b, both.a, T(0), intersects<exact>(a, b), sum);
            if (wrong == nullptr) wrong = wrong_with_nearest(a, both.b, sum.nearest);
            // Shapes of one and two points, with a radius.
            const T radius = static_cast<T>(0.125);
            const sphere<T> ball{both.a[0], radius};
            if (wrong == nullptr)
                wrong = wrong_with_hulls(distance(ball, b), {both.a[0]}, both.b, radius, intersects<exact>(b, ball), sum);
            if (both.b.size() > 2 && wrong == nullptr) {
                const triangle<T> t{both.b[0], both.b[1], both.b[2]};
                const separation<T> to = distance(a, t), from = distance(t, a);
                wrong = wrong_with_hulls(to, both.a, {t.a, t.b, t.c}, T(0), intersects<exact>(a, t), sum);
                if (!(to == separation<T>{0, 0, from.point_b, from.point_a, from.distance}))
                    wrong = "the other order has another answer";
            }
            if (wrong != nullptr) FAIL_CHECK(wrong);
        }
        std::printf("  %s: %llu pairs, %llu touch, distance %.2f, points %.2f, nearest %.2f\n", test::name_of(f),
                    static_cast<unsigned long long>(sum.pairs), static_cast<unsigned long long>(sum.touching), sum.distance,
                    sum.point, sum.nearest);
        INFO(test::name_of(f));
        CHECK(sum.touching * 20 > sum.pairs);
        CHECK(sum.touching * 20 < sum.pairs * 19);
        CHECK(sum.nearest < 4);
        CHECK(sum.distance < 16);
        CHECK(sum.point < 16);
    }
}

// In doubles the normal of a needle is any, and so is the point that seems to be the nearest.
TEMPLATE_TEST_CASE("distance of hulls: needles and blades", "", float, double) {
    using T = TestType;
    test::uniform random(77);
    hull_distance_tally sum;
    constexpr int digits = std::same_as<T, float> ? 20 : 50;
    for (std::uint64_t k = 0; k < test::sample_count() / 10; ++k) {
        const auto needle = [&](const vec3<T>& at, std::size_t count) {
            test::point_list<T> points{at + random.point<T>(-1, 1), at + random.point<T>(-1, 1)};
            while (points.size() < count) {
                const T share = random.point<T>(0, 1).x,
                        thin = static_cast<T>(std::ldexp(1.0, -static_cast<int>(k % digits)));
                points.push_back(points[0] + share * (points[1] - points[0]) + thin * random.point<T>(-1, 1));
            }
            return points;
        };
        const auto a = needle({0, 0, 0}, 2 + k % 3), b = needle({T(1.5), T(0.5), 0}, 2 + k / 3 % 3);
        const hull<T> x = test::hull_over(a), y = test::hull_over(b);
        const char* wrong = wrong_with_hulls(distance(x, y), a, b, T(0), intersects<exact>(x, y), sum);
        INFO(k);
        if (wrong != nullptr) FAIL_CHECK(wrong);
    }
    std::printf("needles: %llu pairs, distance %.2f, points %.2f\n", static_cast<unsigned long long>(sum.pairs),
                sum.distance, sum.point);
    CHECK(sum.distance < 16);
    CHECK(sum.point < 16);
}

TEMPLATE_TEST_CASE("distance of hulls: the same as where it is known whether they touch", "", float, double) {
    using T = TestType;
    std::uint64_t near = 0, touching = 0;
    const auto compare = [&](const auto& s, const auto& t) {
        const bool touch = intersects<exact>(s, t);
        const auto asked = distance(s, t);
        CHECK(asked == detail::separation_of(s, t, touch));
        CHECK((asked.distance == 0) == touch);
        touching += touch;
        return asked;
    };
    for (const test::hull_family f : hull_families) {
        for (std::uint64_t k = 0; k < test::sample_count() / 20 / test::thinned_by(f); ++k) {
            const auto both = test::make_hull_pair<T>(test::sample_seed + 6, f, k);
            const hull<T> a = test::hull_over(both.a), b = test::hull_over(both.b);
            INFO(test::name_of(f) << " " << k);
            compare(a, b);
            // A ball that just touches, or just does not.
            const vec3<T> p = both.b[0];
            const auto apart = compare(a, p);
            if (apart.distance == 0 || !(apart.distance < largest_finite<T> / 4)) continue;
            const T step = apart.distance * unit_roundoff<T>;
            for (const T radius : {apart.distance - 4 * step, apart.distance, apart.distance + 4 * step}) {
                compare(a, sphere<T>{p, radius});
                compare(sphere<T>{p, radius}, a);
                ++near;
            }
        }
    }
    CHECK(near > 100);
    CHECK(touching > 100);
}

TEMPLATE_TEST_CASE("distance of hulls: eight points need not be a box's corners", "", float, double) {
    using T = TestType;
    // Boxes are measured in closed form, by the order of their corners. Here they are askew, from a little to no box at all.
    constexpr double bound = 0x1p-46 + 4 * static_cast<double>(unit_roundoff<T>);  // as plain_box.hpp has it
    std::uint64_t plain = 0, left = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 2; ++k) {
        test::draws d(test::sample_seed + 9, 1, k);
        // Every other one of points at random, often nearly in a plane.
        const bool is_box = k % 2 == 0;
        const double askew = is_box ? std::ldexp(1.0, -static_cast<int>(k % 24)) : 1, radius = d.uniform(0, 0.25),
                     flat = k % 4 == 1 ? std::ldexp(1.0, -static_cast<int>(k % 20)) : 1;
        const vec3<double> half = is_box ? vec3<double>{d.uniform(0.25, 1), d.uniform(0.25, 1), d.uniform(0.25, 1)} : vec3<double>{0, 0, 0};
        const auto around = [&](double size) {
            const double x = d.uniform(-size, size), y = d.uniform(-size, size);
            return vec3<double>{x, y, d.uniform(-size, size)};
        };
        vec3<T> corner[8];
        for (int i = 0; i < 8; ++i) {
            const vec3<double> off = around(askew);
            corner[i] = {static_cast<T>(off.x + ((i & 1) != 0 ? half.x : -half.x)), static_cast<T>(off.y + ((i & 2) != 0 ? half.y : -half.y)),
                         static_cast<T>(flat * off.z + ((i & 4) != 0 ? half.z : -half.z))};
        }
        const vec3<double> at = around(2.5);
        const sphere<T> ball{{static_cast<T>(at.x), static_cast<T>(at.y), static_cast<T>(at.z)}, static_cast<T>(radius)};
        const hull<T> h{corner, 8};
        const detail::plain_pair<hull<T>, sphere<T>> first(h, ball);
        if (first.touch() != verdict::no) {
            ++left;
            continue;
        }
        ++plain;
        INFO(k);
        std::vector<test::rational_point> seen;
        for (const vec3<T>& p : corner) seen.push_back(test::difference(test::to_rational(p), test::to_rational(ball.center)));
        const double truth = std::sqrt(test::least_square(seen).template convert_to<double>()) - static_cast<double>(ball.radius);
        const auto found = distance(h, ball);
        CHECK(std::fabs(static_cast<double>(found.distance) - truth) <= bound);
        const vec3<double> way = detail::widened(found.point_b) - detail::widened(found.point_a);
        CHECK(std::fabs(std::sqrt(dot(way, way)) - truth) <= 4 * bound);
    }
    CHECK(plain > 500);
    CHECK(left > 100);
}

// Differences of coordinates, and radii beside them, that are no doubles: distances and points are those of a small scene.
TEST_CASE("distance of hulls: near the largest number") {
    constexpr int up = 1023;
    constexpr double bound = 0x1p-45;
    const auto scaled = [](const vec3<double>& p, int e) {
        return vec3<double>{std::ldexp(p.x, e), std::ldexp(p.y, e), std::ldexp(p.z, e)};
    };
    std::uint64_t touching = 0, apart = 0;
    for (std::uint64_t k = 0; k < test::sample_count() / 4; ++k) {
        test::draws d(test::sample_seed + 10, 1, k);
        const auto somewhere = [&] {
            const double x = d.uniform(-1.9, 1.9), y = d.uniform(-1.9, 1.9);
            return vec3<double>{x, y, d.uniform(-1.9, 1.9)};
        };
        const std::size_t n = 1 + k % 6, m = 1 + k / 6 % 3;
        std::vector<vec3<double>> points, others, large, large_others;
        for (std::size_t i = 0; i < n; ++i) points.push_back(somewhere()), large.push_back(scaled(points.back(), up));
        for (std::size_t i = 0; i < m; ++i) others.push_back(somewhere()), large_others.push_back(scaled(others.back(), up));
        const double radius = k % 3 == 0 ? 0 : d.uniform(0, 1.9);
        const hull<double> h{points.data(), n}, far{large.data(), n};
        const auto look = [&](const auto& small, const auto& size) {
            const separation<double> truth = distance(h, small), found = distance(far, size);
            CAPTURE(k, n, m);
            CHECK(intersects<exact>(far, size) == (truth.distance == 0));
            ++(truth.distance == 0 ? touching : apart);
            if (truth.distance < 1.99) CHECK(std::fabs(std::ldexp(found.distance, -up) - truth.distance) <= bound);
            if (truth.distance > 2.01) CHECK(found.distance == infinity<double>);
            const auto reaches_out = [](const vec3<double>& p) { return detail::contact_math::magnitude_of(p) == largest_finite<double>; };
            if (reaches_out(found.point_a) || reaches_out(found.point_b)) return;  // a capsule may reach farther
            const vec3<double> a = scaled(found.point_a, -up), b = scaled(found.point_b, -up), way = b - a;
            CHECK(std::fabs(std::sqrt(dot(way, way)) - truth.distance) <= bound);
            CHECK(distance(a, h).distance <= bound);
            CHECK(distance(b, small).distance <= bound);
        };
        const hull<double> other{others.data(), m}, other_far{large_others.data(), m};
        look(other, other_far);
        look(sphere<double>{others[0], radius}, sphere<double>{large_others[0], std::ldexp(radius, up)});
        look(capsule<double>{{others[0], others[m - 1]}, radius},
             capsule<double>{{large_others[0], large_others[m - 1]}, std::ldexp(radius, up)});
    }
    CHECK(touching > test::sample_count() / 10);
    CHECK(apart > test::sample_count() / 10);
}

TEMPLATE_TEST_CASE("distance of hulls: a far corner hides no meeting", "", float, double) {
    using T = TestType;
    // What is near looks apart beside rounding of what is far.
    for (int k = 0; k < 100; ++k) {
        const T far = static_cast<T>(std::ldexp(1.0, k)), off = static_cast<T>(std::ldexp(1.0, -k));
        const vec3<T> a[4] = {{0, 0, 0}, {far, far, far}, {far, -far, far}, {far, 0, -far}},
                      b[4] = {{-1, -1, off}, {-1, 1, off}, {far, 0, off}, {-2, 0, -off}};
        for (int n = 1; n <= 4; ++n) {
            const hull<T> x(a, 4), y(b, static_cast<std::size_t>(n));
            INFO(k << " " << n);
            CHECK((distance(x, y).distance == 0) == intersects<exact>(x, y));
            CHECK((distance(y, x).distance == 0) == intersects<exact>(x, y));
        }
    }
}

TEMPLATE_TEST_CASE("nearest point of a hull: one that integers leave out is as far as the box", "", float, double) {
    using T = TestType;
    const T step = test::construction::least_denormal<T>;
    const vec3<T> corners[3] = {{4, 4, 0}, {9, 4, 0}, {4, 9, 0}};
    for (const std::size_t count : {1u, 2u, 3u}) {
        const hull<T> h(corners, count);
        const vec3<T> p{4, 4, -step};
        const auto unit = detail::unit_for(bounds(h), p);
        CHECK(detail::way_to(h, p, unit) == detail::way_to(bounds(h), p, unit));
        CHECK(nearest_point(h, p) == corners[0]);
    }
}

TEMPLATE_TEST_CASE("distance of hulls and planes: as by definition, in every family", "", float, double) {
    using T = TestType;
    std::printf("distances of hulls and planes, seed %llu: errors in units of 2^-53 D\n",
                static_cast<unsigned long long>(test::sample_seed));
    for (const test::hull_family f : hull_families) {
        hull_distance_tally sum;
        for (std::uint64_t k = 0; k < test::sample_count() / 20; ++k) {
            const auto both = test::make_hull_pair<T>(test::sample_seed + 5, f, k);
            // Through a point of the other hull, or that far along an axis.
            const vec3<T> at = both.b[0], from = both.b[both.b.size() / 2];
            plane<T> s{k % 2 == 0 ? at - from : vec3<T>{T(k % 3 == 0), T(k % 3 == 1), T(k % 3 == 2)}, T(0)};
            s.offset = dot(s.normal, at);
            if (!is_valid(s)) continue;
            INFO(test::name_of(f) << " " << k);
            if (test::length_of(test::widest(s.normal)) == 0) continue;
            if (const char* wrong = wrong_with_plane(s, both.a, sum)) FAIL_CHECK(wrong);
        }
        std::printf("  %s: %llu pairs, %llu touch, distance %.2f, point of the plane %.2f, of the hull %.2f\n",
                    test::name_of(f), static_cast<unsigned long long>(sum.pairs),
                    static_cast<unsigned long long>(sum.touching), sum.distance, sum.point, sum.nearest);
        INFO(test::name_of(f));
        CHECK(sum.pairs > sum.touching);
        CHECK(sum.touching > 0);
        CHECK(sum.distance < 16);
        CHECK(sum.point < 16);
        CHECK(sum.nearest < 16);
    }
}

// Small shapes far from the origin, where a coordinate's own rounding is all that a point may be off: it happens once, not for
// a point of the core and again for the radius. The bound is that of docs/numerics/distances.md, without a factor.
TEMPLATE_TEST_CASE("distance of round shapes: points are rounded once where coordinates are large", "", float, double) {
    using T = TestType;
    const wide u(unit_roundoff<T>);
    const T far = std::same_as<T, float> ? T(0x1p16) : T(0x1p28);
    std::uint64_t apart = 0;
    double worst = 0;
    const auto check = [&](const vec3<T>& q, const test::point_list<T>& core, T radius, const wide& farthest) {
        const wide gap = sqrt(test::square_of_gap(test::differences<T>({q}, core)));
        const wide off = abs(gap - wide(radius)), rounding = u * test::length_of(test::widest(q));
        worst = std::max(worst, static_cast<double>(off / rounding));
        CHECK(off <= 16 * wide(0x1p-53) * farthest + rounding);
    };
    for (std::uint64_t k = 0; k < test::sample_count(); ++k) {
        test::draws d(test::sample_seed, 31, k);
        const auto near = [&](double size) {
            const auto one = [&] { return static_cast<T>(static_cast<double>(far) + d.uniform(0, size)); };
            return vec3<T>{one(), one(), one()};
        };
        test::point_list<T> a;
        for (int n = 1 + d.below(4); n > 0; --n) a.push_back(near(4));
        const test::point_list<T> b{near(4), near(4)};
        const T radius = static_cast<T>(d.uniform(0.01, 1));
        const hull<T> h = test::hull_over(a);
        wide farthest = 0;
        for (const wide_point& way : test::differences(a, b)) farthest = std::max(farthest, test::length_of(way));
        farthest += wide(radius);
        const auto ask = [&](const auto& s, const test::point_list<T>& points, const auto& t, const test::point_list<T>& core) {
            const separation<T> found = distance(s, t);
            if (found.distance == 0) return;
            ++apart;
            if (points.size() < 4) check(found.point_a, points, T(0), farthest);
            check(found.point_b, core, radius, farthest);
        };
        const capsule<T> rod{{b[0], b[1]}, radius};
        const sphere<T> ball{b[0], radius};
        ask(h, a, rod, b);
        ask(h, a, ball, {b[0]});
        ask(a[0], {a[0]}, rod, b);
        if (a.size() > 2) ask(triangle<T>{a[0], a[1], a[2]}, {a[0], a[1], a[2]}, rod, b);
        if (a.size() > 2) ask(triangle<T>{a[0], a[1], a[2]}, {a[0], a[1], a[2]}, ball, {b[0]});
    }
    std::printf("round shapes far away: %llu apart, off by %.3f of a coordinate's rounding\n",
                static_cast<unsigned long long>(apart), worst);
    CHECK(apart > test::sample_count());
}
