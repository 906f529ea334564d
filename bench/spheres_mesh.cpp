// SPDX-License-Identifier: MIT
//
// usage: bench_spheres_mesh --benchmark_enable_random_interleaving=true --benchmark_out=cpu.json
//
// Spheres against a mesh, the table of Lee and Hsieh, 2019: brute force and buckets, with our BVH beside them, serial and
// on OpenMP threads. Brute force stops at 2^13 spheres, because its time grows with the product of both numbers. Names:
//
//   build/INDEX/POLICY               the index over the triangles; counter bytes
//   pairs/INDEX/POLICY/SPHERES       the query alone, pairs sorted; the index is there
//   unsorted/..., count/...          the same without the sort, and without storing pairs
//   all/INDEX/POLICY                 build and query, pairs sorted
//   arithmetic/INDEX/SCALAR/NAME     the query on the whole scene, serial
//   break_even/INDEX/SPHERES/TRIANGLES   build and query of small scenes, serial
//   floor/read, floor/copy           bytes a second of one core, from memory
//
// Peers (bench/spheres_mesh/) are in the same run, where their packages are there. bench/report.py makes tables of it.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "../docs/examples/scene.hpp"
#include "google.hpp"

namespace {

constexpr int repetitions = 11;

template <class T>
const abut::mesh<T>& torus() {
    static const abut::mesh<T> made = [] {
        const auto surface = scene::torus<T>();
        return abut::mesh<T>(surface.vertices, surface.faces);
    }();
    return made;
}

/// The first n spheres of the scene.
template <class T>
const abut::equal_spheres<T>& spheres(std::size_t n) {
    static std::map<std::size_t, abut::equal_spheres<T>> made;
    auto [found, fresh] = made.try_emplace(n);
    if (fresh) found->second = abut::equal_spheres<T>(scene::centers<T>(n), static_cast<T>(scene::radius));
    return found->second;
}

// --- indices, policies and answers, as types with names -----------------------------------------------------------------

struct bvh {
    static constexpr const char* name = "bvh";
    static auto make(const auto& on, const auto& mesh) { return abut::make_bvh(on, mesh); }
};
struct grid {
    static constexpr const char* name = "grid";
    static auto make(const auto& on, const auto& mesh) { return abut::make_grid(on, mesh); }
};
struct none {
    static constexpr const char* name = "none";
    static auto make(const auto&, const auto& mesh) { return mesh; }
};

const char* name_of(const abut::serial&) { return "serial"; }
const char* name_of(const abut::openmp&) { return "openmp"; }

struct sorted_pairs {
    static constexpr const char* name = "pairs";
    template <abut::arithmetic A>
    static std::size_t ask(const auto& on, const auto& index, const auto& spheres) {
        return abut::pairs<A>(on, index, spheres).size();
    }
};
struct unsorted_pairs {
    static constexpr const char* name = "unsorted";
    template <abut::arithmetic A>
    static std::size_t ask(const auto& on, const auto& index, const auto& spheres) {
        return abut::pairs<A>(on, index, spheres, {.sorted = false}).size();
    }
};
struct number {
    static constexpr const char* name = "count";
    template <abut::arithmetic A>
    static std::size_t ask(const auto& on, const auto& index, const auto& spheres) {
        return abut::count<A>(on, index, spheres);
    }
};

// --- what is measured ----------------------------------------------------------------------------------------------------

void note(benchmark::State& state, std::size_t pairs, std::size_t n, std::size_t triangles) {
    state.counters["pairs"] = static_cast<double>(pairs);
    state.counters["spheres"] = static_cast<double>(n);
    state.counters["triangles"] = static_cast<double>(triangles);
}

template <class Index, class Policy>
void build(benchmark::State& state, Policy on) {
    const auto& mesh = torus<float>();
    std::size_t bytes = 0;
    for (auto _ : state) bytes = Index::make(on, mesh).bytes();
    state.counters["bytes"] = static_cast<double>(bytes);
    state.counters["triangles"] = static_cast<double>(mesh.size());
}

template <class Answer, class Index, abut::arithmetic A, class T, class Policy>
void query(benchmark::State& state, Policy on, std::size_t n) {
    const auto index = Index::make(on, torus<T>());
    const auto& set = spheres<T>(n);
    std::size_t pairs = 0;
    for (auto _ : state) pairs = Answer::template ask<A>(on, index, set);
    note(state, pairs, n, torus<T>().size());
}

template <class Index, class Policy>
void all(benchmark::State& state, Policy on) {
    const auto& set = spheres<float>(scene::sphere_count);
    std::size_t pairs = 0;
    for (auto _ : state) {
        const auto index = Index::make(on, torus<float>());
        pairs = sorted_pairs::ask<abut::filtered>(on, index, set);
    }
    note(state, pairs, set.size(), torus<float>().size());
}

/// Small scenes: a coarser torus, and the spheres in the box around it alone, so that some touch.
template <class Index>
void small(benchmark::State& state, std::size_t n, std::uint32_t around, std::uint32_t across) {
    const auto surface = scene::torus<float>(around, across);
    const abut::mesh<float> mesh(surface.vertices, surface.faces);
    const abut::equal_spheres<float> set(scene::points_in<float>({{-140, -140, -40}, {140, 140, 40}}, n), 3.0f);
    const abut::serial on;
    std::size_t pairs = 0;
    for (auto _ : state) {
        const auto index = Index::make(on, mesh);
        pairs = sorted_pairs::ask<abut::filtered>(on, index, set);
    }
    note(state, pairs, n, mesh.size());
}

void read_floor(benchmark::State& state) {
    const std::vector<std::uint64_t> words(std::size_t{1} << 25, 1);
    for (auto _ : state) benchmark::DoNotOptimize(std::accumulate(words.begin(), words.end(), std::uint64_t{0}));
    state.SetBytesProcessed(static_cast<std::int64_t>(words.size() * sizeof(words[0])) *
                            static_cast<std::int64_t>(state.iterations()));
}

void copy_floor(benchmark::State& state) {
    const std::vector<char> from(std::size_t{1} << 27, 1);
    std::vector<char> to(from.size(), 2);
    for (auto _ : state) {
        std::memcpy(to.data(), from.data(), from.size());
        benchmark::DoNotOptimize(to.data());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(2 * static_cast<std::int64_t>(from.size()) * static_cast<std::int64_t>(state.iterations()));
}

// --- the list ------------------------------------------------------------------------------------------------------------

/// `milliseconds`: about how long one run takes; long ones run once in a repetition.
void usual(benchmark::internal::Benchmark* b, double milliseconds, int times = repetitions) {
    b->Unit(benchmark::kMillisecond)->UseRealTime()->Repetitions(times)->ReportAggregatesOnly(true);
    if (milliseconds > 5) {
        b->Iterations(1);
    } else {
        b->MinTime(0.01);
    }
}

template <class Answer, class Index, class Policy>
void add_query(const Policy& on, std::size_t n, int times = repetitions) {
    const std::string name = std::string(Answer::name) + "/" + Index::name + "/" + name_of(on) + "/" + std::to_string(n);
    const bool brute = std::string(Index::name) == "none";
    usual(benchmark::RegisterBenchmark(name.c_str(), query<Answer, Index, abut::filtered, float, Policy>, on, n),
          brute ? 100 : static_cast<double>(n) * 3e-5, times);
}

template <class Index, class Policy>
void add_index(const Policy& on) {
    const std::string tail = std::string("/") + Index::name + "/" + name_of(on);
    usual(benchmark::RegisterBenchmark(("build" + tail).c_str(), build<Index, Policy>, on), 20);
    usual(benchmark::RegisterBenchmark(("all" + tail).c_str(), all<Index, Policy>, on), 100);
    for (std::size_t n = 1 << 10; n <= 1 << 20; n *= 2) add_query<sorted_pairs, Index>(on, n);
    add_query<sorted_pairs, Index>(on, scene::sphere_count);
    add_query<unsorted_pairs, Index>(on, scene::sphere_count);
    add_query<number, Index>(on, scene::sphere_count);
}

template <class Index, class T, abut::arithmetic A>
void add_arithmetic(const char* scalar, const char* arithmetic) {
    const std::string name = std::string("arithmetic/") + Index::name + "/" + scalar + "/" + arithmetic;
    usual(benchmark::RegisterBenchmark(name.c_str(), query<sorted_pairs, Index, A, T, abut::serial>, abut::serial{},
                                       scene::sphere_count),
          100);
}

template <class Index>
void add_small(std::size_t n, std::uint32_t around, std::uint32_t across) {
    const std::string name =
        std::string("break_even/") + Index::name + "/" + std::to_string(n) + "/" + std::to_string(2 * around * across);
    usual(benchmark::RegisterBenchmark(name.c_str(), small<Index>, n, around, across), 0, 5);
}

template <class Policy>
void add_policy(const Policy& on) {
    add_index<bvh>(on);
    add_index<grid>(on);
    for (std::size_t n = 1 << 10; n <= 1 << 13; n *= 2) add_query<sorted_pairs, none>(on, n, 3);
}

void add_all() {
    add_policy(abut::serial{});
    add_policy(abut::openmp{});
    add_arithmetic<bvh, float, abut::fast>("float", "fast");
    add_arithmetic<bvh, float, abut::filtered>("float", "filtered");
    add_arithmetic<bvh, float, abut::exact>("float", "exact");
    add_arithmetic<bvh, double, abut::fast>("double", "fast");
    add_arithmetic<bvh, double, abut::filtered>("double", "filtered");
    add_arithmetic<bvh, double, abut::exact>("double", "exact");
    add_arithmetic<grid, float, abut::fast>("float", "fast");
    add_arithmetic<grid, float, abut::filtered>("float", "filtered");
    for (const auto& [around, across] : {std::pair(4u, 4u), {8u, 8u}, {16u, 16u}, {32u, 32u}, {64u, 64u}}) {
        for (const std::size_t n : {1u, 8u, 64u, 512u, 4096u}) {
            add_small<none>(n, around, across);
            add_small<grid>(n, around, across);
            add_small<bvh>(n, around, across);
        }
    }
    usual(benchmark::RegisterBenchmark("floor/read", read_floor), 100);
    usual(benchmark::RegisterBenchmark("floor/copy", copy_floor), 100);
}

}  // namespace

int main(int argc, char** argv) {
    add_all();
    return bench::run_registered("bench_spheres_mesh", argc, argv);
}
