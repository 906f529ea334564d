// SPDX-License-Identifier: MIT
#pragma once

// bounded_by: a tree of any bounding volume (shape/volume.hpp), over the topology of a finished one. Trees of oriented boxes
// (S. Gottschalk, M. Lin, D. Manocha, OBBTree, 1996) have a name of their own, oriented: where surfaces come close to each
// other without touching, boxes that lie along them tell them apart many levels sooner than boxes along the axes do, and it
// does not matter how the objects are turned.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/walk_order.hpp>
#include <abut/shape/moving_shape.hpp>
#include <abut/shape/volume.hpp>

namespace abut {

/// An inner node: its two children with their volumes, in whole cache lines in single precision.
template <bounding_volume V>
struct alignas(sizeof(typename detail::volume_scalar<V>::type) == 4 ? 64 : 16) bounded_node {
    V volume[2];         ///< around the children's shapes
    bvh_child child[2];  ///< the children
};

/// A view of a tree of volumes. `bounds` is of the box along the axes around a volume, which is made anew each time.
template <bounding_volume V, memory_space Space>
struct bounded_view : bvh_view_base<typename detail::volume_scalar<V>::type, Space, bounded_node<V>> {
    using volume_type = V;                 ///< a volume
    using node_type = bounded_node<V>;     ///< a node, as walks read it
    static constexpr bool nested = false;  ///< a volume need not hold those of the children

    /// Node, volume, box and child by number, as bvh_layout says. On hosts and devices.
    ///@{
    [[nodiscard]] ABUT_HD const node_type& fetch(std::uint32_t node) const { return this->nodes[node]; }
    [[nodiscard]] ABUT_HD static const V& volume(const node_type& n, int slot) { return n.volume[slot]; }
    [[nodiscard]] ABUT_HD static auto bounds(const node_type& n, int slot) {
        using abut::bounds;  // beside it, that of a volume of the caller's own
        return bounds(n.volume[slot]);
    }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int slot) { return n.child[slot]; }
    ///@}
};

/// Both children's volumes in their parent. Bytes a node in single and double precision: 64 and 80 for spheres, 128 and 256
/// for oriented boxes, 128 and 240, 192 and 304, 256 and 432 for kdop of 14, 18 and 26 planes.
template <bounding_volume V>
struct bounded_layout {
    /// What kernels see, and what owns a tree of this layout.
    ///@{
    template <scalar T, memory_space Space>
    using view = bounded_view<typename detail::volume_scalar<V>::template rebound<T>, Space>;

    template <scalar T, memory_space Space>
    using storage = bvh_storage<bounded_layout, T, Space>;
    ///@}
};

namespace detail {

/// Volumes merged from below, to be folded up (index/walk_order.hpp): what a node holds goes to where it hangs.
template <bounding_volume V>
struct merge_volumes {
    bounded_node<V>* nodes;
    const std::uint32_t* above;
    [[nodiscard]] ABUT_HD bool is_leaf(std::size_t node, std::uint32_t slot) const {
        return nodes[node].child[slot].is_leaf();
    }
    [[nodiscard]] ABUT_HD static std::uint32_t leaf_value(std::size_t, std::uint32_t) { return 0; }
    ABUT_HD std::uint32_t join(std::uint32_t node, std::uint32_t, std::uint32_t) const {
        const std::uint32_t link = above[node];
        if (link != no_link) nodes[link / 2].volume[link % 2] = merge(nodes[node].volume[0], nodes[node].volume[1]);
        return 0;
    }
};

/// Shapes that volumes are made around, as the triangles of their corners: segments and points have fewer, and a shape in
/// motion is between where it begins and where it ends, as convex volumes are that hold both.
template <class S>
inline constexpr std::size_t triangles_of = 0;
template <scalar T>
inline constexpr std::size_t triangles_of<triangle<T>> = 1;
template <scalar T>
inline constexpr std::size_t triangles_of<segment<T>> = 1;
template <scalar T>
inline constexpr std::size_t triangles_of<vec3<T>> = 1;
template <class S>
inline constexpr std::size_t triangles_of<motion<S>> = 2 * triangles_of<S>;

template <scalar T>
ABUT_HD constexpr triangle<T> corner_triangle(const triangle<T>& t, std::size_t) {
    return t;
}
template <scalar T>
ABUT_HD constexpr triangle<T> corner_triangle(const segment<T>& s, std::size_t) {
    return {s.a, s.b, s.b};
}
template <scalar T>
ABUT_HD constexpr triangle<T> corner_triangle(const vec3<T>& p, std::size_t) {
    return {p, p, p};
}
template <class S>
ABUT_HD constexpr auto corner_triangle(const motion<S>& m, std::size_t i) {
    return corner_triangle(i == 0 ? m.t0 : m.t1, 0);
}

/// The same of shapes by their position in an order. For devices as well, since `around` is, though none gets here.
template <shape_view Shapes>
struct some_triangles {
    static constexpr std::size_t each = triangles_of<typename Shapes::shape_type>;
    const Shapes* shapes;
    const std::uint32_t* ids;
    std::size_t count;
    [[nodiscard]] ABUT_HD std::size_t size() const { return each * count; }
    [[nodiscard]] ABUT_HD auto operator[](std::size_t i) const { return corner_triangle((*shapes)[ids[i / each]], i % each); }
};

}  // namespace detail

