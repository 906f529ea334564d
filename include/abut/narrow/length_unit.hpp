// SPDX-License-Identifier: MIT
#pragma once

// The unit in which distances are computed, and ways between points in it.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut::detail {

/// What lengths are measured in: a power of two that keeps squares, and products of four lengths, from overflow and
/// underflow. Floats need none, being computed in double.
template <scalar T>
struct length_unit {
    ABUT_HD static constexpr double of(T x) { return static_cast<double>(x); }
    ABUT_HD static constexpr double length(double x) { return x; }
};
template <>
struct length_unit<double> {
    double per_length = 1, unit = 1;

    length_unit() = default;
    /// For coordinates that are nowhere larger in magnitude than `largest`: they come below 2^250.
    ABUT_HD explicit constexpr length_unit(double largest) {
        if (!(largest > 0)) return;
        const int e = 249 - contact_math::exponent_of(largest), k = e < -1000 ? -1000 : e > 1000 ? 1000 : e;
        per_length = contact_math::power_of_two(k);
        unit = contact_math::power_of_two(-k);
    }
    [[nodiscard]] ABUT_HD constexpr double of(double x) const { return plain_product(x, per_length); }
    [[nodiscard]] ABUT_HD constexpr double length(double x) const { return plain_product(x, unit); }
};

template <scalar T>
ABUT_HD constexpr vec3<double> way_between(const vec3<T>& from, const vec3<T>& to, const length_unit<T>& unit) {
    return {plain_sum(unit.of(to.x), -unit.of(from.x)), plain_sum(unit.of(to.y), -unit.of(from.y)),
            plain_sum(unit.of(to.z), -unit.of(from.z))};
}

}  // namespace abut::detail
