// SPDX-License-Identifier: MIT
#pragma once

// Scenes of many bodies on several devices. Each has all bodies. What is asked of them is in query.hpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/bodies.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/collide/scene_meetings.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

template <class Index>
inline constexpr bool refits_alone<bodies<Index>> = false;
template <class Index>
inline constexpr bool is_many_bodies<replicated<bodies<Index>>> = true;
template <class Index>
struct index_of_bodies<replicated<bodies<Index>>> : std::type_identity<Index> {};
template <class Index>
inline constexpr bool is_bodies_motion<replicated<bodies_motion<Index>>> = true;

/// What one device has of the scenes that are asked about.
///@{
template <class Scene>
auto on_device(const alone<replicated<Scene>>& all, int k) {
    return alone<Scene>{all.x[k]};
}
template <class SceneA, class SceneB>
auto on_device(const two<replicated<SceneA>, replicated<SceneB>>& both, int k) {
    return two<SceneA, SceneB>{both.a[k], both.b[k]};
}
///@}
/// Bodies that meet on their ways: each device asks about its share of those whose boxes meet.
template <execution::policy_team Team, class Question, class Scenes, class Filter>
auto ask_scenes_on_way(const Team& team, const Question&, const Scenes& scenes, const scene_meeting_options<Filter>& options, const char* function) {
    if constexpr (requires { scenes.x; }) {
        require_as_many(team, scenes.x, function);
    } else {
        require_as_many(team, scenes.a, function);
        require_as_many(team, scenes.b, function);
    }
    const auto parts = static_cast<std::size_t>(team.size());
    const auto found = each_of(team, [&](int k) {
        return bodies_that_meet<Question>(team[k], on_device(scenes, k), options, function, {static_cast<std::size_t>(k), parts});
    });
    std::vector<typename Question::found> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return Question::bodies(x) < Question::bodies(y); });
    return result_of_host(team[0], all);
}

}  // namespace detail

/// @addtogroup devices
///@{

/// Bodies on each device: body i is indices[index_of[i]] under poses[i], as of `make_bodies` under one policy. Indices are
/// what `make_bvh` made for these devices. Throws as `make_bodies` does, and `error` if an index lies on another number of
/// devices. Waits for all.
template <execution::policy_team Team, class Index>
[[nodiscard]] auto make_bodies(const Team& team, const std::vector<replicated<Index>>& indices,
                               std::type_identity_t<std::span<const std::uint32_t>> index_of,
                               std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    for (const replicated<Index>& index : indices) detail::require_as_many(team, index, "abut::make_bodies");
    return replicated(detail::each_of(team, [&](int k) {
        std::vector<Index> there;
        for (const replicated<Index>& index : indices) there.push_back(index[k]);
        return make_bodies(team[k], there, index_of, poses);
    }));
}

/// The same bodies under other poses, in host memory, as `refit` of one policy. The first device decides for all whether
/// there is to be a new tree: they have to walk the same one. Waits for all.
template <execution::policy_team Team, class Index>
[[nodiscard]] auto refit(const Team& team, const replicated<bodies<Index>>& all,
                         std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    detail::require_as_many(team, all, "abut::refit");
    auto moved = detail::each_of(team, [&](int k) {
        detail::check_refit(team[k], all[k], poses.size());
        return detail::move_bodies(team[k], all[k], poses);
    });
    const bool new_tree = moved.front().wants_new_tree;
    return replicated(detail::each_of(team, [&](int k) {
        return detail::settle_bodies(team[k], std::move(moved[static_cast<std::size_t>(k)]), new_tree);
    }));
}

/// The scene on each device, on its way from one frame to another.
template <class Index>
[[nodiscard]] auto moving(const replicated<bodies<Index>>& at_t0, const replicated<bodies<Index>>& at_t1) {
    std::vector<bodies_motion<Index>> ways;
    for (int k = 0; k < at_t0.devices(); ++k) ways.push_back(moving(at_t0[k], at_t1[k]));
    return replicated(std::move(ways));
}

///@}

}  // namespace abut
