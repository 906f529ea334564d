// SPDX-License-Identifier: MIT
#pragma once

// The least of many values, for walks that look for it: sinks that give back what they have, and the verb
// for_each_ordered, of which execution/policy.hpp says what it does. Three kinds, and one that keeps nothing:
//
//   best_of_each<Space>       the least of each index by itself
//   best_few_of_each<Space>   as many of the least of each index by itself
//   best_of_all<Space>        the least of all indices; they share a bound
//   until_stopped             for walks that keep what they find themselves, and may end before all is seen
//
// All but the last take sink.offer(value, key), and keep the least value and, of equal ones, the least key; sink.bound() is
// what values have to stay below, or equal, to matter, and sink.known() what has to come before others: of the second kind
// the last of what it keeps, of the third what one thread has. Values are doubles, 0
// or more. What is left does not depend on the order in which values come, and so not on threads, as long as nothing at the
// bound is left out.

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/parallel.hpp>

namespace abut::execution {

/// A value and whose it is. At first there is none: an infinite value of the largest key.
struct least_value {
    double value = HUGE_VAL;
    std::uint64_t key = static_cast<std::uint64_t>(-1);

    [[nodiscard]] ABUT_HD bool comes_before(const least_value& other) const {
        return value < other.value || (value == other.value && key < other.key);
    }
    ABUT_HD void offer(double v, std::uint64_t k) {
        const least_value one{v, k};
        if (one.comes_before(*this)) *this = one;
    }
    friend constexpr bool operator==(const least_value&, const least_value&) = default;
};

struct lesser_value {
    ABUT_HD least_value operator()(least_value a, const least_value& b) const {
        a.offer(b.value, b.key);
        return a;
    }
};

template <memory_space Space>
class best_of_each {
public:
    /// Of the index that is being walked.
    struct sink {
        least_value* out;
        double most;
        least_value mine{};

        ABUT_HD void begin(std::size_t) { mine = {}; }
        ABUT_HD void offer(double value, std::uint64_t key) { mine.offer(value, key); }
        [[nodiscard]] ABUT_HD double bound() const { return mine.value < most ? mine.value : most; }
        [[nodiscard]] ABUT_HD const least_value& known() const { return mine; }
        ABUT_HD void end(std::size_t i) { out[i] = mine; }
        ABUT_HD void close() {}
    };

    template <execution_policy Policy>
    best_of_each(const Policy& policy, std::size_t n, double bound = least_value{}.value)
        : values_(policy, n), most_(bound) {}

    /// By index, in the policy's memory.
    [[nodiscard]] const least_value* data() const { return values_.data(); }
    [[nodiscard]] least_value* data() { return values_.data(); }

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {values_.data(), most_}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}

private:
    buffer<least_value, Space> values_;
    double most_;
};

/// Of each index the `count` least, the least first. What was kept may be offered again, and is kept once.
template <memory_space Space>
class best_few_of_each {
public:
    struct sink {
        least_value* out;
        std::size_t count;
        least_value* mine = nullptr;
        static constexpr bool keeps_few = true;

        ABUT_HD void begin(std::size_t i) {
            mine = out + i * count;
            for (std::size_t k = 0; k < count; ++k) mine[k] = {};
        }
        ABUT_HD void offer(double value, std::uint64_t key) {
            const least_value one{value, key};
            std::size_t to = count;
            while (to > 0 && one.comes_before(mine[to - 1])) --to;
            if (to == count || (to > 0 && mine[to - 1] == one)) return;
            for (std::size_t k = count - 1; k > to; --k) mine[k] = mine[k - 1];
            mine[to] = one;
        }
        [[nodiscard]] ABUT_HD double bound() const { return mine[count - 1].value; }
        [[nodiscard]] ABUT_HD const least_value& known() const { return mine[count - 1]; }
        ABUT_HD void end(std::size_t) {}
        ABUT_HD void close() {}
    };

    /// n indices; count > 0
    template <execution_policy Policy>
    best_few_of_each(const Policy& policy, std::size_t n, std::size_t count) : values_(policy, n * count), count_(count) {}

    /// By index, in the policy's memory.
    [[nodiscard]] const least_value* data() const { return values_.data(); }

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {values_.data(), count_}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}

private:
    buffer<least_value, Space> values_;
    std::size_t count_;
};

template <memory_space Space>
class best_of_all;  // of devices: execution/cuda_ordered.hpp

