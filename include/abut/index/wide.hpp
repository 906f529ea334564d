// SPDX-License-Identifier: MIT
#pragma once

// wide: a tree of four children a node, for queries on a processor. Two of its nodes are sixteen tests of boxes, which take
// four rows of four at a time and need no more cache lines than the few binary nodes that they stand for.
//
// A node's children are those of a binary node, of which the one with the largest surface is replaced by its own two until
// there are four, or all of them are leaves: I. Wald, C. Benthin, S. Boulos, Getting rid of packets (2008), section 3.1.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <abut/arithmetic/limits.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/box_lanes.hpp>
#include <abut/shape/box_measure.hpp>

namespace abut {

/// An inner node: `count` children, two to four, with their boxes by axis; two cache lines in single precision. Only a node
/// all of whose children are leaves has fewer than four. Slots without a child hold the empty box.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 64 : 32) wide_node {
    T planes[6][4];       ///< lower x, y and z of all children, then upper x, y and z
    bvh_child child[4];   ///< the children
    std::uint32_t count;  ///< of children
};

/// A view of a wide tree.
template <scalar T, memory_space Space>
struct wide_view : bvh_view_base<T, Space, wide_node<T>, 4> {
    /// A node as walks read it.
    using node_type = wide_node<T>;

    /// Node, number of children, box and child by number, as bvh_layout says. On hosts and devices.
    ///@{
    [[nodiscard]] ABUT_HD const node_type& fetch(std::uint32_t node) const { return this->nodes[node]; }
    [[nodiscard]] ABUT_HD static int children(const node_type& n) { return static_cast<int>(n.count); }
    [[nodiscard]] ABUT_HD static aabb<T> bounds(const node_type& n, int slot) {
        return {{n.planes[0][slot], n.planes[1][slot], n.planes[2][slot]},
                {n.planes[3][slot], n.planes[4][slot], n.planes[5][slot]}};
    }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int slot) { return n.child[slot]; }
    ///@}
    /// The boxes of all four slots, as lanes of four numbers.
    [[nodiscard]] ABUT_INLINE ABUT_HD static auto all_bounds(const node_type& n) {
        return detail::box_lanes<T>::load(n.planes);
    }
    /// The six planes of all four slots, as they lie in the node.
    [[nodiscard]] ABUT_HD static auto all_planes(const node_type& n) -> const T (&)[6][4] { return n.planes; }
};

/// 128 bytes a node in single precision, 224 in double, for two to three shapes.
struct wide_layout {
    /// What kernels see, and what owns a tree of this layout.
    ///@{
    template <scalar T, memory_space Space>
    using view = wide_view<T, Space>;

    template <scalar T, memory_space Space>
    using storage = bvh_storage<wide_layout, T, Space>;
    ///@}
};

namespace detail {

template <scalar T>
struct widen_tree {
    const bvh_node<T>* from;

    /// A binary node that is to become a wide one, and where its number goes: to slot link % 4 of wide node link / 4.
    struct waiting {
        std::uint32_t node;
        std::size_t link;
    };

