// SPDX-License-Identifier: MIT
#pragma once

// What many triangles together contribute to a winding number from afar: of each node of a tree the first moments of its
// triangles, and how far the sum that is made of them can be off (G. Barill, N. Dickson, R. Schmidt, D. Levin, A. Jacobson:
// Fast Winding Numbers for Soups and Clouds, 2018, whose expansion this is; it has no bound, which is below).
//
// Seen from p, a surface contributes the integral of n . grad f over 4 pi, where f(x) = -1 / |x - p| and n is the normal.
// With x = c + y, v = c - p, d = |v| and u = v / d, f is the sum over l of -h_l(y) / d^(l + 1), where h_l is the homogeneous
// harmonic polynomial |y|^l P_l(-cos) of the angle between y and u. The terms to l = L are kept. What of y is left in the
// integrals of their gradients are moments of the surface about c, forms in u:
//
//   F_l(u) = integral of (n.u) (y.u)^(l - 1)
//   4 pi w = F_1 / d^2 - 3 F_2 / d^3 + 15/2 F_3 / d^4 - 35/2 F_4 / d^5 ...
//
// with the leading coefficients of P_l, times l and (-1)^(l + 1). That holds of the harmonic part of F_l: what is |u|^2 times
// another form belongs to a derivative of a harmonic function without trace, and so to none.
//
// The harmonic part is what F_l is where u.u = 0, of complex u, which are (s^2 - t^2) / 2, (s^2 + t^2) / 2i and s t. So a form is
// kept as a polynomial in s and t, the sum over |m| <= l of g_m s^(l + m) t^(l - m), where g_-m is (-1)^m times the conjugate
// of g_m: 2 l + 1 numbers. A product of forms is one of polynomials. With z = u.x + i u.y the harmonic part is
//
//   g_0 q_l0(u.z) + 2 Re of the sum over m > 0 of g_m z^m q_lm(u.z),   q_lm = x^(l - m) + ..., the m-th derivative of P_l
//
// The rest: |h_l| <= |y|^l, since |P_l| <= 1. A homogeneous polynomial of degree l that is at most 1 on the unit sphere has
// a gradient of at most l there (S. Banach, Über homogene Polynome in (L2), 1938). So what is left out is, with |y| <= r < d
// and R2 the integral of |y|^2, at most
//
//   sum over l > L of l r^(l - 3) R2 / d^(l + 1)  =  R2 r^(L - 2) ((L + 1) d - L r) / (d^(L + 1) (d - r)^2)

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

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

inline constexpr int far_degree = 5;                               ///< L
inline constexpr int far_count = far_degree * (far_degree + 2);    ///< of numbers that forms of degrees 1 to L have

namespace winding {

using contact_math::one_double;
using vector = vec3<one_double>;

ABUT_HD constexpr one_double number(double x) { return {x}; }
ABUT_HD constexpr vector vector_of(const vec3<double>& v) { return {{v.x}, {v.y}, {v.z}}; }
ABUT_HD constexpr double length_of(const vector& v) { return contact_math::root(dot(v, v)).high; }

/// Adds v.u times a form of degree l - 1 to one of degree l. Their numbers are g_0, then real and imaginary parts of g_1, g_2 ...
ABUT_HD constexpr void add_product(one_double* to, const vector& v, const one_double* by, int l) {
    // v.u = g_1 s^2 + v.z s t - conj(g_1) t^2
    const one_double x = number(0.5) * v.x, y = number(0.5) * v.y;
    to[0] = to[0] + v.z * by[0];
    if (l > 1) to[0] = to[0] - number(2) * (x * by[1] - y * by[2]);
    for (int m = 1; m <= l; ++m) {
        one_double re = x * (m > 1 ? by[2 * m - 3] : by[0]), im = -(y * (m > 1 ? by[2 * m - 3] : by[0]));
        if (m > 1) re = re + y * by[2 * m - 2], im = im + x * by[2 * m - 2];
        if (m < l) re = re + v.z * by[2 * m - 1], im = im + v.z * by[2 * m];
        if (m + 1 < l) {
            re = re - (x * by[2 * m + 1] - y * by[2 * m + 2]);
            im = im - (x * by[2 * m + 2] + y * by[2 * m + 1]);
        }
        to[2 * m - 1] = to[2 * m - 1] + re;
        to[2 * m] = to[2 * m] + im;
    }
}
/// Where the numbers of a form begin.
ABUT_HD constexpr int first_of(int l) { return l * l - 1; }

/// A double to so many bits (T. J. Dekker, A floating-point technique for extending the available precision, 1971). Casts to float
/// and back would do as well, if g++ 12 did not drop both where it makes vectors of them.
ABUT_HD inline double of_bits(double x, int bits) {
    const double more = plain_product(x, contact_math::power_of_two(53 - bits) + 1);
    return plain_sum(more, -plain_sum(more, -x));
}
/// As the sum of two floats, of 48 bits.
ABUT_HD inline void write_floats(double x, float& high, float& low) {
    const double first = of_bits(x, 24);
    high = static_cast<float>(first);
    low = static_cast<float>(plain_sum(x, -first));
}
ABUT_HD inline vec3<double> held_by_floats(const vector& v) {
    return {of_bits(v.x.high, 46), of_bits(v.y.high, 46), of_bits(v.z.high, 46)};
}

}  // namespace winding

