// SPDX-License-Identifier: MIT

// Whole queries of two sets and of one: pairs, contacts, distances, posed and not, over trees and a grid.

#include <abut/collide/contacts.hpp>
#include <abut/collide/distance.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/reduce_contacts.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/validate.hpp>
#include <abut/collide/within.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>

#include "questions.hpp"
#include "scenes.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask_two(table& to) {
    if (!to.asks("two-meshes")) return;
    const abut::serial on;
    const auto of = [&](const char* question) { return to.of("two-meshes", name_of<T>, question); };
    answers pairs = of("pairs"), contacts = of("contacts"), few = of("reduce_contacts"), distance = of("distance"),
            near = of("within"), balls = of("mesh-spheres"), grid = of("mesh-grid");  // the last two in float alone
    for (std::uint64_t k = 0; k < 12; ++k) {
        const auto a = abut::make_bvh(on, cubes<T>(31, 4, k % 2 == 0)),
                   b = abut::make_bvh(on, cubes<T>(32 + k % 3, 3, k % 4 < 2));
        auto pose = any_pose<T>(k);
        if (k == 11) pose.translation.x = 40;
        const auto there = abut::posed(b, pose);
        pairs.add_list(abut::pairs(on, a, there));
        const auto found = abut::contacts(on, a, there);
        contacts.add_list(found);
        few.add_list(abut::reduce_contacts(on, found, {.most = 8}));
        const auto apart = abut::distance(on, a, there);
        distance.next(), distance.add(apart->distance == 0), distance.add_members(*apart);
        if (k < 4) near.add_list(abut::within(on, a, there, 0.25));
        if constexpr (std::same_as<T, float>) {
            const abut::spheres<T> spheres(shapes_of_family<abut::sphere<T>>(35, scene_families[k % 6], 200));
            balls.add_list(abut::pairs(on, a, spheres));
            grid.add_list(abut::pairs(on, a, abut::make_grid(on, spheres)));
        }
    }
}

template <abut::scalar T>
void ask_one(table& to) {
    if (!to.asks("one-set")) return;
    const abut::serial on;
    const auto of = [&](const char* question) { return to.of("one-set", name_of<T>, question); };
    answers self = of("self_pairs"), spheres = of("self_pairs_spheres"), near = of("self_within"), report = of("validate");
    for (std::uint64_t k = 0; k < 6; ++k) {
        const auto mesh = sheet<T>(41, k + 1, 12, k % 2 == 1);
        self.add_list(abut::self_pairs(on, abut::make_bvh(on, mesh)));
        const auto balls =
            abut::make_bvh(on, abut::spheres<T>(shapes_of_family<abut::sphere<T>>(42, scene_families[k], 100)));
        spheres.add_list(abut::self_pairs(on, balls));
        near.add_list(abut::self_within(on, balls, 0.5));
        const auto r = abut::validate(on, mesh);
        report.next(), report.add(r.edges), report.add(std::uint64_t{r.boundary_edges.size()}),
            report.add(std::uint64_t{r.zero_area_faces.size()});
    }
}

}  // namespace

void ask_meshes(table& to) {
    ask_two<float>(to), ask_two<double>(to);
    ask_one<float>(to);
}

}  // namespace platform
