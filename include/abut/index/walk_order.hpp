// SPDX-License-Identifier: MIT
#pragma once

// The shapes of a tree in the order in which a walk from left to right meets them, and passes from the leaves up and from
// the root down: what refit and trees of volumes need to know of a topology.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>

namespace abut::detail {

/// A link says where a child hangs: 2 * node + slot. This is none, and also none of other numbers.
inline constexpr std::uint32_t no_link = static_cast<std::uint32_t>(-1);

/// Writes the link of each inner node. Nodes have two children.
template <class Node>
struct write_links {
    const Node* nodes;
    bvh_child root;
    std::uint32_t* above;
    ABUT_HD void operator()(std::size_t i) const {
        const auto node = static_cast<std::uint32_t>(i);
        for (std::uint32_t slot = 0; slot < 2; ++slot) {
            const bvh_child child = nodes[i].child[slot];
            if (!child.is_leaf()) above[child.index()] = 2 * node + slot;
        }
        if (node == root.index()) above[node] = no_link;
    }
};

/// From the leaves of trees to their roots: of the two that come to a node the second one goes on. `Tree` says
/// `is_leaf(node, slot)`, `above[node]`, and what leaves and nodes are worth: `leaf_value(node, slot)` and
/// `join(node, left, right)`, which are not `no_link`.
template <class Tree>
struct fold_up {
    Tree tree;
    std::uint32_t* reached;  ///< for each node the value of the child that came first; at the start `no_link`

    ABUT_HD void operator()(std::size_t i) const {
        for (std::uint32_t slot = 0; slot < 2; ++slot) {
            if (!tree.is_leaf(i, slot)) continue;
            std::uint32_t link = 2 * static_cast<std::uint32_t>(i) + slot, value = tree.leaf_value(i, slot);
            while (link != no_link) {
                const std::uint32_t node = link / 2;
                const std::uint32_t other = execution::atomic_exchange_acq_rel(&reached[node], value);
                if (other == no_link) break;
                value = link % 2 == 0 ? tree.join(node, value, other) : tree.join(node, other, value);
                link = tree.above[node];
            }
        }
    }
};

/// The shapes below a node: `count` from `first` on in the order, of which `left` are below its left child.
struct node_range {
    std::uint32_t first, left, count;
    [[nodiscard]] ABUT_HD std::uint32_t border() const { return first + left - 1; }
    [[nodiscard]] ABUT_HD std::uint32_t last() const { return first + count - 1; }
    [[nodiscard]] ABUT_HD bool spans_groups() const {
        return first / execution::group_size != last() / execution::group_size;
    }
};

template <scalar T>
struct count_shapes {
    const bvh_node<T>* nodes;
    const std::uint32_t* above;
    node_range* ranges;
    [[nodiscard]] ABUT_HD bool is_leaf(std::size_t node, std::uint32_t slot) const {
        return nodes[node].child[slot].is_leaf();
    }
    [[nodiscard]] ABUT_HD static std::uint32_t leaf_value(std::size_t, std::uint32_t) { return 1; }
    [[nodiscard]] ABUT_HD std::uint32_t join(std::uint32_t node, std::uint32_t left, std::uint32_t right) const {
        ranges[node].left = left;
        return ranges[node].count = left + right;
    }
};

/// From the root down, where the shapes below each node begin in the order. It writes elsewhere, which does no harm: there
/// is no queue that could overflow, and so nothing is done twice.
template <scalar T>
struct place_shapes {
    struct item {
        std::uint32_t node, first;
    };
    using candidate = std::uint32_t;  // none
    static constexpr unsigned most_children = 2, most_depth = bvh_max_depth;

    const bvh_node<T>* nodes;
    bvh_child root;
    node_range* ranges;
    std::uint32_t *node_at, *leaves;

    [[nodiscard]] std::size_t seeds() const { return 1; }
    [[nodiscard]] ABUT_HD item seed(std::size_t) const { return {root.index(), 0}; }
    void prefetch(const item&) const {}
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        ranges[at.node].first = at.first;
        const std::uint32_t middle = at.first + ranges[at.node].left;
        node_at[middle - 1] = at.node;
        const bvh_child left = nodes[at.node].child[0], right = nodes[at.node].child[1];
        if (left.is_leaf()) leaves[at.first] = left.index();
        if (right.is_leaf()) leaves[middle] = right.index();
        emitter.add(std::integral_constant<unsigned, 0>{}, !left.is_leaf(), item{left.index(), at.first});
        emitter.add(std::integral_constant<unsigned, 1>{}, !right.is_leaf(), item{right.index(), middle});
    }
};
struct judge_nothing {
    ABUT_HD bool operator()(std::uint32_t, auto&...) const { return true; }
    ABUT_HD void finish(std::uint32_t, auto&...) const {}
};

/// Shapes in the order in which a walk from left to right meets them: those below a node lie side by side.
template <memory_space Space>
struct walk_order {
    execution::buffer<std::uint32_t, Space> above;    ///< the link of each node; `no_link` for the root
    execution::buffer<node_range, Space> ranges;      ///< of each node
    execution::buffer<std::uint32_t, Space> node_at;  ///< by borders
    execution::buffer<std::uint32_t, Space> leaves;   ///< ids
};

/// Of a tree with `count` nodes, one at least. May return before it is there.
template <class Policy, scalar T>
walk_order<space_of<Policy>> order_by_walk(const Policy& on, const bvh_node<T>* nodes, std::size_t count, bvh_child root) {
    walk_order<space_of<Policy>> order{{on, count}, {on, count}, {on, count}, {on, count + 1}};
    execution::buffer_of<Policy, std::uint32_t> reached(on, count);
    for_each_index(on, count, write_links<bvh_node<T>>{nodes, root, order.above.data()});
    fill(on, reached.data(), count, no_link);
    for_each_index(on, count, fold_up<count_shapes<T>>{{nodes, order.above.data(), order.ranges.data()}, reached.data()});
    for_each_descendant(on, place_shapes<T>{nodes, root, order.ranges.data(), order.node_at.data(), order.leaves.data()},
                        judge_nothing{});
    return order;
}

}  // namespace abut::detail
