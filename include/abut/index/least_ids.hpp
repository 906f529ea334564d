// SPDX-License-Identifier: MIT
#pragma once

// The least id of the shapes below each node of a tree. Who looks for the pair with the least ids leaves out all that lies
// below two nodes as soon as a lesser pair is known. They are made when somebody asks, and depend on a tree's topology
// alone.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <type_traits>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/walk_order.hpp>

namespace abut::detail {

/// Trees that may have them: of two children a node, in a layout that keeps them. A user's need not.
template <class Index>
concept keeps_least_ids = Index::view_type::width == 2 && requires(const Index& tree) {
    { tree.view().nodes[0].child[0] } -> std::convertible_to<bvh_child>;
    tree.stored().least_ids->made;
    tree.stored().nodes.size();
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

/// By nodes: 4 bytes a shape. Null for trees of fewer than two shapes. Whoever asks first makes them, in time proportional
/// to the number of shapes, and waits for them.
template <class Policy, class Set, memory_space Space, class Layout>
const std::uint32_t* least_ids_of(const Policy& on, const bvh<Set, Space, Layout>& tree) {
    auto& shared = *tree.stored().least_ids;
    const std::scoped_lock lock(shared.making);
    const std::size_t nodes = tree.stored().nodes.size();
    if (shared.made.size() == 0 && nodes > 0) {
        using numbers = execution::buffer_of<Policy, std::uint32_t>;
        const auto view = tree.view();
        using node = std::remove_cvref_t<decltype(*view.nodes)>;
        bvh_root<typename Set::scalar_type> root;
        download(on, view.top, 1, &root);
        numbers above(on, nodes), reached(on, nodes), least(on, nodes);
        for_each_index(on, nodes, write_links<node>{view.nodes, root.child, above.data()});
        fill(on, reached.data(), nodes, no_link);
        for_each_index(on, nodes, fold_up<join_least_ids<node>>{{view.nodes, above.data(), least.data()}, reached.data()});
        synchronize(on);
        shared.made = std::move(least);
    }
    return shared.made.data();
}
/// Whether there is nothing to be made any more.
template <class Set, memory_space Space, class Layout>
bool has_least_ids(const bvh<Set, Space, Layout>& tree) {
    auto& shared = *tree.stored().least_ids;
    const std::scoped_lock lock(shared.making);
    return shared.made.size() == tree.stored().nodes.size();
}
/// Whether somebody had use for them. They pay from the second time on.
///@{
template <class Set, memory_space Space, class Layout>
bool wants_least_ids(const bvh<Set, Space, Layout>& tree) {
    auto& shared = *tree.stored().least_ids;
    const std::scoped_lock lock(shared.making);
    return shared.wanted;
}
template <class Set, memory_space Space, class Layout>
void want_least_ids(const bvh<Set, Space, Layout>& tree) {
    auto& shared = *tree.stored().least_ids;
    const std::scoped_lock lock(shared.making);
    shared.wanted = true;
}
///@}

}  // namespace abut::detail
