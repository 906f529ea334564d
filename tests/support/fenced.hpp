// SPDX-License-Identifier: MIT
#pragma once

// A policy whose memory the host can read only in loops and copies, as that of a device: between them it is closed to all,
// and who reads it there ends the program. It runs on the calling thread; several of a team take turns. For POSIX systems,
// and for programs without CUDA, whose memory space it takes. Memory is not used twice, so that who reads what was given
// back is seen as well.

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/execution/generic.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/execution/work_queue.hpp>

namespace abut::test {

/// Addresses for all of it, pages of which are taken one after another.
class fence {
public:
    static fence& of_all() {
        static fence one;
        return one;
    }
    [[nodiscard]] void* take(std::size_t bytes) {
        const std::scoped_lock mine(turn_);
        constexpr std::size_t page = 4096;
        const std::size_t whole = (bytes + page - 1) / page * page;
        if (whole > room - used_) throw std::bad_alloc();
        unsigned char* const at = first_ + used_;
        used_ += whole;
        if (depth_ > 0) mprotect(at, whole, PROT_READ | PROT_WRITE);
        return at;
    }
    void open() {
        turn_.lock();
        if (depth_++ == 0) mprotect(first_, used_, PROT_READ | PROT_WRITE);
    }
    void close() {
        if (--depth_ == 0) mprotect(first_, used_, PROT_NONE);
        turn_.unlock();
    }

private:
    static constexpr std::size_t room = std::size_t{1} << 34;

