// SPDX-License-Identifier: MIT
#pragma once

// Where walks of two trees, or of one with itself, begin: at all pairs of nodes of a depth, so that there is work for all
// blocks of a device, or for all shares of a search, at once. traverse/even_nodes.hpp begins at nodes of about equal numbers
// of shapes instead.

#include <cstddef>
#include <cstdint>

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

/// The paths to the nodes that lie `depth` binary levels below the root, or as many as a balanced tree has.
template <bvh_layout Tree>
descent_path<Tree> path_to_depth(const Tree& tree, int depth) {
    descent_path<Tree> path{tree, 0};
    constexpr int levels_of_node = Tree::width > 2 ? 2 : 1;
    for (std::size_t paths = Tree::width; path.depth < depth / levels_of_node && paths <= tree.size(); paths *= Tree::width)
        ++path.depth;
    return path;
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

}  // namespace abut::detail