/// The moments of some triangles about a centre.
struct winding_moments {
    using point = vec3<double>;
    point center, lower, upper;  ///< two floats hold each coordinate of the centre; and the box around the corners
    double radius;               ///< no corner is farther from the centre
    double area, spread;         ///< the triangles' area, and R2 or more
    winding::one_double form[far_count];  ///< F_1, F_2 ...
    std::uint32_t count;                  ///< of triangles
};

/// The corners of a triangle.
struct corners_in_frame {
    winding::vector at[3];

    template <scalar T>
    ABUT_HD corners_in_frame(const triangle<T>& t, const winding_frame& frame)
        : at{winding::vector_of(frame.of(widened(t.a))), winding::vector_of(frame.of(widened(t.b))), winding::vector_of(frame.of(widened(t.c)))} {}
    [[nodiscard]] ABUT_HD winding::vector normal() const {
        return scale(winding::number(0.5), cross(at[1] - at[0], at[2] - at[0]));
    }
    /// Adds its moments about a centre.
    ABUT_HD void add_forms(const vec3<double>& center, winding::one_double* to) const {
        using namespace winding;
        // The mean of (y.u)^k is 2 k! / (k + 2)! times the sum of all products of k of the corners' (y.u).
        one_double mean[far_count] = {};  // of degrees 0 to L - 1
        mean[0] = number(1);
        for (const vector& corner : at) {
            const vector way = corner - vector_of(center);
            for (int k = 1; k < far_degree; ++k) add_product(mean + k * k, way, mean + (k - 1) * (k - 1), k);
        }
        const vector n = normal();
        for (int l = 1; l <= far_degree; ++l) {
            add_product(to + first_of(l), scale(number(2.0 / (l * (l + 1))), n), mean + (l - 1) * (l - 1), l);
        }
    }
};

/// Of one triangle, about the mean of its corners as it is rounded, but the forms, which are 0.
ABUT_HD inline winding_moments place_of(const corners_in_frame& t) {
    using namespace winding;
    const vector &a = t.at[0], &b = t.at[1], &c = t.at[2], sum = a + b + c;
    winding_moments of;
    of.center = held_by_floats({sum.x / number(3), sum.y / number(3), sum.z / number(3)});
    const vector center = vector_of(of.center), to[3] = {a - center, b - center, c - center}, all = to[0] + to[1] + to[2];
    for (one_double& x : of.form) x = number(0);
    of.lower = {least(a.x.high, b.x.high, c.x.high), least(a.y.high, b.y.high, c.y.high), least(a.z.high, b.z.high, c.z.high)};
    of.upper = {greatest(a.x.high, b.x.high, c.x.high), greatest(a.y.high, b.y.high, c.y.high),
                greatest(a.z.high, b.z.high, c.z.high)};
    of.count = 1;
    of.radius = greatest(length_of(to[0]), length_of(to[1]), length_of(to[2]));
    of.area = length_of(t.normal());
    // The mean of a square is that of corners' squares, and the square of their sum, over 12.
    one_double squares = dot(all, all);
    for (const vector& way : to) squares = squares + dot(way, way);
    of.spread = (number(of.area) * squares / number(12)).high;
    return of;
}
/// And the forms.
template <scalar T>
ABUT_HD winding_moments moments_of(const triangle<T>& t, const winding_frame& frame) {
    const corners_in_frame corners(t, frame);
    winding_moments of = place_of(corners);
    corners.add_forms(of.center, of.form);
    return of;
}

