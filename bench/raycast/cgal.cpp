// SPDX-License-Identifier: MIT
//
// The peer for points: CGAL's Side_of_triangle_mesh, which is exact too, one point at a time on one thread. Its tree is made
// before the clock starts.

#include <cstddef>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <benchmark/benchmark.h>

#include "peer.hpp"

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using surface = CGAL::Surface_mesh<kernel::Point_3>;

void add() {
    raycast_peer::add("inside/points/cgal/double/serial", [](benchmark::State& state) {
        surface mesh;
        std::vector<surface::Vertex_index> numbers;
        const auto exactly = [](const auto& p) { return kernel::Point_3(double(p.x), double(p.y), double(p.z)); };
        for (const auto& p : raycast_peer::mesh().vertices) numbers.push_back(mesh.add_vertex(exactly(p)));
        for (const auto& f : raycast_peer::mesh().faces) mesh.add_face(numbers[f[0]], numbers[f[1]], numbers[f[2]]);
        std::vector<kernel::Point_3> points;
        for (const auto& p : raycast_scene::points_in(raycast_peer::mesh())) points.push_back(exactly(p));
        const CGAL::Side_of_triangle_mesh<surface, kernel> side(mesh);
        benchmark::DoNotOptimize(side(points.front()));
        std::size_t within = 0;
        for (auto _ : state) {
            std::vector<CGAL::Bounded_side> found;
            found.reserve(points.size());
            for (const auto& p : points) found.push_back(side(p));
            state.PauseTiming();
            within = 0;
            for (const auto where : found) within += where == CGAL::ON_BOUNDED_SIDE ? 1 : 0;
            state.ResumeTiming();
        }
        raycast_peer::note(state, points.size(), within);
    });
}
[[maybe_unused]] const bool registered = (raycast_peer::peers().push_back(add), true);

}  // namespace
