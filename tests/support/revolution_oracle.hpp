// SPDX-License-Identifier: MIT
#pragma once

// The oracle for cylinders and cones, in rationals. It shares no formula with the library: a polygon (a point, a segment, a
// triangle or the face of a box) is cut by the two planes of the solid's ends, and the quadratic F that is not negative in
// the solid is evaluated where it is greatest: at a corner of what is left, inside a side, or where its gradient is 0. For
// if no border of what is left meets the solid, then the solid has a whole ellipse of the polygon's plane, whose centre that
// is, or nothing. For balls and planes the distance is computed with so many digits that what seems 0 is 0.

#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/primitive.hpp>

#include "rational.hpp"

namespace abut::test {

using fraction = boost::multiprecision::cpp_rational;

struct fraction_point {
    fraction x, y, z;
    friend fraction_point operator+(const fraction_point& a, const fraction_point& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend fraction_point operator-(const fraction_point& a, const fraction_point& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend fraction_point operator*(const fraction& s, const fraction_point& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend fraction inner(const fraction_point& a, const fraction_point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

/// A cylinder or a cone whose first end is the origin, and which has an axis.
struct exact_solid {
    bool is_cone;
    fraction_point d;
    fraction r, dd;

    [[nodiscard]] fraction height(const fraction_point& x) const { return inner(x, d); }
    /// The polar form of F, and of the cylinder's its part of degree 2; `c` is what that lacks.
    [[nodiscard]] fraction form(const fraction_point& x, const fraction_point& y) const {
        const fraction across = inner(x, y) * dd - height(x) * height(y);
        return is_cone ? fraction(r * r * height(x) * height(y) - across * dd) : fraction(-across);
    }
    [[nodiscard]] fraction constant() const { return is_cone ? fraction(0) : fraction(r * r * dd); }
    [[nodiscard]] fraction value(const fraction_point& x) const { return form(x, x) + constant(); }
};

/// What a convex polygon has on the side of a plane where sign * (height - level) >= 0.
inline std::vector<fraction_point> part_of(const std::vector<fraction_point>& polygon, const exact_solid& s,
                                           const fraction& level, int side) {
    std::vector<fraction_point> part;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        const fraction_point &a = polygon[i], &b = polygon[(i + 1) % n];
        const fraction u = side * (s.height(a) - level), v = side * (s.height(b) - level);
        if (u >= 0) part.push_back(a);
        if ((u < 0 && v > 0) || (u > 0 && v < 0)) part.push_back(a + fraction(u / (u - v)) * (b - a));
    }
    return part;
}

/// Of a convex polygon, its corners in order; one of two corners is a segment.
inline bool polygon_meets(std::vector<fraction_point> polygon, const exact_solid& s) {
    polygon = part_of(polygon, s, 0, 1);
    polygon = part_of(polygon, s, s.dd, -1);
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        const fraction_point &a = polygon[i], &b = polygon[(i + 1) % n];
        if (s.value(a) >= 0) return true;
        const fraction_point e = b - a;
        const fraction bend = s.form(e, e), slope = s.form(a, e);
        if (bend >= 0) continue;
        const fraction t = -slope / bend;
        if (t > 0 && t < 1 && s.value(a + t * e) >= 0) return true;
    }
    // Where the gradient along the plane is 0, strictly inside of a triangle of the fan.
    for (std::size_t i = 2; i < n; ++i) {
        const fraction_point &o = polygon[0], e = polygon[i - 1] - o, f = polygon[i] - o;
        const fraction ee = s.form(e, e), ef = s.form(e, f), ff = s.form(f, f), oe = s.form(o, e), of = s.form(o, f);
        const fraction determinant = ee * ff - ef * ef;
        if (determinant == 0) continue;
        const fraction u = (ef * of - ff * oe) / determinant, v = (ef * oe - ee * of) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && s.value(o + u * e + v * f) >= 0) return true;
    }
    return false;
}

namespace oracle {

template <scalar T>
const segment<T>& axis_of(const cylinder<T>& s) {
    return s.axis;
}
template <scalar T>
segment<T> axis_of(const cone<T>& s) {
    return {s.apex, s.base_center};
}

template <class S>
inline constexpr bool is_revolved = false;
template <scalar T>
inline constexpr bool is_revolved<cylinder<T>> = true;
template <scalar T>
inline constexpr bool is_revolved<cone<T>> = true;

/// Numbers of a solid and of some points, as fractions of one unit, seen from the solid's first end.
template <template <class> class Solid, scalar T>
std::vector<fraction_point> seen_from(const Solid<T>& s, const std::vector<vec3<T>>& points, exact_solid& solid) {
    const segment<T> axis = axis_of(s);
    std::vector<T> numbers{axis.a.x, axis.a.y, axis.a.z, axis.b.x, axis.b.y, axis.b.z, s.radius};
    for (const vec3<T>& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    const std::vector<integer> v = to_integers(numbers);
    const auto point = [&](std::size_t i) {
        return fraction_point{fraction(v[i] - v[0]), fraction(v[i + 1] - v[1]), fraction(v[i + 2] - v[2])};
    };
    solid = {std::same_as<Solid<T>, cone<T>>, point(3), fraction(v[6]), 0};
    solid.dd = inner(solid.d, solid.d);
    std::vector<fraction_point> seen;
    for (std::size_t i = 7; i < v.size(); i += 3) seen.push_back(point(i));
    return seen;
}

template <template <class> class Solid, scalar T>
    requires(std::same_as<Solid<T>, cylinder<T>> || std::same_as<Solid<T>, cone<T>>)
bool polygon_meets_solid(const Solid<T>& s, const std::vector<vec3<T>>& corners) {
    exact_solid solid;
    const auto polygon = seen_from(s, corners, solid);
    if (solid.dd == 0) {
        std::vector<integer_point> w;
        for (const fraction_point& p : polygon) w.push_back({numerator(p.x), numerator(p.y), numerator(p.z)});
        return hull_reaches(w, numerator(fraction(solid.r * solid.r)));
    }
    return polygon_meets(polygon, solid);
}

template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const vec3<T>& p) {
    return polygon_meets_solid(s, {p});
}
template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const segment<T>& t) {
    return polygon_meets_solid(s, {t.a, t.b});
}
template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const triangle<T>& t) {
    return polygon_meets_solid(s, {t.a, t.b, t.c});
}

/// The faces of the box, and an end of the axis.
template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const aabb<T>& box) {
    const vec3<T>&l = box.lower, &u = box.upper;
    const vec3<T> end = axis_of(s).a;
    if (l.x <= end.x && end.x <= u.x && l.y <= end.y && end.y <= u.y && l.z <= end.z && end.z <= u.z) return true;
    for (int side = 0; side < 2; ++side) {
        const T x = side == 0 ? l.x : u.x, y = side == 0 ? l.y : u.y, z = side == 0 ? l.z : u.z;
        if (polygon_meets_solid(s, {{x, l.y, l.z}, {x, u.y, l.z}, {x, u.y, u.z}, {x, l.y, u.z}}) ||
            polygon_meets_solid(s, {{l.x, y, l.z}, {u.x, y, l.z}, {u.x, y, u.z}, {l.x, y, u.z}}) ||
            polygon_meets_solid(s, {{l.x, l.y, z}, {u.x, l.y, z}, {u.x, u.y, z}, {l.x, u.y, z}})) {
            return true;
        }
    }
    return false;
}

/// Numbers of so many binary digits that two which are computed from input of the type T differ before the last quarter of
/// them, or not at all; but for exponents that are drawn from all that doubles have, where no two meet by chance.
template <scalar T>
using long_float =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<std::same_as<T, float> ? 5000 : 9000,
                                                                       boost::multiprecision::digit_base_2, void, int>,
                                  boost::multiprecision::et_off>;

template <class N>
bool is_at_most(const N& a, const N& b) {
    return a <= b + ldexp(abs(b), -std::numeric_limits<N>::digits * 3 / 4);
}

/// The distance of (x, y) from the segment from (a, b) to (c, d).
template <class N>
N distance_in_plane(const N& x, const N& y, const N& a, const N& b, const N& c, const N& d) {
    const N length = (c - a) * (c - a) + (d - b) * (d - b);
    N t = length == 0 ? N(0) : N(((x - a) * (c - a) + (y - b) * (d - b)) / length);
    if (t < 0) t = 0;
    if (t > 1) t = 1;
    const N p = x - a - t * (c - a), q = y - b - t * (d - b);
    return sqrt(N(p * p + q * q));
}

/// A cylinder or a cone and a centre, in the half plane of the axis and the centre, with numbers that may be doubles where
/// the solid's are floats. `more` are such numbers; all are of one unit.
template <class N>
struct half_plane_view {
    bool is_cone, has_axis;
    N height, x, y, r;
    std::vector<N> more;

