// SPDX-License-Identifier: MIT
#include <abut/shape/rigid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

namespace {

constexpr rigid<double> quarter{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {1, 2, 3}};

static_assert(std::is_aggregate_v<rigid<float>> && std::is_trivially_copyable_v<rigid<float>>);
static_assert(place(rigid<float>{}, vec3<float>{1, 2, 3}) == vec3<float>{1, 2, 3});
static_assert(place(quarter, vec3<double>{1, 0, 0}) == vec3<double>{1, 3, 3});
static_assert(compose(quarter, inverse(quarter)) == rigid<double>{});
static_assert(place(quarter, sphere<double>{{1, 0, 0}, 5}).radius == 5);

constexpr double quarter_by_rows[12] = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3};
constexpr std::array<double, 12> quarter_by_columns{0, 1, 0, -1, 0, 0, 0, 0, 1, 1, 2, 3};
static_assert(rigid_from_matrix<double>(quarter_by_rows, matrix_order::row_major) == quarter);
static_assert(rigid_from_matrix<double>(quarter_by_columns, matrix_order::column_major) == quarter);

template <class T>
rational exact_coordinate(const rigid<T>& pose, const vec3<T>& p, int i) {
    const T t[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    const T* const r = pose.rotation + 3 * i;
    return rational(r[0]) * rational(p.x) + rational(r[1]) * rational(p.y) + rational(r[2]) * rational(p.z) + rational(t[i]);
}

/// What `place` promises of a coordinate's error.
template <class T>
rational bound_on_error(const rigid<T>& pose, const vec3<T>& p, int i) {
    const T t[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    const T* const r = pose.rotation + 3 * i;
    const rational rotated =
        abs(rational(r[0]) * rational(p.x)) + abs(rational(r[1]) * rational(p.y)) + abs(rational(r[2]) * rational(p.z));
    const rational u(unit_roundoff<T>), factor = sizeof(T) == 4 ? rational(1) : rational(4);
    const rational slack = 1 + rational(1) / 1000000;
    return u * slack * (factor * rotated + abs(rational(t[i]))) + 8 * rational(std::numeric_limits<T>::denorm_min());
}

template <class T>
void check_error() {
    const std::uint64_t n = test::sample_count() / 5 + 1;
    std::uint64_t wrong = 0, inexact = 0;
    for (std::uint64_t i = 0; i < n; ++i) {
        test::draws d(test::sample_seed, 1, i);
        const int span = sizeof(T) == 4 ? 36 : 300;
        const double size = d.power_of_ten(-span, span), relative = d.power_of_ten(-9, 9);
        const double far = std::fmin(size * relative, 1e-2 * static_cast<double>(largest_finite<T>));
        const rigid<T> pose = test::make_pose<T>(d, far);
        const vec3<T> p = test::construction::round_to<T>(test::construction::cube(d, size)), w = place(pose, p);
        const T world[3] = {w.x, w.y, w.z};
        for (int k = 0; k < 3; ++k) {
            const rational off = abs(rational(world[k]) - exact_coordinate(pose, p, k));
            wrong += off > bound_on_error(pose, p, k);
            inexact += off != 0;
        }
    }
    CHECK(wrong == 0);
    CHECK(inexact > n);
}

/// The order that `place` states, one operation to a statement and through memory, so that nothing is contracted.
vec3<double> in_stated_order(const rigid<double>& pose, const vec3<double>& p) {
    double result[3]{};
    const double t[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    for (int i = 0; i < 3; ++i) {
        const double* const r = pose.rotation + 3 * i;
        volatile double x = r[0] * p.x, y = r[1] * p.y, z = r[2] * p.z, sum = 0;
        sum = x + y;
        sum = sum + z;
        sum = sum + t[i];
        result[i] = sum;
    }
    return {result[0], result[1], result[2]};
}
vec3<float> in_stated_order(const rigid<float>& pose, const vec3<float>& p) {
    float result[3]{};
    const float t[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    for (int i = 0; i < 3; ++i) {
        const float* const r = pose.rotation + 3 * i;
        volatile double x = double(r[0]) * double(p.x), y = double(r[1]) * double(p.y), z = double(r[2]) * double(p.z),
                        sum = 0;
        sum = x + y;
        sum = sum + z;
        sum = sum + double(t[i]);
        volatile float once = static_cast<float>(sum);
        result[i] = once;
    }
    return {result[0], result[1], result[2]};
}

template <class T>
void check_order() {
    std::uint64_t different = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        test::draws d(test::sample_seed, 2, i);
        const rigid<T> pose = test::make_pose<T>(d, d.power_of_ten(-3, 3));
        const vec3<T> p = test::construction::round_to<T>(test::construction::cube(d, d.power_of_ten(-3, 3)));
        different += !(place(pose, p) == in_stated_order(pose, p));
    }
    CHECK(different == 0);
}

template <class T>
void check_round_trips() {
    const T tolerance = 400 * unit_roundoff<T>;
    for (std::uint64_t i = 0; i < test::sample_count() / 5; ++i) {
        test::draws d(test::sample_seed, 3, i);
        const rigid<T> a = test::make_pose<T>(d, 1), b = test::make_pose<T>(d, 1);
        const vec3<T> p = test::construction::round_to<T>(test::construction::cube(d, 1));
        const vec3<T> back = place(inverse(a), place(a, p)) - p, twice = place(compose(a, b), p) - place(a, place(b, p));
        REQUIRE(detail::magnitudes(back) < tolerance);
        REQUIRE(detail::magnitudes(twice) < tolerance);
    }
}

template <class T>
std::string refusal(const rigid<T>& pose, std::size_t index) {
    try {
        detail::check(pose, "abut::posed");
    } catch (const invalid_geometry& e) {
        CHECK(e.function() == "abut::posed");
        CHECK(e.index() == index);
        return e.what();
    }
    return "accepted";
}

template <class T>
void check_refusals() {
    const T nan = std::numeric_limits<T>::quiet_NaN();
    rigid<T> pose;
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[5] = nan;
    CHECK(refusal(pose, 5) == "abut::posed: rotation entry 5: is not finite (nan)");
    pose = {};
    pose.translation.z = -infinity<T>;
    CHECK(refusal(pose, 2) == "abut::posed: translation coordinate 2: is not finite (-inf)");
    pose = {};
    pose.rotation[4] = 2;
    CHECK(refusal(pose, 1) == "abut::posed: rotation row 1: its squared length differs from 1 by more than 2^-10 (3)");
    pose = {};
    pose.rotation[4] = largest_finite<T>;
    CHECK(refusal(pose, 1) != "accepted");
    pose = {};
    pose.rotation[8] = -1;
    CHECK(refusal(pose, 0) == "abut::posed: rotation 0: it reflects: its determinant is negative (-1)");
    // 2^-10 is accepted and a little more is not, of a squared length and of a product.
    const auto length = [](double square) { return static_cast<T>(std::sqrt(square)); };
    pose = {};
    pose.rotation[0] = length(1 + 0.999 * 0x1p-10);
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[0] = length(1 - 0.999 * 0x1p-10);
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[0] = length(1 + 1.001 * 0x1p-10);
    CHECK(refusal(pose, 0).find("row 0: its squared length differs from 1 by more than 2^-10 (0.00097") !=
          std::string::npos);
    pose.rotation[0] = length(1 - 1.001 * 0x1p-10);
    CHECK(refusal(pose, 0).find("row 0: its squared length differs from 1 by more than 2^-10 (-0.00097") !=
          std::string::npos);
    pose = {};
    pose.rotation[1] = T(0x1p-10);
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[1] = T(-1.25 * 0x1p-10);
    CHECK(refusal(pose, 1) ==
          "abut::posed: rotation row 1: its product with row 0 differs from 0 by more than 2^-10 (-0.00122070312)");
}

/// Products of 1000 joints, and rotations printed with few digits, are what programs have.
template <class T>
void check_acceptance() {
    const std::uint64_t n = test::sample_count() / 50 + 1;
    std::uint64_t refused = 0, refused_printed = 0;
    for (std::uint64_t i = 0; i < n; ++i) {
        test::draws d(test::sample_seed, 4, i);
        rigid<T> product = test::make_pose<T>(d, 1);
        for (int k = 0; k < 1000; ++k) product = compose(test::make_pose<T>(d, 1e-3), product);
        refused += !test::is_accepted(product);
        const rigid<T> pose = test::make_pose<T>(d, 1);
        for (int digits = 4; digits <= 12; ++digits)
            refused_printed += !test::is_accepted(test::construction::printed(pose, digits));
    }
    CHECK(refused == 0);
    CHECK(refused_printed == 0);
}

/// U = orthonormalised(A) is nearest to A if and only if the product of A and U's transposed is symmetric and positive
/// definite (K. Fan, A. Hoffman, Some metric inequalities in the space of matrices, 1955): in rationals, no iteration.
/// Returns how far from symmetric it is, as a part of its size, or infinity where it is not positive definite.
template <class T>
double off_from_nearest(const rigid<T>& given, const rigid<T>& nearest) {
    rational h[3][3], size = 0;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k)
                h[i][j] += rational(given.rotation[3 * i + k]) * rational(nearest.rotation[3 * j + k]);
            size += abs(h[i][j]);
        }
    }
    const rational minor = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    const rational determinant = h[0][0] * (h[1][1] * h[2][2] - h[1][2] * h[2][1]) -
                                 h[0][1] * (h[1][0] * h[2][2] - h[1][2] * h[2][0]) +
                                 h[0][2] * (h[1][0] * h[2][1] - h[1][1] * h[2][0]);
    if (h[0][0] <= 0 || minor <= 0 || determinant <= 0) return infinity<double>;
    const rational off = abs(h[0][1] - h[1][0]) + abs(h[1][2] - h[2][1]) + abs(h[2][0] - h[0][2]);
    return static_cast<double>(rational(off / size));
}

