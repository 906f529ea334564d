// SPDX-License-Identifier: MIT
#pragma once

// `contact_of`: where, in which direction and how deep two shapes touch, if they do. Whether they do is decided exactly;
// point, normal and depth are rounded, within `contact_bound`. docs/contacts.md says what they mean for each pair of shapes.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/narrow/box_contact.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/half_space_contact.hpp>
#include <abut/narrow/hull_contact.hpp>
#include <abut/narrow/plain_box.hpp>
#include <abut/narrow/plain_oriented.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/narrow/revolution_hull_contact.hpp>
#include <abut/narrow/revolution_pair_contact.hpp>
#include <abut/narrow/round_contact.hpp>
#include <abut/narrow/triangle_contact.hpp>
#include <abut/predicate/as_hull.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// A contact, or none. std::optional is not for kernels.
/// @ingroup one_pair
template <scalar T>
class optional_contact {
public:
    using value_type = contact<T>;  ///< what it may hold

    /// None.
    constexpr optional_contact() = default;
    /// One.
    ABUT_HD constexpr optional_contact(const contact<T>& value) : value_(value), has_value_(true) {}

    /// Whether there is one.
    ///@{
    [[nodiscard]] ABUT_HD constexpr bool has_value() const { return has_value_; }
    ABUT_HD constexpr explicit operator bool() const { return has_value_; }
    ///@}
    /// The contact, only where there is one: that is not checked.
    ///@{
    [[nodiscard]] ABUT_HD constexpr const contact<T>& value() const { return value_; }
    [[nodiscard]] ABUT_HD constexpr const contact<T>& operator*() const { return value_; }
    [[nodiscard]] ABUT_HD constexpr const contact<T>* operator->() const { return &value_; }
    ///@}

    friend constexpr bool operator==(const optional_contact&, const optional_contact&) = default;

private:
    contact<T> value_{};
    bool has_value_ = false;
};

namespace detail {

/// Pairs of shapes, in this order, of which contacts are written.
template <class S, class U>
concept contact_pair = requires(const hull_form_of<S>& s, const hull_form_of<U>& t) {
    contact_between(s, t);
};

/// Those whose closed form may tell the contact, and whether there is one.
template <class S, class U>
concept has_first_contact =
    contact_pair<S, U> && requires(const S& s, const U& t) { first_contact_of(s, t, plain_pair<S, U>(s, t)); };

/// The same of what is decided about both, in either order.
template <class S, class U>
concept has_early_contact = has_first_contact<hull_form_of<S>, hull_form_of<U>> ||
                            (!contact_pair<S, U> && has_first_contact<hull_form_of<U>, hull_form_of<S>>);

/// In either order.
template <class S, class U>
ABUT_HD constexpr auto contact_in_any_order(const S& s, const U& t) {
    if constexpr (seen_as_hull<S> || seen_as_hull<U>) {
        const auto a = hull_form(s);
        const auto b = hull_form(t);
        return contact_in_any_order(a.as_hull(), b.as_hull());
    } else if constexpr (contact_pair<S, U>) {
        if constexpr (refers_to_memory<S> && has_first_contact<S, U>) {
            if (const auto first = first_contact_of(s, t, plain_pair<S, U>(s, t)); first.touch == verdict::yes)
                return first.found;
        }
        return contact_between(s, t);
    } else if constexpr (contact_pair<U, S>) {
        return reversed(contact_in_any_order(t, s));
    } else {
        static_assert(contact_pair<U, S>, "abut: there are no contacts of this pair of shapes; a shape of your own needs contact_between(s, t) beside it (docs/extending.md)");
        return contact<scalar_type_of<S>>{};
    }
}

/// What the closed form tells, nothing where there is none.
template <scalar T, class S, class U>
ABUT_INLINE ABUT_HD constexpr first_contact<T> first_contact_in_any_order(const S& s, const U& t) {
    if constexpr (seen_as_hull<S> || seen_as_hull<U>) {
        if constexpr (has_first_contact<S, U>) {
            const auto first = first_contact_of(s, t, plain_pair<S, U>(s, t));
            if (first.touch != verdict::unknown) return first;
        } else if constexpr (has_first_contact<U, S>) {
            const auto first = first_contact_of(t, s, plain_pair<U, S>(t, s));
            if (first.touch != verdict::unknown) return {first.touch, reversed(first.found)};
        }
        const auto a = hull_form(s);
        const auto b = hull_form(t);
        return first_contact_in_any_order<T>(a.as_hull(), b.as_hull());
    } else if constexpr (has_first_contact<S, U>) {
        return first_contact_of(s, t, plain_pair<S, U>(s, t));
    } else if constexpr (!contact_pair<S, U> && has_first_contact<U, S>) {
        const auto first = first_contact_of(t, s, plain_pair<U, S>(t, s));
        return {first.touch, reversed(first.found)};
    } else {
        return {};
    }
}

/// Those of which a search for the contact tells early that they touch, but for boxes with what a filter knows of them sooner.
template <class S, class U>
concept has_searched_contact = !requires(const S& s, const U& t) { near_oriented(s, t); } &&
                               requires(const hull_form_of<S>& s, const hull_form_of<U>& t) { search_contact(s, t); };

/// Decided, and asked, where the closed form does not tell.
template <arithmetic A, scalar T, class S, class U>
ABUT_NOINLINE ABUT_HD constexpr optional_contact<T> contact_by_stages(const S& s, const U& t) {
    if constexpr (std::same_as<A, filtered> && has_searched_contact<S, U>) {
        if (!ABUT_CONSTANT_EVALUATED()) {  // nothing may overflow there
            const auto a = hull_form(s);
            const auto b = hull_form(t);
            const contact_in_doubles<T> known = search_contact(a.as_hull(), b.as_hull());
            if (known.touch == verdict::no) return {};
            if (known.touch == verdict::yes && known.is_known) return known.found;
        }
    } else if constexpr (std::same_as<A, filtered> && has_searched_contact<U, S>) {
        const optional_contact<T> found = contact_by_stages<A, T>(t, s);
        if (!found) return {};
        return reversed(*found);
    }
    if (!intersects<A>(s, t)) return {};
    return contact_in_any_order(s, t);
}

}  // namespace detail

