// SPDX-License-Identifier: MIT
#pragma once

// What of a query each device is asked. What lies on each device is searched in parts (search_part in collide/shares.hpp);
// what is divided is searched where it lies. Where both arguments are divided, shapes of b come to the devices whose
// a-shapes they come near.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/pair_up.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/question.hpp>
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

/// Boxes that others look at closely (close_bounds): around nodes of a large part's tree, where its nodes tell how many shapes
/// they have. Of small parts, and where a part has no such tree, there are none.
template <class Policy, class Operand>
auto close_boxes(const Policy& on, const Operand& x) {
    using T = typename decltype(x.shapes())::scalar_type;
    // Another surface that crosses a box brings about as many shapes into it as are in it already. So boxes are small beside
    // what crosses, and few enough to be handed over through the host.
    constexpr std::size_t shapes_in_box = 1024, least_boxes = 256, most_boxes = 16384;
    const std::size_t boxes = std::min(x.shapes().size() / shapes_in_box, most_boxes);
    if constexpr (Operand::has_tree && !Operand::is_posed) {
        if (boxes >= least_boxes && is_along_curve(x)) return boxes_of_nodes(on, x.tree(), boxes);
    }
    return std::vector<aabb<T>>();
}

/// A tree over boxes of the host.
template <class Policy, scalar T>
auto tree_of_boxes(const Policy& on, const std::vector<aabb<T>>& boxes) {
    execution::buffer_of<Policy, aabb<T>> there(on, boxes.size());
    upload(on, boxes.data(), boxes.size(), there.data());
    return make_bvh(on, set_parts::shapes_of(std::move(there)));
}

/// What each device packs for each other one, [from][to], if goes(from, to): of its part of b what comes near the other's
/// part of a. reach(bounds) is what comes near enough to a part, or to a box. Complete when it returns.
template <class Team, class ShapesOn, class Bounds, class Close, class IdsOn, class Goes, class Reach>
auto pack_for_others(const Team& team, const ShapesOn& shapes_on, const IdsOn& ids, const Bounds& bounds_a,
                     const Close& close_a, const Bounds& bounds_b, const Goes& goes, const Reach& reach) {
    using local = typename Team::local_policy;
    using view = decltype(shapes_on(0));
    using packed = near_part<local, typename view::shape_type>;
    using close_bounds_there = close_bounds<typename view::scalar_type, space_of<local>>;
    return each_of(team, [&](int from) {
        const local& on = team[from];
        const view shapes = shapes_on(from);
        near_shapes<local, view> near(shapes);
        std::vector<packed> for_each(static_cast<std::size_t>(team.size()));
        for (int to = 0; to < team.size(); ++to) {
            if (to == from || !goes(from, to)) continue;
            const auto theirs = reach(bounds_a[static_cast<std::size_t>(to)]);
            if (!theirs.is_near(bounds_b[static_cast<std::size_t>(from)])) continue;
            auto boxes = close_a[static_cast<std::size_t>(to)];
            for (auto& box : boxes) box = reach(box);
            const auto tree = tree_of_boxes(on, boxes);
            packed some;
            some.ids = near.ids(on, close_bounds_there{theirs, tree.view()});
            const std::size_t n = some.ids.size();
            some.shapes = execution::buffer_of<local, typename view::shape_type>(on, n);
            for_each_index(on, n, pack_shape<view>{shapes, some.ids.data(), some.shapes.data()});
            for_each_index(on, n, gather_ids{ids(from), some.ids.data()});
            for_each[static_cast<std::size_t>(to)] = std::move(some);
        }
        synchronize(on);
        return for_each;
    });
}

/// What `other` has packed for device k, which has it then.
template <class Team, class Part>
Part fetched(const Team& team, int other, int k, Part& from) {
    const auto& on = team[k];
    const std::size_t n = from.ids.size();
    Part here{{on, n}, {on, n}};
    if (n > 0) {
        copy_across(team[other], from.shapes.data(), n, on, here.shapes.data());
        copy_across(team[other], from.ids.data(), n, on, here.ids.data());
    }
    from = {};
    return here;
}

