// SPDX-License-Identifier: MIT
#include <abut/narrow/turning_time.hpp>

// When two shapes of bodies that turn come together, against a dense subdivision of time in long double that shares no
// formula (support/turning_oracle.hpp): nothing touches before the time that is told, the shapes are within the tolerance
// then, and what is told to be free is. Drawn are small and large turns, turns by more than a half, ones in place, starts in
// contact, needles, ways that pass each other as near as the tolerance, bodies far from the axis and far from the origin,
// rotations that are off from orthonormal, each side in motion or at rest.

#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/turning_oracle.hpp"

using namespace abut;
using namespace abut::test;

namespace {

constexpr const char* turning_families[] = {
    "small turns",       "large turns",         "in place",       "starts in contact", "needles", "grazing",
    "far from the axis", "far from the origin", "the longer way", "no turn",           "bent"};
constexpr int turning_family_count = 11;

template <class T>
vec3<T> drawn_point(draws& d, double half) {
    const T x = static_cast<T>(d.uniform(-half, half)), y = static_cast<T>(d.uniform(-half, half));
    return {x, y, static_cast<T>(d.uniform(-half, half))};
}

/// Points of a shape of one of six kinds; and f(shape, as the oracle sees it).
template <class T, class F>
auto with_turning_shape(int kind, draws& d, double thin, const vec3<T>& at, const F& f) {
    vec3<T> p[4];
    for (vec3<T>& x : p) {
        x = drawn_point<T>(d, 1);
        x.y = static_cast<T>(x.y * static_cast<T>(thin));
        x = x + at;
    }
    const auto seen = [&](std::size_t n, std::vector<std::array<std::size_t, 3>> faces, double radius,
                          bool is_solid = false) {
        long_shape s{{}, std::move(faces), radius, is_solid};
        for (std::size_t i = 0; i < n; ++i) s.points.push_back(as_long(p[i]));
        return s;
    };
    const T radius = static_cast<T>(d.uniform(0.05, 0.5));
    switch (kind) {
        case 0:
            return f(p[0], seen(1, {{0, 0, 0}}, 0));
        case 1:
            return f(segment<T>{p[0], p[1]}, seen(2, {{0, 1, 1}}, 0));
        case 2:
            return f(sphere<T>{p[0], radius}, seen(1, {{0, 0, 0}}, static_cast<double>(radius)));
        case 3:
            return f(capsule<T>{{p[0], p[1]}, radius}, seen(2, {{0, 1, 1}}, static_cast<double>(radius)));
        case 4:
            return f(hull<T>(p, 4), seen(4, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}, 0, true));
        default:
            return f(triangle<T>{p[0], p[1], p[2]}, seen(3, {{0, 1, 2}}, 0));
    }
}

/// Puts a triangle at one height.
template <class S>
void flatten(S& s, long_shape& seen, int height) {
    if constexpr (std::same_as<S, triangle<scalar_type_of<S>>>) {
        s.a.z = s.b.z = s.c.z = static_cast<scalar_type_of<S>>(height);
        for (auto& p : seen.points) p[2] = height;
    }
}

/// A rotation by an angle about an axis, times another one, rounded to T.
template <class T>
void set_turn(rigid<T>& pose, const vec3<double>& axis, double angle, const long double (&q)[4]) {
    const long double half = static_cast<long double>(angle) / 2, n = long_norm(as_long(axis)), s = std::sin(half) / n,
                      w = std::cos(half), x = s * axis.x, y = s * axis.y, z = s * axis.z;
    construction::set_rotation(pose, w * q[0] - x * q[1] - y * q[2] - z * q[3], w * q[1] + x * q[0] + y * q[3] - z * q[2],
                               w * q[2] - x * q[3] + y * q[0] + z * q[1], w * q[3] + x * q[2] - y * q[1] + z * q[0]);
}

template <class T>
struct drawn_motion {
    rigid<T> from, to;
    turning<T> about;
};
template <class T>
drawn_motion<T> draw_motion(int family, draws& d, bool rests, const vec3<T>& towards) {
    drawn_motion<T> m;
    long double q[4];
    for (long double& x : q) x = d.uniform(-1, 1);
    const long double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (long double& x : q) x /= length;
    construction::set_rotation(m.from, q[0], q[1], q[2], q[3]);
    const vec3<double> axis = drawn_point<double>(d, 1);
    const double angle = family == 9                  ? 0
                         : family == 0 || family == 6 ? d.uniform(0, 0.2)
                         : family == 8                ? d.uniform(3.3, 6.2)
                                                      : d.uniform(0.2, 3.1);
    set_turn(m.to, axis, angle, q);
    m.from.translation = drawn_point<T>(d, 0.7);
    m.to.translation = family == 2 ? m.from.translation : towards + drawn_point<T>(d, 0.7);
    if (family == 8) m.about.axis = {static_cast<T>(axis.x), static_cast<T>(axis.y), static_cast<T>(axis.z)};
    if (d.below(2) == 0) m.about.centre = drawn_point<T>(d, 1);
    if (family == 10) {  // as far from orthonormal as that
        for (T& x : m.to.rotation) x = static_cast<T>(x + static_cast<T>(d.uniform(-0x1p-13, 0x1p-13)));
    }
    if (rests) m.to = m.from, m.about.axis = {0, 0, 0};
    return m;
}

