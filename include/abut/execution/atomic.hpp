// SPDX-License-Identifier: MIT
#pragma once

// Atomic operations on plain memory, for functors that run on the host and on a device. Relaxed unless the name says so.

#include <atomic>
#include <cstdint>

#include <abut/config.hpp>

namespace abut::execution {

namespace detail {

#if defined(__cpp_lib_atomic_ref)
using std::atomic_ref;
#else
/// What is needed of std::atomic_ref, for libc++ before 19, which has none. Orders have the numbers that the builtins take.
template <class T>
class atomic_ref {
public:
    explicit atomic_ref(T& word) : word_(&word) {}
    T load(std::memory_order order) const { return __atomic_load_n(word_, static_cast<int>(order)); }
    void store(T value, std::memory_order order) const { __atomic_store_n(word_, value, static_cast<int>(order)); }
    T exchange(T value, std::memory_order order) const { return __atomic_exchange_n(word_, value, static_cast<int>(order)); }
    T fetch_add(T value, std::memory_order order) const { return __atomic_fetch_add(word_, value, static_cast<int>(order)); }
    T fetch_or(T value, std::memory_order order) const { return __atomic_fetch_or(word_, value, static_cast<int>(order)); }
    bool compare_exchange_strong(T& expected, T desired, std::memory_order success, std::memory_order failure) const {
        return __atomic_compare_exchange_n(word_, &expected, desired, false, static_cast<int>(success),
                                           static_cast<int>(failure));
    }

private:
    T* word_;
};
#endif

}  // namespace detail

/// Adds and returns the value before. T: std::uint32_t or std::uint64_t.
template <class T>
ABUT_HD T atomic_add(T* target, T value) {
#if ABUT_DEVICE_CODE
    if constexpr (sizeof(T) == 8) {
        return static_cast<T>(
            atomicAdd(reinterpret_cast<unsigned long long*>(target), static_cast<unsigned long long>(value)));
    } else {
        return atomicAdd(target, value);
    }
#else
    return detail::atomic_ref<T>(*target).fetch_add(value, std::memory_order_relaxed);
#endif
}

/// Sets bits.
inline ABUT_HD void atomic_or(std::uint32_t* target, std::uint32_t bits) {
#if ABUT_DEVICE_CODE
    atomicOr(target, bits);
#else
    detail::atomic_ref<std::uint32_t>(*target).fetch_or(bits, std::memory_order_relaxed);
#endif
}

/// Swaps, and orders memory: what this thread wrote before is seen by a thread that later swaps the same word, and what
/// that thread wrote before its swap is seen here.
inline ABUT_HD std::uint32_t atomic_exchange_acq_rel(std::uint32_t* target, std::uint32_t value) {
#if ABUT_DEVICE_CODE
    std::uint32_t before;
    asm volatile("atom.acq_rel.gpu.exch.b32 %0, [%1], %2;" : "=r"(before) : "l"(target), "r"(value) : "memory");
    return before;
#else
    return detail::atomic_ref<std::uint32_t>(*target).exchange(value, std::memory_order_acq_rel);
#endif
}

/// Adds 1 and returns the value before, between the members of a group (execution/group.hpp), in memory that they share. On
/// the host they take turns.
inline ABUT_HD std::uint32_t increment_in_group(std::uint32_t* target) {
#if ABUT_DEVICE_CODE
    return atomicAdd(target, 1u);
#else
    return (*target)++;
#endif
}

/// Sets bits, as increment_in_group adds.
inline ABUT_HD void set_bits_in_group(std::uint32_t* target, std::uint32_t bits) {
#if ABUT_DEVICE_CODE
    atomicOr(target, bits);
#else
    *target |= bits;
#endif
}

/// Leaves the lesser of the word and the value there.
inline ABUT_HD void atomic_min(std::uint64_t* target, std::uint64_t value) {
#if ABUT_DEVICE_CODE
    atomicMin(reinterpret_cast<unsigned long long*>(target), static_cast<unsigned long long>(value));
#else
    detail::atomic_ref<std::uint64_t> word(*target);
    std::uint64_t seen = word.load(std::memory_order_relaxed);
    while (value < seen &&
           !word.compare_exchange_strong(seen, value, std::memory_order_relaxed, std::memory_order_relaxed)) {
    }
#endif
}

/// Stores `desired` if the word is `expected`; returns the value before. T as for atomic_add.
template <class T>
ABUT_HD T atomic_compare_exchange(T* target, T expected, T desired) {
#if ABUT_DEVICE_CODE
    if constexpr (sizeof(T) == 8) {
        return atomicCAS(reinterpret_cast<unsigned long long*>(target), static_cast<unsigned long long>(expected),
                         static_cast<unsigned long long>(desired));
    } else {
        return atomicCAS(target, expected, desired);
    }
#else
    detail::atomic_ref<T>(*target).compare_exchange_strong(expected, desired, std::memory_order_relaxed,
                                                           std::memory_order_relaxed);
    return expected;
#endif
}

/// A read and a write that other threads may race with: flags and counters that only ever go up. T as for atomic_add.
template <class T>
ABUT_HD T atomic_load(const T* source) {
#if ABUT_DEVICE_CODE
    return *const_cast<const volatile T*>(source);
#else
    return detail::atomic_ref<T>(*const_cast<T*>(source)).load(std::memory_order_relaxed);
#endif
}

inline ABUT_HD void atomic_store(std::uint32_t* target, std::uint32_t value) {
#if ABUT_DEVICE_CODE
    *const_cast<volatile std::uint32_t*>(target) = value;
#else
    detail::atomic_ref<std::uint32_t>(*target).store(value, std::memory_order_relaxed);
#endif
}

}  // namespace abut::execution
