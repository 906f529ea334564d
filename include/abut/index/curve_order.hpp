// SPDX-License-Identifier: MIT
#pragma once

// Shapes along a Hilbert curve, for walks: neighbours need the same nodes. Unlike a Morton curve it never jumps, so that the
// box around some neighbours is small.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <abut/execution/policy.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/leaf_order.hpp>
#include <abut/index/morton.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

template <shape_view Shapes>
struct box_of_shape {
    Shapes shapes;
    ABUT_HD auto operator()(std::size_t i) const { return bounds(shapes[i]); }
};

/// How far along the curve a cell comes, of 2^10 cells an axis. Each step from the highest bit down turns and mirrors what
/// is below as the curve asks; then the bits become a Gray code (Skilling, 2004).
ABUT_HD constexpr std::uint32_t hilbert_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint32_t axis[3] = {x, y, z};
    constexpr std::uint32_t top = std::uint32_t{1} << (morton_axis_bits<std::uint32_t> - 1);
    for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
        const std::uint32_t below = bit - 1;
        for (std::uint32_t& other : axis) {
            const std::uint32_t changed = (other & bit) != 0 ? 0 : (axis[0] ^ other) & below;
            axis[0] ^= (other & bit) != 0 ? below : changed;
            other ^= changed;
        }
    }
    axis[1] ^= axis[0];
    axis[2] ^= axis[1];
    std::uint32_t flipped = 0;
    for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
        if ((axis[2] & bit) != 0) flipped ^= bit - 1;
    }
    return spread_bits(axis[0] ^ flipped) << 2 | spread_bits(axis[1] ^ flipped) << 1 | spread_bits(axis[2] ^ flipped);
}

template <shape_view Shapes>
struct write_curve_codes {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    const aabb<T>* around;
    int unused_bits;
    std::uint32_t *codes, *ids;
    ABUT_HD void operator()(std::size_t i) const {
        const aabb<T> box = bounds(shapes[i]);
        const auto cell = [&](T vec3<T>::*x) {
            return morton_cell<std::uint32_t>(sum_of_halves(box.lower.*x, box.upper.*x), around->lower.*x, around->upper.*x);
        };
        codes[i] = hilbert_code(cell(&vec3<T>::x), cell(&vec3<T>::y), cell(&vec3<T>::z)) >> unused_bits;
        ids[i] = static_cast<std::uint32_t>(i);
    }
};

/// The ids of fewer than 2^32 shapes, along the curve, in the policy's memory.
template <class Policy, shape_view Shapes>
execution::buffer_of<Policy, std::uint32_t> order_on_curve(const Policy& on, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    const std::size_t n = shapes.size();
    const int bits = std::min(24, sufficient_morton_bits(n));
    execution::buffer_of<Policy, aabb<T>> around(on, 1);
    execution::buffer_of<Policy, std::uint32_t> codes(on, n), ids(on, n);
    reduce_into(on, n, around.data(), empty_box<T>(), merge_boxes{}, box_of_shape<Shapes>{shapes});
    for_each_index(
        on, n,
        write_curve_codes<Shapes>{shapes, around.data(), morton_bits<std::uint32_t> - bits, codes.data(), ids.data()});
    sort_by_key(on, codes, ids, bits);
    return ids;
}

}  // namespace abut::detail
