// SPDX-License-Identifier: MIT
#pragma once

// What refit derives of a topology, once: in which order its boxes are made.
//
// Shapes are put in the order in which a walk from left to right meets them (walk_order.hpp). A node then stands for the
// border between the last shape below its left side and the first one below its right side, and each border has one node.
// Shapes are divided into groups of neighbours, and a tree restricted to the shapes of one group is again a tree, with one
// node for each border inside the group. In it a node's turn is its height, so a group makes its boxes turn by turn in the
// memory that it shares, and nothing is counted or waited for. Nodes with shapes of several groups, about eight a group, are
// put together after that (refit.hpp): each of their sides is the end of one group, whole groups, and the beginning of
// another.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/arithmetic/align.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/walk_order.hpp>

namespace abut {

/// How refit makes a node among the shapes of a group, and where a shape's box goes. While a group is made, step k has the
/// entries k and 256 + k of a table for the boxes of its two children.
struct alignas(16) refit_step {
    static constexpr std::uint32_t spans = std::uint32_t{1} << 31;  ///< a bit of `node`
    static constexpr std::uint32_t no_entry = 511;                  ///< where a box goes nowhere
    std::uint32_t node;  ///< its number; or `spans` and its number among those that have shapes of several groups below them
    bvh_child child[2];  ///< the node's children
    std::uint32_t box_to : 9;  ///< the entry of the node's own box, in a later turn; the last step of a group has none
    std::uint32_t turn : 7;    ///< the node's height in the tree of its group
    std::uint32_t shape_to : 9;  ///< the entry of the shape at this position in the order; none if it is the only one
};

/// A node with shapes of several groups below it, from `first` to `last` in their order.
struct alignas(16) spanning_node {
    std::uint32_t node;    ///< its number
    bvh_child child[2];    ///< its children
    std::uint32_t border;  ///< between the shapes of its left side and those of its right side
    std::uint32_t first;   ///< position of its first shape
    std::uint32_t last;    ///< position of its last one
    std::uint32_t before;  ///< the number of such a node at the border before `first`, if there is
    std::uint32_t after;   ///< likewise after `last`
};

/// In which order refit makes the boxes of a topology.
template <memory_space Space>
struct refit_plan {
    execution::buffer<std::uint32_t, Space> leaves;  ///< ids of shapes in the order in which a walk meets them
    execution::buffer<refit_step, Space> steps;      ///< as many, by groups, in each by turns; its last is none
    execution::buffer<spanning_node, Space> spanning;  ///< nodes with shapes of several groups, by borders
};

namespace detail {

/// The last border of a group lies between it and the next one: no node of the tree that is restricted to the group.
ABUT_HD constexpr bool ends_group(std::uint32_t border) {
    return border % execution::group_size == execution::group_size - 1;
}

/// Trees restricted to groups, by borders. Keys are groups above turns, by which borders are sorted.
struct group_trees {
    static constexpr int turn_bits = 7;
    static constexpr std::uint32_t turns = 1u << turn_bits, no_turn = turns - 1;
    static_assert(bvh_max_depth < no_turn);
    const std::uint32_t* below;  ///< at link 2 border + slot a border, or `no_link` for a leaf
    const std::uint32_t* above;
    std::uint32_t* keys;
    [[nodiscard]] ABUT_HD bool is_leaf(std::size_t border, std::uint32_t slot) const {
        return !ends_group(static_cast<std::uint32_t>(border)) && below[2 * border + slot] == no_link;
    }
    [[nodiscard]] ABUT_HD static std::uint32_t leaf_value(std::size_t, std::uint32_t) { return 0; }
    [[nodiscard]] ABUT_HD static std::uint32_t key(std::uint32_t border, std::uint32_t turn) {
        return border / execution::group_size << turn_bits | turn;
    }
    [[nodiscard]] ABUT_HD std::uint32_t join(std::uint32_t border, std::uint32_t left, std::uint32_t right) const {
        const std::uint32_t turn = left < right ? right : left;
        keys[border] = key(border, turn);
        return turn + 1;
    }
};

/// Restricts the tree to groups.
template <scalar T>
struct write_group_trees {
    const bvh_node<T>* nodes;
    const node_range* ranges;
    const std::uint32_t* node_at;
    std::uint32_t *below, *above, *keys, *borders;

