// SPDX-License-Identifier: MIT
#pragma once

// Does a shape touch a plane? The corners' heights, normal . v - offset, must not be all above or all below: the height is
// linear, so it takes every value between its least and its greatest, on degenerate shapes as well. Of a box two corners
// tell, the lowest and the highest. A ball, or what is within a radius of a segment, may also lie on one side, if
// |height| <= radius |normal| at an end. A plane whose normal is 0 has one height everywhere and needs no case of its own.
// With a distance added to the radius, that is `within`.

#include <concepts>
#include <cstddef>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/plain_sign.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// Degree 2, and 4 where there is a radius. The exact stages see one unit of all values, so that a product is worth its
/// square: the offset is multiplied by a 1 of that unit. The plane's normal and offset, a 1, the corners; then, where they
/// are meant, a radius and a distance.
template <int N, bool Round>
struct plane_meets_corners {
    static constexpr int degree = Round ? 4 : 2, points = 0;
    static constexpr std::size_t values = std::size_t{5 + 3 * N + (Round ? 2 : 0)};

    template <class Number>
    ABUT_HD static constexpr bool holds(const Number (&value)[values]) {
        const vec3<Number> normal{value[0], value[1], value[2]};
        const auto offset = value[3] * value[4];
        int lowest = 1, highest = -1;
        for (int i = 0; i < N; ++i) {
            const int height = sign(height_at(value, i, normal, offset));
            lowest = height < lowest ? height : lowest;
            highest = height > highest ? height : highest;
        }
        if (lowest <= 0 && highest >= 0) return true;
        if constexpr (Round) {
            const auto reach = scale(value[5 + 3 * N] + value[6 + 3 * N], normal);
            for (int i = 0; i < N; ++i) {
                if (squares_at_most(height_at(value, i, normal, offset), reach)) return true;
            }
        }
        return false;
    }

private:
    template <class Number, class Product>
    ABUT_HD static constexpr auto height_at(const Number (&value)[values], int i, const vec3<Number>& normal,
                                            const Product& offset) {
        return dot(normal, vec3<Number>{value[5 + 3 * i], value[6 + 3 * i], value[7 + 3 * i]}) - offset;
    }
};
using plane_meets_triangle = plane_meets_corners<3, false>;

/// Whose lowest and highest points over a plane tell what all of it does.
template <scalar T, class S>
    requires(corners_of_core<S> > 0)
ABUT_HD constexpr auto core_over(const plane<T>&, const S& s) {
    return core_of(s);
}
template <scalar T>
ABUT_HD constexpr corner_hull<T, 2> core_over(const plane<T>& p, const aabb<T>& box) {
    const bool x = has_sign(p.normal.x), y = has_sign(p.normal.y), z = has_sign(p.normal.z);
    const vec3<T>&l = box.lower, &u = box.upper;
    return {{{x ? u.x : l.x, y ? u.y : l.y, z ? u.z : l.z}, {x ? l.x : u.x, y ? l.y : u.y, z ? l.z : u.z}}};
}

/// What a plane and a shape of the same scalar type may be asked.
template <class S, class T>
concept has_height = scalar<T> && std::same_as<scalar_type_of<S>, T> && requires(const plane<T>& p, const S& s) {
    core_over(p, s);
};
template <scalar T, has_height<T> S>
inline constexpr int corners_over_plane = decltype(core_over(plane<T>{}, S{}))::corners;

/// The values without a radius, in the input's type.
template <scalar T, has_height<T> S>
ABUT_HD constexpr auto values_of(const plane<T>& p, const S& s) {
    const auto core = core_over(p, s);
    constexpr std::size_t n = corners_over_plane<T, S>;
    row_of<T, 5 + 3 * n> row{};
    T* end = append(append(append(row.value, p.normal), p.offset), T(1));
    for (const vec3<T>& v : core.at) end = append(end, v);
    return row;
}

/// And with one, in the type F: as they are in double, or of `fast` in the input's type.
template <scalar F, scalar T, has_height<T> S>
ABUT_HD constexpr auto values_over(const plane<T>& p, const S& s, F distance) {
    const auto plain = values_of(p, s);
    constexpr std::size_t n = 5 + 3 * std::size_t{corners_over_plane<T, S>};
    row_of<F, n + 2> row{};
    const auto as_it_is = [](T x) {
        if constexpr (std::same_as<F, T>) {
            return x;
        } else {
            return widened_exactly(x);
        }
    };
    for (std::size_t i = 0; i < n; ++i) row.value[i] = as_it_is(plain.value[i]);
    row.value[n] = as_it_is(radius_around_core(s));
    row.value[n + 1] = distance;
    return row;
}

