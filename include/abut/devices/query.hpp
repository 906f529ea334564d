// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair and contacts, and self_pairs, on several devices at a time. ask.hpp says what each device
// is asked, merge.hpp makes one list of what they find.

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/pair_kinds.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/devices/ask.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/merge.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace detail {

template <class Found, class Ids>
struct rename_found {
    const Found* found;
    Ids ids;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const {
        Found renamed = found[i];
        const index_pair pair = ids(renamed.a, renamed.b);
        renamed.a = pair.a;
        renamed.b = pair.b;
        out[i] = renamed;
    }
};

/// What was found of a device's shapes, with ids of the whole sets.
template <class Policy, class Found, class Ids>
auto renamed(const Policy& on, const result<Found, space_of<Policy>>& found, const Ids& ids) {
    execution::buffer_of<Policy, Found> out(on, found.size());
    for_each_index(on, found.size(), rename_found<Found, Ids>{found.data(), ids, out.data()});
    synchronize(on);
    return result<Found, space_of<Policy>>(std::move(out));
}

/// Pairs of ids as numbers in their order, and back.
struct number_pairs {
    const index_pair* pairs;
    std::uint64_t* numbers;
    ABUT_HD void operator()(std::size_t i) const { numbers[i] = std::uint64_t{pairs[i].a} << 32 | pairs[i].b; }
};
struct pairs_of_numbers {
    const std::uint64_t* numbers;
    index_pair* pairs;
    ABUT_HD void operator()(std::size_t i) const {
        pairs[i] = {static_cast<std::uint32_t>(numbers[i] >> 32), static_cast<std::uint32_t>(numbers[i])};
    }
};
/// Brings pairs in order. `shapes` is the number of the shapes whose ids these are.
template <class Policy>
auto in_order(const Policy& on, const result<index_pair, space_of<Policy>>& found, std::size_t shapes) {
    execution::buffer_of<Policy, std::uint64_t> numbers(on, found.size());
    execution::buffer_of<Policy, index_pair> out(on, found.size());
    for_each_index(on, found.size(), number_pairs{found.data(), numbers.data()});
    sort_keys(on, numbers, 32 + id_bits(shapes));
    for_each_index(on, found.size(), pairs_of_numbers{numbers.data(), out.data()});
    synchronize(on);
    return result<index_pair, space_of<Policy>>(std::move(out));
}

/// The same options for the shapes of a device.
template <class Filter, traversal Traversal, schedule Schedule, class Ids>
auto options_there(const query_options<Filter, Traversal, Schedule>& options, const Ids& ids) {
    auto filter = filter_here(options.filter, ids);
    schedule_options scheduling = options.scheduling;
    scheduling.report = nullptr;  // of one query, and here are several
    return query_options<decltype(filter), Traversal, Schedule>{
        options.sorted, filter, options.most_pairs, options.resident, options.start_depth, scheduling, nullptr};
}

/// What ask(on, pairing) finds on each device, in order if the options say so.
template <class Found, class Team, class X, class Y, class Options, class Kind, class Ask>
auto found_on_each(const Team& team, const X& x, const Y& y, const Options& options, const char* function, const Kind& kind,
                   const Ask& ask) {
    using local = typename Team::local_policy;
    using list = result<Found, space_of<local>>;
    std::vector<std::vector<list>> found(static_cast<std::size_t>(team.size()));
    ask_each(
        team, x, y, function,
        [&](int k, const auto& a, const auto& b, const search_part& part, const ids_of_parts& ids) {
            const local& on = team[k];
            list some = ask(on, in_part(kind.pair_up(on, a, b, options_there(options, ids), function), part));
            if constexpr (is_divided<X> || is_divided<Y>) {  // ids ascend in each part, so the order stays
                some = renamed(on, some, ids);
            }
            found[static_cast<std::size_t>(k)].push_back(std::move(some));
        },
        never_over{}, kind);
    const auto one = [&](int k) {
        return joined<local, Found>(team[k], std::move(found[static_cast<std::size_t>(k)]), options.sorted);
    };
    if constexpr (is_divided<X> && is_divided<Y>) {
        return each_of(team, one);
    } else {  // each has one list, and nothing is to be done on the devices
        std::vector<list> all;
        for (int k = 0; k < team.size(); ++k) all.push_back(one(k));
        return all;
    }
}

/// Whether a query of several devices takes its arguments and options.
template <class Team, class X, class Y, class Filter, traversal Traversal>
consteval bool can_pair_on_devices() {
    static_assert(Traversal == traversal::both_at_once, "abut: queries of several devices walk both_at_once");
    return Traversal == traversal::both_at_once &&
           can_pair<typename Team::local_policy, type_on_device<X>, type_on_device<Y>, Filter>();
}

template <arithmetic A, class Team, class X, class Y, class Options, class Kind = pairs_that_touch>
auto pairs_on_each(const Team& team, const X& a, const Y& b, const Options& options, const char* function,
                   const Kind& kind = {}) {
    return found_on_each<index_pair>(team, a, b, options, function, kind, [&](const auto& on, const auto& pairing) {
        return pairs_of<A>(on, pairing, kind.template names<A>());
    });
}

template <arithmetic A, class Team, class X, class Y, class Options, class Kind = pairs_that_touch>
bool any_on_devices(const Team& team, const X& a, const Y& b, const Options& options, const char* function,
                    const Kind& kind = {}) {
    std::atomic<bool> found{false};
    ask_each(
        team, a, b, function,
        [&](int k, const auto& x, const auto& y, const auto& part, const ids_of_parts& ids) {
            const auto both = in_part(kind.pair_up(team[k], x, y, options_there(options, ids), function), part);
            if (any_of<A>(team[k], both, kind.template judge<A>())) found.store(true);
        },
        [&](int) { return found.load(); }, kind);
    return found.load();
}

template <arithmetic A, class Team, class X, class Y, class Options, class Kind = pairs_that_touch>
std::uint64_t count_on_devices(const Team& team, const X& a, const Y& b, const Options& options, const char* function,
                               const Kind& kind = {}) {
    std::atomic<std::uint64_t> sum{0};
    ask_each(
        team, a, b, function,
        [&](int k, const auto& x, const auto& y, const auto& part, const ids_of_parts& ids) {
            const auto both = in_part(kind.pair_up(team[k], x, y, options_there(options, ids), function), part);
            sum += count_of<A>(team[k], both, kind.template judge<A>());
        },
        never_over{}, kind);
    return sum.load();
}

template <arithmetic A, class Team, class X, class Y, class VisitorOf, class Options, class Kind = pairs_that_touch>
void visit_on_devices(const Team& team, const X& a, const Y& b, const VisitorOf& visitor_of, const Options& options,
                      const char* function, const Kind& kind = {}) {
    using local = typename Team::local_policy;
    using visitor = std::remove_cvref_t<decltype(visitor_of(0))>;
    std::vector<visitor> visitors;
    for (int k = 0; k < team.size(); ++k) visitors.push_back(visitor_of(k));
    const auto stopped = each_of(team, [&](int k) {
        execution::buffer_of<local, std::uint32_t> flag(team[k], 1);
        fill(team[k], flag.data(), 1, std::uint32_t{0});
        return flag;
    });
    const auto flag = [&](int k) { return const_cast<std::uint32_t*>(stopped[static_cast<std::size_t>(k)].data()); };
    ask_each(
        team, a, b, function,
        [&](int k, const auto& x, const auto& y, const auto& part, const ids_of_parts& ids) {
            const local& on = team[k];
            const visitor_by_whole_ids<visitor, ids_of_parts> visits{visitors[static_cast<std::size_t>(k)], ids, flag(k)};
            const auto both = in_part(kind.pair_up(on, x, y, options_there(options, ids), function), part);
            visit_pairs_of<A>(on, both, visits, kind.template judge<A>());
        },
        [&](int k) {
            std::uint32_t has_stopped = 0;
            download(team[k], flag(k), 1, &has_stopped);
            return has_stopped != 0;
        },
        kind);
}

/// Of one set the pairs of its shapes, and their number.
template <arithmetic A, class Team, class X, class Options, class Kind>
auto self_pairs_on_devices(const Team& team, const X& x, const Options& options, const char* function, const Kind& kind) {
    using local = typename Team::local_policy;
    using list = result<index_pair, space_of<local>>;
    std::vector<list> found(static_cast<std::size_t>(team.size()));
    if constexpr (is_divided<X>) {
        std::vector<std::vector<list>> of_parts(found.size());
        ask_parts_themselves(
            team, x, function, kind, [&](int k, const auto& part, const auto& other, const ordered_ids& ids) {
                const local& on = team[k];
                using other_type = std::remove_cvref_t<decltype(other)>;
                const auto both = kind.pair_up(on, part, other, options_there(options, ids), function);
                list some = renamed(on, pairs_of<A>(on, both, kind.template names<A>()), ids);
                // Of one part ids ascend, so the order stays.
                if (options.sorted && !std::same_as<other_type, itself>) some = in_order(on, some, x.size());
                of_parts[static_cast<std::size_t>(k)].push_back(std::move(some));
            });
        found = each_of(team, [&](int k) {
            return joined<local, index_pair>(team[k], std::move(of_parts[static_cast<std::size_t>(k)]), options.sorted);
        });
    } else {
        ask_each_itself(team, x, function, [&](int k, const auto& there, const search_part& part) {
            found[static_cast<std::size_t>(k)] = pairs_of<A>(
                team[k], in_part(kind.pair_up(team[k], there, itself{}, options, function), part), kind.template names<A>());
        });
    }
    return on_first(team, std::move(found), options.sorted);
}
template <arithmetic A, class Team, class X, class Options, class Kind>
std::uint64_t count_self_on_devices(const Team& team, const X& x, const Options& options, const char* function,
                                    const Kind& kind) {
    std::atomic<std::uint64_t> sum{0};
    if constexpr (is_divided<X>) {
        ask_parts_themselves(
            team, x, function, kind, [&](int k, const auto& part, const auto& other, const ordered_ids& ids) {
                const auto both = kind.pair_up(team[k], part, other, options_there(options, ids), function);
                sum += count_of<A>(team[k], both, kind.template judge<A>());
            });
    } else {
        ask_each_itself(team, x, function, [&](int k, const auto& there, const search_part& part) {
            sum += count_of<A>(team[k], in_part(kind.pair_up(team[k], there, itself{}, options, function), part),
                               kind.template judge<A>());
        });
    }
    return sum.load();
}

}  // namespace detail

