// SPDX-License-Identifier: MIT
#pragma once

// From the leaves of a tree to its root, as the linear builder goes (Apetrei, "Fast and Simple Agglomerative LBVH
// Construction", 2014): every subtree that is finished hangs itself below the node above; of the two that come to a node the
// second makes sure that it is finished in turn. Boxes depend on the tree alone, not on who came second.
//
// Most nodes lie within a group of neighbours (for_each_group), whose subtrees meet in the memory that they share. What
// finds nobody there goes on when all groups are done, in a loop of its own (for_each_indirect).

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/execution/atomic.hpp>
#include <abut/execution/generic.hpp>
#include <abut/execution/group.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/leaf_order.hpp>
#include <abut/index/node_part.hpp>

namespace abut::detail {

/// A subtree whose box and child are written where it hangs: at link 2 node + slot. `end` is the end of its leaves that is
/// far from there.
struct hanging_subtree {
    std::uint32_t link, end;
};

/// The nodes of a group while they are made.
template <scalar T, memory_space Space>
struct node_table {
    static constexpr unsigned parts = 1;  ///< in which a node is written
    bvh_node<T> made[execution::group_size];

    ABUT_HD void put(std::uint32_t slot, std::uint32_t k, const aabb<T>& box, bvh_child is) {
        made[k].bounds[slot] = box;
        made[k].child[slot] = is;
    }
    [[nodiscard]] ABUT_HD const aabb<T>& box(std::uint32_t slot, std::uint32_t k) const { return made[k].bounds[slot]; }
    [[nodiscard]] ABUT_HD bvh_child child(std::uint32_t slot, std::uint32_t k) const { return made[k].child[slot]; }
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

