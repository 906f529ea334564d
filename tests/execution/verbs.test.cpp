// SPDX-License-Identifier: MIT
#include <abut/execution/host.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "execution/verb_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

static_assert(execution_policy<serial>);
static_assert(execution_policy<openmp>);
static_assert(!execution_policy<int>);
static_assert(host_policy<serial> && host_policy<openmp>);

namespace {

/// Runs f on a thread that has lost nothing yet, so that loops on a busy machine ask for other threads at once.
template <class F>
void on_fresh_thread(const F& f) {
    std::exception_ptr failure;
    std::thread([&] {
        try {
            f();
        } catch (...) {
            failure = std::current_exception();
        }
    }).join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

TEST_CASE("verbs: serial") { test::check_verbs(serial{}); }

TEST_CASE("verbs: openmp on 1, 2, 7, all and far too many threads") {
    for (const int threads : {1, 2, 7, 0, 30'000}) {
        CAPTURE(threads);
        test::check_verbs(openmp{.threads = threads});
    }
}

namespace {

/// Items that all make sixteen others, down to the greatest depth, until so many have: what a walk of two trees with four
/// children a node has room for, and far more than it meets.
struct flood {
    struct item {
        unsigned depth;
    };
    using candidate = unsigned;
    static constexpr unsigned most_children = 16, most_depth = 96;
    std::atomic<long>* left;

    [[nodiscard]] static std::size_t seeds() { return 1; }
    [[nodiscard]] static item seed(std::size_t) { return {0}; }
    void prefetch(const item&) const {}
    template <class Emitter>
    void operator()(const item& at, Emitter& emitter) const {
        const bool ends = at.depth == most_depth || left->fetch_sub(1) <= 0;
        for (unsigned k = 0; k < most_children && !ends; ++k) emitter.add(k, true, item{at.depth + 1});
        emitter.push(0u, ends, at.depth);
    }
};
struct keep_depth {
    std::atomic<int>* hints;
    bool operator()(unsigned depth, auto& hits) const {
        hits.push(depth);
        return true;
    }
    void finish(unsigned, auto&) const { FAIL("nothing is left open"); }
    void prefetch(unsigned, int step) const { *hints += step == 0 ? 1 : -1; }
};

}  // namespace

TEST_CASE("verbs: a descent has room for as many items as there may be, and hints at each candidate twice") {
    const auto check_on = [](const auto& on) {
        constexpr long most = 200'000;
        std::atomic<long> left{most};
        std::atomic<int> hints{0};
        execution::work_queue<unsigned, host_space> hits(on);
        for_each_descendant(on, flood{&left}, keep_depth{&hints}, hits);
        CHECK(hits.size() == 1 + 15 * most);
        CHECK(*std::max_element(hits.data(), hits.data() + hits.size()) == 96);
        CHECK(hints == 0);
    };
    check_on(serial{});
    check_on(openmp{3});
}

TEST_CASE("verbs: what a functor throws on any thread arrives at the caller") {
    const auto thrower = [](std::size_t i) {
        if (i == 50'000) throw std::runtime_error("from within");
    };
    CHECK_THROWS_WITH(for_each_index(serial{}, 100'000, thrower), "from within");
    CHECK_THROWS_WITH(for_each_index(openmp{.threads = 3}, 100'000, thrower), "from within");
    const auto first = [](std::size_t a, std::size_t) { return a; };
    const auto worse = [](std::size_t i) {
        if (i == 99'999) throw std::bad_alloc();
        return i;
    };
    CHECK_THROWS_AS(reduce(openmp{.threads = 3}, 100'000, std::size_t{0}, first, worse), std::bad_alloc);
}

namespace {

/// A call on one thread that waits until another thread has called as well, but not for ever.
class rendezvous {
public:
    void operator()() {
        std::unique_lock lock(mutex_);
        if (!callers_.insert(std::this_thread::get_id()).second) return;
        all_there_.notify_all();
        all_there_.wait_for(lock, std::chrono::seconds(20), [&] { return callers_.size() > 1; });
    }
    [[nodiscard]] bool met() const { return callers_.size() > 1; }

private:
    std::mutex mutex_;
    std::condition_variable all_there_;
    std::set<std::thread::id> callers_;
};

/// A number of which the sum is made on more threads than one.
struct met_sum {
    static inline rendezvous* meeting = nullptr;
    std::uint64_t value = 0;
    friend met_sum operator+(met_sum a, met_sum b) {
        if (meeting) (*meeting)();
        return {a.value + b.value};
    }
};

}  // namespace

TEST_CASE("verbs: scans, selections, reductions and groups of openmp run on its threads") {
    const openmp on{.threads = 2};
    if (concurrency(on) == 1) return;  // compiled without OpenMP
    constexpr std::size_t n = 50'000;
    SECTION("exclusive_scan") {
        rendezvous meeting;
        std::vector<met_sum> values(n + 1, met_sum{3});
        met_sum::meeting = &meeting;
        on_fresh_thread([&] { exclusive_scan(on, values.data(), n); });
        met_sum::meeting = nullptr;
        CHECK(meeting.met());
        CHECK(values[n].value == 3 * n);
    }
    SECTION("compact") {
        rendezvous meeting;
        std::vector<std::uint32_t> kept(n);
        const auto odd = [&](std::size_t i) {
            meeting();
            return i % 2 == 1;
        };
        on_fresh_thread([&] { CHECK(compact(on, n, odd, kept.data()) == n / 2); });
        CHECK(meeting.met());
        CHECK(kept[n / 2 - 1] == n - 1);
    }
    SECTION("reduce") {
        rendezvous meeting;
        const auto one = [&](std::size_t) {
            meeting();
            return std::size_t{1};
        };
        on_fresh_thread([&] { CHECK(reduce(on, n, std::size_t{0}, std::plus<std::size_t>{}, one) == n); });
        CHECK(meeting.met());
    }
    SECTION("for_each_task") {
        rendezvous meeting;
        on_fresh_thread([&] { for_each_task(on, 2, [&](std::size_t) { meeting(); }); });
        CHECK(meeting.met());
    }
}

namespace {

/// Threads of the parallel region that this is called in.
int team_size() {
#if defined(_OPENMP)
    return omp_get_num_threads();
#else
    return 1;
#endif
}

}  // namespace

TEST_CASE(
    "verbs: a loop of one range takes the calling thread, others a team of one size, of eight for each processor at most") {
    for (const int threads : {30'000, 200'000, std::numeric_limits<int>::max()}) {
        const openmp on{.threads = threads};
        CHECK(concurrency(on) >= 1);
        CHECK(static_cast<unsigned>(concurrency(on)) <= 8 * std::max(std::thread::hardware_concurrency(), 1u));
        on_fresh_thread([&] {
            int alone = 0;
            for_each_range(on, 1'000, 1'000,
                           [&](int thread, std::size_t, std::size_t) { alone += thread == 0 && team_size() == 1; });
            CHECK(alone == 1);
        });
        on_fresh_thread([&] {
            const int all = concurrency(on);  // within a loop it is 1
            std::atomic<int> most{0}, calls{0}, others{0};
            for_each_range(on, 2'500, 1'000, [&](int thread, std::size_t, std::size_t) {
                for (int seen = most; seen < thread && !most.compare_exchange_weak(seen, thread);) {
                }
                ++calls;
                if (team_size() != all) ++others;
            });
            CHECK(most < all);
            CHECK(calls == (all == 1 ? 1 : 3));
            CHECK(others == 0);
        });
        CHECK(reduce(on, 1'000'000, std::uint64_t{0}, test::sum{}, test::identity{}) == 499'999'500'000);
    }
    CHECK(concurrency(openmp{.threads = 1}) == 1);
}

TEST_CASE("verbs: loops within loops, on threads of one policy and of several") {
    const openmp outer{.threads = 3};
    std::vector<std::uint64_t> sums(40);
    for_each_task(outer, sums.size(), [&](std::size_t i) {
        sums[i] = reduce(openmp{.threads = 2}, 20'000 + i, std::uint64_t{0}, test::sum{}, test::identity{});
        execution::work_count<host_space> count(outer);
        for_each_index(
            outer, 3'000, [](std::size_t, auto& sink) { sink.add(1); }, count);
        if (count.total() != 3'000) sums[i] = 0;
    });
    for (std::size_t i = 0; i < sums.size(); ++i) CHECK(sums[i] == (20'000 + i) * (19'999 + i) / 2);
}

TEST_CASE("verbs: when a functor throws on one thread, the others end soon") {
    const openmp on{.threads = 2};
    if (concurrency(on) == 1) return;  // compiled without OpenMP
    std::atomic<bool> thrown{false};
    std::atomic<std::size_t> begun{0}, after{0};
    // The thread that throws waits for the other to be at work, and that one takes its time with each index then.
    const auto throw_first = [&](std::size_t i) {
        if (i == 0) {
            const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(20);
            while (begun == 0 && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
            thrown = true;
            throw std::runtime_error("the first");
        }
        ++begun;
        while (!thrown) std::this_thread::yield();
        ++after;
        std::this_thread::sleep_for(std::chrono::microseconds(20));
    };
    SECTION("a loop begins no more ranges") {
        constexpr std::size_t n = 32 * 1024;
        CHECK_THROWS_WITH(on_fresh_thread([&] { for_each_index(on, n, throw_first); }), "the first");
        CHECK(begun > 0);
        CHECK(after < n / 2);
    }
    SECTION("a loop with queues does not end its range") {
        constexpr std::size_t n = 2 * 1024;
        execution::work_count<host_space> count(on);
        const auto with_sink = [&](std::size_t i, auto&) { throw_first(i); };
        CHECK_THROWS_WITH(on_fresh_thread([&] { for_each_index(on, n, with_sink, count); }), "the first");
        CHECK(begun > 0);
        CHECK(after < n / 4);
    }
}

namespace {

/// f(i) for i < n, each on a thread of a parallel region, where as many levels of regions may be open at a time.
template <class F>
void inside_regions([[maybe_unused]] int levels, std::size_t n, const F& f) {
#if defined(_OPENMP)
    const int before = omp_get_max_active_levels();
    omp_set_max_active_levels(levels);
#pragma omp parallel for num_threads(2) schedule(static, 1)
#endif
    for (std::size_t i = 0; i < n; ++i) f(i);
#if defined(_OPENMP)
    omp_set_max_active_levels(before);
#endif
}

}  // namespace

TEST_CASE("verbs: the more regions in a row lose time, the more work the calling thread does alone") {
    execution::detail::lost_time lost;
    lost.settle(1e-5);
    CHECK(lost.owed == 0);
    for (const double times : {1.0, 2.0, 4.0, 8.0, 16.0, 16.0}) {
        lost.settle(2e-3);
        CHECK(lost.owed == times * 2e-3);
    }
    lost.owed = 0;
    lost.settle(-1);
    CHECK(lost.owed == 0);
    CHECK(lost.times == 8);
    lost.settle(3600);
    CHECK(lost.owed == 0.1);
}

TEST_CASE("verbs: what a loop has lost is worked off by the calling thread, and then it asks for others") {
    const openmp on{.threads = 2};
    if (concurrency(on) == 1) return;  // compiled without OpenMP
    using execution::detail::lost_time_of_thread;
    SECTION("as long as something is owed") {
        on_fresh_thread([&] {
            lost_time_of_thread().owed = 1e9;
            std::size_t next = 0;  // no other thread is there
            bool alone = true;
            for_each_range(on, 10'500, 1'000, [&](int thread, std::size_t begin, std::size_t end) {
                alone = alone && thread == 0 && begin == next;
                next = end;
            });
            CHECK(alone);
            CHECK(next == 10'500);
            CHECK(lost_time_of_thread().owed > 0);
            CHECK_THROWS_AS(for_each_index(on, 5'000,
                                           [](std::size_t i) {
                                               if (i == 4'000) throw std::bad_alloc();
                                           }),
                            std::bad_alloc);
            test::check_verbs(on);
        });
    }
    SECTION("then on all threads, and a region that gains makes the next loss cheaper") {
        on_fresh_thread([&] {
            lost_time_of_thread() = {.owed = 0.005, .times = 16};
            rendezvous meeting;
            std::vector<std::atomic<int>> calls(100);
            for_each_task(on, calls.size(), [&](std::size_t i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                ++calls[i];
                if (i >= 6) meeting();
            });
            CHECK(meeting.met());
            CHECK(lost_time_of_thread().owed <= 0);
            CHECK(lost_time_of_thread().times == 8);
            for (const auto& n : calls) CHECK(n == 1);
        });
    }
    SECTION("and whatever a thread has lost, answers are the same") {
        for (const double owed : {1e-6, 1e-4, 1e-2}) {
            lost_time_of_thread().owed = owed;
            test::check_verbs(openmp{.threads = 7});
        }
    }
}

TEST_CASE("verbs: in a parallel region of the caller's there is one thread, unless regions nest") {
    const openmp on{.threads = 3};
    if (concurrency(on) == 1) return;  // compiled without OpenMP
    for (const int levels : {1, 2}) {
        std::vector<std::uint64_t> sums(8), counts(8);
        std::vector<int> threads(8);
        inside_regions(levels, sums.size(), [&](std::size_t i) {
            threads[i] = concurrency(on);
            sums[i] = reduce(on, 50'000 + i, std::uint64_t{0}, test::sum{}, test::identity{});
            execution::work_count<host_space> count(on);
            for_each_index(
                on, 30'000, [](std::size_t, auto& sink) { sink.add(1); }, count);
            counts[i] = count.total();
        });
        for (std::size_t i = 0; i < sums.size(); ++i) {
            CHECK(threads[i] == (levels == 1 ? 1 : 3));
            CHECK(sums[i] == (50'000 + i) * (49'999 + i) / 2);
            CHECK(counts[i] == 30'000);
        }
    }
}

TEST_CASE("verbs: several threads of the host at a time, each with more threads than there are processors") {
    const unsigned processors = std::max(std::thread::hardware_concurrency(), 1u);
#ifdef __clang__  // LLVM's runtime 14 can crash where all these are far more threads than processors (docs/guide/platforms.md, Platforms)
    const unsigned hosts_at_once = 2, threads = processors + 1;
#else
    const unsigned hosts_at_once = 6, threads = 4 * processors;
#endif
    const openmp on{.threads = static_cast<int>(threads)};
    std::vector<std::uint64_t> sums(hosts_at_once);
    std::vector<std::thread> hosts;
    for (std::size_t h = 0; h < sums.size(); ++h) {
        hosts.emplace_back([&, h] {
            for (std::size_t k = 0; k < 20; ++k) {
                std::vector<std::uint32_t> kept(40'000);
                sums[h] += compact(
                    on, kept.size(), [&](std::size_t i) { return i % (h + 2) == 0; }, kept.data());
                sums[h] += reduce(on, 20'000, std::uint64_t{0}, test::sum{}, test::identity{});
            }
        });
    }
    for (auto& host : hosts) host.join();
    for (std::size_t h = 0; h < sums.size(); ++h) {
        CHECK(sums[h] == 20 * ((40'000 + h + 1) / (h + 2) + std::uint64_t{20'000} * 19'999 / 2));
    }
}

TEST_CASE("buffers: memory for more elements than can be addressed is refused") {
    using buffer = execution::buffer<std::uint64_t, host_space>;
    CHECK_THROWS_AS(buffer(serial{}, static_cast<std::size_t>(-1) / 4), std::bad_alloc);
    buffer none(serial{}, 0);
    CHECK(none.data() == nullptr);
    buffer a(serial{}, 3), b(std::move(a));
    CHECK(a.data() == nullptr);
    CHECK(b.size() == 3);
}

namespace {

/// Keys, of which `kind` says how they are spread: 0 evenly, 1 few values, 2 most in one bucket, 3 all in one, 4 ascending.
template <class Key>
std::vector<Key> keys_of(int kind, std::size_t n, int bits) {
    std::vector<Key> keys(n);
    std::uint64_t state = 20261123;
    for (std::size_t i = 0; i < n; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const std::uint64_t any = (state ^ state >> 29) >> (64 - bits), low = any & ((std::uint64_t{1} << bits / 2) - 1);
        const std::uint64_t key = kind == 0   ? any
                                  : kind == 1 ? any % 5
                                  : kind == 2 ? (i % 50 == 0 ? any : low)
                                  : kind == 3 ? low
                                              : i & ((std::uint64_t{1} << (bits - 1)) * 2 - 1);
        keys[i] = static_cast<Key>(key);
    }
    return keys;
}

template <class Key>
void check_spread_keys(const openmp& on, int bits) {
    for (int kind = 0; kind < 5; ++kind) {
        for (const std::size_t n :
             {std::size_t{0}, std::size_t{1}, std::size_t{2'000}, std::size_t{5'000}, std::size_t{40'000}}) {
            CAPTURE(sizeof(Key), bits, kind, n);
            const std::vector<Key> from = keys_of<Key>(kind, n, bits);
            std::vector<std::pair<Key, std::uint32_t>> expected;
            for (std::size_t i = 0; i < n; ++i) expected.emplace_back(from[i], static_cast<std::uint32_t>(i));
            std::ranges::stable_sort(expected, {}, [](const auto& p) { return p.first; });
            execution::buffer<Key, host_space> keys(on, n), alone(on, n);
            execution::buffer<std::uint32_t, host_space> values(on, n);
            for (std::size_t i = 0; i < n; ++i) {
                keys.data()[i] = alone.data()[i] = from[i];
                values.data()[i] = static_cast<std::uint32_t>(i);
            }
            execution::radix_sort(on, keys, &values, bits);
            sort_keys(on, alone, bits);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < n; ++i) {
                wrong += keys.data()[i] != expected[i].first || values.data()[i] != expected[i].second;
                wrong += alone.data()[i] != expected[i].first;
            }
            CHECK(wrong == 0);
        }
    }
}

}  // namespace

TEST_CASE("verbs: keys are sorted however they are spread, and equal ones stay in their order") {
    const openmp on{.threads = 7};
    for (const int bits : {1, 2, 7, 8, 9, 10, 16, 17, 24, 25, 31, 32}) check_spread_keys<std::uint32_t>(on, bits);
    for (const int bits : {3, 30, 33, 41, 49, 51, 57, 63, 64}) check_spread_keys<std::uint64_t>(on, bits);
}
