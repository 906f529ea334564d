// SPDX-License-Identifier: MIT
#pragma once

// Families of convex hulls of few points and other shapes: rays and segments, capsules and spheres, planes; and those of
// which a distance is asked, with the oracle that says what is right. Hosts only: each is a list of points.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <abut/predicate/intersects.hpp>

#include "hull_pairs.hpp"
#include "hulls.hpp"
#include "samples.hpp"
#include "solid_pairs.hpp"

namespace abut::test {

/// Those whose oracles do not take too long.
inline constexpr hull_family families_of_few_points[] = {
    hull_family::general,  hull_family::far_away, hull_family::lattice,   hull_family::flat,    hull_family::line,
    hull_family::touching, hull_family::step_off, hull_family::exponents, hull_family::denormal};

/// A hull, and a ray and a segment from one point.
template <scalar T>
struct line_case {
    point_list<T> points;
    ray<T> r;
    segment<T> s;
};

/// Lines at random, through corners and between them, along edges and in planes of faces, from inside, and of no direction.
template <scalar T>
line_case<T> make_line_case(std::uint64_t seed, hull_family f, std::uint64_t index) {
    auto both = make_hull_pair<T>(seed, f, index);
    draws d(seed, 12, index);
    if (both.a.size() > 6) both.a.resize(6);
    const auto any = [&](const point_list<T>& points) {
        return points[static_cast<std::size_t>(d.below(static_cast<int>(points.size())))];
    };
    const auto middle = [](const vec3<T>& p, const vec3<T>& q) {
        return vec3<T>{p.x / 2 + q.x / 2, p.y / 2 + q.y / 2, p.z / 2 + q.z / 2};
    };
    vec3<T> origin = any(both.b), to = any(both.a);
    vec3<T> along = to - origin;
    switch (index % 9) {
        case 0:
            break;
        case 1:
            along = middle(to, any(both.a)) - origin;
            break;
        case 2:
            along = middle(middle(to, any(both.a)), any(both.a)) - origin;
            break;
        case 3:
            along = any(both.a) - to;
            origin = any(both.a) - T(2) * along;
            break;
        case 4:
            along = any(both.a) - to;
            origin = middle(any(both.a), any(both.a)) - along;
            break;
        case 5:
            origin = middle(to, any(both.a));
            break;
        case 6:
            along = any(both.b) - origin;
            break;
        case 7:
            along = T(d.below(2)) * along;
            break;
        default:
            along = vec3<T>{T(0), T(d.below(3) - 1), T(1)};
            origin = to - T(3) * along;
            break;
    }
    return {both.a, {origin, along}, {origin, origin + T(index % 2 == 0 ? 1 : 0.5) * along}};
}

/// A radius: at random, a small whole number, 0, or as near to tangent as `fast` can tell, and a step off.
template <scalar T>
T draw_radius(draws& d, const point_list<T>& core, const point_list<T>& points) {
    const int kind = d.below(4);
    if (kind == 0) return T(0);
    if (kind == 1) return static_cast<T>(d.below(6));
    if (kind == 2) return static_cast<T>(d.uniform(0, 1));
    T below = 0, above = 0x1p40;
    for (int i = 0; i < 90 && below < above; ++i) {
        const T middle = below / 2 + above / 2;
        if (middle == below || middle == above) break;
        const capsule<T> s{{core.front(), core.back()}, middle};
        (intersects<fast>(s, hull_over(points)) ? above : below) = middle;
    }
    return above == 0 ? above : construction::moved(above, d.below(5) - 2);
}

/// A segment or point, with a radius around it, and a hull.
template <scalar T>
struct round_case {
    point_list<T> core, points;
    T radius;
};

template <scalar T>
round_case<T> make_round_case(std::uint64_t seed, hull_family f, std::uint64_t index) {
    auto both = make_hull_pair<T>(seed, f, index);
    draws d(seed, 7, index);
    both.a.resize(both.a.size() > 1 ? static_cast<std::size_t>(1 + d.below(2)) : 1);
    if (both.b.size() > 6) both.b.resize(6);
    round_case<T> made{both.a, both.b, T(0)};
    made.radius = draw_radius(d, both.a, both.b);
    if (!(made.radius >= 0)) made.radius = 0;
    return made;
}

/// A plane and a hull; some go through a point of it, as nearly as it rounds.
template <scalar T>
struct plane_case {
    plane<T> p;
    point_list<T> points;
};
template <scalar T>
plane_case<T> make_plane_case(std::uint64_t seed, std::uint64_t index) {
    const auto f = index % 2 == 0 ? hull_family::lattice : hull_family::general;
    const auto both = make_hull_pair<T>(seed, f, index);
    const vec3<T>&n = both.a.front(), &on = both.b.front();
    return {{n, index % 3 == 0 ? T(3) : static_cast<T>(dot(n, on))}, both.b};
}

/// Kinds of shapes that are asked of hulls: those around points, and planes.
inline constexpr int kinds_beside_hulls = kinds_around_points + 1;

/// Calls f(hull, other shape), of shape number `kind`: made of the points of b. The last is a plane.
template <scalar T, class F>
void with_shape_beside_hull(int kind, const hull_pair<T>& points, std::uint64_t index, const F& f) {
    const vec3<T> p = points.b[0], q = points.b[1 % points.b.size()];
    if (kind == kinds_around_points) return f(hull_over(points.a), plane<T>{p, static_cast<T>(dot(p, q))});
    draws d(sample_seed, 8, index);
    const T radius = d.below(3) == 0 ? T(0) : static_cast<T>(d.uniform(0, 0.5));
    with_shapes_of_kind(kind, points, radius, f);
}

/// Of few points, for a distance.
template <scalar T>
hull_pair<T> make_few_points(std::uint64_t seed, hull_family f, std::uint64_t index) {
    auto both = make_hull_pair<T>(seed, f, index);
    if (both.a.size() > 5) both.a.resize(5);
    if (both.b.size() > 4) both.b.resize(4);
    // Not too many meet: those that do are asked of `intersects`.
    if (index % 4 != 0 && f != hull_family::exponents) {
        T width = 0;
        for (const auto* points : {&both.a, &both.b}) {
            for (const vec3<T>& p : *points) width = std::max(width, detail::absolute(p.x - both.a[0].x));
        }
        for (vec3<T>& p : both.b) p.x += width;
    }
    return both;
}

/// A hull and another shape: which are within a distance of each other.
template <class T, class U>
struct hull_question {
    const hull<T>& h;
    const U& other;
    bool meet;

    hull_question(const hull<T>& a, const U& b)
        : h(a), other(b), meet(oracle::hulls_intersect(corners_of(a), corners_of(b))) {}
    [[nodiscard]] double least_distance() const { return meet ? 0 : exact_gap(h, other).least_double(); }
    [[nodiscard]] bool truth(double d) const { return meet || exact_gap(h, other).compared_with(d) <= 0; }
};
template <class T>
struct hull_question<T, plane<T>> {
    const hull<T>& h;
    const plane<T>& other;

    [[nodiscard]] double least_distance() const {
        return construction::least_number<double>([this](double d) { return truth(d); });
    }
    [[nodiscard]] bool truth(double d) const { return oracle::within_distance(other, h, d); }
};

}  // namespace abut::test
