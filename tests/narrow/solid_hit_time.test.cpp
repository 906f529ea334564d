// SPDX-License-Identifier: MIT
#include <abut/narrow/solid_hit_time.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <abut/predicate/intersects.hpp>
#include <abut/shape/shape.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/line_oracle.hpp"
#include "support/modes.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"

namespace {

using namespace abut;
using detail::hit_time;

struct solid_tally {
    std::uint64_t lines = 0, hits = 0, inside = 0, rounded = 0, bounded = 0, wrong = 0;
    solid_tally& operator+=(const solid_tally& o) {
        lines += o.lines, hits += o.hits, inside += o.inside, rounded += o.rounded, bounded += o.bounded, wrong += o.wrong;
        return *this;
    }
};

template <class Line, class S>
void examine_solid(const Line& line, const S& s, solid_tally& sum) {
    using T = scalar_type_of<S>;
    const detail::line_of<T> l(line);
    const test::line_oracle<S> truth(l, s);
    const double time = hit_time<exact>(line, s);
    const detail::time_bounds bounds = detail::hit_time_bounds<filtered>(line, s);
    const bool is_met = time >= 0;
    ++sum.lines;
    sum.hits += is_met;
    sum.inside += time == 0;
    sum.wrong += !truth.is_right(time);
    sum.wrong += hit_time<filtered>(line, s) != time;
    sum.wrong += (bounds.first >= 0) != is_met || (is_met && !(bounds.first <= time && time <= bounds.last));
    sum.wrong += detail::is_met<filtered>(line, s) != is_met || detail::is_met<exact>(line, s) != is_met;
    sum.wrong += intersects(line, s) != is_met || intersects<exact>(s, line) != is_met;
    if (!is_met || time == 0) return;
    sum.bounded += !bounds.is_one();
    if (!bounds.is_one()) {
        const double before = std::nextafter(bounds.first, 0.0);
        sum.wrong += truth.is_met_by(test::exactly(before)) || !truth.is_met_by(test::exactly(bounds.last));
    }
    sum.rounded += detail::rounded_time(detail::entry_in_pairs(l, s)) >= 0;
}

/// A line beside the solid around an axis: along corners of a case, to places of the solid, along axes, of no length, from
/// inside.
template <scalar T>
ray<T> line_beside(const test::revolution_case<T>& c, std::uint64_t k) {
    test::draws d(17, k, 3);
    const auto way = [](const vec3<T>& from, const vec3<T>& to) {
        const auto one = [](T x, T y) { return std::isfinite(y - x) ? y - x : y / 2 - x / 2; };
        return vec3<T>{one(from.x, to.x), one(from.y, to.y), one(from.z, to.z)};
    };
    const auto middle = [](const vec3<T>& x, const vec3<T>& y) { return T(0.5) * x + T(0.5) * y; };
    const vec3<T>&o = c.corner[0], &a = c.axis.a, &b = c.axis.b;
    vec3<T> axis{0, 0, 0};
    T* const coordinate[] = {&axis.x, &axis.y, &axis.z};
    *coordinate[d.below(3)] = d.below(2) == 0 ? T(1) : T(-2);
    const T r = d.below(2) == 0 ? c.radius : -c.radius;
    vec3<T> rim = d.below(2) == 0 ? a : b;
    T* const places[] = {&rim.x, &rim.y, &rim.z};
    T& moved = *places[d.below(3)];
    if (std::isfinite(moved + r)) moved += r;
    ray<T> line{o, way(o, c.corner[1])};
    switch (d.below(16)) {
        case 0:
            line.direction = way(c.corner[1], o);
            break;
        case 1:
            line.direction = way(o, a);
            break;
        case 2:
            line.direction = way(o, b);
            break;
        case 3:
            line.direction = way(o, middle(a, b));
            break;
        case 4:
            line.direction = way(o, rim);
            break;
        case 5:
            line.direction = axis;
            break;
        case 6:
            line.direction = way(a, b);
            break;
        case 7:
            line.direction = {0, 0, 0};
            break;
        case 8:
            line = {middle(a, b), c.corner[1]};
            break;
        case 9:
            line = {rim, axis};
            break;
        case 10:
            line = {rim, way(a, b)};
            break;
        case 11:
            line = {rim, way(rim, c.corner[2])};
            break;
        case 12:
            line = {c.corner[2], way(c.corner[2], rim)};
            break;
        default:
            break;
    }
    if (d.below(6) == 0) {
        const T far = std::ldexp(T(1), d.below(121) - 60);
        line.direction = far * line.direction;
    }
    if (d.below(8) == 0) line.origin.x = std::nextafter(line.origin.x, d.below(2) == 0 ? T(-1) : T(1));
    return is_valid(line) ? line : ray<T>{o, c.corner[1]};
}

template <class S>
S solid_around(const test::revolution_case<scalar_type_of<S>>& c, std::uint64_t k) {
    using T = scalar_type_of<S>;
    if constexpr (std::same_as<S, sphere<T>>) {
        return {c.axis.a, c.radius};
    } else if constexpr (std::same_as<S, aabb<T>>) {
        aabb<T> box = bounds(k % 3 == 0 ? segment<T>{c.axis.a, c.corner[2]} : c.axis);
        if (k % 7 == 0) box.upper.y = box.lower.y;
        return box;
    } else {
        return test::solid_of<S>(c.axis, c.radius);
    }
}

template <class S>
void check_times_of() {
    using T = scalar_type_of<S>;
    solid_tally all;
    for (int i = 0; i < test::revolution_family_count; ++i) {
        const auto f = static_cast<test::revolution_family>(i);
        const bool is_long = std::same_as<T, double> && (f == test::revolution_family::all_bit_patterns ||
                                                         f == test::revolution_family::mixed_exponents);
        const auto sum = test::in_threads<solid_tally>(
            test::some_samples(is_long ? 200 : 20), [&](std::uint64_t first, std::uint64_t last, solid_tally& tally) {
                for (std::uint64_t k = first; k < last; ++k) {
                    const auto c = test::make_revolution_case<T>(test::sample_seed + 5, f, k, std::same_as<S, cone<T>>);
                    const S s = solid_around<S>(c, k);
                    const ray<T> line = line_beside(c, k);
                    examine_solid(line, s, tally);
                    examine_solid(segment<T>{c.corner[0], c.corner[1]}, s, tally);
                    const vec3<T> end = line.origin + T(0.5) * line.direction;
                    if (is_valid(end)) examine_solid(segment<T>{line.origin, end}, s, tally);
                }
            });
        INFO(test::name_of(f));
        CHECK(sum.wrong == 0);
        CHECK(sum.hits * 50 > sum.lines);
        all += sum;
    }
    CHECK(all.hits * 5 > all.lines);
    CHECK(all.hits * 10 < all.lines * 9);
    CHECK((all.hits - all.inside) * 10 > all.lines);
    CHECK(all.inside * 50 > all.lines);
    CHECK(all.rounded * 2 > all.hits - all.inside);
    CHECK(all.bounded * 2 > all.hits - all.inside);
}

/// Where arithmetic rounds otherwise, or reads denormal numbers as 0, filters say what integers say, or nothing.
template <class S>
void check_filter_of() {
    using T = scalar_type_of<S>;
    for (const test::floating_mode& mode : test::floating_modes()) {
        INFO(mode.name);
        std::uint64_t wrong = 0, open = 0, asked = 0;
        for (int i = 0; i < test::revolution_family_count; ++i) {
            const auto f = static_cast<test::revolution_family>(i);
            if (std::same_as<T, double> && f == test::revolution_family::all_bit_patterns) continue;
            for (std::uint64_t k = 0; k < test::some_samples(100); ++k) {
                auto c = test::make_revolution_case<T>(test::sample_seed + 6, f, k, std::same_as<S, cone<T>>);
                if (f == test::revolution_family::denormal && k % 2 == 0) {  // and normal numbers beside them
                    for (int n = 0; n < 16; ++n)
                        *test::construction::number_of(c, n) *= T(0.5) / std::numeric_limits<T>::epsilon();
                }
                const S s = solid_around<S>(c, k);
                const auto look = [&](const auto& line) {
                    const double time = hit_time<exact>(line, s);
                    detail::entry_bounds bounds{};
                    test::in_mode(mode, [&] { bounds = detail::certified_line(detail::line_of<T>(line), s); });
                    ++asked;
                    open += bounds.met == verdict::unknown;
                    wrong += bounds.met == verdict::no && time >= 0;
                    wrong += bounds.met == verdict::yes && !(bounds.first <= time && time <= bounds.last);
                };
                look(line_beside(c, k));
                look(segment<T>{c.corner[0], c.corner[1]});
            }
        }
        CHECK(wrong == 0);
        CHECK(open * 2 < asked);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("solid hit time: filters in every rounding mode", "", sphere<float>, aabb<float>, capsule<float>,
                   cylinder<float>, cone<float>, sphere<double>, aabb<double>, capsule<double>, cylinder<double>,
                   cone<double>) {
    check_filter_of<TestType>();
}

TEST_CASE("solid hit time: next to halfway between two doubles") {
    // From -x to 2^53, beside which doubles are 2 apart: at 2^53 + x.
    const auto time = [](double x) {
        const ray<double> line{{-x, 0, 0}, {1, 0, 0}};
        const double by_box = hit_time<filtered>(line, aabb<double>{{0x1p53, -1, -1}, {0x1p54, 1, 1}});
        CHECK(by_box == hit_time<exact>(line, aabb<double>{{0x1p53, -1, -1}, {0x1p54, 1, 1}}));
        CHECK(by_box == hit_time<filtered>(line, sphere<double>{{0x1p53 + 8, 0, 0}, 8}));
        CHECK(by_box == hit_time<exact>(line, sphere<double>{{0x1p53 + 8, 0, 0}, 8}));
        CHECK(by_box == hit_time<filtered>(line, cylinder<double>{{{0x1p53, 0, 0}, {0x1p53 + 8, 0, 0}}, 8}));
        return by_box;
    };
    CHECK(time(1) == 0x1p53);
    CHECK(time(1 - 0x1p-53) == 0x1p53);
    CHECK(time(1 + 0x1p-52) == 0x1p53 + 2);
    CHECK(time(3) == 0x1p53 + 2);
    CHECK(time(3 + 0x1p-51) == 0x1p53 + 4);
}

TEMPLATE_TEST_CASE("solid hit time: rounded to nearest in every family", "", float, double) {
    SECTION("spheres") { check_times_of<sphere<TestType>>(); }
    SECTION("boxes") { check_times_of<aabb<TestType>>(); }
    SECTION("capsules") { check_times_of<capsule<TestType>>(); }
    SECTION("cylinders") { check_times_of<cylinder<TestType>>(); }
    SECTION("cones") { check_times_of<cone<TestType>>(); }
}

TEST_CASE("solid hit time: a box so long that the way to its end overflows") {
    // It leaves the box's slab in x long before it comes to the box's height.
    constexpr double h = 1.7e308;
    const aabb<double> far{{-h, 0x1p200, -1}, {h, 0x1p201, 1}}, flat{{-h, 0.5, -1}, {h, 3, 1}};
    const ray<double> steep{{-h, 0, 0}, {0x1p900, 1, 0}}, steeper{{-h, 0, 0}, {0x1p999, 0x1p-30, 0}};
    const auto check = [](const ray<double>& line, const aabb<double>& box, int axis) {
        const auto turned = [axis](vec3<double> v) {
            for (int k = 0; k < axis; ++k) detail::rotate(v.x, v.y, v.z);
            return v;
        };
        const ray<double> l{turned(line.origin), turned(line.direction)};
        const aabb<double> b{turned(box.lower), turned(box.upper)};
        CHECK(hit_time<exact>(l, b) < 0);
        CHECK(hit_time<filtered>(l, b) < 0);
        CHECK(detail::hit_time_bounds<filtered>(l, b).first < 0);
        CHECK_FALSE(intersects(l, b));
    };
    for (int axis = 0; axis < 3; ++axis) {
        check(steep, far, axis);
        check(steeper, flat, axis);
    }
}
