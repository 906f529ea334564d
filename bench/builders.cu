// SPDX-License-Identifier: MIT
//
// usage: bench_builders_cuda [OUT.json [MESH]]
//
// Trees on a device, over a mesh (PLY or OBJ; without one a torus of 345,744 triangles) and over 10 million random
// triangles. Names:
//
//   build/SCENE             make_bvh, linear
//   build/ploc/SCENE        the same by bvh_builder::ploc
//   build_and_refit_first/SCENE   and the first refit of the topology, which derives its plan
//   refit/SCENE             any later one, around other shapes
//   convert/LAYOUT/SCENE    a tree in another layout
//   pairs/LAYOUT            the mesh against a turned copy of itself (bench/meshes_scene.hpp), sorted, both in the layout
//   pairs/ploc              the same, both built by ploc, in the standard layout

#include <cstdint>
#include <string>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/experimental/leafless.hpp>

#include "cuda_table.hpp"
#include "meshes_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;
namespace scene = meshes_scene;

/// `shape_bytes` is what a shape takes to be read.
template <class Set>
void add_builds(const abut::cuda& on, table& out, const std::string& name, const Set& set, const Set& moved,
                double shape_bytes) {
    const double n = static_cast<double>(set.size());
    const counters items{{"items", n}};
    out.add(joined({"build", name}), 0, [&] {
        if (make_bvh(on, set).size() != set.size()) throw abut::error("build");
        return items;
    });
    out.add(joined({"build/ploc", name}), 0, [&] {
        if (make_bvh(on, set, {.builder = abut::bvh_builder::ploc}).size() != set.size()) throw abut::error("build");
        return items;
    });
    const auto tree = make_bvh(on, set);
    out.add(joined({"build_and_refit_first", name}), 0, [&] {
        (void)refit(on, make_bvh(on, set), moved);
        return items;
    });
    (void)refit(on, tree, moved);
    // Shapes, their order and the steps are read, and nodes written.
    out.add(joined({"refit", name}),
            n * (shape_bytes + sizeof(std::uint32_t) + sizeof(abut::refit_step) + sizeof(abut::bvh_node<float>)), [&] {
                (void)refit(on, tree, moved);
                return items;
            });
    out.add(joined({"convert/quantised", name}), n * 96, [&] {
        (void)quantised(on, tree);
        return items;
    });
    out.add(joined({"convert/leafless", name}), n * 96, [&] {
        (void)leafless(on, tree);
        return items;
    });
}

template <class Tree>
void add_pairs(const abut::cuda& on, table& out, const std::string& name, const Tree& a, const Tree& b) {
    const abut::bvh_quality q = quality(on, a);
    out.add(joined({"pairs", name}), 0, [&] {
        return counters{{"pairs", static_cast<double>(pairs(on, a, b).size())},
                        {"sah_cost", q.sah_cost},
                        {"bytes_per_shape", q.bytes_per_shape}};
    });
}

abut::triangle_soup<float> random_soup(std::size_t n, std::uint64_t seed) {
    abut::test::uniform random(seed);
    std::vector<abut::triangle<float>> triangles(n);
    for (auto& t : triangles) {
        const auto p = random.point<float>(-1, 1);
        const auto corner = [&] { return p + random.point<float>(-0.002, 0.002); };
        t.a = corner();
        t.b = corner();
        t.c = corner();
    }
    return abut::triangle_soup<float>(triangles);
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_builders_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const scene::mesh_pair pair = scene::make_pair(argc < 3 ? scene::unit_torus() : scene::read_surface(argv[2]));
        const auto a = copy_to(on, abut::mesh<float>(pair.a.vertices, pair.a.faces));
        const auto b = copy_to(on, abut::mesh<float>(pair.b.vertices, pair.b.faces));
        add_builds(on, out, "mesh", a, b, 12 + 6);  // three indices, and half a vertex
        const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
        add_pairs(on, out, "standard", tree_a, tree_b);
        add_pairs(on, out, "quantised", quantised(on, tree_a), quantised(on, tree_b));
        add_pairs(on, out, "leafless", leafless(on, tree_a), leafless(on, tree_b));
        const abut::bvh_options by_ploc{.builder = abut::bvh_builder::ploc};
        add_pairs(on, out, "ploc", make_bvh(on, a, by_ploc), make_bvh(on, b, by_ploc));
        add_builds(on, out, "random", copy_to(on, random_soup(10'000'000, 1)), copy_to(on, random_soup(10'000'000, 2)), 36);
    });
}
