// SPDX-License-Identifier: MIT
#pragma once

// The order in which builders that work from the bottom up take their leaves: along a Morton curve through the scene.

#include <cstddef>
#include <cstdint>

#include <abut/execution/policy.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/morton.hpp>

namespace abut::detail {

template <class Code, scalar T>
struct write_codes {
    const aabb<T>* boxes;
    const bvh_root<T>* root;
    int unused_bits;
    Code* codes;
    std::uint32_t* ids;
    ABUT_HD void operator()(std::size_t i) const {
        codes[i] = morton_code<Code>(boxes[i], root->bounds) >> unused_bits;
        ids[i] = static_cast<std::uint32_t>(i);
    }
};

/// Shapes by the first bits of their codes, and of equal codes by their ids.
template <class Policy, class Code>
struct leaf_order {
    execution::buffer_of<Policy, Code> codes;
    execution::buffer_of<Policy, std::uint32_t> ids;
};

/// Sorts by `bits` bits; `root` holds the scene's box, in the policy's memory.
template <class Code, execution_policy Policy, scalar T>
leaf_order<Policy, Code> order_leaves(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes,
                                      const bvh_root<T>* root, int bits) {
    const std::size_t n = boxes.size();
    leaf_order<Policy, Code> order{{on, n}, {on, n}};
    for_each_index(on, n,
                   write_codes<Code, T>{boxes.data(), root, morton_bits<Code> - bits, order.codes.data(), order.ids.data()});
    sort_by_key(on, order.codes, order.ids, bits);
    return order;
}

/// Bits that tell n shapes apart, with 6 to spare for their uneven spread, in whole bits of each axis: sorting fewer bits is
/// faster.
constexpr int sufficient_morton_bits(std::size_t n) {
    int bits = 6;
    while (n >> (bits - 6) > 1 && bits < 30) ++bits;
    return bits < 30 ? (bits + 2) / 3 * 3 : 30;
}

/// More shapes than this with one code are a crowd: their order means nothing.
inline constexpr std::size_t crowd_of_leaves = 8;

/// Whether leaf i has the code that the eighth one after it has too.
template <class Code>
struct is_crowded {
    const Code* codes;
    std::size_t shapes;
    ABUT_HD bool operator()(std::size_t i) const {
        return i + crowd_of_leaves < shapes && codes[i] == codes[i + crowd_of_leaves];
    }
};

}  // namespace abut::detail
