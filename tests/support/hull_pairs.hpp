// SPDX-License-Identifier: MIT
#pragma once

// Families of pairs of convex hulls, as lists of points: in general position, on small lattices, in one plane or on one
// line, touching in a corner, an edge or a face and one step off it, of mixed exponents, denormal, and of many points.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/shape/bounds.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"

namespace abut::test {

template <scalar T>
using point_list = std::vector<vec3<T>>;

template <scalar T>
struct hull_pair {
    point_list<T> a, b;
};

template <scalar T>
hull<T> hull_over(const point_list<T>& points) {
    return {points.data(), points.size()};
}

enum class hull_family { general, far_away, lattice, flat, line, touching, step_off, exponents, denormal, any_bits, many };
inline constexpr int hull_family_count = 11;

inline const char* name_of(hull_family f) {
    const char* const names[] = {"general",  "far away",        "lattice",  "flat",        "line",       "touching",
                                 "step off", "mixed exponents", "denormal", "any numbers", "many points"};
    return names[static_cast<int>(f)];
}

/// How many of the pairs of other families this one has: the oracle takes longer.
inline std::uint64_t thinned_by(hull_family f) {
    return f == hull_family::any_bits ? 10 : f == hull_family::many ? 100 : f == hull_family::exponents ? 8 : 1;
}

namespace construction {

/// Small integers, as doubles.
inline point small_point(draws& d, int most) {
    const double x = d.below(2 * most + 1) - most, y = d.below(2 * most + 1) - most;
    return {x, y, static_cast<double>(d.below(2 * most + 1) - most)};
}

/// A map of integers with determinant 1, which keeps all that is exact about small ones.
struct shear {
    double m[6];

