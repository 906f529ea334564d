// SPDX-License-Identifier: MIT
//
// usage: bench_cloth_step_cuda FOLDER [OUT.json]
//
// A recorded step of a cloth (frame0.ply and frame1.ply of FOLDER) against itself, float, on CUDA. Names:
//
//   refit, impacts, frame     by calls that wait: a refit, all impacts, both
//   safe_step                 the largest part of the step that is free, by a call that waits
//   graph/frame               refit and impacts as one CUDA graph, launched and waited for
//   graph/safe_step           the safe step alone, likewise
//   graph/all                 refit, impacts and the safe step
//   million/impacts           eleven such cloths beside each other, their impacts with themselves
//
// Counters: faces, impacts, undecided; same: 1 if the graph's impacts are those of the call that waits.

#include <cstddef>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "motion_scene.hpp"

namespace {

using bench::counters;
using device_mesh = abut::mesh<float, abut::device_space>;

/// What `ask` puts on the stream, as a graph that can be launched.
template <class Ask>
cudaGraphExec_t graph_of(const abut::cuda& on, const Ask& ask) {
    ask();  // once before, so that kernels are loaded
    bench::check(cudaStreamSynchronize(on.stream), "cudaStreamSynchronize");
    cudaGraph_t graph = nullptr;
    cudaGraphExec_t made = nullptr;
    bench::check(cudaStreamBeginCapture(on.stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
    ask();
    bench::check(cudaStreamEndCapture(on.stream, &graph), "cudaStreamEndCapture");
    bench::check(cudaGraphInstantiate(&made, graph, 0), "cudaGraphInstantiate");
    bench::check(cudaGraphDestroy(graph), "cudaGraphDestroy");
    return made;
}

void measure(const abut::cuda& on, bench::table& out, const motion_scene::frames& scene) {
    const auto from_there = motion_scene::frames::as<float>(scene.t0), to_there = motion_scene::frames::as<float>(scene.t1);
    const device_mesh at_0(on, from_there, scene.faces);
    const auto step = abut::moving(at_0, at_0.with_vertices(on, to_there));
    const auto index = make_impact_index(on, step);
    const auto faces = static_cast<double>(scene.faces.size());
    const std::size_t impacts = self_impacts(on, index).size();
    const counters size{{"faces", faces}, {"impacts", static_cast<double>(impacts)}};
    out.add("refit", 0, [&] { return (void)refit(on, index, step), size; });
    out.add("impacts", 0, [&] { return (void)self_impacts(on, index), size; });
    out.add("frame", 0, [&] { return (void)self_impacts(on, refit(on, index, step)), size; });
    double safe = 0;
    out.add("safe_step", 0, [&]() -> counters {
        safe = safe_self_step(on, index);
        return {{"safe", safe}};
    });

    abut::async_index moved(on, make_impact_index(on, step));
    abut::execution::buffer<abut::vec3<float>, abut::device_space> at_t0(on, from_there.size()), at_t1(on, to_there.size());
    upload(on, from_there.data(), from_there.size(), at_t0.data());
    upload(on, to_there.data(), to_there.size(), at_t1.data());
    using view = abut::points_view<float, abut::device_space>;
    const auto positions = abut::moving(view(at_t0.data(), at_t0.size()), view(at_t1.data(), at_t1.size()));
    abut::async_result<abut::impact<float>> met(on, 2 * impacts + 1000);
    abut::async_value<double> largest(on);
    const auto follow = [&] { refit(abut::async(on, moved), positions); };
    const auto meet = [&] { self_impacts(abut::async(on, met), moved.index()); };
    const auto go = [&] { safe_self_step(abut::async(on, largest), moved.index()); };
    const auto add = [&](const std::string& name, const auto& ask) {
        const cudaGraphExec_t graph = graph_of(on, ask);
        out.add(name, 0, [&] { return bench::check(cudaGraphLaunch(graph, on.stream), "cudaGraphLaunch"), size; });
        bench::check(cudaGraphExecDestroy(graph), "cudaGraphExecDestroy");
    };
    add("graph/frame", [&] { follow(), meet(); });
    add("graph/safe_step", go);
    add("graph/all", [&] { follow(), meet(), go(); });
    const bool same = to_host(wait(on, met)) == to_host(self_impacts(on, index)) && wait(on, largest) == safe;
    out.note("graph/same", {{"same", same ? 1.0 : 0.0}});
}

void measure_million(const abut::cuda& on, bench::table& out, const motion_scene::frames& scene) {
    auto from = motion_scene::frames::as<float>(scene.t0), to = motion_scene::frames::as<float>(scene.t1);
    auto faces = scene.faces;
    const std::size_t vertices = from.size(), of_one = faces.size();
    auto box = abut::empty_box<float>();
    for (const auto& p : from) box = merge(box, abut::bounds(p));
    const float apart = 1.5f * (box.upper.x - box.lower.x);
    for (std::size_t k = 1; k < 11; ++k) {
        for (std::size_t i = 0; i < vertices; ++i) {
            const float x = apart * static_cast<float>(k);
            from.push_back({from[i].x + x, from[i].y, from[i].z});
            to.push_back({to[i].x + x, to[i].y, to[i].z});
        }
        for (std::size_t f = 0; f < of_one; ++f) {
            const auto more = static_cast<std::uint32_t>(k * vertices);
            faces.push_back({faces[f][0] + more, faces[f][1] + more, faces[f][2] + more});
        }
    }
    const device_mesh at_0(on, from, faces);
    const auto index = make_impact_index(on, abut::moving(at_0, at_0.with_vertices(on, to)));
    out.add("million/impacts", 0, [&]() -> counters {
        return {{"faces", static_cast<double>(faces.size())}, {"impacts", static_cast<double>(self_impacts(on, index).size())}};
    });
}

}  // namespace

int main(int argc, char** argv) {
    const std::string folder = argc > 1 ? argv[1] : ".";
    if (argc > 1) argv[1] = argv[0], ++argv, --argc;
    return bench::run("bench_cloth_step_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const auto scene = motion_scene::read_frames(folder);
        measure(on, out, scene);
        measure_million(on, out, scene);
    });
}
