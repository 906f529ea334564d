// SPDX-License-Identifier: MIT
#include <abut/traverse/reach.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

static_assert(prune_functor<detail::ball_reach<float>, float>);
static_assert(prune_functor<detail::box_reach<double>, double>);
static_assert(!prune_functor<aabb<float>, float>);

namespace {

template <class T>
rational squared_distance(const vec3<T>& p, const aabb<T>& box) {
    const auto axis = [](T x, T lower, T upper) -> rational {
        const rational beyond = x < lower ? rational(lower) - rational(x) : x > upper ? rational(x) - rational(upper) : rational(0);
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
        const aabb<T> box{detail::lesser(p, q), detail::greater(p, q)};
        const vec3<T> away = center - detail::lesser(detail::greater(center, box.lower), box.upper);
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

}  // namespace

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
