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
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/cuda.hpp>

#include "../docs/examples/scene.hpp"

namespace {

void check(cudaError_t code, const char* call) {
    if (code != cudaSuccess) throw abut::cuda_error(call, code);
}

class stopwatch {
public:
    stopwatch() {
        check(cudaEventCreate(&start_), "cudaEventCreate");
        check(cudaEventCreate(&stop_), "cudaEventCreate");
    }
    stopwatch(const stopwatch&) = delete;
    stopwatch& operator=(const stopwatch&) = delete;
    ~stopwatch() {
        cudaEventDestroy(start_);
        cudaEventDestroy(stop_);
    }
    /// Milliseconds between events before and after what `work` puts on the stream.
    template <class Work>
    float time(const abut::cuda& on, const Work& work) {
        check(cudaEventRecord(start_, on.stream), "cudaEventRecord");
        work();
        check(cudaEventRecord(stop_, on.stream), "cudaEventRecord");
        check(cudaEventSynchronize(stop_), "cudaEventSynchronize");
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, start_, stop_), "cudaEventElapsedTime");
        return milliseconds;
    }

private:
    cudaEvent_t start_ = nullptr, stop_ = nullptr;
};

struct row {
    std::string name;
    double median, best;  // ms
    std::vector<std::pair<std::string, double>> counters;
};

class table {
public:
    explicit table(const abut::cuda& on) : on_(on) {}

    /// Bytes a millisecond; 0 until it has been measured.
    double bandwidth = 0;

    /// `work` returns counters; `least_bytes` is what it has to move.
    template <class Work>
    double add(const std::string& name, double least_bytes, const Work& work) {
        std::vector<std::pair<std::string, double>> counters;
        const auto once = [&] { return watch_.time(on_, [&] { counters = work(); }); };
        once();
        const int runs = once() > 20 ? 11 : 21;
        std::vector<float> times;
        for (int i = 0; i < runs; ++i) times.push_back(once());
        std::sort(times.begin(), times.end());
        if (bandwidth > 0) counters.emplace_back("floor_ms", least_bytes / bandwidth);
        rows_.push_back({name, times[times.size() / 2], times[0], counters});
        print(rows_.back());
        return rows_.back().median;
    }

    void write(const char* path) const {
        cudaDeviceProp device{};
        check(cudaGetDeviceProperties(&device, abut::execution::device_of(on_)), "cudaGetDeviceProperties");
        const auto memory = memory_in_use(on_);
        std::FILE* const file = std::fopen(path, "w");
        if (file == nullptr) throw abut::error(std::string(path) + ": cannot be written");
        std::fprintf(file,
                     "{\"context\": {\"device\": \"%s\", \"cuda\": %d, \"pool_reserved\": %llu, \"pool_peak\": %llu},\n",
                     device.name, CUDART_VERSION, static_cast<unsigned long long>(memory.reserved),
                     static_cast<unsigned long long>(memory.used_peak));
        std::fprintf(file, " \"benchmarks\": [");
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const row& r = rows_[i];
            std::fprintf(file, "%s\n  {\"name\": \"%s_median\", \"run_name\": \"%s\", \"aggregate_name\": \"median\", ",
                         i == 0 ? "" : ",", r.name.c_str(), r.name.c_str());
            std::fprintf(file, "\"real_time\": %.9g, \"cpu_time\": %.9g, \"time_unit\": \"ms\", \"best_ms\": %.9g", r.median,
                         r.median, r.best);
            for (const auto& [key, value] : r.counters) std::fprintf(file, ", \"%s\": %.17g", key.c_str(), value);
            std::fprintf(file, "}");
        }
        std::fprintf(file, "\n]}\n");
        if (std::fclose(file) != 0) throw abut::error(std::string(path) + ": cannot be written");
    }

private:
    static void print(const row& r) {
        std::printf("%-34s %11.4f ms  (best %.4f)", r.name.c_str(), r.median, r.best);
        for (const auto& [key, value] : r.counters) std::printf("  %s %.9g", key.c_str(), value);
        std::printf("\n");
        std::fflush(stdout);
    }

    abut::cuda on_;
    stopwatch watch_;
    std::vector<row> rows_;
};

using counters = std::vector<std::pair<std::string, double>>;

/// Parts of a benchmark's name with slashes between them.
std::string joined(std::initializer_list<std::string> parts) {
    std::string name;
    for (const auto& part : parts) {
        if (!name.empty()) name += '/';
        name += part;
    }
    return name;
}

struct word_at {
    const std::uint64_t* words;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return words[i]; }
};
struct either {
    ABUT_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a | b; }
};

/// Reads a GiB and copies a GiB; sets the table's bandwidth to the former.
void measure_floor(const abut::cuda& on, table& out) {
    constexpr std::size_t words = std::size_t{1} << 27, bytes = words * sizeof(std::uint64_t);
    abut::execution::buffer_of<abut::cuda, std::uint64_t> from(on, words), to(on, words);
    fill(on, from.data(), words, std::uint64_t{1});
    const auto rate = [&](const char* name, double moved, const auto& work) {
        const double milliseconds = out.add(name, moved, [&] {
            work();
            return counters{{"bytes", moved}};
        });
        return moved / milliseconds;
    };
    const double copied = rate("floor/copy", 2.0 * bytes, [&] { copy(on, from.data(), words, to.data()); });
    const double read = rate("floor/read", bytes, [&] {
        if (reduce(on, words, std::uint64_t{0}, either{}, word_at{from.data()}) != 1) throw abut::error("floor: wrong sum");
    });
    rate("floor/call", 8, [&] { (void)reduce(on, std::size_t{1}, std::uint64_t{0}, either{}, word_at{from.data()}); });
    out.bandwidth = read;
    std::printf("copy %.0f GB/s, read %.0f GB/s\n", copied * 1e-6, read * 1e-6);
}

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

void run(const char* path) {
    cudaStream_t stream = nullptr;
    check(cudaStreamCreate(&stream), "cudaStreamCreate");
    {
        const abut::cuda on{stream};
        table out(on);
        measure_floor(on, out);
        const resident_scene data(on);
        add_index<bvh>(on, data, out);
        add_index<grid>(on, data, out);
        add_sizes(on, data, "none", data.mesh, out, 400);
        add_break_even(on, out);
        const auto memory = memory_in_use(on);
        std::printf("pool: %llu bytes reserved, at most %llu in use\n", static_cast<unsigned long long>(memory.reserved),
                    static_cast<unsigned long long>(memory.used_peak));
        if (path != nullptr) out.write(path);
    }
    check(cudaStreamDestroy(stream), "cudaStreamDestroy");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run(argc > 1 ? argv[1] : nullptr);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_spheres_mesh_cuda: %s\n", e.what());
        return 1;
    }
}
