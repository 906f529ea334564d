// SPDX-License-Identifier: MIT
#pragma once

// Lists of posed pairs on many ranks. Each rank has some of the entries, with the indices of both sides, and asks about
// these. No shapes are sent: ranks tell each other how many entries they have, what they count, and whether one failed.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/collide/list.hpp>
#include <abut/collide/list_distance.hpp>
#include <abut/collide/list_within.hpp>
#include <abut/collide/pair_kinds.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/query.hpp>

#include <mpi.h>

namespace abut {

/// @addtogroup distributed
///@{

/// A `tagged_pair` of a list of many parts.
struct global_tagged_pair {
    std::uint64_t pair;  ///< position in the list of all ranks
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one

    friend constexpr bool operator==(const global_tagged_pair&, const global_tagged_pair&) = default;
    friend constexpr auto operator<=>(const global_tagged_pair&, const global_tagged_pair&) = default;
};

/// A `tagged_contact` of a list of many parts.
template <scalar T>
struct global_tagged_contact {
    std::uint64_t pair;  ///< position in the list of all ranks
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one
    vec3<T> point;       ///< of both shapes, in the world
    vec3<T> normal;      ///< of length 1, from b to a
    T depth;             ///< 0 or more, in units of length

    friend constexpr bool operator==(const global_tagged_contact&, const global_tagged_contact&) = default;
};

///@}

namespace detail {

/// Positions of a rank's entries in the list of all ranks.
struct entries_of_rank {
    std::uint64_t first;
    [[nodiscard]] std::uint64_t operator()(std::size_t i) const { return first + i; }
    [[nodiscard]] ABUT_HD global_tagged_pair named(const tagged_pair& of) const { return {first + of.pair, of.a, of.b}; }
    template <scalar T>
    [[nodiscard]] ABUT_HD global_tagged_contact<T> named(const tagged_contact<T>& of) const {
        return {first + of.pair, of.a, of.b, of.point, of.normal, of.depth};
    }
};

/// Where the entries of this rank are in the list of all of them, each of which gives how many it has.
inline entries_of_rank positions_of_rank(const own_communicator& ranks, std::size_t entries) {
    const std::uint64_t mine = entries;
    std::uint64_t up_to_mine = 0;
    check_mpi(MPI_Scan(&mine, &up_to_mine, 1, MPI_UINT64_T, MPI_SUM, ranks.get()), "MPI_Scan");
    return {up_to_mine - mine};
}

/// Runs ask(position) of a rank's entries, on all ranks; it throws on all or on none.
template <class Local, class List, class Ask>
void ask_own_entries(const distributed<Local>& on, const List& list, const Ask& ask) {
    const entries_of_rank position = positions_of_rank(on.ranks(), list.size());
    attempts attempt;
    attempt([&] { ask(position); });
    attempt.settle(on.ranks());
}

/// A rank's entries, ready to be asked for pairs of a kind (pair_kinds.hpp).
template <class Local, class IndexA, class IndexB, class Options, class Kind>
auto pair_up_own(const Local& on, const std::vector<posed_pair<IndexA, IndexB>>& list, const Options& options,
                 const char* function, const entries_of_rank& position, const Kind& kind) {
    return pair_up(on, list, options_of_part(options, position), function, position,
                   kind.template nearness<typename IndexA::scalar_type>(function));
}

/// What ask(pairing) finds of a rank's entries.
template <class Global, class Local, class List, class Options, class Kind, class Ask>
auto found_of_own_entries(const distributed<Local>& on, const List& list, const Options& options, const char* function,
                          const Kind& kind, const Ask& ask) {
    result<Global, space_of<Local>> found;
    ask_own_entries(on, list, [&](const entries_of_rank& position) {
        const auto pairing = pair_up_own(on.local(), list, options, function, position, kind);
        found = found_of_part(on.local(), ask(pairing), position);
    });
    return found;
}

template <arithmetic A, class Local, class List, class Options, class Kind>
bool any_of_own_entries(const distributed<Local>& on, const List& list, const Options& options, const char* function,
                        const Kind& kind) {
    bool found = false;
    ask_own_entries(on, list, [&](const entries_of_rank& position) {
        const auto pairing = pair_up_own(on.local(), list, options, function, position, kind);
        found = any_of<A>(on.local(), pairing, kind.template judge<A>());
    });
    return sum_of_ranks(on.ranks(), found ? 1 : 0) > 0;
}
template <arithmetic A, class Local, class List, class Options, class Kind>
std::uint64_t count_of_own_entries(const distributed<Local>& on, const List& list, const Options& options,
                                   const char* function, const Kind& kind) {
    std::uint64_t found = 0;
    ask_own_entries(on, list, [&](const entries_of_rank& position) {
        const auto pairing = pair_up_own(on.local(), list, options, function, position, kind);
        found = count_of<A>(on.local(), pairing, kind.template judge<A>());
    });
    return sum_of_ranks(on.ranks(), found);
}
template <arithmetic A, class Local, class List, class Options, class Kind>
auto pairs_of_own_entries(const distributed<Local>& on, const List& list, const Options& options, const char* function,
                          const Kind& kind) {
    return found_of_own_entries<global_tagged_pair>(on, list, options, function, kind, [&](const auto& pairing) {
        return pairs_of<A>(on.local(), pairing, kind.template names<A>());
    });
}
template <arithmetic A, class Local, class List, class Visitor, class Options, class Kind>
void visit_own_entries(const distributed<Local>& on, const List& list, const Visitor& visitor, const Options& options,
                       const char* function, const Kind& kind) {
    ask_own_entries(on, list, [&](const entries_of_rank& position) {
        const call_of_part<Visitor, entries_of_rank> visits{visitor, position};
        const auto pairing = pair_up_own(on.local(), list, options, function, position, kind);
        visit_pairs_of<A>(on.local(), pairing, visits, kind.template judge<A>());
    });
}

}  // namespace detail

/// @addtogroup distributed
///@{

/// Whether the shapes of any entry touch: the same answer on all ranks. `list` is this rank's part of the list: entries of
/// indices that this rank has, made under the local policy, as those of `any` of a list. It may be empty. The list that is
/// asked about is all parts one after another, in the order of the ranks. A filter is called as filter(global_tagged_pair).
/// Errors name an entry by its position there. A rank that has found a pair looks for no other.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                       const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Local, IndexA, IndexB>()) {
        return detail::any_of_own_entries<A>(on, list, options, "abut::any", detail::pairs_that_touch{});
    } else {
        return false;
    }
}

