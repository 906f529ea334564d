// SPDX-License-Identifier: MIT
#pragma once

// The two parallel loops of the host policies; all their verbs are made of these.

#include <algorithm>
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

/// Cuts [0, n) into one contiguous part for each thread and calls f(part, begin, end), also for empty parts. The first
/// exception thrown is thrown again after all threads are done.
template <class F>
void for_each_part(int threads, std::size_t n, const F& f) {
    if (threads <= 1) return f(0, std::size_t{0}, n);
#if defined(_OPENMP)
    std::exception_ptr failure;
    const auto parts = static_cast<std::size_t>(threads);
#pragma omp parallel for num_threads(threads) schedule(static, 1) shared(failure)
    for (int part = 0; part < threads; ++part) {
        try {
            const auto p = static_cast<std::size_t>(part);
            f(part, n / parts * p + std::min(p, n % parts), n / parts * (p + 1) + std::min(p + 1, n % parts));
        } catch (...) {
#pragma omp critical(abut_failure)
            if (!failure) failure = std::current_exception();
        }
    }
    if (failure) std::rethrow_exception(failure);
#else
    // thread_count may come from a translation unit with OpenMP.
    const auto parts = static_cast<std::size_t>(threads);
    for (std::size_t p = 0; p < parts; ++p) {
        f(static_cast<int>(p), n / parts * p + std::min(p, n % parts), n / parts * (p + 1) + std::min(p + 1, n % parts));
    }
#endif
}

/// Calls f(thread, begin, end) on ranges of at most `grain` indices that idle threads fetch: for work of uneven cost.
template <class F>
void for_each_range(int threads, std::size_t n, std::size_t grain, const F& f) {
    if (threads <= 1 || n <= grain) {
        if (n > 0) f(0, std::size_t{0}, n);
        return;
    }
#if defined(_OPENMP)
    std::exception_ptr failure;
    const std::size_t ranges = (n + grain - 1) / grain;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1) shared(failure)
    for (std::size_t range = 0; range < ranges; ++range) {
        try {
            f(omp_get_thread_num(), range * grain, std::min(n, (range + 1) * grain));
        } catch (...) {
#pragma omp critical(abut_failure)
            if (!failure) failure = std::current_exception();
        }
    }
    if (failure) std::rethrow_exception(failure);
#else
    f(0, std::size_t{0}, n);
#endif
}

}  // namespace abut::execution
