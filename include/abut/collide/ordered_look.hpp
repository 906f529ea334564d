// SPDX-License-Identifier: MIT
#pragma once

// How points and lines look into an operand for what is least: the walk through it, the frame in which it is seen, and the unit
// that its lengths are measured in. What they look for is said elsewhere (nearest.hpp, raycast.hpp, distance.hpp).

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/collide/operand.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/ties.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/traverse/ordered_walk.hpp>

namespace abut::detail {

template <class Walk, shape_view Shapes>
struct watch_of_walk : ties_of_one<decltype(Walk::tree), Shapes> {
    watch_of_walk(std::size_t shapes_a_tie, bool chains, Walk& walk, kept_ties& kept, const Shapes& shapes)
        : ties_of_one<decltype(Walk::tree), Shapes>(shapes_a_tie, chains, kept, walk.tree, shapes) {
        walk.watch = this;
    }
};
/// Has a walk through a tree of a host watch for ties, as long as what is returned and the operand live. Copies have to be
/// `Alike` to it.
template <class Policy, bool Alike, class Walk, class Operand>
auto watch_ties([[maybe_unused]] std::size_t shapes_a_tie, [[maybe_unused]] bool chains, [[maybe_unused]] Walk& walk,
                [[maybe_unused]] const Operand& x) {
    if constexpr (host_policy<Policy> && Alike && requires { walk.watch = nullptr; }) {
        const auto& tree = x.tree_with_least_ids();
        using shapes = decltype(view_of(tree.set()));
        return watch_of_walk<Walk, shapes>(shapes_a_tie, chains, walk, tree.ties(), view_of(tree.set()));
    } else {
        return 0;
    }
}

template <class Operand>
auto ordered_walk_of(const Operand& x) {
    if constexpr (Operand::is_posed) {
        return ordered_walk_of(x.operand);
    } else if constexpr (Operand::has_tree) {
        return ordered_tree_walk<decltype(x.tree())>{x.tree()};
    } else if constexpr (Operand::is_indexed) {
        return ordered_grid_walk<decltype(x.index.view())>{x.index.view()};
    } else {
        return ordered_list_walk{x.shapes().size()};
    }
}

/// From where points look at it. `unit` is what lengths in the world are measured in.
template <class Operand, scalar T>
auto frame_of(const Operand& x, const length_unit<T>& unit) {
    if constexpr (Operand::is_posed && Operand::is_indexed) {
        return object_frame<T>(unit.length(1), x.pose, x.around);
    } else {
        return world_frame<T>{unit.length(1)};
    }
}

/// The largest coordinate in a box.
template <scalar T>
double largest_coordinate(const aabb<T>& box) {
    const vec3<T> most = greatest(absolute(box.lower), absolute(box.upper));
    return static_cast<double>(greatest(most.x, most.y, most.z));
}
/// That of some shapes; 0 of none.
template <class Policy, shape_view Shapes>
double largest_coordinate(const Policy& on, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    if (shapes.size() == 0) return 0;
    return largest_coordinate(reduce(on, shapes.size(), empty_box<T>(), merge_boxes{}, box_of_shape<Shapes>{shapes}));
}
/// No less than that of an operand's shapes.
template <class Policy, operand X>
double largest_coordinate(const Policy& on, const X& x) {
    if (x.shapes().size() == 0) return 0;
    if constexpr (X::is_posed && X::is_indexed) {
        return 2 * farthest(x.around) + magnitudes(x.pose.translation);
    } else if constexpr (X::is_indexed) {
        return largest_coordinate(x.bounds(on));
    } else {
        return largest_coordinate(on, x.shapes());
    }
}
/// Of an operand and of points.
template <class Policy, operand X, shape_view Points>
double largest_coordinate(const Policy& on, const X& x, const Points& points) {
    return greatest(largest_coordinate(on, points), largest_coordinate(on, x));
}

/// A unit for coordinates of that magnitude and below.
template <scalar T>
length_unit<T> unit_of_magnitude([[maybe_unused]] double largest) {
    if constexpr (std::same_as<T, float>) {
        return {};
    } else {
        return length_unit<double>(least(largest, largest_finite<double>));
    }
}

}  // namespace abut::detail
