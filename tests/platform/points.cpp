// SPDX-License-Identifier: MIT

// What is nearest to points, and what is around them.

#include <abut/collide/inside.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/winding_number.hpp>
#include <abut/index/bvh.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/shape/hulls.hpp>

#include "questions.hpp"
#include "scenes.hpp"

namespace platform {

namespace {

/// The point of each shape that is nearest to a point, in all families.
template <class S>
void ask_shape(table& to, const char* kind) {
    using T = abut::scalar_type_of<S>;
    if (!to.asks(kind)) return;
    answers point = to.of(kind, name_of<T>, "nearest_point");
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        inputs<T> in(7, i);
        const S s = in.template shape<S>();
        point.next(), point.add(abut::nearest_point(s, in.point()));
    }
}

template <abut::scalar T, class Set>
void ask_tree(table& to, const char* kind, const Set& set_of_family) {
    if (!to.asks(kind)) return;
    const abut::serial on;
    answers one = to.of(kind, name_of<T>, "nearest"), five = to.of(kind, name_of<T>, "nearest_5");
    for (const std::uint64_t family : scene_families) {
        const auto tree = abut::make_bvh(on, set_of_family(family));
        const auto points = shapes_of_family<abut::vec3<T>>(71, family, 300);
        one.add_list(abut::nearest(on, tree, points));
        five.add_list(abut::nearest(on, tree, points, 5));
    }
}

template <class S>
void ask_set(table& to, const char* kind) {
    ask_tree<abut::scalar_type_of<S>>(
        to, kind, [](std::uint64_t family) { return abut::shapes<S>(shapes_of_family<S>(72, family, 80)); });
}

template <abut::scalar T>
void ask_mesh(table& to) {
    if (!to.asks("points-mesh")) return;
    const abut::serial on;
    const auto of = [&](const char* question) { return to.of("points-mesh", name_of<T>, question); };
    answers inside = of("inside"), distance = of("signed_distance"), winding = of("winding_number"),
            winding_all = of("winding_number_0"), posed = of("nearest_posed");
    for (const bool moves : {false, true}) {
        const auto tree = abut::make_bvh(on, cubes<T>(73, 4, moves));
        for (const std::uint64_t family : scene_families) {
            const auto points = shapes_of_family<abut::vec3<T>>(74, family, 200);
            inside.add_list(abut::inside(on, tree, points));
            distance.add_list(abut::signed_distance(on, tree, points));
            winding.add_list(abut::winding_number(on, tree, points));
            winding_all.add_list(abut::winding_number(on, tree, points, {.tolerance = 0}));
            posed.add_list(abut::nearest(on, abut::posed(tree, any_pose<T>(family)), points));
        }
    }
}

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    ask_shape<triangle<T>>(to, "point-of-triangle");
    ask_shape<segment<T>>(to, "point-of-segment");
    ask_shape<sphere<T>>(to, "point-of-sphere");
    ask_shape<capsule<T>>(to, "point-of-capsule");
    ask_shape<cylinder<T>>(to, "point-of-cylinder");
    ask_shape<cone<T>>(to, "point-of-cone");
    ask_shape<aabb<T>>(to, "point-of-box");
    ask_shape<hull<T>>(to, "point-of-hull");
    ask_set<triangle<T>>(to, "points-triangles");
    ask_set<vec3<T>>(to, "points-points");
    ask_set<cylinder<T>>(to, "points-cylinders");
    ask_set<cone<T>>(to, "points-cones");
    ask_mesh<T>(to);
}

}  // namespace

void ask_points(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
