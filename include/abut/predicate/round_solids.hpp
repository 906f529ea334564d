// SPDX-License-Identifier: MIT
#pragma once

// Spheres and capsules as solids: all within a radius of a segment, which may be a point. How two of them lie to each other, and
// how near one is to the faces and vertices of another solid, is told by signs of squared distances less squared radii, which are
// ratios of integers. Not for cylinders and cones.
//
// The distance from a segment Q goes up by r in some direction from any point, so that the ball of radius r about p is in the
// capsule of radius s about Q where the distance of p from Q is s - r at most. It is a convex function: of all points of another
// segment, or of a polyhedron, an end or a vertex is farthest.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/big_int.hpp>
#include <abut/arithmetic/whole_numbers.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/solid_cones.hpp>
#include <abut/shape/capsule.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/sphere.hpp>

namespace abut::detail {

template <class X>
inline constexpr bool is_round = false;
template <scalar T>
inline constexpr bool is_round<sphere<T>> = true;
template <scalar T>
inline constexpr bool is_round<capsule<T>> = true;

/// A round shape as a capsule, which may have no length.
template <scalar T>
capsule<T> as_capsule(const sphere<T>& s) {
    return {{s.center, s.center}, s.radius};
}
template <scalar T>
capsule<T> as_capsule(const capsule<T>& s) {
    return s;
}

/// Signs of distances less a length, squared and exact.
class squared_distances {
public:
    using point = vec3<big_int>;
    using points = std::array<point, 2>;

    /// Of a point and a segment.
    static int sign(const point& p, const points& s, const big_int& length) {
        const point along = s[1] - s[0], to = p - s[0];
        const big_int t = dot(to, along), whole = dot(along, along), most = length * length;
        if (t.sign() <= 0) return (dot(to, to) - most).sign();
        if ((t - whole).sign() >= 0) return (square(p - s[1]) - most).sign();
        return (square(cross(to, along)) - most * whole).sign();
    }
    /// Of two segments: of their lines, where these are nearest between the ends; else of an end.
    static int sign(const points& s, const points& t, const big_int& length) {
        const point u = s[1] - s[0], v = t[1] - t[0], from = t[0] - s[0], n = cross(u, v);
        const big_int whole = dot(n, n), at_s = dot(cross(from, v), n), at_t = dot(cross(from, u), n);
        const auto is_between = [&](const big_int& x) { return x.sign() > 0 && (x - whole).sign() < 0; };
        if (whole.sign() > 0 && is_between(at_s) && is_between(at_t)) {
            const big_int height = dot(from, n);
            return (height * height - length * length * whole).sign();
        }
        return std::min(std::min(sign(s[0], t, length), sign(s[1], t, length)), std::min(sign(t[0], s, length), sign(t[1], s, length)));
    }
    /// Of a segment that does not pass through a triangle, and the triangle, which has an area.
    static int sign(const points& s, const std::array<point, 3>& t, const big_int& length) {
        const point n = cross(t[1] - t[0], t[2] - t[0]);
        int least = 1;
        for (std::size_t k = 0; k < 3; ++k) least = std::min(least, sign(s, points{t[k], t[(k + 1) % 3]}, length));
        for (const point& p : s) {
            bool is_above = true;
            for (std::size_t k = 0; k < 3; ++k) {
                is_above = is_above && dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), n).sign() >= 0;
            }
            if (!is_above) continue;
            const big_int height = dot(p - t[0], n);
            least = std::min(least, (height * height - length * length * dot(n, n)).sign());
        }
        return least;
    }

private:
    static big_int square(const point& p) { return dot(p, p); }
};

/// What two solids have in common, and whether their surfaces touch.
struct regions_and_touch {
    common_regions found;
    bool touch;
};

/// Of two round solids.
template <scalar T>
regions_and_touch regions_of_round(const capsule<T>& a, const capsule<T>& b) {
    whole_numbers<T> unit;
    for (const capsule<T>* s : {&a, &b}) {
        unit.look_at(s->axis.a);
        unit.look_at(s->axis.b);
        unit.look_at(s->radius);
    }
    const squared_distances::points s{unit(a.axis.a), unit(a.axis.b)}, t{unit(b.axis.a), unit(b.axis.b)};
    const big_int r = unit(a.radius), q = unit(b.radius);
    const int apart = squared_distances::sign(s, t, r + q);
    if (apart >= 0) return {{false, true, true}, apart == 0};
    // How far the first goes out of the second: -1 for not at all, 0 for up to its surface.
    const auto goes_out = [](const auto& of, const big_int& by, const auto& out_of, const big_int& reach) {
        const big_int left = reach - by;
        if (left.sign() < 0) return 1;
        return std::max(squared_distances::sign(of[0], out_of, left), squared_distances::sign(of[1], out_of, left));
    };
    const int first = goes_out(s, r, t, q), second = goes_out(t, q, s, r);
    return {{true, first > 0, second > 0}, (first >= 0 && second >= 0) || first == 0 || second == 0};
}

/// How near a round solid comes to the faces of another one, and how far its vertices go out of it.
template <scalar T>
class round_and_faces {
public:
    explicit round_and_faces(const capsule<T>& round) : round_(round) {}
    /// Whether a face of positive area that the solid meets has a point in its interior.
    [[nodiscard]] bool has_within(const triangle<T>& t) const {
        if (intersects<filtered>(round_.axis, t)) return true;
        whole_numbers<T> unit = of_round();
        unit.look_at(t.a), unit.look_at(t.b), unit.look_at(t.c);
        const squared_distances::points s{unit(round_.axis.a), unit(round_.axis.b)};
        return squared_distances::sign(s, {unit(t.a), unit(t.b), unit(t.c)}, unit(round_.radius)) < 0;
    }
    /// 1 if a point is outside, 0 on the surface, -1 in the interior.
    [[nodiscard]] int place_of(const vec3<T>& p) const {
        if (!intersects<filtered>(round_, p)) return 1;
        whole_numbers<T> unit = of_round();
        unit.look_at(p);
        return squared_distances::sign(unit(p), {unit(round_.axis.a), unit(round_.axis.b)}, unit(round_.radius));
    }

private:
    [[nodiscard]] whole_numbers<T> of_round() const {
        whole_numbers<T> unit;
        unit.look_at(round_.axis.a), unit.look_at(round_.axis.b), unit.look_at(round_.radius);
        return unit;
    }
    capsule<T> round_;
};

/// Of a round solid and one of faces, of which `met` are those that the round one meets; inside(p) says whether a point that is on no
/// face is in the solid of faces.
template <scalar T, class Faces, class Inside>
regions_and_touch regions_of_round(const capsule<T>& round, const Faces& faces, const std::vector<std::uint32_t>& met, const Inside& inside) {
    const round_and_faces<T> near(round);
    bool passes = false;
    for (std::size_t i = 0; i < met.size() && !passes; ++i) passes = near.has_within(faces[met[i]].corners);
    if (!passes) {
        // No point of the surface is in the interior of the round solid, which is on one side of it, then.
        const bool is = inside(round.axis.a);
        return {{is, !is, true}, !met.empty()};
    }
    int farthest = -1;
    for (std::size_t i = 0; i < faces.size() && farthest < 1; ++i) {
        for (const vec3<T>* p : {&faces[i].corners.a, &faces[i].corners.b, &faces[i].corners.c}) {
            farthest = std::max(farthest, near.place_of(*p));
        }
    }
    return {{true, true, farthest > 0}, farthest >= 0};
}

}  // namespace abut::detail
