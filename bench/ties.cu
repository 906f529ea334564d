// SPDX-License-Identifier: MIT
//
// usage: bench_ties_cuda [OUT.json]
//
// bench/ties.cpp on CUDA, with the same scenes; the voxel models are larger, and a torus stands in for the mesh. Names:
//
//   pair/ARITHMETIC/SCALAR/NAME    a plain kernel that calls `intersects` for each of a family's pairs; counters registers,
//                                  and local_bytes, which is stack and spills of a thread
//   count/ARITHMETIC/SCALAR/NAME   whole queries, with two trees
//
#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "decide_pairs.hpp"
#include "ties_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::scalar_name;
using bench::table;

namespace scene = ties_scene;
namespace test = abut::test;

/// Rows for the three arithmetics: `ask(A{}, name)` adds one and returns the number of hits.
template <class Ask>
void add_arithmetics(const char* kind, const char* scalar, const std::string& name, const Ask& ask) {
    const auto row = [&](const char* arithmetic) { return joined({kind, arithmetic, scalar, name}); };
    (void)ask(abut::fast{}, row("fast"));
    if (ask(abut::filtered{}, row("filtered")) != ask(abut::exact{}, row("exact")))
        throw abut::error(name + ": filtered and exact disagree");
}

template <abut::scalar T>
void add_families(const abut::cuda& on, table& out) {
    constexpr std::size_t n = std::size_t{1} << 22;
    abut::execution::buffer_of<abut::cuda, test::triangle_pair<T>> pairs(on, n);
    abut::execution::buffer_of<abut::cuda, std::uint8_t> touches(on, n);
    for (const auto family : scene::families) {
        for_each_index(on, n, bench::make_family_pair<T>{scene::seed, family, pairs.data()});
        const auto ask = [&]<class A>(A, const std::string& name) -> double {
            const bench::decide_pair<A, T> decide{pairs.data(), touches.data()};
            for_each_index(on, n, decide);
            const double hits = bench::count_hits(on, n, touches.data());
            const counters says = bench::counters_of_pairs<A, T>(n, hits);
            out.add(name, 0, [&] {
                for_each_index(on, n, decide);
                return says;
            });
            return hits;
        };
        add_arithmetics("pair", scalar_name<T>, test::name_of(family), ask);
    }
}

template <abut::scalar T>
void add_queries(const abut::cuda& on, table& out) {
    for (const auto& s : scene::scenes<T>(64, nullptr)) {
        const auto a = abut::make_bvh(on, copy_to(on, abut::mesh<T>(s.a.vertices, s.a.faces)));
        const auto b = abut::make_bvh(on, copy_to(on, abut::mesh<T>(s.b.vertices, s.b.faces)));
        const auto ask = [&]<class A>(A, const std::string& name) -> double {
            double found = 0;
            out.add(name, 0, [&] {
                found = static_cast<double>(abut::count<A>(on, a, b));
                return counters{{"found", found}};
            });
            return found;
        };
        add_arithmetics("count", scalar_name<T>, s.name, ask);
    }
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_ties_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        add_families<float>(on, out);
        add_queries<float>(on, out);
        add_families<double>(on, out);
        add_queries<double>(on, out);
    });
}
