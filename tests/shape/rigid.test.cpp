// SPDX-License-Identifier: MIT
#include <abut/shape/rigid.hpp>

#include <cmath>
#include <limits>
#include <string>

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
        test::draws d(test::seed, 1, i);
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
        test::draws d(test::seed, 2, i);
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
        test::draws d(test::seed, 3, i);
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
    const T nan = std::numeric_limits<T>::quiet_NaN(), ulp = std::numeric_limits<T>::epsilon();
    rigid<T> pose;
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[5] = nan;
    CHECK(refusal(pose, 5) == "abut::posed: rotation entry 5: is not finite (nan)");
    pose = {};
    pose.translation.z = -infinity<T>;
    CHECK(refusal(pose, 2) == "abut::posed: translation coordinate 2: is not finite (-inf)");
    pose = {};
    pose.rotation[4] = 2;
    CHECK(refusal(pose, 1) == "abut::posed: rotation row 1: its squared length is not 1 (4)");
    pose = {};
    pose.rotation[4] = largest_finite<T>;
    CHECK(refusal(pose, 1) != "accepted");
    pose = {};
    pose.rotation[8] = -1;
    CHECK(refusal(pose, 0) == "abut::posed: rotation 0: it reflects: the determinant is -1 (-1)");
    // 16 units in the last place are accepted and 17 are not, of a squared length (8 of the length) and of a product.
    pose = {};
    pose.rotation[0] = 1 + 7 * ulp;
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[0] = 1 + 9 * ulp;
    CHECK(refusal(pose, 0) != "accepted");
    pose.rotation[0] = 1 - 9 * ulp;
    CHECK(refusal(pose, 0) != "accepted");
    pose = {};
    pose.rotation[1] = 16 * ulp;
    CHECK(refusal(pose, 0) == "accepted");
    pose.rotation[1] = 17 * ulp;
    CHECK(refusal(pose, 1).find("row 1: is not orthogonal to row 0") != std::string::npos);
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

TEST_CASE("rigid: a box stays finite, or may not") {
    const aabb<float> box{{-1, -2, 0}, {1e38f, 3, 4}};
    CHECK(stays_finite(rigid<float>{}, box));
    rigid<float> far;
    far.translation.y = 1e38f;
    CHECK_FALSE(stays_finite(far, box));
    CHECK_FALSE(stays_finite(rigid<double>{}, aabb<double>{{-1e308, -1e308, 0}, {1, 2, 3}}));
}
