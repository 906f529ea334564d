// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair and contacts of sets whose parts lie on many ranks. The shapes of b come to the ranks
// whose a-shapes they come near (parts.hpp), and each rank asks the query of its local policy: of its own parts first, and
// then of what came from each other rank.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/pair_kinds.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/index/bvh.hpp>

#include <mpi.h>

namespace abut {

/// @addtogroup distributed
///@{

/// Ids of two shapes that touch, in sets of many parts: `a` in a query's first argument, `b` in its second.
struct global_pair {
    std::uint64_t a;  ///< id in the first argument's set
    std::uint64_t b;  ///< id in the second one's

    friend constexpr bool operator==(const global_pair&, const global_pair&) = default;
    friend constexpr auto operator<=>(const global_pair&, const global_pair&) = default;
};

/// A `contact` with ids in sets of many parts.
template <scalar T>
struct global_contact {
    std::uint64_t a;  ///< id of the first shape
    std::uint64_t b;  ///< id of the second one
    vec3<T> point;    ///< of both shapes, in the world
    vec3<T> normal;   ///< of length 1, from b to a
    T depth;          ///< 0 or more, in units of length

    friend constexpr bool operator==(const global_contact&, const global_contact&) = default;
};

///@}

namespace detail {

/// Ids of a rank's own a-shapes and of the b-shapes of one rank, in the whole sets.
struct global_ids {
    std::uint64_t first_a, first_b;
    const std::uint32_t* ids_b;  ///< of those b-shapes that came; null if all are here

    [[nodiscard]] ABUT_HD global_pair operator()(std::uint32_t a, std::uint32_t b) const {
        return {first_a + a, first_b + (ids_b == nullptr ? b : ids_b[b])};
    }
};

/// What was found here, with the ids of the whole sets.
///@{
ABUT_HD inline global_pair named_globally(const index_pair& pair, const global_ids& ids) { return ids(pair.a, pair.b); }
template <scalar T>
ABUT_HD global_contact<T> named_globally(const contact<T>& c, const global_ids& ids) {
    const global_pair pair = ids(c.a, c.b);
    return {pair.a, pair.b, c.point, c.normal, c.depth};
}
///@}
/// By what results are sorted that come from different ranks: the a-shape. Results of one rank are in order.
///@{
ABUT_HD inline std::uint64_t key_of_first(const index_pair& pair) { return pair.a; }
template <scalar T>
ABUT_HD std::uint64_t key_of_first(const contact<T>& c) {
    return c.a;
}
///@}
template <class Found, class Global>
struct name_all_globally {
    const Found* found;
    global_ids ids;
    Global* out;
    std::uint64_t* keys;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = named_globally(found[i], ids);
        keys[i] = key_of_first(found[i]);
    }
};

template <class Global>
struct gather_places {
    const Global* found;
    const std::uint64_t* places;
    Global* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = found[places[i]]; }
};

/// What a rank's a-shapes touch, as it comes from one rank after another.
template <class Local, class Global>
class found_by_rank {
public:
    /// With room for `n` values of `rank` and for the keys of their a-shapes, write(values, keys) writes them.
    template <class Write>
    void add(const Local& local, int rank, std::size_t n, const Write& write) {
        if (n == 0) return;
        part found{rank, execution::buffer_of<Local, Global>(local, n),
                   execution::buffer_of<Local, std::uint64_t>(local, n)};
        write(found.values.data(), found.keys.data());
        synchronize(local);
        parts_.push_back(std::move(found));
    }

