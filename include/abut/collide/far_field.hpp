// SPDX-License-Identifier: MIT
#pragma once

// What many triangles together contribute to a winding number from afar: of each node of a tree the first moments of its
// triangles, and how far the sum that is made of them can be off (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson:
// Fast Winding Numbers for Soups and Clouds, 2018, whose expansion this is; it has no bound, which is below).
//
// Seen from p, a surface contributes the integral of n . grad f over 4 pi, where f(x) = -1 / |x - p| and n is the normal.
// With x = c + y, v = c - p, d = |v| and u = v / d, f is the sum over l of -h_l(y) / d^(l + 1), where h_l is the homogeneous
// harmonic polynomial |y|^l P_l(-cos) of the angle between y and u. The terms to l = 4 are kept: their gradients are of
// degree 0 to 3 in y, and what of y is left in the integrals are moments of the surface about c:
//
//   S_i = integral of n_i,   M_ij of n_i y_j,   Q_ijk of n_i y_j y_k,   T_ijkl of n_i y_j y_k y_l
//   4 pi w = S.u / d^2  -  3 M[u, u] / d^3  +  15/2 Q[u, u, u] / d^4  -  35/2 T[u, u, u, u] / d^5
//
// M, Q and T are multiplied by derivatives of a harmonic function. These are symmetric and without trace, so that nothing but
// that part of them is asked for.
//
// The rest: |h_l| <= |y|^l, since |P_l| <= 1. A homogeneous polynomial of degree l that is at most 1 on the unit sphere has
// a gradient of at most l there (S. Banach, Über homogene Polynome in (L2), 1938). So what is left out is, with |y| <= r < d
// and R2 the integral of |y|^2, at most
//
//   sum over l >= 5 of l r^(l - 3) R2 / d^(l + 1)  =  R2 r^2 (5 d - 4 r) / (d^5 (d - r)^2)

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/walk_order.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/rounded_lanes.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Where moments are made: the middle of the triangles' box is the origin, and its longest side comes to [1, 4), or as near
/// to it as powers of two go.
struct winding_frame {
    double scale = 1;  ///< the largest coordinate comes to [1, 2)
    vec3<double> middle{0, 0, 0};
    double per_length = 1;

    winding_frame() = default;
    /// Of the lowest and the highest coordinates.
    winding_frame(const vec3<double>& lower, const vec3<double>& upper) {
        const auto power = [](double x) {
            const int e = contact_math::exponent_of(least(x, largest_finite<double>));
            return contact_math::power_of_two(greatest(-1000, least(1000, -e)));
        };
        const double largest = greatest(magnitude(lower), magnitude(upper));
        if (!(largest > 0)) return;
        scale = power(largest);
        middle = of(0.5 * lower) + of(0.5 * upper);
        const double size = magnitude(of(upper));
        if (size > 0) per_length = power(size);
    }
    [[nodiscard]] ABUT_HD vec3<double> of(const vec3<double>& p) const {
        const auto one = [&](double x, double from) {
            return plain_product(plain_sum(plain_product(x, scale), -from), per_length);
        };
        return {one(p.x, middle.x), one(p.y, middle.y), one(p.z, middle.z)};
    }

private:
    static double magnitude(const vec3<double>& v) { return contact_math::largest_of(v); }
};

/// The symmetric part without trace of the moments of some triangles about a centre.
struct winding_moments {
    using point = vec3<double>;
    point center, lower, upper;  ///< and the box around the corners
    double radius;               ///< no corner is farther from the centre
    double area, spread;         ///< the triangles' area, and R2 or more
    point s;
    double m[6];   ///< xx, yy, zz, xy, yz, zx; each as often as it occurs in M[u, u]
    double q[10];  ///< xxx, yyy, zzz, xxy, yyz, zzx, xyy, yzz, zxx, xyz; each as often as it occurs in Q[u, u, u]
    double t[15];  ///< xxxx, yyyy, zzzz, xxxy, yyyz, zzzx, xyyy, yzzz, zxxx, xxyy, yyzz, zzxx, xxyz, yyzx, zzxy; likewise
    std::uint32_t count;  ///< of triangles
};