/// Both arguments of a query of several devices. They are brought to each device and looked at once, however often it is
/// asked.
template <class Team, class X, class Y>
class arguments_on_each {
    using local = typename Team::local_policy;
    using type_x = type_on_device<X>;
    using type_y = type_on_device<Y>;
    using scalar = scalar_type_of<typename shape_of_argument<type_x>::type>;
    template <class Argument>
    using operand_of = decltype(make_operand(std::declval<const local&>(), std::declval<const Argument&>(), ""));
    /// What shapes from elsewhere look in.
    using type_looked_in =
        decltype(looked_in(std::declval<const local&>(), std::declval<const type_x&>(), std::type_identity<type_y>{}));

public:
    /// Throws in the name of `function` if one lies on another number of devices. The arguments outlive this.
    arguments_on_each(const Team& team, const X& x, const Y& y, const char* function)
        : team_(team),
          x_(x),
          y_(y),
          function_(function),
          there_(static_cast<std::size_t>(team.size())),
          looks_(there_.size()) {
        require_as_many(team, x, function);
        require_as_many(team, y, function);
    }

    /// Runs ask(k, a, b, part, ids) on each device, on a thread of its own, of operands: once or several times, so that all
    /// pairs that may touch are looked at, each once; no more of them once is_over(k). Where pairs are wanted that do not
    /// touch, reach(bounds) is what comes near enough to a part of a. It is called when devices have searched their own
    /// parts, if they do that first.
    template <class Ask, class IsOver = never_over, class Reach = as_near_as_boxes>
    void operator()(const Ask& ask, const IsOver& is_over = {}, const Reach& reach = {}) {
        constexpr bool is_whole = !is_divided<X> && !is_divided<Y>;
        const auto search_own = [&](int k) {
            const auto& [a, b] = there(k);
            ask(k, a, b, is_whole ? share_of(team_, k) : search_part{}, ids_of_parts{ids_on(x_, k), ids_on(y_, k)});
        };
        if constexpr (is_divided<X> && is_divided<Y>) {
            ask_parts(search_own, ask, is_over, reach);
        } else {
            execution::on_each(team_, search_own);
        }
    }

private:
    /// On the thread that drives the device.
    const operands_there<operand_of<type_x>, operand_of<type_y>>& there(int k) {
        auto& one = there_[static_cast<std::size_t>(k)];
        if (!one) {
            auto b = make_operand(team_[k], on_device(y_, k), function_);
            auto a = make_operand(team_[k], on_device(x_, k), function_);
            one.emplace(operands_there<operand_of<type_x>, operand_of<type_y>>{std::move(a), std::move(b)});
        }
        return *one;
    }
    const operand_of<type_looked_in>& looks(int k) {
        auto& one = looks_[static_cast<std::size_t>(k)];
        if (!one) {
            const local& on = team_[k];
            one.emplace(make_operand(on, looked_in(on, on_device(x_, k), std::type_identity<type_y>{}), function_));
        }
        return *one;
    }