    template <template <class> class Solid, scalar T>
    half_plane_view(const Solid<T>& s, const vec3<T>& center, const std::vector<double>& others)
        : is_cone(std::same_as<Solid<T>, cone<T>>) {
        std::vector<double> numbers;
        const auto add = [&numbers](T number) { numbers.push_back(static_cast<double>(number)); };
        for (const vec3<T>& p : {axis_of(s).a, axis_of(s).b, center}) add(p.x), add(p.y), add(p.z);
        add(s.radius);
        numbers.insert(numbers.end(), others.begin(), others.end());
        const std::vector<integer> v = to_integers(numbers);
        const integer d[3] = {v[3] - v[0], v[4] - v[1], v[5] - v[2]}, w[3] = {v[6] - v[0], v[7] - v[1], v[8] - v[2]};
        const integer dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], ww = w[0] * w[0] + w[1] * w[1] + w[2] * w[2],
                      dw = d[0] * w[0] + d[1] * w[1] + d[2] * w[2];
        has_axis = dd != 0;
        r = N(v[9]);
        for (std::size_t i = 10; i < v.size(); ++i) more.push_back(N(v[i]));
        height = sqrt(N(dd));
        x = has_axis ? N(N(dw) / height) : N(0);
        y = has_axis ? N(sqrt(N(integer(ww * dd - dw * dw))) / height) : N(sqrt(N(ww)));
    }
    [[nodiscard]] bool is_inside() const {
        if (!has_axis) return is_at_most(y, r);
        if (x < 0 || !is_at_most(x, height)) return false;
        return is_cone ? is_at_most(N(y * height), N(x * r)) : is_at_most(y, r);
    }
    /// From the sides of a rectangle or a triangle, if it is not inside.
    [[nodiscard]] N distance() const {
        const N zero(0);
        if (!has_axis) return y - r;
        const N base = distance_in_plane(x, y, height, zero, height, r);
        const N side =
            is_cone ? distance_in_plane(x, y, zero, zero, height, r) : distance_in_plane(x, y, zero, r, height, r);
        const N least = base < side ? base : side;
        if (is_cone) return least;
        const N first = distance_in_plane(x, y, zero, zero, zero, r);
        return first < least ? first : least;
    }
};

