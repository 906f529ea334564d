// SPDX-License-Identifier: MIT
//
// usage: bench_turning_cuda DATA [OUT.json]
//
// bench/turning.cpp on CUDA: 10,000 motions of each kind in one call. Names:
//
//   KIND/cuda        first_meetings, of trees by ploc; met: how many meet; differ: of the first 1,000 answers those that are not the host's, bit for bit
//   KIND/cuda_any    the yes or no alone
//
// Each figure is the median of 21 runs (fewer of long ones), taken with CUDA events around the whole call.

#include <cstddef>
#include <string>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/collide/turning.hpp>

#include "cuda_table.hpp"
#include "mesh_file.hpp"
#include "turning_scene.hpp"

int main(int argc, char** argv) {
    const std::string data = argc > 1 ? argv[1] : ".";
    if (argc > 1) argv[1] = argv[0], ++argv, --argc;
    return bench::run("bench_turning_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const auto robot = bench::read_surface<turning_scene::surface>(data + "/meshes/rob.obj"),
                   room = bench::read_surface<turning_scene::surface>(data + "/meshes/env.obj");
        const abut::serial host;
        using mesh = abut::mesh<float>;
        using device_mesh = abut::mesh<float, abut::device_space>;
        const abut::bvh_options how{.builder = abut::bvh_builder::ploc};
        const auto host_robot = make_bvh(host, mesh(robot.vertices, robot.faces), how),
                   host_room = make_bvh(host, mesh(room.vertices, room.faces), how);
        const auto device_robot = make_bvh(on, device_mesh(on, robot.vertices, robot.faces), how),
                   device_room = make_bvh(on, device_mesh(on, room.vertices, room.faces), how);
        for (const auto& of : turning_scene::kinds) {
            const auto motions = turning_scene::motions_of(of, host_robot, host_room, 10000);
            const auto list = turning_scene::pairs_of(motions, device_robot, device_room);
            const std::vector<turning_scene::motion> few(motions.begin(), motions.begin() + 1000);
            const auto expected = to_host(first_meetings(host, turning_scene::pairs_of(few, host_robot, host_room), {turning_scene::tolerance}));
            const auto found = to_host(first_meetings(on, list, {turning_scene::tolerance}));
            double met = 0, differ = 0;
            for (std::size_t i = 0; i < found.size(); ++i) met += found[i].a != abut::no_id;
            for (std::size_t i = 0; i < expected.size(); ++i) differ += !(found[i] == expected[i]);
            const std::string kind = of.name;
            out.add(kind + "/cuda", 0, [&] {
                (void)first_meetings(on, list, {turning_scene::tolerance});
                return bench::counters{{"items", static_cast<double>(list.size())}, {"met", met}, {"differ", differ}};
            });
            out.add(kind + "/cuda_any", 0, [&] {
                (void)any_each(on, list, {turning_scene::tolerance});
                return bench::counters{{"items", static_cast<double>(list.size())}};
            });
        }
    });
}
