// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `serial` and `openmp`: depth first, of the calling thread alone to begin with. What is left where
// that takes longer makes a list, from which threads fetch; each goes depth first.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/execution/host_loops.hpp>

namespace abut::execution {

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

/// Items that a turn takes at most. An early end is worth more than many items whose fetches do not wait for each other; but
/// the longer it does not come, the more items are taken at a time.
template <class Expand, bool AnyWillDo>
struct descent_width {
    static constexpr std::size_t most = descent<Expand>::most_width, first = 4, turns_of_a_width = 16;
    std::size_t turns = 0;
    std::size_t next() { return AnyWillDo ? std::min(first + turns++ / turns_of_a_width, most) : most; }
};

/// Takes the newest items, `limit` of those from `first` on or as many as there is room for, and expands them. Returns how
/// many.
template <class Expand>
ABUT_INLINE std::size_t expand_newest(const Expand& step, descent<Expand>& mine, std::size_t first, std::size_t limit) {
    typename Expand::item now[descent<Expand>::most_width];
    const std::size_t held = mine.count - first, width = mine.count > mine.many ? 1 : held < limit ? held : limit;
    for (std::size_t k = 0; k < width; ++k) {
        now[k] = mine.items[--mine.count];
        step.prefetch(now[k]);
    }
    for (std::size_t k = 0; k < width; ++k) step(now[k], mine);
    return width;
}

/// Level by level until there are `enough` items for threads to share.
template <class Expand>
void open_levels(const Expand& expand, std::size_t enough, next_level<Expand>& start) {
    while (!start.items.empty() && start.items.size() < enough) {
        const auto level = std::exchange(start.items, {});
        for (const auto& at : level) expand(at, start);
    }
}

/// Judges what was found on the first levels, then goes depth first from each of their items; or, of the thread that begins
/// alone, from all seeds.
template <class Expand, class Judge, bool AnyWillDo>
struct descent_loop {
    const Expand& expand;
    const Judge& judge;
    next_level<Expand>& start;
    /// Of who begins alone: items that it opens and candidates that it judges before it leaves other items, and seeds, in
    /// `start`. 0 for a share of all.
    std::size_t most_alone = 0;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        const Expand step = expand;
        const std::size_t early = start.candidates.size();
        open_candidates<typename Expand::candidate, Sinks...> open;
        constexpr std::size_t at_a_time = AnyWillDo ? 1 : descent<Expand>::at_a_time;
        descent_width<Expand, AnyWillDo> width;
        std::size_t left = most_alone > 0 ? most_alone : static_cast<std::size_t>(-1);
        for (std::size_t i = begin; i < end && !over(); ++i) {
            if (i < early) {
                judge_all<true>(&start.candidates[i], 1, judge, open, sinks...);
                continue;
            }
            if (left == 0) {
                append(start.items, step.seed(i));
                continue;
            }
            descent<Expand> mine;
            mine.items[mine.count++] = most_alone > 0 ? step.seed(i) : start.items[i - early];
            while (mine.count > 0 && left > 0) {
                const std::size_t opened = expand_newest(step, mine, 0, width.next());
                left -= std::min(opened, left);
                if (mine.found >= at_a_time || mine.count == 0 || left == 0) {
                    judge_all<AnyWillDo>(mine.candidates, mine.found, judge, open, sinks...);
                    left -= std::min(mine.found, left);
                    mine.found = 0;
                }
                if (over()) return;
            }
            for (std::size_t k = 0; k < mine.count; ++k) append(start.items, mine.items[k]);
        }
        open.finish(judge, sinks...);
    }
};

}  // namespace detail

/// The calling thread begins alone. What is done soon costs no more than on one thread; what is not is shared out.
template <range_policy Policy, expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const Policy& on, const Expand& expand, const Judge& judge, Queues&... queues) {
    // Who only wants to know whether there is one starts soon, and so does who is spared work by the first.
    constexpr bool any_will_do = (is_eager<sink_of<Queues>> || ...);
    constexpr std::size_t break_even = 1024;  // items and candidates: some 50 us
    const auto threads = static_cast<std::size_t>(concurrency(on));
    const std::size_t grain = any_will_do ? 1 : 4, seeds = expand.seeds();
    detail::next_level<Expand> start;
    detail::thread_sinks<Queues...> sinks(static_cast<int>(threads), queues...);
    detail::descent_loop<Expand, Judge, any_will_do> loop{expand, judge, start,
                                                          threads == 1 ? static_cast<std::size_t>(-1) : break_even};
    sinks.each(serial{}, seeds, seeds, loop);
    if (!start.items.empty() && !sinks.is_over()) {
        loop.most_alone = 0;
        detail::open_levels(expand, (any_will_do ? 4 : 128) * threads, start);
        sinks.each(on, start.candidates.size() + start.items.size(), grain, loop);
    }
    sinks.merge(on);
    return 0;
}

}  // namespace abut::execution
