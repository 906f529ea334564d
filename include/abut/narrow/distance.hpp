// SPDX-License-Identifier: MIT
#pragma once

// `distance` of two shapes: how far apart they are and where, and 0 exactly where they touch, as `intersects` decides. The
// numbers of shapes that do not touch are measured in nearest_ways.hpp; docs/numerics/distances.md bounds what rounding
// leaves in them.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/common_unit.hpp>
#include <abut/narrow/contact.hpp>
#include <abut/narrow/hull_distance.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/nearest_ways.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_box.hpp>
#include <abut/narrow/plain_distance.hpp>
#include <abut/narrow/plain_oriented.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/narrow/revolution_hull_distance.hpp>
#include <abut/narrow/revolution_plane.hpp>
#include <abut/narrow/revolution_ways.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/plane_core.hpp>
#include <abut/predicate/plane_hull.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut {

/// How far apart two shapes are, and a point of each that are so far apart. Where two shapes touch the distance is 0, and
/// both points are one that they share. No distance of shapes that do not touch is 0: at least it is the least positive
/// number. One that T has no number for is infinite.
template <scalar T>
struct separation {
    std::uint32_t a;  ///< id of the first shape; 0 of a single pair
    std::uint32_t b;  ///< id of the second one; 0 of a single pair
    vec3<T> point_a;  ///< of the first shape, in the world
    vec3<T> point_b;  ///< of the second one
    T distance;       ///< between the two shapes, rounded to T

    friend constexpr bool operator==(const separation&, const separation&) = default;
};

