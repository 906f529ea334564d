// SPDX-License-Identifier: MIT
#pragma once

// The pairs that trade_pairs.hpp lacks, but for hulls, and pairs that are asked about a distance, for bench/trade.cpp,
// bench/trade.cu, bench/trade_solids.cu and bench/trade_within.cu, in the same three kinds of input, on hosts and devices
// alike. Here `touching` holds shapes with a point in common, and others of which one number is a step of the scalar type
// less or more: a radius, the offset of a plane, the distance, or else a coordinate (of boxes all of them); and rays that
// are aimed at a corner or a side.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "../tests/support/shape_families.hpp"
#include "trade_pairs.hpp"

namespace trade {

/// Of numbers: of half of them the radius is a share of one, and half of the planes on the lattice go through a point of it.
template <template <class> class S, abut::scalar T>
ABUT_HD S<T> solid_of(abut::test::draws& d, input in) {
    T v[7];
    const auto draw = [&d, in](auto& numbers) {
        if (in == input::lattice) {
            abut::test::construction::draw_numbers(d, abut::test::shape_family::lattice_4, numbers);
        } else {
            for (T& x : numbers) x = static_cast<T>(d.uniform(-1, 1));
        }
    };
    draw(v);
    const abut::vec3<T> p{v[0], v[1], v[2]}, q{v[3], v[4], v[5]};
    const bool half = d.below(2) == 0;
    const T radius = (v[6] < 0 ? -v[6] : v[6]) / (half ? T(1) : T(4));
    if constexpr (std::same_as<S<T>, abut::vec3<T>>) {
        return p;
    } else if constexpr (std::same_as<S<T>, abut::segment<T>>) {
        return {p, q};
    } else if constexpr (std::same_as<S<T>, abut::triangle<T>>) {
        T w[3];
        draw(w);
        return {p, q, {w[0], w[1], w[2]}};
    } else if constexpr (std::same_as<S<T>, abut::plane<T>>) {
        return {p, in == input::lattice && half ? dot(p, q) : v[6]};
    } else if constexpr (std::same_as<S<T>, abut::aabb<T>>) {
        return abut::test::construction::box_of(p, q);
    } else if constexpr (std::same_as<S<T>, abut::capsule<T>>) {
        return {{p, q}, radius};
    } else {
        return {p, radius};
    }
}

/// A radius or an offset, which alone decides how far a shape reaches.
template <class S>
inline constexpr bool has_reach = abut::detail::has_radius<S> || std::same_as<S, abut::plane<abut::scalar_type_of<S>>>;

/// A step at most, of the reach, of all numbers of a box, or else of some coordinate. A coordinate or an offset of 0 stays:
/// its next numbers are denormal.
template <class S>
ABUT_HD void step_off(abut::test::draws& d, S& s) {
    using T = abut::scalar_type_of<S>;
    const auto step = [&d](T& x) {
        const int steps = d.below(3) - 1;
        if (x != 0) x = abut::test::construction::moved(x, steps);
    };
    if constexpr (requires { s.radius; }) {
        step(s.radius);
    } else if constexpr (requires { s.offset; }) {
        step(s.offset);
    } else {
        constexpr std::size_t count = sizeof(S) / sizeof(T);
        struct numbers {
            T at[count];
        };
        numbers all = __builtin_bit_cast(numbers, s);
        if constexpr (std::same_as<S, abut::aabb<T>>) {
            for (T& x : all.at) step(x);
        } else {
            auto k = static_cast<std::size_t>(d.below(static_cast<int>(count)));
            for (std::size_t tried = 0; tried < count && all.at[k] == 0; ++tried) k = (k + 1) % count;
            step(all.at[k]);
        }
        s = __builtin_bit_cast(S, all);
        if constexpr (std::same_as<S, abut::aabb<T>>) s = abut::test::construction::box_of(s.lower, s.upper);
    }
}

template <template <class> class A, template <class> class B>
struct two_solids {
    template <abut::scalar T>
    ABUT_HD static pair<A<T>, B<T>> make(input in, std::uint64_t i) {
        namespace make = abut::test::construction;
        abut::test::draws d(seed, 8850 + static_cast<std::uint64_t>(in), i);
        if (in != input::touching) {
            const A<T> a = solid_of<A, T>(d, in);
            return {a, solid_of<B, T>(d, in)};
        }
        const make::contact_frame frame = make::any_contact_frame(d, 0);
        A<T> a = make::touching_from<A<T>>(d, frame, 1, 1 + d.below(3));
        B<T> b = make::touching_from<B<T>>(d, frame, -1, 1 + d.below(3));
        if constexpr (has_reach<A<T>> && !has_reach<B<T>>) {
            step_off(d, a);
        } else {
            step_off(d, b);
        }
        return {a, b};
    }
};
struct sphere_sphere : two_solids<abut::sphere, abut::sphere> {
    static constexpr const char* name = "sphere_sphere";
};
struct capsule_capsule : two_solids<abut::capsule, abut::capsule> {
    static constexpr const char* name = "capsule_capsule";
};
struct box_sphere : two_solids<abut::aabb, abut::sphere> {
    static constexpr const char* name = "box_sphere";
};
struct box_capsule : two_solids<abut::aabb, abut::capsule> {
    static constexpr const char* name = "box_capsule";
};

/// Half of the touching ones are a tenth as large, with numbers rounded.
template <template <class> class A, template <class> class B>
struct two_sizes {
    template <abut::scalar T>
    ABUT_HD static pair<A<T>, B<T>> make(input in, std::uint64_t i) {
        namespace make = abut::test::construction;
        const pair<A<T>, B<T>> p = two_solids<A, B>::template make<T>(in, i);
        if (in != input::touching || i % 2 == 0) return p;
        const T tenth = T(1) / T(10);
        return {make::scaled(tenth, p.s), make::scaled(tenth, p.t)};
    }
};
struct point_point : two_sizes<abut::vec3, abut::vec3> {
    static constexpr const char* name = "point_point";
};
struct point_segment : two_sizes<abut::vec3, abut::segment> {
    static constexpr const char* name = "point_segment";
};
struct point_triangle : two_sizes<abut::vec3, abut::triangle> {
    static constexpr const char* name = "point_triangle";
};
struct point_sphere : two_sizes<abut::vec3, abut::sphere> {
    static constexpr const char* name = "point_sphere";
};
struct point_capsule : two_sizes<abut::vec3, abut::capsule> {
    static constexpr const char* name = "point_capsule";
};
struct segment_segment : two_sizes<abut::segment, abut::segment> {
    static constexpr const char* name = "segment_segment";
};
struct sphere_segment : two_sizes<abut::sphere, abut::segment> {
    static constexpr const char* name = "sphere_segment";
};
struct segment_capsule : two_sizes<abut::segment, abut::capsule> {
    static constexpr const char* name = "segment_capsule";
};
struct sphere_capsule : two_sizes<abut::sphere, abut::capsule> {
    static constexpr const char* name = "sphere_capsule";
};
struct box_point : two_sizes<abut::aabb, abut::vec3> {
    static constexpr const char* name = "box_point";
};
struct box_segment : two_sizes<abut::aabb, abut::segment> {
    static constexpr const char* name = "box_segment";
};
struct box_box : two_sizes<abut::aabb, abut::aabb> {
    static constexpr const char* name = "box_box";
};
struct plane_point : two_sizes<abut::plane, abut::vec3> {
    static constexpr const char* name = "plane_point";
};
struct plane_segment : two_sizes<abut::plane, abut::segment> {
    static constexpr const char* name = "plane_segment";
};
struct plane_sphere : two_sizes<abut::plane, abut::sphere> {
    static constexpr const char* name = "plane_sphere";
};
struct plane_capsule : two_sizes<abut::plane, abut::capsule> {
    static constexpr const char* name = "plane_capsule";
};
struct plane_box : two_sizes<abut::plane, abut::aabb> {
    static constexpr const char* name = "plane_box";
};

/// `touching` planes are one, by equations that are multiples of each other; or with a step, or with one of the equations
/// divided by ten and rounded.
struct plane_plane {
    static constexpr const char* name = "plane_plane";
    template <abut::scalar T>
    ABUT_HD static pair<abut::plane<T>, abut::plane<T>> make(input in, std::uint64_t i) {
        auto p = two_solids<abut::plane, abut::plane>::make<T>(in, i);
        if (in != input::touching) return p;
        const T times = static_cast<T>(1 + i / 2 % 3), tenth = T(1) / T(10);
        p.s = {times * p.s.normal, times * p.s.offset};
        if (i % 2 == 1) p.t = {tenth * p.t.normal, tenth * p.t.offset};
        return p;
    }
};

/// From a corner of one triangle along its side, and the other triangle; or towards the border of the other.
struct ray_triangle {
    static constexpr const char* name = "ray_triangle";
    template <abut::scalar T>
    ABUT_HD static pair<abut::ray<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        const auto p = abut::test::make_triangle_pair<T>(
            seed, in == input::lattice ? triangle_family::lattice_4 : triangle_family::random, i);
        const auto towards = [&](const abut::vec3<T>& to) { return abut::ray<T>{p.a.a, to - p.a.a}; };
        if (in != input::touching) return {towards(p.a.b), p.b};
        if (i % 2 == 0) return {towards(p.b.a), p.b};
        return {towards(T(0.5) * p.b.a + T(0.5) * p.b.b), p.b};
    }
};

