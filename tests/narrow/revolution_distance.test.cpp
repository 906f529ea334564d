// SPDX-License-Identifier: MIT
#include <abut/narrow/distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/draws.hpp"
#include "support/revolution_pairs.hpp"
#include "support/revolution_solid.hpp"
#include "support/samples.hpp"

// The oracle: the least way between a cylinder or a cone and a hull, in 300 bits, by their farthest points along directions
// alone (Gilbert, Johnson and Keerthi). The nearest point of the simplex that was found so far is never too near, and what
// the farthest points say of its direction is never too far, so that the distance lies between the two whatever the search
// does. It shares no formula with the library, which has no directions but a face's normal.

namespace abut::test {

namespace {

constexpr std::uint64_t gap_seed = 20261126;

// --- the search -----------------------------------------------------------------------------------------------------------

struct wide_bounds {
    wide lower = 0, upper = 0;
};

/// The point nearest to the origin of the hull of up to four, of which those are left that it needs.
wide_point nearest_of(std::vector<wide_point>& w) {
    wide least = -1;
    wide_point nearest{};
    std::vector<wide_point> needed;
    const auto offer = [&](const wide_point& q, std::vector<wide_point> of) {
        const wide square = dot(q, q);
        if (least < 0 || square < least) least = square, nearest = q, needed = std::move(of);
    };
    for (std::size_t i = 0; i < w.size(); ++i) {
        offer(w[i], {w[i]});
        for (std::size_t j = i + 1; j < w.size(); ++j) {
            const wide_point e = w[j] - w[i];
            const wide ee = dot(e, e), s = -dot(e, w[i]);
            if (s > 0 && s < ee) offer(w[i] + (s / ee) * e, {w[i], w[j]});
            for (std::size_t k = j + 1; k < w.size(); ++k) {
                const wide_point f = w[k] - w[i];
                const wide ff = dot(f, f), ef = dot(e, f), t = -dot(f, w[i]), d = ee * ff - ef * ef;
                if (!(d > 0)) continue;
                const wide u = (s * ff - t * ef) / d, v = (t * ee - s * ef) / d;
                if (u > 0 && v > 0 && u + v < 1) offer(w[i] + u * e + v * f, {w[i], w[j], w[k]});
            }
        }
    }
    w = std::move(needed);
    return nearest;
}

wide_point farthest_corner(const std::vector<wide_point>& corners, const wide_point& n) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        if (dot(n, corners[i]) > dot(n, corners[best])) best = i;
    }
    return corners[best];
}

wide_bounds gap_between(const wide_solid& s, const std::vector<wide_point>& corners, const wide& size) {
    std::vector<wide_point> simplex{corners[0] - s.first};
    wide_bounds found{0, length_of(simplex[0])};
    for (int step = 0; step < 200; ++step) {
        const wide_point v = nearest_of(simplex), back{-v.x, -v.y, -v.z};
        const wide length = length_of(v);
        found.upper = std::min(found.upper, length);
        if (!(length > 0)) return found;
        const wide_point w = farthest_corner(corners, back) - s.farthest(v);
        found.lower = std::max<wide>(found.lower, dot(v, w) / length);
        if (found.upper - found.lower <= ldexp(size, -60)) return found;
        simplex.push_back(w);
    }
    return found;
}

/// What is known of two shapes that do not touch: bounds of their distance, and that of their farthest points.
struct wide_gap {
    wide_bounds distance;
    wide farthest;
};
template <class S, class U>
wide_gap exact_gap(const S& s, const U& t) {
    const wide_solid solid = in_bits(s);
    const wide_hull h = hull_of(t);
    wide far = 0;
    for (const wide_point& p : h.corners) far = std::max(far, solid.farthest_from(p));
    far += h.radius;
    const wide_bounds gap = gap_between(solid, h.corners, far);
    return {{gap.lower - h.radius, gap.upper - h.radius}, far};
}
template <class S, scalar T>
wide_gap exact_gap(const S& s, const plane<T>& p) {
    const wide_solid solid = in_bits(s);
    const wide_point n = widest(p.normal), back{-n.x, -n.y, -n.z};
    const wide high = dot(n, solid.farthest(n)) - wide(p.offset), low = dot(n, solid.farthest(back)) - wide(p.offset);
    const wide gap = std::max<wide>(low, -high) / length_of(n);
    return {{gap, gap}, solid.farthest_from({0, 0, 0}) + gap};
}

