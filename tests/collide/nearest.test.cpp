// SPDX-License-Identifier: MIT
#include <abut/collide/nearest.hpp>

#include "collide/nearest_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

TEMPLATE_TEST_CASE("nearest: serial", "", float, double) { test::check_all_nearest<TestType>(serial{}); }

namespace {

/// Looks as devices do.
struct in_groups : execution::policy_base {
    using memory_space = host_space;
};
int concurrency(const in_groups&) { return 1; }
template <class F>
void for_each_range(const in_groups&, std::size_t n, std::size_t, const F& f) {
    f(0, std::size_t{0}, n);
}

}  // namespace

template <>
inline constexpr bool abut::detail::looks_in_groups<in_groups> = true;

TEMPLATE_TEST_CASE("nearest: in groups", "", float, double) {
    test::check_all_nearest<TestType>(in_groups{});
    test::check_nearest_of<vec3<TestType>>(in_groups{}, 75);
    test::check_nearest_of<segment<TestType>>(in_groups{}, 76);
    test::check_nearest_in_tube<TestType>(in_groups{});
}

TEST_CASE("nearest: points, segments, capsules and boxes") {
    test::check_nearest_of<vec3<float>>(serial{}, 75);
    test::check_nearest_of<segment<double>>(serial{}, 76);
    test::check_nearest_of<capsule<float>>(serial{}, 77);
    test::check_nearest_of<aabb<double>>(serial{}, 78);
}

TEST_CASE("nearest: openmp on 1, 3 and 7 threads") {
    for (const int threads : {1, 3, 7}) {
        CAPTURE(threads);
        test::check_nearest_by_hand<float>(openmp{threads});
        test::check_nearest_to_mesh<double>(openmp{threads});
    }
}

namespace stones {

/// A shape of the caller's own: a box whose lower corner alone counts.
struct flag {
    vec3<float> foot;
    float height;
    using scalar_type = float;
};
aabb<float> bounds(const flag& f) { return {f.foot, {f.foot.x, f.foot.y, f.foot.z + f.height}}; }
vec3<float> nearest_point(const flag& f, const vec3<float>& p) {
    return abut::nearest_point(segment<float>{f.foot, {f.foot.x, f.foot.y, f.foot.z + f.height}}, p);
}

}  // namespace stones

TEST_CASE("nearest: a shape of the caller's own by the point that it names") {
    static_assert(approachable<stones::flag>);
    test::uniform random(79);
    std::vector<stones::flag> flags;
    for (int i = 0; i < 200; ++i) flags.push_back({random.point<float>(-1, 1), 0.5f});
    test::check_nearest(serial{}, shapes<stones::flag>(flags), test::points_around<float>(100, random, {}));
}
