// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the predicates between a box and a triangle or a segment: the axes of exact_box.hpp in plain
// arithmetic (`fast`), and in double with bounds on the error that are never wrong (`filtered`).
//
// Coordinates are doubled and measured from the box's middle: w = 2 (v - lower) - size for a corner v, so that the box is
// |x| <= size. For an edge f from such a corner w, and with the normal n = e0 x e1, the triangle's shadow on the axis
// e_k x f reaches from (f x w)_k to (f x w)_k + 2 n_k, and the box's to |f_i| size_j + |f_j| size_i on both sides of 0. So
// the gap between both, if there is any, is
//     |(f x w)_k + n_k| - |n_k| - (|f_i| size_j + |f_j| size_i),
// and on the axis n it is |n . w| - |n| . size. A gap > 0 separates.
//
// Why the bounds hold. u = 2^-52, so that they do in each rounding mode, with and without contraction. Differences of inputs
// carry a relative error of u; A is the sum of the magnitudes of all w and of size, F that of the edges e0 and e1, which is
// not less than that of the third, and at most A. Then w is within 2u (|w| + size) of the true one, a coordinate of f x w
// within 5uFA, n_k within uFA, the box's shadow within 4uFA, and the sums of these add less than 5uFA: 17uFA in all. On the
// axis n, with E = |e0| |e1| (sums of magnitudes again), the gap is within 20uEA. The code takes 32u of both.
//
// A segment has one edge f, whose gaps are |(f x w)_k| - (|f_i| size_j + |f_j| size_i). A is the sum of the magnitudes of
// both w and of size, and so not less than F. The bound is the same.
//
// Flush to zero: an input, or a difference, that is taken for 0 is off by less than d = 2^-126 (float) or 2^-1021 (double).
// A gap is off by less than 16dA + 500dd on an edge's axis, and by less than four times that, times (F + d), on n; `tiny` is
// more, and in double it pays for products that underflow too. Double input with A >= 2^300, where products might overflow,
// is left undecided; so is all that is not finite.
//
// Ties. Where shapes lie along the axes, most of them touch, or have axes that are none: an edge with a zero coordinate
// makes axes of its kind that are 0 or parallel to one of the box's own, and so does the normal of a triangle that is
// parallel to a face of the box. The box's own axes are decided exactly by comparisons of the input, and the axes that
// repeat them need no more than that. Comparisons lie only where denormals are taken for 0, and then call numbers equal
// that are not; they never call a smaller one larger. So "apart" is certain, and a tie is, where no input is denormal:
// which is asked of the inputs' bits.

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// x - origin; in double, as `difference` says.
template <scalar F, scalar T>
ABUT_HD constexpr vec3<F> minus(const vec3<T>& x, const vec3<T>& origin) {
    if constexpr (std::same_as<F, double>) {
        return relative_to(origin, x);
    } else {
        return x - origin;
    }
}

/// A box and a triangle in numbers of type F, as above. `F` is the input's type (`fast`), or double.
template <scalar F>
struct box_frame {
    vec3<F> w[3];  ///< the corners, doubled, from the box's middle
    vec3<F> e[3];  ///< the edges: e[j] leads from corner j to the next
    vec3<F> size;
    vec3<F> n;

    template <scalar T>
    ABUT_HD constexpr box_frame(const aabb<T>& box, const triangle<T>& t)
        : w{},
          e{minus<F>(t.b, t.a), minus<F>(t.c, t.b), minus<F>(t.a, t.c)},
          size(minus<F>(box.upper, box.lower)),
          n(cross(e[0], e[1])) {
        const vec3<F> a = minus<F>(t.a, box.lower), b = minus<F>(t.b, box.lower), c = minus<F>(t.c, box.lower);
        w[0] = (a + a) - size;
        w[1] = (b + b) - size;
        w[2] = (c + c) - size;
    }

    /// The gaps on the three axes of edge j.
    [[nodiscard]] ABUT_HD constexpr vec3<F> edge_gaps(int j) const {
        const vec3<F> shadow = cross(e[j], w[j]), f = absolute(e[j]), width = absolute(n);
        return {absolute(shadow.x + n.x) - width.x - (f.y * size.z + f.z * size.y),
                absolute(shadow.y + n.y) - width.y - (f.z * size.x + f.x * size.z),
                absolute(shadow.z + n.z) - width.z - (f.x * size.y + f.y * size.x)};
    }
    [[nodiscard]] ABUT_HD constexpr F normal_gap() const { return absolute(dot(n, w[0])) - dot(absolute(n), size); }
};

template <scalar F>
ABUT_HD constexpr F greatest_coordinate(const vec3<F>& v) {
    return greatest(v.x, v.y, v.z);
}

/// The lower and the upper corner of a box and the corners of a triangle.
template <scalar T>
ABUT_HD constexpr auto values_of(const aabb<T>& box, const triangle<T>& t) {
    return in_a_row(box.lower, box.upper, t.a, t.b, t.c);
}

/// Whether all gaps that are not certainly below 0 belong to axes that repeat the box's own, which are known not to
/// separate. Where inputs are denormal it says no.
template <scalar T>
ABUT_HD constexpr bool only_ties(const aabb<T>& box, const triangle<T>& t, const box_frame<double>& frame, double bound,
                                 double normal_bound) {
    const auto all = values_of(box, t);
    if (any_subnormal(all.value)) return false;
    const T* const v = all.value + 6;
    bool flat = false;
    for (int k = 0; k < 3; ++k) flat = flat || (v[k] == v[3 + k] && v[k] == v[6 + k]);
    for (int j = 0; j < 3; ++j) {
        const int from = 3 * j, to = j == 2 ? 0 : from + 3;
        const bool x = v[from] == v[to], y = v[from + 1] == v[to + 1], z = v[from + 2] == v[to + 2];
        const vec3<double> gaps = frame.edge_gaps(j);
        if (!(gaps.x < -bound || y || z) || !(gaps.y < -bound || z || x) || !(gaps.z < -bound || x || y)) return false;
        flat = flat || (x && y && z);  // no edge, no normal
    }
    return flat || frame.normal_gap() < -normal_bound;
}

