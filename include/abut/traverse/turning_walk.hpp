// SPDX-License-Identifier: MIT
#pragma once

// Two trees whose bodies turn, for the pair of shapes that meets first: each pair of nodes has a time before which nothing
// in it comes near, and the earliest of all that wait is opened next. What is found prunes the rest. Boxes stay in the
// frames of their bodies.

#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/turning_reach.hpp>
#include <abut/traverse/ordered_walk.hpp>
#include <abut/traverse/pair_walk.hpp>

namespace abut::detail {

/// Down from both roots, always through the larger of two boxes. What finds no more room in a heap is walked depth first.
/// The best tells `until()`, a time after which nothing is wanted; visitor(id, id, from) tells it of what it finds of a pair
/// that comes no nearer than `far` before a time, and whether to go on. What is told does not depend on the trees: a pair is
/// passed over only where its boxes are farther apart than `far` until that time.
template <bvh_layout A, bvh_layout B>
struct turning_walk {
    A a;
    B b;

    /// A pair of nodes or leaves, by links as in pair_walk.hpp. Times are rounded down.
    struct item {
        std::uint32_t a, b;
        float from;  ///< apart before
        float gap;   ///< how far, along some direction
        [[nodiscard]] ABUT_HD bool comes_before(const item& other) const {
            return from < other.from || (from == other.from && gap < other.gap);
        }
    };

    ABUT_CALLS_ANY
    template <class Best, class Visitor>
    ABUT_HD void operator()(const turning_pair& both, const turning_bounds& bounds, double far, const Best& best,
                            const Visitor& visitor, float begin = 0) const {
        if (a.size() == 0 || b.size() == 0) return;
        step<Best, Visitor> one{*this, both, bounds, far, best, visitor};
        heap waiting;
        const side<A> at_a{a, root_of(a)};
        const side<B> at_b{b, root_of(b)};
        one.keep({at_a.link, at_b.link, begin, 0}, turned_box(at_a.box(), both.a.centre),
                 turned_box(at_b.box(), both.b.centre), waiting);
        while (waiting.count > 0) {
            const item at = waiting.take();
            if (static_cast<double>(at.from) > best.until()) return;
            if (waiting.has_room()) {
                if (!one.take(at, waiting)) return;
                continue;
            }
            stack below;
            below.add(at);
            while (below.count > 0) {
                const item next = below.take();
                if (static_cast<double>(next.from) <= best.until() && !one.take(next, below)) return;
            }
        }
    }

private:
    static constexpr int width = A::width > B::width ? A::width : B::width;
    static constexpr std::uint32_t whole = static_cast<std::uint32_t>(-1);  ///< the leaf of a tree of one shape

    template <class Tree>
    ABUT_HD static std::uint32_t root_of(const Tree& tree) {
        return tree.root().is_leaf() ? whole : tree.root().index();
    }
    /// One half of a pair.
    template <class Tree>
    struct side {
        const Tree& tree;
        std::uint32_t link;

        [[nodiscard]] ABUT_HD bool is_leaf() const { return (link & bvh_child::leaf_bit) != 0; }
        [[nodiscard]] ABUT_HD auto box() const {
            if (link == whole) return aabb<typename Tree::scalar_type>(tree.root_bounds());
            const node_or_leaf at(link, Tree::width);
            if (!at.is_leaf) return box_of_node(tree, at.node);
            return aabb<typename Tree::scalar_type>(tree.bounds(tree.fetch(at.node), static_cast<int>(at.slot)));
        }
        [[nodiscard]] ABUT_HD std::uint32_t shape() const {
            return link == whole ? tree.root().index() : shape_of_leaf(tree, link);
        }
        /// f(link, box) of each child.
        ABUT_CALLS_ANY
        template <class F>
        ABUT_HD void each_child(const F& f) const {
            const auto& node = tree.fetch(link);
            for (int i = 0; i < tree.children(node); ++i) {
                f(link_to(tree.child(node, i), Tree::width * link + static_cast<std::uint32_t>(i)), tree.bounds(node, i));
            }
        }
    };
    /// The earliest is taken.
    struct heap {
        static constexpr int room = 256;
        item at[std::size_t{room}];  // not initialised
        int count = 0;

