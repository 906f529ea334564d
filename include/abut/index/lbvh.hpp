// SPDX-License-Identifier: MIT
#pragma once

// make_bvh: a linear BVH in one bottom-up pass over shapes sorted by Morton code (Apetrei, "Fast and Simple Agglomerative
// LBVH Construction", 2014). Each leaf climbs; of the two threads that reach a node, the second knows both boxes and goes
// on. Topology and boxes depend on the shapes alone, not on the policy or the order of the threads.

#include <cstddef>
#include <cstdint>
#include <memory>

#include <abut/execution/atomic.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/binned_sah.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/leaf_order.hpp>
#include <abut/index/mean_split.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/ploc.hpp>

namespace abut {

namespace detail {

/// The box of shape i, which is kept too: it is read again out of order, and a box is one place where a triangle of a mesh
/// is four.
template <shape_view Shapes>
struct keep_bounds {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    aabb<T>* boxes;
    ABUT_HD aabb<T> operator()(std::size_t i) const {
        const aabb<T> box = bounds(shapes[i]);
        boxes[i] = box;
        return box;
    }
};

struct merge_boxes {
    template <class T>
    ABUT_HD aabb<T> operator()(const aabb<T>& a, const aabb<T>& b) const {
        return merge(a, b);
    }
};

/// The climb of leaf i. A node between sorted leaves k and k + 1 is node k. A range of leaves [first, last] joins its
/// neighbour across the closer of its two borders; `reached` holds, for each node, the far end of the child that came first.
/// Most nodes lie within a group of leaves (for_each_in_groups), which meet in the memory that they share; only ranges that
/// find nobody there go on outside.
template <class Code, scalar T>
struct climb {
    static constexpr std::uint32_t nobody = static_cast<std::uint32_t>(-1);
    static constexpr std::uint32_t group = execution::group_size;

    const aabb<T>* boxes;
    std::size_t shapes;
    const Code* codes;
    const std::uint32_t* ids;
    std::uint32_t* reached;
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    /// Nodes between leaves of one group: side, coordinate, node, so that neighbours do not meet in one bank of memory.
    struct shared {
        T bounds[2][6][group];
        bvh_child child[2][group];
        std::uint32_t reached[group], joined[group];

        ABUT_HD void put(int side, std::uint32_t k, const aabb<T>& box, bvh_child is) {
            const T values[] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
            for (int c = 0; c < 6; ++c) bounds[side][c][k] = values[c];
            child[side][k] = is;
        }
        [[nodiscard]] ABUT_HD aabb<T> box(int side, std::uint32_t k) const {
            const auto& b = bounds[side];
            return {{b[0][k], b[1][k], b[2][k]}, {b[3][k], b[4][k], b[5][k]}};
        }
    };
    /// A range of leaves and the tree over it; `waits` is the place in the group of the node where it found nobody.
    struct state {
        aabb<T> box;
        bvh_child child;
        std::uint32_t first, last, waits;
    };

    ABUT_HD void prepare(unsigned k, shared& with) const {
        with.reached[k] = nobody;
        with.joined[k] = 0;
    }
    ABUT_HD state inside(std::size_t i, shared& with) const {
        const auto leaf = static_cast<std::uint32_t>(i), first_of_group = leaf / group * group;
        const std::uint32_t last_leaf = count() - 1;
        const std::uint32_t last_of_group = last_leaf - first_of_group < group ? last_leaf : first_of_group + (group - 1);
        const std::uint32_t id = ids[i];
        state at{boxes[id], bvh_child::leaf(id), leaf, leaf, nobody};
        while (!is_all(at)) {
            const bool left = is_left(at);
            const std::uint32_t node = node_above(at, left);
            if (node < first_of_group || node >= last_of_group) return at;
            const std::uint32_t k = node - first_of_group;
            const int side = left ? 0 : 1;
            with.put(side, k, at.box, at.child);
            const std::uint32_t other = execution::exchange_in_group(&with.reached[k], far_end(at, left));
            if (other == nobody) {
                at.waits = k;
                return at;
            }
            with.joined[k] = 1;
            const aabb<T> sibling = with.box(1 - side, k);
            const bvh_child its = with.child[1 - side][k];
            nodes[node] =
                left ? bvh_node<T>{{at.box, sibling}, {at.child, its}} : bvh_node<T>{{sibling, at.box}, {its, at.child}};
            join(at, left, node, other, sibling);
        }
        return at;
    }
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void outside(std::size_t i, state at, const shared& with, Count& crowded) const {
        crowded.add(is_crowded<Code>{codes, shapes}(i));
        if (at.waits != nobody && with.joined[at.waits] != 0) return;
        while (!is_all(at)) {
            const bool left = is_left(at);
            const std::uint32_t node = node_above(at, left);
            put(at, left, nodes[node]);
            const std::uint32_t other = execution::atomic_exchange_acq_rel(&reached[node], far_end(at, left));
            if (other == nobody) return;
            join(at, left, node, other, load_fresh(nodes[node].bounds[left ? 1 : 0]));
        }
        *root = {at.box, at.child};
    }

private:
    /// How far apart leaves k and k + 1 are: the highest bit in which their codes, and between equal codes their positions,
    /// differ. Comparing the numbers compares those bits, since no two borders of one range share their highest bit.
    struct distance {
        Code code;
        std::uint32_t position;
        ABUT_HD bool operator<(const distance& other) const {
            return code < other.code || (code == other.code && position < other.position);
        }
    };
    ABUT_HD distance across(std::uint32_t k) const { return {static_cast<Code>(codes[k] ^ codes[k + 1]), k ^ (k + 1)}; }

