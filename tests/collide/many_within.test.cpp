// SPDX-License-Identifier: MIT
#include <abut/collide/within.hpp>

#include "collide/many_within_cases.hpp"

TEMPLATE_TEST_CASE("within: lists of posed pairs and scenes of bodies, serial and openmp", "", float, double) {
    abut::test::check_all_many_within<TestType>(abut::serial{});
    abut::test::check_all_many_within<TestType>(abut::openmp{.threads = 3});
}

TEST_CASE("within: lists of cylinders and cones with points and spheres, serial and openmp") {
    using namespace abut;
    test::check_lists_of_solids_within<cylinder<float>, sphere<float>>(serial{});
    test::check_lists_of_solids_within<cone<double>, vec3<double>>(openmp{.threads = 3});
}

TEST_CASE("within: lists and scenes of trees of other layouts") {
    using namespace abut;
    using namespace abut::test;
    const openmp on{.threads = 3};
    const torus<float> shape(12, 8, 0.7, 0.3);
    const auto tree = make_bvh(on, triangle_soup<float>(triangles_of(shape.vertices, shape.faces)));
    const auto one = make_bvh(on, triangle_soup<float>(std::vector<triangle<float>>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
    const auto check = [&](const auto& layout_a, const auto& layout_b) {
        const std::vector of_a{layout_a(tree), layout_a(one)};
        const std::vector of_b{layout_b(tree), layout_b(one)};
        std::vector<posed_pair<std::remove_cvref_t<decltype(of_a[0])>, std::remove_cvref_t<decltype(of_b[0])>>> list;
        std::vector<posed_object<std::remove_cvref_t<decltype(of_a[0])>>> bodies;
        std::vector<tagged_pair> expected;
        for (std::uint32_t i = 0; i < 16; ++i) {
            draws d(20270505, 104, i);
            const auto pose_a = make_loose_pose<float>(d, 1), pose_b = make_loose_pose<float>(d, 1);
            list.push_back({posed(of_a[i % 2], pose_a), posed(of_b[i / 2 % 2], pose_b)});
            bodies.push_back(posed(of_a[i % 2], pose_a));
            const auto& a = i % 2 == 0 ? tree : one;
            const auto& b = i / 2 % 2 == 0 ? tree : one;
            for (const auto& p : within(serial{}, posed(a, pose_a), posed(b, pose_b), 0.25))
                expected.push_back({i, p.a, p.b});
        }
        CHECK(expected.size() > 1000);
        CHECK((to_host(within(on, list, 0.25)) == expected));
        std::size_t of_bodies = 0;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) of_bodies += count_within(serial{}, bodies[i], bodies[j], 0.25);
        }
        CHECK(of_bodies > 1000);
        CHECK(count_within(on, bodies, 0.25) == of_bodies);
        const body_options<keep_all, schedule::work_stealing> stealing;
        CHECK(within(on, bodies, 0.25, stealing).size() == of_bodies);
    };
    const auto as_it_is = [](const auto& x) { return x; };
    check([&](const auto& x) { return wide(on, x); }, as_it_is);
    check([&](const auto& x) { return quantised(on, x); }, [&](const auto& x) { return wide(on, x); });
    check([&](const auto& x) { return oriented(on, x); }, [&](const auto& x) { return oriented(on, x); });
}