    /// All of it; sorted by a, then b, if each part is and `sorted` is. b ascends with the ranks, and the sort by the keys,
    /// of `bits` bits, is stable.
    result<Global, space_of<Local>> join(const Local& local, bool sorted, int bits) {
        std::sort(parts_.begin(), parts_.end(), [](const part& a, const part& b) { return a.rank < b.rank; });
        if (parts_.size() == 1) return result<Global, space_of<Local>>(std::move(parts_.front().values));
        std::size_t total = 0;
        for (const part& found : parts_) total += found.values.size();
        execution::buffer_of<Local, Global> all(local, total);
        execution::buffer_of<Local, std::uint64_t> keys(local, sorted ? total : 0), places(local, keys.size());
        std::size_t first = 0;
        for (part& found : parts_) {
            const std::size_t n = found.values.size();
            copy(local, found.values.data(), n, all.data() + first);
            if (sorted) copy(local, found.keys.data(), n, keys.data() + first);
            first += n;
            found = {};
        }
        if (sorted && total > 0) {
            for_each_index(local, total, execution::write_index<std::uint64_t>{places.data()});
            sort_by_key(local, keys, places, bits);
            execution::buffer_of<Local, Global> in_order(local, total);
            for_each_index(local, total, gather_places<Global>{all.data(), places.data(), in_order.data()});
            synchronize(local);
            all = std::move(in_order);
        }
        synchronize(local);
        return result<Global, space_of<Local>>(std::move(all));
    }

private:
    struct part {
        int rank = 0;
        execution::buffer_of<Local, Global> values;
        execution::buffer_of<Local, std::uint64_t> keys;
    };
    std::vector<part> parts_;
};

/// The same options of the local query, with a filter of local ids.
template <class Filter, traversal Traversal, schedule Schedule>
auto options_here(const query_options<Filter, Traversal, Schedule>& options, const global_ids& ids) {
    auto filter = filter_here(options.filter, ids);
    return query_options<decltype(filter), Traversal, Schedule>{
        options.sorted,     filter,       options.most_pairs, options.resident, options.start_depth,
        options.scheduling, options.front};
}
template <class Filter>
auto options_here(const contact_options<Filter>& options, const global_ids& ids) {
    auto filter = filter_here(options.filter, ids);
    return contact_options<decltype(filter)>{options.sorted, filter, options.resident, options.discard_sideways};
}

/// Whether a query of ranks takes its filter, and its arguments.
template <class Local, class Filter>
consteval bool is_global_filter() {
    constexpr bool is = std::same_as<Filter, keep_all> || answers<Local, Filter, bool, std::uint64_t, std::uint64_t>();
    static_assert(is,
                  "abut: a filter of a distributed query is called as filter(a, b) const with two std::uint64_t, and "
                  "returns bool");
    return is;
}
template <class Local, class X, class Y, class Filter>
consteval bool can_pair_globally() {
    if constexpr (can_pair<Local, X, Y, keep_all>()) {
        return is_global_filter<Local, Filter>();
    } else {
        return false;
    }
}

template <class Local, class X, class Filter>
consteval bool can_pair_itself_globally() {
    if constexpr (can_pair_itself<Local, X, keep_all>()) {
        return is_global_filter<Local, Filter>();
    } else {
        return false;
    }
}

/// The shape of a query's second argument; of the first one where it is asked about alone.
template <class X, class Y>
struct shape_of_second : shape_of_argument<Y> {};
template <class X>
struct shape_of_second<X, itself> : shape_of_argument<X> {};

struct share_nothing {
    void operator()() const {}
};

/// An argument in the policy's memory, for several queries: copied under cuda once, if it is a set of the host's.
template <class Policy, class X>
auto brought_to(const Policy& on, const X& x) {
    if constexpr (is_posed<X>) {
        return posed(brought_to(on, x.object), x.pose);
    } else if constexpr (shape_set<X> && !is_index<X>) {
        return x.copied_to(on);
    } else {
        return x;
    }
}

