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
        turned_frames frames;
        step<Best, Visitor> one({*this, both, bounds, far, best, frames}, visitor);
        heap waiting;
        item root = roots(begin);
        if (one.keeps_roots(root)) waiting.add(root);
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

    static constexpr int width = A::width > B::width ? A::width : B::width;
    /// Pairs that wait where all that one makes is taken before the others do.
    static constexpr int most_below = 2 * bvh_max_depth * (width - 1) + 2;

    [[nodiscard]] ABUT_HD item roots(float begin) const { return {root_of(a), root_of(b), begin, 0}; }
    [[nodiscard]] ABUT_HD bool is_pair_of_shapes(const item& at) const {
        return side<A>{a, at.a}.is_leaf() && side<B>{b, at.b}.is_leaf();
    }
    [[nodiscard]] ABUT_HD std::uint32_t shape_a(const item& at) const { return side<A>{a, at.a}.shape(); }
    [[nodiscard]] ABUT_HD std::uint32_t shape_b(const item& at) const { return side<B>{b, at.b}.shape(); }

private:
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
        [[nodiscard]] ABUT_HD int children() const { return tree.children(tree.fetch(link)); }
        [[nodiscard]] ABUT_HD side child(int i) const {
            return {tree, link_to(tree.child(tree.fetch(link), i), Tree::width * link + static_cast<std::uint32_t>(i))};
        }
        [[nodiscard]] ABUT_HD auto box_of_child(int i) const { return tree.bounds(tree.fetch(link), i); }
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
        item at[std::size_t{most_below}];  // not initialised
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

public:
    /// What may come near, of the children of a pair.
    template <class Best>
    struct look {
        const turning_walk& walk;
        const turning_pair& both;
        const turning_bounds& bounds;
        double far;
        const Best& best;
        turned_frames& frames;

        /// Of the roots.
        [[nodiscard]] ABUT_HD bool keeps_roots(item& root) {
            return keeps(root, turned_box(side<A>{walk.a, root.a}.box(), both.a.centre),
                         turned_box(side<B>{walk.b, root.b}.box(), both.b.centre));
        }
        /// A pair of nodes, of which the larger one is opened.
        class opened {
        public:
            ABUT_HD opened(const look& by, const item& at)
                : a_{by.walk.a, at.a}, b_{by.walk.b, at.b}, p_(a_.box(), by.both.a.centre), q_(b_.box(), by.both.b.centre),
                  opens_a_(!a_.is_leaf() && (b_.is_leaf() || dot(p_.half, p_.half) >= dot(q_.half, q_.half))) {}
            [[nodiscard]] ABUT_HD int children() const { return opens_a_ ? a_.children() : b_.children(); }
            /// Makes `one` the i-th child, and tells whether it is kept.
            [[nodiscard]] ABUT_HD bool keeps_child(look& by, int i, item& one) const {
                if (opens_a_) {
                    one.a = a_.child(i).link;
                    return by.keeps(one, turned_box(a_.box_of_child(i), by.both.a.centre), q_);
                }
                one.b = b_.child(i).link;
                return by.keeps(one, p_, turned_box(b_.box_of_child(i), by.both.b.centre));
            }

        private:
            side<A> a_;
            side<B> b_;
            turned_box p_, q_;
            bool opens_a_;
        };

    private:
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
        /// Whether it may come near by then, and not before when.
        [[nodiscard]] ABUT_HD bool keeps(item& one, const turned_box& p, const turned_box& q) {
            const double until = best.until(), since = static_cast<double>(one.from);
            if (since > until || (since == until && !may_come_first(one, since))) return false;
            frames.move_to(since, both);
            double gap = 0;
            const double from = frames.free_until(p, q, both, bounds, far, until, gap);
            if (from > until) return false;
            if (from > since) one.from = greatest(one.from, static_cast<float>(from * (1 - 0x1p-22)));
            one.gap = static_cast<float>(gap);
            return true;
        }
    };

private:
    template <class Best, class Visitor>
    struct step : look<Best> {
        const Visitor& visitor;

        ABUT_HD step(const look<Best>& by, const Visitor& visits) : look<Best>(by), visitor(visits) {}
        /// Visits a pair of shapes, and tells whether to go on; or opens a pair of nodes.
        ABUT_CALLS_ANY
        template <class Pending>
        ABUT_HD bool take(const item& at, Pending& pending) {
            if (this->walk.is_pair_of_shapes(at)) {
                return visitor(this->walk.shape_a(at), this->walk.shape_b(at), static_cast<double>(at.from));
            }
            const typename look<Best>::opened pair(*this, at);
            for (int i = 0; i < pair.children(); ++i) {
                item child = at;
                if (pair.keeps_child(*this, i, child)) pending.add(child);
            }
            return true;
        }
    };
};

}  // namespace abut::detail
