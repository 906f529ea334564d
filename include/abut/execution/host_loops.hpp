// SPDX-License-Identifier: MIT
#pragma once

// Loops of threads over ranges, with what they gather and what they leave open: of these the verbs of execution/host.hpp are
// made.

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/execution/parallel.hpp>
#include <abut/execution/roles.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

namespace detail {

/// Indices of a range, where n are looped over. There are many ranges for each thread, since some take longer than others;
/// but not more than that, since all threads write to what they share where a range ends. Few indices are one range.
template <class Policy>
std::size_t grain_of(const Policy& on, std::size_t n) {
    constexpr std::size_t few = 1024, for_each_thread = 16, least = 256, most = 4096;
    if (n <= few) return few;
    return std::clamp(n / for_each_thread / static_cast<std::size_t>(concurrency(on)), least, most);
}

}  // namespace detail

template <range_policy Policy, class F>
void for_each_index(const Policy& on, std::size_t n, const F& f) {
    static_assert(index_functor<F>, "abut: for_each_index: the functor is no index_functor (execution/roles.hpp)");
    if constexpr (index_functor<F>) {
        for_each_range(on, n, detail::grain_of(on, n), [&](int, std::size_t begin, std::size_t end) {
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

/// The sinks of the threads that loops take. `each` runs loop(begin, end, over, sinks...) over ranges of [0, n), where over()
/// says that there is no need to go on: a sink says so, or another thread's functor has thrown. `merge` hands the sinks'
/// content to the queues.
template <class... Queues>
class thread_sinks {
public:
    thread_sinks(int threads, Queues&... queues) : queues_(queues...) {
        all_.reserve(static_cast<std::size_t>(threads));
        for (int t = 0; t < threads; ++t) all_.emplace_back(queues.make_sink()...);
    }

    template <class Policy, class Loop>
    void each(const Policy& on, std::size_t n, std::size_t grain, const Loop& loop) {
        failure_flag failed;
        for_each_range(on, n, grain, part<Loop>{*this, loop, failed});
    }
    /// Whether what the calling thread has found says that there is no need to go on.
    [[nodiscard]] bool is_over() const {
        return std::apply([](const auto&... sink) { return execution::is_over(sink...); }, all_.front());
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
                    const auto over = [&] { return failed.raised() || execution::is_over(sink...); };
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

    std::tuple<Queues&...> queues_;
    std::vector<sinks> all_;
};

/// Runs loop(begin, end, over, sinks...) over ranges of [0, n), and hands what is gathered to the queues.
template <class Policy, class Loop, class... Queues>
void gather(const Policy& on, std::size_t n, std::size_t grain, const Loop& loop, Queues&... queues) {
    thread_sinks<Queues...> sinks(n <= grain ? 1 : concurrency(on), queues...);
    sinks.each(on, n, grain, loop);
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
    static constexpr std::size_t most = (is_eager<Sinks> || ...) ? 1 : 256;
    std::size_t count_ = 0;
    Candidate values_[most];
};

}  // namespace detail

}  // namespace abut::execution
