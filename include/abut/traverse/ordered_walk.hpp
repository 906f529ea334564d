// SPDX-License-Identifier: MIT
#pragma once

// Walks that look for what is least: nearest first, and less and less far as better is found. A walk takes a reach that
// shrinks, a sink of execution/ordered.hpp, whose bound shrinks it, and a visitor, which offers the sink what it finds. It
// passes over nothing that may be as good as the bound, so that of equals the least key is found too.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/rigid.hpp>
#include <abut/traverse/grid_walk.hpp>
#include <abut/traverse/reach.hpp>

namespace abut {

/// A prune functor that tightens. `least_in(box)` orders boxes by how much what lies in them measures at least;
/// `keeps(least)` is what the reach says of a box of that; and after `shrink_to(bound)` it may leave out what measures more
/// than bound, and nothing else.
template <class R, class T>
concept shrinking_reach = prune_functor<R, T> && requires(R& reach, const aabb<T>& box, double bound) {
    { reach.least_in(box) } -> std::same_as<T>;
    { reach.keeps(T{}) } -> std::same_as<bool>;
    reach.shrink_to(bound);
};

namespace detail {

/// How squared distances in the world relate to those from a point to boxes in the frame of an object: what is at least x
/// away in the frame is at least (x - slack) / stretch away in the world. Lengths in the world have a unit of their own.
struct distance_map {
    double unit = 1, slack = 0, stretch = 1;
};

/// A ball around a point, of all space at first, which shrinks to squared distances that are found. What is cut off is
/// surely farther: the square of a box's distance is computed with a relative error below 6u, as for ball_reach, and the
/// limit has 32u, which covers its own rounding too; underflow is below twice the smallest normal number. A limit that
/// overflows is infinite, and keeps all, NaN too.
template <scalar T>
struct shrinking_ball {
    vec3<T> center;
    distance_map map;
    T limit = infinity<T>;

    ABUT_HD T least_in(const aabb<T>& box) const {
        const vec3<T> away = center - least(greatest(center, box.lower), box.upper);
        return dot(away, away);
    }
    /// Of a volume that bounds distances better than the box around it.
    template <class V>
        requires requires(const V& volume, const vec3<T>& p) { least_squared_distance(volume, p); }
    ABUT_HD T least_in(const V& volume) const {
        return least_squared_distance(volume, center);
    }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return !(least > limit); }
    ABUT_HD bool operator()(const aabb<T>& box) const { return keeps(least_in(box)); }
    /// bound: a squared distance in the world, in its unit.
    ABUT_HD void shrink_to(double bound) {
        constexpr double grown = 1 + 32 * static_cast<double>(unit_roundoff<T>);
        constexpr double tiny = 2 * static_cast<double>(smallest_normal<T>);
        bound += 4 * smallest_normal<double>;  // less was lost of squares in this unit
        double square = bound * map.unit * map.unit;
        if (map.slack > 0) {
            const double radius = (std::sqrt(bound) * map.unit + map.slack) * map.stretch;
            square = radius * radius;
        }
        limit = static_cast<T>(square * grown + tiny);
    }
    /// A ball of nothing: it keeps no box.
    ABUT_HD void close() { limit = -1; }
    /// Not less than the ball's.
    [[nodiscard]] ABUT_HD T radius() const {
        return static_cast<T>(std::sqrt(static_cast<double>(limit)) * (1 + 8 * static_cast<double>(unit_roundoff<T>)));
    }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return abut::bounds(sphere<T>{center, radius()}); }
};

/// What a point in the world sees of an index that lies there as it is.
template <scalar T>
struct world_frame {
    double unit = 1;
    [[nodiscard]] ABUT_HD shrinking_ball<T> ball_around(const vec3<T>& p) const { return {p, {unit, 0, 1}}; }
};

/// What a point p in the world sees of an index whose shapes, which lie in `around`, a pose places: boxes in the object's
/// frame, where p is at A^T (p - t) but for rounding. As in relative_pose.hpp, D = A^T A - 1 and `deviation` is the largest
/// entry of D, as it is measured; no singular value of A is less than 1 - 1.6 deviation. A point q in the frame is placed at
/// A q + t, and A q + t - p = A (q - B (p - t)) with the inverse B of A. B (p - t) differs from A^T (p - t) by D B (p - t),
/// which is below 4 deviation |p - t|, and that is rounded. A ball is placed by its centre and its radius stays, which adds
/// 1.6 deviation of the radius; and `place` rounds. Where anything might overflow, the slack is infinite.
template <scalar T>
struct object_frame {
    double unit = 1;
    rigid<T> pose;
    double deviation = 0, size = 0;  ///< the farthest coordinates in `around`, summed up

    object_frame() = default;
    object_frame(double unit_of_lengths, const rigid<T>& p, const aabb<T>& around)
        : unit(unit_of_lengths),
          pose(p),
          deviation(detail::deviation(widened(column(p.rotation, 0)), widened(column(p.rotation, 1)),
                                      widened(column(p.rotation, 2)))),
          size(farthest(around)) {}

