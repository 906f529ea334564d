// SPDX-License-Identifier: MIT
#pragma once

// Families of pairs of a triangle with a box, a plane or a capsule, each built to break something. A pair is a pure function
// of (seed, family, index), as in families.hpp.

#include <cstdint>
#include <type_traits>

#include "box_pairs.hpp"
#include "capsule_pairs.hpp"
#include "plane_pairs.hpp"

namespace abut::test {

/// Pair number `index` of a family, of a triangle and a `Shape`: aabb, plane or capsule.
template <template <class> class Shape, scalar T>
ABUT_HD shape_triangle_pair<Shape, T> make_shape_pair(std::uint64_t seed, shape_family f, std::uint64_t index) {
    namespace make = construction;
    using make::point;
    draws d(seed, 100 + static_cast<std::uint64_t>(f), index);
    shape_triangle_pair<Shape, T> p{};
    switch (f) {
        case shape_family::small_triangle:
        case shape_family::large_triangle: {
            // `at` is the middle of the triangle's face, at a distance of up to three sizes or shapes from the shape's
            // surface. A plane has no size of its own.
            constexpr bool is_plane = std::is_same_v<Shape<T>, plane<T>>;
            const double size = f == shape_family::small_triangle ? d.power_of_ten(-6, -1) : d.power_of_ten(1, 6);
            make::general(d, 1, {0, 0, 0}, p);
            const point near_by = make::surface_point(d, p), aside = make::cube(d, 0.5);
            const point at = make::along(near_by, 3 * (size < 1 || is_plane ? size : 1), aside);
            const point u = make::cube(d, 1), v = make::cube(d, 1);
            p.t = {make::round_to<T>(make::along(at, size, u)), make::round_to<T>(make::along(at, size, v)),
                   make::round_to<T>(make::along(make::along(at, -size, u), -size, v))};
            break;
        }
        case shape_family::needle_1e3:
        case shape_family::needle_1e6:
        case shape_family::needle_1e9:
            p.t = make::needle<T>(d, f == shape_family::needle_1e3 ? 1e3 : f == shape_family::needle_1e6 ? 1e6 : 1e9);
            make::general(d, 0.5,
                          make::along(make::widened(p.t.a), 0.5, make::between(make::widened(p.t.a), make::widened(p.t.b))),
                          p);
            break;
        case shape_family::degenerate:
            if (d.below(2) == 0) {
                T v[16];
                make::draw_numbers(d, shape_family::lattice_16, v);
                make::from_numbers(d, shape_family::lattice_16, v, p);
            } else {
                make::touching(d, d.below(5), p);
            }
            make::collapse(d, p.t);
            break;
        case shape_family::no_extent: {
            const point on = make::lattice_point_of(d, p.t);
            make::without_extent(d, on, p);
            if (d.below(3) == 0) make::nudge(d, p.t);
            if (d.below(4) == 0) make::collapse(d, p.t);
            break;
        }
        case shape_family::touching_0:
        case shape_family::touching_1:
        case shape_family::touching_2:
        case shape_family::touching_3:
        case shape_family::touching_4:
            make::touching(d, static_cast<int>(f) - static_cast<int>(shape_family::touching_0), p);
            break;
        case shape_family::any_scale: {
            make::touching(d, d.below(5), p);
            const T by = make::any_power_of_two<T>(d);
            p = {make::scaled(by, p.s), make::scaled(by, p.t)};
            break;
        }
        case shape_family::lattice_4:
        case shape_family::lattice_16:
        case shape_family::lattice_256:
        case shape_family::tenths_4:
        case shape_family::tenths_16:
        case shape_family::tenths_256:
        case shape_family::denormal:
        case shape_family::largest:
        case shape_family::all_bit_patterns: {
            T v[16];
            make::draw_numbers(d, f, v);
            make::from_numbers(d, f, v, p);
            break;
        }
        case shape_family::mixed_exponents: {
            T v[16];
            make::draw_mixed(d, v);
            make::from_numbers(d, f, v, p);
            break;
        }
        default: {
            const double scale = make::scale_of(f), far = make::offset_of(f);
            const point offset{far, -far, far / 2};
            const auto corner = [&] { return make::round_to<T>(make::along(offset, scale, make::cube(d, 1))); };
            p.t.a = corner();
            p.t.b = corner();
            p.t.c = corner();
            make::general(d, scale, offset, p);
        }
    }
    return p;
}

}  // namespace abut::test
