// SPDX-License-Identifier: MIT
#pragma once

// The stages of `within` for a cylinder or a cone and a point or a ball: whether the solid meets a ball that is larger by
// the distance. Its radius is that sum as it is: integers add it without rounding, and estimates know how far it is off. The
// questions are those of revolution.hpp. And for a plane, which has one of its own.
//
// And for a shape around a core of more points: a segment, a capsule, a triangle, a box or a convex hull. The search of
// gjk.hpp, in double, ends with a way on which the core is ahead of all that is within reach of the solid, or with a point of
// it that is within, or tells nothing, mostly where that is a tie. Then integers are asked: whether the solid touches the
// core, and whether it is within reach of an edge or of a face of it (exact_revolution_within.hpp). Of a hull these are those
// of triangles of its points, as in revolution_hull.hpp.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/arena_int.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/estimate.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/predicate/box_within.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/exact_revolution.hpp>
#include <abut/predicate/exact_revolution_within.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_hull.hpp>
#include <abut/predicate/solid_on_ways.hpp>
#include <abut/predicate/within_stages.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/outward.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

template <scalar T>
ABUT_HD constexpr vec3<double> widened_exactly(const vec3<T>& p) {
    return {widened_exactly(p.x), widened_exactly(p.y), widened_exactly(p.z)};
}

/// A cylinder or a cone, and a shape around a point.
template <class S, class U>
concept revolution_and_center = solid_of_revolution<S> && corners_of_core<U>
== 1 && std::same_as<scalar_type_of<S>, scalar_type_of<U>>;

/// As exact_revolution.hpp expects them, in double, as those of two hulls.
template <class S, class U>
requires revolution_and_center<S, U> ABUT_HD constexpr auto values_within(const S& s, const U& t, double distance) {
    const auto exactly = [](const auto& p) {
        return vec3<double>{widened_exactly(p.x), widened_exactly(p.y), widened_exactly(p.z)};
    };
    const auto axis = axis_of(s);
    return in_a_row(exactly(axis.a), exactly(axis.b), exactly(core_of(t).at[0]), widened_exactly(s.radius),
                    widened_exactly(radius_around_core(t)), distance);
}

template <class S>
using asked_within = revolution_within_of_ball<typename questions_of<S>::type>;

/// The first stage: in floating point; or of `exact` in integers, and unknown only where the exponents of all numbers span
/// more than 124 bits.
template <arithmetic A, class S, class U>
requires revolution_and_center<S, U> ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    using T = scalar_type_of<S>;
    if (is_point(axis_of(s))) return decide_within<A>(ball_around(s), t, distance);
    if constexpr (std::same_as<A, exact>) {
        return ask_integers<asked_within<S>>(values_within(s, t, distance).value);
    } else if constexpr (std::same_as<A, filtered>) {
        return ask_estimates<asked_within<S>>(values_within(s, t, distance).value);
    } else {
        return decide<fast>(s, sphere<T>{core_of(t).at[0], radius_around_core(t) + static_cast<T>(distance)});
    }
}

/// The last one: decides every finite input.
template <class S, class U>
requires revolution_and_center<S, U> ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t,
                                                                                         double distance) {
    if (is_point(axis_of(s))) return resolve_within(ball_around(s), t, distance);
    return decide_at_any_length<asked_exactly<asked_within<S>>>(values_within(s, t, distance).value);
}

/// A cylinder or a cone and a plane.
template <class S, class T>
concept revolution_over_planes = solid_of_revolution<S> && std::same_as<scalar_type_of<S>, T>;

template <scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr auto values_within(const S& s, const plane<T>& p, double distance) {
    const auto exactly = [](const vec3<T>& v) {
        return vec3<double>{widened_exactly(v.x), widened_exactly(v.y), widened_exactly(v.z)};
    };
    const segment<T> axis = axis_of(s);
    return in_a_row(exactly(p.normal), widened_exactly(p.offset), 1.0, exactly(axis.a), exactly(axis.b),
                    widened_exactly(s.radius), distance);
}

