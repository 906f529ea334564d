// SPDX-License-Identifier: MIT
//
// usage: bench_nearest_cuda [--mesh=FILE.ply] [OUT.json]
//
// bench/nearest.cpp on CUDA: the same scenes (nearest_scene.hpp) and the same names, policy cuda, all data resident on the device before the
// clock starts. Each figure is the median of 21 runs after two that are not counted, taken with CUDA events around the whole
// call. The floor is what has to be read and written at least once.
//
// nearest/plain/cuda/POINTS is what others do, to compare with: a thread for each point, sorted along the same curve, walks
// with a stack through a tree of `ploc`, the nearest child first, and all of it is computed in float, which may find
// another triangle than the nearest.

#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/cuda.hpp>

#include "../docs/examples/scene.hpp"
#include "cuda_table.hpp"
#include "nearest_scene.hpp"

namespace {

using bench::counters;
using bench::joined;
using bench::table;

using point = abut::vec3<float>;

__device__ float squared_distance(const point& p, const abut::aabb<float>& box) {
    const point below = box.lower - p, above = p - box.upper;
    const point way{fmaxf(fmaxf(below.x, above.x), 0), fmaxf(fmaxf(below.y, above.y), 0), fmaxf(fmaxf(below.z, above.z), 0)};
    return dot(way, way);
}

/// By regions of the triangle: corners, edges, face.
__device__ float squared_distance(const point& p, const abut::triangle<float>& t) {
    const auto square = [](const point& way) { return dot(way, way); };
    const point ab = t.b - t.a, ac = t.c - t.a, from_a = p - t.a, from_b = p - t.b, from_c = p - t.c;
    const float b_of_a = dot(ab, from_a), c_of_a = dot(ac, from_a), b_of_b = dot(ab, from_b), c_of_b = dot(ac, from_b),
                b_of_c = dot(ab, from_c), c_of_c = dot(ac, from_c);
    if (b_of_a <= 0 && c_of_a <= 0) return square(from_a);
    if (b_of_b >= 0 && c_of_b <= b_of_b) return square(from_b);
    const float c = b_of_a * c_of_b - b_of_b * c_of_a;
    if (c <= 0 && b_of_a >= 0 && b_of_b <= 0) return square(from_a - (b_of_a / (b_of_a - b_of_b)) * ab);
    if (c_of_c >= 0 && b_of_c <= c_of_c) return square(from_c);
    const float b = b_of_c * c_of_a - b_of_a * c_of_c;
    if (b <= 0 && c_of_a >= 0 && c_of_c <= 0) return square(from_a - (c_of_a / (c_of_a - c_of_c)) * ac);
    const float a = b_of_b * c_of_c - b_of_c * c_of_b, to_c = c_of_b - b_of_b, to_b = b_of_c - c_of_c;
    if (a <= 0 && to_c >= 0 && to_b >= 0) return square(from_b - (to_c / (to_c + to_b)) * (t.c - t.b));
    return square(from_a - (b / (a + b + c)) * ab - (c / (a + b + c)) * ac);
}

struct plain_answer {
    std::uint32_t id;
    float square;
};

template <class Tree, class Shapes, class Points>
__global__ void plain_walk(Tree tree, Shapes shapes, Points points, const std::uint32_t* order, plain_answer* out) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i >= points.size()) return;
    struct entry {
        abut::bvh_child child;
        float square;
    };
    entry waiting[abut::bvh_max_depth + 1], at{tree.root(), 0};
    const point p = points[order[i]];
    plain_answer best{abut::no_id, abut::infinity<float>};
    for (int count = 0;;) {
        while (at.square < best.square && !at.child.is_leaf()) {
            const auto& node = tree.fetch(at.child.index());
            entry near{tree.child(node, 0), squared_distance(p, tree.bounds(node, 0))};
            entry far{tree.child(node, 1), squared_distance(p, tree.bounds(node, 1))};
            if (far.square < near.square) {
                const entry before = near;
                near = far;
                far = before;
            }
            if (far.square < best.square) waiting[count++] = far;
            at = near;
        }
        if (at.square < best.square) {
            const float square = squared_distance(p, shapes[at.child.index()]);
            if (square < best.square) best = {at.child.index(), square};
        }
        if (count == 0) break;
        at = waiting[--count];
    }
    out[order[i]] = best;
}

template <class Index, class Shapes>
void add_plain(const abut::cuda& on, const nearest_scene::question& ask, const Index& index, const Shapes& shapes, table& out) {
    constexpr unsigned block = 256;
    for (const std::size_t n : ask.counts) {
        const abut::points<float, abut::device_space> points(on, ask.points(*ask.mesh, n));
        out.add(joined({ask.name, "plain", "cuda", std::to_string(n)}), 20.0 * static_cast<double>(n), [&] {
            const auto order = abut::detail::order_on_curve(on, points.view());
            abut::execution::buffer<plain_answer, abut::device_space> answers(on, n);
            plain_walk<<<static_cast<unsigned>((n + block - 1) / block), block, 0, on.stream>>>(
                index.view(), shapes.view(), points.view(), order.data(), answers.data());
            bench::check(cudaGetLastError(), "plain_walk");
            return counters{{"points", static_cast<double>(answers.size())}};
        });
    }
}

template <class Index>
void add(const abut::cuda& on, const nearest_scene::question& ask, const char* name, const Index& index, table& out) {
    const double mesh_bytes = 12.0 * static_cast<double>(ask.mesh->vertices.size() + ask.mesh->faces.size());
    for (const std::size_t n : ask.counts) {
        const abut::points<float, abut::device_space> points(on, ask.points(*ask.mesh, n));
        const double least = mesh_bytes + static_cast<double>(index.bytes()) + (12.0 + 20.0) * static_cast<double>(n);
        out.add(joined({ask.name, name, "cuda", std::to_string(n)}), least, [&] {
            return counters{{"points", static_cast<double>(abut::nearest(on, index, points).size())}};
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mesh_file = bench::take_argument(argc, argv, "--mesh");
    return bench::run("bench_nearest_cuda", argc, argv, [&](const abut::cuda& on, table& out) {
        for (const auto& ask : nearest_scene::questions(mesh_file)) {
            const abut::mesh<float, abut::device_space> mesh(on, ask.mesh->vertices, ask.mesh->faces);
            const auto tree = abut::make_bvh(on, mesh);
            const auto joined_tree = abut::make_bvh(on, mesh, {.builder = abut::bvh_builder::ploc});
            add(on, ask, "bvh", tree, out);
            add(on, ask, "ploc", joined_tree, out);
            add_plain(on, ask, joined_tree, mesh, out);
            add(on, ask, "oriented", abut::oriented(on, joined_tree), out);
            add(on, ask, "quantised", abut::quantised(on, tree), out);
        }
    });
}
