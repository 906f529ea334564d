// SPDX-License-Identifier: MIT
#pragma once

// Pairs without a triangle, rays, and pairs that are asked about a distance, for bench/trade.cpp, bench/trade.cu and
// bench/trade_within.cu, in the same three kinds of input, on hosts and devices alike. Here `touching` holds shapes with a
// point in common, and others of which a radius, or the distance, is a step of the scalar type less or more; and rays that
// are aimed at a corner or a side.

#include <cstdint>

#include "../tests/support/shape_families.hpp"
#include "trade_pairs.hpp"

namespace trade {

/// Of numbers: of half of them the radius is a share of one.
template <template <class> class S, abut::scalar T>
ABUT_HD S<T> solid_of(abut::test::draws& d, input in) {
    T v[7];
    if (in == input::lattice) {
        abut::test::construction::draw_numbers(d, abut::test::shape_family::lattice_4, v);
    } else {
        for (T& x : v) x = static_cast<T>(d.uniform(-1, 1));
    }
    const abut::vec3<T> p{v[0], v[1], v[2]}, q{v[3], v[4], v[5]};
    const T radius = (v[6] < 0 ? -v[6] : v[6]) / (d.below(2) == 0 ? T(1) : T(4));
    if constexpr (requires { S<T>{}.lower; }) {
        return abut::test::construction::box_of(p, q);
    } else if constexpr (requires { S<T>{}.axis; }) {
        return {{p, q}, radius};
    } else {
        return {p, radius};
    }
}

/// The second shape has a radius.
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
        const A<T> a = make::touching_from<A<T>>(d, frame, 1, 1 + d.below(3));
        B<T> b = make::touching_from<B<T>>(d, frame, -1, 1 + d.below(3));
        b.radius = make::moved(b.radius, d.below(3) - 1);
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
template <class Add>
void for_each_distance_predicate(const Add& add) {
    add(triangles_within{});
    add(capsules_within{});
}

}  // namespace trade
