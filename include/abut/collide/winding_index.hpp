// SPDX-License-Identifier: MIT
#pragma once

// make_winding_index: what winding_number looks in, made once: far fields of a tree's nodes (far_field.hpp), four at a time,
// and the triangles below in fours. Not for other queries: those look in the tree.
//
// Its nodes stand for those of a tree of four children a node, and for every second level of a binary one. What has four
// triangles or fewer is a block of them. No result depends on how nodes and blocks are numbered.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

#include <abut/collide/far_field.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/narrow/solid_angle.hpp>
#include <abut/shape/posed.hpp>

namespace abut {

namespace detail {

/// Four children at most: inner nodes, and blocks with `of_block` set in their numbers.
struct alignas(64) winding_node {
    static constexpr std::uint32_t of_block = std::uint32_t{1} << 31;

    float center[3][4], center_low[3][4];                    ///< sums of two
    float radius[4], weight[4], noise[4], noise_of_high[4];  ///< as of far_bounds
    std::uint32_t child[4], count;
};

/// What a walk reads.
template <scalar T>
struct winding_view {
    const winding_node* nodes;
    const far_terms* terms;  ///< of each node
    const four_triangles<T>* blocks;
    std::size_t block_count;  ///< 0 of no triangles
    std::uint32_t root;       ///< a child's number
    winding_frame frame;
};

template <scalar T, memory_space Space>
struct winding_storage {
    execution::buffer<winding_node, Space> nodes;
    execution::buffer<far_terms, Space> terms;
    execution::buffer<four_triangles<T>, Space> blocks;
    std::uint32_t root = winding_node::of_block;
    winding_frame frame;
};

/// What becomes of a tree's node in an index.
template <bvh_layout Tree>
struct winding_slots {
    Tree tree;
    const winding_moments* moments;
    const std::uint32_t* above;

    [[nodiscard]] ABUT_HD bool is_block(bvh_child child) const { return child.is_leaf() || moments[child.index()].count <= 4; }
    /// Whether a node of the index stands for it.
    [[nodiscard]] ABUT_HD bool is_node(std::uint32_t number) const {
        if (moments[number].count <= 4) return false;
        bool is_even = true;
        if (Tree::width == 2) {
            for (std::uint32_t at = above[number]; at != no_link; at = above[at]) is_even = !is_even;
        }
        return is_even;
    }
    /// Its children in the index.
    ABUT_HD int children(std::uint32_t number, bvh_child (&out)[4]) const {
        const auto& node = tree.fetch(number);
        int count = 0;
        for (int slot = 0; slot < tree.children(node); ++slot) {
            const bvh_child child = tree.child(node, slot);
            if (Tree::width > 2 || is_block(child)) {
                out[count++] = child;
                continue;
            }
            const auto& below = tree.fetch(child.index());
            for (int k = 0; k < 2; ++k) out[count++] = tree.child(below, k);
        }
        return count;
    }
};

/// How many nodes, 0 or 1, and blocks stand for each of the tree's nodes.
template <bvh_layout Tree>
struct count_winding_slots {
    winding_slots<Tree> slots;
    std::uint32_t* nodes;
    std::uint32_t* blocks;

