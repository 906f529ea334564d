// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair: which shapes of one set touch which of another. Each side is a set (an owner, a view or
// one shape) or an index over a set, either of them posed or not; where neither is an index, all are compared with all in
// tiles.
//
// All four run on the policy and return when the answer is there. Their answers do not depend on the policy, the thread
// count or the index. They throw invalid_geometry (views and single shapes, which are checked at each call), error (a set on
// another device, a start_depth out of range), capacity_error, std::bad_alloc and cuda_error.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include <abut/collide/search.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>
#include <abut/shape/posed.hpp>
#include <abut/traverse/bvh_walk.hpp>
#include <abut/traverse/frontier.hpp>
#include <abut/traverse/grid_walk.hpp>
#include <abut/traverse/pair_walk.hpp>
#include <abut/traverse/posed_walk.hpp>
#include <abut/traverse/rule_walk.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut {

namespace detail {

template <class X>
inline constexpr bool is_index = false;
template <class Set, memory_space Space, class Layout>
inline constexpr bool is_index<bvh<Set, Space, Layout>> = true;
template <class Set, memory_space Space>
inline constexpr bool is_index<grid<Set, Space>> = true;

template <class Object>
inline constexpr bool is_index<posed_object<Object>> = is_index<Object>;

template <class Set, memory_space Space, class Layout>
auto walk_of(const bvh<Set, Space, Layout>& index) {
    return bvh_walk<typename bvh<Set, Space, Layout>::view_type>{index.view()};
}
template <class Set, memory_space Space>
auto walk_of(const grid<Set, Space>& index) {
    return grid_walk<typename grid<Set, Space>::view_type>{index.view()};
}

/// The box around all shapes of an index, which has some.
template <class Policy, class Set, memory_space Space, class Layout>
auto box_of(const Policy&, const bvh<Set, Space, Layout>& index) {
    return index.bounds();
}
template <class Policy, class Set, memory_space Space>
auto box_of(const Policy& on, const grid<Set, Space>& index) {
    aabb<typename Set::scalar_type> box;
    download(on, &index.view().frame->bounds, 1, &box);
    return box;
}

/// One side of a query, in the policy's memory: the resident set, and a walk if it is indexed.
template <class Resident>
struct plain_side {
    Resident set;
    auto shapes() const { return view_of(set); }
};
template <class Index>
struct indexed_side {
    Index index;
    auto shapes() const { return view_of(index.set()); }
    auto walk() const { return walk_of(index); }
};
template <class Side, scalar T>
struct posed_side {
    Side side;
    rigid<T> pose;
    aabb<T> around;  ///< an index's shapes, in their frame
    auto shapes() const { return posed_view<decltype(side.shapes())>{side.shapes(), pose}; }
    auto walk() const { return posed_walk<decltype(side.walk())>(side.walk(), pose, around); }
};

template <class X>
inline constexpr bool is_indexed_side = false;
template <class Index>
inline constexpr bool is_indexed_side<indexed_side<Index>> = true;
template <class Side, scalar T>
inline constexpr bool is_indexed_side<posed_side<Side, T>> = is_indexed_side<Side>;

/// The tree of a side and its pose, if it has a tree.
template <class Side>
struct tree_of_side {
    static constexpr bool exists = false;
};
template <class Set, memory_space Space, class Layout>
struct tree_of_side<indexed_side<bvh<Set, Space, Layout>>> {
    static constexpr bool exists = true, posed = false;
    using T = typename Set::scalar_type;
    using side_type = indexed_side<bvh<Set, Space, Layout>>;
    static auto view(const side_type& side) { return side.index.view(); }
    static rigid<T> pose(const side_type&) { return {}; }
    static aabb<T> bounds(const side_type& side) { return side.index.bounds(); }
};
template <class Side, scalar T>
    requires tree_of_side<Side>::exists
struct tree_of_side<posed_side<Side, T>> {
    static constexpr bool exists = true, posed = true;
    static auto view(const posed_side<Side, T>& side) { return tree_of_side<Side>::view(side.side); }
    static rigid<T> pose(const posed_side<Side, T>& side) { return side.pose; }
    static aabb<T> bounds(const posed_side<Side, T>& side) { return side.around; }
};

/// How boxes of two sides' trees are compared.
template <class SideA, class SideB>
auto box_overlap(const SideA& side_a, const SideB& side_b) {
    using a = tree_of_side<SideA>;
    using b = tree_of_side<SideB>;
    if constexpr (a::posed || b::posed) {
        return two_frames{make_relative_pose(a::pose(side_a), a::bounds(side_a), b::pose(side_b), b::bounds(side_b))};
    } else {
        return same_frame{};
    }
}

template <class Policy, class X>
auto make_side(const Policy& on, const X& x, const char* function) {
    if constexpr (is_posed<X>) {
        using T = typename X::scalar_type;
        check(x.pose, function);
        posed_side<decltype(make_side(on, x.object, function)), T> side{make_side(on, x.object, function), x.pose, {}};
        bool surely_finite = side.shapes().size() == 0;
        if constexpr (is_index<X>) {
            if (!surely_finite) {
                side.around = box_of(on, x.object);
                surely_finite = stays_finite(x.pose, side.around);
            }
        }
        if (!surely_finite) check(on, side.shapes(), function);
        return side;
    } else if constexpr (is_index<X>) {
        static_assert(std::same_as<typename X::memory_space, space_of<Policy>>,
                      "abut: the index lies in other memory than the policy works in; make it with the same policy");
        require_same_device(on, x, function);
        return indexed_side<X>{x};
    } else {
        auto set = make_resident(on, x, function);
        return plain_side<decltype(set)>{std::move(set)};
    }
}

// What a walk of two trees finds, handed to a policy's emitter. No lambdas: nvcc would warn of emitters of the host.

template <class Emitter>
struct add_item {
    Emitter& emitter;
    ABUT_CALLS_ANY
    template <class Number, class Item>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Item& next) const {
        emitter.add(k, is, next);
    }
};
template <class Emitter, class Sides>
struct push_key {
    Emitter& emitter;
    const Sides& sides;
    ABUT_CALLS_ANY
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, std::uint32_t query, std::uint32_t target) const {
        emitter.push(k, is && sides.wanted(query, target), sides.key.pack(query, target));
    }
};

