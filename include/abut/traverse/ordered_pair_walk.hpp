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
    tie_watch* watch = nullptr;  ///< of both trees, on a host

    /// Whether volumes of both trees are compared, and not the boxes around them.
    template <class Reach>
    static consteval bool compares_volumes() {
        if constexpr (bvh_layouts_of_one_volume<A, B>) {
            return requires(const Reach& reach, const typename A::volume_type& v) { reach.least_between(v, v); };
        } else {
            return false;
        }
    }

    struct entry {
        item nodes;
        T least;
    };
    /// A heap of a host: the nearest is taken. What is no number counts as 0.
    template <int Room = 256>
    struct nearest_first {
        entry at[std::size_t{Room}];  // not initialised
        int count = 0;

        [[nodiscard]] bool has_room() const { return count <= Room - most_children; }
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

    /// All pairs below a pair of nodes. visitor(id, id) may say whether the two are as near as the best. A visitor may also
    /// say what cannot come before that: what has no lesser ids, visitor.may_come_first(id, id), and lies in boxes that are no
    /// nearer, visitor.may_be_nearer(box, box).
    ABUT_CALLS_ANY
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    ABUT_HD void operator()(const item& from, Reach& reach, const Best& best, const Visitor& visitor) const {
#if ABUT_DEVICE_CODE
        double bound = infinity<double>;
        tighten(reach, best, bound);
        told nothing;
        walk_depth_first({from, least_of(from, reach)}, nothing, reach, best, bound, visitor);
#else
        nearest_first<> pending;
        begin(from, pending, reach, best, visitor);
        go_on(pending, all_steps, reach, best, visitor);
#endif
    }
    /// The same in parts, on a host: what is to be walked; and a walk that leaves the rest after `most` steps, or where there is
    /// no more room for it.
    ///@{
    static constexpr std::size_t all_steps = static_cast<std::size_t>(-1);
    template <class Pending, shrinking_pair_reach<T> Reach, class Best, class Visitor>
    void begin(const item& from, Pending& pending, Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        pending.add({from, least_of(from, reach)});
        if (!(bound < infinity<double>)) descend(from, reach, best, visitor);
    }
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    void below(const entry& from, Reach& reach, const Best& best, const Visitor& visitor) const {
        nearest_first<> pending;
        pending.add(from);
        go_on(pending, all_steps, reach, best, visitor);
    }
    template <class Pending, shrinking_pair_reach<T> Reach, class Best, class Visitor>
    void go_on(Pending& pending, std::size_t most, Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        told ties(watch);
        for (std::size_t steps = 0; pending.count > 0; ++steps) {
            if (most != all_steps && (steps >= most || !pending.has_room())) return;
            const entry at = pending.take();
            if (!reach.keeps(at.least)) {
                pending.count = 0;
                return;
            }
            if (is_passed_over(at.nodes, ties, visitor)) continue;
            if (is_pair_of_leaves(at.nodes)) {
                visit(at.nodes, ties, visitor);
                tighten(reach, best, bound);
            } else if (pending.has_room()) {
                open(at.nodes, ties, reach, pending);
            } else {
                walk_depth_first(at, ties, reach, best, bound, visitor);
            }
        }
    }
    ///@}

    /// One pair of shapes below a pair of nodes that is likely to be near: always on to the nearest pair of children.
    ABUT_CALLS_ANY
    template <shrinking_pair_reach<T> Reach, class Best, class Visitor>
    ABUT_HD void descend(item at, Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        while (!is_pair_of_leaves(at)) {
            only_nearest next;
            open(at, told(), reach, next);
            if (!next.is) return;
            at = next.found.nodes;
        }
        visitor(shape_of_leaf(a, at.a), shape_of_leaf(b, at.b));
    }

    [[nodiscard]] ABUT_HD static bool is_pair_of_leaves(const item& at) { return (at.a & at.b & bvh_child::leaf_bit) != 0; }
    /// One step of binary trees, as expanders take them (execution/roles.hpp): take(k, kept, pair, least) of the pairs k = 0 ... 3 of
    /// children, which are constants to the compiler.
    ABUT_CALLS_ANY
    template <class Reach, class Take>
    ABUT_INLINE ABUT_HD void open_four(const item& at, const Reach& reach, const Take& take) const {
        static_assert(A::width == 2 && B::width == 2);
        const node_or_leaf at_a(at.a, 2), at_b(at.b, 2);
        const auto& of_a = a.fetch(at_a.node);
        const auto& of_b = b.fetch(at_b.node);
        const auto one = [&](auto k) {
            constexpr int i = decltype(k)::value / 2, j = decltype(k)::value % 2;
            const bool is = (!at_a.is_leaf || at_a.slot == i) && (!at_b.is_leaf || at_b.slot == j);
            const T least = reach.least_between(reach.see_of_a(what_bounds<Reach>(a, of_a, i)),
                                                reach.see_of_b(what_bounds<Reach>(b, of_b, j)));
            take(k, is && reach.keeps(least),
                 item{link_to(a.child(of_a, i), 2 * at_a.node + i), link_to(b.child(of_b, j), 2 * at_b.node + j)}, least);
        };
        one(std::integral_constant<int, 0>{});
        one(std::integral_constant<int, 1>{});
        one(std::integral_constant<int, 2>{});
        one(std::integral_constant<int, 3>{});
    }

private:
    static constexpr int most_children = A::width * B::width;
    /// What is known of one tree, to half a pair.
    struct known_half : known_below {
        /// The half that is made of a child, with the link to it.
        [[nodiscard]] ABUT_HD std::uint32_t fold(bvh_child child, std::uint32_t link) const {
#if !ABUT_DEVICE_CODE
            if (!child.is_leaf() && known_below::fold(child).is_leaf()) return bvh_child::leaf_bit | links[child.index()];
#endif
            return link_to(child, link);
        }
    };
    /// What is known of ties, and how many a walk has met (index/ties.hpp).
    struct told {
        known_half of_a{}, of_b{};
        std::uint32_t met = 0;

        told() = default;
        explicit told(const tie_watch* from) { learn(from); }
        void learn(const tie_watch* from) {
            if (from != nullptr) of_a = {from->known(0)}, of_b = {from->known(1)};
        }
    };
    ABUT_CALLS_ANY
    template <class Visitor>
    ABUT_HD void visit(const item& at, [[maybe_unused]] told& ties, const Visitor& visitor) const {
        const std::uint32_t id_a = shape_of_leaf(a, at.a), id_b = shape_of_leaf(b, at.b);
#if !ABUT_DEVICE_CODE
        if constexpr (std::same_as<decltype(visitor(id_a, id_b)), bool>) {
            if (visitor(id_a, id_b) && watch != nullptr && ++ties.met > watch->few && watch->met()) ties.learn(watch);
            return;
        }
#endif
        visitor(id_a, id_b);
    }
    /// Whether what is below a pair of nodes cannot come before the best: it is no nearer, and has no lesser ids.
    ABUT_CALLS_ANY
    template <class Visitor>
    [[nodiscard]] ABUT_HD bool is_passed_over([[maybe_unused]] const item& at, [[maybe_unused]] const told& ties,
                                              [[maybe_unused]] const Visitor& visitor) const {
#if !ABUT_DEVICE_CODE
        if constexpr (requires(const aabb<T>& box) { visitor.may_be_nearer(box, box); }) {
            if (ties.of_a.of_nodes == nullptr || ties.of_b.of_nodes == nullptr) return false;
            return !visitor.may_come_first(least_id(a, at.a, ties.of_a), least_id(b, at.b, ties.of_b)) &&
                   !visitor.may_be_nearer(bounds_of(a, at.a), bounds_of(b, at.b));
        }
#endif
        return false;
    }
    template <class Tree>
    [[nodiscard]] static std::uint32_t least_id(const Tree& tree, std::uint32_t half, const known_half& known) {
        return (half & bvh_child::leaf_bit) != 0 ? shape_of_leaf(tree, half) : known.least_id(half);
    }
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
    ABUT_HD void walk_depth_first(const entry& from, told& ties, Reach& reach, const Best& best, double& bound,
                                  const Visitor& visitor) const {
        newest_first pending;
        pending.add(from);
        while (pending.count > 0) {
            const entry at = pending.take();
            if (!reach.keeps(at.least) || is_passed_over(at.nodes, ties, visitor)) continue;
            if (is_pair_of_leaves(at.nodes)) {
                visit(at.nodes, ties, visitor);
                tighten(reach, best, bound);
            } else {
                open(at.nodes, ties, reach, pending);
            }
        }
    }

    template <class Tree>
    [[nodiscard]] ABUT_HD static aabb<T> bounds_of(const Tree& tree, std::uint32_t bits) {
        const node_or_leaf at(bits, Tree::width);
        if (at.is_leaf) return tree.bounds(tree.fetch(at.node), static_cast<int>(at.slot));
        return box_of_node(tree, at.node);
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
    ABUT_CALLS_ANY
    template <class Reach, class Pending>
    ABUT_HD void open(const item& at, const told& ties, const Reach& reach, Pending& pending) const {
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
            const std::uint32_t child_a =
                ties.of_a.fold(a.child(of_a, i), A::width * at_a.node + static_cast<std::uint32_t>(i));
            for (int j = first_b; j < end_b; ++j) {
                const T least = reach.least_between(seen_of_a, seen[j - first_b]);
                if (!reach.keeps(least)) continue;
                const std::uint32_t child_b =
                    ties.of_b.fold(b.child(of_b, j), B::width * at_b.node + static_cast<std::uint32_t>(j));
                pending.add({{child_a, child_b}, least});
            }
        }
    }
};

}  // namespace abut::detail
