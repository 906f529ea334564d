// SPDX-License-Identifier: MIT
#pragma once

// A shape of one's own: a solid upright cylinder, in a namespace that is not abut's, and what abut asks of it.
// docs/extending.md walks through this file, and tests/collide/extending.test.cpp tries it in all queries.

#include <abut/abut.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/plain_sign.hpp>

namespace plant {

/// All points over the disc around `foot`, up to `height` above it. Radius and height may be 0: a segment, a disc, a point.
template <abut::scalar T>
struct cylinder {
    abut::vec3<T> foot;
    T radius, height;
};

// 1. What every shape has: a box around it. add_up and add_down round outward.

template <abut::scalar T>
ABUT_HD constexpr abut::aabb<T> bounds(const cylinder<T>& c) {
    const abut::vec3<T>& f = c.foot;
    return {{abut::add_down(f.x, -c.radius), abut::add_down(f.y, -c.radius), f.z},
            {abut::add_up(f.x, c.radius), abut::add_up(f.y, c.radius), abut::add_up(f.z, c.height)}};
}

// 2. Which numbers are a cylinder.

template <abut::scalar T>
ABUT_HD constexpr bool is_valid(const cylinder<T>& c) {
    return abut::is_valid(c.foot) && c.radius >= 0 && c.radius <= abut::largest_finite<T> && c.height >= 0 &&
           c.height <= abut::largest_finite<T>;
}

// 3. Does it meet a triangle? The polynomials, once, over any number type N: plain numbers for `fast`, integers as wide as
// need be for `exact`.
//
// With the foot as the origin, the question is whether x^2 + y^2 is at most r^2 somewhere on the part of the triangle that
// lies between the heights 0 and h. That part is a convex polygon, and x^2 + y^2 is convex: it is least at a corner of the
// polygon, inside one of its sides, or inside the polygon. Its corners are corners of the triangle, or points in which a
// side of the triangle passes one of the two heights. Its sides are parts of the triangle's sides, or cuts through the
// triangle at one of the heights. And inside it is least where the axis passes through. So five kinds of features are asked
// whether they have a point in the cylinder, and one "yes" will do. How the triangle lies is never asked. What is inside is
// strictly inside, so a side or a triangle without extent has no inside, and degenerate triangles need no case of their own.

struct cylinder_meets_triangle {
    /// The values: three corners, the foot, radius and height.
    template <class N>
    ABUT_HD static constexpr bool holds(const N (&value)[14]) {
        const auto point = [&](int i) { return abut::vec3<N>{value[3 * i], value[3 * i + 1], value[3 * i + 2]}; };
        const auto a = point(0) - point(3), b = point(1) - point(3), c = point(2) - point(3);
        const auto ab = point(1) - point(0), bc = point(2) - point(1), ca = point(0) - point(2);
        const N &r = value[12], &h = value[13];
        return corner(a, r, h) || corner(b, r, h) || corner(c, r, h) || side(a, b, ab, r, h) || side(b, c, bc, r, h) ||
               side(c, a, ca, r, h) || axis(a, b, c, h) ||
               at_height(a, b, c, ab, bc, ca, abut::vec3<decltype(a.z)>{a.z, b.z, c.z}, r) ||
               at_height(a, b, c, ab, bc, ca, abut::vec3<decltype(a.z - h)>{a.z - h, b.z - h, c.z - h}, r);
    }

private:
    /// x and y alone.
    template <class N>
    ABUT_HD static constexpr abut::vec3<N> flat(const N& x, const N& y) {
        return {x, y, N{}};
    }
    template <class N, class M>
    ABUT_HD static constexpr auto cross_flat(const abut::vec3<N>& p, const abut::vec3<M>& q) {
        return p.x * q.y - p.y * q.x;
    }

    /// A corner. Degree 2.
    template <class P, class N>
    ABUT_HD static constexpr bool corner(const abut::vec3<P>& p, const N& r, const N& h) {
        return abut::sign(p.z) >= 0 && abut::sign(p.z - h) <= 0 && abut::squares_at_most(flat(p.x, p.y), r);
    }

    /// Inside a side pq, its point nearest to the axis, n / d of the way from p to q: its height is p.z + pq.z n / d, and
    /// its distance |p x q| / sqrt(d). Degree 4.
    template <class P, class D, class N>
    ABUT_HD static constexpr bool side(const abut::vec3<P>& p, const abut::vec3<P>& q, const abut::vec3<D>& pq, const N& r,
                                       const N& h) {
        const auto along = flat(pq.x, pq.y);
        if (abut::sign_of_dot(along, p) >= 0 || abut::sign_of_dot(along, q) <= 0) return false;
        const auto d = along.x * along.x + along.y * along.y, minus_n = along.x * p.x + along.y * p.y;
        return abut::sign(p.z * d - minus_n * pq.z) >= 0 && abut::sign((p.z - h) * d - minus_n * pq.z) <= 0 &&
               abut::squares_at_most(cross_flat(p, q), abut::scale(r, along));
    }

    /// The axis, where it passes through the triangle: seen from above, the weights of the corners there are u, v and w, all
    /// of one sign. Degree 3.
    template <class P, class N>
    ABUT_HD static constexpr bool axis(const abut::vec3<P>& a, const abut::vec3<P>& b, const abut::vec3<P>& c, const N& h) {
        const auto u = cross_flat(b, c), v = cross_flat(c, a), w = cross_flat(a, b);
        const int su = abut::sign(u), sv = abut::sign(v), sw = abut::sign(w);
        const int s = su != 0 ? su : sv != 0 ? sv : sw;
        if (s == 0 || su == -s || sv == -s || sw == -s) return false;
        const auto height = u * a.z + v * b.z + w * c.z;
        return s * abut::sign(height) >= 0 && s * abut::sign(height - (u + v + w) * h) <= 0;
    }

