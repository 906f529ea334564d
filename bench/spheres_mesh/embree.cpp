// SPDX-License-Identifier: MIT
//
// The peer: Embree's point queries over the same triangles, on one thread, with the usual closest-point test in single
// precision. It is a fast library used as its manual says; its answers are not exact, and not sorted unless sorted here.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "../embree_scene.hpp"

namespace {

using embree_peer::closest_point;
using embree_peer::embree_scene;
using embree_peer::inner;
using embree_peer::minus;
using embree_peer::vec;

struct scene_data {
    scene::surface<float> mesh = scene::torus<float>();
    std::vector<vec> centers = scene::centers<float>();
};

const scene_data& the_scene() {
    static const scene_data data;
    return data;
}

using pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;  // (triangle, sphere)

struct query {
    const scene::surface<float>& mesh;
    std::uint32_t sphere;
    pairs& found;
};

bool meet(RTCPointQueryFunctionArguments* arguments) {
    auto& q = *static_cast<query*>(arguments->userPtr);
    const auto& f = q.mesh.faces[arguments->primID];
    const vec p{arguments->query->x, arguments->query->y, arguments->query->z};
    const vec to = minus(closest_point(p, q.mesh.vertices[f[0]], q.mesh.vertices[f[1]], q.mesh.vertices[f[2]]), p);
    if (inner(to, to) <= arguments->query->radius * arguments->query->radius)
        q.found.emplace_back(arguments->primID, q.sphere);
    return false;  // the radius has not changed
}

pairs find_pairs(const embree_scene& index, bool sorted) {
    const scene_data& data = the_scene();
    pairs found;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    for (std::size_t i = 0; i < data.centers.size(); ++i) {
        const vec& p = data.centers[i];
        query q{data.mesh, static_cast<std::uint32_t>(i), found};
        RTCPointQuery point{p.x, p.y, p.z, 0, static_cast<float>(scene::radius)};
        rtcPointQuery(index.get(), &point, &context, meet, &q);
    }
    if (sorted) std::sort(found.begin(), found.end());
    return found;
}

void note(benchmark::State& state, std::size_t found) {
    state.counters["pairs"] = static_cast<double>(found);
    state.counters["spheres"] = static_cast<double>(scene::sphere_count);
}

void build(benchmark::State& state) {
    for (auto _ : state) {
        const embree_scene index(the_scene().mesh);
        benchmark::DoNotOptimize(index.get());
    }
}

void query_only(benchmark::State& state, bool sorted) {
    const embree_scene index(the_scene().mesh);
    std::size_t n = 0;
    for (auto _ : state) n = find_pairs(index, sorted).size();
    note(state, n);
}

void build_and_query(benchmark::State& state, bool sorted) {
    std::size_t n = 0;
    for (auto _ : state) n = find_pairs(embree_scene(the_scene().mesh), sorted).size();
    note(state, n);
}

constexpr int repetitions = 11;

[[maybe_unused]] const bool registered = [] {
    const auto usual = [](benchmark::internal::Benchmark* b) {
        b->Repetitions(repetitions)->ReportAggregatesOnly(true)->Unit(benchmark::kMillisecond)->Iterations(1);
    };
    usual(benchmark::RegisterBenchmark("build/embree/serial", build));
    usual(benchmark::RegisterBenchmark("unsorted/embree/serial/1703244", query_only, false));
    usual(benchmark::RegisterBenchmark("pairs/embree/serial/1703244", query_only, true));
    usual(benchmark::RegisterBenchmark("all/embree/serial", build_and_query, true));
    usual(benchmark::RegisterBenchmark("all_unsorted/embree/serial", build_and_query, false));
    return true;
}();

}  // namespace
