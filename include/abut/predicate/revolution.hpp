// SPDX-License-Identifier: MIT
#pragma once

// Does a solid of revolution, a cylinder or a cone, touch a point, a segment, a triangle, a box, a ball or a plane? The
// questions are those of exact_revolution.hpp: `filtered` asks them of estimates, and `exact` of integers. `fast` asks them
// of plain numbers, in which the axis is a unit long, or else numbers of degree 8 would overflow. An axis without length is
// the centre of a ball.

#include <concepts>
#include <cstddef>
#include <type_traits>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/predicate/exact_revolution.hpp>
#include <abut/predicate/aabb_capsule.hpp>
#include <abut/predicate/aabb_sphere.hpp>
#include <abut/predicate/capsule_triangle.hpp>
#include <abut/predicate/certified_cylinder_ball.hpp>
#include <abut/predicate/near_cores.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/sphere_sphere.hpp>
#include <abut/predicate/sphere_triangle.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

template <scalar T>
ABUT_HD constexpr const segment<T>& axis_of(const cylinder<T>& s) {
    return s.axis;
}
template <scalar T>
ABUT_HD constexpr segment<T> axis_of(const cone<T>& s) {
    return {s.apex, s.base_center};
}

template <class S>
struct questions_of;
template <scalar T>
struct questions_of<cylinder<T>> {
    using type = cylinder_questions;
};
template <scalar T>
struct questions_of<cone<T>> {
    using type = cone_questions;
};

/// A cylinder or a cone.
template <class S>
concept solid_of_revolution = requires {
    typename questions_of<S>::type;
};

/// By their bits, since denormal numbers may be read as zero.
template <scalar T>
ABUT_HD constexpr bool is_point(const segment<T>& s) {
    return ordered_bits(s.a.x) == ordered_bits(s.b.x) && ordered_bits(s.a.y) == ordered_bits(s.b.y) &&
           ordered_bits(s.a.z) == ordered_bits(s.b.z);
}

template <solid_of_revolution S>
ABUT_HD constexpr sphere<scalar_type_of<S>> ball_around(const S& s) {
    return {axis_of(s).b, s.radius};
}

/// What holds all of it.
template <solid_of_revolution S>
ABUT_HD constexpr capsule<scalar_type_of<S>> capsule_around(const S& s) {
    return {axis_of(s), s.radius};
}

/// What is asked of a cylinder or a cone and another shape of its scalar type, and the numbers that it is asked of: as they
/// are, and for `fast` as seen from the first end, in a unit in which the axis has length 1.
template <class S, class U>
struct revolution_question;

template <scalar T>
struct unit_frame {
    vec3<T> origin, d;
    T per_unit;

