// SPDX-License-Identifier: MIT
#include <abut/predicate/as_hull.hpp>

#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/set.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/hulls.hpp"
#include "support/oriented_boxes.hpp"

// Oriented boxes against every shape that hulls have stages with. The truth of hulls of points is linear programming in
// unbounded integers, on corners that the test makes by itself; of round shapes what is decided of the hull of the same
// eight corners, whose own truth is capsule_hull.test.cpp and revolution_hull.test.cpp.

namespace {

using namespace abut;

constexpr oriented_box<float> unit{{0, 0, 0}, {1, 1, 1}};
constexpr oriented_box<double> turned{{0, 0, 0}, {5, 5, 1}, {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1}};
static_assert(intersects(unit, vec3<float>{1, 1, 1}));
static_assert(!intersects(vec3<float>{1, 1, 0x1.000002p0f}, unit));
static_assert(intersects(unit, sphere<float>{{0, 0, 3}, 2}) && !intersects<exact>(unit, sphere<float>{{0, 0, 3}, 1.999f}));
static_assert(intersects(unit, oriented_box<float>{{2, 2, 2}, {1, 1, 1}}));
static_assert(!intersects(unit, oriented_box<float>{{2, 2, 0x1.000002p1f}, {1, 1, 1}}));
static_assert(intersects(place(rigid<float>{.translation = {2, 0, 0}}, aabb<float>{{-1, -1, -1}, {1, 1, 1}}), unit));
static_assert(intersects(turned, ray<double>{{0, 9, 0}, {0, -1, 0}}) &&
              !intersects(turned, ray<double>{{0, 9, 0}, {0, 1, 0}}));
static_assert(within(unit, vec3<float>{0, 0, 3}, 2) && !within(vec3<float>{0, 0, 3}, unit, 0x1.fffffffffffffp0));
static_assert(bounds(unit).lower == vec3<float>{-1, -1, -1} && bounds(unit).upper == vec3<float>{1, 1, 1});
static_assert(decidable_pair<oriented_box<float>, hull<float>> || decidable_pair<hull<float>, oriented_box<float>>);
static_assert(!decidable_pair<oriented_box<float>, triangle<double>> &&
              !decidable_pair<triangle<double>, oriented_box<float>>);
static_assert(distance_decidable<oriented_box<double>, plane<double>> &&
              distance_decidable<capsule<float>, placed_box<float>>);

struct tally {
    std::size_t pairs = 0, hits = 0, wrong = 0;
    void add(bool truth, bool right) { ++pairs, hits += truth, wrong += !right; }
};

/// Whether all stages and both orders say the truth, where they say anything.
template <class S, class U>
bool all_stages_say(const S& s, const U& t, bool truth) {
    const auto lies = [&](verdict v) { return v == to_verdict(!truth); };
    bool right = intersects(s, t) == truth && intersects(t, s) == truth && intersects<exact>(s, t) == truth;
    if constexpr (decidable_pair<S, U>) {
        right = right && !lies(decide<filtered>(s, t)) && !lies(decide<exact>(s, t)) && resolve(s, t) == truth;
        if constexpr (requires { decide_late<filtered>(s, t); }) right = right && !lies(decide_late<filtered>(s, t));
    } else {
        right = all_stages_say(t, s, truth);
    }
    return right;
}

template <class T>
std::vector<vec3<T>> corners_of(const triangle<T>& t) {
    return {t.a, t.b, t.c};
}
template <class T>
std::vector<vec3<T>> corners_of(const segment<T>& t) {
    return {t.a, t.b};
}
template <class T>
std::vector<vec3<T>> corners_of(const vec3<T>& t) {
    return {t};
}
template <class T>
std::vector<vec3<T>> corners_of(const aabb<T>& box) {
    return test::corners_of(box);
}
template <class T>
std::vector<vec3<T>> corners_of(const oriented_box<T>& box) {
    return test::corners_of(box);
}
template <class T>
std::vector<vec3<T>> corners_of(const placed_box<T>& box) {
    return {box.corners, box.corners + 8};
}
template <class T>
std::vector<vec3<T>> corners_of(const hull<T>& h) {
    std::vector<vec3<T>> all;
    for (std::size_t i = 0; i < h.count; ++i) all.push_back(h[i]);
    return all;
}

/// Shapes to be tried with boxes: in a box of side 2, and on its lattice.
template <class T>
struct maker {
    test::uniform& random;
    bool on_lattice;

