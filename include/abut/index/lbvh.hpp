// SPDX-License-Identifier: MIT
#pragma once

// make_bvh: a linear BVH in one bottom-up pass over shapes sorted by Morton code (index/climb.hpp). Topology and boxes
// depend on the shapes alone, not on the policy or the order of the threads.

#include <cstddef>
#include <cstdint>
#include <memory>

#include <abut/execution/work_queue.hpp>
#include <abut/index/binned_sah.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/climb.hpp>
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

/// Leaves sorted by code, to climb through (index/climb.hpp). Node k lies between leaves k and k + 1. A range of leaves
/// [first, last] joins its neighbour across the closer of its two borders; its token is the end that is far from there.
template <class Code, scalar T>
struct sorted_leaves {
    const aabb<T>* boxes;
    std::size_t shapes;
    const Code* codes;
    const std::uint32_t* ids;

    struct subtree {
        aabb<T> box;
        bvh_child child;
        std::uint32_t first, last;
    };

    ABUT_CALLS_ANY
    template <class Hang>
    ABUT_HD void start(std::size_t i, const Hang& hang) const {
#if !ABUT_DEVICE_CODE
        // A processor would wait for each box in turn; so what comes later is asked for now.
        constexpr std::size_t ahead = 16;
        if (i + ahead < shapes) __builtin_prefetch(boxes + ids[i + ahead]);
#endif
        const auto leaf = static_cast<std::uint32_t>(i);
        hang(subtree{boxes[ids[i]], bvh_child::leaf(ids[i]), leaf, leaf});
    }
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void notice(std::size_t i, Count& crowded) const {
        crowded.add(is_crowded<Code>{codes, shapes}(i));
    }
    [[nodiscard]] ABUT_HD bool is_all(const subtree& at) const { return at.first == 0 && at.last == last_leaf(); }
    template <class Reader>
    [[nodiscard]] ABUT_HD std::uint32_t above(const subtree& at, const Reader& across) const {
        const bool left = at.first == 0 || (at.last != last_leaf() && across(at.last) < across(at.first - 1));
        return left ? 2 * at.last : 2 * (at.first - 1) + 1;
    }
    template <class Reader>
    [[nodiscard]] ABUT_HD std::uint32_t token(const subtree& at, std::uint32_t place, const Reader&) const {
        return place % 2 == 0 ? at.first : at.last;
    }
    [[nodiscard]] ABUT_HD subtree joined(std::uint32_t left, std::uint32_t right) const { return {{}, {}, left, right}; }

    /// How far apart leaves k and k + 1 are: the highest bit in which their codes, and between equal codes their positions,
    /// differ. Comparing the numbers compares those bits, since no two borders of one range share their highest bit.
    struct distance {
        Code code;
        std::uint32_t position;
        ABUT_HD bool operator<(const distance& other) const {
            return code < other.code || (code == other.code && position < other.position);
        }
    };
    struct far_reader {
        const Code* codes;
        ABUT_HD distance operator()(std::uint32_t k) const {
            return {static_cast<Code>(codes[k] ^ codes[k + 1]), k ^ (k + 1)};
        }
    };
    [[nodiscard]] ABUT_HD far_reader far() const { return {codes}; }

    /// Between the leaves of a group, and before the first one of them.
    struct local {
        Code across[execution::group_size + 1];
    };
    struct near_reader {
        const Code* across;
        std::uint32_t before;  ///< what across[0] is of
        ABUT_HD distance operator()(std::uint32_t k) const { return {across[k - before], k ^ (k + 1)}; }
    };
    ABUT_HD void load(std::size_t first, unsigned k, local& to) const {
        if (first + k + 1 < shapes) to.across[k + 1] = codes[first + k] ^ codes[first + k + 1];
        if (k == 0 && first > 0) to.across[0] = codes[first - 1] ^ codes[first];
    }
    [[nodiscard]] ABUT_HD near_reader near(std::size_t first, const local& from) const {
        return {from.across, static_cast<std::uint32_t>(first) - 1};
    }

private:
    [[nodiscard]] ABUT_HD std::uint32_t last_leaf() const { return static_cast<std::uint32_t>(shapes) - 1; }
};

/// Sorts the shapes by the first `bits` bits of their codes and builds the tree. Returns how many shapes have a code that
/// the eighth one after them has too.
template <class Code, execution_policy Policy, scalar T, class Storage>
std::uint64_t build_lbvh(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, Storage& tree, int bits) {
    const std::size_t n = boxes.size();
    const auto order = order_leaves<Code, Policy, T>(on, boxes, tree.root.data(), bits);
    execution::work_count<space_of<Policy>> crowded(on);
    const sorted_leaves<Code, T> leaves{boxes.data(), n, order.codes.data(), order.ids.data()};
    climb_all(on, leaves, n, n, tree.nodes.data(), tree.root.data(), crowded);
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
