// SPDX-License-Identifier: MIT
#include <abut/narrow/sweep_time.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include <abut/shape/bounds.hpp>

#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/sweep_oracle.hpp"
#include "support/sweep_shapes.hpp"

using namespace abut;

namespace {

using test::sweep_oracle;
using test::sweep_points;
using test::sweep_shape_maker;

template <scalar T>
vec3<T> widest(const aabb<T>& box) {
    return detail::greatest(detail::absolute(box.lower), detail::absolute(box.upper));
}

template <class S>
auto some_point(const S& s) {
    const auto core = detail::core_points_of(s);
    return core.as_hull()[core.as_hull().count / 2];
}

struct sweep_tally {
    std::size_t wrong = 0, other = 0, never = 0, at_start = 0, later = 0, far = 0, bad_normal = 0;
    std::size_t plainly_wrong = 0, plainly_passed = 0, plainly_met = 0;
};

/// Whether what a few directions tell holds the time, until the end and until another one.
template <class S, class U>
void check_plain_bounds(const swept<S>& s, const U& t, double time, double until, sweep_tally& tally) {
    if constexpr (requires { detail::plain_sweep_bounds(s, t, until); }) {
        for (const double end : {1.0, until}) {
            const detail::time_bounds plainly = detail::plain_sweep_bounds(s, t, end);
            const bool passes = plainly.first < 0, meets = !passes && plainly.last <= 1;
            tally.plainly_wrong += passes ? time >= 0 && time <= end : time >= 0 && !(plainly.first <= time && time <= plainly.last);
            tally.plainly_wrong += meets && time < 0;
            tally.plainly_passed += passes ? 1 : 0;
            tally.plainly_met += meets ? 1 : 0;
        }
    }
}

template <class S, class U>
void check_sweep_times(std::uint64_t count, std::uint64_t seed, sweep_tally& tally) {
    using T = scalar_type_of<S>;
    for (std::uint64_t i = 0; i < count; ++i) {
        test::uniform random((test::sample_seed + seed) * 1000003 + i);
        sweep_points<T> points{random, static_cast<int>(i % 5)};
        std::vector<vec3<T>> room_s, room_t;
        const S s = sweep_shape_maker<S>::make(points, room_s);
        const U t = sweep_shape_maker<U>::make(points, room_t);
        // Most go to where the other one is, and some of these farther.
        const vec3<T> to = i % 3 == 0 ? points.way() : some_point(t) - some_point(s);
        const vec3<T> way = i % 4 == 1 ? T(1.5) * to : to;
        const swept<S> moving{s, way};
        const double time = detail::sweep_time<filtered>(moving, t);
        tally.other += time != detail::sweep_time<exact>(moving, t);
        tally.wrong += !sweep_oracle(s, t, way).is_first(time);
        ++(time < 0 ? tally.never : time == 0 ? tally.at_start : tally.later);
        const auto between = detail::sweep_bounds<filtered>(moving, t, 1);
        const bool holds = time < 0 ? between.first < 0 : between.first <= time && time <= between.last;
        tally.other += !holds;
        check_plain_bounds(moving, t, time, random(), tally);
        tally.other += intersects(moving, t) != (time >= 0) || intersects<exact>(moving, t) != (time >= 0);
        if (time < 0) continue;
        // The point is on the shape that is met, and the mover has come to it.
        const sweep_hit<T> hit = sweep(s, t, way);
        const double unit = static_cast<double>(std::numeric_limits<T>::epsilon());
        const auto size = static_cast<double>(detail::magnitudes(widest(merge(bounds(t), bounds(moving)))));
        const vec3<double> normal = detail::widened(hit.normal);
        const double length = std::hypot(normal.x, normal.y, normal.z);
        tally.bad_normal += length != 0 && !(std::abs(length - 1) < 8 * unit);
        const test::rational near(64 * std::max(unit, 0x1p-44) * size);
        tally.far += !test::is_near(hit.point, t, near) || !test::is_near(hit.point - hit.t * way, s, near);
    }
}

template <template <class> class S, template <class> class U, scalar T>
void check_pair_of_kinds(std::uint64_t count, std::uint64_t seed) {
    sweep_tally tally;
    check_sweep_times<S<T>, U<T>>(count, seed, tally);
    CAPTURE(seed, tally.never, tally.at_start, tally.later, tally.plainly_passed, tally.plainly_met);
    CHECK(tally.wrong == 0);
    CHECK(tally.other == 0);
    CHECK(tally.plainly_wrong == 0);
    if constexpr (detail::has_radius<S<T>> && std::same_as<U<T>, triangle<T>>) {
        CHECK(test::is_share_above(0.1, tally.plainly_passed, 2 * count));
        CHECK(test::is_share_above(0.1, tally.plainly_met, 2 * count));
    }
    CHECK(tally.far * 200 <= count);  // no bound is promised: features may be needles
    CHECK(tally.bad_normal == 0);
    CHECK(test::is_share_above(0.15, tally.later, count));
    CHECK(test::is_share_above(0.02, tally.at_start, count));
    CHECK(test::is_share_above(0.02, tally.never, count));
}

}  // namespace

