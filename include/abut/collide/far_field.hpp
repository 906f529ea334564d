// SPDX-License-Identifier: MIT
#pragma once

// What many triangles together contribute to a winding number from afar: of each node of a tree the first moments of its
// triangles, and how far the sum that is made of them can be off (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson:
// Fast Winding Numbers for Soups and Clouds, 2018, whose expansion this is; it has no bound, which is below).
//
// Seen from p, a surface contributes the integral of n . grad f over 4 pi, where f(x) = -1 / |x - p| and n is the normal.
// With x = c + y, v = c - p, d = |v| and u = v / d, f is the sum over l of -h_l(y) / d^(l + 1), where h_l is the homogeneous
// harmonic polynomial |y|^l P_l(-cos) of the angle between y and u. The terms to l = 3 are kept: their gradients are of
// degree 0 to 2 in y, and what of y is left in the integrals are moments of the surface about c:
//
//   S_i = integral of n_i,   M_ij = integral of n_i y_j,   Q_ijk = integral of n_i y_j y_k
//   4 pi w = S.u / d^2  -  3 M[u, u] / d^3  +  15/2 Q[u, u, u] / d^4
//
// M and Q are multiplied by derivatives of a harmonic function. These are symmetric and without trace, so that nothing but
// that part of M and of Q is asked for.
//
// The rest: |h_l| <= |y|^l, since |P_l| <= 1. A homogeneous polynomial of degree l that is at most 1 on the unit sphere has
// a gradient of at most l there (S. Banach, Über homogene Polynome in (L2), 1938). So what is left out is, with |y| <= r < d
// and R2 the integral of |y|^2, at most
//
//   sum over l >= 4 of l r^(l - 3) R2 / d^(l + 1)  =  R2 r (4 d - 3 r) / (d^4 (d - r)^2)
//
// Lengths are measured in a unit in which products of six of them are in range: in doubles the largest coordinate of a
// triangle comes to [1, 2), or as near to it as 2^1000 times goes, and in floats none is needed.

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
    std::uint32_t count;  ///< of triangles
};

namespace winding {

using contact_math::one_double;
using vector = vec3<one_double>;

ABUT_HD constexpr one_double number(double x) { return {x}; }
ABUT_HD constexpr vector vector_of(const vec3<double>& v) { return {{v.x}, {v.y}, {v.z}}; }
ABUT_HD constexpr double length_of(const vector& v) { return contact_math::root(dot(v, v)).high; }

/// The coefficients of M[u, u] and Q[u, u, u], as polynomials in u, while they are added up.
struct moment_sums {
    one_double m[6]{}, q[10]{};

