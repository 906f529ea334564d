// SPDX-License-Identifier: MIT
#pragma once

// The engine of all queries: candidates from a walk or from tiles, decided in stages, left in a queue, a count or a flag.
//
// Stage 1 runs where the candidates are found. What its filter cannot decide is late: it goes to a queue, and stage 2, which
// follows at once, decides it with more effort and in fixed-width integers, whole warps at a time. What is too wide even for
// those (coordinates over 2^124 apart in one pair) is decided on the host. No caller sees the difference.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/align.hpp>
#include <abut/collide/options.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/operand.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/traverse/reach.hpp>

namespace abut::detail {

/// Number of bits that ids below n need.
constexpr int id_bits(std::size_t n) { return bits_up_to(n > 0 ? n - 1 : 0); }

/// Pairs travel as one number, a above b, in as few bits as the sets need: sorting them is then a short radix sort.
struct pair_key {
    int a_bits, b_bits;
    bool queries_are_b;

    [[nodiscard]] int bits() const { return a_bits + b_bits; }

    ABUT_HD std::uint64_t pack(std::uint32_t query, std::uint32_t target) const {
        const std::uint64_t a = queries_are_b ? target : query, b = queries_are_b ? query : target;
        return a << b_bits | b;
    }
    ABUT_HD index_pair unpack(std::uint64_t key) const {
        return {static_cast<std::uint32_t>(key >> b_bits),
                static_cast<std::uint32_t>(key & ((std::uint64_t{1} << b_bits) - 1))};
    }
    ABUT_HD std::uint32_t query(std::uint64_t key) const { return queries_are_b ? unpack(key).b : unpack(key).a; }
    ABUT_HD std::uint32_t target(std::uint64_t key) const { return queries_are_b ? unpack(key).a : unpack(key).b; }
};

// What to do with a pair that touches, for each kind of answer.

ABUT_CALLS_ANY
template <class Sink>
ABUT_HD void report(Sink& hits, std::uint64_t key) {
    if constexpr (requires { hits.push(key); }) {
        hits.push(key);
    } else if constexpr (requires { hits.add(1); }) {
        hits.add(1);
    } else {
        hits.raise();
    }
}

/// A query may meet a target in either order of shapes; predicates are written for one.
template <class Query, class Target>
inline constexpr bool decidable = decidable_pair<Query, Target> || decidable_pair<Target, Query>;

template <class Query, class Target>
ABUT_HD const auto& first_of(const Query& query, const Target& target) {
    if constexpr (decidable_pair<Query, Target>) {
        return query;
    } else {
        return target;
    }
}
template <class Query, class Target>
ABUT_HD const auto& second_of(const Query& query, const Target& target) {
    if constexpr (decidable_pair<Query, Target>) {
        return target;
    } else {
        return query;
    }
}

/// Both sides of a search: `queries` look for `targets`.
template <shape_view Queries, shape_view Targets, class Filter>
struct sides {
    static_assert(std::same_as<typename Queries::scalar_type, typename Targets::scalar_type>,
                  "abut: both sides of a query need the same scalar type, float or double");
    using query_shape = typename Queries::shape_type;
    using target_shape = typename Targets::shape_type;
    static_assert(decidable<query_shape, target_shape>, "abut: queries between sets of these two shapes are not supported");

    Queries queries;
    Targets targets;
    pair_key key;
    Filter filter;

    ABUT_CALLS_ANY
    ABUT_HD bool wanted(std::uint32_t query, std::uint32_t target) const {
        return key.queries_are_b ? filter(target, query) : filter(query, target);
    }
};

/// Stage 1 for one pair; what it cannot decide is late, on the host as well: calling the integers from here made g++ inline
/// less of the loop around it, and the query half as long again.
template <arithmetic A, class Sides>
struct decide_key {
    Sides sides;

    ABUT_HD void operator()(std::uint64_t key, auto& late, auto&, auto& hits) const {
        (*this)(key, sides.queries[sides.key.query(key)], sides.targets[sides.key.target(key)], late, hits);
    }
    /// A hint that the pair will be decided soon; see shape_view.
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const {
        prefetch_shape(sides.queries, sides.key.query(key), step);
        prefetch_shape(sides.targets, sides.key.target(key), step);
    }
    ABUT_CALLS_ANY
    template <class Query, class Target, class Late, class Hits>
    ABUT_HD void operator()(std::uint64_t key, const Query& query, const Target& target, Late& late, Hits& hits) const {
        const verdict v = decide<A>(first_of(query, target), second_of(query, target));
        if (v == verdict::yes) report(hits, key);
        if (v == verdict::unknown) late.push(key);
    }
};

/// Whether query `first + i` can touch anything at all.
template <class Walk, class Sides>
struct may_touch {
    Walk walk;
    Sides sides;
    std::size_t first;

    ABUT_HD bool operator()(std::size_t i) const {
        auto reach = reach_of(sides.queries[first + i]);
        return walk.may_touch(reach);
    }
};

/// The candidates of query `first + i` in an index.
template <class Walk, class Sides>
struct walk_index {
    using candidate = std::uint64_t;
    Walk walk;
    Sides sides;
    std::size_t first;