/// Runs ask(rank, a, b, ids) of a rank's own parts, and then of what comes from each other rank: all pairs of its a-shapes
/// with b-shapes that they may touch, each once. Where y is `itself`, these are pairs of shapes of x: of its own part a rank
/// asks by `itself`, and others come from the ranks above it alone, where all ids are greater. Where pairs are wanted that
/// do not touch, reach(bounds) is what comes near enough to a part of a: the same on all ranks, which call share() first,
/// when they have asked about their own parts, whether that failed or not. Returns the parts of a. All ranks call it; it
/// throws on all or on none.
template <class Local, class X, class Y, class Ask, class Reach = as_near_as_boxes, class Share = share_nothing>
auto ask_all_parts(const distributed<Local>& on, const X& x, const Y& y, const char* function, const Ask& ask,
                   const Reach& reach = {}, const Share& share = {}) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    constexpr bool is_alone = std::same_as<Y, itself>;
    const own_communicator& ranks = on.ranks();
    const Local& local = on.local();
    attempts attempt;
    const auto bring = [&] {
        auto a = brought_to(local, x);
        auto operand_a = make_operand(local, a, function);
        if constexpr (is_alone) {
            auto operand_b = operand_a;
            return std::tuple(std::move(a), y, std::move(operand_a), std::move(operand_b));
        } else {
            auto b = brought_to(local, y);
            auto operand_b = make_operand(local, b, function);
            return std::tuple(std::move(a), std::move(b), std::move(operand_a), std::move(operand_b));
        }
    };
    std::optional<decltype(bring())> here;
    part_bounds<T> part_a, part_b;
    parts_of_set<T> parts_a, parts_b, looking;
    parcel_room<sizes_of_shapes<typename shape_of_second<X, Y>::type>> room;
    attempt([&] {
        parts_a.make_room(ranks.size());
        parts_b.make_room(ranks.size());
        looking.make_room(ranks.size());
        room.make_room(ranks.size());
        here.emplace(bring());
        part_a = bounds_of_part(local, std::get<2>(*here).shapes());
        part_b = is_alone ? part_a : bounds_of_part(local, std::get<3>(*here).shapes());
    });
    attempt.settle(ranks);
    const auto& a = std::get<0>(*here);
    const auto& b = std::get<1>(*here);
    const auto& operand_b = std::get<3>(*here);
    parts_a.gather(ranks, part_a);
    parts_b.gather(ranks, part_b);
    const std::uint64_t first_a = parts_a.first_of(ranks.rank());

    attempt([&] { ask(ranks.rank(), a, b, global_ids{first_a, parts_b.first_of(ranks.rank()), nullptr}); });
    std::optional<decltype(looked_in(local, a, std::type_identity<Y>{}))> looks;
    const auto use = [&](int rank, const auto& came, const std::uint32_t* ids) {
        if (!looks) looks.emplace(looked_in(local, a, std::type_identity<Y>{}));
        ask(rank, *looks, came, global_ids{first_a, parts_b.first_of(rank), ids});
    };
    share();
    looking.take_grown(parts_a, reach);
    const auto goes = [&](int from, int to) { return (!is_alone || from > to) && looking[to].is_near(parts_b[from]); };
    using near_b = near_shapes<Local, std::remove_cvref_t<decltype(operand_b.shapes())>>;
    shape_parcels parcels(local, near_b(operand_b.shapes()), looking, use);
    exchange_parcels(on, attempt, room, goes, parcels);
    return parts_a;
}

/// The sum over all ranks.
inline std::uint64_t sum_of_ranks(const own_communicator& ranks, std::uint64_t mine) {
    std::uint64_t sum = 0;
    check_mpi(MPI_Allreduce(&mine, &sum, 1, MPI_UINT64_T, MPI_SUM, ranks.get()), "MPI_Allreduce");
    return sum;
}

/// What was found of all ranks. All of them call it.
template <class Local, class Global>
auto joined(const distributed<Local>& on, found_by_rank<Local, Global>& all, bool sorted, int bits) {
    attempts attempt;
    result<Global, space_of<Local>> found;
    attempt([&] { found = all.join(on.local(), sorted, bits); });
    attempt.settle(on.ranks());
    return found;
}

/// What ask(a, b, options) finds of all parts, in this rank's order.
template <class Global, class Local, class X, class Y, class Options, class Ask, class Reach = as_near_as_boxes>
auto found_in_all_parts(const distributed<Local>& on, const X& a, const Y& b, const Options& options, const char* function,
                        const Ask& ask, const Reach& reach = {}) {
    found_by_rank<Local, Global> all;
    const Local& local = on.local();
    const auto parts = ask_all_parts(
        on, a, b, function,
        [&](int rank, const auto& x, const auto& y, const global_ids& ids) {
            const auto found = ask(x, y, options_here(options, ids));
            using value = typename std::remove_cvref_t<decltype(found)>::value_type;
            all.add(local, rank, found.size(), [&](Global* out, std::uint64_t* keys) {
                for_each_index(local, found.size(), name_all_globally<value, Global>{found.data(), ids, out, keys});
            });
        },
        reach);
    return joined(on, all, options.sorted, id_bits(static_cast<std::size_t>(parts[on.rank()].size)));
}

// Queries of all parts, of a kind of pairs (collide/pair_kinds.hpp).

