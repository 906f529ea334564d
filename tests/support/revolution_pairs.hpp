// SPDX-License-Identifier: MIT
#pragma once

// Cylinders and cones beside three points, which are the corners of a triangle, the ends of a segment or a point. In general
// position, on lattices, touching exactly and within a step, of every size, degenerate.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <abut/arithmetic/limits.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

#include "draws.hpp"

namespace abut::test {

/// What breaks what: as in shape_families.hpp. In `tangent` the input is whole numbers, and edges, faces and corners touch
/// the side, a rim, an end or the apex; in `nudged` one number of such a pair is moved by a step. In `flat` edges and faces
/// lie in the planes of the ends or along the axis.
enum class revolution_family : int {
    random,
    offset,
    any_scale,
    lattice_2,
    lattice_5,
    upright_lattice,
    tangent,
    nudged,
    flat,
    surface_point,
    needle,
    degenerate,
    short_axis,
    no_length,
    denormal,
    largest,
    mixed_exponents,
    all_bit_patterns,
};
inline constexpr int revolution_family_count = 18;

template <scalar T>
struct revolution_case {
    segment<T> axis;
    T radius;
    vec3<T> corner[3];
};

namespace construction {

/// A number of any exponent in a range; of T's whole range where that is 0.
template <scalar T>
T any_number(draws& d, int half_range) {
    const double m = d.uniform(-1, 1);
    return rounded_to<T>(std::ldexp(m, d.below(2 * half_range + 1) - half_range));
}

template <scalar T>
T any_pattern(draws& d) {
    for (;;) {
        T x;
        if constexpr (std::same_as<T, float>) {
            x = from_bits(static_cast<std::uint32_t>(d.bits() >> 32));
        } else {
            x = from_bits(d.bits());
        }
        if (std::isfinite(x)) return x;
    }
}

/// Whole coordinates in a frame of three orthogonal axes of length 3 or 1, so that right angles and circles stay.
struct lattice_frame {
    int axis[3][3];
    int origin[3];

