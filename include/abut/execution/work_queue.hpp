// SPDX-License-Identifier: MIT
#pragma once

// Where the functors of loops with queues leave what they find. There are four kinds of queue. A queue is given to the verb,
// and the functor sees a sink of it:
//
//   work_queue<T, Space>   sink.push(value): all values, in no order, none lost, behind those that the queue has already. A
//                          queue that proves too small is enlarged and the loop runs again, so loops that fill queues have
//                          no other effects
//   work_count<Space>      sink.add(k): the sum
//   work_flag<Space>       sink.raise(), sink.raised(): any; lets others stop early
//   work_visit<F, Space>   sink.push(value): calls f(value) -> bool at once, which says whether to go on; sink.raised()
//                          tells that a call said no. Calls are concurrent, and each value is handed on once. On the
//                          host candidates are judged as soon as they are found if `F::eager` is true
//
// and of work_queue a form that has an end:
//
//   bounded_queue<T, Space>  the same up to a number of values. A loop that pushes more leaves the queue as it was and says
//                          so: queue.overflowed()
//
// On a device a loop that judges candidates is not waited for if the first of its queues is
//
//   async_queue<Queue>     a queue of which the host learns nothing: what it counts is left in the device's memory

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/roles.hpp>

namespace abut::execution {

template <class T, memory_space Space>
class work_queue;
template <memory_space Space>
class work_count;
template <memory_space Space>
class work_flag;
template <class F, memory_space Space>
class work_visit;
template <class T, memory_space Space>
class bounded_queue;
// Of devices alone (execution/cuda_queue.hpp).
template <class T, memory_space Space>
class capped_queue;
template <class T, memory_space Space>
class capped_queue_from_end;
template <class Queue>
struct counted_queue;

/// Memory of a device for one loop that the host does not wait for. Candidates are numbers of 64 bits.
struct async_loop {
    std::uint64_t* words;        ///< one more than `counts`; 0 before the loop and after it
    std::uint64_t* counts;       ///< what was counted: of candidates left open, then of each queue
    std::uint64_t* open;         ///< room for candidates left open; where it is too small, none of them is finished
    std::uint64_t open_capacity;
};

/// The first queue of such a loop: a sink of `Queue`, in whose place the loop leaves counts.
template <class Queue>
struct async_queue : Queue {
    async_loop loop;
};
template <class Queue>
inline constexpr bool is_async = false;
template <class Queue>
inline constexpr bool is_async<async_queue<Queue>> = true;

/// Values that may wait on a device to be finished, 8 bytes each as a rule. There is room for so many at first, and where more are
/// left open the loop runs again with more.
inline constexpr std::uint64_t most_open_at_first = std::uint64_t{1} << 21, most_open = std::uint64_t{1} << 23;

ABUT_CALLS_ANY
template <class Sink>
ABUT_HD bool is_raised(const Sink& sink) {
    if constexpr (may_stop<Sink>) {
        return sink.raised();
    } else {
        return false;
    }
}

/// Whether one of the sinks tells to stop.
template <class... Sinks>
ABUT_HD bool is_over(const Sinks&... sinks) {
    return (is_raised(sinks) || ...);
}

/// The elements of both, in a new buffer if both have some.
template <class Policy, class T, memory_space Space>
buffer<T, Space> joined(const Policy& on, buffer<T, Space>& a, buffer<T, Space>& b) {
    if (b.size() == 0) return std::move(a);
    if (a.size() == 0) return std::move(b);
    buffer<T, Space> both(on, a.size() + b.size());
    copy(on, a.data(), a.size(), both.data());
    copy(on, b.data(), b.size(), both.data() + a.size());
    return both;
}

// On the host each thread has a sink of its own; `merge` joins them after the loop.

template <class T>
class work_queue<T, host_space> {
public:
    struct sink {
        std::vector<T> values;
        void push(const T& value) { values.push_back(value); }
    };

    template <host_policy Policy>
    explicit work_queue(const Policy&, std::size_t /*expected*/ = 0) {}

    [[nodiscard]] std::size_t size() const { return items_.size(); }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    /// Hands the elements over; the queue is empty after.
    [[nodiscard]] buffer<T, host_space> take() { return std::move(items_); }

