// SPDX-License-Identifier: MIT
#pragma once

// leafless: a tree without the boxes of its leaves, half the standard layout's memory. A walk takes a leaf's box to be that
// of the node above it, and so tests the shape itself where the leaf's box would have been tested.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>

namespace abut {

/// An inner node: its own box and its children, half a cache line in single precision.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 32 : 8) leafless_node {
    aabb<T> box;         ///< around both children
    bvh_child child[2];  ///< the children
};

/// A view of a leafless tree. To fetch a node is to read its children's boxes too, where these lie.
template <scalar T, memory_space Space>
struct leafless_view : bvh_view_base<T, Space, leafless_node<T>> {
    /// A node with its children's boxes: of an inner child its own, of a leaf the node's.
    using node_type = bvh_node<T>;

    /// Node, box and child by number, as bvh_layout says. On hosts and devices.
    ///@{
    [[nodiscard]] ABUT_HD node_type fetch(std::uint32_t node) const {
        const leafless_node<T> n = this->nodes[node];
        const auto box_of = [&](bvh_child child) { return child.is_leaf() ? n.box : this->nodes[child.index()].box; };
        return {{box_of(n.child[0]), box_of(n.child[1])}, {n.child[0], n.child[1]}};
    }
    [[nodiscard]] ABUT_HD static const aabb<T>& bounds(const node_type& n, int slot) { return n.bounds[slot]; }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int slot) { return n.child[slot]; }
    ///@}
};

/// 32 bytes a node in single precision, 56 in double.
struct leafless_layout {
    /// What kernels see, and what owns a tree of this layout.
    ///@{
    template <scalar T, memory_space Space>
    using view = leafless_view<T, Space>;

    template <scalar T, memory_space Space>
    using storage = bvh_storage<leafless_layout, T, Space>;
    ///@}
};

namespace detail {

template <scalar T>
struct drop_leaves {
    const bvh_node<T>* from;
    leafless_node<T>* to;
    ABUT_HD void operator()(std::size_t i) const {
        const bvh_node<T> node = from[i];
        to[i] = {merge(node.bounds[0], node.bounds[1]), {node.child[0], node.child[1]}};
    }
};

}  // namespace detail

/// @addtogroup indices
///@{

/// The same tree without boxes of leaves. It shares the set and the least ids, if there are some; the one it
/// was made of may go. Linear time. Throws error (a tree on another device), std::bad_alloc, cuda_error.
template <execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, leafless_layout> leafless(const Policy& on, const bvh<Set, Space>& tree) {
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: the index lies in other memory than the policy works in; make it with the same policy");
    using tree_type = bvh<Set, Space, leafless_layout>;
    using T = typename tree_type::scalar_type;
    const std::size_t n = tree.size();
    detail::require_same_device(on, tree, "abut::leafless");
    auto fresh = std::make_shared<typename tree_type::storage>();
    fresh->least_ids = tree.stored().least_ids;
    if (n > 0) {
        fresh->nodes = execution::buffer_of<Policy, leafless_node<T>>(on, n - 1);
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, 1);
        for_each_index(on, n - 1, detail::drop_leaves<T>{tree.view().nodes, fresh->nodes.data()});
        copy(on, tree.view().top, 1, fresh->root.data());
        synchronize(on);
    }
    return tree_type(tree.set(), std::move(fresh));
}

///@}

}  // namespace abut
