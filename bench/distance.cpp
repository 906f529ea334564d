// SPDX-License-Identifier: MIT
//
// usage: bench_distance [--meshes=FOLDER] --benchmark_enable_random_interleaving=true --benchmark_out=distance.json
//
// How far apart two meshes are, in many poses (bench/distance_scene.hpp). Names:
//
//   distance/SCENE/KIND/bvh       two linear trees on one core, float
//   distance/SCENE/KIND/sah       trees by surface area
//   distance/SCENE/KIND/double    linear trees, in double
//   distance/SCENE/KIND/openmp    linear trees, on all cores
//   distance/SCENE/KIND/list      all poses in one call, one core
//
// KIND is apart or touching; a row is the time of all poses of its kind. The peers (bench/distance/) are in the same run, where
// their packages are there.

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
void add(const scene& s, const char* name, const Policy& on, abut::bvh_builder builder = abut::bvh_builder::linear) {
    const abut::bvh_options options{.builder = builder};
    distance_peer::add(s, name,
                       [on, a = make_bvh(on, mesh_in<T>(s.a), options), b = make_bvh(on, mesh_in<T>(s.b), options)](const pose& p) {
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
    for (const scene& s : scenes) {
        add<float>(s, "bvh", abut::serial{});
        add<float>(s, "sah", abut::serial{}, abut::bvh_builder::sah);
        add<double>(s, "double", abut::serial{});
        add<float>(s, "openmp", abut::openmp{});
        for (const auto& peer : distance_peer::peers()) peer(s);
    }
    return bench::run_registered("bench_distance", argc, argv);
}