template <class S>
wide distance_from_shape(const wide_point& x, const S& s) {
    if constexpr (detail::solid_of_revolution<S>) {
        return distance_from_solid(x, in_bits(s));
    } else if constexpr (requires { s.normal; }) {
        return abs(dot(widest(s.normal), x) - wide(s.offset)) / length_of(widest(s.normal));
    } else {
        return distance_from(x, s);
    }
}

// --- what has to hold -----------------------------------------------------------------------------------------------------

/// Worst figures, in units of 2^-53 of the distance of the farthest points; of shared points as a share of contact_bound.
struct gap_tally {
    std::uint64_t pairs = 0, touching = 0, open = 0;
    double distance = 0, point = 0, shared = 0;

    gap_tally& operator+=(const gap_tally& t) {
        pairs += t.pairs, touching += t.touching, open += t.open;
        distance = std::max(distance, t.distance);
        point = std::max(point, t.point);
        shared = std::max(shared, t.shared);
        return *this;
    }
};

constexpr double most_steps = 16;

template <scalar T>
bool is_at_end(const vec3<T>& p) {
    return detail::contact_math::magnitude_of(p) == largest_finite<T>;
}

template <class S, class U>
const char* wrong_with_gap(const S& s, const U& t, gap_tally& tally) {
    using T = scalar_type_of<S>;
    const separation<T> found = distance(s, t), other = distance(t, s);
    ++tally.pairs;
    if (found.a != 0 || found.b != 0) return "ids are not 0";
    if (!(other == separation<T>{0, 0, found.point_b, found.point_a, found.distance})) return "the other order is unlike";
    if (intersects<exact>(s, t)) {
        ++tally.touching;
        if (found.distance != 0) return "what touches is apart";
        if (!(found.point_a == found.point_b)) return "what touches has two points";
        const wide_point x = widest(found.point_a);
        if (is_at_end(found.point_a)) return nullptr;  // it may lie where T has no number
        wide off = distance_from_shape(x, s);
        if constexpr (std::same_as<U, plane<T>>) {
            if (t.normal == vec3<T>{0, 0, 0}) return nullptr;
        }
        off = std::max(off, distance_from_shape(x, t));
        tally.shared = std::max(tally.shared, static_cast<double>(off / wide(contact_bound(s, t))));
        return off > wide(contact_bound(s, t)) ? "the shared point is off the shapes" : nullptr;
    }
    if (!(found.distance > 0)) return "what does not touch is at no distance";
    if constexpr (std::same_as<U, plane<T>>) {
        if (t.normal == vec3<T>{0, 0, 0}) return found.distance == infinity<T> ? nullptr : "a plane that is nothing is near";
    }
    const wide_gap gap = exact_gap(s, t);
    const wide step = wide(0x1p-53) * gap.farthest;
    tally.open += gap.distance.upper - gap.distance.lower > step / 4;
    // T may have no number for it, or none for what is off by less than is allowed.
    if (gap.distance.upper > wide(largest_finite<T>) + step) return nullptr;
    if (found.distance == infinity<T> && gap.distance.upper + most_steps * step > wide(largest_finite<T>)) return nullptr;
    const auto within = [&](const wide& off, const wide& allowed, double& worst) {
        if (off > allowed && step > 0) worst = std::max(worst, static_cast<double>((off - allowed) / step));
        return off <= allowed + most_steps * step;
    };
    const wide measured(found.distance);
    const wide rounded = wide(unit_roundoff<T>) * gap.distance.upper + wide(std::numeric_limits<T>::denorm_min());
    const auto off_bounds = [&](const wide& x) {
        return std::max<wide>({gap.distance.lower - x, x - gap.distance.upper, wide(0)});
    };
    if (!within(off_bounds(measured), rounded, tally.distance)) return "the distance is off";
    if (is_at_end(found.point_a) || is_at_end(found.point_b)) return nullptr;  // they may lie where T has no number
    const wide on_a = rounding_of(found.point_a), on_b = rounding_of(found.point_b);
    if (!within(distance_from_shape(widest(found.point_a), s), on_a, tally.point)) return "the first point is off";
    if (!within(distance_from_shape(widest(found.point_b), t), on_b, tally.point)) return "the second point is off";
    const wide between = length_of(widest(found.point_b) - widest(found.point_a));
    if (!within(off_bounds(between), on_a + on_b, tally.point)) return "the points are not so far apart";
    return nullptr;
}

