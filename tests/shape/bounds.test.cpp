// SPDX-License-Identifier: MIT
#include <abut/shape/bounds.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <rapidcheck.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

namespace {

/// Any finite number, by its bits: denormals and the largest included.
template <class T>
rc::Gen<T> finite() {
    using bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    const auto from_bits = [](bits b) { return __builtin_bit_cast(T, b); };
    return rc::gen::suchThat(rc::gen::map(rc::gen::arbitrary<bits>(), from_bits), [](T x) { return std::isfinite(x); });
}

/// A radius of the size of a coordinate, so that rounding matters.
template <class T>
rc::Gen<sphere<T>> comparable_sphere() {
    return rc::gen::apply(
        [](T x, int exponent, T y, T z) {
            const T r = std::ldexp(std::fabs(x), exponent);
            return sphere<T>{{x, y, z}, std::isfinite(r) ? r : std::numeric_limits<T>::max()};
        },
        finite<T>(), rc::gen::inRange(-30, 30), finite<T>(), finite<T>());
}

template <class T>
bool at_most(T bound, const rational& exact) {
    return bound == -std::numeric_limits<T>::infinity() || rational(bound) <= exact;
}

/// The box holds the sphere, and the next smaller box would not.
template <class T>
void check_tight(T center, T radius, T lower, T upper) {
    const rational low = rational(center) - rational(radius), high = rational(center) + rational(radius);
    const T inf = std::numeric_limits<T>::infinity();
    RC_ASSERT(at_most(lower, low));
    RC_ASSERT(at_most(T(-upper), rational(-high)));
    const T inner_low = std::nextafter(lower, inf), inner_high = std::nextafter(upper, -inf);
    RC_ASSERT(rational(inner_low) > low);
    RC_ASSERT(rational(inner_high) < high);
}

template <class T>
void check_spheres() {
    const auto property = [](const sphere<T>& s) {
        const aabb<T> box = bounds(s);
        check_tight(s.center.x, s.radius, box.lower.x, box.upper.x);
        check_tight(s.center.y, s.radius, box.lower.y, box.upper.y);
        check_tight(s.center.z, s.radius, box.lower.z, box.upper.z);
    };
    CHECK(rc::check("box of a sphere", [&] { property(*comparable_sphere<T>()); }));
}

}  // namespace

namespace rc {
template <class T>
void showValue(const abut::sphere<T>& s, std::ostream& out) {
    out << s.center.x << ' ' << s.center.y << ' ' << s.center.z << " radius " << s.radius;
}
}  // namespace rc

TEST_CASE("bounds: a sphere's box rounds outward, by one step at most") {
    check_spheres<float>();
    check_spheres<double>();
}

TEST_CASE("bounds: a capsule's box rounds outward, by one step at most") {
    const auto property = []<class T>(T) {
        const sphere<T> a = *comparable_sphere<T>(), b = *comparable_sphere<T>();
        const capsule<T> s{{a.center, b.center}, a.radius};
        const aabb<T> box = bounds(s);
        const auto check = [&](T x, T y, T lower, T upper) {
            check_tight(std::min(x, y), s.radius, lower, bounds(sphere<T>{{std::min(x, y), 0, 0}, s.radius}).upper.x);
            check_tight(std::max(x, y), s.radius, bounds(sphere<T>{{std::max(x, y), 0, 0}, s.radius}).lower.x, upper);
        };
        check(s.axis.a.x, s.axis.b.x, box.lower.x, box.upper.x);
        check(s.axis.a.y, s.axis.b.y, box.lower.y, box.upper.y);
        check(s.axis.a.z, s.axis.b.z, box.lower.z, box.upper.z);
    };
    CHECK(rc::check("box of a capsule, float", [&] { property(float{}); }));
    CHECK(rc::check("box of a capsule, double", [&] { property(double{}); }));
}

TEST_CASE("bounds: boxes of points, segments and boxes are exact, and a plane's is all of space") {
    const aabb<double> box = bounds(segment<double>{{1, 5, -3}, {-2, 7, 0}});
    CHECK(box.lower == vec3<double>{-2, 5, -3});
    CHECK(box.upper == vec3<double>{1, 7, 0});
    CHECK(bounds(box).lower == box.lower);
    CHECK(bounds(box).upper == box.upper);
    CHECK(bounds(vec3<double>{1, 2, 3}).lower == vec3<double>{1, 2, 3});
    CHECK(bounds(vec3<double>{1, 2, 3}).upper == vec3<double>{1, 2, 3});
    const double largest = std::numeric_limits<double>::max();
    CHECK(contains(bounds(plane<double>{{0, 0, 1}, 4}), aabb<double>{{-largest, 0, 9}, {0, largest, largest}}));
}

TEST_CASE("bounds: boxes of triangles are exact, merging and comparing too") {
    const triangle<float> t{{1, 5, -3}, {-2, 7, 0}, {4, 6, -9}};
    const aabb<float> box = bounds(t);
    CHECK(box.lower == vec3<float>{-2, 5, -9});
    CHECK(box.upper == vec3<float>{4, 7, 0});
    const aabb<float> none = empty_box<float>();
    CHECK(merge(none, box).lower == box.lower);
    CHECK(merge(none, box).upper == box.upper);
    CHECK_FALSE(overlaps(none, box));
    CHECK(overlaps(box, aabb<float>{{4, 7, 0}, {5, 8, 1}}));
    CHECK_FALSE(overlaps(box, aabb<float>{{std::nextafter(4.0f, 5.0f), 7, 0}, {5, 8, 1}}));
    CHECK(contains(box, box));
    CHECK_FALSE(contains(box, aabb<float>{{-2, 5, -9}, {4, 7, std::numeric_limits<float>::denorm_min()}}));
}
