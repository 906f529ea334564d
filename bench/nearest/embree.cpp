// SPDX-License-Identifier: MIT
//
// The peer: Embree's point queries of unbounded radius over the same triangles, on one thread, with the usual closest-point
// test in single precision, which shrinks the query. Its points come in the order in which they are.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>

#include "../embree_scene.hpp"
#include "peer.hpp"

namespace {

using embree_peer::closest_point;
using embree_peer::embree_scene;
using embree_peer::inner;
using embree_peer::minus;
using embree_peer::vec;

struct answer {
    std::uint32_t triangle;
    vec point;
    float distance;
};

struct query {
    const scene::surface<float>& mesh;
    answer best;
};

bool meet(RTCPointQueryFunctionArguments* arguments) {
    auto& q = *static_cast<query*>(arguments->userPtr);
    const auto& f = q.mesh.faces[arguments->primID];
    const vec p{arguments->query->x, arguments->query->y, arguments->query->z};
    const vec closest = closest_point(p, q.mesh.vertices[f[0]], q.mesh.vertices[f[1]], q.mesh.vertices[f[2]]);
    const vec to = minus(closest, p);
    const float distance = std::sqrt(inner(to, to));
    if (!(distance < arguments->query->radius)) return false;
    arguments->query->radius = distance;
    q.best = {arguments->primID, closest, distance};
    return true;  // the radius has changed
}

std::vector<answer> find_nearest(const embree_scene& index, const scene::surface<float>& mesh,
                                 const std::vector<vec>& points) {
    std::vector<answer> found(points.size());
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    for (std::size_t i = 0; i < points.size(); ++i) {
        query q{mesh, {}};
        RTCPointQuery point{points[i].x, points[i].y, points[i].z, 0, std::numeric_limits<float>::infinity()};
        rtcPointQuery(index.get(), &point, &context, meet, &q);
        found[i] = q.best;
    }
    return found;
}

void nearest(benchmark::State& state, std::size_t n) {
    const auto mesh = scene::torus<float>();
    const auto points = scene::centers<float>(n);
    const embree_scene index(mesh);
    std::vector<answer> found;
    double sum = 0;
    for (auto _ : state) {
        found = find_nearest(index, mesh, points);
    }
    std::vector<std::uint32_t> named;
    for (const answer& a : found) named.push_back(a.triangle), sum += static_cast<double>(a.distance);
    nearest_peer::note(state, n, sum);
    state.counters["wrong"] = static_cast<double>(nearest_peer::wrong_ids(mesh, points, named));
}

[[maybe_unused]] const bool registered = nearest_peer::add("nearest/embree/serial", nearest);

}  // namespace
