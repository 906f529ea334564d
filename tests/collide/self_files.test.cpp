// SPDX-License-Identifier: MIT
#include <abut/collide/self_pairs.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "collide/self_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"

// self_pairs of real meshes against CGAL's self_intersections, with exact predicates. The two agree but for faces without
// area: CGAL lists each as a pair with itself, and pairs it with no other. And CGAL's meshes have manifold edges and
// vertices alone: small ones that have others are compared with the oracle in integers.

namespace abut::test {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using cgal_point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using cgal_mesh = CGAL::Surface_mesh<cgal_point>;

/// CGAL's pairs of a mesh whose edges are manifold, in order, those of a face with itself left out.
template <class T>
pair_list cgal_pairs(const mesh_view<T>& m, const std::vector<std::vector<std::size_t>>& faces) {
    std::vector<cgal_point> points;
    for (std::size_t i = 0; i < m.vertices.count; ++i) {
        const auto p = detail::widened(m.vertices[i]);
        points.emplace_back(p.x, p.y, p.z);
    }
    cgal_mesh theirs;
    pmp::polygon_soup_to_polygon_mesh(points, faces, theirs);
    std::vector<std::pair<cgal_mesh::Face_index, cgal_mesh::Face_index>> found;
    pmp::self_intersections(theirs, std::back_inserter(found));
    pair_list pairs;
    for (const auto& [f, g] : found) {
        const auto a = static_cast<std::uint32_t>(f), b = static_cast<std::uint32_t>(g);
        if (a != b) pairs.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

template <class T>
raw_mesh<T> raw(const mesh<T>& m) {
    const auto v = m.view();
    return {{v.vertices.first(), v.vertices.first() + v.vertices.count}, {v.faces.first(), v.faces.first() + v.faces.count}};
}

/// Whether CGAL could be asked.
template <class T>
bool compare_with_cgal(const char* name, const mesh<T>& m) {
    const auto v = m.view();
    std::vector<std::vector<std::size_t>> faces;
    for (std::size_t f = 0; f < v.size(); ++f) faces.push_back({v.faces[f][0], v.faces[f][1], v.faces[f][2]});
    const auto ours = to_host(self_pairs(openmp{}, make_bvh(openmp{}, m)));
    if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) {
        const bool small = v.size() < 1000;
        std::printf("%s: %zu pairs; CGAL has no such meshes%s\n", name, ours.size(), small ? ", the oracle decides" : "");
        if (small) CHECK(ours == self_truth(raw(m), {}, false, false));
        return false;
    }
    pair_list with_area;
    for (const index_pair& p : ours) {
        if (!has_zero_area(v[p.a]) && !has_zero_area(v[p.b])) with_area.push_back(p);
    }
    std::printf("%s: %zu pairs, %zu of faces with an area\n", name, ours.size(), with_area.size());
    CAPTURE(name);
    CHECK(with_area == cgal_pairs(v, faces));
    CHECK(to_host(self_pairs(serial{}, make_grid(serial{}, m))) == ours);
    CHECK(to_host(self_pairs<exact>(serial{}, wide(serial{}, make_bvh(serial{}, m)))) == ours);
    return true;
}

}  // namespace

TEST_CASE("pairs within real meshes, and CGAL's") {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    int compared = 0;
    for (const char* const name : {"armadillo_2766.ply", "armadillo_27674.ply", "armadillo_99994.ply",
                                   "armadillo_rollers326.ply", "stanford-bunny.ply", "fandisk.ply", "ogre.ply", "spot.obj",
                                   "cow.obj", "teapot.obj", "suzanne.obj", "env.obj", "rob.obj"}) {
        const auto m = io::read_mesh<float>(*folder / name);
        compared += compare_with_cgal(name, m);
        const auto one = welded(serial{}, m);
        if (one.view().vertices.count == m.view().vertices.count) continue;
        const auto pairs = to_host(self_pairs(serial{}, make_bvh(serial{}, one)));
        CHECK(to_host(self_pairs(serial{}, make_bvh(serial{}, m), {.coincident = coincident_vertices::merged})) == pairs);
        compared += compare_with_cgal((std::string(name) + ", welded").c_str(), one);
    }
    CHECK(compared >= 11);
}

}  // namespace abut::test
