// SPDX-License-Identifier: MIT

// What one decision costs: `intersects` of a sphere and a triangle with each arithmetic and scalar, and the last stage
// alone. Axis `pairs`: 0 random (about 30 % hits); 1 near contact (the radius within 1e-3 of the distance); 2 candidates of
// a scene (spheres of three triangle sizes whose boxes meet the triangles'). Counters: the share of pairs that the filter
// decides, and hits.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include <abut/predicate/intersects.hpp>

#include "../tests/support/families.hpp"

namespace {

using namespace abut;

enum class pairs : int { random, near_contact, scene };

template <scalar T>
std::vector<test::sphere_triangle_pair<T>> make(pairs kind) {
    using test::construction::cube;
    using test::construction::round_to;
    constexpr std::uint64_t count = 1 << 14, seed = 1;
    std::vector<test::sphere_triangle_pair<T>> r;
    for (std::uint64_t i = 0; i < count; ++i) {
        auto p = test::make_pair<T>(seed, test::family::random, i);
        test::draws d(seed, 1000, i);
        if (kind == pairs::near_contact) {
            const auto& [s, t] = p;
            const vec3<T> q = detail::nearest_to_origin(t.a - s.center, t.b - s.center, t.c - s.center);
            p.s.radius = static_cast<T>(std::sqrt(static_cast<double>(dot(q, q))) * d.uniform(0.999, 1.001));
        }
        if (kind == pairs::scene) {
            const auto place = cube(d, 100);
            const auto corner = [&] { return round_to<T>(place + cube(d, 1.6)); };
            p.t = {corner(), corner(), corner()};
            p.s = {round_to<T>(place + cube(d, 4.2)), 3};
        }
        r.push_back(p);
    }
    return r;
}

template <scalar T>
void count_shares(benchmark::State& state, const std::vector<test::sphere_triangle_pair<T>>& all) {
    double decided = 0, hits = 0;
    for (const auto& [s, t] : all) {
        decided += decide<filtered>(s, t) != verdict::unknown;
        hits += intersects(s, t);
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["filter_decides"] = decided / static_cast<double>(all.size());
    state.counters["hits"] = hits / static_cast<double>(all.size());
}

template <arithmetic A, scalar T>
void sphere_triangle(benchmark::State& state) {
    const auto all = make<T>(static_cast<pairs>(state.range(0)));
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(intersects<A>(all[i].s, all[i].t));
        i = (i + 1) % all.size();
    }
    count_shares(state, all);
}

template <scalar T>
void sphere_triangle_resolve(benchmark::State& state) {
    const auto all = make<T>(static_cast<pairs>(state.range(0)));
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(resolve(all[i].s, all[i].t));
        i = (i + 1) % all.size();
    }
    count_shares(state, all);
}

}  // namespace

BENCHMARK(sphere_triangle<fast, float>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle<filtered, float>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle<exact, float>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle_resolve<float>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle<fast, double>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle<filtered, double>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle<exact, double>)->ArgName("pairs")->DenseRange(0, 2);
BENCHMARK(sphere_triangle_resolve<double>)->ArgName("pairs")->DenseRange(0, 2);

BENCHMARK_MAIN();
