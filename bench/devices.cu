// SPDX-License-Identifier: MIT
//
// usage: bench_devices_cuda [OUT.json]
//
// Scenes on several devices: `cuda` alone, cuda_devices of that one device, of that device named twice, which shows what
// sharing out costs, and of all devices if there are several. The scene of spheres (trees, look_up, divided), 100,000 bodies
// (bodies), and a torus that moves through another (impacts). All data is resident on the devices before the clock starts.
// Each figure is the median of 21 runs after two that are not counted, taken with CUDA events of the first device around the
// whole call. The floor is what has to be read and written at least once. Row `devices` has the number of all devices.

#include <cstddef>
#include <string>
#include <vector>

#include <abut/cuda_devices.hpp>

#include "../docs/examples/scene.hpp"
#include "bodies_scene.hpp"
#include "cuda_table.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;

/// The queries of trees, or of what is divided, by one policy or by several.
template <class Policy, class A, class B>
void add(const Policy& on, const char* name, const char* policy, const A& a, const B& b, double bytes, table& out) {
    const auto found = [](std::size_t n) { return counters{{"pairs", static_cast<double>(n)}}; };
    out.add(joined({"devices", "pairs", name, policy}), bytes, [&] { return found(abut::pairs(on, a, b).size()); });
    out.add(joined({"devices", "count", name, policy}), bytes, [&] { return found(abut::count(on, a, b)); });
}

template <class Policy, class Bodies>
void add_bodies(const Policy& on, const char* policy, const Bodies& all, table& out) {
    out.add(joined({"devices", "pairs", "bodies", policy}), 0, [&] {
        return counters{{"pairs", static_cast<double>(abut::pairs(on, all).size())}};
    });
}
template <class Policy, class A, class B>
void add_impacts(const Policy& on, const char* policy, const A& a, const B& b, table& out) {
    out.add(joined({"devices", "impacts", "tori", policy}), 0, [&] {
        return counters{{"impacts", static_cast<double>(abut::impacts(on, a, b).size())}};
    });
}

/// A torus that goes along y by a part of its tube during the step.
abut::moving_set<abut::mesh<float>> torus_in_motion(const scene::surface<float>& at_t0) {
    auto at_t1 = at_t0.vertices;
    for (auto& p : at_t1) p.y += static_cast<float>(scene::torus_minor_radius / 8);
    const abut::mesh<float> first(at_t0.vertices, at_t0.faces);
    return abut::moving(first, first.with_vertices(abut::serial{}, at_t1));
}
/// The same surface upright, and beside it, so that the two touch.
scene::surface<float> upright(scene::surface<float> all) {
    for (auto& p : all.vertices) p = {p.x + static_cast<float>(0.7 * scene::torus_major_radius), p.z, -p.y};
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_devices_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        const auto surface = scene::torus<float>();
        const abut::mesh<float> mesh(surface.vertices, surface.faces);
        const abut::equal_spheres<float> balls(scene::centers<float>(scene::sphere_count),
                                               static_cast<float>(scene::radius));
        const auto there = abut::copy_to(on, mesh);
        const auto balls_there = abut::copy_to(on, balls);
        const auto mesh_tree = abut::make_bvh(on, there);
        const auto ball_tree = abut::make_bvh(on, balls_there);
        const double bytes = static_cast<double>(mesh_tree.bytes()) + 12.0 * static_cast<double>(balls.size());
        add(on, "trees", "cuda", mesh_tree, ball_tree, bytes, out);
        add(on, "look_up", "cuda", mesh_tree, balls_there, bytes, out);

        const auto bodies = bodies_scene::make(100'000);
        std::vector<decltype(abut::make_bvh(on, bodies_scene::shape(0)))> kinds;
        for (std::size_t k = 0; k < bodies_scene::kinds; ++k) kinds.push_back(abut::make_bvh(on, bodies_scene::shape(k)));
        add_bodies(on, "cuda", abut::make_bodies(on, kinds, bodies.kind, bodies.now), out);
        const auto goes = torus_in_motion(surface);
        const auto other = upright(surface);
        const abut::mesh<float> stands(other.vertices, other.faces);
        add_impacts(on, "cuda", abut::make_impact_index(on, goes), abut::make_impact_index(on, stands), out);

        std::vector<std::vector<int>> lists{{0}, {0, 0}};
        const abut::cuda_devices all;
        out.note("devices", {{"count", static_cast<double>(all.size())}});
        std::vector<int> numbers;
        for (int k = 0; k < all.size(); ++k) numbers.push_back(k);
        if (all.size() > 1) lists.push_back(numbers);
        const char* const names[] = {"one_device", "one_named_twice", "all_devices"};
        for (std::size_t k = 0; k < lists.size(); ++k) {
            const abut::cuda_devices team(lists[k]);
            const auto copies = abut::make_bvh(team, mesh);
            add(team, "trees", names[k], copies, abut::make_bvh(team, balls), bytes, out);
            add(team, "look_up", names[k], copies, abut::replicate(team, balls), bytes, out);
            add(team, "divided", names[k], abut::make_bvh(team, abut::divide(team, mesh)),
                abut::make_bvh(team, abut::divide(team, balls)), bytes, out);
            std::vector<abut::replicated<decltype(kinds)::value_type>> kinds_there;
            for (std::size_t i = 0; i < bodies_scene::kinds; ++i) {
                kinds_there.push_back(abut::make_bvh(team, bodies_scene::shape(i)));
            }
            add_bodies(team, names[k], abut::make_bodies(team, kinds_there, bodies.kind, bodies.now), out);
            add_impacts(team, names[k], abut::make_impact_index(team, goes), abut::make_impact_index(team, stands), out);
        }
    });
}
