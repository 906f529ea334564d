// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once, for what is least of pairs: the nearest pair of nodes first, and less and less far as better is found.
// The counterpart of ordered_walk.hpp for two trees. A walk takes a reach of pairs that shrinks (shape/pair_reach.hpp), a
// sink of execution/ordered.hpp, whose bound shrinks it, and a visitor, which offers the sink what it finds. It passes over
// nothing that may be as good as the bound.

#include <algorithm>
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

/// A pair of nodes makes the pairs of their children, which wait with their distances. Of all that wait the nearest pair is
/// next, while there is room: so hardly more is opened than has to be. What comes when there is none is walked depth first,
/// the nearest pair of children before the others. What is farther than the reach when its turn comes is dropped. Pairs of
/// leaves wait like nodes. Trees of two shapes or more: a leaf alone has no link.
///
/// A device walks depth first alone. A heap lies in its local memory, and took up to twice as long.
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
        double bound = infinity<double>;
        tighten(reach, best, bound);
        const entry whole{from, least_of(from, reach)};
#if ABUT_DEVICE_CODE
        walk_depth_first(whole, reach, best, bound, visitor);
#else
        if (!(bound < infinity<double>)) descend(from, reach, best, visitor);
        nearest_first pending;
        pending.add(whole);
        while (pending.count > 0) {
            const entry at = pending.take();
            if (!reach.keeps(at.least)) return;
            if (is_pair_of_leaves(at.nodes)) {
                visitor(shape_of_leaf(a, at.nodes.a), shape_of_leaf(b, at.nodes.b));
                tighten(reach, best, bound);
            } else if (pending.has_room()) {
                open(at.nodes, reach, pending);
            } else {
                walk_depth_first(at, reach, best, bound, visitor);
            }
        }
#endif
    }

    /// One pair of shapes below a pair of nodes that is likely to be near: always on to the nearest pair of children.
    ABUT_CALLS_ANY
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    ABUT_HD void descend(item at, Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        while (!is_pair_of_leaves(at)) {
            only_nearest next;
            open(at, reach, next);
            if (!next.is) return;
            at = next.found.nodes;
        }
        visitor(shape_of_leaf(a, at.a), shape_of_leaf(b, at.b));
    }

private:
    static constexpr int most_children = A::width * B::width;
    struct entry {
        item nodes;
        T least;
    };
    /// The nearest alone.
    struct only_nearest {
        entry found{};
        bool is = false;
        ABUT_HD void add(const entry& one) {
            if (is && !(found.least > one.least)) return;
            found = one;
            is = true;
        }
    };
    /// A heap of a host: the nearest is taken. What is no number counts as 0.
    struct nearest_first {
        static constexpr int room = 256;
        entry at[std::size_t{room}];  // not initialised
        int count = 0;

        [[nodiscard]] bool has_room() const { return count <= room - most_children; }
        void add(entry one) {
            one.least = one.least > 0 ? one.least : 0;
            at[count++] = one;
            std::push_heap(at, at + count, is_farther);
        }
        entry take() {
            std::pop_heap(at, at + count, is_farther);
            return at[--count];
        }
        static bool is_farther(const entry& a, const entry& b) { return a.least > b.least; }
    };
    /// A stack: of what a pair makes the nearest is taken first, and all of it before what was there.
    struct newest_first {
        entry at[std::size_t{bvh_max_depth * (most_children - 1) + 1}];  // not initialised
        int count = 0, first = 0;

        ABUT_HD entry take() {
            const entry newest = at[--count];
            first = count;
            return newest;
        }
        ABUT_HD void add(const entry& one) {
            int place = count++;
            for (; place > first && one.least > at[place - 1].least; --place) at[place] = at[place - 1];
            at[place] = one;
        }
    };

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void walk_depth_first(const entry& from, Reach& reach, const Best& best, double& bound,
                                  const Visitor& visitor) const {
        newest_first pending;
        pending.add(from);
        while (pending.count > 0) {
            const entry at = pending.take();
            if (!reach.keeps(at.least)) continue;
            if (is_pair_of_leaves(at.nodes)) {
                visitor(shape_of_leaf(a, at.nodes.a), shape_of_leaf(b, at.nodes.b));
                tighten(reach, best, bound);
            } else {
                open(at.nodes, reach, pending);
            }
        }
    }

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

    /// Adds the pairs of children that the reach keeps.
    template <class Reach, class Pending>
    ABUT_HD void open(const item& at, const Reach& reach, Pending& pending) const {
        const node_or_leaf at_a(at.a, A::width), at_b(at.b, B::width);
        const auto& of_a = a.fetch(at_a.node);
        const auto& of_b = b.fetch(at_b.node);
        const int end_a = at_a.end_of_slots(a.children(of_a)), end_b = at_b.end_of_slots(b.children(of_b));
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
                pending.add({{child_a, child_b}, least});
            }
        }
    }
};

}  // namespace abut::detail
