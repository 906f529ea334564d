// SPDX-License-Identifier: MIT
#pragma once

// Poses: a rotation and a translation, from an object's frame to the world's. What is decided about a posed shape is
// decided about its corners as `place` rounds them, so `place` gives the same bits under every compiler, flag and device
// that rounds to nearest and keeps subnormals, and the rest of this file is there to make poses and to refuse what is none.
// How two posed sets lie to each other, for culling, is in relative_pose.hpp.

#include <cstddef>
#include <span>
#include <string>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/error.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

/// @addtogroup shapes
///@{

/// x -> rotation x + translation, with the rotation's nine numbers row by row. `rigid<T>{}` moves nothing.
///
/// Queries take rotations whose rows are orthonormal within `rotation_tolerance`, and no reflections: products of many
/// rotations, and ones printed with three digits or more. They are not mended: points go where these nine numbers put them.
template <scalar T>
struct rigid {
    T rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row
    vec3<T> translation = {0, 0, 0};              ///< in units of length

    friend constexpr bool operator==(const rigid&, const rigid&) = default;
};

/// By how much the dot product of two rows of a rotation may differ from 0, and that of a row with itself from 1.
inline constexpr double rotation_tolerance = 0x1p-10;

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
    return magnitudes(greatest(lower, upper));
}

}  // namespace detail

/// A point in the world's coordinates, rounded to T: of floats, computed in double and rounded once; of doubles,
/// ((r0 x + r1 y) + r2 z) + t with each operation rounded. The same bits on every policy. The error of a coordinate is below
/// 4 |r| . |p| + |t| units of roundoff (float: |r| . |p| + |t|) and some smallest numbers; what is too large becomes
/// infinite.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr vec3<T> place(const rigid<T>& pose, const vec3<T>& p) {
    const T* const r = pose.rotation;
    return {detail::placed(r[0], r[1], r[2], p, pose.translation.x), detail::placed(r[3], r[4], r[5], p, pose.translation.y),
            detail::placed(r[6], r[7], r[8], p, pose.translation.z)};
}

/// Whether no point of the box can overflow where it is placed. False also where that is not certain: then look at each.
template <scalar T>
ABUT_HD constexpr bool stays_finite(const rigid<T>& pose, const aabb<T>& box) {
    const double shift = detail::magnitudes(detail::widened(pose.translation));
    return detail::farthest(box) + shift < static_cast<double>(largest_finite<T>) / 2;
}

/// The pose that places as `inner` does first and `outer` after, but for rounding: place(compose(a, b), p) and
/// place(a, place(b, p)) differ in the last places. Rotations drift from orthonormal by some units of roundoff with each
/// product, so that a product of thousands in float may be refused: `orthonormalised` takes the drift out.
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

/// The pose back, by the transposed rotation: place(inverse(pose), place(pose, p)) is p but for rounding, as above, and for
/// what the rotation is off from orthonormal, times |p|.
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

/// Throws invalid_geometry in the name of `function` where a number is not finite (index: which entry of the rotation, or
/// which coordinate).
template <scalar T>
void check_finite(const rigid<T>& pose, const std::string& function) {
    for (std::size_t i = 0; i < 9; ++i) {
        const T x = pose.rotation[i];
        if (!is_finite(x)) throw invalid_geometry(function, "rotation entry", i, "is not finite", static_cast<double>(x));
    }
    const T shift[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = static_cast<double>(shift[i]);
        if (!is_finite(value)) throw invalid_geometry(function, "translation coordinate", i, "is not finite", value);
    }
}

/// Whether `check` below takes the pose: true is certain under every compiler, whether it contracts or not. Where this is
/// false, the host has to look.
template <scalar T>
ABUT_HD constexpr bool is_surely_rigid(const rigid<T>& pose) {
    constexpr double tolerance = rotation_tolerance * (1 - 0x1p-20);  // the rest is for rounding
    const vec3<double> x = widened(row(pose.rotation, 0)), y = widened(row(pose.rotation, 1)),
                       z = widened(row(pose.rotation, 2));
    // Comparisons with NaN are false.
    return absolute(dot(x, x) - 1) <= tolerance && absolute(dot(y, y) - 1) <= tolerance &&
        absolute(dot(z, z) - 1) <= tolerance && absolute(dot(x, y)) <= tolerance && absolute(dot(y, z)) <= tolerance &&
        absolute(dot(z, x)) <= tolerance && dot(cross(x, y), z) > 0 &&
        magnitudes(widened(pose.translation)) < infinity<double>;
}

/// Throws invalid_geometry in the name of `function` where a pose is none: where a number is not finite, where two rows'
/// product is off by more than `rotation_tolerance` (index: the row; value: by how much), or where the rotation reflects
/// (index 0; value: its determinant).
template <scalar T>
void check(const rigid<T>& pose, const auto& function) {
    if (is_surely_rigid(pose)) return;
    check_finite(pose, function);
    const vec3<double> rows[3] = {widened(row(pose.rotation, 0)), widened(row(pose.rotation, 1)),
                                  widened(row(pose.rotation, 2))};
    for (std::size_t i = 0; i < 3; ++i) {
        const double off = dot(rows[i], rows[i]) - 1;
        if (!(absolute(off) <= rotation_tolerance)) {
            throw invalid_geometry(function, "rotation row", i, "its squared length differs from 1 by more than 2^-10", off);
        }
        for (std::size_t j = 0; j < i; ++j) {
            const double product = dot(rows[i], rows[j]);
            if (absolute(product) <= rotation_tolerance) continue;
            throw invalid_geometry(function, "rotation row", i,
                                   "its product with row " + std::to_string(j) + " differs from 0 by more than 2^-10",
                                   product);
        }
    }
    const double determinant = dot(cross(rows[0], rows[1]), rows[2]);
    if (determinant < 0) {
        throw invalid_geometry(function, "rotation", 0, "it reflects: its determinant is negative", determinant);
    }
}

}  // namespace detail

