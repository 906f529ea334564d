// SPDX-License-Identifier: MIT
#pragma once

// Shapes along a Morton curve, for walks: neighbours need the same nodes.

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

template <shape_view Shapes>
struct write_curve_codes {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    const aabb<T>* around;
    int unused_bits;
    std::uint32_t *codes, *ids;
    ABUT_HD void operator()(std::size_t i) const {
        codes[i] = morton_code<std::uint32_t>(bounds(shapes[i]), *around) >> unused_bits;
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
