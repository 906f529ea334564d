// SPDX-License-Identifier: MIT
#pragma once

// What is right of the pairs of extremes.hpp, in unbounded integers.

#include "extremes.hpp"
#include "hulls.hpp"
#include "motion_oracle.hpp"
#include "rational.hpp"

namespace abut::test {

template <scalar T>
bool touch_in_truth(const pair_of<triangle<T>, triangle<T>>& p) {
    return oracle::intersects(p.a, p.b);
}
template <scalar T>
bool touch_in_truth(const pair_of<sphere<T>, triangle<T>>& p) {
    return oracle::intersects(p.a, p.b);
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
