// SPDX-License-Identifier: MIT
#pragma once

// A tree against itself: each pair of two leaves whose boxes overlap, once, in one of its two orders. A pair of two nodes
// goes on as in pair_walk.hpp. A node with itself makes each child with itself and each child with those behind it; what the
// others would find is there already.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/index/bvh.hpp>
#include <abut/traverse/pair_walk.hpp>

namespace abut::detail {

/// Down one tree with itself, a step at a time, as the verb for_each_descendant takes it. The tree has two leaves or more.
/// `overlap` has to keep a pair of boxes in either order: a pose's slack covers both (shape/relative_pose.hpp).
template <bvh_layout Tree, class Overlap>
struct self_walk {
    using pairs = pair_walk<Tree, Tree, Overlap>;
    using item = typename pairs::item;
    static constexpr unsigned width = pairs::width_a;
    static constexpr unsigned most_children = pairs::most_children, most_depth = pairs::most_depth;
    static constexpr std::size_t most_shapes = pairs::most_shapes;

    pairs both;

    self_walk(const Tree& tree, const Overlap& overlap) : both{tree, tree, overlap} {}

    [[nodiscard]] ABUT_HD const Tree& tree() const { return both.a; }
    [[nodiscard]] ABUT_HD static constexpr std::size_t seeds() { return 1; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return both.seed(i); }
    ABUT_INLINE void prefetch(const item& at) const { both.prefetch(at); }

    /// As pair_walk's; the visitor's two ids differ.
    template <class Add, class Visitor>
    ABUT_INLINE ABUT_HD void expand(const item& at, const Add& add, const Visitor& visitor) const {
        expand(both, at, at.a != at.b, add, visitor);
    }
    /// The same for a walk of any two trees, of which the item may be a node with itself, or `two`.
    template <class Add, class Visitor>
    ABUT_INLINE ABUT_HD static void expand(const pairs& both, const item& at, bool two, const Add& add, const Visitor& visitor) {
        both.expand(at, add_once<Add>{add, two}, visit_once<Visitor>{visitor, two});
    }

private:
    // What a step hands on, without what a node with itself would make twice. No lambdas, as in pair_walk.
    template <class Add>
    struct add_once {
        const Add& add;
        bool two;  ///< nodes, and not one with itself
        ABUT_CALLS_ANY
        template <class Number>
        ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const item& next) const {
            add(k, is & (two | (k / width <= k % width)), next);
        }
    };
    template <class Visitor>
    struct visit_once {
        const Visitor& visitor;
        bool two;
        ABUT_CALLS_ANY
        template <class Number>
        ABUT_INLINE ABUT_HD void operator()(Number k, bool is, std::uint32_t i, std::uint32_t j) const {
            visitor(k, is & (two | (k / width < k % width)), i, j);
        }
    };
};

}  // namespace abut::detail
