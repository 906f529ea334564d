// SPDX-License-Identifier: MIT
#pragma once

// Who pairs up: two operands, the numbers by which their pairs go, and the way to the pairs that come near each other. The
// roles are dealt out here and nowhere else: two trees are walked together, the shapes of one operand look in the index of
// the other, and two plain sets are compared all with all, in tiles.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/collide/judge.hpp>
#include <abut/collide/nearness.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/traverse/even_nodes.hpp>
#include <abut/traverse/front.hpp>
#include <abut/traverse/frontier.hpp>
#include <abut/traverse/pair_walk.hpp>
#include <abut/shape/reach.hpp>
#include <abut/traverse/rule_walk.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

/// Number of bits that ids below n need.
constexpr int id_bits(std::size_t n) { return bits_up_to(n > 0 ? n - 1 : 0); }

/// A pair travels as one number, a's id above b's, in as few bits as the sets need: sorting is then a short radix sort.
struct pair_key {
    int a_bits, b_bits;

    [[nodiscard]] int bits() const { return a_bits + b_bits; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t a, std::uint32_t b) const {
        return std::uint64_t{a} << b_bits | b;
    }
    [[nodiscard]] ABUT_HD std::uint32_t a(std::uint64_t key) const { return static_cast<std::uint32_t>(key >> b_bits); }
    [[nodiscard]] ABUT_HD std::uint32_t b(std::uint64_t key) const {
        return static_cast<std::uint32_t>(key & ((std::uint64_t{1} << b_bits) - 1));
    }
    [[nodiscard]] ABUT_HD index_pair unpack(std::uint64_t key) const { return {a(key), b(key)}; }
};

/// A set of one shape.
template <class View>
inline constexpr bool is_single = false;
template <class Shape, memory_space Space>
inline constexpr bool is_single<single_view<Shape, Space>> = true;

/// What a kernel sees of a pairing: the shapes of both operands by the key of a pair, and which pairs are wanted.
template <shape_view A, shape_view B, class Filter>
struct pair_view {
    using shape_type_a = typename A::shape_type;
    using shape_type_b = typename B::shape_type;
    A a;
    B b;
    pair_key key;
    Filter filter;

    [[nodiscard]] ABUT_HD shape_type_a shape_a(std::uint64_t k) const { return a[key.a(k)]; }
    [[nodiscard]] ABUT_HD shape_type_b shape_b(std::uint64_t k) const { return b[key.b(k)]; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t id_a, std::uint32_t id_b) const { return key.pack(id_a, id_b); }
    [[nodiscard]] ABUT_HD index_pair ids(std::uint64_t k) const { return key.unpack(k); }
    /// The same of a contact.
    template <class Contact>
    [[nodiscard]] ABUT_HD Contact tagged(std::uint64_t k, Contact c) const {
        c.a = key.a(k);
        c.b = key.b(k);
        return c;
    }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t id_a, std::uint32_t id_b) const { return filter(id_a, id_b); }
    ABUT_INLINE void prefetch(std::uint64_t k, int step) const {
        prefetch_shape(a, key.a(k), step);
        prefetch_shape(b, key.b(k), step);
    }
};

// The ways to candidates, as the verbs of a policy take them (execution/policy.hpp). `Ids` packs two ids into a key and says
// whether the pair is wanted; `RowsAreB` says whose shapes look.

template <bool RowsAreB, class Ids>
ABUT_HD std::uint64_t pack_row(const Ids& ids, std::uint32_t row, std::uint32_t found) {
    return RowsAreB ? ids.pack(found, row) : ids.pack(row, found);
}
ABUT_CALLS_ANY
template <bool RowsAreB, class Ids>
ABUT_HD bool is_wanted_by_row(const Ids& ids, std::uint32_t row, std::uint32_t found) {
    return RowsAreB ? ids.wanted(found, row) : ids.wanted(row, found);
}

/// Each shape of one operand looks in the index of the other.
template <bool RowsAreB, class Walk, class Rows, class Ids, class Nearness>
struct look_up {
    using candidate = std::uint64_t;
    using cursor = typename Walk::cursor;
    Walk walk;
    Rows rows;
    Ids ids;
    Nearness near;

