// SPDX-License-Identifier: MIT
//
// usage: bench_spheres_mesh_cuda [OUT.json]
//
// bench/spheres_mesh.cpp on CUDA: the same scene and the same names, policy cuda, all data resident on the device before the
// clock starts. Each figure is the median of 21 runs (11 where a run takes more than 20 ms) after two that are not counted,
// taken with CUDA events around the whole call, so what the host does between kernels is in it. The floor is what has to be
// read and written at least once, over the bandwidth that a read loop reaches in this run. Prints a table, and writes JSON
// in the form of Google Benchmark. Takes less than a minute.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "../docs/examples/scene.hpp"
#include "cuda_table.hpp"

namespace {

using bench::check;
using bench::counters;
using bench::joined;
using bench::table;

struct bvh {
    static constexpr const char* name = "bvh";
    static auto make(const auto& on, const auto& mesh) { return abut::make_bvh(on, mesh); }
};
struct grid {
    static constexpr const char* name = "grid";
    static auto make(const auto& on, const auto& mesh) { return abut::make_grid(on, mesh); }
};

struct resident_scene {
    abut::mesh<float, abut::device_space> mesh;
    std::vector<abut::equal_spheres<float, abut::device_space>> prefixes;  // growing; the last is the whole scene
    double mesh_bytes;

