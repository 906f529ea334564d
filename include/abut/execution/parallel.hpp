// SPDX-License-Identifier: MIT
#pragma once

// Ranges of indices on threads: the one loop of `serial` and `openmp`, of which all their verbs are made.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

#if defined(_OPENMP)
#include <omp.h>
#endif

#include <abut/execution/policy.hpp>

namespace abut::execution {

inline int concurrency(const serial&) { return 1; }
/// More threads than a few for each processor gain nothing, and a runtime that cannot start as many as it is told to ends
/// the program. Within a parallel region there is one, unless the runtime nests regions.
inline int concurrency([[maybe_unused]] const openmp& on) {
#if defined(_OPENMP)
    if (omp_get_active_level() >= omp_get_max_active_levels()) return 1;
    constexpr int for_each_processor = 8;
    static const int processors = omp_get_num_procs();  // a call of the system, each time
    const int wanted = on.threads > 0 ? on.threads : omp_get_max_threads();
    return std::max(1, std::min({wanted, for_each_processor * processors, omp_get_thread_limit()}));
#else
    return 1;
#endif
}

namespace detail {

/// Threads for n indices in ranges of `grain`: one where there is one range, and else all, though some find nothing to do.
/// GNU's runtime ends threads that a smaller team leaves over, and starts others for the next one, which takes 10 to 30 us
/// each.
template <class Policy>
int range_threads(const Policy& on, std::size_t n, std::size_t grain) {
    return n <= grain ? 1 : concurrency(on);
}

/// Told when a functor has thrown: then no more work begins.
class failure_flag {
public:
    void raise() { raised_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool raised() const { return raised_.load(std::memory_order_relaxed); }

private:
    std::atomic<bool> raised_{false};
};

}  // namespace detail

/// On the calling thread there is one range.
template <class F>
void for_each_range(const serial&, std::size_t n, std::size_t, const F& f) {
    if (n > 0) f(0, std::size_t{0}, n);
}

namespace detail {

/// A functor of ranges, whatever its type, so that the loop below is compiled once. It refers to the functor.
class range_call {
public:
    template <class F>
    explicit range_call(const F& f)
        : functor_(&f), call_([](const void* functor, int thread, std::size_t begin, std::size_t end) {
              (*static_cast<const F*>(functor))(thread, begin, end);
          }) {}
    void operator()(int thread, std::size_t begin, std::size_t end) const { call_(functor_, thread, begin, end); }

private:
    const void* functor_;
    void (*call_)(const void*, int, std::size_t, std::size_t);
};

/// What a thread's loops have lost by waiting for threads that had no processor. A parallel region ends when its last thread
/// has come, though all work be done: on a busy machine that takes a turn of the scheduler, some milliseconds, in each loop.
/// So the thread that calls works alone until it has done `times` as much as was lost, and only then asks for others again.
struct lost_time {
    static constexpr double least = 1e-4;     ///< seconds; regions on quiet processors lose less
    static constexpr double most_owed = 0.1;  ///< also where the process has been stopped for hours
    static constexpr double most_times = 16;
    double owed = 0;   ///< seconds of work
    double times = 1;  ///< the more, the more regions in a row have lost

    /// What a region has lost, in seconds; negative if it has gained.
    void settle(double lost) {
        if (lost > least) {
            owed = std::min(times * lost, most_owed);
            times = std::min(2 * times, most_times);
        } else {
            times = std::max(times / 2, 1.0);
        }
    }
};

/// Of the calling thread.
inline lost_time& lost_time_of_thread() {
    thread_local lost_time lost;
    return lost;
}

[[gnu::noinline]] inline void for_each_range_on(int threads, std::size_t n, std::size_t grain, const range_call& f) {
    if (threads == 1) return for_each_range(serial{}, n, grain, f);
#if defined(_OPENMP)
    const std::size_t ranges = n / grain + (n % grain != 0);
    const auto call = [&](int thread, std::size_t range) {
        f(thread, range * grain, range * grain + std::min(grain, n - range * grain));
    };
    lost_time& lost = lost_time_of_thread();
    std::size_t first = 0;
    double begun = omp_get_wtime();
    for (; first < ranges && lost.owed > 0; ++first) {
        call(0, first);
        const double now = omp_get_wtime();
        lost.owed -= now - begun;
        begun = now;
    }
    if (first == ranges) return;

    std::exception_ptr failure;
    failure_flag failed;
    double work = 0;  // seconds of all threads
#pragma omp parallel num_threads(threads) shared(failure, failed) reduction(+ : work)
    {
        const double from = omp_get_wtime();
#pragma omp for schedule(dynamic, 1) nowait
        for (std::size_t range = first; range < ranges; ++range) {
            if (failed.raised()) continue;
            try {
                call(omp_get_thread_num(), range);
            } catch (...) {
                failed.raise();
#pragma omp critical(abut_failure)
                if (!failure) failure = std::current_exception();
            }
        }
        work += omp_get_wtime() - from;
    }
    lost.settle(omp_get_wtime() - begun - work);
    if (failure) std::rethrow_exception(failure);
#else
    for_each_range(serial{}, n, grain, f);  // concurrency may come from a translation unit with OpenMP
#endif
}

}  // namespace detail

/// Calls f(thread, begin, end) on ranges of `grain` indices that idle threads fetch; on the calling thread alone there is
/// one range. On a busy machine the calling thread may take the first ranges, or all, before it asks for others. The first
/// exception thrown is thrown again when all threads are done. None of them begins another range then.
template <class F>
void for_each_range(const openmp& on, std::size_t n, std::size_t grain, const F& f) {
    detail::for_each_range_on(detail::range_threads(on, n, grain), n, grain, detail::range_call(f));
}

/// A policy in host memory whose loops are made of ranges on threads (execution/host.hpp): `serial`, `openmp`, and another
/// that supplies concurrency(on) and for_each_range(on, n, grain, f) as openmp does. That calls f(thread, begin, end) for
/// ranges of `grain` indices or more. No two calls at a time have the same `thread`, which is below concurrency(on), and 0
/// where n <= grain. It returns when all calls have, and throws again what one of them has thrown.
template <class P>
concept range_policy = host_policy<P> && requires(const P& on, void (*f)(int, std::size_t, std::size_t)) {
    for_each_range(on, std::size_t{}, std::size_t{}, f);
};

}  // namespace abut::execution
