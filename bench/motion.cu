// SPDX-License-Identifier: MIT
//
// usage: bench_motion_cuda [OUT.json [FOLDER...]]
//
// Continuous collision of a mesh with itself on CUDA, all data resident before the clock starts. Each FOLDER has frame0.ply and
// frame1.ply, the same mesh at two times; without any, scenes are made: 64 to 4,096 triangles flying about. Per scene:
//
//   build, refit                  the index of the step: trees over faces, edges and vertices
//   impacts                       self_impacts of the index, sorted, with times; counters: impacts, of vertices, of edges
//   frame                         refit and impacts: a step of a simulation
//   KIND/walk/SCHEDULE            the walk alone: candidates are counted. KIND is vertex_face or edge_edge. Counters: what the
//                                 schedule reports
//   KIND/walk/part/N              the best schedule on an N-th of the blocks
//   KIND/ARITHMETIC               one elementary test of each candidate in its first stage, and its second, of those that the
//                                 first left (conservative: all). Counters: candidates, left, found; items a second
//   same                          1 if 100 runs of impacts gave the same
//
// Each figure is the median of 21 runs by CUDA events around the whole call.

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "motion_scene.hpp"

namespace {

using namespace abut::detail;
using bench::counters;
using bench::joined;
using bench::table;
using abut::device_space;
using abut::schedule;
using key_queue = abut::execution::work_queue<std::uint64_t, device_space>;

struct count_candidate {
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t, Count& count, auto&...) const {
        count.add(1);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

template <class View, class Judge, bool Finish>
struct test_candidate {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    template <class Hits, class Open>
    ABUT_HD void operator()(std::size_t i, Hits& hits, Open& open) const {
        const auto s = both.shape_a(keys[i]);
        const auto t = both.shape_b(keys[i]);
        const abut::verdict v = Finish ? judge.finish(s, t) : judge.decide(s, t);
        if (v == abut::verdict::yes) hits.push(keys[i]);
        if (v == abut::verdict::unknown) open.push(keys[i]);
    }
};

template <class Pairing>
std::uint64_t count_candidates(const abut::cuda& on, const Pairing& pairing) {
    abut::execution::work_count<device_space> count(on);
    pairing.judge_candidates(on, [&](const auto& loop) { loop(count_candidate{}, count); });
    return count.total();
}

counters reported(std::uint64_t candidates, const abut::schedule_report& r) {
    return {{"candidates", static_cast<double>(candidates)}, {"blocks", static_cast<double>(r.workers)},
            {"nodes", static_cast<double>(r.items)},         {"steals", static_cast<double>(r.steals)},
            {"stolen", static_cast<double>(r.stolen)},       {"failed_steals", static_cast<double>(r.failed_steals)},
            {"transfers", static_cast<double>(r.transfers)}, {"balances", static_cast<double>(r.balances)},
            {"idle_share", r.idle_share}};
}

template <abut::motion_arithmetic A, class Pairing>
void add_tests(const abut::cuda& on, table& out, const std::string& name, const Pairing& pairing, const key_queue& near,
               std::size_t count) {
    const auto both = pairing.view();
    using view = std::remove_const_t<decltype(both)>;
    using judge = touch_in_motion<A>;
    std::size_t left = 0, found = 0;
    const auto first = [&](key_queue& hits, key_queue& open) {
        for_each_index(on, count, test_candidate<view, judge, false>{both, {}, near.data()}, hits, open);
    };
    out.add(joined({name, "first"}), 0, [&]() -> counters {
        key_queue hits(on, 1 << 20), open(on, count + 1);
        first(hits, open);
        left = open.size(), found = hits.size();
        return {{"items", static_cast<double>(count)}, {"left", static_cast<double>(left)}, {"found", static_cast<double>(found)}};
    });
    if (left == 0) return;
    key_queue hits(on, 1 << 20), open(on, count + 1);
    first(hits, open);
    out.add(joined({name, "second"}), 0, [&]() -> counters {
        key_queue more(on, 1 << 20), rest(on, 1 << 16);
        for_each_index(on, open.size(), test_candidate<view, judge, true>{both, {}, open.data()}, more, rest);
        return {{"items", static_cast<double>(open.size())}, {"found", static_cast<double>(found + more.size())}};
    });
}

template <class Make>
void add_kind(const abut::cuda& on, table& out, const std::string& name, const Make& make) {
    std::size_t count = 0;
    const auto walk = [&]<schedule S>(const char* called) {
        abut::schedule_report report;
        auto pairing = make.template operator()<S>();
        pairing.options.scheduling.report = &report;
        out.add(joined({name, "walk", called}), 0, [&] {
            count = count_candidates(on, pairing);
            return reported(count, report);
        });
    };
    walk.template operator()<schedule::shared_list>("shared_list");
    walk.template operator()<schedule::static_partition>("static_partition");
    walk.template operator()<schedule::work_stealing>("work_stealing");
    walk.template operator()<schedule::lazy_work_stealing>("lazy_work_stealing");
    auto pairing = make.template operator()<schedule::static_partition>();
    abut::schedule_report all;
    pairing.options.scheduling.report = &all;
    count_candidates(on, pairing);
    for (const std::uint32_t part : {8u, 4u, 2u}) {
        auto some = make.template operator()<schedule::static_partition>();
        some.options.scheduling.most_blocks = static_cast<std::uint32_t>(all.workers / part);
        out.add(joined({name, "walk/part", std::to_string(part)}), 0, [&]() -> counters {
            return {{"candidates", static_cast<double>(count_candidates(on, some))}};
        });
    }
    key_queue near(on, count + 1);
    pairing.judge_candidates(on, [&](const auto& loop) { loop(gather_candidate{}, near); });
    add_tests<abut::fast>(on, out, joined({name, "fast"}), pairing, near, count);
    add_tests<abut::filtered>(on, out, joined({name, "filtered"}), pairing, near, count);
    add_tests<abut::conservative>(on, out, joined({name, "conservative"}), pairing, near, count);
}

template <abut::scalar T>
void add_scene(const abut::cuda& on, table& out, const motion_scene::frames& scene) {
    const abut::mesh<T, device_space> at_0(on, motion_scene::frames::as<T>(scene.t0), scene.faces);
    const auto step = abut::moving(at_0, at_0.with_vertices(on, motion_scene::frames::as<T>(scene.t1)));
    const auto index = make_impact_index(on, step);
    const std::string name = joined({scene.name, std::is_same_v<T, float> ? "float" : "double"});
    out.add(joined({name, "build"}), 0, [&]() -> counters {
        return {{"faces", static_cast<double>(make_impact_index(on, step).size())}};
    });
    out.add(joined({name, "refit"}), 0, [&]() -> counters { return {{"faces", static_cast<double>(refit(on, index, step).size())}}; });
    const auto of = [](std::size_t impacts) { return counters{{"impacts", static_cast<double>(impacts)}}; };
    out.add(joined({name, "impacts"}), 0, [&] { return of(self_impacts(on, index).size()); });
    out.add(joined({name, "frame"}), 0, [&] { return of(self_impacts(on, refit(on, index, step)).size()); });
    const auto known = to_host(self_impacts(on, index));
    bool same = true;
    for (int run = 0; run < 100; ++run) same = same && to_host(self_impacts(on, index)) == known;
    out.add(joined({name, "same"}), 0, [&]() -> counters { return {{"same", same ? 1.0 : 0.0}}; });

    const auto faces = step.t0().view().faces;
    const auto edges = index.edges().set().t0().view().edges;
    using abut::traversal;
    add_kind(on, out, joined({name, "vertex_face"}), [&]<schedule S>() {
        const abut::query_options<share_no_vertex_with_face, traversal::both_at_once, S> options{.filter = {faces}};
        return pair_up(on, index.vertices(), index.faces(), options, "bench");
    });
    add_kind(on, out, joined({name, "edge_edge"}), [&]<schedule S>() {
        const abut::query_options<share_no_vertex_with_edge, traversal::both_at_once, S> options{.filter = {edges}};
        return pair_up_self(on, index.edges(), options, "bench");
    });
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_motion_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        for (int i = 2; i < argc; ++i) {
            const auto scene = motion_scene::read_frames(argv[i]);
            scene.is_single() ? add_scene<float>(on, out, scene) : add_scene<double>(on, out, scene);
        }
        if (argc > 2) return;
        for (const std::size_t triangles : {64u, 128u, 256u, 512u, 1024u, 2048u, 4096u}) {
            add_scene<float>(on, out, motion_scene::flying_things(triangles));
        }
    });
}
