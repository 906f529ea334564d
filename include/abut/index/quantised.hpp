// SPDX-License-Identifier: MIT
#pragma once

// quantised: a tree whose boxes are kept in 16 bits a coordinate, half the standard layout's memory in single precision and
// a quarter and more in double. No box becomes smaller.
//
// A coordinate is an integer times a step, a power of two, so large that 2^16 integers span the root's box, and not
// denormal. The integers are exact in T: below 2^digits all are, and a coordinate of more steps than that is a whole number
// of them, since T has no digits left for a fraction. So a box is made of an exact sum and an exact product, which is not
// denormal (or one that overflows, outward or to the largest number): it is the same on every device, under every
// contraction and where denormals are flushed to zero. Rounding outward once, when the tree is converted, is all the care
// that there is. There a denormal coordinate may be read as zero, in the tree as in queries (shape/bounds.hpp).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>

namespace abut {

/// Cells that coordinates are rounded to: cell k of an axis lies at (first + k) * step.
template <scalar T>
struct quantised_frame {
    static constexpr int last_cell = 65535;  ///< along each axis
    vec3<T> first;                           ///< of each axis, in steps: an integer
    vec3<T> step;                            ///< of each axis: a power of two

    /// Where a cell lies along an axis, or three along three axes.
    ///@{
    [[nodiscard]] ABUT_HD static T at(T first, T step, std::uint16_t cell) { return (first + static_cast<T>(cell)) * step; }
    [[nodiscard]] ABUT_HD vec3<T> at(const vec3<std::uint16_t>& cell) const {
        return {at(first.x, step.x, cell.x), at(first.y, step.y, cell.y), at(first.z, step.z, cell.z)};
    }
    ///@}
};

/// An inner node: its two children with their boxes, half a cache line.
struct alignas(32) quantised_node {
    /// A box in cells.
    struct box {
        vec3<std::uint16_t> lower;  ///< the cell of the least coordinate along each axis
        vec3<std::uint16_t> upper;  ///< that of the greatest
    };
    box bounds[2];       ///< around the children
    bvh_child child[2];  ///< the children
};

/// A view of a quantised tree.
template <scalar T, memory_space Space>
struct quantised_view : bvh_view_base<T, Space, quantised_node> {
    /// A node as walks read it.
    using node_type = quantised_node;

    quantised_frame<T> frame{};  ///< where cells lie

    /// Node, box and child by number, as bvh_layout says. On hosts and devices.
    ///@{
    [[nodiscard]] ABUT_HD const node_type& fetch(std::uint32_t node) const { return this->nodes[node]; }
    [[nodiscard]] ABUT_HD aabb<T> bounds(const node_type& n, int slot) const {
        return {frame.at(n.bounds[slot].lower), frame.at(n.bounds[slot].upper)};
    }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int slot) { return n.child[slot]; }
    ///@}
};

/// 32 bytes a node.
struct quantised_layout {
    /// What kernels see.
    template <scalar T, memory_space Space>
    using view = quantised_view<T, Space>;

    /// What owns a tree of this layout.
    template <scalar T, memory_space Space>
    struct storage {
        execution::buffer<quantised_node, Space> nodes;  ///< one fewer than shapes
        execution::buffer<bvh_root<T>, Space> root;      ///< one; none where there are no shapes
        quantised_frame<T> frame{};                      ///< where cells lie
        shared_least_ids<Space> least_ids = {};          ///< those of the tree that it was made of

        /// The view of a tree of so many shapes.
        [[nodiscard]] view<T, Space> view_of(std::size_t shapes) const {
            return {{nodes.data(), root.data(), shapes}, frame};
        }
        /// Its memory.
        [[nodiscard]] std::size_t bytes() const { return nodes.capacity_bytes() + root.capacity_bytes(); }
        /// A copy in host memory. Waits for it.
        [[nodiscard]] storage<T, host_space> to_host() const { return {nodes.to_host(), root.to_host(), frame}; }
    };
};

namespace detail {

/// One axis: integers times 2^exponent. Factors come in halves, since the whole of one need not be finite.
template <scalar T>
struct quantiser {
    T down[2], up[2];
    T beyond;  ///< the integer that stands for the power of two above all finite numbers, and so for infinity
    T first = 0;

    explicit quantiser(int exponent)
        : down{power(exponent / 2), power(exponent - exponent / 2)},
          up{power(-(exponent / 2)), power(-(exponent - exponent / 2))},
          beyond(exponent > 0 ? power(std::numeric_limits<T>::max_exponent - exponent) : infinity<T>) {}