    /// The triangle at one of the heights, over which the corners are by `over`: where its sides pass there, and the cut.
    template <class P, class D, class Z, class N>
    ABUT_HD static constexpr bool at_height(const abut::vec3<P>& a, const abut::vec3<P>& b, const abut::vec3<P>& c,
                                            const abut::vec3<D>& ab, const abut::vec3<D>& bc, const abut::vec3<D>& ca,
                                            const abut::vec3<Z>& over, const N& r) {
        return passing(a, b, over.x, over.y, ab.z, r) || passing(b, c, over.y, over.z, bc.z, r) ||
               passing(c, a, over.z, over.x, ca.z, r) || cut(a, b, c, over.x, over.y, over.z, ab, ca, r) ||
               cut(b, c, a, over.y, over.z, over.x, bc, ab, r) || cut(c, a, b, over.z, over.x, over.y, ca, bc, r);
    }

    /// The point of pq, or of the line on, at height 0, times the difference of the heights.
    template <class P, class Z>
    ABUT_HD static constexpr auto point_between(const abut::vec3<P>& p, const abut::vec3<P>& q, const Z& over_p,
                                                const Z& over_q) {
        return flat(p.x * over_q - q.x * over_p, p.y * over_q - q.y * over_p);
    }

    /// Degree 4.
    template <class P, class Z, class D, class N>
    ABUT_HD static constexpr bool passing(const abut::vec3<P>& p, const abut::vec3<P>& q, const Z& over_p, const Z& over_q,
                                          const D& rise, const N& r) {
        return abut::sign(over_p) * abut::sign(over_q) < 0 &&
               abut::squares_at_most(point_between(p, q, over_p, over_q), r * rise);
    }

    /// Inside the cut, its point nearest to the axis, if p is on one side of the height and q and s are not: the cut goes
    /// from pq to sp, and lies on the line n.x x + n.y y = k, with n the triangle's normal. Degree 6.
    template <class P, class Z, class D, class N>
    ABUT_HD static constexpr bool cut(const abut::vec3<P>& p, const abut::vec3<P>& q, const abut::vec3<P>& s,
                                      const Z& over_p, const Z& over_q, const Z& over_s, const abut::vec3<D>& pq,
                                      const abut::vec3<D>& sp, const N& r) {
        const int up = abut::sign(over_p);
        if (up == 0 || abut::sign(over_q) == up || abut::sign(over_s) == up) return false;
        const auto on_pq = point_between(p, q, over_p, over_q), on_sp = point_between(s, p, over_s, over_p);
        // Both of these are to be divided by a rise: by pq.z, of sign -up, and by sp.z, of sign up.
        const auto backwards = flat(on_sp.x * pq.z - on_pq.x * sp.z, on_sp.y * pq.z - on_pq.y * sp.z);
        if (abut::sign_of_dot(backwards, on_pq) * up >= 0 || abut::sign_of_dot(backwards, on_sp) * up >= 0) return false;
        const auto n = abut::cross(pq, sp);
        const auto k = n.x * p.x + n.y * p.y + n.z * over_p;
        return abut::squares_at_most(k, abut::scale(r, flat(n.x, n.y)));
    }
};

template <abut::scalar T>
struct cylinder_values {
    T value[14];
};

template <abut::scalar T>
ABUT_HD constexpr cylinder_values<T> values_of(const cylinder<T>& c, const abut::triangle<T>& t) {
    return {
        {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z, c.foot.x, c.foot.y, c.foot.z, c.radius, c.height}};
}

// 4. The filter: what floating point is certain of, and `unknown` where it is not. Here it knows corners that are well
// inside. A thousandth of the radius and of the height is far more than these few roundings can lose, and sizes are such
// that nothing overflows or underflows. A filter that always says `unknown` would be right too, and slow.

template <abut::scalar T>
ABUT_HD constexpr bool is_well_inside(const cylinder<T>& c, const abut::vec3<T>& p) {
    const double r = static_cast<double>(c.radius), h = static_cast<double>(c.height);
    if (!(r > 1e-100 && r < 1e100 && h > 1e-100 && h < 1e100)) return false;
    const double x = static_cast<double>(p.x) - static_cast<double>(c.foot.x),
                 y = static_cast<double>(p.y) - static_cast<double>(c.foot.y),
                 z = static_cast<double>(p.z) - static_cast<double>(c.foot.z);
    return z > 0.001 * h && z < 0.999 * h && x * x + y * y < 0.999 * (r * r);
}

// 5. The stages, for one order of the two shapes.

template <abut::arithmetic A, abut::scalar T>
ABUT_HD constexpr abut::verdict decide(const cylinder<T>& c, const abut::triangle<T>& t) {
    if constexpr (std::same_as<A, abut::exact>) {
        return abut::decide_in_limbs<cylinder_meets_triangle>(values_of(c, t).value);
    } else if constexpr (std::same_as<A, abut::filtered>) {
        const bool inside = is_well_inside(c, t.a) || is_well_inside(c, t.b) || is_well_inside(c, t.c);
        return inside ? abut::verdict::yes : abut::verdict::unknown;
    } else {
        return abut::to_verdict(cylinder_meets_triangle::holds(values_of(c, t).value));
    }
}

/// What is left: exponents too far apart for integers of fixed width.
template <abut::scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const cylinder<T>& c, const abut::triangle<T>& t) {
    return abut::decide_at_any_span<cylinder_meets_triangle>(values_of(c, t).value);
}

}  // namespace plant
