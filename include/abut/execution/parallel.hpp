// SPDX-License-Identifier: MIT
#pragma once

// The two parallel loops of the host policies; all their verbs are made of these.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>

#if defined(_OPENMP)
#include <omp.h>
#endif

#include <abut/execution/policy.hpp>

namespace abut::execution {

inline int thread_count(const serial&) { return 1; }
inline int thread_count([[maybe_unused]] const openmp& on) {
#if defined(_OPENMP)
    return on.threads > 0 ? on.threads : omp_get_max_threads();
#else
    return 1;
#endif
}

inline int thread_number() {
#if defined(_OPENMP)
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/// Keeps the first exception of many threads.
class first_failure {
public:
    template <class F>
    void catching(const F& f) noexcept {
        try {
            f();
        } catch (...) {
            if (!taken_.test_and_set()) failure_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::atomic_flag taken_;
    std::exception_ptr failure_;
};

// Without OpenMP the pragmas below are left out and the loops run on the calling thread, whatever `threads` says.

/// Cuts [0, n) into one contiguous part for each thread and calls f(part, begin, end), also for empty parts. The first
/// exception thrown is thrown again after all threads are done.
template <class F>
void for_each_part(int threads, std::size_t n, const F& f) {
    if (threads <= 1) return f(0, std::size_t{0}, n);
    first_failure failure;
    const auto parts = static_cast<std::size_t>(threads);
#if defined(_OPENMP)
#pragma omp parallel for num_threads(threads) schedule(static, 1)
#endif
    for (int part = 0; part < threads; ++part) {
        failure.catching([&] {
            const auto p = static_cast<std::size_t>(part);
            f(part, n / parts * p + std::min(p, n % parts), n / parts * (p + 1) + std::min(p + 1, n % parts));
        });
    }
    failure.rethrow();
}

/// Calls f(thread, begin, end) on ranges of at most `grain` indices that idle threads fetch: for work of uneven cost.
template <class F>
void for_each_range(int threads, std::size_t n, std::size_t grain, const F& f) {
    if (threads <= 1 || n <= grain) {
        if (n > 0) f(0, std::size_t{0}, n);
        return;
    }
    first_failure failure;
    const std::size_t ranges = (n + grain - 1) / grain;
#if defined(_OPENMP)
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
#endif
    for (std::size_t range = 0; range < ranges; ++range) {
        failure.catching([&] { f(thread_number(), range * grain, std::min(n, (range + 1) * grain)); });
    }
    failure.rethrow();
}

}  // namespace abut::execution