/// One step down two trees.
template <class Walk, class Sides>
struct expand_pair {
    using item = typename Walk::item;
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = Walk::most_children, most_depth = Walk::most_depth;
    Walk walk;
    Sides sides;

    [[nodiscard]] std::size_t seeds() const { return walk.seeds(); }
    ABUT_INLINE void prefetch(const item& at) const { walk.prefetch(at); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return walk.seed(i); }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        walk.expand(at, add_item<sink>{emitter}, push_key<sink, Sides>{emitter, sides});
    }
};

/// The walk of two trees for a traversal.
template <traversal Traversal, class A, class B, class Overlap>
using chosen_walk =
    typename std::conditional_t<Traversal == traversal::both_at_once || Traversal == traversal::breadth_first,
                                std::type_identity<pair_walk<A, B, Overlap>>,
                                std::type_identity<rule_walk<A, B, Overlap, Traversal>>>::type;

/// Stage 1 of a search for queries [first, first + n): two trees walk together, a set in an index shape by shape, and two
/// plain sets are tiled.
template <arithmetic A, traversal Traversal, class Policy, class Sides, class QuerySide, class TargetSide>
struct find_candidates {
    const Policy& on;
    const Sides& sides;
    const QuerySide& query;
    const TargetSide& target;
    std::size_t first, n;
    int start_depth;

