// SPDX-License-Identifier: MIT
//
// usage: bench_raycast_cuda [OUT.json [MESH]]
//
// bench/raycast.cpp on CUDA: the same mesh (MESH, PLY or OBJ, or a torus), the same kinds of rays, 16 times as many, and the
// same names, policy cuda; all data resident on the device before the clock starts. Each figure is the median of 21 runs,
// taken with CUDA events around the whole call. The floor is what has to be read and written at least once.
//
// raycast/KIND/plain/cuda is the walk that one writes by hand: a thread for each ray, in floats, through the same tree; rays pass
// between faces there.

#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "mesh_file.hpp"
#include "raycast_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;

template <abut::arithmetic A, class Index>
void add(const abut::cuda& on, table& out, const scene::surface<float>& surface, const char* name, const char* arithmetic,
         const Index& index) {
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const auto made = raycast_scene::rays_at(surface, kind, 4 * raycast_scene::default_side);
        const abut::rays<float, abut::device_space> rays(on, made);
        const double bytes = static_cast<double>(index.bytes()) + (24.0 + 8.0) * static_cast<double>(rays.size());
        out.add(joined({"raycast", raycast_scene::kinds[kind], name, arithmetic, "cuda"}), bytes, [&] {
            const auto found = abut::raycast<A>(on, index, rays);
            return counters{{"items", static_cast<double>(found.size())}};
        });
    }
}

struct plain_hit {
    std::uint32_t id;
    float t;
};

__device__ float entry(const abut::vec3<float>& o, const abut::vec3<float>& inverse, const abut::aabb<float>& box) {
    const float x0 = (box.lower.x - o.x) * inverse.x, x1 = (box.upper.x - o.x) * inverse.x,
                y0 = (box.lower.y - o.y) * inverse.y, y1 = (box.upper.y - o.y) * inverse.y,
                z0 = (box.lower.z - o.z) * inverse.z, z1 = (box.upper.z - o.z) * inverse.z;
    const float in = fmaxf(fmaxf(fminf(x0, x1), fminf(y0, y1)), fmaxf(fminf(z0, z1), 0.0f));
    const float out = fminf(fminf(fmaxf(x0, x1), fmaxf(y0, y1)), fmaxf(z0, z1));
    return in <= out ? in : abut::infinity<float>;
}

/// T. Moeller, B. Trumbore, Fast, minimum storage ray-triangle intersection (1997).
__device__ float hit(const abut::ray<float>& r, const abut::triangle<float>& t) {
    const auto ab = t.b - t.a, ac = t.c - t.a, p = cross(r.direction, ac), s = r.origin - t.a;
    const float inverse = 1 / dot(ab, p), u = dot(s, p) * inverse;
    if (!(u >= 0 && u <= 1)) return -1;
    const auto q = cross(s, ab);
    const float v = dot(r.direction, q) * inverse;
    return v >= 0 && u + v <= 1 ? dot(ac, q) * inverse : -1;
}

template <class Tree, class Shapes, class Rays>
__global__ void plain_walk(Tree tree, Shapes shapes, Rays rays, plain_hit* out) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i >= rays.size()) return;
    struct part {
        abut::bvh_child child;
        float entry;
    };
    part waiting[abut::bvh_max_depth + 1], at{tree.root(), 0};
    const abut::ray<float> r = rays[i];
    const abut::vec3<float> inverse{1 / r.direction.x, 1 / r.direction.y, 1 / r.direction.z};
    plain_hit best{abut::no_id, 3.4e38f};
    for (int count = 0;;) {
        while (at.entry <= best.t && !at.child.is_leaf()) {
            const auto& node = tree.fetch(at.child.index());
            part near{tree.child(node, 0), entry(r.origin, inverse, tree.bounds(node, 0))};
            part far{tree.child(node, 1), entry(r.origin, inverse, tree.bounds(node, 1))};
            if (far.entry < near.entry) {
                const part before = near;
                near = far;
                far = before;
            }
            if (far.entry <= best.t) waiting[count++] = far;
            at = near;
        }
        if (at.entry <= best.t) {
            const float t = hit(r, shapes[at.child.index()]);
            if (t >= 0 && t < best.t) best = {at.child.index(), t};
        }
        if (count == 0) break;
        at = waiting[--count];
    }
    out[i] = best;
}

template <class Index, class Shapes>
void add_plain(const abut::cuda& on, table& out, const scene::surface<float>& surface, const Index& index, const Shapes& shapes) {
    constexpr unsigned block = 128;
    for (std::size_t kind = 0; kind < raycast_scene::kinds.size(); ++kind) {
        const abut::rays<float, abut::device_space> rays(on,
                                                         raycast_scene::rays_at(surface, kind, 4 * raycast_scene::default_side));
        out.add(joined({"raycast", raycast_scene::kinds[kind], "plain", "cuda"}), 32.0 * static_cast<double>(rays.size()), [&] {
            abut::execution::buffer<plain_hit, abut::device_space> hits(on, rays.size());
            plain_walk<<<static_cast<unsigned>((rays.size() + block - 1) / block), block, 0, on.stream>>>(
                index.view(), shapes.view(), rays.view(), hits.data());
            bench::check(cudaGetLastError(), "plain_walk");
            return counters{{"items", static_cast<double>(hits.size())}};
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string path = argc > 2 ? argv[2] : "";
    return bench::run("bench_raycast_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        const auto surface = path.empty() ? scene::torus<float>() : bench::read_surface<scene::surface<float>>(path);
        const abut::mesh<float, abut::device_space> mesh(on, surface.vertices, surface.faces);
        const auto linear = abut::make_bvh(on, mesh), joined_tree = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::ploc});
        add<abut::filtered>(on, out, surface, "bvh", "filtered", linear);
        add<abut::filtered>(on, out, surface, "ploc", "filtered", joined_tree);
        add<abut::fast>(on, out, surface, "ploc", "fast", joined_tree);
        add_plain(on, out, surface, joined_tree, mesh);
    });
}