template <class S, class U>
void check_gap(const std::string& name, std::uint64_t i, const S& s, const U& t, gap_tally& tally) {
    if (!is_valid(s) || !is_valid(t)) return;
    if (const char* const wrong = wrong_with_gap(s, t, tally)) {
        CAPTURE(name, i);
        FAIL_CHECK(wrong);
    }
}

void check_total(const char* name, const gap_tally& tally) {
    std::printf("distance, %s: %llu pairs, %llu touch, %llu open; off by %.2f, points by %.2f, shared ones %.2f\n", name,
                static_cast<unsigned long long>(tally.pairs), static_cast<unsigned long long>(tally.touching),
                static_cast<unsigned long long>(tally.open), tally.distance, tally.point, tally.shared);
    CHECK(tally.open * 50 <= tally.pairs);
}

}  // namespace

TEMPLATE_TEST_CASE("nearest_point: of cylinders and cones, in each family, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    double worst = 0, worst_point = 0;
    std::uint64_t inside = 0, points = 0;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        for (std::uint64_t k = 0; k < some_samples(50); ++k) {
            const auto c = make_revolution_case<T>(gap_seed + 1, f, k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            const vec3<T> p = c.corner[k % 3];
            if (!is_valid(s) || !is_valid(p)) continue;
            CAPTURE(name_of(f), k);
            const auto unit = detail::unit_for(bounds(s), p);
            const vec3<double> way = detail::way_to(s, p, unit);
            const double square = detail::plain_dot(way, way);
            // The way to the box is no longer, as computed, bit for bit; nor is that to a box around the box.
            const aabb<T> box = bounds(s), around = merge(box, aabb<T>{c.corner[0], c.corner[0]});
            const vec3<double> to_box = detail::way_to(box, p, unit), to_around = detail::way_to(around, p, unit);
            CHECK(detail::plain_dot(to_box, to_box) <= square);
            CHECK(detail::plain_dot(to_around, to_around) <= detail::plain_dot(to_box, to_box));
            const vec3<T> q = nearest_point(s, p);
            CHECK(contains(box, bounds(q)));
            const wide_solid solid = in_bits(s);
            const wide step = wide(0x1p-53) * solid.farthest_from(widest(p)), exact = distance_from_solid(widest(p), solid);
            if (!(step > 0)) continue;
            ++points;
            inside += exact == 0;
            const wide measured = wide(std::sqrt(square)) * wide(unit.length(1));
            worst = std::max(worst, static_cast<double>(abs(measured - exact) / step));
            if (!is_valid(q) || is_at_end(q)) continue;  // where T has no number
            const wide off = distance_from_solid(widest(q), solid) - rounding_of(q);
            if (off > 0) worst_point = std::max(worst_point, static_cast<double>(off / step));
        }
    }
    std::printf("nearest_point: %llu points, %llu inside; off by %.2f, points by %.2f\n",
                static_cast<unsigned long long>(points), static_cast<unsigned long long>(inside), worst, worst_point);
    CHECK(inside > points / 30);
    CHECK(worst < 8);
    CHECK(worst_point < 8);
}

