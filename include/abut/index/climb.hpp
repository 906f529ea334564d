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
#include <abut/index/leaf_order.hpp>
#include <abut/index/node_part.hpp>

namespace abut::detail {

/// A subtree whose box and child are written where it hangs: at place 2 node + side. `end` is the end of its leaves that is
/// far from there.
struct hanging_subtree {
    std::uint32_t place, end;
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
        write_node_part(
            to, part, [&](unsigned q) { return bounds[q][k]; }, children[0][k], children[1][k]);
    }
};

/// Reads what another thread has just written, past a cache that may hold the line as it was before.
template <scalar T>
ABUT_HD aabb<T> load_fresh(const aabb<T>& box) {
    const volatile aabb<T>& now = box;
    return {{now.lower.x, now.lower.y, now.lower.z}, {now.upper.x, now.upper.y, now.upper.z}};
}

/// A climb over leaves that are sorted by code. Node k lies between leaves k and k + 1. A range of leaves [first, last]
/// joins its neighbour across the closer of its two borders.
template <class Code, scalar T, memory_space Space>
struct climb {
    static constexpr std::uint32_t nobody = static_cast<std::uint32_t>(-1);
    static constexpr std::uint32_t group = execution::group_size;
    static constexpr unsigned parts = node_table<T, Space>::parts;

    const aabb<T>* boxes;
    std::uint32_t leaves;
    const Code* codes;
    const std::uint32_t* ids;
    std::uint32_t* reached;  ///< for each node the end of whoever came first, outside of groups
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    struct shared {
        node_table<T, Space> nodes;
        std::uint32_t end[2][group], visitors[group];
        Code across[group + 1];  ///< between leaf k of the group and the one before it
    };

    ABUT_HD void prepare(std::size_t first, unsigned k, shared& with) const {
        if (first + k + 1 < leaves) with.across[k + 1] = codes[first + k] ^ codes[first + k + 1];
        if (k == 0 && first > 0) with.across[0] = codes[first - 1] ^ codes[first];
        with.end[0][k] = with.end[1][k] = nobody;
        with.visitors[k] = 0;
    }
    ABUT_CALLS_ANY
    template <class Ready, class Late, class Count>
    ABUT_HD void begin(std::size_t i, shared& with, Ready&& ready, Late&& late, Count& crowded) const {
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now.
        constexpr std::size_t ahead = 16;
        if (i + ahead < leaves) __builtin_prefetch(boxes + ids[i + ahead]);
#endif
        crowded.add(is_crowded<Code>{codes, leaves}(i));
        const auto leaf = static_cast<std::uint32_t>(i);
        hang({boxes[ids[i]], bvh_child::leaf(ids[i]), leaf, leaf}, leaf / group * group, with, ready, late);
    }
    /// Both subtrees below node k of the group are there.
    ABUT_CALLS_ANY
    template <class Ready, class Late>
    ABUT_HD void step(std::size_t first, unsigned k, shared& with, Ready&& ready, Late&& late) const {
        const auto first_node = static_cast<std::uint32_t>(first);
        // The left box before the right one: the two zeros are told apart by it.
        hang({merge(with.nodes.box(0, k), with.nodes.box(1, k)), bvh_child::inner(first_node + k), with.end[0][k],
              with.end[1][k]},
             first_node, with, ready, late);
    }
    ABUT_HD void write(std::size_t first, unsigned t, const shared& with) const {
        const unsigned k = t / parts;
        if (with.visitors[k] == 2) with.nodes.write(k, t % parts, nodes[first + k]);
    }
    /// Who waits at node k alone goes on outside.
    ABUT_CALLS_ANY
    template <class Late>
    ABUT_HD void end(std::size_t first, unsigned k, const shared& with, Late&& late) const {
        if (with.visitors[k] != 1) return;
        const std::uint32_t side = with.end[0][k] != nobody ? 0 : 1;
        leave({2 * (static_cast<std::uint32_t>(first) + k) + side, with.end[side][k]}, with.nodes.box(side, k),
              with.nodes.child(side, k), late);
    }

