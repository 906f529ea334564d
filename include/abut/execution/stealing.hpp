// SPDX-License-Identifier: MIT
#pragma once

// Work stealing: a lock-free deque of items, and the count by which workers learn that there is nothing left. A worker is a
// block of a device or a thread of a host, and both run this code. Functions are called by one thread of a worker; it says
// what to copy, and the worker's threads copy it.
//
// The deque is that of Arora, Blumofe and Plaxton (1998): its owner works at the bottom, thieves at the top, and the place
// of the top stands in one 64-bit word with a tag, which thieves change by compare-and-swap. It differs in three things.
// Items come and go in runs. The owner, too, takes by a compare-and-swap of that word, each time, and not for the last item
// alone: of runs the last may be many, and on a device the fence that the original needs costs as much. And items that were
// stolen may be copied at any time later, since their places are not used again before the thief has said that it is done.

#include <atomic>
#include <cstdint>

#include <abut/config.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/schedule.hpp>

namespace abut::execution::detail {

// Words that all workers see. The scope is the device or the process; the order is in the name. T: std::uint32_t or
// std::uint64_t. On a device these are nvcc's own functions: what <cuda/atomic> makes of them is the same, and nvcc takes as
// long to read it as a third of all that else is included.

template <class T>
ABUT_HD T load_acquire(T* word) {
#if ABUT_DEVICE_CODE
    return __nv_atomic_load_n(word, __NV_ATOMIC_ACQUIRE, __NV_THREAD_SCOPE_DEVICE);
#else
    return atomic_ref<T>(*word).load(std::memory_order_acquire);
#endif
}
template <class T>
ABUT_HD void store_release(T* word, T value) {
#if ABUT_DEVICE_CODE
    __nv_atomic_store_n(word, value, __NV_ATOMIC_RELEASE, __NV_THREAD_SCOPE_DEVICE);
#else
    atomic_ref<T>(*word).store(value, std::memory_order_release);
#endif
}
/// Returns the value before.
template <class T>
ABUT_HD T add_relaxed(T* word, T value) {
#if ABUT_DEVICE_CODE
    return __nv_atomic_fetch_add(word, value, __NV_ATOMIC_RELAXED, __NV_THREAD_SCOPE_DEVICE);
#else
    return atomic_ref<T>(*word).fetch_add(value, std::memory_order_relaxed);
#endif
}
template <class T>
ABUT_HD T add_release(T* word, T value) {
#if ABUT_DEVICE_CODE
    return __nv_atomic_fetch_add(word, value, __NV_ATOMIC_RELEASE, __NV_THREAD_SCOPE_DEVICE);
#else
    return atomic_ref<T>(*word).fetch_add(value, std::memory_order_release);
#endif
}
template <class T>
ABUT_HD T add_acq_rel(T* word, T value) {
#if ABUT_DEVICE_CODE
    return __nv_atomic_fetch_add(word, value, __NV_ATOMIC_ACQ_REL, __NV_THREAD_SCOPE_DEVICE);
#else
    return atomic_ref<T>(*word).fetch_add(value, std::memory_order_acq_rel);
#endif
}
/// Where it fails, `expected` becomes what was found.
template <class T>
ABUT_HD bool compare_exchange_acq_rel(T* word, T& expected, T desired) {
#if ABUT_DEVICE_CODE
    return __nv_atomic_compare_exchange_n(word, &expected, desired, false, __NV_ATOMIC_ACQ_REL, __NV_ATOMIC_ACQUIRE,
                                          __NV_THREAD_SCOPE_DEVICE);
#else
    return atomic_ref<T>(*word).compare_exchange_strong(expected, desired, std::memory_order_acq_rel,
                                                        std::memory_order_acquire);
#endif
}

/// What a worker counts of itself; the fields of schedule_report (execution/schedule.hpp). Times are in any unit.
struct worker_counts {
    std::uint64_t steps, items, steals, stolen, failed_steals, offers, transfers, transferred, overflows, idle_time, time;

