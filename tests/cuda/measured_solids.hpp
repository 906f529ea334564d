// SPDX-License-Identifier: MIT
#pragma once

// Distances and contacts of cylinders and cones with every kind of shape, where a policy works and by the host: the same bits.
// Each kind of solid is a program of its own, since ptxas takes minutes for one.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "collide/revolution_distance_cases.hpp"
#include "cuda/predicate_cases.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <class S, class U>
struct measure_pairs {
    using T = scalar_type_of<S>;
    const copied_pair<S, U>* pairs;
    separation<T>* apart;
    contact<T>* how;
    ABUT_HD void operator()(std::size_t i) const {
        apart[i] = distance(pairs[i].s, pairs[i].t);
        const auto found = contact_of(pairs[i].s, pairs[i].t);
        how[i] = found ? *found : contact<T>{};
    }
};

/// Pairs that the host makes are measured where the policy works, and by the host: the same bits.
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
    const std::size_t n = pairs.size();
    std::vector<separation<T>> here(n), there(n);
    std::vector<contact<T>> how_here(n), how_there(n);
    for_each_index(openmp{}, n, measure_pairs<Solid, other>{pairs.data(), here.data(), how_here.data()});
    const auto copies = copied(on, pairs);
    execution::buffer_of<Policy, separation<T>> apart(on, n);
    execution::buffer_of<Policy, contact<T>> how(on, n);
    for_each_index(on, n, measure_pairs<Solid, other>{copies.data(), apart.data(), how.data()});
    apart.read(there.data());
    how.read(how_there.data());
    std::size_t unlike = 0, touching = 0;
    for (std::size_t i = 0; i < n; ++i) {
        unlike += std::memcmp(&here[i], &there[i], sizeof here[i]) != 0;
        unlike += std::memcmp(&how_here[i], &how_there[i], sizeof how_here[i]) != 0;
        touching += here[i].distance == 0;
    }
    CHECK(unlike == 0);
    CHECK(touching > n / 50);
    CHECK(touching < n);
}

/// With all kinds of other shapes.
template <class Solid, class Policy>
void check_all_measured(const Policy& on) {
    using T = scalar_type_of<Solid>;
    using pair = revolution_case<T>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return c.corner[0]; });
    check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return segment<T>{c.corner[0], c.corner[1]}; });
    check_measured<Solid>(on, [](const pair& c, std::uint64_t) {
        return triangle<T>{c.corner[0], c.corner[1], c.corner[2]};
    });
    check_measured<Solid>(on, [](const pair& c, std::uint64_t) { return bounds(segment<T>{c.corner[0], c.corner[1]}); });
    check_measured<Solid>(on, [](const pair& c, std::uint64_t k) { return ball_beside(c, is_cone, k); });
    check_measured<Solid>(on, [](const pair& c, std::uint64_t k) { return plane_beside(c, k); });
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

}  // namespace abut::test