    [[nodiscard]] sink make_sink() { return {}; }
    template <class Policy>
    void merge(const Policy& on, std::vector<sink*>& sinks) {
        std::vector<std::size_t> first{items_.size()};
        for (const sink* s : sinks) first.push_back(first.back() + s->values.size());
        if (first.back() == items_.size()) return;
        buffer<T, host_space> all(on, first.back());
        copy(on, items_.data(), items_.size(), all.data());
        const auto move = [&](std::size_t k) {
            auto& from = sinks[k]->values;
            if (!from.empty()) std::memcpy(static_cast<void*>(all.data() + first[k]), from.data(), from.size() * sizeof(T));
            from = {};
        };
        // What is large goes to memory that nobody has touched, so threads also share the work of the system.
        constexpr std::size_t large = std::size_t{1} << 18;
        if (all.capacity_bytes() < large) {
            for (std::size_t k = 0; k < sinks.size(); ++k) move(k);
        } else {
            for_each_task(on, sinks.size(), move);
        }
        items_ = std::move(all);
    }

private:
    buffer<T, host_space> items_;
};

/// Grows by doubling: it is for values that stay while others come.
template <class T>
class bounded_queue<T, host_space> {
public:
    /// A thread stores no more than the bound either.
    struct sink {
        std::size_t room;
        std::vector<T> values;
        void push(const T& value) {
            if (values.size() <= room) values.push_back(value);
        }
    };

    template <host_policy Policy>
    bounded_queue(const Policy&, std::size_t most) : most_(most) {}

    [[nodiscard]] std::size_t size() const { return items_.size(); }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    /// Of the last loop.
    [[nodiscard]] bool overflowed() const { return overflowed_; }
    void clear() { items_.clear(); }

    [[nodiscard]] sink make_sink() { return {most_ - items_.size(), {}}; }
    template <class Policy>
    void merge(const Policy&, std::vector<sink*>& sinks) {
        std::size_t total = 0;
        for (const sink* s : sinks) total += s->values.size();
        overflowed_ = total > most_ - items_.size();
        if (overflowed_) return;
        for (sink* s : sinks) {
            items_.insert(items_.end(), s->values.begin(), s->values.end());
            s->values = {};
        }
    }

private:
    std::vector<T> items_;
    std::size_t most_;
    bool overflowed_ = false;
};

template <>
class work_count<host_space> {
public:
    struct sink {
        std::uint64_t sum = 0;
        void add(std::uint32_t k) { sum += k; }
    };

    template <host_policy Policy>
    explicit work_count(const Policy&) {}
    [[nodiscard]] std::uint64_t total() const { return total_; }

    [[nodiscard]] sink make_sink() { return {}; }
    template <class Policy>
    void merge(const Policy&, std::vector<sink*>& sinks) {
        for (const sink* s : sinks) total_ += s->sum;
    }

private:
    std::uint64_t total_ = 0;
};

template <>
class work_flag<host_space> {
public:
    struct sink {
        std::uint32_t* word;
        void raise() { atomic_store(word, 1); }
        [[nodiscard]] bool raised() const { return atomic_load(word) != 0; }
    };

    template <host_policy Policy>
    explicit work_flag(const Policy&) {}
    [[nodiscard]] bool raised() const { return word_ != 0; }

    [[nodiscard]] sink make_sink() { return {&word_}; }
    template <class Policy>
    void merge(const Policy&, std::vector<sink*>&) {}

private:
    std::uint32_t word_ = 0;
};

template <class F>
class work_visit<F, host_space> {
public:
    struct sink {
        static constexpr bool eager = requires { requires F::eager; };
        const F* visitor;
        std::uint32_t* word;
        template <class T>
        void push(const T& value) {
            if (!raised() && !(*visitor)(value)) atomic_store(word, 1);
        }
        [[nodiscard]] bool raised() const { return atomic_load(word) != 0; }
    };

    template <host_policy Policy>
    work_visit(const Policy&, const F& visitor) : visitor_(visitor) {}
    /// Whether a call said that there is no need to go on.
    [[nodiscard]] bool raised() const { return word_ != 0; }

    [[nodiscard]] sink make_sink() { return {&visitor_, &word_}; }
    template <class Policy>
    void merge(const Policy&, std::vector<sink*>&) {}

private:
    F visitor_;
    std::uint32_t word_ = 0;
};

}  // namespace abut::execution