/// The pose with the rotation that is nearest to the given one, by the sum of the entries' squared differences: the
/// orthogonal factor of the polar decomposition, by Newton's iteration (N. Higham, Computing the polar decomposition, with
/// applications, 1986) in double, rounded to T. The translation stays. Rows are then orthonormal within some units of
/// roundoff; of a rotation that was so before, entries change by as much. What scales or shears is dropped without a word.
/// Last digits may depend on the compiler and its flags.
///
/// Throws invalid_geometry where a number is not finite, and where the determinant, in units of the largest entry, is not
/// above 2^-20: such a matrix reflects or is singular, or so nearly that it says little about a rotation.
///
///     pose = abut::compose(step, pose);
///     if (++steps % 1000 == 0) pose = abut::orthonormalised(pose);
template <scalar T>
[[nodiscard]] rigid<T> orthonormalised(const rigid<T>& pose) {
    const std::string function = "abut::orthonormalised";
    detail::check_finite(pose, function);
    double largest = 0;
    for (const T x : pose.rotation) largest = detail::greatest(largest, detail::absolute(static_cast<double>(x)));
    vec3<double> rows[3];
    for (int i = 0; i < 3; ++i) {
        const vec3<double> r = detail::widened(detail::row(pose.rotation, i));
        rows[i] = {r.x / largest, r.y / largest, r.z / largest};
    }
    const double determinant = dot(cross(rows[0], rows[1]), rows[2]);
    if (!(determinant > 0x1p-20)) {  // NaN where all is 0
        throw invalid_geometry(function, "rotation", 0,
                               "it reflects or is singular: its determinant, in units of its largest entry, is below 2^-20",
                               largest == 0 ? 0 : determinant);
    }
    // The error of a step is about half the square of the step before: after one of 2^-27 there is nothing left to gain.
    double step = 1;
    while (step > 0x1p-27) {
        const vec3<double> cofactors[3] = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
        const double inverse_determinant = 1 / dot(rows[0], cofactors[0]);
        step = 0;
        for (int i = 0; i < 3; ++i) {
            const vec3<double> next = 0.5 * (rows[i] + inverse_determinant * cofactors[i]);
            step = detail::greatest(step, detail::magnitudes(next - rows[i]));
            rows[i] = next;
        }
    }
    rigid<T> r = pose;
    for (int i = 0; i < 3; ++i) {
        r.rotation[3 * i] = static_cast<T>(rows[i].x);
        r.rotation[3 * i + 1] = static_cast<T>(rows[i].y);
        r.rotation[3 * i + 2] = static_cast<T>(rows[i].z);
    }
    return r;
}

/// Which numbers of a matrix lie side by side: those of a row, or those of a column (OpenGL, Eigen and GLM by default).
enum class matrix_order {
    row_major,    ///< those of a row
    column_major  ///< those of a column
};

namespace detail {

template <scalar T, std::size_t N>
constexpr rigid<T> rigid_from_entries(std::span<const T, N> m, matrix_order order) {
    const auto entry = [&](std::size_t i, std::size_t j) {
        return order == matrix_order::row_major ? m[4 * i + j] : m[N / 4 * j + i];
    };
    rigid<T> r;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) r.rotation[3 * i + j] = entry(i, j);
    }
    r.translation = {entry(0, 3), entry(1, 3), entry(2, 3)};
    return r;
}

}  // namespace detail

/// The pose of a 3 x 4 matrix that multiplies columns from the left: three columns of rotation, and one of translation.
/// Numbers are taken as they are; queries check them, and `orthonormalised` makes them a rotation.
///
///     const float m[12] = {1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7};
///     const auto pose = abut::rigid_from_matrix<float>(m, abut::matrix_order::row_major);  // moves by (5, 6, 7)
template <scalar T>
[[nodiscard]] constexpr rigid<T> rigid_from_matrix(std::span<const T, 12> m, matrix_order order) {
    return detail::rigid_from_entries(m, order);
}

/// The same of a 4 x 4 matrix. Throws invalid_geometry, with the number's place in `m`, where the last row is not 0 0 0 1.
/// Matrices that multiply rows from the right have the translation in their last row: stored by rows, they are the same
/// sixteen numbers as column_major.
template <scalar T>
[[nodiscard]] constexpr rigid<T> rigid_from_matrix(std::span<const T, 16> m, matrix_order order) {
    for (std::size_t j = 0; j < 4; ++j) {
        const std::size_t at = order == matrix_order::row_major ? 12 + j : 4 * j + 3;
        if (m[at] != T(j == 3 ? 1 : 0)) {
            throw invalid_geometry("abut::rigid_from_matrix", "matrix entry", at, "the last row has to be 0 0 0 1",
                                   static_cast<double>(m[at]));
        }
    }
    return detail::rigid_from_entries(m, order);
}

///@}

}  // namespace abut