template <arithmetic A, class Local, class X, class Y, class Options, class Kind>
bool any_of_parts(const distributed<Local>& on, const X& a, const Y& b, const Options& options, const char* function,
                  const Kind& kind) {
    bool found = false;
    const auto ask = [&](int, const auto& x, const auto& y, const global_ids& ids) {
        if (found) return;
        const auto both = kind.pair_up(on.local(), x, y, options_here(options, ids), function);
        found = any_of<A>(on.local(), both, kind.template judge<A>());
    };
    ask_all_parts(on, a, b, function, ask, kind);
    return sum_of_ranks(on.ranks(), found ? 1 : 0) > 0;
}

template <arithmetic A, class Local, class X, class Y, class Options, class Kind>
std::uint64_t count_of_parts(const distributed<Local>& on, const X& a, const Y& b, const Options& options,
                             const char* function, const Kind& kind) {
    std::uint64_t found = 0;
    const auto ask = [&](int, const auto& x, const auto& y, const global_ids& ids) {
        const auto both = kind.pair_up(on.local(), x, y, options_here(options, ids), function);
        found += count_of<A>(on.local(), both, kind.template judge<A>());
    };
    ask_all_parts(on, a, b, function, ask, kind);
    return sum_of_ranks(on.ranks(), found);
}

template <arithmetic A, class Local, class X, class Y, class Options, class Kind>
auto pairs_of_parts(const distributed<Local>& on, const X& a, const Y& b, const Options& options, const char* function,
                    const Kind& kind) {
    const auto ask = [&](const auto& x, const auto& y, const auto& here) {
        return pairs_of<A>(on.local(), kind.pair_up(on.local(), x, y, here, function), kind.template names<A>());
    };
    return found_in_all_parts<global_pair>(on, a, b, options, function, ask, kind);
}

template <arithmetic A, class Local, class X, class Y, class Visitor, class Options, class Kind>
void visit_all_parts(const distributed<Local>& on, const X& a, const Y& b, const Visitor& visitor, const Options& options,
                     const char* function, const Kind& kind) {
    const Local& local = on.local();
    attempts attempt;
    execution::buffer_of<Local, std::uint32_t> stopped;
    attempt([&] {
        stopped = execution::buffer_of<Local, std::uint32_t>(local, 1);
        fill(local, stopped.data(), 1, std::uint32_t{0});
    });
    attempt.settle(on.ranks());
    const auto ask = [&](int, const auto& x, const auto& y, const global_ids& ids) {
        std::uint32_t has_stopped = 0;
        download(local, stopped.data(), 1, &has_stopped);
        if (has_stopped != 0) return;
        const visitor_by_whole_ids<Visitor, global_ids> visits{visitor, ids, stopped.data()};
        visit_pairs_of<A>(local, kind.pair_up(local, x, y, options_here(options, ids), function), visits,
                          kind.template judge<A>());
    };
    ask_all_parts(on, a, b, function, ask, kind);
}

/// Whether a visitor of ranks can be called.
template <class Local, class Visitor, class Pair = global_pair>
consteval bool is_global_visitor() {
    constexpr bool is = answers<Local, Visitor, visit, Pair>();
    static_assert(is,
                  "abut: a visitor of a distributed query is called as visitor(pair) const, and returns abut::visit::proceed "
                  "or abut::visit::stop; the pair is a global_pair, or a global_tagged_pair where the query is of a list");
    return is;
}

}  // namespace detail

/// @addtogroup distributed
///@{

/// Whether any shape of `a` touches any shape of `b`: the same answer on all ranks. Arguments are this rank's parts, as
/// those of `any` under the local policy; a filter is called with two std::uint64_t. A rank that has found a pair looks for
/// no other; the others learn of it at the end.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any(const distributed<Local>& on, const X& a, const Y& b,
                       const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_globally<Local, X, Y, Filter>()) {
        return detail::any_of_parts<A>(on, a, b, options, "abut::any", detail::pairs_that_touch{});
    } else {
        return false;
    }
}

/// Number of pairs that touch and that the filter wants, of all ranks: the same answer on each. As `any` otherwise.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count(const distributed<Local>& on, const X& a, const Y& b,
                                  const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_globally<Local, X, Y, Filter>()) {
        return detail::count_of_parts<A>(on, a, b, options, "abut::count", detail::pairs_that_touch{});
    } else {
        return 0;
    }
}

