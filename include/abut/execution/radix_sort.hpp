// SPDX-License-Identifier: MIT
#pragma once

// Radix sort for unsigned keys, by the loops of any policy: the standard library has no sort of keys with values that runs
// on OpenMP, and std::sort takes 5 to 8 times as long on 32-bit codes.
//
// One thread sorts by the least significant digit first. Threads do so together only where most keys agree in the highest
// digit: threads that write to the same cache lines in each pass wait for each other. Else they divide the keys into buckets
// by that digit, and each bucket is then one thread's.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/execution/buffer.hpp>

namespace abut::execution {

namespace detail {

/// [0, n) in contiguous parts of nearly one size.
struct equal_parts {
    std::size_t n, count;
    [[nodiscard]] ABUT_HD std::size_t begin(std::size_t part) const {
        const std::size_t longer = n % count;
        return n / count * part + (part < longer ? part : longer);
    }
    [[nodiscard]] ABUT_HD std::size_t end(std::size_t part) const { return begin(part + 1); }
};

/// As many parts as keep the policy busy; small ones are not worth it.
template <class Policy>
equal_parts parts_for(const Policy& on, std::size_t n) {
    constexpr std::size_t least = 2048;
    return {n, std::clamp<std::size_t>(n / least, 1, static_cast<std::size_t>(concurrency(on)))};
}

/// One digit of all keys.
template <class Key>
struct digit_of_keys {
    static constexpr int most_bits = 11;
    const Key* keys;
    int shift;
    Key mask;
    [[nodiscard]] ABUT_HD std::size_t values() const { return static_cast<std::size_t>(mask) + 1; }
    [[nodiscard]] ABUT_HD std::size_t operator()(std::size_t i) const {
        return static_cast<std::size_t>(keys[i] >> shift & mask);
    }
};

/// How often each part has each value of the digit.
template <class Key>
struct count_digits {
    digit_of_keys<Key> digit;
    equal_parts parts;
    std::size_t* counts;
    ABUT_HD void operator()(std::size_t part) const {
        std::size_t* const mine = counts + part * digit.values();
        for (std::size_t d = 0; d < digit.values(); ++d) mine[d] = 0;
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) ++mine[digit(i)];
    }
};

/// Where each part's keys of each digit go, in place of their counts; then how many keys the most frequent digit has. It
/// goes row by row, since the counts of a part are kilobytes from those of the next.
struct offset_digits {
    std::size_t values;
    equal_parts parts;
    std::size_t* counts;
    ABUT_HD void operator()(std::size_t) const {
        const std::size_t before_last = parts.count - 1;
        // First the counts of all parts, then where the next part's keys go.
        std::size_t* const last = counts + before_last * values;
        for (std::size_t part = 0; part < before_last; ++part) {
            for (std::size_t d = 0; d < values; ++d) last[d] += counts[part * values + d];
        }
        std::size_t offset = 0, most = 0;
        for (std::size_t d = 0; d < values; ++d) {
            const std::size_t all = last[d];
            last[d] = offset;
            offset += all;
            most = most < all ? all : most;
        }
        for (std::size_t part = 0; part < before_last; ++part) {
            for (std::size_t d = 0; d < values; ++d) {
                const std::size_t mine = counts[part * values + d];
                counts[part * values + d] = last[d];
                last[d] += mine;
            }
        }
        last[values] = most;
    }
};

template <class Key, class Value>
struct move_by_digit {
    digit_of_keys<Key> digit;
    equal_parts parts;
    std::size_t* offsets;
    const Value* values;  ///< or null
    Key* moved_keys;
    Value* moved_values;
    ABUT_HD void operator()(std::size_t part) const {
        std::size_t* const next = offsets + part * digit.values();
        for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
            const std::size_t to = next[digit(i)]++;
            moved_keys[to] = digit.keys[i];
            if (values != nullptr) moved_values[to] = values[i];
        }
    }
};