/// @addtogroup indices
///@{

/// A tree of volumes V of the same topology, for triangles, segments and points, at rest or in motion. It shares the set and
/// nothing else; the one it was made of may go. Each volume is as small as one made around all triangles in it.
///
/// Oriented boxes and spheres are made so, in time proportional to the number of shapes times the depth of the tree: some
/// thirty and seventy linear builds. kdop and aabb are merged from below, in linear time: some ten. For a device the tree is
/// made on all threads of the host, of a copy, and brought there. Throws error (a tree on another device), std::bad_alloc,
/// cuda_error.
///
/// Two trees of one kind of volume are told apart by these, but of kdop under a pose by the boxes along the axes. Together
/// with anything else a tree of volumes stands for such boxes. Where they have to be made at each look, that is slow.
///
///     const auto better = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah});
///     const auto tree = abut::bounded_by<abut::kdop<float, 18>>(on, better);
template <bounding_volume V, execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, bounded_layout<V>> bounded_by(const Policy& on, const bvh<Set, Space>& tree) {
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: a tree of volumes is made by a policy of the memory where the tree is");
    static_assert(host_policy<Policy> || shape_set<Set>,
                  "abut: on a device a tree of volumes is made of a tree over a set, not over a view");
    detail::require_same_device(on, tree, "abut::bounded_by");
    using tree_type = bvh<Set, Space, bounded_layout<V>>;
    using T = typename tree_type::scalar_type;
    static_assert(std::same_as<typename detail::volume_scalar<V>::type, T>,
                  "abut: the volumes and the tree's shapes differ in their scalar type");
    static_assert(detail::triangles_of<typename Set::shape_type> > 0,
                  "abut: volumes are made around triangles, segments and points alone, at rest or in motion");
    const std::size_t n = tree.size();
    auto fresh = std::make_shared<typename tree_type::storage>();
    fresh->least_ids = tree.stored().least_ids;
    if constexpr (!host_policy<Policy>) {
        const auto set = copy_to(openmp{}, tree.set());
        using on_host = bvh<std::remove_const_t<decltype(set)>, host_space>;
        const auto made = bounded_by<V>(
            openmp{}, on_host(set, std::make_shared<typename on_host::storage>(tree.stored().to_host())));
        const auto& from = made.stored();
        fresh->nodes = execution::buffer_of<Policy, bounded_node<V>>(on, from.nodes.size());
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, from.root.size());
        upload(on, from.nodes.data(), from.nodes.size(), fresh->nodes.data());
        upload(on, from.root.data(), from.root.size(), fresh->root.data());
        synchronize(on);
    } else if (n > 0) {
        const bvh_node<T>* const nodes = tree.view().nodes;
        const bvh_root<T> root = *tree.view().top;
        const auto shapes = detail::view_of(tree.set());
        fresh->nodes = execution::buffer_of<Policy, bounded_node<V>>(on, n - 1);
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, 1);
        bounded_node<V>* const to = fresh->nodes.data();
        const auto order = n > 1 ? detail::order_by_walk(on, nodes, n - 1, root.child) : detail::walk_order<Space>{};
        using triangles = detail::some_triangles<std::remove_const_t<decltype(shapes)>>;
        // Nodes near the root take longest, and lie anywhere.
        for_each_task(on, n - 1, [&](std::size_t i) {
            for (int slot = 0; slot < 2; ++slot) {
                const bvh_child child = nodes[i].child[slot];
                to[i].child[slot] = child;
                if (detail::merges_tightly<V> && !child.is_leaf()) continue;
                const detail::node_range of =
                    child.is_leaf() ? detail::node_range{0, 0, 1} : order.ranges.data()[child.index()];
                const std::uint32_t leaf = child.index();
                to[i].volume[slot] =
                    around<V>(triangles{&shapes, child.is_leaf() ? &leaf : order.leaves.data() + of.first, of.count});
            }
        });
        if constexpr (detail::merges_tightly<V>) {
            execution::buffer_of<Policy, std::uint32_t> reached(on, n - 1);
            fill(on, reached.data(), n - 1, detail::no_link);
            for_each_index(on, n - 1, detail::fold_up<detail::merge_volumes<V>>{{to, order.above.data()}, reached.data()});
        }
        // The root's box has to hold all that the view hands out.
        const auto box_of_node = [to](std::size_t i) { return merge(bounds(to[i].volume[0]), bounds(to[i].volume[1])); };
        const auto joined = [](const aabb<T>& a, const aabb<T>& b) { return merge(a, b); };
        *fresh->root.data() = {reduce(on, n - 1, root.bounds, joined, box_of_node), root.child};
    }
    return tree_type(tree.set(), std::move(fresh));
}

/// A tree of oriented boxes, fitted along the principal axes of the corners in them; two are told apart by fifteen axes. It
/// pays for queries that come close and touch little, again and again: nested or neighbouring surfaces, `any`.
///
///     const auto tree = abut::oriented(on, abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah}));
template <execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, bounded_layout<obb<typename Set::scalar_type>>> oriented(const Policy& on,
                                                                                       const bvh<Set, Space>& tree) {
    return bounded_by<obb<typename Set::scalar_type>>(on, tree);
}

///@}

}  // namespace abut
