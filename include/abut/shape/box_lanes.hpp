// SPDX-License-Identifier: MIT
#pragma once

// Four boxes side by side, and the tests of boxes in one frame or two on all of them at once: the same operations in the
// same order as for one box (bounds.hpp, relative_pose.hpp), and so the same bounds on errors.

#include <abut/arithmetic/lanes.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut::detail {

/// As with lanes, what two compilers make of it has two names.
template <scalar T, class Register = typename register_of<T>::type>
struct box_lanes {
    using lanes_type = lanes<T, Register>;
    vec3<lanes_type> lower, upper;

    /// From their planes: lower x, y and z of all, then upper x, y and z.
    ABUT_INLINE ABUT_HD static box_lanes load(const T (&planes)[6][4]) {
        return {{lanes_type::load(planes[0]), lanes_type::load(planes[1]), lanes_type::load(planes[2])},
                {lanes_type::load(planes[3]), lanes_type::load(planes[4]), lanes_type::load(planes[5])}};
    }
    /// One box four times.
    ABUT_INLINE ABUT_HD static box_lanes all(const aabb<T>& box) {
        return {{lanes_type::all(box.lower.x), lanes_type::all(box.lower.y), lanes_type::all(box.lower.z)},
                {lanes_type::all(box.upper.x), lanes_type::all(box.upper.y), lanes_type::all(box.upper.z)}};
    }
};

/// Whether boxes of one frame share a point.
template <scalar T, class Register>
ABUT_INLINE ABUT_HD auto overlaps(const box_lanes<T, Register>& a, const box_lanes<T, Register>& b) {
    return ((a.lower.x <= b.upper.x) & (b.lower.x <= a.upper.x)) & ((a.lower.y <= b.upper.y) & (b.lower.y <= a.upper.y)) &
           ((a.lower.z <= b.upper.z) & (b.lower.z <= a.upper.z));
}

template <scalar T, class Register>
ABUT_INLINE ABUT_HD vec3<lanes<T, Register>> absolute(const vec3<lanes<T, Register>>& v) {
    return {absolute(v.x), absolute(v.y), absolute(v.z)};
}
template <scalar T, class Register>
ABUT_INLINE ABUT_HD auto exceeds(const vec3<lanes<T, Register>>& v, const vec3<lanes<T, Register>>& limit) {
    return (v.x > limit.x) | (v.y > limit.y) | (v.z > limit.z);
}

/// Whether boxes of two frames may hold shapes that meet in the world, by the faces of both boxes.
template <scalar T, class Register>
ABUT_INLINE ABUT_HD auto overlaps(const box_lanes<T, Register>& a, const relative_pose<T>& pose,
                                  const box_lanes<T, Register>& b) {
    using many = lanes<T, Register>;
    const auto all = [](const vec3<T>& v) { return vec3<many>{many::all(v.x), many::all(v.y), many::all(v.z)}; };
    const vec3<many> r[] = {all(pose.rotation[0]), all(pose.rotation[1]), all(pose.rotation[2])};
    const vec3<many> m[] = {all(pose.magnitude[0]), all(pose.magnitude[1]), all(pose.magnitude[2])};
    const vec3<many> middle = b.lower + b.upper, shift = all(pose.translation + pose.translation);
    const vec3<many> d = vec3<many>{dot(r[0], middle), dot(r[1], middle), dot(r[2], middle)} + (shift - (a.lower + a.upper));
    const vec3<many> side_a = a.upper - a.lower, side_b = b.upper - b.lower;
    const many slack = many::all(2 * pose.slack);
    return !(apart_by_a(side_a, side_b, d, m, slack) | apart_by_b(side_a, side_b, d, r, m, slack));
}

}  // namespace abut::detail
