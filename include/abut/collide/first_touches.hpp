// SPDX-License-Identifier: MIT
#pragma once

// The first pair that touches, of two arguments or of each entry of a list: the least key, by the engine of all queries
// (search.hpp). `distance` is 0 there, and measures nothing.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/judge.hpp>
#include <abut/collide/placed.hpp>
#include <abut/collide/search.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/least_ids.hpp>

namespace abut::detail {

/// The key of no pair.
inline constexpr std::uint64_t no_pair = static_cast<std::uint64_t>(-1);

/// A filter: pairs before the first one that is known to touch. So where much touches, little of it is decided; and where
/// the trees' least ids are given, little of the trees is walked (routes.hpp).
template <class Key>
struct before_first_touch {
    Key key{};
    const std::uint64_t* first = nullptr;  ///< of each entry
    const std::uint32_t *const *least_a = nullptr, *const *least_b = nullptr;
    std::uint32_t* left_out = nullptr;  ///< on a host: how many were, about
    std::uint32_t enough = 0;           ///< of them

    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const {
        return counted(key.pack(a, b) < execution::atomic_load(first));
    }
    /// Of a list.
    template <class Tagged>
    ABUT_HD bool operator()(const Tagged& of) const {
        return counted(key.pack(of.pair, of.a, of.b) < execution::atomic_load(first + of.pair));
    }
    /// Whether so many are left out that to know the least ids would have taken less.
    [[nodiscard]] ABUT_HD bool is_enough() const {
#if !ABUT_DEVICE_CODE
        return left_out != nullptr && execution::atomic_load(left_out) > enough;
#else
        return false;
#endif
    }

private:
    [[nodiscard]] ABUT_HD bool counted(bool is_before) const {
#if !ABUT_DEVICE_CODE
        if (!is_before && left_out != nullptr) execution::atomic_store(left_out, execution::atomic_load(left_out) + 1);
#endif
        return is_before;
    }
};
/// Takes pairs that touch.
template <class Key>
struct keep_first_touch {
    static constexpr bool eager = true;
    Key key;
    std::uint64_t* first;
    ABUT_HD bool operator()(std::uint64_t pair) const {
        std::size_t entry = 0;
        if constexpr (requires { key.entry_bits; }) entry = key.unpack(pair).entry;
        execution::atomic_min(first + entry, pair);
        return true;
    }
};

/// The trees of an operand or of bodies.
///@{
template <may_have_least_ids Operand>
auto trees_with_least_ids(const Operand& x) {
    return std::span(&x.tree_with_least_ids(), 1);
}
template <class Index>
auto trees_with_least_ids(const placed_bodies<Index>& x) {
    return std::span(std::as_const(x.objects->indices));
}
///@}

template <class Trees>
bool have_least_ids(const Trees& trees) {
    return std::all_of(trees.begin(), trees.end(), [](const auto& tree) { return own_least_ids(tree) != nullptr; });
}
template <class Trees>
std::size_t shapes_of(const Trees& trees) {
    std::size_t all = 0;
    for (const auto& tree : trees) all += tree.size();
    return all;
}
/// The least ids of all trees of one side, by trees: those that a tree has, or made for one query.
class ids_of_trees {
public:
    template <class Trees>
    explicit ids_of_trees(const Trees& trees) {
        for (const auto& tree : trees) {
            const std::uint32_t* of_nodes = own_least_ids(tree);
            if (of_nodes == nullptr) of_nodes = made_.emplace_back(least_ids_of_nodes(tree.view())).data();
            all_.push_back(of_nodes);
        }
    }
    [[nodiscard]] const std::uint32_t* const* data() const { return all_.data(); }

private:
    std::vector<std::vector<std::uint32_t>> made_;
    std::vector<const std::uint32_t*> all_;
};

/// For each of n entries the least key of a pair that touches, or no_pair. Of two arguments there is one entry.
///
/// A host walks by least ids. Of trees that do not keep them it makes them when so much is left out that they would have
/// taken less, and goes on from what it has found. A device opens thousands of pairs of nodes
/// at a time, before it knows any that touches.
template <class Policy, class Pairing>
auto first_touches(const Policy& on, Pairing& pairing, std::size_t n) {
    using key_type = decltype(pairing.key);
    execution::buffer_of<Policy, std::uint64_t> first(on, n);
    fill(on, first.data(), n, no_pair);
    auto& filter = pairing.options.filter;
    filter = {pairing.key, first.data()};
    const auto look = [&] {
        const keep_first_touch<key_type> keeps{pairing.key, first.data()};
        execution::work_visit<keep_first_touch<key_type>, space_of<Policy>> hits(on, keeps);
        search(on, pairing, touch<filtered>{}, hits);
    };
    if constexpr (host_policy<Policy> && requires { trees_with_least_ids(pairing.a), trees_with_least_ids(pairing.b); }) {
        const auto a = trees_with_least_ids(pairing.a);
        const auto b = trees_with_least_ids(pairing.b);
        // Of one entry there is one tree on each side. One of a single shape is not walked with the other.
        if (n > 1 || (n == 1 && a[0].size() > 1 && b[0].size() > 1)) {
            bool by_ids = have_least_ids(a) && have_least_ids(b);
            if (!by_ids) {
                std::uint32_t left_out = 0;
                filter.left_out = &left_out;
                filter.enough = static_cast<std::uint32_t>(std::min<std::size_t>((shapes_of(a) + shapes_of(b)) / 16, 1u << 30)) + 64;
                look();
                by_ids = filter.is_enough();
                filter.left_out = nullptr;
            }
            if (by_ids) {
                const ids_of_trees of_a(a), of_b(b);
                filter.least_a = of_a.data(), filter.least_b = of_b.data();
                look();
            }
            filter = {};
            return first;
        }
    }
    look();
    filter = {};
    return first;
}

}  // namespace abut::detail