    ABUT_CALLS_ANY
    template <class Emitter, class Wide, class Hits>
    ABUT_HD void operator()(std::size_t i, const Emitter& emitter, Wide&, Hits& hits) const {
        const auto query = static_cast<std::uint32_t>(first + i);
        auto reach = reach_of(sides.queries[query]);
        walk.for_each(reach, [&](std::uint32_t target) {
            if (sides.wanted(query, target)) emitter.push(sides.key.pack(query, target));
            return execution::is_over(hits) ? visit::stop : visit::proceed;
        });
    }
};

/// Queries against targets, all against all.
template <arithmetic A, class Sides>
struct all_against_all {
    struct column {
        typename Sides::target_shape shape;
        decltype(bounds(typename Sides::target_shape{})) box;
    };
    using row = typename Sides::query_shape;
    using reach = decltype(abut::reach_of(row{}));

    Sides sides;
    std::size_t first;

    [[nodiscard]] const row* rows_in_memory() const {
        const row* const all = shapes_in_memory(sides.queries);
        return all == nullptr ? nullptr : all + first;
    }
    ABUT_HD row load_row(std::size_t i) const { return sides.queries[first + i]; }
    ABUT_HD reach reach_of(const row& query) const { return abut::reach_of(query); }
    ABUT_HD column load_column(std::size_t j) const {
        const auto shape = sides.targets[j];
        return {shape, bounds(shape)};
    }
    ABUT_HD bool passes(const reach& query, const column& target) const { return query(target.box); }
    ABUT_CALLS_ANY
    template <class Late, class Wide, class Hits>
    ABUT_HD void operator()(const row& query, std::size_t i, const column& target, std::size_t j, Late& late, Wide&,
                            Hits& hits) const {
        const auto query_id = static_cast<std::uint32_t>(first + i), target_id = static_cast<std::uint32_t>(j);
        if (!sides.wanted(query_id, target_id)) return;
        decide_key<A, Sides>{sides}(sides.key.pack(query_id, target_id), query, target.shape, late, hits);
    }
};

/// Stage 2 for one pair: stage 1 where it has not been tried, then all that needs no more than registers.
template <arithmetic A, class Sides>
struct settle {
    Sides sides;

    ABUT_CALLS_ANY
    template <class Wide, class Hits>
    ABUT_HD void operator()(std::uint64_t key, Wide& wide, Hits& hits) const {
        const auto query = sides.queries[sides.key.query(key)];
        const auto target = sides.targets[sides.key.target(key)];
        verdict v = decide<A>(first_of(query, target), second_of(query, target));
        if constexpr (!std::same_as<A, exact>) {
            if (v == verdict::unknown) v = decide_left<A>(first_of(query, target), second_of(query, target));
        }
        if (v == verdict::yes) report(hits, key);
        if (v == verdict::unknown) wide.push(key);
    }
};

/// A pair with its shapes, on its way to the host.
template <class Sides>
struct whole_pair {
    typename Sides::query_shape query;
    typename Sides::target_shape target;
    std::uint64_t key;
};

template <class Sides>
struct fetch_pair {
    Sides sides;
    const std::uint64_t* keys;
    whole_pair<Sides>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = keys[i];
        out[i] = {sides.queries[sides.key.query(key)], sides.targets[sides.key.target(key)], key};
    }
};

template <class Policy>
using key_queue = execution::work_queue<std::uint64_t, space_of<Policy>>;

/// Stage 3: decides on the host and returns the keys of the pairs that touch.
template <class Policy, class Sides>
std::vector<std::uint64_t> settle_on_host(const Policy& on, const Sides& sides, key_queue<Policy>& wide) {
    const std::size_t n = wide.size();
    execution::buffer_of<Policy, whole_pair<Sides>> gathered(on, n);
    for_each_index(on, n, fetch_pair<Sides>{sides, wide.data(), gathered.data()});
    std::vector<whole_pair<Sides>> pairs(n);
    download(on, gathered.data(), n, pairs.data());
    std::vector<std::uint64_t> touching;
    for (const auto& pair : pairs) {
        if (resolve(first_of(pair.query, pair.target), second_of(pair.query, pair.target))) touching.push_back(pair.key);
    }
    return touching;
}

/// Runs the stages and leaves the outcome in `hits`: a work_queue of keys, a work_count or a work_flag.
/// `find(settle, late, wide, hits)` is stages 1 and 2. Waits for the outcome.
template <arithmetic A, class Policy, class Sides, class Hits, class Find>
void search(const Policy& on, const Sides& sides, Hits& hits, const Find& find) {
    key_queue<Policy> late(on), wide(on, 0);  // hardly anything is wide: no room is made for it unasked
    find(settle<A, Sides>{sides}, late, wide, hits);
    if (wide.size() == 0 || execution::is_over(hits)) return;
    key_queue<Policy> last(on, settle_on_host(on, sides, wide));
    hits.absorb(on, last);
}

}  // namespace abut::detail
