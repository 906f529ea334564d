// SPDX-License-Identifier: MIT
#pragma once

// What of the work a search does: all of it, or one of some shares, as devices and ranks have them. Each candidate falls to
// one share. Not the ways to candidates themselves: routes.hpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <abut/config.hpp>
#include <abut/traverse/even_nodes.hpp>

namespace abut::detail {

/// All of it.
struct whole_search {};
/// What falls to one of some parts. Rows and pairs of nodes are dealt out by a hash of their numbers: neighbours, which have
/// as much to do, fall to different parts.
struct search_part {
    static constexpr std::size_t rows_together = 256;  ///< so that threads that run together all have work or none
    std::uint32_t part = 0, parts = 1;

    [[nodiscard]] ABUT_HD bool has(std::uint64_t item) const {
        // By the highest bits of the product, in which all bits of the item have a say.
        return parts == 1 || (item * 0x9e3779b97f4a7c15u >> 32) * parts >> 32 == part;
    }
    /// The first of n rows that are shared out as they lie, four at a time, so that parts are aligned as the whole is.
    [[nodiscard]] std::size_t first_of(std::size_t n) const {
        if (part == parts) return n;
        return (n / parts * part + std::min<std::size_t>(n % parts, part)) / 4 * 4;
    }
};

/// The rows of a part look.
template <class LookUp>
struct look_up_of_part : LookUp {
    search_part mine;
    [[nodiscard]] ABUT_HD bool may_find(std::size_t i) const {
        return mine.has(i / search_part::rows_together) && LookUp::may_find(i);
    }
};

/// A step down two trees, from the seeds of a part.
template <class Step>
struct step_of_part : Step {
    using item = typename Step::item;
    search_part mine;
    step_of_part(const Step& step, const search_part& part) : Step(step), mine(part) {}
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        if (mine.has(i)) return Step::seed(i);
        item nothing{};
        nothing.a = nothing.b = Step::nowhere;
        return nothing;
    }
};

/// The same, or where nodes are given, from all pairs of these (traverse/even_nodes.hpp); of one tree with itself from each
/// pair once. They come in any order, so a pair falls to a part by its nodes.
template <class Step>
struct step_of_nodes : step_of_part<Step> {
    using item = typename Step::item;
    static constexpr bool is_of_one_tree = requires(const Step& step) { step.walk.tree(); };
    const std::uint32_t *nodes_a = nullptr, *nodes_b = nullptr;
    std::size_t count_a = 0, count_b = 0;

    using step_of_part<Step>::step_of_part;
    template <class Policy>
    void begin_at(const cut_trees<Policy>& nodes) {
        const auto& b = is_of_one_tree ? nodes.a : nodes.b;
        if (nodes.a.size() * b.size() > most_even_pairs) return;
        nodes_a = nodes.a.data();
        nodes_b = b.data();
        count_a = nodes.a.size();
        count_b = b.size();
    }
    [[nodiscard]] std::size_t seeds() const { return nodes_a == nullptr ? Step::seeds() : count_a * count_b; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        if (nodes_a == nullptr) return step_of_part<Step>::seed(i);
        item at{};
        at.a = nodes_a[i / count_b];
        at.b = nodes_b[i % count_b];
        const bool once = !is_of_one_tree || at.a <= at.b;
        if (!once || !this->mine.has(std::uint64_t{at.a} << 32 | at.b)) at.a = at.b = Step::nowhere;
        return at;
    }
};

/// The rows from `first` on.
template <class Tile>
struct tile_from : Tile {
    using row = typename Tile::row;
    using column = typename Tile::column;
    std::size_t first;

    [[nodiscard]] const row* rows_in_memory() const {
        const row* const all = Tile::rows_in_memory();
        return all == nullptr ? all : all + first;
    }
    [[nodiscard]] ABUT_HD row load_row(std::size_t i) const { return Tile::load_row(first + i); }
    [[nodiscard]] ABUT_HD std::uint64_t candidate_of(std::size_t i, std::size_t j) const {
        return Tile::candidate_of(first + i, j);
    }
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD bool operator()(const row& r, std::size_t i, const column& c, std::size_t j, Hits& hits, auto&... sinks) const {
        return Tile::operator()(r, first + i, c, j, hits, sinks...);
    }
};

/// Lanes of one warp that go different ways wait for each other: of few pieces of work each is taken by one lane in so many.
template <class N>
ABUT_HD N spread_of(N pieces) {
    N spread = 1;
    while (spread < 32 && pieces * spread <= N{1} << 15) spread *= 2;
    return spread;
}
/// f(i) by one lane in `spread`.
template <class F>
struct by_one_lane {
    F f;
    std::size_t spread;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        if (i % spread == 0) f(i / spread);
    }
};

}  // namespace abut::detail
