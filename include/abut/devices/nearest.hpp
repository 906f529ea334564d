// SPDX-License-Identifier: MIT
#pragma once

// nearest on several devices. Where each has all shapes, the points are shared out; where shapes are divided, each device
// looks for all points in its part, and the first one keeps the nearest.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/nearest.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// So many points after each other go to one device, and the next ones to the next.
inline constexpr std::size_t points_together = 4096;

/// The points of a part, of `parts`.
struct points_of_part {
    std::size_t part, parts;
    /// How many there are, of n.
    [[nodiscard]] std::size_t count(std::size_t n) const {
        const std::size_t round = points_together * parts, rest = n % round, first = points_together * part;
        return n / round * points_together + (rest > first ? std::min(rest - first, points_together) : 0);
    }
    /// Which is the i-th.
    [[nodiscard]] ABUT_HD std::size_t operator()(std::size_t i) const {
        return (i / points_together * parts + part) * points_together + i % points_together;
    }
};
template <shape_view Points>
struct take_points_of_part {
    Points points;
    points_of_part mine;
    typename Points::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = points[mine(i)]; }
};
template <class Found>
struct put_points_of_part {
    const Found* found;
    points_of_part theirs;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[theirs(i)] = found[i]; }
};

/// A neighbor in the whole set, and what it was found by.
template <scalar T>
struct measured_on_device {
    double measure;  ///< the squared distance in the unit of all devices
    neighbor<T> near;
};
template <shape_view Shapes, shape_view Points>
struct write_measured_on_device {
    using T = typename Points::scalar_type;
    Shapes shapes;
    Points points;
    length_unit<T> unit;
    part_ids ids;
    const std::uint32_t* order;
    const execution::least_value* found;  ///< null for none
    measured_on_device<T>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t k = order == nullptr ? i : order[i];
        const vec3<T> p = points[k];
        out[k] = {infinity<double>, {no_id, p, infinity<T>}};
        if (found == nullptr || found[i].key >= no_id) return;
        const auto id = static_cast<std::uint32_t>(found[i].key);
        out[k] = {found[i].value, neighbor_of(p, shapes[id], id, unit)};
        out[k].near.id = ids(id);
    }
};
/// Keeps the nearer one, and of equally near ones that with the smaller id.
template <scalar T>
struct keep_nearer {
    const measured_on_device<T>* other;
    measured_on_device<T>* best;
    ABUT_HD void operator()(std::size_t i) const {
        const measured_on_device<T> x = other[i];
        if (x.measure < best[i].measure || (x.measure == best[i].measure && x.near.id < best[i].near.id)) best[i] = x;
    }
};
template <scalar T>
struct take_neighbor {
    const measured_on_device<T>* best;
    neighbor<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = best[i].near; }
};

/// Both arguments of `nearest` on a device, and the largest coordinate of both there.
template <class X, class Points>
struct nearest_operands {
    X shapes;
    Points points;
    double largest;
};

