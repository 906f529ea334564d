// SPDX-License-Identifier: MIT
#pragma once

// Walks that look for what is least: nearest first, and less and less far as better is found. A walk takes a reach that
// shrinks, a sink of execution/ordered.hpp, whose bound shrinks it, and a visitor, which offers the sink what it finds. It
// passes over nothing that may be as good as the bound, so that of equals the least key is found too.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>
#include <abut/index/ties.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/shape/view.hpp>
#include <abut/traverse/grid_walk.hpp>

namespace abut {

namespace detail {

/// What the sink knows by now shrinks the reach; `bound` is what it knew before.
ABUT_CALLS_ANY
template <class Reach, class Best>
ABUT_HD void tighten(Reach& reach, const Best& best, double& bound) {
    if (best.bound() < bound) {
        bound = best.bound();
        reach.shrink_to(bound);
    }
}

/// Least distance of what a node's slot holds: of its volume where there is one that tells, or else of its box.
template <class Reach, class Tree>
ABUT_HD auto least_in_slot(const Reach& reach, const Tree& tree, const typename Tree::node_type& node, int slot) {
    if constexpr (requires { reach.least_in(tree.volume(node, slot)); }) {
        return reach.least_in(tree.volume(node, slot));
    } else {
        return reach.least_in(tree.bounds(node, slot));
    }
}

/// Around all children of a node.
template <class Tree>
ABUT_HD auto box_of_node(const Tree& tree, std::uint32_t number) {
    const auto& node = tree.fetch(number);
    auto box = tree.bounds(node, 0);
    for (int slot = 1; slot < tree.children(node); ++slot) box = merge(box, tree.bounds(node, slot));
    return box;
}

/// A reach that a walk through a tree can take: it looks at one box, or at the four boxes of a node at once.
template <class Reach, class Tree>
concept ordered_reach = shrinking_reach<Reach, typename Tree::scalar_type> || requires { Reach::takes_four; };

/// Where a walk through a tree is: at a node or a leaf, while `waiting` others wait in a room, with their distances. The
/// room is apart, since compilers for devices keep no part of a struct in registers that has an array in it.
template <bvh_layout Tree>
struct place_in_tree {
    using T = typename Tree::scalar_type;
    struct entry {
        bvh_child child;
        T least;
    };
    entry at;
    int waiting;
    using room = entry[bvh_max_depth * (Tree::width - 1) + 1];

    ABUT_HD void begin(const Tree& tree, const known_below& below) {
        at = {below.fold(tree.root()), T(0)};
        waiting = 0;
    }

    /// From an inner node on. False where nothing is left. Nodes of copies alone are taken for the first of these.
    template <class Reach>
    ABUT_HD bool descend(const Tree& tree, const known_below& below, const Reach& reach, room& pending) {
        const auto& node = tree.fetch(at.child.index());
        if constexpr (requires { Reach::takes_four; }) {
            // The nearest goes on; the others wait, the farthest below. Often there is one alone.
            T least_of[4];
            unsigned kept = reach.least_in_four(tree.all_planes(node), least_of) & ((1u << tree.children(node)) - 1);
            if (kept == 0) return next(reach, pending);
            const auto take = [&] {
                const auto slot = static_cast<int>(lowest_bit(kept));
                kept &= kept - 1;
                return entry{below.fold(tree.child(node, slot)), least_of[slot]};
            };
            at = take();
            const int first = waiting;
            while (kept != 0) {
                entry other = take();
                if (other.least < at.least) {
                    const entry before = at;
                    at = other;
                    other = before;
                }
                int k = waiting++;
                for (; k > first && other.least > pending[k - 1].least; --k) pending[k] = pending[k - 1];
                pending[k] = other;
                tree.prefetch(other.child);
            }
        } else {
            at = {below.fold(tree.child(node, 0)), least_in_slot(reach, tree, node, 0)};
            tree.prefetch(at.child);
            for (int slot = 1; slot < tree.children(node); ++slot) {
                entry other{below.fold(tree.child(node, slot)), least_in_slot(reach, tree, node, slot)};
                tree.prefetch(other.child);
                if (other.least < at.least) {
                    const entry before = at;
                    at = other;
                    other = before;
                }
                pending[waiting] = other;
                waiting += reach.keeps(other.least);
            }
        }
        return true;
    }