/// @defgroup devices Several devices
///
/// `abut::cuda_devices` from `<abut/cuda_devices.hpp>` asks a query of several devices at a time. `replicate` puts a set on
/// each of them, `divide` a part of it on each, and `make_bvh` makes a tree of either on each. `any`, `count`, `pairs`,
/// `for_each_pair`, `contacts`, `within` and `distance` take these, posed or not, and sets in host memory and single shapes,
/// which are copied to each device for the call; so do `nearest`, `inside` and `raycast`, and what looks is not divided.
/// Self queries take what is replicated or divided, and queries of bodies what each device has whole. Answers are those of one
/// device, bit for bit.
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
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        return detail::any_on_devices<A>(team, a, b, options, "abut::any");
    } else {
        return false;
    }
}

/// Number of pairs that touch and that the filter wants. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count(const Team& team, const X& a, const Y& b,
                                  const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_on_devices<Team, X, Y, Filter, Traversal>()) {
        return detail::count_on_devices<A>(team, a, b, options, "abut::count");
    } else {
        return 0;
    }
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
        detail::visit_on_devices<A>(team, a, b, visitor_of, options, "abut::for_each_pair");
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
        auto found = detail::found_on_each<contact<T>>(
            team, a, b, query, "abut::contacts", detail::pairs_that_touch{}, [&](const auto& on, const auto& pairing) {
                return detail::contacts_of<A>(on, pairing, options.discard_sideways);
            });
        return detail::on_first(team, std::move(found), options.sorted);
    } else {
        return result<contact<float>, space_of<local>>();
    }
}

