// SPDX-License-Identifier: MIT
#pragma once

// Bounds on how far shapes with corners (points, segments, triangles) are from points that lie near each other. They say
// which shapes need not be measured: what they leave out is surely farther, as nearest_point.hpp measures it, than a shape
// that they keep.
//
// Let c be a point amid the others, x the corners of a shape as seen from c, and p one of the others, seen from c too. For
// every point y of the shape |p - y|^2 = |y|^2 - 2 p.y + |p|^2. The first term is least at the shape's point nearest to c,
// and the second at a corner. So |p|^2 aside the square of the distance is
//
//   not above   |x|^2 - 2 p.x, for each corner x,
//   not below   d^2 + min over the corners of -2 p.x, where d is the distance from c.
//
// This needs nine multiplications for each point and triangle, and is the better the smaller the shape.
//
// Rounding. All is computed from x and p, which are differences rounded once, so errors are relative to them and not to
// where the scene lies. Sums of a few products carry below 16u (|x|^2 + |p|^2), with the roundoff u of T; and the distance
// as it is measured differs from the true one by less than 2^-48 of it and of the shape's size. `slack_of_squares` covers
// both twice over. Underflow, also where denormals are flushed, takes less than 16 of the smallest normal number. Where
// squares might overflow there are no bounds.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

template <class S>
inline constexpr int corners_of_shape = 0;
template <scalar T>
inline constexpr int corners_of_shape<vec3<T>> = 1;
template <scalar T>
inline constexpr int corners_of_shape<segment<T>> = 2;
template <scalar T>
inline constexpr int corners_of_shape<triangle<T>> = 3;

/// Points whose convex hull a shape is.
template <class S>
concept has_corners = (corners_of_shape<S> > 0);

/// The corners as seen from a point.
template <scalar T, int N>
struct corners_from {
    vec3<T> at[std::size_t{N}];

    corners_from() = default;
    ABUT_HD corners_from(const vec3<T>& p, const vec3<T>& from) : at{p - from} {}
    ABUT_HD corners_from(const segment<T>& s, const vec3<T>& from) : at{s.a - from, s.b - from} {}
    ABUT_HD corners_from(const triangle<T>& t, const vec3<T>& from) : at{t.a - from, t.b - from, t.c - from} {}
};
template <has_corners S>
using seen_corners_of = corners_from<scalar_type_of<S>, corners_of_shape<S>>;

/// Relative to squares of what bounds are computed from.
template <scalar T>
inline constexpr T slack_of_squares = std::same_as<T, float> ? T(0x1p-17) : T(0x1p-44);

/// The square of the distance from the origin is not below this but for rounding of the corners' squares. For any direction w
/// all corners lie beyond the plane across w through the corner with the least product w.x, and so does the shape: it is no
/// nearer than min(w.x) / |w|, if that is positive. Three w are tried: to the nearest corner, to the foot on an edge, and the
/// normal. Out of line: on a device its callers have to fit into the cache of instructions.
template <scalar T, int N>
ABUT_NOINLINE ABUT_HD T least_square_to_hull(const corners_from<T, N> corners) {
    constexpr T tiny = std::same_as<T, float> ? T(0x1p-100) : T(0x1p-900);
    vec3<T> a = corners.at[0];
    T aa = dot(a, a);
    if constexpr (N == 1) {
        return aa;
    } else {
        vec3<T> b = corners.at[1];
        const auto first_if_nearer = [&](vec3<T>& other) {
            const T square = dot(other, other);
            if (!(square < aa)) return;
            const vec3<T> before = a;
            a = other;
            other = before;
            aa = square;
        };
        T most = 0;
        const auto offer = [&](T along, T square) {
            if (along > tiny && square > tiny) most = greatest(along / square * along, most);
        };
        first_if_nearer(b);
        if constexpr (N == 2) {
            offer(least(dot(a, b), aa), aa);
            const vec3<T> edge = b - a, foot = a + (-dot(a, edge) / dot(edge, edge)) * edge;
            offer(least(dot(foot, a), dot(foot, b)), dot(foot, foot));
        } else {
            vec3<T> c = corners.at[2];
            first_if_nearer(c);
            T ab = dot(a, b), ac = dot(a, c);
            if (ac < ab) {  // let b be the one with the lesser product with a
                const vec3<T> before = b;
                b = c;
                c = before;
                ab = ac;
            }
            offer(least(ab, aa), aa);
            const vec3<T> edge = b - a;
            const vec3<T> foot = a + (-dot(a, edge) / dot(edge, edge)) * edge;
            offer(least(dot(foot, a), dot(foot, b), dot(foot, c)), dot(foot, foot));
            const vec3<T> normal = cross(edge, c - a);
            const T at_a = dot(normal, a), at_b = dot(normal, b), at_c = dot(normal, c);
            offer(greatest(least(at_a, at_b, at_c), -greatest(at_a, at_b, at_c)), dot(normal, normal));
        }
        return most;
    }
}

