// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once: the pairs of leaves whose boxes overlap, without a walk from the root for each leaf of one tree.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/index/bvh.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/traverse/bvh_walk.hpp>
#include <abut/traverse/visit.hpp>

namespace abut::detail {

/// Boxes of one frame.
struct same_frame {
    template <scalar T>
    ABUT_HD bool operator()(const aabb<T>& a, const aabb<T>& b) const {
        return overlaps(a, b);
    }
};

/// Boxes of two frames (shape/relative_pose.hpp).
template <scalar T>
struct two_frames {
    relative_pose<T> b_to_a;
    ABUT_HD bool operator()(const aabb<T>& a, const aabb<T>& b) const { return overlaps(a, b_to_a, b); }
};
template <scalar T>
two_frames(relative_pose<T>) -> two_frames<T>;

/// An inner node of each tree.
struct node_pair {
    std::uint32_t a, b;
};

/// Depth first, down both trees at once: an inner node has both its children's boxes, so a pair of nodes is four tests and
/// two fetches, and no box has to be kept on the stack. A leaf walks on alone, through what is left of the other tree.
template <bvh_layout A, bvh_layout B, class Overlap>
struct pair_walk {
    A a;
    B b;
    Overlap overlap;

    /// A pair of nodes leaves four at most, of which one is next.
    static constexpr int most_pending = 3 * bvh_max_depth + 1;

    /// Calls visitor(id in a, id in b) -> visit for all leaves below a pair of nodes whose boxes overlap, until it says
    /// stop.
    template <class Visitor>
    ABUT_HD void for_each(node_pair start, Visitor&& visitor) const {
        node_pair pending[most_pending];
        int depth = 0;
        pending[depth++] = start;
        while (depth > 0) {
            const node_pair at = pending[--depth];
            const auto node_a = a.fetch(at.a);
            const auto node_b = b.fetch(at.b);
            for (int k = 0; k < 4; ++k) {
                const int i = k / 2, j = k % 2;
                if (!overlap(a.bounds(node_a, i), b.bounds(node_b, j))) continue;
                const bvh_child child_a = a.child(node_a, i), child_b = b.child(node_b, j);
                if (!child_a.is_leaf() && !child_b.is_leaf()) {
                    a.prefetch(child_a);
                    b.prefetch(child_b);
                    pending[depth++] = {child_a.index(), child_b.index()};
                } else if (leaf_and_rest(child_a, a.bounds(node_a, i), child_b, b.bounds(node_b, j), visitor) ==
                           visit::stop) {
                    return;
                }
            }
        }
    }

    /// Pairs of nodes with all of the overlapping leaves below them: `enough` of them or up to four times as many, for
    /// threads to share; fewer where leaves are met on the way, as in small trees. None where the trees do not meet. Both
    /// trees have inner nodes.
    [[nodiscard]] std::vector<node_pair> split(std::size_t enough) const {
        std::vector<node_pair> now, done;
        if (overlap(a.root_bounds(), b.root_bounds())) now.push_back({a.root().index(), b.root().index()});
        while (!now.empty() && now.size() + done.size() < enough) {
            std::vector<node_pair> next;
            for (const node_pair& at : now) {
                const std::size_t before = next.size();
                if (!children(at, next)) {
                    next.resize(before);
                    done.push_back(at);
                }
            }
            now = std::move(next);
        }
        done.insert(done.end(), now.begin(), now.end());
        return done;
    }

private:
    /// One of the two is a leaf at least.
    template <class Visitor>
    ABUT_HD visit leaf_and_rest(bvh_child child_a, const aabb<typename A::scalar_type>& box_a, bvh_child child_b,
                                const aabb<typename B::scalar_type>& box_b, Visitor& visitor) const {
        if (child_a.is_leaf() && child_b.is_leaf()) return visitor(child_a.index(), child_b.index());
        visit last = visit::proceed;
        if (child_a.is_leaf()) {
            const auto reach = [&](const auto& box) { return overlap(box_a, box); };
            bvh_walk<B>{b}.for_each_below(child_b.index(), reach,
                                          [&](std::uint32_t id) { return last = visitor(child_a.index(), id); });
        } else {
            const auto reach = [&](const auto& box) { return overlap(box, box_b); };
            bvh_walk<A>{a}.for_each_below(child_a.index(), reach,
                                          [&](std::uint32_t id) { return last = visitor(id, child_b.index()); });
        }
        return last;
    }

    /// Adds the pairs of children that overlap. False if there is a leaf among them.
    bool children(const node_pair& at, std::vector<node_pair>& to) const {
        const auto node_a = a.fetch(at.a);
        const auto node_b = b.fetch(at.b);
        for (int k = 0; k < 4; ++k) {
            if (!overlap(a.bounds(node_a, k / 2), b.bounds(node_b, k % 2))) continue;
            const bvh_child child_a = a.child(node_a, k / 2), child_b = b.child(node_b, k % 2);
            if (child_a.is_leaf() || child_b.is_leaf()) return false;
            to.push_back({child_a.index(), child_b.index()});
        }
        return true;
    }
};

}  // namespace abut::detail
