// SPDX-License-Identifier: MIT
#pragma once

// impacts, self_impacts and the first of them on several devices. Where each has the whole meshes, it walks its share of the
// pairs of nodes (search_part in collide/shares.hpp). Keys of pairs are the same on all, and what is found is merged by
// them. Meshes that are divided are in divided_impacts.hpp.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/merge.hpp>
#include <abut/collide/mesh_pieces.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/divide_mesh.hpp>
#include <abut/devices/divided_impacts.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Whether impact queries of several devices take arguments of these types.
template <class Team, class X>
consteval bool can_move_on_devices() {
    static_assert(!is_divided<X>,
                  "abut: impacts of several devices take a mesh that is divided by divide_mesh, not its shapes");
    if constexpr (!is_divided<X>) {
        return can_move<typename Team::local_policy, type_on_device<X>>();
    } else {
        return false;
    }
}
template <bool Within, class Team, class X, class Y>
consteval bool can_collide_on_devices() {
    if constexpr (can_move_on_devices<Team, X>() && can_move_on_devices<Team, Y>()) {
        return can_collide<Within, typename Team::local_policy, type_on_device<X>, type_on_device<Y>>();
    } else {
        return false;
    }
}

/// use(x, y) of what each device has whole: indices, which `Within` one mesh are one.
template <bool Within, class Team, class X, class Y, class Use>
auto with_indices_on_each(const Team& team, const X& a, const Y& b, const char* function, const Use& use) {
    const auto x = impact_operand_on_each<Y>(team, a, function);
    if constexpr (Within) {
        return use(x, x);
    } else {
        return use(x, impact_operand_on_each<X>(team, b, function));
    }
}
/// The same of meshes of which one or both are divided.
template <bool Within, class Team, class X, class Y, class Use>
auto with_parts_on_each(const Team& team, const X& a, const Y& b, const char* function, const Use& use) {
    if constexpr (Within) {
        const auto all = indices_of_parts(team, a, function);
        return use(all, all);
    } else {
        return use(a, b);
    }
}

/// The impacts of indices on each device, or `Within` one.
template <motion_arithmetic A, bool Within, class Team, class Index>
auto impacts_on_devices(const Team& team, const std::vector<Index>& x, const std::vector<Index>& y,
                        const impact_options& options, const char* function) {
    using local = typename Team::local_policy;
    using found_type = impact<typename Index::scalar_type>;
    auto there = each_of(team, [&](int k) {
        const auto i = static_cast<std::size_t>(k);
        return impacts_of_indices<A, Within>(team[k], x[i], y[i], options, no_fronts{}, function, share_of(team, k));
    });
    if (there.size() == 1) return std::move(there.front().found);
    found_lists<local, found_type> lists;
    found_lists<local, std::uint64_t> keys;
    for (auto& one : there) {
        lists.push_back(std::move(one.found));
        keys.push_back(std::move(one.keys));
    }
    const auto first = beginnings_of(lists);
    auto all = brought_to_first<Team, found_type>(team, lists, first);
    if (options.sorted && all.size() > 0) {
        const auto order = brought_to_first<Team, std::uint64_t>(team, keys, first);
        all = merged_by(team[0], by_number{}, order.data(), std::move(all), first);
    }
    return result<found_type, space_of<local>>(std::move(all));
}

/// The first of them: each device looks at the same part of the step.
template <motion_arithmetic A, bool Within, class Team, class Index>
auto first_on_devices(const Team& team, const std::vector<Index>& x, const std::vector<Index>& y,
                      const impact_options& options, const char* function) {
    const auto first_until_time = [&](double time) {
        const auto found = each_of(team, [&](int k) {
            const auto i = static_cast<std::size_t>(k);
            return first_until<A, Within>(team[k], x[i], y[i], time, options, no_fronts{}, function, share_of(team, k));
        });
        auto first = found.front();
        for (const auto& one : found) keep_earlier(first, one);
        return first;
    };
    return first_of_step<A>(first_until_time, options.bounds);
}

template <execution::policy_team Team, motion_arithmetic A, bool Within, class X, class Y>
auto ask_motion(const Team& team, const ask_impacts<A, Within>& question, const X& a, const Y& b,
                const impact_options& options) {
    const char* const function = question.function;
    if constexpr (!can_collide_on_devices<Within, Team, X, Y>()) {
        return result<impact<float>, space_of<typename Team::local_policy>>();
    } else if constexpr (is_divided_mesh<X> || is_divided_mesh<Y>) {
        return with_parts_on_each<Within>(team, a, b, function, [&](const auto& x, const auto& y) {
            return impacts_of_divided<A, Within>(team, x, y, options, function);
        });
    } else {
        return with_indices_on_each<Within>(team, a, b, function, [&](const auto& x, const auto& y) {
            return impacts_on_devices<A, Within>(team, x, y, options, function);
        });
    }
}
template <execution::policy_team Team, motion_arithmetic A, bool Within, class X, class Y>
auto ask_motion(const Team& team, const ask_first_impact<A, Within>& question, const X& a, const Y& b,
                const impact_options& options) {
    const char* const function = question.function;
    if constexpr (!can_collide_on_devices<Within, Team, X, Y>()) {
        return std::optional<impact<float>>();
    } else if constexpr (is_divided_mesh<X> || is_divided_mesh<Y>) {
        return with_parts_on_each<Within>(team, a, b, function, [&](const auto& x, const auto& y) {
            return without_key(first_of_divided<A, Within>(team, x, y, options, function));
        });
    } else {
        return with_indices_on_each<Within>(team, a, b, function, [&](const auto& x, const auto& y) {
            return without_key(first_on_devices<A, Within>(team, x, y, options, function));
        });
    }
}

}  // namespace detail

/// @addtogroup devices
///@{

/// An impact index on each device, of a mesh at rest or in motion in host memory, or of one that each device has; or of the
/// parts of a divided_mesh. Options are those of `make_impact_index` under one policy. Returns a `replicated` or a
/// `divided_mesh` of indices; waits for all.
template <execution::policy_team Team, class X>
[[nodiscard]] auto make_impact_index(const Team& team, const X& x, const bvh_options& options = {}) {
    if constexpr (detail::can_move_on_devices<Team, X>()) {
        detail::require_as_many(team, x, "abut::make_impact_index");
        auto indices =
            detail::each_of(team, [&](int k) { return make_impact_index(team[k], detail::on_device(x, k), options); });
        if constexpr (detail::is_divided_mesh<X>) {
            return divided_mesh<typename decltype(indices)::value_type>(std::move(indices), x);
        } else {
            return replicated(std::move(indices));
        }
    } else {
        return detail::refused();
    }
}

///@}

}  // namespace abut