    explicit resident_scene(const abut::cuda& on) {
        const auto surface = scene::torus<float>();
        mesh = abut::mesh<float, abut::device_space>(on, surface.vertices, surface.faces);
        mesh_bytes = 12.0 * static_cast<double>(surface.vertices.size() + surface.faces.size());
        const auto centers = scene::centers<float>();
        for (std::size_t n = 1 << 10; n <= 1 << 20; n *= 2) prefixes.emplace_back(on, std::span(centers).first(n), 3.0f);
        prefixes.emplace_back(on, centers, 3.0f);
    }
    [[nodiscard]] const auto& whole() const { return prefixes.back(); }
    [[nodiscard]] double query_bytes(std::size_t spheres, std::size_t pairs) const {
        return mesh_bytes + 12.0 * static_cast<double>(spheres) + 8.0 * static_cast<double>(pairs);
    }
};

counters of(std::size_t pairs) { return {{"pairs", static_cast<double>(pairs)}}; }

/// Pairs with index (or mesh) `x` on the first sets of spheres: all, or until one takes longer than `patience` ms.
template <class X>
void add_sizes(const abut::cuda& on, const resident_scene& data, const char* name, const X& x, table& out, double patience) {
    for (const auto& set : data.prefixes) {
        const std::size_t found = abut::count(on, x, set);
        const double took = out.add(joined({"pairs", name, "cuda", std::to_string(set.size())}),
                                    data.query_bytes(set.size(), found), [&] { return of(abut::pairs(on, x, set).size()); });
        if (took > patience) return;
    }
}

/// The whole scene by calls that do not wait. `enqueue_ms` is what the host's thread takes for a call, behind one that still
/// runs; `captured` is the same call out of a graph.
template <class X>
void add_async(const abut::cuda& own, const resident_scene& data, const X& index, std::size_t found, table& out) {
    cudaStream_t stream = nullptr;  // the default one cannot be recorded
    check(cudaStreamCreate(&stream), "cudaStreamCreate");
    {
        abut::cuda on = own;
        on.stream = stream;
        abut::async_result<abut::index_pair> pairs(on, 2 * found);
        abut::async_value<std::uint64_t> count(on);
        const auto row = [&](const char* query, const auto& ask, const auto& wait) {
            const auto ended = [&] { check(cudaStreamSynchronize(stream), "cudaStreamSynchronize"); };
            ended();
            out.add(joined({"async", query, "ended"}), 0, [&] {
                ask();
                ended();
                return counters{};
            });
            out.add(joined({"async", query, "read"}), 0, [&] {
                ask();
                wait();
                return counters{};
            });
            std::vector<double> enqueue;
            for (int i = 0; i < 51; ++i) {
                ask();
                const auto start = std::chrono::steady_clock::now();
                ask();
                enqueue.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
                ended();
            }
            std::sort(enqueue.begin(), enqueue.end());
            cudaGraph_t graph = nullptr;
            cudaGraphExec_t run = nullptr;
            check(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
            ask();
            check(cudaStreamEndCapture(stream, &graph), "cudaStreamEndCapture");
            check(cudaGraphInstantiate(&run, graph, 0), "cudaGraphInstantiate");
            out.add(joined({"async", query, "captured"}), 0, [&] {
                check(cudaGraphLaunch(run, stream), "cudaGraphLaunch");
                ended();
                return counters{};
            });
            check(cudaGraphExecDestroy(run), "cudaGraphExecDestroy");
            check(cudaGraphDestroy(graph), "cudaGraphDestroy");
            out.note(joined({"async", query, "enqueue"}), {{"ms", enqueue[enqueue.size() / 2]}, {"best_ms", enqueue[0]}});
        };
        row(
            "pairs", [&] { abut::pairs_async(on, index, data.whole(), pairs); },
            [&] { (void)abut::wait(on, pairs).size(); });
        row(
            "count", [&] { abut::count_async(on, index, data.whole(), count); }, [&] { (void)abut::wait(on, count); });
    }
    check(cudaStreamDestroy(stream), "cudaStreamDestroy");
}

template <class Index>
void add_index(const abut::cuda& on, const resident_scene& data, table& out) {
    const auto name = [](const char* what) { return joined({what, Index::name, "cuda"}); };
    const std::string whole = std::to_string(scene::sphere_count);
    const auto before = memory_in_use(on).used;
    const auto index = Index::make(on, data.mesh);
    synchronize(on);
    const double bytes = static_cast<double>(index.bytes());
    const double held = static_cast<double>(memory_in_use(on).used - before);
    const std::size_t found = abut::count(on, index, data.whole());
    const double least = data.query_bytes(data.whole().size(), found);

    out.add(name("build"), data.mesh_bytes + bytes, [&] {
        const auto made = Index::make(on, data.mesh);
        return counters{{"bytes", bytes}, {"bytes_held", held}};
    });
    out.add(name("all"), least + bytes,
            [&] { return of(abut::pairs(on, Index::make(on, data.mesh), data.whole()).size()); });
    out.add(joined({name("unsorted"), whole}), least,
            [&] { return of(abut::pairs(on, index, data.whole(), {.sorted = false}).size()); });
    out.add(joined({name("count"), whole}), least, [&] { return of(abut::count(on, index, data.whole())); });
    add_sizes(on, data, Index::name, index, out, 1e9);
    out.add(joined({"arithmetic", Index::name, "float/filtered"}), least,
            [&] { return of(abut::pairs(on, index, data.whole()).size()); });
    out.add(joined({"arithmetic", Index::name, "float/fast"}), least,
            [&] { return of(abut::pairs<abut::fast>(on, index, data.whole()).size()); });
    if constexpr (std::is_same_v<Index, bvh>) {
        add_async(on, data, index, found, out);
        out.add("arithmetic/bvh/float/exact", least,
                [&] { return of(abut::pairs<abut::exact>(on, index, data.whole()).size()); });
        out.add("all_unsorted/bvh/cuda", least + bytes,
                [&] { return of(abut::pairs(on, Index::make(on, data.mesh), data.whole(), {.sorted = false}).size()); });
    }
}

/// Build and query of small scenes: where an index starts to pay.
void add_break_even(const abut::cuda& on, table& out) {
    for (const std::uint32_t side : {8u, 32u, 96u}) {
        const auto surface = scene::torus<float>(side, side);
        const abut::mesh<float, abut::device_space> mesh(on, surface.vertices, surface.faces);
        for (const std::size_t n : {64u, 4096u, 65536u}) {
            const auto centers = scene::points_in<float>({{-140, -140, -40}, {140, 140, 40}}, n);
            const abut::equal_spheres<float, abut::device_space> set(on, centers, 3.0f);
            const auto name = [&](const char* index) {
                return joined({"break_even", index, std::to_string(n), std::to_string(mesh.size())});
            };
            out.add(name("none"), 0, [&] { return of(abut::pairs(on, mesh, set).size()); });
            out.add(name("grid"), 0, [&] { return of(abut::pairs(on, grid::make(on, mesh), set).size()); });
            out.add(name("bvh"), 0, [&] { return of(abut::pairs(on, bvh::make(on, mesh), set).size()); });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_spheres_mesh_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        const resident_scene data(on);
        add_index<bvh>(on, data, out);
        add_index<grid>(on, data, out);
        add_sizes(on, data, "none", data.mesh, out, 400);
        add_break_even(on, out);
    });
}
