// SPDX-License-Identifier: MIT
#pragma once

// Two cylinders in floating point, with the names of exact_cylinders.hpp. Where the disc of an end and the other cylinder
// are nearest is searched for in plain numbers, and what is found is certified by estimates of polynomials of degree 8 at
// most:
//
// Touching. A point of the disc's plane, by two numbers g and s, is in both and between the ends.
//
// Apart. For any g, and positive y, y', z and z' with y y' >= 1 and z z' >= 1,
//     S^(1/2) + (T / V)^(1/2) <= (S y' + y + T z' / V + z) / 2,
// a concave quadratic in g, which is nowhere above its tangent at the g that was found. Where |M| is above the tangent at
// both ends of the cylinder, no point of the disc is in it.

#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

/// A disc and a cylinder in numbers or estimates: those of exact_cylinders.hpp, R^2 E, r^2 V E, and where the cylinder's
/// ends are.
template <class N>
struct disc_beside_cylinder {
    N uu, vv, w, m, n, most_s, most_t, last, first;
};
template <class N>
ABUT_HD constexpr disc_beside_cylinder<N> disc_beside(const vec3<N>& x, const vec3<N>& u, const vec3<N>& v,
                                                      const N& disc_radius, const N& radius) {
    const vec3<N> e = cross(u, v);
    const N ee = dot(e, e), vv = dot(v, v), last = dot(x, v);
    return {dot(u, u),
            vv,
            dot(u, v),
            dot(x, e),
            dot(cross(x, v), e),
            disc_radius * disc_radius * ee,
            radius * radius * (vv * ee),
            last,
            last - vv};
}

/// Where the sum of both roots is greatest between the ends, as it seems, and the roots there.
struct nearest_chords {
    double g;
    double in_disc, in_cylinder;  ///< S^(1/2) and (T / V)^(1/2), or 0
    bool is_at_tip;               ///< the disc begins or ends there, and the cylinder's chords are beyond
    bool is_beyond;               ///< the disc is beyond an end
};

/// Of numbers whose degrees of 12 neither overflow nor all underflow.
ABUT_NOINLINE ABUT_HD constexpr nearest_chords find_nearest_chords(const disc_beside_cylinder<double>& d, double first,
                                                                   double last) {
    const double tip = square_root(d.most_s / d.uu);
    const auto s_at = [&](double g) { return d.most_s - d.uu * g * g; };
    const auto t_at = [&](double g) { return d.most_t - (d.n + d.w * g) * (d.n + d.w * g); };
    // How the sum falls, and how fast that grows, or 0 where a root is of nothing: then only the sign means something.
    const auto falls_at = [&](double g, double& slope) {
        const double s = s_at(g), t = t_at(g), across = d.w * (d.n + d.w * g);
        slope = 0;
        if (!(t > 0) && across != 0) return across;
        if (!(s > 0)) return g;
        const double root_s = square_root(s), root_t = t > 0 ? square_root(d.vv * t) : 1;
        slope = d.uu * d.most_s / (s * root_s) + (t > 0 ? d.w * d.w * d.most_t / (t * root_t) : 0);
        return d.uu * g / root_s + across / root_t;
    };
    double low = greatest(first, -tip), high = least(last, tip), g = 0, slope = 0;
    if (low > high) {
        g = last < -tip ? last : first;
    } else if (falls_at(low, slope) >= 0) {
        g = low;
    } else if (falls_at(high, slope) <= 0) {
        g = high;
    } else {
        g = low < 0 && high > 0 ? 0 : low + (high - low) / 2;
        for (int i = 0; i < 64; ++i) {
            const double falls = falls_at(g, slope);
            if (falls == 0) break;
            (falls > 0 ? high : low) = g;
            double next = slope > 0 ? g - falls / slope : low;
            if (!(next > low && next < high)) next = low + (high - low) / 2;
            const double step = absolute(next - g);
            g = next;
            if (step <= 0x1p-52 * absolute(g)) break;
        }
    }
    const double s = s_at(g), t = t_at(g);
    return {g, s > 0 ? square_root(s) : 0, t > 0 ? square_root(t / d.vv) : 0, g > first && g < last && !(t > 0), low > high};
}

