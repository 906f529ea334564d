// SPDX-License-Identifier: MIT
#pragma once

// The builder of bvh_builder::ploc: clusters of shapes joined from the bottom up, locally (Meister and Bittner, "Parallel
// Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", 2018). Clusters stand in a row, at first one for
// each shape, along a Morton curve. In each round every cluster looks among its neighbours in the row for the one with which
// it would have the least surface; two that choose each other are joined, and the row closes up.
//
// Topology and boxes depend on the shapes alone: surfaces are computed without contraction, and what decides between equal
// ones is places in the row.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/execution/work_queue.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/leaf_order.hpp>
#include <abut/index/morton.hpp>
#include <abut/index/top_down.hpp>
#include <abut/shape/box_measure.hpp>

namespace abut::detail {

/// How far a cluster looks, in places to either side. Looking farther costs time in proportion and gains next to nothing
/// (docs/results/trees.md).
inline constexpr std::uint32_t ploc_radius = 4;
/// Each round makes the tree one level deeper at most. In some rows only one pair joins in a round, as where shapes contain
/// each other; so neighbours join whatever they are, which halves the row, as soon as there are no more levels than that
/// needs. Sets as they are get nowhere near: a round leaves three clusters of four.
constexpr bool has_to_halve(int round, std::size_t clusters) { return round + least_depth(clusters) >= bvh_max_depth; }
/// So few clusters are joined on the calling thread: a round over them waits for the device or for threads, and not for
/// work.
inline constexpr std::size_t ploc_few = 256;

/// A tree over some shapes that has yet to be joined with others. `seat` is the place in the first row of the first leaf
/// below it: joined, the cluster that comes first keeps its own, and the other's names the node, number seat - 1. Nobody
/// comes before the first cluster of a row, so each other seat names one node; and nodes lie near the leaves below them.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 16 : 8) cluster {
    aabb<T> box;
    bvh_child child;
    std::uint32_t seat;
};

template <class Code, scalar T>
struct first_clusters {
    const aabb<T>* boxes;
    is_crowded<Code> test;
    const std::uint32_t* ids;
    cluster<T>* row;
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD void operator()(std::size_t i, Count& crowded) const {
        const std::uint32_t id = ids[i];
        row[i] = {boxes[id], bvh_child::leaf(id), static_cast<std::uint32_t>(i)};
        crowded.add(test(i));
    }
};

/// Half the surface of a box, in units of the scene's that neither overflow nor all underflow, and next to nothing for the
/// length of its sides: that counts where shapes lie in a line and no box has a surface. The same bits on every policy.
template <scalar T>
struct plain_area {
    T unit;

    explicit plain_area(const aabb<T>& scene) {
        const auto half = [](T lower, T upper) { return sum_of_halves(upper, -lower); };
        const vec3<T> sides{half(scene.lower.x, scene.upper.x), half(scene.lower.y, scene.upper.y),
                            half(scene.lower.z, scene.upper.z)};
        unit = greatest(T(0.5) * surface_unit(longest(sides)), smallest_normal<T>);
    }
    /// A box that ends at infinity may have no surface that is a number; it counts as the largest.
    ABUT_HD T operator()(const aabb<T>& box) const {
        const vec3<T> sides{plain_product(unit, plain_sum(box.upper.x, -box.lower.x)),
                            plain_product(unit, plain_sum(box.upper.y, -box.lower.y)),
                            plain_product(unit, plain_sum(box.upper.z, -box.lower.z))};
        const T length = plain_sum(plain_sum(sides.x, sides.y), sides.z);
        const T area = plain_sum(plain_half_surface(sides), plain_product(T(0x1p-40), length));
        return area < infinity<T> ? area : infinity<T>;
    }
};

/// Where in the row the cluster is with which the one at i would have the least surface; of equal ones the one whose place
/// differs from i in the lowest bits. Of all pairs the least chooses each other, and in a row of equals all neighbours do.
template <scalar T>
struct find_nearest {
    const cluster<T>* row;
    std::uint32_t count;
    bool as_they_come;  ///< neighbours join whatever they are
    plain_area<T> area;
    std::uint32_t* nearest;

    ABUT_HD void operator()(std::size_t i) const {
        const auto at = static_cast<std::uint32_t>(i);
        if (as_they_come) {
            nearest[at] = (at ^ 1) < count ? at ^ 1 : at;
            return;
        }
        const aabb<T> box = row[at].box;
        T least = infinity<T>;
        std::uint32_t least_bits = static_cast<std::uint32_t>(-1);
        const auto look = [&](std::uint32_t other) {
            const T joint = area(merge(box, row[other].box));
            const std::uint32_t bits = other ^ at;
            const bool closer = (joint < least) | ((joint == least) & (bits < least_bits));
            least = closer ? joint : least;
            least_bits = closer ? bits : least_bits;
        };
        if (at >= ploc_radius && count - at > ploc_radius) {
            for (std::uint32_t k = 1; k <= ploc_radius; ++k) {
                look(at - k);
                look(at + k);
            }
        } else {
            const std::uint32_t first = at < ploc_radius ? 0 : at - ploc_radius;
            const std::uint32_t end = count - at > ploc_radius ? at + ploc_radius + 1 : count;
            for (std::uint32_t other = first; other < end; ++other) {
                if (other != at) look(other);
            }
        }
        nearest[at] = least_bits ^ at;
    }
};

/// Of two that chose each other the first keeps its place.
struct keeps_place {
    const std::uint32_t* nearest;
    ABUT_HD bool operator()(std::size_t i) const {
        const std::uint32_t other = nearest[i];
        return other >= i || nearest[other] != i;
    }
};

