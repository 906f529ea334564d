// SPDX-License-Identifier: MIT
#pragma once

// From the leaves of a tree to its root, as the linear builder goes (Apetrei, "Fast and Simple Agglomerative LBVH
// Construction", 2014): every subtree that is finished hangs itself below the node above; of the two that come to a node the
// second makes sure that it is finished in turn. Boxes depend on the tree alone, not on who came second.
//
// Most nodes lie within a group of neighbours (for_each_in_groups), whose subtrees meet in the memory that they share. What
// finds nobody there goes on when all groups are done.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/execution/atomic.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/node_part.hpp>

namespace abut::detail {

/// A subtree whose box and child are written where it hangs: at place 2 node + side. `token` is what else the node has to
/// know.
struct hanging_subtree {
    std::uint32_t place, token;
};

/// The nodes of a group while they are made.
template <scalar T, memory_space Space>
struct node_table {
    static constexpr unsigned parts = 1;  ///< in which a node is written
    bvh_node<T> made[execution::group_size];

    ABUT_HD void put(std::uint32_t side, std::uint32_t k, const aabb<T>& box, bvh_child is) {
        made[k].bounds[side] = box;
        made[k].child[side] = is;
    }
    [[nodiscard]] ABUT_HD const aabb<T>& box(std::uint32_t side, std::uint32_t k) const { return made[k].bounds[side]; }
    [[nodiscard]] ABUT_HD bvh_child child(std::uint32_t side, std::uint32_t k) const { return made[k].child[side]; }
    ABUT_HD void write(std::uint32_t k, unsigned, bvh_node<T>& to) const { to = made[k]; }
};

/// On a device number by number, so that neighbours do not meet in one bank of memory; and rows are a little longer than a
/// group for the sake of `write`, whose neighbours read different rows. Those write to one line of memory: nodes that were
/// written one by one took a device twice as long.
template <scalar T>
struct node_table<T, device_space> {
    static constexpr unsigned parts = node_parts<T>, row = execution::group_size + 2;
    T bounds[12][row];
    bvh_child children[2][row];

    ABUT_HD void put(std::uint32_t side, std::uint32_t k, const aabb<T>& box, bvh_child is) {
        const T values[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
        for (std::uint32_t c = 0; c < 6; ++c) bounds[6 * side + c][k] = values[c];
        children[side][k] = is;
    }
    [[nodiscard]] ABUT_HD aabb<T> box(std::uint32_t side, std::uint32_t k) const {
        const auto* const b = bounds + 6 * side;
        return {{b[0][k], b[1][k], b[2][k]}, {b[3][k], b[4][k], b[5][k]}};
    }
    [[nodiscard]] ABUT_HD bvh_child child(std::uint32_t side, std::uint32_t k) const { return children[side][k]; }
    ABUT_HD void write(std::uint32_t k, unsigned part, bvh_node<T>& to) const {
        write_node_part(to, part, [&](unsigned q) { return bounds[q][k]; }, children[0][k], children[1][k]);
    }
};

/// `Tree` says how the climb goes. Its `subtree` has the members `box` and `child` and what else it needs; a group keeps
/// what it needs to know of the tree in a `local`.
///   load(first, k, local)   brings what belongs to index first + k, of which there need not be one
///   near(first, local)      reads the tree for subtrees of the group from `first` on
///   far()                   reads it for any
///   start(i, hang)          calls hang(subtree) for each leaf of index i, less than three
///   notice(i, sinks...)     sees each index once, and the queues of the loop
///   is_all(subtree)         whether it is the whole tree
///   above(subtree, reader)  the place where it hangs
///   token(subtree, place, reader)   what whoever goes on from there has to know, less than 2^32 - 1
///   joined(left_token, right_token)   what is not box and child of the subtree of a node
template <class Tree, scalar T, memory_space Space>
struct climb {
    static constexpr std::uint32_t nobody = static_cast<std::uint32_t>(-1);
    static constexpr std::uint32_t group = execution::group_size;

    Tree tree;
    std::uint32_t* reached;  ///< for each node the token of whoever came first, outside of groups
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    using subtree = typename Tree::subtree;

    struct shared {
        node_table<T, Space> nodes;
        std::uint32_t token[2][group], visitors[group];
        typename Tree::local tree;
    };

