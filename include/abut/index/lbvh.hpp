// SPDX-License-Identifier: MIT
#pragma once

// make_bvh: a linear BVH in one bottom-up pass over shapes sorted by Morton code (index/climb.hpp). Topology and boxes
// depend on the shapes alone, not on the policy or the order of the threads.

#include <cstddef>
#include <cstdint>
#include <memory>

#include <abut/index/binned_sah.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/climb.hpp>
#include <abut/index/least_ids.hpp>
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

/// make_bvh, by the linear builder alone unless `AnyBuilder`: who asks for no other compiles no other.
template <bool AnyBuilder, execution_policy Policy, class Set>
auto build_bvh(const Policy& on, const Set& set, const bvh_options& options) {
    auto resident = make_resident(on, set, "abut::make_bvh");
    using tree_type = bvh<decltype(resident), space_of<Policy>>;
    using T = typename tree_type::scalar_type;
    const auto shapes = view_of(resident);
    const std::size_t n = shapes.size();
    auto tree = std::make_shared<typename tree_type::storage>();
    tree->root = execution::buffer_of<Policy, bvh_root<T>>(on, n > 0 ? 1 : 0);
    tree->nodes = execution::buffer_of<Policy, bvh_node<T>>(on, n > 0 ? n - 1 : 0);
    const auto done = [&] {
        if constexpr (AnyBuilder && host_policy<Policy>) {
            if (options.least_ids) {
                tree->least_ids = std::make_shared<const execution::buffer_of<Policy, std::uint32_t>>(
                    make_least_ids(on, tree->nodes.data(), tree->nodes.size(), tree->root.data()));
            }
        }
        return tree_type(std::move(resident), std::move(tree));
    };
    bool built = n == 0;
    if constexpr (AnyBuilder) built = built || build_from_top(on, shapes, *tree, options.builder);
    if (!built) {
        execution::buffer_of<Policy, aabb<T>> boxes(on, n);
        reduce_into(on, n, &tree->root.data()->bounds, empty_box<T>(), merge_boxes{},
                    keep_bounds<decltype(shapes)>{shapes, boxes.data()});
        if constexpr (AnyBuilder) {
            if (options.builder == bvh_builder::ploc) {
                build_ploc<Policy, T>(on, boxes, *tree, options.morton_bits);
                return done();
            }
        }
        tree->along_curve = true;
        const bool choose = options.morton_bits == 0;
        if (options.morton_bits != 63) {
            const int bits = choose ? sufficient_morton_bits(n) : 30;
            const std::uint64_t crowded = build_lbvh<std::uint32_t, Policy, T>(on, boxes, *tree, bits);
            if (!choose || crowded <= n / 8) return done();
            // The first build has overwritten the scene's box with the root's, which is the same.
        }
        build_lbvh<std::uint64_t, Policy, T>(on, boxes, *tree, 63);
    }
    return done();
}

}  // namespace detail

/// @addtogroup indices
///@{

/// Builds a tree over the shapes of `set` in the policy's memory, by the linear builder. The same shapes give the same tree
/// on every policy, and for any number of threads.
template <execution_policy Policy, class Set>
[[nodiscard]] auto make_bvh(const Policy& on, const Set& set) {
    if constexpr (detail::can_reside<Policy, Set>()) {
        return detail::build_bvh<false>(on, set, {});
    } else {
        return detail::refused();
    }
}

/// The same with options, of which `{}` are the defaults. All builders are compiled, which takes a compiler a second. The
/// same shapes give the same tree on every policy that has the builder. Throws error for bits that are not an option, and
/// for a builder that the policy does not have; else as the group says.
template <execution_policy Policy, class Set>
[[nodiscard]] auto make_bvh(const Policy& on, const Set& set, const bvh_options& options) {
    if (options.morton_bits != 0 && options.morton_bits != 30 && options.morton_bits != 63) {
        throw error("abut::make_bvh: morton_bits is " + std::to_string(options.morton_bits) + "; expected 0, 30 or 63");
    }
    if (options.builder > bvh_builder::ploc) throw error("abut::make_bvh: the builder is none of bvh_builder");
    if (!host_policy<Policy> && options.builder != bvh_builder::linear && options.builder != bvh_builder::ploc) {
        throw error(
            "abut::make_bvh: on a device the builder is bvh_builder::linear or ploc; serial and openmp have mean_split and "
            "sah");
    }
    if constexpr (detail::can_reside<Policy, Set>()) {
        return detail::build_bvh<true>(on, set, options);
    } else {
        return detail::refused();
    }
}

///@}

}  // namespace abut
