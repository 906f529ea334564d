// SPDX-License-Identifier: MIT
#pragma once

// The verbs of `serial` and `openmp` (execution/policy.hpp lists them), one implementation for both.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/parallel.hpp>
#include <abut/execution/radix_sort.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::execution {

inline constexpr std::size_t range_grain = 1024;

template <host_policy Policy, class F>
void for_each_index(const Policy& on, std::size_t n, const F& f) {
    for_each_range(thread_count(on), n, range_grain, [&](int, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) f(i);
    });
}

namespace detail {

/// Gives each thread its own sinks, runs `loop(thread, begin, end, sinks...)` over [0, n), and merges the sinks.
template <class Policy, class Loop, class... Queues>
void gather(const Policy& on, std::size_t n, std::size_t grain, const Loop& loop, Queues&... queues) {
    const int threads = n <= grain ? 1 : thread_count(on);
    using sinks = std::tuple<typename Queues::local...>;
    std::vector<sinks> all;
    all.reserve(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t) all.emplace_back(queues.make_local()...);
    for_each_range(threads, n, grain, [&](int thread, std::size_t begin, std::size_t end) {
        sinks mine = std::move(all[static_cast<std::size_t>(thread)]);
        std::apply([&](auto&... sink) { loop(begin, end, sink...); }, mine);
        all[static_cast<std::size_t>(thread)] = std::move(mine);
    });
    const auto merge = [&]<std::size_t... K>(std::index_sequence<K...>) {
        const auto merge_one = [&]<std::size_t I>(auto& queue, std::integral_constant<std::size_t, I>) {
            std::vector<std::remove_reference_t<decltype(std::get<I>(all[0]))>*> locals;
            for (sinks& s : all) locals.push_back(&std::get<I>(s));
            queue.merge(on, locals);
        };
        (merge_one(queues, std::integral_constant<std::size_t, K>{}), ...);
    };
    merge(std::index_sequence_for<Queues...>{});
}

/// On the host a candidate is decided where it is found.
template <class Decide>
struct decide_at_once {
    Decide decide;
    ABUT_CALLS_ANY
    template <class Candidate>
    ABUT_HD void push(const Candidate& candidate) const {
        decide(candidate);
    }
};
template <class Decide>
decide_at_once(Decide) -> decide_at_once<Decide>;

}  // namespace detail

template <host_policy Policy, class F, class Queue, class... Queues>
void for_each_index(const Policy& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    const auto loop = [&](std::size_t begin, std::size_t end, auto&... sinks) {
        for (std::size_t i = begin; i < end && !is_over(sinks...); ++i) f(i, sinks...);
    };
    detail::gather(on, n, range_grain, loop, queue, queues...);
}

template <host_policy Policy, class Test, class Walk, class Decide, class... Queues>
void for_each_candidate(const Policy& on, std::size_t n, const Test& test, const Walk& walk, const Decide& decide,
                        Queues&... queues) {
    const auto loop = [&](std::size_t begin, std::size_t end, auto& late, auto&... sinks) {
        const detail::decide_at_once emitter{[&](const typename Walk::candidate& c) { decide(c, late, sinks...); }};
        for (std::size_t i = begin; i < end; ++i) {
            if (test(i)) {
                walk(i, emitter, sinks...);
                if (is_over(sinks...)) return;
            }
        }
    };
    detail::gather(on, n, range_grain, loop, queues...);
}

template <host_policy Policy, class Tile, class... Queues>
void for_each_tiled(const Policy& on, std::size_t n, std::size_t m, const Tile& tile, Queues&... queues) {
    constexpr std::size_t rows = 64, columns = 256;
    detail::gather(
        on, n, rows,
        [&](std::size_t begin, std::size_t end, auto&... sinks) {
            typename Tile::column staged[columns];
            for (std::size_t first = 0; first < m; first += columns) {
                const std::size_t width = std::min(columns, m - first);
                for (std::size_t j = 0; j < width; ++j) staged[j] = tile.load_column(first + j);
                for (std::size_t i = begin; i < end && !is_over(sinks...); ++i) {
                    auto row = tile.load_row(i);
                    for (std::size_t j = 0; j < width; ++j) tile(row, i, staged[j], first + j, sinks...);
                }
            }
        },
        queues...);
}

template <host_policy Policy, class T, class Combine, class F>
T reduce(const Policy& on, std::size_t n, T init, const Combine& combine, const F& f) {
    const int threads = n <= range_grain ? 1 : thread_count(on);
    std::vector<T> partial(static_cast<std::size_t>(threads), init);
    for_each_part(threads, n, [&](int part, std::size_t begin, std::size_t end) {
        T mine = init;
        for (std::size_t i = begin; i < end; ++i) mine = combine(mine, f(i));
        partial[static_cast<std::size_t>(part)] = mine;
    });
    for (const T& p : partial) init = combine(init, p);
    return init;
}

template <host_policy Policy, class T, class Combine, class F>
void reduce_into(const Policy& on, std::size_t n, T* out, T init, const Combine& combine, const F& f) {
    *out = reduce(on, n, init, combine, f);
}

template <host_policy Policy, class T>
void exclusive_scan(const Policy&, T* values, std::size_t n) {
    T sum{};
    for (std::size_t i = 0; i < n; ++i) sum = static_cast<T>(sum + std::exchange(values[i], sum));
    values[n] = sum;
}

template <host_policy Policy, class Key>
void sort_keys(const Policy& on, buffer<Key, host_space>& keys, int bits) {
    radix_sort(on, keys, static_cast<buffer<unsigned char, host_space>*>(nullptr), bits);
}

template <host_policy Policy, class Key, class Value>
void sort_by_key(const Policy& on, buffer<Key, host_space>& keys, buffer<Value, host_space>& values, int bits) {
    radix_sort(on, keys, &values, bits);
}

template <host_policy Policy, class Test, class Index>
std::size_t compact(const Policy&, std::size_t n, const Test& test, Index* out) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (test(i)) out[kept++] = static_cast<Index>(i);
    }
    return kept;
}

template <host_policy Policy, class T>
void fill(const Policy& on, T* out, std::size_t n, const T& value) {
    for_each_index(on, n, [=](std::size_t i) { out[i] = value; });
}

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

template <host_policy Policy>
int device_of(const Policy&) {
    return -1;
}

template <host_policy Policy>
void synchronize(const Policy&) {}

/// Gives pooled memory back to the system; the host policies pool none.
template <host_policy Policy>
void release_memory(const Policy&) {}

}  // namespace abut::execution

namespace abut {
using execution::release_memory;
using execution::synchronize;
}
