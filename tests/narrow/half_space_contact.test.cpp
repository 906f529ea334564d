// SPDX-License-Identifier: MIT
#include <abut/narrow/half_space_contact.hpp>

#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/predicate/within.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

#include "support/catch.hpp"
#include "support/oriented_boxes.hpp"
#include "support/scenes.hpp"

// Contacts and distances of half spaces and of oriented boxes. What a contact promises is asked of predicates: its point is
// one of both shapes and the shapes are apart when moved by its depth, within the bound, and not when moved by less. Depths
// and distances over a half space have a formula in long double as well.

namespace {

using namespace abut;

constexpr half_space<float> ground{{0, 0, 2}, 0};
constexpr auto ball_on_ground = contact_of(ground, sphere<float>{{1, 2, 3}, 4});
static_assert(ball_on_ground && ball_on_ground->depth == 1 && ball_on_ground->normal == vec3<float>{0, 0, -1} &&
              ball_on_ground->point == vec3<float>{1, 2, -1});
constexpr auto box_on_ground = contact_of(aabb<float>{{1, 1, -3}, {3, 3, 5}}, ground);
static_assert(box_on_ground && box_on_ground->depth == 3 && box_on_ground->normal == vec3<float>{0, 0, 1} &&
              box_on_ground->point == vec3<float>{2, 2, -3});
constexpr auto lying = contact_of(cylinder<float>{{{0, 0, 1}, {4, 0, 1}}, 2}, ground);
static_assert(lying && lying->depth == 1 && lying->point == vec3<float>{2, 0, -1});
constexpr auto standing = contact_of(cone<float>{{0, 0, 1}, {0, 0, -1}, 2}, ground);
static_assert(standing && standing->depth == 1 && standing->point == vec3<float>{0, 0, -1});
static_assert(contact_of(ground, oriented_box<float>{{0, 0, -50}, {1, 1, 1}})->depth == 51);
static_assert(!contact_of(ground, vec3<float>{0, 0, 1}));
static_assert(distance(ground, sphere<float>{{0, 0, 4}, 1}).distance == 3);
static_assert(distance(cone<float>{{0, 0, 6}, {0, 0, 4}, 1}, ground).distance == 4);
static_assert(distance(oriented_box<float>{{0, 0, 4}, {1, 1, 1}}, sphere<float>{{0, 0, 0}, 1}).distance == 2);
static_assert(distance(ground, oriented_box<float>{{0, 0, -4}, {1, 1, 1}}).distance == 0);

template <class T>
vec3<T> moved(const vec3<T>& p, const vec3<T>& n, double by) {
    const auto one = [&](T x, T d) { return static_cast<T>(static_cast<double>(x) + by * static_cast<double>(d)); };
    return {one(p.x, n.x), one(p.y, n.y), one(p.z, n.z)};
}

/// How low a shape is over a half space, in long double; the shape as points, and how far around them.
template <class T>
long double lowest(const half_space<T>& s, const std::vector<vec3<T>>& points, T radius) {
    const vec3<T>& n = s.normal;
    const auto wide = [](T x) { return static_cast<long double>(x); };
    const long double length = std::sqrt(wide(n.x) * wide(n.x) + wide(n.y) * wide(n.y) + wide(n.z) * wide(n.z));
    long double least = 1e30L;
    for (const vec3<T>& p : points) {
        least = std::min(least,
                         (wide(n.x) * wide(p.x) + wide(n.y) * wide(p.y) + wide(n.z) * wide(p.z) - wide(s.offset)) / length);
    }
    return least - wide(radius);
}

struct tally {
    std::size_t touch = 0, apart = 0, wrong = 0;
};

template <class T, class S>
void check_over(const half_space<T>& s, const S& t, long double low, tally& sum) {
    const double bound = static_cast<double>(contact_bound(s, t));
    const auto c = contact_of(s, t);
    const auto d = distance(s, t), other = distance(t, s);
    bool right = intersects(s, t) == c.has_value() && d.distance == other.distance && d.point_a == other.point_b;
    if (c) {
        ++sum.touch;
        const contact<T>& found = *c;
        right = right && contact_of(t, s)->depth == found.depth && contact_of(t, s)->point == found.point;
        right = right && std::abs(static_cast<long double>(found.depth) + std::min(low, 0.0L)) <= bound;
        right = right && within(s, found.point, bound) && static_cast<double>(distance(t, found.point).distance) <= bound;
        // It is the deepest, but for rounding.
        right = right && std::abs(lowest<T>(s, {found.point}, 0) - low) <= 4 * bound && d.distance == 0;
        right = right && within(s, d.point_a, bound) && static_cast<double>(distance(t, d.point_a).distance) <= bound;
    } else {
        ++sum.apart;
        right = right && std::abs(static_cast<long double>(d.distance) - low) <= bound && d.distance > 0;
        right = right && within(s, d.point_a, bound) && static_cast<double>(distance(t, d.point_b).distance) <= bound;
    }
    sum.wrong += !right;
}

template <class T>
long double lowest_of_solid(const half_space<T>& s, const vec3<T>& a, const vec3<T>& b, T radius, bool is_cone) {
    const auto wide = [](T x) { return static_cast<long double>(x); };
    const vec3<long double> n{wide(s.normal.x), wide(s.normal.y), wide(s.normal.z)},
        d{wide(b.x) - wide(a.x), wide(b.y) - wide(a.y), wide(b.z) - wide(a.z)};
    const auto product = [](const auto& u, const auto& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
    const long double nn = product(n, n), dd = product(d, d), along = product(n, d);
    const long double sine = dd > 0 ? std::sqrt(std::max(0.0L, 1 - along * along / (nn * dd))) : 1;
    const long double rim = wide(radius) * sine, first = lowest<T>(s, {a}, 0), last = lowest<T>(s, {b}, 0);
    return dd > 0 ? std::min(is_cone ? first : first - rim, last - rim) : last - rim;
}

template <class T>
void check_half_spaces() {
    test::uniform random(851);
    tally of[6];
    for (std::uint64_t i = 0; i < 600; ++i) {
        const half_space<T> s{random.point<T>(-1, 1), static_cast<T>(random(-0.7, 0.7))};
        const vec3<T> p = random.point<T>(-1, 1), q = p + random.point<T>(-0.5, 0.5), r = p + random.point<T>(-0.5, 0.5);
        const T radius = static_cast<T>(random(0, 0.4));
        check_over(s, triangle<T>{p, q, r}, lowest<T>(s, {p, q, r}, 0), of[0]);
        check_over(s, sphere<T>{p, radius}, lowest<T>(s, {p}, radius), of[1]);
        check_over(s, capsule<T>{{p, q}, radius}, lowest<T>(s, {p, q}, radius), of[2]);
        const auto box = test::random_oriented_box<T>(random, 851, i, false);
        check_over(s, box, lowest<T>(s, test::corners_of(box), 0), of[3]);
        check_over(s, cylinder<T>{{p, q}, radius}, lowest_of_solid(s, p, q, radius, false), of[4]);
        check_over(s, cone<T>{p, q, radius}, lowest_of_solid(s, p, q, radius, true), of[5]);
    }
    for (const tally& t : of) {
        CAPTURE(&t - of);
        CHECK(t.wrong == 0);
        CHECK(t.touch > 100);
        CHECK(t.apart > 100);
    }
}

/// As of the hull of the same corners, to the bit; and moved by the depth the box is apart.
template <class T>
void check_boxes() {
    test::uniform random(852);
    tally of[7];
    for (std::uint64_t i = 0; i < 1200; ++i) {
        const auto box = test::random_oriented_box<T>(random, 852, i, i % 2 == 0);
        const auto points = test::corners_of(box);
        const hull<T> same(points.data(), points.size());
        const vec3<T> p = i % 3 == 0 ? box.center + random.point<T>(-0.2, 0.2) : random.point<T>(-1, 1),
                      q = p + random.point<T>(-0.6, 0.6);
        const T radius = static_cast<T>(random(0, 0.4));
        const auto compare = [&](const auto& other, const auto& as_hull, tally& sum) {
            const auto c = contact_of(box, other);
            bool right = c == contact_of(same, as_hull) && contact_of(other, box) == contact_of(as_hull, same);
            right =
                right && distance(box, other) == distance(same, as_hull) && distance(other, box) == distance(as_hull, same);
            (c ? sum.touch : sum.apart) += 1;
            if (c) {
                const double by = static_cast<double>(c->depth) + static_cast<double>(contact_bound(box, other));
                oriented_box<T> away = box;
                away.center = moved(box.center, c->normal, by);
                right = right && !within(away, other, 0) == !intersects(away, other);
                right = right && distance(away, other).distance >= 0;
                away.center = moved(box.center, c->normal, by + 1e-5);
                right = right && !intersects(away, other);
            }
            sum.wrong += !right;
        };
        const auto with_itself = [&](const auto& other, tally& sum) { compare(other, other, sum); };
        with_itself(triangle<T>{p, q, p + random.point<T>(-0.6, 0.6)}, of[0]);
        with_itself(sphere<T>{p, radius}, of[1]);
        with_itself(capsule<T>{{p, q}, radius}, of[2]);
        with_itself(bounds(segment<T>{p, q}), of[3]);
        const auto other = test::random_oriented_box<T>(random, 853, i, i % 2 == 0);
        const auto points_of_other = test::corners_of(other);
        compare(other, hull<T>(points_of_other.data(), points_of_other.size()), of[4]);
        with_itself(segment<T>{p, q}, of[5]);
        const vec3<T> near = nearest_point(box, p);
        of[6].wrong += near != nearest_point(same, p);
        of[6].touch += near == p, of[6].apart += near != p;
    }
    for (const tally& t : of) {
        CAPTURE(&t - of);
        CHECK(t.wrong == 0);
        CHECK(t.touch > 50);
        CHECK(t.apart > 50);
    }
    // Planes and solids of revolution.
    for (std::uint64_t i = 0; i < 40; ++i) {
        const auto box = test::random_oriented_box<T>(random, 854, i, false);
        const auto points = test::corners_of(box);
        const hull<T> same(points.data(), points.size());
        const vec3<T> p = random.point<T>(-1, 1), q = p + random.point<T>(-0.6, 0.6);
        const plane<T> side{p, static_cast<T>(random(-1, 1))};
        CHECK(contact_of(side, box) == contact_of(side, same));
        CHECK(distance(box, side) == distance(same, side));
        const cone<T> solid{p, q, T(0.3)};
        CHECK(contact_of(box, solid) == contact_of(same, solid));
        CHECK(distance(solid, box) == distance(solid, same));
    }
}

}  // namespace

TEST_CASE("half_space: contacts and distances") {
    std::printf("contacts of half spaces and oriented boxes: seeds 851 to 854\n");
    check_half_spaces<float>();
    check_half_spaces<double>();
}
TEST_CASE("oriented_box: contacts, distances and nearest points") {
    check_boxes<float>();
    check_boxes<double>();
}
TEST_CASE("half_space: far planes, and none") {
    const auto c = contact_of(half_space<double>{{0, 0, 1}, 1e200}, vec3<double>{0, 0, 1e-200});
    REQUIRE(c.has_value());
    CHECK(c->depth == 1e200);
    const auto deep = contact_of(half_space<float>{{0, 0, 1e-30f}, 3e38f}, vec3<float>{0, 0, 1});
    REQUIRE(deep.has_value());
    CHECK(deep->depth == largest_finite<float>);
    const auto solid = contact_of(half_space<float>{{0, 0, 1}, 3e30f}, cylinder<float>{{{0, 0, 0}, {1, 0, 0}}, 1});
    REQUIRE(solid.has_value());
    CHECK(solid->depth == 3e30f);
    CHECK(contact_of(half_space<float>{{0, 0, 0}, 0}, vec3<float>{0, 0, 1})->depth == largest_finite<float>);
}
