// SPDX-License-Identifier: MIT
#include <abut/narrow/sweep_time.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <abut/shape/bounds.hpp>

#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/sweep_oracle.hpp"
#include "support/sweep_shapes.hpp"

using namespace abut;

namespace {

struct flat_sweep_tally {
    std::size_t wrong = 0, other = 0, never = 0, at_start = 0, later = 0, far = 0, bad_normal = 0;
};

/// Whether a point is no farther from a plane or a half space than `near`.
template <class F, class T>
bool is_near_flat(const vec3<T>& p, const F& flat, const test::rational& near) {
    const auto at = test::to_rational(p), n = test::to_rational(flat.normal);
    const test::rational height = test::inner(n, at) - test::rational(flat.offset);
    if (detail::is_half_space<F> && height <= 0) return true;
    return height * height <= near * near * test::inner(n, n);
}

template <class F, class S>
void check_flat_sweeps(std::uint64_t count, std::uint64_t seed) {
    using T = scalar_type_of<S>;
    flat_sweep_tally tally;
    for (std::uint64_t i = 0; i < count; ++i) {
        test::uniform random((test::sample_seed + seed) * 1000003 + i);
        test::sweep_points<T> points{random, static_cast<int>(i % 5)};
        std::vector<vec3<T>> room;
        const S s = test::sweep_shape_maker<S>::make(points, room);
        // Most planes lie where a corner comes to on the way.
        const vec3<T> normal = points(), to = points.way(), way = i % 4 == 1 ? T(2.5) * to : to;
        const auto core = detail::core_points_of(s);
        const vec3<T> corner = core.as_hull()[random.below(core.as_hull().count)], stop = corner + T(0.25) * static_cast<T>(random.below(5)) * way,
                      through = i % 4 == 0 ? points() : stop + (i % 4 == 2 ? T(0.5) * points() : vec3<T>{0, 0, 0});
        const T offset = detail::rounded(normal.x * through.x + normal.y * through.y + normal.z * through.z);
        if (detail::is_half_space<F> && dot(normal, normal) == 0) continue;
        const F flat{normal, offset};
        const swept<S> moving{s, way};
        const test::flat_oracle truth(s, way, normal, offset, detail::is_half_space<F>);
        const double time = detail::sweep_time<filtered>(moving, flat);
        tally.wrong += !truth.is_first(time);
        tally.other += time != detail::sweep_time<exact>(moving, flat);
        ++(time < 0 ? tally.never : time == 0 ? tally.at_start : tally.later);
        const auto between = detail::sweep_bounds<filtered>(moving, flat, 1);
        tally.other += !(time < 0 ? between.first < 0 : between.first <= time && time <= between.last);
        tally.other += intersects(moving, flat) != (time >= 0) || intersects<exact>(moving, flat) != (time >= 0);
        tally.other += (detail::sweep_time<filtered>(swept<S>{s, {0, 0, 0}}, flat) == 0) != intersects(s, flat);
        // What goes the other way round.
        const swept<F> back{flat, -T(1) * way};
        tally.other += time != detail::sweep_time<filtered>(back, s) || intersects(back, s) != (time >= 0);
        if (time < 0 || dot(normal, normal) == 0) continue;
        const double unit = std::max(static_cast<double>(std::numeric_limits<T>::epsilon()), 0x1p-44);
        const auto corners = bounds(moving);
        const auto most = detail::greatest(detail::absolute(corners.lower), detail::absolute(corners.upper));
        const double length = std::sqrt(static_cast<double>(dot(normal, normal)));
        const test::rational near(64 * unit * (static_cast<double>(detail::magnitudes(most)) + std::abs(static_cast<double>(offset)) / length));
        const auto hit = sweep(s, flat, way);
        const auto reversed = sweep(flat, s, -T(1) * way);
        tally.far += !is_near_flat(hit.point, flat, near) || !test::is_near(hit.point - hit.t * way, s, near);
        tally.far += !test::is_near(reversed.point, s, near) || !is_near_flat(reversed.point + hit.t * way, flat, near);
        const double square = static_cast<double>(dot(hit.normal, hit.normal));
        tally.bad_normal += square != 0 && !(std::abs(square - 1) < 16 * unit);
        tally.bad_normal += hit.t > 0 && !(static_cast<double>(dot(hit.normal, way)) < unit * static_cast<double>(detail::magnitudes(way)));
        tally.bad_normal += !(reversed.normal == -T(1) * hit.normal);
    }
    CAPTURE(seed, tally.never, tally.at_start, tally.later);
    CHECK(tally.wrong == 0);
    CHECK(tally.other == 0);
    CHECK(tally.far * 200 <= count);
    CHECK(tally.bad_normal == 0);
    CHECK(test::is_share_above(0.1, tally.later, count));
    CHECK(test::is_share_above(0.02, tally.at_start, count));
    CHECK(test::is_share_above(0.02, tally.never, count));
}

template <class F>
void check_flat_kinds(std::uint64_t seed) {
    using T = scalar_type_of<F>;
    const std::uint64_t many = test::some_samples(50);
    check_flat_sweeps<F, vec3<T>>(many, seed);
    check_flat_sweeps<F, segment<T>>(many, seed + 1);
    check_flat_sweeps<F, triangle<T>>(many, seed + 2);
    check_flat_sweeps<F, sphere<T>>(many, seed + 3);
    check_flat_sweeps<F, capsule<T>>(many, seed + 4);
    check_flat_sweeps<F, aabb<T>>(many, seed + 5);
    check_flat_sweeps<F, oriented_box<T>>(many, seed + 6);
    check_flat_sweeps<F, hull<T>>(many, seed + 7);
}

}  // namespace

