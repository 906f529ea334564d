// SPDX-License-Identifier: MIT
#pragma once

// Pairs of shapes at the extremes of what floating point can hold, in steps: the same pairs scaled, moved away, flattened,
// snapped to a lattice, spread over many exponents, or mixed with pairs that the first stages leave open. Most pairs of
// the first five are close to touching, so that no step is easy. A pair is a pure function of (seed, step, index), on hosts
// and devices alike and bit for bit; draws.hpp says how.

#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/config.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/moving_shape.hpp>
#include <abut/shape/primitive.hpp>

#include "draws.hpp"
#include "shape_families.hpp"
#include "triangle_families.hpp"

namespace abut::test {

/// What is taken to an extreme, and what the value of a step stands for.
enum class extreme : int {
    scaled,      // the size of the cube that all is in; what is too large for the scalar becomes its largest number
    moved,       // how many of its sizes the cube is from the origin
    flattened,   // how thin all is in one direction, which no axis has
    snapped,     // into how many cells the cube is divided
    spread,      // how many binary exponents coordinates are spread over
    undecided,   // the share of ties: in contact, by integers below 2^21
    unresolved,  // the share of near ties: 2^-140 from contact, where the size is 1
};

inline constexpr extreme extremes[] = {extreme::scaled, extreme::moved,     extreme::flattened, extreme::snapped,
                                       extreme::spread, extreme::undecided, extreme::unresolved};

/// On the host only.
inline const char* name_of(extreme e) {
    constexpr const char* names[] = {"scaled", "moved", "flattened", "snapped", "spread", "undecided", "unresolved"};
    return names[static_cast<int>(e)];
}

struct extreme_step {
    extreme what;
    double value;
};

/// The values of an extreme, from one end of the scalar's range to the other where it is the range that counts.
template <scalar T>
std::vector<extreme_step> steps_of(extreme what) {
    constexpr bool is_float = sizeof(T) == 4;
    std::vector<double> values;
    switch (what) {
        case extreme::scaled:
            if (is_float) {
                values = {1e-45, 1e-40, 1e-37, 1e-31, 1e-25, 1e-19, 1e-13, 1e-7, 1e-3, 1,
                          1e3,   1e7,   1e10,  1e13,  1e17,  1e19,  1e25,  1e31, 1e36, 1e38};
            } else {
                values = {1e-323, 1e-320, 1e-307, 1e-280, 1e-240, 1e-200, 1e-160, 1e-120, 1e-80, 1e-40, 1,
                          1e40,   1e80,   1e100,  1e120,  1e153,  1e160,  1e200,  1e240,  1e280, 1e307, 1e308};
            }
            break;
        case extreme::moved:
            values = {0, 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
            break;
        case extreme::flattened:
            values = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
            break;
        case extreme::snapped:
            values = {2, 4, 16, 256, 0x1p12, 0x1p16, 0x1p20, 0x1p30};
            break;
        case extreme::spread:
            values = {0, 8, 16, 32, 64, 96, 124, 160, 200, 250};
            if (!is_float) values.insert(values.end(), {300, 400, 600, 1000, 1500, 2000});
            break;
        case extreme::undecided:
        case extreme::unresolved:
            values = {0, 0.01, 0.1, 0.25, 0.5, 0.75, 1};
            break;
    }
    std::vector<extreme_step> steps;
    for (const double value : values) steps.push_back({what, value});
    return steps;
}

/// A question about two shapes.
template <class S, class U>
struct pair_of {
    S a;
    U b;
};

/// Of which a hull is made where it is asked about.
template <scalar T>
struct four_points {
    vec3<T> at[4];
};

/// What predicates are asked about.
template <class S>
ABUT_HD const S& shape_of(const S& s) {
    return s;
}
template <scalar T>
ABUT_HD hull<T> shape_of(const four_points<T>& s) {
    return {s.at, 4};
}

namespace construction {

/// p, q, or what is between.
ABUT_HD inline point between(const point& p, const point& q, double t) { return along(p, t, along(q, -1, p)); }

/// 2^k for |k| up to 1022.
ABUT_HD inline double power_of_two(int k) { return from_bits(static_cast<std::uint64_t>(1023 + k) << 52); }

/// Where a step puts what was made in the cube from -1 to 1: `formed` first, then `placed`, which rounds once.
class extreme_frame {
public:
    ABUT_HD extreme_frame(draws& d, const extreme_step& step) : step_(step) {
        by_axes_ = d.below(2) == 0;
        for (int& k : of_axis_) k = exponent(d);
    }

    /// Still in the cube.
    [[nodiscard]] ABUT_HD point formed(const point& p) const {
        if (step_.what == extreme::flattened) {
            const point n{0.36, -0.48, 0.8};  // of length 1, but for rounding
            return along(p, product(p, n) * (1 / step_.value - 1), n);
        }
        return {snapped(p.x), snapped(p.y), snapped(p.z)};
    }
    [[nodiscard]] ABUT_HD double formed(double length) const { return snapped(length); }

    template <scalar T>
    [[nodiscard]] ABUT_HD vec3<T> placed(draws& d, const point& p) const {
        if (step_.what == extreme::moved) return round_to<T>(along(p, step_.value, {2, -2, 1}));
        const double x = scaled(d, p.x, 0), y = scaled(d, p.y, 1), z = scaled(d, p.z, 2);
        return {limited<T>(x), limited<T>(y), limited<T>(z)};
    }
    /// Not negative.
    template <scalar T>
    [[nodiscard]] ABUT_HD T placed(draws& d, double length) const {
        return limited<T>(scaled(d, length, 0));
    }

    template <scalar T>
    [[nodiscard]] ABUT_HD static T limited(double x) {
        constexpr auto most = static_cast<double>(largest_number<T>);
        return rounded_to<T>(x < -most ? -most : x > most ? most : x);
    }

private:
    [[nodiscard]] ABUT_HD int exponent(draws& d) const {
        if (step_.what != extreme::spread) return 0;
        const int most = static_cast<int>(step_.value);
        return most / 2 - d.below(most + 1);
    }
    [[nodiscard]] ABUT_HD double snapped(double x) const {
        return step_.what == extreme::snapped ? std::floor(std::fma(x, step_.value, 0.5)) / step_.value : x;
    }
    [[nodiscard]] ABUT_HD double scaled(draws& d, double x, int axis) const {
        if (step_.what == extreme::scaled) return x * step_.value;
        if (step_.what == extreme::spread) return x * power_of_two(by_axes_ ? of_axis_[axis] : exponent(d));
        return x;
    }

    extreme_step step_;
    bool by_axes_;  ///< one exponent for each axis, which keeps contacts; else one for each coordinate
    int of_axis_[3] = {0, 0, 0};
};

/// Whether the next pair is one of the step's ties.
ABUT_HD inline bool is_tie(draws& d, const extreme_step& step) {
    const double drawn = d.uniform(0, 1);
    return step.what >= extreme::undecided && drawn < step.value;
}

/// Which of four constructions is next: 0 is of points anywhere, which is all that is beside ties.
ABUT_HD inline int kind_of(draws& d, const extreme_step& step) {
    const int drawn = d.below(4);
    return step.what >= extreme::undecided ? 0 : drawn;
}

/// Points of a tie, by two coordinates in a plane and the height over it, all relative to the place of contact.
template <scalar T>
class tie_frame {
public:
    ABUT_HD tie_frame(draws& d, const extreme_step& step)
        : near_(step.what == extreme::unresolved),
          axis_(d.below(3)),
          at_{d.below(1 << 18), d.below(1 << 18), d.below(1 << 18)} {
        gap_ = near_ ? (d.below(2) == 0 ? -0x1p-140 : 0x1p-140) : 0.0;
    }

    /// With one unit in 2^20; where the gap is, the plane is at height 0 and all else in that unit as well.
    [[nodiscard]] ABUT_HD vec3<T> at(int u, int v, int height) const {
        const double x = (at_[0] + u) * 0x1p-20, y = (at_[1] + v) * 0x1p-20, z = ((near_ ? 0 : at_[2]) + height) * 0x1p-20;
        return turned(x, y, z);
    }
    /// In the plane, but for the gap: below, or above.
    [[nodiscard]] ABUT_HD vec3<T> near(int u, int v) const {
        const vec3<T> p = at(u, v, 0);
        if (!near_) return p;
        const double x = (at_[0] + u) * 0x1p-20, y = (at_[1] + v) * 0x1p-20;
        return turned(x, y, gap_);
    }
    [[nodiscard]] ABUT_HD static T length(int units) { return static_cast<T>(units * 0x1p-20); }

private:
    [[nodiscard]] ABUT_HD vec3<T> turned(double x, double y, double z) const {
        const T a = static_cast<T>(x), b = static_cast<T>(y), c = static_cast<T>(z);
        return axis_ == 0 ? vec3<T>{a, b, c} : axis_ == 1 ? vec3<T>{c, a, b} : vec3<T>{b, c, a};
    }

    bool near_;
    int axis_, at_[3];
    double gap_;
};

/// A triangle in the plane of the tie, around the place of contact.
template <scalar T>
ABUT_HD triangle<T> around_tie(draws& d, const tie_frame<T>& f) {
    constexpr int quarter = 1 << 16;
    const int m = 4 * quarter + d.below(4 * quarter), p = d.below(quarter), q = d.below(quarter), r = d.below(quarter);
    return {f.at(m, p, 0), f.at(-m, q, 0), f.at(r, -m, 0)};
}

/// Where two shapes touch, for `touching_from`. In ties all that is made there has coordinates of whole units of 2^-20; in
/// near ties, what is in the plane of contact is a gap away from 0 in one of them, or of what is round the centre or axis.
ABUT_HD inline contact_frame extreme_contact(draws& d, const extreme_step& step, bool tie, int up) {
    if (!tie) {
        const point at = cube(d, 0.5), n = unit(cube(d, 1)), u = unit(cross_product(n, cube(d, 1))), v = cross_product(n, u);
        const double height = d.uniform(0.01, 0.2), width = d.uniform(0.01, 0.2), depth = d.uniform(0.01, 0.2);
        const point zero{0, 0, 0};
        contact_frame c{at, along(zero, height, n), along(zero, width, u), along(zero, depth, v), height, height};
        if (step.what == extreme::flattened) {
            const extreme_frame f(d, step);
            c.at = f.formed(c.at), c.u = f.formed(c.u), c.v = f.formed(c.v);
            const point across = cross_product(c.u, c.v);
            c.normal = along(zero, height * width * depth / (step.value * product(across, across)), across);
            c.length = c.unit = length(c.normal);
        }
        return c;
    }
    contact_frame c = any_contact_frame(d, 0);
    c.unit = (1 + d.below(1 << 12)) * 0x1p-20;
    c.length *= c.unit;
    for (point* const p : {&c.normal, &c.u, &c.v}) *p = along({0, 0, 0}, c.unit, *p);
    const int x = d.below(1 << 18), y = d.below(1 << 18), z = d.below(1 << 18);
    c.at = along({0, 0, 0}, 0x1p-20, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    if (step.what == extreme::unresolved) {
        constexpr point axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        int k = d.below(3);
        while (product(c.normal, axes[k]) == 0) k = (k + 1) % 3;
        const point& axis = axes[k];
        if (product(c.u, axis) != 0 || product(c.v, axis) != 0) c.u = c.v = cross_product(c.normal, axis);
        c.at = along(c.at, up * product(c.normal, axis) - product(c.at, axis), axis);
        c.gap = along({0, 0, 0}, d.below(2) == 0 ? -0x1p-140 : 0x1p-140, axis);
    }
    return c;
}

/// Shapes of doubles, where the step puts them.
template <scalar T>
class shape_placer {
public:
    ABUT_HD shape_placer(draws& d, const extreme_step& step) : d_(d), frame_(d, step) {}

    ABUT_HD vec3<T> operator()(const point& p) const {
        return frame_.template placed<T>(d_, {frame_.formed(p.x), frame_.formed(p.y), frame_.formed(p.z)});
    }
    ABUT_HD T operator()(double length) const { return frame_.template placed<T>(d_, frame_.formed(length)); }
    ABUT_HD segment<T> operator()(const segment<double>& s) const { return {(*this)(s.a), (*this)(s.b)}; }
    ABUT_HD triangle<T> operator()(const triangle<double>& t) const { return {(*this)(t.a), (*this)(t.b), (*this)(t.c)}; }
    ABUT_HD aabb<T> operator()(const aabb<double>& b) const {
        const vec3<T> lower = (*this)(b.lower);  // before the other one: both draw
        return box_of(lower, (*this)(b.upper));
    }
    ABUT_HD sphere<T> operator()(const sphere<double>& s) const { return {(*this)(s.center), (*this)(s.radius)}; }
    ABUT_HD capsule<T> operator()(const capsule<double>& s) const { return {(*this)(s.axis), (*this)(s.radius)}; }

    /// A shape that touches the frame's point, as `touching_from` says.
    template <template <class> class S>
    ABUT_HD S<T> touching(const contact_frame& c, int side, int up) const {
        if constexpr (std::same_as<S<T>, plane<T>>) {  // through that point after rounding, or nearly
            const vec3<T> normal = round_to<T>(touching_from<plane<double>>(d_, c, side, up).normal), at = (*this)(c.at);
            return {normal, extreme_frame::limited<T>(product(widened(normal), widened(at)))};
        } else if constexpr (std::same_as<S<T>, ray<T>>) {
            const auto way = [](T x, T y) { return y - x - (y - x) == 0 ? y - x : y / 2 - x / 2; };
            const segment<T> s = touching<segment>(c, side, up);
            return {s.a, {way(s.a.x, s.b.x), way(s.a.y, s.b.y), way(s.a.z, s.b.z)}};
        } else if constexpr (std::same_as<S<T>, four_points<T>>) {
            const segment<T> s = touching<segment>(c, side, up), t = touching<segment>(c, side, up);
            return {{s.a, s.b, t.a, t.b}};
        } else {
            return (*this)(touching_from<S<double>>(d_, c, side, up));
        }
    }

private:
    draws& d_;
    extreme_frame frame_;
};

}  // namespace construction

/// The kinds of pairs: `make` draws one.
struct extreme_triangles {
    static std::string name() { return "triangle_triangle"; }
    static constexpr bool moving = false;

    template <scalar T>
    ABUT_HD static pair_of<triangle<T>, triangle<T>> make(draws& d, const extreme_step& step) {
        using namespace construction;
        if (is_tie(d, step)) {
            const tie_frame<T> f(d, step);
            const triangle<T> flat = around_tie(d, f);
            const vec3<T> tip = f.near(0, 0);
            const int u = d.below(1 << 19), v = d.below(1 << 19), h = 1 + d.below(1 << 19), k = 1 + d.below(1 << 19);
            return {{f.at(u, -v, h), tip, f.at(-v, u, k)}, flat};
        }
        const int kind = kind_of(d, step);
        const auto unit_pair = kind == 0   ? triangles::random_pair<double>(d, 1, 0)
                               : kind == 1 ? triangles::edge_edge_pair<double>(d)
                                           : triangles::vertex_face_pair<double>(d);
        const extreme_frame f(d, step);
        const point* const from[] = {&unit_pair.a.a, &unit_pair.a.b, &unit_pair.a.c,
                                     &unit_pair.b.a, &unit_pair.b.b, &unit_pair.b.c};
        vec3<T> p[6];
        for (int i = 0; i < 6; ++i) p[i] = f.placed<T>(d, f.formed(*from[i]));
        return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
    }
};

struct extreme_balls {
    static std::string name() { return "sphere_triangle"; }
    static constexpr bool moving = false;

    template <scalar T>
    ABUT_HD static pair_of<sphere<T>, triangle<T>> make(draws& d, const extreme_step& step) {
        using namespace construction;
        if (is_tie(d, step)) {
            const tie_frame<T> f(d, step);
            const triangle<T> flat = around_tie(d, f);
            const int h = 1 + d.below(1 << 15);
            if (step.what == extreme::undecided) return {{f.at(0, 0, h), f.length(h)}, flat};
            // One corner tells the planes apart: a ball around it touches, or not quite.
            const vec3<T> tip = f.near(0, 0);
            return {{f.at(0, 0, h), f.length(h)}, {tip, f.at(2 * h, h, -h), f.at(-h, 2 * h, -h)}};
        }
        const extreme_frame f(d, step);
        const point a = f.formed(cube(d, 1)), b = f.formed(cube(d, 1)), c = f.formed(cube(d, 1));
        const int kind = kind_of(d, step);
        const double u = kind == 1 ? 0.0 : d.uniform(0, 1), v = kind == 1 ? 0.0 : d.uniform(0, 1 - u);
        const point foot = along(along(a, u, along(b, -1, a)), v, along(c, -1, a));
        const point normal = cross_product(along(b, -1, a), along(c, -1, a));
        const double size = length(normal), distance = d.uniform(0.01, 0.5);
        point direction = cube(d, 1);
        if (kind > 1 && size > 0) direction = {normal.x / size, normal.y / size, normal.z / size};
        const point center = f.formed(kind == 0 ? direction : along(foot, distance, direction));
        const double away = kind == 0 ? distance : length(along(center, -1, foot));
        const T radius = f.placed<T>(d, f.formed(away));
        const int steps = d.below(3) - 1;
        const T near = radius > T(0) && radius < largest_number<T> ? stepped(radius, steps) : radius;
        const auto at = f.placed<T>(d, center), p = f.placed<T>(d, a), q = f.placed<T>(d, b), r = f.placed<T>(d, c);
        return {{at, near}, {p, q, r}};
    }
};

struct extreme_vertex_face {
    static std::string name() { return "vertex_face"; }
    static constexpr bool moving = true;

    template <scalar T>
    ABUT_HD static pair_of<abut::motion<vec3<T>>, abut::motion<triangle<T>>> make(draws& d, const extreme_step& step) {
        using namespace construction;
        if (is_tie(d, step)) {
            const tie_frame<T> f(d, step);
            const triangle<T> flat = around_tie(d, f);
            const vec3<T> tip = f.near(0, 0), away = f.at(d.below(1 << 18), d.below(1 << 18), 1 + d.below(1 << 19));
            return step.what == extreme::undecided
                       ? pair_of<abut::motion<vec3<T>>, abut::motion<triangle<T>>>{{tip, away}, {flat, flat}}
                       : pair_of<abut::motion<vec3<T>>, abut::motion<triangle<T>>>{{away, tip}, {flat, flat}};
        }
        point p[8];
        for (point& x : p) x = cube(d, 1);
        const int kind = kind_of(d, step);
        const double time = d.uniform(0, 1), tau = kind == 1 ? 0.0 : kind == 2 ? 1.0 : time;
        const double u = d.uniform(0, 1), v = d.uniform(0, 1 - u);
        if (kind != 0) {  // the vertex comes by a point of the face at tau
            const point a = between(p[1], p[5], tau), b = between(p[2], p[6], tau), c = between(p[3], p[7], tau);
            const point met = along(along(a, u, along(b, -1, a)), v, along(c, -1, a)), velocity = p[0];
            p[0] = along(met, -tau, velocity);
            p[4] = along(met, 1 - tau, velocity);
        }
        const extreme_frame f(d, step);
        vec3<T> q[8];
        for (int i = 0; i < 8; ++i) q[i] = f.placed<T>(d, f.formed(p[i]));
        return {{q[0], q[4]}, {{q[1], q[2], q[3]}, {q[5], q[6], q[7]}}};
    }
};

struct extreme_edges {
    static std::string name() { return "edge_edge"; }
    static constexpr bool moving = true;

    template <scalar T>
    ABUT_HD static pair_of<abut::motion<segment<T>>, abut::motion<segment<T>>> make(draws& d, const extreme_step& step) {
        using namespace construction;
        if (is_tie(d, step)) {
            const tie_frame<T> f(d, step);
            const int u = 1 + d.below(1 << 18), v = d.below(1 << 17), w = 1 + d.below(1 << 18), h = 1 + d.below(1 << 19);
            const segment<T> rest{f.at(u, v, 0), f.at(-u, -v, 0)};
            const segment<T> near{f.near(v, -w), f.near(-v, w)}, away{f.at(v, -w, h), f.at(-v, w, h)};
            if (step.what == extreme::undecided) return {{near, away}, {rest, rest}};
            return {{away, near}, {rest, rest}};
        }
        point p[8];
        for (point& x : p) x = cube(d, 1);
        const int kind = kind_of(d, step);
        const double time = d.uniform(0, 1), tau = kind == 1 ? 0.0 : kind == 2 ? 1.0 : time;
        const double u = d.uniform(0, 1), v = d.uniform(0, 1);
        if (kind != 0) {  // the first edge is moved so that the two cross at tau
            const point from = between(between(p[0], p[1], u), between(p[4], p[5], u), tau);
            const point to = between(between(p[2], p[3], v), between(p[6], p[7], v), tau);
            const point shift = along(to, -1, from);
            for (const int i : {0, 1, 4, 5}) p[i] = along(p[i], 1, shift);
        }
        const extreme_frame f(d, step);
        vec3<T> q[8];
        for (int i = 0; i < 8; ++i) q[i] = f.placed<T>(d, f.formed(p[i]));
        return {{{q[0], q[1]}, {q[4], q[5]}}, {{q[2], q[3]}, {q[6], q[7]}}};
    }
};

/// On the host only.
template <template <class> class S>
std::string word_of() {
    using shape = S<double>;
    return std::same_as<shape, vec3<double>>     ? "point"
           : std::same_as<shape, ray<double>>      ? "ray"
           : std::same_as<shape, segment<double>>  ? "segment"
           : std::same_as<shape, triangle<double>> ? "triangle"
           : std::same_as<shape, plane<double>>    ? "plane"
           : std::same_as<shape, sphere<double>>   ? "sphere"
           : std::same_as<shape, capsule<double>>  ? "capsule"
           : std::same_as<shape, aabb<double>>     ? "box"
                                                     : "hull";
}

/// Two shapes that touch in a point, or nearly; or some that lie anywhere. Of near ties both have the gap, or one alone.
template <template <class> class S, template <class> class U>
struct extreme_contacts {
    static std::string name() { return word_of<S>() + '_' + word_of<U>(); }
    static constexpr bool moving = false;

    template <scalar T>
    ABUT_HD static pair_of<S<T>, U<T>> make(draws& d, const extreme_step& step) {
        using namespace construction;
        const bool tie = is_tie(d, step), apart = !tie && kind_of(d, step) == 0;
        const int up = 1 + d.below(3);
        contact_frame above = extreme_contact(
                          d, step, tie, requires { U<T>{}.radius; } ? up : 0),
                      below = above;
        if (d.below(2) == 0) above.gap = {0, 0, 0};
        if (apart) below = extreme_contact(d, step, false, up);
        const shape_placer<T> place(d, step);
        const auto a = place.template touching<S>(above, 1, 1 + d.below(3));
        return {a, place.template touching<U>(below, -1, up)};
    }
};

template <class... Kinds>
struct kind_list {};
using first_extreme_kinds = kind_list<extreme_triangles, extreme_balls, extreme_vertex_face, extreme_edges>;
using other_extreme_kinds =
    kind_list<extreme_contacts<aabb, triangle>, extreme_contacts<plane, triangle>, extreme_contacts<capsule, triangle>,
              extreme_contacts<segment, triangle>, extreme_contacts<vec3, triangle>, extreme_contacts<ray, triangle>,
              extreme_contacts<sphere, sphere>, extreme_contacts<aabb, capsule>, extreme_contacts<aabb, segment>>;
/// Of shapes whose points lie elsewhere: not for a kernel that makes its own pairs.
using hull_extreme_kinds = kind_list<extreme_contacts<four_points, four_points>>;

template <class... Kinds, class F>
void for_each_kind(kind_list<Kinds...>, const F& f) {
    (f(Kinds{}), ...);
}

/// Pair `index` of a step.
template <class Kind, scalar T>
ABUT_HD auto make_extreme_pair(std::uint64_t seed_value, const extreme_step& step, std::uint64_t index) {
    draws d(seed_value, static_cast<std::uint64_t>(step.what) << 32 | static_cast<std::uint64_t>(sizeof(T)), index);
    return Kind::template make<T>(d, step);
}

}  // namespace abut::test
