// SPDX-License-Identifier: MIT
//
// The peer: tinybvh's tree of eight children for processors with AVX2, made with spatial splits (BuildHQ): the first hits over the same
// triangles, and whether there are any, one ray at a time on one thread. It divides by a direction's length, and is not exact.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#define TINYBVH_IMPLEMENTATION
#include <tiny_bvh.h>

#include "peer.hpp"

namespace {

struct tree {
    std::vector<tinybvh::bvhvec4> corners;  // tinybvh reads them where they are
    tinybvh::BVH8_CPU index;

    explicit tree(const scene::surface<float>& mesh) {
        for (const auto& f : mesh.faces) {
            for (int k = 0; k < 3; ++k) {
                const auto& p = mesh.vertices[f[static_cast<std::size_t>(k)]];
                corners.emplace_back(p.x, p.y, p.z, 0.0f);
            }
        }
        index.BuildHQ(corners.data(), static_cast<std::uint32_t>(mesh.faces.size()));
    }
};

tinybvh::Ray ray_of(const abut::ray<float>& r) {
    return {tinybvh::bvhvec3(r.origin.x, r.origin.y, r.origin.z), tinybvh::bvhvec3(r.direction.x, r.direction.y, r.direction.z)};
}

void first_hits(benchmark::State& state, std::size_t kind) {
    const tree made(raycast_peer::mesh());
    const auto& rays = raycast_peer::truth_of(kind).rays;
    std::vector<std::uint32_t> found;
    for (auto _ : state) {
        found.assign(rays.size(), abut::no_id);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            tinybvh::Ray ray = ray_of(rays[i]);
            made.index.Intersect(ray);
            if (ray.hit.t < BVH_FAR) found[i] = ray.hit.prim;
        }
    }
    raycast_peer::note_hits(state, kind, found);
}
void occluded(benchmark::State& state, std::size_t kind) {
    const tree made(raycast_peer::mesh());
    const auto& rays = raycast_peer::truth_of(kind).rays;
    std::vector<std::uint8_t> found;
    for (auto _ : state) {
        found.assign(rays.size(), 0);
        for (std::size_t i = 0; i < rays.size(); ++i) found[i] = made.index.IsOccluded(ray_of(rays[i]));
    }
    raycast_peer::note_flags(state, kind, found);
}

void add_both() {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const std::string name = std::string(raycast_scene::kinds[kind]) + "/tinybvh/float/serial";
        raycast_peer::add("raycast/" + name, [=](benchmark::State& state) { first_hits(state, kind); });
        raycast_peer::add("occluded/" + name, [=](benchmark::State& state) { occluded(state, kind); });
    }
}
[[maybe_unused]] const bool registered = (raycast_peer::peers().push_back(add_both), true);

}  // namespace
