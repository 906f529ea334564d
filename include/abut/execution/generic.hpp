// SPDX-License-Identifier: MIT
#pragma once

// The verbs that a policy need not supply (execution/policy.hpp), made of for_each_index and, in host memory, of nothing. A
// policy's own verb is more specialised than these, and so it is preferred; but a loop's own verb takes only functors that
// play their roles, and others are refused here, in one line.
//
// Definitions do not go in circles: for_each_index <- for_each_task <- reduce_into <- reduce;
// for_each_task <- exclusive_scan <- compact; for_each_task <- the sorts; for_each_index <- all else.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/group.hpp>
#include <abut/execution/policy.hpp>
#include <abut/execution/radix_sort.hpp>
#include <abut/execution/roles.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

// --- memory of the host ------------------------------------------------------------------------------------------------

template <host_policy Policy, class T>
void upload(const Policy&, const T* from, std::size_t n, T* to) {
    if (n > 0) std::memcpy(static_cast<void*>(to), from, n * sizeof(T));
}

template <host_policy Policy, class T>
void download(const Policy&, const T* from, std::size_t n, T* to) {
    if (n > 0) std::memcpy(static_cast<void*>(to), from, n * sizeof(T));
}

template <host_policy Policy, class T>
void copy(const Policy&, const T* from, std::size_t n, T* to) {
    if (n > 0) std::memcpy(static_cast<void*>(to), from, n * sizeof(T));
}

/// Host memory is open to all.
template <host_policy Policy>
void require_access(const Policy&, const void*, const char*) {}

/// A host calls anything.
template <host_policy Policy, class F, class... Args>
void require_callable(const Policy&, const F&, const Args&...) {}

template <host_policy Policy>
int device_of(const Policy&) {
    return -1;
}

/// Loops on the host end before they return, so there is nothing to wait for.
/// @ingroup policies
template <host_policy Policy>
void synchronize(const Policy&) {}

/// Host memory is not pooled, so there is nothing to give back.
/// @ingroup policies
template <host_policy Policy>
void release_memory(const Policy&) {}

// --- loops over indices ------------------------------------------------------------------------------------------------

template <class Policy>
int concurrency(const Policy&) {
    return 32;
}

template <class Policy, class F>
void for_each_task(const Policy& on, std::size_t n, const F& f) {
    for_each_index(on, n, f);
}

/// 0, 1, 2, ...
template <class T>
struct write_index {
    T* out;  ///< as many as indices
    /// Writes one.
    ABUT_HD void operator()(std::size_t i) const { out[i] = static_cast<T>(i); }
};

template <class Policy, class F, class... Queues>
void for_each_indirect(const Policy& on, const std::uint32_t* n, const F& f, Queues&... queues) {
    std::uint32_t count = 0;
    download(on, n, 1, &count);
    for_each_index(on, count, f, queues...);
}

namespace detail {

template <class F>
struct run_group {
    F f;
    void operator()(std::size_t i) const {
        typename F::shared shared;
        f(group<typename F::shared, group_size_of<F>>(i * group_size_of<F>, shared));
    }
};

template <class T>
struct store_value {
    T* out;
    T value;
    ABUT_HD void operator()(std::size_t i) const { out[i] = value; }
};
template <class T>
struct copy_value {
    const T* from;
    T* to;
    ABUT_HD void operator()(std::size_t i) const { to[i] = from[i]; }
};

}  // namespace detail

template <host_policy Policy, class F>
void for_each_group(const Policy& on, std::size_t n, const F& f) {
    static_assert(group_functor<F>, "abut: for_each_group: the functor is no group_functor (execution/roles.hpp)");
    if constexpr (group_functor<F>) {
        for_each_task(on, n / group_size_of<F> + (n % group_size_of<F> != 0), detail::run_group<F>{f});
    }
}

template <class Policy, class T>
void fill(const Policy& on, T* out, std::size_t n, const T& value) {
    for_each_index(on, n, detail::store_value<T>{out, value});
}

template <class Policy, class T>
void copy(const Policy& on, const T* from, std::size_t n, T* to) {
    for_each_index(on, n, detail::copy_value<T>{from, to});
}