TEMPLATE_TEST_CASE("sweep_time: of all kinds against rationals", "", float, double) {
    using T = TestType;
    const std::uint64_t many = test::some_samples(100), some = test::some_samples(300);
    check_pair_of_kinds<vec3, triangle, T>(many, 1);
    check_pair_of_kinds<segment, triangle, T>(many, 2);
    check_pair_of_kinds<sphere, triangle, T>(many, 3);
    check_pair_of_kinds<capsule, triangle, T>(many, 4);
    check_pair_of_kinds<triangle, triangle, T>(some, 5);
    check_pair_of_kinds<aabb, triangle, T>(some, 6);
    check_pair_of_kinds<oriented_box, triangle, T>(some, 7);
    check_pair_of_kinds<hull, triangle, T>(some, 8);
    check_pair_of_kinds<sphere, sphere, T>(many, 9);
    check_pair_of_kinds<capsule, capsule, T>(many, 10);
    check_pair_of_kinds<segment, segment, T>(many, 11);
    check_pair_of_kinds<sphere, aabb, T>(some, 12);
    check_pair_of_kinds<triangle, oriented_box, T>(some, 13);
    check_pair_of_kinds<capsule, hull, T>(some, 14);
    check_pair_of_kinds<oriented_box, hull, T>(test::some_samples(1000), 15);
}

// The search stops a little before the touch, and what is nearest there need not be what is touched: past the ends of an edge, or
// the edges of a face.
TEST_CASE("sweep_time: what passes the rim of a feature by little") {
    std::size_t wrong = 0, touched = 0;
    constexpr std::size_t count = 300;
    const segment<double> edge{{0, 0, 0}, {1, 0, 0}};
    const triangle<double> face{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < count; ++i) {
        test::uniform random(7000 + i);
        const double slope = random(0.05, 1), radius = i % 3 == 0 ? 0 : std::ldexp(random(0.5, 1), -20);
        const vec3<double> at{1 + random(-6e-5, 6e-5), random(-2e-6, 2e-6), i % 2 == 0 ? 0 : random(-2e-4, 2e-4)};
        const vec3<double> back{-3, 3 * slope, 0};
        const sphere<double> ball{at + back, radius};
        const vec3<double> way{3.01, -3.01 * slope, 0};
        const double to_edge = detail::sweep_time<filtered>(swept<sphere<double>>{ball, way}, edge);
        wrong += !sweep_oracle(ball, edge, way).is_first(to_edge);
        const double to_face = detail::sweep_time<filtered>(swept<sphere<double>>{ball, way}, face);
        wrong += !sweep_oracle(ball, face, way).is_first(to_face);
        touched += to_edge >= 0;
        touched += to_face >= 0;
    }
    CHECK(wrong == 0);
    CHECK(touched > count / 4);
    CHECK(touched < 2 * count);
}

TEST_CASE("sweep_time: numbers of all exponents, and times that are tiny") {
    std::size_t wrong = 0, touched = 0;
    test::uniform random(5);
    for (int i = 0; i < 60; ++i) {
        const double far = std::ldexp(1.0, static_cast<int>(random.below(1800)) - 900), near = std::ldexp(far, -static_cast<int>(random.below(100)));
        const sphere<double> ball{{0, 0, far}, near};
        const triangle<double> flat{{-far, -far, 0}, {far, -far, 0}, {0, far, near}};
        const vec3<double> way{0, near, -far * (i % 2 == 0 ? 1 : 0x1p60)};
        const double time = detail::sweep_time<filtered>(swept<sphere<double>>{ball, way}, flat);
        wrong += !sweep_oracle(ball, flat, way).is_first(time);
        touched += time >= 0;
    }
    CHECK(wrong == 0);
    CHECK(touched > 30);
}

TEST_CASE("sweep: of one pair, also in constant expressions") {
    constexpr triangle<float> floor{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    constexpr auto hit = sweep(sphere<float>{{0, 0, 5}, 1}, floor, vec3<float>{0, 0, -8});
    static_assert(hit.id == 0 && hit.t == 0.5f && hit.normal == vec3<float>{0, 0, 1} && hit.point == vec3<float>{0, 0, 0});
    static_assert(sweep(sphere<float>{{0, 0, 5}, 1}, floor, vec3<float>{0, 0, 8}).id == no_id);
    static_assert(intersects(moving(sphere<float>{{0, 0, 5}, 1}, vec3<float>{0, 0, -4}), floor));
    static_assert(!intersects(moving(sphere<float>{{0, 0, 5}, 1}, vec3<float>{0, 0, -3.9999998f}), floor));
    // Tangent at the start, and then away.
    static_assert(sweep(sphere<float>{{0, 0, 1}, 1}, floor, vec3<float>{0, 0, 8}).t == 0);
    // Overlapping cores have no normal.
    static_assert(sweep(segment<float>{{0, 0, 1}, {0, 0, -1}}, floor, vec3<float>{0, 0, 8}).normal == vec3<float>{0, 0, 0});
    // A box that lands on its side, as doubles are rounded: 0.3 is not 3/10.
    const auto landing = sweep(aabb<double>{{-1, -1, 1}, {1, 1, 2}}, triangle<double>{{-9, -9, 0.3}, {9, -9, 0.3}, {0, 9, 0.3}}, vec3<double>{0, 0, -1});
    CHECK(landing.t == 1 - 0.3);
    CHECK(landing.normal == vec3<double>{0, 0, 1});
    CHECK(sweep<fast>(sphere<float>{{0, 0, 5}, 1}, floor, vec3<float>{0, 0, -8}).t == 0.5f);
}
