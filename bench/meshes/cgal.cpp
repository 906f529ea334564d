// SPDX-License-Identifier: MIT
//
// The peer: CGAL's AABB tree over one mesh, asked for each triangle of the other. Its kernel has exact predicates, so it
// finds the same pairs.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include "../meshes_scene.hpp"

namespace {

namespace scene = meshes_scene;
using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using triangle_list = std::vector<kernel::Triangle_3>;
using primitive = CGAL::AABB_triangle_primitive<kernel, triangle_list::const_iterator>;
using tree = CGAL::AABB_tree<CGAL::AABB_traits<kernel, primitive>>;

triangle_list triangles_of(const scene::surface& s) {
    triangle_list all;
    const auto point = [&](std::uint32_t v) {
        const auto& p = s.vertices[v];
        return kernel::Point_3(double(p.x), double(p.y), double(p.z));
    };
    for (const auto& f : s.faces) all.emplace_back(point(f[0]), point(f[1]), point(f[2]));
    return all;
}

void build(benchmark::State& state) {
    const auto a = triangles_of(scene::the_pair->a);
    for (auto _ : state) {
        tree t(a.begin(), a.end());
        t.build();
        benchmark::DoNotOptimize(t.size());
    }
}

void query(benchmark::State& state) {
    const auto a = triangles_of(scene::the_pair->a), b = triangles_of(scene::the_pair->b);
    tree t(a.begin(), a.end());
    t.build();
    std::size_t found = 0;
    for (auto _ : state) {
        std::vector<tree::Primitive_id> hit;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (std::size_t j = 0; j < b.size(); ++j) {
            hit.clear();
            t.all_intersected_primitives(b[j], std::back_inserter(hit));
            for (const auto& id : hit) {
                pairs.emplace_back(static_cast<std::uint32_t>(id - a.begin()), static_cast<std::uint32_t>(j));
            }
        }
        found = pairs.size();
    }
    state.counters["pairs"] = static_cast<double>(found);
}

void usual(benchmark::internal::Benchmark* b) {
    b->Unit(benchmark::kMillisecond)->Repetitions(5)->ReportAggregatesOnly(true)->MinTime(0.01);
}

[[maybe_unused]] const bool added = [] {
    scene::peers().push_back([] {
        usual(benchmark::RegisterBenchmark("build/cgal/serial", build));
        usual(benchmark::RegisterBenchmark("unsorted/cgal/serial", query));
    });
    return true;
}();

}  // namespace
