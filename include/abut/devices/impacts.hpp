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
template <class Team, class X, class Y>
consteval bool can_meet_on_devices() {
    if constexpr (can_move_on_devices<Team, X>() && can_move_on_devices<Team, Y>()) {
        return can_meet<typename Team::local_policy, type_on_device<X>, type_on_device<Y>>();
    } else {
        return false;
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
    return first_of_step<A>([&](double time) {
        const auto found = each_of(team, [&](int k) {
            const auto i = static_cast<std::size_t>(k);
            return first_until<A, Within>(team[k], x[i], y[i], time, options, no_fronts{}, function, share_of(team, k));
        });
        auto first = found.front();
        for (const auto& one : found) keep_earlier(first, one);
        return first;
    });
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

/// The impacts of two meshes, as under one policy, bit for bit: a `result` of `impact` in memory of the first device.
/// Arguments are replicated meshes, at rest or in motion, replicated indices of such, or meshes in host memory, which are
/// copied to each device for the call; or meshes that are divided (divide_mesh), and indices of their parts. Fronts are not
/// taken.
///
/// Of divided meshes the answer is that of the whole ones, with their vertex numbers, and is always sorted. Where both are
/// divided, pieces of b come to the devices whose parts of a they come near during the step, and all pieces of a device are
/// there at a time: of each other device at most its part, with an index. The first device holds 56 bytes for each impact,
/// three times for a moment, and those of features on the border of two parts more than once.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X, class Y>
[[nodiscard]] auto impacts(const Team& team, const X& a, const Y& b, const impact_options& options = {}) {
    constexpr const char* function = "abut::impacts";
    if constexpr (detail::can_meet_on_devices<Team, X, Y>()) {
        if constexpr (detail::is_divided_mesh<X> || detail::is_divided_mesh<Y>) {
            return detail::impacts_of_divided<A, false>(team, a, b, options, function);
        } else {
            const auto x = detail::impact_operand_on_each<Y>(team, a, function);
            const auto y = detail::impact_operand_on_each<X>(team, b, function);
            return detail::impacts_on_devices<A, false>(team, x, y, options, function);
        }
    } else {
        return result<impact<float>, space_of<typename Team::local_policy>>();
    }
}

/// The impacts of a mesh with itself, as under one policy; otherwise as `impacts`. Where the mesh is divided, pieces of each
/// part come to the devices whose parts they come near.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X>
[[nodiscard]] auto self_impacts(const Team& team, const X& x, const impact_options& options = {}) {
    constexpr const char* function = "abut::self_impacts";
    if constexpr (detail::can_move_on_devices<Team, X>()) {
        if constexpr (detail::is_divided_mesh<X>) {
            const auto all = detail::indices_of_parts(team, x, function);
            return detail::impacts_of_divided<A, true>(team, all, all, options, function);
        } else {
            const auto all = detail::impact_operand_on_each<X>(team, x, function);
            return detail::impacts_on_devices<A, true>(team, all, all, options, function);
        }
    } else {
        return result<impact<float>, space_of<typename Team::local_policy>>();
    }
}

/// The earliest of the impacts, as under one policy: a std::optional<impact<T>>. All devices look at a first part of the
/// step, and at more where nothing touches in it. Arguments are those of `impacts`; pieces of b are of the whole step.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X, class Y>
[[nodiscard]] auto first_impact(const Team& team, const X& a, const Y& b, const impact_options& options = {}) {
    constexpr const char* function = "abut::first_impact";
    if constexpr (detail::can_meet_on_devices<Team, X, Y>()) {
        if constexpr (detail::is_divided_mesh<X> || detail::is_divided_mesh<Y>) {
            return detail::first_of_divided<A, false>(team, a, b, options, function);
        } else {
            const auto x = detail::impact_operand_on_each<Y>(team, a, function);
            const auto y = detail::impact_operand_on_each<X>(team, b, function);
            return detail::first_on_devices<A, false>(team, x, y, options, function);
        }
    } else {
        return std::optional<impact<float>>();
    }
}

/// The earliest of the impacts of a mesh with itself; otherwise as `first_impact`.
template <motion_arithmetic A = filtered, execution::policy_team Team, class X>
[[nodiscard]] auto first_self_impact(const Team& team, const X& x, const impact_options& options = {}) {
    constexpr const char* function = "abut::first_self_impact";
    if constexpr (detail::can_move_on_devices<Team, X>()) {
        if constexpr (detail::is_divided_mesh<X>) {
            const auto all = detail::indices_of_parts(team, x, function);
            return detail::first_of_divided<A, true>(team, all, all, options, function);
        } else {
            const auto all = detail::impact_operand_on_each<X>(team, x, function);
            return detail::first_on_devices<A, true>(team, all, all, options, function);
        }
    } else {
        return std::optional<impact<float>>();
    }
}

///@}

}  // namespace abut