    ABUT_HD explicit constexpr unit_frame(const segment<T>& axis) : origin(axis.a), d{}, per_unit{} {
        const vec3<T> along = axis.b - axis.a;
        const vec3<double> wide = widened(along);
        per_unit = static_cast<T>(1 / square_root(dot(wide, wide)));
        d = per_unit * along;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<T> at(const vec3<T>& p) const { return per_unit * (p - origin); }
};

template <scalar T, int N>
ABUT_HD constexpr auto values_of(const segment<T>& axis, T radius, const corner_hull<T, N>& core) {
    row_of<T, std::size_t{7 + 3 * N}> row{};
    T* end = append(append(row.value, axis.a), axis.b);
    for (const vec3<T>& v : core.at) end = append(end, v);
    append(end, radius);
    return row;
}

template <solid_of_revolution S, has_corners U>
struct revolution_question<S, U> {
    using solid = typename questions_of<S>::type;
    using T = scalar_type_of<S>;
    static constexpr int corners = corners_of_core<U>;
    static constexpr bool has_capsule_filter = corners > 1;
    using type = std::conditional_t<
        corners == 1, revolution_meets_point<solid>,
        std::conditional_t<corners == 2, revolution_meets_segment<solid>, revolution_meets_triangle<solid>>>;
    ABUT_HD static constexpr auto values(const S& s, const U& t) { return values_of(axis_of(s), s.radius, core_of(t)); }
    ABUT_HD static constexpr auto values_in_unit(const S& s, const U& t) {
        const unit_frame<T> f(axis_of(s));
        auto core = core_of(t);
        for (vec3<T>& v : core.at) v = f.at(v);
        return values_of(segment<T>{{0, 0, 0}, f.d}, f.per_unit * s.radius, core);
    }
};

template <solid_of_revolution S, scalar T>
struct revolution_question<S, sphere<T>> {
    static constexpr bool has_capsule_filter = false;
    using type = revolution_meets_ball<typename questions_of<S>::type>;
    ABUT_HD static constexpr auto values(const S& s, const sphere<T>& t) {
        const segment<T> axis = axis_of(s);
        return in_a_row(axis.a, axis.b, t.center, s.radius, t.radius);
    }
    ABUT_HD static constexpr auto values_in_unit(const S& s, const sphere<T>& t) {
        const unit_frame<T> f(axis_of(s));
        return in_a_row(vec3<T>{0, 0, 0}, f.d, f.at(t.center), f.per_unit * s.radius, f.per_unit * t.radius);
    }
};

template <solid_of_revolution S, scalar T>
struct revolution_question<S, aabb<T>> {
    static constexpr bool has_capsule_filter = true;
    using type = revolution_meets_box<typename questions_of<S>::type>;
    ABUT_HD static constexpr auto values(const S& s, const aabb<T>& t) {
        const segment<T> axis = axis_of(s);
        return in_a_row(axis.a, axis.b, t.lower, t.upper, s.radius);
    }
    ABUT_HD static constexpr auto values_in_unit(const S& s, const aabb<T>& t) {
        const unit_frame<T> f(axis_of(s));
        return in_a_row(vec3<T>{0, 0, 0}, f.d, f.at(t.lower), f.at(t.upper), f.per_unit * s.radius);
    }
};

template <solid_of_revolution S, scalar T>
struct revolution_question<S, plane<T>> {
    static constexpr bool has_capsule_filter = false;
    using type = plane_meets_revolution<typename questions_of<S>::type>;
    ABUT_HD static constexpr auto values(const S& s, const plane<T>& t) {
        const segment<T> axis = axis_of(s);
        return in_a_row(t.normal, t.offset, T(1), axis.a, axis.b, s.radius);
    }
    ABUT_HD static constexpr auto values_in_unit(const S& s, const plane<T>& t) {
        const unit_frame<T> f(axis_of(s));
        return in_a_row(t.normal, f.per_unit * (t.offset - dot(t.normal, f.origin)), T(1), vec3<T>{0, 0, 0}, f.d,
                        f.per_unit * s.radius);
    }
};

/// A stage of another pair that has a ball in it, in either order; of `fast` all of them.
template <arithmetic A, class S, class U>
ABUT_HD constexpr verdict decide_in_place(const S& s, const U& t) {
    if constexpr (requires { decide<A>(s, t); }) {
        const verdict v = decide<A>(s, t);
        if constexpr (std::same_as<A, fast> && requires { decide_late<A>(s, t); }) {
            if (v == verdict::unknown) return decide_late<A>(s, t);
        }
        return v;
    } else {
        return decide_in_place<A>(t, s);
    }
}
template <class S, class U>
ABUT_HD constexpr bool resolve_in_place(const S& s, const U& t) {
    if constexpr (requires { resolve(s, t); }) {
        return resolve(s, t);
    } else {
        return resolve(t, s);
    }
}

/// A question of integers. Polynomials of a high degree, in limbs that are written out, are a megabyte of a kernel. So a
/// device asks them of integers whose length is known at run time.
template <class Question, scalar T, std::size_t V>
ABUT_HD constexpr verdict ask_integers(const T (&value)[V]) {
    if constexpr (ABUT_DEVICE_CODE != 0) {
        return decide_at_short_length<asked_exactly<Question>>(value);
    } else {
        return decide_in_limbs<asked_exactly<Question>>(value);
    }
}

/// And so it asks of the ball that is left of a solid without an axis, beside a triangle: hardly ever.
template <class U>
inline constexpr bool is_asked_at_length = ABUT_DEVICE_CODE != 0 && std::same_as<U, triangle<scalar_type_of<U>>>;

/// The stages where the axis has no length.
///@{
template <arithmetic A, scalar T, class U>
ABUT_HD constexpr verdict decide_without_axis(const sphere<T>& s, const U& t) {
    if constexpr (std::same_as<A, exact> && is_asked_at_length<U>) {
        return decide_at_short_length<ball_meets_triangle>(values_of(s, t).value);
    } else {
        return decide_in_place<A>(s, t);
    }
}
template <scalar T, class U>
ABUT_HD constexpr bool resolve_without_axis(const sphere<T>& s, const U& t) {
    if constexpr (is_asked_at_length<U>) {
        return decide_at_any_length<ball_meets_triangle>(values_of(s, t).value);
    } else {
        return resolve_in_place(s, t);
    }
}
///@}

template <class S, class U>
concept revolution_pair = solid_of_revolution<S> && std::same_as<scalar_type_of<S>, scalar_type_of<U>> && requires {
    typename revolution_question<S, U>::type;
};

}  // namespace detail

/// One stage of the decision, as for a sphere and a triangle. A cylinder and a cone have radius >= 0.
template <arithmetic A, class S, class U>
requires detail::revolution_pair<S, U> ABUT_HD constexpr verdict decide(const S& s, const U& t) {
    using question = detail::revolution_question<S, U>;
    if (detail::is_point(detail::axis_of(s))) return detail::decide_without_axis<A>(detail::ball_around(s), t);
    if constexpr (std::same_as<A, exact>) {
        return detail::ask_integers<typename question::type>(question::values(s, t).value);
    } else if constexpr (std::same_as<A, filtered>) {
        if constexpr (std::same_as<S, cylinder<scalar_type_of<S>>> && std::same_as<U, sphere<scalar_type_of<S>>>) {
            const verdict v = detail::near_cylinder(s, t.center, static_cast<double>(t.radius));
            if (v != verdict::unknown) return v;
        } else if constexpr (question::has_capsule_filter) {
            if (detail::decide_in_place<filtered>(detail::capsule_around(s), t) == verdict::no) return verdict::no;
        }
        return detail::ask_estimates<typename question::type>(question::values(s, t).value);
    } else {
        return question::type::ask(question::values_in_unit(s, t).value);
    }
}

/// The last stage: decides every finite input.
template <class S, class U>
requires detail::revolution_pair<S, U> ABUT_NOINLINE ABUT_HD constexpr bool resolve(const S& s, const U& t) {
    using question = detail::revolution_question<S, U>;
    if (detail::is_point(detail::axis_of(s))) return detail::resolve_without_axis(detail::ball_around(s), t);
    return detail::decide_at_any_length<detail::asked_exactly<typename question::type>>(question::values(s, t).value);
}

}  // namespace abut
