// SPDX-License-Identifier: MIT
#pragma once

// The unit in which two shapes are measured.

#include <concepts>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// A unit for two shapes: what products of four lengths stay in.
template <class S, class U>
ABUT_HD constexpr auto common_unit(const S& s, const U& t) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<T, float>) {
        return length_unit<float>{};
    } else {
        return length_unit<double>(greatest(contact_math::magnitude_of(s), contact_math::magnitude_of(t)));
    }
}

}  // namespace abut::detail