/// As it is rounded: heights, and how much lower a rim reaches.
template <scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr bool seems_within(const S& s, const plane<T>& p, T distance) {
    const segment<T> axis = axis_of(s);
    const T at_first = dot(p.normal, axis.a) - p.offset, at_last = dot(p.normal, axis.b) - p.offset;
    if ((at_first <= 0) != (at_last <= 0)) return true;
    const auto length_of = [](const vec3<T>& v) { return static_cast<T>(square_root(dot(widened(v), widened(v)))); };
    const T rim = s.radius * length_of(cross(p.normal, unit_frame<T>(axis).d)), gap = distance * length_of(p.normal);
    constexpr bool is_cone = questions_of<S>::type::is_cone;
    return absolute(at_last) <= rim + gap || absolute(at_first) <= (is_cone ? gap : rim + gap);
}

template <class S>
using asked_over_plane = plane_within_of_revolution<typename questions_of<S>::type>;

/// The first stage, as above. A capsule around the solid says no to most that are too far.
template <arithmetic A, scalar T, revolution_over_planes<T> S>
ABUT_HD constexpr verdict decide_within(const S& s, const plane<T>& p, double distance) {
    if (is_point(axis_of(s))) return decide_within<A>(p, ball_around(s), distance);
    if constexpr (std::same_as<A, exact>) {
        return ask_integers<asked_over_plane<S>>(values_within(s, p, distance).value);
    } else if constexpr (std::same_as<A, filtered>) {
        if (decide_within<filtered>(p, capsule_around(s), distance) == verdict::no) return verdict::no;
        return ask_estimates<asked_over_plane<S>>(values_within(s, p, distance).value);
    } else {
        return to_verdict(seems_within(s, p, static_cast<T>(distance)));
    }
}

/// The last one: decides every finite input.
template <scalar T, revolution_over_planes<T> S>
ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const plane<T>& p, double distance) {
    if (is_point(axis_of(s))) return resolve_within(p, ball_around(s), distance);
    return decide_at_any_length<asked_exactly<asked_over_plane<S>>>(values_within(s, p, distance).value);
}

/// A cylinder or a cone, and a shape around a core of more points than one.
template <class S, class U>
concept revolution_and_core =
    solid_of_revolution<S> && !seen_as_hull<U> && has_core_points<U, scalar_type_of<S>> && corners_of_core<U> != 1;

/// A core as a shape: of a capsule its axis.
template <class U>
ABUT_HD constexpr const auto& shape_of_core(const U& t) {
    if constexpr (requires { t.axis; }) {
        return t.axis;
    } else {
        return t;
    }
}

/// Two shapes that are to be within a reach, as gjk.hpp reads two hulls.
template <bool Certified, class Both>
class near_on_ways : public Both {
public:
    using Both::Both;

    /// Whether the feature of the first corners is near. Its nearest point is a combination of differences, each of which is
    /// off by less than is lost on ways, as its weights are by less than 2^-50.
    [[nodiscard]] ABUT_HD constexpr bool is_enough(const vec3<double> (&w)[4], const difference_simplex& at) const {
        double weight[3];
        const vec3<double> q = nearest_on_feature(w, least(at.count, 3), weight), one = of_size_1(q);
        const double length = magnitudes(q) * square_root(dot(one, one));
        if (!(length > 0)) return false;  // of no size that doubles compare
        if constexpr (!Certified) return length <= Both::reach();
        return Both::is_known() && (1 + 0x1p-40) * length + lost_on_ways<typename Both::T>(Both::size()) <= Both::reach();
    }
};
template <bool Certified, class S>
using core_near_solid = near_on_ways<Certified, hull_and_solid<Certified, S>>;

/// Whether the core is within reach of the solid, whose axis has a length, if the search tells.
template <bool Certified, solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict search_near_solid(const S& s, const hull<T>& core, double reach) {
    const corner_hull<T, 2> axis = points_of(axis_of(s));
    const hull<T> ends = axis.as_hull();
    points_of_solid asked;
    found_simplex found;
    return search_origin<sought::meeting>(core_near_solid<Certified, S>(core, s, ends, asked, reach), found.at, found.w);
}