namespace detail {

/// How far around its core a shape reaches, in a unit. A cylinder or a cone is its own core.
template <class S, scalar T>
ABUT_HD constexpr double core_radius(const S& s, const length_unit<T>& unit) {
    if constexpr (solid_of_revolution<S>) {
        return 0;
    } else {
        return unit.of(radius_around_core(s));
    }
}

/// The distance of two boxes in double, with a relative error of a few units of roundoff, also where squares would leave the
/// range.
template <scalar T>
ABUT_HD constexpr double gap_of_boxes(const aabb<T>& a, const aabb<T>& b) {
    const auto gap = [](T lower_a, T upper_a, T lower_b, T upper_b) {
        const auto over = [](T lower, T upper) {
            return plain_sum(static_cast<double>(lower), -static_cast<double>(upper));
        };
        return greatest(over(lower_a, upper_b), over(lower_b, upper_a), 0.0);
    };
    vec3<double> gaps{gap(a.lower.x, a.upper.x, b.lower.x, b.upper.x), gap(a.lower.y, a.upper.y, b.lower.y, b.upper.y),
                      gap(a.lower.z, a.upper.z, b.lower.z, b.upper.z)};
    int exponent = 0;
    if constexpr (std::same_as<T, double>) {
        const double largest = contact_math::largest_of(gaps);
        if (!(largest > 0) || !(largest < infinity<double>)) return largest;
        exponent = contact_math::exponent_of(largest);
        gaps = contact_math::scaled(gaps, -exponent);
    }
    const double length = contact_math::root(contact_math::one_double{plain_dot(gaps, gaps)}).high;
    return exponent == 0 ? length : contact_math::scaled(length, exponent);
}

/// A distance that is known to be positive, as it is measured: never below that of the boxes, so that culling by boxes loses
/// nothing.
///@{
template <scalar T>
ABUT_HD constexpr double positive_distance_over(const aabb<T>& a, const aabb<T>& b, double measured) {
    return greatest(measured, gap_of_boxes(a, b), 0x1p-1074);
}
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr double positive_distance(const S& s, const U& t, double measured) {
    return positive_distance_over(bounds(s), bounds(t), measured);
}
/// Of measured hulls, whose boxes are known, or smaller ones that are no nearer to each other: mostly those tell enough.
template <class U, class Measured>
ABUT_HD constexpr double positive_distance_of(const U& t, const Measured& m) {
    using hulls = hulls_in_plain_doubles<scalar_type_of<U>>;
    const double measured = m.distance();
    if constexpr (refers_to_memory<U>) {
        const double first = positive_distance_over(m.nearest.box_a, m.nearest.box_b, measured);
        if (first == measured || m.nearest.are_boxes_whole) return first;
        return positive_distance_over(hulls::whole_box(m.a), hulls::whole_box(m.b), measured);
    } else {
        const double first = positive_distance_over(m.nearest.box_a, bounds(t), measured);
        if (first == measured || m.nearest.are_boxes_whole) return first;
        return positive_distance_over(hulls::whole_box(m.a), bounds(t), measured);
    }
}
///@}

template <scalar T>
ABUT_HD constexpr T rounded_distance(double distance) {
    const T d = distance > static_cast<double>(largest_finite<T>) * (1 + static_cast<double>(unit_roundoff<T>) / 2)
                    ? infinity<T>
                    : rounded(static_cast<T>(distance));
    constexpr T least_positive = ABUT_BIT_CAST(T, typename float_format<T>::word{1});
    return d > 0 ? d : least_positive;
}

/// Whether the boxes around two shapes are nearer to each other than the shapes for sure, by the way between their cores and
/// what is rounded. In a coordinate x of the way boxes are no farther apart than |x| - radii, or not at all; with m for the
/// largest |x| that is no more than |x| (1 - radii / m), so that boxes lose radii length / m, where shapes lose radii. Without
/// branches, which nobody can predict.
ABUT_HD constexpr bool are_boxes_nearer(const vec3<double>& way, double length, double radii, double rounding) {
    const double most = contact_math::largest_of(way);
    return plain_product(radii, plain_sum(length, -most)) > plain_product(2 * rounding, most) &&
           plain_sum(length, -radii) > 2 * rounding;
}

/// Two shapes that are apart, by a closed form in plain doubles. What is rounded is below 16u size, as plain_ways.hpp says.
template <class S, class U>
ABUT_INLINE ABUT_HD constexpr double plain_distance(const S& s, const U& t, const plain_pair<S, U>& both) {
    const double gap = plain_sum(both.length, -both.radii());
    const bool is_more = are_boxes_nearer(both.way(), both.length, both.radii(), 0x1p-49 * both.size);
    return is_more ? gap : positive_distance(s, t, gap);
}
template <class S, class U>
ABUT_INLINE ABUT_HD constexpr auto plain_separation(const S& s, const U& t, const plain_pair<S, U>& both) {
    using T = scalar_type_of<S>;
    const double per_length = 1 / both.length;
    return separation<T>{0, 0, both.on_a(s).at(plain_product(both.radius_a, per_length), both.way()),
                         both.on_b(t).at(-plain_product(both.radius_b, per_length), both.way()),
                         rounded_distance<T>(plain_distance(s, t, both))};
}

/// Two shapes that do not touch, measured.
template <scalar T>
struct measured_pair {
    nearest_way<T> nearest;  ///< of the cores
    length_unit<T> unit;
    double length;  ///< of the way, in the unit
    double radius_a, radius_b;