// --- loops over candidates ---------------------------------------------------------------------------------------------

namespace detail {

/// Decides a candidate to the end.
ABUT_CALLS_ANY
template <class Judge, class Candidate, class... Sinks>
ABUT_HD void decide(const Judge& judge, const Candidate& c, Sinks&... sinks) {
    if (!judge(c, sinks...)) judge.finish(c, sinks...);
}

/// Takes candidates from a walk, and hands each on at once.
template <class F>
struct push_at_once {
    F f;
    ABUT_CALLS_ANY
    template <class Candidate>
    ABUT_HD void push(const Candidate& c) const {
        f(c);
    }
    [[nodiscard]] ABUT_HD static constexpr bool is_full() { return false; }
};
template <class F>
push_at_once(F) -> push_at_once<F>;

template <class Walk, class Judge>
struct walk_and_judge {
    Walk walk;
    Judge judge;
    ABUT_CALLS_ANY
    template <class... Sinks>
    ABUT_HD void operator()(std::size_t i, Sinks&... sinks) const {
        if (!walk.may_find(i)) return;
        typename Walk::cursor at;
        const push_at_once emitter{[&](const typename Walk::candidate& c) { decide(judge, c, sinks...); }};
        walk(i, at, emitter, sinks...);
    }
};

template <class Tile>
struct row_against_columns {
    Tile tile;
    std::size_t columns;
    ABUT_CALLS_ANY
    template <class... Sinks>
    ABUT_HD void operator()(std::size_t i, Sinks&... sinks) const {
        const auto row = tile.load_row(i);
        auto reach = tile.reach_of(row);
        for (std::size_t j = 0; j < columns && !is_over(sinks...); ++j) {
            const auto column = tile.load_column(j);
            if (!tile.passes(reach, column) || tile(row, i, column, j, sinks...)) continue;
            tile.finish(tile.candidate_of(i, j), sinks...);
        }
    }
};

template <class Expand>
struct write_seeds {
    Expand expand;
    typename Expand::item* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = expand.seed(i); }
};

/// Takes what an item makes: items wait in a sink, and candidates are handed on at once.
template <class Next, class F>
struct expand_at_once {
    Next& next;
    const F& f;
    ABUT_CALLS_ANY
    template <class Number, class Item>
    ABUT_HD void add(Number, bool is, const Item& item) const {
        if (is) next.push(item);
    }
    ABUT_CALLS_ANY
    template <class Number, class Candidate>
    ABUT_HD void push(Number, bool is, const Candidate& c) const {
        if (is) f(c);
    }
};
template <class Next, class F>
expand_at_once(Next&, const F&) -> expand_at_once<Next, F>;

template <class Expand, class Judge>
struct expand_and_judge {
    Expand expand;
    Judge judge;
    const typename Expand::item* items;
    ABUT_CALLS_ANY
    template <class Next, class... Sinks>
    ABUT_HD void operator()(std::size_t i, Next& next, Sinks&... sinks) const {
        const auto judged = [&](const typename Expand::candidate& c) { decide(judge, c, sinks...); };
        const expand_at_once emitter{next, judged};
        expand(items[i], emitter);
    }
};

}  // namespace detail

template <class Policy, class Walk, class Judge, class... Queues>
std::uint64_t for_each_candidate(const Policy& on, std::size_t n, const Walk& walk, const Judge& judge, Queues&... queues) {
    constexpr bool walks = candidate_walk<Walk, sink_of<Queues>...>;
    static_assert(walks, "abut: for_each_candidate: the walk is no candidate_walk (execution/roles.hpp)");
    if constexpr (walks) {
        constexpr bool judges = candidate_judge<Judge, typename Walk::candidate, sink_of<Queues>...>;
        static_assert(judges, "abut: for_each_candidate: the judge is no candidate_judge (execution/roles.hpp)");
        if constexpr (judges) for_each_index(on, n, detail::walk_and_judge<Walk, Judge>{walk, judge}, queues...);
    }
    return 0;
}

