// SPDX-License-Identifier: MIT
//
// The peer: FCL's models of oriented boxes, all contacts and the first. Its triangle test is not exact, and it tells one or
// two contacts for a pair, so pairs are counted apart. Its code is in the library that the package has: its headers declare
// the templates for double as `extern`.

#include <cstddef>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include "../any_scenes.hpp"

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

void query(benchmark::State& state, const scene::mesh_pair& pair, std::size_t most) {
    const auto a = build(pair.a), b = build(pair.b);
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

/// Also of a pose, which oriented boxes need not be built anew for.
void query_any(benchmark::State& state, const scene::any_scene& s, bool is_posed) {
    const auto& pose = s.pair.pose;
    const bool same = is_posed && s.is_copy();
    const auto a = build(s.pair.a), b = build(same ? s.pair.a : s.pair.b);
    const auto here = fcl::Transform3d::Identity();
    auto there = here;
    for (int i = 0; same && i < 3; ++i) {
        for (int j = 0; j < 3; ++j) there(i, j) = double(pose.rotation[3 * i + j]);
    }
    if (same) there.translation() = point(pose.translation);
    const auto ask = [&] {
        fcl::CollisionResultd result;
        fcl::collide(a.get(), here, b.get(), there, fcl::CollisionRequestd(1, false), result);
        return result.isCollision();
    };
    bool found = ask();
    for (auto _ : state) benchmark::DoNotOptimize(found = ask());
    state.counters["found"] = found ? 1 : 0;
}

[[maybe_unused]] const bool added = [] {
    scene::peers().push_back([] {
        usual(benchmark::RegisterBenchmark("build/fcl_obb/serial", [](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(build(scene::the_pair->a).get());
        }));
        const scene::mesh_pair& pair = *scene::the_pair;
        usual(benchmark::RegisterBenchmark("unsorted/fcl_obb/serial", query, pair, std::size_t{100'000'000}));
        usual(benchmark::RegisterBenchmark("any/fcl_obb/serial", query, pair, std::size_t{1}));
        for (const scene::any_scene& s : scene::any_scenes) {
            const std::string name = "any/" + s.name + "/";
            usual(benchmark::RegisterBenchmark((name + "baked/fcl_obb").c_str(), query_any, s, false));
            usual(benchmark::RegisterBenchmark((name + "posed/fcl_obb").c_str(), query_any, s, true));
        }
    });
    return true;
}();

}  // namespace
