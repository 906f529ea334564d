// SPDX-License-Identifier: MIT
#pragma once

// Whether convex shapes come within a distance of each other, by their farthest points on ways alone: the search of gjk.hpp in
// 256 digits, or in double where that is enough. No is certain. In double yes is as well, and what lies between is unknown; in
// 256 digits yes is what a search comes to that finds no way on which the shapes are farther apart. Not for shapes that exact
// signs decide.
//
// Numbers are known but for `lost`, a share of the size of both: 2^-200 or in double 2^-42. That is more than what differences
// of coordinates, a few products with a way of length 1 and the farthest points below are off by. In double a size is between
// 2^-60 and 2^60, so that products of ten differences neither overflow nor vanish.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/arithmetic/wide_float.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <class N>
inline constexpr bool is_wide = std::same_as<N, wide_float>;

ABUT_HD constexpr double inverse_root(double x) { return 1 / square_root(x); }
template <class N>
ABUT_HD constexpr int sense_of(const N& x) {
    using abut::sign;
    return sign(x);
}
template <class N>
ABUT_HD constexpr N magnitude_of(const N& x) {
    return sense_of(x) < 0 ? -x : x;
}
template <class N>
ABUT_HD constexpr N magnitudes_of(const vec3<N>& v) {
    return magnitude_of(v.x) + magnitude_of(v.y) + magnitude_of(v.z);
}
template <class N>
ABUT_HD constexpr vec3<N> way_of_length_1(const vec3<N>& v) {
    return inverse_root(dot(v, v)) * v;
}
/// One point as seen from another.
template <class N, scalar T>
ABUT_HD constexpr vec3<N> seen_in(const vec3<T>& p, const vec3<T>& from) {
    const auto in = [](T x) {
        if constexpr (is_wide<N>) {
            return N(x);
        } else {
            return widened_exactly(x);
        }
    };
    return {in(p.x) - in(from.x), in(p.y) - in(from.y), in(p.z) - in(from.z)};
}

/// A solid whose axis has a length.
template <class N>
struct solid_in_numbers {
    vec3<N> first, last, unit;  ///< `unit` along the axis
    N radius;
    bool is_cone;

    template <solid_of_revolution S>
    ABUT_HD constexpr solid_in_numbers(const S& s, const vec3<scalar_type_of<S>>& origin)
        : first(seen_in<N>(axis_of(s).a, origin)),
          last(seen_in<N>(axis_of(s).b, origin)),
          unit(way_of_length_1(seen_in<N>(axis_of(s).b, axis_of(s).a))),
          radius(N(widened_exactly(s.radius))),
          is_cone(questions_of<S>::type::is_cone) {}

    /// On a way of length 1. What is across the axis is made orthogonal to it twice: rounding leaves anything of a way along
    /// it, and then as much as of a number. Where it is shorter than 2^-240, or in double 2^-45, the centre is as far.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr vec3<N> farthest(const vec3<N>& one) const {
        const N along = dot(one, unit);
        vec3<N> across = one - along * unit;
        if (sense_of(dot(across, across) - N(is_wide<N> ? 0x1p-480 : 0x1p-90)) < 0) return sense_of(along) > 0 ? last : first;
        across = way_of_length_1(across);
        across = way_of_length_1(across - dot(across, unit) * unit);
        const vec3<N> rim = last + radius * across;
        if (is_cone) return sense_of(dot(one, rim - first)) > 0 ? rim : first;
        return sense_of(along) > 0 ? rim : first + radius * across;
    }
    /// No less than how far any point of it is from the origin.
    [[nodiscard]] ABUT_HD constexpr N size() const { return magnitudes_of(first) + magnitudes_of(last) + radius; }
    [[nodiscard]] ABUT_HD constexpr vec3<N> any_point() const { return first; }
};