template <>
class best_of_all<host_space> {
public:
    /// Of one thread.
    struct sink {
        std::uint64_t* word;  ///< the bits of the least value of all threads; those of positive doubles are ordered alike
        least_value* out;
        least_value mine{};

        ABUT_HD void begin(std::size_t) {}
        ABUT_HD void offer(double value, std::uint64_t key) {
            mine.offer(value, key);
            atomic_min(word, ABUT_BIT_CAST(std::uint64_t, mine.value));
        }
        [[nodiscard]] ABUT_HD double bound() const { return ABUT_BIT_CAST(double, atomic_load(word)); }
        [[nodiscard]] ABUT_HD const least_value& known() const { return mine; }
        ABUT_HD void end(std::size_t) {}
        ABUT_HD void close() { out->offer(mine.value, mine.key); }
    };

    template <host_policy Policy>
    explicit best_of_all(const Policy&, double bound = least_value{}.value)
        : word_(ABUT_BIT_CAST(std::uint64_t, bound)) {}
    /// The least of all loops so far.
    [[nodiscard]] least_value least() const { return least_; }
    /// What is still worth looking at: all that is not above.
    [[nodiscard]] double bound() const { return ABUT_BIT_CAST(double, word_); }
    /// What was found otherwise.
    void offer(const least_value& found) { least_.offer(found.value, found.key); }

    [[nodiscard]] sink make_sink(std::size_t thread) { return {&word_, of_threads_.data() + thread, least_}; }
    template <class Policy>
    void begin(const Policy& on, std::size_t threads) {
        of_threads_ = buffer<least_value, host_space>(on, threads);
        for (std::size_t t = 0; t < of_threads_.size(); ++t) of_threads_.data()[t] = {};
    }
    template <class Policy>
    void end(const Policy&) {
        for (std::size_t t = 0; t < of_threads_.size(); ++t) least_ = lesser_value{}(least_, of_threads_.data()[t]);
    }

private:
    least_value least_{};
    std::uint64_t word_;
    buffer<least_value, host_space> of_threads_;
};

/// The least value alone, while an index is walked: the walk itself keeps what is found.
struct least_kept_by_walk {
    struct sink {
        double most, least = most;

        ABUT_HD void begin(std::size_t) { least = most; }
        ABUT_HD void offer(double value) { least = value < least ? value : least; }
        [[nodiscard]] ABUT_HD double bound() const { return least; }
        ABUT_HD void end(std::size_t) {}
        ABUT_HD void close() {}
    };
    double most;

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {most}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}
};

/// There is no bound, until the walk of an index says that nothing matters any more: sink.stop().
struct until_stopped {
    struct sink {
        bool stopped = false;

        ABUT_HD void begin(std::size_t) { stopped = false; }
        ABUT_HD void stop() { stopped = true; }
        [[nodiscard]] ABUT_HD double bound() const { return stopped ? -HUGE_VAL : HUGE_VAL; }
        ABUT_HD void end(std::size_t) {}
        ABUT_HD void close() {}
    };

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}
};
/// The same below a bound.
struct until_stopped_below : until_stopped {
    double most;

    struct sink : until_stopped::sink {
        double most;
        [[nodiscard]] ABUT_HD double bound() const { return stopped ? -HUGE_VAL : most; }
    };

    explicit until_stopped_below(double bound) : most(bound) {}
    [[nodiscard]] sink make_sink(std::size_t /*thread*/) { return {{}, most}; }
};

namespace detail {

template <class Walk, class Best>
struct walk_alone {
    Walk walk;
    Best* best;
    void operator()(std::size_t i) const {
        auto sink = best->make_sink(i);
        sink.begin(i);
        walk(i, sink);
        sink.end(i);
        sink.close();
    }
};

}  // namespace detail

/// Of a policy that says nothing of its threads: each index has a sink of its own.
template <host_policy Policy, class Walk, class Best>
void for_each_ordered(const Policy& on, std::size_t n, const Walk& walk, Best& best) {
    best.begin(on, n);
    for_each_index(on, n, detail::walk_alone<Walk, Best>{walk, &best});
    best.end(on);
}

namespace detail {

/// The indices of a thread's share, begin to end. A walk may have in_bundles(): that is offered some neighbouring indices at
/// a time, walks from all of them at once, or from none if that does not pay, and tells which. Where it often does not, it
/// is asked less often.
template <class Walk>
class share_of_indices {
public:
    share_of_indices(const Walk& walk, std::size_t begin, std::size_t end)
        : bundles_(bundles_of(walk)), next_(begin), end_(end), looked_at_(begin) {}