/// All pairs of this rank's a-shapes that touch, each once: a `result` of `global_pair`, 16 bytes each, in the local
/// policy's memory; sorted by a, then b, unless the options say otherwise. Then the lists of all ranks, one after another,
/// are the list of one machine. Arguments as of `any`.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto pairs(const distributed<Local>& on, const X& a, const Y& b,
                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_globally<Local, X, Y, Filter>()) {
        return detail::pairs_of_parts<A>(on, a, b, options, "abut::pairs", detail::pairs_that_touch{});
    } else {
        return result<global_pair, space_of<Local>>();
    }
}

/// Calls visitor(global_pair) -> visit once for every pair of this rank's a-shapes that touches, as `for_each_pair` under
/// the local policy does. `visit::stop` ends the visits of this rank; other ranks go on. Arguments as of `any`.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_pair(const distributed<Local>& on, const X& a, const Y& b, const Visitor& visitor,
                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair_globally<Local, X, Y, Filter>() && detail::is_global_visitor<Local, Visitor>()) {
        detail::visit_all_parts<A>(on, a, b, visitor, options, "abut::for_each_pair", detail::pairs_that_touch{});
    }
}

/// The contacts of all pairs of this rank's a-shapes that touch: a `result` of `global_contact`, 40 bytes each in float and
/// 72 in double, in the local policy's memory and in the order of `pairs`. The numbers are those of `contacts`, bit for bit.
/// Arguments as of `contacts`, and a filter as of `any`.
template <arithmetic A = filtered, execution_policy Local, class X, class Y, class Filter = keep_all>
[[nodiscard]] auto contacts(const distributed<Local>& on, const X& a, const Y& b,
                            const contact_options<Filter>& options = {}) {
    if constexpr (detail::can_pair_globally<Local, X, Y, Filter>() && detail::can_touch<Local, X, Y, keep_all>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<X>::type>;
        return detail::found_in_all_parts<global_contact<T>>(
            on, a, b, options, "abut::contacts",
            [&](const auto& x, const auto& y, const auto& here) { return contacts<A>(on.local(), x, y, here); });
    } else {
        return result<global_contact<float>, space_of<Local>>();
    }
}

/// All pairs of shapes of one set that touch, each once with a < b, of which a is this rank's: a `result` of `global_pair`,
/// 16 bytes each, in the local policy's memory; sorted by a, then b, unless the options say otherwise. The lists of all
/// ranks, one after another, are the list of `self_pairs` on one machine. `x` is this rank's part, as the argument of
/// `self_pairs` under the local policy; a filter is called with two std::uint64_t, a < b.
///
/// The mesh that is asked about is all parts one after another, each of which has vertices of its own. So neighbours on two
/// ranks share none, and are reported, where vertices are `distinct`; where they are `merged`, neighbours share those in one
/// place, and parts of a mesh give the list of the whole mesh. A face goes to the ranks below its own whose faces it comes
/// near.
template <arithmetic A = filtered, execution_policy Local, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] auto self_pairs(const distributed<Local>& on, const X& x,
                              const self_options<Filter, Traversal>& options = {}) {
    if constexpr (detail::can_pair_itself_globally<Local, X, Filter>()) {
        return detail::pairs_of_parts<A>(on, x, detail::itself{}, detail::as_query_options(options), "abut::self_pairs",
                                         detail::pairs_beyond_shared(options.coincident));
    } else {
        return result<global_pair, space_of<Local>>();
    }
}

/// The number of pairs that self_pairs of all ranks reports: the same on each. Stores none of them.
template <arithmetic A = filtered, execution_policy Local, class X, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] std::uint64_t count_self_pairs(const distributed<Local>& on, const X& x,
                                             const self_options<Filter, Traversal>& options = {}) {
    if constexpr (detail::can_pair_itself_globally<Local, X, Filter>()) {
        return detail::count_of_parts<A>(on, x, detail::itself{}, detail::as_query_options(options),
                                         "abut::count_self_pairs", detail::pairs_beyond_shared(options.coincident));
    } else {
        return 0;
    }
}

///@}

}  // namespace abut
