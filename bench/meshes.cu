// SPDX-License-Identifier: MIT
//
// usage: bench_meshes_cuda [OUT.json [MESH]]
//
// bench/meshes.cpp on CUDA: the same pair of meshes (MESH, PLY or OBJ, or a torus of 345,744 triangles) and the same names,
// policy cuda, all data resident before the clock starts; and
//
//   pairs/baked_with_build/cuda          one of the trees built in the call
//   near/WHAT/cuda                       the mesh against its copy moved by (.0003, .0002, .0001) of its box: pairs, and
//                                        boxes, the walk of both trees with a filter that refuses every pair
//   build/bvh/cuda/N, sort/cuda/N        a tree over N triangles, and the sort of 32-bit codes alone that is in it
//
// Each figure is the median of 21 runs, taken with CUDA events around the whole call, so what the host does between kernels
// is in it.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "meshes_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;
using device_mesh = abut::mesh<float, abut::device_space>;

counters of(std::size_t pairs) { return {{"pairs", static_cast<double>(pairs)}}; }

/// Refuses every pair, but no compiler knows.
struct refuse_all {
    std::uint32_t wanted;
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t) const { return a == wanted; }
};

void add_pair(const abut::cuda& on, table& out, const meshes_scene::mesh_pair& pair) {
    const device_mesh a(on, pair.a.vertices, pair.a.faces), b(on, pair.b.vertices, pair.b.faces);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto add_queries = [&](const std::string& kind, const auto& other) {
        const abut::query_options<> unsorted{.sorted = false};
        out.add(joined({"pairs", kind, "cuda"}), 0, [&] { return of(pairs(on, tree_a, other).size()); });
        out.add(joined({"unsorted", kind, "cuda"}), 0, [&] { return of(pairs(on, tree_a, other, unsorted).size()); });
        out.add(joined({"fast_unsorted", kind, "cuda"}), 0,
                [&] { return of(abut::pairs<abut::fast>(on, tree_a, other, unsorted).size()); });
        out.add(joined({"count", kind, "cuda"}), 0, [&] { return of(count(on, tree_a, other)); });
        out.add(joined({"any", kind, "cuda"}), 0, [&] { return of(any(on, tree_a, other) ? 1 : 0); });
        const abut::query_options<refuse_all> none{.filter = {0xffffffff}};
        out.add(joined({"boxes", kind, "cuda"}), 0, [&] { return of(count(on, tree_a, other, none)); });
    };
    add_queries("baked", tree_b);
    add_queries("posed", posed(tree_a, pair.pose));
    out.add("pairs/baked_with_build/cuda", 0, [&] { return of(pairs(on, tree_a, make_bvh(on, b)).size()); });
    out.add("one_sided/pairs/cuda", 0, [&] { return of(pairs(on, tree_a, b).size()); });
}

void add_near(const abut::cuda& on, table& out, const meshes_scene::surface& a) {
    const device_mesh mesh(on, a.vertices, a.faces);
    const auto tree = make_bvh(on, mesh);
    const auto box = tree.bounds();
    const abut::vec3<float> size = box.upper - box.lower;
    std::vector<abut::vec3<float>> moved;
    for (const auto& p : a.vertices)
        moved.push_back(p + abut::vec3<float>{.0003f * size.x, .0002f * size.y, .0001f * size.z});
    const auto other = make_bvh(on, device_mesh(on, moved, a.faces));
    const abut::query_options<refuse_all> none{.filter = {0xffffffff}};
    out.add("near/pairs/cuda", 0, [&] { return of(pairs(on, tree, other).size()); });
    out.add("near/unsorted/cuda", 0, [&] { return of(pairs(on, tree, other, {.sorted = false}).size()); });
    out.add("near/fast/cuda", 0, [&] { return of(abut::count<abut::fast>(on, tree, other)); });
    out.add("near/count/cuda", 0, [&] { return of(count(on, tree, other)); });
    out.add("near/boxes/cuda", 0, [&] { return of(count(on, tree, other, none)); });
}

void add_builds(const abut::cuda& on, table& out, const device_mesh& mesh) {
    const std::string n = std::to_string(mesh.size());
    out.add(joined({"build/bvh/cuda", n}), 0, [&] { return of(make_bvh(on, mesh).size()); });
    abut::execution::buffer_of<abut::cuda, std::uint32_t> keys(on, mesh.size()), values(on, mesh.size());
    std::vector<std::uint32_t> codes(mesh.size());
    std::uint32_t state = 1;
    for (auto& c : codes) c = state = state * 1664525u + 1013904223u;
    upload(on, codes.data(), codes.size(), keys.data());
    out.add(joined({"sort/cuda", n}), 0, [&] {
        sort_by_key(on, keys, values, 32);
        return counters{};
    });
}

/// n small triangles in a unit cube, each with vertices of its own.
device_mesh random_mesh(const abut::cuda& on, std::size_t n) {
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
    std::uint64_t state = 1;
    const auto next = [&state] {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<float>(state >> 40) * 0x1p-24f;
    };
    for (std::uint32_t i = 0; i < n; ++i) {
        const abut::vec3<float> at{next(), next(), next()};
        for (int k = 0; k < 3; ++k) vertices.push_back(at + 0.004f * abut::vec3<float>{next(), next(), next()});
        faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return device_mesh(on, vertices, faces);
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_meshes_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const auto pair =
            meshes_scene::make_pair(argc > 2 ? meshes_scene::read_surface(argv[2]) : meshes_scene::unit_torus());
        add_pair(on, out, pair);
        add_near(on, out, pair.a);
        add_builds(on, out, device_mesh(on, pair.a.vertices, pair.a.faces));
        add_builds(on, out, random_mesh(on, 10'000'000));
    });
}