namespace winding {

using contact_math::one_double;
using vector = vec3<one_double>;

ABUT_HD constexpr one_double number(double x) { return {x}; }
ABUT_HD constexpr vector vector_of(const vec3<double>& v) { return {{v.x}, {v.y}, {v.z}}; }
ABUT_HD constexpr double length_of(const vector& v) { return contact_math::root(dot(v, v)).high; }

/// Forms in u of degree 2, 3 and 4, by their coefficients as above; v.u times one of lower degree is added to each.
///@{
using quadratic = one_double[6];
using cubic = one_double[10];
using quartic = one_double[15];
ABUT_HD constexpr void add_product(quadratic& m, const vector& v, const vector& w) {
    m[0] = m[0] + v.x * w.x;
    m[1] = m[1] + v.y * w.y;
    m[2] = m[2] + v.z * w.z;
    m[3] = m[3] + (v.x * w.y + v.y * w.x);
    m[4] = m[4] + (v.y * w.z + v.z * w.y);
    m[5] = m[5] + (v.z * w.x + v.x * w.z);
}
ABUT_HD constexpr void add_product(cubic& q, const vector& v, const quadratic& m) {
    q[0] = q[0] + v.x * m[0];
    q[1] = q[1] + v.y * m[1];
    q[2] = q[2] + v.z * m[2];
    q[3] = q[3] + (v.x * m[3] + v.y * m[0]);
    q[4] = q[4] + (v.y * m[4] + v.z * m[1]);
    q[5] = q[5] + (v.z * m[5] + v.x * m[2]);
    q[6] = q[6] + (v.x * m[1] + v.y * m[3]);
    q[7] = q[7] + (v.y * m[2] + v.z * m[4]);
    q[8] = q[8] + (v.z * m[0] + v.x * m[5]);
    q[9] = q[9] + (v.x * m[4] + v.y * m[5] + v.z * m[3]);
}
ABUT_HD constexpr void add_product(quartic& t, const vector& v, const cubic& q) {
    t[0] = t[0] + v.x * q[0];
    t[1] = t[1] + v.y * q[1];
    t[2] = t[2] + v.z * q[2];
    t[3] = t[3] + (v.x * q[3] + v.y * q[0]);
    t[4] = t[4] + (v.y * q[4] + v.z * q[1]);
    t[5] = t[5] + (v.z * q[5] + v.x * q[2]);
    t[6] = t[6] + (v.x * q[1] + v.y * q[6]);
    t[7] = t[7] + (v.y * q[2] + v.z * q[7]);
    t[8] = t[8] + (v.z * q[0] + v.x * q[8]);
    t[9] = t[9] + (v.x * q[6] + v.y * q[3]);
    t[10] = t[10] + (v.y * q[7] + v.z * q[4]);
    t[11] = t[11] + (v.z * q[8] + v.x * q[5]);
    t[12] = t[12] + (v.x * q[9] + v.y * q[8] + v.z * q[3]);
    t[13] = t[13] + (v.y * q[9] + v.z * q[6] + v.x * q[4]);
    t[14] = t[14] + (v.z * q[9] + v.x * q[7] + v.y * q[5]);
}
///@}

/// Moments as forms, while they are added up.
struct moment_sums {
    quadratic m{};
    cubic q{};
    quartic t{};

