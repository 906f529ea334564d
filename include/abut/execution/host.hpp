// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `serial` and `openmp` (execution/policy.hpp lists them), one implementation for both and for any
// range_policy. What is not here is in execution/generic.hpp.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/generic.hpp>
#include <abut/execution/parallel.hpp>
#include <abut/execution/roles.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

inline constexpr std::size_t range_grain = 1024, descent_grain = 32;

template <range_policy Policy, class F>
void for_each_index(const Policy& on, std::size_t n, const F& f) {
    static_assert(index_functor<F>, "abut: for_each_index: the functor is no index_functor (execution/roles.hpp)");
    if constexpr (index_functor<F>) {
        for_each_range(on, n, range_grain, [&](int, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) f(i);
        });
    }
}

template <range_policy Policy, class F>
void for_each_task(const Policy& on, std::size_t n, const F& f) {
    for_each_range(on, n, 1, [&](int, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) f(i);
    });
}

namespace detail {

/// The sinks of the threads that a loop over [0, n) takes. `each` runs loop(begin, end, over, sinks...) over ranges of it,
/// where over() says that there is no need to go on: a sink says so, or another thread's functor has thrown. `merge`
/// hands the sinks' content to the queues.
template <class... Queues>
class thread_sinks {
public:
    thread_sinks(int threads, std::size_t n, std::size_t grain, Queues&... queues)
        : n_(n), grain_(grain), queues_(queues...) {
        all_.reserve(static_cast<std::size_t>(threads));
        for (int t = 0; t < threads; ++t) all_.emplace_back(queues.make_sink()...);
    }

    template <class Policy, class Loop>
    void each(const Policy& on, const Loop& loop) {
        failure_flag failed;
        for_each_range(on, n_, grain_, part<Loop>{*this, loop, failed});
    }

    template <class Policy>
    void merge(const Policy& on) {
        [&]<std::size_t... K>(std::index_sequence<K...>) { (merge_one<K>(on), ...); }
        (std::index_sequence_for<Queues...>{});
    }

private:
    using sinks = std::tuple<sink_of<Queues>...>;

    /// A range of a loop. No part of its type is the policy's: where two policies run one loop, it is compiled once.
    template <class Loop>
    struct part {
        thread_sinks& all;
        const Loop& loop;
        failure_flag& failed;

        void operator()(int thread, std::size_t begin, std::size_t end) const {
            sinks& kept = all.all_[static_cast<std::size_t>(thread)];
            sinks mine = std::move(kept);
            try {
                const auto with_sinks = [&](auto&... sink) {
                    const auto over = [&] { return failed.raised() || is_over(sink...); };
                    loop(begin, end, over, sink...);
                };
                std::apply(with_sinks, mine);
            } catch (...) {
                failed.raise();
                throw;
            }
            kept = std::move(mine);
        }
    };

    template <std::size_t K, class Policy>
    void merge_one(const Policy& on) {
        std::vector<std::tuple_element_t<K, sinks>*> locals;
        for (sinks& s : all_) locals.push_back(&std::get<K>(s));
        std::get<K>(queues_).merge(on, locals);
    }

    std::size_t n_, grain_;
    std::tuple<Queues&...> queues_;
    std::vector<sinks> all_;
};

/// Runs loop(begin, end, over, sinks...) over ranges of [0, n), and hands what is gathered to the queues.
template <class Policy, class Loop, class... Queues>
void gather(const Policy& on, std::size_t n, std::size_t grain, const Loop& loop, Queues&... queues) {
    thread_sinks<Queues...> sinks(n <= grain ? 1 : concurrency(on), n, grain, queues...);
    sinks.each(on, loop);
    sinks.merge(on);
}

/// Finishes what a judge left open. It changes no candidate; they are not const because g++ 12 warns of a const array that
/// nothing was written to, which is so where a judge leaves nothing open.
template <class Judge, class Candidate, class... Sinks>
[[gnu::noinline, gnu::cold]] void finish_all(const Judge& judge, Candidate* open, std::size_t n, Sinks&... sinks) {
    for (std::size_t k = 0; k < n && !is_over(sinks...); ++k) judge.finish(open[k], sinks...);
}

/// What a thread's judge leaves open. It waits for a while, so that the code that finishes it stays out of the loop that
/// finds candidates: called from there, it made the loop half as long again. Where one hit will do, nothing waits.
template <class Candidate, class... Sinks>
class open_candidates {
public:
    template <class Judge>
    void add(const Candidate& c, const Judge& judge, Sinks&... sinks) {
        values_[count_++] = c;
        if (count_ == most) finish(judge, sinks...);
    }
    template <class Judge>
    void finish(const Judge& judge, Sinks&... sinks) {
        const std::size_t n = std::exchange(count_, 0);
        if (n > 0) finish_all(judge, values_, n, sinks...);
    }

private:
    static constexpr std::size_t most = (is_flag<Sinks> || ...) ? 1 : 256;
    std::size_t count_ = 0;
    Candidate values_[most];
};

}  // namespace detail