TEST_CASE("distance: of cylinders and cones, by hand, and in constant expressions") {
    using vec = vec3<double>;
    constexpr cylinder<double> rod{{{0, 0, 0}, {0, 0, 2}}, 1};
    constexpr cone<double> tip{{0, 0, 4}, {0, 0, 0}, 3};
    static_assert(distance(rod, vec{3, 0, 1}) == separation<double>{0, 0, {1, 0, 1}, {3, 0, 1}, 2});
    static_assert(distance(vec{0, 0, 5}, rod) == separation<double>{0, 0, {0, 0, 5}, {0, 0, 2}, 3});
    static_assert(distance(rod, vec{4, 0, 6}).distance == 5);
    static_assert(distance(rod, segment<double>{{3, -5, 1}, {3, 5, 1}}).distance == 2);
    static_assert(distance(rod, triangle<double>{{-5, -5, 4}, {5, -5, 4}, {0, 9, 4}}) ==
                  separation<double>{0, 0, {0, 0, 2}, {0, 0, 4}, 2});
    static_assert(distance(rod, triangle<double>{{-5, -5, 1}, {5, -5, 1}, {0, 9, 1}}).distance == 0);
    static_assert(distance(aabb<double>{{4, -1, -1}, {5, 1, 1}}, rod).distance == 3);
    static_assert(distance(sphere<double>{{5, 0, 1}, 1}, rod).distance == 3);
    static_assert(distance(rod, plane<double>{{0, 0, 2}, 10}) == separation<double>{0, 0, {0, 0, 2}, {0, 0, 5}, 3});
    static_assert(distance(rod, plane<double>{{2, 0, 0}, 10}) == separation<double>{0, 0, {1, 0, 0}, {5, 0, 0}, 4});
    static_assert(distance(rod, plane<double>{{0, 0, 0}, 1}).distance == infinity<double>);
    static_assert(distance(tip, vec{0, 0, 6}) == separation<double>{0, 0, {0, 0, 4}, {0, 0, 6}, 2});
    static_assert(distance(tip, vec{0, 0, -2}).distance == 2);
    static_assert(distance(tip, plane<double>{{4, 0, 3}, 22}).distance == 2);
    CHECK(distance(tip, vec{4, 0, 3}).distance == Approx(2.6));
    // Without length they are balls, and with a radius of 0 segments.
    static_assert(distance(cylinder<double>{{{0, 0, 0}, {0, 0, 0}}, 1}, vec{0, 3, 4}).distance == 4);
    static_assert(distance(cone<double>{{0, 0, 0}, {0, 0, 0}, 1}, aabb<double>{{3, -1, -1}, {4, 1, 1}}).distance == 2);
    static_assert(distance(cone<double>{{0, 0, 0}, {0, 0, 2}, 0}, vec{3, 0, 1}).distance == 3);
    CHECK(nearest_point(rod, vec{4, 0, 1}) == vec{1, 0, 1});
    CHECK(nearest_point(rod, vec{0, 0.5, 1}) == vec{0, 0.5, 1});
    CHECK(nearest_point(tip, vec{0, 0, 7}) == vec{0, 0, 4});
    static_assert(approachable<cylinder<float>> && approachable<cone<double>>);
    static_assert(detail::measurable<triangle<float>, cone<float>> && detail::measurable<cylinder<double>, plane<double>>);
    static_assert(!detail::measurable<cylinder<float>, cylinder<float>> &&
                  !detail::measurable<cone<float>, capsule<float>> && !detail::measurable<cone<float>, vec3<double>>);
    // A disc that is as flat as numbers are, far below the other's size.
    constexpr double least = std::numeric_limits<double>::denorm_min();
    CHECK(distance(cylinder<double>{{{0, 0, 0}, {0, 0, least}}, 1}, vec{0, 0, 1}).distance == 1);
    CHECK(distance(cylinder<double>{{{0, 0, 0}, {0, 0, least}}, 1}, vec{3, 0, 0}).distance == 2);
    CHECK(distance(cone<double>{{0, 0, least}, {0, 0, 0}, 1}, vec{0.5, 0, 1}).distance == 1);
}

