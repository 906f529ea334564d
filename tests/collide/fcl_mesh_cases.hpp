// SPDX-License-Identifier: MIT
#pragma once

// FCL's trees of two meshes against pairs of two trees on every policy, in double and in general position: a pair on which
// they differ is left out, and counted, if moving one triangle by `margin` changes the exact answer, since FCL is wrong in
// exact contact.

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <vector>

#include <abut/io/read.hpp>

#include "collide/mesh_cases.hpp"
#include "io/support.hpp"
#include "support/catch.hpp"
#include "support/fcl_model.hpp"

namespace abut::test {

namespace fcl_runs {

struct comparison {
    int scenes = 0, meet = 0, apart = 0;  // apart: whose distance was compared
    std::size_t hits = 0, near_contact = 0, wrong = 0;

    void print(const char* name) const {
        std::printf("FCL, %s: %d scenes, %d meet, %zu pairs; %zu in near contact left out\n", name, scenes, meet, hits,
                    near_contact);
    }
};

inline bool is_near_contact(const triangle<double>& a, const triangle<double>& b, double margin) {
    const bool now = intersects<exact>(a, b);
    for (const double step : {-margin, margin}) {
        for (const vec3<double>& v : {vec3<double>{step, 0, 0}, vec3<double>{0, step, 0}, vec3<double>{0, 0, step}}) {
            if (intersects<exact>(a, triangle<double>{b.a + v, b.b + v, b.c + v}) != now) return true;
        }
    }
    return false;
}

/// `a` where it is and `b` under a pose, which FCL gets in its vertices.
template <class Policy>
void compare(const Policy& on, const mesh<double>& a, const fcl_model& model_a, const mesh<double>& b,
             const rigid<double>& pose, double margin, comparison& all) {
    const fcl_model model_b = make_fcl_model(b.view(), pose);
    const std::vector<index_pair> theirs = fcl_pairs(model_a, model_b);
    const auto tree_a = make_bvh(on, a), tree_b = make_bvh(on, b);
    const auto ours = to_host(pairs(on, tree_a, posed(tree_b, pose)));
    std::vector<index_pair> differing;
    std::set_symmetric_difference(ours.begin(), ours.end(), theirs.begin(), theirs.end(), std::back_inserter(differing));
    for (const index_pair& p : differing) {
        const bool is_near = is_near_contact(a.view()[p.a], place(pose, b.view()[p.b]), margin);
        ++(is_near ? all.near_contact : all.wrong);
    }
    if constexpr (std::same_as<Policy, serial>) {
        const auto apart = distance(on, tree_a, posed(tree_b, pose));
        CHECK((apart->distance == 0) == !ours.empty());
        if (ours.empty() && theirs.empty()) {
            ++all.apart;
            CHECK(apart->distance == Approx(fcl_distance(model_a, model_b)).epsilon(1e-7));
        }
    }
    ++all.scenes;
    all.meet += theirs.empty() ? 0 : 1;
    all.hits += theirs.size();
}

/// How often `b` is put somewhere in a box around `a`, and what has to come of it for the comparison to mean something.
struct poses {
    std::uint64_t seed, count;
    vec3<double> lower, upper;
    double margin;
    int least_that_meet;
    std::size_t least_hits;
};

template <class Policy>
comparison compare_under(const Policy& on, const poses& all, const char* name, const mesh<double>& a,
                         const mesh<double>& b) {
    comparison sum;
    const fcl_model model = make_fcl_model(a.view());
    for (std::uint64_t k = 0; k < all.count; ++k) {
        compare(on, a, model, b, pose_within<double>(all.seed, k, all.lower, all.upper), all.margin, sum);
    }
    sum.print(name);
    CHECK(sum.meet > all.least_that_meet);
    CHECK(sum.hits > all.least_hits);
    CHECK(sum.near_contact * 1000 <= sum.hits);
    CHECK(sum.wrong == 0);
    return sum;
}

}  // namespace fcl_runs

/// FCL finds the same pairs in general position.
template <class Policy>
void check_fcl_shapes(const Policy& on) {
    const torus<double> ring(48, 24, 2, 0.7);
    fcl_runs::compare_under(on, {20261201, 60, {-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}, 1e-9, 40, 6000}, "torus and ball",
                            {ring.vertices, ring.faces}, as_mesh(ball_surface<double>(4, 1.5)));
}

/// And of its own robot and room, and of two scans.
template <class Policy>
void check_fcl_files(const Policy& on) {
    const auto folder = io_test::meshes();
    if (!folder) ABUT_SKIP("data", "the folder of real meshes is not there (ABUT_DATA)");
    const auto env = io::read_mesh<double>(*folder / "env.obj"), rob = io::read_mesh<double>(*folder / "rob.obj");
    const fcl_runs::comparison all = fcl_runs::compare_under(
        on, {20261202, 400, {-3000, -3000, 0}, {3000, 3000, 3000}, 1e-6, 100, 5000}, "env.obj and rob.obj", env, rob);
    CHECK(all.meet < all.scenes);
    if constexpr (std::same_as<Policy, serial>) CHECK(all.apart > 20);
    const auto scan = io::read_mesh<double>(*folder / "armadillo_2766.ply");
    fcl_runs::compare_under(on, {20261203, 40, {-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}, 1e-9, 20, 5000}, "armadillo_2766.ply",
                            scan, scan);
}

}  // namespace abut::test
