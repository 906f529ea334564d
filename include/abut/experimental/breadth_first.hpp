// SPDX-License-Identifier: MIT
#pragma once

// traversal::breadth_first: two trees at once, or one with itself, level by level, from all pairs of nodes at a chosen depth
// on; for comparisons. A step is that of pair_walk.hpp or self_walk.hpp for every item of a level. A first loop counts what
// the level makes; a scan of the counts says where its items go; a second loop writes them there, and judges the candidates,
// if there are any: the upper levels have none. So a level is the same on every policy, and each item has its place before
// it is made.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/routes.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/traverse/seeds.hpp>
#include <abut/traverse/self_walk.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

/// All pairs of two ends of paths.
template <class Walk>
struct pair_ends {
    descent_path<decltype(Walk::a)> a;
    descent_path<decltype(Walk::b)> b;
    const std::uint32_t *paths_a, *paths_b;
    std::size_t count_b;
    typename Walk::item* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = {a.end(paths_a[i / count_b]), b.end(paths_b[i % count_b])}; }
};

/// All pairs of two ends of paths down one tree, each once, and each end with itself. Seen as hands of a clock, `count` of
/// them: i with the one that is d ahead, d = 0 ... count / 2, where the last d of an even number has half as many pairs.
template <class Walk>
struct pair_own_ends {
    descent_path<std::remove_cvref_t<decltype(std::declval<Walk>().tree())>> path;
    const std::uint32_t* paths;
    std::size_t count;
    typename Walk::item* out;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t i = k % count, j = (i + k / count) % count;
        out[k] = {path.end(paths[i]), path.end(paths[j])};
    }
};

/// Takes what a step makes, and counts it.
struct count_made {
    std::uint32_t items = 0, candidates = 0;
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void add(Number, bool is, const Item&) {
        items += static_cast<std::uint32_t>(is);
    }
    template <class Number, class Candidate>
    ABUT_INLINE ABUT_HD void push(Number, bool is, const Candidate&) {
        candidates += static_cast<std::uint32_t>(is);
    }
};

/// Takes what a step makes, writes the items, and hands the candidates to a policy's emitter.
template <class Item, class Emitter>
struct write_and_push {
    Item* to;
    const Emitter& emitter;
    template <class Number>
    ABUT_INLINE ABUT_HD void add(Number, bool is, const Item& next) {
        if (is) *to++ = next;
    }
    ABUT_CALLS_ANY
    template <class Number, class Candidate>
    ABUT_INLINE ABUT_HD void push(Number, bool is, const Candidate& c) const {
        if (is) emitter.push(c);
    }
};

/// The first loop over a level.
template <class Expand>
struct count_items {
    Expand expand;
    const typename Expand::item* items;
    std::uint32_t* counts;
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void operator()(std::size_t i, Count& made_items, Count& candidates) const {
        count_made made;
        expand(items[i], made);
        counts[i] = made.items;
        made_items.add(made.items);
        candidates.add(made.candidates);
    }
};

/// Of a level that has no candidates.
struct drop_candidates {
    ABUT_HD void push(const auto&) const {}
};

/// The second loop: `first` holds where the items that each one makes begin.
template <class Expand>
struct write_items {
    using candidate = typename Expand::candidate;
    struct cursor {};
    Expand expand;
    const typename Expand::item* items;
    const std::uint32_t* first;
    typename Expand::item* out;

    [[nodiscard]] ABUT_HD bool may_find(std::size_t) const { return true; }
    /// A pair of binary nodes makes four candidates at most. A device, which has no others, has room for those of all walks.
    ABUT_CALLS_ANY
    template <class Emitter, class... Sinks>
    ABUT_HD bool operator()(std::size_t i, cursor&, const Emitter& emitter, Sinks&...) const {
        expand(items[i], write_and_push<typename Expand::item, Emitter>{out + first[i], emitter});
        return false;
    }
    ABUT_HD void operator()(std::size_t i) const {
        cursor at;
        (*this)(i, at, drop_candidates{});
    }
};