    /// To the sum of all workers.
    ABUT_HD void add_to(worker_counts* sum) const {
        add_relaxed(&sum->steps, steps);
        add_relaxed(&sum->items, items);
        add_relaxed(&sum->steals, steals);
        add_relaxed(&sum->stolen, stolen);
        add_relaxed(&sum->failed_steals, failed_steals);
        add_relaxed(&sum->offers, offers);
        add_relaxed(&sum->transfers, transfers);
        add_relaxed(&sum->transferred, transferred);
        add_relaxed(&sum->overflows, overflows);
        add_relaxed(&sum->idle_time, idle_time);
        add_relaxed(&sum->time, time);
    }
};

inline schedule_report report_of(schedule ran, std::uint64_t workers, const worker_counts& sum) {
    return {.ran = ran,
            .workers = workers,
            .steps = sum.steps,
            .items = sum.items,
            .steals = sum.steals,
            .stolen = sum.stolen,
            .failed_steals = sum.failed_steals,
            .offers = sum.offers,
            .transfers = sum.transfers,
            .transferred = sum.transferred,
            .overflows = sum.overflows,
            .rounds = 1,
            .balances = 0,
            .idle_share = sum.time > 0 ? static_cast<double>(sum.idle_time) / static_cast<double>(sum.time) : 0};
}

/// Items [first, first + count) of an array.
struct item_range {
    std::uint32_t first, count;
};

/// What thieves see of a deque. A cache line of its own. All 0: an empty one.
struct alignas(64) deque_words {
    std::uint64_t age;     ///< a tag above, and below it the top: where the first item lies. No value of it comes twice
    std::uint32_t bottom;  ///< where the last item ends. Written by the owner alone
    std::uint32_t copied;  ///< stolen items that have been copied
};

ABUT_HD inline std::uint32_t top_of(std::uint64_t age) { return static_cast<std::uint32_t>(age); }
/// With the next tag. It would come again after 2^32 operations of the owner that fall between two instructions of a thief.
ABUT_HD inline std::uint64_t next_age(std::uint64_t age, std::uint32_t top) { return ((age >> 32) + 1) << 32 | top; }

/// About how many items a deque holds.
ABUT_HD inline std::uint32_t deque_size(deque_words* deque) {
    const std::uint32_t top = top_of(load_acquire(&deque->age)), bottom = load_acquire(&deque->bottom);
    return bottom > top ? bottom - top : 0;
}

/// Takes the first items of another's deque: half of them, or `most`. None if there are none, or another worker was quicker.
/// When they have been copied, the thief calls give_back_places.
///
/// Why a range is taken once, and has what the owner wrote: `bottom` is read after `age`. If the exchange succeeds, `age`
/// has not changed since, so nothing was taken from either end since (the owner's take changes it as well). What `bottom`
/// was read as the owner stored after the last take that this thread's `age` shows, for that take's exchange is what the
/// load of `age` acquired, and the owner stores `bottom` before it exchanges; so places below it have items, and their
/// writes are acquired with it.
ABUT_HD inline item_range steal(deque_words* deque, std::uint32_t most) {
    std::uint64_t age = load_acquire(&deque->age);
    const std::uint32_t bottom = load_acquire(&deque->bottom), top = top_of(age);
    if (bottom <= top) return {top, 0};
    const std::uint32_t size = bottom - top, half = size - size / 2, count = half < most ? half : most;
    return {top, compare_exchange_acq_rel(&deque->age, age, age + count) ? count : 0};
}

/// `count` stolen items have been copied. Releases the reads before it to the owner, who may then write there.
ABUT_HD inline void give_back_places(deque_words* deque, std::uint32_t count) { add_release(&deque->copied, count); }

/// The owner's end of a deque with room for `capacity` items. Calls are the owner's, one at a time.
struct deque_owner {
    deque_words* words;
    std::uint32_t capacity;
    std::uint32_t bottom;  ///< as in `words`
    std::uint64_t age;     ///< as last seen: the top may be further

    [[nodiscard]] ABUT_HD std::uint32_t room() const { return capacity - bottom; }

