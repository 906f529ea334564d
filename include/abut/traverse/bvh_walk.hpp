// SPDX-License-Identifier: MIT
#pragma once

// One query against a tree: a depth-first walk with a stack of the inner nodes still to see.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/index/bvh.hpp>
#include <abut/shape/box_lanes.hpp>
#include <abut/traverse/traversal.hpp>

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

    /// Where a walk that rests goes on: the inner nodes still to see, the next one last.
    struct cursor {
        static constexpr int stack_size = Tree::width > 2 ? bvh_max_depth*(Tree::width - 1) + 1 : bvh_max_depth + 1;
        std::uint32_t pending[std::size_t{stack_size}];  ///< not initialised
        int waiting = -1;                                ///< how many; a walk that has not begun has the root to see
    };

    /// Calls visitor(shape id) -> visit for every leaf whose box the query reaches, until it says stop. Rests where rests()
    /// says so, which it is asked before each node; then it returns true, and another call with the same query goes on from
    /// `at`, a cursor of this walk or one with more room. At its end it returns false.
    ABUT_CALLS_ANY
    template <class Reach, class Cursor, class Rests, class Visitor>
    ABUT_HD bool for_each(Reach& reach, Cursor& at, const Rests& rests, Visitor&& visitor) const {
        if (at.waiting < 0) {
            const bvh_child root = tree.root();
            at.waiting = 0;
            if (root.is_leaf()) {
                visitor(root.index());
            } else {
                at.pending[at.waiting++] = root.index();
            }
        }
        if (at.waiting == 0) return false;
        if constexpr (Tree::width > 2) {
            return for_each_below_wide(reach, at, rests, visitor);
        } else {
            return for_each_below_two(reach, at, rests, visitor);
        }
    }

private:
    ABUT_CALLS_ANY
    template <class Reach, class Cursor, class Rests, class Visitor>
    ABUT_HD bool for_each_below_two(Reach& reach, Cursor& at, const Rests& rests, Visitor& visitor) const {
        // One entry at most for each level above the current node.
        std::uint32_t* const pending = at.pending;
        int depth = at.waiting - 1;
        std::uint32_t node = pending[depth];
        at.waiting = 0;
        for (;;) {
            if (rests()) {
                pending[depth] = node;
                at.waiting = depth + 1;
                return true;
            }
            const typename Tree::node_type both = tree.fetch(node);
            const bvh_child left = tree.child(both, 0), right = tree.child(both, 1);
            // Most of a walk on a processor core is waiting for nodes: both are asked for before either is known to be
            // needed.
            tree.prefetch(left);
            tree.prefetch(right);
            bool go_left = reach(tree.bounds(both, 0)), go_right = reach(tree.bounds(both, 1));
            if (go_left && left.is_leaf()) {
                if (visitor(left.index()) == visit::stop) return false;
                go_left = false;
            }
            if (go_right && right.is_leaf()) {
                if (visitor(right.index()) == visit::stop) return false;
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
                return false;
            }
        }
    }

    ABUT_CALLS_ANY
    template <class Reach, class Cursor, class Rests, class Visitor>
    ABUT_HD bool for_each_below_wide(Reach& reach, Cursor& at, const Rests& rests, Visitor& visitor) const {
        std::uint32_t* const pending = at.pending;
        int waiting = at.waiting;
        [[maybe_unused]] const auto around = box_lanes<scalar_type>::all(reach.bounds());
        while (waiting > 0) {
            if (rests()) {
                at.waiting = waiting;
                return true;
            }
            const auto& all = tree.fetch(pending[--waiting]);
            unsigned left = (1u << tree.children(all)) - 1;
            // All four by the box around the reach, and what that keeps by the reach. A line's box tells little.
            if constexpr (!requires { reach.shrink_to(1.0); }) {
                const decltype(overlaps(around, around)) boxes[] = {overlaps(around, tree.all_bounds(all))};
                left &= bits_of(boxes);
            }
            for (; left != 0; left &= left - 1) {
                const int slot = static_cast<int>(lowest_bit(left));
                if constexpr (!std::same_as<std::remove_cv_t<Reach>, box_reach<scalar_type>>) {
                    if (!reach(tree.bounds(all, slot))) continue;
                }
                const bvh_child child = tree.child(all, slot);
                if (child.is_leaf()) {
                    if (visitor(child.index()) == visit::stop) return false;
                } else {
                    tree.prefetch(child);
                    pending[waiting++] = child.index();
                }
            }
        }
        return false;
    }
};

}  // namespace abut::detail
