// SPDX-License-Identifier: MIT
#pragma once

// Shapes that are decided as the hull of their corners, oriented and placed boxes: their stages are those of that hull and
// the other shape, in whichever order these are written.

#include <concepts>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/certified_oriented.hpp>
#include <abut/predicate/hull_hull.hpp>
#include <abut/predicate/plane_hull.hpp>
#include <abut/predicate/ray_hull.hpp>
#include <abut/predicate/revolution_hull.hpp>
#include <abut/shape/oriented_box.hpp>

namespace abut {

namespace detail {

/// A shape in the place of points whose hull it would be.
template <class S>
struct as_it_is {
    const S& of;
    ABUT_HD constexpr const S& as_hull() const { return of; }
};
/// `hull_form(s).as_hull()` is what is decided about s: its hull, or s itself. It refers to what hull_form gives.
///@{
template <class S>
ABUT_HD constexpr as_it_is<S> hull_form(const S& s) {
    return {s};
}
template <seen_as_hull S>
ABUT_HD constexpr auto hull_form(const S& s) {
    return points_of(s);
}
///@}
template <class S>
using hull_form_of = std::remove_cvref_t<decltype(hull_form(std::declval<const S&>()).as_hull())>;

/// One that is, and another shape that has stages with hulls.
template <class S, class U>
concept pair_seen_as_hull =
    seen_as_hull<S> && !std::same_as<U, hull_form_of<S>> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> &&
    (
        requires(const hull_form_of<S>& s, const hull_form_of<U>& t) { resolve(s, t); } ||
        requires(const hull_form_of<S>& s, const hull_form_of<U>& t) { resolve(t, s); });

}  // namespace detail

/// One stage of the decision, as of the hull.
template <arithmetic A, class S, class U>
    requires detail::pair_seen_as_hull<S, U>
ABUT_HD constexpr verdict decide(const S& s, const U& t) {
    if constexpr (std::same_as<A, filtered> && requires { detail::near_oriented(s, t); }) {
        if (const verdict v = detail::near_oriented(s, t); v != verdict::unknown) return v;
    }
    const auto a = detail::hull_form(s);
    const auto b = detail::hull_form(t);
    return detail::decide_in_place<A>(a.as_hull(), b.as_hull());
}

/// What the filter left, if there is such a stage.
template <arithmetic A, class S, class U>
    requires(detail::pair_seen_as_hull<S, U> && std::same_as<A, filtered>)
ABUT_HD constexpr verdict decide_late(const S& s, const U& t) {
    const auto a = detail::hull_form(s);
    const auto b = detail::hull_form(t);
    if constexpr (requires { decide_late<A>(a.as_hull(), b.as_hull()); }) {
        return decide_late<A>(a.as_hull(), b.as_hull());
    } else if constexpr (requires { decide_late<A>(b.as_hull(), a.as_hull()); }) {
        return decide_late<A>(b.as_hull(), a.as_hull());
    } else {
        return verdict::unknown;
    }
}

/// The last stage: decides every finite input.
template <class S, class U>
    requires detail::pair_seen_as_hull<S, U>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const S& s, const U& t) {
    const auto a = detail::hull_form(s);
    const auto b = detail::hull_form(t);
    return detail::resolve_in_place(a.as_hull(), b.as_hull());
}

}  // namespace abut
