// SPDX-License-Identifier: MIT
#include <abut/shape/reach.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"
#include "support/shape_oracles.hpp"

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

static_assert(prune_functor<detail::ball_reach<float>, float>);
static_assert(prune_functor<detail::box_reach<double>, double>);
static_assert(prune_functor<detail::swept_reach<float>, float>);
static_assert(prune_functor<detail::plane_reach<double>, double>);
static_assert(!prune_functor<aabb<float>, float>);

namespace {

template <class T>
rational squared_distance(const vec3<T>& p, const aabb<T>& box) {
    const auto axis = [](T x, T lower, T upper) -> rational {
        const rational beyond = x < lower   ? rational(lower) - rational(x)
                                : x > upper ? rational(x) - rational(upper)
                                            : rational(0);
        return beyond * beyond;
    };
    return axis(p.x, box.lower.x, box.upper.x) + axis(p.y, box.lower.y, box.upper.y) + axis(p.z, box.lower.z, box.upper.z);
}

/// Balls that just touch or just miss a box, at every scale. None that touches may be pruned; of those that are clear of the
/// box by more than the slack, all have to be.
template <class T>
void check_balls(std::size_t n) {
    test::uniform random(7);
    std::size_t touching = 0, lost = 0, kept_in_vain = 0, clear = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const int span = std::numeric_limits<T>::max_exponent / 2 + 20;  // squares overflow and underflow as well
        const T scale = std::ldexp(T(1), static_cast<int>(random(-span, span)));
        const auto point = [&] { return scale * random.point<T>(-1, 1); };
        const vec3<T> p = point(), q = point(), center = point();
        const aabb<T> box{detail::least(p, q), detail::greatest(p, q)};
        const vec3<T> away = center - detail::least(detail::greatest(center, box.lower), box.upper);
        T radius = static_cast<T>(std::hypot(static_cast<long double>(away.x), static_cast<long double>(away.y),
                                             static_cast<long double>(away.z)));
        for (int step = static_cast<int>(random.below(7)) - 3; step != 0; step += step < 0 ? 1 : -1) {
            radius = std::max(T(0), std::nextafter(radius, step < 0 ? T(0) : std::numeric_limits<T>::infinity()));
        }
        if (i % 5 == 0) radius *= T(0.99);
        const sphere<T> ball{center, radius};
        const bool touches = squared_distance(center, box) <= rational(radius) * rational(radius);
        const bool kept = detail::ball_reach<T>(ball)(box);
        touching += touches;
        lost += touches && !kept;
        const bool squares_are_normal = std::fabs(std::log2(radius)) < std::numeric_limits<T>::max_exponent / 2 - 8;
        if (i % 5 == 0 && radius > 0 && squares_are_normal) {
            ++clear;
            kept_in_vain += !touches && kept;
        }
    }
    std::printf("balls against boxes: n %zu, touching %zu, lost %zu, clear by 1 %% yet kept %zu of %zu\n", n, touching, lost,
                kept_in_vain, clear);
    CHECK(lost == 0);
    CHECK(kept_in_vain == 0);
    CHECK(touching > n / 4);
    CHECK(touching < n * 9 / 10);
    CHECK(clear > n / 20);
}

template <class T>
T stepped_some(T x, test::uniform& random) {
    const T inf = std::numeric_limits<T>::infinity();
    for (int step = static_cast<int>(random.below(7)) - 3; step != 0; step += step < 0 ? 1 : -1) {
        x = std::nextafter(x, step < 0 ? -inf : inf);
    }
    return x;
}

struct reach_tally {
    std::size_t touching = 0, lost = 0, clear = 0, kept_in_vain = 0;

    void add(bool touches, bool kept, bool is_clear) {
        touching += touches;
        lost += touches && !kept;
        clear += is_clear && !touches;
        kept_in_vain += is_clear && !touches && kept;
    }
    void check(const char* what, std::size_t n) const {
        std::printf("%s against boxes: n %zu, touching %zu, lost %zu, clear yet kept %zu of %zu\n", what, n, touching, lost,
                    kept_in_vain, clear);
        CHECK(lost == 0);
        CHECK(kept_in_vain == 0);
        CHECK(touching > n / 10);
        CHECK(clear > n / 20);
    }
};

/// A scale of the whole range, so that products underflow and overflow as well.
template <class T>
T any_scale(test::uniform& random) {
    const int span = std::numeric_limits<T>::max_exponent - 4;
    return std::ldexp(T(1), static_cast<int>(random(-span, span)));
}

template <class T>
bool is_moderate(T scale) {
    return std::fabs(std::log2(scale)) < std::numeric_limits<T>::max_exponent / 2 - 8;
}

/// Planes through a corner of a box, or just beside it, and others.
template <class T>
void check_planes(std::size_t n) {
    test::uniform random(11);
    reach_tally tally;
    for (std::size_t i = 0; i < n; ++i) {
        const T scale = i % 2 == 0 ? T(1) : any_scale<T>(random);
        const vec3<T> p = scale * random.point<T>(-1, 1), q = scale * random.point<T>(-1, 1);
        const aabb<T> box{detail::least(p, q), detail::greatest(p, q)};
        plane<T> query{random.point<T>(-1, 1), 0};
        const vec3<T> corner{random() < 0.5 ? p.x : q.x, random() < 0.5 ? p.y : q.y, random() < 0.5 ? p.z : q.z};
        query.offset = stepped_some(dot(query.normal, corner), random);
        const bool is_clear = i % 5 == 0 && is_moderate(scale);
        if (i % 5 == 0) query.offset = 2 * query.offset + scale / 64;
        bool below = false, above = false;
        for (int k = 0; k < 8; ++k) {
            const vec3<T> v{k % 2 ? p.x : q.x, k / 2 % 2 ? p.y : q.y, k / 4 ? p.z : q.z};
            const rational height = rational(query.normal.x) * rational(v.x) + rational(query.normal.y) * rational(v.y) +
                                    rational(query.normal.z) * rational(v.z) - rational(query.offset);
            below = below || height <= 0;
            above = above || height >= 0;
        }
        tally.add(below && above, reach_of(query)(box), is_clear);
    }
    tally.check("planes", n);
}

