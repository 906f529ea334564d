// SPDX-License-Identifier: MIT
#pragma once

// One query against a tree: a depth-first walk with a stack of the inner nodes still to see.

#include <cstdint>

#include <abut/index/bvh.hpp>
#include <abut/traverse/reach.hpp>
#include <abut/traverse/visit.hpp>

namespace abut::detail {

template <bvh_layout Tree>
struct bvh_walk {
    using scalar_type = typename Tree::scalar_type;
    Tree tree;

    /// False if the query touches nothing in the tree.
    template <class Reach>
    ABUT_HD bool may_touch(Reach& reach) const {
        return reach(tree.root_bounds());
    }

    /// Calls visitor(shape id) -> visit for every leaf whose box the query reaches, until it says stop.
    template <class Reach, class Visitor>
    ABUT_HD void for_each(Reach& reach, Visitor&& visitor) const {
        const bvh_child root = tree.root();
        if (root.is_leaf()) {
            visitor(root.index());
        } else {
            for_each_below(root.index(), reach, visitor);
        }
    }

    /// The same for the leaves below an inner node.
    template <class Reach, class Visitor>
    ABUT_HD void for_each_below(std::uint32_t node, Reach& reach, Visitor&& visitor) const {
        if constexpr (Tree::width > 2) {
            for_each_below_wide(node, reach, visitor);
        } else {
            for_each_below_two(node, reach, visitor);
        }
    }

private:
    template <class Reach, class Visitor>
    ABUT_HD void for_each_below_two(std::uint32_t node, Reach& reach, Visitor& visitor) const {
        // One entry at most for each level above the current node.
        std::uint32_t pending[bvh_max_depth];
        int depth = 0;
        for (;;) {
            const typename Tree::node_type both = tree.fetch(node);
            const bvh_child left = tree.child(both, 0), right = tree.child(both, 1);
            // Most of a walk on a processor core is waiting for nodes: both are asked for before either is known to be
            // needed.
            tree.prefetch(left);
            tree.prefetch(right);
            bool go_left = reach(tree.bounds(both, 0)), go_right = reach(tree.bounds(both, 1));
            if (go_left && left.is_leaf()) {
                if (visitor(left.index()) == visit::stop) return;
                go_left = false;
            }
            if (go_right && right.is_leaf()) {
                if (visitor(right.index()) == visit::stop) return;
                go_right = false;
            }
            if (go_left) {
                node = left.index();
                if (go_right) pending[depth++] = right.index();
            } else if (go_right) {
                node = right.index();
            } else if (depth > 0) {
                node = pending[--depth];
            } else {
                return;
            }
        }
    }

    template <class Reach, class Visitor>
    ABUT_HD void for_each_below_wide(std::uint32_t node, Reach& reach, Visitor& visitor) const {
        std::uint32_t pending[bvh_max_depth * (Tree::width - 1) + 1];
        int waiting = 0;
        for (;;) {
            const auto& all = tree.fetch(node);
            for (int side = 0; side < tree.children(all); ++side) {
                if (!reach(tree.bounds(all, side))) continue;
                const bvh_child child = tree.child(all, side);
                if (child.is_leaf()) {
                    if (visitor(child.index()) == visit::stop) return;
                } else {
                    tree.prefetch(child);
                    pending[waiting++] = child.index();
                }
            }
            if (waiting == 0) return;
            node = pending[--waiting];
        }
    }
};

}  // namespace abut::detail