    T number(double lower, double upper) {
        const double x = random(lower, upper);
        return static_cast<T>(on_lattice ? std::floor(x * 4 + 0.5) / 4 : x);
    }
    vec3<T> point(double size = 1) { return {number(-size, size), number(-size, size), number(-size, size)}; }
    vec3<T> near(const vec3<T>& p) { return p + point(0.75); }
};

template <class T>
void check_hulls_of_points(bool on_lattice) {
    test::uniform random(on_lattice ? 811 : 812);
    maker<T> make{random, on_lattice};
    tally of[7];
    const auto compare = [&](int kind, const oriented_box<T>& box, const auto& other) {
        const bool truth = test::oracle::hulls_intersect(corners_of(box), corners_of(other));
        of[kind].add(truth, all_stages_say(box, other, truth));
    };
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const auto box = test::random_oriented_box<T>(random, 811, i, on_lattice);
        const vec3<T> p = make.point();
        // Some corners of the box itself, which it touches in nothing else.
        const vec3<T> its_corner = corners_of(box)[i % 8];
        compare(0, box, triangle<T>{i % 3 == 0 ? its_corner : p, make.near(p), make.near(p)});
        compare(1, box, segment<T>{i % 3 == 0 ? its_corner : p, make.near(p)});
        compare(2, box, i % 3 == 0 ? its_corner : p);
        compare(3, box, bounds(segment<T>{p, make.near(p)}));
        compare(4, box, test::random_oriented_box<T>(random, 812, i, on_lattice));
        test::draws d(813, 7, i);
        rigid<T> pose;
        if (on_lattice) {
            test::construction::set_quarter_turns(pose, d);
        } else {
            pose = test::make_pose<T>(d, 0.25);
        }
        compare(5, box, place(pose, bounds(segment<T>{p, make.near(p)})));
        const std::vector<vec3<T>> core{p, make.near(p), make.near(p), make.near(p), make.near(p)};
        compare(6, box, hull<T>(core.data(), core.size()));
    }
    for (const tally& t : of) {
        CAPTURE(&t - of, on_lattice, t.hits);
        CHECK(t.wrong == 0);
        CHECK(t.hits * 20 > t.pairs);
        CHECK(t.hits < t.pairs);
    }
}

/// As of the hull of the same corners.
template <class T>
void check_as_hull(bool on_lattice) {
    test::uniform random(on_lattice ? 821 : 822);
    maker<T> make{random, on_lattice};
    tally touch[6], near[6];
    const auto compare = [&](int kind, const oriented_box<T>& box, const auto& other) {
        const auto core = corners_of(box);
        const hull<T> same(core.data(), core.size());
        const bool truth = intersects<exact>(same, other);
        touch[kind].add(truth, all_stages_say(box, other, truth));
        using other_type = std::remove_cvref_t<decltype(other)>;
        if constexpr (distance_decidable<hull<T>, other_type>) {
            for (const double distance : {0.0, 0.25, 0.7}) {
                const bool comes = within<exact>(same, other, distance);
                near[kind].add(comes, within(box, other, distance) == comes && within<exact>(other, box, distance) == comes);
            }
        }
    };
    for (std::uint64_t i = 0; i < 800; ++i) {
        const auto box = test::random_oriented_box<T>(random, 821, i, on_lattice);
        const vec3<T> p = make.point();
        compare(0, box, sphere<T>{p, make.number(0, 0.5)});
        compare(1, box, capsule<T>{{p, make.near(p)}, make.number(0, 0.25)});
        compare(2, box, plane<T>{p, make.number(-1, 1)});
        const vec3<T> from = make.point(2);
        compare(3, box, ray<T>{from, i % 3 == 0 ? make.point() : (i % 3 == 1 ? corners_of(box)[i % 8] : box.center) - from});
        compare(4, box, cylinder<T>{{p, make.near(p)}, make.number(0, 0.25)});
        compare(5, box, cone<T>{p, make.near(p), make.number(0, 0.75)});
    }
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i, on_lattice, touch[i].hits, near[i].hits, near[i].pairs);
        CHECK(touch[i].wrong == 0);
        CHECK(touch[i].hits * 20 > touch[i].pairs);
        CHECK(touch[i].hits < touch[i].pairs);
        CHECK(near[i].wrong == 0);
        CHECK((near[i].pairs == 0 || near[i].hits * 20 > near[i].pairs));
    }
}

}  // namespace

