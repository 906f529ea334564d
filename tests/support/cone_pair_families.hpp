// SPDX-License-Identifier: MIT
#pragma once

// Pairs of a cone and another one, a cylinder or a capsule: in general position, with features that face each other, at the
// last radius without contact and at the first one with it, on lattices, touching exactly by construction, of every size,
// degenerate. All deterministic by seed, family and number. Where the construction says whether they meet, the pair does
// too.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

#include "cylinder_pair_families.hpp"
#include "cylinder_pair_oracle.hpp"
#include "draws.hpp"
#include "revolution_pairs.hpp"

namespace abut::test {

/// `facing`: features of both, an apex, a side, a rim, an end, touch one plane from both sides, at one place of it, but for
/// a gap down to 2^-50. `touching`: so in whole numbers, of which the construction says whether they touch; `nudged`: one of
/// its numbers is a step off. `other_nappe`: the place is on the line of a side but behind the apex, or a cone is mirrored
/// there. `leaning`: the plane is that of a side whose slope has a length that is irrational, and the other, in whole
/// numbers too, is the mirror image of the first, or touches the plane with its apex, its end or a side. `around_apex`: a
/// feature of the second is about where the first's apex is. `aligned`: numbers of all digits, but along axes of the
/// coordinates, and as far apart as the rounded sum of two numbers. `near_contact`: a radius is the least with which they
/// meet. `huge_and_small`: the surface of the first, up to 2^60 times as large, goes through where the other is.
enum class cone_family : int {
    random,
    facing,
    offset,
    any_scale,
    lattice_2,
    lattice_5,
    upright_lattice,
    touching,
    other_nappe,
    leaning,
    nudged,
    around_apex,
    aligned,
    near_contact,
    nested,
    discs_and_needles,
    huge_and_small,
    no_radius,
    no_length,
    denormal,
    largest,
    mixed_exponents,
    all_bit_patterns,
};
inline constexpr int cone_family_count = 23;

inline const char* name_of(cone_family f) {
    constexpr const char* names[cone_family_count] = {
        "random",    "facing",       "offset",      "any scale",       "lattice 2",       "lattice 5",
        "upright",   "touching",     "other nappe", "leaning",         "nudged",          "around apex",
        "aligned",   "near contact", "nested",      "discs, needles",  "huge and small",  "no radius",
        "no length", "denormal",     "largest",     "mixed exponents", "all bit patterns"};
    return names[static_cast<int>(f)];
}

/// A cone's apex is the axis' first end.
template <class S, scalar T>
S round_shape(const segment<T>& axis, T radius) {
    if constexpr (std::same_as<S, cone<T>>) {
        return {axis.a, axis.b, radius};
    } else {
        return {axis, radius};
    }
}
template <scalar T>
cone<T> cone_of(const pair_of_rounds<T>& c) {
    return round_shape<cone<T>>(c.first, c.first_radius);
}
template <class Other, scalar T>
Other other_of(const pair_of_rounds<T>& c) {
    return round_shape<Other>(c.second, c.second_radius);
}

namespace construction {

constexpr int five_circle[12][2] = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                    {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};

/// What a body and a plane share: a segment or a point, or a disc around p.
struct footprint {
    int p[2], q[2], radius;
};

inline bool footprints_meet(const footprint& f, const footprint& g) {
    if (f.radius == 0 && g.radius == 0) return plane_segments_meet(f.p, f.q, g.p, g.q);
    if (f.radius == 0) return footprints_meet(g, f);
    using wide_int = std::int64_t;
    const wide_int e[2] = {g.q[0] - g.p[0], g.q[1] - g.p[1]}, w[2] = {f.p[0] - g.p[0], f.p[1] - g.p[1]};
    const wide_int reach = f.radius + g.radius, ww = w[0] * w[0] + w[1] * w[1];
    const wide_int ee = e[0] * e[0] + e[1] * e[1], s = e[0] * w[0] + e[1] * w[1], area = e[0] * w[1] - e[1] * w[0];
    if (s <= 0) return ww <= reach * reach;
    if (s >= ee) return ww - 2 * s + ee <= reach * reach;
    return area * area <= reach * reach * ee;
}

/// A body over the plane z = 0, in whole numbers, that touches it.
struct resting_body {
    whole_point a, b;
    int radius;
    footprint shared;
};

/// Right angles and lengths are exact, by 3, 4 and 5.
inline resting_body make_resting(draws& d, round_kind kind, bool on_generator) {
    const int* const u = five_circle[d.below(12)];
    const int high = 25 * (1 + d.below(4)), size = 1 + d.below(4), radius = 25 * size;
    const bool is_steep = d.below(2) == 0;
    // Along the radius to a rim's lowest point, upwards, and along the axis, both of length 25.
    const int out = is_steep ? 3 : 4, up = is_steep ? 4 : 3;
    const whole_point w{out * u[0], out * u[1], up * 5}, v{-up * u[0], -up * u[1], out * 5};
    resting_body r{{0, 0, 0}, {0, 0, 0}, radius, {{0, 0}, {0, 0}, 0}};
    int feature = on_generator ? 1 : d.below(16);
    if (feature == 15) {  // a ball
        r.a = r.b = {0, 0, radius};
        return r;
    }
    if (kind == round_kind::cone) {
        feature = on_generator ? 1 : feature % 5;
        if (feature == 0) {  // its apex; the axis may be its all
            const int i = d.below(13) - 6, j = d.below(13) - 6, k = 1 + d.below(8);
            const int across = i * i + j * j, square = across + k * k;
            int least = d.below(9);
            while (k * k * square <= least * least * across) --least;
            r.b = {25 * i, 25 * j, 25 * k};
            r.radius = 25 * least;
        } else if (feature == 1) {  // a line of its side
            const int part = is_steep ? 9 : 16;
            r.b = {size * part * u[0], size * part * u[1], size * 60};
            r.radius = size * (is_steep ? 100 : 75);
            r.shared.q[0] = radius * u[0], r.shared.q[1] = radius * u[1];
        } else if (feature == 2) {  // its base
            r.a = {0, 0, high};
            r.shared.radius = radius;
        } else if (feature == 3) {  // its rim
            r.b = size * w;
            const int length = 1 + d.below(4), side = size * w.z > length * v.z && d.below(2) == 0 ? -1 : 1;
            r.a = r.b + side * length * v;
        } else {  // its rim, where the axis is level
            const int length = 5 * (1 + d.below(12));
            r.b = {0, 0, radius};
            r.a = {length * u[0], length * u[1], radius};
        }
    } else if (feature < 5) {  // a side
        const bool is_round = d.below(2) == 0;
        r.shared.q[0] = is_round ? radius * u[0] : 25 * (d.below(13) - 6);
        r.shared.q[1] = is_round ? radius * u[1] : 25 * (d.below(13) - 6);
        r.a = {0, 0, radius};
        r.b = {r.shared.q[0], r.shared.q[1], radius};
    } else if (kind == round_kind::capsule) {  // an end
        r.a = {0, 0, radius};
        r.b = {25 * (d.below(9) - 4), 25 * (d.below(9) - 4), radius + high};
    } else if (feature < 10) {  // an end
        r.b = {0, 0, high};
        r.shared.radius = radius;
    } else {  // a rim
        r.a = size * w;
        r.b = r.a + (1 + d.below(4)) * v;
    }
    return r;
}

/// A place of what is shared, at its border or inside; behind an apex, if wanted.
inline void draw_place(draws& d, const footprint& f, bool is_behind, int (&place)[2]) {
    const int* const u = five_circle[d.below(12)];
    const int part = d.below(6);
    for (int k = 0; k < 2; ++k) {
        const int e = (f.q[k] - f.p[k]) / 5;
        place[k] = f.radius > 0 ? f.p[k] + f.radius / 25 * part * u[k] : f.p[k] + (is_behind ? -part : part) * e;
    }
}

/// The second is under the plane that the first is over, and both touch it, or the first is a step over that or under it.
template <scalar T>
void touching_cone(draws& d, round_kind kind, bool is_behind, pair_of_rounds<T>& pair) {
    const lattice_frame f(d);
    resting_body s = make_resting(d, round_kind::cone, is_behind), t = make_resting(d, kind, false);
    int at[2], to[2];
    draw_place(d, s.shared, is_behind, at);
    draw_place(d, t.shared, false, to);
    int shift[2];
    const bool is_off = d.below(3) == 0;
    for (int k = 0; k < 2; ++k) shift[k] = at[k] - to[k] + (is_off ? d.below(5) - 2 : 0);
    for (int k = 0; k < 2; ++k) t.shared.p[k] += shift[k], t.shared.q[k] += shift[k];
    for (whole_point* p : {&t.a, &t.b}) *p = {p->x + shift[0], p->y + shift[1], -p->z};
    pair.truth = footprints_meet(s.shared, t.shared) ? known::yes : known::no;
    if (is_behind && d.below(3) == 0) {
        s.b = 2 * s.a + -1 * s.b;
        pair.truth = known::nothing;
    } else if (const int step = d.below(8); step < 2) {
        for (whole_point* p : {&s.a, &s.b}) p->z += step == 0 ? 1 : -1;
        pair.truth = step == 0 ? known::no : known::nothing;
    }
    const auto place = [&](const whole_point& w) { return f.at<T>(w.x, w.y, w.z); };
    pair.first = {place(s.a), place(s.b)}, pair.second = {place(t.a), place(t.b)};
    pair.first_radius = static_cast<T>(s.radius * f.unit()), pair.second_radius = static_cast<T>(t.radius * f.unit());
    if (kind != round_kind::cone && d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
    if (kind == round_kind::cone && d.below(2) == 0) {
        std::swap(pair.first, pair.second), std::swap(pair.first_radius, pair.second_radius);
    }
    const T scale = rounded_to<T>(std::ldexp(1.0, d.below(3) == 0 ? d.below(41) - 20 : 0));
    for (int i = 0; i < 14; ++i) *number_of(pair, i) *= scale;
}

/// The first stands on its apex, which is at 0. `g` is a line of its side, from the apex to the rim; n is its normal, and t
/// the tangent of the rim. The second touches their plane from without, or is a step before that.
template <scalar T>
void leaning(draws& d, round_kind kind, pair_of_rounds<T>& pair) {
    constexpr int slopes[4][2] = {{4, 21}, {1, 12}, {3, 8}, {7, 12}};  // whose normals have whole lengths
    const lattice_frame f(d);
    const int* const u = five_circle[d.below(12)];
    const int* const slope = slopes[d.below(4)];
    const int way = d.below(kind == round_kind::cone ? 4 : kind == round_kind::cylinder ? 2 : 1);
    const bool is_whole = way == 0;
    const int out = is_whole ? slope[0] : 1 + d.below(3), up = is_whole ? slope[1] : 1 + d.below(6);
    const whole_point g{out * u[0], out * u[1], up}, n{up * u[0], up * u[1], -25 * out}, t{-u[1], u[0], 0};
    const int square = 25 * (up * up + 25 * out * out), unit = way == 3 ? 6 * square : 6;
    // Of the plane, in parts of g / 6 and t.
    const int x = d.below(11) - 2, y = d.below(3) == 0 ? d.below(5) - 2 : 0;
    const auto at = [&](int i, int j) { return unit / 6 * i * g + unit * j * t; };
    const int low[2] = {0, 0}, high[2] = {6, 0}, from[2] = {x, y};
    whole_point a = at(x, y), b{};
    int r = 0;
    bool is_met = false;
    if (way == 0) {  // a side, an end that is a ball, or a ball
        int length = 5;
        while (length * length < up * up + 25 * out * out) ++length;
        const int to[2] = {x + d.below(7) - 3, y + d.below(3) - 1}, lift = kind == round_kind::capsule ? d.below(3) : 0;
        const bool is_ball = kind == round_kind::cone || d.below(8) == 0;
        a = a + 6 * n;
        b = is_ball ? a : at(to[0], to[1]) + 6 * (1 + lift) * n;
        r = 6 * 5 * length;
        is_met = is_ball || lift > 0 ? plane_segments_meet(low, high, from, from) : plane_segments_meet(low, high, from, to);
    } else if (way == 1) {  // an end
        const std::int64_t size = 1 + d.below(20), past = x < 0 ? -x : x > 6 ? x - 6 : 0;
        r = static_cast<int>(6 * size);
        b = a + 6 * n;
        is_met = past * past * (25 * out * out + up * up) + 36 * 25 * y * y <= 36 * size * size;
        if (kind == round_kind::cone) std::swap(a, b);
    } else if (way == 2) {  // an apex
        const int i = d.below(3) - 1, j = d.below(3) - 1, k = 1 + d.below(2);
        const whole_point axis = i * t + j * g + k * n;
        const auto inner_of = [](const whole_point& v, const whole_point& w) {
            return std::int64_t{v.x} * w.x + std::int64_t{v.y} * w.y + std::int64_t{v.z} * w.z;
        };
        const std::int64_t dd = inner_of(axis, axis), s = inner_of(axis, n), across = square * dd - s * s;
        std::int64_t size = d.below(120);
        while (size * size * across >= s * s * dd) --size;
        b = a + 6 * axis;
        r = static_cast<int>(6 * size);
        is_met = plane_segments_meet(low, high, from, from);
    } else {  // the mirror image, or that turned around
        const int sign = d.below(2) == 0 ? 1 : -1;
        const int to[2] = {x + 6 * sign, y};
        // By twice the axis' part along n, which is -25 out up / square of n.
        const whole_point mirrored{50 * out * up * n.x, 50 * out * up * n.y, square * up + 50 * out * up * n.z};
        b = a + (sign > 0 ? 6 * mirrored : whole_point{0, 0, -unit * up});
        r = 5 * out * unit;
        is_met = plane_segments_meet(low, high, from, to);
    }
    pair.truth = is_met ? known::yes : known::no;
    if (const int step = d.below(8); step < 2) {
        const whole_point away{u[0], u[1], 0};
        a = a + (step == 0 ? 1 : -1) * away, b = b + (step == 0 ? 1 : -1) * away;
        pair.truth = step == 0 ? known::no : known::nothing;
    }
    const auto place = [&](const whole_point& w) { return f.at<T>(w.x, w.y, w.z); };
    pair.first = {place({0, 0, 0}), place({0, 0, unit * up})}, pair.second = {place(a), place(b)};
    pair.first_radius = static_cast<T>(5 * out * unit * f.unit()), pair.second_radius = static_cast<T>(r * f.unit());
    if (kind != round_kind::cone && d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
    if (kind == round_kind::cone && d.below(2) == 0) {
        std::swap(pair.first, pair.second), std::swap(pair.first_radius, pair.second_radius);
    }
}

struct facing_body {
    point first, last;
    double radius;
};

/// A body over the plane through 0 with the normal `out`, that touches it at 0 or near that; `side` is in the plane.
inline facing_body make_facing(draws& d, round_kind kind, const point& out, const point& side) {
    const auto small = [&](int most) {
        const double m = d.uniform(0.5, 1);
        return std::ldexp(m, -d.below(most));
    };
    const auto turned = [](double x, const point& u, double y, const point& v) {
        return along(along({0, 0, 0}, x, u), y, v);
    };
    const double right = std::acos(-1.0) / 2, height = d.below(3) == 0 ? small(40) : d.uniform(0.5, 2),
                 r = d.below(4) == 0 ? small(50) : small(3), side_angle = std::atan2(r, height);
    const double part = d.below(3) == 0 ? d.below(2) : d.uniform(-0.1, 1.1), ratio = d.below(2) == 0 ? 1 : part;
    const int feature = d.below(4), bend = d.below(3);
    // The angle of the axis with the plane: anywhere between two, or near one of them.
    const auto between = [&](double low, double high) {
        const double near = (high - low) * small(50);
        return bend == 0 ? low + near : bend == 1 ? high - near : d.uniform(low, high);
    };
    if (kind == round_kind::cone) {
        if (feature < 2) {  // an apex, or a line of the side
            const double angle = feature == 0 ? between(side_angle, right) : side_angle;
            const point apex = along({0, 0, 0}, feature == 0 ? 0 : -part * std::hypot(height, r), side);
            return {apex, along(apex, height, turned(std::cos(angle), side, std::sin(angle), out)), r};
        }
        if (feature == 2) {  // a rim
            const double angle = between(-right, side_angle);
            const point base = turned(-r * std::sin(angle), side, r * std::cos(angle), out);
            return {along(base, -height, turned(std::cos(angle), side, std::sin(angle), out)), base, r};
        }
        const point base = along({0, 0, 0}, ratio * r, side);
        return {along(base, height, out), base, r};
    }
    if (feature < 2) {  // a side
        const point a = turned(-part * height, side, r, out);
        return {a, along(a, height, side), r};
    }
    const double angle = between(0, right);
    const point axis = turned(std::cos(angle), side, std::sin(angle), out);
    if (kind == round_kind::capsule) {
        const point a = along({0, 0, 0}, r, out);
        return {a, along(a, height, axis), r};
    }
    const point rim = turned(-r * std::sin(angle), side, r * std::cos(angle), out), end = along({0, 0, 0}, ratio * r, side);
    return feature == 2 ? facing_body{rim, along(rim, height, axis), r} : facing_body{end, along(end, height, out), r};
}

template <scalar T>
void facing(draws& d, round_kind kind, double most_gap, pair_of_rounds<T>& c) {
    const auto small = [&](int most) {
        const double m = d.uniform(0.5, 1);
        return std::ldexp(m, -d.below(most));
    };
    const point out = unit(cube(d, 1)), back = along({0, 0, 0}, -1, out), side = unit(cross_product(out, cube(d, 1)));
    point other = unit(cross_product(out, cube(d, 1)));
    if (d.below(2) == 0) {
        const double sign = d.below(2) == 0 ? 1 : -1;
        other = unit(along(along({0, 0, 0}, small(60), other), sign, side));
    }
    const facing_body s = make_facing(d, round_kind::cone, out, side), t = make_facing(d, kind, back, other);
    const point at = cube(d, d.below(2) == 0 ? 0 : 1);
    const double away = d.below(2) == 0 ? 1 : -1, gap = d.below(8) == 0 ? 0 : most_gap * away * small(51);
    const point there = along(at, gap, back);
    c.first = {round_to<T>(along(at, 1, s.first)), round_to<T>(along(at, 1, s.last))};
    c.second = {round_to<T>(along(there, 1, t.first)), round_to<T>(along(there, 1, t.last))};
    c.first_radius = rounded_to<T>(s.radius), c.second_radius = rounded_to<T>(t.radius);
}

/// The first along z, its apex below, and the second along z or x, with numbers of all digits. They touch in a plane of
/// coordinates, or on a line along z.
template <scalar T>
void aligned_cone(draws& d, round_kind shape, pair_of_rounds<T>& pair) {
    const auto draw = [&](double least, double most) { return rounded_to<T>(d.uniform(least, most)); };
    const auto rounded_sum = [&](T a, T b) {
        const volatile T sum = a + b;
        const int step = d.below(4) - 2;
        return moved(T(sum), step < -1 ? 0 : step);
    };
    const bool is_cone = shape == round_kind::cone, is_capsule = shape == round_kind::capsule;
    const int kind = d.below(5), turn = d.below(3);
    const T r = draw(0.01, 1), s = draw(0.01, 1), low = draw(-1, 0.2), high = draw(0.3, 1), size = draw(0.1, 1);
    const T x = draw(-0.6, 0.6) * r, y = draw(-0.6, 0.6) * r;
    pair.first_radius = r, pair.second_radius = s;
    pair.first = {{T(0), T(0), low}, {T(0), T(0), high}};
    if (kind == 0) {  // rims in one plane, or a capsule's side there
        const T out = rounded_sum(r, s), end = d.below(2) == 0 ? high + size : high - size;
        pair.second = {{out, T(0), end}, {out, T(0), is_capsule && end > high ? high - size : high}};
        if (is_capsule && end < high) pair.second.b.z += size;
        pair.truth = is_sum_at_least(r, s, out) ? known::yes : known::no;
    } else if (kind == 1) {  // an apex, an end, or a capsule's end on the base
        const T lift = is_capsule ? s : T(0), up = rounded_sum(high, lift);
        pair.second = {{x, y, up}, {x, y, up + size}};
        if (is_cone && d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
        pair.truth = is_sum_at_least(high, lift, up) ? known::yes : known::no;
    } else if (kind == 2) {  // a side, or a rim of a level axis, on the base
        const T up = rounded_sum(high, s);
        pair.second = {{is_cone ? x + size : x - size, y, up}, {is_cone ? x : x + size, y, up}};
        pair.truth = is_sum_at_least(high, s, up) ? known::yes : known::no;
    } else if (kind == 3) {  // under the apex
        const T lift = is_capsule ? s : T(0);
        const T down = rounded_sum(-low, lift), part = d.below(2) == 0 || is_capsule ? T(0) : s / 2;
        const bool is_apex = is_cone && d.below(2) == 0;
        pair.second = {{is_apex ? T(0) : part, T(0), -down}, {is_apex ? T(0) : part, T(0), -down - size}};
        if (is_cone && !is_apex) std::swap(pair.second.a, pair.second.b);
        pair.truth = is_sum_at_least(-low, lift, down) ? known::yes : known::no;
    } else {  // on one axis, or on parallel ones
        const T from = draw(-1.5, 1), to = draw(-1, 1.5);
        const bool is_one = d.below(2) == 0;
        pair.second = {{is_one ? T(0) : x, is_one ? T(0) : y + s, from}, {is_one ? T(0) : x, is_one ? T(0) : y + s, to}};
    }
    for (int i = 0; i < turn; ++i) {
        for (vec3<T>* p : {&pair.first.a, &pair.first.b, &pair.second.a, &pair.second.b}) *p = {p->z, p->x, p->y};
    }
    if (!is_cone && d.below(2) == 0) std::swap(pair.second.a, pair.second.b);
}

}  // namespace construction

template <class Other, scalar T = scalar_type_of<Other>>
pair_of_rounds<T> make_cone_pair(std::uint64_t seed, cone_family f, std::uint64_t k) {
    using namespace construction;
    constexpr round_kind kind = oracle::kind_of_round<Other>;
    draws d(seed, 2000 + static_cast<std::uint64_t>(f) * 3 + static_cast<std::uint64_t>(kind), k);
    pair_of_rounds<T> c{};
    const auto general = [&](double scale, const point& offset) {
        for (segment<T>* s : {&c.first, &c.second}) {
            s->a = round_to<T>(along(offset, scale, cube(d, 1)));
            s->b = round_to<T>(along(offset, scale, cube(d, 1)));
        }
        c.first_radius = rounded_to<T>(scale * d.power_of_ten(-2, 0));
        c.second_radius = rounded_to<T>(scale * d.power_of_ten(-2, 0));
    };
    const auto lattice = [&](int n) {
        for (int i = 0; i < 12; ++i) *number_of(c, i) = static_cast<T>(d.below(2 * n + 1) - n);
        c.first_radius = static_cast<T>(d.below(2 * n)) / 2;
        c.second_radius = static_cast<T>(d.below(2 * n)) / 2;
    };
    // The first along an axis of the coordinates, and the second half the time.
    const auto upright = [&](int n) {
        lattice(n);
        c.first.b = c.first.a;
        *number_of(c, 3 + d.below(3)) += static_cast<T>(d.below(7) - 3);
        if (d.below(2) == 0) {
            c.second.b = c.second.a;
            *number_of(c, 9 + d.below(3)) += static_cast<T>(d.below(7) - 3);
        }
    };
    const auto discs_and_needles = [&] {
        general(1, {0, 0, 0});
        for (int i = 0; i < 2; ++i) {
            segment<T>& s = i == 0 ? c.first : c.second;
            T& radius = i == 0 ? c.first_radius : c.second_radius;
            const double part = d.uniform(0.5, 1), thin = std::ldexp(part, -d.below(50));
            if (d.below(2) == 0) {
                radius = rounded_to<T>(thin);
            } else {
                const point e = along(widened(s.b), -1, widened(s.a));
                // Where the first end is small, a disc may be as thin as wanted.
                if (d.below(2) == 0) s.a = {T(0), T(0), T(0)};
                s.b = round_to<T>(along(widened(s.a), thin, e));
                radius = rounded_to<T>(d.uniform(0.2, 1.5));
            }
        }
    };
    // A place of the second's axis or surface about at the first's apex.
    const auto around_apex = [&] {
        general(1, {0, 0, 0});
        const double size = d.power_of_ten(-3, 1), away_by = d.uniform(-1, 1);
        const int shift = d.below(40);
        const double step = d.below(4) == 0 ? 0 : std::ldexp(away_by, -shift);
        const point e = along({0, 0, 0}, size, cube(d, 1)), out = unit(cross_product(e, cube(d, 1)));
        const int feature = d.below(4);
        const double t = feature < 2 ? feature : d.uniform(0, 1), r = size * d.power_of_ten(-2, 1);
        const double away = kind == round_kind::cone && feature != 3 ? t * r : r,
                     part = feature == 1 ? d.uniform(0, 1.2) : 1;
        // 0: an apex or an end, 1: a place of the base or of the other end, 2: one of the side, 3: or about there.
        const point at = along(widened(c.first.a), step, cube(d, 1));
        const point a = along(along(at, -t, e), -part * away, out);
        c.second = {round_to<T>(a), round_to<T>(along(a, 1, e))};
        c.second_radius = rounded_to<T>(r);
    };
    const auto any_of_three = [&] {
        if (const int way = d.below(4); way < 2) {
            general(1, {0, 0, 0});
        } else if (way == 2) {
            facing(d, kind, 0.1, c);
        } else {
            lattice(3);
        }
    };
    switch (f) {
        case cone_family::random:
            general(1, {0, 0, 0});
            break;
        case cone_family::facing:
            facing(d, kind, 1, c);
            break;
        case cone_family::offset:
            if (d.below(2) == 0) {
                general(1, cube(d, d.power_of_ten(1, 6)));
            } else {
                const point away = cube(d, d.power_of_ten(1, 3));
                facing(d, kind, 1, c);
                for (vec3<T>* p : {&c.first.a, &c.first.b, &c.second.a, &c.second.b}) {
                    *p = round_to<T>(along(widened(*p), 1, away));
                }
            }
            break;
        case cone_family::any_scale:
            general(std::same_as<T, float> ? d.power_of_ten(-36, 36) : d.power_of_ten(-36, 36) * d.power_of_ten(-36, 36),
                    {0, 0, 0});
            break;
        case cone_family::lattice_2:
            lattice(2);
            break;
        case cone_family::lattice_5:
            lattice(5);
            break;
        case cone_family::upright_lattice:
            upright(3);
            break;
        case cone_family::touching:
            touching_cone(d, kind, false, c);
            break;
        case cone_family::other_nappe:
            touching_cone(d, kind, true, c);
            break;
        case cone_family::leaning:
            leaning(d, kind, c);
            break;
        case cone_family::nudged: {
            if (d.below(3) != 0) {
                touching_cone(d, kind, d.below(4) == 0, c);
            } else {
                upright(2);
            }
            c.truth = known::nothing;
            const bool is_one = d.below(2) == 0;
            const int count = is_one ? 1 : 1 + d.below(3);
            for (int i = 0; i < count; ++i) {
                T& x = *number_of(c, d.below(14));
                const int way = d.below(2) == 0 ? -1 : 1;
                // The step from 0 is as small as numbers are where that is not many digits.
                x = x != 0 || (sizeof(T) == 4 && d.below(4) == 0)
                        ? moved(x, way)
                        : rounded_to<T>(std::ldexp(double(way), -1 - d.below(100)));
                if (c.first_radius < 0 || c.second_radius < 0) x = 0;
            }
            break;
        }
        case cone_family::around_apex:
            around_apex();
            break;
        case cone_family::aligned:
            aligned_cone(d, kind, c);
            break;
        case cone_family::near_contact:
            for (int tries = 0; tries < 40; ++tries) {
                const int way = d.below(6);
                if (way == 0) general(1, {0, 0, 0});
                if (way == 1) facing(d, kind, 0.1, c);
                if (way == 2) around_apex();
                if (way == 3) discs_and_needles();
                if (way == 4) general(1, cube(d, d.power_of_ten(1, 3)));
                if (way == 5) lattice(4);
                c.is_first_least = d.below(2) == 0;
                if (c.is_first_least && c.first.a == c.first.b) continue;
                if (set_least_radius(c, [&] { return oracle::examine_round(cone_of(c), other_of<Other>(c)); })) return c;
            }
            general(1, {0, 0, 0});
            break;
        case cone_family::nested: {
            // A part of the axis is inside, and about all of the solid, or a little less.
            general(1, {0, 0, 0});
            const point a = widened(c.first.a), e = along(widened(c.first.b), -1, a);
            const double size = d.power_of_ten(-6, 0), t = d.uniform(-0.2, 1.2);
            const point at = along(along(a, t, e), t * static_cast<double>(c.first_radius), cube(d, 1));
            c.second = {round_to<T>(at), round_to<T>(along(at, size, cube(d, 1)))};
            c.second_radius = rounded_to<T>(size * d.power_of_ten(-2, 0));
            if (kind == round_kind::cone && d.below(2) == 0) {
                std::swap(c.first, c.second), std::swap(c.first_radius, c.second_radius);
            }
            break;
        }
        case cone_family::discs_and_needles:
            if (d.below(2) == 0) {
                discs_and_needles();
            } else {
                facing(d, kind, 1, c);
                *number_of(c, 12 + d.below(2)) *= rounded_to<T>(std::ldexp(1.0, -d.below(20)));
            }
            break;
        case cone_family::huge_and_small: {
            const resting_body s = make_resting(d, round_kind::cone, d.below(2) == 0);
            const double size = std::ldexp(1.0, d.below(61));
            int at[2];
            draw_place(d, s.shared, d.below(8) == 0, at);
            const int turn = d.below(3);
            const auto placed = [&](const whole_point& w) {
                const point p{(w.x - at[0]) * size, (w.y - at[1]) * size, w.z * size};
                return round_to<T>(turn == 0 ? p : turn == 1 ? point{p.z, p.x, p.y} : point{p.y, p.z, p.x});
            };
            c.first = {placed(s.a), placed(s.b)};
            c.first_radius = rounded_to<T>(s.radius * size);
            const point there = cube(d, 1);
            c.second = {round_to<T>(there), round_to<T>(along(there, 1, cube(d, 1)))};
            c.second_radius = rounded_to<T>(d.power_of_ten(-2, 0));
            if (kind == round_kind::cone && d.below(2) == 0) {
                std::swap(c.first, c.second), std::swap(c.first_radius, c.second_radius);
            }
            break;
        }
        case cone_family::no_radius:
            any_of_three();
            if (const int which = d.below(3); which < 2)
                *number_of(c, 12 + which) = 0;
            else
                c.first_radius = c.second_radius = 0;
            break;
        case cone_family::no_length:
            any_of_three();
            if (const int which = d.below(3); which != 1)
                c.first.b = c.first.a;
            else
                c.second.b = c.second.a;
            if (d.below(8) == 0) c.second.b = c.second.a;
            break;
        case cone_family::denormal:
            lattice(4);
            for (int i = 0; i < 14; ++i) *number_of(c, i) *= std::numeric_limits<T>::denorm_min();
            break;
        case cone_family::largest:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = largest_finite<T> / 4 * static_cast<T>(d.below(9) - 4);
            c.first_radius = std::fabs(c.first_radius) / 4, c.second_radius = std::fabs(c.second_radius) / 4;
            break;
        case cone_family::mixed_exponents:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = any_number<T>(d, 1 + d.below(60));
            c.first_radius = std::fabs(c.first_radius), c.second_radius = std::fabs(c.second_radius);
            break;
        case cone_family::all_bit_patterns:
            for (int i = 0; i < 14; ++i) *number_of(c, i) = any_pattern<T>(d);
            c.first_radius = std::fabs(c.first_radius), c.second_radius = std::fabs(c.second_radius);
            break;
    }
    return c;
}

}  // namespace abut::test