/// Whether they have a point in common.
ABUT_HD constexpr verdict ask_disc(const disc_beside_cylinder<double>& d) {
    const nearest_chords at = find_nearest_chords(d, d.first, d.last);
    const double k = d.n + d.w * at.g;
    return to_verdict(at.g >= d.first && at.g <= d.last && d.uu * at.g * at.g <= d.most_s && k * k <= d.most_t &&
                      absolute(d.m) <= at.in_disc + at.in_cylinder);
}
ABUT_HD constexpr verdict ask_disc(const disc_beside_cylinder<estimate>& d) {
    const auto known = [](double x) { return estimate{x, 0}; };
    const auto is_known = [](verdict v) { return v == verdict::yes; };
    // In the unit of ask_estimates numbers of degree 8 come close to the largest there is. And a number that is found may
    // not be so small that its products with estimates underflow.
    constexpr double down = 0x1p-112, up = 0x1p112, down2 = down * down, down4 = down2 * down2;
    const auto found = [](double x) { return absolute(x) < 0x1p-240 ? 0 : x; };
    const nearest_chords at = find_nearest_chords(
        {d.uu.value * down2, d.vv.value * down2, d.w.value * down2, d.m.value * down2 * down, d.n.value * down4,
         d.most_s.value * down4 * down2, d.most_t.value * down4 * down4, d.last.value * down2, d.first.value * down2},
        (d.first.value + 2 * d.first.error) * down2, (d.last.value - 2 * d.last.error) * down2);
    const estimate g = known(found(at.g * up * up)), k = d.n + d.w * g, s = d.most_s - d.uu * (g * g), t = d.most_t - k * k;
    const double in_disc = at.in_disc * up * up * up, in_cylinder = at.in_cylinder * up * up * up,
                 both = in_disc + in_cylinder, apart = absolute(d.m.value);
    if (apart <= both && s.value >= 0 && t.value >= 0) {
        const estimate along = known(both > 0 ? found(-d.m.value * (in_disc / both)) : 0), other = d.m + along;
        const bool touch = is_known(is_not_negative(d.last - g)) && is_known(is_not_negative(g - d.first)) &&
                           is_known(is_not_negative(s - along * along)) &&
                           is_known(is_not_negative(t - d.vv * (other * other)));
        return touch ? verdict::yes : verdict::unknown;
    }
    const double widest = square_root(d.most_t.value / d.vv.value),
                 little = 0x1p-48 * (apart + both + square_root(d.most_s.value) + widest),
                 to_cylinder = greatest(in_cylinder, at.is_beyond ? widest + little : little);
    // At a tip such that the tangent is level.
    const double level = at.is_at_tip ? -(d.uu.value / d.w.value) * (g.value / k.value * d.vv.value) * to_cylinder : 0,
                 to_disc = level > 0 ? level : greatest(in_disc, little);
    const auto above = [](double x) { return x + 0x1p-40 * x; };
    const estimate y = known(above(to_disc)), z = known(above(to_cylinder)), y1 = known(1 / to_disc),
                   z1 = known(1 / to_cylinder);
    const estimate length = d.m.value < 0 ? -d.m : d.m;
    const estimate over = d.vv * (length + length - s * y1 - y - z) - t * z1, falls = d.vv * (d.uu * g * y1) + d.w * k * z1,
                   slope = falls + falls;
    const estimate one = known(1);
    const bool is_apart = is_known(is_positive(over + slope * (d.last - g))) &&
                          is_known(is_positive(over + slope * (d.first - g))) && is_known(is_not_negative(y * y1 - one)) &&
                          is_known(is_not_negative(z * z1 - one));
    return is_apart ? verdict::no : verdict::unknown;
}

/// As `cylinders_meet`, of estimates or plain numbers.
struct cylinders_seem_to_meet {
    static constexpr int degree = 8;

    template <class N>
    ABUT_NOINLINE ABUT_HD static constexpr verdict ask(const N (&value)[14]) {
        const vec3<N> a[2] = {point_at(value, 0), point_at(value, 1)}, b[2] = {point_at(value, 2), point_at(value, 3)};
        const vec3<N> u = a[1] - a[0], v = b[1] - b[0], x = a[0] - b[0], e = cross(u, v);
        const N ee = dot(e, e), reach = value[12] + value[13];
        const int crossed = sign_or_unknown(ee);
        if (crossed == unknown_sign) return verdict::unknown;
        if (crossed == 0) return parallel_meet(x, a[1] - b[0], v, reach);
        const N apart = dot(x, e);
        const verdict near = is_not_positive(apart * apart - reach * reach * ee);
        if (near == verdict::no) return near;
        const N at_a = dot(cross(x, v), e), at_b = dot(cross(x, u), e);
        verdict met = near && is_not_positive(at_a) && is_not_negative(at_a + ee) && is_not_positive(at_b) &&
                      is_not_negative(at_b + ee);
        ABUT_ROLLED
        for (int k = 0; k < 2; ++k) {
            met = or_else(met, [&] { return ask_disc(disc_beside(a[k] - b[0], u, v, value[12], value[13])); });
            met = or_else(met, [&] { return ask_disc(disc_beside(b[k] - a[0], v, u, value[13], value[12])); });
        }
        return met;
    }

private:
    template <class N>
    ABUT_HD static constexpr verdict parallel_meet(const vec3<N>& x, const vec3<N>& y, const vec3<N>& v, const N& reach) {
        const N first = dot(x, v), last = dot(y, v), vv = dot(v, v);
        const vec3<N> across = cross(x, v);
        return (is_not_negative(first) || is_not_negative(last)) &&
               (is_not_positive(first - vv) || is_not_positive(last - vv)) &&
               is_not_positive(dot(across, across) - reach * reach * vv);
    }
};

}  // namespace abut::detail
