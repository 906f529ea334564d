// SPDX-License-Identifier: MIT
//
// usage: bench_motion_cuda [OUT.json [FOLDER...]]
//
// Continuous collision of a mesh with itself on CUDA, all data resident before the clock starts. Each FOLDER has frame0.ply
// and frame1.ply, the same mesh at two times; without any, scenes are made: 64 to 4,096 triangles flying about. Per scene:
//
//   build, refit                  the index of the step: trees over faces, edges and vertices
//   impacts                       self_impacts of the index, sorted, with times; counters: impacts, of vertices, of edges
//   frame                         refit and impacts: a step of a simulation
//   walk                          all kinds of features are walked together: candidates are counted
//   KIND/walk/SCHEDULE            the walk of one kind alone, vertex_face or edge_edge. Counters: what the schedule reports
//   KIND/walk/part/N              the best schedule on an N-th of the blocks
//   KIND/ARITHMETIC               one elementary test of each candidate in its first stage, and its second, of what the
//                                 first left, with the time. Counters: items, left, found
//   KIND/ARITHMETIC/wrong         missed_per_million and phantom_per_million: answers that differ from those of the host's
//                                 `exact`, of candidates at even steps, 65,536 at most
//   halves/from_roots             self_impacts of the first half of the step, and of the second, with refits
//   halves/from_fronts            the same, each from the fronts that the other left. Counters: pairs of nodes that they
//   hold,
//                                 and how many were opened in the last query
//   same                          1 if 100 runs of impacts gave the same
//
// Each figure is the median of 21 runs by CUDA events around the whole call.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include <abut/cuda.hpp>
#include <abut/experimental/cuda_work_stealing.hpp>
#include <abut/experimental/impact_fronts.hpp>

#include "cuda_table.hpp"
#include "motion_scene.hpp"

