// SPDX-License-Identifier: MIT

// Lists of posed pairs and scenes of many bodies.

#include <abut/collide/bodies.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/list_distance.hpp>
#include <abut/collide/within.hpp>
#include <abut/index/bvh.hpp>

#include "questions.hpp"
#include "scenes.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    if (!to.asks("many-bodies")) return;
    const abut::serial on;
    const auto of = [&](const char* question) { return to.of("many-bodies", name_of<T>, question); };
    answers pairs = of("pairs"), contacts = of("contacts"), near = of("within"), moved = of("refit"),
            list_pairs = of("list_pairs"), list_contacts = of("list_contacts"), list_distance = of("list_distance"),
            list_near = of("list_within");
    using index = decltype(abut::make_bvh(on, cubes<T>(51, 2, true)));
    const std::vector<index> indices{abut::make_bvh(on, cubes<T>(51, 2, true)), abut::make_bvh(on, cubes<T>(52, 2, false))};
    std::vector<std::uint32_t> which;
    std::vector<abut::rigid<T>> poses, later;
    for (std::uint64_t k = 0; k < 10; ++k) {
        which.push_back(static_cast<std::uint32_t>(k % 2));
        poses.push_back(any_pose<T>(k));
        later.push_back(any_pose<T>(k + 100));
    }
    const auto bodies = abut::make_bodies(on, indices, which, poses);
    pairs.add_list(abut::pairs(on, bodies));
    contacts.add_list(abut::contacts(on, bodies));
    near.add_list(abut::within(on, bodies, 0.125));
    moved.add_list(abut::pairs(on, abut::refit(on, bodies, later)));
    std::vector<abut::posed_pair<index>> list;
    for (std::uint64_t k = 0; k < 40; ++k) {
        list.push_back({abut::posed(indices[k % 2], any_pose<T>(k)), abut::posed(indices[k / 2 % 2], any_pose<T>(k + 50))});
    }
    list_pairs.add_list(abut::pairs(on, list));
    list_contacts.add_list(abut::contacts(on, list));
    list_distance.add_list(abut::distance(on, list));
    list_near.add_list(abut::within(on, list, 0.125));
}

}  // namespace

void ask_bodies(table& to) {
    ask<double>(to);  // one scalar type: this takes long to compile, and what is between boxes and shapes is the same
}

}  // namespace platform
