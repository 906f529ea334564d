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
// Rows are those of bench/in_turn.hpp, of a pair or of the whole query. Those of pairs have filter_leaves as well: the share
// that the error bound leaves to the stages behind it. Without --mesh a torus stands in for the mesh.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "google.hpp"
#include "in_turn.hpp"
#include "mesh_file.hpp"
#include "ties_scene.hpp"

namespace {

namespace scene = ties_scene;
namespace test = abut::test;

using bench::in_turn;
using bench::scalar_name;

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
