// SPDX-License-Identifier: MIT
#pragma once

// What the predicates of a triangle and a box, a plane or a capsule all promise: every stage right in every family, whatever
// the floating-point mode; and one answer for whatever order, mirror or power of two a pair is
// given in.

#include <cmath>
#include <cstdint>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/other_shapes.hpp"
#include "support/samples.hpp"
#include "support/shape_oracles.hpp"
#include "support/stages.hpp"

namespace abut::test {

template <scalar T>
void examine_shapes(const aabb<T>& box, const triangle<T>& t, std::uint64_t index, stage_tally& sum) {
    const auto all = detail::values_of(box, t);
    examine_stages<detail::box_meets_triangle>(box, t, all.value, oracle::intersects(box, t), index, sum);
}

template <scalar T>
void examine_shapes(const plane<T>& p, const triangle<T>& t, std::uint64_t index, stage_tally& sum) {
    const auto all = detail::values_of(p, t);
    examine_stages<detail::plane_meets_triangle>(p, t, all.value, oracle::intersects(p, t), index, sum);
}

template <scalar T>
void examine_shapes(const capsule<T>& s, const triangle<T>& t, std::uint64_t index, stage_tally& sum) {
    const auto all = detail::values_of(s, t);
    examine_stages<detail::capsule_meets_triangle>(s, t, all.value, oracle::intersects(s, t), index, sum);
}

/// Names of the families of touching pairs, which differ from shape to shape.
struct touching_names {
    const char* name[5];
};

/// On the host only.
inline const char* name_of(shape_family f, const touching_names& touching) {
    const int i = static_cast<int>(f), first = static_cast<int>(shape_family::touching_0);
    return i >= first && i < first + 5 ? touching.name[i - first] : name_of(f);
}

/// Every stage against the oracle, family by family; the table goes where stages.hpp says.
template <template <class> class Shape>
void check_every_stage(const char* title, const char* file_name, const touching_names& touching) {
    check_every_family<shape_family>(
        title, file_name, false, shape_family_count, [&](shape_family f) { return name_of(f, touching); },
        []<class T>(T, shape_family f, std::uint64_t k, stage_tally& sum) {
            const auto p = make_shape_pair<Shape, T>(sample_seed, f, k);
            examine_shapes(p.s, p.t, k, sum);
        });
}

template <template <class> class Shape>
void check_every_mode() {
    const auto check = []<class T>(T) {
        for (int i = 0; i < shape_family_count; ++i) {
            const auto f = static_cast<shape_family>(i);
            const auto wrong = in_threads<std::uint64_t>(
                sample_count() / 4, [f](std::uint64_t first, std::uint64_t last, std::uint64_t& sum) {
                    for (std::uint64_t k = first; k < last; ++k) {
                        const auto p = make_shape_pair<Shape, T>(sample_seed, f, k);
                        const bool truth = oracle::intersects(p.s, p.t);
                        sum += modes_in_which([&] {
                            return intersects(p.s, p.t) != truth || decide<filtered>(p.s, p.t) == to_verdict(!truth);
                        });
                    }
                });
            CAPTURE(i, sizeof(T));
            CHECK(wrong == 0);
        }
    };
    check(float{});
    check(double{});
}

// --- one answer
// ------------------------------------------------------------------------------------------------------------

/// x to -z, y to x, z to -y: a mirror and a turn.
template <class T>
vec3<T> turned(const vec3<T>& v) {
    return {-v.z, v.x, -v.y};
}
template <class T>
triangle<T> turned(const triangle<T>& t) {
    return {turned(t.a), turned(t.b), turned(t.c)};
}
template <class T>
aabb<T> turned(const aabb<T>& box) {
    const vec3<T> p = turned(box.lower), q = turned(box.upper);
    return {detail::least(p, q), detail::greatest(p, q)};
}
template <class T>
plane<T> turned(const plane<T>& p) {
    return {turned(p.normal), p.offset};
}
template <class T>
capsule<T> turned(const capsule<T>& s) {
    return {{turned(s.axis.b), turned(s.axis.a)}, s.radius};
}

template <class T>
bool same(const triangle<T>& a, const triangle<T>& b) {
    return a.a == b.a && a.b == b.b && a.c == b.c;
}
template <class T>
bool same(const aabb<T>& a, const aabb<T>& b) {
    return a.lower == b.lower && a.upper == b.upper;
}
template <class T>
bool same(const plane<T>& a, const plane<T>& b) {
    return a.normal == b.normal && a.offset == b.offset;
}
template <class T>
bool same(const capsule<T>& a, const capsule<T>& b) {
    return a.axis.a == b.axis.a && a.axis.b == b.axis.b && a.radius == b.radius;
}

/// The order of corners and arguments, a turn and a mirror, and, where it is exact, a power of two.
template <template <class> class Shape>
void check_one_answer() {
    const auto check = [&]<class T>(T) {
        std::uint64_t differing = 0, scaled_pairs = 0;
        for (int i = 0; i < shape_family_count; ++i) {
            for (std::uint64_t k = 0; k < sample_count() / 10; ++k) {
                const auto [s, t] = make_shape_pair<Shape, T>(sample_seed + 1, static_cast<shape_family>(i), k);
                const bool answer = intersects(s, t);
                const triangle<T> orders[] = {
                    {t.a, t.c, t.b}, {t.b, t.a, t.c}, {t.b, t.c, t.a}, {t.c, t.a, t.b}, {t.c, t.b, t.a}};
                for (const triangle<T>& o : orders) differing += intersects(o, s) != answer;
                differing += intersects(turned(s), turned(t)) != answer;
                differing += intersects(turned(turned(turned(t))), turned(turned(turned(s)))) != answer;
                const T by = std::ldexp(T(1), static_cast<int>(k % 41) - 20);
                const auto s2 = construction::scaled(by, s);
                const auto t2 = construction::scaled(by, t);
                if (!same(construction::scaled(1 / by, s2), s) || !same(construction::scaled(1 / by, t2), t)) continue;
                ++scaled_pairs;
                differing += intersects(s2, t2) != answer;
            }
        }
        CHECK(differing == 0);
        CHECK(scaled_pairs * 2 > shape_family_count * (sample_count() / 10));
    };
    check(float{});
    check(double{});
}

}  // namespace abut::test