    template <class Settle, class Late, class Wide, class Hits>
    void operator()(const Settle& settle, Late& late, Wide& wide, Hits& hits) const {
        if (n == 0 || sides.targets.size() == 0) return;
        if constexpr (tree_of_side<QuerySide>::exists && tree_of_side<TargetSide>::exists) {
            using walk_type = decltype(walk_of_both());
            const std::size_t least = std::min(n, sides.targets.size()), most = std::max(n, sides.targets.size());
            // A part of the queries is no tree, and a leaf alone has no place (traverse/pair_walk.hpp).
            if (n == sides.queries.size() && least > 1 && most <= walk_type::most_shapes) {
                const expand_pair<walk_type, Sides> expand{walk_of_both(), sides};
                const decide_key<A, Sides> decide{sides};
                if constexpr (Traversal == traversal::breadth_first) {
                    return for_each_on_levels(on, expand, start_depth, decide, settle, late, wide, hits);
                } else {
                    return for_each_descendant(on, expand, decide, settle, late, wide, hits);
                }
            }
        }
        if constexpr (is_indexed_side<TargetSide>) {
            const auto walk = target.walk();
            using walk_type = std::remove_const_t<decltype(walk)>;
            for_each_candidate(on, n, may_touch<walk_type, Sides>{walk, sides, first},
                               walk_index<walk_type, Sides>{walk, sides, first}, decide_key<A, Sides>{sides}, settle, late,
                               wide, hits);
        } else {
            for_each_tiled(on, n, sides.targets.size(), all_against_all<A, Sides>{sides, first}, settle, late, wide, hits);
        }
    }

private:
    auto walk_of_both() const {
        const auto tree_a = tree_of_side<QuerySide>::view(query);
        const auto tree_b = tree_of_side<TargetSide>::view(target);
        const auto overlap = box_overlap(query, target);
        using walk_type = chosen_walk<Traversal, std::remove_const_t<decltype(tree_a)>,
                                      std::remove_const_t<decltype(tree_b)>, std::remove_const_t<decltype(overlap)>>;
        return walk_type{tree_a, tree_b, overlap};
    }
};

/// Searches with `query_side` looking for `target_side`; `body(both, run, n)` gets the sides, a function run(hits, first, n)
/// that searches for a range of queries, and the number of queries.
template <arithmetic A, class Policy, class QuerySide, class TargetSide, class Filter, traversal Traversal, class Body>
auto with_search(const Policy& on, const QuerySide& query_side, const TargetSide& target_side, bool queries_are_b,
                 const query_options<Filter, Traversal>& options, const Body& body) {
    const auto queries = query_side.shapes();
    const auto targets = target_side.shapes();
    using sides_type = sides<std::remove_const_t<decltype(queries)>, std::remove_const_t<decltype(targets)>, Filter>;
    const int query_bits = id_bits(queries.size()), target_bits = id_bits(targets.size());
    const pair_key key{queries_are_b ? target_bits : query_bits, queries_are_b ? query_bits : target_bits, queries_are_b};
    const sides_type both{queries, targets, key, options.filter};
    using find = find_candidates<A, Traversal, Policy, sides_type, QuerySide, TargetSide>;
    const auto run = [&](auto& hits, std::size_t first, std::size_t n) {
        search<A>(on, both, hits, find{on, both, query_side, target_side, first, n, options.start_depth});
    };
    return body(both, run, queries.size());
}

/// Brings both arguments to the policy and chooses who looks for whom: an index is looked in, and of two plain sets the
/// larger one looks, since rows of tiles are what runs in parallel.
template <arithmetic A, class Policy, class X, class Y, class Filter, traversal Traversal, class Body>
auto on_both(const Policy& on, const X& x, const Y& y, const query_options<Filter, Traversal>& options, const char* function,
             const Body& body) {
    if (Traversal == traversal::breadth_first && (options.start_depth < 0 || options.start_depth > most_start_depth)) {
        throw error(std::string(function) + ": start_depth is " + std::to_string(options.start_depth) + ", not in 0.." +
                    std::to_string(most_start_depth));
    }
    // Generic, so that the order that is not taken is not compiled.
    const auto a_looks = [&](const auto& a, const auto& b) { return with_search<A>(on, a, b, false, options, body); };
    const auto b_looks = [&](const auto& a, const auto& b) { return with_search<A>(on, b, a, true, options, body); };
    const auto a = make_side(on, x, function);
    const auto b = make_side(on, y, function);
    constexpr bool indexed = is_index<X> || is_index<Y>;
    if constexpr (indexed ? is_index<X> : is_shape<X>) {
        return b_looks(a, b);
    } else if constexpr (indexed || is_shape<Y>) {
        return a_looks(a, b);
    } else {
        const bool a_is_smaller = a.shapes().size() < b.shapes().size();
        const bool a_stays = options.resident == query_side::automatic ? a_is_smaller : options.resident == query_side::a;
        return a_stays ? b_looks(a, b) : a_looks(a, b);
    }
}

struct unpack_key {
    pair_key key;
    const std::uint64_t* keys;
    index_pair* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = key.unpack(keys[i]); }
};

