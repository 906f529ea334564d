// SPDX-License-Identifier: MIT
#include <abut/predicate/within.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <type_traits>
#include <vector>

#include <abut/narrow/distance.hpp>
#include <abut/shape/hull.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/revolution_ties.hpp"
#include "support/samples.hpp"

// Rays within a distance of what they may meet: of whole numbers they are decided as segments that are long enough, whose
// answers are exact signs of polynomials, and share nothing with the search that certifies a ray's.

namespace {

namespace ray_within {

using namespace abut;

constexpr ray<float> up{{8, -9, 6}, {0, 0.125f, 0}};
static_assert(within(up, sphere<float>{{0, 0, 6}, 3}, 5) &&
              !within(sphere<float>{{0, 0, 6}, 3}, up, 0x1.3ffffffffffffp2));
static_assert(distance_decidable<ray<float>, hull<float>> && distance_decidable<cone<double>, ray<double>> &&
              !distance_decidable<ray<float>, vec3<float>> && !distance_decidable<ray<float>, ray<float>> &&
              !distance_decidable<ray<float>, plane<float>> && !distance_decidable<ray<float>, aabb<double>>);

struct drawn {
    test::draws& d;

    template <scalar T>
    vec3<T> point(int most) const {
        const auto x = [&] { return static_cast<T>(d.below(2 * most + 1) - most); };
        const T a = x(), b = x(), c = x();
        return {a, b, c};
    }
    template <scalar T>
    T radius() const {
        return static_cast<T>(d.below(6)) / 2;
    }
    template <class U>
    U shape() const {
        using T = scalar_type_of<U>;
        const vec3<T> p = point<T>(5), q = point<T>(5), r = point<T>(5);
        if constexpr (std::same_as<U, triangle<T>>) return {p, q, r};
        if constexpr (std::same_as<U, sphere<T>>) return {p, radius<T>()};
        if constexpr (std::same_as<U, capsule<T>>) return {{p, q}, radius<T>()};
        if constexpr (std::same_as<U, cylinder<T>>) return {{p, q}, radius<T>()};
        if constexpr (std::same_as<U, cone<T>>) return {p, q, radius<T>()};
        if constexpr (std::same_as<U, aabb<T>>) return bounds(triangle<T>{p, q, q});
    }
};

using tally = test::within_tally;

template <scalar T, class U>
void examine(const ray<T>& r, const U& t, std::uint64_t k, tally& sum) {
    const segment<T> s{r.origin, r.origin + T(256) * r.direction};
    const double d = test::distance_beside(static_cast<double>(distance(t, s).distance), k);
    const bool truth = within(s, t, d);
    const verdict lie = to_verdict(!truth), by_filter = detail::decide_within<filtered>(r, t, d),
                  late = detail::decide_within_late<filtered>(r, t, d), by_bits = detail::decide_within<exact>(r, t, d);
    ++sum.pairs;
    sum.hits += truth;
    sum.open += by_filter == verdict::unknown;
    sum.unlike += within<fast>(t, r, d) != truth;
    sum.without_end += d > 0 && by_bits == verdict::unknown;
    sum.wrong += by_filter == lie || late == lie || by_bits == lie || within(r, t, d) != truth ||
                 within<exact>(t, r, d) != truth || detail::resolve_within(r, t, d) != truth ||
                 within(t, r, 0) != intersects(r, t) || detail::decide_within<fast>(r, t, d) == verdict::unknown;
}

template <class U>
void check(const char* name) {
    using T = scalar_type_of<U>;
    tally sum;
    for (std::uint64_t k = 0; k < test::some_samples(5); ++k) {
        test::draws d(test::sample_seed + 12, sizeof(U), k);
        const drawn draw{d};
        ray<T> r{draw.point<T>(5), draw.point<T>(3)};
        if (r.direction == vec3<T>{0, 0, 0}) r.direction.x = 1;
        if constexpr (std::same_as<U, hull<T>>) {
            std::vector<vec3<T>> points(static_cast<std::size_t>(1 + d.below(9)));
            for (vec3<T>& p : points) p = draw.point<T>(5);
            examine(r, hull<T>(points.data(), points.size()), k, sum);
        } else {
            examine(r, draw.shape<U>(), k, sum);
        }
    }
    CAPTURE(name);
    test::print(name, sum);
    CHECK(sum.wrong == 0);
    CHECK(sum.without_end * 50 <= sum.pairs);
    CHECK(test::is_share_above(0.2, sum.hits, sum.pairs));
    CHECK(test::is_share_above(0.2, sum.pairs - sum.hits, sum.pairs));
}

}  // namespace ray_within

}  // namespace

TEMPLATE_TEST_CASE("within, rays: of whole numbers, as long segments", "", float, double) {
    using namespace abut;
    ray_within::check<triangle<TestType>>("triangles");
    ray_within::check<sphere<TestType>>("spheres");
    ray_within::check<capsule<TestType>>("capsules");
    ray_within::check<aabb<TestType>>("boxes");
    ray_within::check<hull<TestType>>("hulls");
    ray_within::check<cylinder<TestType>>("cylinders");
    ray_within::check<cone<TestType>>("cones");
}