    /// What is left of the groups.
    template <class Count>
    ABUT_HD void operator()(hanging_subtree at, Count&) const {
        for (;;) {
            const std::uint32_t node = at.place / 2, side = at.place % 2;
            const std::uint32_t other = execution::atomic_exchange_acq_rel(&reached[node], at.end);
            if (other == nobody) return;
            const aabb<T> left = load_fresh(nodes[node].bounds[0]), right = load_fresh(nodes[node].bounds[1]);
            const subtree both{merge(left, right), bvh_child::inner(node), side == 0 ? at.end : other,
                               side == 0 ? other : at.end};
            if (is_all(both)) return;
            at = above(both, [this](std::uint32_t k) -> distance {
                return {static_cast<Code>(codes[k] ^ codes[k + 1]), k ^ (k + 1)};
            });
            put(at.place, both.box, both.child);
        }
    }

private:
    struct subtree {
        aabb<T> box;
        bvh_child child;
        std::uint32_t first, last;
    };

    /// How far apart leaves k and k + 1 are: the highest bit in which their codes, and between equal codes their positions,
    /// differ. Comparing the numbers compares those bits, since no two borders of one range share their highest bit.
    struct distance {
        Code code;
        std::uint32_t position;
        ABUT_HD bool operator<(const distance& other) const {
            return code < other.code || (code == other.code && position < other.position);
        }
    };

    /// Whether it is the whole tree; then it has been written.
    ABUT_HD bool is_all(const subtree& at) const {
        const bool all = at.first == 0 && at.last == leaves - 1;
        if (all) *root = {at.box, at.child};
        return all;
    }
    template <class Across>
    [[nodiscard]] ABUT_HD hanging_subtree above(const subtree& at, const Across& across) const {
        const bool left = at.first == 0 || (at.last != leaves - 1 && across(at.last) < across(at.first - 1));
        return left ? hanging_subtree{2 * at.last, at.first} : hanging_subtree{2 * (at.first - 1) + 1, at.last};
    }
    ABUT_HD void put(std::uint32_t place, const aabb<T>& box, bvh_child is) const {
        nodes[place / 2].bounds[place % 2] = box;
        nodes[place / 2].child[place % 2] = is;
    }
    ABUT_CALLS_ANY
    template <class Late>
    ABUT_HD void leave(const hanging_subtree& at, const aabb<T>& box, bvh_child is, Late&& late) const {
        put(at.place, box, is);
        late.push(at);
    }
    ABUT_CALLS_ANY
    template <class Ready, class Late>
    ABUT_HD void hang(const subtree& at, std::uint32_t first_node, shared& with, Ready&& ready, Late&& late) const {
        if (is_all(at)) return;
        const hanging_subtree next = above(at, [&](std::uint32_t k) -> distance {
            return {with.across[k + 1 - first_node], k ^ (k + 1)};
        });
        const std::uint32_t side = next.place % 2, k = next.place / 2 - first_node;  // unsigned: or before the group
        if (k >= group) return leave(next, at.box, at.child, late);
        with.nodes.put(side, k, at.box, at.child);
        with.end[side][k] = next.end;
        if (execution::increment_in_group(&with.visitors[k]) == 1) ready.push(k);
    }
};

/// Sorts n > 0 shapes by the first `bits` bits of their codes and builds the tree; its root holds the scene's box. Returns
/// how many shapes have a code that the eighth one after them has too.
template <class Code, execution_policy Policy, scalar T, class Storage>
std::uint64_t build_lbvh(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, Storage& tree, int bits) {
    using climb_type = climb<Code, T, space_of<Policy>>;
    const std::size_t n = boxes.size();
    const auto order = order_leaves<Code, Policy, T>(on, boxes, tree.root.data(), bits);
    execution::work_count<space_of<Policy>> crowded(on);
    execution::buffer_of<Policy, std::uint32_t> reached(on, n - 1);
    execution::work_queue<hanging_subtree, space_of<Policy>> late(on, n);
    fill(on, reached.data(), n - 1, climb_type::nobody);
    const climb_type each{boxes.data(),       static_cast<std::uint32_t>(n),
                          order.codes.data(), order.ids.data(),
                          reached.data(),     tree.nodes.data(),
                          tree.root.data()};
    for_each_in_groups(on, n, each, each, late, crowded);
    return crowded.total();
}

}  // namespace abut::detail
