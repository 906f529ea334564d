// SPDX-License-Identifier: MIT
//
// The filter of oriented boxes by their own directions never says what integers do not say (`exact` decides the hulls of the
// corners, by another way), and knows most pairs: in general place, those that all but touch, and far from the origin. And
// how far an oriented box reaches: every box of a tree in which something touches it is kept.
#include <abut/predicate/certified_oriented.hpp>

#include <abut/predicate/intersects.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include "support/catch.hpp"

using namespace abut;

namespace {

struct draws {
    std::uint64_t state = 21;
    double operator()(double low, double high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
    }
    template <scalar T>
    vec3<T> place(double within) {
        return {static_cast<T>((*this)(-within, within)), static_cast<T>((*this)(-within, within)), static_cast<T>((*this)(-within, within))};
    }
    /// Now and then flat, or a segment, or along the axes, or with a rotation that was printed with few digits.
    template <scalar T>
    oriented_box<T> box(const vec3<T>& center) {
        oriented_box<T> b{center, {static_cast<T>((*this)(0, 1)), static_cast<T>((*this)(0, 1)), static_cast<T>((*this)(0, 1))}};
        if ((*this)(0, 8) < 1) b.half.z = 0;
        if ((*this)(0, 16) < 1) b.half.y = 0;
        if ((*this)(0, 8) < 1) return b;
        const vec3<double> u = place<double>(1), v = place<double>(1);
        const vec3<double> x = (1 / std::sqrt(dot(u, u))) * u, n = cross(x, v), y = (1 / std::sqrt(dot(n, n))) * n, z = cross(x, y);
        const double m[] = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
        const double unit = (*this)(0, 4) < 1 ? 0x1p-12 : 0x1p-60;
        for (int k = 0; k < 9; ++k) b.rotation[k] = static_cast<T>(std::round(m[k] / unit) * unit);
        return b;
    }
};

struct tally {
    std::size_t pairs = 0, known = 0, yes = 0, wrong = 0;
    template <class S, class U>
    void add(const S& s, const U& t) {
        const verdict v = detail::near_oriented(s, t);
        const bool truth = intersects<exact>(s, t);
        ++pairs, known += v != verdict::unknown, yes += v == verdict::yes, wrong += v != verdict::unknown && v != to_verdict(truth);
    }
};

}  // namespace

TEMPLATE_TEST_CASE("an oriented box and what is near it", "", float, double) {
    using T = TestType;
    draws d;
    tally of_triangles, of_capsules, of_boxes, of_spheres;
    for (const double far : {0.0, 1.0, 0x1p10, 0x1p20}) {
        for (int i = 0; i < 4000; ++i) {
            const vec3<T> at = d.place<T>(far);
            const oriented_box<T> s = d.box(at);
            const auto near = [&](double within) { return at + d.place<T>(within); };
            const vec3<T> a = near(1.25);
            of_triangles.add(s, triangle<T>{a, a + d.place<T>(1), a + d.place<T>(1)});
            of_capsules.add(s, capsule<T>{{a, a + d.place<T>(1)}, static_cast<T>(d(0, 1))});
            of_boxes.add(s, d.box(near(1.25)));
            of_spheres.add(s, sphere<T>{a, static_cast<T>(d(0, 1))});
        }
    }
    for (const tally& of : {of_triangles, of_capsules, of_boxes, of_spheres}) {
        CHECK(of.wrong == 0);
        CHECK(of.known > of.pairs / 2);
        CHECK(of.yes > of.pairs / 25);
        CHECK(of.known - of.yes > of.pairs / 4);
    }
}

