// SPDX-License-Identifier: MIT
#pragma once

// What is right of the pairs of extremes.hpp, in unbounded integers.

#include "extremes.hpp"
#include "hulls.hpp"
#include "motion_oracle.hpp"
#include "rational.hpp"
#include "ray_oracle.hpp"
#include "shape_oracles.hpp"
#include "solid_pairs.hpp"

namespace abut::test {

template <scalar T, class S, class U>
    requires requires(S a, U b) { oracle::intersects(a, b); }
bool touch_in_truth(const pair_of<S, U>& p) { return oracle::intersects(p.a, p.b); }
template <scalar T>
bool touch_in_truth(const pair_of<ray<T>, triangle<T>>& p) {
    return first_time(p.a, p.b).has_value();
}
template <scalar T>
bool touch_in_truth(const pair_of<aabb<T>, capsule<T>>& p) {
    return oracle::within_distance(p.a, p.b, 0);
}
template <scalar T>
bool touch_in_truth(const pair_of<aabb<T>, segment<T>>& p) {
    return oracle::within_distance(p.a, p.b, 0);
}
template <scalar T>
bool touch_in_truth(const pair_of<four_points<T>, four_points<T>>& p) {
    return oracle::hulls_intersect<T>({p.a.at, p.a.at + 4}, {p.b.at, p.b.at + 4});
}
template <scalar T>
bool touch_in_truth(const pair_of<abut::motion<vec3<T>>, abut::motion<triangle<T>>>& p) {
    return oracle::vertex_face<T>({{p.a.t0, p.b.t0.a, p.b.t0.b, p.b.t0.c}, {p.a.t1, p.b.t1.a, p.b.t1.b, p.b.t1.c}}).hit;
}
template <scalar T>
bool touch_in_truth(const pair_of<abut::motion<segment<T>>, abut::motion<segment<T>>>& p) {
    return oracle::edge_edge<T>({{p.a.t0.a, p.a.t0.b, p.b.t0.a, p.b.t0.b}, {p.a.t1.a, p.a.t1.b, p.b.t1.a, p.b.t1.b}}).hit;
}

}  // namespace abut::test