    /// Whether row i may find anything at all.
    [[nodiscard]] ABUT_HD bool may_find(std::size_t i) const {
        auto reach = near.reach(rows[i]);
        return walk.may_touch(reach);
    }
    /// Hands on what row i finds from `at` on. True if there may be more, for which the emitter has no room.
    ABUT_CALLS_ANY
    template <class Emitter, class... Sinks>
    ABUT_HD bool operator()(std::size_t i, cursor& at, const Emitter& emitter, Sinks&... sinks) const {
        const auto row = static_cast<std::uint32_t>(i);
        auto reach = near.reach(rows[i]);
        return walk.for_each(
            reach, at, [&] { return emitter.is_full(); },
            [&](std::uint32_t found) {
                if (is_wanted_by_row<RowsAreB>(ids, row, found)) emitter.push(pack_row<RowsAreB>(ids, row, found));
                return execution::is_over(sinks...) ? visit::stop : visit::proceed;
            });
    }
};

// What of the work a search does. Each candidate falls to one part.

/// All of it.
struct whole_search {};
/// What falls to one of some parts. Rows and pairs of nodes are dealt out by a hash of their numbers: neighbours, which have
/// as much to do, fall to different parts.
struct search_part {
    static constexpr std::size_t rows_together = 256;  ///< so that threads that run together all have work or none
    std::uint32_t part = 0, parts = 1;

    [[nodiscard]] ABUT_HD bool has(std::uint64_t item) const {
        // By the highest bits of the product, in which all bits of the item have a say.
        return parts == 1 || (item * 0x9e3779b97f4a7c15u >> 32) * parts >> 32 == part;
    }
    /// The first of n rows that are shared out as they lie, four at a time, so that parts are aligned as the whole is.
    [[nodiscard]] std::size_t first_of(std::size_t n) const {
        if (part == parts) return n;
        return (n / parts * part + std::min<std::size_t>(n % parts, part)) / 4 * 4;
    }
};

/// The rows of a part look.
template <class LookUp>
struct look_up_of_part : LookUp {
    search_part mine;
    [[nodiscard]] ABUT_HD bool may_find(std::size_t i) const {
        return mine.has(i / search_part::rows_together) && LookUp::may_find(i);
    }
};

/// A step down two trees, from the seeds of a part.
template <class Step>
struct step_of_part : Step {
    using item = typename Step::item;
    search_part mine;
    step_of_part(const Step& step, const search_part& part) : Step(step), mine(part) {}
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        if (mine.has(i)) return Step::seed(i);
        item nothing{};
        nothing.a = nothing.b = Step::nowhere;
        return nothing;
    }
};

/// The same, or where nodes are given, from all pairs of these (traverse/even_nodes.hpp); of one tree with itself from each
/// pair once. They come in any order, so a pair falls to a part by its nodes.
template <class Step>
struct step_of_nodes : step_of_part<Step> {
    using item = typename Step::item;
    static constexpr bool is_of_one_tree = requires(const Step& step) { step.walk.tree(); };
    const std::uint32_t *nodes_a = nullptr, *nodes_b = nullptr;
    std::size_t count_a = 0, count_b = 0;

    using step_of_part<Step>::step_of_part;
    template <class Policy>
    void begin_at(const cut_trees<Policy>& nodes) {
        const auto& b = is_of_one_tree ? nodes.a : nodes.b;
        if (nodes.a.size() * b.size() > most_even_pairs) return;
        nodes_a = nodes.a.data();
        nodes_b = b.data();
        count_a = nodes.a.size();
        count_b = b.size();
    }
    [[nodiscard]] std::size_t seeds() const { return nodes_a == nullptr ? Step::seeds() : count_a * count_b; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        if (nodes_a == nullptr) return step_of_part<Step>::seed(i);
        item at{};
        at.a = nodes_a[i / count_b];
        at.b = nodes_b[i % count_b];
        const bool once = !is_of_one_tree || at.a <= at.b;
        if (!once || !this->mine.has(std::uint64_t{at.a} << 32 | at.b)) at.a = at.b = Step::nowhere;
        return at;
    }
};

/// All shapes of one operand against all of the other.
template <bool RowsAreB, class Rows, class Columns, class Ids, class Nearness, class Judge>
struct all_with_all {
    using candidate = std::uint64_t;
    using row = typename Rows::shape_type;
    using reach = decltype(std::declval<const Nearness&>().reach(row{}));
    struct column {
        typename Columns::shape_type shape;
        decltype(bounds(typename Columns::shape_type{})) box;
    };
    Rows rows;
    Columns columns;
    Ids ids;
    Nearness near;
    Judge judge;