/// The contact of two closed shapes, with ids 0, or none where they do not touch. It takes the pairs that docs/contacts.md
/// lists, in either order. Whether they touch is decided as by `intersects<A>`. The numbers are the same bits for each A and
/// on every compiler and device, in constant expressions too.
///
///     constexpr auto c = abut::contact_of(abut::sphere<float>{{0, 0, 4}, 5},
///                                         abut::triangle<float>{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}});
///     static_assert(c && c->depth == 1 && c->normal == abut::vec3<float>{0, 0, 1});
/// @ingroup one_pair
template <arithmetic A = filtered, class S, class U>
[[nodiscard]] ABUT_INLINE ABUT_HD constexpr auto contact_of(const S& s, const U& t) {
    using found = decltype(detail::contact_in_any_order(s, t));
    using T = decltype(found::depth);
    const auto& a = detail::as_stored(s);
    const auto& b = detail::as_stored(t);
    constexpr bool is_searched = detail::has_searched_contact<S, U> || detail::has_searched_contact<U, S>;
    if constexpr (std::same_as<A, filtered> && is_searched && !detail::has_early_contact<S, U>) {
        const optional_contact<T> found_by_search = detail::contact_by_stages<A, T>(a, b);
        if (!found_by_search) return optional_contact<T>();
        return optional_contact<T>(*found_by_search);
    } else if constexpr (std::same_as<A, filtered> && detail::has_early_contact<S, U>) {
        const auto first = detail::first_contact_in_any_order<T>(a, b);
        if (first.touch == verdict::no) return optional_contact<T>();
        if (first.touch == verdict::yes) return optional_contact<T>(first.found);
        const optional_contact<T> late = detail::contact_by_stages<A, T>(a, b);
        if (!late) return optional_contact<T>();
        return optional_contact<T>(*late);  // a copy, so that the answer above need not lie in memory
    } else {
        if (!intersects<A>(s, t)) return optional_contact<T>();
        return optional_contact<T>(detail::contact_in_any_order(a, b));
    }
}

}  // namespace abut
