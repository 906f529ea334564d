// SPDX-License-Identifier: MIT
#pragma once

// distance on several devices: each looks at its share of the pairs, and at what of divided sets may be nearer than what is
// known.

#include <cstddef>
#include <optional>

#include <abut/collide/apart.hpp>
#include <abut/collide/body_distance.hpp>
#include <abut/collide/distance.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/bodies.hpp>
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

/// Of bodies, each device looks at its share of the pairs of them.
template <execution::policy_team Team, class Index>
auto ask_least(const Team& team, const ask_distance& question, const replicated<bodies<Index>>& all, each_other) {
    using T = typename Index::scalar_type;
    if constexpr (can_be_measured<typename Team::local_policy, Index, Index>()) {
        check(question.options, question.function);
        require_as_many(team, all, question.function);
        const std::size_t n = parts_of_bodies::of(all[0]).with_shapes->size();
        return least_of_bodies<T>(question, n, [&](const auto& look) {
            bodies_apart<T> best;
            for (const auto& one : each_of(team, [&](int k) { return look(team[k], all[k], share_of(team, k)); })) {
                if (one.comes_before(best)) best = one;
            }
            return best;
        });
    } else {
        return std::optional<body_separation<T>>();
    }
}

}  // namespace abut::detail
