// SPDX-License-Identifier: MIT
#pragma once

// Do a moving vertex and a moving triangle, or two moving edges, touch? In double, with bounds: `no` and `yes` are never
// wrong.
//
// u, v, w and f = w . (u x v) are those of exact_motion.hpp; all of what follows is asked of an interval of time.
// Polynomials in t are known by their Bernstein coefficients on it, between the least and the greatest of which their values
// are.
//
// No, for one of these reasons:
// - f has no root there: its four coefficients are all above 0 or all below (M. Tang, D. Manocha, R. Tong, Fast continuous
//   collision detection using deforming non-penetration filters, 2010).
// - In the projection along an axis, the normal u x v keeps its sign, and one of the areas that have to have that sign where
//   the
//   features touch has the other one. At a root of f all is in one plane, which the projection shows as it is.
// - Of what separates the features in the middle of the interval, g: all differences between a point of one and a point of
//   the other have g . x > 0 at both ends, and so at all times between.
// Yes: the normal keeps its sign, all areas have it, and f has different signs at the ends.
// Otherwise the interval is halved. Intervals are taken from the earliest on, and few pairs need more than one.
//
// Where an area is 0 for all t, as where a vertex moves in the plane of a face's side that is along an axis, it is no reason
// for no, and does not speak against yes: coordinates tell that, when all three points have the same.
//
// Errors, as multiples of u = 2^-52, so that they hold in each rounding mode, with and without contraction. M is the largest
// coordinate of a vector at both ends of the step. Differences of inputs are off by u M, and what lies between two of them
// in time by 6u M. An area of two such vectors is off by 28u M M; of the middle coefficient, which is a sum of two, by 60u;
// sums and differences of two or three areas by twice the sum of their bounds, 2^-45 M M for each, which is more. A
// determinant is off by 144u M M M, the middle coefficients, times 3, by 474u; 2^-42 is four times that. g . x is off by 12u
// |g| M, g itself being right by definition; 2^-46.
//
// M is not taken below 2^-60 for float, so that an error of a whole denormal number, in modes that read it as 0, is below
// 2^-112 and so below all bounds; for double not below 2^-200, so that what a product loses by underflow is, too. Double
// beyond 2^200 is left undecided, so that nothing overflows. NaN makes every comparison false.

#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/shape/outward.hpp>

