// SPDX-License-Identifier: MIT
//
// usage: bench_distance [--meshes=FOLDER] --benchmark_enable_random_interleaving=true --benchmark_out=distance.json
//
// How far apart two meshes are, in many poses (bench/distance_scene.hpp). Names:
//
//   distance/SCENE/KIND/bvh              two linear trees on one core, float
//   distance/SCENE/KIND/oriented         oriented trees, of trees by surface area
//   distance/SCENE/KIND/oriented_double  the same in double
//   distance/SCENE/KIND/oriented_openmp  in float, on all cores
//   distance/SCENE/KIND/any              whether anything touches, for comparison: of the oriented trees, one core
//
// KIND is apart or touching; a row is the time of all poses of its kind. The peers (bench/distance/) are in the same run,
// where their packages are there.

#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "distance/peer.hpp"
#include "google.hpp"

namespace {

using distance_peer::pose;
using distance_peer::scene;

template <class T>
abut::mesh<T> mesh_in(const distance_scene::surface& s) {
    std::vector<abut::vec3<T>> vertices;
    for (const auto& v : s.vertices) vertices.push_back({T(v.x), T(v.y), T(v.z)});
    return {vertices, s.faces};
}
template <class T>
abut::rigid<T> pose_in(const pose& p) {
    abut::rigid<T> q;
    for (int i = 0; i < 9; ++i) q.rotation[i] = T(p.rotation[i]);
    q.translation = {T(p.translation.x), T(p.translation.y), T(p.translation.z)};
    return q;
}

template <class T, class Policy>
auto oriented_tree(const Policy& on, const distance_scene::surface& s) {
    return oriented(on, make_bvh(on, mesh_in<T>(s), {.builder = abut::bvh_builder::sah, .least_ids = true}));
}

template <class T, class Policy, class Tree>
void add(const scene& s, const char* name, const Policy& on, const Tree& a, const Tree& b) {
    distance_peer::add(s, name, [=](const pose& p) {
        return static_cast<double>(abut::distance(on, a, posed(b, pose_in<T>(p)))->distance);
    });
}

}  // namespace

int main(int argc, char** argv) {
    std::string folder;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument.rfind("--meshes=", 0) != 0) continue;
        folder = argument.substr(9);
        for (int k = i--; k < argc; ++k) argv[k] = argv[k + 1];
        --argc;
    }
    const std::vector<scene> scenes = distance_scene::make_scenes(folder);
    const abut::serial on;
    for (const scene& s : scenes) {
        const abut::bvh_options keeping{.least_ids = true};  // one tree is asked in all poses
        add<float>(s, "bvh", on, make_bvh(on, mesh_in<float>(s.a), keeping), make_bvh(on, mesh_in<float>(s.b), keeping));
        const auto a = oriented_tree<float>(on, s.a), b = oriented_tree<float>(on, s.b);
        add<float>(s, "oriented", on, a, b);
        add<double>(s, "oriented_double", on, oriented_tree<double>(on, s.a), oriented_tree<double>(on, s.b));
        add<float>(s, "oriented_openmp", abut::openmp{}, a, b);
        distance_peer::add(s, "any", [=](const pose& p) { return abut::any(on, a, posed(b, p)) ? 1.0 : 0.0; });
        for (const auto& peer : distance_peer::peers()) peer(s);
    }
    return bench::run_registered("bench_distance", argc, argv);
}
