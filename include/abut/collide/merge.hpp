// SPDX-License-Identifier: MIT
#pragma once

// Lists that parts of a query have found, each in order, become one.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/collide/options.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/parallel.hpp>
#include <abut/shape/equal_elements.hpp>

namespace abut::detail {

struct by_ids {
    template <class Found>
    ABUT_HD bool operator()(const Found& x, const Found& y) const {
        return x.a < y.a || (x.a == y.a && x.b < y.b);
    }
};
struct by_number {
    ABUT_HD bool operator()(std::uint64_t x, std::uint64_t y) const { return x < y; }
};
/// Lists in the order of their keys, one after another, become one. Of equal keys those of earlier lists come first.
template <class Order, class Key, class Found>
struct merge_lists {
    Order comes_before;
    const Key* keys;
    const Found* found;
    const std::size_t* first;  ///< of each list, and the number of all
    std::size_t lists;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const {
        const Key mine = keys[i];
        std::size_t place = 0;
        for (std::size_t k = 0; k < lists; ++k) {
            std::size_t lower = first[k], upper = first[k + 1];
            if (lower <= i && i < upper) {
                lower = i;
            } else {
                const bool is_earlier = upper <= i;
                while (lower < upper) {
                    const std::size_t middle = lower + (upper - lower) / 2;
                    if (is_earlier ? !comes_before(mine, keys[middle]) : comes_before(keys[middle], mine)) {
                        lower = middle + 1;
                    } else {
                        upper = middle;
                    }
                }
            }
            place += lower - first[k];
        }
        out[place] = found[i];
    }
};

/// Whether list k + 1 does not go on where list k ends.
template <class Order, class Key>
struct is_out_of_order {
    Order comes_before;
    const Key* keys;
    const std::size_t *first, *last;
    ABUT_HD bool operator()(std::size_t k) const {
        const std::size_t i = first[k + 1];
        return i > 0 && i < *last && !comes_before(keys[i - 1], keys[i]);
    }
};

/// Lists one after another: where each begins, and where the last one ends.
template <class Lists>
std::vector<std::size_t> beginnings_of(const Lists& lists) {
    std::vector<std::size_t> first{0};
    for (const auto& list : lists) first.push_back(first.back() + list.size());
    return first;
}
/// Such lists become one in the order of their keys, in which each of them is. Long ones may be so already, as where parts
/// have ids one after another.
template <class Policy, class Order, class Key, class Found>
auto merged_by(const Policy& on, const Order& order, const Key* keys, execution::buffer_of<Policy, Found> all,
               const std::vector<std::size_t>& first) {
    constexpr std::size_t many = std::size_t{1} << 20;
    const std::size_t lists = first.size() - 1;
    execution::buffer_of<Policy, std::size_t> begins(on, first.size());
    upload(on, first.data(), first.size(), begins.data());
    const is_out_of_order<Order, Key> out_of_order{order, keys, begins.data(), begins.data() + lists};
    if (all.size() >= many &&
        reduce(on, lists - 1, std::uint64_t{0}, add_up_tallies{}, one_if<is_out_of_order<Order, Key>>{out_of_order}) == 0) {
        return all;
    }
    execution::buffer_of<Policy, Found> in_order(on, all.size());
    for_each_index(on, all.size(),
                   merge_lists<Order, Key, Found>{order, keys, all.data(), begins.data(), lists, in_order.data()});
    synchronize(on);
    return in_order;
}
/// Such lists become one, in order if they are and `sorted` is.
template <class Policy, class Found, class Order = by_ids>
auto merged(const Policy& on, execution::buffer_of<Policy, Found> all, const std::vector<std::size_t>& first, bool sorted,
            const Order& order = {}) {
    const Found* const keys = all.data();
    if (sorted && all.size() > 0) all = merged_by(on, order, keys, std::move(all), first);
    return result<Found, space_of<Policy>>(std::move(all));
}

template <class Local, class Found>
using found_lists = std::vector<result<Found, space_of<Local>>>;
/// `lists` as one, if there are any.
template <class Policy, class Found, class Order = by_ids>
auto joined(const Policy& on, found_lists<Policy, Found> lists, bool sorted, const Order& order = {}) {
    if (lists.size() == 1) return std::move(lists.front());
    const auto first = beginnings_of(lists);
    execution::buffer_of<Policy, Found> all(on, first.back());
    for (std::size_t k = 0; k < lists.size(); ++k) {
        copy(on, lists[k].data(), lists[k].size(), all.data() + first[k]);
        lists[k] = {};
    }
    synchronize(on);
    return merged(on, std::move(all), first, sorted, order);
}

}  // namespace abut::detail