/// How far around the solid a core may be, rounded.
template <class U>
ABUT_HD constexpr double reach_to_core(const U& t, double distance) {
    return rounded(static_cast<double>(radius_around_core(t))) + rounded(distance);
}

/// Asks integers of edges and faces, in two limbs or in any number of them. An axis has a length.
template <bool AtAnySpan, solid_of_revolution S>
struct features_near_solid {
    using T = scalar_type_of<S>;
    using solid = typename questions_of<S>::type;

    const S& s;
    double radius, distance;  ///< around the core, and from there

    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict edge(const vec3<T>& p, const vec3<T>& q) const {
        const segment<T> axis = axis_of(s);
        return ask<revolution_within_of_edge<solid>>(in_a_row(widened_exactly(axis.a), widened_exactly(axis.b),
                                                              widened_exactly(p), widened_exactly(q),
                                                              widened_exactly(s.radius), radius, distance)
                                                         .value);
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr verdict face(const vec3<T>& p, const vec3<T>& q, const vec3<T>& t) const {
        const segment<T> axis = axis_of(s);
        return ask<revolution_within_of_face<solid>>(in_a_row(widened_exactly(axis.a), widened_exactly(axis.b),
                                                              widened_exactly(p), widened_exactly(q), widened_exactly(t),
                                                              widened_exactly(s.radius), radius, distance)
                                                         .value);
    }
    [[nodiscard]] ABUT_HD constexpr verdict any(const corner_hull<T, 2>& core) const { return edge(core.at[0], core.at[1]); }
    [[nodiscard]] ABUT_HD constexpr verdict any(const corner_hull<T, 3>& core) const {
        const vec3<T>(&p)[3] = core.at;
        verdict near = face(p[0], p[1], p[2]);
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) near = or_else(near, [&] { return edge(p[i], p[i == 2 ? 0 : i + 1]); });
        return near;
    }
    /// The corners of a box: bit k of a number says on which side it is of axis k.
    [[nodiscard]] ABUT_HD constexpr verdict any(const corner_hull<T, 8>& core) const {
        const vec3<T>(&p)[8] = core.at;
        verdict near = verdict::no;
        ABUT_ROLLED
        for (int k = 0; k < 3; ++k) {
            const int x = 1 << k, y = 1 << (k + 1) % 3, z = 1 << (k + 2) % 3;
            ABUT_ROLLED
            for (int i = 0; i < 8; ++i) {
                if ((i & x) == 0) near = or_else(near, [&] { return edge(p[i], p[i | x]); });
            }
            ABUT_ROLLED
            for (int i = 0; i <= x; i += x) {
                near = or_else(near, [&] { return face(p[i], p[i | y], p[i | z]); });
                near = or_else(near, [&] { return face(p[i | y | z], p[i | y], p[i | z]); });
            }
        }
        return near;
    }

private:
    template <class Question, std::size_t V>
    ABUT_HD static constexpr verdict ask(const double (&value)[V]) {
        if constexpr (AtAnySpan) {
            return to_verdict(decide_in_arena<Question>(value));
        } else {
            return decide_in_short_arena<Question>(value);
        }
    }
};
template <bool AtAnySpan, class S, class U>
ABUT_HD constexpr features_near_solid<AtAnySpan, S> features_near(const S& s, const U& t, double distance) {
    return {s, widened_exactly(radius_around_core(t)), distance};
}

/// Whether an edge or the inside of a face that does not touch the solid is within a distance of it, by all stages one after
/// another. Of a face whose edges are not.
///@{
template <int N, solid_of_revolution S, scalar T, class Ask>
ABUT_HD constexpr bool is_exactly_near(const S& s, const corner_hull<T, N>& core, double distance, const Ask& ask) {
    verdict v = ABUT_CONSTANT_EVALUATED() ? verdict::unknown : search_near_solid<true>(s, core.as_hull(), rounded(distance));
    if (v == verdict::unknown) v = ask(features_near_solid<false, S>{s, 0, distance});
    if (v == verdict::unknown) v = ask(features_near_solid<true, S>{s, 0, distance});
    return v == verdict::yes;
}
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool is_edge_near(const S& s, const vec3<T>& p, const vec3<T>& q, double distance) {
    return is_exactly_near(s, corner_hull<T, 2>{{p, q}}, distance, [&](const auto& f) { return f.edge(p, q); });
}
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr bool is_face_near(const S& s, const vec3<T>& p, const vec3<T>& q, const vec3<T>& t,
                                                  double distance) {
    return is_exactly_near(s, corner_hull<T, 3>{{p, q, t}}, distance, [&](const auto& f) { return f.face(p, q, t); });
}
///@}