template <range_policy Policy, class F, class Queue, class... Queues>
void for_each_index(const Policy& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    constexpr bool plays = index_functor<F, sink_of<Queue>, sink_of<Queues>...>;
    static_assert(plays, "abut: for_each_index: the functor is no index_functor for these queues (execution/roles.hpp)");
    if constexpr (plays) {
        const auto loop = [&](std::size_t begin, std::size_t end, const auto& over, auto&... sinks) {
            for (std::size_t i = begin; i < end && !over(); ++i) f(i, sinks...);
        };
        detail::gather(on, n, range_grain, loop, queue, queues...);
    }
}

namespace detail {

// The loops over candidates, which are no part of a policy's functions for the same reason.

template <class Walk, class Judge>
struct candidate_loop {
    const Walk& walk;
    const Judge& judge;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        using candidate = typename Walk::candidate;
        open_candidates<candidate, Sinks...> open;
        const push_at_once emitter{[&](const candidate& c) {
            if (!judge(c, sinks...)) open.add(c, judge, sinks...);
        }};
        for (std::size_t i = begin; i < end && !over(); ++i) {
            if (!walk.may_find(i)) continue;
            typename Walk::cursor at;
            walk(i, at, emitter, sinks...);
        }
        open.finish(judge, sinks...);
    }
};

}  // namespace detail

template <range_policy Policy, class Walk, class Judge, class... Queues>
    requires candidate_walk<Walk, sink_of<Queues>...> && candidate_judge<Judge, typename Walk::candidate, sink_of<Queues>...>
std::uint64_t for_each_candidate(const Policy& on, std::size_t n, const Walk& walk, const Judge& judge, Queues&... queues) {
    detail::gather(on, n, range_grain, detail::candidate_loop<Walk, Judge>{walk, judge}, queues...);
    return 0;
}

namespace detail {

/// One function for all walks: the code that enlarges a vector stands in it once, and not once for each child of a node.
template <class T>
[[gnu::noinline]] void append(std::vector<T>& values, const T& value) {
    values.push_back(value);
}

/// What the items of a level make.
template <class Expand>
struct next_level {
    std::vector<typename Expand::item> items;
    std::vector<typename Expand::candidate> candidates;
    template <class Number>
    void add(Number, bool is, const typename Expand::item& value) {
        if (is) append(items, value);
    }
    template <class Number>
    void push(Number, bool is, const typename Expand::candidate& value) {
        if (is) append(candidates, value);
    }
};

/// What waits in a descent from one item, in arrays of the size that it may need (39 KiB of stack for two binary trees, 54
/// for two of four children a node, half as much again for lists of pairs): adding is free of branches, and g++ keeps the
/// counts in registers.
template <class Expand>
struct descent {
    static constexpr std::size_t at_a_time = 256;  ///< candidates that wait to be decided
    static constexpr std::size_t most_width = 32, most = Expand::most_children, one_deep = Expand::most_depth * (most - 1);
    /// With more items than these, one is taken at a time: what it leaves on its way down has room above those of the last
    /// turn with more.
    static constexpr std::size_t many = 4096;
    typename Expand::item items[many + most_width * (most - 1) + one_deep + most];
    typename Expand::candidate candidates[at_a_time + most_width * most];
    std::size_t count = 0, found = 0;

