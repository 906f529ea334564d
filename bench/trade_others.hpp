// SPDX-License-Identifier: MIT
#pragma once

// Pairs without a triangle for bench/trade.cpp and bench/trade.cu, in the same three kinds of input, on hosts and devices
// alike. Here `touching` holds shapes with a point in common, and others of which a radius is a step of the scalar type less
// or more.

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

/// Calls add(Predicate{}) for each.
template <class Add>
void for_each_other_predicate(const Add& add) {
    add(sphere_sphere{});
    add(capsule_capsule{});
    add(box_sphere{});
    add(box_capsule{});
}

}  // namespace trade