    /// Of two divided arguments. Devices pack before they search, or a device would wait until another has searched. Only
    /// where a search may be over soon they search their own parts first.
    template <class SearchOwn, class Ask, class IsOver, class Reach>
    void ask_parts(const SearchOwn& search_own, const Ask& ask, const IsOver& is_over, const Reach& reach) {
        const auto shapes_b = [&](int k) { return there(k).b.shapes(); };
        if (bounds_a_.empty()) {
            execution::on_each(team_, [&](int k) { (void)there(k); });
            bounds_a_ = bounds_of_parts(team_, x_, [&](int k) { return there(k).a.shapes(); });
            bounds_b_ = bounds_of_parts(team_, y_, shapes_b);
        }
        const auto pack = [&] {
            if (close_a_.empty()) close_a_ = each_of(team_, [&](int k) { return close_boxes(team_[k], there(k).a); });
            return pack_for_others(
                team_, shapes_b, [&](int k) { return ids_on(y_, k); }, bounds_a_, close_a_, bounds_b_,
                [&](int, int to) { return !is_over(to); }, reach);
        };
        const auto search_near = [&](int k, auto& packed) {
            using part = typename std::remove_cvref_t<decltype(packed)>::value_type::value_type;
            using shape_type = typename decltype(part::shapes)::value_type;
            const local& on = team_[k];
            for (int step = 1; step < team_.size() && !is_over(k); ++step) {
                const int other = (k + step) % team_.size();
                const part here =
                    fetched(team_, other, k, packed[static_cast<std::size_t>(other)][static_cast<std::size_t>(k)]);
                if (here.ids.size() == 0) continue;
                const shapes_view<shape_type, space_of<local>> view(here.shapes.data(), here.shapes.size());
                ask(k, looks(k), view, search_part{}, ids_of_parts{ids_on(x_, k), part_ids{here.ids.data()}});
                synchronize(on);
            }
        };
        if constexpr (std::same_as<IsOver, never_over>) {
            auto packed = pack();
            execution::on_each(team_, [&](int k) {
                search_own(k);
                search_near(k, packed);
            });
        } else {
            execution::on_each(team_, search_own);
            auto packed = pack();
            execution::on_each(team_, [&](int k) { search_near(k, packed); });
        }
    }

    const Team& team_;
    const X& x_;
    const Y& y_;
    const char* function_;
    std::vector<std::optional<operands_there<operand_of<type_x>, operand_of<type_y>>>> there_;
    std::vector<std::optional<operand_of<type_looked_in>>> looks_;
    std::vector<part_bounds<scalar>> bounds_a_, bounds_b_;
    std::vector<std::vector<aabb<scalar>>> close_a_;
};

/// Ids of two shapes of one set, the lesser first.
struct ordered_ids {
    part_ids a, b;
    [[nodiscard]] ABUT_HD index_pair operator()(std::uint32_t i, std::uint32_t j) const {
        const std::uint32_t x = a(i), y = b(j);
        return x < y ? index_pair{x, y} : index_pair{y, x};
    }
};

/// A divided argument that is asked about alone: ask(k, part, itself, ids) about the pairs of a part, and ask(k, part, view,
/// ids) about it and what comes near it of the parts of the devices after it. Parts are operands.
template <class Team, class X, class Reach, class Ask>
void ask_parts_themselves(const Team& team, const X& x, const char* function, const Reach& reach, const Ask& ask) {
    using local = typename Team::local_policy;
    require_as_many(team, x, function);
    const auto there = each_of(team, [&](int k) { return make_operand(team[k], x[k], function); });
    const auto shapes_on = [&](int k) { return there[static_cast<std::size_t>(k)].shapes(); };
    const auto bounds = bounds_of_parts(team, x, shapes_on);
    const auto close = each_of(team, [&](int k) { return close_boxes(team[k], there[static_cast<std::size_t>(k)]); });
    auto packed = pack_for_others(
        team, shapes_on, [&](int k) { return x.ids(k); }, bounds, close, bounds, [](int from, int to) { return from > to; },
        reach);
    execution::on_each(team, [&](int k) {
        const auto& mine = there[static_cast<std::size_t>(k)];
        ask(k, mine, itself{}, ordered_ids{x.ids(k), x.ids(k)});
        for (int other = k + 1; other < team.size(); ++other) {
            const auto here = fetched(team, other, k, packed[static_cast<std::size_t>(other)][static_cast<std::size_t>(k)]);
            if (here.ids.size() == 0) continue;
            using shape_type = typename decltype(here.shapes)::value_type;
            const shapes_view<shape_type, space_of<local>> view(here.shapes.data(), here.shapes.size());
            ask(k, mine, view, ordered_ids{x.ids(k), part_ids{here.ids.data()}});
            synchronize(team[k]);
        }
    });
}

}  // namespace abut::detail
