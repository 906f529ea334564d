// SPDX-License-Identifier: MIT
#pragma once

// winding_number on several devices.

#include <cstddef>

#include <abut/collide/winding_number.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/rows.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

struct ask_winding_number {
    using answer = double;
    double tolerance;

    [[nodiscard]] std::size_t per_row() const { return 1; }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids&, answer* out) const {
        wind_around(on, x, rows, tolerance, out);
    }
};

/// Whether `winding_number` of several devices takes both arguments.
template <class Team, class X, class Points>
consteval bool can_wind_on_devices() {
    static_assert(!is_divided<X>,
                  "abut: winding_number adds up triangles in one order, and so takes a mesh that each device has: "
                  "replicate(devices, mesh)");
    if constexpr (!is_divided<X>) {
        return can_wind<typename Team::local_policy, type_on_device<X>, type_on_device<Points>>();
    } else {
        return false;
    }
}

}  // namespace detail

/// For each of `points` how often a surface of triangles goes round it, as `winding_number` says under one policy, bit for
/// bit: a `result` of doubles in memory of the first device. `mesh` is a mesh, a soup of triangles or an index of either that
/// is replicated, posed or not; `points` are as of `nearest`. Points are shared out. Each device makes what a tolerance asks
/// for of its own tree: scratch is as under one policy on each.
/// @ingroup devices
template <execution::policy_team Team, class X, class Points>
[[nodiscard]] auto winding_number(const Team& team, const X& mesh, const Points& points,
                                  const winding_options& options = {}) {
    using local = typename Team::local_policy;
    using answer = result<double, space_of<local>>;
    if constexpr (detail::can_wind_on_devices<Team, X, Points>()) {
        constexpr const char* function = "abut::winding_number";
        using T = scalar_type_of<typename detail::shape_of_argument<detail::type_on_device<X>>::type>;
        detail::check_tolerance(options.tolerance, function);
        const auto there = detail::asked_on_each(
            team, mesh, points, function,
            [](const auto& on, const auto& rows, const char* name) { return detail::make_points<T>(on, rows, name); });
        return answer(detail::answers_of_devices(team, there, mesh, detail::ask_winding_number{options.tolerance},
                                                 detail::take_answers{}));
    } else {
        return answer();
    }
}

}  // namespace abut
