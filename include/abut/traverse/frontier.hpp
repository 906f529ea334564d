// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once, breadth first: level by level, from all pairs of nodes at a chosen depth on. A step is that of
// pair_walk.hpp for every item of a level. A first loop decides the candidates that the level has and counts the items that
// it makes; a scan of the counts says where they go; a second loop writes them there. So a level is the same on every
// policy, and each item has its place before it is made.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>

namespace abut::detail {

/// A way down from the root, by the digits of a number: to a node at a depth, or to a leaf above that, where all digits that
/// are left have to be 0, so that it is reached once.
template <bvh_layout Tree>
struct descent_path {
    static constexpr std::uint32_t nowhere = static_cast<std::uint32_t>(-1);
    Tree tree;
    int depth;

    /// Half an item of pair_walk, or `nowhere`.
    [[nodiscard]] ABUT_HD std::uint32_t end(std::size_t path) const {
        constexpr std::uint32_t width = Tree::width;
        bvh_child at = tree.root();
        std::uint32_t place = 0;
        for (int level = 0; level < depth; ++level, path /= width) {
            const auto digit = static_cast<std::uint32_t>(path % width);
            if (at.is_leaf()) {
                if (digit != 0) return nowhere;
                continue;
            }
            const auto& node = tree.fetch(at.index());
            if (static_cast<int>(digit) >= tree.children(node)) return nowhere;
            place = width * at.index() + digit;
            at = tree.child(node, static_cast<int>(digit));
        }
        return at.is_leaf() ? bvh_child::leaf_bit | place : at.index();
    }
    ABUT_HD bool operator()(std::size_t path) const { return end(path) != nowhere; }
};

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

// What a walk makes, handed on; see add_item in collide/query.hpp.

/// Counts items, and hands candidates to a policy's emitter.
template <class Emitter>
struct count_and_push {
    const Emitter& emitter;
    std::uint32_t& items;
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void add(Number, bool is, const Item&) const {
        items += static_cast<std::uint32_t>(is);
    }
    ABUT_CALLS_ANY
    template <class Number, class Candidate>
    ABUT_INLINE ABUT_HD void push(Number, bool is, const Candidate& c) const {
        if (is) emitter.push(c);
    }
};
template <class Item>
struct write_item {
    Item*& to;
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number, bool is, const Item& next) const {
        if (is) *to++ = next;
    }
};
struct drop_candidate {
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number, bool, std::uint32_t, std::uint32_t) const {}
};

struct every_index {
    ABUT_HD constexpr bool operator()(std::size_t) const { return true; }
};

/// The first loop over a level.
template <class Expand>
struct count_items {
    using candidate = typename Expand::candidate;
    Expand expand;
    const typename Expand::item* items;
    std::uint32_t* counts;

    ABUT_CALLS_ANY
    template <class Emitter, class Wide, class Hits, class Total>
    ABUT_HD void operator()(std::size_t i, const Emitter& emitter, Wide&, Hits&, Total& total) const {
        std::uint32_t made = 0;
        expand(items[i], count_and_push<Emitter>{emitter, made});
        counts[i] = made;
        total.add(made);
    }
};
/// The functors of a search beside a total that is not theirs.
template <class Decide>
struct decide_beside_total {
    Decide decide;
    ABUT_CALLS_ANY
    template <class Candidate, class Late, class Wide, class Hits, class Total>
    ABUT_HD void operator()(const Candidate& c, Late& late, Wide& wide, Hits& hits, Total&) const {
        decide(c, late, wide, hits);
    }
};
template <class Settle>
struct settle_beside_total {
    Settle settle;
    ABUT_CALLS_ANY
    template <class Candidate, class Wide, class Hits, class Total>
    ABUT_HD void operator()(const Candidate& c, Wide& wide, Hits& hits, Total&) const {
        settle(c, wide, hits);
    }
};

/// The second loop: `first` holds where the items that each one makes begin.
template <class Expand>
struct write_items {
    using item = typename Expand::item;
    Expand expand;
    const item* items;
    const std::uint32_t* first;
    item* out;

    ABUT_HD void operator()(std::size_t i) const {
        item* to = out + first[i];
        expand.walk.expand(items[i], write_item<item>{to}, drop_candidate{});
    }
};

/// The paths to the nodes that lie `depth` binary levels below the root, or as many as a balanced tree has.
template <bvh_layout Tree>
descent_path<Tree> path_to_depth(const Tree& tree, int depth) {
    descent_path<Tree> path{tree, 0};
    constexpr int levels_of_node = Tree::width > 2 ? 2 : 1;
    for (std::size_t paths = Tree::width; path.depth < depth / levels_of_node && paths <= tree.size(); paths *= Tree::width)
        ++path.depth;
    return path;
}

/// The pairs of nodes whose children are compared first.
template <class Policy, class Walk>
auto begin_at_depth(const Policy& on, const Walk& walk, int start_depth) {
    using item = typename Walk::item;
    // Children at start_depth hang at nodes one level up.
    const int depth = std::max(start_depth - 1, 0);
    const auto a = path_to_depth(walk.a, depth);
    const auto b = path_to_depth(walk.b, depth);
    const auto ends = [&](const auto& path, unsigned width, std::size_t& count) {
        std::size_t paths = 1;
        for (int level = 0; level < path.depth; ++level) paths *= width;
        execution::buffer_of<Policy, std::uint32_t> found(on, paths);
        count = compact(on, paths, path, found.data());
        return found;
    };
    std::size_t count_a = 0, count_b = 0;
    const auto paths_a = ends(a, Walk::width_a, count_a), paths_b = ends(b, Walk::width_b, count_b);
    execution::buffer_of<Policy, item> items(on, count_a * count_b);
    for_each_index(on, items.size(), pair_ends<Walk>{a, b, paths_a.data(), paths_b.data(), count_b, items.data()});
    return items;
}

/// Finds and decides the candidates of two trees: `expand` is a step of pair_walk, and the rest as in for_each_descendant.
/// Levels of very many items are taken in parts, the deepest first, so that memory is bounded by the depth of the trees.
template <class Policy, class Expand, class Decide, class Settle, class Late, class Wide, class Hits>
void for_each_on_levels(const Policy& on, const Expand& expand, int start_depth, const Decide& decide, const Settle& settle,
                        Late&, Wide& wide, Hits& hits) {
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
    while (!levels.empty()) {
        level& from = levels.back();
        const std::size_t n = std::min(from.left, most_at_a_time);
        from.left -= n;
        const item* const items = from.items.data() + from.left;
        execution::buffer_of<Policy, std::uint32_t> counts(on, n + 1);
        Late late(on);
        Wide more_wide(on, 0);
        Hits more(on);
        execution::work_count<space_of<Policy>> total(on);
        for_each_candidate(on, n, every_index{}, count_items<Expand>{expand, items, counts.data()},
                           decide_beside_total<Decide>{decide}, settle_beside_total<Settle>{settle}, late, more_wide, more,
                           total);
        wide.absorb(on, more_wide);
        hits.absorb(on, more);
        if (execution::is_over(hits)) return;
        exclusive_scan(on, counts.data(), n);
        execution::buffer_of<Policy, item> next(on, total.total());
        if (next.size() > 0) {
            for_each_index(on, n, write_items<Expand>{expand, items, counts.data(), next.data()});
        }
        if (from.left == 0) levels.pop_back();
        add_level(std::move(next));
    }
}

}  // namespace abut::detail
