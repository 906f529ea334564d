// SPDX-License-Identifier: MIT
//
// usage: bench_mixed_bodies --benchmark_enable_random_interleaving=true --benchmark_out=mixed_bodies.json
//
// Which of 1,000 bodies of five kinds touch (bench/mixed_bodies/peer.hpp), on one core in double. Names:
//
//   mixed_bodies/touching/NAME   the bodies as they lie
//   mixed_bodies/frame/NAME      they are moved, and asked
//
// NAME is abut, by_hand (`touching_bodies` of each kind and `between` of each two, whose numbers are brought together), or
// the dynamic tree of boxes of a peer, whose pairs are asked with its default tolerances. Counters: touching, and wrong,
// which are pairs that abut::exact has not, or has alone.

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mixed_bodies/peer.hpp"

namespace {

using namespace mixed_scene;
using touching_list = std::vector<abut::index_pair>;

const crowd& shared_crowd() {
    static const crowd s = make(1000);
    return s;
}

/// The bodies of one kind, each but the meshes over a set of its own.
template <class Set, class MakeSet>
auto list_of(const crowd& s, kind of, const MakeSet& make_set) {
    using index = decltype(abut::make_bvh(abut::serial{}, std::declval<const Set&>()));
    std::vector<abut::posed_object<index>> list;
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        if (s.bodies[i].of != of) continue;
        const bool is_shared = of == kind::mesh && !list.empty();
        list.push_back(
            abut::posed(is_shared ? list[0].object : abut::make_bvh(abut::serial{}, make_set(s.bodies[i])), s.now[i]));
    }
    return list;
}
auto lists_of(const crowd& s) {
    using namespace abut;
    const auto along = [](const body& b) { return segment<double>{{0, 0, -b.half_length}, {0, 0, b.half_length}}; };
    return std::tuple(
        list_of<abut::mesh<double>>(s, kind::mesh, [&](const body&) { return abut::mesh<double>(s.vertices, s.faces); }),
        list_of<boxes<double>>(s, kind::box,
                               [](const body& b) {
                                   return boxes<double>(std::vector<aabb<double>>{{vec3<double>{} - b.half, b.half}});
                               }),
        list_of<capsules<double>>(s, kind::capsule,
                                  [&](const body& b) {
                                      return capsules<double>(std::vector<abut::capsule<double>>{{along(b), b.radius}});
                                  }),
        list_of<cylinders<double>>(s, kind::cylinder,
                                   [&](const body& b) {
                                       return cylinders<double>(std::vector<abut::cylinder<double>>{{along(b), b.radius}});
                                   }),
        list_of<spheres<double>>(s, kind::sphere, [](const body& b) {
            return spheres<double>(std::vector<abut::sphere<double>>{{{0, 0, 0}, b.radius}});
        }));
}
auto mixed_of(const crowd& s) {
    return std::apply([](const auto&... list) { return abut::make_bodies(abut::serial{}, list...); }, lists_of(s));
}

holder make_abut(const crowd& s) {
    const abut::serial on;
    const auto all = std::make_shared<decltype(mixed_of(s))>(mixed_of(s));
    return {[=](const poses& at) { *all = abut::refit(on, *all, at); },
            [=] { return to_host(abut::touching_bodies(on, *all)); }};
}

holder make_by_hand(const crowd& s) {
    const abut::serial on;
    const auto each =
        std::apply([&](const auto&... list) { return std::tuple(abut::make_bodies(on, list)...); }, lists_of(s));
    const auto all = std::make_shared<std::remove_const_t<decltype(each)>>(each);
    const auto move = [=](const poses& at) {
        std::size_t first = 0;
        const auto one = [&](auto& bodies) {
            bodies = abut::refit(on, bodies, std::span(at).subspan(first, bodies.size()));
            first += bodies.size();
        };
        std::apply([&](auto&... bodies) { (one(bodies), ...); }, *all);
    };
    const auto touching = [=] {
        touching_list found;
        const auto add = [&](std::size_t first_a, std::size_t first_b, const auto& two) {
            for (const auto& [a, b] : two) {
                found.push_back({static_cast<std::uint32_t>(first_a + a), static_cast<std::uint32_t>(first_b + b)});
            }
        };
        std::size_t first_a = 0;
        const auto with_others = [&](const auto& a, std::size_t at_a) {
            add(first_a, first_a, abut::touching_bodies(on, a));
            std::size_t first_b = 0, at_b = 0;
            const auto with = [&](const auto& b) {
                if (at_b++ > at_a) add(first_a, first_b, abut::touching_bodies(on, abut::between(a, b)));
                first_b += b.size();
            };
            std::apply([&](const auto&... b) { (with(b), ...); }, *all);
            first_a += a.size();
        };
        std::size_t at = 0;
        std::apply([&](const auto&... a) { (with_others(a, at++), ...); }, *all);
        std::sort(found.begin(), found.end());
        return found;
    };
    return {move, touching};
}

const touching_list& truth(bool later) {
    static const std::pair<touching_list, touching_list> both = [] {
        const abut::serial on;
        const auto all = mixed_of(shared_crowd());
        return std::pair(to_host(abut::touching_bodies<abut::exact>(on, all)),
                         to_host(abut::touching_bodies<abut::exact>(on, abut::refit(on, all, shared_crowd().later))));
    }();
    return later ? both.second : both.first;
}

void add(const peer& who, bool frame) {
    const std::string name = std::string("mixed_bodies/") + (frame ? "frame/" : "touching/") + who.name;
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& state) {
                                     const crowd& s = shared_crowd();
                                     const holder held = who.make(s);
                                     touching_list found;
                                     for (auto _ : state) {
                                         if (frame) held.move(s.later);
                                         found = held.touching();
                                     }
                                     std::sort(found.begin(), found.end());
                                     touching_list other;
                                     const auto& right = truth(frame);
                                     std::set_symmetric_difference(found.begin(), found.end(), right.begin(), right.end(),
                                                                   std::back_inserter(other));
                                     state.counters["touching"] = static_cast<double>(found.size());
                                     state.counters["wrong"] = static_cast<double>(other.size());
                                 })
        ->Repetitions(9)
        ->ReportAggregatesOnly(true)
        ->Unit(benchmark::kMillisecond)
        ->Iterations(20);
}

}  // namespace

int main(int argc, char** argv) {
    peers().insert(peers().begin(), {{"abut", make_abut}, {"by_hand", make_by_hand}});
    for (const bool frame : {false, true}) {
        for (const peer& who : peers()) add(who, frame);
    }
    std::string versions;
    for (const peer& who : peers()) {
        if (!who.version.empty()) versions += (versions.empty() ? "" : ", ") + who.version;
    }
    if (!versions.empty()) benchmark::AddCustomContext("peers", versions);
    return bench::run_registered("bench_mixed_bodies", argc, argv);
}