    [[nodiscard]] ABUT_HD std::uint32_t count() const { return static_cast<std::uint32_t>(shapes); }
    ABUT_HD bool is_all(const state& at) const { return at.first == 0 && at.last == count() - 1; }
    /// Whether the range is the left child of the node above.
    ABUT_HD bool is_left(const state& at) const {
        return at.first == 0 || (at.last != count() - 1 && across(at.last) < across(at.first - 1));
    }
    ABUT_HD static std::uint32_t node_above(const state& at, bool left) { return left ? at.last : at.first - 1; }
    ABUT_HD static std::uint32_t far_end(const state& at, bool left) { return left ? at.first : at.last; }
    ABUT_HD static void put(const state& at, bool left, bvh_node<T>& node) {
        node.bounds[left ? 0 : 1] = at.box;
        node.child[left ? 0 : 1] = at.child;
    }
    /// Left before right, whoever comes first: the two zeros are told apart by it.
    ABUT_HD static void join(state& at, bool left, std::uint32_t node, std::uint32_t other, const aabb<T>& sibling) {
        at.box = left ? merge(at.box, sibling) : merge(sibling, at.box);
        at.child = bvh_child::inner(node);
        (left ? at.last : at.first) = other;
    }
};

/// Sorts the shapes by the first `bits` bits of their codes and builds the tree. Returns how many shapes have a code that
/// the eighth one after them has too.
template <class Code, execution_policy Policy, scalar T, class Storage>
std::uint64_t build_lbvh(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, Storage& tree, int bits) {
    const std::size_t n = boxes.size();
    const auto order = order_leaves<Code, Policy, T>(on, boxes, tree.root.data(), bits);
    execution::buffer_of<Policy, std::uint32_t> reached(on, n - 1);
    fill(on, reached.data(), n - 1, climb<Code, T>::nobody);
    execution::work_count<space_of<Policy>> crowded(on);
    const climb<Code, T> each{boxes.data(),    n, order.codes.data(), order.ids.data(), reached.data(), tree.nodes.data(),
                              tree.root.data()};
    for_each_in_groups(on, n, each, crowded);
    return crowded.total();
}

/// Builds by one of the top-down builders, where the policy has them. False if another is asked for.
template <execution_policy Policy, shape_view Shapes, class Storage>
bool build_from_top(const Policy& on, const Shapes& shapes, Storage& tree, bvh_builder builder) {
    using T = typename Shapes::scalar_type;
    if (builder == bvh_builder::linear || builder == bvh_builder::ploc) return false;
    if constexpr (host_policy<Policy>) {
        if (builder == bvh_builder::mean_split) build_top_down(on, shapes, tree, mean_splitter<T>{});
        if (builder == bvh_builder::sah) build_top_down(on, shapes, tree, sah_splitter<T>{});
    }
    return true;
}

}  // namespace detail

/// Builds a tree over the shapes of `set` in the policy's memory: a set in host memory is copied there first under cuda. A
/// view over the caller's arrays is checked and has to outlive the tree. Returns when the tree is built.
/// The same shapes give the same tree on every policy that has the builder, and for any number of threads.
/// Throws invalid_geometry (views only), error (bits that are not an option, a builder that the policy does not have),
/// std::bad_alloc, cuda_error.
template <execution_policy Policy, class Set>
[[nodiscard]] auto make_bvh(const Policy& on, const Set& set, const bvh_options& options = {}) {
    if (options.morton_bits != 0 && options.morton_bits != 30 && options.morton_bits != 63) {
        throw error("abut::make_bvh: morton_bits is " + std::to_string(options.morton_bits) + "; expected 0, 30 or 63");
    }
    if (options.builder > bvh_builder::ploc) throw error("abut::make_bvh: the builder is none of bvh_builder");
    if (!host_policy<Policy> && options.builder != bvh_builder::linear && options.builder != bvh_builder::ploc) {
        throw error(
            "abut::make_bvh: on a device the builder is bvh_builder::linear or ploc; serial and openmp have mean_split and "
            "sah");
    }
    auto resident = detail::make_resident(on, set, "abut::make_bvh");
    using tree_type = bvh<decltype(resident), space_of<Policy>>;
    using T = typename tree_type::scalar_type;
    const auto shapes = detail::view_of(resident);
    const std::size_t n = shapes.size();
    auto tree = std::make_shared<typename tree_type::storage>();
    tree->root = execution::buffer_of<Policy, bvh_root<T>>(on, n > 0 ? 1 : 0);
    tree->nodes = execution::buffer_of<Policy, bvh_node<T>>(on, n > 0 ? n - 1 : 0);
    if (n > 0 && !detail::build_from_top(on, shapes, *tree, options.builder)) {
        execution::buffer_of<Policy, aabb<T>> boxes(on, n);
        reduce_into(on, n, &tree->root.data()->bounds, empty_box<T>(), detail::merge_boxes{},
                    detail::keep_bounds<decltype(shapes)>{shapes, boxes.data()});
        if (options.builder == bvh_builder::ploc) {
            detail::build_ploc<Policy, T>(on, boxes, *tree, options.morton_bits);
            return tree_type(std::move(resident), std::move(tree));
        }
        const bool choose = options.morton_bits == 0;
        if (options.morton_bits != 63) {
            const int bits = choose ? detail::sufficient_morton_bits(n) : 30;
            const std::uint64_t crowded = detail::build_lbvh<std::uint32_t, Policy, T>(on, boxes, *tree, bits);
            if (!choose || crowded <= n / 8) return tree_type(std::move(resident), std::move(tree));
            // The first build has overwritten the scene's box with the root's, which is the same.
        }
        detail::build_lbvh<std::uint64_t, Policy, T>(on, boxes, *tree, 63);
    }
    return tree_type(std::move(resident), std::move(tree));
}

}  // namespace abut
