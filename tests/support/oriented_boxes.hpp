// SPDX-License-Identifier: MIT
#pragma once

// Oriented boxes for tests: turned in general or by multiples of 90 degrees, on a lattice or not, flat ones too, and the
// corners that they are defined by.

#include <cmath>
#include <vector>

#include <abut/shape/oriented_box.hpp>

#include "draws.hpp"
#include "poses.hpp"
#include "scenes.hpp"

namespace abut::test {

/// Bit k of a corner's number says on which side it is of axis k.
template <class T>
std::vector<vec3<T>> corners_of(const aabb<T>& box) {
    std::vector<vec3<T>> all;
    for (int i = 0; i < 8; ++i) {
        all.push_back({(i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                       (i & 4) != 0 ? box.upper.z : box.lower.z});
    }
    return all;
}

/// By definition.
template <scalar T>
std::vector<vec3<T>> corners_of(const oriented_box<T>& box) {
    rigid<T> pose{.translation = box.center};
    for (int i = 0; i < 9; ++i) pose.rotation[i] = box.rotation[i];
    std::vector<vec3<T>> corners;
    for (int i = 0; i < 8; ++i) {
        const auto end = [&](int axis, T half) { return (i >> axis & 1) != 0 ? half : -half; };
        corners.push_back(place(pose, vec3<T>{end(0, box.half.x), end(1, box.half.y), end(2, box.half.z)}));
    }
    return corners;
}

/// In a box of side 2. On a lattice turned by multiples of 90 degrees, so that many touch exactly; some are flat.
template <scalar T>
oriented_box<T> random_oriented_box(uniform& random, std::uint64_t seed, std::uint64_t index, bool on_lattice) {
    const auto number = [&](double lower, double upper) {
        const double x = random(lower, upper);
        return static_cast<T>(on_lattice ? std::floor(x * 4 + 0.5) / 4 : x);
    };
    oriented_box<T> box{{number(-1, 1), number(-1, 1), number(-1, 1)}, {number(0, 0.5), number(0, 0.5), number(0, 0.5)}};
    if (index % 7 == 0) box.half.z = 0;
    draws d(seed, 131, index);
    rigid<T> turn;
    if (on_lattice) {
        construction::set_quarter_turns(turn, d);
    } else {
        construction::set_rotation(turn, random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1));
    }
    for (int i = 0; i < 9; ++i) box.rotation[i] = turn.rotation[i];
    return box;
}

}  // namespace abut::test
