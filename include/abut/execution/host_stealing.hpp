// SPDX-License-Identifier: MIT
#pragma once

// for_each_descendant of `openmp` by schedules (execution/schedule.hpp). Of these a host has two: the list of
// host_descent.hpp, and work stealing, which is here.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <thread>

#include <abut/execution/buffer.hpp>
#include <abut/execution/generic.hpp>
#include <abut/execution/host_descent.hpp>
#include <abut/execution/host_loops.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/execution/stealing.hpp>

namespace abut::execution {

namespace detail {

/// Workers that descend, each a range of one index. A worker keeps what it has in an array of its own, and puts the oldest
/// half of it into its deque whenever that is empty: who steals from there has more below it than of the newest. Who has
/// nothing takes that back, then seeds, then what another's deque has.
template <class Expand, class Judge, bool AnyWillDo>
struct stealing_loop {
    using item = typename Expand::item;
    /// Items that change hands at a time. With no more than `few` a worker keeps them.
    static constexpr std::uint32_t portion = 64, few = 2 * descent<Expand>::most_width;

    const Expand& expand;
    const Judge& judge;
    work_left& all;
    deque_words* words;  ///< of each worker
    item* items;         ///< `capacity` of each
    std::uint32_t capacity, workers, seeds;
    worker_counts& sum;

    template <class Over, class... Sinks>
    void operator()(std::size_t begin, std::size_t end, const Over& over, Sinks&... sinks) const {
        for (std::size_t i = begin; i < end && !over(); ++i) work(static_cast<std::uint32_t>(i), over, sinks...);
    }

private:
    /// What a worker has. Items before `first` are gone.
    struct worker {
        std::uint32_t me;
        deque_owner own;
        work_part part;
        worker_counts counts{};
        descent<Expand> mine{};
        std::size_t first = 0;
    };

    template <class Over, class... Sinks>
    void work(std::uint32_t me, const Over& over, Sinks&... sinks) const {
        constexpr std::size_t at_a_time = AnyWillDo ? 1 : descent<Expand>::at_a_time;
        const Expand step = expand;
        const std::uint32_t some = std::clamp(seeds / (4 * workers), 1u, portion);
        worker w{me, {words + me, capacity, 0, 0}, {&all, seeds, some, false, true}};
        open_candidates<typename Expand::candidate, Sinks...> open;
        descent_width<Expand, AnyWillDo> width;
        const auto judge_found = [&] {
            judge_all<AnyWillDo>(w.mine.candidates, w.mine.found, judge, open, sinks...);
            w.mine.found = 0;
        };
        while (!over()) {
            if (w.first == w.mine.count) {
                w.first = w.mine.count = 0;
                if (!take_own(w)) {
                    judge_found();
                    open.finish(judge, sinks...);
                    if (!steal_some(w, over)) break;
                }
            }
            w.counts.items += expand_newest(step, w.mine, w.first, width.next());
            ++w.counts.steps;
            if (w.mine.found >= at_a_time) judge_found();
            offer(w);
        }
        w.counts.time = w.counts.steps + w.counts.idle_time;
        w.counts.add_to(&sum);
    }

    /// From the worker's own deque, or seeds. Whether there are any.
    bool take_own(worker& w) const {
        const item_range range = w.own.take(portion);
        if (range.count > 0) {
            copy_in(w, w.me, range);
            return true;
        }
        const item_range some = w.part.take_seeds();
        for (std::uint32_t k = 0; k < some.count; ++k) w.mine.items[w.mine.count++] = expand.seed(some.first + k);
        return some.count > 0;
    }

    /// From another's deque, as soon as one has some. False if there is nothing left anywhere, or no need to go on.
    template <class Over>
    bool steal_some(worker& w, const Over& over) const {
        w.part.become_idle();
        for (std::uint32_t turn = 0; !over() && !w.part.is_all_done(); ++turn) {
            const std::uint32_t start = (w.me + 1 + turn * 7) % workers;
            for (std::uint32_t k = 0; k < workers; ++k) {
                const std::uint32_t victim = (start + k) % workers;
                if (victim == w.me || deque_size(words + victim) == 0) continue;
                w.part.become_busy();
                const item_range range = steal(words + victim, portion);
                if (range.count > 0) {
                    copy_in(w, victim, range);
                    give_back_places(words + victim, range.count);
                    ++w.counts.steals;
                    w.counts.stolen += range.count;
                    return true;
                }
                w.part.become_idle();
            }
            ++w.counts.failed_steals;
            ++w.counts.idle_time;
            std::this_thread::yield();
        }
        return false;
    }

    void copy_in(worker& w, std::uint32_t from, item_range range) const {
        const item* const at = items + std::size_t{from} * capacity + range.first;
        for (std::uint32_t k = 0; k < range.count; ++k) w.mine.items[w.mine.count++] = at[k];
    }

    void offer(worker& w) const {
        const std::size_t held = w.mine.count - w.first;
        if (held <= few || deque_size(w.own.words) > 0) return;
        const auto some = static_cast<std::uint32_t>(held / 2);
        if (w.own.room() < some) w.own.make_room();
        const std::uint32_t count = std::min(some, w.own.room());
        if (count < some) ++w.counts.overflows;
        if (count == 0) return;
        item* const to = items + std::size_t{w.me} * capacity + w.own.bottom;
        for (std::uint32_t k = 0; k < count; ++k) to[k] = w.mine.items[w.first + k];
        w.own.publish(count);
        w.first += count;
        ++w.counts.offers;
    }
};

}  // namespace detail

/// On one thread, and by schedules that a host has not, it is the list's.
template <range_policy Policy, schedule Schedule, expander Expand, class Judge, class... Queues>
    requires candidate_judge<Judge, typename Expand::candidate, sink_of<Queues>...>
std::uint64_t for_each_descendant(const Policy& on, const scheduled<Schedule>& how, const Expand& expand, const Judge& judge,
                                  Queues&... queues) {
    const auto workers = static_cast<std::uint32_t>(concurrency(on));
    if constexpr (Schedule == schedule::work_stealing) {
        if (workers > 1) {
            constexpr bool any_will_do = (is_eager<sink_of<Queues>> || ...);
            const auto seeds = static_cast<std::uint32_t>(expand.seeds());
            const std::uint32_t capacity = how.queue_capacity > 0 ? how.queue_capacity : 4096;
            detail::work_left all{seeds, 0};
            detail::worker_counts sum{};
            buffer<detail::deque_words, host_space> words(on, workers);
            buffer<typename Expand::item, host_space> items(on, std::size_t{workers} * capacity);
            std::fill_n(words.data(), workers, detail::deque_words{});
            const detail::stealing_loop<Expand, Judge, any_will_do> loop{
                expand, judge, all, words.data(), items.data(), capacity, workers, seeds, sum};
            detail::gather(on, workers, 1, loop, queues...);
            if (how.report != nullptr) *how.report = detail::report_of(Schedule, workers, sum);
            return 0;
        }
    }
    if (how.report != nullptr) *how.report = {.ran = schedule::shared_list, .workers = workers};
    return for_each_descendant(on, expand, judge, queues...);
}

}  // namespace abut::execution