/// Number of pairs of shapes that touch, of the entries of all ranks: the same answer on each. Arguments as of `any` of a
/// list.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                  const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Local, IndexA, IndexB>()) {
        return detail::count_of_own_entries<A>(on, list, options, "abut::count", detail::pairs_that_touch{});
    } else {
        return 0;
    }
}

/// All pairs of shapes of this rank's entries that touch: a `result` of `global_tagged_pair`, 16 bytes each, in the local
/// policy's memory; sorted by entry, then a, then b, unless the options say otherwise. Then the lists of all ranks, one
/// after another, are the list of one machine. Arguments as of `any` of a list.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto pairs(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                         const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Local, IndexA, IndexB>()) {
        return detail::pairs_of_own_entries<A>(on, list, options, "abut::pairs", detail::pairs_that_touch{});
    } else {
        return result<global_tagged_pair, space_of<Local>>();
    }
}

/// Calls visitor(global_tagged_pair) -> visit once for every such pair of this rank's entries, as `for_each_pair` of a list
/// under the local policy does. `visit::stop` ends the visits of this rank; other ranks go on.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Visitor,
          class Filter = keep_all, schedule Schedule = schedule::shared_list>
void for_each_pair(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list, const Visitor& visitor,
                   const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Local, IndexA, IndexB>() &&
                  detail::is_global_visitor<Local, Visitor, global_tagged_pair>()) {
        detail::visit_own_entries<A>(on, list, visitor, options, "abut::for_each_pair", detail::pairs_that_touch{});
    }
}

/// The contacts of all pairs of shapes of this rank's entries that touch: a `result` of `global_tagged_contact`, 48 bytes
/// each in float and 72 in double, in the local policy's memory and in the order of `pairs`. Arguments as of `any` of a
/// list.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto contacts(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                            const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Local, IndexA, IndexB>()) {
        return detail::found_of_own_entries<global_tagged_contact<typename IndexA::scalar_type>>(
            on, list, options, "abut::contacts", detail::pairs_that_touch{},
            [&](const auto& pairing) { return detail::contacts_of<A>(on.local(), pairing, options.discard_sideways); });
    } else {
        return result<global_tagged_contact<float>, space_of<Local>>();
    }
}

/// How far apart the two indices of each of this rank's entries are, as `distance` of a list under the local policy: a
/// `result` of `separation`, one of each entry in their order, in the local policy's memory. Arguments as of `any` of a
/// list.
template <execution_policy Local, class IndexA, class IndexB>
[[nodiscard]] auto distance(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                            const distance_options& options = {}) {
    if constexpr (detail::can_be_measured<Local, IndexA, IndexB>()) {
        result<separation<typename IndexA::scalar_type>, space_of<Local>> found;
        detail::ask_own_entries(on, list, [&](const detail::entries_of_rank& position) {
            found = detail::distances_of(on.local(), list, options, "abut::distance", position);
        });
        return found;
    } else {
        return result<separation<float>, space_of<Local>>();
    }
}

/// All pairs of shapes of this rank's entries that are no farther apart than `distance`: as `pairs` of a list, and of each
/// entry what `within` says of its two indices. All ranks give the same distance.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto within(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                          const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Local, IndexA, IndexB>()) {
        return detail::pairs_of_own_entries<A>(on, list, options, "abut::within", detail::pairs_within{distance});
    } else {
        return result<global_tagged_pair, space_of<Local>>();
    }
}

/// Number of the pairs of `within`, of the entries of all ranks: the same answer on each.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_within(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                         double distance, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Local, IndexA, IndexB>()) {
        return detail::count_of_own_entries<A>(on, list, options, "abut::count_within", detail::pairs_within{distance});
    } else {
        return 0;
    }
}

/// Whether two shapes of any entry are no farther apart than `distance`: the same answer on all ranks.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Filter = keep_all,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_within(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                              double distance, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Local, IndexA, IndexB>()) {
        return detail::any_of_own_entries<A>(on, list, options, "abut::any_within", detail::pairs_within{distance});
    } else {
        return false;
    }
}

/// Calls visitor(global_tagged_pair) -> visit once for every pair of `within` of this rank's entries, as `for_each_pair` of
/// a list does.
template <arithmetic A = filtered, execution_policy Local, class IndexA, class IndexB, class Visitor,
          class Filter = keep_all, schedule Schedule = schedule::shared_list>
void for_each_within(const distributed<Local>& on, const std::vector<posed_pair<IndexA, IndexB>>& list, double distance,
                     const Visitor& visitor, const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed_within<Local, IndexA, IndexB>() &&
                  detail::is_global_visitor<Local, Visitor, global_tagged_pair>()) {
        detail::visit_own_entries<A>(on, list, visitor, options, "abut::for_each_within", detail::pairs_within{distance});
    }
}

///@}

}  // namespace abut
