// SPDX-License-Identifier: MIT
#pragma once

// The least id of the shapes below each node of a tree. Who looks for the pair with the least ids leaves out all that lies
// below two nodes as soon as a lesser pair is known. They depend on a tree's topology alone. Made with a tree where
// bvh_options::least_ids says so, or for one query.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Those that a tree keeps, or null.
template <class Index>
const std::uint32_t* own_least_ids([[maybe_unused]] const Index& tree) {
    if constexpr (keeps_least_ids<Index>) {
        if (tree.stored().least_ids != nullptr) return tree.stored().least_ids->data();
    }
    return nullptr;
}

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

/// f(node) of each inner node of a tree in host memory, children first. In the order of a walk, which is about that of memory.
template <bvh_layout Tree, class F>
void for_each_node_up(const Tree& tree, const F& f) {
    if (tree.size() < 2) return;
    std::vector<std::uint32_t> order;
    order.reserve(tree.size());
    bvh_child waiting[bvh_max_depth * (Tree::width - 1) + 1] = {tree.root()};
    for (int count = 1; count > 0;) {
        const std::uint32_t at = waiting[--count].index();
        order.push_back(at);
        const auto& node = tree.fetch(at);
        for (int slot = tree.children(node); slot-- > 0;) {
            if (!tree.child(node, slot).is_leaf()) waiting[count++] = tree.child(node, slot);
        }
    }
    for (std::size_t i = order.size(); i-- > 0;) f(order[i]);
}
/// Where what is found of each node has room, as it is found.
inline std::uint32_t& place_of(std::vector<std::uint32_t>& of_nodes, std::uint32_t node) {
    if (node >= of_nodes.size()) of_nodes.resize(std::size_t{node} + 1);
    return of_nodes[node];
}
/// The least ids of any tree in host memory, by one thread: 4 bytes a shape, and 4 while they are made.
template <bvh_layout Tree>
std::vector<std::uint32_t> least_ids_of_nodes(const Tree& tree) {
    std::vector<std::uint32_t> least;
    least.reserve(tree.size());
    for_each_node_up(tree, [&](std::uint32_t at) {
        const auto& node = tree.fetch(at);
        std::uint32_t of_node = static_cast<std::uint32_t>(-1);
        for (int slot = 0; slot < tree.children(node); ++slot) {
            const bvh_child child = tree.child(node, slot);
            const std::uint32_t below = child.is_leaf() ? child.index() : least[child.index()];
            of_node = below < of_node ? below : of_node;
        }
        place_of(least, at) = of_node;
    });
    return least;
}

}  // namespace abut::detail
