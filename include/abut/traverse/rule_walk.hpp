// SPDX-License-Identifier: MIT
#pragma once

// Two trees at once, one step down one of them at a time, by a rule that says which. pair_walk.hpp opens both.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/box_measure.hpp>
#include <abut/shape/volume.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/traverse/pair_walk.hpp>

namespace abut::detail {

/// The rule of traversal::larger_first. A rule has
///   begins_with_b(surface_b, surface_a)   whether b's root is opened first, by half of the roots' surfaces
///   is_next(is_b, is_larger)              whether the opened node's child, of b if `is_b`, goes before what stayed closed
struct opens_larger {
    template <class T>
    [[nodiscard]] ABUT_HD static constexpr bool begins_with_b(T surface_b, T surface_a) {
        return surface_b > surface_a;
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD static constexpr bool is_next(bool, bool is_larger) { return is_larger; }
};

/// Down two trees: of two subtrees whose boxes meet one is opened, and its children's boxes are compared with the box of the
/// other. A step is two fetches and two tests (four where nodes have four children). No box has to be kept: that of the
/// subtree which stays lies in its parent. Of a query b is the tree of the first argument (walk_of_both in
/// collide/routes.hpp). The interface is pair_walk's.
template <bvh_layout A, bvh_layout B, class Overlap, class Rule>
struct rule_walk {
    A a;
    B b;
    Overlap overlap;

    static constexpr unsigned width_a = A::width, width_b = B::width;
    static constexpr unsigned most_children = width_a > width_b ? width_a : width_b, most_depth = 2 * bvh_max_depth;
    /// Trees of more shapes have no items, for want of bits.
    static constexpr std::size_t most_shapes = bvh_child::leaf_bit / most_children;

    /// The node to be opened, with the highest bit set if it is one of b, and the link to the other tree's subtree: the
    /// link to slot s of node n is width * n + s, and the root has a link of its own.
    struct item {
        std::uint32_t open, other;
    };
    [[nodiscard]] ABUT_HD static constexpr std::size_t seeds() { return 1; }
    [[nodiscard]] ABUT_HD item seed(std::size_t) const {
        const bool opens_b = Rule::begins_with_b(surface(b.root_bounds()), surface(a.root_bounds()));
        return {opening(opens_b, opens_b ? b.root() : a.root()), link_of_root};
    }

    /// A hint that the item will be expanded soon. The parent of what stays closed has been fetched before.
    ABUT_INLINE void prefetch(const item& at) const {
        const bvh_child next = bvh_child::inner(at.open & ~is_of_b);
        if ((at.open & is_of_b) != 0) {
            b.prefetch(next);
        } else {
            a.prefetch(next);
        }
    }

    /// As pair_walk::expand, for pairs k of a child and what stays closed. Of trees of one type each is opened by the same
    /// code, since a branch on which one it is would often be predicted wrong.
    template <class Add, class Visitor>
    ABUT_INLINE ABUT_HD void expand(const item& at, const Add& add, const Visitor& visitor) const {
        const bool opens_b = (at.open & is_of_b) != 0;
        if constexpr (std::same_as<A, B>) {
            const A opened = opens_b ? b : a, other = opens_b ? a : b;
            open(opens_b, at, opened, other, add, visitor);
        } else if (opens_b) {
            open(true, at, b, a, add, visitor);
        } else {
            open(false, at, a, b, add, visitor);
        }
    }

private:
    static constexpr std::uint32_t is_of_b = bvh_child::leaf_bit, link_of_root = static_cast<std::uint32_t>(-1);
    using T = typename A::scalar_type;
    using box = aabb<T>;
    /// Two such trees are compared by their volumes; but that of a root is a box along the axes.
    static constexpr bool by_volume = bvh_layouts_of_one_volume<A, B>;

    /// The subtree that stays closed.
    template <class Volume>
    struct closed {
        bvh_child child;
        std::uint32_t link;
        const Volume& volume;  ///< not of a root, if `by_volume`
        const box& root;       ///< of a root alone
        [[nodiscard]] ABUT_HD bool is_root() const { return link == link_of_root; }
    };

    ABUT_HD static std::uint32_t opening(bool opens_b, bvh_child node) {
        return opens_b ? is_of_b | node.index() : node.index();
    }

