// SPDX-License-Identifier: MIT
#include <abut/collide/curves.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Surface_mesh.h>

#include <abut/io/read.hpp>

#include "collide/crossing_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"
#include "support/needs.hpp"
#include "support/samples.hpp"

// Curves of real meshes in general position against CGAL's surface_intersection: how many there are, how many of them are
// closed, and how many points they have. Both are given the same coordinates.

namespace abut::test {

namespace {

using their_kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using their_mesh = CGAL::Surface_mesh<their_kernel::Point_3>;

their_mesh theirs(const mesh<float>& of) {
    their_mesh m;
    std::vector<their_mesh::Vertex_index> at;
    for (std::size_t i = 0; i < of.view().vertices.count; ++i) {
        const auto v = detail::widened(of.view().vertices[i]);
        at.push_back(m.add_vertex({v.x, v.y, v.z}));
    }
    for (std::size_t i = 0; i < of.size(); ++i) {
        const auto f = of.view().faces[i];
        if (m.add_face(at[f[0]], at[f[1]], at[f[2]]) == their_mesh::null_face()) m.clear();
    }
    return m;
}

}  // namespace

TEST_CASE("curves: as many as CGAL's surface_intersection finds, with as many points") {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const serial on;
    std::size_t scenes = 0, all_points = 0;
    for (const char* name : {"armadillo_2766.ply", "spot.obj"}) {
        const auto still = io::read_mesh<float>(*folder / name);
        const their_mesh their_still = theirs(still);
        REQUIRE(their_still.number_of_faces() == still.size());
        float reach = 0;
        for (std::size_t i = 0; i < still.view().vertices.count; ++i) reach = std::max(reach, std::abs(still.view().vertices[i].x));
        for (std::uint64_t k = 0; k < (sample_count() > 100000 ? 50u : 5u); ++k) {
            draws d(20270516, 1, k);
            const auto other = turned_and_moved(still, d, static_cast<double>(reach) / 4);
            CAPTURE(name, k);
            std::size_t points = 0, closed = 0;
            const auto all = curves(on, crossings(on, still, other));
            for (const auto& c : all) {
                points += c.points.size();
                closed += c.closed;
            }
            their_mesh a = their_still, b = theirs(other);
            std::vector<std::vector<their_kernel::Point_3>> lines;
            CGAL::Polygon_mesh_processing::surface_intersection(a, b, std::back_inserter(lines));
            std::size_t their_points = 0, their_closed = 0;
            for (const auto& line : lines) {
                const bool is_closed = line.size() > 2 && line.front() == line.back();
                their_points += line.size() - (is_closed ? 1 : 0);
                their_closed += is_closed;
            }
            CHECK(all.size() == lines.size());
            CHECK(closed == their_closed);
            CHECK(points == their_points);
            ++scenes;
            all_points += points;
        }
    }
    CHECK(scenes >= 10);
    CHECK(all_points > 500);
}

}  // namespace abut::test
