// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair and contacts, and self_pairs, on several devices at a time. What lies on each device is
// searched in parts (search_part in collide/pairing.hpp); what is divided is searched where it lies. Where both arguments
// are divided, shapes of b come to the devices whose a-shapes they come near.

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

/// Ids of shapes on a device, in the whole sets.
struct ids_of_parts {
    part_ids a, b;  ///< of the shapes there; the same ids where all are there

    [[nodiscard]] ABUT_HD index_pair operator()(std::uint32_t i, std::uint32_t j) const { return {a(i), b(j)}; }
};

template <class Found>
struct rename_found {
    const Found* found;
    ids_of_parts ids;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const {
        Found renamed = found[i];
        const index_pair pair = ids(renamed.a, renamed.b);
        renamed.a = pair.a;
        renamed.b = pair.b;
        out[i] = renamed;
    }
};

struct by_ids {
    template <class Found>
    ABUT_HD bool operator()(const Found& x, const Found& y) const {
        return x.a < y.a || (x.a == y.a && x.b < y.b);
    }
};
struct by_number {
    ABUT_HD bool operator()(std::uint64_t x, std::uint64_t y) const { return x < y; }
};
/// Lists in the order of their keys, one after another, become one. No pair is in two of them.
template <class Order, class Key, class Found>
struct merge_lists {
    Order comes_before;
    const Key* keys;
    const Found* found;
    const std::size_t* first;  ///< of each list, and the number of all
    std::size_t lists;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const {
        const Key mine = keys[i];
        std::size_t place = 0;
        for (std::size_t k = 0; k < lists; ++k) {
            std::size_t lower = first[k], upper = first[k + 1];
            if (lower <= i && i < upper) {
                lower = i;
            } else {
                while (lower < upper) {
                    const std::size_t middle = lower + (upper - lower) / 2;
                    if (comes_before(keys[middle], mine)) {
                        lower = middle + 1;
                    } else {
                        upper = middle;
                    }
                }
            }
            place += lower - first[k];
        }
        out[place] = found[i];
    }
};

/// Lists one after another: where each begins, and where the last one ends.
template <class Lists>
std::vector<std::size_t> beginnings_of(const Lists& lists) {
    std::vector<std::size_t> first{0};
    for (const auto& list : lists) first.push_back(first.back() + list.size());
    return first;
}
/// Such lists become one in the order of their keys, in which each of them is.
template <class Policy, class Order, class Key, class Found>
auto merged_by(const Policy& on, const Order& order, const Key* keys, const execution::buffer_of<Policy, Found>& all,
               const std::vector<std::size_t>& first) {
    execution::buffer_of<Policy, std::size_t> begins(on, first.size());
    execution::buffer_of<Policy, Found> in_order(on, all.size());
    upload(on, first.data(), first.size(), begins.data());
    for_each_index(on, all.size(),
                   merge_lists<Order, Key, Found>{order, keys, all.data(), begins.data(), first.size() - 1, in_order.data()});
    synchronize(on);
    return in_order;
}
/// Such lists become one, in order if they are and `sorted` is.
template <class Policy, class Found, class Order = by_ids>
auto merged(const Policy& on, execution::buffer_of<Policy, Found> all, const std::vector<std::size_t>& first, bool sorted,
            const Order& order = {}) {
    if (sorted && all.size() > 0) all = merged_by(on, order, all.data(), all, first);
    return result<Found, space_of<Policy>>(std::move(all));
}
template <class Local, class Found>
using found_lists = std::vector<result<Found, space_of<Local>>>;
/// Of one device.
template <class Policy, class Found>
auto joined(const Policy& on, found_lists<Policy, Found> lists, bool sorted) {
    if (lists.size() == 1) return std::move(lists.front());
    const auto first = beginnings_of(lists);
    execution::buffer_of<Policy, Found> all(on, first.back());
    for (std::size_t k = 0; k < lists.size(); ++k) {
        copy(on, lists[k].data(), lists[k].size(), all.data() + first[k]);
        lists[k] = {};
    }
    synchronize(on);
    return merged(on, std::move(all), first, sorted);
}
/// Of each device one, one after another in memory of the first. They are empty then.
template <class Team, class Found>
auto brought_to_first(const Team& team, found_lists<typename Team::local_policy, Found>& lists,
                      const std::vector<std::size_t>& first) {
    execution::buffer_of<typename Team::local_policy, Found> all(team[0], first.back());
    synchronize(team[0]);
    for (std::size_t k = 0; k < lists.size(); ++k) {
        synchronize(team[static_cast<int>(k)]);
        copy_across(team[static_cast<int>(k)], lists[k].data(), lists[k].size(), team[0], all.data() + first[k]);
        lists[k] = {};
    }
    return all;
}
/// The same as one list.
template <class Team, class Found, class Order = by_ids>
auto on_first(const Team& team, std::vector<result<Found, space_of<typename Team::local_policy>>> lists, bool sorted,
              const Order& order = {}) {
    if (lists.size() == 1) return std::move(lists.front());
    const auto first = beginnings_of(lists);
    return merged(team[0], brought_to_first<Team, Found>(team, lists, first), first, sorted, order);
}