    template <class Number>
    void add(Number, bool is, const typename Expand::item& value) {
        items[count] = value;
        count += is;
    }
    template <class Number>
    void push(Number, bool is, const typename Expand::candidate& value) {
        candidates[found] = value;
        found += is;
    }
};

/// Judges n candidates one after another. What a candidate refers to is asked for in two steps before its turn, since the
/// second of them has to read what the first one asks for.
template <bool AtOnce, class Candidate, class Judge, class Open, class... Sinks>
void judge_all(const Candidate* candidates, std::size_t n, const Judge& judge, Open& open, Sinks&... sinks) {
    constexpr bool hints = !AtOnce && requires { judge.prefetch(candidates[0], 0); };
    constexpr std::size_t ahead = hints ? 8 : 0;
    for (std::size_t k = 0; k < n + 2 * ahead; ++k) {
        if constexpr (hints) {
            if (k < n) judge.prefetch(candidates[k], 0);
            if (k >= ahead && k < n + ahead) judge.prefetch(candidates[k - ahead], 1);
            if (k < 2 * ahead) continue;
        }
        const Candidate& c = candidates[k - 2 * ahead];
        if (!judge(c, sinks...)) open.add(c, judge, sinks...);
    }
}

/// Level by level until there are `enough` items for threads to share.
template <class Expand>
next_level<Expand> first_levels(const Expand& expand, std::size_t enough) {
    next_level<Expand> start;
    for (std::size_t i = 0; i < expand.seeds(); ++i) append(start.items, expand.seed(i));
    while (!start.items.empty() && start.items.size() < enough) {
        const auto level = std::exchange(start.items, {});
        for (const auto& at : level) expand(at, start);
    }
    return start;
}

/// Judges what was found on the first levels, then goes depth first from each of their items.
template <class Expand, class Judge, bool AnyWillDo>
struct descent_loop {
    const Expand& expand;
    const Judge& judge;
    next_level<Expand>& start;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        const Expand step = expand;
        const std::size_t early = start.candidates.size();
        open_candidates<typename Expand::candidate, Sinks...> open;
        // An early end is worth more than a long run of decisions, and than many items whose fetches do not wait for each
        // other; but the longer it does not come, the more items are taken at a time.
        constexpr std::size_t at_a_time = AnyWillDo ? 1 : descent<Expand>::at_a_time;
        constexpr std::size_t most_width = descent<Expand>::most_width, first_width = 4, turns_of_a_width = 16;
        std::size_t turns = 0;
        for (std::size_t i = begin; i < end && !over(); ++i) {
            if (i < early) {
                judge_all<true>(&start.candidates[i], 1, judge, open, sinks...);
                continue;
            }
            descent<Expand> mine;
            mine.items[mine.count++] = start.items[i - early];
            while (mine.count > 0) {
                typename Expand::item now[most_width];
                const std::size_t limit =
                    AnyWillDo ? std::min(first_width + turns++ / turns_of_a_width, most_width) : most_width;
                const std::size_t width = mine.count < limit ? mine.count : mine.count > mine.many ? 1 : limit;
                for (std::size_t k = 0; k < width; ++k) {
                    now[k] = mine.items[--mine.count];
                    step.prefetch(now[k]);
                }
                for (std::size_t k = 0; k < width; ++k) step(now[k], mine);
                if (mine.found >= at_a_time || mine.count == 0) {
                    judge_all<AnyWillDo>(mine.candidates, mine.found, judge, open, sinks...);
                    mine.found = 0;
                }
                if (over()) return;
            }
        }
        open.finish(judge, sinks...);
    }
};

template <class Tile>
struct tile_loop {
    std::size_t m;
    const Tile& tile;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        constexpr std::size_t columns = 256;
        typename Tile::column staged[columns];
        open_candidates<typename Tile::candidate, Sinks...> open;
        for (std::size_t first = 0; first < m; first += columns) {
            const std::size_t width = std::min(columns, m - first);
            for (std::size_t j = 0; j < width; ++j) staged[j] = tile.load_column(first + j);
            for (std::size_t i = begin; i < end && !over(); ++i) {
                const auto row = tile.load_row(i);
                auto reach = tile.reach_of(row);
                for (std::size_t j = 0; j < width; ++j) {
                    if (!tile.passes(reach, staged[j]) || tile(row, i, staged[j], first + j, sinks...)) continue;
                    open.add(tile.candidate_of(i, first + j), tile, sinks...);
                }
            }
        }
        open.finish(tile, sinks...);
    }
};

}  // namespace detail

template <range_policy Policy, expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const Policy& on, const Expand& expand, const Judge& judge, Queues&... queues) {
    // Who only wants to know whether there is one starts soon.
    constexpr bool any_will_do = (is_flag<sink_of<Queues>> || ...);
    const std::size_t threads = static_cast<std::size_t>(concurrency(on));
    const std::size_t enough = threads == 1 ? 1 : any_will_do ? 4 * threads : 4096;
    auto start = detail::first_levels(expand, enough);
    const std::size_t n = start.candidates.size() + start.items.size();
    const detail::descent_loop<Expand, Judge, any_will_do> loop{expand, judge, start};
    detail::gather(on, n, any_will_do ? 1 : descent_grain, loop, queues...);
    return 0;
}

template <range_policy Policy, class Tile, class... Queues>
    requires tile_functor<Tile, sink_of<Queues>...>
std::uint64_t for_each_tiled(const Policy& on, std::size_t n, std::size_t m, const Tile& tile, Queues&... queues) {
    constexpr std::size_t pairs_of_a_thread = 16384;
    const std::size_t grain = std::max<std::size_t>(pairs_of_a_thread / (m + 1), 64);
    detail::gather(on, n, grain, detail::tile_loop<Tile>{m, tile}, queues...);
    return 0;
}

}  // namespace abut::execution
