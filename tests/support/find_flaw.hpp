// SPDX-License-Identifier: MIT
#pragma once

// Whether a tree is well formed.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/index/bvh.hpp>

namespace abut::test {

/// Checks a tree in host memory: every shape in exactly one leaf, every box around what lies below it and the shape's own
/// box in its leaf, no leaf deeper than bvh_max_depth. Returns what is wrong, or an empty string. Linear time.
template <bvh_layout Layout, shape_view Shapes>
[[nodiscard]] std::string find_flaw(const Layout& tree, const Shapes& shapes) {
    using T = typename Layout::scalar_type;
    struct entry {
        bvh_child child;
        aabb<T> box;
        int depth;
    };
    const std::size_t n = shapes.size();
    if (tree.size() != n) return "the tree has " + std::to_string(tree.size()) + " shapes, the set " + std::to_string(n);
    if (n == 0) return {};
    std::vector<int> seen(n, 0), used(n, 0);
    std::vector<entry> pending{{tree.root(), tree.root_bounds(), 0}};
    while (!pending.empty()) {
        const entry e = pending.back();
        pending.pop_back();
        const std::uint32_t i = e.child.index();
        const std::string name = (e.child.is_leaf() ? "leaf of shape " : "node ") + std::to_string(i);
        if (e.depth > bvh_max_depth) return name + " is deeper than bvh_max_depth";
        if (i >= (e.child.is_leaf() ? n : n - 1)) return name + " does not exist";
        if ((e.child.is_leaf() ? seen : used)[i]++ > 0) return name + " is reached twice";
        if (e.child.is_leaf()) {
            if (!contains(e.box, bounds(shapes[i]))) return name + ": the box does not hold the shape";
            continue;
        }
        const typename Layout::node_type node = tree.fetch(i);
        const int children = tree.children(node);
        if (children < 2 || children > Layout::width) return name + " has " + std::to_string(children) + " children";
        for (int slot = 0; slot < children; ++slot) {
            const aabb<T> box = tree.bounds(node, slot), &around = e.box;
            if (Layout::nested && !contains(around, box)) return name + ": the box does not hold the child's";
            // Where boxes are not nested, a shape has to lie in what all above it have in common.
            const aabb<T> common{detail::greatest(around.lower, box.lower), detail::least(around.upper, box.upper)};
            pending.push_back({tree.child(node, slot), common, e.depth + 1});
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (seen[i] == 0) return "shape " + std::to_string(i) + " is in no leaf";
    }
    return {};
}

}  // namespace abut::test
