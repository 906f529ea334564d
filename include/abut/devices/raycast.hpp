// SPDX-License-Identifier: MIT
#pragma once

// raycast, raycast_any and raycast_all on several devices.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/collide/raycast_all.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/merge.hpp>
#include <abut/devices/rows.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Whether queries of rays of several devices take both arguments.
template <class Team, class X, class Rays>
consteval bool can_be_met_on_devices() {
    return can_be_met<typename Team::local_policy, type_on_device<X>, type_on_device<Rays>>();
}

template <class Team, class X, class Rays>
auto rays_on_each(const Team& team, const X& index, const Rays& rays, const char* function) {
    return asked_on_each(team, index, rays, function, [](const auto& on, const auto& there, const char* name) {
        return make_operand(on, there, name);
    });
}

template <scalar T>
struct write_timed_hits {
    const timed_hit* found;
    hit_of_ray<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = {found[i].line, static_cast<std::uint32_t>(found[i].id), time_as<T>(found[i].time)};
    }
};

/// All hits: lists of the devices, each in order, which are merged.
template <arithmetic A, class Team, class X, class There>
auto all_hits_of_devices(const Team& team, const std::vector<There>& there, const X& index) {
    using local = typename Team::local_policy;
    using list = result<timed_hit, space_of<local>>;
    return on_first(team, each_of(team, [&](int k) {
        const auto& mine = there[static_cast<std::size_t>(k)];
        const auto look = [&](const auto& rows, const auto& lines, const part_ids& ids) {
            using name = name_timed_hit<std::remove_cvref_t<decltype(lines)>, part_ids>;
            return list(look_for_all_hits<A, timed_hit>(team[k], lines_and_shapes{mine.shapes, rows}, name{lines, ids}));
        };
        if constexpr (is_divided<X>) {
            return look(mine.rows, same_number{}, index.ids(k));
        } else {
            return with_share_of_rows(team, k, mine.rows,
                                      [&](const auto& rows) { return look(rows, rows_of(team, k), part_ids{}); });
        }
    }), true, by_line_and_time{});
}

}  // namespace detail

/// @addtogroup devices
///@{

/// For each of `rays` the shape of `index` that it meets first, as `raycast` finds it under one policy, bit for bit: a
/// `result` of `ray_hit` in memory of the first device. `index` is a set or a tree of shapes that is replicated or
/// divided, posed or not; `rays` are rays or segments that are replicated, or a set of them in host memory, which is copied
/// to each device. Where the index is divided, each device looks for all rays in its part, and holds 16 bytes for each of
/// them, the first device twice.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Rays>
[[nodiscard]] auto raycast(const Team& team, const X& index, const Rays& rays) {
    using local = typename Team::local_policy;
    if constexpr (detail::can_be_met_on_devices<Team, X, Rays>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<detail::type_on_device<X>>::type>;
        const auto there = detail::rays_on_each(team, index, rays, "abut::raycast");
        auto hits = detail::answers_of_devices(
            team, there, index, detail::ask_first_hit<A>{}, [](const local& on, const auto& found) {
                execution::buffer_of<local, ray_hit<T>> out(on, found.size());
                for_each_index(on, found.size(), detail::write_hits<T>{found.data(), out.data()});
                synchronize(on);
                return out;
            });
        return result<ray_hit<T>, space_of<local>>(std::move(hits));
    } else {
        return result<ray_hit<float>, space_of<local>>();
    }
}

/// For each of `rays` whether it meets any shape of `index`, as under one policy: a `result` of `std::uint8_t` in memory
/// of the first device, 1 or 0. Arguments are those of `raycast`.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Rays>
[[nodiscard]] auto raycast_any(const Team& team, const X& index, const Rays& rays) {
    using answer = result<std::uint8_t, space_of<typename Team::local_policy>>;
    if constexpr (detail::can_be_met_on_devices<Team, X, Rays>()) {
        const auto there = detail::rays_on_each(team, index, rays, "abut::raycast_any");
        return answer(
            detail::answers_of_devices(team, there, index, detail::ask_any_hit<A>{}, detail::take_answers{}));
    } else {
        return answer();
    }
}

/// All shapes of `index` that each of `rays` meets, as under one policy: a `result` of `hit_of_ray` in memory of the
/// first device, sorted by the ray's number, then by t, then by id. Arguments are those of `raycast`. The first device holds
/// 48 bytes for each hit besides the result.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Rays>
[[nodiscard]] auto raycast_all(const Team& team, const X& index, const Rays& rays) {
    using local = typename Team::local_policy;
    if constexpr (detail::can_be_met_on_devices<Team, X, Rays>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<detail::type_on_device<X>>::type>;
        const auto there = detail::rays_on_each(team, index, rays, "abut::raycast_all");
        const auto hits = detail::all_hits_of_devices<A>(team, there, index);
        execution::buffer_of<local, hit_of_ray<T>> out(team[0], hits.size());
        for_each_index(team[0], hits.size(), detail::write_timed_hits<T>{hits.data(), out.data()});
        synchronize(team[0]);
        return result<hit_of_ray<T>, space_of<local>>(std::move(out));
    } else {
        return result<hit_of_ray<float>, space_of<local>>();
    }
}

///@}

}  // namespace abut
