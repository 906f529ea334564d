// SPDX-License-Identifier: MIT
#pragma once

// What points and rays ask of several devices, how far sets are apart there, and which shapes come within a distance:
// answers are those of one policy, bit for bit, whatever lies where. Many shapes come twice, so that answers are told apart
// by ids alone, which lie on different devices.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/distance.hpp>
#include <abut/devices/query.hpp>
#include <abut/devices/rows.hpp>

#include "devices/device_cases.hpp"
#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace device_cases {

/// Triangles, each twice, the second far behind the first.
template <scalar T>
std::vector<triangle<T>> twice_some_triangles(std::size_t n, unsigned seed) {
    auto all = random_scene<T>(n, 0, false, seed).triangles;
    const auto first = all;
    all.insert(all.end(), first.begin(), first.end());
    return all;
}
/// Rays between points of which half lie on a lattice, as corners of triangles do.
template <scalar T>
std::vector<ray<T>> some_rays(std::size_t n, unsigned seed) {
    const auto from = some_points<T>(n, seed), to = some_points<T>(n, seed + 1);
    std::vector<ray<T>> rays;
    for (std::size_t i = 0; i < n; ++i) rays.push_back({from[i], to[i] - from[i]});
    return rays;
}

/// By all three queries of rays.
template <scalar T>
struct ray_answers {
    std::vector<ray_hit<T>> first;
    std::vector<std::uint8_t> any;
    std::vector<hit_of_ray<T>> all;
    friend bool operator==(const ray_answers&, const ray_answers&) = default;
};
template <scalar T, class On, class X, class Rays>
ray_answers<T> met_by(const On& on, const X& x, const Rays& rays) {
    return {to_host(raycast(on, x, rays)), to_host(raycast_any(on, x, rays)), to_host(raycast_all(on, x, rays))};
}

template <scalar T, class Team>
void check_raycast_on(const Team& team) {
    const auto triangles = twice_some_triangles<T>(450, 21);
    const triangle_soup<T> a(triangles);
    const auto whole = make_bvh(serial{}, a);
    const auto tree = make_bvh(team, a);
    const auto forest = make_bvh(team, divide(team, a));
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{70}, std::size_t{9'000}}) {
        CAPTURE(n, team.size());
        const abut::rays<T> set(some_rays<T>(n, 22));
        const auto expected = met_by<T>(serial{}, whole, set);
        CHECK((met_by<T>(team, tree, set) == expected));
        CHECK((met_by<T>(team, forest, set) == expected));
        CHECK((met_by<T>(team, make_bvh(team, given_parts(team, triangles)), replicate(team, set)) == expected));
        if (n < 9'000) continue;
        CHECK(expected.all.size() > n);
        const auto tie = [](const auto& x, const auto& y) { return x.ray == y.ray && x.t == y.t && y.id == x.id + 450; };
        CHECK(std::adjacent_find(expected.all.begin(), expected.all.end(), tie) != expected.all.end());
    }
    const abut::rays<T> some(some_rays<T>(300, 23));
    draws d(8, 0, 0);
    const auto pose = make_rotation<T>(d);
    const auto turned = met_by<T>(serial{}, posed(whole, pose), some);
    CHECK((met_by<T>(team, posed(forest, pose), some) == turned && turned.all.size() > 100));
    CHECK((to_host(raycast<exact>(team, forest, some)) == to_host(raycast(serial{}, whole, some))));
    const triangle_soup<T> none, one(std::vector<triangle<T>>{triangles[3]});
    CHECK((met_by<T>(team, make_bvh(team, divide(team, none)), some) == met_by<T>(serial{}, none, some)));
    CHECK((met_by<T>(team, make_bvh(team, divide(team, one)), some) == met_by<T>(serial{}, one, some)));
}

template <scalar T, class Team>
void check_nearest_few(const Team& team) {
    const auto triangles = twice_some_triangles<T>(300, 31);
    const triangle_soup<T> a(triangles);
    const auto whole = make_bvh(serial{}, a);
    const auto forest = make_bvh(team, divide(team, a));
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{70}, std::size_t{5'000}}) {
        for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{7}}) {
            CAPTURE(n, count, team.size());
            const auto from = some_points<T>(n, 32);
            const auto expected = to_host(nearest(serial{}, whole, from, count));
            CHECK((to_host(nearest(team, make_bvh(team, a), from, count)) == expected));
            CHECK((to_host(nearest(team, forest, from, count)) == expected));
            CHECK((to_host(nearest(team, make_bvh(team, given_parts(team, triangles)), from, count)) == expected));
        }
    }
    const triangle_soup<T> few(std::vector<triangle<T>>(triangles.begin(), triangles.begin() + 3));
    const auto from = some_points<T>(20, 33);
    const auto expected = to_host(nearest(serial{}, make_bvh(serial{}, few), from, 5));
    CHECK((to_host(nearest(team, make_bvh(team, few), from, 5)) == expected));
    CHECK((to_host(nearest(team, make_bvh(team, divide(team, few)), from, 5)) == expected));
    CHECK((expected[2].id != no_id && expected[3].id == no_id));
    CHECK(message_of([&] { (void)nearest(team, forest, from, 0); }) == "abut::nearest: count is 0, expected 1 or more");
}