/// Whether any triangle of a hull's points is so near, where the hull does not touch the solid: of a few corners, or of all
/// but those that are surely too far on a way; `unknown` if only a few are asked, and are not near.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict any_triangle_near(const S& s, const hull<T>& h, double distance, bool ask_all) {
    const corner_hull<T, 2> axis = points_of(axis_of(s));
    const hull<T> ends = axis.as_hull();
    points_of_solid asked;
    const core_near_solid<true, S> x(h, s, ends, asked, reach_to_core(h, distance));
    found_simplex found;
    const verdict v = search_origin<sought::meeting>(x, found.at, found.w);
    if (v != verdict::unknown) return v;
    const steepest_way<S, T> steepest(x, h, found);
    const nearest_corners<S, T> few(x, h, steepest.way);
    const auto edge = [&](const vec3<T>& p, const vec3<T>& q) { return is_edge_near(s, p, q, distance); };
    const auto face = [&](const vec3<T>& p, const vec3<T>& q, const vec3<T>& r) { return is_face_near(s, p, q, r, distance); };
    if (any_feature(few, few.size(), all_points(), edge, face)) return verdict::yes;
    if (!ask_all) return verdict::unknown;
    return to_verdict(any_feature(h, h.count, [&](std::size_t i) { return x.is_near(steepest.way, i); }, edge, face));
}

/// The first stage, as above.
template <arithmetic A, class S, class U>
requires revolution_and_core<S, U> ABUT_HD constexpr verdict decide_within(const S& s, const U& t, double distance) {
    if (is_point(axis_of(s))) {
        if constexpr (corners_of_core<U> > 0) {
            return decide_within<A>(ball_around(s), t, distance);
        } else {
            return decide_within<A>(t, ball_around(s), distance);
        }
    }
    const auto core = core_points_of(t);
    if constexpr (!std::same_as<A, exact>) {
        return search_near_solid<std::same_as<A, filtered>>(s, core.as_hull(), reach_to_core(t, distance));
    } else {
        return or_else(decide<exact>(s, shape_of_core(t)), [&] {
            if constexpr (std::same_as<U, hull<scalar_type_of<S>>>) {
                return any_triangle_near(s, t, distance, false);
            } else {
                return features_near<false>(s, t, distance).any(core);
            }
        });
    }
}

/// What that leaves of those that touch.
template <arithmetic A, class S, class U>
requires(std::same_as<A, filtered> && revolution_and_core<S, U>) ABUT_HD constexpr verdict
    decide_within_late(const S& s, const U& t, double) {
    if (is_point(axis_of(s))) return verdict::unknown;
    return decide<filtered>(s, shape_of_core(t)) == verdict::yes ? verdict::yes : verdict::unknown;
}

/// The last one: decides every finite input. Of a hull it may take as long as there are triangles of points.
template <class S, class U>
requires revolution_and_core<S, U> ABUT_NOINLINE ABUT_HD constexpr bool resolve_within(const S& s, const U& t,
                                                                                       double distance) {
    if (is_point(axis_of(s))) {
        if constexpr (corners_of_core<U> > 0) {
            return resolve_within(ball_around(s), t, distance);
        } else {
            return resolve_within(t, ball_around(s), distance);
        }
    }
    if (resolve(s, shape_of_core(t))) return true;
    if constexpr (std::same_as<U, hull<scalar_type_of<S>>>) {
        return any_triangle_near(s, t, distance, true) == verdict::yes;
    } else {
        return features_near<true>(s, t, distance).any(core_points_of(t)) == verdict::yes;
    }
}

}  // namespace abut::detail