/// The same options for the shapes of a device.
template <class Filter, traversal Traversal, schedule Schedule>
auto options_there(const query_options<Filter, Traversal, Schedule>& options, const ids_of_parts& ids) {
    auto filter = filter_here(options.filter, ids);
    schedule_options scheduling = options.scheduling;
    scheduling.report = nullptr;  // of one query, and here are several
    return query_options<decltype(filter), Traversal, Schedule>{
        options.sorted, filter, options.most_pairs, options.resident, options.start_depth, scheduling, nullptr};
}

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

/// Where the parts are; of parts under a pose one box each.
template <class Team, class X, class Operands>
auto bounds_of_parts(const Team& team, const X& x, const Operands& operands) {
    using T = typename X::scalar_type;
    if (!x.bounds().empty()) return x.bounds();
    return each_of(team, [&](int k) {
        const auto shapes = operands[static_cast<std::size_t>(k)].shapes();
        const box_of_shape<std::remove_const_t<decltype(shapes)>> box{shapes};
        const aabb<T> around = reduce(team[k], shapes.size(), empty_box<T>(), merge_boxes{}, box);
        return bounds_of_boxes<T>(shapes.size(), {around});
    });
}

/// What each device packs for each other one, [from][to]: of its part of b what comes near the other's part of a; nothing for
/// those that are over. Complete when it returns.
template <class Team, class Operands, class Bounds, class Ids, class IsOver>
auto pack_for_others(const Team& team, const Operands& operands, const Bounds& bounds_a, const Bounds& bounds_b, const Ids& ids,
                     const IsOver& is_over) {
    using local = typename Team::local_policy;
    using view = decltype(operands[0].shapes());
    using packed = near_part<local, typename view::shape_type>;
    return each_of(team, [&](int from) {
        const local& on = team[from];
        near_shapes<local, view> near(operands[static_cast<std::size_t>(from)].shapes());
        std::vector<packed> for_each(static_cast<std::size_t>(team.size()));
        for (int to = 0; to < team.size(); ++to) {
            const auto& theirs = bounds_a[static_cast<std::size_t>(to)];
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

/// ask_each of two divided arguments. Devices pack before they search, or a device would wait until another has searched. Only
/// where a search may be over soon they search their own parts first.
template <class Team, class X, class Y, class Ask, class IsOver>
void ask_each_of_parts(const Team& team, const X& x, const Y& y, const char* function, const Ask& ask, const IsOver& is_over) {
    using local = typename Team::local_policy;
    const auto operands_b = each_of(team, [&](int k) { return make_operand(team[k], y[k], function); });
    const auto operands_a = each_of(team, [&](int k) { return make_operand(team[k], x[k], function); });
    const auto bounds_a = bounds_of_parts(team, x, operands_a);
    const auto bounds_b = bounds_of_parts(team, y, operands_b);
    const auto pack = [&] {
        return pack_for_others(team, operands_b, bounds_a, bounds_b, [&](int k) { return ids_on(y, k); }, is_over);
    };
    const auto search_own = [&](int k) {
        ask(k, x[k], y[k], search_part{}, ids_of_parts{ids_on(x, k), ids_on(y, k)});
    };
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
/// touch are looked at, each once; no more of them once is_over(k).
template <class Team, class X, class Y, class Ask, class IsOver = never_over>
void ask_each(const Team& team, const X& x, const Y& y, const char* function, const Ask& ask, const IsOver& is_over = {}) {
    require_as_many(team, x, function);
    require_as_many(team, y, function);
    if constexpr (is_divided<X> && is_divided<Y>) {
        ask_each_of_parts(team, x, y, function, ask, is_over);
    } else {
        constexpr bool is_whole = !is_divided<X> && !is_divided<Y>;
        execution::on_each(team, [&](int k) {
            ask(k, on_device(x, k), on_device(y, k), is_whole ? share_of(team, k) : search_part{},
                ids_of_parts{ids_on(x, k), ids_on(y, k)});
        });
    }
}

/// What ask(on, pairing) finds on each device, in order if the options say so.
template <class Found, class Team, class X, class Y, class Options, class Ask>
auto found_on_each(const Team& team, const X& x, const Y& y, const Options& options, const char* function, const Ask& ask) {
    using local = typename Team::local_policy;
    using list = result<Found, space_of<local>>;
    std::vector<std::vector<list>> found(static_cast<std::size_t>(team.size()));
    ask_each(team, x, y, function,
             [&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
                 const local& on = team[k];
                 list some = ask(on, in_part(pair_up(on, a, b, options_there(options, ids), function), part));
                 if constexpr (is_divided<X> || is_divided<Y>) {  // ids ascend in each part, so the order stays
                     execution::buffer_of<local, Found> renamed(on, some.size());
                     for_each_index(on, some.size(), rename_found<Found>{some.data(), ids, renamed.data()});
                     synchronize(on);
                     some = list(std::move(renamed));
                 }
                 found[static_cast<std::size_t>(k)].push_back(std::move(some));
             });
    return each_of(team, [&](int k) {
        return joined<local, Found>(team[k], std::move(found[static_cast<std::size_t>(k)]), options.sorted);
    });
}

/// Whether a query of several devices takes its arguments and options.
template <class Team, class X, class Y, class Filter, traversal Traversal>
consteval bool can_pair_on_devices() {
    static_assert(Traversal == traversal::both_at_once, "abut: queries of several devices walk both_at_once");
    return Traversal == traversal::both_at_once &&
           can_pair<typename Team::local_policy, type_on_device<X>, type_on_device<Y>, Filter>();
}

template <arithmetic A, class Team, class X, class Y, class Options>
auto pairs_on_each(const Team& team, const X& a, const Y& b, const Options& options, const char* function) {
    return found_on_each<index_pair>(team, a, b, options, function,
                                     [](const auto& on, const auto& pairing) { return pairs_of<A>(on, pairing); });
}

/// An argument of a self query; nothing of it is divided.
template <class Team, class X, class Ask>
void ask_each_itself(const Team& team, const X& x, const char* function, const Ask& ask) {
    static_assert(!is_divided<X>, "abut: self queries of several devices take a replicated set or index");
    require_as_many(team, x, function);
    execution::on_each(team, [&](int k) { ask(k, on_device(x, k), share_of(team, k)); });
}

}  // namespace detail

/// @defgroup devices Several devices
///
/// `abut::cuda_devices` from `<abut/cuda_devices.hpp>` asks a query of several devices at a time. `replicate` puts a set on
/// each of them, `divide` a part of it on each, and `make_bvh` makes a tree of either on each. `any`, `count`, `pairs`,
/// `for_each_pair`, `contacts`, `self_pairs` and `count_self_pairs` take these, posed or not, and sets in host memory and
/// single shapes, which are copied to each device for the call. `impacts` and queries of bodies take what each device has
/// whole. Answers are those of one device, bit for bit.
///
/// A filter runs on every device: what it points to has to be readable on each of them. `schedule_options::report` is left
/// as it is.
///
/// What both arguments have on each device is searched in parts: each device walks an equal share of the pairs of nodes, or
/// of the shapes that look. What is divided is searched where it lies. If both are divided, shapes of b are copied to the
/// devices whose a-shapes they come near, from one other device at a time.
///
/// @par Memory
/// A result lies in memory of the first device, with the copies that it was made of for a moment. `pairs_by_device` leaves
/// it where it was found.
///
/// @par Errors
/// Those of @ref queries, and `error` if an argument lies on another number of devices. An error on one device is thrown
/// when all have ended; if several failed, that of the first of them.
///
/// @par Synchronisation
/// Each call returns when its answer is complete on all devices. Each device is driven by a thread of the host, the first by
/// the caller's.
///
/// @par Example
/// @snippet devices.cu devices
///@{

/// Whether any shape of `a` touches any shape of `b`. Each device stops soon after the first pair that it finds, and does
/// not ask others for their shapes once one is found.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any(const Team& team, const X& a, const Y& b,
                       const query_options<Filter, Traversal, Schedule>& options = {}) {
    std::atomic<bool> found{false};
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        detail::ask_each(
            team, a, b, "abut::any",
            [&](int k, const auto& x, const auto& y, const auto& part, const detail::ids_of_parts& ids) {
                const auto both = detail::pair_up(team[k], x, y, detail::options_there(options, ids), "abut::any");
                if (detail::any_of<A>(team[k], detail::in_part(both, part))) found.store(true);
            },
            [&](int) { return found.load(); });
    }
    return found.load();
}

/// Number of pairs that touch and that the filter wants. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count(const Team& team, const X& a, const Y& b,
                                  const query_options<Filter, Traversal, Schedule>& options = {}) {
    std::atomic<std::uint64_t> sum{0};
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        detail::ask_each(team, a, b, "abut::count",
                         [&](int k, const auto& x, const auto& y, const auto& part, const detail::ids_of_parts& ids) {
                             const auto both =
                                 detail::pair_up(team[k], x, y, detail::options_there(options, ids), "abut::count");
                             sum += detail::count_of<A>(team[k], detail::in_part(both, part));
                         });
    }
    return sum.load();
}

