// SPDX-License-Identifier: MIT
#pragma once

// Poses for tests: rotations of every kind that is accepted, up to the last unit in the last place. Drawn as draws.hpp says,
// but for `long double`, so on hosts only.

#include <cmath>

#include <abut/shape/rigid.hpp>

#include "draws.hpp"

namespace abut::test {

namespace construction {

/// The rotation by a unit quaternion that is (w, x, y, z) normalised; rounded to T.
template <scalar T>
void set_rotation(rigid<T>& pose, long double w, long double x, long double y, long double z) {
    const long double n = std::sqrt(w * w + x * x + y * y + z * z);
    w /= n, x /= n, y /= n, z /= n;
    const long double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                              2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                              2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 9; ++i) pose.rotation[i] = static_cast<T>(m[i]);
}

/// A turn by multiples of 90 degrees, one of the 24.
template <scalar T>
void set_quarter_turns(rigid<T>& pose, draws& d) {
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const int order = d.below(6), first = 1 - 2 * d.below(2), second = 1 - 2 * d.below(2);
    const int signs[3] = {first, second, (order < 3 ? 1 : -1) * first * second};
    for (T& x : pose.rotation) x = 0;
    for (int i = 0; i < 3; ++i) pose.rotation[3 * i + orders[order][i]] = static_cast<T>(signs[i]);
}

}  // namespace construction

template <scalar T>
bool is_accepted(const rigid<T>& pose) {
    try {
        detail::check(pose, "test");
    } catch (const invalid_geometry&) {
        return false;
    }
    return true;
}

/// A pose without translation: the identity, quarter turns, any rotation, nearly the identity, nearly about a coordinate
/// axis, and rotations that are as far from orthonormal as is accepted.
template <scalar T>
rigid<T> make_rotation(draws& d) {
    rigid<T> pose;
    const int kind = d.below(7);
    if (kind == 0) return pose;
    if (kind == 1) {
        construction::set_quarter_turns(pose, d);
        return pose;
    }
    double w = d.uniform(-1, 1), x = d.uniform(-1, 1), y = d.uniform(-1, 1), z = d.uniform(-1, 1);
    if (kind == 2) {  // nearly the identity
        const double angle = d.power_of_ten(-17, 0);
        w = 1, x *= angle, y *= angle, z *= angle;
    } else if (kind == 3) {  // about z, nearly
        const double off = d.power_of_ten(-17, -2);
        x *= off, y *= off;
    }
    construction::set_rotation<T>(pose, w, x, y, z);
    if (kind < 5) return pose;
    constexpr T ulp = 2 * unit_roundoff<T>;
    if (kind == 5) {  // too long or too short
        const T factor = 1 + static_cast<T>(d.below(2) == 0 ? -7 : 7) * ulp;
        rigid<T> stretched = pose;
        for (T& r : stretched.rotation) r *= factor;
        if (is_accepted(stretched)) return stretched;
        return pose;
    }
    for (int tries = 0; tries < 30; ++tries) {  // askew
        rigid<T> askew = pose;
        for (T& r : askew.rotation) r += ulp * static_cast<T>(d.uniform(-8, 8));
        if (is_accepted(askew)) return askew;
    }
    return pose;
}

template <scalar T>
rigid<T> make_pose(draws& d, double translation) {
    rigid<T> pose = make_rotation<T>(d);
    pose.translation = construction::round_to<T>(construction::cube(d, translation));
    return pose;
}

}  // namespace abut::test
