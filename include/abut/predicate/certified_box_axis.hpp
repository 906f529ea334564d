// SPDX-License-Identifier: MIT
#pragma once

// The floating-point half of the question whether a box and a segment, the axis of a capsule, are no farther apart than a
// radius: plain arithmetic in the input's type (`fast`), and in double with certificates that are never wrong (`filtered`).
//
// All is seen from the axis's first end: the box's corners and the axis d are differences of inputs, rounded once. M is the
// greatest length of any of them. The certificates are those of certified_within.hpp, with the same constants:
// - Apart. A direction g has its least product over the box at one of its corners, and its greatest over the axis at an end.
//   Computed, both are within 5u |g| M, and their difference is within 13u |g| M.
// - Near. With s in [0, 1] as it stands in its register, x = s d is within 2uM of the axis. What of x lies in the box, each
//   coordinate for itself, is within 2uM of the box. With the rounding of the way between both that is below 22uM.
// Nothing trusts that s is where it should be.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/certified_box.hpp>
#include <abut/predicate/certified_capsule.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A box as seen from the first end of an axis d, and what lengths are compared with. F is the input's type (`fast`), or
/// double.
template <bool Certified, scalar F>
struct box_from_axis {
    vec3<F> lower, upper, d;
    F squared_radius, reach, lost, tiny;  ///< as those of two_hulls
    bool in_range = true;

    template <scalar T>
    ABUT_HD constexpr box_from_axis(const aabb<T>& box, const segment<T>& axis, F radius)
        : lower(minus<F>(box.lower, axis.a)),
          upper(minus<F>(box.upper, axis.a)),
          d(minus<F>(axis.b, axis.a)),
          squared_radius(radius * radius),
          reach(squared_radius),
          lost(0),
          tiny(0) {
        if constexpr (Certified) {
            const vec3<F> far = greatest(absolute(lower), absolute(upper));
            const F mm = greatest(dot(far, far), dot(d, d));
            tiny = std::same_as<T, float> ? 0x1p-210 : 0x1p-1000;
            in_range = std::same_as<T, float> || (mm < 0x1p480 && squared_radius < 0x1p480);
            reach = (1 + 0x1p-29) * squared_radius + (0x1p-65 * mm + tiny);
            lost = 0x1p-62 * mm + tiny;
        }
    }

    /// From the point at s of the axis to the box.
    [[nodiscard]] ABUT_HD constexpr vec3<F> way_from(F s) const {
        const vec3<F> x = s * d;
        return least(greatest(x, lower), upper) - x;
    }
    /// Half of how the square of that way grows with s. It grows itself, and is linear but where the axis passes the plane
    /// of a face.
    [[nodiscard]] ABUT_HD constexpr F slope_at(F s) const { return -dot(d, way_from(s)); }
    /// Where on the axis that square is least, in [0, 1].
    [[nodiscard]] ABUT_HD constexpr F nearest_on_axis() const {
        F from = 0, to = 1, slope_from = slope_at(from), slope_to = slope_at(to);
        if (!(slope_from < 0)) return from;
        if (!(slope_to > 0)) return to;
        const F at[6] = {lower.x / d.x, lower.y / d.y, lower.z / d.z, upper.x / d.x, upper.y / d.y, upper.z / d.z};
        for (int i = 0; i < 6; ++i) {
            const F s = into_unit(at[i]), slope = slope_at(s);
            const bool is_before = slope < 0;
            if (is_before && s > from) from = s, slope_from = slope;
            if (!is_before && s < to) to = s, slope_to = slope;
        }
        return into_unit(from + (to - from) * (slope_from / (slope_from - slope_to)));
    }

    /// Whether a way of this square tells that both are near.
    [[nodiscard]] ABUT_HD constexpr bool is_short(F square) const {
        if constexpr (Certified) {
            return (1 + 0x1p-29) * square + lost <= squared_radius;
        } else {
            return square <= squared_radius;
        }
    }
    /// Whether the direction g tells that the box is beyond reach of the axis.
    [[nodiscard]] ABUT_HD constexpr bool is_beyond(const vec3<F>& g) const {
        const vec3<F> first{g.x > 0 ? lower.x : upper.x, g.y > 0 ? lower.y : upper.y, g.z > 0 ? lower.z : upper.z};
        const F gap = dot(g, first) - greatest(dot(g, d), F(0));
        return gap > 0 && gap * gap > reach * (dot(g, g) + tiny) + F(Certified ? 0x1p-1000 : 0);
    }
    [[nodiscard]] ABUT_HD constexpr bool is_beyond_either(const vec3<F>& g) const {
        return is_beyond(g) || is_beyond({-g.x, -g.y, -g.z});
    }
};

/// What the nearest points tell: of all pairs but those that nearly touch, and those whose axis meets the box.
template <bool Certified, scalar F>
ABUT_HD constexpr verdict near_by_nearest(const box_from_axis<Certified, F>& both) {
    if (!both.in_range) return verdict::unknown;
    const vec3<F> way = both.way_from(both.nearest_on_axis());
    if (both.is_short(dot(way, way))) return verdict::yes;
    if constexpr (!Certified) return verdict::no;
    return both.is_beyond(way) ? verdict::no : verdict::unknown;
}

/// What directions tell that stay exact where the way is short.
template <scalar F>
ABUT_HD constexpr verdict near_by_axes(const box_from_axis<true, F>& both) {
    if (!both.in_range) return verdict::unknown;
    const vec3<F>& d = both.d;
    const vec3<F> axes[6] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -d.z, d.y}, {d.z, 0, -d.x}, {-d.y, d.x, 0}};
    ABUT_ROLLED
    for (int i = 0; i < 6; ++i) {
        if (both.is_beyond_either(axes[i])) return verdict::no;
    }
    return verdict::unknown;
}

}  // namespace abut::detail
