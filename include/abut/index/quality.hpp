// SPDX-License-Identifier: MIT
#pragma once

// quality: numbers by which trees over the same shapes can be compared without running a query. needs_rebuild: whether a
// tree that was refitted has become so bad that it should be built again.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/execution/host.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/box_measure.hpp>

namespace abut {

/// What `quality` measures of a tree. Surfaces are those of the boxes that a walk sees, so a layout whose boxes are larger
/// than they were built shows it here; of other volumes, which this is not for, those of the boxes around them. Where the
/// root's box has no surface, every box counts as large as the root's.
/// @ingroup indices
struct bvh_quality {
    /// Number of shapes.
    std::size_t shapes = 0;
    /// Nodes and leaves whose boxes a random line meets, if it meets the root's: the sum of all boxes' surfaces over that of
    /// the root's (the surface area heuristic with unit costs; Goldsmith and Salmon, 1987). 2 n - 1 at most.
    double sah_cost = 0;
    /// Sum of all boxes' surfaces, in squared units of the coordinates; infinity where it overflows.
    double surface = 0;
    /// Depth of leaves; a tree of one shape has depth 0. At most bvh_max_depth.
    int greatest_depth = 0;
    /// The same, averaged over all leaves.
    double mean_depth = 0;
    /// Surface of what pairs of siblings' boxes have in common, over that of all nodes with children: 0 for siblings that
    /// are apart, 1 for two siblings in one place. A node of four children has six pairs.
    double overlap = 0;
    /// Memory of the tree itself, over the number of shapes.
    double bytes_per_shape = 0;
};

namespace detail {

template <scalar T>
aabb<T> common_part(const aabb<T>& a, const aabb<T>& b) {
    return {greatest(a.lower, b.lower), least(a.upper, b.upper)};
}

/// Of a tree in host memory that has at least one shape. `bytes_per_shape` is left for the caller.
template <bvh_layout Layout>
bvh_quality measure(const Layout& tree) {
    using T = typename Layout::scalar_type;
    struct entry {
        bvh_child child;
        int depth;
    };
    const aabb<T> around = tree.root_bounds();
    const double unit = surface_unit(longest(half_sides<double>(around)));
    const auto surface_of = [unit](const aabb<T>& box) { return half_surface(unit * half_sides<double>(box)); };
    const double whole = surface_of(around);
    const auto part = [&](const aabb<T>& box) {
        const double surface = surface_of(box);
        return whole > 0 && surface <= whole ? surface / whole : 1;  // a box at infinity has a surface that is no number
    };
    bvh_quality q{.shapes = tree.size(), .sah_cost = 1};
    double depths = 0, common = 0, of_nodes = 0;
    std::vector<entry> pending{{tree.root(), 0}};
    std::vector<double> surface{1};
    while (!pending.empty()) {
        const entry e = pending.back();
        const double own = surface.back();
        pending.pop_back();
        surface.pop_back();
        if (e.child.is_leaf()) {
            depths += e.depth;
            q.greatest_depth = greatest(q.greatest_depth, e.depth);
            continue;
        }
        const auto node = tree.fetch(e.child.index());
        of_nodes += own;
        for (int slot = 0; slot < tree.children(node); ++slot) {
            const aabb<T> box = tree.bounds(node, slot);
            for (int other = 0; other < slot; ++other) {
                const aabb<T> sibling = tree.bounds(node, other);
                if (overlaps(sibling, box)) common += part(common_part(sibling, box));
            }
            const double next = part(box);
            q.sah_cost += next;
            pending.push_back({tree.child(node, slot), e.depth + 1});
            surface.push_back(next);
        }
    }
    q.surface = 8 * q.sah_cost * whole / unit / unit;  // of halves of sides
    q.mean_depth = depths / static_cast<double>(tree.size());
    q.overlap = of_nodes > 0 ? common / of_nodes : 0;
    return q;
}

}  // namespace detail

/// @addtogroup indices
///@{

/// Measures a tree, of any layout and in any memory: a tree in device memory is copied to the host first. Linear time on the
/// calling thread; all numbers are 0 for a tree without shapes. Throws std::bad_alloc, cuda_error.
template <class Set, memory_space Space, bvh_layout_kind Layout>
[[nodiscard]] bvh_quality quality(const bvh<Set, Space, Layout>& tree) {
    if (tree.size() == 0) return {};
    bvh_quality q;
    if constexpr (std::same_as<Space, host_space>) {
        q = detail::measure(tree.view());
    } else {
        const auto copy = tree.stored().to_host();
        q = detail::measure(copy.view_of(tree.size()));
    }
    q.bytes_per_shape = static_cast<double>(tree.bytes()) / static_cast<double>(tree.size());
    return q;
}

/// The same, after all that was put into the policy's stream.
template <execution_policy Policy, class Set, memory_space Space, bvh_layout_kind Layout>
[[nodiscard]] bvh_quality quality(const Policy& on, const bvh<Set, Space, Layout>& tree) {
    synchronize(on);
    return quality(tree);
}

///@}

/// Whether a tree that was refitted should be built again: `when_built` is the quality of the tree that make_bvh made, `now`
/// that of the refitted one. True where boxes have grown to more than `growth` times their surface, in all or beside the
/// root's. Shapes that keep their neighbours (a cloth, a body that bends) seldom come to that. Shapes that change places
/// (particles that mix, a set in another order) do at once: each box is then nearly as large as the scene, queries compare
/// nearly all shapes with all. 10,000 spheres in a plane, shuffled, took 120 times as long as with a new tree, and that
/// grows with their number. A scene that grows as a whole is said to need it too, which costs one build.
///
///     auto tree = abut::make_bvh(on, cloth_t0);
///     const auto when_built = abut::quality(tree);
///     tree = abut::refit(on, tree, cloth_t1);
///     if (abut::needs_rebuild(when_built, abut::quality(tree))) tree = abut::make_bvh(on, cloth_t1);
[[nodiscard]] inline bool needs_rebuild(const bvh_quality& when_built, const bvh_quality& now, double growth = 1.5) {
    return now.sah_cost > growth * when_built.sah_cost || now.surface > growth * when_built.surface;
}

}  // namespace abut
