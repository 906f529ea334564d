// SPDX-License-Identifier: MIT
#pragma once

// make_bvh: a linear BVH in one bottom-up pass over shapes sorted by Morton code (Apetrei, "Fast and Simple Agglomerative
// LBVH Construction", 2014). Each leaf climbs; of the two threads that reach a node, the second knows both boxes and goes on.
// Topology and boxes depend on the shapes alone, not on the policy or the order of the threads.

#include <cstddef>
#include <cstdint>
#include <memory>

#include <abut/execution/atomic.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/binned_sah.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/mean_split.hpp>
#include <abut/index/morton.hpp>
#include <abut/index/operand.hpp>

namespace abut {

namespace detail {

template <shape_view Shapes>
struct shape_bounds {
    Shapes shapes;
    ABUT_HD auto operator()(std::size_t i) const { return bounds(shapes[i]); }
};

struct merge_boxes {
    template <class T>
    ABUT_HD aabb<T> operator()(const aabb<T>& a, const aabb<T>& b) const {
        return merge(a, b);
    }
};

template <class Code, shape_view Shapes>
struct write_codes {
    using scalar = typename Shapes::scalar_type;
    Shapes shapes;
    const bvh_root<scalar>* root;
    int unused_bits;
    Code* codes;
    std::uint32_t* ids;
    ABUT_HD void operator()(std::size_t i) const {
        codes[i] = morton_code<Code>(bounds(shapes[i]), root->bounds) >> unused_bits;
        ids[i] = static_cast<std::uint32_t>(i);
    }
};

/// The climb of leaf i. A node between sorted leaves k and k + 1 is node k. A range of leaves [first, last] joins its
/// neighbour across the closer of its two borders; `reached` holds, for each node, the far end of the child that came first.
template <class Code, shape_view Shapes>
struct climb {
    using T = typename Shapes::scalar_type;
    static constexpr std::uint32_t nobody = static_cast<std::uint32_t>(-1);
    static constexpr std::uint32_t crowd = 8;  ///< more shapes than this with one code are counted: their order means nothing

    Shapes shapes;
    const Code* codes;
    const std::uint32_t* ids;
    std::uint32_t* reached;
    bvh_node<T>* nodes;
    bvh_root<T>* root;

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

    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void operator()(std::size_t i, Count& crowded) const {
        const auto last_leaf = static_cast<std::uint32_t>(shapes.size() - 1);
        auto first = static_cast<std::uint32_t>(i), last = first;
        const std::uint32_t id = ids[i];
        crowded.add(first + crowd <= last_leaf && codes[first] == codes[first + crowd]);
        bvh_child child = bvh_child::leaf(id);
        aabb<T> box = bounds(shapes[id]);
        while (first != 0 || last != last_leaf) {
            const bool left = first == 0 || (last != last_leaf && across(last) < across(first - 1));
            const std::uint32_t node = left ? last : first - 1;
            const int side = left ? 0 : 1;
            nodes[node].bounds[side] = box;
            nodes[node].child[side] = child;
            const std::uint32_t other = execution::atomic_exchange_acq_rel(&reached[node], left ? first : last);
            if (other == nobody) return;
            box = merge(box, load_fresh(nodes[node].bounds[1 - side]));
            child = bvh_child::inner(node);
            (left ? last : first) = other;
        }
        *root = {box, child};
    }

    /// Reads what another thread has just written, past a cache that may hold the line as it was before.
    ABUT_HD static aabb<T> load_fresh(const aabb<T>& box) {
        const volatile aabb<T>& now = box;
        return {{now.lower.x, now.lower.y, now.lower.z}, {now.upper.x, now.upper.y, now.upper.z}};
    }
};

/// Sorts the shapes by the first `bits` bits of their codes and builds the tree. Returns how many shapes have a code that the
/// eighth one after them has too.
template <class Code, execution_policy Policy, shape_view Shapes, class Storage>
std::uint64_t build_lbvh(const Policy& on, const Shapes& shapes, Storage& tree, int bits) {
    const std::size_t n = shapes.size();
    execution::buffer_of<Policy, Code> codes(on, n);
    execution::buffer_of<Policy, std::uint32_t> ids(on, n), reached(on, n - 1);
    auto* const root = tree.root.data();
    for_each_index(on, n, write_codes<Code, Shapes>{shapes, root, morton_bits<Code> - bits, codes.data(), ids.data()});
    sort_by_key(on, codes, ids, bits);
    fill(on, reached.data(), n - 1, climb<Code, Shapes>::nobody);
    execution::work_count<space_of<Policy>> crowded(on);
    const climb<Code, Shapes> each{shapes, codes.data(), ids.data(), reached.data(), tree.nodes.data(), root};
    for_each_index(on, n, each, crowded);
    return crowded.total();
}

/// Bits that tell n shapes apart, with 6 to spare for their uneven spread, in whole bits of each axis: sorting fewer bits is
/// faster.
constexpr int sufficient_morton_bits(std::size_t n) {
    int bits = 6;
    while (n >> (bits - 6) > 1 && bits < 30) ++bits;
    return bits < 30 ? (bits + 2) / 3 * 3 : 30;
}

/// Builds by one of the top-down builders, where the policy has them. False if another is asked for.
template <execution_policy Policy, shape_view Shapes, class Storage>
bool build_from_top(const Policy& on, const Shapes& shapes, Storage& tree, bvh_builder builder) {
    using T = typename Shapes::scalar_type;
    if (builder == bvh_builder::linear) return false;
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
    if (options.builder > bvh_builder::sah) throw error("abut::make_bvh: the builder is none of bvh_builder");
    if (!host_policy<Policy> && options.builder != bvh_builder::linear) {
        throw error(
            "abut::make_bvh: on a device the builder is bvh_builder::linear; serial and openmp have mean_split and sah");
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
        reduce_into(on, n, &tree->root.data()->bounds, empty_box<T>(), detail::merge_boxes{},
                    detail::shape_bounds<decltype(shapes)>{shapes});
        const bool choose = options.morton_bits == 0;
        if (options.morton_bits != 63) {
            const int bits = choose ? detail::sufficient_morton_bits(n) : 30;
            const std::uint64_t crowded = detail::build_lbvh<std::uint32_t>(on, shapes, *tree, bits);
            if (!choose || crowded <= n / 8) return tree_type(std::move(resident), std::move(tree));
            // The first build has overwritten the scene's box with the root's, which is the same.
        }
        detail::build_lbvh<std::uint64_t>(on, shapes, *tree, 63);
    }
    return tree_type(std::move(resident), std::move(tree));
}

}  // namespace abut