TEMPLATE_TEST_CASE("sweep_time: of planes and half spaces against rationals", "", float, double) {
    check_flat_kinds<plane<TestType>>(1);
    check_flat_kinds<half_space<TestType>>(11);
}

TEST_CASE("sweep_time: of planes with numbers of all exponents, and times that are tiny") {
    std::size_t wrong = 0, touched = 0;
    test::uniform random(5);
    for (int i = 0; i < 100; ++i) {
        const auto any = [&](std::uint64_t most) {
            return std::ldexp(random(0.5, 1), static_cast<int>(random.below(most)) - static_cast<int>(most) / 2);
        };
        const double far = any(i % 4 == 0 ? 2000 : 200), radius = i % 2 == 0 ? 0 : std::ldexp(far, -static_cast<int>(random.below(100)));
        const vec3<double> normal{0, i % 3 == 0 ? any(100) : 0, any(i % 4 == 0 ? 1000 : 100)};
        const sphere<double> ball{{0, 0, far}, radius};
        const vec3<double> way{0, far / 3, -std::ldexp(far, static_cast<int>(random.below(60)))};
        const double offset = i % 5 == 0 ? 0 : std::min(far * normal.z * 0.5, 1e300);
        const double time = detail::sweep_time<filtered>(swept<sphere<double>>{ball, way}, plane<double>{normal, offset});
        wrong += !test::flat_oracle(ball, way, normal, offset, false).is_first(time);
        touched += time >= 0;
    }
    CHECK(wrong == 0);
    CHECK(touched > 25);
}

TEST_CASE("sweep: of one pair with a plane, also in constant expressions") {
    constexpr sphere<float> ball{{0, 0, 5}, 1};
    constexpr half_space<float> floor{{0, 0, 2}, 0};
    constexpr auto hit = sweep(ball, floor, vec3<float>{0, 0, -8});
    static_assert(hit.id == 0 && hit.t == 0.5f && hit.normal == vec3<float>{0, 0, 1} && hit.point == vec3<float>{0, 0, 0});
    static_assert(sweep(ball, floor, vec3<float>{3, 0, 0}).id == no_id);
    static_assert(intersects(moving(ball, vec3<float>{0, 0, -4}), floor));
    static_assert(!intersects(moving(ball, vec3<float>{0, 0, -3.9999998f}), floor));
    // A wall that comes nearer; and what begins inside of a half space.
    constexpr auto met = sweep(plane<float>{{1, 0, 0}, -4}, aabb<float>{{0, 0, 0}, {1, 1, 1}}, vec3<float>{8, 0, 0});
    static_assert(met.t == 0.5f && met.normal == vec3<float>{-1, 0, 0} && met.point.x == 0);
    static_assert(sweep(vec3<float>{0, 0, -3}, floor, vec3<float>{0, 0, 8}).t == 0);
    static_assert(sweep(vec3<float>{0, 0, -3}, plane<float>{{0, 0, 2}, 0}, vec3<float>{0, 0, 8}).t == 0.375f);
    CHECK(sweep<fast>(ball, floor, vec3<float>{0, 0, -8}).t == 0.5f);
}