    template <class S, class U>
    ABUT_HD constexpr measured_pair(const S& s, const U& t)
        : unit(common_unit(s, t)), radius_a(core_radius(s, unit)), radius_b(core_radius(t, unit)) {
        if constexpr (solid_of_revolution<U>) {
            nearest = nearest_way_from<false>(s, t, unit);
        } else if constexpr (solid_of_revolution<S>) {
            nearest = nearest_way_from<false>(s, core_of(t), unit);
        } else {
            nearest = nearest_way_between(core_of(s), core_of(t), unit);
        }
        length = contact_math::root(contact_math::one_double{nearest.square}).high;
    }
    [[nodiscard]] ABUT_HD constexpr double distance() const {
        return unit.length(plain_sum(length, -plain_sum(radius_a, radius_b)));
    }
    template <class S>
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_a(const S& s) const {
        return on_shape(s, nearest.from_a, nearest.to_a, radius_a);
    }
    template <class U>
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_b(const U& t) const {
        return on_shape(t, nearest.from_b, nearest.to_b, -radius_b);
    }

private:
    template <class S>
    [[nodiscard]] ABUT_HD constexpr vec3<T> on_shape(const S& s, const vec3<T>& from, vec3<double> to, double along) const {
        if (along != 0 && length > 0) to = plain_step(to, along / length, nearest.way);
        if constexpr (std::same_as<S, aabb<T>>) {
            return end_of_way<T>(from, to, s, unit);
        } else {
            return end_of_way(s, from, to, unit);
        }
    }
};

/// A plane and a shape that do not touch: how far, in lengths, and where. A plane of normal 0 that is nothing is infinitely
/// far.
template <scalar T>
struct measured_plane {
    double length = infinity<double>;
    vec3<T> on_plane{}, on_shape{};

