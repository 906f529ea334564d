// SPDX-License-Identifier: MIT
#pragma once

// distance on several devices: each looks at its share of the pairs, and at what of divided sets may be nearer than what is
// known.

#include <cstdint>
#include <optional>

#include <abut/collide/apart.hpp>
#include <abut/collide/distance.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

template <class Team, class X, class Y>
auto distance_on_devices(const Team& team, const X& x, const Y& y, const distance_options& options, const char* function) {
    using T = scalar_type_of<typename shape_of_argument<type_on_device<X>>::type>;
    check(options, function);
    least_apart<T> least(options.below);
    arguments_on_each<Team, X, Y> asked(team, x, y, function);
    asked([&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
        least.look_for_touch(team[k], in_part(pair_up_apart(team[k], a, b, function), part), ids);
    });
    if (!least.best().is_one() && options.below > 0) {
        asked(
            [&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
                least.look_for_nearest(team[k], in_part(pair_up_apart(team[k], a, b, function), part), ids);
            },
            [](int) { return false; },  // and their own parts first, so that little comes near enough
            [&](const auto& bounds) { return grown_by(bounds, least.reach()); });
    }
    const pair_apart<T> best = least.best();
    separation<T> found = best.found;
    found.a = static_cast<std::uint32_t>(best.a);
    found.b = static_cast<std::uint32_t>(best.b);
    const bool is = best.is_one() && options.below > 0 && is_below(found, options.below);
    return is ? std::optional<separation<T>>(found) : std::optional<separation<T>>();
}

}  // namespace detail

/// How far apart two sets are, as `distance` says under one policy, bit for bit: a std::optional<separation<T>>. Arguments
/// are those of `pairs` on several devices, of shapes that `distance` takes. Where both are divided, devices search their
/// own parts first. Then shapes of b come to the devices whose a-shapes may be as near to them as what was found.
/// @ingroup devices
template <execution::policy_team Team, class X, class Y>
[[nodiscard]] auto distance(const Team& team, const X& a, const Y& b, const distance_options& options = {}) {
    if constexpr (detail::can_be_apart<typename Team::local_policy, detail::type_on_device<X>,
                                       detail::type_on_device<Y>>()) {
        return detail::distance_on_devices(team, a, b, options, "abut::distance");
    } else {
        return std::optional<separation<float>>();
    }
}

}  // namespace abut
