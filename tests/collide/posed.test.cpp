// SPDX-License-Identifier: MIT
#include <abut/experimental/leafless.hpp>

#include "posed_cases.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("queries of posed sets and indices", "", float, double) {
    SECTION("serial") { check_all_posed<TestType>(serial{}); }
    SECTION("openmp") { check_all_posed<TestType>(openmp{.threads = 3}); }
}

/// Calls see(make) for every kind of tree that a host has, where make(set) is such a tree. Volumes are of triangles alone.
template <bool OfTriangles, class On, class See>
void for_each_kind_of_tree(const On& on, const See& see) {
    const auto built = [&on](const auto& set) { return make_bvh(on, set, {.builder = bvh_builder::sah}); };
    see(built);
    see([&](const auto& set) { return quantised(on, built(set)); });
    see([&](const auto& set) { return leafless(on, built(set)); });
    see([&](const auto& set) { return wide(on, built(set)); });
    if constexpr (OfTriangles) {
        see([&](const auto& set) { return oriented(on, built(set)); });
        see([&]<class Set>(const Set& set) { return bounded_by<sphere<typename Set::scalar_type>>(on, built(set)); });
        see([&]<class Set>(const Set& set) { return bounded_by<kdop<typename Set::scalar_type, 18>>(on, built(set)); });
    }
}

/// Poses as far from orthonormal as is accepted, in each way: no pair is lost and none invented, whatever the trees.
TEMPLATE_TEST_CASE("loose poses: every kind of tree finds what placed shapes tell", "", float, double) {
    using T = TestType;
    const openmp on{.threads = 2};
    uniform random(20261125);
    std::size_t hits = 0;
    for (std::uint64_t scene = 0; scene < 24; ++scene) {
        draws d(20261125, 82, scene);
        const double far = scene % 4 == 0 ? 100 : 1;
        rigid<T> pose_a = make_loose_pose<T>(d, far), pose_b = make_loose_pose<T>(d, far);
        if (scene % 2 == 1) {
            pose_a = construction::strained(d, make_pose<T>(d, far), 0.99 * rotation_tolerance);
            pose_b = construction::strained(d, make_pose<T>(d, far), 0.99 * rotation_tolerance);
        }
        const auto center = random.point<T>(-far, far);
        const auto a = brought_back(random_triangles<T>(120, random), pose_a, center);
        const auto b = brought_back(random_triangles<T>(150, random), pose_b, center);
        const auto balls = brought_back(random_spheres<T>(100, random), pose_b, center);
        const auto posed_a = posed(a, pose_a);
        const posed_view<typename triangle_soup<T>::view_type> placed_a{a.view(), pose_a}, placed_b{b.view(), pose_b};
        const pair_list expected = placed_truth(placed_a, placed_b);
        const pair_list expected_of_balls =
            placed_truth(placed_a, posed_view<typename spheres<T>::view_type>{balls.view(), pose_b});
        hits += expected.size() + expected_of_balls.size();
        CAPTURE(scene);
        for_each_kind_of_tree<true>(on, [&](const auto& make) {
            const auto tree_b = posed(make(b), pose_b);
            CHECK(to_host(pairs(on, posed_a, tree_b)) == expected);
            CHECK(to_host(pairs(on, posed(make(a), pose_a), tree_b)) == expected);
        });
        for_each_kind_of_tree<false>(on, [&](const auto& make) {
            CHECK(to_host(pairs(on, posed_a, posed(make(balls), pose_b))) == expected_of_balls);
        });
        // Single shapes of the world.
        const auto p = random.point<T>(-1, 1) + center, q = random.point<T>(-1, 1) + center;
        const capsule<T> rod{{p, q}, T(0.25)};
        const sphere<T> ball{p, T(0.5)};
        const auto tree_a = posed(make_bvh(on, a), pose_a);
        std::uint64_t on_rod = 0, on_ball = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            on_rod += intersects<exact>(rod, placed_a[i]);
            on_ball += intersects<exact>(ball, placed_a[i]);
        }
        CHECK(count(on, tree_a, rod) == on_rod);
        CHECK(count(on, tree_a, ball) == on_ball);
        hits += on_rod + on_ball;
    }
    CHECK(hits > 2000);
}

/// Large enough for threads to share a walk through both trees.
TEMPLATE_TEST_CASE("two large trees: threads find what a walk for each triangle finds", "", float, double) {
    using T = TestType;
    const torus<T> shape(240, 120, 2, 1);
    const mesh<T> surface(shape.vertices, shape.faces);
    const auto tree = make_bvh(serial{}, surface);
    for (const T shift : {T(0), T(0.01), T(1.5)}) {
        rigid<T> pose;
        pose.translation = {shift, shift / 2, shift / 4};
        const pair_list expected = to_host(pairs(serial{}, tree, posed(surface, pose)));
        CAPTURE(shift);
        CHECK(expected.size() > 500);
        CHECK(to_host(pairs(serial{}, tree, posed(tree, pose))) == expected);
        for (const int threads : {2, 3, 7}) {
            const openmp on{.threads = threads};
            CHECK(to_host(pairs(on, tree, posed(tree, pose))) == expected);
            CHECK(count(on, tree, posed(tree, pose)) == expected.size());
            CHECK(any(on, tree, posed(tree, pose)));
        }
    }
}

}  // namespace abut::test