TEMPLATE_TEST_CASE("distance: cylinders and cones over thin triangles, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    gap_tally triangles;
    for (std::uint64_t k = 0; k < some_samples(10); ++k) {
        const auto c = over_needle<TestType>(k);
        const auto s = solid_of<TestType>(c.axis, c.radius);
        check_gap("over a needle", k, s,
                  triangle<scalar_type_of<TestType>>{c.corner[k % 3], c.corner[(k + 1) % 3], c.corner[(k + 2) % 3]},
                  triangles);
    }
    check_total("triangles, thin", triangles);
}

TEMPLATE_TEST_CASE("distance: of cylinders and cones, in each family, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    constexpr bool is_cone = std::same_as<TestType, cone<T>>;
    std::printf("distance: seed %llu\n", static_cast<unsigned long long>(gap_seed));
    std::array<gap_tally, kinds_beside.size()> tallies;
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto f = static_cast<revolution_family>(i);
        const std::string name = name_of(f);
        for (std::uint64_t k = 0; k < some_samples(250); ++k) {
            const auto c = make_revolution_case<T>(gap_seed, f, k, is_cone);
            const auto s = solid_of<TestType>(c.axis, c.radius);
            each_beside(c, k, is_cone, [&](std::size_t kind, const auto& t) { check_gap(name, k, s, t, tallies[kind]); });
        }
    }
    for (std::size_t kind = 0; kind < tallies.size(); ++kind) {
        const gap_tally& t = tallies[kind];
        check_total(kinds_beside[kind], t);
        CHECK(t.touching > t.pairs / 25);
        CHECK(t.touching < t.pairs * 19 / 20);
    }
}

TEMPLATE_TEST_CASE("distance: edges that are nearly parallel to a cylinder or a cone, against 300 bits", "", cylinder<float>,
                   cylinder<double>, cone<float>, cone<double>) {
    using T = scalar_type_of<TestType>;
    gap_tally segments, triangles, boxes;
    for (std::uint64_t k = 0; k < some_samples(20); ++k) {
        const auto c = nearly_parallel<TestType>(k);
        const auto s = solid_of<TestType>(c.axis, c.radius);
        check_gap("nearly parallel", k, s, segment<T>{c.corner[0], c.corner[1]}, segments);
        check_gap("nearly parallel", k, s, triangle<T>{c.corner[0], c.corner[1], c.corner[2]}, triangles);
        if (k % 4 == 0) check_gap("nearly parallel", k, s, bounds(segment<T>{c.corner[0], c.corner[1]}), boxes);
    }
    check_total("segments, nearly parallel", segments);
    check_total("triangles, nearly parallel", triangles);
    check_total("boxes, nearly parallel", boxes);
}

TEST_CASE("nearest_point: a cylinder that reaches to where the scalar has no number") {
    const cylinder<double> far{{{1.79e308, 1e307, 0}, {1.7901e308, 1.01e307, 0}}, 5e307};
    const auto p = nearest_point(far, vec3<double>{1.79e308, -1e308, 0});
    CHECK((p.x == largest_finite<double> && p.y < 1e307 && p.y > 8e306 && p.z == 0));
    const cylinder<float> far_too{{{3.4e38f, 1e37f, 0}, {3.4001e38f, 1.01e37f, 0}}, 5e37f};
    const auto q = nearest_point(far_too, vec3<float>{3.4e38f, -1e38f, 0});
    CHECK((q.x == largest_finite<float> && q.y < 1e37f && q.z == 0));
}

}  // namespace abut::test