template <scalar T>
ABUT_HD constexpr verdict certified_box(const aabb<T>& box, const triangle<T>& t) {
    const aabb<T> around = bounds(t);
    if (!overlaps(box, around)) return verdict::no;
    const bool inside = box.lower.x < around.upper.x && around.lower.x < box.upper.x && box.lower.y < around.upper.y &&
                        around.lower.y < box.upper.y && box.lower.z < around.upper.z && around.lower.z < box.upper.z;

    constexpr double tiny = std::same_as<T, float> ? 0x1p-120 : 0x1p-1010, unit = std::same_as<T, float> ? 0x1p-120 : 1;
    const box_frame<double> frame(box, t);
    const double size = magnitudes(frame.w[0]) + magnitudes(frame.w[1]) + magnitudes(frame.w[2]) + magnitudes(frame.size);
    if (std::same_as<T, double> && !(size < 0x1p300)) return verdict::unknown;
    const double e0 = magnitudes(frame.e[0]), e1 = magnitudes(frame.e[1]), lost = tiny * (size + unit);
    const double normal_bound = 0x1p-47 * (e0 * e1 * size) + lost * (e0 + e1 + unit);
    const double normal_gap = frame.normal_gap();
    if (normal_gap > normal_bound) return verdict::no;
    const double bound = 0x1p-47 * ((e0 + e1) * size) + lost;
    const double gap = greatest(greatest_coordinate(frame.edge_gaps(0)), greatest_coordinate(frame.edge_gaps(1)),
                                greatest_coordinate(frame.edge_gaps(2)));
    if (gap > bound) return verdict::no;
    if (inside && gap < -bound && normal_gap < -normal_bound) return verdict::yes;
    return only_ties(box, t, frame, bound, normal_bound) ? verdict::yes : verdict::unknown;
}

/// A box and a segment in numbers of type F.
template <scalar F>
struct box_beside_segment {
    vec3<F> from, to;  ///< the ends, doubled, from the box's middle
    vec3<F> edge, size;

    template <scalar T>
    ABUT_HD constexpr box_beside_segment(const aabb<T>& box, const segment<T>& t)
        : from{}, to{}, edge(minus<F>(t.b, t.a)), size(minus<F>(box.upper, box.lower)) {
        const vec3<F> a = minus<F>(t.a, box.lower), b = minus<F>(t.b, box.lower);
        from = (a + a) - size;
        to = (b + b) - size;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<F> gaps() const {
        const vec3<F> shadow = absolute(cross(edge, from)), f = absolute(edge);
        return {shadow.x - (f.y * size.z + f.z * size.y), shadow.y - (f.z * size.x + f.x * size.z),
                shadow.z - (f.x * size.y + f.y * size.x)};
    }
};

template <scalar T>
ABUT_HD constexpr verdict certified_box(const aabb<T>& box, const segment<T>& t) {
    const aabb<T> around = bounds(t);
    if (!overlaps(box, around)) return verdict::no;
    constexpr double tiny = std::same_as<T, float> ? 0x1p-120 : 0x1p-1010, unit = std::same_as<T, float> ? 0x1p-120 : 1;
    const box_beside_segment<double> both(box, t);
    const double size = magnitudes(both.from) + magnitudes(both.to) + magnitudes(both.size);
    if (std::same_as<T, double> && !(size < 0x1p300)) return verdict::unknown;
    const double bound = 0x1p-47 * (magnitudes(both.edge) * size) + tiny * (size + unit);
    const vec3<double> gaps = both.gaps();
    if (greatest_coordinate(gaps) > bound) return verdict::no;
    // Boxes that overlap do so surely but where inputs are denormal; and an edge with a zero coordinate makes axes that
    // repeat the box's own.
    const T values[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z,
                        t.a.x,       t.a.y,       t.a.z,       t.b.x,       t.b.y,       t.b.z};
    const bool x = t.a.x == t.b.x, y = t.a.y == t.b.y, z = t.a.z == t.b.z;
    const bool meets = (gaps.x < -bound || y || z) && (gaps.y < -bound || z || x) && (gaps.z < -bound || x || y);
    return meets && !any_subnormal(values) ? verdict::yes : verdict::unknown;
}

/// `fast`
///@{
template <scalar T>
ABUT_HD constexpr bool approximate_box(const aabb<T>& box, const segment<T>& t) {
    return overlaps(box, bounds(t)) && !(greatest_coordinate(box_beside_segment<T>(box, t).gaps()) > 0);
}
template <scalar T>
ABUT_HD constexpr bool approximate_box(const aabb<T>& box, const triangle<T>& t) {
    if (!overlaps(box, bounds(t))) return false;
    const box_frame<T> frame(box, t);
    return !(frame.normal_gap() > 0) &&
           !(greatest(greatest_coordinate(frame.edge_gaps(0)), greatest_coordinate(frame.edge_gaps(1)),
                      greatest_coordinate(frame.edge_gaps(2))) > 0);
}
///@}

}  // namespace abut::detail