    /// Takes off |u|^2 times a form of lower degree, so that what is left is harmonic, and writes it.
    ABUT_HD constexpr void write_harmonic(winding_moments& to) const {
        const one_double third = (m[0] + m[1] + m[2]) / number(3);
        for (int k = 0; k < 6; ++k) to.m[k] = (k < 3 ? m[k] - third : m[k]).high;
        // The Laplacian of a cubic form is 6 xxx + 2 xyy + 2 zzx along x; that of |u|^2 l is 10 l for a linear l.
        const auto tenth = [](one_double cube, one_double first, one_double second) {
            return (number(3) * cube + first + second) / number(5);
        };
        const one_double x = tenth(q[0], q[6], q[5]), y = tenth(q[1], q[7], q[3]), z = tenth(q[2], q[8], q[4]);
        const one_double off[10] = {x, y, z, y, z, x, x, y, z, number(0)};
        for (int k = 0; k < 10; ++k) to.q[k] = (q[k] - off[k]).high;
        // F less |u|^2 of its Laplacian G over 14, and |u|^4 of that of G over 280.
        const auto twice = [](one_double a) { return a + a; };
        const auto of_square = [&](one_double fourth, one_double a, one_double b) {
            return number(12) * fourth + twice(a + b);
        };
        const auto mixed = [&](one_double a, one_double b, one_double c) { return number(6) * (a + b) + twice(c); };
        const one_double g[6] = {of_square(t[0], t[9], t[11]), of_square(t[1], t[9], t[10]), of_square(t[2], t[10], t[11]),
                                 mixed(t[3], t[6], t[14]),     mixed(t[4], t[7], t[12]),     mixed(t[5], t[8], t[13])};
        const one_double f = twice(g[0] + g[1] + g[2]) / number(280);
        const one_double by_g[15] = {g[0], g[1], g[2], g[3],        g[4],        g[5],        g[3], g[4],
                                     g[5], g[0] + g[1], g[1] + g[2], g[2] + g[0], g[4], g[5], g[3]};
        for (int k = 0; k < 15; ++k) {
            const one_double fourth = k < 3 ? f : k >= 9 && k < 12 ? twice(f) : number(0);
            to.t[k] = (t[k] - by_g[k] / number(14) + fourth).high;
        }
    }
};

}  // namespace winding

/// Of one triangle, about the mean of its corners as it is rounded.
template <scalar T>
ABUT_HD winding_moments moments_of(const triangle<T>& t, const winding_frame& frame) {
    using namespace winding;
    const auto corner = [&](const vec3<T>& p) {
        const vec3<double> at = frame.of(widened(p));
        return vector_of(at);
    };
    const vector a = corner(t.a), b = corner(t.b), c = corner(t.c);
    const auto third = [](const vector& v) { return vector{v.x / number(3), v.y / number(3), v.z / number(3)}; };
    const vector center = third(a + b + c), to_a = a - center, to_b = b - center, to_c = c - center;
    const vector double_normal = cross(b - a, c - a), all = to_a + to_b + to_c, mean = third(all);
    const vector n{number(0.5) * double_normal.x, number(0.5) * double_normal.y, number(0.5) * double_normal.z};
    // The mean of (y.u)^2 is (sum of corners' squares + the square of their sum) / 12; that of (y.u)^3, with sums p1, p2 and p3
    // of the corners' powers, is (p1^3 + 3 p1 p2 + 2 p3) / 60.
    const auto powers_of = [](const vector& v, quadratic& square, cubic& cube, double factor) {
        quadratic own{};
        add_product(own, v, v);
        const vector more = scale(number(factor), v);
        add_product(square, v, v);
        add_product(cube, more, own);
    };
    quadratic square{};
    cubic cube{};
    powers_of(to_a, square, cube, 2);
    powers_of(to_b, square, cube, 2);
    powers_of(to_c, square, cube, 2);
    add_product(cube, scale(number(3), all), square);
    powers_of(all, square, cube, 1);
    for (one_double& x : square) x = x / number(12);
    for (one_double& x : cube) x = x / number(60);
    moment_sums sums;
    add_product(sums.m, n, mean);
    add_product(sums.q, n, square);
    add_product(sums.t, n, cube);
    winding_moments of;
    of.center = contact_math::rounded_off(center);
    of.lower = contact_math::rounded_off(vector{{least(a.x.high, b.x.high, c.x.high)},
                                                {least(a.y.high, b.y.high, c.y.high)},
                                                {least(a.z.high, b.z.high, c.z.high)}});
    of.upper = contact_math::rounded_off(vector{{greatest(a.x.high, b.x.high, c.x.high)},
                                                {greatest(a.y.high, b.y.high, c.y.high)},
                                                {greatest(a.z.high, b.z.high, c.z.high)}});
    of.count = 1;
    of.radius = greatest(length_of(to_a), length_of(to_b), length_of(to_c));
    of.area = length_of(n);
    of.spread = (number(of.area) * (square[0] + square[1] + square[2])).high;
    of.s = contact_math::rounded_off(n);
    sums.write_harmonic(of);
    return of;
}

