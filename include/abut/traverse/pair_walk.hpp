// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once: the pairs of leaves whose boxes overlap, without a walk from the root for each leaf of one tree.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/index/bvh.hpp>
#include <abut/shape/relative_pose.hpp>

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

/// A larger tree has no items, for want of bits.
inline constexpr std::size_t most_shapes_of_pair_walk = std::size_t{1} << 30;

/// Down both trees at once: an inner node has both its children's boxes, so a step is two fetches and four tests, and no box
/// has to be kept. In which order steps are taken is the policy's to choose: depth first in a thread of the host, a block's
/// newest items at a time on a device (execution/cuda_expand.hpp).
template <bvh_layout A, bvh_layout B, class Overlap>
struct pair_walk {
    A a;
    B b;
    Overlap overlap;

    /// A node of each tree. A leaf goes by its place, which tells its box as well: child `side` of node n is place 2 n +
    /// side.
    struct item {
        std::uint32_t a, b;
        ABUT_HD static constexpr std::uint32_t leaf(std::uint32_t node, int side) {
            return bvh_child::leaf_bit | (2 * node + static_cast<std::uint32_t>(side));
        }
    };
    static constexpr unsigned most_children = 4, most_depth = bvh_max_depth;
    [[nodiscard]] ABUT_HD static constexpr std::size_t seeds() { return 1; }
    [[nodiscard]] ABUT_HD item seed(std::size_t) const { return {a.root().index(), b.root().index()}; }

    /// A hint that the item will be expanded soon. The parent of a leaf has been fetched before.
    void prefetch(const item& at) const {
        if ((at.a & bvh_child::leaf_bit) == 0) a.prefetch(bvh_child::inner(at.a));
        if ((at.b & bvh_child::leaf_bit) == 0) b.prefetch(bvh_child::inner(at.b));
    }

    /// For the pairs k = 0 ... 3 of children, calls add(k, overlap, item), or visitor(k, overlap, id in a, id in b), where
    /// `overlap` is false if there is nothing to be done. k is a constant to the compiler. Inlined by force: g++ would
    /// not where a program has several queries, and they took twice as long. Without a branch: which of the
    /// boxes overlap is anyone's guess.
    template <class Add, class Visitor>
    ABUT_INLINE ABUT_HD void expand(const item& at, const Add& add, const Visitor& visitor) const {
        const bool a_is_leaf = (at.a & bvh_child::leaf_bit) != 0, b_is_leaf = (at.b & bvh_child::leaf_bit) != 0;
        const std::uint32_t place_a = at.a & ~bvh_child::leaf_bit, place_b = at.b & ~bvh_child::leaf_bit;
        const std::uint32_t index_a = a_is_leaf ? place_a / 2 : place_a, index_b = b_is_leaf ? place_b / 2 : place_b;
        // Which children are meant: the leaf itself, or both.
        const unsigned sides_a = a_is_leaf ? 1u << (place_a % 2) : 3u, sides_b = b_is_leaf ? 1u << (place_b % 2) : 3u;
        const typename A::node_type node_a = a.fetch(index_a);
        const typename B::node_type node_b = b.fetch(index_b);
        const auto step = [&](auto k) {
            constexpr unsigned i = decltype(k)::value / 2, j = decltype(k)::value % 2;
            const unsigned meant = sides_a >> i & sides_b >> j & 1u;
            const bool meet = (meant & static_cast<unsigned>(overlap(a.bounds(node_a, i), b.bounds(node_b, j)))) != 0;
            const bvh_child child_a = a.child(node_a, i), child_b = b.child(node_b, j);
            const bool leaves = (child_a.bits & child_b.bits & bvh_child::leaf_bit) != 0;
            add(k, meet & !leaves,
                item{child_a.is_leaf() ? item::leaf(index_a, i) : child_a.index(),
                     child_b.is_leaf() ? item::leaf(index_b, j) : child_b.index()});
            visitor(k, meet & leaves, child_a.index(), child_b.index());
        };
        step(std::integral_constant<unsigned, 0>{});
        step(std::integral_constant<unsigned, 1>{});
        step(std::integral_constant<unsigned, 2>{});
        step(std::integral_constant<unsigned, 3>{});
    }
};

}  // namespace abut::detail
