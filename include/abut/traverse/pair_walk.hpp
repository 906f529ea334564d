// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once: the pairs of leaves whose boxes overlap, without a walk from the root for each leaf of one tree.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/box_lanes.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/volume.hpp>

namespace abut::detail {

// How volumes of two trees are compared: one with one, of one kind, or boxes four with four, which gives a lane_mask.
// Inlined by force: the four tests of a pair of nodes have much in common, and three quarters more instructions where they
// are calls.

/// Volumes of one frame.
struct same_frame {
    template <class Volume>
    ABUT_INLINE ABUT_HD bool operator()(const Volume& a, const Volume& b) const {
        return overlaps(a, b);
    }
    template <scalar T>
    ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T>& a, const box_lanes<T>& b) const {
        return overlaps(a, b);
    }
};

/// Boxes of one frame that may be so far apart, in each coordinate. Rounding is monotone: what is no larger than the
/// distance is rounded to no more.
template <scalar T>
struct near_frame {
    T distance;
    ABUT_INLINE ABUT_HD bool operator()(const aabb<T>& a, const aabb<T>& b) const {
        const auto near = [this](T lower, T upper) { return static_cast<unsigned>(lower - upper <= distance); };
        return (near(a.lower.x, b.upper.x) & near(b.lower.x, a.upper.x) & near(a.lower.y, b.upper.y) &
                near(b.lower.y, a.upper.y) & near(a.lower.z, b.upper.z) & near(b.lower.z, a.upper.z)) != 0;
    }
};
template <scalar T>
near_frame(T) -> near_frame<T>;

/// Boxes of one frame that may be so far apart, along a straight line. Other volumes by their boxes.
///
/// Squares are compared, of twice the gaps: g + |g| is that without a branch. Rounding, also of denormals, is that of
/// ball_reach (shape/reach.hpp), for a distance that is 4 of the smallest normal number more than is meant. A gap that
/// overflows to the other side gives NaN, and what is not a number is kept.
template <scalar T>
struct distance_frame {
    T distance;
    T limit;  ///< four times the squared distance, and a slack

    distance_frame() = default;
    ABUT_HD explicit distance_frame(T most) : distance(most) {
        constexpr T slack = 16 * unit_roundoff<T>, tiny = 2 * smallest_normal<T>;
        const T square = most * most;
        limit = 4 * (square + (slack * square + tiny));
    }
    ABUT_INLINE ABUT_HD bool operator()(const aabb<T>& a, const aabb<T>& b) const {
        const vec3<T> gap = greatest(a.lower, b.lower) - least(a.upper, b.upper), twice = gap + absolute(gap);
        return !(dot(twice, twice) > limit);
    }
    template <class Volume>
    ABUT_INLINE ABUT_HD bool operator()(const Volume& a, const Volume& b) const {
        return (*this)(bounds(a), bounds(b));
    }
    ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T>& a, const box_lanes<T>& b) const {
        const auto gap = greatest(a.lower, b.lower) - least(a.upper, b.upper), twice = gap + absolute(gap);
        return !(dot(twice, twice) > box_lanes<T>::lanes_type::all(limit));
    }
};

/// Volumes of two frames (shape/relative_pose.hpp). Polytopes by their boxes: under a pose a slab takes as long as several
/// boxes do, and queries that compared them all took two to ten times as long (docs/results/trees.md).
template <class Volume, scalar T>
ABUT_INLINE ABUT_HD bool overlaps_posed(const Volume& a, const relative_pose<T>& b_to_a, const Volume& b) {
    return overlaps(a, b_to_a, b);
}
template <scalar T, int K>
ABUT_INLINE ABUT_HD bool overlaps_posed(const kdop<T, K>& a, const relative_pose<T>& b_to_a, const kdop<T, K>& b) {
    return overlaps(bounds(a), b_to_a, bounds(b));
}

/// By one relative pose.
template <scalar T>
struct two_frames {
    relative_pose<T> b_to_a;
    template <class Volume>
    ABUT_INLINE ABUT_HD bool operator()(const Volume& a, const Volume& b) const {
        return overlaps_posed(a, b_to_a, b);
    }
    ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T>& a, const box_lanes<T>& b) const {
        return overlaps(a, b_to_a, b);
    }
};
template <scalar T>
two_frames(relative_pose<T>) -> two_frames<T>;

/// A layout that hands out the boxes of four children at once, for tests of four with four.
template <class L>
concept wide_bvh_layout = bvh_layout<L> && L::width == 4 && requires(const L& tree) {
    { tree.all_bounds(tree.fetch(std::uint32_t{})) } -> std::same_as<box_lanes<typename L::scalar_type>>;
};

/// A layout that hands out volumes, around which its boxes are.
template <class L>
concept volume_bvh_layout = bvh_layout<L> && bounding_volume<typename L::volume_type> && requires(const L& tree, int slot) {
    { tree.volume(tree.fetch(std::uint32_t{}), slot) } -> std::convertible_to<typename L::volume_type>;
};

