// SPDX-License-Identifier: MIT
//
// The peer: FCPW's closest points over the same triangles, in its wide tree of eight lanes, one point at a time on one thread. It counts in
// single precision; `wrong` is how many of its triangles are not the nearest by abut::exact.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include <fcpw/fcpw.h>

#include "peer.hpp"

namespace {

void nearest(benchmark::State& state, std::size_t n) {
    const auto mesh = scene::torus<float>();
    const auto points = scene::centers<float>(n);
    fcpw::Scene<3> index;
    std::vector<fcpw::Vector3> vertices;
    std::vector<fcpw::Vector3i> faces;
    for (const auto& p : mesh.vertices) vertices.emplace_back(p.x, p.y, p.z);
    for (const auto& f : mesh.faces) faces.emplace_back(f[0], f[1], f[2]);
    index.setObjectCount(1);
    index.setObjectVertices(vertices, 0);
    index.setObjectTriangles(faces, 0);
    index.build(fcpw::AggregateType::Bvh_SurfaceArea, true);
    std::vector<fcpw::Interaction<3>> found;
    double sum = 0;
    for (auto _ : state) {
        found.assign(n, {});
        for (std::size_t i = 0; i < n; ++i) {
            index.findClosestPoint(fcpw::Vector3(points[i].x, points[i].y, points[i].z), found[i]);
        }
    }
    std::vector<std::uint32_t> named;
    for (const auto& a : found) named.push_back(static_cast<std::uint32_t>(a.primitiveIndex)), sum += static_cast<double>(a.d);
    nearest_peer::note(state, n, sum);
    state.counters["wrong"] = static_cast<double>(nearest_peer::wrong_ids(mesh, points, named));
}

[[maybe_unused]] const bool registered = nearest_peer::add("nearest/fcpw/serial", nearest);

}  // namespace
