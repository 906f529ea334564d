// SPDX-License-Identifier: MIT
#pragma once

// Least significant digit radix sort for unsigned keys, by the loops of any policy: the standard library has no sort of keys
// with values that runs on OpenMP, and std::sort takes 5 to 8 times as long on 32-bit codes.

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
    constexpr std::size_t least = 8192;
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

/// Where each part's keys of each digit go, in place of their counts; then whether all keys agree in the digit. It goes row by
/// row, since the counts of a part are kilobytes from those of the next.
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
        std::size_t offset = 0, agree = 0;
        for (std::size_t d = 0; d < values; ++d) {
            const std::size_t all = last[d];
            last[d] = offset;
            offset += all;
            agree |= static_cast<std::size_t>(all == parts.n);
        }
        for (std::size_t part = 0; part < before_last; ++part) {
            for (std::size_t d = 0; d < values; ++d) {
                const std::size_t mine = counts[part * values + d];
                counts[part * values + d] = last[d];
                last[d] += mine;
            }
        }
        last[values] = agree;
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

}  // namespace detail

/// Sorts by the lowest `bits` bits, stable, and carries `values` along unless it is null. Uses as much memory again. Digits
/// are of nearly one length: short ones have few counts.
template <class Policy, class Key, class Value, memory_space Space>
void radix_sort(const Policy& on, buffer<Key, Space>& keys, buffer<Value, Space>* values, int bits) {
    using digit = detail::digit_of_keys<Key>;
    const int digits = (bits + digit::most_bits - 1) / digit::most_bits;
    if (digits <= 0) return;
    const int longest = (bits + digits - 1) / digits;
    const std::size_t n = keys.size();
    const detail::equal_parts parts = detail::parts_for(on, n);
    buffer<std::size_t, Space> counts(on, (parts.count << longest) + 1);
    buffer<Key, Space> other_keys(on, n);
    buffer<Value, Space> other_values(on, values ? n : 0);
    for (int shift = 0; shift < bits; shift += longest) {
        const int width = std::min(bits - shift, longest);
        const digit of{keys.data(), shift, static_cast<Key>((Key{1} << width) - 1)};
        for_each_task(on, parts.count, detail::count_digits<Key>{of, parts, counts.data()});
        for_each_task(on, 1, detail::offset_digits{of.values(), parts, counts.data()});
        std::size_t agree = 0;
        download(on, counts.data() + parts.count * of.values(), 1, &agree);
        if (agree != 0) continue;
        for_each_task(on, parts.count,
                      detail::move_by_digit<Key, Value>{of, parts, counts.data(), values ? values->data() : nullptr,
                                                        other_keys.data(), other_values.data()});
        keys.swap(other_keys);
        if (values) values->swap(other_values);
    }
}

}  // namespace abut::execution
