// SPDX-License-Identifier: MIT
#include <abut/cuda.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"

namespace {

using namespace abut;
using namespace abut::test;

/// The same bits as serial's, again and again.
template <class T>
void check_bodies() {
    const large_scene<T> s(5, 0.07);
    const auto a = s.a.as_set(), b = s.b.as_set();
    const auto between = to_host(impacts(serial{}, a, b)), self = to_host(self_impacts(serial{}, a));
    CHECK(between.size() > 2000);
    CHECK(self.size() > 2000);
    const abut::cuda on;
    const auto of_a = make_impact_index(on, a), of_b = make_impact_index(on, b);
    for (int k = 0; k < 20; ++k) {
        check_same("between", to_host(impacts(on, of_a, of_b)), between);
        check_same("within", to_host(self_impacts(on, of_a)), self);
        CHECK(first_impact(on, of_a, of_b) == abut::test::first_of(between));
    }
    check_same("from the host", to_host(impacts(on, a, b)), between);
}

}  // namespace

TEST_CASE("impacts: cuda, float") {
    check_all_impacts<float, ways::conservative_too>(abut::cuda{});
    check_small_impacts<float, ways::conservative_too>(abut::cuda{});
    check_bodies<float>();
}

TEST_CASE("impacts: cuda, double") {
    check_all_impacts<double, ways::filtered_alone>(abut::cuda{});
    check_bodies<double>();
}

TEST_CASE("vertices and faces in motion in a query: cuda") {
    for (const impact_case<float>& c : impact_cases<float>()) {
        if (!c.follows) check_moving_pairs(abut::cuda{}, c);
    }
}
