// SPDX-License-Identifier: MIT
#pragma once

// Does a cylinder touch another one, or a capsule? `filtered` asks certified_cylinders.hpp, and what that leaves, and
// `exact`, the integers of exact_cylinders.hpp. `fast` takes the filter's search as it comes. A capsule is a cylinder with a
// ball about each end. An axis without length is the centre of a ball.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/predicate/certified_cylinders.hpp>
#include <abut/predicate/exact_cylinders.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr auto values_of(const cylinder<T>& s, const cylinder<T>& t) {
    return in_a_row(s.axis.a, s.axis.b, t.axis.a, t.axis.b, s.radius, t.radius);
}

/// In double, and as seen from an end of the second axis, which is a unit long.
template <scalar T>
ABUT_HD constexpr verdict ask_plain(const cylinder<T>& s, const cylinder<T>& t) {
    const unit_frame<T> f(t.axis);
    const auto row =
        in_a_row(f.at(s.axis.a), f.at(s.axis.b), vec3<T>{0, 0, 0}, f.d, f.per_unit * s.radius, f.per_unit * t.radius);
    double number[14]{};
    for (int i = 0; i < 14; ++i) number[i] = static_cast<double>(row.value[i]);
    return cylinders_seem_to_meet::ask(number);
}

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle. Radii are >= 0.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const cylinder<T>& s, const cylinder<T>& t) {
    if (detail::is_point(s.axis)) return detail::decide_in_place<A>(t, detail::ball_around(s));
    if (detail::is_point(t.axis)) return detail::decide_in_place<A>(s, detail::ball_around(t));
    if constexpr (std::same_as<A, exact>) {
        return detail::decide_at_short_length<detail::cylinders_meet>(detail::values_of(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        if (decide<filtered>(detail::capsule_around(s), detail::capsule_around(t)) == verdict::no) return verdict::no;
        return detail::ask_estimates<detail::cylinders_seem_to_meet>(detail::values_of(s, t).value);
    } else {
        return detail::ask_plain(s, t);
    }
}

/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const cylinder<T>& s, const cylinder<T>& t) {
    if (detail::is_point(s.axis)) return detail::resolve_in_place(t, detail::ball_around(s));
    if (detail::is_point(t.axis)) return detail::resolve_in_place(s, detail::ball_around(t));
    return detail::decide_at_any_length<detail::cylinders_meet>(detail::values_of(s, t).value);
}

/// One stage of the decision of a cylinder and a capsule.
template <arithmetic A, scalar T>
ABUT_HD constexpr verdict decide(const cylinder<T>& s, const capsule<T>& t) {
    if constexpr (std::same_as<A, filtered>) {
        if (decide<filtered>(detail::capsule_around(s), t) == verdict::no) return verdict::no;
    }
    const auto at = [&](const vec3<T>& end) { return detail::decide_in_place<A>(s, sphere<T>{end, t.radius}); };
    return detail::or_else(at(t.axis.a), [&] {
        if (detail::is_point(t.axis)) return verdict::no;
        return detail::or_else(at(t.axis.b), [&] { return decide<A>(s, cylinder<T>{t.axis, t.radius}); });
    });
}
/// The last stage: decides every finite input.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const cylinder<T>& s, const capsule<T>& t) {
    if (resolve(s, sphere<T>{t.axis.a, t.radius})) return true;
    if (detail::is_point(t.axis)) return false;
    return resolve(s, sphere<T>{t.axis.b, t.radius}) || resolve(s, cylinder<T>{t.axis, t.radius});
}

}  // namespace abut
