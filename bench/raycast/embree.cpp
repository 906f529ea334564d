// SPDX-License-Identifier: MIT
//
// The peer: Embree's first hits over the same triangles, and whether there are any (rtcOccluded1), one ray at a time on one
// thread. `robust` is its watertight way (RTC_SCENE_FLAG_ROBUST); neither is exact.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <benchmark/benchmark.h>

#include "../embree_scene.hpp"
#include "peer.hpp"

namespace {

void add(bool robust) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const std::string name = std::string("raycast/") + raycast_scene::kinds[kind] + (robust ? "/embree_robust" : "/embree") + "/float/serial";
        raycast_peer::add(name, [=](benchmark::State& state) {
            const auto rays = raycast_scene::rays_at(raycast_peer::mesh(), kind, raycast_scene::default_side);
            const embree_peer::embree_scene index(raycast_peer::mesh(), robust);
            struct answer {
                std::uint32_t id;
                float t;
            };
            std::vector<answer> found;
            for (auto _ : state) {
                found.assign(rays.size(), {});
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const auto &o = rays[i].origin, &d = rays[i].direction;
                    RTCRayHit ray{};
                    ray.ray.org_x = o.x, ray.ray.org_y = o.y, ray.ray.org_z = o.z;
                    ray.ray.dir_x = d.x, ray.ray.dir_y = d.y, ray.ray.dir_z = d.z;
                    ray.ray.tfar = std::numeric_limits<float>::infinity();
                    ray.ray.mask = static_cast<unsigned>(-1);
                    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
                    rtcIntersect1(index.get(), &context, &ray);
                    found[i] = {ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? static_cast<std::uint32_t>(-1) : ray.hit.primID, ray.ray.tfar};
                }
            }
            std::vector<std::uint32_t> named;
            for (const answer& a : found) named.push_back(a.id);
            raycast_peer::note_hits(state, kind, named);
        });
    }
}

void add_occluded(bool robust) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const std::string name = std::string("occluded/") + raycast_scene::kinds[kind] + (robust ? "/embree_robust" : "/embree") + "/float/serial";
        raycast_peer::add(name, [=](benchmark::State& state) {
            const auto rays = raycast_scene::rays_at(raycast_peer::mesh(), kind, raycast_scene::default_side);
            const embree_peer::embree_scene index(raycast_peer::mesh(), robust);
            std::vector<std::uint8_t> found;
            for (auto _ : state) {
                found.assign(rays.size(), 0);
                RTCIntersectContext context;
                rtcInitIntersectContext(&context);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    const auto &o = rays[i].origin, &d = rays[i].direction;
                    RTCRay ray{};
                    ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
                    ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
                    ray.tfar = std::numeric_limits<float>::infinity();
                    ray.mask = static_cast<unsigned>(-1);
                    rtcOccluded1(index.get(), &context, &ray);
                    found[i] = ray.tfar < 0 ? 1 : 0;
                }
            }
            raycast_peer::note_flags(state, kind, found);
        });
    }
}

void add_both() {
    for (const bool robust : {false, true}) add(robust), add_occluded(robust);
}
[[maybe_unused]] const bool registered = (raycast_peer::peers().push_back(add_both), true);

}  // namespace