    explicit lattice_frame(draws& d) : axis{}, origin{} {
        constexpr int turned[3][3] = {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}};
        const bool tilted = d.below(2) == 0;
        const int first = d.below(3), step = 1 + d.below(2);
        for (int i = 0; i < 3; ++i) {
            const int row = (first + i * step) % 3;
            for (int k = 0; k < 3; ++k) axis[i][k] = tilted ? turned[row][k] : row == k ? 1 : 0;
        }
        for (int& x : origin) x = d.below(11) - 5;
    }
    template <scalar T>
    vec3<T> at(int x, int y, int z) const {
        const auto coordinate = [&](int k) {
            return static_cast<T>(origin[k] + x * axis[0][k] + y * axis[1][k] + z * axis[2][k]);
        };
        return {coordinate(0), coordinate(1), coordinate(2)};
    }
    /// What a length of 1 is; the axes are all as long.
    int unit() const { return axis[0][0] * axis[0][0] + axis[0][1] * axis[0][1] + axis[0][2] * axis[0][2] == 9 ? 3 : 1; }
};

/// Touching exactly, or about so: at height k of h over the first end the solid's radius is rho, a multiple of 5.
template <scalar T>
void tangent(draws& d, bool is_cone, revolution_case<T>& c) {
    constexpr int circle[12][2] = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                   {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
    const lattice_frame f(d);
    const int steps = 1 + d.below(4), rise = 1 + d.below(3), height = steps * rise, at = d.below(steps + 1);
    const int radius = is_cone ? steps : 1 + d.below(3), here = is_cone ? at : radius;
    c.axis = {f.at<T>(0, 0, 0), f.at<T>(0, 0, height)};
    c.radius = static_cast<T>(5 * radius * f.unit());
    const int* const u = circle[d.below(12)];
    const int x = here * u[0], y = here * u[1], z = at * rise;
    // A tangent of the circle there, and the side's line through it.
    const int tx = -u[1] / (u[0] % 5 == 0 ? 5 : 1), ty = u[0] / (u[0] % 5 == 0 ? 5 : 1);
    const int sx = is_cone ? u[0] : 0, sy = is_cone ? u[1] : 0, sz = is_cone ? rise : 1;
    const auto on_tangent_plane = [&](int a, int b) {
        return f.at<T>(x + a * tx + b * sx, y + a * ty + b * sy, z + b * sz);
    };
    const auto below = [&](int n) { return d.below(n); };
    const int kind = d.below(6);
    const int i = below(5) - 2, j = below(5) - 2, k = below(5) - 2, l = below(5) - 2;
    if (kind == 0) {  // a face in a tangent plane
        c.corner[0] = on_tangent_plane(i, j);
        c.corner[1] = on_tangent_plane(k, l);
        c.corner[2] = on_tangent_plane(-i - k, -j - l);
    } else if (kind == 1) {  // an edge in a tangent plane, a corner anywhere
        c.corner[0] = on_tangent_plane(i, j);
        c.corner[1] = on_tangent_plane(-i, -j);
        c.corner[2] = f.at<T>(x + u[0] * (1 + below(2)), y + u[1] * (1 + below(2)), z + k);
    } else if (kind == 2) {  // a corner on the side
        c.corner[0] = f.at<T>(x, y, z);
        c.corner[1] = f.at<T>(x + u[0] + i, y + u[1] + j, z + k);
        c.corner[2] = f.at<T>(x + u[0] + k, y + u[1] + l, z + i);
    } else if (kind == 3) {  // in or beside the plane of an end
        const int end = below(2) * height, off = below(4) == 0 ? (end == 0 ? -1 : 1) : 0;
        c.corner[0] = f.at<T>(x + i, y + j, end + off);
        c.corner[1] = f.at<T>(x + u[0] + k, y + u[1] + l, end + off);
        c.corner[2] = f.at<T>(2 * u[0] + i, 2 * u[1] + k, end + off + (below(2) == 0 ? 0 : end == 0 ? -2 : 2));
    } else if (kind == 4) {  // a plane that touches the rim of an end, or the apex, alone
        const int end = below(2) * height, out = end == 0 && is_cone ? 0 : radius, up = end == 0 ? -1 : 1;
        const int rx = out * u[0], ry = out * u[1];
        c.corner[0] = f.at<T>(rx + 2 * tx, ry + 2 * ty, end);
        c.corner[1] = f.at<T>(rx - (1 + below(3)) * tx, ry - (1 + below(3)) * ty, end);
        c.corner[2] = f.at<T>(rx - 3 * i * u[0], ry - 3 * i * u[1], end + up * (1 + below(4)));
    } else {  // across the axis
        c.corner[0] = f.at<T>(0, 0, z + (below(3) - 1) * height);
        c.corner[1] = f.at<T>(i * 9, j * 9, z);
        c.corner[2] = f.at<T>(-k * 9, -l * 9, z + below(3) - 1);
    }
    // Any corner first.
    const int turn = below(3);
    for (int n = 0; n < turn; ++n) {
        const vec3<T> first = c.corner[0];
        c.corner[0] = c.corner[1];
        c.corner[1] = c.corner[2];
        c.corner[2] = first;
    }
}

template <scalar T>
T* number_of(revolution_case<T>& c, int i) {
    vec3<T>* const points[] = {&c.axis.a, &c.axis.b, &c.corner[0], &c.corner[1], &c.corner[2]};
    if (i == 15) return &c.radius;
    vec3<T>& p = *points[i / 3];
    return i % 3 == 0 ? &p.x : i % 3 == 1 ? &p.y : &p.z;
}

}  // namespace construction

template <scalar T>
revolution_case<T> make_revolution_case(std::uint64_t seed, revolution_family f, std::uint64_t k, bool is_cone) {
    using namespace construction;
    draws d(seed, static_cast<std::uint64_t>(f) * 2 + (is_cone ? 1 : 0), k);
    revolution_case<T> c{};
    const auto general = [&](double scale, const point& offset) {
        c.axis = {round_to<T>(along(offset, scale, cube(d, 1))), round_to<T>(along(offset, scale, cube(d, 1)))};
        c.radius = rounded_to<T>(scale * d.power_of_ten(-2, 0));
        const double size = scale * d.power_of_ten(-1, 1);
        const point on_axis = along(widened(c.axis.a), d.uniform(0, 1), along(widened(c.axis.b), -1, widened(c.axis.a)));
        const point middle = along(on_axis, size, cube(d, 1));
        for (vec3<T>& p : c.corner) p = round_to<T>(along(middle, size, cube(d, 1)));
    };
    const auto lattice = [&](int n) {
        for (int i = 0; i < 15; ++i) *number_of(c, i) = static_cast<T>(d.below(2 * n + 1) - n);
        c.radius = static_cast<T>(d.below(2 * n)) / 2;
    };
    const auto collapse = [&] {
        const int kind = d.below(4);
        if (kind == 0) c.corner[1] = c.corner[2] = c.corner[0];
        if (kind == 1) c.corner[1] = c.corner[0];
        if (kind == 2) c.corner[2] = c.corner[1];
        if (kind == 3) c.corner[2] = (c.corner[1] - c.corner[0]) + c.corner[1];
    };
    switch (f) {
        case revolution_family::random:
            general(1, {0, 0, 0});
            break;
        case revolution_family::offset:
            general(1, cube(d, d.power_of_ten(1, 6)));
            break;
        case revolution_family::any_scale:
            general(std::same_as<T, float> ? d.power_of_ten(-36, 36) : d.power_of_ten(-36, 36) * d.power_of_ten(-36, 36),
                    {0, 0, 0});
            break;
        case revolution_family::lattice_2:
            lattice(2);
            break;
        case revolution_family::lattice_5:
            lattice(5);
            break;
        case revolution_family::upright_lattice:
            lattice(3);
            c.axis.b = c.axis.a;
            *number_of(c, 3 + d.below(3)) += static_cast<T>(d.below(7) - 3);
            break;
        case revolution_family::tangent:
            tangent(d, is_cone, c);
            break;
        case revolution_family::nudged: {
            tangent(d, is_cone, c);
            T& x = *number_of(c, d.below(16));
            x = std::nextafter(x, d.below(2) == 0 ? T(-1e30) : T(1e30));
            if (c.radius < 0) c.radius = 0;
            break;
        }
        case revolution_family::flat: {
            general(1, {0, 0, 0});
            const int axis = d.below(3), end = d.below(2);
            for (int i = 0; i < 2; ++i) {
                if (i != axis) *number_of(c, 3 + i) = *number_of(c, i);
            }
            if (axis != 2) c.axis.b.z = c.axis.a.z;
            if (axis == 2) c.axis.b = {c.axis.a.x, c.axis.a.y, c.axis.b.z};
            const T level = *number_of(c, 3 * end + axis);
            const int count = 1 + d.below(3);
            for (int i = 0; i < count; ++i) *number_of(c, 6 + 3 * i + axis) = level;
            break;
        }
        case revolution_family::surface_point: {
            general(1, {0, 0, 0});
            const point a = widened(c.axis.a), e = along(widened(c.axis.b), -1, a);
            const double t = d.below(4) == 0 ? d.below(2) : d.uniform(0, 1), r = static_cast<double>(c.radius);
            const point away = unit(cross_product(e, cube(d, 1)));
            const point x = along(along(a, t, e), is_cone ? t * r : r, away);
            const int kind = d.below(3);
            const point v = cube(d, 1), w = d.below(2) == 0 ? cross_product(away, v) : cube(d, 1);
            if (kind == 0) c.corner[0] = round_to<T>(x);
            if (kind >= 1) c.corner[0] = round_to<T>(along(x, 1, w)), c.corner[1] = round_to<T>(along(x, -0.5, w));
            if (kind == 2) c.corner[2] = round_to<T>(along(x, d.uniform(-1, 1), cross_product(away, w)));
            break;
        }
        case revolution_family::needle: {
            general(1, {0, 0, 0});
            c.corner[2] = round_to<T>(along(widened(c.corner[1]), d.power_of_ten(-9, -3), cube(d, 1)));
            break;
        }
        case revolution_family::degenerate:
            if (d.below(2) == 0) {
                general(1, {0, 0, 0});
            } else {
                tangent(d, is_cone, c);
            }
            collapse();
            if (d.below(4) == 0) c.radius = 0;
            break;
        case revolution_family::short_axis:
            general(1, {0, 0, 0});
            c.axis.b = round_to<T>(along(widened(c.axis.a), d.power_of_ten(-8, -1), cube(d, 1)));
            break;
        case revolution_family::no_length:
            if (d.below(2) == 0) {
                general(1, {0, 0, 0});
            } else {
                lattice(3);
            }
            c.axis.b = c.axis.a;
            break;
        case revolution_family::denormal:
            lattice(4);
            for (int i = 0; i < 16; ++i) *number_of(c, i) *= std::numeric_limits<T>::denorm_min();
            break;
        case revolution_family::largest:
            for (int i = 0; i < 16; ++i) {
                *number_of(c, i) = largest_finite<T> / 4 * static_cast<T>(d.below(9) - 4);
            }
            c.radius = c.radius < 0 ? -c.radius : c.radius;
            break;
        case revolution_family::mixed_exponents:
            for (int i = 0; i < 16; ++i) *number_of(c, i) = any_number<T>(d, 1 + d.below(60));
            c.radius = c.radius < 0 ? -c.radius : c.radius;
            break;
        case revolution_family::all_bit_patterns:
            for (int i = 0; i < 16; ++i) *number_of(c, i) = any_pattern<T>(d);
            c.radius = c.radius < 0 ? -c.radius : c.radius;
            break;
    }
    return c;
}

/// A ball with the first corner for its centre, that is about as large as far from a feature of the solid; of whole numbers,
/// exactly.
template <scalar T>
sphere<T> ball_beside(const revolution_case<T>& c, bool is_cone, std::uint64_t k) {
    using namespace construction;
    const point p = widened(c.axis.a), e = along(widened(c.axis.b), -1, p), center = widened(c.corner[0]);
    const point w = along(center, -1, p), v = along(center, -1, widened(c.axis.b));
    const double height = length(e), x = product(w, e) / height, y = length(cross_product(w, e)) / height,
                 r = static_cast<double>(c.radius);
    double reach = 0;
    switch (k % 8) {
        case 0:
            reach = x > height ? x - height : -x;
            break;
        case 1:
            reach = y - r;
            break;
        case 2:
            reach = std::sqrt((y - r) * (y - r) + (x - height) * (x - height));
            break;
        case 3:
            reach =
                is_cone ? (y * height - x * r) / std::sqrt(height * height + r * r) : std::sqrt((y - r) * (y - r) + x * x);
            break;
        case 4:
            reach = length(w);
            break;
        case 5:
            reach = length(v);
            break;
        case 6:
            return {c.corner[0], std::fabs(c.corner[1].x / 2 - c.corner[1].y / 2)};
        default:
            return {c.corner[0], std::fabs(c.corner[1].x)};
    }
    T radius = rounded_to<T>(std::fabs(reach));
    if (!(radius <= largest_finite<T>)) radius = T(1);
    const std::uint64_t step = k / 8 % 3;
    return {c.corner[0], step == 0 || radius == 0 ? radius : std::nextafter(radius, step == 1 ? T(0) : largest_finite<T>)};
}

/// A plane through the corners, or the first of them, whose numbers are rounded.
template <scalar T>
plane<T> plane_beside(const revolution_case<T>& c, std::uint64_t k) {
    const vec3<T> e = c.corner[1] - c.corner[0], f = c.corner[2] - c.corner[0];
    vec3<T> n = k % 4 == 0 ? c.corner[1] : cross(e, f);
    const T offset = k % 8 == 1 ? c.corner[2].x : dot(n, c.corner[0]);
    if (k % 16 == 2) n = {T(0), T(0), T(0)};
    const plane<T> p{n, offset};
    return is_valid(p) ? p : plane<T>{c.corner[1], c.corner[2].x};
}

/// A cylinder between the first two corners: about as thick as the first is far from a feature of the solid, or as anything.
template <scalar T>
cylinder<T> cylinder_beside(const revolution_case<T>& c, bool is_cone, std::uint64_t k) {
    const T radius = k % 2 == 0 ? ball_beside(c, is_cone, k / 2).radius : std::fabs(c.corner[2].x / 4);
    return {{c.corner[0], c.corner[1]}, radius};
}

inline const char* name_of(revolution_family f) {
    constexpr const char* names[revolution_family_count] = {
        "random",     "offset",    "any scale", "lattice 2",     "lattice 5",       "upright lattice",
        "tangent",    "nudged",    "flat",      "surface point", "needle",          "degenerate",
        "short axis", "no length", "denormal",  "largest",       "mixed exponents", "all bit patterns"};
    return names[static_cast<int>(f)];
}

template <class Solid>
Solid solid_of(const segment<scalar_type_of<Solid>>& axis, scalar_type_of<Solid> radius) {
    if constexpr (requires(Solid s) { s.apex; }) {
        return {axis.a, axis.b, radius};
    } else {
        return {axis, radius};
    }
}

/// What tests put beside a cylinder or a cone, by name and in the order of each_beside.
inline constexpr std::array<const char*, 6> kinds_beside{"points", "segments", "triangles", "boxes", "balls", "planes"};

/// f(kind, shape) of one of each kind beside case k.
template <scalar T, class F>
void each_beside(const revolution_case<T>& c, std::uint64_t k, bool is_cone, const F& f) {
    const triangle<T> t{c.corner[0], c.corner[1], c.corner[2]};
    const segment<T> side{t.a, t.b};
    f(std::size_t{0}, t.a);
    f(std::size_t{1}, side);
    f(std::size_t{2}, t);
    f(std::size_t{3}, k % 2 == 0 ? bounds(t) : bounds(side));
    f(std::size_t{4}, ball_beside(c, is_cone, k));
    f(std::size_t{5}, plane_beside(c, k));
}

}  // namespace abut::test
