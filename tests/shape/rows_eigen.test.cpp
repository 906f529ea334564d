// SPDX-License-Identifier: MIT

#include <abut/shape/rows.hpp>

#include <vector>

#include <Eigen/Core>
#include "support/catch.hpp"

#include <abut/abut.hpp>

TEST_CASE("Sets and views are made of vectors of Eigen's") {
    const std::vector<Eigen::Vector3f> vertices{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
    std::vector<Eigen::Vector3i> faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const std::vector<Eigen::Vector4f> four{{1, 1, -2, 2}, {9, 9, 9, 1}, {4, 0, 0, 0}};
    const abut::serial on;
    const abut::mesh<float> mesh(vertices, faces);
    const abut::mesh_view<float> view(vertices.data(), vertices.size(), faces.data(), faces.size());
    const abut::spheres<float> balls(four);
    CHECK(abut::count(on, mesh, balls) == 4);
    CHECK(abut::count(on, view, balls) == 4);
    CHECK(abut::count(on, mesh.with_vertices(on, vertices), balls) == 4);

    // One row a vertex, as in libigl.
    Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> rows(4, 3);
    for (int i = 0; i < 4; ++i) rows.row(i) = vertices[static_cast<std::size_t>(i)].cast<double>();
    const abut::mesh_view<double> of_rows(rows.data(), 4, faces.data(), faces.size());
    CHECK(abut::count(on, of_rows, abut::sphere<double>{{1, 1, -2}, 2}) == 1);

    faces[2][1] = -5;
    CHECK_THROWS_WITH(abut::mesh<float>(vertices, faces),
                      "abut::mesh: face 2: vertex index out of range, there are 4 vertices (-5)");
}
