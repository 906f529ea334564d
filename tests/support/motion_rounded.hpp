// SPDX-License-Identifier: MIT
#pragma once

// Constructions for the families of moving pairs whose coordinates are rounded, and for those at the ends of the number
// range. They are built from differences, as motion_exact.hpp says.

#include <cmath>
#include <cstdint>

#include <abut/config.hpp>

#include "draws.hpp"
#include "motion.hpp"
#include "motion_exact.hpp"

namespace abut::test::construction::motions {

/// Differences that have the origin in their hull at tau, and a motion through it. `border` puts it near an edge or a
/// corner.
ABUT_HD inline relative crossing(draws& d, double speed, double tau, bool border) {
    point x[3], v[3];
    for (point& p : x) p = cube(d, 1);
    for (point& p : v) p = cube(d, speed);
    double weight[3];
    for (double& w : weight) w = d.uniform(0.05, 1);
    if (border) {
        const int which = d.below(3);
        const double size = d.below(3) == 0 ? 0 : d.power_of_ten(-17, -4);
        weight[which] = d.below(2) == 0 ? -size : size;
    }
    const double sum = weight[0] + weight[1] + weight[2];
    point foot{0, 0, 0};
    for (int i = 0; i < 3; ++i) foot = along(foot, weight[i] / sum, x[i]);
    relative r;
    for (int i = 0; i < 3; ++i) {
        const point at_tau = along(x[i], -1, foot);
        r.w0[i] = along(at_tau, -tau, v[i]);
        r.w1[i] = along(at_tau, 1 - tau, v[i]);
    }
    return r;
}

/// At a place of which the size is given, and moving by `speed`.
template <scalar T>
ABUT_HD motion<T> rounded_pair(draws& d, motion_kind kind, const relative& r, double place, double speed, double size) {
    const point o0 = cube(d, place), o1 = along(o0, 1, cube(d, speed));
    relative scaled = r;
    for (int i = 0; i < 6; ++i) {
        point& v = i < 3 ? scaled.w0[i] : scaled.w1[i - 3];
        v = {size * v.x, size * v.y, size * v.z};
    }
    return shuffled(d, kind, placed<T>(kind, scaled, o0, o1));
}

template <scalar T>
ABUT_HD motion<T> steps_pair(draws& d, motion_kind kind) {
    motion<T> m = rounded_pair<T>(d, kind, crossing(d, 0, 0, d.below(2) == 0), 1, 0, 1);
    for (int i = 0; i < 4; ++i) {
        const vec3<T>& v = m.t0[i];
        m.t1[i].x = moved(v.x, d.below(7) - 3);
        m.t1[i].y = moved(v.y, d.below(7) - 3);
        m.t1[i].z = moved(v.z, d.below(7) - 3);
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> needle_pair(draws& d, motion_kind kind) {
    const point e = unit(cube(d, 1));
    const double width = d.power_of_ten(-9, -2), speed = d.below(2) == 0 ? width : 1, tau = d.uniform(0, 1);
    relative r = crossing(d, 1, tau, d.below(3) == 0);
    for (int i = 0; i < 3; ++i) {
        // At tau: squeezed to a needle along e. The motion: across, by `speed`.
        point at = along(r.w0[i], tau, along(r.w1[i], -1, r.w0[i]));
        const point v = along(r.w1[i], -1, r.w0[i]);
        const double length_along = product(at, e);
        at = along({width * at.x, width * at.y, width * at.z}, length_along, e);
        r.w0[i] = along(at, -tau * speed, v);
        r.w1[i] = along(at, (1 - tau) * speed, v);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

template <scalar T>
ABUT_HD motion<T> flat_pair(draws& d, motion_kind kind) {
    const point e = unit(cube(d, 1)), f = unit(cross_product(e, cube(d, 1)));
    const double tau = d.uniform(0, 1);
    relative r = crossing(d, 1, tau, d.below(2) == 0);
    for (int i = 0; i < 6; ++i) {
        point& v = i < 3 ? r.w0[i] : r.w1[i - 3];
        v = along(along({0, 0, 0}, v.x, e), v.y, f);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

/// Corners on both sides of the origin that turn about it, in front of a point that keeps a small distance from their plane
/// at the time tau; alike for edges.
template <scalar T>
ABUT_HD motion<T> rotating_pair(draws& d, motion_kind kind) {
    relative r;
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = unit(cube(d, 1));
        r.w1[i] = unit(cube(d, 1));
    }
    r.w0[2] = along(along({0, 0, 0}, -1, r.w0[0]), -1, r.w0[1]);
    r.w1[2] = along(along({0, 0, 0}, -1, r.w1[0]), -1, r.w1[1]);
    const double tau = d.uniform(0, 1), gap = d.power_of_ten(-8, -2), closer = d.uniform(-1, 1);
    const point a = along(r.w0[0], tau, along(r.w1[0], -1, r.w0[0])), b = along(r.w0[1], tau, along(r.w1[1], -1, r.w0[1]));
    const point n = unit(cross_product(a, b));
    for (int i = 0; i < 3; ++i) {
        r.w0[i] = along(r.w0[i], std::fma(-closer, tau, 1.0) * gap, n);
        r.w1[i] = along(r.w1[i], std::fma(closer, 1 - tau, 1.0) * gap, n);
    }
    return rounded_pair<T>(d, kind, r, 1, 1, 1);
}

// --- the number range ----------------------------------------------------------------------------------------------------

template <scalar T>
ABUT_HD T power_of_two(int k) {
    if constexpr (sizeof(T) == 4) {
        return k < -126 ? from_bits(1u << (k + 149)) : from_bits(static_cast<std::uint32_t>(127 + k) << 23);
    } else {
        return k < -1022 ? from_bits(std::uint64_t{1} << (k + 1074)) : from_bits(static_cast<std::uint64_t>(1023 + k) << 52);
    }
}

/// Each axis times a power of two; bits that fall off the end are rounded.
template <scalar T>
ABUT_HD motion<T> scaled(motion<T> m, T x, T y, T z) {
    for (int i = 0; i < 8; ++i) {
        vec3<T>& v = i < 4 ? m.t0[i] : m.t1[i - 4];
        v = {x * v.x, y * v.y, z * v.z};
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> axis_scales_pair(draws& d) {
    constexpr int low = sizeof(T) == 4 ? -149 : -1074, high = sizeof(T) == 4 ? 126 : 1022;
    const T x = power_of_two<T>(low + d.below(high - low)), y = power_of_two<T>(low + d.below(high - low));
    const T z = power_of_two<T>(low + d.below(high - low));
    return scaled(lattice_pair<T>(d, 4, 1), x, y, z);
}

template <scalar T>
ABUT_HD motion<T> denormal_pair(draws& d) {
    motion<T> m = lattice_pair<T>(d, d.below(2) == 0 ? 4 : 4096, 1);
    m = scaled(m, least_denormal<T>, least_denormal<T>, least_denormal<T>);
    for (int i = 0; i < 3; ++i) {
        T& x = any_coordinate(d, m);
        x = -x;
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> wide_lattice_pair(draws& d) {
    motion<T> m;
    for (int i = 0; i < 24; ++i) {
        vec3<T>& v = i < 12 ? m.t0[i / 3] : m.t1[i / 3 - 4];
        const int what = d.below(6);
        T x = T(0);
        if (what == 1) x = least_denormal<T>;
        if (what == 2) x = T(1);
        if (what == 3) x = moved(T(1), 1);
        if (what == 4) x = largest_number<T>;
        if (what == 5) x = moved(largest_number<T>, -1);
        if (d.below(2) == 0) x = -x;
        (i % 3 == 0 ? v.x : i % 3 == 1 ? v.y : v.z) = x;
    }
    return m;
}

/// Any finite numbers, or those from 1/8 of the largest one on.
template <scalar T>
ABUT_HD motion<T> any_numbers_pair(draws& d, bool large) {
    motion<T> m;
    for (int i = 0; i < 24; ++i) {
        vec3<T>& v = i < 12 ? m.t0[i / 3] : m.t1[i / 3 - 4];
        T x = T(0);
        if (large) {
            x = d.below(3) == 0 ? largest_number<T>
                                : static_cast<T>(largest_number<T> * static_cast<T>(d.uniform(0.125, 1)));
            if (d.below(2) == 0) x = -x;
        } else {
            x = any_finite<T>(d);
        }
        (i % 3 == 0 ? v.x : i % 3 == 1 ? v.y : v.z) = x;
    }
    return m;
}

template <scalar T>
ABUT_HD motion<T> random_pair(draws& d) {
    motion<T> m;
    for (int i = 0; i < 8; ++i) (i < 4 ? m.t0[i] : m.t1[i - 4]) = round_to<T>(cube(d, 1));
    return m;
}

}  // namespace abut::test::construction::motions
