// SPDX-License-Identifier: MIT
#include <abut/narrow/contact.hpp>

#include <random>

#include "support/catch.hpp"
#include "support/contact_oracles.hpp"
#include "support/triangle_families.hpp"

namespace abut::test {

// What docs/contacts.md says, one by one; in constant expressions, and at run time the same.

template <class T>
constexpr triangle<T> ground{{-4, -4, 0}, {4, -4, 0}, {0, 4, 0}};

template <class T>
constexpr bool is_near(const vec3<T>& p, const vec3<T>& q, T bound) {
    const vec3<T> d = detail::absolute(p - q);
    return d.x <= bound && d.y <= bound && d.z <= bound;
}

template <class S, class U, class T>
constexpr bool is(const S& s, const U& t, const vec3<T>& point, const vec3<T>& normal, T depth) {
    const auto c = contact_of(s, t);
    return c && is_near(c->point, point, contact_bound(s, t)) && is_near(c->normal, normal, unit_roundoff<T>) &&
           detail::absolute(c->depth - depth) <= contact_bound(s, t) && c->a == 0 && c->b == 0;
}

/// The line of the first case that does not hold; 0 if all do.
template <class T>
constexpr int wrong_case() {
    using P = vec3<T>;
    using tri = triangle<T>;
    constexpr T half = T(0.5), quarter = T(0.25);
    const tri g = ground<T>;
    // A corner that has passed the face by 1/4: a goes up. The common part is a segment, and its middle is the point.
    const tri dips{{0, 0, -quarter}, {-1, 0, half}, {1, 0, half}};
    if (!(is(dips, g, P{0, 0, 0}, P{0, 0, 1}, quarter))) return __LINE__;
    if (!(is(g, dips, P{0, 0, 0}, P{0, 0, -1}, quarter))) return __LINE__;
    // From below.
    if (!(is(tri{{0, 0, quarter}, {-1, 0, -half}, {1, 0, -half}}, g, P{0, 0, 0}, P{0, 0, -1}, quarter))) return __LINE__;
    // A corner in the face.
    if (!(is(tri{{0, 0, 0}, {-1, 0, 2}, {1, 0, 2}}, g, P{0, 0, 0}, P{0, 0, 1}, T(0)))) return __LINE__;
    // Edges that cross: the edge from (0, 0, 0) along z, and the edge along x that g has at y = -4.
    const auto crossing = contact_of(tri{{0, -4, -1}, {0, -4, 1}, {0, -8, 0}}, g);
    if (!(crossing && is_near(crossing->point, P{0, -4, 0}, T(1e-6)) && crossing->depth == 1)) return __LINE__;
    // Coplanar; identical; an edge in common; a corner in common.
    if (!(is(tri{{-1, -1, 0}, {1, -1, 0}, {0, -1, 0}}, g, P{0, -1, 0}, P{0, 0, 1}, T(0)))) return __LINE__;
    const auto same = contact_of(g, g);
    if (!(same && same->normal == P{0, 0, 1} && same->depth == 0)) return __LINE__;
    const auto edge = contact_of(tri{{-4, -4, 0}, {4, -4, 0}, {0, -4, 5}}, g);
    if (!(edge && edge->point.y == -4 && edge->point.z == 0 && edge->point.x > -4 && edge->point.x < 4)) return __LINE__;
    if (!(edge->normal == P{0, 0, 1} && edge->depth == 0)) return __LINE__;
    if (!(is(tri{{0, 4, 0}, {1, 9, 0}, {0, 9, 1}}, g, P{0, 4, 0}, P{0, 0, 1}, T(0)))) return __LINE__;
    // Degenerate: a segment through the face, a point in it, crossing segments, segments on one line, one point.
    if (!(is(tri{{0, 0, 1}, {0, 0, -half}, {0, 0, -half}}, g, P{0, 0, 0}, P{0, 0, 1}, half))) return __LINE__;
    if (!(is(tri{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, g, P{1, 0, 0}, P{0, 0, 1}, T(0)))) return __LINE__;
    if (!(is(tri{{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, tri{{0, -1, 0}, {0, 1, 0}, {0, 0, 0}}, P{0, 0, 0}, P{0, 0, 1}, T(0))))
        return __LINE__;
    const auto line = contact_of(tri{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}, tri{{0, 0, 0}, {3, 0, 0}, {2, 0, 0}});
    if (!(line && line->normal.x == 0 && line->depth == 0 && line->point.y == 0 && line->point.x >= 0 && line->point.x <= 1))
        return __LINE__;
    if (!(is(tri{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, tri{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, P{1, 2, 3}, P{0, 0, 1}, T(0))))
        return __LINE__;
    // Segments and points.
    if (!(is(segment<T>{{0, 0, 1}, {0, 0, -half}}, g, P{0, 0, 0}, P{0, 0, 1}, half))) return __LINE__;
    if (!(is(g, P{1, 0, 0}, P{1, 0, 0}, P{0, 0, -1}, T(0)))) return __LINE__;
    // Spheres: beside, off an edge, on the face, around.
    if (!(is(sphere<T>{{0, 0, 4}, 5}, g, P{0, 0, 0}, P{0, 0, 1}, T(1)))) return __LINE__;
    if (!(is(g, sphere<T>{{0, 0, 4}, 5}, P{0, 0, 0}, P{0, 0, -1}, T(1)))) return __LINE__;
    if (!(is(sphere<T>{{0, -7, 4}, 6}, g, P{0, -4, 0}, P{0, T(-0.6), T(0.8)}, T(1)))) return __LINE__;
    if (!(is(sphere<T>{{0, 0, 0}, 2}, g, P{0, 0, 0}, P{0, 0, 1}, T(2)))) return __LINE__;
    if (!(is(sphere<T>{{0, 0, 0}, 2}, segment<T>{{-1, 0, 0}, {1, 0, 0}}, P{0, 0, 0}, P{0, 0, 1}, T(2)))) return __LINE__;
    if (!(is(sphere<T>{{0, 0, 5}, 2}, sphere<T>{{0, 0, 1}, 3}, P{0, 0, T(3.5)}, P{0, 0, 1}, T(1)))) return __LINE__;
    if (!(is(sphere<T>{{1, 1, 1}, 2}, sphere<T>{{1, 1, 1}, 3}, P{1, 1, 1}, P{0, 0, 1}, T(5)))) return __LINE__;
    // Capsules: above, and with the axis through the face.
    if (!(is(capsule<T>{{{0, 0, 1}, {0, 0, 5}}, 2}, g, P{0, 0, 0}, P{0, 0, 1}, T(1)))) return __LINE__;
    if (!(is(capsule<T>{{{0, 0, -quarter}, {0, 0, 5}}, 2}, g, P{0, 0, 0}, P{0, 0, 1}, T(2) + quarter))) return __LINE__;
    // Planes: the triangle goes up where the plane's normal points; a normal of 0.
    if (!(is(plane<T>{{0, 0, 2}, 0}, dips, P{0, 0, 0}, P{0, 0, -1}, quarter))) return __LINE__;
    if (!(is(dips, plane<T>{{0, 0, 2}, 0}, P{0, 0, 0}, P{0, 0, 1}, quarter))) return __LINE__;
    if (!(is(plane<T>{{0, 0, 0}, 0}, dips, P{0, 0, -quarter}, P{0, 0, 1}, largest_finite<T>))) return __LINE__;
    // Boxes: on the ground, and with a triangle inside.
    if (!(is(aabb<T>{{-1, -1, -quarter}, {1, 1, 3}}, g, P{0, 0, 0}, P{0, 0, 1}, quarter))) return __LINE__;
    // None.
    if (!(!contact_of(dips, tri{{0, 0, -9}, {1, 0, -9}, {0, 1, -9}}))) return __LINE__;
    return 0;
}

static_assert(wrong_case<float>() == 0);
static_assert(wrong_case<double>() == 0);

TEMPLATE_TEST_CASE("contacts of plain positions, at run time", "", float, double) { CHECK(wrong_case<TestType>() == 0); }

TEST_CASE("square roots of constant expressions are rounded as std::sqrt rounds") {
    std::mt19937_64 engine(20261132);
    for (int i = 0; i < 200000; ++i) {
        const int e = static_cast<int>(engine() % 900) - 450;
        const double x = std::ldexp(1 + static_cast<double>(engine() >> 12) * 0x1p-52, e);
        REQUIRE(detail::contact_math::constant_root(x) == std::sqrt(x));
        REQUIRE(detail::contact_math::constant_root(x * x) == std::sqrt(x * x));
    }
    static_assert(detail::contact_math::constant_root(2) == 1.4142135623730951);
}

TEST_CASE("errors of products are the same in constant expressions") {
    constexpr double a = 1.0 / 3, b = 0x1.fedcba9876543p10;
    constexpr double constant = detail::error_of_product(a, b, a * b);
    CHECK(constant == std::fma(a, b, -(a * b)));
}

/// By the definition of what is discarded, but where it is a tie.
TEMPLATE_TEST_CASE("the overlap along the line of two planes", "", float, double) {
    using T = TestType;
    int lines = 0;
    for (const auto family : {triangle_family::random, triangle_family::needle_1e3, triangle_family::scaled_1e30,
                              triangle_family::lattice_16, triangle_family::largest, triangle_family::coplanar_aligned}) {
        for (std::uint64_t i = 0; i < 400; ++i) {
            const auto p = make_triangle_pair<T>(20261133, family, i);
            if (!intersects(p.a, p.b)) continue;
            const wide_point line = cross(wide_normal(p.a), wide_normal(p.b));
            const T found = detail::overlap_along_shared_line(p.a, p.b);
            const wide sine = length_of(line), one = length_of(wide_normal(p.a)) * length_of(wide_normal(p.b));
            if (sine == 0) {
                CHECK(found < 0);
                continue;
            }
            if (sine < one / 1000) continue;  // the direction is not certain
            least_of least(p.a, p.b);
            least.offer(line);
            const wide expected = std::min<wide>(least.value(), wide(largest_finite<T>));
            CHECK(abs(wide(found) - expected) <= 1000 * wide(contact_bound(p.a, p.b)));
            ++lines;
        }
    }
    CHECK(lines > 200);
}

}  // namespace abut::test
