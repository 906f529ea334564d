// SPDX-License-Identifier: MIT
#pragma once

// Who pairs up in a self query: the shapes of one operand, among themselves. As `pairing` does for two operands it numbers
// their pairs, of which the lesser id comes first, and finds those that come near each other: a tree is walked with itself,
// shapes look in the grid that they are in, and those of a plain set are compared all with all, in tiles. A shape is not
// paired with itself. Not for what two shapes of one set may have in common without meeting: that is a judge's to know.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/keys.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pair_up.hpp>
#include <abut/collide/routes.hpp>
#include <abut/collide/shares.hpp>
#include <abut/traverse/self_walk.hpp>

namespace abut::detail {

/// The ids of two shapes that a walk finds once, in either order.
template <class View>
struct ids_in_order {
    View both;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t i, std::uint32_t j) const {
        return i < j ? both.pack(i, j) : both.pack(j, i);
    }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t i, std::uint32_t j) const {
        return i < j ? both.wanted(i, j) : both.wanted(j, i);
    }
};

/// The ids of two shapes that find each other, so that a pair comes in both orders, and each shape with itself.
template <class View>
struct ids_that_ascend {
    View both;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t i, std::uint32_t j) const { return both.pack(i, j); }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t i, std::uint32_t j) const { return i < j && both.wanted(i, j); }
};

/// One operand that is asked about its pairs.
template <operand X, class Filter, traversal Traversal, schedule Schedule, class Nearness = near_enough_to_touch,
          class Part = whole_search>
struct self_pairing {
    X x;
    pair_key key;
    query_options<Filter, Traversal, Schedule> options;
    Nearness near = {};
    Part part = {};

    using view_of_shapes = decltype(std::declval<const X&>().shapes());
    using view_type = pair_view<view_of_shapes, view_of_shapes, Filter>;

    [[nodiscard]] view_type view() const {
        const view_of_shapes shapes = x.shapes();
        return {shapes, shapes, key, options.filter};
    }
    /// Room that results are likely to need.
    [[nodiscard]] std::size_t likely_hits() const { return std::max(x.shapes().size() / 4, std::size_t{1} << 16); }

    /// Judges all pairs that come near each other, by loops that `run` runs (judged_loops in search.hpp).
    template <class Policy, class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        const view_type both = view();
        const std::size_t n = both.a.size();
        if (n < 2) return;  // a leaf alone has no place (traverse/pair_walk.hpp)
        if constexpr (X::has_tree) {
            const self_walk walk(x.tree(), box_overlap(x, x, near));
            using walk_type = std::remove_const_t<decltype(walk)>;
            if (n <= walk_type::most_shapes) {
                const expand_pair<false, walk_type, ids_in_order<view_type>> expand{walk, {both}};
                return descend(on, x, x, expand, options, run, part);
            }
        }
        const ids_that_ascend<view_type> ids{both};
        if constexpr (X::is_indexed) {
            look<false>(on, x.walk(), both.a, ids, run, near, part);
        } else {
            compare<false>(on, both.a, both.b, ids, run, near, part);
        }
    }
};

/// A part of what a pairing searches.
template <operand X, class Filter, traversal Traversal, schedule Schedule, class Nearness>
auto in_part(self_pairing<X, Filter, Traversal, Schedule, Nearness> all, const search_part& part) {
    return self_pairing<X, Filter, Traversal, Schedule, Nearness, search_part>{std::move(all.x), all.key, all.options,
                                                                               all.near, part};
}

/// The argument of a self query, ready to be paired with itself; errors are thrown in the name of `function`. Of the
/// traversals breadth_first and from_front are meant as they say, and the others are both_at_once.
template <input Input = input::checked, class Policy, class X, class Filter, traversal Traversal, schedule Schedule,
          class Sight = as_they_are, class Nearness = near_enough_to_touch>
auto pair_up_self(const Policy& on, const X& x, const query_options<Filter, Traversal, Schedule>& options,
                  const char* function, const Sight& sight = {}, const Nearness& near = {}) {
    check_options(on, options, function);
    auto operand = see(make_operand<Input>(on, x, function), sight);
    const auto shapes = operand.shapes();
    const int bits = id_bits(shapes.size());
    using shape_type = typename decltype(shapes)::shape_type;
    require_functions_of_shapes<shape_type, shape_type>(on);
    return self_pairing<decltype(operand), Filter, Traversal, Schedule, Nearness>{
        std::move(operand), {bits, bits}, options, near};
}

}  // namespace abut::detail
