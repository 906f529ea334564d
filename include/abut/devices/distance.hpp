// SPDX-License-Identifier: MIT
#pragma once

// distance on several devices: each looks at its share of the pairs, and at what of divided sets may be nearer than what is
// known.

#include <optional>

#include <abut/collide/apart.hpp>
#include <abut/collide/distance.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/team.hpp>

namespace abut::detail {

template <execution::policy_team Team, class X, class Y>
auto ask_least(const Team& team, const ask_distance& question, const X& x, const Y& y) {
    if constexpr (can_be_apart<typename Team::local_policy, type_on_device<X>, type_on_device<Y>>()) {
        using T = scalar_type_of<typename shape_of_argument<type_on_device<X>>::type>;
        const char* const function = question.function;
        const double below = question.options.below;
        check(question.options, function);
        least_apart<T> least(below);
        arguments_on_each<Team, X, Y> asked(team, x, y, function);
        asked([&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
            least.look_for_touch(team[k], in_part(pair_up_apart(team[k], a, b, function), part), ids);
        });
        if (!least.best().is_one() && below > 0) {
            asked(
                [&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
                    least.look_for_nearest(team[k], in_part(pair_up_apart(team[k], a, b, function), part), ids);
                },
                [](int) { return false; },  // and their own parts first, so that little comes near enough
                [&](const auto& bounds) { return grown_by(bounds, least.reach()); });
        }
        return least.template answer<separation<T>>(least.best(), below);
    } else {
        return std::optional<separation<float>>();
    }
}

}  // namespace abut::detail