    fence() {
        void* const all = mmap(nullptr, room, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (all == MAP_FAILED) throw std::bad_alloc();
        first_ = static_cast<unsigned char*>(all);
    }

    unsigned char* first_ = nullptr;
    std::size_t used_ = 0;
    int depth_ = 0;
    std::recursive_mutex turn_;
};

/// As long as it lives, the memory may be read and written.
struct opened_fence {
    opened_fence() { fence::of_all().open(); }
    ~opened_fence() { fence::of_all().close(); }
    opened_fence(const opened_fence&) = delete;
    opened_fence& operator=(const opened_fence&) = delete;
};

inline void copy_through_fence(void* to, const void* from, std::size_t bytes) {
    const opened_fence open;
    if (bytes > 0) std::memcpy(to, from, bytes);
}

struct fenced : execution::policy_base {
    using memory_space = device_space;
};

}  // namespace abut::test

namespace abut::execution {

template <>
struct allocator<device_space> {
    template <class Policy>
    explicit allocator(const Policy&) {}
    allocator() = default;
    [[nodiscard]] void* allocate(std::size_t bytes) const { return test::fence::of_all().take(bytes); }
    void deallocate(void*) const noexcept {}
    void read(const void* from, std::size_t bytes, void* to) const { test::copy_through_fence(to, from, bytes); }
    [[nodiscard]] int device() const { return 0; }
};

// Queues: the sinks are those of the host, and values lie behind the fence.

template <class T>
class work_queue<T, device_space> {
public:
    using sink = typename work_queue<T, host_space>::sink;
    template <class Policy>
    explicit work_queue(const Policy&, std::size_t /*expected*/ = 0) {}
    [[nodiscard]] std::size_t size() const { return items_.size(); }
    [[nodiscard]] T* data() { return items_.data(); }
    [[nodiscard]] const T* data() const { return items_.data(); }
    [[nodiscard]] buffer<T, device_space> take() { return std::move(items_); }
    [[nodiscard]] sink make_sink() { return {}; }
    template <class Policy>
    void merge(const Policy& on, std::vector<sink*>& sinks) {
        for (sink* s : sinks) {
            buffer<T, device_space> more(on, s->values.size());
            test::copy_through_fence(more.data(), s->values.data(), s->values.size() * sizeof(T));
            items_ = joined(on, items_, more);
            s->values = {};
        }
    }

private:
    buffer<T, device_space> items_;
};

template <class T>
class capped_queue<T, device_space> {
public:
    using sink = typename work_queue<T, host_space>::sink;
    template <class Policy>
    capped_queue(const Policy& on, std::size_t capacity)
        : own_(std::make_shared<buffer<T, device_space>>(on, capacity)), items_(own_->data()), capacity_(capacity) {}
    /// In memory of the caller's.
    capped_queue(T* room, std::size_t capacity) : items_(room), capacity_(capacity) {}
    [[nodiscard]] std::uint64_t pushed() const { return pushed_; }
    [[nodiscard]] std::uint64_t capacity() const { return capacity_; }
    [[nodiscard]] const T* data() const { return items_; }
    [[nodiscard]] sink make_sink() { return {}; }
    template <class Policy>
    void merge(const Policy&, std::vector<sink*>& sinks) {
        store(sinks, [](std::size_t i, std::size_t) { return i; });
    }

protected:
    /// Value i at place(i, capacity), if there is room for it.
    template <class Place>
    void store(std::vector<sink*>& sinks, const Place& place) {
        const test::opened_fence open;
        for (sink* s : sinks) {
            for (const T& value : s->values) {
                if (pushed_ < capacity_) items_[place(pushed_, capacity_)] = value;
                ++pushed_;
            }
            s->values = {};
        }
    }

private:
    std::shared_ptr<buffer<T, device_space>> own_;  // copies of a queue are that queue, as on a device
    T* items_;
    std::size_t capacity_;
    std::uint64_t pushed_ = 0;
};

template <class T>
class capped_queue_from_end<T, device_space> : public capped_queue<T, device_space> {
    using base = capped_queue<T, device_space>;

public:
    using base::base;
    template <class Policy>
    void merge(const Policy&, std::vector<typename base::sink*>& sinks) {
        base::store(sinks, [](std::size_t i, std::size_t capacity) { return capacity - 1 - i; });
    }
};

// What these hold stays with the host, which alone merges it.

template <>
class work_count<device_space> : public work_count<host_space> {
public:
    template <class Policy>
    explicit work_count(const Policy&) : work_count<host_space>(serial{}) {}
};
template <>
class work_flag<device_space> : public work_flag<host_space> {
public:
    template <class Policy>
    explicit work_flag(const Policy&) : work_flag<host_space>(serial{}) {}
};
template <class F>
class work_visit<F, device_space> : public work_visit<F, host_space> {
public:
    template <class Policy>
    work_visit(const Policy&, const F& visitor) : work_visit<F, host_space>(serial{}, visitor) {}
};
template <>
class best_of_all<device_space> : public best_of_all<host_space> {
public:
    template <class Policy>
    explicit best_of_all(const Policy&, double bound = least_value{}.value) : best_of_all<host_space>(serial{}, bound) {}
    template <class Policy>
    void begin(const Policy&, std::size_t threads) {
        best_of_all<host_space>::begin(serial{}, threads);
    }
};

}  // namespace abut::execution

namespace abut::test {

template <class F>
void for_each_index(const fenced&, std::size_t n, const F& f) {
    const opened_fence open;
    for (std::size_t i = 0; i < n; ++i) f(i);
}
template <class F, class Queue, class... Queues>
void for_each_index(const fenced& on, std::size_t n, const F& f, Queue& queue, Queues&... queues) {
    const auto loop = [&](auto... sinks) {
        const opened_fence open;
        for (std::size_t i = 0; i < n && !execution::is_over(sinks...); ++i) f(i, sinks...);
        const auto merge = [&](auto& to, auto& from) {
            std::vector<std::remove_reference_t<decltype(from)>*> all{&from};
            to.merge(on, all);
        };
        const auto merge_all = [&](auto&... to) { (merge(to, sinks), ...); };
        merge_all(queue, queues...);
    };
    loop(queue.make_sink(), queues.make_sink()...);
}
template <class F>
void for_each_group(const fenced& on, std::size_t n, const F& f) {
    constexpr std::size_t size = execution::group_size_of<F>;
    for_each_index(on, n / size + (n % size != 0), execution::detail::run_group<F>{f});
}
template <class Walk, class Best>
void for_each_ordered(const fenced& on, std::size_t n, const Walk& walk, Best& best) {
    best.begin(on, n);
    for_each_index(on, n, execution::detail::walk_alone<Walk, Best>{walk, &best});
    best.end(on);
}
template <class T>
void upload(const fenced&, const T* from, std::size_t n, T* to) {
    copy_through_fence(to, from, n * sizeof(T));
}
template <class T>
void download(const fenced&, const T* from, std::size_t n, T* to) {
    copy_through_fence(to, from, n * sizeof(T));
}
template <class T>
void copy(const fenced&, const T* from, std::size_t n, T* to) {
    copy_through_fence(to, from, n * sizeof(T));
}
/// Between two policies of a team.
template <class T>
void copy_across(const fenced&, const T* from, std::size_t n, const fenced&, T* to) {
    copy_through_fence(to, from, n * sizeof(T));
}
inline void require_access(const fenced&, const void*, const char*) {}
template <class F, class... Args>
void require_callable(const fenced&, const F&, const Args&...) {}
inline int device_of(const fenced&) { return 0; }
inline void synchronize(const fenced&) {}
inline void release_memory(const fenced&) {}

}  // namespace abut::test