/// Two bodies that overlap, in one mesh.
template <scalar T>
mesh<T> two_balls() {
    auto data = ball_surface<T>(3, 1.0);
    const auto other = ball_surface<T>(2, 0.75);
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    for (const auto& v : other.vertices) data.vertices.push_back({v.x + T(0.75), v.y, v.z});
    for (const auto& [i, j, k] : other.faces) data.faces.push_back({first + i, first + j, first + k});
    return mesh<T>(data.vertices, data.faces);
}

template <scalar T, class Team>
void check_inside_on(const Team& team) {
    const mesh<T> body = two_balls<T>();
    const auto whole = make_bvh(serial{}, body);
    std::vector<vec3<T>> from;
    for (const auto& p : some_points<T>(4'500, 41)) from.push_back({T(0.25) * (p.x - 4), T(0.25) * (p.y - 4), T(0.25) * (p.z - 4)});
    const auto data = ball_surface<T>(3, 1.0);
    from.insert(from.end(), data.vertices.begin(), data.vertices.end());
    const auto expected = to_host(inside(serial{}, whole, from));
    for (const containment at : {containment::outside, containment::inside, containment::on_surface}) {
        CHECK(std::count(expected.begin(), expected.end(), at) > 50);
    }
    const auto signs = to_host(signed_distance(serial{}, whole, from));
    const auto tree = make_bvh(team, body);
    const auto forest = make_bvh(team, divide(team, body));
    const inside_options closed{.known_closed = true};
    CHECK((to_host(inside(team, tree, from)) == expected));
    CHECK((to_host(inside<exact>(team, forest, from, closed)) == expected));
    CHECK((to_host(inside(team, divide(team, body), from, closed)) == expected));
    CHECK((to_host(signed_distance(team, tree, from)) == signs));
    CHECK((to_host(signed_distance(team, forest, points<T>(from), closed)) == signs));
    CHECK(message_of([&] { (void)inside(team, forest, from); }) ==
          "abut::inside: no device has all of a divided mesh to find out whether it is closed; expected {.known_closed = true}");
    const auto data_open = ball_surface<T>(1, 1.0);
    const mesh<T> open(data_open.vertices, std::vector<face>(data_open.faces.begin() + 1, data_open.faces.end()));
    CHECK_THROWS_AS((void)inside(team, make_bvh(team, open), from), invalid_geometry);
}

template <scalar T, class Team>
void check_winding_on(const Team& team) {
    const mesh<T> body = two_balls<T>();
    std::vector<vec3<T>> from;
    for (const auto& p : some_points<T>(9'000, 43)) from.push_back({T(0.25) * (p.x - 4), T(0.25) * (p.y - 4), T(0.25) * (p.z - 4)});
    const auto tree = make_bvh(team, body);
    const auto whole = make_bvh(serial{}, body);
    CHECK((to_host(winding_number(team, tree, from)) == to_host(winding_number(serial{}, whole, from))));
    CHECK((to_host(winding_number(team, tree, replicate(team, points<T>(from)), {.tolerance = 0})) ==
           to_host(winding_number(serial{}, whole, from, {.tolerance = 0}))));
    CHECK(winding_number(team, tree, std::vector<vec3<T>>()).size() == 0);
    CHECK(message_of([&] { (void)winding_number(team, tree, from, {.tolerance = -1}); }) ==
          message_of([&] { (void)winding_number(serial{}, whole, from, {.tolerance = -1}); }));
}

/// Pairs within a distance by all ways to ask for them.
template <class Team, class A, class B>
void check_pairs_within(const Team& team, const A& a, const B& b, double distance, const std::vector<index_pair>& expected) {
    CHECK((to_host(within(team, a, b, distance)) == expected));
    CHECK(count_within(team, a, b, distance) == expected.size());
    CHECK(any_within(team, a, b, distance) == !expected.empty());
}

template <scalar T, class Team>
void check_within(const Team& team) {
    auto all = random_scene<T>(500, 400, false, 51);
    for (auto& s : all.spheres) s.radius = T(0.25) * s.radius;
    const triangle_soup<T> a(all.triangles);
    const spheres<T> b(all.spheres);
    const auto tree_a = make_bvh(team, a);
    const auto tree_b = make_bvh(team, b);
    const auto forest_a = make_bvh(team, divide(team, a));
    const auto forest_b = make_bvh(team, divide(team, b));
    for (const double distance : {0.0, 0.25, 1.5}) {
        CAPTURE(distance, team.size());
        const auto expected = to_host(within(serial{}, a, b, distance));
        CHECK(expected.size() > (distance > 0 ? 100u : 5u));
        check_pairs_within(team, tree_a, tree_b, distance, expected);
        check_pairs_within(team, forest_a, forest_b, distance, expected);
        CHECK((to_host(within(team, tree_a, forest_b, distance)) == expected));
        CHECK((to_host(within(team, make_bvh(team, given_parts(team, all.triangles)), b, distance)) == expected));
        CHECK((to_host(within(team, replicate(team, a), replicate(team, b), distance)) == expected));
        draws d(7, 0, 0);
        const auto pose = make_rotation<T>(d);
        CHECK((to_host(within(team, posed(forest_a, pose), forest_b, distance)) ==
               to_host(within(serial{}, posed(a, pose), b, distance))));
        CHECK((to_host(self_within(team, tree_b, distance)) == to_host(self_within(serial{}, b, distance))));
        CHECK(count_self_within(team, tree_b, distance) == self_within(serial{}, b, distance).size());
        CHECK((to_host(self_within(team, forest_b, distance)) == to_host(self_within(serial{}, b, distance))));
        CHECK(count_self_within(team, forest_b, distance) == self_within(serial{}, b, distance).size());
    }
    const query_options<keep_some> some{.filter = {}};
    CHECK((to_host(within(team, forest_a, forest_b, 1.0, some)) == to_host(within(serial{}, a, b, 1.0, some))));
    if constexpr (host_policy<typename Team::local_policy>) {
        std::vector<std::uint64_t> sums(2 * static_cast<std::size_t>(team.size()));
        const auto visitor_of = [&](int k) { return sum_up{&sums[2 * static_cast<std::size_t>(k)], static_cast<std::uint64_t>(-1)}; };
        for_each_within(team, forest_a, tree_b, 0.5, visitor_of);
        std::uint64_t visits = 0, sum = 0;
        for (std::size_t k = 0; k < sums.size(); k += 2) visits += sums[k], sum += sums[k + 1];
        const auto expected = to_host(within(serial{}, a, b, 0.5));
        CHECK((visits == expected.size() && sum == sum_of(expected)));
    }
    CHECK(message_of([&] { (void)within(team, tree_a, tree_b, -1); }) ==
          "abut::within: distance is -1; expected a finite number, 0 or more");
}

/// How far two sets are apart that come nearer and nearer, until they touch.
template <scalar T, class Team>
void check_distance_on(const Team& team) {
    const auto triangles = twice_some_triangles<T>(300, 61);
    const triangle_soup<T> a(triangles);
    const auto tree_a = make_bvh(team, a);
    const auto forest_a = make_bvh(team, divide(team, a));
    const auto given_a = make_bvh(team, given_parts(team, triangles));
    bool touched = false, apart = false;
    for (const T away : {T(100), T(12), T(9), T(8)}) {
        CAPTURE(away, team.size());
        auto balls = random_scene<T>(0, 300, false, 62).spheres;
        for (auto& s : balls) s = {{s.center.x + away, s.center.y, s.center.z}, T(0.25)};
        const auto first = balls;
        balls.insert(balls.end(), first.begin(), first.end());
        const spheres<T> b(balls);
        const auto tree_b = make_bvh(team, b);
        const auto forest_b = make_bvh(team, divide(team, b));
        const auto expected = distance(serial{}, make_bvh(serial{}, a), make_bvh(serial{}, b));
        touched |= expected->distance == 0, apart |= expected->distance > 0;
        CHECK((expected->a < 300 && expected->b < 300));
        CHECK(distance(team, tree_a, tree_b) == expected);
        CHECK(distance(team, forest_a, forest_b) == expected);
        CHECK(distance(team, given_a, make_bvh(team, given_parts(team, balls))) == expected);
        CHECK(distance(team, forest_a, tree_b) == expected);
        CHECK(distance(team, tree_a, b) == expected);
        CHECK(distance(team, replicate(team, a), replicate(team, b)) == expected);
        const auto in_vain = distance(team, forest_a, forest_b, {.below = static_cast<double>(expected->distance)});
        CHECK(in_vain == std::nullopt);
        CHECK(distance(team, forest_a, forest_b, {.below = static_cast<double>(expected->distance) + 1}) == expected);
        draws d(7, 0, 0);
        const auto pose = make_rotation<T>(d);
        const auto turned = distance(serial{}, posed(make_bvh(serial{}, a), pose), make_bvh(serial{}, b));
        CHECK(distance(team, posed(forest_a, pose), forest_b) == turned);
        CHECK(distance(team, posed(tree_a, pose), tree_b) == turned);
    }
    CHECK((touched && apart));
    const triangle_soup<T> none;
    CHECK(distance(team, forest_a, make_bvh(team, divide(team, none))) == std::nullopt);
    CHECK(distance(team, tree_a, make_bvh(team, none)) == std::nullopt);
    const triangle_soup<T> one(std::vector<triangle<T>>{{{90, 0, 0}, {91, 0, 0}, {90, 1, 0}}});  // on one device alone
    CHECK(distance(team, forest_a, make_bvh(team, divide(team, one))) == distance(serial{}, a, one));
}

template <scalar T, class Team>
void check_question_errors(const Team& team, const Team& larger) {
    const auto triangles = twice_some_triangles<T>(20, 71);
    const triangle_soup<T> a(triangles);
    const auto tree = make_bvh(team, a);
    const std::string lies = " lies on " + std::to_string(team.size()) + " devices, the call is to " + std::to_string(larger.size());
    CHECK(message_of([&] { (void)raycast(larger, tree, abut::rays<T>()); }) == "abut::raycast: the argument" + lies);
    CHECK(message_of([&] { (void)distance(larger, tree, a); }) == "abut::distance: the argument" + lies);
    CHECK(message_of([&] { (void)count_within(larger, a, tree, 1); }) == "abut::count_within: the argument" + lies);
    auto rays = some_rays<T>(6'000, 72);
    rays[5'000].origin.y = std::numeric_limits<T>::quiet_NaN();
    const shapes_view<ray<T>> view(rays.data(), rays.size());
    if constexpr (host_policy<typename Team::local_policy>) {
        const auto said = message_of([&] { (void)raycast_all(team, tree, view); });
        CHECK(said == message_of([&] { (void)raycast_all(serial{}, a, view); }));
        CHECK(said.find("5000") != std::string::npos);
    }
    CHECK(message_of([&] { (void)distance(team, tree, tree, {.below = std::numeric_limits<double>::quiet_NaN()}); }) ==
          "abut::distance: below is NaN; expected a distance");
}

}  // namespace device_cases

/// All of these of a team.
template <scalar T, class Team>
void check_questions(const Team& team) {
    device_cases::check_raycast_on<T>(team);
    device_cases::check_nearest_few<T>(team);
    device_cases::check_inside_on<T>(team);
    device_cases::check_winding_on<T>(team);
    device_cases::check_within<T>(team);
    device_cases::check_distance_on<T>(team);
}

}  // namespace abut::test