    /// To what waits. False where nothing is left.
    template <class Reach>
    ABUT_HD bool next(const Reach& reach, const room& pending) {
        do {
            if (waiting == 0) return false;
            at = pending[--waiting];
        } while (!reach.keeps(at.least));
        return true;
    }
};

/// Ties as one walk of a tree meets them, on a host: what is known lets it pass over copies (index/ties.hpp).
template <class Watch = tie_watch>
struct ties_met {
    Watch* watch;
    known_below below{};
    std::uint32_t count = 0;

    ABUT_HD explicit ties_met([[maybe_unused]] Watch* of_call) : watch(of_call) {
#if !ABUT_DEVICE_CODE
        if (watch != nullptr) below = watch->known(0);
#endif
    }
    /// Has a visitor look at a shape. It says whether that is as near as the best, if it can tell.
    ABUT_CALLS_ANY
    template <class Visitor>
    ABUT_HD void visit(const Visitor& visitor, std::uint32_t id) {
#if !ABUT_DEVICE_CODE
        if constexpr (std::same_as<decltype(visitor(id)), bool>) {
            if (visitor(id) && watch != nullptr && ++count > watch->few && watch->met()) below = watch->known(0);
            return;
        }
#endif
        visitor(id);
    }
    /// Whether what is below a node cannot come before the best: of visitors that say what may (ordered_pair_walk.hpp), what has no
    /// lesser id and is no nearer; of others, since nothing is less than 0. By bits: some modes take denormal numbers for it.
    ABUT_CALLS_ANY
    template <class Tree, class Best, class Visitor>
    [[nodiscard]] ABUT_HD bool is_passed_over([[maybe_unused]] const Tree& tree, [[maybe_unused]] std::uint32_t node,
                                              [[maybe_unused]] const Best& best,
                                              [[maybe_unused]] const Visitor& visitor) const {
#if !ABUT_DEVICE_CODE
        if constexpr (requires { visitor.may_be_nearer(box_of_node(tree, node)); }) {
            return below.of_nodes != nullptr && !visitor.may_come_first(below.least_id(node)) &&
                   !visitor.may_be_nearer(box_of_node(tree, node));
        } else if constexpr (requires { best.known(); }) {
            if (below.of_nodes == nullptr || ABUT_BIT_CAST(std::uint64_t, best.bound()) != 0) return false;
            return watch->key_of(below.least_id(node)) > best.known().key;
        }
#endif
        return false;
    }
};

/// A walk through a tree, nearest child first. The others wait, and are dropped when their turn comes if the reach has
/// shrunk below their distance. Leaves wait like nodes. A walk without branches on what is nearer and what is kept was
/// tried, also with four nodes at a time: it took half as long again on one core, which guesses right more often than not.
template <bvh_layout Tree, class Watch = tie_watch>
struct ordered_tree_walk {
    using T = typename Tree::scalar_type;
    Tree tree;
    Watch* watch = nullptr;  ///< of walks that are about the least alone, on a host

    /// The next copies of shapes, on a host, if walks pass over these.
    [[nodiscard]] const std::uint32_t* copies_with(std::uint64_t) const {
        return watch != nullptr && watch->is_known() ? watch->known(0).copies : nullptr;
    }
    /// Whether walks of many indices at once are faster in steps: in a tree that a core's own cache does not hold.
    [[nodiscard]] bool pays_in_steps() const { return tree.size() >= std::size_t{1} << 16; }