/// Of two parts or more, about the centre of their areas.
ABUT_HD inline winding_moments joined_moments(const winding_moments* parts, int count, double off_center) {
    using namespace winding;
    // The centre is moved from that of the first towards each of the others: it stays among them, whatever is rounded.
    one_double area = number(parts[0].area);
    vector center = vector_of(parts[0].center);
    for (int k = 1; k < count; ++k) {
        area = area + number(parts[k].area);
        const one_double weight = area.high > 0 ? number(parts[k].area) / area : number(0.5);
        center = center + scale(weight, vector_of(parts[k].center) - center);
    }
    winding_moments all;
    all.center = contact_math::rounded_off(center);
    all.area = area.high;
    all.lower = parts[0].lower, all.upper = parts[0].upper, all.count = parts[0].count;
    for (int k = 1; k < count; ++k) {
        all.lower = least(all.lower, parts[k].lower);
        all.upper = greatest(all.upper, parts[k].upper);
        all.count += parts[k].count;
    }
    one_double spread{};
    double radius = 0;
    vector s{};
    moment_sums sums;
    for (int k = 0; k < count; ++k) {
        const winding_moments& part = parts[k];
        const vector way = vector_of(part.center) - center, n = vector_of(part.s);
        const one_double moved = number(length_of(way));
        radius = greatest(radius, (moved + number(part.radius)).high);
        // R2 about a centre that is moved from that of the area is R2 + area times the square; a part's is not quite that.
        const one_double reach = moved + number(off_center);
        spread = spread + (number(part.spread) + number(part.area) * (reach * reach));
        s = s + n;
        // About the new centre they are M + S w, Q + (2 M + S w) w and T + (3 Q + (3 M + S w) w) w, where w is way.u.
        quadratic by_s{}, twice, thrice;
        cubic by_m{}, all_q;
        add_product(by_s, way, n);
        for (int j = 0; j < 6; ++j) {
            const one_double m = number(part.m[j]);
            sums.m[j] = sums.m[j] + (m + by_s[j]);
            twice[j] = number(2) * m + by_s[j];
            thrice[j] = number(3) * m + by_s[j];
        }
        add_product(by_m, way, thrice);
        for (int j = 0; j < 10; ++j) {
            const one_double q = number(part.q[j]);
            sums.q[j] = sums.q[j] + q;
            all_q[j] = number(3) * q + by_m[j];
        }
        add_product(sums.q, way, twice);
        for (int j = 0; j < 15; ++j) sums.t[j] = sums.t[j] + number(part.t[j]);
        add_product(sums.t, way, all_q);
    }
    // The box's farthest corner may be nearer than what the parts' balls say.
    const vec3<double> far = greatest(contact_math::plain_difference(all.upper, all.center),
                                      contact_math::plain_difference(all.center, all.lower));
    all.radius = plain_product(least(radius, length_of(vector_of(far))), 1 + 0x1p-46);
    all.spread = spread.high;
    all.s = contact_math::rounded_off(s);
    sums.write_harmonic(all);
    return all;
}

inline constexpr double per_full_angle = 0.079577471545947668;  ///< 1 / (4 pi)

/// What a walk reads of the far fields of four nodes: coefficients of S.u, M[u, u] / r, Q[u, u, u] / r^2 and T[u, u, u, u] / r^3,
/// over 4 pi and with the factors of the expansion; of the forms those that say all. So all are like the area, and no product
/// of floats is too small, however small the node. One is the sum of two floats, of which the first may do.
struct alignas(16) far_terms {
    static constexpr int count = 24;
    float high[count][4], low[count][4];
};
/// And what its error is made of: the radius; the factor of the bound that does not depend on the point, R2 / (4 pi r^2); and
/// what floats may lose of S and M, and of Q and T, as factors of 1 / d^2 and r^2 / d^4. Rounded up.
struct far_bounds {
    float radius, weight, noise, noise_of_high;
};

ABUT_HD inline float rounded_up(double x) { return static_cast<float>(plain_product(x, 1 + 0x1p-20) + 0x1p-120); }

