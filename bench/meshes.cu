// SPDX-License-Identifier: MIT
//
// usage: bench_meshes_cuda [OUT.json [MESH [SMALL]]]
//
// bench/meshes.cpp on CUDA: the same pair of meshes (MESH, PLY or OBJ, or a torus of 345,744 triangles) and the same names,
// policy cuda, all data resident before the clock starts; and
//
//   pairs/baked_with_build/cuda          one of the trees built in the call
//   traversal/NAME/cuda                  unsorted/baked by each traversal but the default; breadth first with its depth
//   near/WHAT/cuda                       the mesh against its copy moved by (.0003, .0002, .0001) of its box: pairs, and
//                                        boxes, the walk of both trees with a filter that refuses every pair
//   batch/N/cuda                         N posed pairs of a small mesh in one call (SMALL, or a torus of 2,700 triangles)
//   contacts/KIND/cuda                   contacts of the pair
//   build/bvh/cuda/N, sort/cuda/N        a tree over N triangles, and the sort of 32-bit codes alone that is in it
//
// Each figure is the median of 21 runs, taken with CUDA events around the whole call, so what the host does between kernels
// is in it.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/experimental/breadth_first.hpp>
#include <abut/experimental/descent_rules.hpp>

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

template <abut::traversal Traversal, class Tree>
void add_traversal(const abut::cuda& on, table& out, const std::string& name, const Tree& a, const Tree& b,
                   int start_depth = 0) {
    const abut::query_options<abut::keep_all, Traversal> options{.sorted = false, .start_depth = start_depth};
    out.add(joined({"traversal", name, "cuda"}), 0, [&] { return of(pairs(on, a, b, options).size()); });
}

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
    using enum abut::traversal;
    add_traversal<one_first>(on, out, "one_first", tree_a, tree_b);
    add_traversal<larger_first>(on, out, "larger_first", tree_a, tree_b);
    add_traversal<alternate>(on, out, "alternate", tree_a, tree_b);
    for (const int depth : {0, 4, 6, 8}) {
        add_traversal<breadth_first>(on, out, joined({"breadth_first", std::to_string(depth)}), tree_a, tree_b, depth);
    }
    add_queries("posed", posed(tree_a, pair.pose));
    out.add("contacts/baked/cuda", 0, [&] { return of(contacts(on, tree_a, tree_b).size()); });
    out.add("contacts/posed/cuda", 0, [&] { return of(contacts(on, tree_a, posed(tree_a, pair.pose)).size()); });
    out.add("pairs/baked_with_build/cuda", 0, [&] { return of(pairs(on, tree_a, make_bvh(on, b)).size()); });
    out.add("one_sided/pairs/cuda", 0, [&] { return of(pairs(on, tree_a, b).size()); });
}

/// Pairs of one mesh and itself, a third to nine tenths of its size apart, turned at random.
void add_batch(const abut::cuda& on, table& out, const meshes_scene::surface& small) {
    const auto tree = make_bvh(on, device_mesh(on, small.vertices, small.faces));
    const auto box = tree.bounds();
    const abut::vec3<float> size = box.upper - box.lower, middle = 0.5f * (box.lower + box.upper);
    abut::test::uniform next(1);
    std::vector<abut::posed_pair<std::remove_const_t<decltype(tree)>>> list;
    for (int i = 0; i < 1000; ++i) {
        const double turn = 6.28 * next(), c = std::cos(turn), s = std::sin(turn), far = 0.3 + 0.6 * next();
        abut::rigid<float> pose;
        pose.rotation[0] = pose.rotation[4] = static_cast<float>(c);
        pose.rotation[3] = static_cast<float>(s);
        pose.rotation[1] = -pose.rotation[3];
        const abut::vec3<float> turned{pose.rotation[0] * middle.x + pose.rotation[1] * middle.y,
                                       pose.rotation[3] * middle.x + pose.rotation[4] * middle.y, middle.z};
        pose.translation = middle - turned + abut::vec3<float>{static_cast<float>(far) * size.x, 0, 0};
        list.push_back({posed(tree, {}), posed(tree, pose)});
    }
    for (const std::size_t n : {1u, 10u, 100u, 1000u}) {
        const std::vector part(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n));
        out.add(joined({"batch", std::to_string(n), "cuda"}), 0, [&] { return of(pairs(on, part).size()); });
    }
    out.add("batch/1000/one_by_one/cuda", 0, [&] {
        std::size_t found = 0;
        for (const auto& entry : list) found += pairs(on, entry.a, entry.b).size();
        return of(found);
    });
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
    abut::test::uniform random(1);
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto at = random.point<float>(0, 1);
        for (int k = 0; k < 3; ++k) vertices.push_back(at + random.point<float>(0, 0.004));
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
        const abut::test::torus<float> torus(45, 30, 0.35, 0.15);
        add_batch(on, out,
                  argc > 3 ? meshes_scene::read_surface(argv[3]) : meshes_scene::surface{torus.vertices, torus.faces});
        add_builds(on, out, device_mesh(on, pair.a.vertices, pair.a.faces));
        add_builds(on, out, random_mesh(on, 10'000'000));
    });
}