/// In double, also for float input. A height is a sum of three products and the offset, with at most four roundings on the
/// way of any of them. Let `size` be the sum of those terms' magnitudes, the greatest over all corners: heights
/// are within 5u of it, u = 2^-52, in each rounding mode and with or without contraction. The code takes 8u, which pays for
/// the rounding of `size` as well. What flush to zero takes from an input or a product is below 2^-126 (float) or 2^-1022
/// times the other factor, for each of three terms and the offset. Double input whose products may overflow is left
/// undecided. Where it is `Solid`, what is below the plane belongs to it.
///
/// A radius R reaches as high as the vector v = R n is long. Of its square, 2^-40 pays for all rounding, and 2^-1000 for
/// what squares lose that underflow. What flush to zero takes from v is below 2^-124 (|n| + R + 2^-124) in float, and in
/// double likewise; `tiny` is more.
template <bool Round, bool Solid = false, scalar T, int N>
ABUT_HD constexpr verdict certified_heights(const plane<T>& p, const corner_hull<T, N>& core,
                                            [[maybe_unused]] double radius) {
    constexpr double tiny = std::same_as<T, float> ? 0x1p-122 : 0x1p-1018;
    const vec3<double> n = widened(p.normal), size_n = absolute(n);
    const double offset = rounded(static_cast<double>(p.offset));
    double lowest = infinity<double>, highest = -infinity<double>;
    vec3<double> reach{0, 0, 0};
    for (const vec3<T>& corner : core.at) {
        const vec3<double> v = widened(corner);
        const double height = dot(n, v) - offset;
        lowest = least(height, lowest);
        highest = greatest(height, highest);
        reach = greatest(absolute(v), reach);
    }
    const double size = dot(size_n, reach) + absolute(offset);
    if constexpr (!Round) {
        if (std::same_as<T, double> && !(size < 0x1p1000)) return verdict::unknown;
        const double bound = 0x1p-49 * size + tiny * (magnitudes(n) + magnitudes(reach) + 1);
        if (lowest > bound || (!Solid && highest < -bound)) return verdict::no;
        return lowest < -bound && (Solid || highest > bound) ? verdict::yes : verdict::unknown;
    } else {
        const vec3<double> v = radius * n;
        const double square = dot(v, v), bound = 0x1p-49 * size + tiny * (magnitudes(n) + magnitudes(reach) + radius + 1);
        if (std::same_as<T, double> && !(size < 0x1p480 && square < 0x1p960)) return verdict::unknown;
        const double nearest = greatest(lowest, -highest);  // below 0 where the plane goes between corners
        const double from = nearest - bound, to = nearest + bound;
        if (from > 0 && from * from > (1 + 0x1p-40) * square + 0x1p-1000) return verdict::no;
        const bool reaches = (1 + 0x1p-40) * (to * to) + 0x1p-1000 <= square;
        return to < 0 || reaches ? verdict::yes : verdict::unknown;
    }
}

/// The stages of `within` for a plane and a shape with corners, or a box. The first one, in registers.
template <arithmetic A, scalar T, has_height<T> S>
ABUT_HD constexpr verdict decide_within(const plane<T>& p, const S& s, double distance) {
    using predicate = plane_meets_corners<corners_over_plane<T, S>, true>;
    if constexpr (std::same_as<A, exact>) {
        return decide_in_limbs<predicate>(values_over<double>(p, s, distance).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return certified_heights<true>(p, core_over(p, s), radius_within<true>(p, s, distance));
    } else {
        return to_verdict(predicate::holds(values_over<T>(p, s, static_cast<T>(distance)).value));
    }
}

/// The last one: decides every finite input.
template <scalar T, has_height<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const plane<T>& p, const S& s, double distance) {
    using predicate = plane_meets_corners<corners_over_plane<T, S>, true>;
    return decide_at_any_span<predicate>(values_over<double>(p, s, distance).value);
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle.
template <arithmetic A, scalar T, detail::has_height<T> S>
ABUT_HD constexpr verdict decide(const plane<T>& p, const S& s) {
    if constexpr (detail::has_radius<S>) {
        return detail::decide_within<A>(p, s, 0);
    } else {
        using predicate = detail::plane_meets_corners<detail::corners_over_plane<T, S>, false>;
        if constexpr (std::same_as<A, exact>) {
            return decide_in_limbs<predicate>(detail::values_of(p, s).value);
        } else if constexpr (std::same_as<A, filtered>) {
            return detail::certified_heights<false>(p, detail::core_over(p, s), 0);
        } else {
            return to_verdict(predicate::holds(detail::values_of(p, s).value));
        }
    }
}

/// The last stage: decides every finite input.
template <scalar T, detail::has_height<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const plane<T>& p, const S& s) {
    if constexpr (detail::has_radius<S>) {
        return detail::resolve_within(p, s, 0);
    } else {
        return decide_at_any_span<detail::plane_meets_corners<detail::corners_over_plane<T, S>, false>>(
            detail::values_of(p, s).value);
    }
}

}  // namespace abut
