// SPDX-License-Identifier: MIT
#include <abut/experimental/front.hpp>
#include <abut/experimental/leafless.hpp>

#include "collide/front_cases.hpp"

namespace abut::test {

TEST_CASE("fronts: serial") { check_fronts(serial{}, 1000); }

TEST_CASE("fronts: openmp") { check_fronts(openmp{.threads = 3}, 200); }

TEST_CASE("fronts: another policy of the same memory, another layout, another scalar") {
    uniform random(20270404);
    const auto a = small_crowd<double>(200, random).soup(), b = small_crowd<double>(150, random).soup();
    const auto x = make_bvh(serial{}, a), y = make_bvh(serial{}, b);
    const auto expected = to_host(pairs(serial{}, x, y));
    front ends;
    const begun_at<> from{.front = &ends};
    CHECK(to_host(pairs(serial{}, x, y, from)) == expected);
    CHECK(to_host(pairs(openmp{.threads = 2}, x, y, from)) == expected);
    CHECK(ends.report().rebuilds == 1);
    CHECK(ends.report().queries == 2);
    CHECK(to_host(pairs(serial{}, wide(serial{}, x), wide(serial{}, y), from)) == expected);
    CHECK(to_host(pairs(serial{}, x, leafless(serial{}, y), from)) == expected);
    CHECK(ends.report().queries == 2);
    front moved = std::move(ends);
    CHECK(to_host(pairs(serial{}, x, y, begun_at<>{.front = &moved})) == expected);
    CHECK(moved.report().rebuilds == 1);
    // A tree in the place of one that is gone has another topology.
    for (int k = 0; k < 20; ++k) {
        const auto fresh = make_bvh(serial{}, small_crowd<double>(150, random).soup());
        CHECK(to_host(pairs(serial{}, x, fresh, begun_at<>{.front = &moved})) == to_host(pairs(serial{}, x, fresh)));
        CHECK(moved.report().rebuilds == static_cast<std::uint64_t>(2 + k));
    }
}

}  // namespace abut::test
