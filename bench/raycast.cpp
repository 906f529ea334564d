// SPDX-License-Identifier: MIT
//
// usage: bench_raycast [--mesh=FILE] --benchmark_enable_random_interleaving=true --benchmark_out=raycast.json
//
// For each of a million rays the triangle that it meets first: of a mesh (FILE, PLY or OBJ, or a torus). Names:
//
//   raycast/RAYS/INDEX/ARITHMETIC/POLICY    the query alone; the index is there. RAYS: raycast_scene.hpp
//                                           `in_order`: of the faces in the order of a tree's leaves (leaf_ids)
//   occluded/...                            the same by raycast_any
//   all/...                                 by raycast_all
//   inside/points/INDEX/ARITHMETIC/POLICY   points in the box around the mesh, by inside; `checked`: with a look at the mesh
//
// Peers (bench/raycast/) are in the same run, where their packages are there.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "mesh_file.hpp"
#include "raycast/peer.hpp"

namespace {

/// Rows of a query: ask(rays) gives its answers, and note(state, kind of rays, answers) what is told of them.
template <class Ask, class Note>
void add_rays(const char* query, const std::string& name, const Ask& ask, const Note& note) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const abut::rays<float> rays(raycast_scene::rays_at(raycast_peer::mesh(), kind, raycast_scene::default_side));
        raycast_peer::add(std::string(query) + "/" + raycast_scene::kinds[kind] + "/" + name, [=](benchmark::State& state) {
            for (auto _ : state) {
                const auto found = ask(rays);
                state.PauseTiming();
                note(state, kind, found);
                state.ResumeTiming();
            }
        });
    }
}

template <abut::arithmetic A, class Policy, class Index>
void add(const char* index_name, const char* arithmetic, const char* policy, const Policy& on, const Index& index) {
    // Of faces in another order the ids are others: they say nothing of what is wrong.
    const bool has_ids = std::string(index_name) != "wide_in_order";
    add_rays("raycast", std::string(index_name) + "/" + arithmetic + "/" + policy,
             [=](const auto& rays) { return abut::raycast<A>(on, index, rays); },
             [=](benchmark::State& state, std::size_t kind, const auto& found) {
                 std::vector<std::uint32_t> named;
                 for (const auto& hit : found) named.push_back(hit.id);
                 raycast_peer::note_hits(state, kind, named, has_ids);
             });
}

template <class Policy, class Index>
void add_others(const char* index_name, const Policy& on, const Index& index) {
    const std::string name = std::string(index_name) + "/filtered/serial";
    add_rays("occluded", name, [=](const auto& rays) { return abut::raycast_any(on, index, rays); },
             [](benchmark::State& state, std::size_t kind, const auto& found) {
                 raycast_peer::note_flags(state, kind, {found.begin(), found.end()});
             });
    add_rays("all", name, [=](const auto& rays) { return abut::raycast_all(on, index, rays); },
             [](benchmark::State& state, std::size_t, const auto& found) { raycast_peer::note(state, found.size(), found.size()); });
}

template <class Policy, class Index>
void add_inside(const char* index_name, const Policy& on, const Index& index, bool is_checked) {
    const auto points = raycast_scene::points_in(raycast_peer::mesh());
    raycast_peer::add(std::string("inside/points/") + index_name + "/filtered/serial", [=](benchmark::State& state) {
        std::size_t within = 0;
        for (auto _ : state) {
            const auto found = abut::inside(on, index, points, {.known_closed = !is_checked});
            state.PauseTiming();
            within = 0;
            for (const auto where : found) within += where == abut::containment::inside;
            state.ResumeTiming();
        }
        raycast_peer::note(state, points.size(), within);
    });
}

}  // namespace

const raycast_peer::truth& raycast_peer::truth_of(std::size_t kind) {
    static std::array<truth, raycast_scene::kinds.size()> all;
    truth& made = all[kind];
    if (made.rays.empty()) {
        const abut::serial on;
        made.rays = raycast_scene::rays_at(mesh(), kind, raycast_scene::default_side);
        const auto index = abut::make_bvh(on, abut::mesh<float>(mesh().vertices, mesh().faces), {.builder = abut::bvh_builder::sah});
        for (const auto& hit : abut::raycast<abut::exact>(on, index, abut::rays<float>(made.rays))) made.ids.push_back(hit.id);
    }
    return made;
}

std::size_t raycast_peer::wrong_hits(std::size_t kind, const std::vector<std::uint32_t>& named) {
    const truth& right = truth_of(kind);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < named.size(); ++i) {
        if (named[i] == right.ids[i]) continue;
        if (named[i] == abut::no_id || right.ids[i] == abut::no_id) {
            ++wrong;
            continue;
        }
        const abut::mesh<float> both(mesh().vertices, {mesh().faces[named[i]], mesh().faces[right.ids[i]]});
        const abut::rays<float> ray(std::vector{right.rays[i]});
        wrong += abut::raycast<abut::exact>(abut::serial{}, both, ray)[0].id != 0;  // of equal times the least id
    }
    return wrong;
}
std::size_t raycast_peer::wrong_flags(std::size_t kind, const std::vector<std::uint8_t>& named) {
    const truth& right = truth_of(kind);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < named.size(); ++i) wrong += (named[i] != 0) != (right.ids[i] != abut::no_id);
    return wrong;
}

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--mesh");
        raycast_peer::mesh() = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        benchmark::AddCustomContext("mesh", path.empty() ? "torus" : path.substr(path.find_last_of('/') + 1));
        const abut::mesh<float> mesh(raycast_peer::mesh().vertices, raycast_peer::mesh().faces);
        const abut::serial on;
        const auto linear = abut::make_bvh(on, mesh), sah = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::sah});
        const auto wide_sah = abut::wide(on, sah);
        std::vector<abut::face> faces;  // in the order of leaves
        for (const std::uint32_t id : abut::leaf_ids(wide_sah)) faces.push_back(raycast_peer::mesh().faces[id]);
        const abut::mesh<float> in_order(raycast_peer::mesh().vertices, faces);
        const auto wide_in_order = abut::wide(on, abut::make_bvh(on, in_order, {.builder = abut::bvh_builder::sah}));
        add<abut::filtered>("bvh", "filtered", "serial", on, linear);
        add<abut::filtered>("sah", "filtered", "serial", on, sah);
        add<abut::filtered>("wide_sah", "filtered", "serial", on, wide_sah);
        add<abut::filtered>("wide_in_order", "filtered", "serial", on, wide_in_order);
        add<abut::fast>("sah", "fast", "serial", on, sah);
        add<abut::filtered>("sah", "filtered", "openmp", abut::openmp{}, sah);
        add_others("sah", on, sah);
        add_others("wide_sah", on, wide_sah);
        add_inside("sah", on, sah, false);
        add_inside("wide_sah", on, wide_sah, false);
        add_inside("wide_sah_checked", on, wide_sah, true);
        for (const auto register_peer : raycast_peer::peers()) register_peer();
        return bench::run_registered("bench_raycast", argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
}
