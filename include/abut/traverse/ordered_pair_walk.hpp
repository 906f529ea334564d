// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once, for what is least of pairs: the nearest pair of nodes first, and less and less far as better is found.
// The counterpart of ordered_walk.hpp for two trees. A walk takes a reach of pairs that shrinks (shape/pair_reach.hpp), a
// sink of execution/ordered.hpp, whose bound shrinks it, and a visitor, which offers the sink what it finds. It passes over
// nothing that may be as good as the bound.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/limits.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/pair_reach.hpp>
#include <abut/traverse/ordered_walk.hpp>
#include <abut/traverse/pair_walk.hpp>

namespace abut::detail {

/// A pair of nodes makes the pairs of their children. Of these the nearest is next, and the others wait with their
/// distances; they are dropped when their turn comes if the reach has shrunk below that. Pairs of leaves wait like nodes.
/// Trees of two shapes or more: a leaf alone has no link.
template <bvh_layout A, bvh_layout B>
struct ordered_pair_walk {
    using T = typename A::scalar_type;
    using item = tree_pair;
    static constexpr std::size_t most_shapes = pair_walk<A, B, same_frame>::most_shapes;
    A a;
    B b;
    /// Whether volumes of both trees are compared, and not the boxes around them.
    template <class Reach>
    static consteval bool compares_volumes() {
        if constexpr (bvh_layouts_of_one_volume<A, B>) {
            return requires(const Reach& reach, const typename A::volume_type& v) { reach.least_between(v, v); };
        } else {
            return false;
        }
    }

    /// All pairs below a pair of nodes.
    ABUT_CALLS_ANY
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    ABUT_HD void operator()(const item& from, Reach& reach, const Best& best, const Visitor& visitor) const {
        entry pending[bvh_max_depth * (A::width * B::width - 1) + 1];  // not initialised
        double bound = infinity<double>;
        tighten(reach, best, bound);
        pending[0] = {from, least_of(from, reach)};
        for (int waiting = 1; waiting > 0;) {
            const entry at = pending[--waiting];
            if (!reach.keeps(at.least)) continue;
            if (is_pair_of_leaves(at.nodes)) {
                visitor(shape_of_leaf(a, at.nodes.a), shape_of_leaf(b, at.nodes.b));
                tighten(reach, best, bound);
            } else {
                open(at.nodes, reach, pending, waiting);
            }
        }
    }

    /// One pair of shapes below a pair of nodes that is likely to be near: always on to the nearest pair of children.
    ABUT_CALLS_ANY
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    ABUT_HD void descend(item at, Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        entry pending[A::width * B::width];
        while (!is_pair_of_leaves(at)) {
            int kept = 0;
            open(at, reach, pending, kept);
            if (kept == 0) return;
            at = pending[kept - 1].nodes;
        }
        visitor(shape_of_leaf(a, at.a), shape_of_leaf(b, at.b));
    }

private:
    struct entry {
        item nodes;
        T least;
    };

    [[nodiscard]] ABUT_HD static bool is_pair_of_leaves(const item& at) { return (at.a & at.b & bvh_child::leaf_bit) != 0; }
    template <class Tree>
    [[nodiscard]] ABUT_HD static aabb<T> bounds_of(const Tree& tree, std::uint32_t bits) {
        const node_or_leaf at(bits, Tree::width);
        const auto& node = tree.fetch(at.node);
        if (at.is_leaf) return tree.bounds(node, static_cast<int>(at.slot));
        aabb<T> box = tree.bounds(node, 0);
        for (int slot = 1; slot < tree.children(node); ++slot) box = merge(box, tree.bounds(node, slot));
        return box;
    }
    /// A child's volume, if both trees have volumes that the reach knows, or else its box.
    template <class Reach, class Tree>
    [[nodiscard]] ABUT_HD static auto what_bounds(const Tree& tree, const typename Tree::node_type& node, int slot) {
        if constexpr (compares_volumes<Reach>()) {
            return tree.volume(node, slot);
        } else {
            return tree.bounds(node, slot);
        }
    }
    template <class Reach>
    [[nodiscard]] ABUT_HD T least_of(const item& at, const Reach& reach) const {
        return reach.least_between(bounds_of(a, at.a), bounds_of(b, at.b));
    }

    /// Adds the pairs of children that the reach keeps, the nearest last.
    template <class Reach>
    ABUT_HD void open(const item& at, const Reach& reach, entry* pending, int& waiting) const {
        const node_or_leaf at_a(at.a, A::width), at_b(at.b, B::width);
        const auto& of_a = a.fetch(at_a.node);
        const auto& of_b = b.fetch(at_b.node);
        const int first = waiting, end_a = at_a.end_of_slots(a.children(of_a)), end_b = at_b.end_of_slots(b.children(of_b));
        const int first_b = at_b.first_slot();
        using seen_of_b = std::remove_cvref_t<decltype(reach.see_of_b(what_bounds<Reach>(b, of_b, 0)))>;
        seen_of_b seen[B::width];  // not initialised
        for (int j = first_b; j < end_b; ++j) seen[j - first_b] = reach.see_of_b(what_bounds<Reach>(b, of_b, j));
        for (int i = at_a.first_slot(); i < end_a; ++i) {
            const auto seen_of_a = reach.see_of_a(what_bounds<Reach>(a, of_a, i));
            const std::uint32_t child_a = link_to(a.child(of_a, i), A::width * at_a.node + static_cast<std::uint32_t>(i));
            for (int j = first_b; j < end_b; ++j) {
                const T least = reach.least_between(seen_of_a, seen[j - first_b]);
                if (!reach.keeps(least)) continue;
                const std::uint32_t child_b =
                    link_to(b.child(of_b, j), B::width * at_b.node + static_cast<std::uint32_t>(j));
                int place = waiting++;
                for (; place > first && pending[place - 1].least < least; --place) pending[place] = pending[place - 1];
                pending[place] = {{child_a, child_b}, least};
            }
        }
    }
};

}  // namespace abut::detail
