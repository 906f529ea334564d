// SPDX-License-Identifier: MIT
#pragma once

// Patches on a policy, compared with those of one thread, bit for bit.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <abut/collide/contact_patches.hpp>
#include <abut/index/bvh.hpp>

#include "solid_cases.hpp"
#include "support/catch.hpp"
#include "support/draws.hpp"

namespace abut::test {

/// All but the faces and features of curves.
template <scalar T>
bool are_same(const std::vector<contact_patch<T>>& x, const std::vector<contact_patch<T>>& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& p, const auto& q) {
        return p.center == q.center && p.normal == q.normal && p.area == q.area && p.depth == q.depth &&
               p.deepest_a == q.deepest_a && p.deepest_b == q.deepest_b && p.points == q.points &&
               std::equal(p.curves.begin(), p.curves.end(), q.curves.begin(), q.curves.end(),
                          [](const auto& c, const auto& d) { return c.points == d.points && c.closed == d.closed; });
    });
}

/// Of sets of cells, as meshes, trees and under poses.
template <scalar T, class Policy>
void check_patches(const Policy& on) {
    const serial one;
    std::size_t found = 0;
    for (std::uint64_t k = 0; k < 16; ++k) {
        draws d(20280104, 1, k);
        const auto [a, b] = draw_two_sets(d, k);
        const frame_of_grid f = draw_frame(d);
        const auto x = surface_of<T>(a, f, d), y = surface_of<T>(b, f, d);
        const rigid<T> there{{T(0.8), T(-0.6), 0, T(0.6), T(0.8), 0, 0, 0, 1}, {T(f.unit / 2), T(f.unit / 4), 0}};
        const auto truth = contact_patches(one, x, posed(y, there));
        found += truth.size();
        CAPTURE(k);
        CHECK(are_same(contact_patches(on, make_bvh(on, copy_to(on, x)), posed(copy_to(on, y), there)), truth));
        CHECK(are_same(contact_patches(on, copy_to(on, x), make_bvh(on, copy_to(on, y)), {.known_solid = true}), contact_patches(one, x, y)));
    }
    CHECK(found > 4);
}

}  // namespace abut::test
