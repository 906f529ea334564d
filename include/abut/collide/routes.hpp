// SPDX-License-Identifier: MIT
#pragma once

// The ways to candidates, as the verbs of a policy take them (execution/policy.hpp): shapes of one operand look in the index
// of the other, all are compared with all in tiles, or two trees, or one with itself, are walked down. Not whose shapes do
// what: pairing.hpp, self_pairing.hpp. `Ids` packs two ids into a key and says whether the pair is wanted; `RowsAreB` says
// whose shapes look.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/keys.hpp>
#include <abut/collide/nearness.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/shares.hpp>
#include <abut/error.hpp>
#include <abut/index/least_ids.hpp>
#include <abut/shape/reach.hpp>
#include <abut/traverse/even_nodes.hpp>
#include <abut/traverse/pair_walk.hpp>
#include <abut/traverse/rule_walk.hpp>
#include <abut/traverse/seeds.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

/// Pairs by their ids, with a filter that is asked of subtrees. Of a user's filter members of these names say nothing.
template <class Ids>
concept asked_of_subtrees = requires(const Ids& ids) {
    { ids.filter.least_a } -> std::same_as<const std::uint32_t* const* const&>;
    { ids.filter.least_b } -> std::same_as<const std::uint32_t* const* const&>;
    { ids.filter.is_enough() } -> std::same_as<bool>;
};

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
        if constexpr (asked_of_subtrees<Ids>) {
            if (!is_wanted_by_row<RowsAreB>(ids, static_cast<std::uint32_t>(i), 0)) return false;  // nor with another
        }
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

/// One step down two trees, of which the rows' is the walk's first.
///
/// A filter may leave out, with a pair, all pairs in which neither id is less. Such a one is asked of subtrees as well, by
/// their least ids: its `least_a[0]` and `least_b[0]` say these of each node of the trees (index/least_ids.hpp). Both tables
/// may be null: then it may say that it is enough, and that nothing more is to be walked.
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
            if (ids.filter.least_a == nullptr) return !ids.filter.is_enough();
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

/// Down two trees, or one with itself, depth first: what traversals have in common.
struct goes_down {
    /// The walk of two trees: of both nodes at once.
    template <class A, class B, class Overlap>
    using walk = pair_walk<A, B, Overlap>;
    /// Whether it begins at query_options::start_depth, whatever the schedule.
    static constexpr bool begins_at_depth = false;

    /// Throws in the name of a function where options lack something.
    static void check(const auto&, const char*) {}
    /// Whether the boxes of two trees' roots tell that there is nothing to find. Only a host reads them.
    template <class Policy, class Expand>
    static bool are_apart([[maybe_unused]] const Expand& expand) {
        [[maybe_unused]] const auto& walk = expand.walk;
        if constexpr (host_policy<Policy> && requires { walk.overlap(walk.a.root_bounds(), walk.b.root_bounds()); }) {
            return !walk.overlap(walk.a.root_bounds(), walk.b.root_bounds());
        } else {
            return false;
        }
    }
    /// Judges what is found below the trees of two operands, which may be one, by loops that `run` runs.
    template <class Policy, class A, class B, class Expand, class Filter, traversal Traversal, schedule Schedule, class Run>
    static void descend(const Policy& on, const A&, const B&, const Expand& expand,
                        const query_options<Filter, Traversal, Schedule>& options, const Run& run) {
        if (are_apart<Policy>(expand)) return;
        const execution::scheduled<Schedule> how{options.scheduling};
        const auto from = [&](const auto& step) {
            run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, step, judge, sinks...); });
        };
        if constexpr (Schedule != schedule::shared_list && Traversal == traversal::both_at_once && !host_policy<Policy>) {
            from(begin_below<Expand>(expand, options.start_depth));
        } else {
            from(expand);
        }
    }
};
/// The same, where a rule says which of two nodes is opened (traverse/rule_walk.hpp).
template <class Rule>
struct goes_down_by_rule : goes_down {
    template <class A, class B, class Overlap>
    using walk = rule_walk<A, B, Overlap, Rule>;
};

/// How a traversal goes down. Those of experimental/ are specialised there.
template <traversal Traversal>
struct way_down : goes_down {
    static_assert(Traversal != traversal::one_first && Traversal != traversal::alternate,
                  "abut: this traversal is in another header: include <abut/experimental/descent_rules.hpp>");
    static_assert(Traversal != traversal::breadth_first,
                  "abut: this traversal is in another header: include <abut/experimental/breadth_first.hpp>");
    static_assert(Traversal != traversal::from_front,
                  "abut: this traversal is in another header: include <abut/experimental/front.hpp>");
};
template <>
struct way_down<traversal::larger_first> : goes_down_by_rule<opens_larger> {};

/// Judges what a walk down the trees of two operands finds, which may be one.
template <class Policy, class A, class B, class Expand, class Filter, traversal Traversal, schedule Schedule, class Run,
          class Part = whole_search>
void descend(const Policy& on, const A& a, const B& b, const Expand& expand,
             const query_options<Filter, Traversal, Schedule>& options, const Run& run, const Part& part = {}) {
    if constexpr (std::same_as<Part, whole_search>) {
        way_down<Traversal>::descend(on, a, b, expand, options, run);
    } else {
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
    }
}

}  // namespace abut::detail