TEMPLATE_TEST_CASE("an oriented box and what all but touches it", "", float, double) {
    using T = TestType;
    // A point of a face of the box, a unit in the last place or a few of them farther or less far, is a corner of the other shape,
    // which lies outside. Some numbers are as large or as small as they come.
    draws d;
    tally all, of_spheres;
    const int least = std::is_same_v<T, float> ? -120 : -1000, most = std::is_same_v<T, float> ? 120 : 1000;
    for (int i = 0; i < 12000; ++i) {
        oriented_box<T> s = d.box(d.place<T>(i % 4 == 0 ? 0x1p12 : 1));
        const int power = i % 8 == 0 ? static_cast<int>(d(least, most)) : 0;
        const T unit = std::ldexp(T(1), power);
        s.center = unit * s.center, s.half = unit * s.half;
        const auto corners = detail::points_of(s);
        const vec3<T> c = corners.at[i % 8], e = corners.at[(i % 8) ^ 1], f = corners.at[(i % 8) ^ 2];
        const vec3<T> on = c + static_cast<T>(d(0, 1)) * (e - c) + static_cast<T>(d(0, 0.5)) * (f - c);
        const vec3<T> out = on - s.center, off = std::ldexp(T(1), -static_cast<int>(d(10, 60))) * out;
        const vec3<T> tip = i % 3 == 0 ? on : i % 3 == 1 ? on + off : on - off;
        const auto beside = [&] { return tip + T(0.5) * out + (unit * T(0.125)) * d.place<T>(1); };
        all.add(s, triangle<T>{tip, beside(), beside()});
        const T radius = std::sqrt(dot(T(0.25) * out, T(0.25) * out));
        all.add(s, capsule<T>{{tip + T(0.25) * out, beside()}, radius});
        of_spheres.add(s, sphere<T>{tip + T(0.25) * out, radius});
        oriented_box<T> t = s;
        t.center = s.center + (tip - s.center) + T(0.999) * (corners.at[(i % 8) ^ 7] - s.center) + (tip - on);
        all.add(s, t);
    }
    CHECK(all.wrong == 0);
    CHECK(all.known > all.pairs / 4);
    CHECK(all.known < all.pairs);
    CHECK(of_spheres.wrong == 0);
    CHECK(of_spheres.known > of_spheres.pairs / 4);
    CHECK(of_spheres.known < of_spheres.pairs);
}

TEMPLATE_TEST_CASE("an oriented box reaches all that it touches", "", float, double) {
    using T = TestType;
    draws d;
    std::size_t touching = 0, missed = 0, by_box = 0, kept = 0;
    for (int i = 0; i < 20000; ++i) {
        const oriented_box<T> s = d.box(d.place<T>(i % 4 == 0 ? 0x1p16 : 1));
        const auto reach = reach_of(s);
        // Around a point of the box, or a box that a corner of it all but touches.
        const auto corners = detail::points_of(s);
        const vec3<T> at = i % 2 == 0 ? s.center + d.place<T>(2) : corners.at[i % 8];
        const vec3<T> half = static_cast<T>(d(0, 0.5)) * vec3<T>{1, 1, 1}, p = i % 2 == 0 ? at - half : at;
        const aabb<T> box{p, p + half};
        const bool touches = intersects<exact>(s, box);
        touching += touches;
        missed += touches && !reach(box);
        by_box += i % 4 == 2 && !touches && overlaps(bounds(s), box);
        kept += i % 4 == 2 && !touches && reach(box);
        const aabb<T> around = reach.bounds(), smallest = bounds(s);
        missed += !(detail::least(around.lower, smallest.lower) == around.lower &&
                    detail::greatest(around.upper, smallest.upper) == around.upper);
    }
    CHECK(missed == 0);
    CHECK(touching > 5000);
    CHECK(3 * kept < 2 * by_box);
    const T large = std::numeric_limits<T>::max();
    for (const T size : {large / 4, std::numeric_limits<T>::min(), std::numeric_limits<T>::denorm_min()}) {
        const oriented_box<T> s{{size, size, size}, {size, size, size}, {T(0.6), T(-0.8), 0, T(0.8), T(0.6), 0, 0, 0, 1}};
        for (const vec3<T>& corner : detail::points_of(s).at) CHECK(reach_of(s)(aabb<T>{corner, corner}));
    }
}
