// SPDX-License-Identifier: MIT
#pragma once

// Ranks as those who answer questions about pairs (collide/question.hpp): any, count, pairs, for_each_pair, contacts, within
// and the others, of sets whose parts lie on many ranks, and of lists. The shapes of b come to the ranks whose a-shapes they
// come near (parts.hpp), and each rank asks its local policy: of its own parts first, and then of what came from each other
// rank. Of a list each rank has some of the entries, with the indices of both sides, and asks about these; no shapes are sent.
// Bodies are not for ranks: each two of them may meet, and indices are not sent. Lists of those that may meet are.

#include <algorithm>
#include <array>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/collide/question.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/index/bvh.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/shape/crossing.hpp>

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

/// A `crossing` with ids in sets of many parts. Vertices have no numbers there: what a corner lies in is told by the faces.
template <scalar T>
struct global_crossing {
    std::uint64_t a;         ///< id of the first face; in `self_crossings` the lower one
    std::uint64_t b;         ///< id of the second one
    unsigned char count;     ///< as of crossing
    unsigned char coplanar;  ///< as of crossing
    unsigned char in_a[6];   ///< as of crossing
    unsigned char in_b[6];   ///< as of crossing
    vec3<T> points[6];       ///< as of crossing

    friend constexpr bool operator==(const global_crossing&, const global_crossing&) = default;
};

/// A `tagged_crossing` of a list of many parts.
template <scalar T>
struct global_tagged_crossing {
    std::uint64_t pair;  ///< position in the list of all ranks
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one
    crossing<T> common;  ///< what they have in common

