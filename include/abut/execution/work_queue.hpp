// SPDX-License-Identifier: MIT
#pragma once

// Where the functors of loops with queues leave what they find. Each kind has an owner, given to the
// verb, and a sink that the functor sees:
//
//   work_queue<T, Space>   sink.push(value): all values, in no order, none lost: a queue that proves too small is enlarged
//                          and the work done again, so functors have no other effects
//   work_count<Space>      sink.add(k): the sum
//   work_flag<Space>       sink.raise(), sink.raised(): any; lets others stop early

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>

namespace abut::execution {

template <class T, memory_space Space>
class work_queue;
template <memory_space Space>
class work_count;
template <memory_space Space>
class work_flag;

/// A sink that others watch to stop early.
template <class Sink>
inline constexpr bool is_flag = requires(const Sink& sink) { sink.raised(); };

ABUT_CALLS_ANY
template <class Sink>
ABUT_HD bool is_raised(const Sink& sink) {
    if constexpr (is_flag<Sink>) {
        return sink.raised();
    } else {
        return false;
    }
}

/// Whether one of the sinks is a raised flag.
template <class... Sinks>
ABUT_HD bool is_over(const Sinks&... sinks) {
    return (is_raised(sinks) || ...);
}

/// The elements of both, in a new buffer if both have some.
template <execution_policy Policy, class T, memory_space Space>
buffer<T, Space> joined(const Policy& on, buffer<T, Space>& a, buffer<T, Space>& b) {
    if (b.size() == 0) return std::move(a);
    if (a.size() == 0) return std::move(b);
    buffer<T, Space> both(on, a.size() + b.size());
    copy(on, a.data(), a.size(), both.data());
    copy(on, b.data(), b.size(), both.data() + a.size());
    return both;
}

// On the host each thread has a sink of its own (`local`); `merge` joins them after the loop.

template <class T>
class work_queue<T, host_space> {
public:
    struct local {
        std::vector<T> values;
        void push(const T& value) { values.push_back(value); }
    };

    template <execution_policy Policy>
    explicit work_queue(const Policy&, std::size_t /*expected*/ = 0) {}
    template <execution_policy Policy>
    work_queue(const Policy& on, const std::vector<T>& values) : items_(on, values.size()) {
        upload(on, values.data(), values.size(), items_.data());
    }

    [[nodiscard]] std::size_t size() const { return items_.size(); }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    /// Hands the elements over; the queue is empty after.
    [[nodiscard]] buffer<T, host_space> take() { return std::move(items_); }
    /// Adds the elements of `more`, which is empty after.
    template <execution_policy Policy>
    void absorb(const Policy& on, work_queue& more) {
        items_ = joined(on, items_, more.items_);
        more.items_ = {};
    }

    [[nodiscard]] local make_local() { return {}; }
    template <class Policy>
    void merge(const Policy& on, std::vector<local*>& locals) {
        std::size_t total = 0;
        for (const local* l : locals) total += l->values.size();
        buffer<T, host_space> all(on, total);
        T* out = all.data();
        for (local* l : locals) {
            if (!l->values.empty()) std::memcpy(static_cast<void*>(out), l->values.data(), l->values.size() * sizeof(T));
            out += l->values.size();
            l->values = {};
        }
        items_ = joined(on, items_, all);
    }

private:
    buffer<T, host_space> items_;
};

template <>
class work_count<host_space> {
public:
    struct local {
        std::uint64_t sum = 0;
        void add(std::uint32_t k) { sum += k; }
    };

    template <execution_policy Policy>
    explicit work_count(const Policy&) {}
    [[nodiscard]] std::uint64_t total() const { return total_; }
    /// Adds the number of elements in a queue.
    template <execution_policy Policy, class Queue>
    void absorb(const Policy&, const Queue& more) {
        total_ += more.size();
    }
    /// Adds another sum.
    template <execution_policy Policy>
    void absorb(const Policy&, const work_count& more) {
        total_ += more.total_;
    }

    [[nodiscard]] local make_local() { return {}; }
    template <class Policy>
    void merge(const Policy&, std::vector<local*>& locals) {
        for (const local* l : locals) total_ += l->sum;
    }

private:
    std::uint64_t total_ = 0;
};

template <>
class work_flag<host_space> {
public:
    struct local {
        std::uint32_t* word;
        void raise() { atomic_store(word, 1); }
        [[nodiscard]] bool raised() const { return atomic_load(word) != 0; }
    };

    template <execution_policy Policy>
    explicit work_flag(const Policy&) {}
    [[nodiscard]] bool raised() const { return word_ != 0; }
    /// Raised if there is an element in a queue.
    template <execution_policy Policy, class Queue>
    void absorb(const Policy&, const Queue& more) {
        if (more.size() > 0) word_ = 1;
    }
    /// Raised if either is.
    template <execution_policy Policy>
    void absorb(const Policy&, const work_flag& more) {
        word_ |= more.word_;
    }

    [[nodiscard]] local make_local() { return {&word_}; }
    template <class Policy>
    void merge(const Policy&, std::vector<local*>&) {}

private:
    std::uint32_t word_ = 0;
};

}  // namespace abut::execution
