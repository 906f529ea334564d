// SPDX-License-Identifier: MIT
//
// usage: bench_ties [--mesh=FILE] --benchmark_out=cpu.json
//
// What ties cost: scenes in which hardly a pair is decided by floating point with an error bound (bench/ties_scene.hpp).
// Names:
//
//   pair/SCALAR/NAME    pairs decided one by one: families of tests/support/triangle_families.hpp, and the candidates of
//                       scenes
//   count/SCALAR/NAME   whole queries, with two trees, on one thread
//
// A row runs `fast`, `filtered` and `exact` in turn, so that all three see the same machine. Its counters are the medians of
// their processor times in ns, of a pair or of the whole query; filtered_over_fast; hits; and, for pairs, filter_leaves: the
// share that the error bound leaves to the stages behind it. Without --mesh a torus stands in for the mesh.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mesh_file.hpp"
#include "ties_scene.hpp"

namespace {

namespace scene = ties_scene;
namespace test = abut::test;

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

double median(std::vector<double>& times) {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

/// `ask(A{})` returns the number of hits.
template <class Ask>
void in_turn(benchmark::State& state, std::size_t items, const Ask& ask) {
    std::vector<double> fast, filtered, exact;
    std::uint64_t hits = 0, by_integers = 0;
    const auto timed = [&]<class A>(A, std::vector<double>& times) {
        const std::clock_t start = std::clock();
        const std::uint64_t found = ask(A{});
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        times.push_back(1e9 * seconds / static_cast<double>(items));
        return found;
    };
    for (auto _ : state) {
        benchmark::DoNotOptimize(timed(abut::fast{}, fast));
        hits = timed(abut::filtered{}, filtered);
        by_integers = timed(abut::exact{}, exact);
    }
    if (hits != by_integers) state.SkipWithError("filtered and exact disagree");
    state.counters["fast"] = median(fast);
    state.counters["filtered"] = median(filtered);
    state.counters["exact"] = median(exact);
    state.counters["filtered_over_fast"] = median(filtered) / median(fast);
    state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(items);
}

template <abut::scalar T>
void decide_pairs(benchmark::State& state, const std::vector<test::triangle_pair<T>>& pairs) {
    in_turn(state, pairs.size(), [&]<class A>(A) {
        std::uint64_t hits = 0;
        for (const auto& [a, b] : pairs) hits += abut::intersects<A>(a, b) ? 1 : 0;
        return hits;
    });
    double left = 0;
    for (const auto& [a, b] : pairs) left += abut::decide<abut::filtered>(a, b) == abut::verdict::unknown;
    state.counters["filter_leaves"] = left / static_cast<double>(pairs.size());
}

template <abut::scalar T>
void family(benchmark::State& state, abut::test::triangle_family which) {
    std::vector<test::triangle_pair<T>> pairs;
    for (std::uint64_t i = 0; i < 1 << 14; ++i) pairs.push_back(test::make_triangle_pair<T>(scene::seed, which, i));
    decide_pairs(state, pairs);
}

template <abut::scalar T>
void candidates_of(benchmark::State& state, const scene::scene<T>& s) {
    decide_pairs(state, scene::candidates(s.a, s.b, 1 << 16));
}

template <abut::scalar T>
void count(benchmark::State& state, const scene::scene<T>& s) {
    const abut::serial on;
    const auto a = abut::make_bvh(on, abut::mesh<T>(s.a.vertices, s.a.faces));
    const auto b = abut::make_bvh(on, abut::mesh<T>(s.b.vertices, s.b.faces));
    in_turn(state, 1, [&]<class A>(A) { return abut::count<A>(on, a, b); });
}

template <abut::scalar T>
void add(const scene::surface<float>* mesh) {
    const std::string of = std::string("/") + scalar_name<T> + "/";
    const auto row = [](const std::string& name, auto&&... arguments) {
        benchmark::RegisterBenchmark(name.c_str(), arguments...)->Unit(benchmark::kMillisecond)->Iterations(21);
    };
    for (const auto f : scene::families) row("pair" + of + test::name_of(f), family<T>, f);
    scene::surface<T> widened;
    if (mesh != nullptr) {
        widened.faces = mesh->faces;
        for (const auto& p : mesh->vertices) {
            widened.vertices.push_back({static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
        }
    }
    const auto* const onto_itself = mesh != nullptr ? &widened : nullptr;
    for (const auto& s : scene::scenes<T>(12, onto_itself)) row("pair" + of + s.name, candidates_of<T>, s);
    for (const auto& s : scene::scenes<T>(24, onto_itself)) row("count" + of + s.name, count<T>, s);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--mesh");
        scene::surface<float> mesh;
        if (path.empty()) {
            std::printf("no --mesh: a torus stands in for it\n");
        } else {
            mesh = bench::read_surface<scene::surface<float>>(path);
        }
        const auto* const onto_itself = path.empty() ? nullptr : &mesh;
        add<float>(onto_itself);
        add<double>(onto_itself);
        return bench::run_registered("bench_ties", argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_ties: %s\n", problem.what());
        return 1;
    }
}
