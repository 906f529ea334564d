// SPDX-License-Identifier: MIT
//
// usage: bench_bodies_cuda [OUT.json]
//
// bench/bodies.cpp on CUDA, with 10,000 and 100,000 bodies: the same scene and the same names, policy cuda. Poses of the
// next step are on the device, but in `refit_from_host` and `list`. Each figure is the median of 21 runs after two that are
// not counted, taken with CUDA events around the whole call. The floor is what has to be read and written at least once: the
// poses, boxes and nodes of bodies, the pairs of bodies whose boxes meet, and the results.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <abut/cuda.hpp>

#include "bodies_scene.hpp"
#include "cuda_table.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;
using index_type = decltype(abut::make_bvh(abut::cuda{}, bodies_scene::shape(0)));

std::vector<index_type> make_indices(const abut::cuda& on, abut::bvh_builder builder) {
    std::vector<index_type> made;
    for (std::size_t k = 0; k < bodies_scene::kinds; ++k) {
        made.push_back(abut::make_bvh(on, bodies_scene::shape(k), {.builder = builder}));
    }
    return made;
}

void add(const abut::cuda& on, std::size_t n, table& out) {
    const auto indices = make_indices(on, abut::bvh_builder::linear);
    const auto scene = bodies_scene::make(n);
    const auto all = abut::make_bodies(on, indices, scene.kind, scene.now);
    abut::execution::buffer_of<abut::cuda, abut::rigid<float>> there(on, n);
    upload(on, scene.later.data(), n, there.data());
    synchronize(on);
    const abut::poses_view<float, abut::device_space> later{there.data(), n};
    std::vector<abut::posed_object<index_type>> list;
    for (std::size_t i = 0; i < n; ++i) list.push_back(abut::posed(indices[scene.kind[i]], scene.now[i]));

    const double bodies = static_cast<double>(n), near = static_cast<double>(bodies_scene::near(on, all));
    const double found = static_cast<double>(abut::count(on, all));
    const double of_bodies = 48.0 + 4.0, boxes_and_nodes = 24.0 + 64.0;
    const double least_refit = (2 * 48.0 + of_bodies + 2 * boxes_and_nodes) * bodies;
    const double least_near = boxes_and_nodes * bodies + 8.0 * near;
    const double least_count = least_near + of_bodies * bodies, least_pairs = least_count + 16.0 * found;
    const auto row = [&](const char* name, double least, const auto& work) {
        out.add(joined({"bodies", name, "cuda", std::to_string(n)}), least, [&] {
            const double items = static_cast<double>(work());
            return counters{{"near", near}, {"pairs", found}, {"items", items}};
        });
    };
    row("build", least_refit, [&] { return abut::make_bodies(on, indices, scene.kind, scene.now).size(); });
    row("refit", least_refit, [&] { return abut::refit(on, all, later).size(); });
    row("refit_from_host", least_refit, [&] { return abut::refit(on, all, scene.later).size(); });
    row("near", least_near, [&] { return bodies_scene::near(on, all); });
    row("pairs", least_pairs, [&] { return abut::pairs(on, all).size(); });
    row("unsorted", least_pairs, [&] { return abut::pairs(on, all, {.sorted = false}).size(); });
    row("count", least_count, [&] { return abut::count(on, all); });
    row("any", 0, [&] { return static_cast<std::size_t>(abut::any(on, all)); });
    row("contacts", least_count + 44.0 * found, [&] { return abut::contacts(on, all).size(); });
    row("list", least_pairs, [&] { return abut::pairs(on, list).size(); });
    row("frame", least_refit + least_pairs, [&] { return abut::pairs(on, abut::refit(on, all, later)).size(); });
    const abut::body_options<abut::keep_all, abut::schedule::lazy_work_stealing> stealing;
    row("stealing", least_pairs, [&] { return abut::pairs(on, all, stealing).size(); });
    row("fast", least_pairs, [&] { return abut::pairs<abut::fast>(on, all).size(); });
    const auto joined_up = abut::make_bodies(on, make_indices(on, abut::bvh_builder::ploc), scene.kind, scene.now);
    row("ploc", least_pairs, [&] { return abut::pairs(on, joined_up).size(); });
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_bodies_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        add(on, 10'000, out);
        add(on, 100'000, out);
    });
}
