// SPDX-License-Identifier: MIT
#pragma once

// refit: a tree's boxes made anew around shapes that have moved, bottom-up in one pass, while its topology stays. A build
// sorts; this does not, and so it is what a step of a simulation pays for.
//
// A climb begins at each node with two leaves. Where a node's other child is a leaf, the climb reads that leaf's shape and
// goes on; where it is a node, the second climb that arrives goes on. So only nodes above two nodes need an atomic
// operation, about a third of them.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>

namespace abut {

namespace detail {

/// Writes the link of each node's children. Nodes are read, boxes are not.
template <scalar T>
struct write_links {
    const bvh_node<T>* nodes;
    bvh_child root;
    bvh_link* links;
    ABUT_HD void operator()(std::size_t i) const {
        const auto node = static_cast<std::uint32_t>(i);
        const bvh_child left = nodes[i].child[0], right = nodes[i].child[1];
        if (!left.is_leaf()) links[left.index()] = {2 * node, right};
        if (!right.is_leaf()) links[right.index()] = {2 * node + 1, left};
        if (node == root.index()) links[node] = {bvh_link::none, {}};
    }
};

template <scalar T>
struct has_two_leaves {
    const bvh_node<T>* nodes;
    ABUT_HD bool operator()(std::size_t i) const { return nodes[i].child[0].is_leaf() && nodes[i].child[1].is_leaf(); }
};

/// The links of a tree with two shapes or more: made by whoever needs them first.
template <class Policy, class Storage>
const auto& links_of(const Policy& on, const Storage& tree) {
    using T = std::remove_cvref_t<decltype(tree.root.data()->bounds.lower.x)>;
    auto& links = *tree.links;
    const std::scoped_lock lock(links.making);
    if (!links.made) {
        const std::size_t n = tree.nodes.size();
        const bvh_node<T>* const nodes = tree.nodes.data();
        bvh_root<T> root;
        download(on, tree.root.data(), 1, &root);
        execution::buffer_of<Policy, bvh_link> of_nodes(on, n);
        execution::buffer_of<Policy, std::uint32_t> found(on, n);
        for_each_index(on, n, write_links<T>{nodes, root.child, of_nodes.data()});
        const std::size_t count = compact(on, n, has_two_leaves<T>{nodes}, found.data());
        execution::buffer_of<Policy, std::uint32_t> starts(on, count);
        copy(on, found.data(), count, starts.data());
        synchronize(on);  // another policy may use them, in a stream of its own
        links.of_nodes = std::move(of_nodes);
        links.starts = std::move(starts);
        links.made = true;
    }
    return links;
}

/// Boxes as a set of shapes.
template <scalar T, memory_space Space>
struct box_view {
    using scalar_type = T;
    using shape_type = aabb<T>;
    using memory_space = Space;
    const aabb<T>* boxes;
    std::size_t count;
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    [[nodiscard]] ABUT_HD aabb<T> operator[](std::size_t i) const { return boxes[i]; }
};

template <shape_view Shapes>
struct write_box {
    Shapes shapes;
    aabb<typename Shapes::scalar_type>* boxes;
    ABUT_HD void operator()(std::size_t i) const { boxes[i] = bounds(shapes[i]); }
};

template <shape_view Shapes>
struct refit_climb {
    using T = typename Shapes::scalar_type;

