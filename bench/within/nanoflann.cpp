// SPDX-License-Identifier: MIT
//
// The peer for points: nanoflann's k-d tree in float on one thread, with leaves of 10 points, which its documentation names
// as a good size. Each point asks for all within the radius, unsorted, and its pairs are kept in one list, whose memory is
// there before. Squares are rounded: a pair that is at the radius but for rounding may be missed or be too much.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <nanoflann.hpp>

#include "peer.hpp"

namespace {

/// What nanoflann asks of a set of points.
struct point_set {
    const std::vector<abut::vec3<float>>& points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using kd_tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, point_set>, point_set, 3, std::uint32_t>;

void neighbours(benchmark::State& state, const within_peer::cloud& c, double radius) {
    const point_set set{c.points};
    const kd_tree index(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    nanoflann::SearchParams how;
    how.sorted = false;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::vector<std::pair<std::uint32_t, float>> near;
    for (auto _ : state) {
        pairs.clear();
        for (std::uint32_t i = 0; i < c.points.size(); ++i) {
            const float from[3] = {c.points[i].x, c.points[i].y, c.points[i].z};
            near.clear();
            index.radiusSearch(from, static_cast<float>(radius * radius), near, how);
            for (const auto& found : near) pairs.emplace_back(i, found.first);
        }
        benchmark::DoNotOptimize(pairs.data());
    }
    within_peer::note(state, pairs.size());
}

[[maybe_unused]] const bool registered = (within_peer::add("points/nanoflann", neighbours), true);

}  // namespace