    ABUT_HD void put(std::uint32_t slot, std::uint32_t k, const aabb<T>& box, bvh_child is) {
        const T values[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
        for (std::uint32_t c = 0; c < 6; ++c) bounds[6 * slot + c][k] = values[c];
        children[slot][k] = is;
    }
    [[nodiscard]] ABUT_HD aabb<T> box(std::uint32_t slot, std::uint32_t k) const {
        const auto* const b = bounds + 6 * slot;
        return {{b[0][k], b[1][k], b[2][k]}, {b[3][k], b[4][k], b[5][k]}};
    }
    [[nodiscard]] ABUT_HD bvh_child child(std::uint32_t slot, std::uint32_t k) const { return children[slot][k]; }
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
    std::uint32_t* reached;  ///< for each node 1 + the end of whoever came first, outside of groups; 0 before
    bvh_node<T>* nodes;
    bvh_root<T>* root;
    hanging_subtree* late;  ///< what goes on outside of groups
    std::uint32_t* late_count;

    struct shared {
        node_table<T, Space> nodes;
        std::uint32_t end[2][group], visitors[group];
        Code across[group + 1];          ///< between leaf k of the group and the one before it
        hanging_subtree leaving[group];  ///< each has a leaf of its own
        std::uint16_t ready[group];  ///< nodes below which both subtrees are there, in the order in which they came to be
        unsigned ready_count, leaving_count;
        std::uint32_t first_late;
    };

    /// A group, in rounds: each joins what the one before has made ready. The last rounds, of few, are a subgroup's.
    ABUT_HD void operator()(const execution::group<shared>& members) const {
        const auto first = static_cast<std::uint32_t>(members.first);
        shared& with = members.shared;
        const unsigned crowded = members.count(0, group, [&](unsigned k) {
            prepare(first, k, with);
            return first + k < leaves && is_crowded<Code>{codes, leaves}(first + k);
        });
        unsigned done = 0, count = members.count(0, group, [&](unsigned k) { return begin(first, k, with); });
        const auto join_next = [&](const auto& some) {
            const unsigned next =
                some.count(done, done + count, [&](unsigned k) { return join(first, with.ready[k], with); });
            done += count;
            count = next;
        };
        while (count > execution::subgroup_size) join_next(members);
        members.in_subgroup([&](const execution::subgroup& some) {
            while (count > 0) join_next(some);
        });
        members.each(0, parts * group, [&](unsigned t) {
            if (t < group) end(first, t, with);
            write(first, t, with);
        });
        // What leaves the group goes out together; the number of crowded leaves goes with it.
        members.each(0, 1, [&](unsigned) { with.first_late = execution::atomic_add(late_count, with.leaving_count + 1); });
        members.each(0, with.leaving_count + 1, [&](unsigned k) {
            late[with.first_late + k] = k < with.leaving_count ? with.leaving[k] : hanging_subtree{nobody, crowded};
        });
    }

    /// What has left the groups.
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void operator()(std::size_t i, Count& crowded) const {
        hanging_subtree at = late[i];
        if (at.link == nobody) return crowded.add(at.end);
        for (;;) {
            const std::uint32_t node = at.link / 2, slot = at.link % 2;
            const std::uint32_t before = execution::atomic_exchange_acq_rel(&reached[node], at.end + 1);
            if (before == 0) return;
            const std::uint32_t other = before - 1;
            const aabb<T> left = load_fresh(nodes[node].bounds[0]), right = load_fresh(nodes[node].bounds[1]);
            const subtree both{merge(left, right), bvh_child::inner(node), slot == 0 ? at.end : other,
                               slot == 0 ? other : at.end};
            if (is_all(both)) return;
            at = above(both, [this](std::uint32_t k) -> distance {
                return {static_cast<Code>(codes[k] ^ codes[k + 1]), k ^ (k + 1)};
            });
            put(at.link, both.box, both.child);
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
    ABUT_HD void put(std::uint32_t link, const aabb<T>& box, bvh_child is) const {
        nodes[link / 2].bounds[link % 2] = box;
        nodes[link / 2].child[link % 2] = is;
    }
    ABUT_HD void prepare(std::uint32_t first, unsigned k, shared& with) const {
        if (first + k + 1 < leaves) with.across[k + 1] = codes[first + k] ^ codes[first + k + 1];
        if (k == 0 && first > 0) with.across[0] = codes[first - 1] ^ codes[first];
        if (k == 0) with.ready_count = with.leaving_count = 0;
        with.end[0][k] = with.end[1][k] = nobody;
        with.visitors[k] = 0;
    }
    /// These two return whether they have made a node ready.
    ABUT_HD bool begin(std::uint32_t first, unsigned k, shared& with) const {
        const std::uint32_t leaf = first + k;
        if (leaf >= leaves) return false;
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now.
        constexpr std::uint32_t ahead = 16;
        if (leaf + ahead < leaves) ABUT_PREFETCH(boxes + ids[leaf + ahead]);
#endif
        return hang({boxes[ids[leaf]], bvh_child::leaf(ids[leaf]), leaf, leaf}, first, with);
    }
    ABUT_HD bool join(std::uint32_t first, unsigned k, shared& with) const {
        // The left box before the right one: the two zeros are told apart by it.
        return hang(
            {merge(with.nodes.box(0, k), with.nodes.box(1, k)), bvh_child::inner(first + k), with.end[0][k], with.end[1][k]},
            first, with);
    }
    /// Who waits at node k alone goes on outside.
    ABUT_HD void end(std::uint32_t first, unsigned k, shared& with) const {
        if (with.visitors[k] != 1) return;
        const std::uint32_t slot = with.end[0][k] != nobody ? 0 : 1;
        leave({2 * (first + k) + slot, with.end[slot][k]}, with.nodes.box(slot, k), with.nodes.child(slot, k), with);
    }
    /// Part t % parts of node t / parts: neighbours write side by side.
    ABUT_HD void write(std::uint32_t first, unsigned t, const shared& with) const {
        const unsigned k = t / parts;
        if (with.visitors[k] == 2) with.nodes.write(k, t % parts, nodes[first + k]);
    }
    ABUT_HD void leave(const hanging_subtree& at, const aabb<T>& box, bvh_child is, shared& with) const {
        put(at.link, box, is);
        with.leaving[execution::increment_in_group(&with.leaving_count)] = at;
    }
    ABUT_HD bool hang(const subtree& at, std::uint32_t first, shared& with) const {
        if (is_all(at)) return false;
        const hanging_subtree next = above(at, [&](std::uint32_t k) -> distance {
            return {with.across[k + 1 - first], k ^ (k + 1)};
        });
        const std::uint32_t slot = next.link % 2, k = next.link / 2 - first;  // unsigned: or before the group
        if (k >= group) {
            leave(next, at.box, at.child, with);
            return false;
        }
        with.nodes.put(slot, k, at.box, at.child);
        with.end[slot][k] = next.end;
        if (execution::increment_in_group(&with.visitors[k]) == 0) return false;
        with.ready[execution::increment_in_group(&with.ready_count)] = static_cast<std::uint16_t>(k);
        return true;
    }
};

/// Sorts n > 0 shapes by the first `bits` bits of their codes and builds the tree; its root holds the scene's box. Returns
/// how many shapes have a code that the eighth one after them has too.
template <class Code, execution_policy Policy, scalar T, class Storage>
std::uint64_t build_lbvh(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, Storage& tree, int bits) {
    const std::size_t n = boxes.size(), groups = n / execution::group_size + 1;
    const auto order = order_leaves<Code, Policy, T>(on, boxes, tree.root.data(), bits);
    execution::work_count<space_of<Policy>> crowded(on);
    execution::buffer_of<Policy, std::uint32_t> reached(on, n);  // of n - 1 nodes; the last word counts what is late
    execution::buffer_of<Policy, hanging_subtree> late(on, n + groups);
    fill(on, reached.data(), n, std::uint32_t{0});
    const climb<Code, T, space_of<Policy>> each{boxes.data(),
                                                static_cast<std::uint32_t>(n),
                                                order.codes.data(),
                                                order.ids.data(),
                                                reached.data(),
                                                tree.nodes.data(),
                                                tree.root.data(),
                                                late.data(),
                                                reached.data() + (n - 1)};
    for_each_group(on, n, each);
    for_each_indirect(on, each.late_count, each, crowded);
    return crowded.total();
}

}  // namespace abut::detail