    [[nodiscard]] const row* rows_in_memory() const { return shapes_in_memory(rows); }
    [[nodiscard]] ABUT_HD row load_row(std::size_t i) const { return rows[i]; }
    [[nodiscard]] ABUT_HD reach reach_of(const row& r) const { return near.reach(r); }
    [[nodiscard]] ABUT_HD column load_column(std::size_t j) const {
        const auto shape = columns[j];
        return {shape, bounds(shape)};
    }
    [[nodiscard]] ABUT_HD bool passes(const reach& r, const column& c) const { return r(c.box); }
    [[nodiscard]] ABUT_HD std::uint64_t candidate_of(std::size_t i, std::size_t j) const {
        return pack_row<RowsAreB>(ids, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD bool operator()(const row& r, std::size_t i, const column& c, std::size_t j, Hits& hits, auto&...) const {
        if (!is_wanted_by_row<RowsAreB>(ids, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j))) return true;
        if constexpr (RowsAreB) {
            return judge.decide(candidate_of(i, j), c.shape, r, hits);
        } else {
            return judge.decide(candidate_of(i, j), r, c.shape, hits);
        }
    }
    ABUT_CALLS_ANY
    template <class... Sinks>
    ABUT_HD void finish(std::uint64_t key, Sinks&... sinks) const {
        judge.finish(key, sinks...);
    }
};

/// The rows from `first` on.
template <class Tile>
struct tile_from : Tile {
    using row = typename Tile::row;
    using column = typename Tile::column;
    std::size_t first;

    [[nodiscard]] const row* rows_in_memory() const {
        const row* const all = Tile::rows_in_memory();
        return all == nullptr ? all : all + first;
    }
    [[nodiscard]] ABUT_HD row load_row(std::size_t i) const { return Tile::load_row(first + i); }
    [[nodiscard]] ABUT_HD std::uint64_t candidate_of(std::size_t i, std::size_t j) const {
        return Tile::candidate_of(first + i, j);
    }
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD bool operator()(const row& r, std::size_t i, const column& c, std::size_t j, Hits& hits, auto&... sinks) const {
        return Tile::operator()(r, first + i, c, j, hits, sinks...);
    }
};

/// Judges what the rows find.
template <bool RowsAreB, class Policy, class Walk, class Rows, class Ids, class Run, class Nearness = near_enough_to_touch,
          class Part = whole_search>
void look(const Policy& on, const Walk& walk, const Rows& rows, const Ids& ids, const Run& run, const Nearness& near = {},
          const Part& part = {}) {
    const look_up<RowsAreB, Walk, Rows, Ids, Nearness> all{walk, rows, ids, near};
    const auto judge_all = [&](const auto& each) {
        run([&](const auto& judge, auto&... sinks) { return for_each_candidate(on, rows.size(), each, judge, sinks...); });
    };
    if constexpr (std::same_as<Part, whole_search>) {
        judge_all(all);
    } else {
        judge_all(look_up_of_part<std::remove_const_t<decltype(all)>>{all, part});
    }
}

/// Judges all pairs of a row and a column, in tiles.
template <bool RowsAreB, class Policy, class Rows, class Columns, class Ids, class Run,
          class Nearness = near_enough_to_touch, class Part = whole_search>
void compare(const Policy& on, const Rows& rows, const Columns& columns, const Ids& ids, const Run& run,
             const Nearness& near = {}, const Part& part = {}) {
    run([&](const auto& judge, auto&... sinks) {
        using judge_type = std::remove_cvref_t<decltype(judge)>;
        const all_with_all<RowsAreB, Rows, Columns, Ids, Nearness, judge_type> tile{rows, columns, ids, near, judge};
        if constexpr (std::same_as<Part, whole_search>) {
            return for_each_tiled(on, rows.size(), columns.size(), tile, sinks...);
        } else {
            const std::size_t first = part.first_of(rows.size());
            const std::size_t last = search_part{part.part + 1, part.parts}.first_of(rows.size());
            const tile_from<std::remove_const_t<decltype(tile)>> mine{tile, first};
            return for_each_tiled(on, last - first, columns.size(), mine, sinks...);
        }
    });
}

// What a walk of two trees finds, handed to a policy's emitter. No lambdas: nvcc would warn of emitters of the host.

template <class Emitter>
struct add_item {
    Emitter& emitter;
    ABUT_CALLS_ANY
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Item& next) const {
        emitter.add(k, is, next);
    }
};
template <bool RowsAreB, class Emitter, class Ids>
struct push_pair {
    Emitter& emitter;
    const Ids& ids;
    ABUT_CALLS_ANY
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, std::uint32_t row, std::uint32_t found) const {
        emitter.push(k, is && is_wanted_by_row<RowsAreB>(ids, row, found), pack_row<RowsAreB>(ids, row, found));
    }
};