template <class Policy, class Tile, class... Queues>
std::uint64_t for_each_tiled(const Policy& on, std::size_t n, std::size_t m, const Tile& tile, Queues&... queues) {
    constexpr bool plays = tile_functor<Tile, sink_of<Queues>...>;
    static_assert(plays, "abut: for_each_tiled: the tile is no tile_functor (execution/roles.hpp)");
    if constexpr (plays) for_each_index(on, n, detail::row_against_columns<Tile>{tile, m}, queues...);
    return 0;
}

/// Level by level, but in parts, the deepest first: memory is bounded by the depth.
template <class Policy, class Expand, class Judge, class... Queues>
std::uint64_t for_each_descendant(const Policy& on, const Expand& expand, const Judge& judge, Queues&... queues) {
    static_assert(expander<Expand>, "abut: for_each_descendant: the functor is no expander (execution/roles.hpp)");
    if constexpr (expander<Expand>) {
        constexpr bool judges = candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>;
        static_assert(judges, "abut: for_each_descendant: the judge is no candidate_judge (execution/roles.hpp)");
        if constexpr (judges) {
            using item = typename Expand::item;
            constexpr std::size_t most_at_a_time = std::size_t{1} << 16;
            struct level {
                buffer_of<Policy, item> items;
                std::size_t left;
            };
            std::vector<level> levels;
            const auto add_level = [&](buffer_of<Policy, item> items) {
                const std::size_t n = items.size();
                if (n > 0) levels.push_back({std::move(items), n});
            };
            buffer_of<Policy, item> seeds(on, expand.seeds());
            for_each_index(on, seeds.size(), detail::write_seeds<Expand>{expand, seeds.data()});
            add_level(std::move(seeds));
            while (!levels.empty() && !is_over(queues...)) {
                level& from = levels.back();
                const std::size_t n = std::min(from.left, most_at_a_time);
                from.left -= n;
                // It has room for all, so no loop runs twice, and a judge may write elsewhere.
                work_queue<item, space_of<Policy>> next(on, n * Expand::most_children);
                for_each_index(on, n, detail::expand_and_judge<Expand, Judge>{expand, judge, from.items.data() + from.left},
                               next, queues...);
                if (from.left == 0) levels.pop_back();
                add_level(next.take());
            }
        }
    }
    return 0;
}

/// A policy without schedules has one way.
template <class Policy, schedule Schedule, class Expand, class Judge, class... Queues>
std::uint64_t for_each_descendant(const Policy& on, const scheduled<Schedule>& how, const Expand& expand, const Judge& judge,
                                  Queues&... queues) {
    if (how.report != nullptr) *how.report = {};
    return for_each_descendant(on, expand, judge, queues...);
}

// --- reductions, scans, sorts, selections ------------------------------------------------------------------------------

namespace detail {

template <class T, class Combine, class F>
struct fold_part {
    equal_parts parts;
    T init;
    Combine combine;
    F f;
    T* out;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t part) const {
        T sum = init;
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) sum = combine(sum, f(i));
        out[part] = sum;
    }
};
template <class T>
struct element_of {
    const T* values;
    ABUT_HD const T& operator()(std::size_t i) const { return values[i]; }
};

template <class T>
struct add_up_part {
    equal_parts parts;
    const T* values;
    T* sums;
    ABUT_HD void operator()(std::size_t part) const {
        T sum{};
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) sum = static_cast<T>(sum + values[i]);
        sums[part] = sum;
    }
};
template <class T>
struct scan_part {
    equal_parts parts;
    const T* before;  ///< sums of the parts before each; null if there is one part
    T* values;
    ABUT_HD void operator()(std::size_t part) const {
        T sum = before == nullptr ? T{} : before[part];
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
            const T value = values[i];
            values[i] = sum;
            sum = static_cast<T>(sum + value);
        }
        if (part + 1 == parts.count) values[parts.n] = sum;
    }
};

