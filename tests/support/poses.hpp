// SPDX-License-Identifier: MIT
#pragma once

// Poses for tests: rotations as good as rounding leaves them, and rotations of every kind that is accepted, as far from
// orthonormal as that. Drawn as draws.hpp says, but for `long double`, so on hosts only.

#include <cmath>
#include <cstdio>
#include <cstdlib>

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

/// The most by which a product of two rows differs from what it is in a rotation.
template <scalar T>
double deviation_of_rows(const rigid<T>& pose) {
    double most = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            long double sum = i == j ? -1 : 0;
            for (int k = 0; k < 3; ++k) {
                sum +=
                    static_cast<long double>(pose.rotation[3 * i + k]) * static_cast<long double>(pose.rotation[3 * j + k]);
            }
            most = std::fmax(most, static_cast<double>(std::fabs(sum)));
        }
    }
    return most;
}

/// Whether that is within 16 units in the last place.
template <scalar T>
bool is_orthonormal(const rigid<T>& pose) {
    return deviation_of_rows(pose) <= 32 * static_cast<double>(unit_roundoff<T>);
}

/// A pose without translation: the identity, quarter turns, any rotation, nearly the identity, nearly about a coordinate
/// axis, and rotations that are off from orthonormal by some units in the last place.
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
        if (is_orthonormal(stretched)) return stretched;
        return pose;
    }
    for (int tries = 0; tries < 30; ++tries) {  // askew
        rigid<T> askew = pose;
        for (T& r : askew.rotation) r += ulp * static_cast<T>(d.uniform(-8, 8));
        if (is_orthonormal(askew)) return askew;
    }
    return pose;
}

template <scalar T>
rigid<T> make_pose(draws& d, double translation) {
    rigid<T> pose = make_rotation<T>(d);
    pose.translation = construction::round_to<T>(construction::cube(d, translation));
    return pose;
}

namespace construction {

/// (1 + by) times the rotation: where `by` is symmetric, the rows' products are off by twice its entries.
template <scalar T>
rigid<T> strained(const rigid<T>& pose, const double (&by)[3][3]) {
    rigid<T> r = pose;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            long double sum = static_cast<long double>(pose.rotation[3 * i + j]);
            for (int k = 0; k < 3; ++k) sum += by[i][k] * static_cast<long double>(pose.rotation[3 * k + j]);
            r.rotation[3 * i + j] = static_cast<T>(sum);
        }
    }
    return r;
}

/// Rows that are too long or too short; sheared; stretched along the diagonals, which is as much as rows' products allow
/// along any line; or anything: off by `size` or less.
template <scalar T>
rigid<T> strained(draws& d, const rigid<T>& pose, double size) {
    double by[3][3] = {};
    const int kind = d.below(4);
    const int sign[3] = {1 - 2 * d.below(2), 1 - 2 * d.below(2), 1 - 2 * d.below(2)}, longer = 1 - 2 * d.below(2);
    const int first = d.below(3), second = (first + 1 + d.below(2)) % 3;
    for (int i = 0; i < 3; ++i) {
        const bool alike = d.below(2) == 0;
        if (kind == 0) by[i][i] = (alike ? longer : sign[i]) * size / 2;
        for (int j = 0; j <= i; ++j) {
            if (kind == 2) by[i][j] = by[j][i] = longer * sign[i] * sign[j] * size / 2;
            if (kind == 3) by[i][j] = by[j][i] = d.uniform(-size, size) / 2;
        }
    }
    if (kind == 1) by[first][second] = longer * size;
    return strained(pose, by);
}

/// As if printed with some digits and read again.
template <scalar T>
rigid<T> printed(const rigid<T>& pose, int digits) {
    rigid<T> r = pose;
    for (T& x : r.rotation) {
        char text[32];
        std::snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(x));
        x = static_cast<T>(std::atof(text));
    }
    return r;
}

}  // namespace construction

/// A pose that is accepted: half of them strained by anything from rounding to all that is accepted, and as much as that in
/// a third of these; the others as make_pose makes them, or printed with 3 to 12 digits, or products of up to 1000 joints.
template <scalar T>
rigid<T> make_loose_pose(draws& d, double translation) {
    const rigid<T> pose = make_pose<T>(d, translation);
    rigid<T> loose = pose;
    const int kind = d.below(6);
    if (kind < 3) {
        const double size = d.below(3) == 0 ? 0.99 * rotation_tolerance : std::ldexp(0.99, -10 - d.below(44));
        loose = construction::strained(d, pose, size);
    } else if (kind == 3) {
        loose = construction::printed(pose, 3 + d.below(10));
    } else if (kind == 4) {
        rigid<T> joint = make_rotation<T>(d);
        for (int joints = d.below(d.below(20) == 0 ? 1000 : 20); joints > 0; --joints) loose = compose(joint, loose);
        loose.translation = pose.translation;
    }
    return is_accepted(loose) ? loose : pose;
}

}  // namespace abut::test
