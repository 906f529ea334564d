// SPDX-License-Identifier: MIT
#pragma once

// Distances and contacts of cylinders and cones with every kind of shape, where a policy works and by the host: the same bits.
// Each kind of solid is a program of its own, since ptxas takes minutes for one.

#include <cstdint>
#include <vector>

#include "collide/revolution_distance_cases.hpp"
#include "cuda/measured_pairs.hpp"
#include "cuda/part.hpp"
#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

/// Of all families.
template <class Solid, class Policy, class Beside>
void check_measured(const Policy& on, const Beside& beside) {
    using T = scalar_type_of<Solid>;
    using other = decltype(beside(revolution_case<T>{}, std::uint64_t{}));
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    std::vector<copied_pair<Solid, other>> pairs;
    for (int f = 0; f < revolution_family_count; ++f) {
        for (std::uint64_t k = 0; k < (sample_count() + 49) / 50; ++k) {
            const auto family = static_cast<revolution_family>(f);
            const auto c = make_revolution_case<T>(sample_seed + 4, family, k, is_cone);
            const copied_pair<Solid, other> p{solid_of<Solid>(c.axis, c.radius), beside(c, k), 0};
            if (is_valid(p.s) && is_valid(p.t)) pairs.push_back(p);
        }
    }
    check_same_measures(on, pairs);
}

/// With all kinds of other shapes, in parts 0 to 2.
template <class Solid, class Policy>
void check_all_measured([[maybe_unused]] const Policy& on) {
    using T = scalar_type_of<Solid>;
    using pair = revolution_case<T>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    if constexpr (is_in_part(0)) {
        check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return c.corner[0]; });
        check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return segment<T>{c.corner[0], c.corner[1]}; });
        check_measured<Solid>(on, [](const pair& c, std::uint64_t) {
            return triangle<T>{c.corner[0], c.corner[1], c.corner[2]};
        });
    }
    if constexpr (is_in_part(1)) {
        check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return bounds(segment<T>{c.corner[0], c.corner[1]}); });
        check_measured<Solid>(on, [](const pair& c, std::uint64_t k) { return ball_beside(c, is_cone, k); });
        check_measured<Solid>(on, [](const pair& c, std::uint64_t k) { return plane_beside(c, k); });
    }
    if constexpr (is_in_part(2)) {
        check_measured<Solid>(on, [](const pair& c, std::uint64_t k) { return cylinder_beside(c, is_cone, k); });
        check_measured<Solid>(on, [](const pair& c, std::uint64_t k) {
            const cylinder<T> s = cylinder_beside(c, is_cone, k);
            return capsule<T>{s.axis, s.radius};
        });
        if constexpr (is_cone) {
            check_measured<Solid>(on, [](const pair& c, std::uint64_t k) {
                const cylinder<T> s = cylinder_beside(c, is_cone, k);
                return cone<T>{s.axis.a, s.axis.b, s.radius};
            });
        }
    }
}

}  // namespace abut::test