/// Pairs by their ids, with a filter that is asked of subtrees. Of a user's filter members of these names say nothing.
template <class Ids>
concept asked_of_subtrees = requires(const Ids& ids) {
    { ids.filter.least_a } -> std::same_as<const std::uint32_t* const* const&>;
    { ids.filter.least_b } -> std::same_as<const std::uint32_t* const* const&>;
};

/// One step down two trees, of which the rows' is the walk's first.
///
/// A filter may leave out, with a pair, all pairs in which neither id is less. Such a one is asked of subtrees as well, by
/// their least ids: its `least_a[0]` and `least_b[0]` say these of each node of the trees (index/least_ids.hpp). Both tables
/// may be null.
template <bool RowsAreB, class Walk, class Ids>
struct expand_pair {
    using item = typename Walk::item;
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = Walk::most_children, most_depth = Walk::most_depth;
    Walk walk;
    Ids ids;

    [[nodiscard]] std::size_t seeds() const { return walk.seeds(); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return walk.seed(i); }
    ABUT_INLINE void prefetch(const item& at) const { walk.prefetch(at); }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        if (!may_be_wanted(at)) return;
        walk.expand(at, add_item<sink>{emitter}, push_pair<RowsAreB, sink, Ids>{emitter, ids});
    }

private:
    [[nodiscard]] ABUT_INLINE ABUT_HD bool may_be_wanted([[maybe_unused]] const item& at) const {
        if constexpr (asked_of_subtrees<Ids>) {
            if (ids.filter.least_a == nullptr) return true;
            const std::uint32_t* const of_rows = (RowsAreB ? ids.filter.least_b : ids.filter.least_a)[0];
            const std::uint32_t* const of_others = (RowsAreB ? ids.filter.least_a : ids.filter.least_b)[0];
            return is_wanted_by_row<RowsAreB>(ids, least_id_below(walk.a, at.a, of_rows),
                                              least_id_below(walk.b, at.b, of_others));
        } else {
            return true;
        }
    }
};

/// Whether the numbers of an operand's nodes tell how many shapes are below them.
template <class Operand>
bool is_along_curve(const Operand& x) {
    if constexpr (requires { x.is_along_curve(); }) {
        return x.is_along_curve();
    } else {
        return false;
    }
}

/// Judges what a walk down the trees of two operands finds, which may be one.
template <class Policy, class A, class B, class Expand, class Filter, traversal Traversal, schedule Schedule, class Run,
          class Part = whole_search>
void descend(const Policy& on, const A& a, const B& b, const Expand& expand,
             const query_options<Filter, Traversal, Schedule>& options, const Run& run, const Part& part = {}) {
    if constexpr (!std::same_as<Part, whole_search>) {
        static_assert(Traversal == traversal::both_at_once, "abut: parts of a search are walked both_at_once");
        // Deep enough that the hash deals out pairs of nodes evenly.
        const int depth = Schedule == schedule::shared_list || part.parts > 1
                              ? std::clamp(options.start_depth, 8, most_start_depth)
                              : options.start_depth;
        step_of_nodes<begin_below<Expand>> mine(begin_below<Expand>(expand, depth), part);
        cut_trees<Policy> nodes;
        if (part.parts > 1 && is_along_curve(a) && is_along_curve(b)) {
            nodes = cut_both_evenly(on, expand.walk);
            mine.begin_at(nodes);
        }
        const execution::scheduled<Schedule> how{options.scheduling};
        run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, mine, judge, sinks...); });
    } else if constexpr (Traversal == traversal::breadth_first) {
        for_each_on_levels(on, expand, options.start_depth, run);
    } else {
        const execution::scheduled<Schedule> how{options.scheduling};
        if constexpr (Traversal == traversal::from_front && has_topology<A> && has_topology<B>) {
            from_front::walk(*options.front, on, how, expand, a.shape_of_tree(), b.shape_of_tree(), run);
        } else {
            const auto from = [&](const auto& step) {
                run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, step, judge, sinks...); });
            };
            if constexpr (Schedule != schedule::shared_list && Traversal == traversal::both_at_once &&
                          !host_policy<Policy>) {
                from(begin_below<Expand>(expand, options.start_depth));
            } else {
                from(expand);
            }
        }
    }
}

