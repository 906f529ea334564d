// SPDX-License-Identifier: MIT
//
// usage: bench_arm_cuda [OUT.json]
//
// Which of 10,000 states of an arm collide (bench/peers/arm.hpp) on CUDA: in the room, and with the mesh. Links are placed before the
// clock starts. Names:
//
//   states/SCENE/cuda    any_each of all capsules, and of all boxes; collide: states that do; wrong: of these and the others, by exact
//
// Each figure is the median of 21 runs, taken with CUDA events around both calls.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "peers/arm.hpp"
#include "peers/draws.hpp"

namespace {

template <class HostIndex, class Index>
void add_states(const abut::cuda& on, bench::table& out, const std::string& name, const peers::arm_scene& arm, const HostIndex& host_index,
                const Index& index) {
    std::vector<abut::capsule<double>> capsules;
    std::vector<abut::oriented_box<double>> boxes;
    for (const auto& state : arm.poses) {
        for (std::size_t k = 0; k < state.size(); k += 2) {
            capsules.push_back(peers::capsule_of(arm.links[k], state[k]));
            boxes.push_back(peers::box_of(arm.links[k + 1], state[k + 1]));
        }
    }
    const auto per_state = arm.links.size() / 2;
    const bool in_room = arm.faces.empty();
    const auto options = [&](std::size_t first) {
        return abut::each_options<peers::allowed_links>{{first, per_state, in_room}, per_state};
    };
    const abut::shapes<abut::capsule<double>> host_capsules(capsules);
    const abut::shapes<abut::oriented_box<double>> host_boxes(boxes);
    const abut::serial host;
    const auto right_a = abut::any_each<abut::exact>(host, host_index, host_capsules, options(0)),
               right_b = abut::any_each<abut::exact>(host, host_index, host_boxes, options(1));
    const abut::shapes<abut::capsule<double>, abut::device_space> there_capsules(on, capsules);
    const abut::shapes<abut::oriented_box<double>, abut::device_space> there_boxes(on, boxes);
    const auto found_a = to_host(abut::any_each(on, index, there_capsules, options(0))),
               found_b = to_host(abut::any_each(on, index, there_boxes, options(1)));
    double collide = 0, wrong = 0;
    for (std::size_t i = 0; i < right_a.size(); ++i) {
        collide += right_a[i] || right_b[i];
        wrong += (right_a[i] != found_a[i]) + (right_b[i] != found_b[i]);
    }
    out.add("states/" + name + "/cuda", 0, [&] {
        (void)abut::any_each(on, index, there_capsules, options(0));
        (void)abut::any_each(on, index, there_boxes, options(1));
        return bench::counters{{"items", static_cast<double>(arm.poses.size())}, {"collide", collide}, {"wrong", wrong}};
    });
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_arm_cuda", argc, argv, [&](const abut::cuda& on, bench::table& out) {
        const abut::serial host;
        const abut::bvh_options how{.builder = abut::bvh_builder::ploc};
        peers::draws d;
        const auto in_room = peers::make_arm(d, 10000, false), at_mesh = peers::make_arm(d, 10000, true);
        add_states(on, out, "room", in_room, make_bvh(host, abut::oriented_boxes<double>(in_room.room), how),
                   make_bvh(on, abut::oriented_boxes<double, abut::device_space>(on, in_room.room), how));
        add_states(on, out, "mesh", at_mesh, make_bvh(host, abut::mesh<double>(at_mesh.vertices, at_mesh.faces), how),
                   make_bvh(on, abut::mesh<double, abut::device_space>(on, at_mesh.vertices, at_mesh.faces), how));
    });
}