/// Two that hand out volumes of one kind, which are then compared. All other pairs of trees are compared by their boxes.
template <class A, class B>
concept bvh_layouts_of_one_volume =
    volume_bvh_layout<A> && volume_bvh_layout<B> && std::same_as<typename A::volume_type, typename B::volume_type>;

/// A node of each tree. A leaf goes by the link to it, which tells its box as well: the link to slot s of node n is
/// width * n + s.
struct tree_pair {
    std::uint32_t a, b;
};
/// A child, as half of a pair: an inner node by its number, a leaf by the link to it.
ABUT_INLINE ABUT_HD std::uint32_t link_to(bvh_child child, std::uint32_t link) {
    return child.is_leaf() ? bvh_child::leaf_bit | link : child.index();
}
/// Half of it.
struct node_or_leaf {
    bool is_leaf;
    std::uint32_t node, slot;  ///< of a leaf, its parent and where it hangs there; of a node, itself

    ABUT_INLINE ABUT_HD node_or_leaf(std::uint32_t bits, std::uint32_t width) : is_leaf((bits & bvh_child::leaf_bit) != 0) {
        const std::uint32_t number = bits & ~bvh_child::leaf_bit;
        node = is_leaf ? number / width : number;
        slot = number % width;
    }
    /// Which of the node's children are meant: a leaf itself, of a node all.
    [[nodiscard]] ABUT_HD int first_slot() const { return is_leaf ? static_cast<int>(slot) : 0; }
    [[nodiscard]] ABUT_HD int end_of_slots(int children) const { return is_leaf ? static_cast<int>(slot) + 1 : children; }
};

/// The shape of a leaf that goes by the link to it.
template <bvh_layout Tree>
[[nodiscard]] ABUT_HD std::uint32_t shape_of_leaf(const Tree& tree, std::uint32_t leaf) {
    const node_or_leaf at(leaf, Tree::width);
    return tree.child(tree.fetch(at.node), static_cast<int>(at.slot)).index();
}
/// The least id below half a pair, where `of_nodes` says it of each node.
template <bvh_layout Tree>
[[nodiscard]] ABUT_HD std::uint32_t least_id_below(const Tree& tree, std::uint32_t half, const std::uint32_t* of_nodes) {
    return (half & bvh_child::leaf_bit) == 0 ? of_nodes[half] : shape_of_leaf(tree, half);
}

/// Down both trees at once: an inner node has its children's boxes, so a step is two fetches and four tests (sixteen, in
/// rows of four, where nodes have four children), and no box has to be kept. In which order steps are taken is the policy's
/// to choose: depth first in a thread of the host, a block's newest items at a time on a device (execution/cuda_expand.hpp).
template <bvh_layout A, bvh_layout B, class Overlap>
struct pair_walk {
    A a;
    B b;
    Overlap overlap;

    static constexpr unsigned width_a = A::width, width_b = B::width;
    static constexpr unsigned most_children = width_a * width_b, most_depth = bvh_max_depth;
    /// Trees of more shapes have no items, for want of bits.
    static constexpr std::size_t most_shapes = bvh_child::leaf_bit / (width_a > width_b ? width_a : width_b);

    using item = tree_pair;
    [[nodiscard]] ABUT_HD static constexpr std::size_t seeds() { return 1; }
    [[nodiscard]] ABUT_HD item seed(std::size_t) const { return {a.root().index(), b.root().index()}; }

    /// A hint that the item will be expanded soon. The parent of a leaf has been fetched before.
    ABUT_INLINE void prefetch(const item& at) const {
        if ((at.a & bvh_child::leaf_bit) == 0) a.prefetch(bvh_child::inner(at.a));
        if ((at.b & bvh_child::leaf_bit) == 0) b.prefetch(bvh_child::inner(at.b));
    }

