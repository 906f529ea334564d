// SPDX-License-Identifier: MIT
#pragma once

// What a solid has of a line: an interval of times t at which o + t e is in it. Whether a ray meets the solid, and when
// first, is told here by estimates of any kind, and by integers in exact_line_solid.hpp.
//
// A box is what lies between two planes in each coordinate: l <= o + t e <= u. Balls, cylinders and cones are where a
// quadratic is not positive, q(t) = a t^2 + 2 b t + c; the latter two between the planes of their ends. A capsule is a
// cylinder and a ball at each end. Let w be the way from the first end, of a cone the apex, to o; d that to the last end, D
// = |d|^2, s = w . d and k = e . d. Then 0 <= s + t k <= D between the ends, and
//   ball      a = |e|^2           b = w . e                       c = |w|^2 - r^2
//   cylinder  a = |e x d|^2       b = (w x d) . (e x d)           c = |w x d|^2 - r^2 D
//   cone      a = |e'|^2 - r^2 k^2  b = w' . e' - r^2 s k          c = |w'|^2 - r^2 s^2     with x' = (x x d) x d
// by exact_revolution.hpp. Their discriminants b^2 - a c are p m, with an m of a lower degree:
//   ball      m = r^2 |e|^2 - |w x e|^2                              p = 1
//   cylinder  m = r^2 |e x d|^2 - (w . (e x d))^2                    p = D
//   cone      m = r^2 |(w x e) x d|^2 - D ((w x e) . d)^2            p = D^2
// The first is Lagrange's identity, and so is the second, for (w x d) x (e x d) is d times w . (e x d), but for its sign;
// the third is derived in exact_revolution.hpp.
//
// If a > 0, the interval is that between the roots. If a = 0, q is constant but for a cone: b = 0, for it is a product with
// 0. If a < 0, the line goes through both halves of a double cone and q > 0 between its roots: before the lesser or after
// the greater root it is in the half of the cone, as it rises or falls. With v = sqrt(b^2 - a c) the roots are
// (-b - v) / a and (-b + v) / a, or c / (v - b) and c / (-v - b), whichever has no difference of like numbers.
//
// A ray meets the solid if no begin is after an end and no end is before 0, and it meets it first at the last
// begin, or at 0. Times are estimates, too; equal ones, as at a rim or an edge, leave the question open.
//
// Degree 4, 6 and 8.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/exact_ball.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// A part of a solid, which is convex itself.
enum class solid_part : int { ball, last_ball, cylinder, cone };

/// The part that a solid is made of, and the degree of what is asked about it. A capsule has three parts.
template <class S>
struct round_part;
template <scalar T>
struct round_part<sphere<T>> {
    static constexpr solid_part part = solid_part::ball;
    static constexpr int degree = 4;
};
template <scalar T>
struct round_part<capsule<T>> {
    static constexpr solid_part part = solid_part::cylinder;
    static constexpr int degree = 6;
};
template <scalar T>
struct round_part<cylinder<T>> : round_part<capsule<T>> {};
template <scalar T>
struct round_part<cone<T>> {
    static constexpr solid_part part = solid_part::cone;
    static constexpr int degree = 8;
};

template <class S>
concept round_solid = requires {
    round_part<S>::degree;
};
/// What a line meets as it enters.
template <class S>
concept line_solid = round_solid<S> || std::same_as<S, aabb<scalar_type_of<S>>>;

template <scalar T>
ABUT_HD constexpr segment<T> axis_within(const sphere<T>& s) {
    return {s.center, s.center};
}
template <scalar T>
ABUT_HD constexpr segment<T> axis_within(const capsule<T>& s) {
    return s.axis;
}
template <solid_of_revolution S>
ABUT_HD constexpr auto axis_within(const S& s) {
    return segment<scalar_type_of<S>>(axis_of(s));
}
/// An axis without length leaves a ball.
template <round_solid S>
ABUT_HD constexpr solid_part part_of(const S& s) {
    return is_point(axis_within(s)) ? solid_part::ball : round_part<S>::part;
}

