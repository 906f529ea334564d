// SPDX-License-Identifier: MIT
#pragma once

// Does a cylinder or a cone touch another one, or a capsule? `filtered` asks certified_cylinders.hpp, or certified_cones.hpp
// if there is a cone; what that leaves, and `exact`, the integers of exact_cylinders.hpp or exact_cones.hpp. `fast` takes
// the filter's search as it comes. A capsule is a cylinder with a ball about each end. An axis without length is the centre
// of a ball.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/arena_int.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/predicate/certified_cones.hpp>
#include <abut/predicate/certified_cylinders.hpp>
#include <abut/predicate/exact_cones.hpp>
#include <abut/predicate/exact_cylinders.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <solid_of_revolution S, solid_of_revolution U>
ABUT_HD constexpr auto values_of(const S& s, const U& t) {
    const auto a = axis_of(s), b = axis_of(t);
    return in_a_row(a.a, a.b, b.a, b.b, s.radius, t.radius);
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
        return detail::decide_in_short_arena<detail::cylinders_meet>(detail::values_of(s, t).value);
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
    return detail::decide_in_arena<detail::cylinders_meet>(detail::values_of(s, t).value);
}

namespace detail {

template <class S, class U>
using question_of_cones = round_solids_meet<questions_of<S>::type::is_cone, questions_of<U>::type::is_cone>;

/// use(s, t) of both, where they have an axis and a radius; or else of the ball or the segment that one of them is.
template <solid_of_revolution S, solid_of_revolution U, class Use, class UseOther>
ABUT_HD constexpr auto with_solids(const S& s, const U& t, const Use& use, const UseOther& use_other) {
    if (is_point(axis_of(s))) return use_other(t, ball_around(s));
    if (is_point(axis_of(t))) return use_other(s, ball_around(t));
    if (is_zero(s.radius)) return use_other(t, axis_of(s));
    if (is_zero(t.radius)) return use_other(s, axis_of(t));
    return use(s, t);
}

}  // namespace detail

/// One stage of the decision of a cone and another one, or a cylinder. Radii are >= 0.
template <arithmetic A, scalar T, detail::solid_of_revolution U>
requires std::same_as<scalar_type_of<U>, T> ABUT_HD constexpr verdict decide(const cone<T>& s, const U& t) {
    return detail::with_solids(
        s, t,
        [](const cone<T>& a, const U& b) {
            if constexpr (std::same_as<A, exact>) {
                return detail::decide_in_short_arena<detail::question_of_cones<cone<T>, U>>(detail::values_of(a, b).value);
            } else {
                if constexpr (std::same_as<A, filtered>) {
                    const verdict around = decide<filtered>(detail::capsule_around(a), detail::capsule_around(b));
                    if (around == verdict::no) return around;
                }
                return detail::search_solids<A>(a, b);
            }
        },
        [](const auto& a, const auto& b) { return detail::decide_in_place<A>(a, b); });
}
/// The last stage: decides every finite input.
template <scalar T, detail::solid_of_revolution U>
requires std::same_as<scalar_type_of<U>, T> ABUT_NOINLINE ABUT_HD constexpr bool resolve(const cone<T>& s, const U& t) {
    return detail::with_solids(
        s, t,
        [](const cone<T>& a, const U& b) {
            return detail::decide_in_arena<detail::question_of_cones<cone<T>, U>>(detail::values_of(a, b).value);
        },
        [](const auto& a, const auto& b) { return detail::resolve_in_place(a, b); });
}

/// One stage of the decision of a cylinder or a cone and a capsule.
template <arithmetic A, detail::solid_of_revolution S>
ABUT_HD constexpr verdict decide(const S& s, const capsule<scalar_type_of<S>>& t) {
    using T = scalar_type_of<S>;
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
template <detail::solid_of_revolution S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve(const S& s, const capsule<scalar_type_of<S>>& t) {
    using T = scalar_type_of<S>;
    if (resolve(s, sphere<T>{t.axis.a, t.radius})) return true;
    if (detail::is_point(t.axis)) return false;
    return resolve(s, sphere<T>{t.axis.b, t.radius}) || resolve(s, cylinder<T>{t.axis, t.radius});
}

}  // namespace abut
