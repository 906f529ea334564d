// SPDX-License-Identifier: MIT
#include <abut/collide/first_sweep.hpp>

#include <cstddef>
#include <vector>

#include <abut/collide/start_contacts.hpp>

#include "collide/moved_cases.hpp"
#include "collide/sweep_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

namespace {

/// Floors and walls, and shapes that go to them and past each other; on lattices with ties, and anywhere.
template <class T, class Policy>
void check_flat_scenes(const Policy& on) {
    test::uniform random(17);
    for (const bool snaps : {false, true}) {
        CAPTURE(snaps);
        std::vector<plane<T>> walls;
        std::vector<half_space<T>> floors;
        std::vector<swept<sphere<T>>> balls;
        std::vector<swept<triangle<T>>> faces;
        const auto at = [&](double far) { return test::on_sweep_lattice(random.point<T>(-far, far), snaps); };
        for (int i = 0; i < 12; ++i) {
            const vec3<T> n = at(2) + vec3<T>{0, 0, T(0.25)}, p = at(3);
            walls.push_back({n, dot(n, p)});
            floors.push_back({n, dot(n, p) - 9 * std::sqrt(dot(n, n))});
        }
        for (int i = 0; i < 60; ++i) {
            const vec3<T> from = at(6), way = i % 9 == 0 ? vec3<T>{0, 0, 0} : at(6);
            balls.push_back({{from, snaps ? static_cast<T>(random.below(3)) / 2 : static_cast<T>(random(0, 0.4))}, way});
            faces.push_back({{from, from + at(0.6), from + at(0.6)}, way});
        }
        const shapes<plane<T>> all_walls(walls);
        const shapes<half_space<T>> all_floors(floors);
        test::check_sweep(on, copy_to(on, all_floors), balls, test::sweeps_by_definition(all_floors.view(), balls));
        test::check_sweep(on, copy_to(on, all_walls), faces, test::sweeps_by_definition(all_walls.view(), faces));
        test::check_sweep(on, make_bvh(on, all_floors), balls, test::sweeps_by_definition(all_floors.view(), balls));
        std::vector<swept<half_space<T>>> presses;
        for (const auto& f : floors) presses.push_back({f, at(6)});
        std::vector<sphere<T>> still;
        for (const auto& b : balls) still.push_back(b.start);
        const spheres<T> rest(still);
        test::check_sweep(on, make_bvh(on, rest), presses, test::sweeps_by_definition(rest.view(), presses));

        const vec3<T> way = at(5);
        test::check_moved_sets<false>(on, rest, all_walls, way);
        test::check_moved_sets<false>(on, rest, all_floors, T(0.25) * way);
        test::check_moved_sets<false>(on, all_floors, rest, way);
        test::draws d(test::sample_seed, 97, snaps ? 1 : 0);
        const rigid<T> pose = test::make_pose<T>(d, 2);
        const posed_view<typename spheres<T>::view_type> posed_rest{rest.view(), pose};
        const auto truth = test::moved_by_definition<false>(posed_rest, all_walls.view(), way, [](std::uint32_t, std::uint32_t) { return true; });
        test::check_moved(on, moving(posed(make_bvh(on, copy_to(on, rest)), pose), way), copy_to(on, all_walls), truth);
    }
}

}  // namespace

TEST_CASE("sweeps of planes and half spaces: serial") { check_flat_scenes<float>(serial{}); }
TEST_CASE("sweeps of planes and half spaces: openmp on 3 threads, in double") { check_flat_scenes<double>(openmp{3}); }

/// Cylinders and cones: what is told does not depend on the index.
TEST_CASE("sweeps of cylinders and cones: serial") {
    const serial on;
    test::uniform random(19);
    for (const bool snaps : {false, true}) {
        CAPTURE(snaps);
        const auto at = [&](double far) { return test::on_sweep_lattice(random.point<float>(-far, far), snaps); };
        std::vector<cylinder<float>> drums;
        std::vector<triangle<float>> faces;
        std::vector<swept<cone<float>>> tips;
        for (int i = 0; i < 40; ++i) {
            const vec3<float> p = at(4), q = at(6);
            const float radius = snaps ? 0.5f * static_cast<float>(random.below(3)) : static_cast<float>(random(0, 0.4));
            drums.push_back({{p, p + at(1)}, radius});
            faces.push_back({p, p + at(1), p + at(1)});
            tips.push_back({{q, q + at(1), radius}, at(6)});
        }
        const triangle_soup<float> soup(faces);
        const cylinders<float> all(drums);
        const auto tree = make_bvh(on, all);
        const auto expected = test::sweeps_by_definition(all.view(), tips);
        test::check_sweep(on, tree, tips, expected);
        test::check_sweep(on, all, tips, expected);
        test::check_sweep(on, quantised(on, tree), tips, expected);
        test::check_sweep(on, wide(on, tree), tips, expected);
        test::check_moved_sets<false>(on, all, soup, at(5));
    }
}

TEST_CASE("sweeps of planes and half spaces: contacts at the start") {
    const serial on;
    const shapes<half_space<float>> floor(std::vector<half_space<float>>{{{0, 0, 2}, 0}});
    const shapes<swept<sphere<float>>> movers{{{{0, 0, 0.75f}, 1}, {1, 0, 0}}, {{{0, 0, 3}, 1}, {0, 0, -4}}};
    const auto found = sweep(on, floor, movers);
    const auto contacts = to_host(start_contacts(on, found, floor, movers));
    REQUIRE(contacts.size() == 2);
    CHECK((contacts[0].b == 0 && contacts[0].depth == 0.25f && contacts[0].normal == vec3<float>{0, 0, 1}));
    CHECK(contacts[1].b == no_id);
}