    template <has_height<T> S>
    ABUT_HD constexpr measured_plane(const plane<T>& s, const S& t) {
        using namespace contact_math;
        const auto core = core_over(s, t);
        constexpr int last = decltype(core)::corners - 1;
        on_plane = on_shape = core.at[0];
        if (is_zero(widened(s.normal))) return;
        if (measure_plainly(s, core, static_cast<double>(radius_around_core(t)))) return;
        const common_scale scale(s, t);
        const corners corner{{scale(core.at[0]), scale(core.at[last > 0 ? 1 : 0]), scale(core.at[last])}};
        const plane_heights<3> over(s, corner.at, scale);
        int least_corner = 0;
        for (int i = 1; i < 3; ++i) {
            if (absolute(over.height[i].high) < absolute(over.height[least_corner].high)) least_corner = i;
        }
        const two_doubles height = over.height[least_corner];
        const int e = over.exponent < -2040 ? -2040 : over.exponent > 2040 ? 2040 : over.exponent;
        length = scaled(absolute(height.high), e);
        // The foot, in the plane's own scale.
        const two_doubles size = root(dot(over.normal, over.normal));
        const point& from = corner.at[least_corner];
        const auto foot = [&](double x, const two_doubles& n) {
            const int down = scale.exponent - e < -2040 ? -2040 : scale.exponent - e;
            const two_doubles at = two_doubles::of(scaled(x, down)) - height * (n / size);
            return rounded_within<T>(scaled(at.high, e));
        };
        on_plane = {foot(from.x, over.normal.x), foot(from.y, over.normal.y), foot(from.z, over.normal.z)};
        on_shape = least_corner == 0 ? core.at[0] : core.at[least_corner == 2 ? last : last > 0 ? 1 : 0];
        if constexpr (has_radius<S>) {
            const double radius = scale(t.radius);
            const double in_heights = scaled(radius, scale.exponent - e < -2040 ? -2040 : scale.exponent - e);
            length = scaled(plain_sum(absolute(height.high), -in_heights), e);
            const point n = unit_vector(over.normal);
            on_shape = scale.template back<T>(plain_step(from, height.high > 0 ? -radius : radius, n));
        }
    }
    /// From the nearest triangle of the fan that has all points of a hull.
    ABUT_HD constexpr measured_plane(const plane<T>& s, const hull<T>& h) : measured_plane(s, fan_triangle(h, 0)) {
        for (std::size_t i = 1; i < fan_size(h); ++i) {
            const measured_plane other(s, fan_triangle(h, i));
            if (other.length < length) *this = other;
        }
    }
    /// The box around a plane is everything: there is no distance from it that this might be below.
    [[nodiscard]] ABUT_HD constexpr double positive_length() const { return greatest(length, 0x1p-1074); }

private:
    /// In plain doubles, if they tell to which side of the plane the shape is.
    template <int N>
    ABUT_HD constexpr bool measure_plainly(const plane<T>& s, const corner_hull<T, N>& core, double radius) {
        double size = radius;
        for (const vec3<T>& p : core.at) size = greatest(size, contact_math::largest_of(widened(p)));
        const contact_math::plain_plane over(s, size);
        if (!over.is_good) return false;
        double height = infinity<double>;
        for (const vec3<T>& p : core.at) {
            const double other = over.height(widened(p));
            if (absolute(other) < absolute(height)) height = other, on_shape = p;
        }
        if (!(absolute(height) > 0x1p-40 * size)) return false;
        const vec3<T> from = on_shape;
        const auto step = [](T x, double by) { return rounded(static_cast<T>(plain_sum(static_cast<double>(x), by))); };
        const auto along = [&](double by) {
            const vec3<double> v = plain_times(by, over.unit);
            return vec3<T>{step(from.x, v.x), step(from.y, v.y), step(from.z, v.z)};
        };
        length = plain_sum(absolute(height), -radius);
        on_plane = along(-height);
        if (radius != 0) on_shape = along(height > 0 ? -radius : radius);
        return true;
    }
};

/// A cylinder or a cone and a plane, in this order.
template <class S, class U>
concept measured_revolution_over_plane = revolution_pair<S, U> && std::same_as<U, plane<scalar_type_of<U>>>;

/// A cylinder or a cone and a convex hull, in this order.
template <class S, class U>
concept measured_revolution_and_hull = solid_of_revolution<S> && std::same_as<U, hull<scalar_type_of<S>>>;

/// A distance and a way as long, from the first shape to the second, in no unit.
struct distance_and_way {
    double distance = infinity<double>;
    vec3<double> way{0, 0, 0};
};

/// Of a hull that does not touch a solid, the triangle of three points that is nearest to it.
template <solid_of_revolution S, scalar T>
ABUT_HD constexpr triangle<T> nearest_triangle_of(const S& s, const hull<T>& h) {
    const auto measure = [&](const triangle<T>& t) {
        const measured_pair<T> m(s, t);
        return distance_and_way{positive_distance(s, t, m.distance()), m.nearest.way};
    };
    return nearest_triangle<S, decltype(measure)>(s, h, measure).best;
}

/// Of a solid and a shape that the search in doubles knows. Boxes are nearer to each other than shapes, but where the way is
/// along an axis: coordinate by coordinate they are no farther apart than the ends of the way, less the radius.
template <class S, class U, scalar T>
ABUT_HD constexpr double distance_of_searched(const S& s, const U& t, const measured_plainly<T>& m) {
    const double distance = m.distance();
    const double rounding = 0x1p-48 * plain_sum(m.nearest.size, m.radius_b);
    const bool is_more = are_boxes_nearer(m.nearest.way, m.nearest.length, m.radius_b, rounding);
    return is_more ? distance : positive_distance(s, t, distance);
}

/// Of two shapes that do not touch, rounded to double: positive, or infinite.
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr distance_and_way distance_apart(const S& s, const U& t) {
    if constexpr (has_plain_pair<S, U>) {
        const plain_pair<S, U> first(s, t);
        if (first.touch() == verdict::no) return {plain_distance(s, t, first), first.way()};
    }
    if constexpr (searched_plainly<S, U>) {
        const measured_plainly<scalar_type_of<S>> m(s, t);
        if (m.nearest.is_sure) return {distance_of_searched(s, t, m), m.nearest.way};
    }
    if constexpr (measured_hulls<S, U>) {
        return with_measured_hulls(s, t, false, [&](const auto& m) {
            return distance_and_way{positive_distance_of(t, m), m.way()};
        });
    } else if constexpr (requires { s.normal; }) {
        return {measured_plane(s, t).positive_length()};
    } else if constexpr (measured_revolution_and_hull<S, U>) {
        return distance_apart(s, nearest_triangle_of(s, t));
    } else if constexpr (measured_revolution_over_plane<S, U>) {
        if (t.normal == vec3<scalar_type_of<S>>{0, 0, 0}) return {};
        return {positive_distance(s, t, revolution_over_plane(s, t, common_unit(s, t)).distance())};
    } else {
        const measured_pair<scalar_type_of<S>> m(s, t);
        return {positive_distance(s, t, m.distance()), m.nearest.way};
    }
}

/// Of measured hulls that do not touch, with the points, and ids 0.
template <class U, class Measured>
ABUT_HD constexpr auto separation_of_hulls_apart(const U& t, const Measured& m) {
    using T = scalar_type_of<U>;
    return separation<T>{0, 0, m.point_on_a(), m.point_on_b(), rounded_distance<T>(positive_distance_of(t, m))};
}

/// The same of a solid and a shape that the search in doubles knows.
template <class S, class U, scalar T>
ABUT_HD constexpr separation<T> separation_of_searched(const S& s, const U& t, const measured_plainly<T>& m) {
    return {0, 0, m.point_on_a(), m.point_on_b(t), rounded_distance<T>(distance_of_searched(s, t, m))};
}

/// The same of any shapes.
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr auto separation_apart(const S& s, const U& t) {
    using T = scalar_type_of<S>;
    if constexpr (has_plain_pair<S, U>) {
        const plain_pair<S, U> first(s, t);
        if (first.touch() == verdict::no) return plain_separation(s, t, first);
    }
    if constexpr (measured_hulls<S, U>) {
        return with_measured_hulls(s, t, false, [&](const auto& m) { return separation_of_hulls_apart(t, m); });
    } else if constexpr (requires { s.normal; }) {
        const measured_plane<T> m(s, t);
        return separation<T>{0, 0, m.on_plane, m.on_shape, rounded_distance<T>(m.positive_length())};
    } else if constexpr (measured_revolution_and_hull<S, U>) {
        return separation_apart(s, nearest_triangle_of(s, t));
    } else if constexpr (measured_revolution_over_plane<S, U>) {
        const vec3<T> end = axis_of(s).b;
        if (t.normal == vec3<T>{0, 0, 0}) return separation<T>{0, 0, end, end, infinity<T>};
        const revolution_over_plane<T> m(s, t, common_unit(s, t));
        return separation<T>{0, 0, m.point_on_solid(), m.point_on_plane(),
                             rounded_distance<T>(positive_distance(s, t, m.distance()))};
    } else {
        const measured_pair<T> m(s, t);
        return separation<T>{0, 0, m.point_on_a(s), m.point_on_b(t),
                             rounded_distance<T>(positive_distance(s, t, m.distance()))};
    }
}

template <scalar T>
ABUT_HD constexpr separation<T> reversed(const separation<T>& s) {
    return {s.b, s.a, s.point_b, s.point_a, s.distance};
}

/// Pairs of which a shape of the caller's own tells the distance itself: `separation_between(s, t)`, 0 where they touch.
template <class S, class U>
concept own_separation = requires(const S& s, const U& t) {
    { separation_between(s, t) } -> std::same_as<separation<scalar_type_of<S>>>;
};

/// Whether two shapes have a distance, in either order: those that have contacts, or tell it themselves.
template <class S, class U>
concept measurable = contact_pair<S, U> || contact_pair<U, S> || own_separation<S, U> || own_separation<U, S>;

/// Of a solid and what the search in doubles has looked at.
template <class S, class U, scalar T>
ABUT_HD constexpr separation<T> separation_by(const S& s, const U& t, const measured_plainly<T>& m, bool touch) {
    if (!touch) return m.nearest.is_sure ? separation_of_searched(s, t, m) : separation_apart(s, t);
    const vec3<T> shared = m.nearest.knows_shared_point() ? m.shared_point() : shared_point_of(s, t);
    return {0, 0, shared, shared, T(0)};
}

/// Two shapes of which it is known whether they touch.
template <class S, class U>
ABUT_HD constexpr auto separation_of(const S& s, const U& t, [[maybe_unused]] bool touch) {
    using T = scalar_type_of<S>;
    if constexpr (own_separation<S, U>) {
        return separation_between(s, t);
    } else if constexpr (own_separation<U, S>) {
        return reversed(separation_between(t, s));
    } else if constexpr (seen_as_hull<S> || seen_as_hull<U>) {
        const auto a = hull_form(s);
        const auto b = hull_form(t);
        return separation_of(a.as_hull(), b.as_hull(), touch);
    } else if constexpr (!contact_pair<S, U>) {
        return reversed(separation_of(t, s, touch));
    } else {
        if constexpr (solid_of_revolution<U>) {  // of two balls the same comes first in either order
            bool is_first = true;
            if constexpr (std::same_as<S, U>) is_first = !is_point(axis_of(s)) || precedes(t, s);
            if (is_point(axis_of(t)) && is_first) return separation_of(s, ball_around(t), touch);
        }
        if constexpr (solid_of_revolution<S>) {
            if (is_point(axis_of(s))) return separation_of(ball_around(s), t, touch);
        }
        if constexpr (is_half_space<S>) {
            if (!touch) return separation_of(surface_of(s), t, false);
        } else {
            if constexpr (searched_plainly<S, U>) return separation_by(s, t, measured_plainly<T>(s, t), touch);
            if (!touch) return separation_apart(s, t);
        }
        vec3<T> shared{};
        if constexpr ((refers_to_memory<S> || solid_of_revolution<S>) && has_first_contact<S, U>) {
            const auto first = first_contact_of(s, t, plain_pair<S, U>(s, t));
            if (first.touch == verdict::yes) return separation<T>{0, 0, first.found.point, first.found.point, T(0)};
        }
        if constexpr (measured_hulls<S, U>) {
            shared = with_measured_hulls(s, t, true, [](const auto& m) { return m.shared_point(); });
        } else if constexpr (solid_of_revolution<S>) {
            shared = shared_point_of(s, t);
        } else {
            shared = contact_between(s, t).point;
        }
        return separation<T>{0, 0, shared, shared, T(0)};
    }
}

/// Whether the closed form is looked at first. Boxes are decided sooner than they are measured.
template <class S, class U>
inline constexpr bool is_measured_plainly = false;
template <class S, class U>
    requires(contact_pair<S, U> && has_plain_pair<S, U>)
inline constexpr bool is_measured_plainly<S, U> = !std::same_as<S, aabb<scalar_type_of<S>>> || has_radius<U>;

/// Where the closed form is not looked at first.
struct no_plain_pair {};

template <class S, class U>
ABUT_HD constexpr auto separation_of(const S& s, const U& t);

/// The same where the closed form, `first`, does not say that they are apart. Of hulls the search for the distance mostly
/// tells that too; a device asks both, which is less code.
template <class S, class U, class First>
ABUT_HD constexpr auto separation_if_not_apart(const S& s, const U& t, [[maybe_unused]] const First& first) {
    using T = scalar_type_of<S>;
    constexpr bool on_device = ABUT_DEVICE_CODE != 0;
    if constexpr (is_measured_plainly<S, U>) {
        if constexpr (has_first_contact<S, U>) {
            const auto found = first_contact_of(s, t, first);
            if (found.touch == verdict::yes) return separation<T>{0, 0, found.found.point, found.found.point, T(0)};
        }
        if (first.touch() == verdict::yes) return separation_of(s, t, true);
    }
    if constexpr (own_separation<S, U> || own_separation<U, S>) {
        return separation_of(s, t, false);
    } else if constexpr (seen_as_hull<S> || seen_as_hull<U>) {
        const auto a = hull_form(s);
        const auto b = hull_form(t);
        return separation_of(a.as_hull(), b.as_hull());
    } else if constexpr (searched_plainly<S, U>) {
        if (!have_axes(s, t)) return separation_of(s, t, intersects(s, t));
        const measured_plainly<T> m(s, t);
        return m.are_apart() ? separation_of_searched(s, t, m) : separation_by(s, t, m, intersects(s, t));
    } else if constexpr (!contact_pair<S, U> && searched_plainly<U, S>) {
        return reversed(separation_of(t, s));
    } else if constexpr (measured_hulls<S, U> && !on_device) {
        const auto ask = [&] { return intersects(s, t); };
        return with_asked_hulls(s, t, ask, [&](const auto& m, bool touch) {
            if (!touch) return separation_of_hulls_apart(t, m);
            const vec3<T> shared = m.shared_point();
            return separation<T>{0, 0, shared, shared, T(0)};
        });
    } else if constexpr (!contact_pair<S, U> && measured_hulls<U, S> && !on_device) {
        return reversed(separation_of(t, s));
    } else {
        return separation_of(s, t, intersects(s, t));
    }
}

/// The same, out of its callers: with the closed form, or with what it takes to look again.
///@{
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr auto late_separation_of(const S& s, const U& t, const plain_pair<S, U>& first) {
    return separation_if_not_apart(s, t, first);
}
template <class S, class U>
ABUT_NOINLINE ABUT_HD constexpr auto late_separation_of(const S& s, const U& t) {
    return separation_if_not_apart(s, t, plain_pair<S, U>(s, t));
}
///@}

/// Two shapes of which it is not known whether they touch. What closed forms say of shapes apart is part of the caller: shapes
/// that it has placed and the answer need not go through memory. Nor does what the form knows of points and axes.
template <class S, class U>
ABUT_INLINE ABUT_HD constexpr auto separation_of(const S& s, const U& t) {
    if constexpr (!contact_pair<S, U> && is_measured_plainly<U, S>) {
        return reversed(separation_of(t, s));
    } else if constexpr (is_measured_plainly<S, U>) {
        const plain_pair<S, U> first(s, t);
        if (first.touch() == verdict::no) return plain_separation(s, t, first);
        // Copies, so that what is above need not lie in memory. To look again is sooner done, but for two axes.
        if constexpr (!requires { first.cores; }) {
            return separation_if_not_apart(s, t, first);
        } else if constexpr (corners_of_core<S> == 2) {
            const plain_pair<S, U> known = first;
            const auto late = late_separation_of(s, t, known);
            return separation<scalar_type_of<S>>{late.a, late.b, late.point_a, late.point_b, late.distance};
        } else {
            const auto late = late_separation_of(s, t);
            return separation<scalar_type_of<S>>{late.a, late.b, late.point_a, late.point_b, late.distance};
        }
    } else {
        return separation_if_not_apart(s, t, no_plain_pair{});
    }
}

}  // namespace detail