/// The pairs of shapes of one set that touch, as `self_pairs` finds them under one policy: of a set or an index that lies on
/// each device, or is divided. A `result` of `index_pair` in memory of the first device. Faces of a mesh that `divide` has
/// divided are triangles, which share no vertices by their numbers: {.coincident = coincident_vertices::merged} tells
/// neighbours by their places.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all>
[[nodiscard]] auto self_pairs(const Team& team, const X& x, const self_options<Filter>& options = {}) {
    if constexpr (detail::can_pair_itself<typename Team::local_policy, detail::type_on_device<X>, Filter>()) {
        return detail::self_pairs_on_devices<A>(team, x, detail::as_query_options(options), "abut::self_pairs",
                                                detail::pairs_beyond_shared(options.coincident));
    } else {
        return result<index_pair, space_of<typename Team::local_policy>>();
    }
}

/// The number of pairs that self_pairs reports. Stores none of them.
template <arithmetic A = filtered, execution::policy_team Team, class X, class Filter = keep_all>
[[nodiscard]] std::uint64_t count_self_pairs(const Team& team, const X& x, const self_options<Filter>& options = {}) {
    if constexpr (detail::can_pair_itself<typename Team::local_policy, detail::type_on_device<X>, Filter>()) {
        return detail::count_self_on_devices<A>(team, x, detail::as_query_options(options), "abut::count_self_pairs",
                                                detail::pairs_beyond_shared(options.coincident));
    } else {
        return 0;
    }
}

///@}

}  // namespace abut