    /// The greatest integer that stands for x or less; infinite where T has none so large.
    [[nodiscard]] ABUT_HD T below(T x) const {
        if (x < -largest_finite<T>) return -beyond;
        if (x > largest_finite<T>) return beyond;
        // What lies between cells is cut towards 0, and scaling may underflow to 0: too high, both times, below 0 alone.
        const T cell = without_fraction(x * up[0] * up[1]);
        return cell * down[0] * down[1] > x ? cell - 1 : cell;
    }
    [[nodiscard]] ABUT_HD T above(T x) const { return -below(-x); }
    [[nodiscard]] T step() const { return down[0] * down[1]; }
    [[nodiscard]] ABUT_HD std::uint16_t lower(T x) const { return static_cast<std::uint16_t>(below(x) - first); }
    [[nodiscard]] ABUT_HD std::uint16_t upper(T x) const { return static_cast<std::uint16_t>(above(x) - first); }

private:
    static T power(int exponent) { return std::ldexp(T(1), exponent); }
    ABUT_HD static T without_fraction(T x) {
        const bool small = x > T(-0x1p60) && x < T(0x1p60);  // larger numbers have none
        return small ? static_cast<T>(static_cast<std::int64_t>(x)) : x;
    }
};

/// The finest axis on which 2^16 integers span [lower, upper].
template <scalar T>
quantiser<T> make_quantiser(T lower, T upper) {
    // Whether an axis fits is monotone in its exponent; the most always fits. The least is that of the smallest normal
    // number, or of one in whose unit no coordinate overflows.
    constexpr int max_exponent = std::numeric_limits<T>::max_exponent;
    const T most = greatest(absolute(lower), absolute(upper));
    const int power_above = most <= largest_finite<T> ? std::ilogb(greatest(most, smallest_normal<T>)) + 1 : max_exponent;
    int enough = max_exponent - 1,
        too_small = std::max(std::numeric_limits<T>::min_exponent - 1, power_above - max_exponent) - 1;
    while (enough - too_small > 1) {
        const int e = too_small + (enough - too_small) / 2;
        const quantiser<T> axis(e);
        const bool fits = axis.above(upper) - axis.below(lower) <= T(quantised_frame<T>::last_cell);  // no for NaN
        (fits ? enough : too_small) = e;
    }
    quantiser<T> axis(enough);
    axis.first = axis.below(lower);
    return axis;
}

template <scalar T>
struct quantise_node {
    const bvh_node<T>* from;
    quantised_node* to;
    quantiser<T> x, y, z;

    ABUT_HD void operator()(std::size_t i) const {
        for (int slot = 0; slot < 2; ++slot) {
            to[i].bounds[slot] = quantised(from[i].bounds[slot]);
            to[i].child[slot] = from[i].child[slot];
        }
    }
    [[nodiscard]] ABUT_HD quantised_node::box quantised(const aabb<T>& box) const {
        return {{x.lower(box.lower.x), y.lower(box.lower.y), z.lower(box.lower.z)},
                {x.upper(box.upper.x), y.upper(box.upper.y), z.upper(box.upper.z)}};
    }
};

}  // namespace detail

/// @addtogroup indices
///@{

/// The same tree in 16 bits a coordinate: 32 bytes a shape. It shares the set and the least ids, if there are some; the one
/// it was made of may go. Boxes grow by less than a step on each side, and a step is at most the extent of the root's box
/// along the axis over 2^15 - 2, or the smallest normal number of T. So a tree of very many small shapes, or of one far
/// from all others, loses. Linear time. Throws error (a tree on another device), std::bad_alloc, cuda_error.
template <execution_policy Policy, class Set, memory_space Space>
[[nodiscard]] bvh<Set, Space, quantised_layout> quantised(const Policy& on, const bvh<Set, Space>& tree) {
    static_assert(std::same_as<Space, space_of<Policy>>,
                  "abut: the index lies in other memory than the policy works in; make it with the same policy");
    using tree_type = bvh<Set, Space, quantised_layout>;
    using T = typename tree_type::scalar_type;
    const std::size_t n = tree.size();
    auto fresh = std::make_shared<typename tree_type::storage>();
    fresh->least_ids = tree.stored().least_ids;
    detail::require_same_device(on, tree, "abut::quantised");
    if (n > 0) {
        bvh_root<T> root;
        download(on, tree.view().top, 1, &root);
        const aabb<T>& box = root.bounds;
        const auto x = detail::make_quantiser(box.lower.x, box.upper.x),
                   y = detail::make_quantiser(box.lower.y, box.upper.y),
                   z = detail::make_quantiser(box.lower.z, box.upper.z);
        fresh->nodes = execution::buffer_of<Policy, quantised_node>(on, n - 1);
        fresh->root = execution::buffer_of<Policy, bvh_root<T>>(on, 1);
        const detail::quantise_node<T> each{tree.view().nodes, fresh->nodes.data(), x, y, z};
        for_each_index(on, n - 1, each);
        fresh->frame = {{x.first, y.first, z.first}, {x.step(), y.step(), z.step()}};
        const quantised_node::box around = each.quantised(box);
        root.bounds = {fresh->frame.at(around.lower), fresh->frame.at(around.upper)};
        upload(on, &root, 1, fresh->root.data());
        synchronize(on);
    }
    return tree_type(tree.set(), std::move(fresh));
}

///@}

}  // namespace abut