    [[nodiscard]] ABUT_HD shrinking_ball<T> ball_around(const vec3<T>& p) const {
        const vec3<double> t = widened(pose.translation), x = widened(p) - t;
        const double far = magnitudes(widened(p)) + magnitudes(t);
        if (!(far + size < static_cast<double>(largest_finite<T>) / 64)) return {p, {unit, infinity<double>, 1}};
        const vec3<double> at{dot(widened(column(pose.rotation, 0)), x), dot(widened(column(pose.rotation, 1)), x),
                              dot(widened(column(pose.rotation, 2)), x)};
        constexpr double u = static_cast<double>(unit_roundoff<T>);
        const double slack = (5 * deviation + 32 * u) * far + (2 * deviation + 16 * u) * (size + magnitudes(t)) +
                             16 * static_cast<double>(smallest_normal<T>);
        return {to_scalar<T>(at), {unit, slack, 1 + 2 * deviation}};
    }
};

/// What the sink knows by now shrinks the reach; `bound` is what it knew before.
ABUT_CALLS_ANY
template <class Reach, class Best>
ABUT_HD void tighten(Reach& reach, const Best& best, double& bound) {
    if (best.bound() < bound) {
        bound = best.bound();
        reach.shrink_to(bound);
    }
}

/// Least distance of what a node's slot holds: of its volume where there is one that tells, or else of its box.
template <class Reach, class Tree>
ABUT_HD auto least_in_slot(const Reach& reach, const Tree& tree, const typename Tree::node_type& node, int slot) {
    if constexpr (requires { reach.least_in(tree.volume(node, slot)); }) {
        return reach.least_in(tree.volume(node, slot));
    } else {
        return reach.least_in(tree.bounds(node, slot));
    }
}

/// Nearest child first; the others wait with their distances, and are dropped when their turn comes if the reach has shrunk
/// below that. Leaves wait like nodes. A walk without branches on what is nearer and what is kept was tried, also with four
/// nodes at a time: it took half as long again on one core, which guesses right more often than not.
///
/// A team (execution/ordered.hpp) walks as one: it goes where any of its threads has to, and first where most of them are
/// nearer. Each thread keeps distances of its own, and visits what it keeps itself.
template <bvh_layout Tree>
struct ordered_tree_walk {
    using T = typename Tree::scalar_type;
    static constexpr bool in_teams = true;
    Tree tree;

    ABUT_CALLS_ANY
    template <shrinking_reach<T> Reach, class Best, class Visitor, class Team = execution::alone>
    ABUT_HD void operator()(Reach& reach, Best& best, const Visitor& visitor, Team = {}) const {
        struct entry {
            bvh_child child;
            T least;
        };
        entry pending[bvh_max_depth * (Tree::width - 1) + 1];  // not initialised
        int waiting = 0;
        double bound = infinity<double>;
        tighten(reach, best, bound);
        entry at{tree.root(), T(0)};
        for (;;) {
            while (Team::any(reach.keeps(at.least)) && !at.child.is_leaf()) {
                const auto& node = tree.fetch(at.child.index());
                at = {tree.child(node, 0), least_in_slot(reach, tree, node, 0)};
                tree.prefetch(at.child);
                for (int slot = 1; slot < tree.children(node); ++slot) {
                    entry other{tree.child(node, slot), least_in_slot(reach, tree, node, slot)};
                    tree.prefetch(other.child);
                    if (Team::most(other.least < at.least)) {
                        const entry before = at;
                        at = other;
                        other = before;
                    }
                    pending[waiting] = other;
                    waiting += Team::any(reach.keeps(other.least));
                }
            }
            if (reach.keeps(at.least)) visitor(at.child.index());
            tighten(reach, best, bound);
            do {
                if (waiting == 0) return;
                at = pending[--waiting];
            } while (!Team::any(reach.keeps(at.least)));
        }
    }
};

/// A part of a ball that shrinks: what of it is in a box.
template <class Reach, scalar T>
struct reach_in_box {
    Reach& reach;
    aabb<T> box;
    ABUT_HD bool operator()(const aabb<T>& other) const { return reach(other); }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return box; }
};

/// A grid has no order from near to far: it is asked for what lies within a cell's width, then within twice that, and so on,
/// until the best is nearer than that, or all has been seen. What was seen before is offered again, which changes nothing.
template <class Grid>
struct ordered_grid_walk {
    using T = typename Grid::scalar_type;
    static constexpr bool in_teams = false;
    Grid grid;

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach& reach, Best& best, const Visitor& visitor) const {
        const auto frame = *grid.frame;
        const grid_walk<Grid> walk{grid};
        double bound = infinity<double>;
        tighten(reach, best, bound);
        const auto shrinks = [&](std::uint32_t id) {
            visitor(id);
            tighten(reach, best, bound);
            return visit::proceed;
        };
        const auto width = static_cast<T>(1 / frame.cells_per_unit);
        T radius = static_cast<T>(std::sqrt(static_cast<double>(reach.least_in(frame.bounds)))) + width;
        radius = greatest(radius, smallest_normal<T>);  // or it might stay 0
        for (;; radius += radius) {
            const bool is_last = !(radius < reach.radius());
            const aabb<T> box = is_last ? reach.bounds() : bounds(sphere<T>{reach.center, radius});
            reach_in_box<Reach, T> within{reach, box};
            typename grid_walk<Grid>::cursor at;
            walk.for_each(within, at, [] { return false; }, shrinks);
            if (is_last || radius >= reach.radius() || contains(box, frame.bounds)) return;
        }
    }
};

/// All of n shapes, one after another.
struct ordered_list_walk {
    static constexpr bool in_teams = false;
    std::size_t count;

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach&, Best&, const Visitor& visitor) const {
        for (std::size_t i = 0; i < count; ++i) visitor(static_cast<std::uint32_t>(i));
    }
};

}  // namespace detail

}  // namespace abut