/// All pairs that touch, each once, with ids in the whole sets: a `result` of `index_pair`, 8 bytes each, in memory of the
/// first device; sorted by a, then b, unless the options say otherwise.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto pairs(const Team& team, const X& a, const Y& b,
                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        return detail::on_first(team, detail::pairs_on_each<A>(team, a, b, options, "abut::pairs"), options.sorted);
    } else {
        return result<index_pair, space_of<typename Team::local_policy>>();
    }
}

/// The same pairs where they were found: a vector of a `result` for each device. Each pair is in one of them, and each is
/// sorted by a, then b, unless the options say otherwise.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto pairs_by_device(const Team& team, const X& a, const Y& b,
                                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        return detail::pairs_on_each<A>(team, a, b, options, "abut::pairs_by_device");
    } else {
        return std::vector<result<index_pair, space_of<typename Team::local_policy>>>();
    }
}

/// Calls visitor_of(k)(index_pair) -> visit for every pair that touches, once, on the k-th device, which has found it.
/// visitor_of is called on the host, once for each device, and may return visitors with memory of that device. Otherwise as
/// `for_each_pair` of one policy; `visit::stop` ends the visits of that device.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class VisitorOf, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_pair(const Team& team, const X& a, const Y& b, const VisitorOf& visitor_of,
                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    using local = typename Team::local_policy;
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>() &&
                  detail::is_visitor<local, visitor, index_pair>()) {
        std::vector<visitor> visitors;
        for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
        const auto stopped = detail::each_of(team, [&](int k) {
            execution::buffer_of<local, std::uint32_t> flag(team[k], 1);
            fill(team[k], flag.data(), 1, std::uint32_t{0});
            return flag;
        });
        const auto flag = [&](int k) { return const_cast<std::uint32_t*>(stopped[static_cast<std::size_t>(k)].data()); };
        detail::ask_each(
            team, a, b, "abut::for_each_pair",
            [&](int k, const auto& x, const auto& y, const auto& part, const detail::ids_of_parts& ids) {
                const local& on = team[k];
                const detail::visitor_by_whole_ids<visitor, detail::ids_of_parts> visits{
                    visitors[static_cast<std::size_t>(k)], ids, flag(k)};
                const auto both = detail::pair_up(on, x, y, detail::options_there(options, ids), "abut::for_each_pair");
                detail::visit_pairs_of<A>(on, detail::in_part(both, part), visits);
            },
            [&](int k) {
                std::uint32_t has_stopped = 0;
                download(team[k], flag(k), 1, &has_stopped);
                return has_stopped != 0;
            });
    }
}

