// SPDX-License-Identifier: MIT
#pragma once

// nearest on several devices, of one shape or of a few.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/nearest.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/rows.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

template <scalar T>
struct write_neighbors_of_parts {
    const measured_neighbor<T>* found;
    neighbor<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const measured_neighbor<T>& x = found[i];
        out[i] = {x.id == no_global_id ? no_id : static_cast<std::uint32_t>(x.id), x.point, x.distance};
    }
};

/// Where points look for what is nearest, and what lengths are measured in.
template <class Team, class X, class Points>
auto nearest_on_devices(const Team& team, const X& index, const Points& points, std::size_t count, const char* function) {
    using local = typename Team::local_policy;
    using T = scalar_type_of<typename shape_of_argument<type_on_device<X>>::type>;
    const auto there = asked_on_each(team, index, points, function, [](const auto& on, const auto& rows, const char* name) {
        return make_points<T>(on, rows, name);
    });
    check_neighbors(there.front().rows.shapes().size(), count, function);
    double largest = 0;
    if constexpr (std::same_as<T, double>) {
        for (const double of_part : each_of(team, [&](int k) {
                 const auto& both = there[static_cast<std::size_t>(k)];
                 return largest_coordinate(team[k], both.shapes, both.rows.shapes());
             })) {
            largest = greatest(largest, of_part);
        }
    }
    const ask_nearest<T> question{unit_of_magnitude<T>(largest), count};
    return answers_of_devices(team, there, index, question, [](const local& on, const auto& found) {
        execution::buffer_of<local, neighbor<T>> out(on, found.size());
        for_each_index(on, found.size(), write_neighbors_of_parts<T>{found.data(), out.data()});
        synchronize(on);
        return out;
    });
}

/// Whether `nearest` of several devices takes both arguments.
template <class Team, class X, class Points>
consteval bool can_be_near_on_devices() {
    return can_be_near<typename Team::local_policy, type_on_device<X>, type_on_device<Points>>();
}

}  // namespace detail

/// @addtogroup devices
///@{

/// For each of `points` the nearest shape of `index`, as `nearest` finds it under one policy, bit for bit: a `result` of
/// `neighbor` in memory of the first device. `index` is a set or an index that is replicated or divided, posed or not;
/// `points` is replicated, or a set, a vector or a span in host memory, which is copied to each device. Where the index is
/// divided, each device looks for all points in its part, and holds 32 bytes (double: 48) for each of them, the first device
/// twice.
template <execution::policy_team Team, class X, class Points>
[[nodiscard]] auto nearest(const Team& team, const X& index, const Points& points) {
    using space = space_of<typename Team::local_policy>;
    if constexpr (detail::can_be_near_on_devices<Team, X, Points>()) {
        auto found = detail::nearest_on_devices(team, index, points, 1, "abut::nearest");
        return result<typename decltype(found)::value_type, space>(std::move(found));
    } else {
        return result<neighbor<float>, space>();
    }
}

/// For each of `points` the `count` nearest shapes of `index`, as under one policy: those of point i stand at count * i and
/// after. Arguments, and where the answers lie, are as of the nearest one; memory is `count` times as much.
template <execution::policy_team Team, class X, class Points>
[[nodiscard]] auto nearest(const Team& team, const X& index, const Points& points, std::size_t count) {
    using space = space_of<typename Team::local_policy>;
    if constexpr (detail::can_be_near_on_devices<Team, X, Points>()) {
        detail::check_few(count, "abut::nearest");
        auto found = detail::nearest_on_devices(team, index, points, count, "abut::nearest");
        return result<typename decltype(found)::value_type, space>(std::move(found));
    } else {
        return result<neighbor<float>, space>();
    }
}

///@}

}  // namespace abut