/// How far apart two closed shapes are: a `separation` with ids 0. It takes the pairs that `contact_of` takes, in either
/// order: points, segments, triangles, spheres, capsules, boxes and convex hulls with each other, and planes with any of
/// these; and cylinders and cones with all of these and with each other. The distance is 0 exactly where the two touch, as
/// `intersects` decides. Otherwise it is accurate to a few units in the last place of the shapes' farthest corners
/// (docs/numerics/distances.md). The same bits on every compiler and device, in constant expressions too. Shapes are finite
/// and valid.
///
///     constexpr auto d = abut::distance(abut::sphere<float>{{0, 0, 4}, 1},
///                                       abut::triangle<float>{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}});
///     static_assert(d.distance == 3 && d.point_a == abut::vec3<float>{0, 0, 3});
/// @ingroup one_pair
template <shape S, shape U>
[[nodiscard]] ABUT_INLINE ABUT_HD constexpr auto distance(const S& s, const U& t) {
    constexpr bool are = detail::measurable<S, U>;
    static_assert(are, "abut: there is no distance of this pair of shapes");
    if constexpr (are) {
        return detail::separation_of(detail::as_stored(s), detail::as_stored(t));
    } else {
        return separation<scalar_type_of<S>>{};
    }
}

}  // namespace abut