template <class Team, class X, class Points>
auto nearest_on_devices(const Team& team, const X& index, const Points& points, const char* function) {
    using local = typename Team::local_policy;
    using T = scalar_type_of<typename shape_of_argument<type_on_device<X>>::type>;
    require_as_many(team, index, function);
    require_as_many(team, points, function);
    const auto operands = each_of(team, [&](int k) {
        auto x = make_operand(team[k], on_device(index, k), function);
        auto queries = make_points<T>(team[k], on_device(points, k), function);
        const double largest = std::same_as<T, float> ? 0 : largest_coordinate(team[k], x, queries.shapes());
        return nearest_operands<decltype(x), decltype(queries)>{std::move(x), std::move(queries), largest};
    });
    double largest = 0;
    for (const auto& there : operands) largest = greatest(largest, there.largest);
    const auto unit = unit_of_magnitude<T>(largest);
    const std::size_t n = operands.front().points.shapes().size();
    const local& first = team[0];
    execution::buffer_of<local, neighbor<T>> out(first, n);

    if constexpr (is_divided<X>) {
        using answers = execution::buffer_of<local, measured_on_device<T>>;
        const auto found = each_of(team, [&](int k) {
            const auto& there = operands[static_cast<std::size_t>(k)];
            const auto shapes = there.shapes.shapes();
            const auto from = there.points.shapes();
            const auto write = [&](const std::uint32_t* order, const execution::least_value* values) {
                answers all(team[k], n);
                using write_type =
                    write_measured_on_device<std::remove_const_t<decltype(shapes)>, std::remove_const_t<decltype(from)>>;
                for_each_index(team[k], n, write_type{shapes, from, unit, index.ids(k), order, values, all.data()});
                synchronize(team[k]);
                return all;
            };
            return look_for_nearest(team[k], there.shapes, there.points, unit, write);
        });
        answers best(first, n), other(first, n);
        copy(first, found[0].data(), n, best.data());
        for (int k = 1; k < team.size(); ++k) {
            synchronize(team[k]);
            copy_across(team[k], found[static_cast<std::size_t>(k)].data(), n, first, other.data());
            for_each_index(first, n, keep_nearer<T>{other.data(), best.data()});
            synchronize(first);
        }
        for_each_index(first, n, take_neighbor<T>{best.data(), out.data()});
        synchronize(first);
    } else {
        const auto part_of = [&](int k) {
            return points_of_part{static_cast<std::size_t>(k), static_cast<std::size_t>(team.size())};
        };
        const auto found = each_of(team, [&](int k) {
            const local& on = team[k];
            const auto& there = operands[static_cast<std::size_t>(k)];
            const auto shapes = there.shapes.shapes();
            const auto all = there.points.shapes();
            const std::size_t mine = part_of(k).count(n);
            execution::buffer_of<local, vec3<T>> some(on, mine);
            for_each_index(on, mine, take_points_of_part<std::remove_const_t<decltype(all)>>{all, part_of(k), some.data()});
            const shapes_view<vec3<T>, space_of<local>> view(some.data(), mine);
            const auto queries = make_operand<input::trusted>(on, view, function);
            return look_for_nearest(
                on, there.shapes, queries, unit, [&](const std::uint32_t* order, const execution::least_value* values) {
                    execution::buffer_of<local, neighbor<T>> near(on, mine);
                    using write_type =
                        write_neighbors<std::remove_const_t<decltype(shapes)>, std::remove_const_t<decltype(view)>>;
                    for_each_index(on, mine, write_type{shapes, view, unit, order, values, near.data()});
                    synchronize(on);
                    return near;
                });
        });
        for (int k = 0; k < team.size(); ++k) {
            const auto& there = found[static_cast<std::size_t>(k)];
            execution::buffer_of<local, neighbor<T>> came(first, there.size());
            synchronize(team[k]);
            copy_across(team[k], there.data(), there.size(), first, came.data());
            for_each_index(first, there.size(), put_points_of_part<neighbor<T>>{came.data(), part_of(k), out.data()});
            synchronize(first);
        }
    }
    return result<neighbor<T>, space_of<local>>(std::move(out));
}

}  // namespace detail

/// For each of `points` the nearest shape of `index`, as `nearest` finds it under one policy, bit for bit: a `result` of
/// `neighbor` in memory of the first device. `index` is a set or an index that is replicated or divided, posed or not;
/// `points` is replicated, or a set, a vector or a span in host memory, which is copied to each device. Where the index is
/// divided, each device looks for all points in its part, and holds 32 bytes (double: 48) for each of them, the first device
/// twice.
/// @ingroup devices
template <execution::policy_team Team, class X, class Points>
[[nodiscard]] auto nearest(const Team& team, const X& index, const Points& points) {
    static_assert(!detail::is_divided<Points>,
                  "abut: nearest on several devices takes points that are replicated, not divided");
    using local = typename Team::local_policy;
    if constexpr (detail::can_be_near<local, detail::type_on_device<X>, detail::type_on_device<Points>>()) {
        return detail::nearest_on_devices(team, index, points, "abut::nearest");
    } else {
        return result<neighbor<float>, space_of<local>>();
    }
}

}  // namespace abut