/// Capsules that pass an edge of a box at their radius, or nearly so, and others; some of radius 0.
template <class T>
void check_capsules(std::size_t n) {
    test::uniform random(13);
    reach_tally tally;
    for (std::size_t i = 0; i < n; ++i) {
        const T scale = i % 2 == 0 ? T(1) : any_scale<T>(random);
        const vec3<T> p = random.point<T>(-1, 1), q = random.point<T>(-1, 1), along = random.point<T>(-4, 4);
        const aabb<T> box{detail::least(p, q), detail::greatest(p, q)};
        // A direction away from the edge along z, orthogonal to the axis.
        const T length = std::hypot(along.x, along.y);
        vec3<T> away{along.y / length, -along.x / length, 0};
        const vec3<T> edge{away.x > 0 ? box.upper.x : box.lower.x, away.y > 0 ? box.upper.y : box.lower.y,
                           static_cast<T>(random(static_cast<double>(box.lower.z), static_cast<double>(box.upper.z)))};
        const bool is_clear = i % 5 == 0 && is_moderate(scale) && i % 2 == 0;
        const T radius = i % 3 == 0 ? T(0) : static_cast<T>(random()), distance = is_clear ? 2 * radius + T(0.25) : radius;
        const vec3<T> at = edge + distance * away;
        const T before = static_cast<T>(random()), after = static_cast<T>(random());
        const auto scaled = [&](const vec3<T>& v) { return scale * v; };
        const vec3<T> moved{stepped_some(at.x, random), stepped_some(at.y, random), stepped_some(at.z, random)};
        const aabb<T> far_box{scaled(box.lower), scaled(box.upper)};
        const capsule<T> query{{scaled(moved + after * along), scaled(moved - before * along)}, scale * radius};
        std::vector<T> values{query.radius};
        for (const vec3<T>& v : {query.axis.a, query.axis.b, far_box.lower, far_box.upper}) {
            values.insert(values.end(), {v.x, v.y, v.z});
        }
        const auto v = test::to_integers(values);
        std::vector<test::integer_point> differences;
        for (std::size_t k = 0; k < 16; ++k) {
            const std::size_t x = k % 2 ? 7 : 10, y = k / 2 % 2 ? 8 : 11, z = k / 4 % 2 ? 9 : 12, end = k / 8 ? 1 : 4;
            differences.push_back({v[x] - v[end], v[y] - v[end + 1], v[z] - v[end + 2]});
        }
        const auto [numerator, denominator] = test::distance_to_hull(differences);
        const bool touches = numerator <= v[0] * v[0] * denominator;
        tally.add(touches, reach_of(query)(far_box), is_clear);
        if (query.radius == 0) tally.add(touches, reach_of(query.axis)(far_box), is_clear);
    }
    tally.check("capsules", n);
}

}  // namespace

TEST_CASE("reach: a plane never loses a box that it touches") {
    check_planes<float>(20'000);
    check_planes<double>(20'000);
}

TEST_CASE("reach: a capsule and a segment never lose a box that they touch") {
    check_capsules<float>(3'000);
    check_capsules<double>(3'000);
}

TEST_CASE("reach: all of space is always kept, whatever the query") {
    const aabb<float> all = bounds(plane<float>{{0, 0, 1}, 0});
    CHECK(reach_of(plane<float>{{0, 0, 1}, 1})(all));
    CHECK(reach_of(capsule<float>{{{1, 2, 3}, {4, 5, 7}}, 1})(all));
    CHECK(reach_of(segment<float>{{1, 2, 3}, {1, 2, 3}})(all));
    CHECK(reach_of(aabb<float>{{1, 2, 3}, {4, 5, 7}})(all));
    CHECK(reach_of(vec3<float>{1, 2, 3})(all));
    constexpr float huge = std::numeric_limits<float>::max();
    const aabb<float> far{{-huge, -huge, huge}, {huge, huge, huge}};
    CHECK(reach_of(plane<float>{{0, huge, huge}, huge})(far));
    CHECK(reach_of(capsule<float>{{{-huge, huge, huge}, {huge, -huge, huge}}, huge})(far));
}

TEST_CASE("reach: a ball never loses a box that it touches") {
    check_balls<float>(100'000);
    check_balls<double>(100'000);
}

TEST_CASE("reach: extremes overflow to keeping") {
    constexpr float huge = std::numeric_limits<float>::max(), tiny = std::numeric_limits<float>::denorm_min();
    const aabb<float> far{{huge, huge, huge}, {huge, huge, huge}}, origin{{0, 0, 0}, {0, 0, 0}};
    CHECK(detail::ball_reach<float>({{huge, huge, 0}, huge})(far));
    CHECK(detail::ball_reach<float>({{0, 0, 0}, 0})(origin));
    CHECK(detail::ball_reach<float>({{tiny, 0, 0}, tiny})(origin));
    CHECK_FALSE(detail::ball_reach<float>({{1, 0, 0}, 0.5f})(origin));
    CHECK_FALSE(detail::ball_reach<float>({{-huge, 0, 0}, 1})(far));
}
