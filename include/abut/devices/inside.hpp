// SPDX-License-Identifier: MIT
#pragma once

// inside and signed_distance on several devices.

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/inside.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/nearest.hpp>
#include <abut/devices/rows.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Whether `inside` of several devices takes both arguments: of a divided mesh the parts are triangles.
template <arithmetic A, class Team, class X, class Points>
consteval bool can_contain_on_devices() {
    using local = typename Team::local_policy;
    using there = type_on_device<X>;
    if constexpr (is_divided<X>) {
        constexpr bool is_decided = !std::same_as<A, fast>;
        static_assert(is_decided, "abut: inside is decided by `filtered` or `exact`");
        using shape_type = typename shape_of_argument<there>::type;
        constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
        static_assert(are, "abut: inside looks into a closed mesh: the parts of one are triangles");
        if constexpr (is_decided && are) return can_be_near<local, there, type_on_device<Points>>();
        return false;
    } else {
        return can_contain<A, local, there, type_on_device<Points>>();
    }
}

template <arithmetic A, class Team, class X, class Points>
auto inside_on_devices(const Team& team, const X& mesh, const Points& points, const inside_options& options,
                       const char* function) {
    using T = scalar_type_of<typename shape_of_argument<type_on_device<X>>::type>;
    if (is_divided<X> && !options.known_closed) {
        throw error(std::string(function) +
                    ": no device has all of a divided mesh to find out whether it is closed; expected {.known_closed = true}");
    }
    const auto there = asked_on_each(team, mesh, points, function, [](const auto& on, const auto& rows, const char* name) {
        return make_points<T>(on, rows, name);
    });
    if constexpr (!is_divided<X>) {
        if (!options.known_closed) require_closed(team[0], there.front().shapes.shapes(), function);
    }
    return answers_of_devices(team, there, mesh, ask_inside<A>{}, take_answers{});
}

}  // namespace detail

/// @addtogroup devices
///@{

/// For each of `points` whether it is inside of a closed mesh, as `inside` says under one policy: a `result` of
/// `containment` in memory of the first device. `mesh` is a mesh or a tree of one that is replicated or divided, posed or
/// not; `points` are as of `nearest`. Whether a replicated mesh is closed is found out on the first device. Of a divided one
/// the caller has to know it: {.known_closed = true}, or else an `error` is thrown.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Points>
[[nodiscard]] auto inside(const Team& team, const X& mesh, const Points& points, const inside_options& options = {}) {
    using answer = result<containment, space_of<typename Team::local_policy>>;
    if constexpr (detail::can_contain_on_devices<A, Team, X, Points>()) {
        return answer(detail::inside_on_devices<A>(team, mesh, points, options, "abut::inside"));
    } else {
        return answer();
    }
}

/// For each of `points` what `nearest` says of it, with a distance that is below 0 where the point is inside, and 0 where it
/// is on the surface, as under one policy. Arguments and options are those of `inside`.
template <execution::policy_team Team, class X, class Points>
[[nodiscard]] auto signed_distance(const Team& team, const X& mesh, const Points& points, const inside_options& options = {}) {
    using local = typename Team::local_policy;
    if constexpr (detail::can_contain_on_devices<filtered, Team, X, Points>()) {
        constexpr const char* function = "abut::signed_distance";
        const auto where = detail::inside_on_devices<filtered>(team, mesh, points, options, function);
        const auto near = detail::nearest_on_devices(team, mesh, points, 1, function);
        using found = typename decltype(near)::value_type;
        execution::buffer_of<local, found> out(team[0], near.size());
        for_each_index(team[0], near.size(),
                       detail::write_signed<decltype(found::distance)>{near.data(), where.data(), out.data()});
        synchronize(team[0]);
        return result<found, space_of<local>>(std::move(out));
    } else {
        return result<neighbor<float>, space_of<local>>();
    }
}

///@}

}  // namespace abut