    /// Items that were written from `bottom` on are there for all.
    ABUT_HD void publish(std::uint32_t count) {
        bottom += count;
        store_release(&words->bottom, bottom);
    }

    /// The last items, `most` or all. They are the owner's, and their places are free again for it to write to once it has
    /// read them. With none left, the deque begins again at its first place if it can.
    ABUT_HD item_range take(std::uint32_t most) {
        for (;;) {
            const std::uint32_t top = top_of(age), size = bottom - top;
            if (size == 0) {  // no thief passes the bottom, so the top that was last seen is the top
                store_release(&words->bottom, bottom);
                restart();
                return {bottom, 0};
            }
            const std::uint32_t count = size < most ? size : most;
            // A thief that reads this before the exchange sees fewer items than there are, no others.
            store_release(&words->bottom, bottom - count);
            const std::uint64_t next = next_age(age, top);
            if (!compare_exchange_acq_rel(&words->age, age, next)) continue;  // a thief was quicker: `age` shows it
            age = next;
            bottom -= count;
            return {bottom, count};
        }
    }

    /// Where all was stolen and copied, the deque begins again at its first place: for an owner who lacks room.
    ABUT_HD void make_room() {
        age = load_acquire(&words->age);
        if (top_of(age) == bottom) restart();
    }

private:
    /// Of an empty deque. Thieves see it empty all the while: `bottom` falls below the top first. The exchange cannot fail,
    /// for no thief has seen an item at this top.
    ABUT_HD void restart() {
        if (bottom == 0 || load_acquire(&words->copied) != bottom) return;
        store_release(&words->bottom, std::uint32_t{0});
        store_release(&words->copied, std::uint32_t{0});
        const std::uint64_t next = next_age(age, 0);
        if (compare_exchange_acq_rel(&words->age, age, next)) {
            age = next;
            bottom = 0;
        } else {
            store_release(&words->bottom, bottom);
        }
    }
};

/// What there is to do at all. A worker is busy from before it takes its first item, from the seeds or from another's deque,
/// until it has nothing, and has found its own deque empty. `left` counts seeds that nobody has taken, and busy workers.
///
/// If `left` is 0, there is nothing left, and nothing comes: an item is with a busy worker, or in the deque of one, since
/// only its owner puts items there, and that is busy until it finds none; or it has been stolen, and the thief was busy
/// before. That count came before the one that the owner takes off: the owner found the deque empty by a load that acquired
/// the thief's exchange.
///
/// Nobody waits for a worker that has not begun: that one is not busy, and its deque is empty. What an idle worker waits for
/// are workers that run, and seeds, which it can take itself. So workers need not all run at a time.
struct work_left {
    alignas(64) std::uint64_t left;   ///< begins as the number of seeds
    alignas(64) std::uint64_t seeds;  ///< that have been asked for
};

/// A worker's part in that.
struct work_part {
    work_left* all;
    std::uint32_t seeds, portion;  ///< how many there are, and how many are taken at a time
    bool busy, may_have_seeds;

    /// The next seeds; none if there are none.
    ABUT_HD item_range take_seeds() {
        if (!may_have_seeds) return {0, 0};
        const std::uint64_t first = add_relaxed(&all->seeds, std::uint64_t{portion});
        may_have_seeds = first + portion < seeds;
        if (first >= seeds) return {0, 0};
        const std::uint64_t rest = seeds - first, count = rest < portion ? rest : portion;
        add_acq_rel(&all->left, std::uint64_t{busy ? 0u : 1u} - count);  // modulo 2^64
        busy = true;
        return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
    }
    ABUT_HD void become_busy() {
        if (!busy) add_acq_rel(&all->left, std::uint64_t{1});
        busy = true;
    }
    ABUT_HD void become_idle() {
        if (busy) add_acq_rel(&all->left, ~std::uint64_t{0});
        busy = false;
    }
    [[nodiscard]] ABUT_HD bool is_all_done() const { return load_acquire(&all->left) == 0; }
};

}  // namespace abut::execution::detail
