// SPDX-License-Identifier: MIT
#pragma once

// What of a query each device is asked. What lies on each device is searched in parts (search_part in collide/pairing.hpp);
// what is divided is searched where it lies. Where both arguments are divided, shapes of b come to the devices whose
// a-shapes they come near.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/pairing.hpp>
#include <abut/collide/parts.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/team.hpp>

namespace abut::detail {

/// Ids of shapes on a device, in the whole sets.
struct ids_of_parts {
    part_ids a, b;  ///< of the shapes there; the same ids where all are there

    [[nodiscard]] ABUT_HD index_pair operator()(std::uint32_t i, std::uint32_t j) const { return {a(i), b(j)}; }
};

template <class X>
part_ids ids_on(const X& x, int k) {
    if constexpr (is_divided<X>) {
        return x.ids(k);
    } else {
        return {};
    }
}

/// Shapes of a part that come near another one, with their ids in the whole set.
template <class Policy, class Shape>
struct near_part {
    execution::buffer_of<Policy, Shape> shapes;
    execution::buffer_of<Policy, std::uint32_t> ids;
};
struct gather_ids {
    part_ids ids;
    std::uint32_t* places;
    ABUT_HD void operator()(std::size_t i) const { places[i] = ids(places[i]); }
};

struct never_over {
    bool operator()(int) const { return false; }
};

/// Both arguments on a device.
template <class A, class B>
struct operands_there {
    A a;
    B b;
};

/// Where the parts of x are, by the shapes that shapes_on(k) gives; if it is not known yet, one box each.
template <class Team, class X, class ShapesOn>
auto bounds_of_parts(const Team& team, const X& x, const ShapesOn& shapes_on) {
    using T = typename X::scalar_type;
    if (!x.bounds().empty()) return x.bounds();
    return each_of(team, [&](int k) {
        const auto shapes = shapes_on(k);
        const box_of_shape<std::remove_const_t<decltype(shapes)>> box{shapes};
        const aabb<T> around = reduce(team[k], shapes.size(), empty_box<T>(), merge_boxes{}, box);
        return bounds_of_boxes<T>(shapes.size(), {around});
    });
}

/// What each device packs for each other one, [from][to]: of its part of b what comes near the other's part of a; nothing
/// for those that are over. reach(bounds) is what comes near enough to a part. Complete when it returns.
template <class Team, class ShapesOn, class Bounds, class IdsOn, class IsOver, class Reach>
auto pack_for_others(const Team& team, const ShapesOn& shapes_on, const IdsOn& ids, const Bounds& bounds_a,
                     const Bounds& bounds_b, const IsOver& is_over, const Reach& reach) {
    using local = typename Team::local_policy;
    using view = decltype(shapes_on(0));
    using packed = near_part<local, typename view::shape_type>;
    return each_of(team, [&](int from) {
        const local& on = team[from];
        near_shapes<local, view> near(shapes_on(from));
        std::vector<packed> for_each(static_cast<std::size_t>(team.size()));
        for (int to = 0; to < team.size(); ++to) {
            const auto theirs = reach(bounds_a[static_cast<std::size_t>(to)]);
            if (to == from || is_over(to) || !theirs.is_near(bounds_b[static_cast<std::size_t>(from)])) continue;
            const auto n = static_cast<std::size_t>(near.count(on, theirs));
            packed some{{on, n}, {on, n}};
            near.write(on, theirs, some.shapes.data(), some.ids.data());
            for_each_index(on, n, gather_ids{ids(from), some.ids.data()});
            for_each[static_cast<std::size_t>(to)] = std::move(some);
        }
        synchronize(on);
        return for_each;
    });
}

/// ask_each of two divided arguments. Devices pack before they search, or a device would wait until another has searched.
/// Only where a search may be over soon they search their own parts first.
template <class Team, class X, class Y, class Ask, class IsOver, class Reach>
void ask_each_of_parts(const Team& team, const X& x, const Y& y, const char* function, const Ask& ask,
                       const IsOver& is_over, const Reach& reach) {
    using local = typename Team::local_policy;
    const auto operands = each_of(team, [&](int k) {
        auto b = make_operand(team[k], y[k], function);
        auto a = make_operand(team[k], x[k], function);
        return operands_there<decltype(a), decltype(b)>{std::move(a), std::move(b)};
    });
    const auto shapes_a = [&](int k) { return operands[static_cast<std::size_t>(k)].a.shapes(); };
    const auto shapes_b = [&](int k) { return operands[static_cast<std::size_t>(k)].b.shapes(); };
    const auto bounds_a = bounds_of_parts(team, x, shapes_a);
    const auto bounds_b = bounds_of_parts(team, y, shapes_b);
    const auto pack = [&] {
        return pack_for_others(
            team, shapes_b, [&](int k) { return ids_on(y, k); }, bounds_a, bounds_b, is_over, reach);
    };
    const auto search_own = [&](int k) { ask(k, x[k], y[k], search_part{}, ids_of_parts{ids_on(x, k), ids_on(y, k)}); };
    const auto search_near = [&](int k, auto& packed) {
        using part = typename std::remove_cvref_t<decltype(packed)>::value_type::value_type;
        using shape_type = typename decltype(part::shapes)::value_type;
        const local& on = team[k];
        std::optional<decltype(looked_in(on, x[k], std::type_identity<type_on_device<Y>>{}))> looks;
        for (int step = 1; step < team.size() && !is_over(k); ++step) {
            const int other = (k + step) % team.size();
            part& there = packed[static_cast<std::size_t>(other)][static_cast<std::size_t>(k)];
            const std::size_t n = there.ids.size();
            if (n == 0) continue;
            part here{{on, n}, {on, n}};
            copy_across(team[other], there.shapes.data(), n, on, here.shapes.data());
            copy_across(team[other], there.ids.data(), n, on, here.ids.data());
            there = {};
            if (!looks) looks.emplace(looked_in(on, x[k], std::type_identity<type_on_device<Y>>{}));
            const shapes_view<shape_type, space_of<local>> view(here.shapes.data(), n);
            ask(k, *looks, view, search_part{}, ids_of_parts{ids_on(x, k), part_ids{here.ids.data()}});
            synchronize(on);
        }
    };
    if constexpr (std::same_as<IsOver, never_over>) {
        auto packed = pack();
        execution::on_each(team, [&](int k) {
            search_own(k);
            search_near(k, packed);
        });
    } else {
        execution::on_each(team, search_own);
        auto packed = pack();
        execution::on_each(team, [&](int k) { search_near(k, packed); });
    }
}

/// Runs ask(k, a, b, part, ids) on each device, on a thread of its own: once or several times, so that all pairs that may
/// touch are looked at, each once; no more of them once is_over(k). Where pairs are wanted that do not touch, reach(bounds)
/// is what comes near enough to a part of a. It is called when devices have searched their own parts, if they do that first.
template <class Team, class X, class Y, class Ask, class IsOver = never_over, class Reach = as_near_as_boxes>
void ask_each(const Team& team, const X& x, const Y& y, const char* function, const Ask& ask, const IsOver& is_over = {},
              const Reach& reach = {}) {
    require_as_many(team, x, function);
    require_as_many(team, y, function);
    if constexpr (is_divided<X> && is_divided<Y>) {
        ask_each_of_parts(team, x, y, function, ask, is_over, reach);
    } else {
        constexpr bool is_whole = !is_divided<X> && !is_divided<Y>;
        execution::on_each(team, [&](int k) {
            ask(k, on_device(x, k), on_device(y, k), is_whole ? share_of(team, k) : search_part{},
                ids_of_parts{ids_on(x, k), ids_on(y, k)});
        });
    }
}

/// An argument of a self query; nothing of it is divided.
template <class Team, class X, class Ask>
void ask_each_itself(const Team& team, const X& x, const char* function, const Ask& ask) {
    static_assert(!is_divided<X>, "abut: self queries of several devices take a replicated set or index");
    require_as_many(team, x, function);
    execution::on_each(team, [&](int k) { ask(k, on_device(x, k), share_of(team, k)); });
}

}  // namespace abut::detail