/// Of two parts or more, about the centre of their areas. Forms of single triangles may be left to the caller.
ABUT_HD inline winding_moments joined_moments(const winding_moments* parts, int count, double off_center, bool without_triangles = false) {
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
    all.center = held_by_floats(center);
    center = vector_of(all.center);
    all.area = area.high;
    all.lower = parts[0].lower, all.upper = parts[0].upper, all.count = parts[0].count;
    for (int k = 1; k < count; ++k) {
        all.lower = least(all.lower, parts[k].lower);
        all.upper = greatest(all.upper, parts[k].upper);
        all.count += parts[k].count;
    }
    for (one_double& x : all.form) x = number(0);
    one_double spread{};
    double radius = 0;
    for (int k = 0; k < count; ++k) {
        const winding_moments& part = parts[k];
        const vector way = vector_of(part.center) - center;
        const one_double moved = number(length_of(way));
        radius = greatest(radius, (moved + number(part.radius)).high);
        // R2 about a centre that is moved from that of the area is R2 + area times the square; a part's is not quite that.
        const one_double reach = moved + number(off_center);
        spread = spread + (number(part.spread) + number(part.area) * (reach * reach));
        if (without_triangles && part.count == 1) continue;
        // About the new centre (y.u)^k is (y.u + way.u)^k: binomials, as in Pascal's triangle.
        one_double form[far_count];
        for (int j = 0; j < far_count; ++j) form[j] = part.form[j];
        for (int least = 2; least <= far_degree; ++least) {
            for (int l = far_degree; l >= least; --l) add_product(form + first_of(l), way, form + first_of(l - 1), l);
        }
        for (int j = 0; j < far_count; ++j) all.form[j] = all.form[j] + form[j];
    }
    // The box's farthest corner may be nearer than what the parts' balls say.
    const vec3<double> far = greatest(contact_math::plain_difference(all.upper, all.center),
                                      contact_math::plain_difference(all.center, all.lower));
    all.radius = plain_product(least(radius, length_of(vector_of(far))), 1 + 0x1p-46);
    all.spread = spread.high;
    return all;
}

inline constexpr double per_full_angle = 0.079577471545947668;  ///< 1 / (4 pi)

/// What a walk reads of the far fields of four nodes: the numbers of F_l / r^l, over 4 pi and with the factors of the expansion and
/// of g_m. So all are like the area over r, and no product of floats is too small, however small the node. One is the sum of two
/// floats, of which the first may do.
struct alignas(16) far_terms {
    static constexpr int count = far_count;
    float high[count][4], low[count][4];
};
/// And what its error is made of: the radius; the factor of the bound that does not depend on the point, R2 / (4 pi r^2); and
/// what floats may lose of F_1 and F_2, and of the others, as factors of 1 / d^2 and r^2 / d^4. Rounded up.
struct far_bounds {
    float radius, weight, noise, noise_of_high;
};

ABUT_HD inline float rounded_up(double x) { return static_cast<float>(plain_product(x, 1 + 0x1p-20) + 0x1p-120); }

ABUT_HD inline far_bounds write_far_terms(const winding_moments& all, far_terms& terms, int node) {
    const float radius = rounded_up(all.radius);
    const auto r = static_cast<double>(radius);
    // The leading coefficient of P_l, over r^l: that of P_(l + 1) is (2 l + 1) / (l + 1) of it.
    double leading = per_full_angle / r, parts[2] = {};
    for (int l = 1; l <= far_degree; ++l) {
        for (int k = 0; k < 2 * l + 1; ++k) {
            const int at = winding::first_of(l) + k;
            const double term = plain_product(all.form[at].high, plain_product(leading, k == 0 ? 1.0 * l : 2.0 * l));
            winding::write_floats(term, terms.high[at][node], terms.low[at][node]);
            double& part = parts[l < 3 ? 0 : 1];
            part = plain_sum(part, absolute(term));
        }
        leading = plain_product(leading, -(2.0 * l + 1) / (l + 1)) / r;
    }
    // A coordinate of the way over d is off by less than 16 2^-24, so a form of degree l by 16 l 2^-24 and by what some thirty
    // roundings more leave, of parts that add up to no more than this: |z^m q_lm| is at most 5/2 (3/2 for l < 3) with all its parts
    // positive, and r < d.
    const auto noise = [&](double units, double x) { return rounded_up(plain_product(plain_product(units * 0x1p-24, r), x)); };
    return {radius, rounded_up(plain_product(all.spread / r / r, per_full_angle * (1 + 0x1p-8))), noise(1.5 * 64, parts[0]),
            noise(2.5 * 110, parts[1])};
}