template <class T>
void check_orthonormalised() {
    constexpr auto unit = static_cast<double>(unit_roundoff<T>);
    double rows_off = 0, off = 0, off_strained = 0, moved = 0;
    for (std::uint64_t i = 0; i < test::sample_count(); ++i) {
        test::draws d(test::sample_seed, 5, i);
        const rigid<T> pose = test::make_pose<T>(d, 1), once = orthonormalised(pose);
        REQUIRE(once.translation == pose.translation);
        for (int k = 0; k < 9; ++k) {
            moved = std::max(moved, static_cast<double>(detail::absolute(once.rotation[k] - pose.rotation[k])));
        }
        rows_off = std::max(rows_off, test::deviation_of_rows(once));
        off = std::max(off, off_from_nearest(pose, once));

        // Strained far beyond what is accepted, and of any size.
        rigid<T> strained = test::construction::strained(d, pose, d.power_of_ten(-3, 0) / 2);
        const auto scale = static_cast<T>(d.power_of_ten(sizeof(T) == 4 ? -36 : -300, sizeof(T) == 4 ? 37 : 300));
        for (T& x : strained.rotation) x *= scale;
        const rigid<T> mended = orthonormalised(strained);
        rows_off = std::max(rows_off, test::deviation_of_rows(mended));
        off_strained = std::max(off_strained, off_from_nearest(strained, mended));
    }
    CHECK(rows_off < 16 * unit);
    CHECK(off < 8 * unit);
    CHECK(off_strained < 8 * unit);
    CHECK(moved < 32 * unit);

    // Far from any rotation, down to where it is refused: one axis a million times as short as the others.
    for (const double least : {1e-1, 1e-3, 1e-5, 1.1e-6}) {
        rigid<T> flat;
        flat.rotation[1] = T(0.5);
        flat.rotation[8] = static_cast<T>(least);
        flat.rotation[6] = T(0.25) * static_cast<T>(least);
        const rigid<T> mended = orthonormalised(flat);
        CHECK(test::deviation_of_rows(mended) < 16 * unit);
        CHECK(off_from_nearest(flat, mended) < 8 * unit);
    }
}