namespace {

using namespace abut::detail;
using abut::device_space;
using abut::schedule;
using bench::counters;
using bench::joined;
using bench::table;
using key_queue = abut::execution::work_queue<std::uint64_t, device_space>;

struct count_candidate {
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t, Count& count, auto&...) const {
        count.add(1);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

/// The first stage of a judge, of candidates.
template <class View, class Judge>
struct try_candidate {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    template <class Open>
    ABUT_HD void operator()(std::size_t i, Open& open) const {
        if (judge.decide(both.shape_a(keys[i]), both.shape_b(keys[i])) != abut::verdict::no) open.push(keys[i]);
    }
};
/// The second one, of what it left.
template <class View, class Judge>
struct time_candidate {
    View both;
    Judge judge;
    const std::uint64_t* keys;
    template <class Hits>
    ABUT_HD void operator()(std::size_t i, Hits& hits) const {
        const double time = judge.time(both.shape_a(keys[i]), both.shape_b(keys[i]));
        if (time != time_in_bits::none) hits.push({keys[i], time});
    }
};

/// Candidates, every so many, with the shapes that they are of, and whether these touch.
template <class View>
struct sampled {
    using s_type = decltype(View().shape_a(0));
    using t_type = decltype(View().shape_b(0));
    struct pair {
        std::uint64_t key;
        s_type s;
        t_type t;
    };
    struct copy_pair {
        View both;
        const std::uint64_t* keys;
        std::size_t step;
        pair* pairs;
        ABUT_HD void operator()(std::size_t i) const {
            const std::uint64_t key = keys[i * step];
            pairs[i] = {key, both.shape_a(key), both.shape_b(key)};
        }
    };

    std::vector<pair> pairs;
    std::vector<bool> truth;

    sampled(const abut::cuda& on, const View& both, const key_queue& near, std::size_t count) {
        constexpr std::size_t most = std::size_t{1} << 16;
        if (count == 0) return;
        const std::size_t step = (count + most - 1) / most;
        pairs.resize((count + step - 1) / step);
        abut::execution::buffer_of<abut::cuda, pair> copies(on, pairs.size());
        for_each_index(on, pairs.size(), copy_pair{both, near.data(), step, copies.data()});
        copies.read(pairs.data());
        for (const pair& p : pairs) truth.push_back(time_in_motion<abut::exact>{}.time_on_host(p.s, p.t) >= 0);
    }

    /// Of what touches by a judge, and what it leaves to the host.
    template <class Judge>
    counters wrong(const std::vector<timed_key>& hits, const Judge& judge) const {
        std::unordered_map<std::uint64_t, double> times;
        for (const timed_key& hit : hits) times[hit.key] = hit.time;
        std::size_t missed = 0, phantom = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto at = times.find(pairs[i].key);
            double time = at == times.end() ? time_in_bits::none : at->second;
            if (time == time_in_bits::unknown) time = judge.time_on_host(pairs[i].s, pairs[i].t);
            missed += truth[i] && time < 0;
            phantom += time >= 0 && !truth[i];
        }
        const auto per_million = [&](std::size_t n) {
            return 1e6 * static_cast<double>(n) / static_cast<double>(pairs.size());
        };
        return {{"sample", static_cast<double>(pairs.size())},
                {"hits", static_cast<double>(std::count(truth.begin(), truth.end(), true))},
                {"missed_per_million", per_million(missed)},
                {"phantom_per_million", per_million(phantom)}};
    }
};

template <class Pairing>
std::uint64_t count_candidates(const abut::cuda& on, const Pairing& pairing) {
    abut::execution::work_count<device_space> count(on);
    pairing.judge_candidates(on, [&](const auto& loop) { loop(count_candidate{}, count); });
    return count.total();
}

counters reported(std::uint64_t candidates, const abut::schedule_report& r) {
    return {{"candidates", static_cast<double>(candidates)},
            {"blocks", static_cast<double>(r.workers)},
            {"nodes", static_cast<double>(r.items)},
            {"steals", static_cast<double>(r.steals)},
            {"stolen", static_cast<double>(r.stolen)},
            {"failed_steals", static_cast<double>(r.failed_steals)},
            {"transfers", static_cast<double>(r.transfers)},
            {"balances", static_cast<double>(r.balances)},
            {"idle_share", r.idle_share}};
}

template <abut::motion_arithmetic A, class View>
void add_tests(const abut::cuda& on, table& out, const std::string& name, const View& both, const key_queue& near,
               std::size_t count, const sampled<View>& sample) {
    using judge = time_in_motion<A>;
    std::size_t left = 0;
    const auto first = [&](key_queue& open) {
        for_each_index(on, count, try_candidate<View, judge>{both, {}, near.data()}, open);
    };
    const auto second = [&](const key_queue& open, timed_queue<abut::cuda>& hits) {
        for_each_index(on, open.size(), time_candidate<View, judge>{both, {}, open.data()}, hits);
    };
    out.add(joined({name, "first"}), 0, [&]() -> counters {
        key_queue open(on, count + 1);
        first(open);
        left = open.size();
        return {{"items", static_cast<double>(count)}, {"left", static_cast<double>(left)}};
    });
    key_queue open(on, count + 1);
    first(open);
    timed_queue<abut::cuda> touching(on, left + 1);
    if (left > 0) {
        second(open, touching);
        out.add(joined({name, "second"}), 0, [&]() -> counters {
            timed_queue<abut::cuda> hits(on, std::size_t{1} << 20);
            second(open, hits);
            return {{"items", static_cast<double>(open.size())}, {"found", static_cast<double>(hits.size())}};
        });
    }
    if (sample.pairs.empty()) return;
    abut::execution::buffer_of<abut::cuda, timed_key> copy_of(on, touching.size());
    copy(on, touching.data(), touching.size(), copy_of.data());
    std::vector<timed_key> hits(touching.size());
    copy_of.read(hits.data());
    out.note(joined({name, "wrong"}), sample.wrong(hits, judge{}));
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
    const auto both = pairing.view();
    const sampled sample(on, both, near, count);
    add_tests<abut::fast>(on, out, joined({name, "fast"}), both, near, count, sample);
    add_tests<abut::filtered>(on, out, joined({name, "filtered"}), both, near, count, sample);
    add_tests<abut::conservative>(on, out, joined({name, "conservative"}), both, near, count, sample);
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
    out.add(joined({name, "refit"}), 0, [&]() -> counters {
        return {{"faces", static_cast<double>(refit(on, index, step).size())}};
    });
    const auto of = [](std::size_t impacts) { return counters{{"impacts", static_cast<double>(impacts)}}; };
    out.add(joined({name, "impacts"}), 0, [&] { return of(self_impacts(on, index).size()); });
    out.add(joined({name, "frame"}), 0, [&] { return of(self_impacts(on, refit(on, index, step)).size()); });
    const auto known = to_host(self_impacts(on, index));
    bool same = true;
    for (int run = 0; run < 100; ++run) same = same && to_host(self_impacts(on, index)) == known;
    out.add(joined({name, "same"}), 0, [&]() -> counters { return {{"same", same ? 1.0 : 0.0}}; });

    const auto t_half = at_0.with_vertices(on, motion_scene::frames::as<T>(scene.half_way()));
    const auto first = abut::moving(at_0, t_half), second = abut::moving(t_half, step.t1());
    out.add(joined({name, "halves/from_roots"}), 0, [&] {
        return of(self_impacts(on, refit(on, index, first)).size() + self_impacts(on, refit(on, index, second)).size());
    });
    abut::impact_fronts fronts;
    out.add(joined({name, "halves/from_fronts"}), 0, [&] {
        const auto in_first = self_impacts(on, refit(on, index, first), {}, fronts).size();
        counters made = of(in_first + self_impacts(on, refit(on, index, second), {}, fronts).size());
        const auto &of_vertices = fronts.vertex_face.report(), &of_edges = fronts.edge_edge.report();
        made.emplace_back("nodes", static_cast<double>(of_vertices.items + of_edges.items));
        made.emplace_back("opened", static_cast<double>(of_vertices.opened + of_edges.opened));
        return made;
    });
    using features = feature_pairing<true, abut::impact_index<T, device_space>, near_enough_to_touch, no_fronts>;
    out.add(joined({name, "walk"}), 0, [&]() -> counters {
        return {{"candidates", static_cast<double>(count_candidates(on, features(index, index, {}, {}, "bench")))}};
    });
    const auto faces = step.t0().view().faces;
    const auto edges = index.edges().set().t0().view().edges;
    using abut::traversal;
    add_kind(on, out, joined({name, "vertex_face"}), [&]<schedule S>() {
        const abut::query_options<motion_scene::share_no_vertex_with_face, traversal::both_at_once, S> options{
            .filter = {faces}};
        return pair_up(on, index.vertices(), index.faces(), options, "bench");
    });
    add_kind(on, out, joined({name, "edge_edge"}), [&]<schedule S>() {
        const abut::query_options<motion_scene::share_no_vertex_with_edge, traversal::both_at_once, S> options{
            .filter = {edges}};
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
