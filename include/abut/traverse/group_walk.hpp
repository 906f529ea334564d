// SPDX-License-Identifier: MIT
#pragma once

// A walk of many points at once, which lie near each other, through a tree: what may be nearest to one of them. The members
// of a group (execution/group.hpp) test another node each, against the box around the points.

#include <cstdint>

#include <abut/execution/group.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/point_reach.hpp>

namespace abut::detail {

/// Nodes wait in memory that the members share. The newest are taken first, as many as there are members for their children.
/// Where this might exceed `room`, one is taken at a time; then no more wait than room + (width - 1) * depth.
template <bvh_layout Tree>
struct group_tree_walk {
    using T = typename Tree::scalar_type;
    static constexpr unsigned members_of_group = execution::subgroup_size, room = 96;
    struct shared {
        bvh_child nodes[room + (Tree::width - 1) * bvh_max_depth];
        std::uint32_t leaves[2 * members_of_group];
    };
    Tree tree;

    /// A shape near p: that of the leaf which is found by the nearer child each time; of boxes around p by that with the nearer
    /// middle.
    ABUT_HD std::uint32_t shape_near(const vec3<T>& p) const {
        const shrinking_ball<T> ball{p, {}};
        bvh_child at = tree.root();
        while (!at.is_leaf()) {
            const auto& node = tree.fetch(at.index());
            T least = infinity<T>, least_to_middle = infinity<T>;
            for (int slot = 0; slot < tree.children(node); ++slot) {
                const aabb<T> box = tree.bounds(node, slot);
                const vec3<T> way = p - (T(0.5) * box.lower + T(0.5) * box.upper);
                const T to_box = ball.least_in(box), to_middle = dot(way, way);
                if (slot > 0 && !(to_box < least || (to_box == least && to_middle < least_to_middle))) continue;
                at = tree.child(node, slot), least = to_box, least_to_middle = to_middle;
            }
        }
        return at.index();
    }

    /// visit(leaves, n, is_last) for all shapes whose boxes the reach keeps, as many as there are members or fewer at a
    /// time, until it returns false.
    ABUT_CALLS_ANY
    template <class Members, class Visitor>
    ABUT_HD void operator()(const Members& members, shared& memory, const group_reach<T>& reach,
                            const Visitor& visit) const {
        constexpr unsigned width = Tree::width, at_a_time = members_of_group / width;
        const bvh_child root = tree.root();
        unsigned waiting = !root.is_leaf(), leaves = root.is_leaf();
        members.each([&](unsigned k) {
            if (k == 0) memory.nodes[0] = root, memory.leaves[0] = root.index();
        });
        for (;;) {
            while (waiting > 0 && leaves < members_of_group) {
                unsigned take = waiting < at_a_time ? waiting : at_a_time;
                if (waiting + take * (width - 1) > room) take = 1;
                waiting -= take;
                typename Members::template value<bvh_child> child;
                typename Members::template value<bool> is_near;
                members.each([&](unsigned k) {
                    is_near[k] = false;
                    if (k / width >= take) return;
                    const auto& node = tree.fetch(memory.nodes[waiting + k / width].index());
                    const int slot = static_cast<int>(k % width);
                    if (slot >= tree.children(node)) return;
                    child[k] = tree.child(node, slot);
                    is_near[k] = reach(tree.bounds(node, slot));
                });
                members.each([&](unsigned k) {
                    const bool is_leaf = is_near[k] && child[k].is_leaf();
                    members.append(waiting, is_near[k] && !is_leaf, [&](unsigned at) { memory.nodes[at] = child[k]; });
                    members.append(leaves, is_leaf, [&](unsigned at) { memory.leaves[at] = child[k].index(); });
                });
            }
            const unsigned n = leaves < members_of_group ? leaves : members_of_group;
            leaves -= n;
            const bool is_last = waiting + leaves == 0;
            if (!visit(memory.leaves + leaves, n, is_last) || is_last) return;
        }
    }
};

}  // namespace abut::detail