template <scalar T>
struct join_clusters {
    const cluster<T>* row;
    const std::uint32_t* nearest;
    const std::uint32_t* kept;
    bvh_node<T>* nodes;
    cluster<T>* next;

    ABUT_HD void operator()(std::size_t k) const {
        const std::uint32_t i = kept[k], other = nearest[i];
        cluster<T> joined = row[i];
        if (other > i && nearest[other] == i) {
            const cluster<T> right = row[other];
            const std::uint32_t node = right.seat - 1;
            nodes[node] = {{joined.box, right.box}, {joined.child, right.child}};
            joined.box = merge(joined.box, right.box);
            joined.child = bvh_child::inner(node);
        }
        next[k] = joined;
    }
};

/// A row of clusters and what its rounds need; all in the policy's memory.
template <class Policy, scalar T>
class cluster_row {
public:
    cluster_row(const Policy& policy, std::size_t n)
        : count_(n), row_(policy, n), next_(policy, n), nearest_(policy, n), kept_(policy, n) {}

    [[nodiscard]] cluster<T>* data() { return row_.data(); }
    [[nodiscard]] std::size_t size() const { return count_; }

    void join(const Policy& on, const plain_area<T>& area, int round, bvh_node<T>* nodes) {
        const bool as_they_come = has_to_halve(round, count_);
        for_each_index(
            on, count_,
            find_nearest<T>{row_.data(), static_cast<std::uint32_t>(count_), as_they_come, area, nearest_.data()});
        count_ = compact(on, count_, keeps_place{nearest_.data()}, kept_.data());
        for_each_index(on, count_, join_clusters<T>{row_.data(), nearest_.data(), kept_.data(), nodes, next_.data()});
        row_.swap(next_);
    }

private:
    std::size_t count_;
    execution::buffer_of<Policy, cluster<T>> row_, next_;
    execution::buffer_of<Policy, std::uint32_t> nearest_, kept_;
};

/// Puts a tree whose leaves are clusters above these.
template <scalar T>
struct put_above {
    const cluster<T>* clusters;
    const bvh_node<T>* top;
    bvh_root<T> top_root;
    bvh_node<T>* nodes;
    bvh_root<T>* root;

    ABUT_HD void operator()(std::size_t i) const {
        if (i == 0) {
            *root = {top_root.bounds, renamed(top_root.child)};
            return;
        }
        const bvh_node<T> node = top[i - 1];
        nodes[clusters[i].seat - 1] = {{node.bounds[0], node.bounds[1]}, {renamed(node.child[0]), renamed(node.child[1])}};
    }

private:
    [[nodiscard]] ABUT_HD bvh_child renamed(bvh_child child) const {
        return child.is_leaf() ? clusters[child.index()].child : bvh_child::inner(clusters[child.index() + 1].seat - 1);
    }
};

/// The first row: leaves in the order of codes of `bits` bits. Returns how many are crowded.
template <class Code, execution_policy Policy, scalar T>
std::uint64_t line_up(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, const bvh_root<T>* root,
                      int bits, cluster<T>* row) {
    const std::size_t n = boxes.size();
    const auto order = order_leaves<Code, Policy, T>(on, boxes, root, bits);
    execution::work_count<space_of<Policy>> crowded(on);
    for_each_index(on, n, first_clusters<Code, T>{boxes.data(), {order.codes.data(), n}, order.ids.data(), row}, crowded);
    return crowded.total();
}

/// Joins the few clusters of a row that are left, on the calling thread, and puts their tree above them. `round` is that of
/// the row.
template <execution_policy Policy, scalar T, class Storage>
void join_few(const Policy& on, cluster_row<Policy, T>& row, const plain_area<T>& area, int round, Storage& tree) {
    const std::size_t few = row.size();
    cluster_row<execution::serial, T> few_row(execution::serial{}, few);
    execution::buffer<bvh_node<T>, host_space> top(execution::serial{}, few - 1);
    download(on, row.data(), few, few_row.data());
    for (std::uint32_t k = 0; k < few; ++k) {
        few_row.data()[k].child = bvh_child::leaf(k);
        few_row.data()[k].seat = k;
    }
    while (few_row.size() > 1) few_row.join(execution::serial{}, area, round++, top.data());
    const bvh_root<T> top_root{few_row.data()->box, few_row.data()->child};
    execution::buffer_of<Policy, bvh_node<T>> uploaded(on, few - 1);
    upload(on, top.data(), few - 1, uploaded.data());
    for_each_index(on, few, put_above<T>{row.data(), uploaded.data(), top_root, tree.nodes.data(), tree.root.data()});
    synchronize(on);
}

/// Builds a tree over n > 0 shapes into storage of that size, whose root has the scene's box. `bits` are those of the codes,
/// 0 to choose as bvh_options says.
template <execution_policy Policy, scalar T, class Storage>
void build_ploc(const Policy& on, const execution::buffer_of<Policy, aabb<T>>& boxes, Storage& tree, int bits) {
    const std::size_t n = boxes.size();
    bvh_root<T> scene;
    download(on, tree.root.data(), 1, &scene);
    const plain_area<T> area(scene.bounds);
    cluster_row<Policy, T> row(on, n);
    const bvh_root<T>* const root = tree.root.data();
    const int few_bits = bits == 0 ? sufficient_morton_bits(n) : 30;
    if (bits == 63 || (line_up<std::uint32_t, Policy, T>(on, boxes, root, few_bits, row.data()) > n / 8 && bits == 0)) {
        line_up<std::uint64_t, Policy, T>(on, boxes, root, 63, row.data());
    }
    int round = 0;
    while (row.size() > ploc_few) row.join(on, area, round++, tree.nodes.data());
    join_few(on, row, area, round, tree);
}

}  // namespace abut::detail
