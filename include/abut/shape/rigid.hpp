// SPDX-License-Identifier: MIT
#pragma once

// Poses: a rotation and a translation, from an object's frame to the world's. What is decided about a posed shape is
// decided about its corners as `place` rounds them, so `place` gives the same bits under every compiler, flag and device
// that rounds to nearest and keeps subnormals, and the rest of this file is there to make poses and to refuse what is none.
// How two posed sets lie to each other, for culling, is in relative_pose.hpp.

#include <cstddef>
#include <string>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/error.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// x -> rotation x + translation, with the rotation's nine numbers row by row. `rigid<T>{}` moves nothing.
template <scalar T>
struct rigid {
    T rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    vec3<T> translation = {0, 0, 0};

    friend constexpr bool operator==(const rigid&, const rigid&) = default;
};

namespace detail {

/// ((a x + b y) + c z) + t. Of floats: in double, where the products are exact, so that it is all one whether a compiler
/// contracts; rounded to float at the end. Of doubles: six products and sums, each rounded. Not by fma, which is a call into
/// the C library on processors that are not known to have one.
ABUT_HD constexpr float placed(float a, float b, float c, const vec3<float>& p, float t) {
    const double rotated =
        (static_cast<double>(a) * static_cast<double>(p.x) + static_cast<double>(b) * static_cast<double>(p.y)) +
        static_cast<double>(c) * static_cast<double>(p.z);
    // Through a register: g++ 12 drops the rounding where a caller widens the number again, as every filter does.
    return rounded(static_cast<float>(rotated + static_cast<double>(t)));
}
ABUT_HD constexpr double placed(double a, double b, double c, const vec3<double>& p, double t) {
    const double xy = plain_sum(plain_product(a, p.x), plain_product(b, p.y));
    return plain_sum(plain_sum(xy, plain_product(c, p.z)), rounded(t));  // t may be a caller's product
}

/// Row and column of a matrix that is stored row by row.
template <scalar T>
ABUT_HD constexpr vec3<T> row(const T (&m)[9], int i) {
    return {m[3 * i], m[3 * i + 1], m[3 * i + 2]};
}
template <scalar T>
ABUT_HD constexpr vec3<T> column(const T (&m)[9], int j) {
    return {m[j], m[3 + j], m[6 + j]};
}

/// No point of the box is farther from the origin than this, not even by the sum of its coordinates' magnitudes, but for
/// rounding.
template <scalar T>
ABUT_HD constexpr double farthest(const aabb<T>& box) {
    const vec3<double> lower = absolute(widened(box.lower)), upper = absolute(widened(box.upper));
    return magnitudes(greater(lower, upper));
}

}  // namespace detail

/// A point in the world's coordinates, rounded to T: of floats, computed in double and rounded once; of doubles,
/// ((r0 x + r1 y) + r2 z) + t with each operation rounded. The same bits on every policy. The error of a coordinate is below
/// 4 |r| . |p| + |t| units of roundoff (float: |r| . |p| + |t|) and some smallest numbers; what is too large becomes
/// infinite.
template <scalar T>
ABUT_HD constexpr vec3<T> place(const rigid<T>& pose, const vec3<T>& p) {
    const T* const r = pose.rotation;
    return {detail::placed(r[0], r[1], r[2], p, pose.translation.x), detail::placed(r[3], r[4], r[5], p, pose.translation.y),
            detail::placed(r[6], r[7], r[8], p, pose.translation.z)};
}

/// Shapes are placed by their points. A radius stays: the world sees the ball of that radius around the placed centre.
template <scalar T>
ABUT_HD constexpr segment<T> place(const rigid<T>& pose, const segment<T>& s) {
    return {place(pose, s.a), place(pose, s.b)};
}
template <scalar T>
ABUT_HD constexpr triangle<T> place(const rigid<T>& pose, const triangle<T>& t) {
    return {place(pose, t.a), place(pose, t.b), place(pose, t.c)};
}
template <scalar T>
ABUT_HD constexpr sphere<T> place(const rigid<T>& pose, const sphere<T>& s) {
    return {place(pose, s.center), s.radius};
}
template <scalar T>
ABUT_HD constexpr capsule<T> place(const rigid<T>& pose, const capsule<T>& s) {
    return {place(pose, s.axis), s.radius};
}