namespace abut::detail {

/// What two features are to each other at one time: two edges of a triangle from one corner, and from there to the vertex;
/// or two edges, and from an end of the first to an end of the second.
struct feature_frame {
    vec3<double> u, v, w;
};

ABUT_HD constexpr double largest_coordinate(const vec3<double>& p) {
    const vec3<double> a = absolute(p);
    return greatest(a.x, a.y, a.z);
}
ABUT_HD constexpr double coordinate_along(const vec3<double>& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
/// The coordinate of p x q along an axis.
ABUT_HD constexpr double area_along(const vec3<double>& p, const vec3<double>& q, int axis) {
    return axis == 0 ? p.y * q.z - p.z * q.y : axis == 1 ? p.z * q.x - p.x * q.z : p.x * q.y - p.y * q.x;
}
ABUT_HD constexpr vec3<double> in_between(const vec3<double>& a, const vec3<double>& b, double t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/// Where on two edges, u from a point and v from another, w farther on, the points are that are nearest to each other, in
/// parts of the edges: C. Ericson, Real-Time Collision Detection (2005), 5.1.9. Of an edge without length it is anywhere.
struct parts_of_edges {
    double of_u, of_v;
};
ABUT_HD constexpr parts_of_edges nearest_on_edges(const vec3<double>& u, const vec3<double>& v, const vec3<double>& w) {
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const auto clamped = [](double x) { return least(greatest(x, 0.0), 1.0); };
    const double area = uu * vv - uv * uv;
    double s = area > 0 ? clamped((uw * vv - uv * vw) / area) : 0;
    double r = vv > 0 ? (uv * s - vw) / vv : 0;
    if (!(vv > 0 && r >= 0 && r <= 1)) {
        r = clamped(r);
        s = uu > 0 ? clamped((uw + r * uv) / uu) : 0;
    }
    return {s, r};
}

/// A quadratic polynomial by its Bernstein coefficients, of which the middle one is doubled.
struct area_in_time {
    double first, twice_middle, last;

    ABUT_HD constexpr area_in_time(double a, double b, double c) : first(a), twice_middle(b), last(c) {}
    /// Of p x q along an axis.
    ABUT_HD constexpr area_in_time(const vec3<double>& p0, const vec3<double>& q0, const vec3<double>& p1,
                                   const vec3<double>& q1, int axis)
        : first(area_along(p0, q0, axis)),
          twice_middle(area_along(p0, q1, axis) + area_along(p1, q0, axis)),
          last(area_along(p1, q1, axis)) {}
    friend ABUT_HD constexpr area_in_time operator-(const area_in_time& a, const area_in_time& b) {
        return {a.first - b.first, a.twice_middle - b.twice_middle, a.last - b.last};
    }
    friend ABUT_HD constexpr area_in_time operator*(double s, const area_in_time& a) {
        return {s * a.first, s * a.twice_middle, s * a.last};
    }
    [[nodiscard]] ABUT_HD constexpr bool is_above(double bound) const { return least(first, twice_middle, last) > bound; }
    [[nodiscard]] ABUT_HD constexpr bool is_below(double bound) const { return greatest(first, twice_middle, last) < bound; }
    [[nodiscard]] ABUT_HD constexpr bool changes_sign(double error) const {
        return (first > error && last < -error) || (first < -error && last > error);
    }
    /// Whether it falls all the time, or rises.
    [[nodiscard]] ABUT_HD constexpr bool is_monotone(double error) const {
        const double a = twice_middle - 2 * first, b = 2 * last - twice_middle;
        return least(a, b) > 4 * error || greatest(a, b) < -4 * error;
    }
};

/// The only root of c[0] + c[1] x + c[2] x^2 + c[3] x^3 in [0, 1], where it changes its sign, by Newton's iteration in a
/// bracket. The last step is no longer than 2^-24, and so it is off by some 2^-48.
ABUT_HD constexpr double root_of_cubic(const double (&c)[4], double at_1) {
    double low = 0, high = 1, x = c[0] / (c[0] - at_1);
    for (int i = 0; i < 64; ++i) {
        const double value = c[0] + x * (c[1] + x * (c[2] + x * c[3])), slope = c[1] + x * (2 * c[2] + 3 * x * c[3]);
        ((value < 0) == (c[0] < 0) ? low : high) = x;
        const double newton = x - value / slope;
        if (absolute(newton - x) <= 0x1p-24) return least(greatest(newton, 0.0), 1.0);
        x = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return x;
}

/// f by its four Bernstein coefficients, times 3.
struct volume_in_time {
    double k[4];

    ABUT_HD constexpr volume_in_time() : k{} {}
    ABUT_HD constexpr volume_in_time(const feature_frame& a, const feature_frame& b, const vec3<double>& normal_a,
                                     const vec3<double>& twice_middle, const vec3<double>& normal_b)
        : k{3 * dot(normal_a, a.w), dot(twice_middle, a.w) + dot(normal_a, b.w), dot(twice_middle, b.w) + dot(normal_b, a.w),
            3 * dot(normal_b, b.w)} {}
    [[nodiscard]] ABUT_HD constexpr bool has_no_root(double error) const {
        return least(least(k[0], k[1]), least(k[2], k[3])) > error || greatest(greatest(k[0], k[1]), greatest(k[2], k[3])) < -error;
    }
    [[nodiscard]] ABUT_HD constexpr bool changes_sign(double error) const {
        return (k[0] > error && k[3] < -error) || (k[0] < -error && k[3] > error);
    }
    /// Whether f falls all the time, or rises: then a root is the only one.
    [[nodiscard]] ABUT_HD constexpr bool is_monotone(double error) const {
        const double a = k[1] - k[0], b = k[2] - k[1], c = k[3] - k[2];
        return least(a, b, c) > 4 * error || greatest(a, b, c) < -4 * error;
    }
    /// The part of the interval at which the only root is.
    [[nodiscard]] ABUT_HD constexpr double root() const {
        return root_of_cubic({k[0], 3 * (k[1] - k[0]), 3 * (k[2] - 2 * k[1] + k[0]), k[3] - 3 * (k[2] - k[1]) - k[0]}, k[3]);
    }
};

/// Four points in motion: a vertex and the corners of a face, or, of Edges, the ends of two edges.
template <scalar T>
struct moving_points {
    vec3<T> t0[4], t1[4];
};

/// By their bits: where denormals are read as zero, all of them would equal each other.
template <scalar T>
ABUT_HD constexpr bool is_same_number(T a, T b) {
    using word = typename float_format<T>::word;
    return ABUT_BIT_CAST(word, a) == ABUT_BIT_CAST(word, b) || (is_zero(a) && is_zero(b));
}

/// Of which sides the area that they span with a point is 0 for all t, whatever the time: a bit for each condition below and
/// each coordinate that the three points share.
template <bool Edges, scalar T>
ABUT_HD constexpr std::uint32_t shared_coordinates(const moving_points<T>& p) {
    constexpr int three[4][3] = {{Edges ? 0 : 0, Edges ? 2 : 1, 3}, {0, 1, 2}, {Edges ? 1 : 0, 2, 3}, {0, 1, 3}};
    std::uint32_t bits = 0;
    for (int i = 0; i < (Edges ? 4 : 3); ++i) {
        const int a = three[i][0], b = three[i][1], c = three[i][2];
        const auto same = [&](T vec3<T>::*x) {
            return static_cast<std::uint32_t>(is_same_number(p.t0[a].*x, p.t0[b].*x) && is_same_number(p.t0[b].*x, p.t0[c].*x) &&
                                              is_same_number(p.t1[a].*x, p.t1[b].*x) && is_same_number(p.t1[b].*x, p.t1[c].*x));
        };
        bits |= (same(&vec3<T>::x) | same(&vec3<T>::y) << 1 | same(&vec3<T>::z) << 2) << 3 * i;
    }
    return bits;
}

/// The axis across which a plane has all points all the time, or -1.
template <bool Edges>
ABUT_HD constexpr int axis_of_plane(std::uint32_t shared) {
    const std::uint32_t all = shared & shared >> 3 & shared >> 6 & (Edges ? shared >> 9 : 7u) & 7u;
    return (all & 1) != 0 ? 0 : (all & 2) != 0 ? 1 : (all & 4) != 0 ? 2 : -1;
}

/// What double precision knows of two features. Of a vertex and a face, or, of Edges, two edges.
template <bool Edges>
class motion_filter {
public:
    template <scalar T>
    ABUT_HD constexpr explicit motion_filter(const moving_points<T>& p)
        : t0_(frame_of(p.t0)), t1_(frame_of(p.t1)), u_(size_of<T>(t0_.u, t1_.u)), v_(size_of<T>(t0_.v, t1_.v)),
          w_(size_of<T>(t0_.w, t1_.w)) {}

    /// Whether they are surely apart at t = 0.
    [[nodiscard]] ABUT_HD constexpr bool start_apart() const { return can_bound() && is_apart(t0_, t0_, 0); }

    /// Whether the way from one middle to the other shows that they are apart for the whole step. Of features that only their boxes
    /// bring near each other it does so most often, and at little cost.
    [[nodiscard]] ABUT_HD constexpr bool are_middles_apart() const {
        const vec3<double> u = t0_.u + t1_.u, v = t0_.v + t1_.v, w = t0_.w + t1_.w;
        return can_bound() && is_apart_along(Edges ? 0.5 * (u - v) - w : w - (1.0 / 3) * (u + v), t0_, t1_, 0);
    }
    /// The whole step at once.
    [[nodiscard]] ABUT_HD constexpr verdict look_once() const {
        if (!can_bound()) return verdict::unknown;
        if (are_middles_apart()) return verdict::no;
        volume_in_time f;
        return look(t0_, t1_, false, 0, f, false);
    }

    /// An interval in which they touch first: [j, j + 1] / 2^depth. Or there is none; or what is found out ends before it.
    struct answer {
        verdict touch;
        std::uint32_t j;
        int depth;
        int condition = 0;  ///< of search_in_plane
        double part = 0;    ///< of search: where in it,
        int before = 0;     ///< and the sign of f at its start
    };
    /// Halves intervals. If one root is asked for, f has one alone in the interval that is found, and changes its sign
    /// there, near `part` of it. `shared` are the shared_coordinates, or 0.
    [[nodiscard]] ABUT_HD constexpr answer search(bool one_root, std::uint32_t shared) const {
        bool may_narrow = true;
        return search_by([&](const feature_frame& a, const feature_frame& b, answer& in) {
            volume_in_time f;
            const verdict seen = look(a, b, one_root, shared, f, may_narrow);
            if (seen == verdict::yes && one_root) in.part = f.root(), in.before = f.k[0] > 0 ? 1 : -1;
            if (!may_narrow || seen != verdict::unknown || !has_one_root(f)) return seen;
            // Where the only root is, a small part decides for all of it: once, since it seldom fails. A root at the end may be
            // rounded out of the interval, where another could follow.
            may_narrow = false;
            constexpr int narrower = 8;
            const double place = f.root() * (1 << narrower);
            if (in.depth + narrower > most_depth || !(place < (1 << narrower))) return verdict::unknown;
            answer inner = in;
            inner.j = (in.j << narrower) + static_cast<std::uint32_t>(place);
            inner.depth = in.depth + narrower;
            inner.before = f.k[0] > 0 ? 1 : -1;
            inner.part = place - static_cast<double>(static_cast<std::uint32_t>(place));
            const verdict there = look(at(inner.j, inner.depth), at(inner.j + 1, inner.depth), false, shared, f, false);
            if (!f.changes_sign(0x1p-42 * u_ * v_ * w_)) return verdict::unknown;
            if (there == verdict::yes) in = inner;
            return there;
        });
    }

    /// The same of features in one plane, across an axis, all the time, which do not touch at the start (exact_motion.hpp
    /// says what happens then). In the interval that is found a point meets an edge, as `condition` says, and no other does.
    [[nodiscard]] ABUT_HD constexpr answer search_in_plane(int axis) const {
        return search_by([&](const feature_frame& a, const feature_frame& b, answer& in) {
            return look_in_plane(a, b, axis, in.condition);
        });
    }

    /// The earliest time at which they may come within `separation` of each other, off by `tolerance` at most, and never
    /// later than they do; or -1. Where more than 2^14 intervals would be looked at, the time at which that happens.
    [[nodiscard]] ABUT_HD constexpr double conservative_time(double separation, double tolerance) const {
        if (!can_bound()) return 0;
        std::uint64_t j = 0;
        int depth = 0;
        volume_in_time f;
        for (int looked = 0;; ++looked) {
            const double width = 1.0 / static_cast<double>(std::uint64_t{1} << depth), from = static_cast<double>(j) * width;
            const feature_frame a = at(from), b = at(from + width);
            const bool apart = (separation > 0 ? is_apart(a, b, separation) : look(a, b, false, 0, f, false) == verdict::no) ||
                               is_apart_across(a, b, separation);
            if (!apart) {
                if (width <= tolerance || depth == 50 || looked >= 1 << 14) return from;
                j *= 2;
                ++depth;
                continue;
            }
            ++j;
            while (depth > 0 && (j & 1) == 0) j >>= 1, --depth;
            if (depth == 0) return -1;
        }
    }

    /// f on the interval of an answer.
    [[nodiscard]] ABUT_HD constexpr volume_in_time volume(const answer& in) const {
        const feature_frame a = at(in.j, in.depth), b = at(in.j + 1, in.depth);
        return {a, b, cross(a.u, a.v), cross(a.u, b.v) + cross(b.u, a.v), cross(b.u, b.v)};
    }
    /// The sign of f at a time, or 0 where double does not tell.
    [[nodiscard]] ABUT_HD constexpr int sign_of_volume(double t) const {
        const feature_frame a = at(t);
        const double f = dot(cross(a.u, a.v), a.w), error = 0x1p-44 * u_ * v_ * w_;
        return f > error ? 1 : f < -error ? -1 : 0;
    }
    /// The area of the answer's condition there.
    [[nodiscard]] ABUT_HD constexpr area_in_time area(const answer& in, int axis) const {
        const feature_frame a = at(in.j, in.depth), b = at(in.j + 1, in.depth);
        area_in_time found{0, 0, 0};
        for_each_condition(a, b, axis, [&](int i, const area_in_time& area, double, const auto&, const auto&, const auto&,
                                           const auto&) { found = i == in.condition ? area : found; });
        return found;
    }
    /// Errors of values that are computed with more bits than double has.
    [[nodiscard]] ABUT_HD constexpr double volume_error(double precision) const { return precision * u_ * v_ * w_; }
    [[nodiscard]] ABUT_HD constexpr double area_error(double precision) const {
        const double size = u_ + v_ + w_;
        return precision * size * size;
    }

private:
    static constexpr int most_depth = 20;

    template <scalar T>
    [[nodiscard]] ABUT_HD static constexpr feature_frame frame_of(const vec3<T> (&p)[4]) {
        if constexpr (Edges) {
            return {relative_to(p[0], p[1]), relative_to(p[2], p[3]), relative_to(p[0], p[2])};
        } else {
            return {relative_to(p[1], p[2]), relative_to(p[1], p[3]), relative_to(p[1], p[0])};
        }
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD static constexpr double size_of(const vec3<double>& a, const vec3<double>& b) {
        return greatest(largest_coordinate(a), largest_coordinate(b), std::same_as<T, float> ? 0x1p-60 : 0x1p-200);
    }
    [[nodiscard]] ABUT_HD constexpr bool can_bound() const { return u_ < 0x1p200 && v_ < 0x1p200 && w_ < 0x1p200; }

    [[nodiscard]] ABUT_HD constexpr feature_frame at(double t) const {
        if (t == 1) return t1_;
        return {in_between(t0_.u, t1_.u, t), in_between(t0_.v, t1_.v, t), in_between(t0_.w, t1_.w, t)};
    }
    [[nodiscard]] ABUT_HD constexpr feature_frame at(std::uint32_t j, int depth) const {
        return at(static_cast<double>(j) / static_cast<double>(std::uint32_t{1} << depth));
    }

    /// The earliest interval of which look(frame at its start, frame at its end, interval) says yes, which may make it smaller;
    /// none, if it says no of all.
    template <class Look>
    [[nodiscard]] ABUT_HD constexpr answer search_by(const Look& look) const {
        answer in{verdict::unknown, 0, 0};
        if (!can_bound()) return in;
        for (;;) {
            in.touch = look(at(in.j, in.depth), at(in.j + 1, in.depth), in);
            if (in.touch == verdict::yes || (in.touch == verdict::unknown && in.depth == most_depth)) return in;
            if (in.touch == verdict::unknown) {
                in.j *= 2;
                ++in.depth;
                continue;
            }
            ++in.j;
            while (in.depth > 0 && (in.j & 1) == 0) in.j >>= 1, --in.depth;
            if (in.depth == 0) return {verdict::no, 0, 0};
        }
    }

    /// Calls see(i, area, its error, p - a, p - b, and the same at the end) of each point p and edge from a to b of the
    /// other feature, in the order of the conditions of `look`.
    template <class See>
    ABUT_HD constexpr void for_each_condition(const feature_frame& a, const feature_frame& b, int axis, const See& see) const {
        const area_in_time n(a.u, a.v, b.u, b.v, axis), with_v(a.w, a.v, b.w, b.v, axis), with_u(a.w, a.u, b.w, b.u, axis);
        const double of_n = 0x1p-45 * u_ * v_, of_v = 0x1p-45 * w_ * v_, of_u = 0x1p-45 * w_ * u_;
        const vec3<double> zero{0, 0, 0};
        if constexpr (Edges) {
            see(0, with_v, of_v, zero - a.w, zero - (a.w + a.v), zero - b.w, zero - (b.w + b.v));
            see(1, with_u, of_u, a.w, a.w - a.u, b.w, b.w - b.u);
            see(2, n - with_v, 2 * (of_n + of_v), a.u - a.w, a.u - (a.w + a.v), b.u - b.w, b.u - (b.w + b.v));
            see(3, n - with_u, 2 * (of_n + of_u), a.w + a.v, (a.w + a.v) - a.u, b.w + b.v, (b.w + b.v) - b.u);
        } else {
            see(0, with_v, of_v, a.w, a.w - a.v, b.w, b.w - b.v);
            see(1, with_u, of_u, a.w, a.w - a.u, b.w, b.w - b.u);
            see(2, (n - with_v) - (-1.0 * with_u), 2 * (of_n + of_v + of_u), a.w - a.u, a.w - a.v, b.w - b.u, b.w - b.v);
        }
    }

    /// An interval at the start of which features do not touch, in one plane: no, if no point meets an edge there. A point
    /// is off an edge where their area keeps its sign, and where a coordinate of it is on one side of both ends.
    [[nodiscard]] ABUT_HD constexpr verdict look_in_plane(const feature_frame& a, const feature_frame& b, int axis,
                                                          int& condition) const {
        const double lost = 0x1p-48 * (u_ + v_ + w_);
        int near = 0, met = 0;
        for_each_condition(a, b, axis, [&](int i, const area_in_time& area, double error, const vec3<double>& of_a,
                                           const vec3<double>& of_b, const vec3<double>& then_of_a,
                                           const vec3<double>& then_of_b) {
            if (area.is_above(error) || area.is_below(-error)) return;
            bool beside = false, between = false;
            for (int k = 0; k < 3; ++k) {
                const double x = coordinate_along(of_a, k), y = coordinate_along(of_b, k), then_x = coordinate_along(then_of_a, k),
                             then_y = coordinate_along(then_of_b, k);
                const bool x_above = least(x, then_x) > lost, x_below = greatest(x, then_x) < -lost,
                           y_above = least(y, then_y) > lost, y_below = greatest(y, then_y) < -lost;
                beside |= (x_above && y_above) || (x_below && y_below);
                between |= (x_above && y_below) || (x_below && y_above);
            }
            if (beside) return;
            ++near;
            const bool meets = between && area.changes_sign(error) && area.is_monotone(error);
            met += meets ? 1 : 0;
            condition = meets ? i : condition;
        });
        if (near == 0) return verdict::no;
        return near == 1 && met == 1 ? verdict::yes : verdict::unknown;
    }

    /// f, where it is of both signs surely, has one root alone.
    [[nodiscard]] ABUT_HD constexpr bool has_one_root(const volume_in_time& f) const {
        const double error = 0x1p-42 * u_ * v_ * w_;
        return f.changes_sign(error) && f.is_monotone(error);
    }
    /// The interval between two times, of which f is told. If `briefly`, one with one root alone is not asked whether the features
    /// are apart all the time, which they seldom are.
    [[nodiscard]] ABUT_HD constexpr verdict look(const feature_frame& a, const feature_frame& b, bool one_root,
                                                 std::uint32_t shared, volume_in_time& f, bool briefly) const {
        const vec3<double> normal_a = cross(a.u, a.v), normal_b = cross(b.u, b.v), twice = cross(a.u, b.v) + cross(b.u, a.v);
        f = volume_in_time(a, b, normal_a, twice, normal_b);
        const double error = 0x1p-42 * u_ * v_ * w_;
        if (f.has_no_root(error)) return verdict::no;

        // The axis along which most of the area shows; but where points share a coordinate, not that one's.
        const vec3<double> sum = normal_a + twice + normal_b;
        const std::uint32_t hidden = shared | shared >> 3 | shared >> 6 | shared >> 9;
        const double x = (hidden & 1) != 0 ? 0 : absolute(sum.x), y = (hidden & 2) != 0 ? 0 : absolute(sum.y),
                     z = (hidden & 4) != 0 ? 0 : absolute(sum.z);
        const int axis = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        const double sign = coordinate_along(sum, axis) < 0 ? -1 : 1;
        const area_in_time n =
            sign * area_in_time(coordinate_along(normal_a, axis), coordinate_along(twice, axis), coordinate_along(normal_b, axis));
        const double of_n = 0x1p-45 * u_ * v_, of_v = 0x1p-45 * w_ * v_, of_u = 0x1p-45 * w_ * u_;
        if (n.is_above(of_n)) {
            const area_in_time with_v = sign * area_in_time(a.w, a.v, b.w, b.v, axis);
            const area_in_time with_u = (Edges ? sign : -sign) * area_in_time(a.w, a.u, b.w, b.u, axis);
            bool out = false, in = true;
            const auto require = [&](const area_in_time& area, double lost, int condition) {
                const bool is_zero = (shared >> 3 * condition & 7 & ~(1u << axis)) != 0;
                out |= !is_zero && area.is_below(-lost);
                in &= is_zero || area.is_above(lost);
            };
            require(with_v, of_v, 0);
            require(with_u, of_u, 1);
            if constexpr (Edges) {
                require(n - with_v, 2 * (of_n + of_v), 2);
                require(n - with_u, 2 * (of_n + of_u), 3);
            } else {
                require((n - with_v) - with_u, 2 * (of_n + of_v + of_u), 2);
            }
            if (out) return verdict::no;
            if (in && f.changes_sign(error) && (!one_root || f.is_monotone(error))) return verdict::yes;
        }
        if (briefly && has_one_root(f)) return verdict::unknown;
        return is_apart(a, b, 0) ? verdict::no : verdict::unknown;
    }

    /// Whether a direction shows that the features are farther apart than `separation` at all times between.
    [[nodiscard]] ABUT_HD constexpr bool is_apart(const feature_frame& a, const feature_frame& b, double separation) const {
        const vec3<double> u = a.u + b.u, v = a.v + b.v, w = a.w + b.w;
        vec3<double> g{};  // from the second feature's point to the first's, where they are nearest; it need not be right
        if constexpr (Edges) {
            const parts_of_edges at = nearest_on_edges(u, v, w);
            g = at.of_u * u - w - at.of_v * v;
        } else {
            g = nearest_to_origin(w, w - u, w - v);
        }
        return is_apart_along(g, a, b, separation);
    }
    /// The same by the direction across both edges, or the face. Where edges are nearly parallel, or a face is narrow, where
    /// they are nearest is known to few digits, and this direction to many.
    [[nodiscard]] ABUT_HD constexpr bool is_apart_across(const feature_frame& a, const feature_frame& b, double separation) const {
        const vec3<double> n = cross(a.u + b.u, a.v + b.v);
        return is_apart_along(((dot(n, a.w + b.w) > 0) == Edges ? -1.0 : 1.0) * n, a, b, separation);
    }
    [[nodiscard]] ABUT_HD constexpr bool is_apart_along(const vec3<double>& g, const feature_frame& a, const feature_frame& b,
                                                        double separation) const {
        double lost = 0x1p-46 * magnitudes(g) * (u_ + v_ + w_) + 0x1p-1000;
        if (separation > 0) lost += separation * (1 + 0x1p-40) * length_above(g);
        const auto least_along = [&g](const feature_frame& x) {
            if constexpr (Edges) {
                // Of the differences s u - r v - w, 0 <= s, r <= 1, which is the least along g?
                return least(dot(g, x.u), 0.0) - greatest(dot(g, x.v), 0.0) - dot(g, x.w);
            } else {
                return least(dot(g, x.w), dot(g, x.w - x.u), dot(g, x.w - x.v));
            }
        };
        return least(least_along(a), least_along(b)) > lost;
    }

    feature_frame t0_, t1_;
    double u_, v_, w_;  ///< the largest coordinates
};

}  // namespace abut::detail
