// SPDX-License-Identifier: MIT
#pragma once

// A walk through a posed index: what a query reaches in the world, in the frame of the index.

#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::detail {

/// A prune functor over boxes of a posed object. `query` is a box in the world; see `posed_walk` for how far it goes.
template <scalar T>
struct posed_reach {
    aabb<T> query;
    const relative_pose<T>* to_world;

    ABUT_HD bool operator()(const aabb<T>& box) const { return overlaps(query, *to_world, box); }
    /// In the object's frame. The test of the second box's faces (relative_pose.hpp), solved for where it may be; twice the
    /// slack covers the two roundings more.
    [[nodiscard]] ABUT_HD aabb<T> bounds() const {
        const auto &r = to_world->rotation, &m = to_world->magnitude;
        const T slack = 4 * to_world->slack;
        if (!(slack < infinity<T>)) return {{-slack, -slack, -slack}, {slack, slack, slack}};
        const vec3<T> middle = (query.lower + query.upper) - (to_world->translation + to_world->translation);
        const vec3<T> size = query.upper - query.lower;
        const vec3<T> center = middle.x * r[0] + middle.y * r[1] + middle.z * r[2];
        const vec3<T> width = size.x * m[0] + size.y * m[1] + size.z * m[2] + vec3<T>{slack, slack, slack};
        return {T(0.5) * (center - width), T(0.5) * (center + width)};
    }
};

/// `walk` is over an object in its own frame, whose shapes lie in `around`; the world sees them moved by `pose`.
template <class Walk>
struct posed_walk {
    using scalar_type = typename Walk::scalar_type;
    using T = scalar_type;
    using cursor = typename Walk::cursor;

    Walk walk;
    aabb<T> world;  ///< around all that the object reaches there
    relative_pose<T> to_world;

    ABUT_HD posed_walk(const Walk& in_frame, const rigid<T>& pose, const aabb<T>& around)
        : walk(in_frame), world(world_box(pose, around)), to_world(make_relative_pose(rigid<T>{}, world, pose, around)) {}

    /// False if the query touches nothing in the object. Most queries are far away, which the world's box tells at less cost
    /// than the query's own bounds.
    template <class Reach>
    ABUT_HD bool may_touch(Reach& reach) const {
        if (!reach(world)) return false;
        posed_reach<T> posed{clipped(reach), &to_world};
        return !is_empty(posed.query) && walk.may_touch(posed);
    }

    /// As the walk in the frame.
    template <class Reach, class Cursor, class Rests, class Visitor>
    ABUT_HD bool for_each(Reach& reach, Cursor& at, const Rests& rests, Visitor&& visitor) const {
        posed_reach<T> posed{clipped(reach), &to_world};
        return walk.for_each(posed, at, rests, std::forward<Visitor>(visitor));
    }

private:
    /// What meets the object meets it in its box in the world; so the query need not be larger than that, which is what the
    /// slack of the relative pose is made for.
    template <class Reach>
    ABUT_HD aabb<T> clipped(Reach& reach) const {
        const aabb<T> box = reach.bounds();
        return {greatest(box.lower, world.lower), least(box.upper, world.upper)};
    }
    ABUT_HD static bool is_empty(const aabb<T>& box) {
        return box.lower.x > box.upper.x || box.lower.y > box.upper.y || box.lower.z > box.upper.z;
    }
};

}  // namespace abut::detail