/// Two triangles and a distance. `touching` ones are as far apart, to a step; half of them are a tenth as large, with
/// coordinates rounded.
struct triangles_within {
    static constexpr const char* name = "triangles_within";
    template <abut::scalar T>
    ABUT_HD static spaced_pair<abut::triangle<T>, abut::triangle<T>> make(input in, std::uint64_t i) {
        namespace make = abut::test::construction;
        abut::test::draws d(seed, 8860 + static_cast<std::uint64_t>(in), i);
        if (in != input::touching) {
            const auto p = two_triangles<T>(in, i);
            const T distance = in == input::lattice ? static_cast<T>(d.below(3)) : make::rounded_to<T>(d.uniform(0, 1));
            return {p.a, p.b, distance};
        }
        make::contact_frame frame = make::any_contact_frame(d, 0);
        const auto a = make::touching_from<abut::triangle<T>>(d, frame, 1, 0);
        const int apart = 1 + d.below(3);
        frame.at = make::along(frame.at, -apart, frame.normal);
        const auto b = make::touching_from<abut::triangle<T>>(d, frame, -1, 0);
        const T distance = make::moved(static_cast<T>(apart * frame.length), d.below(3) - 1);
        if (i % 2 == 0) return {a, b, distance};
        const T tenth = T(1) / T(10);
        return {make::scaled(tenth, a), make::scaled(tenth, b), tenth * distance};
    }
};

