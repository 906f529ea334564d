// SPDX-License-Identifier: MIT
#pragma once

// Pairs with a convex hull of points, of the inputs of bench/trade_pairs.hpp. Hulls are lists of points here, which the host
// makes.

#include <cstdint>
#include <utility>

#include <abut/predicate/intersects.hpp>

#include "../tests/support/hull_pairs.hpp"
#include "../tests/support/hulls.hpp"
#include "trade_others.hpp"
#include "trade_pairs.hpp"

namespace trade {

/// Two convex hulls, of some ten points at most. `touching` holds hulls in contact and others a step off it.
struct hull_hull {
    static constexpr const char* name = "hull_hull";
    template <abut::scalar T>
    static auto make(input in, std::uint64_t i) {
        using abut::test::hull_family;
        const auto touching = i % 2 == 0 ? hull_family::touching : hull_family::step_off;
        auto p = abut::test::make_hull_pair<T>(seed,
                                               in == input::random     ? hull_family::general
                                               : in == input::touching ? touching
                                                                       : hull_family::lattice,
                                               i);
        using list = abut::test::point_list<T>;
        return pair<list, list>{std::move(p.a), std::move(p.b)};
    }
};

/// A hull of six points, and another shape as in bench/trade_others.hpp: half of the touching ones are a tenth as large,
/// with numbers rounded.
template <template <class> class Other>
struct hull_and {
    template <abut::scalar T>
    static pair<abut::test::point_list<T>, Other<T>> make(input in, std::uint64_t i) {
        namespace make = abut::test::construction;
        abut::test::draws d(seed, 8870 + static_cast<std::uint64_t>(in), i);
        abut::test::point_list<T> points;
        const auto add = [&points](const abut::triangle<T>& t) { points.insert(points.end(), {t.a, t.b, t.c}); };
        if (in != input::touching) {
            for (int k = 0; k < 2; ++k) add(solid_of<abut::triangle, T>(d, in));
            return {std::move(points), solid_of<Other, T>(d, in)};
        }
        const make::contact_frame frame = make::any_contact_frame(d, 0);
        for (int k = 0; k < 2; ++k) add(make::touching_from<abut::triangle<T>>(d, frame, 1, 0));
        auto other = make::touching_from<Other<T>>(d, frame, -1, 1 + d.below(3));
        step_off(d, other);
        if (i % 2 == 1) {
            const T tenth = T(1) / T(10);
            for (abut::vec3<T>& p : points) p = tenth * p;
            other = make::scaled(tenth, other);
        }
        return {std::move(points), other};
    }
};
struct hull_point : hull_and<abut::vec3> {
    static constexpr const char* name = "hull_point";
};
struct hull_segment : hull_and<abut::segment> {
    static constexpr const char* name = "hull_segment";
};
struct hull_triangle : hull_and<abut::triangle> {
    static constexpr const char* name = "hull_triangle";
};
struct hull_sphere : hull_and<abut::sphere> {
    static constexpr const char* name = "hull_sphere";
};
struct hull_capsule : hull_and<abut::capsule> {
    static constexpr const char* name = "hull_capsule";
};
struct hull_box : hull_and<abut::aabb> {
    static constexpr const char* name = "hull_box";
};
struct hull_plane : hull_and<abut::plane> {
    static constexpr const char* name = "hull_plane";
};

/// From one end of a segment through the other one.
struct hull_ray {
    static constexpr const char* name = "hull_ray";
    template <abut::scalar T>
    static pair<abut::test::point_list<T>, abut::ray<T>> make(input in, std::uint64_t i) {
        auto p = hull_segment::make<T>(in, i);
        return {std::move(p.s), {p.t.a, p.t.b - p.t.a}};
    }
};

/// Calls f(Predicate{}) for each.
template <class F>
void for_each_hull_predicate(const F& f) {
    f(hull_hull{});
    f(hull_point{});
    f(hull_segment{});
    f(hull_triangle{});
    f(hull_sphere{});
    f(hull_capsule{});
    f(hull_box{});
    f(hull_plane{});
    f(hull_ray{});
}

}  // namespace trade
