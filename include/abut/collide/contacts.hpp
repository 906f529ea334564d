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

/// Their contacts.
struct all_contacts {
    static constexpr answer_kind kind = answer_kind::list;
    bool discard_sideways = false;
    template <class Form, scalar T>
    using found_type = typename Form::template contact_type<T>;

    template <class S, class U>
    static consteval bool takes() {
        constexpr bool can = contact_pair<S, U> || contact_pair<U, S>;
        static_assert(can, "abut: there are no contacts of this pair of shapes; a shape of your own needs contact_between(s, t) beside it (docs/extending.md)");
        return can;
    }
    template <arithmetic A, class Relation>
    [[nodiscard]] touch_and_contact<A> judge(const Relation&) const {
        return {};
    }
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] auto find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        using view = typename Pairing::view_type;
        const auto contacts = judge<A>(how);
        const auto keys = find_keys(on, pairing, contacts);
        auto all = answers_to(on, pairing, contacts, keys);
        if constexpr (share_lines<typename view::shape_type_a, typename view::shape_type_b>) {
            using found = typename decltype(all)::value_type;
            if (discard_sideways) {
                return answers_with(on, all, is_not_sideways<view, found>{pairing.view(), keys.data(), all.data()});
            }
        }
        return all;
    }
    template <class Form, class Policy>
    static auto nothing() {
        return result<typename Form::template contact_type<float>, space_of<Policy>>();
    }
};

}  // namespace detail

/// The contacts of all pairs of a shape of `a` and a shape of `b` that touch: a `result` of `contact`. There is one for each
/// pair that `pairs` reports of the same arguments, or fewer with `discard_sideways`. They are sorted by a, then b, unless
/// the options say otherwise. Under a pose all numbers are the world's.
///
/// A contact's point is one of both shapes. Its normal has length 1 and points from b to a. Moved by its depth along it, a
/// is apart from b. All of that holds within `contact_bound` of the two shapes. Contacts are bit for bit the same on each
/// policy, whatever the threads and the indices. Those of `fast` are numbers of the same kind for pairs that may not touch.
///
/// Arguments are those of `pairs`: sets, views, single shapes and indices, posed or not. Of several devices the result lies in
/// memory of the first; of ranks it is of `global_contact`, 40 bytes each in float and 72 in double, of the pairs of the
/// rank's own a-shapes.
///
///     for (const auto& c : abut::contacts(abut::openmp{}, part, abut::posed(tool, pose))) {
///         std::printf("%u meets %u, %g deep\n", c.a, c.b, c.depth);
///     }
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all>
    requires(!detail::scene<X>)
[[nodiscard]] auto contacts(const On& on, const X& a, const Y& b, const contact_options<Filter>& options = {}) {
    const query_options<Filter> query{.sorted = options.sorted, .filter = options.filter, .resident = options.resident};
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_contacts{options.discard_sideways}),
                     detail::two{a, b}, query, "abut::contacts");
}

/// The same of a list, a `result` of `tagged_contact`, which has the entry's position, 40 bytes each in float and 72 in
/// double (of ranks `global_tagged_contact`, 48 and 72); or of bodies, of `body_contact`, 44 and 72.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto contacts(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_contacts{options.discard_sideways}),
                     detail::whole(scene), options, "abut::contacts");
}

///@}

}  // namespace abut