/// The numbers of a line, then those of a box, or of an axis and a radius.
///@{
template <scalar T>
ABUT_HD constexpr auto values_of(const line_of<T>& l, const aabb<T>& box) {
    return in_a_row(l.origin, l.end, l.start, box.lower, box.upper);
}
template <round_solid S, scalar T = scalar_type_of<S>>
ABUT_HD constexpr auto values_of(const line_of<T>& l, const S& s) {
    const segment<T> axis = axis_within(s);
    return in_a_row(l.origin, l.end, l.start, axis.a, axis.b, s.radius);
}
///@}

/// The heights s over the first end and s - D over the last one, and k.
template <class N>
struct line_heights {
    N over_first, over_last, rise;
};
template <class N>
struct line_quadratic {
    N a, b, c, m;
};

template <class N>
ABUT_HD constexpr line_heights<N> heights_of(const N (&value)[16]) {
    const vec3<N> origin = point_at(value, 0), first = point_at(value, 3), last = point_at(value, 4), d = last - first;
    return {dot(origin - first, d), dot(origin - last, d), dot(point_at(value, 1) - point_at(value, 2), d)};
}

template <class N>
ABUT_HD constexpr line_quadratic<N> quadratic_of(solid_part part, const N (&value)[16]) {
    const vec3<N> origin = point_at(value, 0), first = point_at(value, 3), last = point_at(value, 4),
                  e = point_at(value, 1) - point_at(value, 2), w = origin - (part == solid_part::last_ball ? last : first);
    const N& r = value[15];
    if (part == solid_part::ball || part == solid_part::last_ball) {
        const vec3<N> across = cross(w, e);
        return {dot(e, e), dot(w, e), dot(w, w) - r * r, (r * r) * dot(e, e) - dot(across, across)};
    }
    const vec3<N> d = last - first;
    if (part == solid_part::cylinder) {
        const vec3<N> x = cross(w, d), g = cross(e, d);
        const N along = dot(w, g);
        return {dot(g, g), dot(x, g), dot(x, x) - (r * r) * dot(d, d), (r * r) * dot(g, g) - along * along};
    }
    const vec3<N> x = cross(cross(w, d), d), g = cross(cross(e, d), d), normal = cross(w, e), turned = cross(normal, d);
    const N out = r * dot(w, d), opens = r * dot(e, d), along = dot(normal, d);
    return {dot(g, g) - opens * opens, dot(x, g) - out * opens, dot(x, x) - out * out,
            (r * r) * dot(turned, turned) - dot(d, d) * (along * along)};
}

// --- estimates ------------------------------------------------------------------------------------------------------------

/// The square root of what is positive, or 0.
///@{
ABUT_HD constexpr double root_of(double x) { return square_root(x); }
ABUT_HD constexpr estimate root_of(const estimate& x) {
    if (x.value == 0) return {0, 0};
    const double v = square_root(x.value);
    return {v, x.error / v + estimate::roundoff * v};
}
///@}

/// Whether a line meets a solid, and when it does first: at the begin of an interval, or at 0 where that is negative.
template <class N>
struct line_entry {
    verdict met;
    int interval;
    N time;

    [[nodiscard]] ABUT_HD constexpr bool at_start() const { return interval < 0; }
};

/// Of some intervals of times, which may be infinite, when they begin to have a point of time 0 or more in common.
template <class N, int Most>
class common_begin {
public:
    ABUT_HD constexpr void from(int i, const N& time) {
        begin_[i] = time;
        begins_[i] = true;
    }
    ABUT_HD constexpr void until(int i, const N& time) {
        end_[i] = time;
        ends_[i] = true;
    }
    ABUT_HD constexpr void leave_open() { is_open_ = true; }
    ABUT_HD constexpr void leave_empty() { is_empty_ = true; }
    [[nodiscard]] ABUT_HD constexpr bool is_empty() const { return is_empty_; }