/// The contacts of all pairs that touch, with ids in the whole sets: a `result` of `contact` in memory of the first device,
/// in the order of `pairs`. Numbers are those of `contacts` under one policy, bit for bit.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all>
[[nodiscard]] auto contacts(const Team& team, const X& a, const Y& b, const contact_options<Filter>& options = {}) {
    using local = typename Team::local_policy;
    if constexpr (detail::can_touch<local, detail::type_on_device<X>, detail::type_on_device<Y>, Filter>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<detail::type_on_device<X>>::type>;
        const query_options<Filter> query{.sorted = options.sorted, .filter = options.filter, .resident = options.resident};
        auto found =
            detail::found_on_each<contact<T>>(team, a, b, query, "abut::contacts", [&](const auto& on, const auto& pairing) {
                return detail::contacts_of<A>(on, pairing, options.discard_sideways);
            });
        return detail::on_first(team, std::move(found), options.sorted);
    } else {
        return result<contact<float>, space_of<local>>();
    }
}

/// The pairs of shapes of one set that touch, as `self_pairs` finds them under one policy: of a set or an index that lies on
/// each device. A `result` of `index_pair` in memory of the first device.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all>
[[nodiscard]] auto self_pairs(const Team& team, const X& x, const self_options<Filter>& options = {}) {
    using local = typename Team::local_policy;
    std::vector<result<index_pair, space_of<local>>> found(static_cast<std::size_t>(team.size()));
    if constexpr (detail::can_pair_itself<local, detail::type_on_device<X>, Filter>()) {
        detail::ask_each_itself(team, x, "abut::self_pairs", [&](int k, const auto& there, const detail::search_part& part) {
            found[static_cast<std::size_t>(k)] = detail::pairs_of<A>(
                team[k], detail::in_part(detail::pair_up_faces(team[k], there, options, "abut::self_pairs"), part));
        });
    }
    return detail::on_first(team, std::move(found), options.sorted);
}

/// The number of pairs that self_pairs reports. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all>
[[nodiscard]] std::uint64_t count_self_pairs(const Team& team, const X& x, const self_options<Filter>& options = {}) {
    std::atomic<std::uint64_t> sum{0};
    if constexpr (detail::can_pair_itself<typename Team::local_policy, detail::type_on_device<X>, Filter>()) {
        detail::ask_each_itself(
            team, x, "abut::count_self_pairs", [&](int k, const auto& there, const detail::search_part& part) {
                sum += detail::count_of<A>(
                    team[k],
                    detail::in_part(detail::pair_up_faces(team[k], there, options, "abut::count_self_pairs"), part));
            });
    }
    return sum.load();
}

///@}

}  // namespace abut
