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

inline constexpr std::size_t range_grain = 1024, late_grain = 64, descent_grain = 32;

template <host_policy Policy, class F>
void for_each_index(const Policy& on, std::size_t n, const F& f) {
    for_each_range(thread_count(on), n, range_grain, [&](int, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) f(i);
    });
}

namespace detail {

/// The sinks of the threads that a loop over [0, n) takes. `each` runs loop(begin, end, sinks...) over ranges of it; `merge`
/// hands the sinks' content to the queues.
template <class... Queues>
class thread_sinks {
public:
    template <class Policy>
    thread_sinks(const Policy& on, std::size_t n, std::size_t grain, Queues&... queues)
        : n_(n), grain_(grain), queues_(queues...) {
        const int threads = n <= grain ? 1 : thread_count(on);
        all_.reserve(static_cast<std::size_t>(threads));
        for (int t = 0; t < threads; ++t) all_.emplace_back(queues.make_local()...);
    }

    template <class Loop>
    void each(const Loop& loop) {
        for_each_range(static_cast<int>(all_.size()), n_, grain_, [&](int thread, std::size_t begin, std::size_t end) {
            sinks mine = std::move(all_[static_cast<std::size_t>(thread)]);
            std::apply([&](auto&... sink) { loop(begin, end, sink...); }, mine);
            all_[static_cast<std::size_t>(thread)] = std::move(mine);
        });
    }

