// SPDX-License-Identifier: MIT
#pragma once

// All that is asked of two shapes: whether they touch, by all that decide it exactly and in either order, whether they are
// within a distance, their contact, and their distance.

#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/hull.hpp>

#include "inputs.hpp"
#include "tables.hpp"

namespace platform {

/// How many samples of a kind. Those whose integers or contacts take long have fewer.
struct samples {
    std::uint64_t filtered = 20'000;
    std::uint64_t rest = 20'000;  ///< of exact, within, contact and distance each: every other, fourth, ... one
};

/// `n` samples of S and U.
template <class S, class U>
void ask_pair(table& to, const char* kind, samples n) {
    using T = abut::scalar_type_of<S>;
    if (!to.asks(kind)) return;
    constexpr bool has_within = abut::distance_decidable<S, U>, has_contact = abut::detail::measurable<S, U>;
    const char* const scalar = name_of<T>;
    std::uint64_t stream = std::same_as<T, float> ? 1 : 2;
    for (const char* c = kind; *c != 0; ++c) stream = 31 * stream + static_cast<unsigned char>(*c);
    answers filtered = to.of(kind, scalar, "filtered"), exact = to.of(kind, scalar, "exact");
    answers* const within = has_within ? new answers(to.of(kind, scalar, "within")) : nullptr;
    answers* const contact = has_contact ? new answers(to.of(kind, scalar, "contact_of")) : nullptr;
    answers* const distance = has_contact ? new answers(to.of(kind, scalar, "distance")) : nullptr;
    const std::uint64_t every = n.filtered / n.rest;
    for (std::uint64_t i = 0; i < n.filtered; ++i) {
        inputs<T> in(stream, i);
        const S s = in.template shape<S>();
        const U t = in.template shape<U>();
        filtered.next(), filtered.add(abut::intersects(s, t));
        // Families go by the number's last four bits.
        if ((i / 16) % every != 0) continue;
        exact.next(), exact.add(abut::intersects<abut::exact>(s, t));
        if constexpr (has_within) {
            within->next(), within->add(abut::within(s, t, in.reach()));
        }
        if constexpr (has_contact) {
            const auto found = abut::contact_of(s, t);
            contact->next(), contact->add(found.has_value());
            if (found) contact->add_members(*found);
            const auto apart = abut::distance(s, t);
            distance->next(), distance->add(apart.distance == 0), distance->add_members(apart);
        }
    }
    delete within;
    delete contact;
    delete distance;
}

}  // namespace platform