    explicit shear(draws& d) {
        for (double& x : m) x = d.below(7) - 3;
    }
    point operator()(point p) const {
        p.x += m[0] * p.y + m[1] * p.z;
        p.y += m[2] * p.z + m[3] * p.x;
        p.z += m[4] * p.x + m[5] * p.y;
        return p;
    }
};

/// One to `most` points around c, by turns on a sphere, in a flat box, or the same ones again.
inline std::vector<point> cloud(draws& d, int most, const point& c) {
    std::vector<point> made;
    const int n = 1 + d.below(most), kind = d.below(4);
    for (int i = 0; i < n; ++i) {
        point p = cube(d, 1);
        if (kind == 1) p = unit(p);
        if (kind == 2) p.z *= 0x1p-20;
        if (kind == 3 && i > 2) {
            made.push_back(made[static_cast<std::size_t>(d.below(i))]);
        } else {
            made.push_back(along(c, 1, p));
        }
    }
    return made;
}

/// Both are on their sides of a plane and touch it, if they do, in one point, an edge or a face.
inline void draw_touching(draws& d, std::vector<point>& a, std::vector<point>& b) {
    const int in_a = 1 + d.below(4), in_b = 1 + d.below(4);
    for (int i = 0; i < in_a + d.below(5); ++i) {
        point p = small_point(d, 3);
        p.z = i < in_a ? 0 : -1 - d.below(4);
        a.push_back({4 * p.x, 4 * p.y, p.z});
    }
    // One point that both surely have, of all kinds: a corner, the middle of an edge, inside of a face.
    point mean{0, 0, 0};
    for (int i = 0; i < 4; ++i) mean = along(mean, 0.25, a[static_cast<std::size_t>(d.below(in_a))]);
    const bool meets = d.below(2) == 0;
    for (int i = 0; i < in_b + d.below(5); ++i) {
        point p = small_point(d, 12);
        p.z = i < in_b ? 0 : 1 + d.below(4);
        b.push_back(i == 0 && meets ? mean : p);
    }
}

}  // namespace construction

/// Pair number `index` of a family.
template <scalar T>
hull_pair<T> make_hull_pair(std::uint64_t seed, hull_family f, std::uint64_t index) {
    using namespace construction;
    draws d(seed, 1000 + static_cast<std::uint64_t>(f) * 2 + sizeof(T) / 8, index);
    std::vector<point> a, b;
    double unit_of_both = 1;
    point from{0, 0, 0};
    switch (f) {
        case hull_family::general:
        case hull_family::far_away: {
            const point side = cube(d, 1.2);
            a = cloud(d, 12, {0, 0, 0});
            b = cloud(d, 12, side);
            if (f == hull_family::far_away) from = cube(d, 1e6);
            break;
        }
        case hull_family::lattice:
            for (std::vector<point>* points : {&a, &b}) {
                const int n = 1 + d.below(8);
                for (int i = 0; i < n; ++i) points->push_back(small_point(d, 2));
            }
            break;
        case hull_family::flat:
        case hull_family::line: {
            const shear tilted(d);
            for (std::vector<point>* points : {&a, &b}) {
                const int n = 1 + d.below(6);
                for (int i = 0; i < n; ++i) {
                    point p = small_point(d, 4);
                    p.z = 0;
                    if (f == hull_family::line) p.y = 0;
                    points->push_back(tilted(p));
                }
            }
            break;
        }
        case hull_family::touching:
        case hull_family::step_off:
        case hull_family::denormal: {
            draw_touching(d, a, b);
            const shear tilted(d);
            for (std::vector<point>* points : {&a, &b}) {
                for (point& p : *points) p = tilted(p);
            }
            // Denormal, or on both sides of the smallest normal number.
            if (f == hull_family::denormal) {
                unit_of_both = static_cast<double>(least_denormal<T>);
                if (index % 2 == 1) unit_of_both *= sizeof(T) == 4 ? 0x1p18 : 0x1p47;
            }
            break;
        }
        case hull_family::exponents: {
            for (std::vector<point>* points : {&a, &b}) {
                const int n = 2 + d.below(6);
                for (int i = 0; i < n; ++i) {
                    const point p = cube(d, d.power_of_ten(-12, 12));
                    points->push_back(p);
                    if (d.below(3) == 0) points->push_back({-p.x, -p.y, -p.z});
                }
            }
            if (d.below(4) == 0) b[0] = a[0];
            break;
        }
        case hull_family::many: {
            const double apart = d.uniform(1.9, 2.01);
            const point side = unit(cube(d, 1));
            for (int i = 0; i < 150; ++i) {
                a.push_back(unit(cube(d, 1)));
                b.push_back(along(unit(cube(d, 1)), apart, side));
            }
            a.push_back({0.95 * side.x, 0.95 * side.y, 0.95 * side.z});
            b.push_back({0.99 * side.x, 0.99 * side.y, 0.99 * side.z});
            if (d.below(2) == 0) b.pop_back();
            break;
        }
        case hull_family::any_bits:
            break;
    }
    hull_pair<T> made;
    const auto rounded = [&](const std::vector<point>& points) {
        point_list<T> list;
        for (const point& p : points) {
            list.push_back(
                round_to<T>({p.x * unit_of_both + from.x, p.y * unit_of_both + from.y, p.z * unit_of_both + from.z}));
        }
        return list;
    };
    if (f == hull_family::any_bits) {
        for (point_list<T>* points : {&made.a, &made.b}) {
            const int n = 1 + d.below(5);
            for (int i = 0; i < n; ++i) {
                const T x = any_finite<T>(d), y = any_finite<T>(d);
                points->push_back({x, y, any_finite<T>(d)});
            }
        }
        if (d.below(3) == 0) made.b[0] = made.a[0];
    } else {
        made = {rounded(a), rounded(b)};
    }
    if (f == hull_family::step_off) {
        T& x = made.b[0].z;
        x = moved(x, d.below(2) == 0 ? 1 : -1);
    }
    // Which point comes first says nothing.
    for (point_list<T>* points : {&made.a, &made.b}) {
        std::swap(points->front(), (*points)[static_cast<std::size_t>(d.below(static_cast<int>(points->size())))]);
    }
    return made;
}

/// Kinds of shapes that a hull's points make.
inline constexpr int kinds_around_points = 7;

/// Calls f(hull of a, another shape) of a kind: made of points of b, with a radius if it has one.
template <scalar T, class F>
void with_shapes_of_kind(int kind, const hull_pair<T>& points, T radius, const F& f) {
    const hull<T> h = hull_over(points.a);
    const auto p = [&b = points.b](std::size_t i) { return b[i % b.size()]; };
    switch (kind) {
        case 0:
            return f(h, hull_over(points.b));
        case 1:
            return f(h, triangle<T>{p(0), p(1), p(2)});
        case 2:
            return f(h, segment<T>{p(0), p(1)});
        case 3:
            return f(h, p(0));
        case 4:
            return f(h, sphere<T>{p(0), radius});
        case 5:
            return f(h, capsule<T>{{p(0), p(1)}, radius});
        default:
            return f(h, merge(bounds(p(0)), bounds(p(1))));
    }
}

}  // namespace abut::test