    ABUT_HD constexpr line_entry<N> find() const {
        bool is_open = is_open_, is_ahead[std::size_t{Most}]{};
        if (is_empty_) return {verdict::no, -1, {}};
        for (int i = 0; i < Most; ++i) {
            if (ends_[i]) {
                const int s = sign_or_unknown(end_[i]);
                if (s == -1) return {verdict::no, -1, {}};
                is_open = is_open || s == unknown_sign;
            }
            if (begins_[i]) {
                const int s = sign_or_unknown(begin_[i]);
                is_ahead[i] = s > 0;
                is_open = is_open || s == unknown_sign;
            }
        }
        int last = -1;
        for (int i = 0; i < Most; ++i) {
            if (!is_ahead[i]) continue;
            for (int k = 0; k < Most; ++k) {
                if (k == i || !ends_[k]) continue;
                const int s = sign_or_unknown(end_[k] - begin_[i]);
                if (s == -1) return {verdict::no, -1, {}};
                is_open = is_open || s == unknown_sign;
            }
            const int s = last < 0 ? 1 : sign_or_unknown(begin_[i] - begin_[last]);
            is_open = is_open || s == unknown_sign;
            if (s > 0) last = i;
        }
        if (is_open) return {verdict::unknown, -1, {}};
        return {verdict::yes, last, last < 0 ? N{} : begin_[last]};
    }

private:
    N begin_[std::size_t{Most}]{}, end_[std::size_t{Most}]{};
    bool begins_[std::size_t{Most}]{}, ends_[std::size_t{Most}]{}, is_open_ = false, is_empty_ = false;
};

/// Interval i: where first + t rise >= 0 >= last + t rise.
template <class N, int Most>
ABUT_HD constexpr void clip_to_heights(const N& first, const N& last, const N& rise, int i, common_begin<N, Most>& times) {
    const int s = sign_or_unknown(rise);
    if (s == unknown_sign) return times.leave_open();
    if (s == 0) {
        const verdict inside = is_not_negative(first) && is_not_positive(last);
        if (inside == verdict::no) times.leave_empty();
        if (inside == verdict::unknown) times.leave_open();
        return;
    }
    const N back = -rise;
    times.from(i, (s > 0 ? first : last) / back);
    times.until(i, (s > 0 ? last : first) / back);
}

/// Interval i: where a quadratic is not positive; `factor` is the square root of p. rises: whether a line that goes through
/// both halves of a cone enters the right one as the second of them.
template <class N, int Most>
ABUT_HD constexpr void clip_to_quadratic(const line_quadratic<N>& q, const N& factor, bool is_cone, int rises, int i,
                                         common_begin<N, Most>& times) {
    const int bend = sign_or_unknown(q.a);
    if (bend == unknown_sign) return times.leave_open();
    if (bend == 0) {
        const int slope = is_cone ? sign_or_unknown(q.b) : 0, s = sign_or_unknown(q.c);
        if (slope == unknown_sign) return times.leave_open();
        if (slope < 0) return times.from(i, q.c / -(q.b + q.b));
        if (slope > 0) return times.until(i, q.c / -(q.b + q.b));
        if (s == unknown_sign) return times.leave_open();
        if (s > 0) times.leave_empty();
        return;
    }
    const int real = sign_or_unknown(q.m);
    if (real == unknown_sign) return times.leave_open();
    if (real < 0) return times.leave_empty();
    const N v = factor * root_of(q.m);
    const bool is_falling = value_of(q.b) < 0;
    const N sum = is_falling ? v - q.b : v + q.b;
    const bool begins = bend > 0 || rises > 0, ends = bend > 0 || rises < 0;
    if (begins) times.from(i, is_falling ? q.c / sum : -(sum / q.a));
    if (ends) times.until(i, is_falling ? sum / q.a : -(q.c / sum));
}

/// A line and a part of a solid, of which interval 0 is that of the quadratic. is_beside is set where that is empty.
template <class N>
ABUT_NOINLINE ABUT_HD constexpr line_entry<N> enter_part(solid_part part, const N (&value)[16], bool has_end, const N& one,
                                                         bool& is_beside) {
    common_begin<N, 3> times;
    const line_quadratic<N> q = quadratic_of(part, value);
    if (has_end) times.until(2, one);
    if (part == solid_part::ball || part == solid_part::last_ball) {
        clip_to_quadratic(q, one, false, 0, 0, times);
        return times.find();
    }
    const line_heights<N> h = heights_of(value);
    const vec3<N> d = point_at(value, 4) - point_at(value, 3);
    const N length = dot(d, d);
    const bool is_cone = part == solid_part::cone;
    clip_to_quadratic(q, is_cone ? length : root_of(length), is_cone, sign_or_unknown(h.rise), 0, times);
    is_beside = times.is_empty();
    clip_to_heights(h.over_first, h.over_last, h.rise, 1, times);
    return times.find();
}

