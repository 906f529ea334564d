// SPDX-License-Identifier: MIT
#pragma once

// Where to cut two trees, or one that is walked with itself, into parts of work: at nodes of about equal numbers of shapes,
// however deep they lie. Where shapes are crowded in a place, all nodes of one depth but one are nearly empty.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/traverse/self_walk.hpp>

namespace abut::detail {

/// A tree is cut into about so many nodes.
inline constexpr std::size_t even_nodes = 256;
/// More pairs of nodes than this are too many to begin at: of trees as no scene should have them.
inline constexpr std::size_t most_even_pairs = std::size_t{1} << 22;

/// The nodes and leaves that have no more than `most` shapes, where their parents have more: each shape is below one.
/// Node k of the tree lies between leaves k and k + 1 (index/climb.hpp), so that its number tells what its children have.
template <bvh_layout Tree>
struct nodes_below {
    Tree tree;
    std::size_t most = 1;

    nodes_below(const Tree& from, std::size_t nodes) : tree(from), most((from.size() + nodes - 1) / nodes) {}
    /// Leaves that lie `most` apart: one of them at least is below each node of more shapes.
    [[nodiscard]] std::size_t places() const { return (tree.size() + most - 1) / most; }

    /// Those whose parent is above the k-th of the places, and above none that comes before. Half items of pair_walk.
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void find(std::size_t k, Sink& found) const {
        const std::size_t place = k * most;
        std::size_t first = 0, last = tree.size() - 1;
        bvh_child at = tree.root();
        while (last - first >= most) {
            const std::uint32_t node = at.index();
            const auto& children = tree.fetch(node);
            if (k == 0 || place - most < first) {
                if (node - first < most) found.push(half_item(node, 0, tree.child(children, 0)));
                if (last - node <= most) found.push(half_item(node, 1, tree.child(children, 1)));
            }
            const bool left = place <= node;
            at = tree.child(children, left ? 0 : 1);
            (left ? last : first) = left ? node : std::size_t{node} + 1;
        }
    }

private:
    ABUT_HD static std::uint32_t half_item(std::uint32_t node, std::uint32_t slot, bvh_child child) {
        return child.is_leaf() ? bvh_child::leaf_bit | (2 * node + slot) : child.index();
    }
};

/// Of two trees in one loop.
template <bvh_layout A, bvh_layout B>
struct find_even_nodes {
    nodes_below<A> a;
    nodes_below<B> b;
    std::size_t places_a;
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& of_a, Sink& of_b) const {
        i < places_a ? a.find(i, of_a) : b.find(i - places_a, of_b);
    }
};

/// About so many nodes of one tree, in no order.
template <class Policy, bvh_layout Tree>
execution::buffer_of<Policy, std::uint32_t> cut_evenly(const Policy& on, const Tree& tree, std::size_t nodes = even_nodes) {
    const nodes_below<Tree> below(tree, nodes);
    execution::work_queue<std::uint32_t, space_of<Policy>> found(on, 8 * nodes), none(on, 1);
    for_each_index(on, below.places(), find_even_nodes<Tree, Tree>{below, below, below.places()}, found, none);
    return found.take();
}

/// The boxes of such nodes.
template <bvh_layout Tree>
struct write_node_boxes {
    using box = aabb<typename Tree::scalar_type>;
    Tree tree;
    const std::uint32_t* nodes;
    box* boxes;
    ABUT_HD void operator()(std::size_t i) const {
        const bool is_leaf = (nodes[i] & bvh_child::leaf_bit) != 0;
        const std::uint32_t at = nodes[i] & ~bvh_child::leaf_bit;
        const auto& node = tree.fetch(is_leaf ? at / 2 : at);
        const box lower = tree.bounds(node, is_leaf ? static_cast<int>(at % 2) : 0);
        boxes[i] = is_leaf ? lower : merge(lower, tree.bounds(node, 1));
    }
};

/// The nodes of a walk's trees, in no order; of one tree with itself, `a` alone.
template <class Policy>
struct cut_trees {
    execution::buffer_of<Policy, std::uint32_t> a, b;
};
/// The trees have more than one shape each, and nodes as nodes_below needs them.
template <class Policy, class Walk>
cut_trees<Policy> cut_both_evenly(const Policy& on, const Walk& walk) {
    if constexpr (requires { walk.tree(); }) {
        return {cut_evenly(on, walk.tree()), {}};
    } else {
        using tree_a = std::remove_cvref_t<decltype(walk.a)>;
        using tree_b = std::remove_cvref_t<decltype(walk.b)>;
        const nodes_below<tree_a> a(walk.a, even_nodes);
        const nodes_below<tree_b> b(walk.b, even_nodes);
        execution::work_queue<std::uint32_t, space_of<Policy>> of_a(on, 8 * even_nodes), of_b(on, 8 * even_nodes);
        for_each_index(on, a.places() + b.places(), find_even_nodes<tree_a, tree_b>{a, b, a.places()}, of_a, of_b);
        return {of_a.take(), of_b.take()};
    }
}

}  // namespace abut::detail