    // Half of surfaces. Where they overflow or vanish, the tree that was opened last goes on.
    ABUT_HD static T surface(const box& x) { return half_surface(x.upper - x.lower); }
    ABUT_HD static double surface(const obb<T>& x) { return half_surface(widened(x.half_widths)); }
    template <class Volume>
    ABUT_HD static T surface(const Volume& x) {
        return surface(bounds(x));
    }

    template <class Opened, class Other, class Add, class Visitor>
    ABUT_INLINE ABUT_HD void open(bool opens_b, const item& at, const Opened& opened, const Other& other, const Add& add,
                                  const Visitor& visitor) const {
        const bool is_root = at.other == link_of_root;
        const std::uint32_t link = is_root ? 0 : at.other;  // node 0 is always there
        const int slot = static_cast<int>(link % Other::width);
        const auto& parent = other.fetch(link / Other::width);
        const bvh_child child = is_root ? other.root() : other.child(parent, slot);
        if constexpr (by_volume) {
            const box root = is_root ? other.root_bounds() : box{};
            open(opens_b, at.open & ~is_of_b, opened,
                 closed<typename Other::volume_type>{child, at.other, other.volume(parent, slot), root}, add, visitor);
        } else {
            const box bounds = is_root ? other.root_bounds() : other.bounds(parent, slot);
            open(opens_b, at.open & ~is_of_b, opened, closed<box>{child, at.other, bounds, bounds}, add, visitor);
        }
    }
    template <class Opened, class Volume, class Add, class Visitor>
    ABUT_INLINE ABUT_HD void open(bool opens_b, std::uint32_t node, const Opened& opened, const closed<Volume>& stays,
                                  const Add& add, const Visitor& visitor) const {
        if constexpr (Opened::width == 2) {
            const typename Opened::node_type of = opened.fetch(node);
            compare(std::integral_constant<unsigned, 0>{}, 0, opens_b, node, opened, of, stays, add, visitor);
            compare(std::integral_constant<unsigned, 1>{}, 1, opens_b, node, opened, of, stays, add, visitor);
        } else {
            const auto& of = opened.fetch(node);
            const int n = opened.children(of);
            for (int slot = 0; slot < n; ++slot) {
                compare(static_cast<unsigned>(slot), slot, opens_b, node, opened, of, stays, add, visitor);
            }
        }
    }

    /// Child k, which is in `slot`, of a node that was opened, which is of b if `is_b`, and the subtree that stayed closed.
    template <class Number, class Opened, class Node, class Volume, class Add, class Visitor>
    ABUT_INLINE ABUT_HD void compare(Number k, int slot, bool is_b, std::uint32_t node, const Opened& opened, const Node& of,
                                     const closed<Volume>& stays, const Add& add, const Visitor& visitor) const {
        const bvh_child child = opened.child(of, slot);
        bool meet, larger;
        if constexpr (by_volume) {
            const Volume& mine = opened.volume(of, slot);
            meet =
                stays.is_root() ? in_order(is_b, opened.bounds(of, slot), stays.root) : in_order(is_b, mine, stays.volume);
            larger = !stays.is_root() && surface(mine) >= surface(stays.volume);
        } else {
            const Volume mine = opened.bounds(of, slot);
            meet = in_order(is_b, mine, stays.volume);
            larger = surface(mine) >= surface(stays.volume);
        }
        const bool leaves = child.is_leaf() && stays.child.is_leaf();
        const bool goes_on = !child.is_leaf() && (stays.child.is_leaf() || Rule::is_next(is_b, larger));
        const std::uint32_t link = Opened::width * node + static_cast<std::uint32_t>(slot);
        add(k, meet & !leaves, goes_on ? item{opening(is_b, child), stays.link} : item{opening(!is_b, stays.child), link});
        visitor(k, meet & leaves, is_b ? stays.child.index() : child.index(), is_b ? child.index() : stays.child.index());
    }

    /// `mine` is of b if `is_b`.
    template <class Volume>
    ABUT_INLINE ABUT_HD bool in_order(bool is_b, const Volume& mine, const Volume& others) const {
        return overlap(is_b ? others : mine, is_b ? mine : others);
    }
};

}  // namespace abut::detail
