// SPDX-License-Identifier: MIT
#pragma once

// Places on cylinders and cones of whole numbers, with normals of whole lengths: what is beyond a plane there is exactly as
// far as it is said to be. And what tests of distances count.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "draws.hpp"
#include "within_pairs.hpp"

namespace abut::test {

/// Wrong of any stage but `fast`, unlike of that, open after the filter; and what the oracle does not tell.
struct within_tally {
    std::uint64_t pairs = 0, hits = 0, wrong = 0, unlike = 0, open = 0, untold = 0, without_end = 0;

    within_tally& operator+=(const within_tally& o) {
        pairs += o.pairs, hits += o.hits, wrong += o.wrong, unlike += o.unlike, open += o.open, untold += o.untold;
        without_end += o.without_end;
        return *this;
    }
};

inline void print(const char* name, const within_tally& sum) {
    std::printf("%-16s | %6llu %6llu %6llu %6llu %6llu\n", name, static_cast<unsigned long long>(sum.pairs),
                static_cast<unsigned long long>(sum.hits), static_cast<unsigned long long>(sum.open),
                static_cast<unsigned long long>(sum.unlike), static_cast<unsigned long long>(sum.untold));
}

/// Distances beside the least that is enough: hardly, and some.
inline double distance_beside(double least, std::uint64_t index) {
    constexpr double some[4] = {1 + 0x1p-30, 1 - 0x1p-30, 1.25, 0.75};
    const double at = least * some[index % 4];
    return index % 16 < 12 || !(at < std::numeric_limits<double>::infinity()) ? distance_near(least, index) : at;
}

/// A solid in a lattice, a point on it, and there an outward normal of whole numbers, that may be as far as it is long.
struct lattice_touch {
    int height = 0, radius = 0;            ///< of the solid, along the third axis of the frame from its origin
    int at[3]{}, normal[3]{}, length = 1;  ///< in the frame
    int across[2][3]{};                    ///< orthogonal to the normal
};

inline lattice_touch touch_in_lattice(draws& d, bool is_cone) {
    constexpr int circle[12][2] = {{5, 0},  {4, 3},   {3, 4},   {0, 5},  {-3, 4}, {-4, 3},
                                   {-5, 0}, {-4, -3}, {-3, -4}, {0, -5}, {3, -4}, {4, -3}};
    const int* const u = circle[d.below(12)];
    lattice_touch x;
    const int size = 1 + d.below(3), kind = d.below(4);
    const auto set = [](int (&v)[3], int a, int b, int c) { v[0] = a, v[1] = b, v[2] = c; };
    // At so many times the circle's point, with a normal that leads out so many times as far, and up.
    const auto profile = [&](int out, int up, int normal_out, int normal_up) {
        set(x.at, out * u[0], out * u[1], up);
        set(x.normal, normal_out * u[0], normal_out * u[1], normal_up);
        set(x.across[0], -u[1], u[0], 0);
        set(x.across[1], -normal_up * u[0], -normal_up * u[1], 25 * normal_out);
    };
    const bool other = d.below(2) == 0;
    if (is_cone) {
        x.height = 20 * size, x.radius = 15 * size;
        const int part = 1 + d.below(size);
        switch (kind) {
            case 0: profile(3 * part, 20 * part, 4, -15); break;                    // the side
            case 1: profile(0, 0, other ? 3 : 0, other ? -20 : -1); break;          // the apex
            case 2: profile(3 * size, x.height, other ? 3 : 1, other ? 20 : 0); break;  // the rim
            default: profile(d.below(3 * size + 1), x.height, 0, 1);                // the base
        }
    } else {
        x.height = 1 + d.below(9), x.radius = 5 * size;
        const int end = d.below(2) * x.height, up = end == 0 ? -1 : 1;
        switch (kind) {
            case 0: profile(size, d.below(x.height + 1), 1, 0); break;
            case 1: profile(size, end, 3, up * 20); break;
            case 2: profile(size, end, 4, up * 15); break;
            default: profile(d.below(size + 1), end, 0, up);
        }
    }
    const int* const n = x.normal;
    x.length = static_cast<int>(std::lround(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])));
    return x;
}

}  // namespace abut::test
