// SPDX-License-Identifier: MIT
#include <abut/collide/inside.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collide/inside_cases.hpp"
#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/surfaces.hpp"
#include "support/tetrahedra.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("inside: serial", "", float, double) { test::check_inside<TestType>(serial{}); }

TEST_CASE("inside: openmp on 1 and 3 threads, and every layout") {
    for (const int threads : {1, 3}) {
        CAPTURE(threads);
        test::check_inside<float>(openmp{threads}, 3);
    }
    test::uniform random(192);
    const test::cell_body body(random);
    const test::inside_scene scene(body);
    const auto map = test::lattice_maps<float>()[2];
    std::vector<vec3<float>> points;
    for (const auto& p : scene.places) points.push_back(map(p));
    const auto tree = make_bvh(serial{}, test::mesh_of_cells(body, map));
    std::size_t wrong_signs = 0;
    const auto apart = signed_distance(openmp{2}, tree, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto d = apart[i].distance;
        wrong_signs += scene.truth[i] != (d < 0 ? containment::inside : d > 0 ? containment::outside : containment::on_surface);
    }
    CHECK(wrong_signs == 0);
    CHECK(to_host(inside(serial{}, quantised(serial{}, tree), points)) == scene.truth);
    CHECK(to_host(inside(openmp{2}, wide(serial{}, tree), points)) == scene.truth);
}

TEST_CASE("inside: in each rounding mode, and with subnormal numbers flushed") {
    test::uniform random(193);
    const test::cell_body body(random);
    const test::inside_scene scene(body);
    for (const std::size_t k : {std::size_t{2}, std::size_t{4}}) {
        const auto map = test::lattice_maps<float>()[k];
        std::vector<vec3<float>> points;
        for (const auto& p : scene.places) points.push_back(map(p));
        const auto tree = make_bvh(serial{}, test::mesh_of_cells(body, map));
        for (const test::floating_mode& mode : test::floating_modes()) {
            INFO(mode.name);
            bool is_right = false;
            test::in_mode(mode, [&] { is_right = inside(serial{}, tree, points).to_host() == scene.truth; });
            CHECK(is_right);
        }
    }
}

TEMPLATE_TEST_CASE("inside: against tetrahedra in rational numbers", "", float, double) {
    using T = TestType;
    auto data = test::ball_surface<T>(2, 1);
    test::uniform random(194);
    for (auto& v : data.vertices) v = T(1 + random(-0.3, 0.3)) * v;
    std::vector<vec3<T>> points;
    for (int i = 0; i < 100; ++i) points.push_back(random.point<T>(-1, 1));
    // Below vertices and edges, off the surface, and next to it, by less than the filter tells.
    for (std::size_t i = 0; i + 1 < data.vertices.size() && i < 30; ++i) {
        const vec3<T> a = data.vertices[i], b = data.vertices[i + 1];
        points.push_back({a.x, a.y, static_cast<T>(random(-1, 1))});
        points.push_back({a.x, b.y, a.z});
        points.push_back({a.x, a.y, std::nextafter(a.z, i % 2 == 0 ? T(9) : T(-9))});
    }
    // As near to a face as rounding leaves them.
    for (std::size_t i = 0; i < data.faces.size(); i += 4) {
        const face& f = data.faces[i];
        points.push_back(T(0.3) * data.vertices[f[0]] + T(0.5) * data.vertices[f[1]] + T(0.2) * data.vertices[f[2]]);
    }
    const mesh<T> ball(data.vertices, data.faces);
    const auto found = inside(serial{}, make_bvh(serial{}, ball), points);
    std::size_t wrong = 0, within = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const test::turns_around around = test::turns_by_tetrahedra(data.vertices, data.faces, points[i]);
        const containment truth = around.on_surface         ? containment::on_surface
                                  : around.turns % 2 != 0 ? containment::inside
                                                          : containment::outside;
        wrong += found[i] != truth;
        within += truth == containment::inside;
    }
    CHECK(wrong == 0);
    CHECK(within > 40);
    CHECK(within + 40 < points.size());
}

TEST_CASE("inside: a mesh that is not closed, and none at all") {
    const std::vector<vec3<float>> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
    const std::vector<face> all{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const std::vector<vec3<float>> points{{1, 1, 1}, {0.5f, 0.5f, 2}, {9, 1, 1}, {0, 0, 0}, {1, 1, 0}, {0, 2, 2}, {1, 1, 2}};
    using enum containment;
    const std::vector<containment> expected{inside, inside, outside, on_surface, on_surface, on_surface, on_surface};
    CHECK(abut::inside(serial{}, mesh<float>(corners, all), points).to_host() == expected);
    const mesh<float> open(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}});
    std::string message;
    try {
        (void)abut::inside(serial{}, make_bvh(serial{}, open), points);
    } catch (const invalid_geometry& e) {
        message = e.what();
        CHECK(e.index() == 0);
        CHECK(e.value() == 1);
    }
    CHECK(message == "abut::inside: face 0: the mesh is not closed: an edge of this face has an odd number of faces (1)");
    CHECK_THROWS_AS(signed_distance(serial{}, open, points), invalid_geometry);
    CHECK(abut::inside(serial{}, open, points, {.known_closed = true}).size() == points.size());
    auto thrice = all;
    thrice.push_back({1, 2, 3});
    try {
        (void)abut::inside(serial{}, mesh<float>(corners, thrice), points);
        FAIL_CHECK("edges of three faces");
    } catch (const invalid_geometry& e) {
        CHECK(e.index() == 0);
        CHECK(e.value() == 3);
    }
    // A face that names a vertex twice, and one that is there twice more, close nothing and open nothing.
    auto more = all;
    more.insert(more.end(), {{1, 1, 2}, {0, 1, 2}, {1, 0, 2}});
    CHECK(abut::inside(serial{}, mesh<float>(corners, more), points).to_host() == expected);
    CHECK(abut::inside(serial{}, mesh<float>(), points).to_host() == std::vector<containment>(points.size(), outside));
    CHECK(abut::inside(serial{}, mesh<float>(corners, all), std::vector<vec3<float>>{}).size() == 0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_AS(abut::inside(serial{}, mesh<float>(corners, all), vec3<float>{0, nan, 0}), invalid_geometry);

    const auto near = signed_distance(serial{}, make_bvh(serial{}, mesh<float>(corners, all)), points);
    const auto plain = nearest(serial{}, mesh<float>(corners, all), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK(near[i].id == plain[i].id);
        CHECK(near[i].point == plain[i].point);
        CHECK(near[i].distance == (expected[i] == inside ? -plain[i].distance : expected[i] == outside ? plain[i].distance : 0));
    }
    CHECK(near[1].distance == -0.5f);
}
