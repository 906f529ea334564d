// SPDX-License-Identifier: MIT
//
// usage: bench_schedules_cuda [OUT.json [MESH]]
//
// Schedules of the walk of two trees on CUDA (execution/schedule.hpp), count of pairs, all data resident:
//
//   SCENE/SCHEDULE/all             as many blocks as the device holds
//   SCENE/SCHEDULE/half, quarter, eighth
//                                  that part of them: how a schedule scales. Blocks are spread over all multiprocessors
//
// Scenes: `turned`, a mesh (MESH, PLY or OBJ, or a torus of 345,744 triangles) against a turned copy; `near`, the mesh
// against its copy moved by (.0003, .0002, .0001) of its box, where there is work everywhere; `corner`, two soups of 100,000
// triangles that hardly meet and 10,000 in one corner that do; `list`, 1,000 posed pairs of a torus of 2,700 triangles.
// Beside the time: what the schedule reports of itself in the last run.

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/experimental/cuda_work_stealing.hpp>

#include "cuda_table.hpp"
#include "meshes_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;
using device_mesh = abut::mesh<float, abut::device_space>;
using device_soup = abut::triangle_soup<float, abut::device_space>;

counters counters_of(std::uint64_t pairs, const abut::schedule_report& r) {
    const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
    return {{"pairs", number(pairs)},
            {"workers", number(r.workers)},
            {"steps", number(r.steps)},
            {"items", number(r.items)},
            {"steals", number(r.steals)},
            {"stolen", number(r.stolen)},
            {"failed", number(r.failed_steals)},
            {"offers", number(r.offers)},
            {"transfers", number(r.transfers)},
            {"overflows", number(r.overflows)},
            {"rounds", number(r.rounds)},
            {"balances", number(r.balances)},
            {"idle_share", r.idle_share}};
}

/// `ask` answers a query by options of a schedule.
template <class Ask>
void add_scaling(table& out, const std::string& name, const Ask& ask) {
    abut::schedule_report report;
    (void)ask(abut::schedule_options{.report = &report});
    const auto all = static_cast<std::uint32_t>(report.workers);
    const struct {
        const char* name;
        std::uint32_t part;
    } parts[] = {{"all", 1}, {"half", 2}, {"quarter", 4}, {"eighth", 8}};
    for (const auto& p : parts) {
        const std::uint32_t blocks = all / p.part > 0 ? all / p.part : 1;
        const std::uint64_t found = ask(abut::schedule_options{.most_blocks = blocks, .report = &report});
        const counters says = counters_of(found, report);
        out.add(joined({name, p.name}), 0, [&] {  // without a report, which costs a wait of its own
            (void)ask(abut::schedule_options{.most_blocks = blocks});
            return says;
        });
    }
}

template <abut::schedule Schedule, class A, class B>
void add_pair(const abut::cuda& on, table& out, const std::string& name, const A& a, const B& b) {
    add_scaling(out, name, [&](const abut::schedule_options& scheduling) {
        using options = abut::query_options<abut::keep_all, abut::traversal::both_at_once, Schedule>;
        return count(on, a, b, options{.scheduling = scheduling});
    });
}
template <abut::schedule Schedule, class List>
void add_list(const abut::cuda& on, table& out, const std::string& name, const List& list) {
    add_scaling(out, name, [&](const abut::schedule_options& scheduling) {
        return count(on, list, abut::list_options<abut::keep_all, Schedule>{.scheduling = scheduling});
    });
}

template <class Add>
void for_each_schedule(const Add& add) {
    using enum abut::schedule;
    add(std::integral_constant<abut::schedule, shared_list>{}, "shared_list");
    add(std::integral_constant<abut::schedule, static_partition>{}, "static_partition");
    add(std::integral_constant<abut::schedule, work_stealing>{}, "work_stealing");
    add(std::integral_constant<abut::schedule, lazy_work_stealing>{}, "lazy_work_stealing");
}

template <class A, class B>
void add_scene(const abut::cuda& on, table& out, const std::string& name, const A& a, const B& b) {
    for_each_schedule([&](auto chosen, const char* schedule) {
        add_pair<decltype(chosen)::value>(on, out, joined({name, schedule}), a, b);
    });
}

device_soup corner_soup(const abut::cuda& on, abut::test::uniform& random) {
    std::vector<abut::triangle<float>> all;
    const auto add = [&](std::size_t n, double lower, double upper, double side) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto at = random.point<float>(lower, upper);
            all.push_back({at, at + random.point<float>(-side, side), at + random.point<float>(-side, side)});
        }
    };
    add(100'000, -10, 10, 0.02);
    add(10'000, 9.8, 10, 0.01);
    return device_soup(on, all);
}

void add_lists(const abut::cuda& on, table& out) {
    const abut::test::torus<float> shape(45, 30, 0.35, 0.15);
    const auto tree = make_bvh(on, device_mesh(on, shape.vertices, shape.faces));
    std::vector<abut::posed_pair<std::remove_const_t<decltype(tree)>>> list;
    for (int i = 0; i < 1000; ++i) {
        abut::rigid<float> pose;
        pose.translation = {0.3f + 0.0006f * static_cast<float>(i), 0.05f, 0.02f};
        list.push_back({posed(tree, {}), posed(tree, pose)});
    }
    for_each_schedule([&](auto chosen, const char* schedule) {
        add_list<decltype(chosen)::value>(on, out, joined({"list", schedule}), list);
    });
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_schedules_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const auto pair =
            meshes_scene::make_pair(argc > 2 ? meshes_scene::read_surface(argv[2]) : meshes_scene::unit_torus());
        const auto a = make_bvh(on, device_mesh(on, pair.a.vertices, pair.a.faces));
        const auto b = make_bvh(on, device_mesh(on, pair.b.vertices, pair.b.faces));
        add_scene(on, out, "turned", a, b);
        const auto box = a.bounds();
        const abut::vec3<float> size = box.upper - box.lower;
        std::vector<abut::vec3<float>> moved;
        for (const auto& p : pair.a.vertices)
            moved.push_back(p + abut::vec3<float>{.0003f * size.x, .0002f * size.y, .0001f * size.z});
        add_scene(on, out, "near", a, make_bvh(on, device_mesh(on, moved, pair.a.faces)));
        abut::test::uniform random(1);
        const auto c = make_bvh(on, corner_soup(on, random)), d = make_bvh(on, corner_soup(on, random));
        add_scene(on, out, "corner", c, d);
        add_lists(on, out);
    });
}
