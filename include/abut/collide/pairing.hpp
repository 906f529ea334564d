// SPDX-License-Identifier: MIT
#pragma once

// Who pairs up: two operands. The roles are dealt out here and nowhere else: two trees are walked together, the shapes of
// one operand look in the index of the other, and two plain sets are compared all with all, in tiles. How that is done is
// in routes.hpp, and what becomes an operand in pair_up.hpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/keys.hpp>
#include <abut/collide/nearness.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/routes.hpp>
#include <abut/collide/shares.hpp>

namespace abut::detail {

/// Two operands that are asked about their pairs.
template <operand A, operand B, class Filter, traversal Traversal, schedule Schedule, class Nearness = near_enough_to_touch,
          class Part = whole_search>
struct pairing {
    A a;
    B b;
    pair_key key;
    query_options<Filter, Traversal, Schedule> options;
    Nearness near = {};
    Part part = {};

    using view_a = decltype(std::declval<const A&>().shapes());
    using view_b = decltype(std::declval<const B&>().shapes());
    using view_type = pair_view<view_a, view_b, Filter>;

    [[nodiscard]] view_type view() const { return {a.shapes(), b.shapes(), key, options.filter}; }
    /// Room that results are likely to need.
    [[nodiscard]] std::size_t likely_hits() const {
        return std::max({a.shapes().size() / 4, b.shapes().size() / 4, std::size_t{1} << 16});
    }

    /// Judges all pairs that come near each other, by loops that `run` runs (judged_loops in search.hpp).
    template <class Policy, class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        const view_type both = view();
        if (both.a.size() == 0 || both.b.size() == 0) return;
        if constexpr (A::has_tree && B::has_tree) {
            const std::size_t least = std::min(both.a.size(), both.b.size()), most = std::max(both.a.size(), both.b.size());
            const auto walk = walk_of_both();
            using walk_type = std::remove_const_t<decltype(walk)>;
            if (least > 1 && most <= walk_type::most_shapes) {  // a leaf alone has no place (traverse/pair_walk.hpp)
                return descend(on, b, a, expand_pair<true, walk_type, view_type>{walk, both}, options, run, part);
            }
        }
        if constexpr (A::is_indexed) {
            look<true>(on, a.walk(), both.b, both, run, near, part);
        } else if constexpr (B::is_indexed) {
            look<false>(on, b.walk(), both.a, both, run, near, part);
        } else {
            compare_all(on, both, run);
        }
    }

private:
    /// As where a alone is indexed, b's shapes are the rows. Which tree is the first moves no answer, but what `any` meets
    /// first.
    auto walk_of_both() const {
        const auto overlap = box_overlap(b, a, near);
        using walk = typename way_down<Traversal>::template walk<decltype(b.tree()), decltype(a.tree()),
                                                                 std::remove_const_t<decltype(overlap)>>;
        return walk{b.tree(), a.tree(), overlap};
    }

    /// Rows of tiles are what runs in parallel, so the larger set provides them; a single shape never does.
    template <class Policy, class Run>
    void compare_all(const Policy& on, const view_type& both, const Run& run) const {
        const auto rows_a = [&] { detail::compare<false>(on, both.a, both.b, both, run, near, part); };
        const auto rows_b = [&] { detail::compare<true>(on, both.b, both.a, both, run, near, part); };
        if constexpr (is_single<view_a>) {
            rows_b();
        } else if constexpr (is_single<view_b>) {
            rows_a();
        } else {
            const bool a_is_smaller = both.a.size() < both.b.size();
            const bool a_stays = options.resident == argument::automatic ? a_is_smaller : options.resident == argument::a;
            a_stays ? rows_b() : rows_a();
        }
    }
};

/// A part of what a pairing searches.
template <operand A, operand B, class Filter, traversal Traversal, schedule Schedule, class Nearness>
auto in_part(pairing<A, B, Filter, Traversal, Schedule, Nearness> all, const search_part& part) {
    return pairing<A, B, Filter, Traversal, Schedule, Nearness, search_part>{std::move(all.a), std::move(all.b), all.key,
                                                                             all.options,      all.near,         part};
}

}  // namespace abut::detail
