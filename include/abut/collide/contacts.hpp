// SPDX-License-Identifier: MIT
#pragma once

// contacts: where, in which direction and how deep the shapes of one set touch those of another. It is `pairs` with another
// answer: what touches is decided and sorted first, and then each pair gets its contact.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/query.hpp>
#include <abut/narrow/contact.hpp>

namespace abut {

/// @defgroup contacts Contacts of many pairs
///
/// `contacts` of two arguments: where, in which direction and how deep their shapes touch. `reduce_contacts` keeps a few of
/// them that hold two bodies apart nearly as well as all do. docs/contacts.md says what the numbers mean.
///
/// @par Memory
/// Arguments as in @ref queries. Contacts lie in the policy's memory, 36 bytes each in float and 64 in double.
///
/// @par Errors
/// - Of `contacts`: those of @ref queries.
/// - Of `reduce_contacts`: `error` where `bins` is not in 1..1024 or `most` is 0; `capacity_error` for 2^32 contacts or
///   more; `std::bad_alloc`; `cuda_error`.
///
/// @par Synchronisation
/// Each call returns when its contacts are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp contacts
///@{

/// Options of `contacts`; the first ones are those of `query_options`.
template <class Filter = keep_all>
struct contact_options {
    /// Contacts sorted by a, then b. Without it their order is any, and may differ from call to call.
    flag sorted = true;
    /// filter(id in a, id in b) -> bool, as in query_options.
    Filter filter = {};
    /// Which of two plain sets stays close to the cores, as in query_options.
    argument resident = argument::automatic;
    /// Leaves out contacts of two triangles that come apart by a shorter move along the line that their planes share than
    /// along the contact's normal (N. Backman's rule): they pass by each other at an edge or a corner, and tell little of
    /// how the surfaces as a whole lie to each other. Contacts of depth 0, of parallel planes and of other shapes stay.
    flag discard_sideways = false;
};

namespace detail {

/// Whether contacts of two shapes may be discarded, that is: whether they share a line.
template <class S, class U>
inline constexpr bool share_lines = false;
template <scalar T>
inline constexpr bool share_lines<triangle<T>, triangle<T>> = true;

/// Finds out whether two shapes touch, and knows their contact.
template <arithmetic A>
struct touch_and_contact : touch<A> {
    template <class View>
    ABUT_HD auto answer(const View& both, std::uint64_t key) const {
        return both.tagged(key, contact_in_any_order(both.shape_a(key), both.shape_b(key)));
    }
};

/// Whether a contact stays where some are discarded.
template <class View, class Contact>
struct is_not_sideways {
    View both;
    const std::uint64_t* keys;
    const Contact* contacts;

    ABUT_HD bool operator()(std::size_t i) const {
        const auto along_line = overlap_along_shared_line(both.shape_a(keys[i]), both.shape_b(keys[i]));
        return along_line < 0 || !(along_line < contacts[i].depth);
    }
};

/// Whether `contacts` takes both arguments and the filter.
template <class Policy, class X, class Y, class Filter>
consteval bool can_touch() {
    if constexpr (can_pair<Policy, X, Y, Filter>()) {
        using a = typename shape_of_argument<X>::type;
        using b = typename shape_of_argument<Y>::type;
        constexpr bool can = contact_pair<a, b> || contact_pair<b, a>;
        static_assert(can, "abut: there are no contacts of this pair of shapes");
        return can;
    } else {
        return false;
    }
}

/// The contacts of any pairing, of two arguments or of a list.
template <arithmetic A, class Policy, class Pairing>
auto contacts_of(const Policy& on, const Pairing& pairing, bool discard_sideways) {
    using view = typename Pairing::view_type;
    const touch_and_contact<A> judge;
    const auto keys = find_keys(on, pairing, judge);
    auto all = answers_to(on, pairing, judge, keys);
    if constexpr (share_lines<typename view::shape_type_a, typename view::shape_type_b>) {
        using found = typename decltype(all)::value_type;
        if (discard_sideways) {
            return answers_with(on, all, is_not_sideways<view, found>{pairing.view(), keys.data(), all.data()});
        }
    }
    return all;
}

}  // namespace detail

/// The contacts of all pairs of a shape of `a` and a shape of `b` that touch: a `result` of `contact`. There is one for each
/// pair that `pairs` reports of the same arguments, or fewer with `discard_sideways`. They are sorted by a, then b, unless
/// the options say otherwise. Under a pose all numbers are the world's.
///
/// A contact's point is one of both shapes. Its normal has length 1 and points from b to a. Moved by its depth along it, a
/// is apart from b. All of that holds within `contact_bound` of the two shapes. Contacts are bit for bit the same on each
/// policy, whatever the threads and the indices. Those of `fast` are numbers of the same kind for pairs that may not touch.
///
/// Arguments are those of `pairs`: sets, views, single shapes and indices, posed or not.
///
///     for (const auto& c : abut::contacts(abut::openmp{}, part, abut::posed(tool, pose))) {
///         std::printf("%u meets %u, %g deep\n", c.a, c.b, c.depth);
///     }
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all>
[[nodiscard]] auto contacts(const Policy& on, const X& a, const Y& b, const contact_options<Filter>& options = {}) {
    if constexpr (detail::can_touch<Policy, X, Y, Filter>()) {
        const query_options<Filter> query{.sorted = options.sorted, .filter = options.filter, .resident = options.resident};
        return detail::contacts_of<A>(on, detail::pair_up(on, a, b, query, "abut::contacts"), options.discard_sideways);
    } else {
        return result<contact<float>, space_of<Policy>>();
    }
}

///@}

}  // namespace abut