    ABUT_HD void operator()(std::size_t i) const {
        const auto number = static_cast<std::uint32_t>(i);
        nodes[i] = slots.is_node(number) ? 1u : 0u;
        blocks[i] = 0;
        if (nodes[i] == 0) return;
        bvh_child child[4];
        const int count = slots.children(number, child);
        for (int k = 0; k < count; ++k) blocks[i] += slots.is_block(child[k]) ? 1u : 0u;
    }
};

/// The four triangles or fewer below a child; the last places hold points.
template <bvh_layout Tree, shape_view Shapes, scalar T>
ABUT_HD void fill_block(const Tree& tree, const Shapes& shapes, bvh_child child, four_triangles<T>& block) {
    bvh_child pending[4] = {child};
    int waiting = 1, filled = 0;
    while (waiting > 0) {
        const bvh_child at = pending[--waiting];
        if (!at.is_leaf()) {
            const auto& node = tree.fetch(at.index());
            for (int slot = tree.children(node); slot-- > 0;) pending[waiting++] = tree.child(node, slot);
            continue;
        }
        const triangle<T> t = shapes[at.index()];
        const vec3<T> corner[] = {t.a, t.b, t.c};
        for (int k = 0; k < 3; ++k) {
            block.at[3 * k][filled] = corner[k].x;
            block.at[3 * k + 1][filled] = corner[k].y;
            block.at[3 * k + 2][filled] = corner[k].z;
        }
        ++filled;
    }
    for (; filled < 4; ++filled) {
        for (int k = 0; k < 9; ++k) block.at[k][filled] = block.at[k % 3][0];
    }
}
template <bvh_layout Tree, shape_view Shapes, scalar T>
struct fill_one_block {
    Tree tree;
    Shapes shapes;
    bvh_child child;
    four_triangles<T>* block;
    ABUT_HD void operator()(std::size_t) const { fill_block(tree, shapes, child, *block); }
};

/// Writes what stands for each of the tree's nodes.
template <bvh_layout Tree, shape_view Shapes>
struct write_winding_nodes {
    using T = typename Shapes::scalar_type;
    winding_slots<Tree> slots;
    Shapes shapes;
    winding_frame frame;
    const std::uint32_t* node_at;   ///< where a node's number begins; and the end
    const std::uint32_t* block_at;  ///< likewise
    winding_node* nodes;
    far_terms* terms;
    four_triangles<T>* blocks;

    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t number = node_at[i];
        if (node_at[i + 1] == number) return;
        std::uint32_t block = block_at[i];
        bvh_child child[4];
        winding_node node;
        node.count = static_cast<std::uint32_t>(slots.children(static_cast<std::uint32_t>(i), child));
        for (std::uint32_t k = 0; k < 4; ++k) {
            const bvh_child one = child[k < node.count ? k : 0];
            const winding_moments of = one.is_leaf() ? moments_of(shapes[one.index()], frame) : slots.moments[one.index()];
            const double center[3] = {of.center.x, of.center.y, of.center.z};
            for (int axis = 0; axis < 3; ++axis) {
                winding::write_floats(center[axis], node.center[axis][k], node.center_low[axis][k]);
            }
            const far_bounds bounds = write_far_terms(of, terms[number], static_cast<int>(k));
            node.radius[k] = bounds.radius, node.weight[k] = bounds.weight, node.noise[k] = bounds.noise;
            node.noise_of_high[k] = bounds.noise_of_high;
            node.child[k] = 0;
            if (k >= node.count) continue;
            if (slots.is_block(one)) {
                node.child[k] = winding_node::of_block | block;
                fill_block(slots.tree, shapes, one, blocks[block++]);
            } else {
                node.child[k] = node_at[one.index()];
            }
        }
        nodes[number] = node;
    }
};

/// Of a tree with shapes, as they are placed. May return before it is there.
template <class Policy, bvh_layout Tree, shape_view Shapes>
auto winding_storage_of(const Policy& on, const Tree& tree, bvh_child root, std::size_t tree_nodes, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    winding_storage<T, space_of<Policy>> made;
    const aabb<T> box = reduce(on, shapes.size(), empty_box<T>(), merge_boxes{}, box_of_shape<Shapes>{shapes});
    made.frame = winding_frame(widened(box.lower), widened(box.upper));
    const auto one_block = [&] {
        made.blocks = execution::buffer_of<Policy, four_triangles<T>>(on, 1);
        for_each_index(on, 1, fill_one_block<Tree, Shapes, T>{tree, shapes, root, made.blocks.data()});
    };
    if (root.is_leaf()) {
        one_block();
        return made;
    }
    const auto above = parents_of_nodes(on, tree, tree_nodes);
    const auto moments = moments_of_nodes(on, tree, tree_nodes, shapes, made.frame, above.data());
    if (shapes.size() <= 4) {
        one_block();
        return made;
    }
    const winding_slots<Tree> slots{tree, moments.data(), above.data()};
    execution::buffer_of<Policy, std::uint32_t> node_at(on, tree_nodes + 1), block_at(on, tree_nodes + 1);
    for_each_index(on, tree_nodes, count_winding_slots<Tree>{slots, node_at.data(), block_at.data()});
    exclusive_scan(on, node_at.data(), tree_nodes);
    exclusive_scan(on, block_at.data(), tree_nodes);
    std::uint32_t nodes = 0, blocks = 0;
    download(on, node_at.data() + tree_nodes, 1, &nodes);
    download(on, block_at.data() + tree_nodes, 1, &blocks);
    download(on, node_at.data() + root.index(), 1, &made.root);
    made.nodes = execution::buffer_of<Policy, winding_node>(on, nodes);
    made.terms = execution::buffer_of<Policy, far_terms>(on, nodes);
    made.blocks = execution::buffer_of<Policy, four_triangles<T>>(on, blocks);
    for_each_index(on, tree_nodes,
                   write_winding_nodes<Tree, Shapes>{slots, shapes, made.frame, node_at.data(), block_at.data(),
                                                     made.nodes.data(), made.terms.data(), made.blocks.data()});
    return made;
}

template <class Operand>
const auto& index_of(const Operand& x) {
    if constexpr (Operand::is_posed) {
        return index_of(x.operand);
    } else {
        return x.index;
    }
}
/// Of an operand with a tree. Complete when it returns.
template <class Policy, class Operand>
auto winding_storage_of(const Policy& on, const Operand& x) {
    const auto shapes = x.shapes();
    using T = typename std::remove_const_t<decltype(shapes)>::scalar_type;
    winding_storage<T, space_of<Policy>> made;
    if (shapes.size() > 0) {
        const auto& stored = index_of(x).stored();
        bvh_root<std::remove_cvref_t<decltype(x.tree().root_bounds().lower.x)>> root;
        download(on, stored.root.data(), 1, &root);
        made = winding_storage_of(on, x.tree(), root.child, stored.nodes.size(), shapes);
    }
    synchronize(on);
    return made;
}

}  // namespace detail

