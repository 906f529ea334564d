// SPDX-License-Identifier: MIT
#include <abut/collide/ray_options.hpp>

#include "collide/ray_options_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("options of rays and points", "", float, double) {
    const serial one;
    const openmp some{.threads = 3};
    check_ray_options<TestType>(one, [&](const auto& set) { return make_bvh(one, set); });
    check_ray_options<TestType>(some, [](const auto& set) { return set; });
    check_nearest_options<TestType>(one, [&](const auto& set) { return make_bvh(one, set); });
    check_nearest_options<TestType>(some, [](const auto& set) { return set; });
}

TEST_CASE("options of rays in trees that are walked in bundles and turns") {
    const openmp some{.threads = 2};
    check_ray_options<float>(some, [&](const auto& set) { return wide(some, make_bvh(some, set)); });
    check_nearest_options<float>(some, [&](const auto& set) { return make_grid(some, set); });
}

TEST_CASE("options of rays: bodies") {
    const serial on;
    const lattice_scene<float> scene(60, 100, 17);
    const auto tree = make_bvh(on, triangle_soup<float>(scene.triangles));
    std::vector<posed_object<std::remove_const_t<decltype(tree)>>> list;
    for (int i = 0; i < 4; ++i) list.push_back(posed(tree, rigid<float>{.translation = {float(3 * i), float(i), 0}}));
    const rays<float> rows(scene.rays);
    const auto all = to_host(raycast_all(on, list, rows));
    std::vector<body_hit_of_ray<float>> expected;
    for (const auto& hit : all) {
        triangle<float> t = scene.triangles[hit.id];
        t = place(list[hit.body].pose, t);
        const auto& r = scene.rays[hit.ray];
        const double time = detail::hit_time<exact>(r, t);
        if (!some_rows_of_bodies{}(hit.ray, hit.body, hit.id)) continue;
        if (is_kept(r.origin, r.direction, t, time, 0, 0, raycast_options<>{.most_t = 0.75, .side = ray_side::front}))
            expected.push_back(hit);
    }
    CHECK(expected.size() > 20);
    CHECK(all.size() > 3 * expected.size());
    const raycast_options<some_rows_of_bodies> options{.filter = {}, .most_t = 0.75, .side = ray_side::front};
    CHECK((to_host(raycast_all(on, make_bodies(on, list), rows, options)) == expected));
    const auto first = to_host(raycast(on, list, rows, options));
    const auto detailed = to_host(raycast_detailed(on, list, rows, options));
    std::size_t wrong = 0, hits = 0;
    for (std::size_t k = 0; k < first.size(); ++k) {
        wrong += detailed[k].hit != first[k];
        if (first[k].id == no_id) continue;
        ++hits;
        wrong += detailed[k].side != ray_side::front;
        const auto at = std::find_if(expected.begin(), expected.end(), [&](const auto& hit) { return hit.ray == k; });
        wrong += at == expected.end() || first[k] != body_hit<float>{at->body, at->id, at->t};
    }
    CHECK((wrong == 0 && hits > 20));
}

TEST_CASE("options of rays: solids have a front alone, and times are checked") {
    const serial on;
    const spheres<float> balls(std::vector<sphere<float>>{{{0, 0, 5}, 1}, {{0, 0, 9}, 1}});
    const ray<float> up{{0, 0, 0}, {0, 0, 1}};
    CHECK(to_host(raycast(on, balls, up, {.side = ray_side::front}))[0].id == 0);
    CHECK(to_host(raycast(on, balls, up, {.side = ray_side::back}))[0].id == no_id);
    CHECK(to_host(raycast(on, balls, up, {.least_t = 4}))[0].id == 0);
    CHECK(to_host(raycast(on, balls, up, {.least_t = 4.5}))[0].id == 1);
    CHECK(to_host(raycast_any(on, balls, up, {.most_t = 3.5}))[0] == 0);
    CHECK(to_host(raycast_any(on, balls, up, {.most_t = 4}))[0] == 1);
    CHECK_THROWS_AS((void)raycast(on, balls, up, {.least_t = -1}), error);
    CHECK_THROWS_AS((void)raycast_all(on, balls, up, {.most_t = std::nan("")}), error);
}

}  // namespace abut::test