/// Two capsules of two_solids, of which the second one's radius is halved; the other half is the distance.
struct capsules_within {
    static constexpr const char* name = "capsules_within";
    template <abut::scalar T>
    ABUT_HD static spaced_pair<abut::capsule<T>, abut::capsule<T>> make(input in, std::uint64_t i) {
        auto p = capsule_capsule::make<T>(in, i);
        p.t.radius /= 2;
        return {p.s, p.t, p.t.radius};
    }
};

/// Calls add(Predicate{}) for each.
template <class Add>
void for_each_other_predicate(const Add& add) {
    add(sphere_sphere{});
    add(capsule_capsule{});
    add(box_sphere{});
    add(box_capsule{});
    add(ray_triangle{});
}
/// All other pairs of shapes but rays and hulls.
template <class Add>
void for_each_solid_predicate(const Add& add) {
    add(point_point{});
    add(point_segment{});
    add(point_triangle{});
    add(point_sphere{});
    add(point_capsule{});
    add(segment_segment{});
    add(sphere_segment{});
    add(segment_capsule{});
    add(sphere_capsule{});
    add(box_point{});
    add(box_segment{});
    add(box_box{});
    add(plane_point{});
    add(plane_segment{});
    add(plane_sphere{});
    add(plane_capsule{});
    add(plane_box{});
    add(plane_plane{});
}
template <class Add>
void for_each_distance_predicate(const Add& add) {
    add(triangles_within{});
    add(capsules_within{});
}

}  // namespace trade