ABUT_HD inline far_bounds write_far_terms(const winding_moments& all, far_terms& terms, int node) {
    const double *const m = all.m, *const q = all.q, *const t = all.t, unit = per_full_angle;
    const float radius = rounded_up(all.radius);
    const auto r = static_cast<double>(radius);
    const double of[far_terms::count] = {all.s.x, all.s.y, all.s.z, m[0], m[1], m[3], m[4], m[5], q[0], q[1], q[2], q[6],
                                         q[7],    q[8],    q[9],    t[0], t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8]};
    double sum[4] = {};
    for (int k = 0; k < far_terms::count; ++k) {
        const int degree = k < 3 ? 0 : k < 8 ? 1 : k < 15 ? 2 : 3;
        const double factor = degree == 0 ? unit : degree == 1 ? -3 * unit : degree == 2 ? 7.5 * unit : -17.5 * unit;
        double term = plain_product(of[k], factor);
        for (int power = 0; power < degree; ++power) term = term / r;
        const auto high = static_cast<float>(term);
        terms.high[k][node] = high;
        terms.low[k][node] = static_cast<float>(plain_sum(term, -static_cast<double>(high)));
        sum[degree] = plain_sum(sum[degree], absolute(term));
    }
    // Less than forty roundings are one upon another, of parts that add up to no more than this: a coefficient of Q comes with
    // a polynomial of at most 3/2, one of T with 2, and r < d.
    const auto noise = [](double parts) { return rounded_up(plain_product(40 * 0x1p-24, parts)); };
    return {radius, rounded_up(plain_product(all.spread / r / r, per_full_angle * (1 + 0x1p-8))),
            noise(plain_sum(sum[0], sum[1])), noise(plain_sum(1.5 * sum[2], 2 * sum[3]))};
}

/// By how much a far field may be off at a distance whose square is given, in floats: infinite where the gap to the ball has
/// lost its digits, and where products are out of range. The weight makes up for what is rounded here: of the gap by 2^-11 or
/// less.
template <class N>
ABUT_INLINE ABUT_HD N far_error(const N& squared, const N& radius, const N& weight, const N& noise, const N& noise_of_high) {
    const N one = N::of(1), inverse = one / root(squared), square = inverse * inverse, x = radius * inverse, gap = one - x;
    const N x2 = x * x, left_out = (weight * (x2 * x2) * (N::of(5) - N::of(4) * x)) / (gap * gap);
    const N error = square * (left_out + (noise + noise_of_high * x2));
    const auto is_outside = (gap > N::of(0x1p-10f)) & (squared > N::of(1e-30f)) & (squared < N::of(1e30f));
    return select(is_outside, error + N::of(1e-30f), N::of(infinity<float>));
}

/// The far field at `way` from the centre of a node, of which term[k] are the coefficients.
template <class N, class Terms>
ABUT_INLINE ABUT_HD N far_value(const vec3<N>& way, const N& radius, const Terms& term) {
    const N inverse = N::of(1) / root(dot(way, way)), x = radius * inverse;
    const vec3<N> v{way.x * inverse, way.y * inverse, way.z * inverse};
    const N xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z, x_z = xx - zz, y_z = yy - zz, x_y = xx - yy;
    const N xy = v.x * v.y, yz = v.y * v.z, zx = v.z * v.x, three = N::of(3);
    const N x_3z = x_z - (zz + zz), y_3x = yy - three * xx, z_3y = zz - three * yy;
    const N of_s = term[0] * v.x + term[1] * v.y + term[2] * v.z;
    const N of_m = term[3] * x_z + term[4] * y_z + term[5] * xy + term[6] * yz + term[7] * zx;
    const N of_q = v.x * (term[8] * x_3z + term[11] * y_z) + v.y * (term[9] * y_3x - term[12] * x_z) +
                   v.z * (term[10] * z_3y + term[13] * x_y) + term[14] * (v.x * yz);
    const N a = xx * yy, b = yy * zz, c = zz * xx;
    const N squares = term[15] * (xx * xx - three * (a - b + c)) + term[16] * (yy * yy - three * (a + b - c)) +
                      term[17] * (zz * zz - three * (b + c - a));
    const N of_t = squares + xy * (term[18] * x_3z + term[21] * (yy - three * zz)) +
                   yz * (term[19] * y_3x + term[22] * (zz - three * xx)) + zx * (term[20] * z_3y + term[23] * (xx - three * yy));
    return (inverse * inverse) * (of_s + x * (of_m + x * (of_q + x * of_t)));
}

// --- of all nodes of a tree, from the leaves up --------------------------------------------------------------------------

