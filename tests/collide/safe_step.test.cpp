// SPDX-License-Identifier: MIT

#include "collide/safe_step_cases.hpp"

#include <limits>
#include <string>

namespace abut::test {

TEST_CASE("safe_step: nothing is met, and a little later something is") {
    check_safe_step(serial{}, 20);
    check_safe_step(openmp{}, 5);
}
TEST_CASE("safe_steps: whatever part each vertex takes, nothing is met") {
    check_safe_steps(serial{}, 20);
    check_safe_steps(openmp{}, 5);
}

TEST_CASE("safe_step: contacts at known times") {
    const serial on;
    const mesh<float> floor({{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {{0, 1, 2}});
    const auto falls = [](float from, float to) {
        const mesh<float> point({{0, 0, from}}, std::vector<face>{});
        return moving(point, point.with_vertices(serial{}, std::vector<vec3<float>>{{0, 0, to}}));
    };
    CHECK(safe_step(on, falls(1, -1), floor) == 0.5 - 0x1p-40);  // the contact is at a multiple of 2^-40
    CHECK(safe_step(on, falls(1, -2), floor) == (std::floor(0x1p40 / 3) - 1) * 0x1p-40);
    CHECK(safe_step(on, falls(1, 0), floor) == 1 - 0x1p-40);
    CHECK(safe_step(on, falls(1, 0.001f), floor) == 1);
    CHECK(safe_step(on, falls(0, 1), floor) == 0);
    CHECK(safe_step(on, falls(1, 1), mesh<float>()) == 1);
    const double with = safe_step(on, falls(1, -1), floor, {.tolerance = 0x1p-20, .separation = 0.25});
    CHECK((with > 0.375 - 0x1p-19 && with < 0.375));
    CHECK(safe_step(on, falls(0.125f, 1), floor, {.separation = 0.25}) == 0);  // begins nearer, and goes away

    const auto alone = [&](float from, float to, double separation = 0) {
        const auto parts = safe_steps(on, falls(from, to), floor, {.separation = separation});
        for (const double f : to_host(parts.second)) CHECK(f == 1);  // at rest
        return to_host(parts.first).at(0);
    };
    CHECK((alone(1, -1) > 0.499 && alone(1, -1) < 0.5));
    CHECK((alone(1, -1, 0.25) > 0.374 && alone(1, -1, 0.25) < 0.375));
    CHECK(alone(0, 1) == 0);
    CHECK(alone(0, 0) == 1);
    CHECK(alone(1, 0.5f) == 1);
    CHECK(to_host(safe_self_steps(on, mesh<float>())).empty());
}

TEST_CASE("safe_step: what is refused") {
    const serial on;
    const mesh<double> m({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const auto says = [](const auto& call, const std::string& name) {
        try {
            call();
        } catch (const error& e) {
            const std::string what = e.what();
            CAPTURE(what);
            return what.find(name + ": ") == 0 && what.find("separation") != std::string::npos;
        }
        return false;
    };
    for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK(says([&] { (void)safe_step(on, m, m, {.separation = bad}); }, "abut::safe_step"));
        CHECK(says([&] { (void)safe_self_step(on, m, {.separation = bad}); }, "abut::safe_self_step"));
        CHECK(says([&] { (void)safe_steps(on, m, m, {.separation = bad}); }, "abut::safe_steps"));
        CHECK(says([&] { (void)safe_self_steps(on, m, {.separation = bad}); }, "abut::safe_self_steps"));
    }
}

}  // namespace abut::test