    /// For pairs k of children, calls add(k, overlap, item), or visitor(k, overlap, id in a, id in b), where `overlap` is
    /// false if there is nothing to be done. For binary trees k = 0 ... 3 are constants to the compiler, and there is no
    /// branch: one on whether boxes overlap would often be predicted wrong. For wider ones k is a number, of pairs that
    /// overlap alone; on the host. Inlined by force: g++ would not where a program has several queries, and they took twice
    /// as long.
    template <class Add, class Visitor>
    ABUT_INLINE ABUT_HD void expand(const item& at, const Add& add, const Visitor& visitor) const {
        const node_or_leaf at_a(at.a, width_a), at_b(at.b, width_b);
        if constexpr (width_a == 2 && width_b == 2) {
            const typename A::node_type of_a = a.fetch(at_a.node);
            const typename B::node_type of_b = b.fetch(at_b.node);
            compare<0>(at_a, of_a, at_b, of_b, add, visitor);
            compare<1>(at_a, of_a, at_b, of_b, add, visitor);
            compare<2>(at_a, of_a, at_b, of_b, add, visitor);
            compare<3>(at_a, of_a, at_b, of_b, add, visitor);
        } else {
            const auto& of_a = a.fetch(at_a.node);
            const auto& of_b = b.fetch(at_b.node);
            for (unsigned meet = meeting(at_a, of_a, at_b, of_b); meet != 0; meet &= meet - 1) {
                const unsigned k = lowest_bit(meet), i = k / width_b, j = k % width_b;
                hand_on(k, true, a.child(of_a, static_cast<int>(i)), width_a * at_a.node + i,
                        b.child(of_b, static_cast<int>(j)), width_b * at_b.node + j, add, visitor);
            }
        }
    }

private:
    /// Pair K of binary nodes' children. No lambda: g++ would not inline it where a program has several queries.
    template <unsigned K, class Add, class Visitor>
    ABUT_INLINE ABUT_HD void compare(const node_or_leaf& at_a, const typename A::node_type& of_a, const node_or_leaf& at_b,
                                     const typename B::node_type& of_b, const Add& add, const Visitor& visitor) const {
        constexpr unsigned i = K / 2, j = K % 2;
        // A leaf is meant itself, of a node both children.
        const bool meant = (!at_a.is_leaf | (at_a.slot == i)) & (!at_b.is_leaf | (at_b.slot == j));
        bool meet;
        if constexpr (bvh_layouts_of_one_volume<A, B>) {
            meet = meant && overlap(a.volume(of_a, i), b.volume(of_b, j));  // a test is worth the branch
        } else {
            meet = meant & overlap(a.bounds(of_a, i), b.bounds(of_b, j));
        }
        hand_on(std::integral_constant<unsigned, K>{}, meet, a.child(of_a, i), 2 * at_a.node + i, b.child(of_b, j),
                2 * at_b.node + j, add, visitor);
    }

    /// A pair of children, and the links to them.
    template <class Number, class Add, class Visitor>
    ABUT_INLINE ABUT_HD static void hand_on(Number k, bool meet, bvh_child child_a, std::uint32_t link_a, bvh_child child_b,
                                            std::uint32_t link_b, const Add& add, const Visitor& visitor) {
        const bool leaves = (child_a.bits & child_b.bits & bvh_child::leaf_bit) != 0;
        add(k, meet & !leaves,
            item{link_to(child_a, link_a), link_to(child_b, link_b)});
        visitor(k, meet & leaves, child_a.index(), child_b.index());
    }

    /// Which children overlap, of those that an item means: bit width_b * i + j is slot i of a's node and slot j of b's.
    ABUT_INLINE ABUT_HD unsigned meeting(const node_or_leaf& at_a, const typename A::node_type& of_a, const node_or_leaf& at_b,
                                         const typename B::node_type& of_b) const {
        const int n = a.children(of_a), m = b.children(of_b);
        const int i = static_cast<int>(at_a.slot), j = static_cast<int>(at_b.slot);
        if constexpr (wide_bvh_layout<A> && wide_bvh_layout<B>) {
            using boxes = box_lanes<typename A::scalar_type>;
            using row = decltype(overlap(boxes{}, boxes{}));
            const auto first = [](int count) { return (1u << count) - 1; };
            if (at_b.is_leaf) {
                const row one[] = {overlap(a.all_bounds(of_a), boxes::all(b.bounds(of_b, j)))};
                // Both are leaves only where a walk begins below the roots (seeds.hpp).
                const unsigned bits = bits_of(one) & (at_a.is_leaf ? 1u << i : first(n));
                return ((bits & 1) | (bits & 2) << 3 | (bits & 4) << 6 | (bits & 8) << 9) << j;
            }
            const boxes all = b.all_bounds(of_b);
            if (at_a.is_leaf) {
                const row one[] = {overlap(boxes::all(a.bounds(of_a, i)), all)};
                return (bits_of(one) & first(m)) << 4 * i;
            }
            const row rows[] = {overlap(boxes::all(a.bounds(of_a, 0)), all), overlap(boxes::all(a.bounds(of_a, 1)), all),
                                overlap(boxes::all(a.bounds(of_a, 2)), all), overlap(boxes::all(a.bounds(of_a, 3)), all)};
            return bits_of(rows) & first(4 * n) & 0x1111 * first(m);
        } else {
            unsigned meet = 0;
            for (int k = at_a.first_slot(); k < at_a.end_of_slots(n); ++k) {
                for (int l = at_b.first_slot(); l < at_b.end_of_slots(m); ++l) {
                    const bool both = overlap(a.bounds(of_a, k), b.bounds(of_b, l));
                    meet |= static_cast<unsigned>(both) << (B::width * k + l);
                }
            }
            return meet;
        }
    }
};

}  // namespace abut::detail