    friend constexpr bool operator==(const global_tagged_crossing&, const global_tagged_crossing&) = default;
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
    /// What was found here, with the ids of the whole sets.
    ///@{
    [[nodiscard]] ABUT_HD global_pair named(const index_pair& pair) const { return (*this)(pair.a, pair.b); }
    template <scalar T>
    [[nodiscard]] ABUT_HD global_contact<T> named(const contact<T>& c) const {
        const global_pair pair = (*this)(c.a, c.b);
        return {pair.a, pair.b, c.point, c.normal, c.depth};
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD global_crossing<T> named(const crossing<T>& c) const {
        const global_pair pair = (*this)(c.a, c.b);
        global_crossing<T> out{pair.a, pair.b, c.count, c.coplanar, {}, {}, {}};
        for (int i = 0; i < 6; ++i) {
            out.in_a[i] = c.in_a[i];
            out.in_b[i] = c.in_b[i];
            out.points[i] = c.points[i];
        }
        return out;
    }
    ///@}
    template <class Visitor>
    auto visitor(const Visitor& v, std::uint32_t* stopped) const {
        return visitor_by_whole_ids<Visitor, global_ids>{v, *this, stopped};
    }
};

/// By what results are sorted that come from different ranks: the a-shape. Results of one rank are in order.
template <class Found>
ABUT_HD std::uint64_t key_of_first(const Found& found) {
    return found.a;
}
template <class Found, class Names, class Global>
struct name_all_globally {
    const Found* found;
    Names names;
    Global* out;
    std::uint64_t* keys;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = names.named(found[i]);
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

/// Whether a query of ranks takes its filter, and its arguments.
template <class Local, class Filter>
consteval bool is_global_filter() {
    constexpr bool is = std::same_as<Filter, keep_all> || answers<Local, Filter, bool, std::uint64_t, std::uint64_t>();
    static_assert(is,
                  "abut: a filter of a distributed query is called as filter(a, b) const with two std::uint64_t, and "
                  "returns bool");
    return is;
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

/// The shape of a query's second argument; of the first one where it is asked about alone.
template <class X, class Y>
struct shape_of_second : shape_of_argument<Y> {};
template <class X>
struct shape_of_second<X, itself> : shape_of_argument<X> {};

struct share_nothing {
    void operator()() const {}
};

/// Runs ask(rank, a, b, ids), of operands, of a rank's own parts, and then of what comes from each other rank: all pairs of its
/// a-shapes with b-shapes that they may touch, each once. Where y is `itself`, these are pairs of shapes of x: of its own part
/// a rank asks by `itself`, and others come from the ranks above it alone, where all ids are greater. Where pairs are wanted
/// that do not touch, reach(bounds) is what comes near enough to a part of a: the same on all ranks, which call share() first,
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
    const auto bring_b = [&]([[maybe_unused]] const auto& a) {
        if constexpr (is_alone) {
            return a;
        } else {
            return make_operand(local, y, function);
        }
    };
    using operand_a = decltype(make_operand(local, x, function));
    std::optional<operand_a> a;
    std::optional<decltype(bring_b(std::declval<const operand_a&>()))> b;
    part_bounds<T> part_a, part_b;
    parts_of_set<T> parts_a, parts_b, looking;
    parcel_room<sizes_of_shapes<typename shape_of_second<X, Y>::type>> room;
    attempt([&] {
        parts_a.make_room(ranks.size());
        parts_b.make_room(ranks.size());
        looking.make_room(ranks.size());
        room.make_room(ranks.size());
        a.emplace(make_operand(local, x, function));
        b.emplace(bring_b(*a));
        part_a = bounds_of_part(local, a->shapes());
        part_b = is_alone ? part_a : bounds_of_part(local, b->shapes());
    });
    attempt.settle(ranks);
    parts_a.gather(ranks, part_a);
    parts_b.gather(ranks, part_b);
    const std::uint64_t first_a = parts_a.first_of(ranks.rank());

    attempt([&] {
        const global_ids ids{first_a, parts_b.first_of(ranks.rank()), nullptr};
        if constexpr (is_alone) {
            ask(ranks.rank(), *a, y, ids);
        } else {
            ask(ranks.rank(), *a, *b, ids);
        }
    });
    const auto look_in = [&] { return make_operand(local, looked_in(local, x, std::type_identity<Y>{}), function); };
    std::optional<decltype(look_in())> looks;
    const auto use = [&](int rank, const auto& came, const std::uint32_t* ids) {
        if (!looks) looks.emplace(look_in());
        ask(rank, *looks, came, global_ids{first_a, parts_b.first_of(rank), ids});
    };
    share();
    looking.take_grown(parts_a, reach);
    const auto goes = [&](int from, int to) { return (!is_alone || from > to) && looking[to].is_near(parts_b[from]); };
    using near_b = near_shapes<Local, std::remove_cvref_t<decltype(b->shapes())>>;
    shape_parcels parcels(local, near_b(b->shapes()), looking, use);
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

/// Positions of a rank's entries in the list of all ranks.
struct entries_of_rank {
    std::uint64_t first;
    [[nodiscard]] std::uint64_t operator()(std::size_t i) const { return first + i; }
    [[nodiscard]] ABUT_HD global_tagged_pair named(const tagged_pair& of) const { return {first + of.pair, of.a, of.b}; }
    template <class Visitor>
    auto visitor(const Visitor& v, std::uint32_t*) const {
        return call_of_part<Visitor, entries_of_rank>{v, *this};
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD global_tagged_contact<T> named(const tagged_contact<T>& of) const {
        return {first + of.pair, of.a, of.b, of.point, of.normal, of.depth};
    }
    template <scalar T>
    [[nodiscard]] ABUT_HD global_tagged_crossing<T> named(const tagged_crossing<T>& of) const {
        return {first + of.pair, of.a, of.b, of.common};
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

// What ranks make of a form: ask_shares(on, relation, form, options, function, ask) runs ask(rank, pairing, names) of all that
// is this rank's, and returns how many a-shapes it has; and agree(on, relation, function) finds what is wrong with its numbers
// before any asks. can_ask_pairs says whether ranks take the question.

template <class Local, class Relation>
void agree(const distributed<Local>& on, const Relation& how, const char* function) {
    if constexpr (requires { how.agreed(); }) {
        attempts attempt;
        attempt([&] { how.check(function); });
        attempt.settle(on.ranks());
        require_one(on.ranks(), how.agreed(), function, "distances");
    }
}
template <class Local, class Relation, class X, class Y, class Options, class Ask>
std::size_t ask_parts(const distributed<Local>& on, const Relation& how, const X& x, const Y& y, const Options& options,
                      const char* function, const Ask& ask) {
    using T = scalar_of_argument<X>;
    const Local& local = on.local();
    agree(on, how, function);
    const auto near = how.template nearness<T>();
    const auto parts = ask_all_parts(
        on, x, y, function,
        [&](int rank, const auto& a, const auto& b, const global_ids& ids) {
            using second = std::remove_cvref_t<decltype(b)>;
            const auto here = with_filter(options, filter_here(options.filter, ids));
            if constexpr (std::same_as<second, itself>) {
                ask(rank, pair_up_self(local, a, here, function, how.sight(), near), ids);
            } else if constexpr (std::same_as<Y, itself>) {
                ask(rank, pair_up_with_others(local, a, b, how, here, function), ids);
            } else {
                ask(rank, pair_up(local, a, b, here, function, near), ids);
            }
        },
        [&](const auto& bounds) { return grown(bounds, near); });
    return static_cast<std::size_t>(parts[on.rank()].size);
}
template <class Local, class Relation, class X, class Y, class Options, class Ask>
std::size_t ask_shares(const distributed<Local>& on, const Relation& how, const two<X, Y>& both, const Options& options,
                       const char* function, const Ask& ask) {
    return ask_parts(on, how, both.a, both.b, options, function, ask);
}
template <class Local, class Relation, class X, class Options, class Ask>
std::size_t ask_shares(const distributed<Local>& on, const Relation& how, const alone<X>& one, const Options& options,
                       const char* function, const Ask& ask) {
    return ask_parts(on, how, one.x, itself{}, options, function, ask);
}
template <class Local, class Relation, class A, class B, class Options, class Ask>
std::size_t ask_shares(const distributed<Local>& on, const Relation& how, const form_of_list<A, B>& all,
                       const Options& options, const char* function, const Ask& ask) {
    ask_own_entries(on, all.list, [&](const entries_of_rank& position) {
        how.check(function);
        const auto here = options_of_part(options, position);
        ask(on.rank(), all.pair_up(on.local(), how, here, false, function, position), position);
    });
    return all.list.size();
}

template <class Local, class Question, class Form, class Options>
consteval bool can_ask_pairs() {
    if constexpr (!refuse_bodies<std::same_as<typename Form::pair_type, body_pair>>()) {
        return false;
    } else if constexpr (!Form::template can_be_asked<Local, Question, keep_all>()) {
        return false;
    } else if constexpr (std::same_as<typename Form::pair_type, index_pair>) {
        return is_global_filter<Local, decltype(Options::filter)>();
    } else {
        return true;
    }
}
/// What ranks call a pair.
template <class Pair>
struct global_of;
template <>
struct global_of<index_pair> : std::type_identity<global_pair> {};
template <>
struct global_of<tagged_pair> : std::type_identity<global_tagged_pair> {};
template <scalar T>
struct global_of<contact<T>> : std::type_identity<global_contact<T>> {};
template <scalar T>
struct global_of<tagged_contact<T>> : std::type_identity<global_tagged_contact<T>> {};
template <scalar T>
struct global_of<crossing<T>> : std::type_identity<global_crossing<T>> {};
template <scalar T>
struct global_of<tagged_crossing<T>> : std::type_identity<global_tagged_crossing<T>> {};

template <execution_policy Local, class Question, class Form, class Options>
auto ask_pairs(const distributed<Local>& on, const Question& question, const Form& form, const Options& options,
               const char* function) {
    using answer = typename Question::answer_type;
    const Local& local = on.local();
    if constexpr (!can_ask_pairs<Local, Question, Form, Options>()) {
        return answer::template nothing<Form, Local>();
    } else if constexpr (Question::kind == answer_kind::list) {
        using found_type = typename answer::template found_type<Form, typename scalar_of_form<Form>::type>;
        using global = typename global_of<found_type>::type;
        found_by_rank<Local, global> all;
        const std::size_t shapes = ask_shares(
            on, question.relation, form, options, function, [&](int rank, const auto& pairing, const auto& names) {
                const auto found = question.find(local, pairing);
                using names_type = std::remove_cvref_t<decltype(names)>;
                all.add(local, rank, found.size(), [&](global* out, std::uint64_t* keys) {
                    for_each_index(local, found.size(), name_all_globally<found_type, names_type, global>{
                                                            found.data(), names, out, keys});
                });
            });
        return joined(on, all, options.sorted, id_bits(shapes));
    } else if constexpr (Question::kind == answer_kind::total) {
        std::uint64_t sum = 0;
        ask_shares(on, question.relation, form, options, function, [&](int, const auto& pairing, const auto&) {
            if (std::same_as<answer, whether> && sum > 0) return;
            sum += question.find(local, pairing);
        });
        return static_cast<decltype(answer::template nothing<Form, Local>())>(sum_of_ranks(on.ranks(), sum));
    } else {
        using visitor = std::remove_cvref_t<decltype(question.answer.visitor)>;
        if constexpr (is_global_visitor<Local, visitor, typename global_of<typename Form::pair_type>::type>()) {
            attempts attempt;
            execution::buffer_of<Local, std::uint32_t> stopped;
            attempt([&] {
                stopped = execution::buffer_of<Local, std::uint32_t>(local, 1);
                fill(local, stopped.data(), 1, std::uint32_t{0});
            });
            attempt.settle(on.ranks());
            ask_shares(on, question.relation, form, options, function, [&](int, const auto& pairing, const auto& names) {
                std::uint32_t has_stopped = 0;
                download(local, stopped.data(), 1, &has_stopped);
                if (has_stopped != 0) return;
                const auto each = names.visitor(question.answer.visitor, stopped.data());
                ask_for<typename Question::arithmetic_type>(question.relation, visited_by(each)).find(local, pairing);
            });
        }
    }
}

/// What is said of each of the rank's own entries.
template <execution_policy Local, class Each, class Form, class Options>
auto ask_entries(const distributed<Local>& on, const Each& each, const Form& form, const Options& options,
                 const char* function) {
    result<typename Each::template found_type<Form>, space_of<Local>> found;
    if constexpr (Each::template can_be_asked<Local, Form>()) {
        ask_own_entries(on, form.list, [&](const entries_of_rank& position) {
            if constexpr (names_filter<Options>) {
                found = each.find(on.local(), form, options_of_part(options, position), function, position);
            } else {
                found = each.find(on.local(), form, options, function, position);
            }
        });
    }
    return found;
}

}  // namespace detail

}  // namespace abut
