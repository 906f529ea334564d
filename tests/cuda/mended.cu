// SPDX-License-Identifier: MIT

// Welding by a distance, orientation, measures, stretches of rays, and inside by a rule: what a device says is what a host says.

#include <cstdint>
#include <random>
#include <vector>

#include <abut/cuda.hpp>

#include "support/catch.hpp"

TEMPLATE_TEST_CASE("meshes as they come, and rays through them: cuda as serial", "", float, double) {
    using T = TestType;
    const abut::serial host;
    const abut::cuda device;
    std::mt19937 random(9);
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
    for (std::uint32_t k = 0; k < 40; ++k) {
        const T x = static_cast<T>(random() % 8), y = static_cast<T>(random() % 8), z = static_cast<T>(random() % 8);
        vertices.insert(vertices.end(), {{x, y, z}, {x + 3, y, z}, {x, y + 3, z}, {x, y, z + 3}});
        const std::uint32_t v = 4 * k;
        faces.insert(faces.end(), {{v, v + 2, v + 1}, {v, v + 1, v + 3}, {v + 1, v + 2, v + 3}, {v + 2, v, v + 3}});
    }
    const abut::mesh<T> here(vertices, faces);
    const auto there = copy_to(device, here);
    std::vector<abut::ray<T>> rays;
    std::vector<abut::vec3<T>> points;
    for (int i = 0; i < 500; ++i) {
        const T x = static_cast<T>(random() % 24) / 2, y = static_cast<T>(random() % 24) / 2, z = static_cast<T>(random() % 24) / 2;
        rays.push_back({{x, y, z}, {static_cast<T>(random() % 3) - 1, static_cast<T>(random() % 3) - 1, 1}});
        points.push_back({x, y, z});
    }
    const auto tree_here = make_bvh(host, here);
    const auto tree_there = make_bvh(device, there);
    const auto found = abut::spans(device, tree_there, abut::rays<T>(rays));
    CHECK(found.size() > 100);
    CHECK((found == abut::spans(host, tree_here, abut::rays<T>(rays))));
    for (const auto rule : {abut::inside_rule::parity, abut::inside_rule::nonzero, abut::inside_rule::positive}) {
        CHECK((to_host(inside(device, tree_there, abut::points<T>(points), {.rule = rule})) ==
               to_host(inside(host, tree_here, abut::points<T>(points), {.rule = rule}))));
    }
    CHECK((validate(device, there, {.measures = true}) == validate(host, here, {.measures = true})));
    const auto welded_there = welded(device, there, 1.5, {.drop_collapsed = true, .drop_duplicates = true});
    const auto welded_here = welded(host, here, 1.5, {.drop_collapsed = true, .drop_duplicates = true});
    CHECK(welded_there.vertex_of == welded_here.vertex_of);
    CHECK(welded_there.face_of == welded_here.face_of);
    CHECK((validate(device, welded_there.mesh) == validate(host, welded_here.mesh)));
    CHECK(oriented_consistently(device, there).turned == oriented_consistently(host, here).turned);
    const auto open_there = to_host(signed_distance(device, tree_there, abut::points<T>(points), abut::winding_options{.tolerance = 0}));
    const auto open_here = to_host(signed_distance(host, tree_here, abut::points<T>(points), abut::winding_options{.tolerance = 0}));
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(open_there[i].id == open_here[i].id);
    // Doubled, both ways.
    auto doubled = faces;
    for (const abut::face& f : faces) doubled.push_back({f[0], f[2], f[1]});
    CHECK_THROWS_AS(inside(device, copy_to(device, abut::mesh<T>(vertices, doubled)), abut::points<T>(points), {.check = true}),
                    abut::invalid_geometry);
}