/// By how much a far field may be off at a distance whose square is given, in floats: infinite where the gap to the ball has
/// lost its digits, and where products are out of range. The weight makes up for what is rounded here: of the gap by 2^-11 or
/// less.
template <class N>
ABUT_INLINE ABUT_HD N far_error(const N& squared, const N& radius, const N& weight, const N& noise, const N& noise_of_high) {
    const N distance = root(squared), inverse = N::of(1) / distance, by_gap = N::of(1) / (distance - radius);
    const N square = inverse * inverse, x = radius * inverse, x2 = x * x, stretch = distance * by_gap;
    static_assert(far_degree == 5);
    const N left_out = (weight * (x2 * x2 * x)) * (N::of(far_degree + 1) - N::of(far_degree) * x) * (stretch * stretch);
    const N error = square * (left_out + (noise + noise_of_high * x2));
    const auto both = [](const auto& one, const auto& other) {
        if constexpr (std::same_as<std::remove_cvref_t<decltype(one)>, bool>) {
            return one && other;
        } else {
            return one & other;
        }
    };
    const auto is_outside = both(distance - radius > N::of(0x1p-10f) * distance, both(squared > N::of(1e-30f), squared < N::of(1e30f)));
    return select(is_outside, error + N::of(1e-30f), N::of(infinity<float>));
}

/// Adds what the numbers of degrees l and above say of order m to re + i im; q and below are q_lm and that of degree l - 1, as
/// forms: `squared` is the square of the way's length, of which z is a coordinate.
template <int L, int M, class N, class Terms>
ABUT_INLINE ABUT_HD void add_order(const Terms& term, const N& z, const N& squared, const N& q, const N& below, N& re, N& im) {
    constexpr int at = winding::first_of(L);
    re = re + q * term[M > 0 ? at + 2 * M - 1 : at];
    if constexpr (M > 0) im = im + q * term[at + 2 * M];
    if constexpr (L < far_degree) {
        constexpr float ratio = static_cast<float>((L * L - M * M) / (4.0 * L * L - 1));
        add_order<L + 1, M>(term, z, squared, z * q - (N::of(ratio) * squared) * below, q, re, im);
    }
}
/// Of orders m and below, where re + i im is what higher ones say, over (x + i y)^(m + 1).
template <int M, class N, class Terms>
ABUT_INLINE ABUT_HD N sum_of_orders(const Terms& term, const vec3<N>& v, const N& squared, const N& re, const N& im) {
    const N one = N::of(1);
    N real = re * v.x - im * v.y;
    if constexpr (M == 0) {
        N none = one;
        add_order<1, 0>(term, v.z, squared, v.z, one, real, none);
        return real;
    } else {
        constexpr int at = winding::first_of(M);
        N imaginary = re * v.y + im * v.x;
        real = real + term[at + 2 * M - 1];
        imaginary = imaginary + term[at + 2 * M];
        if constexpr (M < far_degree) add_order<M + 1, M>(term, v.z, squared, v.z, one, real, imaginary);
        return sum_of_orders<M - 1>(term, v, squared, real, imaginary);
    }
}

/// The far field at `way` from the centre of a node, of which term[k] are the coefficients.
template <class N, class Terms>
ABUT_INLINE ABUT_HD N far_value(const vec3<N>& way, const N& radius, const Terms& term) {
    const N inverse = N::of(1) / root(dot(way, way)), unit = radius * (inverse * inverse);
    const vec3<N> v{way.x * unit, way.y * unit, way.z * unit};  // x u
    constexpr int at = winding::first_of(far_degree) + 2 * far_degree;
    return inverse * sum_of_orders<far_degree - 1>(term, v, radius * unit, N(term[at - 1]), N(term[at]));
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
                parts[k] = child.is_leaf() ? place_of(corners_in_frame(shapes[child.index()], frame)) : moments[child.index()];
            }
            winding_moments all = joined_moments(parts, children, off_center, true);
            // Of triangles they are made where they are wanted, instead of being moved there.
            for (int k = 0; k < children; ++k) {
                const bvh_child child = tree.child(node, k);
                if (child.is_leaf()) corners_in_frame(shapes[child.index()], frame).add_forms(all.center, all.form);
            }
            moments[number] = all;
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
    // In each of 96 levels at most a centre is rounded, to 46 bits, and the areas that weigh it: by 2^-43 or less.
    for_each_index(on, count, gather{tree, shapes, frame, 0x1p-36, above, reached.data(), moments.data()});
    return moments;
}

}  // namespace abut::detail
