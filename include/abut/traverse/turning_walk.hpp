// SPDX-License-Identifier: MIT
#pragma once

// Two trees whose bodies turn, for the pair of shapes that meets first: each pair of nodes has a time before which nothing in it
// comes near, and the earliest are opened first. What is found prunes the rest. Boxes stay in the frames of their bodies.

#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/aabb.hpp>
#include <abut/shape/turning_reach.hpp>

namespace abut::detail {

/// Down from both roots, depth first, always through the larger of two boxes. The best tells `until()`, a time after which nothing
/// is wanted; visitor(id, id, from) tells it of what it finds
/// of a pair that comes no nearer than `far` before a time, and whether to go on. What is told does not depend on the trees: a pair is passed over
/// only where its boxes are farther apart than `far` until that time.
template <bvh_layout A, bvh_layout B>
struct turning_walk {
    A a;
    B b;

    struct item {
        bvh_child a, b;
        aabb<typename A::scalar_type> box_a;
        aabb<typename B::scalar_type> box_b;
        double from;  ///< apart before
        double gap;   ///< how far, along some direction
        [[nodiscard]] ABUT_HD bool comes_before(const item& other) const {
            return from < other.from || (from == other.from && gap < other.gap);
        }
    };
    static constexpr int width = A::width > B::width ? A::width : B::width;
    static constexpr int most_items = 2 * bvh_max_depth * (width - 1) + 2;

    ABUT_CALLS_ANY
    template <class Best, class Visitor>
    ABUT_HD void operator()(const turning_pair& both, double far, const Best& best, const Visitor& visitor) const {
        if (a.size() == 0 || b.size() == 0) return;
        item pending[std::size_t{most_items}];  // not initialised
        turned_frames frames;
        int count = 0;
        add(pending, count, 0, {a.root(), b.root(), a.root_bounds(), b.root_bounds(), 0, 0}, frames, both, far, best);
        while (count > 0) {
            const item at = pending[--count];
            if (at.from > best.until()) continue;
            if (at.a.is_leaf() && at.b.is_leaf()) {
                if (!visitor(at.a.index(), at.b.index(), at.from)) return;
                continue;
            }
            const int first = count;
            const bool opens_a = !at.a.is_leaf() && (at.b.is_leaf() || extent(at.box_a) >= extent(at.box_b));
            if (opens_a) {
                const auto& node = a.fetch(at.a.index());
                for (int i = 0; i < a.children(node); ++i) {
                    add(pending, count, first, {a.child(node, i), at.b, a.bounds(node, i), at.box_b, at.from, 0}, frames, both, far, best);
                }
            } else {
                const auto& node = b.fetch(at.b.index());
                for (int i = 0; i < b.children(node); ++i) {
                    add(pending, count, first, {at.a, b.child(node, i), at.box_a, b.bounds(node, i), at.from, 0}, frames, both, far, best);
                }
            }
        }
    }

private:
    template <scalar T>
    ABUT_HD static double extent(const aabb<T>& box) {
        const vec3<double> side = widened(box.upper) - widened(box.lower);
        return dot(side, side);
    }
    /// Adds what may come near until then; of what is above `first` the earliest is last.
    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD static void add(item* pending, int& count, int first, item one, turned_frames& frames, const turning_pair& both,
                            double far, const Best& best) {
        const double until = best.until();
        if (one.from > until) return;
        frames.move_to(one.from, both);
        const turned_box p(one.box_a, both.a.centre), q(one.box_b, both.b.centre);
        one.from = frames.free_until(p, q, both, far, until, one.gap);
        if (one.from > until) return;
        int place = count++;
        for (; place > first && pending[place - 1].comes_before(one); --place) pending[place] = pending[place - 1];
        pending[place] = one;
    }
};

}  // namespace abut::detail
