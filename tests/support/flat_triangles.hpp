// SPDX-License-Identifier: MIT
#pragma once

// Triangles that have no area, or nearly none, from a seed: for has_zero_area, and as faces of meshes.

#include <cstdint>

#include <abut/shape/primitive.hpp>

#include "draws.hpp"

namespace abut::test {

enum class flat_family : unsigned char {
    random,            // of any size from 1e-6 to 1e6: none is flat
    lattice,           // corners in a lattice of 3 steps a side: many are flat
    tenth_lattice,     // the same times 0.1, rounded: some of those remain flat
    collinear,         // steps of an integer vector, so exactly on a line
    collinear_scaled,  // the same times a number, rounded
    one_ulp_off,       // exactly on a line, then one coordinate moved by a step
    rounded_line,      // on a line in real numbers, each corner rounded
    far_off,           // integers beside an offset that takes all bits but a few
    points,            // two or three equal corners
    denormals,         // small multiples of the least number
    partly_denormal,   // on a line through 0, with one coordinate about the least normal number
    largest,           // small fractions of the largest number
    across,            // from one end of the numbers to the other, nearly along an axis
    mixed_exponents,   // multiples of an integer vector by powers of two far apart: on a line through 0
    mixed_off,         // the same, one coordinate moved by a step
    along_axis,        // on a line along an axis at any bit patterns, or the least number off it
    any_bits,          // any finite bit patterns
    count
};
inline constexpr int flat_family_count = static_cast<int>(flat_family::count);

template <scalar T>
vec3<T> draw_lattice_point(draws& d, int steps, T unit) {
    const int x = d.below(steps + 1), y = d.below(steps + 1), z = d.below(steps + 1);
    using construction::rounded_to;
    const auto at = [&](int k) { return rounded_to<T>(static_cast<double>(k) * static_cast<double>(unit)); };
    return {at(x), at(y), at(z)};
}

/// k times an integer vector, which stays exact for |k| below 2^10.
template <scalar T>
vec3<T> multiple(const vec3<T>& v, int k) {
    return {static_cast<T>(k) * v.x, static_cast<T>(k) * v.y, static_cast<T>(k) * v.z};
}

template <scalar T>
T power_of_two(int e) {
    T r = 1;
    for (int i = 0; i < (e < 0 ? -e : e); ++i) r *= e < 0 ? T(0.5) : T(2);
    return r;
}

/// One coordinate of one corner, a step up or down.
template <scalar T>
void move_one_coordinate(draws& d, triangle<T>& t) {
    vec3<T>* const corners[3] = {&t.a, &t.b, &t.c};
    vec3<T>& p = *corners[d.below(3)];
    T* const coordinates[3] = {&p.x, &p.y, &p.z};
    T& x = *coordinates[d.below(3)];
    const T stepped = construction::moved(x, d.below(2) == 0 ? 1 : -1);
    if (stepped - stepped == 0) x = stepped;
}

template <scalar T>
triangle<T> make_flat_triangle(std::uint64_t seed_value, flat_family family, std::uint64_t index) {
    using namespace construction;
    draws d(seed_value, 64 + static_cast<std::uint64_t>(family), index);
    const auto integers = [&](int most) {
        const int x = d.below(2 * most + 1) - most, y = d.below(2 * most + 1) - most, z = d.below(2 * most + 1) - most;
        return vec3<T>{static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
    };
    const auto from_three = [&](const auto& corner) {
        const vec3<T> a = corner(), b = corner(), c = corner();
        return triangle<T>{a, b, c};
    };
    const auto on_line = [&] {
        const vec3<T> from = integers(1000), along = integers(100);
        return from_three([&] { return from + multiple(along, d.below(201) - 100); });
    };
    const auto mixed = [&] {
        const vec3<T> v = integers(100);
        const int span = sizeof(T) == 4 ? 110 : 1000;
        return from_three([&] {
            const T s = power_of_two<T>(d.below(2 * span + 1) - span);
            return vec3<T>{s * v.x, s * v.y, s * v.z};
        });
    };
    triangle<T> t{};
    switch (family) {
        case flat_family::random: {
            const double size = d.power_of_ten(-6, 6);
            return from_three([&] { return round_to<T>(cube(d, size)); });
        }
        case flat_family::lattice:
            return from_three([&] { return draw_lattice_point<T>(d, 3, T(1)); });
        case flat_family::tenth_lattice:
            return from_three([&] { return draw_lattice_point<T>(d, 3, T(0.1)); });
        case flat_family::collinear:
            return on_line();
        case flat_family::collinear_scaled: {
            t = on_line();
            const double scale = d.power_of_ten(-12, 12);
            const auto scaled = [&](const vec3<T>& p) {
                return vec3<T>{rounded_to<T>(scale * static_cast<double>(p.x)),
                               rounded_to<T>(scale * static_cast<double>(p.y)),
                               rounded_to<T>(scale * static_cast<double>(p.z))};
            };
            return {scaled(t.a), scaled(t.b), scaled(t.c)};
        }
        case flat_family::one_ulp_off:
            t = on_line();
            move_one_coordinate(d, t);
            return t;
        case flat_family::rounded_line: {
            const point from = cube(d, 1), along_it = cube(d, 1);
            return from_three([&] { return round_to<T>(along(from, d.uniform(-1, 1), along_it)); });
        }
        case flat_family::far_off: {
            const T offset = power_of_two<T>(sizeof(T) == 4 ? 22 : 51);
            return from_three([&] { return vec3<T>{offset, offset, -offset} + draw_lattice_point<T>(d, 3, T(1)); });
        }
        case flat_family::points: {
            const vec3<T> p = round_to<T>(cube(d, 1)), q = d.below(2) == 0 ? p : round_to<T>(cube(d, 1));
            const int k = d.below(3);
            t = {k == 0 ? q : p, k == 1 ? q : p, k == 2 ? q : p};
            if (d.below(4) == 0) move_one_coordinate(d, t);
            return t;
        }
        case flat_family::denormals:
            return from_three([&] {
                const vec3<T> p = integers(1);
                return vec3<T>{p.x * least_denormal<T>, p.y * least_denormal<T>, p.z * least_denormal<T>};
            });
        case flat_family::partly_denormal: {
            const vec3<T> v = integers(3);
            const T unit = sizeof(T) == 4 ? T(0x1p-128) : T(0x1p-1024);
            const int axis = d.below(3);
            return from_three([&] {
                const vec3<T> p = multiple(v, d.below(17) - 8);
                return axis == 0   ? vec3<T>{unit * p.x, p.y, p.z}
                       : axis == 1 ? vec3<T>{p.x, unit * p.y, p.z}
                                   : vec3<T>{p.x, p.y, unit * p.z};
            });
        }
        case flat_family::largest: {
            const auto halves = [&] { return static_cast<T>(d.below(5) - 2) / 2 * largest_number<T>; };
            t = from_three([&] {
                const T x = halves(), y = halves();
                return vec3<T>{x, y, halves()};
            });
            if (d.below(3) == 0) move_one_coordinate(d, t);
            return t;
        }
        case flat_family::across: {
            const T large = largest_number<T>, y = power_of_two<T>(-d.below(100)), z = power_of_two<T>(-d.below(100));
            const int axis = d.below(3);
            const vec3<T> p = axis == 0 ? vec3<T>{large, y, z} : axis == 1 ? vec3<T>{z, large, y} : vec3<T>{y, z, large};
            const T part = T(0.5) * static_cast<T>(d.below(3) - 1);
            t = {{-p.x, -p.y, -p.z}, p, {part * p.x, part * p.y, part * p.z}};
            if (d.below(3) == 0) move_one_coordinate(d, t);
            return t;
        }
        case flat_family::mixed_exponents:
            return mixed();
        case flat_family::mixed_off:
            t = mixed();
            if (d.below(4) != 0) move_one_coordinate(d, t);
            return t;
        case flat_family::along_axis: {
            const int axis = d.below(3);
            t = from_three([&] {
                const T x = any_finite<T>(d), off = d.below(6) == 0 ? least_denormal<T> : T(0);
                return axis == 0 ? vec3<T>{x, off, 0} : axis == 1 ? vec3<T>{0, x, off} : vec3<T>{off, 0, x};
            });
            return t;
        }
        default:
            return from_three([&] {
                const T x = any_finite<T>(d), y = any_finite<T>(d);
                return vec3<T>{x, y, any_finite<T>(d)};
            });
    }
}

}  // namespace abut::test