/// What a part keeps goes where the part begins.
template <class Test, class Index>
struct keep_of_part {
    equal_parts parts;
    Test test;
    Index* out;
    std::size_t* counts;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t part) const {
        Index* const to = out + parts.begin(part);
        std::size_t kept = 0;
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
            if (test(i)) to[kept++] = static_cast<Index>(i);
        }
        counts[part] = kept;
    }
};
template <class Index>
struct close_gaps {
    equal_parts parts;
    const Index* kept;
    const std::size_t* first;
    Index* out;
    ABUT_HD void operator()(std::size_t part) const {
        const Index* const from = kept + parts.begin(part);
        for (std::size_t i = first[part]; i < first[part + 1]; ++i) out[i] = from[i - first[part]];
    }
};

}  // namespace detail

template <class Policy, class T, class Combine, class F>
void reduce_into(const Policy& on, std::size_t n, T* out, T init, const Combine& combine, const F& f) {
    static_assert(combiner<Combine, T>, "abut: reduce: the functor that combines is no combiner (execution/roles.hpp)");
    static_assert(index_value<F, T>, "abut: reduce: the functor of values is no index_value (execution/roles.hpp)");
    if constexpr (combiner<Combine, T> && index_value<F, T>) {
        const auto parts = detail::parts_for(on, n);
        if (parts.count == 1) {
            for_each_task(on, 1, detail::fold_part<T, Combine, F>{parts, init, combine, f, out});
        } else {
            buffer_of<Policy, T> sums(on, parts.count);
            const detail::element_of<T> sum{sums.data()};
            for_each_task(on, parts.count, detail::fold_part<T, Combine, F>{parts, init, combine, f, sums.data()});
            for_each_task(on, 1,
                          detail::fold_part<T, Combine, detail::element_of<T>>{{parts.count, 1}, init, combine, sum, out});
        }
    }
}

template <class Policy, class T, class Combine, class F>
T reduce(const Policy& on, std::size_t n, T init, const Combine& combine, const F& f) {
    buffer_of<Policy, T> out(on, 1);
    reduce_into(on, n, out.data(), init, combine, f);
    download(on, out.data(), 1, &init);
    return init;
}

template <class Policy, class T>
void exclusive_scan(const Policy& on, T* values, std::size_t n) {
    const auto parts = detail::parts_for(on, n);
    if (parts.count == 1) return for_each_task(on, 1, detail::scan_part<T>{parts, nullptr, values});
    buffer_of<Policy, T> sums(on, parts.count + 1);
    for_each_task(on, parts.count, detail::add_up_part<T>{parts, values, sums.data()});
    for_each_task(on, 1, detail::scan_part<T>{{parts.count, 1}, nullptr, sums.data()});
    for_each_task(on, parts.count, detail::scan_part<T>{parts, sums.data(), values});
}

template <class Policy, class Test, class Index>
std::size_t compact(const Policy& on, std::size_t n, const Test& test, Index* out) {
    static_assert(index_test<Test>, "abut: compact: the functor is no index_test (execution/roles.hpp)");
    if constexpr (index_test<Test>) {
        const auto parts = detail::parts_for(on, n);
        buffer_of<Policy, std::size_t> counts(on, parts.count + 1);
        const bool one = parts.count == 1;
        buffer_of<Policy, Index> kept(on, one ? 0 : n);
        for_each_task(on, parts.count,
                      detail::keep_of_part<Test, Index>{parts, test, one ? out : kept.data(), counts.data()});
        exclusive_scan(on, counts.data(), parts.count);
        if (!one) {
            for_each_task(on, parts.count, detail::close_gaps<Index>{parts, kept.data(), counts.data(), out});
        }
        std::size_t total = 0;
        download(on, counts.data() + parts.count, 1, &total);
        return total;
    }
    return 0;
}

template <class Policy, class Key, memory_space Space>
void sort_keys(const Policy& on, buffer<Key, Space>& keys, int bits) {
    radix_sort(on, keys, static_cast<buffer<unsigned char, Space>*>(nullptr), bits);
}

template <class Policy, class Key, class Value, memory_space Space>
void sort_by_key(const Policy& on, buffer<Key, Space>& keys, buffer<Value, Space>& values, int bits) {
    radix_sort(on, keys, &values, bits);
}

}  // namespace abut::execution

namespace abut {
using execution::release_memory;
using execution::synchronize;
}  // namespace abut