template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const sphere<T>& ball) {
    const half_plane_view<long_float<T>> view(s, ball.center, {static_cast<double>(ball.radius)});
    return view.is_inside() || is_at_most(view.distance(), view.more[0]);
}

template <template <class> class Solid, scalar T>
    requires is_revolved<Solid<T>>
bool within_distance(const Solid<T>& s, const sphere<T>& ball, double distance) {
    using N = long_float<double>;
    const half_plane_view<N> view(s, ball.center, {static_cast<double>(ball.radius), distance});
    return view.is_inside() || is_at_most(view.distance(), N(view.more[0] + view.more[1]));
}

/// To a few digits more than a double has.
template <template <class> class Solid, scalar T>
    requires is_revolved<Solid<T>>
double least_distance(const Solid<T>& s, const sphere<T>& ball) {
    using boost::multiprecision::cpp_bin_float, boost::multiprecision::number, boost::multiprecision::digit_base_2;
    using N = number<cpp_bin_float<400, digit_base_2, void, int>, boost::multiprecision::et_off>;
    const half_plane_view<N> view(s, ball.center, {static_cast<double>(ball.radius), 1});
    if (view.is_inside()) return 0;
    const N least = (view.distance() - view.more[0]) / view.more[1];
    return least > 0 ? static_cast<double>(least) : 0;
}