template <class T>
std::string refusal_to_mend(const std::array<double, 9>& rotation) {
    rigid<T> pose;
    std::transform(rotation.begin(), rotation.end(), pose.rotation, [](double x) { return static_cast<T>(x); });
    try {
        (void)orthonormalised(pose);
    } catch (const invalid_geometry& e) {
        return e.what();
    }
    return "accepted";
}

template <class T>
void check_refusals_to_mend() {
    const std::string singular =
        "abut::orthonormalised: rotation 0: it reflects or is singular: its determinant, in units of "
        "its largest entry, is below 2^-20 (";
    CHECK(refusal_to_mend<T>({3, 0, 0, 0, 3, 0, 0, 0, 3}) == "accepted");
    CHECK(refusal_to_mend<T>({2, 0, 0, 0, 2, 0, 0, 0, -2}) == singular + "-1)");
    CHECK(refusal_to_mend<T>({0, 0, 0, 0, 0, 0, 0, 0, 0}) == singular + "0)");
    CHECK(refusal_to_mend<T>({1, 2, 3, 2, 4, 6, 0, 0, 1}) == singular + "0)");
    CHECK(refusal_to_mend<T>({1, 0, 0, 0, 1, 0, 0, 0, 1e-7}) != "accepted");
    CHECK(refusal_to_mend<T>({1, 0, 0, 0, 1, 0, 0, std::nan(""), 1}) ==
          "abut::orthonormalised: rotation entry 7: is not finite (nan)");
}

