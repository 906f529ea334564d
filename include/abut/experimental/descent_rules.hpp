// SPDX-License-Identifier: MIT
#pragma once

// traversal::one_first and traversal::alternate: rules of descent that the sources describe, for comparisons. Who looks for
// the fastest takes both_at_once or larger_first (docs/hierarchies.md).

#include <abut/collide/routes.hpp>
#include <abut/config.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

/// The tree of the first argument, b of the walk, down to its leaves, and only then the other.
struct opens_one_first {
    template <class T>
    [[nodiscard]] ABUT_HD static constexpr bool begins_with_b(T, T) {
        return true;
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD static constexpr bool is_next(bool is_b, bool) { return is_b; }
};
/// The tree that was not opened last.
struct opens_in_turn {
    template <class T>
    [[nodiscard]] ABUT_HD static constexpr bool begins_with_b(T, T) {
        return false;
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD static constexpr bool is_next(bool, bool) { return false; }
};

template <>
struct way_down<traversal::one_first> : goes_down_by_rule<opens_one_first> {};
template <>
struct way_down<traversal::alternate> : goes_down_by_rule<opens_in_turn> {};

}  // namespace abut::detail