struct turning_tally {
    std::uint64_t met = 0, free = 0, late = 0, early = 0, not_free = 0;
    turning_tally& operator+=(const turning_tally& o) {
        met += o.met, free += o.free, late += o.late, early += o.early, not_free += o.not_free;
        return *this;
    }
};

template <class T>
void check_one_turning(int family, std::uint64_t i, turning_tally& tally) {
    draws d(sample_seed, static_cast<std::uint64_t>(family) + (std::same_as<T, float> ? 100 : 0), i);
    const double far = family == 6 ? 50 : 0, thin = family == 4 ? 1e-5 : 1, tolerance = (family == 5 ? d.power_of_ten(-2, -1) : d.power_of_ten(-7, -2));
    const vec3<T> at{static_cast<T>(far), 0, 0}, away{static_cast<T>(family == 7 ? 4096 : 0), 0, 0};
    const vec3<T> apart{static_cast<T>(family == 3 ? 0 : family == 2 ? 1 : 2), 0, 0};
    drawn_motion<T> a = draw_motion<T>(family, d, false, apart),
                    b = draw_motion<T>(family, d, d.below(2) == 0, vec3<T>{0, 0, 0} - apart);
    if (family == 6) {  // so that it comes to where the others are
        a.about.centre = {0, 0, 0};
        for (rigid<T>* pose : {&a.from, &a.to})
            pose->translation = pose->translation - (place(*pose, at) - pose->translation);
    }
    for (vec3<T>* p : {&b.from.translation, &b.to.translation}) *p = *p + apart;
    if (family == 5) {
        // a goes past b, which rests, at about the tolerance.
        b = drawn_motion<T>{};
        const T height = static_cast<T>(1 + tolerance * d.uniform(0.2, 2));
        a.from = a.to = rigid<T>{};
        a.from.translation = {-2, 0, height}, a.to.translation = {2, 0, height};
        set_turn(a.to, {0, 0, 1}, d.uniform(-3, 3), {1, 0, 0, 0});
        a.about = {};
    }
    for (drawn_motion<T>* m : {&a, &b})
        m->from.translation = m->from.translation + away, m->to.translation = m->to.translation + away;
    const int kind_a = family == 5 ? 5 : d.below(6), kind_b = family == 5 ? 5 : d.below(6);
    with_turning_shape<T>(kind_a, d, thin, at, [&](auto s, long_shape seen_s) {
        with_turning_shape<T>(kind_b, d, thin, {0, 0, 0}, [&](auto t, long_shape seen_t) {
            if (family == 5) flatten(s, seen_s, 0), flatten(t, seen_t, 1);
            const detail::rigid_motion ma = detail::make_rigid_motion(a.from, a.to, a.about, "test"),
                                       mb = detail::make_rigid_motion(b.from, b.to, b.about, "test");
            const detail::turning_pair both{ma, mb};
            const double of_a = detail::turning_bounds::radius(ma, bounds(s)),
                         of_b = detail::turning_bounds::radius(mb, bounds(t)),
                         asked = std::max(tolerance, 8 * detail::turning_bounds(both, of_a, of_b).margin);
            const auto told = detail::turning_time_of(s, t, both, asked);
            long_pair truth{seen_s, seen_t, {a.from, a.to, a.about}, {b.from, b.to, b.about}};
            if (family == 10) truth.a.turn_about(as_long(ma.axis), ma.angle), truth.b.turn_about(as_long(mb.axis), mb.angle);
            // Of floats the two axes differ by as much as rotations are off.
            const long double slack = std::same_as<T, float> ? 2e-6L * (1 + far) : 1e-11L * (1 + far) + 0x1p-40L * away.x;
            if (told.time <= 1) {
                ++tally.met;
                if (!(truth.distance(told.time) <= asked + slack)) ++tally.early;
                // Nothing touches before; near the end that is true of what is told of the way without slack.
                const long double before = told.time - 2 * slack / std::max(truth.speed(), 0x1p-20L) - 0x1p-40L;
                if (told.time > 0 && !truth.is_free(before)) {
                    // Of slow approaches it is the distance, and not the time, that is known to the slack.
                    if (std::same_as<T, double> || truth.distance(before) > 8 * slack || !truth.is_free(before - 0.001L))
                        ++tally.late;
                }
            } else {
                ++tally.free;
                if (!truth.is_free(1)) ++tally.not_free;
            }
        });
    });
}

template <class T>
void check_turning_family(int family, std::uint64_t n) {
    CAPTURE(turning_families[family]);
    const turning_tally tally =
        in_threads<turning_tally>(n, [&](std::uint64_t first, std::uint64_t last, turning_tally& mine) {
            for (std::uint64_t i = first; i < last; ++i) check_one_turning<T>(family, i, mine);
        });
    CAPTURE(tally.met, tally.free);
    CHECK(tally.late == 0);
    CHECK(tally.early == 0);
    CHECK(tally.not_free == 0);
    CHECK(is_share_above(0.1, tally.met, n));
    if (family != 3) CHECK(is_share_above(0.1, tally.free, n));
}

}  // namespace

TEMPLATE_TEST_CASE("turning_time: never late, and early by the tolerance at most", "", float, double) {
    for (int family = 0; family < turning_family_count; ++family) check_turning_family<TestType>(family, some_samples(100));
}
