// SPDX-License-Identifier: MIT
#include <abut/predicate/half_space.hpp>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/set.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/oriented_boxes.hpp"
#include "support/scenes.hpp"

// Half spaces against every shape that planes have stages with, and each other. The oracle is in rationals: how low the
// lowest points of a shape are, with the roots of radii squared away; it asks no plane.

namespace {

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

constexpr half_space<float> floor_at_0{{0, 0, 1}, 0};
static_assert(intersects(floor_at_0, vec3<float>{5, 5, 0}) && !intersects(floor_at_0, vec3<float>{5, 5, 1e-45f}));
static_assert(intersects(floor_at_0, sphere<float>{{0, 0, -7}, 1}) && intersects(sphere<float>{{0, 0, 3}, 3}, floor_at_0));
static_assert(!intersects(floor_at_0, sphere<float>{{0, 0, 3}, 0x1.7ffffep1f}));
static_assert(intersects(floor_at_0, aabb<float>{{0, 0, -9}, {1, 1, -8}}));
static_assert(!intersects<exact>(floor_at_0, triangle<float>{{0, 0, 1}, {1, 0, 1}, {0, 1, 2}}));
static_assert(within(floor_at_0, vec3<float>{0, 0, 2}, 2) && !within(vec3<float>{0, 0, 2}, floor_at_0, 0x1.fffffffffffffp0));
static_assert(intersects(floor_at_0, half_space<float>{{0, 0, -2}, 0}) &&
              intersects(half_space<float>{{0, 0, 2}, 9}, floor_at_0));
static_assert(!intersects(floor_at_0, half_space<float>{{0, 0, -2}, -1e-45f}));
static_assert(intersects(floor_at_0, half_space<float>{{0, 1e-45f, -2}, -9}));
static_assert(intersects(floor_at_0, plane<float>{{0, 0, -3}, 6}) && !intersects(plane<float>{{0, 0, 3}, 6}, floor_at_0));
static_assert(!decidable_pair<half_space<float>, triangle<double>>);
static_assert(!placeable<plane<float>> && placeable<half_space<double>>);

using exact_point = vec3<rational>;
template <class T>
exact_point exactly(const vec3<T>& p) {
    return {rational(p.x), rational(p.y), rational(p.z)};
}
rational product(const exact_point& a, const exact_point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// A height over a plane, in units of the normal's length, is `height`, less sqrt(sunk), less reach times that length.
struct lowest_place {
    rational height, sunk;  // sunk is a square
};

/// Whether height <= sqrt(sunk) + reach |n|, for each of the places. square_n = |n|^2.
bool is_below(const std::vector<lowest_place>& places, const rational& reach, const rational& square_n) {
    for (const lowest_place& p : places) {
        if (p.height <= 0) return true;
        const rational h = p.height * p.height, r = reach * reach * square_n;
        // h <= s + r + 2 sqrt(s r)
        const rational left = h - p.sunk - r;
        if (left <= 0 || left * left <= 4 * p.sunk * r) return true;
    }
    return false;
}

template <class T>
struct oracle {
    half_space<T> s;
    exact_point n = exactly(s.normal);

    [[nodiscard]] rational height(const vec3<T>& p) const { return product(n, exactly(p)) - rational(s.offset); }
    [[nodiscard]] bool near(const std::vector<vec3<T>>& points, T radius, double distance) const {
        std::vector<lowest_place> places;
        for (const vec3<T>& p : points) places.push_back({height(p), 0});
        return is_below(places, rational(radius) + rational(distance), product(n, n));
    }
    /// Of a cylinder or a cone: a rim around an end sinks by r |n| sin, which is a root of rationals.
    [[nodiscard]] bool near(const vec3<T>& a, const vec3<T>& b, T radius, bool is_cone, double distance) const {
        const exact_point from = exactly(a), to = exactly(b), d{to.x - from.x, to.y - from.y, to.z - from.z};
        const rational length = product(d, d), along = product(n, d);
        if (length == 0) return near({b}, radius, distance);
        const rational sunk = rational(radius) * rational(radius) * (product(n, n) - along * along / length);
        return is_below({{height(a), is_cone ? rational(0) : sunk}, {height(b), sunk}}, rational(distance), product(n, n));
    }
};

struct tally {
    std::size_t pairs = 0, hits = 0, wrong = 0;
};

template <class T, class S>
void compare(const half_space<T>& s, const S& t, const auto& truth, tally& sum) {
    const bool touch = truth(0.0);
    const auto lies = [&](verdict v) { return v == to_verdict(!touch); };
    ++sum.pairs;
    sum.hits += touch;
    bool right = intersects(s, t) == touch && intersects(t, s) == touch && intersects<exact>(s, t) == touch &&
                 resolve(s, t) == touch && !lies(decide<filtered>(s, t)) && !lies(decide<exact>(s, t));
    for (const double distance : {0.0, 0.25, 0.5, 0.7}) {
        const bool comes = truth(distance);
        right = right && within(s, t, distance) == comes && within<exact>(t, s, distance) == comes;
    }
    sum.wrong += !right;
}

template <class T>
void check_family(bool on_lattice) {
    test::uniform random(on_lattice ? 841 : 842);
    tally of[9];
    const auto number = [&](double lower, double upper) {
        const double x = random(lower, upper);
        return static_cast<T>(on_lattice ? std::floor(x * 4 + 0.5) / 4 : x);
    };
    const auto point = [&](double size) { return vec3<T>{number(-size, size), number(-size, size), number(-size, size)}; };
    for (std::uint64_t i = 0; i < 300; ++i) {
        half_space<T> s{point(1), number(-1, 1)};
        // Normals of whole length: radii then touch exactly.
        if (on_lattice && i % 2 == 0) s = {{1, 2, -2}, number(-3, 3)};
        if (s.normal == vec3<T>{0, 0, 0}) s.normal.x = 1;
        const oracle<T> truth{s};
        const vec3<T> p = point(1), q = p + point(0.75), r = p + point(0.75), o = p + point(0.75);
        const T radius = number(0, 0.5);
        const auto hull_truth = [&](const std::vector<vec3<T>>& points, T around = 0) {
            return [=, &truth](double distance) { return truth.near(points, around, distance); };
        };
        compare(s, p, hull_truth({p}), of[0]);
        compare(s, segment<T>{p, q}, hull_truth({p, q}), of[1]);
        compare(s, triangle<T>{p, q, r}, hull_truth({p, q, r}), of[2]);
        compare(s, sphere<T>{p, radius}, hull_truth({p}, radius), of[3]);
        compare(s, capsule<T>{{p, q}, radius}, hull_truth({p, q}, radius), of[4]);
        const std::vector<vec3<T>> points{p, q, r, o};
        compare(s, hull<T>(points.data(), 4), hull_truth(points), of[5]);
        const auto box = test::random_oriented_box<T>(random, 841, i, on_lattice);
        compare(s, box, hull_truth(test::corners_of(box)), of[6]);
        compare(
            s, cylinder<T>{{p, q}, radius}, [&](double distance) { return truth.near(p, q, radius, false, distance); },
            of[7]);
        compare(
            s, cone<T>{p, q, radius}, [&](double distance) { return truth.near(p, q, radius, true, distance); }, of[8]);
        const aabb<T> along = bounds(segment<T>{p, q});
        compare(s, along,
                hull_truth({p,
                            {p.x, p.y, q.z},
                            {p.x, q.y, p.z},
                            {p.x, q.y, q.z},
                            {q.x, p.y, p.z},
                            {q.x, p.y, q.z},
                            {q.x, q.y, p.z},
                            q}),
                of[6]);
    }
    for (const tally& t : of) {
        CAPTURE(&t - of, on_lattice, t.hits);
        CHECK(t.wrong == 0);
        CHECK(t.hits * 20 > t.pairs);
        CHECK(t.hits * 20 < t.pairs * 19);
    }
}

/// Two half spaces, and a half space and a plane: parallel or not, in rationals by a multiple of the first normal.
template <class T>
void check_parallel() {
    test::uniform random(843);
    tally solid, flat;
    for (int i = 0; i < 4000; ++i) {
        const auto whole = [&](int most) { return static_cast<T>(std::floor(random(-most, most + 1))); };
        half_space<T> a{{whole(2), whole(2), whole(2)}, whole(3)};
        if (a.normal == vec3<T>{0, 0, 0}) a.normal.z = 1;
        T k = whole(3);
        if (k == 0) k = 2;
        half_space<T> b{k * a.normal, whole(5)};
        if (i % 8 == 0) b.normal.x += static_cast<T>(0x1p-20);
        const exact_point m = exactly(a.normal), n = exactly(b.normal);
        const bool parallel = m.y * n.z == m.z * n.y && m.z * n.x == m.x * n.z && m.x * n.y == m.y * n.x;
        // n.x is a multiple of m.x there, and the first says m.x <= a.offset.
        const rational times = product(m, n) / product(m, m), limit = times * rational(a.offset), offset(b.offset);
        const bool truth = !parallel || times > 0 || limit <= offset;
        const bool plane_truth = !parallel || (times > 0 ? offset <= limit : offset >= limit);
        const auto add = [](tally& t, bool is, const auto& x, const auto& y) {
            ++t.pairs;
            t.hits += is;
            const bool right = intersects(x, y) == is && intersects<exact>(y, x) == is && resolve(x, y) == is;
            t.wrong += !right;
        };
        add(solid, truth, a, b);
        add(flat, plane_truth, a, plane<T>{b.normal, b.offset});
    }
    for (const tally& t : {solid, flat}) {
        CHECK(t.wrong == 0);
        CHECK(t.hits * 20 > t.pairs);
        CHECK(t.hits * 20 < t.pairs * 19);
    }
}

}  // namespace

TEST_CASE("half_space: every shape, against rationals") {
    std::printf("half spaces: seeds 841 to 843\n");
    for (const bool on_lattice : {false, true}) {
        check_family<float>(on_lattice);
        check_family<double>(on_lattice);
    }
}
TEST_CASE("half_space: planes and half spaces") {
    check_parallel<float>();
    check_parallel<double>();
}
TEST_CASE("half_space: numbers at the ends of the range") {
    const half_space<double> s{{1e300, 1e-300, 0}, 1e300};
    CHECK(intersects(s, vec3<double>{1, 0, 0}));
    CHECK_FALSE(intersects(s, vec3<double>{1, 1e-300, 0}));
    CHECK(intersects(s, sphere<double>{{2, 0, 0}, 1}));
    CHECK_FALSE(intersects(s, sphere<double>{{2, 1e-300, 0}, 1}) != intersects<exact>(s, sphere<double>{{2, 1e-300, 0}, 1}));
    CHECK(intersects(half_space<float>{{1e-45f, 0, 0}, 0}, vec3<float>{-1e-45f, 0, 0}));
    CHECK_FALSE(intersects(half_space<float>{{1e-45f, 0, 0}, 0}, vec3<float>{1e-45f, 0, 0}));
}
TEST_CASE("half_space: what is none is refused") {
    const shapes<half_space<float>> good(std::vector<half_space<float>>{{{0, 0, 1}, 0}});
    CHECK(good.size() == 1);
    CHECK_THROWS_WITH(shapes<half_space<float>>(std::vector<half_space<float>>{{{0, 0, 1}, 0}, {{0, 0, -0.0f}, 1}}),
                      "abut::shapes: half space 1: the normal has no length (0)");
    CHECK_THROWS_WITH(shapes<half_space<float>>(std::vector<half_space<float>>{{{0, 0, 1}, std::nanf("")}}),
                      Catch::Matchers::Contains("half space 0: offset is not finite"));
}
TEST_CASE("half_space: a reach drops no box that it touches, and drops some") {
    test::uniform random(844);
    std::size_t kept = 0, dropped = 0;
    for (int i = 0; i < 20000; ++i) {
        const half_space<float> s{random.point<float>(-1, 1), static_cast<float>(random(-1, 1))};
        const aabb<float> box = bounds(segment<float>{random.point<float>(-1, 1), random.point<float>(-1, 1)});
        const bool keeps = reach_of(s)(box), touch = intersects<exact>(s, box);
        if (touch && !keeps) FAIL_CHECK("dropped a box");
        (keeps ? kept : dropped) += 1;
    }
    CHECK(kept > 2000);
    CHECK(dropped > 2000);
}