/// The triangles of a mesh as `winding_number` looks at them: made once of what it would be asked of, where points come a few
/// at a time. It keeps the triangles itself, as they were placed: neither the mesh nor a tree has to stay. Immutable; copies
/// share memory, and any number of threads may ask.
/// @ingroup indices
template <scalar T, memory_space Space>
class winding_index {
public:
    using scalar_type = T;            ///< float or double
    using shape_type = triangle<T>;   ///< what a shape is
    using memory_space = Space;       ///< where the memory lies
    using storage = detail::winding_storage<T, Space>;  ///< what owns the nodes and the triangles

    /// For make_winding_index.
    winding_index(std::size_t count, std::shared_ptr<const storage> made) : count_(count), made_(std::move(made)) {}

    /// Number of triangles.
    [[nodiscard]] std::size_t size() const { return count_; }
    /// The CUDA device that it lies on; -1 for the host.
    [[nodiscard]] int device() const { return made_->blocks.device(); }
    /// Its memory, in bytes.
    [[nodiscard]] std::size_t bytes() const {
        return made_->nodes.capacity_bytes() + made_->terms.capacity_bytes() + made_->blocks.capacity_bytes();
    }
    /// What walks read.
    [[nodiscard]] const storage& stored() const { return *made_; }

private:
    std::size_t count_;
    std::shared_ptr<const storage> made_;
};

/// A `winding_index` of a mesh, a soup of triangles, a view of either, or a tree of any layout over one; posed or not. Of a
/// tree it takes the shape, and trees that are better to query give a better index: one of `ploc` or `sah`. Without a tree
/// it makes one of `ploc`.
///
/// Some 290 bytes a triangle in single precision, 370 in double; scratch takes twice as much again. The same bits on every
/// policy, of trees that are the same. Linear time but for the tree.
///
/// Lies in the policy's memory. Returns when it is done; under `cuda` it waits for the policy's stream, which has to outlive
/// it. Errors are those of `winding_number`, and of `make_bvh`.
///
/// @snippet queries.cpp make_winding_index
///
/// @ingroup indices
template <execution_policy Policy, class X>
[[nodiscard]] auto make_winding_index(const Policy& on, const X& mesh) {
    constexpr const char* function = "abut::make_winding_index";
    using shape_type = typename detail::shape_of_argument<X>::type;
    using T = scalar_type_of<shape_type>;
    static_assert(std::same_as<shape_type, triangle<T>>,
                  "abut: a winding index is of triangles: a mesh, a soup of triangles, or a tree of them");
    if constexpr (!std::same_as<shape_type, triangle<T>>) {
        return detail::refused{};
    } else if constexpr (decltype(detail::make_operand(on, mesh, function))::has_tree) {
        const auto x = detail::make_operand(on, mesh, function);
        using storage = typename winding_index<T, space_of<Policy>>::storage;
        auto made = std::make_shared<const storage>(detail::winding_storage_of(on, x));
        return winding_index<T, space_of<Policy>>(x.shapes().size(), std::move(made));
    } else if constexpr (is_posed<X>) {
        return make_winding_index(on, posed(make_bvh(on, mesh.object, {.builder = bvh_builder::ploc}), mesh.pose));
    } else {
        return make_winding_index(on, make_bvh(on, mesh, {.builder = bvh_builder::ploc}));
    }
}

}  // namespace abut