/// Writes the parent of each inner node.
template <bvh_layout Tree>
struct write_parents {
    Tree tree;
    std::uint32_t* above;
    ABUT_HD void operator()(std::size_t i) const {
        const auto number = static_cast<std::uint32_t>(i);
        const auto& node = tree.fetch(number);
        for (int slot = 0; slot < tree.children(node); ++slot) {
            const bvh_child child = tree.child(node, slot);
            if (!child.is_leaf()) above[child.index()] = number;
        }
        if (number == tree.root().index()) above[number] = no_link;
    }
};

/// Of those that come to a node from its children the last one makes its moments of theirs, and goes on. Who that is changes
/// no bit: children are taken in order.
template <bvh_layout Tree, shape_view Shapes>
struct gather_moments {
    static_assert(Tree::width == 2 || Tree::width == 4);
    static constexpr std::uint32_t words = Tree::width == 2 ? 1 : 3;  ///< of `reached` for each node

    Tree tree;
    Shapes shapes;
    winding_frame frame;
    double off_center;  ///< centres of areas are no farther from what is computed
    const std::uint32_t* above;
    std::uint32_t* reached;  ///< 0 at the start
    winding_moments* moments;

    ABUT_HD void operator()(std::size_t i) const {
        const auto number = static_cast<std::uint32_t>(i);
        const auto& node = tree.fetch(number);
        for (int slot = 0; slot < tree.children(node); ++slot) {
            if (tree.child(node, slot).is_leaf()) climb(number, slot);
        }
    }

private:
    ABUT_HD void climb(std::uint32_t number, int slot) const {
        for (;;) {
            const auto& node = tree.fetch(number);
            const int children = tree.children(node);
            if (!is_last(number, slot, children)) return;
            winding_moments parts[std::size_t{Tree::width}];
            for (int k = 0; k < children; ++k) {
                const bvh_child child = tree.child(node, k);
                parts[k] = child.is_leaf() ? moments_of(shapes[child.index()], frame) : moments[child.index()];
            }
            moments[number] = joined_moments(parts, children, off_center);
            const std::uint32_t next = above[number];
            if (next == no_link) return;
            const auto& parent = tree.fetch(next);
            for (slot = 0; tree.child(parent, slot) != bvh_child::inner(number);) ++slot;
            number = next;
        }
    }
    /// Four meet in pairs.
    [[nodiscard]] ABUT_HD bool is_last(std::uint32_t number, int slot, int children) const {
        std::uint32_t* const word = reached + std::size_t{words} * number;
        const auto is_second = [&](int k) { return execution::atomic_exchange_acq_rel(word + k, 1) != 0; };
        if constexpr (words == 1) {
            return is_second(0);
        } else {
            const bool is_alone = (slot ^ 1) >= children;
            if (!is_alone && !is_second(slot / 2)) return false;
            return children == 2 || is_second(2);
        }
    }
};

/// The parents of a tree's inner nodes, `count` of them; no_link of the root. May return before they are there.
template <class Policy, bvh_layout Tree>
execution::buffer_of<Policy, std::uint32_t> parents_of_nodes(const Policy& on, const Tree& tree, std::size_t count) {
    execution::buffer_of<Policy, std::uint32_t> above(on, count);
    for_each_index(on, count, write_parents<Tree>{tree, above.data()});
    return above;
}

/// Of a tree with inner nodes, `count` of them, by their numbers. May
/// return before they are there.
template <class Policy, bvh_layout Tree, shape_view Shapes>
execution::buffer_of<Policy, winding_moments> moments_of_nodes(const Policy& on, const Tree& tree, std::size_t count,
                                                               const Shapes& shapes, const winding_frame& frame,
                                                               const std::uint32_t* above) {
    using gather = gather_moments<Tree, Shapes>;
    execution::buffer_of<Policy, winding_moments> moments(on, count);
    execution::buffer_of<Policy, std::uint32_t> reached(on, gather::words * count);
    fill(on, reached.data(), reached.size(), std::uint32_t{0});
    // In each of 96 levels at most a centre is rounded, and the areas that weigh it: by 200 units of roundoff or less.
    for_each_index(on, count, gather{tree, shapes, frame, 0x1p-37, above, reached.data(), moments.data()});
    return moments;
}

}  // namespace abut::detail