/// A path to the parents of the nodes at `start_depth`, whose children are compared first.
template <bvh_layout Tree>
descent_path<Tree> path_to_start(const Tree& tree, int start_depth) {
    return path_to_depth(tree, std::max(start_depth - 1, 0));
}

/// The numbers of the paths that end somewhere.
template <class Policy, bvh_layout Tree>
execution::buffer_of<Policy, std::uint32_t> paths_with_ends(const Policy& on, const descent_path<Tree>& path) {
    execution::buffer_of<Policy, std::uint32_t> found(on, path.count());
    found.shrink(compact(on, path.count(), path, found.data()));
    return found;
}

/// The pairs of nodes whose children are compared first.
template <class Policy, class Walk>
auto begin_at_depth(const Policy& on, const Walk& walk, int start_depth) {
    const auto a = path_to_start(walk.a, start_depth);
    const auto b = path_to_start(walk.b, start_depth);
    const auto paths_a = paths_with_ends(on, a), paths_b = paths_with_ends(on, b);
    execution::buffer_of<Policy, typename Walk::item> items(on, paths_a.size() * paths_b.size());
    for_each_index(on, items.size(), pair_ends<Walk>{a, b, paths_a.data(), paths_b.data(), paths_b.size(), items.data()});
    return items;
}
/// Of one tree with itself.
template <class Policy, bvh_layout Tree, class Overlap>
auto begin_at_depth(const Policy& on, const self_walk<Tree, Overlap>& walk, int start_depth) {
    using walk_type = self_walk<Tree, Overlap>;
    const auto path = path_to_start(walk.tree(), start_depth);
    const auto paths = paths_with_ends(on, path);
    const std::size_t n = paths.size();
    execution::buffer_of<Policy, typename walk_type::item> items(on, n % 2 == 0 ? n / 2 * (n + 1) : (n + 1) / 2 * n);
    for_each_index(on, items.size(), pair_own_ends<walk_type>{path, paths.data(), n, items.data()});
    return items;
}

/// Judges the candidates of two trees: `expand` is a step of pair_walk or self_walk, and run(loop) runs a loop that judges.
/// Levels of very many items are taken in parts, the deepest first, so that memory is bounded by the depth of the trees.
template <class Policy, class Expand, class Run>
void for_each_on_levels(const Policy& on, const Expand& expand, int start_depth, const Run& run) {
    using item = typename Expand::item;
    constexpr std::size_t most_at_a_time = std::size_t{1} << 22;
    struct level {
        execution::buffer_of<Policy, item> items;
        std::size_t left;
    };
    std::vector<level> levels;
    const auto add_level = [&](execution::buffer_of<Policy, item> items) {
        const std::size_t n = items.size();
        if (n > 0) levels.push_back({std::move(items), n});
    };
    add_level(begin_at_depth(on, expand.walk, start_depth));
    while (!levels.empty() && !run.is_over()) {
        level& from = levels.back();
        const std::size_t n = std::min(from.left, most_at_a_time);
        from.left -= n;
        const item* const items = from.items.data() + from.left;
        execution::buffer_of<Policy, std::uint32_t> counts(on, n + 1);
        execution::work_count<space_of<Policy>> made(on), candidates(on);
        for_each_index(on, n, count_items<Expand>{expand, items, counts.data()}, made, candidates);
        exclusive_scan(on, counts.data(), n);
        execution::buffer_of<Policy, item> next(on, made.total());
        const write_items<Expand> write{expand, items, counts.data(), next.data()};
        if (candidates.total() == 0) {
            for_each_index(on, n, write);
        } else {
            run([&](const auto& judge, auto&... sinks) { return for_each_candidate(on, n, write, judge, sinks...); });
        }
        if (from.left == 0) levels.pop_back();
        add_level(std::move(next));
    }
}

template <>
struct way_down<traversal::breadth_first> : goes_down {
    static constexpr bool begins_at_depth = true;
    template <class Policy, class A, class B, class Expand, class Options, class Run>
    static void descend(const Policy& on, const A&, const B&, const Expand& expand, const Options& options, const Run& run) {
        for_each_on_levels(on, expand, options.start_depth, run);
    }
};

}  // namespace abut::detail
