// SPDX-License-Identifier: MIT
#include <abut/narrow/solid_angle.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "support/catch.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/seen_triangle.hpp"

using namespace abut;

namespace {

struct share_tally {
    std::size_t wrong = 0, near_edges = 0, total = 0;
    double worst = 0;

    share_tally& operator+=(const share_tally& other) {
        wrong += other.wrong;
        near_edges += other.near_edges;
        total += other.total;
        worst = std::max(worst, other.worst);
        return *this;
    }

    template <class T>
    void look(const triangle<T>& t, const vec3<T>& p) {
        const test::seen_triangle truth(t, p);
        const double found = detail::solid_angle_share(t, p);
        const double off = std::abs(static_cast<double>(truth.share - found));
        ++total;
        near_edges += !truth.is_off_edges;
        if (truth.is_off_edges) {
            worst = std::max(worst, off);
            wrong += !(off < std::ldexp(1.0, -45));
        } else {
            wrong +=
                !(off < std::ldexp(1.0, -45) || (std::abs(found) <= 0.5 && found * static_cast<double>(truth.share) >= 0));
        }
    }
};

struct share_tallies {
    share_tally far, close, at_edge, scaled;

    share_tallies& operator+=(const share_tallies& other) {
        far += other.far;
        close += other.close;
        at_edge += other.at_edge;
        scaled += other.scaled;
        return *this;
    }
};

template <class T>
void look_at_many(std::uint64_t begin, std::uint64_t end, share_tallies& sum) {
    constexpr int largest = std::numeric_limits<T>::max_exponent - 1, least = std::numeric_limits<T>::min_exponent - 20;
    for (std::uint64_t i = begin; i < end; ++i) {
        test::uniform random(462'000'000 + i);
        const auto triangles = test::random_triangles<T>(1, random);
        const triangle<T> t = triangles[0];
        sum.far.look(t, random.point<T>(-2, 2));
        // Above a place of the triangle, or of its rim, by less and less. Needles are some of them.
        const triangle<T> needle{t.a, t.b,
                                 t.a + static_cast<T>(random()) * (t.b - t.a) + static_cast<T>(1e-4) * (t.c - t.a)};
        const int down = -static_cast<int>(random.below(40));
        for (const triangle<T>& s : {t, needle}) {
            const vec3<double> a = detail::widened(s.a), ab = detail::widened(s.b) - a, ac = detail::widened(s.c) - a;
            const double along = random(), across = random() * (1 - along);
            const auto above = [&](double u, double v) {
                const vec3<double> n = random.point<double>(-1, 1), q = a + u * ab + v * ac + std::ldexp(1.0, down) * n;
                return vec3<T>{static_cast<T>(q.x), static_cast<T>(q.y), static_cast<T>(q.z)};
            };
            sum.close.look(s, above(along, across));
            sum.at_edge.look(s, above(along, 0));
            sum.at_edge.look(s, above(0, 0));
        }
        // Coordinates of many magnitudes, as many as the digits of the oracle are good for, and both ends of the range.
        constexpr int spread = 240;
        const int lowest = least + static_cast<int>(random() * (largest - least - spread));
        const auto many = [&] {
            const auto x = [&] {
                return std::ldexp(static_cast<T>(random(-1, 1)), lowest + static_cast<int>(random() * spread));
            };
            const T x0 = x(), x1 = x();
            return vec3<T>{x0, x1, x()};
        };
        const vec3<T> first = many(), second = many(), third = many();
        sum.scaled.look({first, second, third}, many());
        for (const int e : {largest - 1, least}) {
            const auto at_scale = [&](const vec3<T>& v) {
                return vec3<T>{std::ldexp(v.x / 4, e), std::ldexp(v.y / 4, e), std::ldexp(v.z / 4, e)};
            };
            sum.scaled.look({at_scale(t.a), at_scale(t.b), at_scale(t.c)}, at_scale(random.point<T>(-1, 1)));
        }
    }
}

}  // namespace

