// SPDX-License-Identifier: MIT
#pragma once

// What `winding_number` promises on every policy: the bits of `serial`, and of a closed surface that faces outward what
// `inside` says.

#include <cmath>
#include <cstddef>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// Points around, some in each corner of the triangles, and some on them.
template <class T>
std::vector<vec3<T>> points_to_wind(const std::vector<triangle<T>>& triangles, uniform& random, std::size_t count) {
    std::vector<vec3<T>> points;
    for (std::size_t i = 0; i < count; ++i) {
        const triangle<T>& t = triangles[random.below(triangles.size())];
        points.push_back(random.point<T>(-2, 2));
        if (i % 8 == 0) points.push_back(t.a);
        if (i % 8 == 1) points.push_back(T(0.5) * (t.a + t.b));
        if (i % 8 == 2) points.push_back(T(0.25) * (t.a + t.b) + T(0.5) * t.c + random.point<T>(-1e-6, 1e-6));
    }
    return points;
}

template <class T, class Policy>
void check_winding_bits(const Policy& on) {
    uniform random(471);
    const torus<T> ring(24, 12, 1.2, 0.5);
    const auto of_ring = triangles_of(ring.vertices, ring.faces);
    const rigid<T> pose{{T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}, {T(0.25), T(-0.5), T(0.125)}};
    for (const auto& triangles : {of_ring, random_triangles<T>(700, random)}) {
        const auto points = points_to_wind(triangles, random, 200);
        const triangle_soup<T> here(triangles);
        const auto there = copy_to(on, here);
        const auto tree_here = make_bvh(serial{}, here);
        const auto tree = make_bvh(on, there);
        CHECK(to_host(winding_number(on, there, points)) == to_host(winding_number(serial{}, here, points)));
        for (const double tolerance : {0.0, 1e-6, 1e-2, 1.0}) {
            CAPTURE(tolerance);
            const winding_options options{.tolerance = tolerance};
            CHECK(to_host(winding_number(on, tree, points, options)) ==
                  to_host(winding_number(serial{}, tree_here, points, options)));
            CHECK(to_host(winding_number(on, posed(tree, pose), points, options)) ==
                  to_host(winding_number(serial{}, posed(tree_here, pose), points, options)));
            CHECK(to_host(winding_number(on, make_winding_index(on, there), points, options)) ==
                  to_host(winding_number(serial{}, make_winding_index(serial{}, here), points, options)));
        }
    }
    // More nodes than a walk's list has room for.
    const torus<T> fine(120, 60, 1.2, 0.5);
    const mesh<T> surface(fine.vertices, fine.faces);
    const auto points = points_to_wind(triangles_of(fine.vertices, fine.faces), random, 24);
    const auto index = make_winding_index(on, make_bvh(on, copy_to(on, surface)));
    const auto index_here = make_winding_index(serial{}, make_bvh(serial{}, surface));
    for (const double tolerance : {0.0, 1e-7, 1e-4, 1e-3}) {
        CAPTURE(tolerance);
        const winding_options options{.tolerance = tolerance};
        CHECK(to_host(winding_number(on, index, points, options)) == to_host(winding_number(serial{}, index_here, points, options)));
    }
    CHECK(to_host(winding_number<exact>(on, copy_to(on, surface), points)) ==
          to_host(winding_number<exact>(serial{}, surface, points)));
}

template <class T, class Policy>
void check_winding_of_closed(const Policy& on) {
    uniform random(472);
    const torus<T> ring(40, 20, 1.2, 0.5);
    const mesh<T> surface(ring.vertices, ring.faces);
    const auto tree = make_bvh(on, copy_to(on, surface));
    const auto points = points_to_wind(triangles_of(ring.vertices, ring.faces), random, 500);
    const auto where = to_host(inside(on, tree, points));
    for (const double tolerance : {0.0, 1e-3, 0.4}) {
        CAPTURE(tolerance);
        std::size_t wrong = 0, within = 0, on_surface = 0;
        const auto wound = to_host(winding_number(on, tree, points, {.tolerance = tolerance}));
        for (std::size_t i = 0; i < points.size(); ++i) {
            within += where[i] == containment::inside;
            on_surface += where[i] == containment::on_surface;
            if (where[i] == containment::on_surface) continue;
            const double truth = where[i] == containment::inside ? 1 : 0;
            wrong += !(std::abs(wound[i] - truth) <= tolerance + 1e-9);
        }
        CHECK(wrong == 0);
        CHECK(within > 50);
        CHECK(on_surface > 20);
        CHECK(within + on_surface < points.size() - 50);
    }
}

template <class T, class Policy>
void check_winding(const Policy& on) {
    check_winding_bits<T>(on);
    check_winding_of_closed<T>(on);
}

}  // namespace abut::test