/// Heights over a plane, of both ends or of the base and the apex, in numbers of the type N.
template <class N>
struct view_over_plane {
    N first, last, reach_first, reach_last, size;  ///< `size` of the normal

    template <template <class> class Solid, scalar T>
    view_over_plane(const Solid<T>& s, const plane<T>& p) {
        const auto exactly = [](T x) { return fraction(static_cast<double>(x)); };
        const segment<T> axis = axis_of(s);
        const fraction_point n{exactly(p.normal.x), exactly(p.normal.y), exactly(p.normal.z)},
            end_a{exactly(axis.a.x), exactly(axis.a.y), exactly(axis.a.z)},
            end_b{exactly(axis.b.x), exactly(axis.b.y), exactly(axis.b.z)};
        const fraction_point d = end_b - end_a;
        const fraction dd = inner(d, d), nn = inner(n, n);
        const fraction across = dd == 0 ? nn : fraction(nn - inner(n, d) * inner(n, d) / dd);
        first = N(fraction(inner(n, end_a) - exactly(p.offset)));
        last = N(fraction(inner(n, end_b) - exactly(p.offset)));
        reach_last = N(exactly(s.radius)) * sqrt(N(across));
        reach_first = std::same_as<Solid<T>, cone<T>> && dd != 0 ? N(0) : reach_last;
        size = sqrt(N(nn));
    }
    /// Whether the least and the greatest height are no more than that beyond 0.
    [[nodiscard]] bool is_within(const N& gap) const {
        const N high_first = first + reach_first + gap, high_last = last + reach_last + gap;
        const N low_first = first - reach_first - gap, low_last = last - reach_last - gap;
        const N slack = ldexp(N(abs(first) + abs(last) + reach_last + gap), -std::numeric_limits<N>::digits * 3 / 4);
        return (high_first >= -slack || high_last >= -slack) && (low_first <= slack || low_last <= slack);
    }
};
template <template <class> class Solid, scalar T>
bool meets(const Solid<T>& s, const plane<T>& p) {
    using N = long_float<T>;
    return view_over_plane<N>(s, p).is_within(N(0));
}
template <template <class> class Solid, scalar T>
    requires is_revolved<Solid<T>>
bool within_distance(const Solid<T>& s, const plane<T>& p, double distance) {
    using N = long_float<double>;
    const view_over_plane<N> view(s, p);
    return view.is_within(N(N(distance) * view.size));
}
/// 0 where the normal is 0.
template <template <class> class Solid, scalar T>
    requires is_revolved<Solid<T>>
double least_distance(const Solid<T>& s, const plane<T>& p) {
    using boost::multiprecision::cpp_bin_float, boost::multiprecision::number, boost::multiprecision::digit_base_2;
    using N = number<cpp_bin_float<2500, digit_base_2, void, int>, boost::multiprecision::et_off>;
    const view_over_plane<N> v(s, p);
    if (v.size == 0) return 0;
    const N high_first = v.first + v.reach_first, high_last = v.last + v.reach_last, low_first = v.first - v.reach_first,
            low_last = v.last - v.reach_last;
    const N high = high_first < high_last ? high_last : high_first, low = low_first < low_last ? low_first : low_last;
    const N gap = high < 0 ? N(-high) : low > 0 ? low : N(0);
    return static_cast<double>(N(gap / v.size));
}

}  // namespace oracle

}  // namespace abut::test
