// SPDX-License-Identifier: MIT
#pragma once

// contacts: where, in which direction and how deep the shapes of one set touch those of another. It is `pairs` and one loop
// more: what touches is decided and sorted first, and then each pair gets its contact.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/query.hpp>
#include <abut/narrow/contact.hpp>

namespace abut {

/// Options of `contacts`; the first ones are those of `query_options`.
template <class Filter = keep_all>
struct contact_options {
    /// Contacts sorted by a, then b. Without it their order is any, and may differ from call to call.
    bool sorted = true;
    /// filter(id in a, id in b) -> bool, as in query_options.
    Filter filter = {};
    /// Which of two plain sets stays close to the cores, as in query_options.
    query_side resident = query_side::automatic;
    /// Leaves out contacts of two triangles that come apart by a shorter move along the line that their planes share than
    /// along the contact's normal (N. Backman's rule): they pass by each other at an edge or a corner, and tell little of
    /// how the surfaces as a whole lie to each other. Contacts of depth 0, of parallel planes and of other shapes stay.
    bool discard_sideways = false;
};

namespace detail {

/// Whether contacts of two shapes may be discarded, that is: whether they share a line.
template <class S, class U>
inline constexpr bool share_lines = false;
template <scalar T>
inline constexpr bool share_lines<triangle<T>, triangle<T>> = true;

template <class Sides>
using contact_of_sides = decltype(contact_in_any_order(typename Sides::query_shape{}, typename Sides::target_shape{}));

/// The contact of each pair.
template <class Sides>
struct fetch_contact {
    Sides sides;
    const std::uint64_t* keys;
    contact_of_sides<Sides>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t key = keys[i];
        const auto query = sides.queries[sides.key.query(key)];
        const auto target = sides.targets[sides.key.target(key)];
        auto found = between(query, target, sides.key.queries_are_b);
        const index_pair ids = sides.key.unpack(key);
        found.a = ids.a;
        found.b = ids.b;
        out[i] = found;
    }

private:
    /// One call for either order: kernels get large enough by one.
    template <class Query, class Target>
    ABUT_HD static auto between(const Query& query, const Target& target, bool queries_are_b) {
        if constexpr (std::same_as<Query, Target>) {
            return contact_between(queries_are_b ? target : query, queries_are_b ? query : target);
        } else {
            const auto found = contact_between(first_of(query, target), second_of(query, target));
            const bool a_is_first = contact_pair<Query, Target> != queries_are_b;
            return a_is_first ? found : reversed(found);
        }
    }
};

/// Whether a contact stays where some are discarded.
template <class Sides>
struct is_not_sideways {
    Sides sides;
    const std::uint64_t* keys;
    const contact_of_sides<Sides>* contacts;

    ABUT_HD bool operator()(std::size_t i) const {
        const auto query = sides.queries[sides.key.query(keys[i])];
        const auto target = sides.targets[sides.key.target(keys[i])];
        // From a's side whoever looks: swapped, the numbers round differently.
        const bool swap = sides.key.queries_are_b;
        const auto along_line = overlap_along_shared_line(swap ? target : query, swap ? query : target);
        return along_line < 0 || !(along_line < contacts[i].depth);
    }
};

template <class Contact>
struct gather_contacts {
    const Contact* from;
    const std::uint64_t* which;
    Contact* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = from[which[i]]; }
};

/// The contacts with test(i), in their order.
template <class Policy, class Contact, class Test>
auto contacts_with(const Policy& on, const execution::buffer_of<Policy, Contact>& all, const Test& test) {
    execution::buffer_of<Policy, std::uint64_t> which(on, all.size());
    const std::size_t n = compact(on, all.size(), test, which.data());
    execution::buffer_of<Policy, Contact> kept(on, n);
    for_each_index(on, n, gather_contacts<Contact>{all.data(), which.data(), kept.data()});
    return kept;
}

}  // namespace detail

/// The contacts of all pairs of a shape of `a` and a shape of `b` that touch: exactly one for each pair that `pairs` reports
/// of the same arguments, sorted by a, then b, unless the options say otherwise; fewer with `discard_sideways`. In the
/// policy's memory, 36 bytes each in float and 64 in double. Under a pose all numbers are the world's.
///
/// A contact's point is one of both shapes, its normal has length 1 and points from b to a, and a moved by its depth along
/// it is apart from b, all within `contact_bound` of the two shapes; docs/contacts.md says what depth is least of. Contacts
/// are bit for bit the same on each policy, whatever the threads, the indices and the sides that look; those of `fast` are
/// numbers of the same kind for pairs that may not touch.
///
/// Arguments are those of `pairs`: sets, views, single shapes and indices, posed or not. So are the errors:
/// invalid_geometry, error, capacity_error, std::bad_alloc and cuda_error. Returns when the contacts are there.
///
///     for (const auto& c : abut::contacts(abut::openmp{}, part, abut::posed(tool, pose))) {
///         std::printf("%u meets %u, %g deep\n", c.a, c.b, c.depth);
///     }
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all>
[[nodiscard]] auto contacts(const Policy& on, const X& a, const Y& b, const contact_options<Filter>& options = {}) {
    const query_options<Filter> query{.sorted = options.sorted, .filter = options.filter, .resident = options.resident};
    const auto body = [&](const auto& both, const auto& run, std::size_t n) {
        using sides_type = std::remove_cvref_t<decltype(both)>;
        using found = detail::contact_of_sides<sides_type>;
        using outcome = result<found, space_of<Policy>>;
        const auto keys = detail::touching_keys(on, both, run, n, options.sorted);
        execution::buffer_of<Policy, found> all(on, keys.size());
        for_each_index(on, keys.size(), detail::fetch_contact<sides_type>{both, keys.data(), all.data()});
        if constexpr (detail::share_lines<typename sides_type::query_shape, typename sides_type::target_shape>) {
            if (options.discard_sideways) {
                all = detail::contacts_with<Policy, found>(
                    on, all, detail::is_not_sideways<sides_type>{both, keys.data(), all.data()});
            }
        }
        synchronize(on);
        return outcome(std::move(all));
    };
    return detail::on_both<A>(on, a, b, query, "abut::contacts", body);
}

}  // namespace abut
