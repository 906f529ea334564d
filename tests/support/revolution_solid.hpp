// SPDX-License-Identifier: MIT
#pragma once

// Cylinders and cones in numbers of 300 bits, and pairs that are hard to measure.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "contact_oracles.hpp"
#include "draws.hpp"
#include "revolution_pairs.hpp"
#include "samples.hpp"

namespace abut::test {

struct wide_solid {
    wide_point first, last, d;
    wide radius, dd;
    bool is_cone;

    /// The farthest point along n, which is not 0.
    [[nodiscard]] wide_point farthest(const wide_point& n) const {
        if (dd == 0) return first + (radius / length_of(n)) * n;
        const wide along = dot(n, d);
        const wide_point across = n - (along / dd) * d;
        const wide size = length_of(across);
        const auto on_rim = [&](const wide_point& center) {
            // What rounding leaves across is not orthogonal to the axis.
            return size > ldexp(length_of(n), -200) ? center + (radius / size) * across : center;
        };
        if (!is_cone) return on_rim(along > 0 ? last : first);
        const wide_point rim = on_rim(last);
        return dot(n, rim) > dot(n, first) ? rim : first;
    }
    /// How far a point is from the farthest of the solid.
    [[nodiscard]] wide farthest_from(const wide_point& x) const {
        const auto from_rim = [&](const wide_point& center, const wide& r) -> wide {
            const wide_point w = x - center;
            if (dd == 0) return length_of(w) + r;
            const wide s = dot(w, d), square = dot(w, w) - s * s / dd;
            const wide rho = square > 0 ? wide(sqrt(square)) : wide(0);
            return sqrt(wide((rho + r) * (rho + r) + s * s / dd));
        };
        return std::max<wide>(from_rim(first, is_cone && dd != 0 ? wide(0) : radius), from_rim(last, radius));
    }
};
template <scalar T>
wide_solid solid_in_bits(const vec3<T>& first, const vec3<T>& last, T radius, bool is_cone) {
    const wide_point d = widest(last) - widest(first);
    return {widest(first), widest(last), d, wide(radius), dot(d, d), is_cone};
}
template <scalar T>
wide_solid in_bits(const cylinder<T>& s) {
    return solid_in_bits(s.axis.a, s.axis.b, s.radius, false);
}
template <scalar T>
wide_solid in_bits(const cone<T>& s) {
    return solid_in_bits(s.apex, s.base_center, s.radius, true);
}

/// Of a point from the solid: from the sides of a rectangle or a triangle, if it is not inside.
inline wide distance_from_solid(const wide_point& x, const wide_solid& s) {
    if (s.dd == 0) return std::max<wide>(length_of(x - s.first) - s.radius, 0);
    const wide h = sqrt(s.dd), height = dot(x - s.first, s.d) / h;
    const wide_point across = x - s.first - (height / h) * s.d;
    const wide rho = length_of(across);
    const wide here = s.is_cone ? wide(s.radius * height / h) : s.radius;
    if (height >= 0 && height <= h && rho <= here) return 0;
    const auto from_side = [&](const wide& a, const wide& b, const wide& c, const wide& d) -> wide {
        const wide square = (c - a) * (c - a) + (d - b) * (d - b);
        wide t = square == 0 ? wide(0) : wide(((height - a) * (c - a) + (rho - b) * (d - b)) / square);
        t = t < 0 ? wide(0) : t > 1 ? wide(1) : t;
        const wide p = height - a - t * (c - a), q = rho - b - t * (d - b);
        return sqrt(wide(p * p + q * q));
    };
    const wide base = from_side(h, 0, h, s.radius);
    if (s.is_cone) return std::min(base, from_side(0, 0, h, s.radius));
    return std::min({base, from_side(0, 0, 0, s.radius), from_side(0, s.radius, h, s.radius)});
}

// --- edges along what a solid has
// ------------------------------------------------------------------------------------------

/// A solid, and an edge that is parallel to a line on it but for an angle down to 2^-60: to its axis, its side, an end, or
/// the tangent of a rim; at a distance down to 2^-50, from a solid that may be as thin or flat.
template <class Solid>
revolution_case<scalar_type_of<Solid>> nearly_parallel(std::uint64_t i) {
    using namespace construction;
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    draws d(20261126, is_cone ? 78 : 77, i);
    const auto small = [&](int most) { return std::ldexp(d.uniform(0.5, 1), -d.below(most)); };
    const point axis = unit(cube(d, 1)), out = unit(cross_product(axis, cube(d, 1))), round = cross_product(axis, out);
    const point first = cube(d, d.below(2) == 0 ? 0 : 1);
    const double height = d.below(3) == 0 ? small(40) : d.uniform(0.5, 2), radius = d.below(3) == 0 ? small(50) : small(2);
    const int kind = d.below(4);
    const double t = kind == 3 ? (d.below(2) == 0 && !is_cone ? 0 : 1) : kind == 2 ? 1 : d.uniform(-0.1, 1.1);
    const double here = is_cone ? t * radius : radius;
    const point side = is_cone ? along(unit(along({0, 0, 0}, height, axis)), radius / height, out) : axis;
    point on = along(along(first, t * height, axis), kind == 2 ? d.uniform(0, 1) * here : here, out);
    const point way = kind == 0 ? axis : kind == 1 ? side : kind == 2 ? cross_product(axis, cube(d, 1)) : round;
    const point normal = kind == 2 ? axis
                         : is_cone ? along(along({0, 0, 0}, 1, out), -radius / height, axis)
                                   : along(out, kind == 3 ? d.uniform(0, 1) : 0, axis);
    on = along(on, small(51), unit(normal));
    const double angle = small(61), shift = d.uniform(-1, 1), length = d.below(3) == 0 ? small(40) : 1;
    revolution_case<T> c{};
    c.axis = {round_to<T>(first), round_to<T>(along(first, height, axis))};
    c.radius = rounded_to<T>(radius);
    const point direction = along(unit(way), angle, cube(d, 1));
    c.corner[0] = round_to<T>(along(on, length * shift, direction));
    c.corner[1] = round_to<T>(along(on, length * (shift + 1), direction));
    c.corner[2] = round_to<T>(along(along(on, d.uniform(-1, 1), direction), small(51), along(normal, 1, cube(d, 1))));
    return c;
}

/// A triangle as thin as 2^-50, and a solid over a place inside of it, or through it: with an end or a rim over it, the
/// side, or the axis through it, at an angle down to 2^-50.
template <class Solid>
revolution_case<scalar_type_of<Solid>> over_needle(std::uint64_t i) {
    using namespace construction;
    using T = scalar_type_of<Solid>;
    draws d(20261126, std::same_as<Solid, cone<T>> ? 80 : 79, i);
    const auto small = [&](int most) { return std::ldexp(d.uniform(0.5, 1), -d.below(most)); };
    const point none{0, 0, 0}, a = cube(d, d.below(2) == 0 ? 0 : 1), e = unit(cube(d, 1)),
                               across = unit(cross_product(e, cube(d, 1))), normal = cross_product(e, across);
    const double width = small(51), u = d.uniform(0, 1);
    const point c = along(along(a, d.uniform(-0.2, 1.2), e), width, across);
    point at = along(along(a, u, e), d.uniform(0, 1 - u), along(c, -1, a));
    const double height = d.below(3) == 0 ? small(40) : d.uniform(0.5, 2), radius = d.below(3) == 0 ? small(50) : small(2);
    const int kind = d.below(4);
    const point flat = unit(along(along(none, d.uniform(-1, 1), e), d.uniform(-1, 1), across));
    point axis = kind == 0 ? along(normal, d.below(2) == 0 ? small(50) : 1, cube(d, 1)) : kind == 1 ? cube(d, 1) : flat;
    axis = unit(along(axis, small(50), kind > 1 ? normal : cube(d, 1)));
    const double gap = d.below(8) == 0 ? 0 : small(51) * (d.below(3) == 0 ? -1 : 1);
    at = along(at, gap, normal);
    point first = at;
    if (kind == 1) first = along(at, -radius, unit(cross_product(cross_product(axis, normal), axis)));
    if (kind == 2) first = along(along(at, radius, normal), -d.uniform(0, height), axis);
    if (kind == 3) first = along(at, -d.uniform(0, height), axis);
    point last = along(first, height, axis);
    if (d.below(2) == 0) std::swap(first, last);
    revolution_case<T> s{};
    s.axis = {round_to<T>(first), round_to<T>(last)};
    s.radius = rounded_to<T>(radius);
    s.corner[0] = round_to<T>(a);
    s.corner[1] = round_to<T>(along(a, 1, e));
    s.corner[2] = round_to<T>(c);
    return s;
}

/// A solid and a triangle: deep in each other, or hardly.
template <class Solid>
revolution_case<scalar_type_of<Solid>> through(std::uint64_t seed, std::uint64_t i) {
    using namespace construction;
    using T = scalar_type_of<Solid>;
    draws d(seed, std::same_as<Solid, cone<T>> ? 82 : 81, i);
    const point a = cube(d, 1), axis = unit(cube(d, 1));
    const double height = d.below(4) == 0 ? d.power_of_ten(-3, 0) : d.uniform(0.5, 2),
                 radius = d.below(4) == 0 ? d.power_of_ten(-3, 0) : d.uniform(0.2, 1), size = d.power_of_ten(-1, 1);
    const point at = along(along(a, d.uniform(-0.1, 1.1) * height, axis), 1.2 * radius, cube(d, 1));
    revolution_case<T> c{};
    c.axis = {round_to<T>(a), round_to<T>(along(a, height, axis))};
    c.radius = rounded_to<T>(radius);
    for (auto& p : c.corner) p = round_to<T>(along(at, size, cube(d, 1)));
    return c;
}

/// Calls f(name, k, case) for some of each family, and of thin, nearly parallel and deep ones.
template <class Solid, class F>
void each_revolution_case(std::uint64_t seed, std::uint64_t part, const F& f) {
    using T = scalar_type_of<Solid>;
    const auto call = [&](const char* name, std::uint64_t count, const auto& make) {
        for (std::uint64_t k = 0; k < count; ++k) f(std::string(name), k, make(k));
    };
    for (int i = 0; i < revolution_family_count; ++i) {
        const auto family = static_cast<revolution_family>(i);
        call(name_of(family), some_samples(part),
             [&](std::uint64_t k) { return make_revolution_case<T>(seed, family, k, std::same_as<Solid, cone<T>>); });
    }
    call("thin", some_samples(part), over_needle<Solid>);
    call("nearly parallel", some_samples(part), nearly_parallel<Solid>);
    call("through", some_samples(part / 5), [&](std::uint64_t k) { return through<Solid>(seed, k); });
}

/// Points around a middle that is beside a solid: of a ball, with one flat side or two, or anywhere.
template <scalar T>
std::vector<vec3<T>> points_beside(std::uint64_t seed, const revolution_case<T>& c, std::uint64_t k) {
    using namespace construction;
    draws d(seed, sizeof(T), k);
    const point middle = widened(c.corner[0]), other = widened(c.corner[1]);
    const double size = d.below(3) == 0 ? 1 : d.power_of_ten(-4, 0);
    const point normal = unit(cube(d, 1));
    const double level = d.uniform(0.2, 1);
    std::vector<vec3<T>> points;
    const int n = 1 + d.below(d.below(4) == 0 ? 40 : 12);
    for (int i = 0; i < n; ++i) {
        point p = d.below(4) == 0 ? cube(d, 1) : unit(cube(d, 1));
        const double high = product(p, normal);
        if (high > level) p = along(p, level - high, normal);
        points.push_back(round_to<T>(along(i == 0 && d.below(4) == 0 ? other : middle, size, p)));
    }
    return points;
}

}  // namespace abut::test