    /// The wide node in place of a binary one; its children are binary nodes still.
    [[nodiscard]] wide_node<T> opened(std::uint32_t node) const {
        aabb<T> box[4];
        wide_node<T> to;
        for (const int slot : {0, 1}) {
            box[slot] = from[node].bounds[slot];
            to.child[slot] = from[node].child[slot];
        }
        to.count = 2;
        while (to.count < 4) {
            std::uint32_t largest = 4;
            T most = 0;
            for (std::uint32_t k = 0; k < to.count; ++k) {
                if (to.child[k].is_leaf()) continue;
                const T surface = half_surface(box[k].upper - box[k].lower);
                // NaN, of a box at infinity, is as large as any.
                if (largest == 4 || !(surface <= most)) {
                    largest = k;
                    most = surface;
                }
            }
            if (largest == 4) break;
            const bvh_node<T>& next = from[to.child[largest].index()];
            box[to.count] = next.bounds[1];
            to.child[to.count] = next.child[1];
            box[largest] = next.bounds[0];
            to.child[largest] = next.child[0];
            ++to.count;
        }
        for (std::uint32_t k = 0; k < 4; ++k) {
            if (k >= to.count) {
                box[k] = empty_box<T>();
                to.child[k] = bvh_child::leaf(0);
            }
            const vec3<T>&lower = box[k].lower, &upper = box[k].upper;
            const T planes[] = {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
            for (int plane = 0; plane < 6; ++plane) to.planes[plane][k] = planes[plane];
        }
        return to;
    }

    /// Appends the wide node in place of a binary one, puts its number where it is referred to (the first one's is not, from
    /// here), and calls wait(waiting) for its inner children, the last one first.
    template <class Wait>
    void append(const waiting& at, std::vector<wide_node<T>>& nodes, const Wait& wait) const {
        const std::size_t number = nodes.size();
        if (number > 0) nodes[at.link / 4].child[at.link % 4] = bvh_child::inner(static_cast<std::uint32_t>(number));
        nodes.push_back(opened(at.node));
        for (std::uint32_t k = nodes.back().count; k-- > 0;) {
            const bvh_child child = nodes.back().child[k];
            if (!child.is_leaf()) wait(waiting{child.index(), 4 * number + k});
        }
    }

    /// All wide nodes below a binary one, depth first, numbered from 0.
    [[nodiscard]] std::vector<wide_node<T>> below(std::uint32_t node) const {
        std::vector<wide_node<T>> nodes;
        std::vector<waiting> pending{{node, 0}};
        while (!pending.empty()) {
            const waiting at = pending.back();
            pending.pop_back();
            append(at, nodes, [&](const waiting& next) { pending.push_back(next); });
        }
        return nodes;
    }
};

/// The wide nodes in place of all binary ones below `root`. A few are made breadth first, whatever the number of threads,
/// and then each part below them by itself.
template <scalar T, host_policy Policy>
execution::buffer<wide_node<T>, host_space> widen(const Policy& on, const bvh_node<T>* from, std::uint32_t root) {
    constexpr std::size_t enough = 256;
    using waiting = typename widen_tree<T>::waiting;
    const widen_tree<T> tree{from};
    std::vector<wide_node<T>> top;
    std::vector<waiting> parts{{root, 0}};
    std::size_t done = 0;
    for (; done < parts.size() && parts.size() - done < enough; ++done) {
        const waiting at = parts[done];
        tree.append(at, top, [&](const waiting& next) { parts.push_back(next); });
    }
    parts.erase(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(done));

    std::vector<std::vector<wide_node<T>>> below(parts.size());
    for_each_task(on, parts.size(), [&](std::size_t i) { below[i] = tree.below(parts[i].node); });
    std::vector<std::uint32_t> first(parts.size() + 1, static_cast<std::uint32_t>(top.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        top[parts[i].link / 4].child[parts[i].link % 4] = bvh_child::inner(first[i]);
        first[i + 1] = first[i] + static_cast<std::uint32_t>(below[i].size());
    }
    execution::buffer<wide_node<T>, host_space> nodes(on, first.back());
    std::copy(top.begin(), top.end(), nodes.data());
    for_each_task(on, parts.size(), [&](std::size_t i) {
        wide_node<T>* const to = nodes.data() + first[i];
        for (std::size_t k = 0; k < below[i].size(); ++k) {
            to[k] = below[i][k];
            for (bvh_child& child : to[k].child) child.bits += child.is_leaf() ? 0 : first[i];
        }
        below[i] = {};
    });
    return nodes;
}

}  // namespace detail

/// @addtogroup indices
///@{

/// The same tree with two to four children a node, for the host's policies. It shares the set and nothing else; the one it
/// was made of may go. Some 62 bytes a shape in single precision, 108 in double, and never more than 86 and 150. The tree is
/// the same for any number of threads. Linear time; needs up to twice as much memory again while it works. Returns when it
/// is done. Throws std::bad_alloc.
///
///     const auto tree = abut::wide(on, abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah}));
template <execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, wide_layout> wide(const Policy& on, const bvh<Set, Space>& tree) {
    static_assert(host_policy<Policy> && std::same_as<Space, host_space>,
                  "abut: the wide layout is for the host's policies, serial and openmp");
    using tree_type = bvh<Set, Space, wide_layout>;
    using T = typename tree_type::scalar_type;
    auto fresh = std::make_shared<typename tree_type::storage>();
    if (tree.size() > 0) {
        bvh_root<T> root = *tree.view().top;
        if (!root.child.is_leaf()) {
            fresh->nodes = detail::widen<T>(on, tree.view().nodes, root.child.index());
            root.child = bvh_child::inner(0);
        }
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, 1);
        *fresh->root.data() = root;
    }
    return tree_type(tree.set(), std::move(fresh));
}

///@}

}  // namespace abut
