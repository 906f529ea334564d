// SPDX-License-Identifier: MIT
#pragma once

// oriented: a tree of oriented boxes (S. Gottschalk, M. Lin, D. Manocha, OBBTree, 1996), over the topology of a finished
// one. Where surfaces come close to each other without touching, boxes that lie along them tell them apart many levels
// sooner than boxes along the axes do, and it does not matter how the objects are turned.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/parallel.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/shape/volume.hpp>

namespace abut {

/// An inner node: its two children with their boxes, two cache lines in single precision.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 64 : 16) oriented_node {
    obb<T> volume[2];
    bvh_child child[2];
};

/// A view of an oriented tree. `bounds` is of the box along the axes around an oriented one, which is made anew each time.
template <scalar T, memory_space Space>
struct oriented_view : bvh_view_base<T, Space, oriented_node<T>> {
    using node_type = oriented_node<T>;
    static constexpr bool nested = false;

    [[nodiscard]] ABUT_HD const node_type& fetch(std::uint32_t node) const { return this->nodes[node]; }
    [[nodiscard]] ABUT_HD static const obb<T>& volume(const node_type& n, int side) { return n.volume[side]; }
    [[nodiscard]] ABUT_HD static aabb<T> bounds(const node_type& n, int side) { return abut::bounds(n.volume[side]); }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int side) { return n.child[side]; }
};

/// 128 bytes a node in single precision, 256 in double.
struct oriented_layout {
    template <scalar T, memory_space Space>
    using view = oriented_view<T, Space>;

    template <scalar T, memory_space Space>
    using storage = bvh_storage<oriented_layout, T, Space>;
};

namespace detail {

/// Shapes in the order in which a walk from left to right meets them; those below a node, or in a leaf, lie side by side.
struct leaves_in_order {
    struct range {
        std::uint32_t first, count;
    };
    std::vector<std::uint32_t> shapes;
    std::vector<range> of_node;

    template <scalar T>
    leaves_in_order(const bvh_node<T>* nodes, std::size_t node_count, bvh_child root) : of_node(node_count) {
        shapes.reserve(node_count + 1);
        std::vector<bvh_child> pending{root};
        std::vector<std::uint32_t> met;
        while (!pending.empty()) {
            const bvh_child at = pending.back();
            pending.pop_back();
            if (at.is_leaf()) {
                shapes.push_back(at.index());
                continue;
            }
            met.push_back(at.index());
            of_node[at.index()].first = static_cast<std::uint32_t>(shapes.size());
            pending.push_back(nodes[at.index()].child[1]);
            pending.push_back(nodes[at.index()].child[0]);
        }
        for (std::size_t i = met.size(); i-- > 0;) {  // children before parents
            range& of = of_node[met[i]];
            of.count = 0;
            for (const bvh_child& child : nodes[met[i]].child)
                of.count += child.is_leaf() ? 1 : of_node[child.index()].count;
        }
    }
    /// Of a child that hangs at a node.
    [[nodiscard]] range of(bvh_child child) const { return child.is_leaf() ? range{0, 1} : of_node[child.index()]; }
};

/// Triangles by their place in an order.
template <shape_view Shapes>
struct some_triangles {
    const Shapes* shapes;
    const std::uint32_t* ids;
    std::size_t count;
    [[nodiscard]] std::size_t size() const { return count; }
    [[nodiscard]] auto operator[](std::size_t i) const { return (*shapes)[ids[i]]; }
};

}  // namespace detail

/// A tree of oriented boxes of the same topology, for triangles and the host's policies. It shares the set and nothing else;
/// the one it was made of may go. Each box is fitted to all triangles in it, along the principal axes of their corners, so
/// this takes time in proportion to the number of shapes times the depth of the tree: some thirty builds of the tree itself.
/// It pays for queries that come close and touch little, again and again: nested or neighbouring surfaces, `any`. Pairs of
/// two oriented trees, posed or not, are told apart by fifteen axes; together with anything else an oriented tree stands for
/// its boxes along the axes, slowly. 128 bytes a shape in single precision, 256 in double. Returns when it is done. Throws
/// std::bad_alloc.
///
///     const auto tree = oriented(on, make_bvh(on, mesh, {.builder = bvh_builder::sah}));
template <execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, oriented_layout> oriented(const Policy& on, const bvh<Set, Space>& tree) {
    static_assert(host_policy<Policy> && std::same_as<Space, host_space>,
                  "abut: the oriented layout is for the host's policies, serial and openmp");
    using tree_type = bvh<Set, Space, oriented_layout>;
    using T = typename tree_type::scalar_type;
    static_assert(std::same_as<typename Set::shape_type, triangle<T>>, "abut: oriented boxes are fitted to triangles alone");
    const std::size_t n = tree.size();
    auto fresh = std::make_shared<typename tree_type::storage>();
    if (n > 0) {
        const bvh_node<T>* const nodes = tree.view().nodes;
        const bvh_root<T> root = *tree.view().top;
        const auto shapes = detail::view_of(tree.set());
        const detail::leaves_in_order leaves(nodes, n - 1, root.child);
        fresh->nodes = execution::buffer_of<Policy, oriented_node<T>>(on, n - 1);
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, 1);
        oriented_node<T>* const to = fresh->nodes.data();
        using triangles = detail::some_triangles<std::remove_const_t<decltype(shapes)>>;
        // Nodes near the root take longest, and lie anywhere: small parts, dealt out as threads become free.
        execution::for_each_range(execution::thread_count(on), n - 1, 16, [&](int, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                for (int side = 0; side < 2; ++side) {
                    const bvh_child child = nodes[i].child[side];
                    const std::uint32_t leaf = child.index();
                    const auto [first, count] = leaves.of(child);
                    to[i].volume[side] =
                        around<obb<T>>(triangles{&shapes, child.is_leaf() ? &leaf : leaves.shapes.data() + first, count});
                    to[i].child[side] = child;
                }
            }
        });
        // The root's box has to hold all that the view hands out.
        const auto box_of_node = [to](std::size_t i) { return merge(bounds(to[i].volume[0]), bounds(to[i].volume[1])); };
        const auto joined = [](const aabb<T>& a, const aabb<T>& b) { return merge(a, b); };
        *fresh->root.data() = {reduce(on, n - 1, root.bounds, joined, box_of_node), root.child};
    }
    return tree_type(tree.set(), std::move(fresh));
}

}  // namespace abut
