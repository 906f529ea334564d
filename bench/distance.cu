// SPDX-License-Identifier: MIT
//
// usage: bench_distance_cuda [--meshes=FOLDER] [OUT.json]
//
// bench/distance.cpp on CUDA: the same scenes, float, the trees resident on the device. Names:
//
//   distance/SCENE/KIND/bvh             each pose in a call of its own; ms of all poses
//   distance/SCENE/KIND/list            all poses in one call
//   distance/SCENE/KIND/oriented        as bvh, with trees of oriented boxes
//   distance/SCENE/KIND/oriented_list   as list, with these
//
// Each figure is the median of 21 runs after two that are not counted (fewer of long ones), taken with CUDA events around
// the whole call.

#include <cstring>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "distance_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;
using distance_scene::pose;
using distance_scene::scene;

using device_mesh = abut::mesh<float, abut::device_space>;

/// The rows of trees of one kind: `each` of a call for each pose, `all` of one for all of them.
template <class Tree>
void add(const abut::cuda& on, const scene& s, const Tree& a, const Tree& b, const char* each, const char* all, table& out) {
    const auto add_kind = [&](const char* kind, const std::vector<pose>& poses) {
        if (poses.empty()) return;
        const auto n = static_cast<double>(poses.size());
        out.add(joined({"distance", s.name, kind, each}), 0, [&] {
            double sum = 0;
            for (const pose& p : poses) sum += static_cast<double>(abut::distance(on, a, posed(b, p))->distance);
            return counters{{"poses", n}, {"mean_distance", sum / n}};
        });
        std::vector<abut::posed_pair<Tree>> list;
        for (const pose& p : poses) list.push_back({posed(a, pose{}), posed(b, p)});
        out.add(joined({"distance", s.name, kind, all}), 0, [&] {
            return counters{{"poses", static_cast<double>(abut::distance(on, list).size())}};
        });
    };
    add_kind("apart", s.apart);
    add_kind("touching", s.touching);
}

void add(const abut::cuda& on, const scene& s, table& out) {
    const auto a = make_bvh(on, device_mesh(on, s.a.vertices, s.a.faces)),
               b = make_bvh(on, device_mesh(on, s.b.vertices, s.b.faces));
    add(on, s, a, b, "bvh", "list", out);
    add(on, s, oriented(on, a), oriented(on, b), "oriented", "oriented_list", out);
}

}  // namespace

int main(int argc, char** argv) {
    std::string folder;
    if (argc > 1 && std::strncmp(argv[1], "--meshes=", 9) == 0) {
        folder = argv[1] + 9;
        argv[1] = argv[0];
        ++argv, --argc;
    }
    return bench::run("bench_distance_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        for (const scene& s : distance_scene::make_scenes(folder)) add(on, s, out);
    });
}
