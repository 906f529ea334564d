// SPDX-License-Identifier: MIT
#pragma once

// Bounds on how far shapes with corners (points, segments, triangles) are from points that lie near each other. They say
// which shapes need not be measured: what they leave out is surely farther, as nearest_point.hpp measures it, than a shape
// that they keep.
//
// Let c be a point amid the others, x the corners of a shape as seen from c, and p one of the others, seen from c too. A
// point y of the shape is the mean of the corners by some weights w, and then
//
//   |p - y|^2 = sum of w_i |p - x_i|^2 - sum of w_i w_j |x_i - x_j|^2 over the pairs i < j.
//
// The second sum is at most (n - 1) / 2n of the square of the longest edge, for n corners. So the square of the distance is
//
//   not above   |x|^2 - 2 p.x + |p|^2 at the nearest corner x,
//   not below   that, less (n - 1) / 2n of the square of the longest edge.
//
// This needs nine multiplications for each point and triangle, and both bounds are as near to each other far away from the
// shape as beside it. |p|^2 is the same for all shapes, and is left out of the squares here.
//
// Rounding. All is computed from x and p, which are differences rounded once, so errors are relative to them and not to
// where the scene lies. Sums of a few products carry below 16u (|x|^2 + |p|^2), with the roundoff u of T; and the distance
// as it is measured differs from the true one by less than 2^-48 of it and of the shape's size. `slack_of_squares` covers
// both twice over. Underflow, also where denormals are flushed, takes less than 16 of the smallest normal number. Where
// squares might overflow there are no bounds.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// The corners of a shape's core (form.hpp), if it is a hull of some.
template <class S>
inline constexpr int corners_of_core = 0;
template <class S>
    requires requires(const S& s) { decltype(core_of(s))::corners; }
inline constexpr int corners_of_core<S> = decltype(core_of(std::declval<const S&>()))::corners;
template <class S>
concept has_radius = requires(const S& s) { s.radius; };

/// The corners of a shape that is its own core.
template <class S>
inline constexpr int corners_of_shape = has_radius<S> ? 0 : corners_of_core<S>;

/// Points whose convex hull a shape is.
template <class S>
concept has_corners = (corners_of_shape<S> > 0);

/// The corners as seen from a point.
template <scalar T, int N>
struct corners_from {
    vec3<T> at[std::size_t{N}];

    corners_from() = default;
    template <has_corners S>
    ABUT_HD corners_from(const S& s, const vec3<T>& from) {
        const auto core = core_of(s);
        for (int k = 0; k < N; ++k) at[k] = core.at[k] - from;
    }
};
template <has_corners S>
using seen_corners_of = corners_from<scalar_type_of<S>, corners_of_shape<S>>;

/// Relative to squares of what bounds are computed from.
template <scalar T>
inline constexpr T slack_of_squares = std::same_as<T, float> ? T(0x1p-17) : T(0x1p-44);

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
    seen_corner<T> corners[std::size_t{N}];
    T spread;  ///< how far the bounds are from each other
    std::uint32_t id;

    shape_from_amid() = default;
    ABUT_HD shape_from_amid(const corners_from<T, N>& seen, T far_squared, std::uint32_t number) : id(number) {
        T size = 0, longest = 0;
        for (int k = 0; k < N; ++k) {
            const vec3<T> edge = seen.at[k] - seen.at[k + 1 < N ? k + 1 : 0];
            size = greatest(size, dot(seen.at[k], seen.at[k]));
            longest = greatest(longest, dot(edge, edge));
        }
        const bool is_safe = size + far_squared < largest_finite<T> / 16;
        const T lost = slack_of_squares<T> * (size + far_squared) + 16 * smallest_normal<T>;
        for (int k = 0; k < N; ++k) {
            corners[k] = {seen.at[k], is_safe ? dot(seen.at[k], seen.at[k]) + lost : infinity<T>};
        }
        spread = is_safe ? T(N - 1) / (2 * N) * longest + 2 * lost : infinity<T>;
    }
    /// Of p, given -2 p.
    [[nodiscard]] ABUT_HD T most_from(const vec3<T>& minus_twice_p) const {
        T most = corners[0].at_most + dot(minus_twice_p, corners[0].at);
        for (int k = 1; k < N; ++k) most = least(corners[k].at_most + dot(minus_twice_p, corners[k].at), most);
        return most;
    }
    /// The same from below. Not a number where there is no bound.
    [[nodiscard]] ABUT_HD T least_from(const vec3<T>& minus_twice_p) const { return most_from(minus_twice_p) - spread; }
    /// Whether it may be as near as a given corner of another shape, to any of the points p that lie in a box around c.
    /// |p - corner|^2 - |p - x|^2 is linear in p.
    [[nodiscard]] ABUT_HD bool may_be_nearer(const vec3<T>& half_extent, const seen_corner<T>& corner) const {
        T nearest = infinity<T>;
        for (int k = 0; k < N; ++k) {
            const T most = dot(half_extent, absolute(corners[k].at - corner.at));
            nearest = least(corners[k].at_most - (most + most), nearest);
        }
        return !(corner.at_most < nearest - spread);
    }
};
template <has_corners S>
using seen_shape_of = shape_from_amid<scalar_type_of<S>, corners_of_shape<S>>;

}  // namespace abut::detail
