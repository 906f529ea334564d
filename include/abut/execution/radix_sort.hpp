// SPDX-License-Identifier: MIT
#pragma once

// Least significant digit radix sort for unsigned keys in host memory, serial or on OpenMP threads: the standard library
// has no sort of keys with values that runs on OpenMP, and std::sort takes 5 to 8 times as long on 32-bit codes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/parallel.hpp>

namespace abut::execution {

namespace detail {

inline constexpr int digit_bits = 11;
inline constexpr std::size_t digits = std::size_t{1} << digit_bits;
using histogram = std::array<std::size_t, digits>;

/// One stable pass on the digit at `shift`. Each thread counts and scatters its own contiguous part. Returns false, having
/// moved nothing, if all keys agree in the digit.
template <class Key, class Move>
bool radix_pass(int threads, const Key* keys, std::size_t n, int shift, Key mask, std::vector<histogram>& counts,
                const Move& move) {
    const auto digit = [=](Key key) { return static_cast<std::size_t>(key >> shift & mask); };
    for_each_part(threads, n, [&](int part, std::size_t begin, std::size_t end) {
        histogram& count = counts[static_cast<std::size_t>(part)];
        count.fill(0);
        for (std::size_t i = begin; i < end; ++i) ++count[digit(keys[i])];
    });
    std::size_t offset = 0;
    for (std::size_t d = 0; d < digits; ++d) {
        const std::size_t before = offset;
        for (histogram& count : counts) offset += std::exchange(count[d], offset);
        if (offset - before == n) return false;
    }
    for_each_part(threads, n, [&](int part, std::size_t begin, std::size_t end) {
        histogram& next = counts[static_cast<std::size_t>(part)];
        for (std::size_t i = begin; i < end; ++i) move(i, next[digit(keys[i])]++);
    });
    return true;
}

}  // namespace detail

/// Sorts by the lowest `bits` bits, stable, and carries `values` along unless it is null. Uses as much memory again.
template <class Policy, class Key, class Value>
void radix_sort(const Policy& on, buffer<Key, host_space>& keys, buffer<Value, host_space>* values, int bits) {
    const std::size_t n = keys.size();
    const int threads = n < 16384 ? 1 : thread_count(on);
    std::vector<detail::histogram> counts(static_cast<std::size_t>(threads));
    buffer<Key, host_space> other_keys(on, n);
    buffer<Value, host_space> other_values(on, values ? n : 0);
    for (int shift = 0; shift < bits; shift += detail::digit_bits) {
        const Key* const key = keys.data();
        const Value* const value = values ? values->data() : nullptr;
        Key* const moved_key = other_keys.data();
        Value* const moved_value = other_values.data();
        const int width = std::min(bits - shift, detail::digit_bits);
        const auto mask = static_cast<Key>((Key{1} << width) - 1);
        const bool moved = detail::radix_pass(threads, key, n, shift, mask, counts, [=](std::size_t from, std::size_t to) {
            moved_key[to] = key[from];
            if (value) moved_value[to] = value[from];
        });
        if (!moved) continue;
        keys.swap(other_keys);
        if (values) values->swap(other_values);
    }
}

}  // namespace abut::execution