    ABUT_CALLS_ANY
    template <ordered_reach<Tree> Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach& reach, Best& best, const Visitor& visitor) const {
        place_in_tree<Tree> place;
        typename place_in_tree<Tree>::room pending;  // not initialised
        double bound = infinity<double>;
        tighten(reach, best, bound);
        ties_met<Watch> ties(watch);
        place.begin(tree, ties.below);
        for (;;) {
            while (reach.keeps(place.at.least) && !place.at.child.is_leaf() &&
                   !ties.is_passed_over(tree, place.at.child.index(), best, visitor)) {
                if (!place.descend(tree, ties.below, reach, pending)) return;
            }
            if (place.at.child.is_leaf() && reach.keeps(place.at.least)) ties.visit(visitor, place.at.child.index());
            tighten(reach, best, bound);
            if (!place.next(reach, pending)) return;
        }
    }
};

/// By what a walk names what it comes to: ids of shapes, unless it says otherwise.
template <class Walk>
struct id_in_walk {
    using type = std::uint32_t;
};
template <class Walk>
using walk_id = typename id_in_walk<Walk>::type;

/// The reach of a line with which a walk looks: by fours through a tree whose boxes come by fours.
///@{
template <class Walk, scalar T>
struct line_reach {
    using type = ray_reach<T>;
};
template <bvh_layout Tree, scalar T>
requires requires(const typename Tree::node_type& node) { Tree::all_planes(node); }
struct line_reach<ordered_tree_walk<Tree>, T> {
    using type = ray_reach_of_four<T>;
};
template <class Walk, scalar T>
using line_reach_of = typename line_reach<Walk, T>::type;
///@}

/// A part of a ball that shrinks: what of it is in a box.
template <class Reach, scalar T>
struct reach_in_box {
    Reach& reach;
    aabb<T> box;
    ABUT_HD bool operator()(const aabb<T>& other) const { return reach(other); }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return box; }
};

/// A grid has no order from near to far: it is asked for what lies within a cell's width, then within twice that, and so on,
/// until the best is nearer than that, or all has been seen. What was seen before is offered again, which changes nothing.
template <class Grid>
struct ordered_grid_walk {
    using T = typename Grid::scalar_type;
    Grid grid;

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach& reach, Best& best, const Visitor& visitor) const {
        const auto frame = *grid.frame;
        const grid_walk<Grid> walk{grid};
        double bound = infinity<double>;
        tighten(reach, best, bound);
        const auto shrinks = [&](std::uint32_t id) {
            visitor(id);
            tighten(reach, best, bound);
            return visit::proceed;
        };
        const auto width = static_cast<T>(1 / frame.cells_per_unit);
        T radius = static_cast<T>(std::sqrt(static_cast<double>(reach.least_in(frame.bounds)))) + width;
        radius = greatest(radius, smallest_normal<T>);  // or it might stay 0
        for (;; radius += radius) {
            const bool is_last = !(radius < reach.radius());
            const aabb<T> box = is_last ? reach.bounds() : bounds(sphere<T>{reach.center, radius});
            reach_in_box<Reach, T> within{reach, box};
            typename grid_walk<Grid>::cursor at;
            walk.for_each(within, at, [] { return false; }, shrinks);
            if (is_last || radius >= reach.radius() || contains(box, frame.bounds)) return;
        }
    }
};

/// All of n shapes, one after another.
struct ordered_list_walk {
    std::size_t count;

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach&, Best&, const Visitor& visitor) const {
        for (std::size_t i = 0; i < count; ++i) visitor(static_cast<std::uint32_t>(i));
    }
};

/// All of n shapes, one after another, whose boxes are near enough.
template <shape_view Shapes>
struct walk_all_boxes {
    Shapes shapes;
    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach& reach, const Best& best, const Visitor& visitor) const {
        double bound = infinity<double>;
        tighten(reach, best, bound);
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            if (!reach(bounds(shapes[i]))) continue;
            visitor(static_cast<std::uint32_t>(i));
            tighten(reach, best, bound);
        }
    }
};

}  // namespace detail

}  // namespace abut
