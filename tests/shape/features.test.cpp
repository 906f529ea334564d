// SPDX-License-Identifier: MIT
#include <abut/shape/features.hpp>

#include <limits>

#include "shape/feature_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("features: serial", "", float, double) {
    test::check_all_features<TestType>(serial{}, 60);
    test::check_features_in_queries<TestType>(serial{});
}

TEST_CASE("features: openmp on 1, 2 and 7 threads") {
    for (const int threads : {1, 2, 7}) {
        CAPTURE(threads);
        test::check_all_features<float>(openmp{.threads = threads}, 30);
        test::check_features_in_queries<float>(openmp{.threads = threads});
    }
}

TEST_CASE("features: a view is checked") {
    const std::vector<vec3<float>> corners{{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}};
    const std::vector<face> faces{{0, 1, 1}, {0, 1, 3}};
    CHECK_THROWS_WITH(edges(mesh_view<float>(corners.data(), 2, faces.data(), 2)),
                      "abut::edges: face 1: vertex index out of range, there are 2 vertices (3)");
    CHECK_THROWS_WITH(edges(mesh_view<float>(corners.data(), 3, faces.data(), 1)),
                      "abut::edges: vertex 2: y is not finite (inf)");
    CHECK_THROWS_AS(edges(mesh_view<float>(nullptr, 3, nullptr, 1'431'655'766)), capacity_error);
}

TEST_CASE("features: edges serve other vertices too") {
    const test::torus<double> ring(8, 6, 2, 1);
    const mesh<double> before(ring.vertices, ring.faces);
    const auto rim = edges(before);
    std::vector<vec3<double>> after;
    for (const vec3<double>& p : ring.vertices) after.push_back({p.x + 1, p.y, p.z});
    const auto ids = rim.view().edges;
    const edge_mesh_view<double> moved(after.data(), after.size(), ids.first(), ids.count);
    CHECK(moved.size() == rim.size());
    CHECK(moved[3].a.x == rim.view()[3].a.x + 1);
    const auto tree = make_bvh(serial{}, rim);
    CHECK(count(serial{}, refit(serial{}, tree, moved), before) == count(serial{}, moved, before));
}
