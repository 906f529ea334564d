// SPDX-License-Identifier: MIT
#pragma once

// How far a cylinder or a cone reaches on a way, in double: what the searches of gjk.hpp ask of it.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Points of a solid that a search asked for: an end of the axis, and how far from there.
struct points_of_solid {
    static constexpr int room = 33;
    std::uint32_t end[room]{};
    vec3<double> to_rim[room]{};
    int count = 0;

    /// Its number. The last place is taken again and again, if there are too many.
    ABUT_HD constexpr std::uint32_t append(std::uint32_t at, const vec3<double>& from_there) {
        const int k = count;
        if (count < room - 1) ++count;
        end[k] = at;
        to_rim[k] = from_there;
        return static_cast<std::uint32_t>(k);
    }
};

/// A way whose magnitudes sum up to 1; or zero, on which nothing is ahead.
ABUT_HD constexpr vec3<double> of_size_1(const vec3<double>& way) {
    const double size = magnitudes(way);
    return size > 0x1p-1000 && size < 0x1p1000 ? (1 / size) * way : vec3<double>{0, 0, 0};
}

/// What rounding leaves of how far a solid reaches on a way of size 1, of numbers of this size; or too much.
template <scalar T>
ABUT_HD constexpr double lost_on_ways(double size) {
    return 0x1p-45 * size + (lost_of_differences<T> + 0x1p-900);
}
template <scalar T>
ABUT_HD constexpr bool is_more_than_lost(double ahead, double size) {
    const double lost = lost_on_ways<T>(size);
    return lost < 0x1p900 && ahead > lost;
}

/// What a solid, whose axis has a length, is beside that.
template <solid_of_revolution S>
struct solid_beside_axis {
    using T = scalar_type_of<S>;
    static constexpr bool is_cone = questions_of<S>::type::is_cone;

    vec3<double> axis;  ///< of length 1
    double radius;
    bool is_known;  ///< whether small numbers that are read as 0 have not turned the axis

    ABUT_HD constexpr explicit solid_beside_axis(const S& s) : axis{}, radius(static_cast<double>(s.radius)), is_known{} {
        const vec3<double> along = relative_to(axis_of(s).a, axis_of(s).b);
        const double size = magnitudes(along);
        is_known = size > (std::same_as<T, float> ? 0x1p-70 : 0x1p-900) && size < 0x1p900;
        const vec3<double> unit = (1 / size) * along;
        axis = (1 / square_root(dot(unit, unit))) * unit;
    }

    [[nodiscard]] ABUT_HD static constexpr double length_of(const vec3<double>& v) { return square_root(dot(v, v)); }
    /// From an end to where its disc is farthest along a way. Of a way along the axis rounding leaves anything, also along
    /// the axis. So what is across it is taken until most of a vector of length 1 is: then the point is on the disc, but for
    /// a few 2^-53 of the radius. Where none is, the end is as far as rounding tells.
    [[nodiscard]] ABUT_HD constexpr vec3<double> to_rim(const vec3<double>& way, std::uint32_t end) const {
        vec3<double> across = across_of(way);
        double size = length_of(across);
        ABUT_ROLLED
        for (int k = 0; k < 3 && has_rim(end) && size > 0; ++k) {
            across = across_of((1 / size) * across);
            size = length_of(across);
            if (size > 0.5) return (radius / size) * across;
        }
        return {0, 0, 0};
    }
    /// How far that is along it, times its length.
    [[nodiscard]] ABUT_HD constexpr double reach(const vec3<double>& way, std::uint32_t end) const {
        return has_rim(end) ? radius * length_of(across_of(way)) : 0;
    }

private:
    [[nodiscard]] ABUT_HD static constexpr bool has_rim(std::uint32_t end) { return !is_cone || end == 1; }
    [[nodiscard]] ABUT_HD constexpr vec3<double> across_of(const vec3<double>& way) const {
        return way - dot(way, axis) * axis;
    }
};

}  // namespace abut::detail