template <class T>
void check_matrices() {
    for (std::uint64_t i = 0; i < 100; ++i) {
        test::draws d(test::sample_seed, 6, i);
        const rigid<T> pose = test::make_loose_pose<T>(d, 10);
        const T* const r = pose.rotation;
        const vec3<T>& t = pose.translation;
        const T rows[16] = {r[0], r[1], r[2], t.x, r[3], r[4], r[5], t.y, r[6], r[7], r[8], t.z, 0, 0, T(-0.0), 1};
        const std::array<T, 16> columns{r[0], r[3], r[6], 0, r[1], r[4], r[7], 0, r[2], r[5], r[8], 0, t.x, t.y, t.z, 1};
        const std::array<T, 12> three{r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8], t.x, t.y, t.z};
        REQUIRE(rigid_from_matrix<T>(rows, matrix_order::row_major) == pose);
        REQUIRE(rigid_from_matrix<T>(columns, matrix_order::column_major) == pose);
        REQUIRE(rigid_from_matrix(std::span<const T, 12>(rows, 12), matrix_order::row_major) == pose);
        REQUIRE(rigid_from_matrix<T>(three, matrix_order::column_major) == pose);
    }
    // A last row that is none, in both orders: a matrix taken for one of the other order is noticed where it moves.
    const T moves[16] = {1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1};
    CHECK(rigid_from_matrix<T>(moves, matrix_order::row_major).translation == vec3<T>{5, 6, 7});
    CHECK_THROWS_WITH(rigid_from_matrix<T>(moves, matrix_order::column_major),
                      "abut::rigid_from_matrix: matrix entry 3: the last row has to be 0 0 0 1 (5)");
    T projects[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, T(0.5)};
    CHECK_THROWS_WITH(rigid_from_matrix<T>(projects, matrix_order::row_major),
                      "abut::rigid_from_matrix: matrix entry 15: the last row has to be 0 0 0 1 (0.5)");
    projects[15] = std::numeric_limits<T>::quiet_NaN();
    CHECK_THROWS_AS(rigid_from_matrix<T>(projects, matrix_order::row_major), invalid_geometry);
}

}  // namespace

TEMPLATE_TEST_CASE("rigid: a placed point is within its stated error of the exact one", "", float, double) {
    check_error<TestType>();
}

TEMPLATE_TEST_CASE("rigid: placing keeps to its order of operations, whatever the compiler contracts", "", float, double) {
    check_order<TestType>();
}

TEMPLATE_TEST_CASE("rigid: inverses and compositions, but for rounding", "", float, double) {
    check_round_trips<TestType>();
}

TEMPLATE_TEST_CASE("rigid: what is no pose is refused, with its place and value", "", float, double) {
    check_refusals<TestType>();
}

TEMPLATE_TEST_CASE("rigid: long products and short prints are accepted", "", float, double) { check_acceptance<TestType>(); }

TEMPLATE_TEST_CASE("rigid: orthonormalised is the nearest rotation, by rationals", "", float, double) {
    check_orthonormalised<TestType>();
    check_refusals_to_mend<TestType>();
}

TEMPLATE_TEST_CASE("rigid: poses from matrices of both orders", "", float, double) { check_matrices<TestType>(); }

TEST_CASE("rigid: a box stays finite, or may not") {
    const aabb<float> box{{-1, -2, 0}, {1e38f, 3, 4}};
    CHECK(stays_finite(rigid<float>{}, box));
    rigid<float> far;
    far.translation.y = 1e38f;
    CHECK_FALSE(stays_finite(far, box));
    CHECK_FALSE(stays_finite(rigid<double>{}, aabb<double>{{-1e308, -1e308, 0}, {1, 2, 3}}));
}
