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
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const {
        return key.pack(a, b) < execution::atomic_load(first);
    }
    /// Of a list.
    template <class Tagged>
    ABUT_HD bool operator()(const Tagged& of) const {
        return key.pack(of.pair, of.a, of.b) < execution::atomic_load(first + of.pair);
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

/// The trees of an operand or of bodies, if they may have least ids.
///@{
template <may_have_least_ids Operand>
auto trees_with_least_ids(const Operand& x) {
    return std::span(&x.tree_with_least_ids(), 1);
}
template <keeps_least_ids Index>
auto trees_with_least_ids(const placed_bodies<Index>& x) {
    return std::span(std::as_const(x.objects->indices));
}
///@}

template <class Trees>
bool have_least_ids(const Trees& trees) {
    return std::all_of(trees.begin(), trees.end(), [](const auto& tree) { return tree.stored().least_ids != nullptr; });
}
/// The least ids of all trees of one side, by trees: those that a tree has, or made for one query.
template <class Policy>
class ids_of_trees {
public:
    template <class Trees>
    ids_of_trees(const Policy& policy, const Trees& trees) {
        for (const auto& tree : trees) {
            const auto view = tree.view();
            const auto& own = tree.stored();
            if (own.least_ids == nullptr) made_.push_back(make_least_ids(policy, view.nodes, own.nodes.size(), view.top));
            all_.push_back(own.least_ids == nullptr ? made_.back().data() : own.least_ids->data());
        }
    }
    [[nodiscard]] const std::uint32_t* const* data() const { return all_.data(); }

private:
    std::vector<execution::buffer_of<Policy, std::uint32_t>> made_;
    std::vector<const std::uint32_t*> all_;
};

/// For each of n entries the least key of a pair that touches, or no_pair. Of two arguments there is one entry.
///
/// A host walks by least ids, of two trees if both have them: to make them takes as long as many a search. For a list they
/// are made, but only if anything touches at all. A device opens thousands of pairs of nodes at a time, before it knows any
/// that touches.
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
        const bool are_there = have_least_ids(a) && have_least_ids(b);
        // Of one entry there is one tree on each side. One of a single shape is not walked with the other.
        if (n > 1 || (n == 1 && are_there && a[0].size() > 1 && b[0].size() > 1)) {
            execution::work_flag<host_space> any(on);
            if (!are_there) search(on, pairing, touch<filtered>{}, any);
            if (are_there || any.raised()) {
                const ids_of_trees<Policy> of_a(on, a), of_b(on, b);
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