    template <class Policy>
    void merge(const Policy& on) {
        [&]<std::size_t... K>(std::index_sequence<K...>) { (merge_one<K>(on), ...); }(std::index_sequence_for<Queues...>{});
    }

private:
    using sinks = std::tuple<typename Queues::local...>;

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

/// Runs loop(begin, end, late_sink, sinks...) over [0, n), then settle(c, sinks...) for all that it left in `late`.
template <class Policy, class Loop, class Settle, class Late, class... Queues>
void gather_and_settle(const Policy& on, std::size_t n, std::size_t grain, const Loop& loop, const Settle& settle,
                       Late& late, Queues&... queues) {
    thread_sinks<Late, Queues...> sinks(on, n, grain, late, queues...);
    sinks.each(loop);
    sinks.merge(on);
    if (late.size() == 0 || is_over(queues...)) return;
    const auto* const left = late.data();
    thread_sinks<Queues...> more(on, late.size(), late_grain, queues...);
    more.each([&](std::size_t begin, std::size_t end, auto&... sink) {
        for (std::size_t i = begin; i < end && !is_over(sink...); ++i) settle(left[i], sink...);
    });
    more.merge(on);
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
    detail::thread_sinks<Queue, Queues...> sinks(on, n, range_grain, queue, queues...);
    sinks.each(loop);
    sinks.merge(on);
}

namespace detail {

/// What is ready in a group.
struct ready_indices {
    unsigned places[group_size];
    unsigned count = 0;
    void push(unsigned k) { places[count++] = k; }
};

}  // namespace detail

template <host_policy Policy, class F, class Settle, class Late, class... Queues>
void for_each_in_groups(const Policy& on, std::size_t n, const F& f, const Settle& settle, Late& late, Queues&... queues) {
    constexpr std::size_t grain = 16;
    const std::size_t groups = (n + group_size - 1) / group_size;
    const auto loop = [&](std::size_t begin, std::size_t end, auto& late_sink, auto&... sinks) {
        typename F::shared shared;
        detail::ready_indices ready;
        for (std::size_t group = begin; group < end; ++group) {
            const std::size_t first = group * group_size, count = std::min<std::size_t>(group_size, n - first);
            for (unsigned k = 0; k < group_size; ++k) f.prepare(first, k, shared);
            for (std::size_t k = 0; k < count; ++k) f.begin(first + k, shared, ready, late_sink, sinks...);
            while (ready.count > 0) f.step(first, ready.places[--ready.count], shared, ready, late_sink);
            for (unsigned k = 0; k < group_size; ++k) f.end(first, k, shared, late_sink);
            for (unsigned t = 0; t < F::parts * group_size; ++t) f.write(first, t, shared);
        }
    };
    detail::gather_and_settle(on, groups, grain, loop, settle, late, queues...);
}

template <host_policy Policy, class F>
void for_each_in_turns(const Policy& on, std::size_t n, const F& f) {
    constexpr std::size_t grain = 16;
    const std::size_t groups = (n + group_size - 1) / group_size;
    for_each_range(thread_count(on), groups, grain, [&](int, std::size_t begin, std::size_t end) {
        typename F::shared shared;
        for (std::size_t group = begin; group < end; ++group) {
            const std::size_t first = group * group_size;
            for (unsigned k = 0; k < group_size; ++k) f.load(first, k, shared);
            const unsigned turns = f.turns(shared);
            for (unsigned t = 0; t < turns; ++t) {
                const index_range now = f.of_turn(t, shared);
                for (unsigned k = now.begin; k < now.end; ++k) f.step(t, first, k, shared);
            }
            if constexpr (F::parts > 0) {
                for (unsigned k = 0; k < group_size; ++k) {
                    for (unsigned part = 0; part < F::parts; ++part) f.write(first, k, part, shared);
                }
            }
        }
    });
}

template <host_policy Policy, class Test, class Walk, class Decide, class Settle, class Late, class... Queues>
void for_each_candidate(const Policy& on, std::size_t n, const Test& test, const Walk& walk, const Decide& decide,
                        const Settle& settle, Late& late, Queues&... queues) {
    const auto loop = [&](std::size_t begin, std::size_t end, auto& late_sink, auto&... sinks) {
        const detail::decide_at_once emitter{[&](const typename Walk::candidate& c) { decide(c, late_sink, sinks...); }};
        for (std::size_t i = begin; i < end; ++i) {
            if (test(i)) {
                walk(i, emitter, sinks...);
                if (is_over(sinks...)) return;
            }
        }
    };
    detail::gather_and_settle(on, n, range_grain, loop, settle, late, queues...);
}

namespace detail {

/// What the items of a level make.
template <class Expand>
struct next_level {
    std::vector<typename Expand::item> items;
    std::vector<typename Expand::candidate> candidates;
    template <class Place>
    void add(Place, bool is, const typename Expand::item& value) {
        if (is) items.push_back(value);
    }
    template <class Place>
    void push(Place, bool is, const typename Expand::candidate& value) {
        if (is) candidates.push_back(value);
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

    template <class Place>
    void add(Place, bool is, const typename Expand::item& value) {
        items[count] = value;
        count += is;
    }
    template <class Place>
    void push(Place, bool is, const typename Expand::candidate& value) {
        candidates[found] = value;
        found += is;
    }
};

/// Decides n candidates one after another. What a candidate refers to is asked for in two steps before its turn, since the
/// second of them has to read what the first one asks for.
template <bool AtOnce, class Candidate, class Decide, class... Sinks>
void decide_all(const Candidate* candidates, std::size_t n, const Decide& decide, Sinks&... sinks) {
    if constexpr (!AtOnce && requires { decide.prefetch(candidates[0], 0); }) {
        constexpr std::size_t ahead = 8;
        for (std::size_t k = 0; k < n + 2 * ahead; ++k) {
            if (k < n) decide.prefetch(candidates[k], 0);
            if (k >= ahead && k < n + ahead) decide.prefetch(candidates[k - ahead], 1);
            if (k >= 2 * ahead) decide(candidates[k - 2 * ahead], sinks...);
        }
    } else {
        for (std::size_t k = 0; k < n; ++k) decide(candidates[k], sinks...);
    }
}

}  // namespace detail

template <host_policy Policy, class Expand, class Decide, class Settle, class Late, class... Queues>
void for_each_descendant(const Policy& on, const Expand& expand, const Decide& decide, const Settle& settle, Late& late,
                         Queues&... queues) {
    // Level by level until there is enough for threads to share; then each goes depth first. Who only wants to know whether
    // there is one starts soon.
    constexpr bool any_will_do = (is_flag<typename Queues::local> || ...);
    const std::size_t threads = static_cast<std::size_t>(thread_count(on));
    const std::size_t enough = threads == 1 ? 1 : any_will_do ? 4 * threads : 4096;
    detail::next_level<Expand> start;
    for (std::size_t i = 0; i < expand.seeds(); ++i) start.items.push_back(expand.seed(i));
    while (!start.items.empty() && start.items.size() < enough) {
        const auto level = std::exchange(start.items, {});
        for (const auto& at : level) expand(at, start);
    }
    const std::size_t early = start.candidates.size();
    const auto loop = [&](std::size_t begin, std::size_t end, auto& late_sink, auto&... sinks) {
        const Expand step = expand;
        // An early end is worth more than a long run of decisions, and than many items whose fetches do not wait for each
        // other; but the longer it does not come, the more items are taken at a time.
        constexpr std::size_t at_a_time = any_will_do ? 1 : detail::descent<Expand>::at_a_time;
        constexpr std::size_t most_width = detail::descent<Expand>::most_width, first_width = 4, turns_of_a_width = 16;
        std::size_t turns = 0;
        for (std::size_t i = begin; i < end && !is_over(sinks...); ++i) {
            if (i < early) {
                decide(start.candidates[i], late_sink, sinks...);
                continue;
            }
            detail::descent<Expand> mine;
            mine.items[mine.count++] = start.items[i - early];
            while (mine.count > 0) {
                typename Expand::item now[most_width];
                const std::size_t wide =
                    any_will_do ? std::min(first_width + turns++ / turns_of_a_width, most_width) : most_width;
                const std::size_t width = mine.count < wide ? mine.count : mine.count > mine.many ? 1 : wide;
                for (std::size_t k = 0; k < width; ++k) {
                    now[k] = mine.items[--mine.count];
                    step.prefetch(now[k]);
                }
                for (std::size_t k = 0; k < width; ++k) step(now[k], mine);
                if (mine.found >= at_a_time || mine.count == 0) {
                    detail::decide_all<any_will_do>(mine.candidates, mine.found, decide, late_sink, sinks...);
                    mine.found = 0;
                }
                if constexpr (any_will_do) {
                    if (is_over(sinks...)) return;
                }
            }
        }
    };
    detail::gather_and_settle(on, early + start.items.size(), any_will_do ? 1 : descent_grain, loop, settle, late,
                              queues...);
}

template <host_policy Policy, class Tile, class Settle, class Late, class... Queues>
void for_each_tiled(const Policy& on, std::size_t n, std::size_t m, const Tile& tile, const Settle& settle, Late& late,
                    Queues&... queues) {
    constexpr std::size_t columns = 256, pairs_of_a_thread = 16384;
    const auto loop = [&](std::size_t begin, std::size_t end, auto& late_sink, auto&... sinks) {
        typename Tile::column staged[columns];
        for (std::size_t first = 0; first < m; first += columns) {
            const std::size_t width = std::min(columns, m - first);
            for (std::size_t j = 0; j < width; ++j) staged[j] = tile.load_column(first + j);
            for (std::size_t i = begin; i < end && !is_over(sinks...); ++i) {
                const auto row = tile.load_row(i);
                auto reach = tile.reach_of(row);
                for (std::size_t j = 0; j < width; ++j) {
                    if (tile.passes(reach, staged[j])) tile(row, i, staged[j], first + j, late_sink, sinks...);
                }
            }
        }
    };
    detail::gather_and_settle(on, n, std::max<std::size_t>(pairs_of_a_thread / (m + 1), 64), loop, settle, late, queues...);
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
}  // namespace abut
