// SPDX-License-Identifier: MIT
//
// usage: bench_validate --benchmark_out=cpu.json
//
// What a mesh takes to be validated. The largest meshes need 2 GB of memory. Names:
//
//   validate/ORDER/SCALAR/POLICY/N   all of it, of N triangles; ORDER is in_order or random
//   half_edges/ORDER/POLICY/N        of that, half-edges written and sorted
//   sort/ORDER/POLICY/N              of that, the sort of the 3 N keys with their half-edges: the floor of the method

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "validate_meshes.hpp"

namespace {

using validate_meshes::order;

const char* name_of(const abut::serial&) { return "serial"; }
const char* name_of(const abut::openmp&) { return "openmp"; }

/// Made at first use.
template <class T>
const abut::mesh<T>& mesh_of(validate_meshes::size n, order o) {
    static std::map<std::pair<std::size_t, order>, abut::mesh<T>> made;
    auto [found, fresh] = made.try_emplace({n.faces(), o});
    if (fresh) {
        const auto arrays = validate_meshes::make<T>(n, o);
        found->second = abut::mesh<T>(arrays.vertices, arrays.faces);
    }
    return found->second;
}

void count_faces(benchmark::State& state, validate_meshes::size n) {
    state.SetItemsProcessed(static_cast<std::int64_t>(n.faces()) * static_cast<std::int64_t>(state.iterations()));
}

template <class T, class Policy>
void validate(benchmark::State& state, Policy on, validate_meshes::size n, order o) {
    const auto& mesh = mesh_of<T>(n, o);
    for (auto _ : state) {
        const abut::mesh_report report = abut::validate(on, mesh);
        if (!report.closed() || report.euler_characteristic != 0) state.SkipWithError("this is no torus");
    }
    count_faces(state, n);
}

template <class Policy>
void half_edges(benchmark::State& state, Policy on, validate_meshes::size n, order o) {
    const auto view = mesh_of<float>(n, o).view();
    for (auto _ : state) {
        const abut::detail::half_edge_table<Policy> table(on, view, abut::detail::id_bits(view.vertices.count));
        auto first = table.view().keys[0];
        benchmark::DoNotOptimize(first);
    }
    count_faces(state, n);
}

template <class Policy>
void sort(benchmark::State& state, Policy on, validate_meshes::size n, order o) {
    const auto view = mesh_of<float>(n, o).view();
    const abut::detail::half_edge_key key{abut::detail::id_bits(view.vertices.count)};
    for (auto _ : state) {
        state.PauseTiming();
        abut::execution::buffer_of<Policy, std::uint64_t> keys(on, 3 * view.size());
        abut::execution::buffer_of<Policy, std::uint32_t> ids(on, 3 * view.size());
        const abut::detail::write_half_edges write{view.faces, view.vertices.count, key, keys.data(), ids.data()};
        for_each_index(on, view.size(), write);
        state.ResumeTiming();
        sort_by_key(on, keys, ids, 2 * key.vertex_bits);
        benchmark::DoNotOptimize(keys.data()[0]);
    }
    count_faces(state, n);
}

/// One thread is timed by the processor; `openmp` by the wall's clock, since its threads work for it.
template <class Policy, class Body>
void add(const std::string& name, const Policy& on, validate_meshes::size n, order o, const Body& body) {
    const std::string whole = name + '/' + name_of(on) + '/' + std::to_string(n.faces());
    auto* const b = benchmark::RegisterBenchmark(whole.c_str(), body, on, n, o);
    b->Unit(benchmark::kMillisecond)->Iterations(1)->Repetitions(5)->ReportAggregatesOnly(true);
    if (std::is_same_v<Policy, abut::openmp>) b->UseRealTime();
}

template <class Policy>
void add_policy(const Policy& on) {
    for (const auto& n : validate_meshes::sizes) {
        for (const order o : {order::of_the_torus, order::random}) {
            const std::string in = validate_meshes::name_of(o);
            add("validate/" + in + "/float", on, n, o, validate<float, Policy>);
            add("validate/" + in + "/double", on, n, o, validate<double, Policy>);
            add("half_edges/" + in, on, n, o, half_edges<Policy>);
            add("sort/" + in, on, n, o, sort<Policy>);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    add_policy(abut::serial{});
    add_policy(abut::openmp{});
    return bench::run_registered("bench_validate", argc, argv);
}