    ABUT_HD void prepare(std::size_t first, unsigned k, shared& with) const {
        tree.load(first, k, with.tree);
        with.token[0][k] = with.token[1][k] = nobody;
        with.visitors[k] = 0;
    }
    ABUT_CALLS_ANY
    template <class Ready, class Late, class... Sinks>
    ABUT_HD void begin(std::size_t i, shared& with, Ready&& ready, Late&& late, Sinks&... sinks) const {
        tree.notice(i, sinks...);
        const std::uint32_t first_node = static_cast<std::uint32_t>(i) / group * group;
        tree.start(i, [&](const subtree& leaf) { hang(leaf, first_node, with, ready, late); });
    }
    /// Both subtrees below node k of the group are there.
    ABUT_CALLS_ANY
    template <class Ready, class Late>
    ABUT_HD void step(std::size_t first, unsigned k, shared& with, Ready&& ready, Late&& late) const {
        const auto first_node = static_cast<std::uint32_t>(first);
        hang(joined({with.nodes.box(0, k), with.nodes.box(1, k)}, first_node + k, with.token[0][k], with.token[1][k]),
             first_node, with, ready, late);
    }
    static constexpr unsigned parts = node_table<T, Space>::parts;
    ABUT_HD void write(std::size_t first, unsigned t, const shared& with) const {
        const unsigned k = t / parts;
        if (with.visitors[k] == 2) with.nodes.write(k, t % parts, nodes[first + k]);
    }
    /// Who waits at node k alone goes on outside.
    ABUT_CALLS_ANY
    template <class Late>
    ABUT_HD void end(std::size_t first, unsigned k, const shared& with, Late&& late) const {
        if (with.visitors[k] != 1) return;
        const std::uint32_t side = with.token[0][k] != nobody ? 0 : 1;
        leave(2 * (static_cast<std::uint32_t>(first) + k) + side, with.token[side][k], with.nodes.box(side, k),
              with.nodes.child(side, k), late);
    }

    /// What is left of the groups.
    template <class... Sinks>
    ABUT_HD void operator()(const hanging_subtree& from, Sinks&...) const {
        std::uint32_t place = from.place, token = from.token;
        for (;;) {
            const std::uint32_t node = place / 2, side = place % 2;
            const std::uint32_t other = execution::atomic_exchange_acq_rel(&reached[node], token);
            if (other == nobody) return;
            const boxes both{load_fresh(nodes[node].bounds[0]), load_fresh(nodes[node].bounds[1])};
            const subtree at = joined(both, node, side == 0 ? token : other, side == 0 ? other : token);
            if (tree.is_all(at)) {
                *root = {at.box, at.child};
                return;
            }
            place = tree.above(at, tree.far());
            token = tree.token(at, place, tree.far());
            nodes[place / 2].bounds[place % 2] = at.box;
            nodes[place / 2].child[place % 2] = at.child;
        }
    }

private:
    struct boxes {
        aabb<T> left, right;
    };
    /// The left box before the right one: the two zeros are told apart by it.
    ABUT_HD subtree joined(const boxes& both, std::uint32_t node, std::uint32_t left, std::uint32_t right) const {
        subtree at = tree.joined(left, right);
        at.box = merge(both.left, both.right);
        at.child = bvh_child::inner(node);
        return at;
    }
    ABUT_CALLS_ANY
    template <class Late>
    ABUT_HD void leave(std::uint32_t place, std::uint32_t token, const aabb<T>& box, bvh_child is, Late&& late) const {
        nodes[place / 2].bounds[place % 2] = box;
        nodes[place / 2].child[place % 2] = is;
        late.push(hanging_subtree{place, token});
    }
    ABUT_CALLS_ANY
    template <class Ready, class Late>
    ABUT_HD void hang(const subtree& at, std::uint32_t first_node, shared& with, Ready&& ready, Late&& late) const {
        if (tree.is_all(at)) {
            *root = {at.box, at.child};
            return;
        }
        const auto reader = tree.near(first_node, with.tree);
        const std::uint32_t place = tree.above(at, reader), token = tree.token(at, place, reader), side = place % 2;
        const std::uint32_t k = place / 2 - first_node;  // unsigned: beyond the group, or before it
        if (k >= group) return leave(place, token, at.box, at.child, late);
        with.nodes.put(side, k, at.box, at.child);
        with.token[side][k] = token;
        if (execution::increment_in_group(&with.visitors[k]) == 1) ready.push(k);
    }
};

/// Climbs from `count` indices through a tree of n shapes.
template <scalar T, execution_policy Policy, class Tree, class... Queues>
void climb_all(const Policy& on, const Tree& tree, std::size_t count, std::size_t n, bvh_node<T>* nodes, bvh_root<T>* root,
               Queues&... queues) {
    execution::buffer_of<Policy, std::uint32_t> reached(on, n - 1);
    execution::work_queue<hanging_subtree, space_of<Policy>> late(on, count);
    fill(on, reached.data(), n - 1, climb<Tree, T, space_of<Policy>>::nobody);
    const climb<Tree, T, space_of<Policy>> each{tree, reached.data(), nodes, root};
    for_each_in_groups(on, count, each, each, late, queues...);
}

}  // namespace abut::detail