TEST_CASE("oriented_box: against hulls of points, by linear programming") {
    std::printf("oriented boxes: seeds 811 to 822\n");
    for (const bool on_lattice : {false, true}) {
        check_hulls_of_points<float>(on_lattice);
        check_hulls_of_points<double>(on_lattice);
    }
}
TEST_CASE("oriented_box: against round shapes, planes and rays, as the hull of its corners") {
    for (const bool on_lattice : {false, true}) {
        check_as_hull<float>(on_lattice);
        check_as_hull<double>(on_lattice);
    }
}

TEST_CASE("oriented_box: far apart exponents, and sizes at the ends of the range") {
    const oriented_box<double> vast{{0, 0, 0}, {1e300, 1e300, 1e300}}, tiny{{1e300, 0, 0}, {1e-300, 1e-300, 1e-300}};
    CHECK(intersects(vast, tiny));
    CHECK(intersects(vast, sphere<double>{{0, 0, 1.5e300}, 0.5e300}));
    CHECK_FALSE(intersects<exact>(vast, sphere<double>{{0, 0, 1.5e300}, 0.4999999e300}));
    const oriented_box<float> least{{0, 0, 0}, {1e-45f, 1e-45f, 1e-45f}};
    CHECK(intersects(least, vec3<float>{1e-45f, 0, -1e-45f}));
    CHECK_FALSE(intersects(least, vec3<float>{3e-45f, 0, 0}));
}

TEST_CASE("oriented_box: a box under a pose is the hull of placed corners, and twice placed ones compose") {
    test::uniform random(831);
    for (std::uint64_t i = 0; i < 40; ++i) {
        test::draws d(831, 5, i);
        const rigid<float> pose = test::make_pose<float>(d, 10);
        const aabb<float> box = bounds(segment<float>{random.point<float>(-9, 9), random.point<float>(-9, 9)});
        const placed_box<float> there = place(pose, box);
        const auto corners = corners_of(box);
        for (int k = 0; k < 8; ++k) CHECK(there.corners[k] == place(pose, corners[static_cast<std::size_t>(k)]));
        CHECK(bounds(place(rigid<float>{}, box)).lower == box.lower);
        const oriented_box<float> other = test::random_oriented_box<float>(random, 832, i, false);
        for (int k = 0; k < 8; ++k) {
            CHECK(place(pose, other).corners[k] == place(pose, corners_of(other)[static_cast<std::size_t>(k)]));
            CHECK(place(pose, there).corners[k] == place(pose, there.corners[k]));
        }
    }
}

TEST_CASE("oriented_box: what is none is refused, with its number") {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    const auto refused = [](const oriented_box<float>& box) -> std::string {
        const oriented_box<float> good{{0, 0, 0}, {1, 1, 0}};
        try {
            (void)oriented_boxes<float>({good, box});
        } catch (const invalid_geometry& e) {
            CHECK(e.index() == 1);
            return e.what();
        }
        return "accepted";
    };
    CHECK(refused({{0, infinite, 0}, {1, 1, 1}}) == "abut::oriented_boxes: oriented box 1: center y is not finite (inf)");
    CHECK(refused({{0, 0, 0}, {1, 1, infinite}}) == "abut::oriented_boxes: oriented box 1: half z is not finite (inf)");
    CHECK(refused({{0, 0, 0}, {1, -2, 1}}) == "abut::oriented_boxes: oriented box 1: a half length is negative (-2)");
    CHECK(refused({{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0, 2, 0, 0, 0, 1}}) ==
          "abut::oriented_boxes: oriented box 1: rotation: squared length of a row differs from 1 by more than 2^-10 (3)");
    CHECK(refused({{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0, 1, 0, 0.25f, 0, 1}}) ==
          "abut::oriented_boxes: oriented box 1: rotation: squared length of a row differs from 1 by more than 2^-10 "
          "(0.0625)");
    CHECK(refused({{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0, 1, 0, 0, 0, -1}}) ==
          "abut::oriented_boxes: oriented box 1: rotation: it reflects: its determinant is negative (-1)");
    CHECK(refused({{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0, std::nanf(""), 0, 0, 0, 1}}).find("rotation") != std::string::npos);
    CHECK(refused({{3e38f, 0, 0}, {1e38f, 1, 1}}) == "abut::oriented_boxes: oriented box 1: corner x is not finite (inf)");
    CHECK(refused({{3e38f, 0, 0}, {1e37f, 1, 1}}) == "accepted");
    const std::vector<float> numbers{0, 0, 0, 1, 2, 3, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    CHECK(oriented_boxes<float>(numbers).view()[0] == oriented_box<float>{{0, 0, 0}, {1, 2, 3}});
}