    /// (n . u)(y . u)
    ABUT_HD constexpr void add_to_m(const vector& n, const vector& y) {
        m[0] = m[0] + n.x * y.x;
        m[1] = m[1] + n.y * y.y;
        m[2] = m[2] + n.z * y.z;
        m[3] = m[3] + (n.x * y.y + n.y * y.x);
        m[4] = m[4] + (n.y * y.z + n.z * y.y);
        m[5] = m[5] + (n.z * y.x + n.x * y.z);
    }
    /// (n . u) times a quadratic form.
    ABUT_HD constexpr void add_to_q(const vector& n, const one_double (&form)[6]) {
        q[0] = q[0] + n.x * form[0];
        q[1] = q[1] + n.y * form[1];
        q[2] = q[2] + n.z * form[2];
        q[3] = q[3] + (n.x * form[3] + n.y * form[0]);
        q[4] = q[4] + (n.y * form[4] + n.z * form[1]);
        q[5] = q[5] + (n.z * form[5] + n.x * form[2]);
        q[6] = q[6] + (n.x * form[1] + n.y * form[3]);
        q[7] = q[7] + (n.y * form[2] + n.z * form[4]);
        q[8] = q[8] + (n.z * form[0] + n.x * form[5]);
        q[9] = q[9] + (n.x * form[4] + n.y * form[5] + n.z * form[3]);
    }
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
    // The mean of y y is (sum of corners' squares + the square of their sum) / 12.
    one_double form[6];
    const auto mean_of = [&](auto product) {
        return (product(to_a) + product(to_b) + product(to_c) + product(all)) / number(12);
    };
    form[0] = mean_of([](const vector& v) { return v.x * v.x; });
    form[1] = mean_of([](const vector& v) { return v.y * v.y; });
    form[2] = mean_of([](const vector& v) { return v.z * v.z; });
    form[3] = mean_of([](const vector& v) { return number(2) * (v.x * v.y); });
    form[4] = mean_of([](const vector& v) { return number(2) * (v.y * v.z); });
    form[5] = mean_of([](const vector& v) { return number(2) * (v.z * v.x); });
    moment_sums sums;
    sums.add_to_m(n, mean);
    sums.add_to_q(n, form);
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
    of.spread = (number(of.area) * (form[0] + form[1] + form[2])).high;
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
        one_double m[6], form[6], twice[6];
        for (int j = 0; j < 6; ++j) m[j] = number(part.m[j]), sums.m[j] = sums.m[j] + m[j];
        for (int j = 0; j < 10; ++j) sums.q[j] = sums.q[j] + number(part.q[j]);
        sums.add_to_m(n, way);
        // (n . u)(way . u)^2 + 2 M[u, u](way . u)
        form[0] = way.x * way.x, form[1] = way.y * way.y, form[2] = way.z * way.z;
        form[3] = number(2) * (way.x * way.y), form[4] = number(2) * (way.y * way.z), form[5] = number(2) * (way.z * way.x);
        sums.add_to_q(n, form);
        for (int j = 0; j < 6; ++j) twice[j] = number(2) * m[j];
        sums.add_to_q(way, twice);
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

/// What a walk reads of the far fields of four nodes: coefficients of S.v, M[v, v] and Q[v, v, v], over 4 pi and with the
/// factors of the expansion; of M and of Q those that say all. One is the sum of two floats, of which the first may do.
struct alignas(16) far_terms {
    float high[15][4], low[15][4];
};
/// And what its error is made of: the radius; the factor of the bound that does not depend on the point, R2 / (4 pi r^2); and
/// a bound on what floats may lose, as a factor of 1 / d^2. Rounded up.
struct far_bounds {
    float radius, weight, noise;
};

ABUT_HD inline float rounded_up(double x) { return static_cast<float>(plain_product(x, 1 + 0x1p-20) + 0x1p-120); }

ABUT_HD inline far_bounds write_far_terms(const winding_moments& all, far_terms& terms, int node) {
    const double *const m = all.m, *const q = all.q, unit = per_full_angle, r = all.radius;
    const double of[15] = {all.s.x, all.s.y, all.s.z, m[0], m[1], m[3], m[4], m[5], q[0], q[1], q[2], q[6], q[7], q[8], q[9]};
    double sum[3] = {};
    for (int k = 0; k < 15; ++k) {
        const int degree = k < 3 ? 0 : k < 8 ? 1 : 2;
        const double term = plain_product(of[k], degree == 0 ? unit : degree == 1 ? -3 * unit : 7.5 * unit);
        const auto high = static_cast<float>(term);
        terms.high[k][node] = high;
        terms.low[k][node] = static_cast<float>(plain_sum(term, -static_cast<double>(high)));
        sum[degree] = plain_sum(sum[degree], absolute(term));
    }
    if (!(r > 0)) return {rounded_up(0), 0, 0};
    // Less than forty roundings are one upon another, of parts that add up to no more than this: a coefficient of Q comes with
    // a polynomial of at most 3/2 d^3, and r < d.
    const double parts = plain_sum(plain_sum(sum[0], sum[1] / r), 1.5 * (sum[2] / r) / r);
    return {rounded_up(r), rounded_up(plain_product(all.spread / r / r, per_full_angle * (1 + 0x1p-8))),
            rounded_up(plain_product(40 * 0x1p-24, parts))};
}

/// By how much a far field may be off at a distance whose square is given, in floats: infinite where the gap to the ball has
/// lost its digits, and where products are out of range. The weight makes up for what is rounded here: of the gap by 2^-11 or
/// less.
template <class N>
ABUT_INLINE ABUT_HD N far_error(const N& squared, const N& radius, const N& weight, const N& noise) {
    const N one = N::of(1), inverse = one / root(squared), square = inverse * inverse, x = radius * inverse, gap = one - x;
    const N error = (weight * square * (x * x * x) * (N::of(4) - N::of(3) * x)) / (gap * gap) + noise * square;
    const auto is_outside = (gap > N::of(0x1p-10f)) & (squared > N::of(1e-30f)) & (squared < N::of(1e30f));
    return select(is_outside, error + N::of(1e-30f), N::of(infinity<float>));
}

/// The far field at v from the centre of a node, of which these are the coefficients.
template <class N>
ABUT_INLINE ABUT_HD N far_value(const vec3<N>& v, const N (&term)[15]) {
    const N xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z, x_z = xx - zz, y_z = yy - zz, x_y = xx - yy;
    const N inverse = N::of(1) / root(xx + yy + zz), square = inverse * inverse, yz = v.y * v.z;
    const N of_s = term[0] * v.x + term[1] * v.y + term[2] * v.z;
    const N of_m = term[3] * x_z + term[4] * y_z + term[5] * (v.x * v.y) + term[6] * yz + term[7] * (v.z * v.x);
    const N of_q = v.x * (term[8] * (x_z - (zz + zz)) + term[11] * y_z) - v.y * (term[9] * (x_y + (xx + xx)) + term[12] * x_z) +
                   v.z * (term[13] * x_y - term[10] * (y_z + (yy + yy))) + term[14] * (v.x * yz);
    // One factor at a time: the terms and their powers of the distance are far apart.
    return inverse * square * (of_s + square * (of_m + square * of_q));
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
