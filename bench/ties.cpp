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
//   least/SCALAR/NAME   distance, nearest and raycast where all is equally near, on one thread: of_ties and of_others say the
//                       milliseconds of the scene and of the same one without ties, ratio how they compare, in turn
//
// Rows are those of bench/in_turn.hpp, of a pair or of the whole query. Those of pairs have filter_leaves as well: the share
// that the error bound leaves to the stages behind it. Without --mesh a torus stands in for the mesh.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <random>
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

/// A scene with ties and one without, asked in turn; the medians of both.
template <class Ties, class Others>
void least(benchmark::State& state, const Ties& ties, const Others& others) {
    std::vector<double> of_ties, of_others;
    const auto timed = [](const auto& ask) {
        const auto from = std::chrono::steady_clock::now();
        ask();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count();
    };
    for (auto _ : state) {
        of_ties.push_back(timed(ties));
        of_others.push_back(timed(others));
    }
    const auto median = [](std::vector<double>& all) {
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
        return all[all.size() / 2];
    };
    state.counters["of_ties"] = median(of_ties);
    state.counters["of_others"] = median(of_others);
    state.counters["ratio"] = median(of_ties) / median(of_others);
}

constexpr std::size_t many = 20000;

/// Points in one place, or in a cube.
template <abut::scalar T>
abut::shapes<abut::vec3<T>> cloud(bool tied, T x) {
    std::mt19937_64 random(scene::seed);
    std::uniform_real_distribution<T> any(0, 1);
    std::vector<abut::vec3<T>> points;
    for (std::size_t i = 0; i < many; ++i) {
        const abut::vec3<T> p{x + any(random), any(random), any(random)};
        points.push_back(tied ? abut::vec3<T>{x, 0, 0} : p);
    }
    return abut::shapes<abut::vec3<T>>(points);
}
/// A square of 40,898 triangles at height z, flat or rough.
template <abut::scalar T>
abut::mesh<T> plate(T z, T rough) {
    constexpr std::uint32_t side = 143;
    std::mt19937_64 random(scene::seed);
    std::uniform_real_distribution<T> any(0, 1);
    std::vector<abut::vec3<T>> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t i = 0; i <= side; ++i) {
        for (std::uint32_t j = 0; j <= side; ++j) {
            vertices.push_back({static_cast<T>(i) / side, static_cast<T>(j) / side, z + rough * any(random)});
        }
    }
    const auto at = [](std::uint32_t i, std::uint32_t j) { return i * (side + 1) + j; };
    for (std::uint32_t i = 0; i < side; ++i) {
        for (std::uint32_t j = 0; j < side; ++j) {
            faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
            faces.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
        }
    }
    return abut::mesh<T>(vertices, faces);
}
/// Slanted triangles, one above the other or in one place.
template <abut::scalar T>
abut::triangle_soup<T> stack(bool tied) {
    std::vector<abut::triangle<T>> triangles;
    for (std::size_t i = 0; i < many; ++i) {
        const T z = tied ? T(0) : static_cast<T>(i);
        triangles.push_back({{0, 0, z}, {1, 0, z + T(0.25)}, {0, 1, z + T(0.125)}});
    }
    return abut::triangle_soup<T>(triangles);
}

template <abut::scalar T>
void least_of_clouds(benchmark::State& state) {
    const abut::serial on;
    const auto tied_a = make_bvh(on, cloud<T>(true, 0)), tied_b = make_bvh(on, cloud<T>(true, 3));
    const auto a = make_bvh(on, cloud<T>(false, 0)), b = make_bvh(on, cloud<T>(false, 3));
    least(
        state, [&] { return distance(on, tied_a, tied_b); }, [&] { return distance(on, a, b); });
}
template <abut::scalar T>
void least_of_plates(benchmark::State& state) {
    const abut::serial on;
    const auto flat_a = make_bvh(on, plate<T>(0, 0)), flat_b = make_bvh(on, plate<T>(T(0.1), 0));
    const auto a = make_bvh(on, plate<T>(0, T(1e-3))), b = make_bvh(on, plate<T>(T(0.1), T(2e-3)));
    least(
        state, [&] { return distance(on, flat_a, flat_b); }, [&] { return distance(on, a, b); });
}
template <abut::scalar T, std::size_t Count>
void least_of_points(benchmark::State& state) {
    const abut::serial on;
    const auto tied = make_bvh(on, cloud<T>(true, 0)), other = make_bvh(on, cloud<T>(false, 0));
    const auto points = cloud<T>(false, 1);
    least(
        state, [&] { return nearest(on, tied, points, Count); }, [&] { return nearest(on, other, points, Count); });
}
template <abut::scalar T>
void least_of_rays(benchmark::State& state) {
    const abut::serial on;
    const auto tied = make_bvh(on, stack<T>(true)), other = make_bvh(on, stack<T>(false));
    std::vector<abut::ray<T>> all;
    std::mt19937_64 random(scene::seed);
    std::uniform_real_distribution<T> any(0, T(0.4));
    for (std::size_t i = 0; i < 2000; ++i) all.push_back({{any(random), any(random), -3}, {0, 0, 1}});
    const abut::rays<T> lines(all);
    least(
        state, [&] { return raycast(on, tied, lines); }, [&] { return raycast(on, other, lines); });
}

template <abut::scalar T>
void add(const scene::surface<float>* mesh) {
    const std::string of = std::string("/") + scalar_name<T> + "/";
    const auto row = [](const std::string& name, auto&&... arguments) {
        benchmark::RegisterBenchmark(name.c_str(), arguments...)->Unit(benchmark::kMillisecond)->Iterations(21);
    };
    row("least" + of + "distance of 20,000 copies of a point from as many", least_of_clouds<T>);
    row("least" + of + "distance of parallel plates", least_of_plates<T>);
    row("least" + of + "nearest among 20,000 copies of a point", least_of_points<T, 1>);
    row("least" + of + "nearest 8 among 20,000 copies of a point", least_of_points<T, 8>);
    row("least" + of + "rays into 20,000 copies of a triangle", least_of_rays<T>);
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
