// SPDX-License-Identifier: MIT
#include <abut/collide/mixed_questions.hpp>

#include "collide/mixed_bodies_cases.hpp"

namespace abut::test {

TEST_CASE("bodies of several kinds: serial, float") { check_mixed_bodies<float, true>(serial{}); }

TEST_CASE("bodies of several kinds: openmp, double") { check_mixed_bodies<double, false>(openmp{.threads = 3}); }

TEST_CASE("bodies of several kinds: ties") {
    check_mixed_ties<float>(serial{});
    check_mixed_ties<double>(openmp{.threads = 2});
}

TEST_CASE("bodies of several kinds: as cuda is asked") { check_mixed_alike(openmp{.threads = 2}); }

TEST_CASE("bodies of several kinds: lists in another order, lists of one kind, and bodies that are there") {
    const serial on;
    const auto scene = random_mixed_scene<float>(on, 7, 1.0, {5, 6, 7});
    const auto& [meshes, boxes, capsules] = scene.kinds;
    const auto first = to_host(pairs(on, scene.made(on)));
    CHECK(first.size() > 20);
    // The numbers of the same bodies where the capsules come first.
    const auto renamed = [](std::uint32_t body) { return body < 11 ? body + 7 : body - 11; };
    std::vector<body_pair> expected;
    for (const body_pair& p : first) {
        const body_pair same{renamed(p.body_a), renamed(p.body_b), p.a, p.b};
        const bool is_turned = same.body_a > same.body_b;
        expected.push_back(is_turned ? body_pair{same.body_b, same.body_a, same.b, same.a} : same);
    }
    std::sort(expected.begin(), expected.end());
    const auto there = make_bodies(on, boxes.bodies);
    CHECK((to_host(pairs(on, make_bodies(on, capsules.bodies, meshes.bodies, there))) == expected));
    // Two lists of one kind are as one.
    const auto& all = capsules.bodies;
    const std::vector front(all.begin(), all.begin() + 3), back(all.begin() + 3, all.end());
    const auto parts = make_bodies(on, front, back);
    CHECK((to_host(pairs(on, parts)) == to_host(pairs(on, all))));
    CHECK(distance(on, parts) == distance(on, all));
    const auto& rings = meshes.bodies;
    const std::vector first_ring(rings.begin(), rings.begin() + 1), other_rings(rings.begin() + 1, rings.end());
    std::vector<ray<float>> lines;
    for (const auto& body : rings) lines.push_back({body.pose.translation, {1, 0, 0}});
    const rays<float> rows(lines);
    const auto details = to_host(raycast_detailed(on, rings, rows));
    CHECK(std::any_of(details.begin(), details.end(), [](const auto& x) { return x.hit.body > 0 && x.hit.body < no_id; }));
    CHECK((to_host(raycast_detailed(on, make_bodies(on, first_ring, other_rings), rows)) == details));
    CHECK((parts.size() == 7 && parts.first(1) == 3 && parts.part<1>().size() == 4));
}

TEST_CASE("bodies of several kinds: filters that are const, and capture") {
    const serial on;
    const auto all = random_mixed_scene<float>(on, 7, 1.0, {5, 6, 7}).made(on);
    const std::vector<std::uint32_t> allowed{3, 11};  // a table of the caller's
    const auto asked = [&allowed](std::uint32_t a, std::uint32_t b) {
        return std::find(allowed.begin(), allowed.end(), a) == allowed.end() && std::find(allowed.begin(), allowed.end(), b) == allowed.end();
    };
    const auto shapes = [&allowed](const body_pair& p) { return p.a != allowed[0]; };
    const body_options<decltype(shapes), schedule::shared_list, decltype(asked)> options{.filter = shapes, .bodies = asked};
    std::vector<body_pair> expected;
    for (const body_pair& p : to_host(pairs(on, all))) {
        if (asked(p.body_a, p.body_b) && shapes(p)) expected.push_back(p);
    }
    CHECK(expected.size() > 10);
    CHECK(expected.size() < count(on, all));
    CHECK((to_host(pairs(on, all, options)) == expected));
    CHECK(count(on, all, options) == expected.size());
}

TEST_CASE("bodies of several kinds: what is wrong is named") {
    const serial on;
    auto scene = random_mixed_scene<float>(on, 7, 1.0, {2, 3, 4});
    auto& boxes = std::get<1>(scene.kinds).bodies;
    const auto all = scene.made(on);
    const auto said_of = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const error& problem) {
            return problem.what();
        }
        return "nothing";
    };
    auto poses = scene.poses();
    CHECK(said_of([&] { (void)refit(on, all, std::span(poses).first(8)); }) ==
          "abut::refit: there are 9 bodies and 8 poses");
    poses[3].rotation[0] = boxes[1].pose.rotation[0] = 7;
    CHECK(said_of([&] { (void)refit(on, all, poses); }).starts_with("abut::refit: body 3 (1 of list 1): rotation row 0"));
    CHECK(said_of([&] { (void)scene.made(on); }).starts_with("abut::make_bodies: body 3 (1 of list 1): rotation row 0"));
    CHECK(said_of([&] { (void)any_within(on, all, -1.0); }).starts_with("abut::any_within: distance is -1"));
    CHECK(said_of([&] { (void)distance(on, all, {.below = -1}); }).starts_with("abut::distance: below is -1"));
    CHECK(said_of([&] { (void)nearest(on, all, vec3<float>{}, 0); }).starts_with("abut::nearest: count is 0"));
}

}  // namespace abut::test
