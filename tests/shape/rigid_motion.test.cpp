// SPDX-License-Identifier: MIT
#include <abut/shape/rigid_motion.hpp>

// The numbers of a motion: sine and cosine within their bound, both ends where they were given, and the axis and the angle
// from which the motion was made, also near no turn, near a half one and beyond.

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"

using namespace abut;
using namespace abut::test;

TEST_CASE("rigid_motion: sine and cosine") {
    double most = 0;
    for (std::uint64_t i = 0; i < 100000; ++i) {
        draws d(sample_seed, 81, i);
        const double angle = i < 4             ? static_cast<double>(i) * 2.0943951023931953
                             : d.below(2) == 0 ? d.uniform(0, 6.2831853071795862)
                                               : d.power_of_ten(-12, 0);
        const auto [s, v] = detail::sine_and_versine_of(angle);
        const auto exact = static_cast<long double>(angle);
        most = std::max(most, static_cast<double>(std::abs(s - std::sin(exact))));
        most = std::max(most, static_cast<double>(std::abs(1 - v - std::cos(exact))));
    }
    CAPTURE(most);
    CHECK(most < 0x1p-46);
}

TEMPLATE_TEST_CASE("rigid_motion: both ends, axis and angle", "", float, double) {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        draws d(sample_seed, 82, i);
        const double angles[] = {d.uniform(0, 3.1), d.power_of_ten(-6, 0), 3.1415926 - d.power_of_ten(-4, -1),
                                 d.uniform(3.3, 6.2)};
        const double angle = angles[i % 4], x = d.uniform(-1, 1), y = d.uniform(-1, 1), z = d.uniform(-1, 1),
                     length = std::sqrt(x * x + y * y + z * z);
        rigid<TestType> from, to;
        construction::set_rotation(to, std::cos(angle / 2), x / length * std::sin(angle / 2),
                                   y / length * std::sin(angle / 2), z / length * std::sin(angle / 2));
        from.translation = {1, 2, 3}, to.translation = {-4, 0, static_cast<TestType>(d.uniform(-9, 9))};
        turning<TestType> about{{7, 8, 9}, {0, 0, 0}};
        if (angle > 3.14159) about.axis = {static_cast<TestType>(x), static_cast<TestType>(y), static_cast<TestType>(z)};
        const auto m = detail::make_rigid_motion(from, to, about, "test");
        CAPTURE(i, angle, m.angle);
        const double lost = std::is_same_v<TestType, float> ? 1e-6 : 1e-14;
        CHECK(std::abs(m.angle - angle) < lost);
        if (angle > 1e-3) CHECK((m.axis.x * x + m.axis.y * y + m.axis.z * z) / length > 1 - 1e-3 * lost / 1e-6);
        CHECK(std::abs(detail::plain_length(m.axis) - 1) < 0x1p-51);
        CHECK(m.off < lost);
        // The second rotation is orthonormal but for rounding, and so the motion ends in it.
        for (const double t : {0.0, 1.0}) {
            const auto frame = m.frame(t);
            const rigid<TestType>& pose = t == 0 ? from : to;
            const vec3<double> p{0.5, -2, 4}, at = frame.place({p.x - 7, p.y - 8, p.z - 9});
            const double placed[] = {at.x, at.y, at.z};
            for (int k = 0; k < 3; ++k) {
                const auto* const r = pose.rotation + 3 * k;
                const TestType shifts[] = {pose.translation.x, pose.translation.y, pose.translation.z};
                const long double there = r[0] * static_cast<long double>(p.x) + r[1] * static_cast<long double>(p.y) +
                                          r[2] * static_cast<long double>(p.z) + shifts[k];
                CHECK(std::abs(static_cast<double>(placed[k] - there)) < 0x1p-44 * 64);
            }
        }
    }
}

TEST_CASE("rigid_motion: a half turn") {
    const rigid<double> start, half{{-1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 0, 0}};
    CHECK_THROWS_AS(detail::make_rigid_motion(start, half, turning<double>{}, "test"), error);
    const auto left =
        detail::make_rigid_motion(start, half, turning<double>{.axis = {0, 0, 1}}, "test").frame(0.5).turned({1, 0, 0});
    const auto right =
        detail::make_rigid_motion(start, half, turning<double>{.axis = {0, 0, -1}}, "test").frame(0.5).turned({1, 0, 0});
    CHECK((std::abs(left.y - 1) < 1e-14 && std::abs(right.y + 1) < 1e-14));
    const auto still = detail::make_rigid_motion(half, half, turning<double>{}, "test");
    CHECK(still.is_still());
}