template <class Visitor>
struct visit_key {
    pair_key key;
    const std::uint64_t* keys;
    Visitor visitor;
    ABUT_CALLS_ANY
    template <class Flag>
    ABUT_HD void operator()(std::size_t i, Flag& stopped) const {
        if (!stopped.raised() && visitor(key.unpack(keys[i])) == visit::stop) stopped.raise();
    }
};

/// The keys of all pairs that touch, sorted if wanted.
template <class Policy, class Sides, class Run>
auto touching_keys(const Policy& on, const Sides& both, const Run& run, std::size_t n, bool sorted) {
    key_queue<Policy> hits(on, std::max(n / 4, std::size_t{1} << 16));
    run(hits, 0, n);
    auto keys = hits.take();
    if (sorted) sort_keys(on, keys, both.key.bits());
    return keys;
}

}  // namespace detail

/// Whether any shape of `a` touches any shape of `b`. Stops at the first one found.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] bool any(const Policy& on, const X& a, const Y& b, const query_options<Filter, Traversal>& options = {}) {
    return detail::on_both<A>(on, a, b, options, "abut::any", [&](const auto&, const auto& run, std::size_t n) {
        execution::work_flag<space_of<Policy>> found(on);
        run(found, 0, n);
        return found.raised();
    });
}

/// Number of pairs that touch. Stores none of them; but pairs that the filter cannot decide wait in a queue, 8 bytes each,
/// for the second stage.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] std::uint64_t count(const Policy& on, const X& a, const Y& b,
                                  const query_options<Filter, Traversal>& options = {}) {
    return detail::on_both<A>(on, a, b, options, "abut::count", [&](const auto&, const auto& run, std::size_t n) {
        execution::work_count<space_of<Policy>> hits(on);
        run(hits, 0, n);
        return hits.total();
    });
}

/// All pairs that touch, each once, in the policy's memory; sorted by a, then b, unless the options say otherwise.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
[[nodiscard]] auto pairs(const Policy& on, const X& a, const Y& b, const query_options<Filter, Traversal>& options = {}) {
    using outcome = result<index_pair, space_of<Policy>>;
    const auto body = [&](const auto& both, const auto& run, std::size_t n) {
        const auto keys = detail::touching_keys(on, both, run, n, options.sorted);
        execution::buffer_of<Policy, index_pair> pairs(on, keys.size());
        for_each_index(on, keys.size(), detail::unpack_key{both.key, keys.data(), pairs.data()});
        synchronize(on);
        return outcome(std::move(pairs));
    };
    return detail::on_both<A>(on, a, b, options, "abut::pairs", body);
}

/// Calls visitor(index_pair) -> visit once for every pair that touches, in no order, concurrently, in the policy's space (so
/// under cuda it is a trivially copyable functor with an ABUT_HD operator()). `visit::stop` is best effort: pairs in flight
/// still come. Every pair is found twice, first to count: memory for results is bounded by options.most_pairs pairs at a
/// time, or by the pairs of one query shape if that has more.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once>
void for_each_pair(const Policy& on, const X& a, const Y& b, const Visitor& visitor,
                   const query_options<Filter, Traversal>& options = {}) {
    const auto body = [&](const auto& both, const auto& run, std::size_t n) {
        // Found pairs are gathered first and visited after, since a queue that proves too small is filled anew and a visitor
        // must see each pair once. A range of queries with too many pairs is halved.
        std::size_t step = std::max<std::size_t>(options.most_pairs / 16, 1);
        for (std::size_t first = 0; first < n;) {
            step = std::min(step, n - first);
            execution::work_count<space_of<Policy>> size(on);
            run(size, first, step);
            if (size.total() > options.most_pairs && step > 1) {
                step = (step + 1) / 2;
                continue;
            }
            detail::key_queue<Policy> hits(on, size.total());
            run(hits, first, step);
            execution::work_flag<space_of<Policy>> stopped(on);
            for_each_index(on, hits.size(), detail::visit_key<Visitor>{both.key, hits.data(), visitor}, stopped);
            if (stopped.raised()) return;
            first += step;
            step *= 2;  // it was halved where pairs were dense
        }
    };
    detail::on_both<A>(on, a, b, options, "abut::for_each_pair", body);
}

}  // namespace abut
