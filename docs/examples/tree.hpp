// SPDX-License-Identifier: MIT
#pragma once

// A shape of one's own that is made of others, with all that a shape can supply: a tree is a trunk and a crown.
// docs/extending.md shows this file, and tests/collide/extending.test.cpp tries it in all queries.

#include <abut/abut.hpp>

namespace plant {

template <abut::scalar T>
struct tree {
    abut::capsule<T> trunk;
    abut::sphere<T> crown;
};

template <abut::scalar T>
ABUT_HD constexpr abut::aabb<T> bounds(const tree<T>& s) {
    return merge(bounds(s.trunk), bounds(s.crown));
}
template <abut::scalar T>
ABUT_HD constexpr bool is_valid(const tree<T>& s) {
    return is_valid(s.trunk) && is_valid(s.crown);
}
template <abut::scalar T>
ABUT_HD constexpr tree<T> place(const abut::rigid<T>& pose, const tree<T>& s) {
    return {place(pose, s.trunk), place(pose, s.crown)};
}

/// Touching: either part does. All stages are the last one.
template <abut::scalar T, abut::shape U>
ABUT_HD constexpr bool resolve(const tree<T>& s, const U& t) {
    return abut::intersects(s.trunk, t) || abut::intersects(s.crown, t);
}
template <abut::arithmetic A, abut::scalar T, abut::shape U>
ABUT_HD constexpr abut::verdict decide(const tree<T>& s, const U& t) {
    return abut::to_verdict(abut::intersects<A>(s.trunk, t) || abut::intersects<A>(s.crown, t));
}

/// Within a distance: the same.
template <abut::scalar T, abut::shape U>
ABUT_HD constexpr bool resolve_within(const tree<T>& s, const U& t, double distance) {
    return abut::within(s.trunk, t, distance) || abut::within(s.crown, t, distance);
}
template <abut::arithmetic A, abut::scalar T, abut::shape U>
ABUT_HD constexpr abut::verdict decide_within(const tree<T>& s, const U& t, double distance) {
    return abut::to_verdict(abut::within<A>(s.trunk, t, distance) || abut::within<A>(s.crown, t, distance));
}

/// How far: the less of two.
template <abut::scalar T, abut::shape U>
ABUT_HD constexpr abut::separation<T> separation_between(const tree<T>& s, const U& t) {
    const auto of_trunk = abut::distance(s.trunk, t), of_crown = abut::distance(s.crown, t);
    return of_crown.distance < of_trunk.distance ? of_crown : of_trunk;
}

/// The contact of the part that is deeper. Moved by its depth that part is apart from t; the other one may not be.
template <abut::scalar T, abut::shape U>
ABUT_HD constexpr abut::contact<T> contact_between(const tree<T>& s, const U& t) {
    const auto of_trunk = abut::contact_of(s.trunk, t), of_crown = abut::contact_of(s.crown, t);
    return !of_trunk || (of_crown && of_crown->depth > of_trunk->depth) ? *of_crown : *of_trunk;
}

/// When a ray or a segment meets it: the earlier time; negative is never.
template <abut::arithmetic A, class Line, abut::scalar T>
ABUT_HD constexpr double hit_time(const Line& line, const tree<T>& s) {
    const double of_trunk = abut::hit_time_of<A>(line, s.trunk), of_crown = abut::hit_time_of<A>(line, s.crown);
    return of_trunk < 0 || (of_crown >= 0 && of_crown < of_trunk) ? of_crown : of_trunk;
}

/// The nearer of two points.
template <abut::scalar T>
ABUT_HD abut::vec3<T> nearest_point(const tree<T>& s, const abut::vec3<T>& p) {
    const auto of_trunk = nearest_point(s.trunk, p), of_crown = nearest_point(s.crown, p);
    return abut::distance(p, of_crown).distance < abut::distance(p, of_trunk).distance ? of_crown : of_trunk;
}

}  // namespace plant
