// SPDX-License-Identifier: MIT
//
// The peer for points: nanoflann's k-d tree over the torus's vertices, or over the centres, in float, on one thread, with
// the leaves that its documentation names as a good size. Memory for the answers is taken within the clock, as by abut. Its
// points come in the order in which they are. Squares are rounded, so of vertices that are nearly as near it may find
// another one than abut does.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include "peer.hpp"

namespace {

/// What nanoflann asks of a set of points.
struct cloud {
    std::vector<abut::vec3<float>> points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using kd_tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, cloud>, cloud, 3, std::uint32_t>;

struct answer {
    std::uint32_t id;
    float square;
};

void nearest_vertex(benchmark::State& state, std::size_t n) {
    const cloud vertices{scene::torus<float>().vertices};
    const kd_tree index(3, vertices, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    const auto points = scene::centers<float>(n);
    double sum = 0;
    for (auto _ : state) {
        std::vector<answer> found(n);
        for (std::size_t i = 0; i < n; ++i) {
            const float from[3] = {points[i].x, points[i].y, points[i].z};
            index.knnSearch(from, 1, &found[i].id, &found[i].square);
        }
        state.PauseTiming();
        sum = 0;
        for (const answer& a : found) sum += std::sqrt(static_cast<double>(a.square));
        state.ResumeTiming();
    }
    nearest_peer::note(state, n, sum);
}

void nearest_few(benchmark::State& state, std::size_t n) {
    constexpr std::size_t count = 8;
    const cloud centers{scene::centers<float>(n)};
    const kd_tree index(3, centers, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    std::vector<std::uint32_t> ids;
    std::vector<float> squares;
    const auto ask = [&] {
        ids.assign(count * n, 0);
        squares.assign(count * n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            const float from[3] = {centers.points[i].x, centers.points[i].y, centers.points[i].z};
            index.knnSearch(from, count, ids.data() + count * i, squares.data() + count * i);
        }
    };
    double sum = 0;
    ask();  // so that the process has the memory
    for (auto _ : state) {
        ask();
        state.PauseTiming();
        sum = 0;
        for (const float square : squares) sum += std::sqrt(static_cast<double>(square));
        state.ResumeTiming();
    }
    nearest_peer::note(state, n, sum / count);
}

[[maybe_unused]] const bool registered = nearest_peer::add("nearest_vertex/nanoflann/serial", nearest_vertex) &&
                                         nearest_peer::add("nearest_few/nanoflann/serial", nearest_few);

}  // namespace