    /// Takes the next index to walk from. False where none is left.
    template <class Sink>
    bool take(std::size_t& i, [[maybe_unused]] Sink& sink) {
        if constexpr (!std::same_as<bundles_type, none>) {
            while (next_ == looked_at_ && next_ < end_) look_at_bundle(sink);
        }
        if (next_ == end_) return false;
        i = next_++;
        return true;
    }

private:
    struct none {};
    static auto bundles_of([[maybe_unused]] const Walk& walk) {
        if constexpr (requires { walk.in_bundles(); }) {
            return walk.in_bundles();
        } else {
            return none{};
        }
    }
    using bundles_type = decltype(bundles_of(std::declval<const Walk&>()));

    template <class Sink>
    void look_at_bundle(Sink& sink) {
        constexpr std::size_t size = 64, longest = 8;
        const std::size_t left = end_ - next_, last = next_ + (left < size ? left : size);
        if (bundles_(next_, last, sink)) {
            next_ = looked_at_ = last;
            apart_ = 1;
        } else {
            looked_at_ = next_ + (left < apart_ * size ? left : apart_ * size);
            if (apart_ < longest) apart_ *= 2;
        }
    }

    [[no_unique_address]] bundles_type bundles_;
    std::size_t next_, end_;
    std::size_t looked_at_;  ///< up to here bundles have been offered
    std::size_t apart_ = 1;  ///< how far apart, in bundles
};

/// One index after the other.
template <class Walk, class Sink>
void walk_in_order(const Walk& walk, Sink sink, std::size_t begin, std::size_t end) {
    constexpr std::size_t ahead = 8;
    share_of_indices<Walk> share(walk, begin, end);
    for (std::size_t i = 0; share.take(i, sink);) {
        if constexpr (requires { walk.prefetch(i); }) {
            if (i + ahead < end) walk.prefetch(i + ahead);
        }
        sink.begin(i);
        walk(i, sink);
        sink.end(i);
    }
    sink.close();
}

/// The same, eight indices at a time, a step of each in turn. walk.in_steps() is one of them: its begin(i, sink),
/// step(sink), which is false after the last, and end(i, sink). Four to twelve at a time took the same time. A thread has a
/// sink for each, all of which are closed.
template <class Walk, class Sink>
void walk_in_turns(const Walk& walk, const Sink& sink, std::size_t begin, std::size_t end) {
    constexpr std::size_t together = 8;
    struct one_walk {
        decltype(std::declval<const Walk&>().in_steps()) steps;
        Sink sink;
        std::size_t i = 0;

        one_walk(const Walk& walk, const Sink& empty) : steps(walk.in_steps()), sink(empty) {}
        void begin(std::size_t index) {
            i = index;
            sink.begin(i);
            steps.begin(i, sink);
        }
        bool step() {
            if (steps.step(sink)) return true;
            steps.end(i, sink);
            sink.end(i);
            return false;
        }
    };
    std::optional<one_walk> room[together];
    one_walk* walks[together];
    share_of_indices<Walk> share(walk, begin, end);
    std::size_t count = 0, i = 0;
    while (count < together) {
        one_walk& one = room[count].emplace(walk, sink);
        if (!share.take(i, one.sink)) {
            one.sink.close();
            break;
        }
        one.begin(i);
        walks[count++] = &one;
    }
    while (count > 0) {
        for (std::size_t k = 0; k < count;) {
            if (walks[k]->step()) {
                ++k;
            } else if (share.take(i, walks[k]->sink)) {
                walks[k++]->begin(i);
            } else {
                walks[k]->sink.close();
                walks[k] = walks[--count];
            }
        }
    }
}

}  // namespace detail

template <range_policy Policy, class Walk, class Best>
void for_each_ordered(const Policy& on, std::size_t n, const Walk& walk, Best& best) {
    std::size_t grain = 256;
    if constexpr (requires { Walk::grain; }) grain = Walk::grain;  // of long walks
    best.begin(on, static_cast<std::size_t>(concurrency(on)));
    for_each_range(on, n, grain, [&](int thread, std::size_t begin, std::size_t end) {
        const auto sink = best.make_sink(static_cast<std::size_t>(thread));
        if constexpr (requires { walk.in_steps(); }) {
            if (walk.pays_in_steps()) return detail::walk_in_turns(walk, sink, begin, end);
        }
        detail::walk_in_order(walk, sink, begin, end);
    });
    best.end(on);
}

}  // namespace abut::execution