/// The first of two parts that are met.
template <class N>
ABUT_HD constexpr line_entry<N> earlier(const line_entry<N>& a, const line_entry<N>& b) {
    if (a.met == verdict::yes && a.at_start()) return a;
    if (b.met == verdict::yes && b.at_start()) return b;
    if (a.met == verdict::no || b.met == verdict::unknown) return b;
    if (b.met == verdict::no || a.met == verdict::unknown) return a;
    const int s = sign_or_unknown(b.time - a.time);
    return s == unknown_sign ? line_entry<N>{verdict::unknown, -1, {}} : s < 0 ? b : a;
}

/// A line and all of a solid.
template <class N, round_solid S>
ABUT_HD constexpr line_entry<N> enter(const S& s, const N (&value)[16], bool has_end, const N& one) {
    const solid_part part = part_of(s);
    bool is_beside = false;
    const line_entry<N> found = enter_part(part, value, has_end, one, is_beside);
    if constexpr (std::same_as<S, capsule<scalar_type_of<S>>>) {
        // Outside of the cylinder's side there is nothing of the balls.
        if (part != solid_part::cylinder || is_beside || (found.met == verdict::yes && found.interval <= 0)) return found;
        return earlier(found, earlier(enter_part(solid_part::ball, value, has_end, one, is_beside),
                                      enter_part(solid_part::last_ball, value, has_end, one, is_beside)));
    }
    return found;
}

template <class N, scalar T>
ABUT_HD constexpr line_entry<N> enter(const aabb<T>&, const N (&value)[15], bool has_end, const N& one) {
    const vec3<N> origin = point_at(value, 0), lower = point_at(value, 3), upper = point_at(value, 4);
    const auto e = point_at(value, 1) - point_at(value, 2), first = origin - lower, last = origin - upper;
    common_begin<N, 4> times;
    if (has_end) times.until(3, one);
    clip_to_heights(first.x, last.x, e.x, 0, times);
    clip_to_heights(first.y, last.y, e.y, 1, times);
    clip_to_heights(first.z, last.z, e.z, 2, times);
    return times.find();
}

template <class S>
inline constexpr int degree_on_lines = 4;
template <round_solid S>
inline constexpr int degree_on_lines<S> = round_part<S>::degree;

/// In numbers that make(x) makes of doubles, and that keep 2^-Digits of the error of a rounded one. Plain doubles may be
/// asked in any unit: in one in which nothing overflows or vanishes, if there is one.
template <int Digits, scalar T, line_solid S, class Make>
ABUT_HD constexpr auto entry_in(const line_of<T>& l, const S& s, const Make& make) {
    using number = decltype(make(0.0));
    const auto row = values_of(l, s);
    constexpr std::size_t n = sizeof(row.value) / sizeof(T);
    double unit = unit_of_estimates<degree_on_lines<S>, Digits>(row.value);
    if (unit == 0) {
        if constexpr (!std::same_as<number, double>) return line_entry<number>{verdict::unknown, -1, {}};
        unit = 1;
    }
    number value[n]{};
    for (std::size_t i = 0; i < n; ++i) value[i] = make(static_cast<double>(row.value[i]) * unit);
    return enter(s, value, l.has_end(), make(1.0));
}

struct make_estimate {
    ABUT_HD constexpr estimate operator()(double x) const { return {x, 0}; }
};
struct make_double {
    ABUT_HD constexpr double operator()(double x) const { return x; }
};

/// By estimates, for `filtered`.
template <scalar T, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr line_entry<estimate> estimated_entry(const line_of<T>& l, const S& s) {
    return entry_in<52>(l, s, make_estimate{});
}
/// In plain doubles, for `fast`.
template <scalar T, line_solid S>
ABUT_NOINLINE ABUT_HD constexpr line_entry<double> plain_entry(const line_of<T>& l, const S& s) {
    return entry_in<52>(l, s, make_double{});
}

}  // namespace abut::detail