/// Sorts the keys of one bucket by their lowest bits: from one memory to the other and back, an odd number of times.
template <class Key, class Value>
struct sort_bucket {
    static constexpr int most_bits = 8;
    const std::size_t* ends;  ///< of the buckets
    int bits;
    Key *from, *to;
    Value *values_from, *values_to;  ///< or null
    ABUT_HD void operator()(std::size_t bucket) const {
        const std::size_t begin = bucket == 0 ? 0 : ends[bucket - 1], end = ends[bucket];
        const int digits = (bits + most_bits - 1) / most_bits | 1, longest = (bits + digits - 1) / digits;
        sort_bucket now = *this;
        for (int shift = 0; shift < bits; shift += longest) {
            const int width = bits - shift < longest ? bits - shift : longest;
            now.move({now.from, shift, static_cast<Key>((Key{1} << width) - 1)}, begin, end);
            now = {ends, bits, now.to, now.from, now.values_to, now.values_from};
        }
    }

private:
    ABUT_HD void move(const digit_of_keys<Key>& digit, std::size_t begin, std::size_t end) const {
        std::size_t next[std::size_t{1} << most_bits] = {};
        for (std::size_t i = begin; i < end; ++i) ++next[digit(i)];
        std::size_t offset = begin;
        for (std::size_t d = 0; d < digit.values(); ++d) {
            const std::size_t all = next[d];
            next[d] = offset;
            offset += all;
        }
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t at = next[digit(i)]++;
            to[at] = from[i];
            if (values_from != nullptr) values_to[at] = values_from[i];
        }
    }
};

/// A digit's counts and offsets. Returns how many keys the most frequent digit has.
template <class Policy, class Key, memory_space Space>
std::size_t count_and_offset(const Policy& on, const digit_of_keys<Key>& digit, const equal_parts& parts,
                             buffer<std::size_t, Space>& counts) {
    for_each_task(on, parts.count, count_digits<Key>{digit, parts, counts.data()});
    for_each_task(on, 1, offset_digits{digit.values(), parts, counts.data()});
    std::size_t most = 0;
    download(on, counts.data() + parts.count * digit.values(), 1, &most);
    return most;
}

}  // namespace detail

/// Sorts by the lowest `bits` bits, stable, and carries `values` along unless it is null. Uses as much memory again. Digits
/// are of nearly one length: short ones have few counts.
template <class Policy, class Key, class Value, memory_space Space>
void radix_sort(const Policy& on, buffer<Key, Space>& keys, buffer<Value, Space>* values, int bits) {
    using digit = detail::digit_of_keys<Key>;
    using bucket = detail::sort_bucket<Key, Value>;
    const int digits = (bits + digit::most_bits - 1) / digit::most_bits;
    const std::size_t n = keys.size();
    if (digits <= 0 || n < 2) return;
    const int longest = (bits + digits - 1) / digits;
    const detail::equal_parts parts = detail::parts_for(on, n);
    buffer<std::size_t, Space> counts(on, (parts.count << std::max(longest, bucket::most_bits)) + 1);
    buffer<Key, Space> other_keys(on, n);
    buffer<Value, Space> other_values(on, values ? n : 0);
    const auto move = [&](const digit& of) {
        for_each_task(on, parts.count,
                      detail::move_by_digit<Key, Value>{of, parts, counts.data(), values ? values->data() : nullptr,
                                                        other_keys.data(), other_values.data()});
        keys.swap(other_keys);
        if (values) values->swap(other_values);
    };
    if (parts.count > 1) {
        const int highest = std::min(bits, bucket::most_bits), rest = bits - highest;
        const digit of{keys.data(), rest, static_cast<Key>((Key{1} << highest) - 1)};
        const std::size_t most = count_and_offset(on, of, parts, counts);
        if (most <= n / parts.count * 4) {  // no thread will have far more than its share
            move(of);
            if (rest == 0) return;
            // What has been moved was moved to the end of each bucket, by the last part.
            const std::size_t* const ends = counts.data() + (parts.count - 1) * of.values();
            for_each_task(on, of.values(),
                          bucket{ends, rest, keys.data(), other_keys.data(), values ? values->data() : nullptr,
                                 other_values.data()});
            keys.swap(other_keys);
            if (values) values->swap(other_values);
            return;
        }
    }
    for (int shift = 0; shift < bits; shift += longest) {
        const int width = std::min(bits - shift, longest);
        const digit of{keys.data(), shift, static_cast<Key>((Key{1} << width) - 1)};
        if (count_and_offset(on, of, parts, counts) < n) move(of);
    }
}

}  // namespace abut::execution