    Shapes shapes;
    const bvh_node<T>* old;
    const bvh_link* links;
    const std::uint32_t* starts;
    std::size_t start_count;
    std::uint32_t* arrived;  ///< 0 for each node
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    ABUT_HD void operator()(std::size_t i) const {
        std::uint32_t node = starts[i];
#if !ABUT_DEVICE_CODE
        // Processors guess how a climb goes on, often wrongly, and then wait for each box and node in turn; so what climbs
        // that begin later will need is asked for now. Not in a function of its own: g++ drops calls that do nothing else.
        if constexpr (std::same_as<Shapes, box_view<T, host_space>>) {
            constexpr std::size_t ahead = 16;
            if (i + 2 * ahead < start_count) {
                __builtin_prefetch(old + starts[i + 2 * ahead]);
                const std::uint32_t next = starts[i + ahead];
                const bvh_link link = links[next];
                __builtin_prefetch(shapes.boxes + old[next].child[0].index());
                __builtin_prefetch(shapes.boxes + old[next].child[1].index());
                if (link.sibling.is_leaf()) __builtin_prefetch(shapes.boxes + link.sibling.index());
                __builtin_prefetch(nodes + next, 1);
                __builtin_prefetch(nodes + link.up / 2, 1);
                __builtin_prefetch(links + link.up / 2);
            }
        }
#endif
        const bvh_child left = old[node].child[0], right = old[node].child[1];
        const aabb<T> box_left = bounds(shapes[left.index()]), box_right = bounds(shapes[right.index()]);
        nodes[node] = {{box_left, box_right}, {left, right}};
        aabb<T> box = merge(box_left, box_right);
        for (;;) {
            const bvh_link link = links[node];
            const bvh_child self = bvh_child::inner(node);
            if (link.up == bvh_link::none) {
                *root = {box, self};
                return;
            }
            node = link.up / 2;
            const bool on_right = (link.up & 1) != 0;
            aabb<T> other;
            if (link.sibling.is_leaf()) {
                other = bounds(shapes[link.sibling.index()]);
            } else {
                // For the other climb, if it is second.
                nodes[node].bounds[on_right ? 1 : 0] = box;
                if (execution::atomic_exchange_acq_rel(&arrived[node], 1u) == 0) return;
                other = load_fresh(nodes[node].bounds[on_right ? 0 : 1]);
            }
            // The left box first, whichever climb this is: of zeros of both signs the first is kept.
            if (on_right) {
                nodes[node] = {{other, box}, {link.sibling, self}};
                box = merge(other, box);
            } else {
                nodes[node] = {{box, other}, {self, link.sibling}};
                box = merge(box, other);
            }
        }
    }
};

/// The climbs, with `shapes` read in the order of leaves.
template <class Policy, shape_view Shapes, class Storage>
void refit_nodes(const Policy& on, const Shapes& shapes, const Storage& old, Storage& fresh) {
    const auto& links = links_of(on, old);
    execution::buffer_of<Policy, std::uint32_t> arrived(on, old.nodes.size());
    fill(on, arrived.data(), arrived.size(), std::uint32_t{0});
    for_each_index(on, links.starts.size(),
                   refit_climb<Shapes>{shapes, old.nodes.data(), links.of_nodes.data(), links.starts.data(),
                                       links.starts.size(), arrived.data(), fresh.nodes.data(), fresh.root.data()});
}

template <shape_view Shapes>
struct refit_single {
    Shapes shapes;
    bvh_root<typename Shapes::scalar_type>* root;
    ABUT_HD void operator()(std::size_t) const { *root = {bounds(shapes[0]), bvh_child::leaf(0)}; }
};

}  // namespace detail

/// A tree of the topology of `tree` over the shapes of `set`, of which there are as many: shape i takes the place of shape
/// i. `tree` stays as it is, and the two share nothing that either could change. Results of queries are right however far
/// shapes have moved; only speed suffers, and `quality` shows how much.
///
/// The set may be of another kind than the tree's. It is brought to the policy's memory and checked as by make_bvh; a tree
/// in another layout than the standard one is refitted before it is converted. Returns when the boxes are there. The first
/// refit of a topology also derives 8 bytes a node and 4 for each node with two leaves, which all trees that come of it
/// share, `tree` too: under cuda the stream of that first refit has to outlive them all. Throws invalid_geometry (views
/// only), error (another number of shapes, a tree on another device), std::bad_alloc, cuda_error.
template <execution_policy Policy, class OldSet, memory_space Space, bvh_layout_kind Layout, class Set>
[[nodiscard]] auto refit(const Policy& on, const bvh<OldSet, Space, Layout>& tree, const Set& set) {
    static_assert(std::same_as<Layout, standard_layout>,
                  "abut: refit takes a tree in the standard layout; refit that one and convert the result");
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: the index lies in other memory than the policy works in; make it with the same policy");
    auto resident = detail::make_resident(on, set, "abut::refit");
    using tree_type = bvh<decltype(resident), Space>;
    using T = typename tree_type::scalar_type;
    static_assert(std::same_as<T, typename OldSet::scalar_type>, "abut: the tree and the set have different scalar types");
    const auto shapes = detail::view_of(resident);
    using shapes_type = std::remove_const_t<decltype(shapes)>;
    const std::size_t n = shapes.size();
    if (n != tree.size()) {
        throw error("abut::refit: the tree has " + std::to_string(tree.size()) + " shapes, the set " + std::to_string(n));
    }
    detail::require_same_device(on, tree, "abut::refit");
    auto fresh = std::make_shared<typename tree_type::storage>();
    fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, n > 0 ? 1 : 0);
    fresh->nodes = execution::buffer_of<Policy, bvh_node<T>>(on, n > 0 ? n - 1 : 0);
    const auto& old = tree.stored();
    fresh->links = old.links;
    if (n == 1) {
        for_each_index(on, 1, detail::refit_single<shapes_type>{shapes, fresh->root.data()});
    } else if (n > 1) {
        if constexpr (host_policy<Policy>) {
            // A processor waits for what it reads out of order: a box is one line of memory, a mesh's triangle up to four.
            execution::buffer_of<Policy, aabb<T>> boxes(on, n);
            for_each_index(on, n, detail::write_box<shapes_type>{shapes, boxes.data()});
            detail::refit_nodes(on, detail::box_view<T, Space>{boxes.data(), n}, old, *fresh);
        } else {
            detail::refit_nodes(on, shapes, old, *fresh);
        }
    }
    synchronize(on);
    return tree_type(std::move(resident), std::move(fresh));
}

}  // namespace abut
