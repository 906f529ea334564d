// SPDX-License-Identifier: MIT
#pragma once

// Nodes written 16 bytes at a time, so that neighbours on a device write to one line of memory.

#include <cstdint>

#include <abut/index/bvh.hpp>

namespace abut::detail {

template <class Values>
struct [[gnu::may_alias]] alignas(16) node_part {
    Values values;
};

template <scalar T>
inline constexpr unsigned node_parts = sizeof(bvh_node<T>) / 16;

/// number(0) ... number(11) are the bounds in the order in which they lie in a node.
template <scalar T, class Number>
ABUT_HD void write_node_part(bvh_node<T>& to, unsigned part, const Number& number, bvh_child left, bvh_child right) {
    constexpr unsigned numbers = 16 / sizeof(T);
    if (part + 1 < node_parts<T>) {
        node_part<T[numbers]> values;
        for (unsigned j = 0; j < numbers; ++j) values.values[j] = number(part * numbers + j);
        reinterpret_cast<node_part<T[numbers]>*>(&to)[part] = values;
    } else {
        reinterpret_cast<node_part<bvh_child[4]>*>(&to)[part] = {{left, right, {0}, {0}}};
    }
}

}  // namespace abut::detail
