// SPDX-License-Identifier: MIT
#pragma once

// leaf_ids: a tree's shapes in the order of its leaves, for who wants them to lie in that order. Shapes that are near each
// other in the tree are then near each other in memory.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/index/bvh.hpp>

namespace abut {

/// Ids of the shapes of a tree in host memory, in the order of its leaves, depth first: each id once, none of an empty tree.
/// The shapes below any node come one after another. In a set whose shapes are brought to this order, the next shape that a
/// walk needs often lies beside the last one. Neighbouring rays take less time so. Of the new set's shape i `ids[i]` is the
/// old id.
///
/// Any layout. Linear time, on the calling thread; 4 bytes a shape. Returns when it is done. Throws std::bad_alloc.
///
///     const std::vector<std::uint32_t> ids = abut::leaf_ids(abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah}));
///
/// @ingroup indices
template <class Set, bvh_layout_kind Layout>
[[nodiscard]] std::vector<std::uint32_t> leaf_ids(const bvh<Set, host_space, Layout>& tree) {
    std::vector<std::uint32_t> ids;
    ids.reserve(tree.size());
    if (tree.size() == 0) return ids;
    const auto view = tree.view();
    std::vector<bvh_child> pending{view.root()};
    while (!pending.empty()) {
        const bvh_child at = pending.back();
        pending.pop_back();
        if (at.is_leaf()) {
            ids.push_back(at.index());
            continue;
        }
        const auto node = view.fetch(at.index());
        for (int slot = view.children(node); slot-- > 0;) pending.push_back(view.child(node, slot));
    }
    return ids;
}

}  // namespace abut