TEST_CASE("solid angle: angles in turns") {
    test::uniform random(461);
    const test::angle_number turn = 2 * boost::math::constants::pi<test::angle_number>();
    double worst = 0;
    const auto look = [&](double y, double x) {
        const test::angle_number truth = atan2(test::angle_number(y), test::angle_number(x)) / turn;
        worst = std::max(worst, std::abs(static_cast<double>(truth - detail::angle_in_turns(y, x))));
    };
    const int many = test::sample_count() < 100000 ? 3000 : 20000;
    for (int i = 0; i < many; ++i) {
        const double x = random(-1, 1), y = random(-1, 1);
        look(y, x);
        look(std::ldexp(y, -i % 80), x);
        look(y, std::ldexp(x, -i % 80));
        look(std::ldexp(y, i % 900), std::ldexp(x, i % 900));
        const double at_fold = x * (i % 2 == 0 ? 0.41421356237309503 : 1);  // where the polynomial ends, and x = y
        look(at_fold, x), look(std::nextafter(at_fold, 2), x), look(std::nextafter(at_fold, -2), x), look(x, at_fold);
    }
    CHECK(worst < 0x1p-53);
    CHECK(worst > 0x1p-56);
    CHECK(detail::angle_in_turns(0, 0) == 0);
    CHECK(detail::angle_in_turns(0, -3) == 0.5);
    CHECK(detail::angle_in_turns(-3, 0) == -0.25);
    CHECK(detail::angle_in_turns(2, 2) == 0.125);
}

TEMPLATE_TEST_CASE("solid angle: against angles between planes", "", float, double) {
    const auto [far, close, at_edge, scaled] =
        test::in_threads<share_tallies>(test::sample_count() / 5, look_at_many<TestType>);
    for (const share_tally& tally : {far, close, at_edge, scaled}) {
        CAPTURE(tally.worst, tally.total, tally.near_edges);
        CHECK(tally.wrong == 0);
        CHECK(tally.total > 2 * tally.near_edges);
    }
    CHECK(at_edge.near_edges > at_edge.total / 100);
}

TEMPLATE_TEST_CASE("solid angle: on a triangle, in its plane, and of none", "", float, double) {
    using T = TestType;
    const triangle<T> t{{0, 0, 0}, {0, 8, 0}, {8, 0, 0}};
    for (const vec3<T>& p : {vec3<T>{1, 1, 0}, vec3<T>{0, 4, 0}, vec3<T>{4, 4, 0}, t.a, t.b, t.c, vec3<T>{9, 9, 0}}) {
        CHECK(detail::solid_angle_share(t, p) == 0);
    }
    const T tiny = std::numeric_limits<T>::denorm_min();
    CHECK(detail::solid_angle_share(t, {1, 1, tiny}) == 0.5);  // the normal is along -z
    CHECK(detail::solid_angle_share(t, {1, 1, -tiny}) == -0.5);
    CHECK(detail::solid_angle_share(t, {0, 4, T(0x1p-60)}) == Approx(0.25));
    CHECK(detail::solid_angle_share(t, {0, 4, T(-0x1p-60)}) == Approx(-0.25));
    // A plane without a coordinate axis in it, a point in it exactly, and its neighbours.
    const triangle<T> tilted{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    const T below = std::nextafter(T(1), T(0)), above = std::nextafter(T(1), T(2));
    CHECK(detail::solid_angle_share(tilted, {1, 1, 1}) == 0);
    CHECK(detail::solid_angle_share(tilted, {1, 1, below}) == Approx(0.5).margin(1e-6));
    CHECK(detail::solid_angle_share(tilted, {1, above, 1}) == Approx(-0.5).margin(1e-6));
    // An octant.
    CHECK(detail::solid_angle_share(tilted, {0, 0, 0}) == 0.125);
    // No area: a point, segments, and corners in a row.
    const vec3<T> a{1, 2, 3}, b{3, 5, 9}, middle{2, T(3.5), 6};
    for (const triangle<T>& none : {triangle<T>{a, a, a}, {a, a, b}, {a, b, b}, {a, b, a}, {a, middle, b}, {b, a, middle}}) {
        for (const vec3<T>& p : {vec3<T>{0, 0, 0}, vec3<T>{2, 3, 6}, a, middle, vec3<T>{1, 2, 4}}) {
            CHECK(detail::solid_angle_share(none, p) == 0);
        }
    }
    // Both ends of the range.
    const T huge = std::numeric_limits<T>::max();
    CHECK(detail::solid_angle_share<T>({{huge, -huge, -huge}, {huge, huge, -huge}, {huge, huge, huge}}, {-huge, 0, 0}) ==
          Approx(std::atan(1 / (2 * std::sqrt(6.0))) / std::acos(-1.0) / 2).epsilon(1e-12));
    CHECK(detail::solid_angle_share<T>({{tiny, -tiny, -tiny}, {tiny, tiny, -tiny}, {tiny, tiny, tiny}}, {0, 0, 0}) ==
          Approx(1.0 / 12));
}