/// The walk of two trees for a traversal.
template <traversal Traversal, class A, class B, class Overlap>
using chosen_walk = typename std::conditional_t<
    Traversal == traversal::both_at_once || Traversal == traversal::breadth_first || Traversal == traversal::from_front,
    std::type_identity<pair_walk<A, B, Overlap>>, std::type_identity<rule_walk<A, B, Overlap, Traversal>>>::type;

/// Two operands that are asked about their pairs.
template <operand A, operand B, class Filter, traversal Traversal, schedule Schedule, class Nearness = near_enough_to_touch,
          class Part = whole_search>
struct pairing {
    A a;
    B b;
    pair_key key;
    query_options<Filter, Traversal, Schedule> options;
    Nearness near = {};
    Part part = {};

    using view_a = decltype(std::declval<const A&>().shapes());
    using view_b = decltype(std::declval<const B&>().shapes());
    using view_type = pair_view<view_a, view_b, Filter>;

    [[nodiscard]] view_type view() const { return {a.shapes(), b.shapes(), key, options.filter}; }
    /// Room that results are likely to need.
    [[nodiscard]] std::size_t likely_hits() const {
        return std::max({a.shapes().size() / 4, b.shapes().size() / 4, std::size_t{1} << 16});
    }

    /// Judges all pairs that come near each other, by loops that `run` runs (judged_loops in search.hpp).
    template <class Policy, class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        const view_type both = view();
        if (both.a.size() == 0 || both.b.size() == 0) return;
        if constexpr (A::has_tree && B::has_tree) {
            const std::size_t least = std::min(both.a.size(), both.b.size()), most = std::max(both.a.size(), both.b.size());
            const auto walk = walk_of_both();
            using walk_type = std::remove_const_t<decltype(walk)>;
            if (least > 1 && most <= walk_type::most_shapes) {  // a leaf alone has no place (traverse/pair_walk.hpp)
                return descend(on, b, a, expand_pair<true, walk_type, view_type>{walk, both}, options, run, part);
            }
        }
        if constexpr (A::is_indexed) {
            look<true>(on, a.walk(), both.b, both, run, near, part);
        } else if constexpr (B::is_indexed) {
            look<false>(on, b.walk(), both.a, both, run, near, part);
        } else {
            compare_all(on, both, run);
        }
    }

private:
    /// As where a alone is indexed, b's shapes are the rows. Which tree is the first moves no answer, but what `any` meets
    /// first.
    auto walk_of_both() const {
        const auto rows = b.tree();
        const auto index = a.tree();
        const auto overlap = box_overlap(b, a, near);
        return chosen_walk<Traversal, std::remove_const_t<decltype(rows)>, std::remove_const_t<decltype(index)>,
                           std::remove_const_t<decltype(overlap)>>{rows, index, overlap};
    }

    /// Rows of tiles are what runs in parallel, so the larger set provides them; a single shape never does.
    template <class Policy, class Run>
    void compare_all(const Policy& on, const view_type& both, const Run& run) const {
        const auto rows_a = [&] { detail::compare<false>(on, both.a, both.b, both, run, near, part); };
        const auto rows_b = [&] { detail::compare<true>(on, both.b, both.a, both, run, near, part); };
        if constexpr (is_single<view_a>) {
            rows_b();
        } else if constexpr (is_single<view_b>) {
            rows_a();
        } else {
            const bool a_is_smaller = both.a.size() < both.b.size();
            const bool a_stays = options.resident == argument::automatic ? a_is_smaller : options.resident == argument::a;
            a_stays ? rows_b() : rows_a();
        }
    }
};

/// A part of what a pairing searches.
template <operand A, operand B, class Filter, traversal Traversal, schedule Schedule, class Nearness>
auto in_part(pairing<A, B, Filter, Traversal, Schedule, Nearness> all, const search_part& part) {
    return pairing<A, B, Filter, Traversal, Schedule, Nearness, search_part>{std::move(all.a), std::move(all.b), all.key,
                                                                             all.options,      all.near,         part};
}

