// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once, or one with itself, breadth first: level by level, from all pairs of nodes at a chosen depth on. A step
// is that of pair_walk.hpp or self_walk.hpp for every item of a level. A first loop counts what the level makes; a scan of
// the counts says where its items go; a second loop writes them there, and judges the candidates, if there are any: the
// upper levels have none. So a level is the same on every policy, and each item has its place before it is made.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/traverse/self_walk.hpp>

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
        std::uint32_t link = 0;
        for (int level = 0; level < depth; ++level, path /= width) {
            const auto digit = static_cast<std::uint32_t>(path % width);
            if (at.is_leaf()) {
                if (digit != 0) return nowhere;
                continue;
            }
            const auto& node = tree.fetch(at.index());
            if (static_cast<int>(digit) >= tree.children(node)) return nowhere;
            link = width * at.index() + digit;
            at = tree.child(node, static_cast<int>(digit));
        }
        return at.is_leaf() ? bvh_child::leaf_bit | link : at.index();
    }
    ABUT_HD bool operator()(std::size_t path) const { return end(path) != nowhere; }
    /// Number of paths.
    [[nodiscard]] std::size_t count() const {
        std::size_t paths = 1;
        for (int level = 0; level < depth; ++level) paths *= Tree::width;
        return paths;
    }
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

/// The paths to the nodes that lie `depth` binary levels below the root, or as many as a balanced tree has.
template <bvh_layout Tree>
descent_path<Tree> path_to_depth(const Tree& tree, int depth) {
    descent_path<Tree> path{tree, 0};
    constexpr int levels_of_node = Tree::width > 2 ? 2 : 1;
    for (std::size_t paths = Tree::width; path.depth < depth / levels_of_node && paths <= tree.size(); paths *= Tree::width)
        ++path.depth;
    return path;
}

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

/// All pairs of nodes at a depth, as seeds.
template <class Walk>
struct seeds_below {
    descent_path<decltype(Walk::a)> a;
    descent_path<decltype(Walk::b)> b;
    std::size_t count_a, count_b;

    seeds_below(const Walk& walk, int depth)
        : a(path_to_depth(walk.a, depth)), b(path_to_depth(walk.b, depth)), count_a(a.count()), count_b(b.count()) {}
    [[nodiscard]] std::size_t count() const { return count_a * count_b; }
    [[nodiscard]] ABUT_HD typename Walk::item operator()(std::size_t i) const { return {a.end(i / count_b), b.end(i % count_b)}; }
};
template <bvh_layout Tree, class Overlap>
struct seeds_below<self_walk<Tree, Overlap>> {
    using walk_type = self_walk<Tree, Overlap>;
    descent_path<Tree> path;
    std::size_t ends;

    seeds_below(const walk_type& walk, int depth) : path(path_to_depth(walk.tree(), depth)), ends(path.count()) {}
    [[nodiscard]] std::size_t count() const { return ends > 1 ? ends / 2 * (ends + 1) : 1; }
    [[nodiscard]] ABUT_HD typename walk_type::item operator()(std::size_t k) const {
        return {path.end(k % ends), path.end((k + k / ends) % ends)};
    }
};

/// The same step, begun at a depth of binary trees: so a device has work for all of its blocks at once.
template <class Expand>
struct begin_below : Expand {
    using item = typename Expand::item;
    static_assert(Expand::most_children == 4);
    static constexpr std::uint32_t nowhere = static_cast<std::uint32_t>(-1);  ///< what a node is where a path ends above
    seeds_below<decltype(Expand::walk)> from;

    begin_below(const Expand& expand, int depth) : Expand(expand), from(expand.walk, depth) {}
    [[nodiscard]] std::size_t seeds() const { return from.count(); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return from(i); }
    ABUT_INLINE void prefetch(const item& at) const {
        if (at.a != nowhere && at.b != nowhere) Expand::prefetch(at);
    }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        if (at.a != nowhere && at.b != nowhere) Expand::operator()(at, emitter);
    }
};

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

}  // namespace abut::detail
