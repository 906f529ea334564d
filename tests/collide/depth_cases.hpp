// SPDX-License-Identifier: MIT
#pragma once

// What is known of distances between surfaces otherwise than by abut's own: squares of distances in integers. Shared by
// tests/cuda/depth.cu for its scenes.

#include <array>
#include <cstdint>
#include <vector>

#include <abut/collide/penetration.hpp>
#include <abut/collide/hausdorff.hpp>

#include "support/draws.hpp"

namespace abut::test {

/// Triangles with corners on a grid, as integers and as a soup in a unit.
struct grid_soup {
    std::vector<std::array<std::array<int, 3>, 3>> faces;

    template <scalar T>
    [[nodiscard]] triangle_soup<T> soup(T unit) const {
        std::vector<triangle<T>> all;
        for (const auto& f : faces) {
            const auto at = [&](std::size_t i) {
                return vec3<T>{unit * static_cast<T>(f[i][0]), unit * static_cast<T>(f[i][1]), unit * static_cast<T>(f[i][2])};
            };
            all.push_back({at(0), at(1), at(2)});
        }
        return triangle_soup<T>(all);
    }
};

inline grid_soup draw_soup(draws& d, int count, int size) {
    grid_soup s;
    for (int k = 0; k < count; ++k) {
        std::array<std::array<int, 3>, 3> f;
        const std::array<int, 3> around{d.below(size), d.below(size), d.below(size)};
        for (auto& corner : f) {
            for (std::size_t c = 0; c < 3; ++c) corner[c] = around[c] + d.below(5) - 2;
        }
        if (k % 16 == 7) f[1] = f[0];  // a segment
        s.faces.push_back(f);
    }
    return s;
}

}  // namespace abut::test