    ABUT_HD void operator()(std::size_t i) const {
        const auto border = static_cast<std::uint32_t>(i);
        borders[i] = border;
        if (ends_group(border)) {
            keys[i] = group_trees::key(border, group_trees::no_turn);
            return;
        }
        for (std::uint32_t slot = 0; slot < 2; ++slot) {
            const std::uint32_t next = nearest(border, slot);
            below[2 * i + slot] = next;
            if (next != no_link) above[next] = 2 * border + slot;
        }
    }

private:
    /// What hangs there once other groups' shapes are gone: of nodes whose border is beyond the group only the side
    /// towards it is left.
    [[nodiscard]] ABUT_HD std::uint32_t nearest(std::uint32_t border, std::uint32_t slot) const {
        bvh_child child = nodes[node_at[border]].child[slot];
        while (!child.is_leaf()) {
            const std::uint32_t at = ranges[child.index()].border();
            if (at / execution::group_size == border / execution::group_size && !ends_group(at)) return at;
            child = nodes[child.index()].child[1 - slot];
        }
        return no_link;
    }
};

struct spans_groups {
    const node_range* ranges;
    const std::uint32_t* node_at;
    ABUT_HD bool operator()(std::size_t border) const { return ranges[node_at[border]].spans_groups(); }
};

struct number_spanning {
    const std::uint32_t* borders;
    std::uint32_t* numbers;
    ABUT_HD void operator()(std::size_t i) const { numbers[borders[i]] = static_cast<std::uint32_t>(i); }
};

/// What has been found out, as refit reads it.
template <scalar T>
struct write_spanning {
    const bvh_node<T>* nodes;
    const node_range* ranges;
    const std::uint32_t *node_at, *borders, *numbers;
    std::uint32_t all;  ///< borders
    spanning_node* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t border = borders[i], node = node_at[border];
        const node_range range = ranges[node];
        const std::uint32_t first = range.first, last = range.last();
        out[i] = {node,
                  {nodes[node].child[0], nodes[node].child[1]},
                  border,
                  first,
                  last,
                  first > 0 ? numbers[first - 1] : no_link,
                  last < all ? numbers[last] : no_link};
    }
};

/// Which step of its group each border is.
struct number_steps {
    const std::uint32_t* borders;
    std::uint32_t* step_of;
    ABUT_HD void operator()(std::size_t i) const {
        step_of[borders[i]] = static_cast<std::uint32_t>(i % execution::group_size);
    }
};

template <scalar T>
struct write_steps {
    const bvh_node<T>* nodes;
    const node_range* ranges;
    const std::uint32_t *node_at, *below, *above, *keys, *borders, *step_of, *numbers;
    std::uint32_t all;  ///< borders
    refit_step* out;

    ABUT_HD void operator()(std::size_t i) const {
        refit_step step{0,
                        {{0}, {0}},
                        refit_step::no_entry,
                        group_trees::no_turn,
                        shape_entry(static_cast<std::uint32_t>(i)) & refit_step::no_entry};
        if (i < all) {
            const std::uint32_t border = borders[i], node = node_at[border];
            step.node = ranges[node].spans_groups() ? refit_step::spans | numbers[border] : node;
            for (int slot = 0; slot < 2; ++slot) step.child[slot] = nodes[node].child[slot];
            step.box_to = entry(above[border]) & refit_step::no_entry;  // the mask is for -Wconversion
            step.turn = keys[i] % group_trees::turns;
        }
        out[i] = step;
    }

private:
    /// Of what hangs at a link in a group's tree.
    [[nodiscard]] ABUT_HD std::uint32_t entry(std::uint32_t link) const {
        return link == no_link ? refit_step::no_entry : link % 2 * execution::group_size + step_of[link / 2];
    }
    /// A leaf hangs to the left of the border after it, or to the right of the one before it.
    [[nodiscard]] ABUT_HD std::uint32_t shape_entry(std::uint32_t i) const {
        if (i < all && !ends_group(i) && below[2 * i] == no_link) return entry(2 * i);
        return i % execution::group_size == 0 ? refit_step::no_entry : entry(2 * (i - 1) + 1);
    }
};

/// Of a tree with `count` nodes, one at least. Takes time and memory as building does.
template <class Policy, scalar T>
refit_plan<space_of<Policy>> make_refit_plan(const Policy& on, const bvh_node<T>* nodes, std::size_t count, bvh_child root) {
    refit_plan<space_of<Policy>> plan;
    using numbers = execution::buffer_of<Policy, std::uint32_t>;
    auto [above, ranges, node_at, leaves] = order_by_walk(on, nodes, count, root);
    plan.leaves = std::move(leaves);
    numbers reached(on, count), below(on, 2 * count), keys(on, count), borders(on, count);
    fill(on, above.data(), count, no_link);
    fill(on, reached.data(), count, no_link);
    for_each_index(
        on, count,
        write_group_trees<T>{nodes, ranges.data(), node_at.data(), below.data(), above.data(), keys.data(), borders.data()});
    for_each_index(on, count, fold_up<group_trees>{{below.data(), above.data(), keys.data()}, reached.data()});
    sort_by_key(on, keys, borders, group_trees::turn_bits + bits_up_to(count / execution::group_size));

    numbers number_of(on, count), step_of(on, count);
    for_each_index(on, count, number_steps{borders.data(), step_of.data()});
    numbers& spanning = reached;
    const std::size_t many = compact(on, count, spans_groups{ranges.data(), node_at.data()}, spanning.data());
    for_each_index(on, many, number_spanning{spanning.data(), number_of.data()});
    plan.spanning = execution::buffer_of<Policy, spanning_node>(on, many);
    for_each_index(on, many,
                   write_spanning<T>{nodes, ranges.data(), node_at.data(), spanning.data(), number_of.data(),
                                     static_cast<std::uint32_t>(count), plan.spanning.data()});
    plan.steps = execution::buffer_of<Policy, refit_step>(on, count + 1);
    for_each_index(
        on, count + 1,
        write_steps<T>{nodes, ranges.data(), node_at.data(), below.data(), above.data(), keys.data(), borders.data(),
                       step_of.data(), number_of.data(), static_cast<std::uint32_t>(count), plan.steps.data()});
    synchronize(on);  // another policy may use it, in a stream of its own
    return plan;
}

}  // namespace detail

}  // namespace abut