/// Whether no point of the box can overflow where it is placed. False also where that is not certain: then look at each.
template <scalar T>
ABUT_HD constexpr bool stays_finite(const rigid<T>& pose, const aabb<T>& box) {
    const double shift = detail::magnitudes(detail::widened(pose.translation));
    return detail::farthest(box) + shift < static_cast<double>(largest_finite<T>) / 2;
}

/// The pose that places as `inner` does first and `outer` after, but for rounding: place(compose(a, b), p) and
/// place(a, place(b, p)) differ in the last places. Rotations drift from orthonormal by some units of roundoff with each
/// product, and are refused in the end: a program that composes without end has to make them orthonormal itself.
template <scalar T>
ABUT_HD constexpr rigid<T> compose(const rigid<T>& outer, const rigid<T>& inner) {
    rigid<T> r;
    for (int i = 0; i < 3; ++i) {
        const vec3<T> a = detail::row(outer.rotation, i);
        for (int j = 0; j < 3; ++j) {
            r.rotation[3 * i + j] = detail::placed(a.x, a.y, a.z, detail::column(inner.rotation, j), T(0));
        }
    }
    r.translation = place(outer, inner.translation);
    return r;
}

/// The pose back, by the transposed rotation; but for rounding, as above.
template <scalar T>
ABUT_HD constexpr rigid<T> inverse(const rigid<T>& pose) {
    rigid<T> r;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) r.rotation[3 * i + j] = pose.rotation[3 * j + i];
    }
    const vec3<T> back = place(r, pose.translation);
    r.translation = {-back.x, -back.y, -back.z};
    return r;
}

namespace detail {

/// Throws invalid_geometry in the name of `function` where a pose is none: where a number is not finite (index: which entry
/// of the rotation, or which coordinate), where two rows' product is off by more than 16 units in the last place of 1
/// (index: the row), or where the rotation reflects (its determinant is -1; index 0).
template <scalar T>
void check(const rigid<T>& pose, const std::string& function) {
    for (std::size_t i = 0; i < 9; ++i) {
        const T x = pose.rotation[i];
        if (!is_finite(x)) throw invalid_geometry(function, "rotation entry", i, "is not finite", static_cast<double>(x));
    }
    const T shift[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = static_cast<double>(shift[i]);
        if (!is_finite(value)) throw invalid_geometry(function, "translation coordinate", i, "is not finite", value);
    }
    constexpr double tolerance = 32 * static_cast<double>(unit_roundoff<T>);  // 16 units in the last place
    const vec3<double> rows[3] = {widened(row(pose.rotation, 0)), widened(row(pose.rotation, 1)),
                                  widened(row(pose.rotation, 2))};
    for (std::size_t i = 0; i < 3; ++i) {
        const double square = dot(rows[i], rows[i]);
        if (!(absolute(square - 1) <= tolerance)) {
            throw invalid_geometry(function, "rotation row", i, "its squared length is not 1", square);
        }
        for (std::size_t j = 0; j < i; ++j) {
            const double product = dot(rows[i], rows[j]);
            if (absolute(product) <= tolerance) continue;
            throw invalid_geometry(function, "rotation row", i, "is not orthogonal to row " + std::to_string(j), product);
        }
    }
    const double determinant = dot(cross(rows[0], rows[1]), rows[2]);
    if (determinant < 0) throw invalid_geometry(function, "rotation", 0, "it reflects: the determinant is -1", determinant);
}

}  // namespace detail

}  // namespace abut
