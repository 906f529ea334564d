// SPDX-License-Identifier: MIT
#pragma once

// The least id of the shapes below each node of a tree. Who looks for the pair with the least ids leaves out all that lies
// below two nodes as soon as a lesser pair is known. They depend on a tree's topology alone. Made with a tree where
// bvh_options::least_ids says so, or for one query.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/walk_order.hpp>

namespace abut::detail {

/// Trees that may have them: of two children a node, in a layout that keeps them. A user's need not.
template <class Index>
concept keeps_least_ids = Index::view_type::width == 2 && requires(const Index& tree) {
    { tree.view().nodes[0].child[0] } -> std::convertible_to<bvh_child>;
    { tree.stored().least_ids } -> std::convertible_to<shared_least_ids<typename Index::memory_space>>;
};

/// To be folded up (walk_order.hpp).
template <class Node>
struct join_least_ids {
    const Node* nodes;
    const std::uint32_t* above;
    std::uint32_t* least;
    [[nodiscard]] ABUT_HD bool is_leaf(std::size_t node, std::uint32_t slot) const {
        return nodes[node].child[slot].is_leaf();
    }
    [[nodiscard]] ABUT_HD std::uint32_t leaf_value(std::size_t node, std::uint32_t slot) const {
        return nodes[node].child[slot].index();
    }
    [[nodiscard]] ABUT_HD std::uint32_t join(std::uint32_t node, std::uint32_t left, std::uint32_t right) const {
        return least[node] = left < right ? left : right;
    }
};

/// Those of a tree's nodes: 4 bytes a shape, and 12 while they are made; none for trees of fewer than two shapes. In time
/// proportional to the number of shapes. Waits for them.
template <class Policy, class Node, scalar T>
execution::buffer_of<Policy, std::uint32_t> make_least_ids(const Policy& on, const Node* nodes, std::size_t count,
                                                           const bvh_root<T>* top) {
    using numbers = execution::buffer_of<Policy, std::uint32_t>;
    numbers least(on, count);
    if (count == 0) return least;
    bvh_root<T> root;
    download(on, top, 1, &root);
    numbers above(on, count), reached(on, count);
    for_each_index(on, count, write_links<Node>{nodes, root.child, above.data()});
    fill(on, reached.data(), count, no_link);
    for_each_index(on, count, fold_up<join_least_ids<Node>>{{nodes, above.data(), least.data()}, reached.data()});
    synchronize(on);
    return least;
}

}  // namespace abut::detail