/// What is checked before the arguments of a query are: its options.
template <class Policy, class Filter, traversal Traversal, schedule Schedule>
void check_options(const Policy& on, const query_options<Filter, Traversal, Schedule>& options, const char* function) {
    constexpr bool begins_at_depth = Traversal == traversal::breadth_first || Schedule != schedule::shared_list;
    if (begins_at_depth && (options.start_depth < 0 || options.start_depth > most_start_depth)) {
        throw error(std::string(function) + ": start_depth is " + std::to_string(options.start_depth) + ", not in 0.." +
                    std::to_string(most_start_depth));
    }
    if (Traversal == traversal::from_front && options.front == nullptr) {
        throw error(std::string(function) + ": a query from a front has none");
    }
    require_callable(on, options.filter, std::uint32_t{}, std::uint32_t{});
}

/// Refuses shapes whose functions are the host's, where the policy cannot call them.
template <class S, class U, class Policy>
void require_functions_of_shapes(const Policy& on) {
    if constexpr (decidable<S, U>) {  // or else a pairing says so
        require_callable(on, functions_of_shapes_have_to_be_marked_ABUT_HD<S, U>{}, static_cast<const S*>(nullptr),
                         static_cast<const U*>(nullptr));
    }
}

/// Whether a filter, or on the host a visitor, can be called as it is. What a device calls, require_callable looks at.
template <class Policy, class F, class Answer, class... Arguments>
consteval bool answers() {
    if constexpr (host_policy<Policy>) {
        return requires(const F& f, Arguments... arguments) {
            { f(arguments...) } -> std::convertible_to<Answer>;
        };
    } else {
        return true;
    }
}
template <class Policy, class Filter>
consteval bool is_filter() {
    constexpr bool is = answers<Policy, Filter, bool, std::uint32_t, std::uint32_t>();
    static_assert(is, "abut: a filter is called as filter(id in a, id in b) const, two std::uint32_t, and returns bool");
    return is;
}

/// Whether pair_up takes both arguments.
template <class Policy, class X, class Y>
consteval bool can_both_be_asked() {
    if constexpr (!can_be_asked<Policy, X>()) {
        return false;
    } else if constexpr (!can_be_asked<Policy, Y>()) {
        return false;
    } else {
        return have_one_scalar<X, Y>();
    }
}

/// Whether it takes them and the filter, and what touches can be decided.
template <class Policy, class X, class Y, class Filter>
consteval bool can_pair() {
    if constexpr (can_both_be_asked<Policy, X, Y>()) {
        constexpr bool is = decidable<typename shape_of_argument<X>::type, typename shape_of_argument<Y>::type>;
        static_assert(is, "abut: queries between sets of these two shapes are not supported");
        return is && is_filter<Policy, Filter>();
    } else {
        return false;
    }
}

/// Two operands, ready to be paired.
template <class Policy, operand A, operand B, class Filter, traversal Traversal, schedule Schedule,
          class Nearness = near_enough_to_touch>
auto pair_operands(const Policy& on, A a, B b, const query_options<Filter, Traversal, Schedule>& options,
                   const Nearness& near = {}) {
    using shape_a = typename decltype(a.shapes())::shape_type;
    using shape_b = typename decltype(b.shapes())::shape_type;
    const pair_key key{id_bits(a.shapes().size()), id_bits(b.shapes().size())};
    require_functions_of_shapes<shape_a, shape_b>(on);
    return pairing<A, B, Filter, Traversal, Schedule, Nearness>{std::move(a), std::move(b), key, options, near};
}

/// Both arguments of a query, ready to be paired; errors are thrown in the name of `function`.
template <input Input = input::checked, class Policy, class X, class Y, class Filter, traversal Traversal, schedule Schedule,
          class Nearness = near_enough_to_touch>
auto pair_up(const Policy& on, const X& x, const Y& y, const query_options<Filter, Traversal, Schedule>& options,
             const char* function, const Nearness& near = {}) {
    check_options(on, options, function);
    auto a = make_operand<Input>(on, x, function);
    auto b = make_operand<Input>(on, y, function);
    return pair_operands(on, std::move(a), std::move(b), options, near);
}

}  // namespace abut::detail
