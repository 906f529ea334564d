// SPDX-License-Identifier: MIT
#include <abut/narrow/nearest_point.hpp>
#include <abut/shape/point_reach.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/volume.hpp>
#include <abut/traverse/ordered_walk.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"

// The oracle: the least squared distance from a point to the hull of up to three others, in rationals. It tries each set of
// corners as the support of the weights and keeps those whose weights are positive; it shares no formula with the library.

namespace {

using namespace abut;
using rational = boost::multiprecision::cpp_rational;
using real = boost::multiprecision::cpp_bin_float_100;

struct rational_point {
    rational x, y, z;
};

template <class T>
rational_point exact_way(const vec3<T>& from, const vec3<T>& to) {
    return {rational(to.x) - rational(from.x), rational(to.y) - rational(from.y), rational(to.z) - rational(from.z)};
}
rational inner(const rational_point& a, const rational_point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
rational_point minus(const rational_point& a, const rational_point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

template <class T>
rational squared_distance(const vec3<T>& p, const std::vector<vec3<T>>& corners) {
    std::vector<rational_point> w;
    for (const vec3<T>& c : corners) w.push_back(exact_way(p, c));
    rational least = inner(w[0], w[0]);
    const auto offer = [&](const rational& square) {
        if (square < least) least = square;
    };
    for (std::size_t i = 0; i < w.size(); ++i) {
        offer(inner(w[i], w[i]));
        for (std::size_t j = i + 1; j < w.size(); ++j) {
            const rational_point e = minus(w[j], w[i]);
            const rational ee = inner(e, e), along = -inner(w[i], e);
            if (along > 0 && along < ee) offer(inner(w[i], w[i]) - along * along / ee);
        }
    }
    if (w.size() == 3) {
        // Normal equations of |w0 + s e + t f|^2 by Cramer's rule.
        const rational_point e = minus(w[1], w[0]), f = minus(w[2], w[0]);
        const rational ee = inner(e, e), ef = inner(e, f), ff = inner(f, f), we = -inner(w[0], e), wf = -inner(w[0], f);
        const rational d = ee * ff - ef * ef;
        if (d > 0) {
            const rational s = we * ff - wf * ef, t = wf * ee - we * ef;
            if (s > 0 && t > 0 && s + t < d) offer(inner(w[0], w[0]) - (s * we + t * wf) / d);
        }
    }
    return least;
}

real root_of(const rational& x) { return sqrt(real(numerator(x)) / real(denominator(x))); }

/// In units of 2^-53 of the distance to the farthest corner: by how much the computed distance is off, and how far from the
/// shape the point lies, but for half a unit in the last place of each of its coordinates.
struct errors {
    double distance = 0, point = 0;
};

template <class T, class Shape>
void measure(const Shape& s, const std::vector<vec3<T>>& corners, const T radius, const vec3<T>& p, errors& worst) {
    const auto unit = detail::unit_for(bounds(s), p);
    const vec3<double> way = detail::way_to(s, p, unit);
    const double square = detail::plain_dot(way, way);

    // The way to the box is no longer, as computed, bit for bit; nor is that to a box around the box.
    const aabb<T> box = bounds(s);
    const aabb<T> around{box.lower - vec3<T>{T(0.25), 0, T(0.5)}, box.upper + vec3<T>{0, T(0.125), 0}};
    const vec3<double> to_box = detail::way_to(box, p, unit), to_around = detail::way_to(around, p, unit);
    CHECK(detail::plain_dot(to_box, to_box) <= square);
    CHECK(detail::plain_dot(to_around, to_around) <= detail::plain_dot(to_box, to_box));

    const vec3<T> q = nearest_point(s, p);
    CHECK(contains(box, bounds(q)));

    real far = 0;
    for (const vec3<T>& c : corners) {
        const rational_point w = exact_way(p, c);
        far = std::max<real>(far, root_of(inner(w, w)));
    }
    far += real(radius);
    if (far == 0) {
        CHECK(square == 0);
        return;
    }
    const real computed = sqrt(real(square)) * real(unit.length(1));
    const real exact = std::max<real>(0, root_of(squared_distance(p, corners)) - real(radius));
    const real steps = real(0x1p-53) * far;
    worst.distance = std::max(worst.distance, static_cast<double>(abs(computed - exact) / steps));

    const real off = std::max<real>(0, root_of(squared_distance(q, corners)) - real(radius));
    const vec3<double> size = detail::absolute(detail::widened(q));
    const real rounded = real(static_cast<double>(unit_roundoff<T>)) * real(size.x + size.y + size.z) +
                         real(std::numeric_limits<T>::denorm_min()) * 2;
    if (off > rounded) worst.point = std::max(worst.point, static_cast<double>((off - rounded) / steps));
}

template <class T>
struct family {
    const char* name;
    triangle<T> (*make)(test::draws&);
};

template <class T>
vec3<T> draw(test::draws& d, double half) {
    return test::construction::round_to<T>(test::construction::cube(d, half));
}

template <class T>
triangle<T> any_triangle(test::draws& d) {
    const vec3<T> a = draw<T>(d, 1), b = draw<T>(d, 1);
    return {a, b, draw<T>(d, 1)};
}
/// Two corners far apart; the third somewhere between, and off the line by 2^0 ... 2^-60, as far as T has digits.
template <class T>
triangle<T> flat_triangle(test::draws& d) {
    using namespace test::construction;
    const point a = cube(d, 1), b = cube(d, 1), off = cube(d, std::ldexp(1.0, -d.below(61)));
    const point c = along(along(a, d.uniform(0, 1), {b.x - a.x, b.y - a.y, b.z - a.z}), 1, off);
    return {round_to<T>(a), round_to<T>(b), round_to<T>(c)};
}
/// Two corners that are 2^0 ... 2^-60 apart, and one far away.
template <class T>
triangle<T> thin_triangle(test::draws& d) {
    using namespace test::construction;
    const point a = cube(d, 1), b = along(a, 1, cube(d, std::ldexp(1.0, -d.below(61)))), c = cube(d, 1);
    return {round_to<T>(a), round_to<T>(b), round_to<T>(c)};
}
/// As thin and flat, around the origin, where coordinates have digits for the least angles.
template <class T>
triangle<T> flat_at_origin(test::draws& d) {
    const int e = d.below(100);
    const T h = static_cast<T>(std::ldexp(d.uniform(0.5, 1), -e));
    const T x = static_cast<T>(d.uniform(0, 1));
    return {{0, 0, 0}, {1, static_cast<T>(d.uniform(-1, 1)) * h, 0}, {x, h, static_cast<T>(d.uniform(-1, 1)) * h}};
}
template <class T>
triangle<T> degenerate(test::draws& d) {
    const vec3<T> a = draw<T>(d, 1), b = draw<T>(d, 1);
    const int kind = d.below(4);
    if (kind == 0) return {a, a, a};
    if (kind == 1) return {a, b, a};
    if (kind == 2) return {a, b, b};
    const vec3<T> c{T(0.5) * a.x + T(0.5) * b.x, T(0.5) * a.y + T(0.5) * b.y, T(0.5) * a.z + T(0.5) * b.z};
    return {a, c, b};
}
template <class T>
triangle<T> on_lattice(test::draws& d) {
    const auto corner = [&] {
        const T x = static_cast<T>(d.below(5)), y = static_cast<T>(d.below(5));
        return vec3<T>{x, y, static_cast<T>(d.below(5))};
    };
    const vec3<T> a = corner(), b = corner();
    return {a, b, corner()};
}
template <class T>
triangle<T> far_from_origin(test::draws& d) {
    const triangle<T> t = any_triangle<T>(d);
    const vec3<T> away{1000, -2000, 4000};
    return {t.a + away, t.b + away, t.c + away};
}
template <class T>
triangle<T> of_mixed_sizes(test::draws& d) {
    triangle<T> t = any_triangle<T>(d);
    for (vec3<T>* c : {&t.a, &t.b, &t.c}) {
        const T s = static_cast<T>(std::ldexp(1.0, d.below(61) - 30));
        *c = s * *c;
    }
    return t;
}

/// A point that is near some part of the triangle, on it as far as digits go, or anywhere.
template <class T>
vec3<T> point_near(const triangle<T>& t, test::draws& d) {
    using namespace test::construction;
    const point a = widened(t.a), b = widened(t.b), c = widened(t.c);
    double u = d.below(4) == 0 ? 0 : d.uniform(0, 1), v = d.below(4) == 0 ? 0 : d.uniform(0, 1 - u);
    if (d.below(8) == 0) u = 1, v = 0;
    const point on = along(along(a, u, {b.x - a.x, b.y - a.y, b.z - a.z}), v, {c.x - a.x, c.y - a.y, c.z - a.z});
    const int kind = d.below(5);
    if (kind == 0) return round_to<T>(on);
    if (kind == 4) {  // over the middle, from which all corners are seen in one plane
        const point ab{b.x - a.x, b.y - a.y, b.z - a.z}, ac{c.x - a.x, c.y - a.y, c.z - a.z};
        const point normal = cross_product(ab, ac), middle = along(along(a, 1.0 / 3, ab), 1.0 / 3, ac);
        const double height = std::ldexp(1.0, -d.below(40));
        return round_to<T>(length(normal) > 0 ? along(middle, height, unit(normal)) : middle);
    }
    if (kind == 1) return round_to<T>(along(on, std::ldexp(1.0, -d.below(50)), cube(d, 1)));
    if (kind == 2) return round_to<T>(along(on, 1, cube(d, 1)));
    return round_to<T>(along(on, 100, cube(d, 1)));
}

template <class T>
triangle<T> times(const triangle<T>& t, T s) {
    return {s * t.a, s * t.b, s * t.c};
}

/// Bounds for points near each other, by what is measured: what is left out is farther than what is kept.
template <class T>
void check_bounds_from_amid(const triangle<T>& t, const vec3<T>& p, test::draws& d) {
    const auto unit = detail::unit_for(merge(bounds(t), bounds(p)), p);
    const double square = detail::squared_distance(p, t, unit), size = std::sqrt(square) + 1e-30;
    const triangle<T> other = d.below(2) == 0 ? triangle<T>{t.b, t.a, t.c} : any_triangle<T>(d);
    for (const double spread : {0.0, 1e-3, 0.1, 1.0}) {
        // Points of the group: p, and one on the other side of its middle c.
        const double far = spread * unit.length(size);
        const vec3<T> q = test::construction::round_to<T>(
            test::construction::along(detail::widened(p), far, test::construction::cube(d, 1)));
        const aabb<T> box = merge(bounds(p), bounds(q));
        const vec3<T> c = T(0.5) * box.lower + T(0.5) * box.upper;
        const vec3<T> half = (1 + 8 * unit_roundoff<T>)*detail::greatest(box.upper - c, c - box.lower);
        const T far_squared = (1 + 16 * unit_roundoff<T>)*dot(half, half);
        using seen = detail::seen_corners_of<triangle<T>>;
        const detail::shape_from_amid<T, 3> shape(seen(t, c), far_squared, 7);
        const seen corners(other, c);
        const T other_size = detail::greatest(dot(corners.at[0], corners.at[0]), dot(corners.at[1], corners.at[1]),
                                              dot(corners.at[2], corners.at[2]));
        const detail::seen_corner<T> corner(corners.at[0], other_size, far_squared);
        const detail::group_reach<T> reach(box, other.a, {}, T(0x1p-44) * other_size);
        const bool may_be = shape.may_be_nearer(half, corner), box_may_be = reach(bounds(t));
        for (const vec3<T>& x : {p, q}) {
            const vec3<T> from_c = x - c;
            const double of_x = unit.length(unit.length(detail::squared_distance(x, t, unit)));
            const double of_other = unit.length(unit.length(detail::squared_distance(x, other, unit)));
            const double own = detail::plain_dot(detail::widened(from_c), detail::widened(from_c));
            CAPTURE(spread, c.x, c.y, c.z, of_x, of_other);
            CHECK(double(shape.least_from(T(-2) * from_c)) + own <= of_x);
            CHECK(double(shape.most_from(T(-2) * from_c)) + own >= of_x);
            if (!may_be) CHECK(of_other < of_x);
            if (!box_may_be) CHECK(of_other < of_x);
            // A limit from one shape never leaves out another that is nearer.
            const double limit = double(corner.at_most - dot(from_c + from_c, corner.at)) + own;
            CHECK(limit >= of_other);
        }
    }
}

template <class T>
void check_triangles() {
    const family<T> families[] = {{"any", any_triangle<T>},       {"flat", flat_triangle<T>},
                                  {"thin", thin_triangle<T>},     {"flat at origin", flat_at_origin<T>},
                                  {"degenerate", degenerate<T>},  {"lattice", on_lattice<T>},
                                  {"offset", far_from_origin<T>}, {"mixed", of_mixed_sizes<T>}};
    std::uint64_t stream = 0;
    for (const family<T>& f : families) {
        errors worst;
        for (std::uint64_t i = 0; i < 1500; ++i) {
            test::draws d(20260301, stream, i);
            const triangle<T> t = f.make(d);
            const vec3<T> p = point_near(t, d);
            CAPTURE(f.name, i, p.x, p.y, p.z);
            measure(t, {t.a, t.b, t.c}, T(0), p, worst);

            const auto unit = detail::unit_for(bounds(t), p);
            const vec3<double> way = detail::way_to(t, p, unit);
            // Bounds hold for what is computed, and no volume around the triangle is out of a reach that shrank to it.
            const double square = detail::plain_dot(way, way);
            const detail::distance_bounds<T> bounds_of(t, p);
            CHECK_FALSE(bounds_of.are_beyond(detail::square_from(unit, square)));
            check_bounds_from_amid(t, p, d);
            auto ball = detail::world_frame<T>{unit.length(1)}.ball_around(p);
            ball.shrink_to(square);
            CHECK(ball.keeps(ball.least_in(bounds(t))));
            CHECK(ball.keeps(ball.least_in(around<obb<T>>(t))));
        }
        std::printf("%-15s %-6s distance %.2f, point %.2f\n", f.name, sizeof(T) == 4 ? "float" : "double", worst.distance,
                    worst.point);
        CHECK(worst.distance < 4);
        CHECK(worst.point < 4);
        ++stream;
    }
}

}  // namespace

TEMPLATE_TEST_CASE("nearest_point: triangles, needles and degenerate ones too, against rationals", "", float, double) {
    check_triangles<TestType>();
}

/// Bounds that are 0 or infinite would pass all else.
TEMPLATE_TEST_CASE("nearest_point: from far away bounds of distances are close, and boxes along a slope tell more", "",
                   float, double) {
    using T = TestType;
    for (std::uint64_t i = 0; i < 200; ++i) {
        test::draws d(11, 1, i);
        // A triangle of size 1 on the slope x + z = 0, and a point 100 above the middle of it.
        const T y = static_cast<T>(d.uniform(0, 1)), h = static_cast<T>(100 / std::sqrt(2.0));
        const triangle<T> t{{0, 0, 0}, {1, y, -1}, {0, 1, 0}};
        const vec3<T> middle{T(1) / 3, (y + 1) / 3, -T(1) / 3}, p{middle.x + h, middle.y, middle.z + h};
        const detail::length_unit<T> unit{};
        const double square = detail::squared_distance(p, t, unit);
        CHECK(square == Approx(10000).epsilon(1e-5));
        const detail::distance_bounds<T> around_it(t, p);
        // As seen from 1 beside it, and together with a point 2 away.
        const vec3<T> c{p.x, p.y + 1, p.z};
        const detail::shape_from_amid<T, 3> seen(detail::seen_corners_of<triangle<T>>(t, c), T(1), 7);
        CHECK(double(seen.least_from({0, 2, 0})) + 1 > 0.9997 * square);
        CHECK(double(seen.most_from({0, 2, 0})) + 1 < 1.0002 * square);
        const detail::seen_corner<T> nearer(vec3<T>{0, -1, 0} - T(0.69) * vec3<T>{h, 0, h}, T(10000), T(1));
        CHECK_FALSE(seen.may_be_nearer({0, 1, 0}, nearer));
        const aabb<T> two{{p.x, p.y, p.z}, {p.x, p.y + 2, p.z}};
        const detail::group_reach<T> reach(two, p - T(0.69) * vec3<T>{h, 0, h}, {}, T(0));
        CHECK_FALSE(reach(bounds(t)));
        CHECK_FALSE(detail::group_reach<T>(two, p - T(0.69) * vec3<T>{h, 0, h}, {1, T(1), 1}, T(0))(bounds(t)));
        CHECK(detail::group_reach<T>(two, p - T(0.69) * vec3<T>{h, 0, h}, {1, T(60), 1}, T(0))(bounds(t)));
        CHECK(around_it.are_beyond(T(0.999 * square)));
        auto ball = detail::world_frame<T>{}.ball_around(p);
        CHECK(double(ball.least_in(around<obb<T>>(t))) > 0.9999 * square);
        CHECK(double(ball.least_in(bounds(t))) < 0.99 * square);
        ball.shrink_to(0.999 * square);
        CHECK_FALSE(ball.keeps(ball.least_in(around<obb<T>>(t))));
    }
}

TEMPLATE_TEST_CASE("nearest_point: scale by powers of two changes no digit, to the ends of the range", "", float, double) {
    using T = TestType;
    const int most = std::numeric_limits<T>::max_exponent - 8, least = std::numeric_limits<T>::min_exponent + 40;
    for (std::uint64_t i = 0; i < 500; ++i) {
        test::draws d(7, 1, i);
        const triangle<T> t = any_triangle<T>(d);
        const vec3<T> p = draw<T>(d, 2), q = nearest_point(t, p);
        for (const int e : {most, least, most / 4, most / 4 + 2, most / 4 + 3, 40, -40}) {
            const T s = std::ldexp(T(1), e);
            const triangle<T> u = times(t, s);
            const vec3<T> far = nearest_point(u, s * p);
            const auto unit = detail::unit_for(bounds(u), s * p);
            const double square = detail::squared_distance(s * p, u, unit);
            CHECK_FALSE(detail::distance_bounds<T>(u, s * p).are_beyond(detail::square_from(unit, square)));
            const vec3<T> c = T(0.5) * (s * p), from_c = s * p - c;
            const detail::shape_from_amid<T, 3> seen(detail::seen_corners_of<triangle<T>>(u, c), dot(c, c), 7);
            const T own = dot(from_c, from_c), at_most = seen.most_from(T(-2) * from_c) + own;
            CHECK_FALSE(seen.least_from(T(-2) * from_c) > at_most - own);
            CHECK_FALSE(unit.length(unit.length(square)) > double(at_most));
            auto ball = detail::world_frame<T>{unit.length(1)}.ball_around(s * p);
            ball.shrink_to(square);
            CHECK(ball.keeps(ball.least_in(around<obb<T>>(u))));
            const vec3<T> off = detail::absolute(far - s * q);
            CAPTURE(i, e, far.x, far.y, far.z, s * q.x, s * q.y, s * q.z);
            CHECK(detail::greatest(off.x, off.y, off.z) <= std::numeric_limits<T>::denorm_min());  // 0, but for denormals
        }
    }
}

TEMPLATE_TEST_CASE("nearest_point: segments, points, spheres, capsules and boxes, against rationals", "", float, double) {
    using T = TestType;
    errors worst;
    for (std::uint64_t i = 0; i < 1500; ++i) {
        test::draws d(20260302, 9, i);
        const triangle<T> t = i % 3 == 0 ? on_lattice<T>(d) : i % 3 == 1 ? thin_triangle<T>(d) : of_mixed_sizes<T>(d);
        const vec3<T> p = point_near(t, d);
        const T r = d.below(4) == 0 ? T(0) : static_cast<T>(d.power_of_ten(-6, 2));
        measure(segment<T>{t.a, t.b}, {t.a, t.b}, T(0), p, worst);
        measure(segment<T>{t.b, t.a}, {t.b, t.a}, T(0), p, worst);
        measure(t.a, {t.a}, T(0), p, worst);
        measure(sphere<T>{t.a, r}, {t.a}, r, p, worst);
        measure(capsule<T>{{t.a, t.b}, r}, {t.a, t.b}, r, p, worst);
        // Beside it along an axis, where the ball reaches to its box.
        measure(sphere<T>{t.a, r}, {t.a}, r, vec3<T>{p.x, t.a.y, t.a.z}, worst);

        const aabb<T> box = bounds(segment<T>{t.a, t.b});
        const vec3<T> q = nearest_point(box, p);
        CHECK(q == detail::least(detail::greatest(p, box.lower), box.upper));
        // One point on the surface: it is the nearest one, and at no distance.
        if (r == 0) CHECK(nearest_point(sphere<T>{p, r}, p) == p);
        CHECK(nearest_point(segment<T>{t.a, t.a}, p) == t.a);
    }
    std::printf("other shapes   %-6s distance %.2f, point %.2f\n", sizeof(T) == 4 ? "float" : "double", worst.distance,
                worst.point);
    CHECK(worst.distance < 4);
    CHECK(worst.point < 4);
}

TEST_CASE("nearest_point: by hand") {
    using vec = vec3<float>;
    const triangle<float> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    CHECK(nearest_point(t, vec{1, 1, 5}) == vec{1, 1, 0});
    CHECK(nearest_point(t, vec{-1, -1, 5}) == vec{0, 0, 0});
    CHECK(nearest_point(t, vec{2, -3, 1}) == vec{2, 0, 0});
    CHECK(nearest_point(t, vec{9, 9, 1}) == vec{2, 2, 0});
    CHECK(nearest_point(segment<float>{{0, 0, 0}, {4, 0, 0}}, vec{1, 2, 0}) == vec{1, 0, 0});
    CHECK(nearest_point(sphere<float>{{0, 0, 0}, 2}, vec{5, 0, 0}) == vec{2, 0, 0});
    CHECK(nearest_point(sphere<float>{{0, 0, 0}, 2}, vec{1, 0, 1}) == vec{1, 0, 1});
    CHECK(nearest_point(capsule<float>{{{0, 0, 0}, {4, 0, 0}}, 1}, vec{2, 3, 0}) == vec{2, 1, 0});
    // A way that is longer than the largest number.
    constexpr double most = std::numeric_limits<double>::max();
    const auto far = nearest_point(segment<double>{{most / 2, -most, 0}, {most, most, 0}}, vec3<double>{-most, 0, 0});
    CHECK(far.x / most == Approx(11.0 / 17));
    CHECK(far.y / most == Approx(-7.0 / 17));
    static_assert(approachable<triangle<float>> && approachable<capsule<double>> && !approachable<plane<float>>);
}

TEST_CASE("nearest_point: small triangles where lengths have a large unit") {
    // Products of four lengths underflow long before squares do.
    const detail::length_unit<double> own(1), large(0x1p400);
    double worst = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        test::draws d(13, 1, i);
        const triangle<double> t = any_triangle<double>(d);
        const vec3<double> p = draw<double>(d, 2);
        const double square = own.length(own.length(detail::squared_distance(p, t, own)));
        for (const int e : {-90, -105, -106, -107, -108, -109, -110, -117, -127, -200, -320}) {
            const double s = std::ldexp(1.0, e);
            const double small = detail::squared_distance(s * p, times(t, s), large);
            const double back = std::ldexp(large.length(large.length(small)), -2 * e);
            if (square > 1e-6) worst = std::max(worst, std::abs(back - square) / square);
        }
    }
    CAPTURE(worst);
    CHECK(worst < 1e-9);
}