/// The hull of some points, as corner_hull has them.
template <class N, class Points>
struct points_in_numbers {
    Points points;
    vec3<scalar_type_of<std::remove_cvref_t<decltype(std::declval<Points>().as_hull())>>> origin;

    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr vec3<N> farthest(const vec3<N>& one) const {
        const auto of = points.as_hull();
        vec3<N> best = any_point();
        ABUT_ROLLED
        for (std::size_t i = 1; i < of.count; ++i) {
            const vec3<N> p = seen_in<N>(of[i], origin);
            if (sense_of(dot(one, p - best)) > 0) best = p;
        }
        return best;
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr N size() const {
        const auto of = points.as_hull();
        N most{};
        ABUT_ROLLED
        for (std::size_t i = 0; i < of.count; ++i) {
            const N here = magnitudes_of(seen_in<N>(of[i], origin));
            if (sense_of(here - most) > 0) most = here;
        }
        return most;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<N> any_point() const { return seen_in<N>(points.as_hull()[0], origin); }
};

/// What a ray has that is nearest to anything: from its origin, which is that of all, to where.
template <class N>
struct part_of_ray {
    vec3<N> end;

    [[nodiscard]] ABUT_HD constexpr vec3<N> farthest(const vec3<N>& one) const {
        return sense_of(dot(one, end)) > 0 ? end : vec3<N>{};
    }
    [[nodiscard]] ABUT_HD constexpr N size() const { return magnitudes_of(end); }
    [[nodiscard]] ABUT_HD constexpr vec3<N> any_point() const { return {}; }
};

/// The difference of points that was asked for last, how many were, and the way on which the shapes were farthest apart: it is
/// `ahead` along the way, the square of whose length is `square`.
template <class N>
struct asked_differences {
    vec3<N> last, best_way;
    N ahead{}, square{};
    std::uint32_t count = 0;
};

/// Two shapes that are to be within `reach`, as gjk.hpp reads two hulls.
template <class N, class X, class Y>
class farthest_points {
public:
    using number = N;
    static constexpr int most_steps = is_wide<N> ? 100 : 48;

    ABUT_HD constexpr farthest_points(const X& x, const Y& y, const N& reach, asked_differences<N>& asked)
        : x_(x), y_(y), lost_(N(is_wide<N> ? 0x1p-200 : 0x1p-42) * (x.size() + y.size() + reach)), reach_(reach), asked_(asked) {}

    /// To begin with, and to begin again with.
    [[nodiscard]] ABUT_HD constexpr vec3<N> way_between_middles() const {
        return asked_.count > 0 ? asked_.best_way : x_.any_point() - y_.any_point();
    }
    [[nodiscard]] ABUT_HD constexpr vec3<N> difference(std::uint32_t, std::uint32_t) const { return asked_.last; }
    ABUT_HD constexpr void look_back(const vec3<N>& way, std::uint32_t& i, std::uint32_t& j) const {
        i = j = ++asked_.count;
        const vec3<N> one = sense_of(dot(way, way)) > 0 ? way_of_length_1(way) : vec3<N>{N(1.0), N{}, N{}};
        asked_.last = x_.farthest(N(-1.0) * one) - y_.farthest(one);
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<N>& way, std::uint32_t, std::uint32_t) const {
        const N ahead = dot(way, asked_.last), far = reach_ + lost_, square = dot(way, way);
        if (sense_of(ahead) <= 0) return false;
        if (sense_of(ahead * ahead * asked_.square - asked_.ahead * asked_.ahead * square) > 0 || sense_of(asked_.square) == 0) {
            asked_.best_way = way, asked_.ahead = ahead, asked_.square = square;
        }
        return sense_of(ahead * ahead - far * far * square) > 0;
    }
    /// Whether the feature's point that is nearest to the origin is near enough, by weights that are not negative.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_enough(const vec3<N> (&w)[4], const difference_simplex& at) const {
        const auto kept = [](const N& x) { return sense_of(x) > 0 ? x : N{}; };
        N weight[3]{N(1.0), N{}, N{}};
        if (at.count == 2) {
            const vec3<N> e = w[1] - w[0];
            weight[0] = kept(dot(e, w[1]));
            weight[1] = kept(-dot(e, w[0]));
        } else if (at.count == 3) {
            const vec3<N> n = cross(w[1] - w[0], w[2] - w[0]);
            weight[0] = kept(dot(n, cross(w[1], w[2])));
            weight[1] = kept(dot(n, cross(w[2], w[0])));
            weight[2] = kept(dot(n, cross(w[0], w[1])));
        } else if (at.count == 4) {
            return false;
        }
        vec3<N> q = weight[0] * w[0];
        if (at.count > 1) q = q + weight[1] * w[1];
        if (at.count > 2) q = q + weight[2] * w[2];
        const N most = (is_wide<N> ? reach_ + lost_ : reach_ - lost_) * (weight[0] + weight[1] + weight[2]);
        if (!is_wide<N> && sense_of(most - N(0x1p-500)) <= 0) return false;
        return sense_of(most) > 0 && sense_of(dot(q, q) - most * most) <= 0;
    }
    /// Whether a tetrahedron holds the origin with what is lost about it: rounding finds that as well in a flat one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict holds_origin(const vec3<N> (&w)[4],
                                                                       const difference_simplex& at) const {
        if (at.count < 4) return verdict::unknown;
        const int side = side_of(w[1], w[2], w[3]);
        return side != 0 && side_of(w[0], w[3], w[2]) == side && side_of(w[0], w[1], w[3]) == side &&
                       side_of(w[0], w[2], w[1]) == side
                   ? verdict::yes
                   : verdict::unknown;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }

private:
    /// On which side of the origin the plane of three points is, or 0 where it is too near.
    [[nodiscard]] ABUT_HD constexpr int side_of(const vec3<N>& p, const vec3<N>& q, const vec3<N>& r) const {
        const vec3<N> n = cross(q - p, r - p);
        const N volume = dot(p, n);
        return sense_of(volume * volume - lost_ * lost_ * dot(n, n)) > 0 ? sense_of(volume) : 0;
    }

    const X& x_;
    const Y& y_;
    N lost_, reach_;
    asked_differences<N>& asked_;
};

/// Whether they are within a reach; `unknown` where rounding leaves that open, or the search does not come to an end. In 256
/// digits it begins again where it is lost, as rounding makes it in flat tetrahedra, on the best way that it came to.
template <class N, class X, class Y>
ABUT_NOINLINE ABUT_HD constexpr verdict search_near(const X& x, const Y& y, const N& reach) {
    asked_differences<N> asked{};
    const farthest_points<N, X, Y> both(x, y, reach, asked);
    verdict near = verdict::unknown;
    ABUT_ROLLED
    for (int i = 0; i < (is_wide<N> ? 12 : 1) && near == verdict::unknown; ++i) {
        vec3<N> w[4]{};
        difference_simplex at;
        near = search_origin<sought::meeting>(both, at, w);
    }
    return near;
}

}  // namespace abut::detail