/// A corner, from which c is subtracted, and what the square of the distance to it is not above, without |p|^2.
template <scalar T>
struct alignas(4 * sizeof(T)) seen_corner {
    vec3<T> at;
    T at_most;

    seen_corner() = default;
    ABUT_HD seen_corner(const vec3<T>& corner, T most) : at(corner), at_most(most) {}
    /// Of a shape whose farthest corner has the square `size`.
    ABUT_HD seen_corner(const vec3<T>& corner, T size, T far_squared) : at(corner) {
        const T square = dot(at, at);
        const bool is_safe = size + far_squared < largest_finite<T> / 16;
        const T lost = slack_of_squares<T> * (square + far_squared) + (T(0x1p-44) * size + 16 * smallest_normal<T>);
        at_most = is_safe ? square + lost : infinity<T>;
    }
};

/// A shape as seen from c, for points p at most `far` from it, whose square is given. Squares of distances are meant without
/// |p|^2.
template <scalar T, int N>
struct alignas(4 * sizeof(T)) shape_from_amid {
    corners_from<T, N> corners;
    T at_most;  ///< of the first corner
    T at_least;
    std::uint32_t id;

    shape_from_amid() = default;
    ABUT_HD shape_from_amid(const corners_from<T, N>& seen, T far_squared, std::uint32_t number)
        : corners(seen), id(number) {
        T size = 0;
        for (int k = 0; k < N; ++k) size = greatest(size, dot(seen.at[k], seen.at[k]));
        at_most = seen_corner<T>(seen.at[0], size, far_squared).at_most;
        const bool is_safe = at_most < infinity<T>;
        at_least = is_safe ? least_square_to_hull(seen) - slack_of_squares<T> * (size + far_squared) : -infinity<T>;
    }
    /// Of p, given -2 p: to the first corner.
    [[nodiscard]] ABUT_HD T most_from(const vec3<T>& minus_twice_p) const {
        return at_most + dot(minus_twice_p, corners.at[0]);
    }
    /// Of p, given -2 p.
    [[nodiscard]] ABUT_HD T least_from(const vec3<T>& minus_twice_p) const {
        T least_of_all = dot(minus_twice_p, corners.at[0]);
        for (int k = 1; k < N; ++k) least_of_all = least(dot(minus_twice_p, corners.at[k]), least_of_all);
        return at_least + least_of_all;
    }
    /// The same of p, by a bound that takes longer and tells more.
    [[nodiscard]] ABUT_HD T least_from_point(const vec3<T>& p) const {
        corners_from<T, N> from_p;
        T size = 0;
        for (int k = 0; k < N; ++k) {
            from_p.at[k] = corners.at[k] - p;
            size = greatest(size, dot(from_p.at[k], from_p.at[k]));
        }
        if (!(at_least > -infinity<T>)) return at_least;
        const T square = dot(p, p);
        return least_square_to_hull(from_p) - slack_of_squares<T> * (size + square) - square;
    }
    /// Whether it may be as near as a given corner of another shape, to any of the points p that lie in a box around c.
    /// |p - corner|^2 - |p - y|^2 is linear in p, and what is added to its value at c the most at a corner of the shape.
    [[nodiscard]] ABUT_HD bool may_be_nearer(const vec3<T>& half_extent, const seen_corner<T>& corner) const {
        T most = 0;
        for (int k = 0; k < N; ++k) most = greatest(most, dot(half_extent, absolute(corners.at[k] - corner.at)));
        return !(corner.at_most + (most + most) < at_least);
    }
};
template <has_corners S>
using seen_shape_of = shape_from_amid<scalar_type_of<S>, corners_of_shape<S>>;

}  // namespace abut::detail
