// SPDX-License-Identifier: MIT
#pragma once

// Families of moving pairs, vertex-face and edge-edge, each built to break something of continuous collision detection. A
// pair is a pure function of (seed, kind, family, index), on hosts and devices alike and bit for bit; draws.hpp says how.

#include <cstdint>

#include <abut/config.hpp>

#include "draws.hpp"
#include "motion.hpp"
#include "motion_exact.hpp"
#include "motion_rounded.hpp"

namespace abut::test {

enum class motion_family : int {
    // Rounded
    random,           // eight points in a cube
    crossing,         // a contact on the way, but for rounding
    crossing_border,  // ... near or on the border of a feature
    fast,             // ... with motions of 1e2 to 1e5 times the size
    slow,             // ... of 1e-6 to 1e-2 times the size
    steps,            // points that move by a few units in the last place
    needles,          // ... slender features, to 1e9
    flat,             // ... all nearly in one plane, rounded off it
    rotating,         // turns while it passes at a distance of 1e-8 to 1e-2
    offset_1e6,       // size 1e0 to 1e3, there
    offset_1e9,       // size 1e2 to 1e6, there
    rigid_rounded,    // one motion for both, rounded
    tenths_4,         // 0.1 times a lattice
    // Exact: there is a contact, at t = m / 2^j or before
    touch_inside,  // vertex inside the face, edges inside both or at a diagonal's middle
    touch_edge,    // vertex on an edge of the face, the end of an edge inside the other
    touch_corner,  // vertex on a corner, two ends
    touch_first,   // any of these at t = 0
    touch_last,    // any of these at t = 1
    touch_far,     // any of these at up to 2^22 (float) or 2^50 (double) from the origin
    translating,   // any of these; the second feature at rest, the first moves as one
    double_root,   // touches and goes away
    two_roots,
    three_roots,        // all in [0, 1], some of them equal
    degenerate,         // zero-length edges; triangles that are segments or points, and stay so
    collapsing,         // degenerate at the time of contact only
    coplanar_sliding,   // always in one plane, which may move and turn
    collinear_sliding,  // always on one line
    // Exact: with contact and without
    nudged,    // one of those exact ones, with one coordinate off by a unit in the last place
    parallel,  // edges that stay parallel; a vertex that moves along the face
    rigid,     // one motion for both
    at_rest,   // nothing moves
    at_rest_coplanar,
    shared,     // a point in common, at all times, at t = 0 or at t = 1
    lattice_2,  // {0, 1}^3
    lattice_4,
    lattice_16,
    // The number range
    any_scale,     // one of the exact ones times any power of two; may be rounded
    axis_scales,   // lattice_4, with a power of two for each axis
    denormal,      // lattices of the least number, signed zeros among them
    wide_lattice,  // 0, +- the least number, 1, 1 and an ulp, the largest
    largest,
    all_bit_patterns,
};

inline constexpr int motion_family_count = static_cast<int>(motion_family::all_bit_patterns) + 1;

/// Each pair of the family has a contact.
inline constexpr bool always_hits(motion_family f) {
    return (f >= motion_family::touch_inside && f <= motion_family::collinear_sliding) || f == motion_family::shared;
}

/// On the host only.
inline const char* name_of(motion_family f) {
    // clang-format off
    constexpr const char* names[motion_family_count] = {
        "random",           "crossing",          "crossing at a border", "fast",           "slow",
        "steps",            "needles",           "flat",                 "rotating",       "offset 1e6",
        "offset 1e9",       "rigid, rounded",    "0.1 lattice 4",        "touch inside",   "touch an edge",
        "touch a corner",   "touch at t = 0",    "touch at t = 1",       "touch far away", "translating",
        "double root",      "two roots",         "three roots",          "degenerate",     "collapsing",
        "coplanar sliding", "collinear sliding", "nudged",               "parallel",       "rigid",
        "at rest",          "at rest, coplanar", "shared point",         "lattice 2",      "lattice 4",
        "lattice 16",       "any scale",         "scales of axes",       "denormal",       "wide lattice",
        "largest",          "all bit patterns"};
    // clang-format on
    return names[static_cast<int>(f)];
}

namespace construction::motions {

/// One of the exact families, but for lattices; with a contact.
template <scalar T>
ABUT_HD motion<T> exact_pair(draws& d, motion_kind kind, motion_family f) {
    const int bits = 2 + d.below(18 + spare_bits<T>);
    const auto anywhere = [&](const relative& r) { return placed_anywhere<T>(d, kind, r, bits); };
    switch (f) {
        case motion_family::touch_inside:
            return anywhere(touch<T>(d, 0, draw_time(d)));
        case motion_family::touch_edge:
            return anywhere(touch<T>(d, 1, draw_time(d)));
        case motion_family::touch_corner:
            return anywhere(touch<T>(d, 2, draw_time(d)));
        case motion_family::touch_first:
            return anywhere(touch<T>(d, d.below(3), {0, 1}));
        case motion_family::touch_last:
            return anywhere(touch<T>(d, d.below(3), {1, 1}));
        case motion_family::touch_far: {
            const int place = d.below(3);
            return placed_anywhere<T>(d, kind, touch<T>(d, place, draw_time(d)), 22 + spare_bits<T>);
        }
        case motion_family::translating:
            return translating_pair<T>(d, kind);
        case motion_family::double_root: {
            const dyadic_time tau = draw_time(d);
            return anywhere(rocking<T>(d, tau, tau));
        }
        case motion_family::two_roots: {
            const dyadic_time first = draw_time(d), second = draw_time(d);
            return anywhere(rocking<T>(d, first, second));
        }
        case motion_family::three_roots:
            return anywhere(three_roots<T>(d));
        case motion_family::degenerate:
            return anywhere(degenerate<T>(d, true));
        case motion_family::collapsing:
            return anywhere(degenerate<T>(d, false));
        case motion_family::coplanar_sliding:
            return anywhere(sliding<T>(d, false));
        default:
            return anywhere(sliding<T>(d, true));
    }
}

/// Any of these.
template <scalar T>
ABUT_HD motion<T> any_exact_pair(draws& d, motion_kind kind) {
    constexpr int first = static_cast<int>(motion_family::touch_inside),
                  last = static_cast<int>(motion_family::collinear_sliding);
    return exact_pair<T>(d, kind, static_cast<motion_family>(first + d.below(last - first + 1)));
}

template <scalar T>
ABUT_HD motion<T> nudged_pair(draws& d, motion_kind kind) {
    motion<T> m = any_exact_pair<T>(d, kind);
    T& x = any_coordinate(d, m);
    x = moved(x, d.below(2) == 0 ? -1 : 1);
    return m;
}

template <scalar T>
ABUT_HD motion<T> any_scale_pair(draws& d, motion_kind kind) {
    const motion<T> m = d.below(2) == 0 ? any_exact_pair<T>(d, kind) : nudged_pair<T>(d, kind);
    constexpr int low = sizeof(T) == 4 ? -149 : -1074, high = sizeof(T) == 4 ? 100 : 968;
    const T s = power_of_two<T>(low + d.below(high - low));
    return scaled(m, s, s, s);
}

}  // namespace construction::motions

/// Pair number `index` of a family.
template <scalar T>
ABUT_HD motion<T> make_motion(std::uint64_t seed_value, motion_kind kind, motion_family f, std::uint64_t index) {
    namespace make = construction::motions;
    draws d(seed_value, static_cast<std::uint64_t>(f) * 2 + static_cast<std::uint64_t>(kind), index);
    if (f >= motion_family::touch_inside && f <= motion_family::collinear_sliding) return make::exact_pair<T>(d, kind, f);
    const double tau = d.uniform(0, 1);
    switch (f) {
        case motion_family::random:
            return make::random_pair<T>(d);
        case motion_family::crossing:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, false), 1, 1, 1);
        case motion_family::crossing_border:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, true), 1, 1, 1);
        case motion_family::fast: {
            const double speed = d.power_of_ten(2, 5);
            return make::rounded_pair<T>(d, kind, make::crossing(d, speed, tau, d.below(2) == 0), 1, speed, 1);
        }
        case motion_family::slow: {
            const double speed = d.power_of_ten(-6, -2);
            return make::rounded_pair<T>(d, kind, make::crossing(d, speed, tau, d.below(2) == 0), 1, speed, 1);
        }
        case motion_family::steps:
            return make::steps_pair<T>(d, kind);
        case motion_family::needles:
            return make::needle_pair<T>(d, kind);
        case motion_family::flat:
            return make::flat_pair<T>(d, kind);
        case motion_family::rotating:
            return make::rotating_pair<T>(d, kind);
        case motion_family::offset_1e6: {
            const double size = d.power_of_ten(0, 3);
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, d.below(2) == 0), 1e6, size, size);
        }
        case motion_family::offset_1e9: {
            const double size = d.power_of_ten(2, 6);
            return make::rounded_pair<T>(d, kind, make::crossing(d, 1, tau, d.below(2) == 0), 1e9, size, size);
        }
        case motion_family::rigid_rounded:
            return make::rounded_pair<T>(d, kind, make::crossing(d, 0, tau, d.below(2) == 0), 1, 1, 1);
        case motion_family::tenths_4:
            return make::lattice_pair<T>(d, 4, 0.1);
        case motion_family::nudged:
            return make::nudged_pair<T>(d, kind);
        case motion_family::parallel:
            return make::parallel_pair<T>(d, kind);
        case motion_family::rigid:
            return make::resting_pair<T>(d, kind, d.below(2) == 0, true);
        case motion_family::at_rest:
            return make::resting_pair<T>(d, kind, false, false);
        case motion_family::at_rest_coplanar:
            return make::resting_pair<T>(d, kind, true, false);
        case motion_family::shared:
            return make::shared_pair<T>(d, kind);
        case motion_family::lattice_2:
            return make::lattice_pair<T>(d, 2, 1);
        case motion_family::lattice_4:
            return make::lattice_pair<T>(d, 4, 1);
        case motion_family::lattice_16:
            return make::lattice_pair<T>(d, 16, 1);
        case motion_family::any_scale:
            return make::any_scale_pair<T>(d, kind);
        case motion_family::axis_scales:
            return make::axis_scales_pair<T>(d);
        case motion_family::denormal:
            return make::denormal_pair<T>(d);
        case motion_family::wide_lattice:
            return make::wide_lattice_pair<T>(d);
        case motion_family::largest:
            return make::any_numbers_pair<T>(d, true);
        default:
            return make::any_numbers_pair<T>(d, false);
    }
}

}  // namespace abut::test
