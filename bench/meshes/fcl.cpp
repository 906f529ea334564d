// SPDX-License-Identifier: MIT
//
// The peer: FCL's models of oriented boxes, all contacts and the first. Its triangle test is not exact, and it tells one or
// two contacts for a pair, so pairs are counted apart.

#include <cstddef>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include "../meshes_scene.hpp"

namespace {

namespace scene = meshes_scene;
using model = fcl::BVHModel<fcl::OBBd>;

fcl::Vector3d point(const abut::vec3<float>& p) { return {double(p.x), double(p.y), double(p.z)}; }

std::unique_ptr<model> build(const scene::surface& s) {
    auto m = std::make_unique<model>();
    m->beginModel(static_cast<int>(s.faces.size()), static_cast<int>(s.vertices.size()));
    for (const auto& f : s.faces) m->addTriangle(point(s.vertices[f[0]]), point(s.vertices[f[1]]), point(s.vertices[f[2]]));
    m->endModel();
    return m;
}

void usual(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly(true)->MinTime(0.01);
}

void query(benchmark::State& state, std::size_t most) {
    const auto a = build(scene::the_pair->a), b = build(scene::the_pair->b);
    const auto here = fcl::Transform3d::Identity();
    std::set<std::pair<int, int>> pairs;
    for (auto _ : state) {
        fcl::CollisionResultd result;
        fcl::collide(a.get(), here, b.get(), here, fcl::CollisionRequestd(most, false), result);
        state.PauseTiming();
        pairs.clear();
        for (std::size_t i = 0; i < result.numContacts(); ++i) {
            pairs.emplace(static_cast<int>(result.getContact(i).b1), static_cast<int>(result.getContact(i).b2));
        }
        state.ResumeTiming();
    }
    state.counters["pairs"] = static_cast<double>(pairs.size());
}

[[maybe_unused]] const bool added = [] {
    scene::peers().push_back([] {
        usual(benchmark::RegisterBenchmark("build/fcl_obb/serial", [](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(build(scene::the_pair->a).get());
        }));
        usual(benchmark::RegisterBenchmark("unsorted/fcl_obb/serial", query, std::size_t{100'000'000}));
        usual(benchmark::RegisterBenchmark("any/fcl_obb/serial", query, std::size_t{1}));
    });
    return true;
}();

}  // namespace