        [[nodiscard]] ABUT_HD bool has_room() const { return count <= room - width; }
        ABUT_HD void add(const item& one) {
            int i = count++;
            for (; i > 0 && one.comes_before(at[(i - 1) / 2]); i = (i - 1) / 2) at[i] = at[(i - 1) / 2];
            at[i] = one;
        }
        ABUT_HD item take() {
            const item first = at[0], last = at[--count];
            int i = 0;
            for (int k = 1; k < count; k = 2 * i + 1) {
                if (k + 1 < count && at[k + 1].comes_before(at[k])) ++k;
                if (!at[k].comes_before(last)) break;
                at[i] = at[k];
                i = k;
            }
            at[i] = last;
            return first;
        }
    };
    /// Of what a pair makes the earliest is taken first, and all of it before what was there.
    struct stack {
        item at[std::size_t{2 * bvh_max_depth * (width - 1) + 2}];  // not initialised
        int count = 0, first = 0;

        ABUT_HD item take() {
            const item newest = at[--count];
            first = count;
            return newest;
        }
        ABUT_HD void add(const item& one) {
            int place = count++;
            for (; place > first && at[place - 1].comes_before(one); --place) at[place] = at[place - 1];
            at[place] = one;
        }
    };

    template <class Best, class Visitor>
    struct step {
        const turning_walk& walk;
        const turning_pair& both;
        const turning_bounds& bounds;
        double far;
        const Best& best;
        const Visitor& visitor;
        turned_frames frames{};

        /// Visits a pair of shapes, and tells whether to go on; or opens a pair of nodes.
        ABUT_CALLS_ANY
        template <class Pending>
        ABUT_HD bool take(const item& at, Pending& pending) {
            const side<A> in_a{walk.a, at.a};
            const side<B> in_b{walk.b, at.b};
            if (in_a.is_leaf() && in_b.is_leaf()) return visitor(in_a.shape(), in_b.shape(), static_cast<double>(at.from));
            const turned_box p(in_a.box(), both.a.centre), q(in_b.box(), both.b.centre);
            if (!in_a.is_leaf() && (in_b.is_leaf() || dot(p.half, p.half) >= dot(q.half, q.half))) {
                in_a.each_child([&](std::uint32_t link, const auto& box) {
                    keep({link, at.b, at.from, 0}, turned_box(box, both.a.centre), q, pending);
                });
            } else {
                in_b.each_child([&](std::uint32_t link, const auto& box) {
                    keep({at.a, link, at.from, 0}, p, turned_box(box, both.b.centre), pending);
                });
            }
            return true;
        }
        /// Whether the pair, or a pair below it, may come before the best, if nothing of it comes near before `since`: of equal times
        /// the least ids count.
        [[nodiscard]] ABUT_HD bool may_come_first([[maybe_unused]] const item& one, [[maybe_unused]] double since) const {
            if constexpr (requires { best.may_come_first(since, one.a, one.b); }) {
                const side<A> in_a{walk.a, one.a};
                const side<B> in_b{walk.b, one.b};
                return !in_a.is_leaf() || best.may_come_first(since, in_a.shape(), in_b.is_leaf() ? in_b.shape() : 0);
            }
            return true;
        }
        /// Adds what may come near by then.
        ABUT_CALLS_ANY
        template <class Pending>
        ABUT_HD void keep(item one, const turned_box& p, const turned_box& q, Pending& pending) {
            const double until = best.until(), since = static_cast<double>(one.from);
            if (since > until || (since == until && !may_come_first(one, since))) return;
            frames.move_to(since, both);
            double gap = 0;
            const double from = frames.free_until(p, q, both, bounds, far, until, gap);
            if (from > until) return;
            if (from > since) one.from = greatest(one.from, static_cast<float>(from * (1 - 0x1p-22)));
            one.gap = static_cast<float>(gap);
            pending.add(one);
        }
    };
};

}  // namespace abut::detail
