// SPDX-License-Identifier: MIT

// What rays and segments meet: first, at all, and in order.

#include <abut/collide/raycast.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/hulls.hpp>

#include "questions.hpp"
#include "scenes.hpp"

namespace platform {

namespace {

/// make(family) is a set; a tree over it is asked with n rays, and the set itself with fewer segments. What takes long has
/// fewer rays.
template <abut::scalar T, class Make>
void ask_set(table& to, const char* kind, std::uint64_t n, const Make& make) {
    if (!to.asks(kind)) return;
    const abut::serial on;
    // Of each way to meet something one kind of shape is asked all.
    using set_type = decltype(make(0));
    constexpr bool all_is_asked = std::same_as<set_type, abut::mesh<T>> || std::same_as<set_type, abut::capsules<T>> ||
                                  std::same_as<set_type, abut::hulls<T>>;
    answers first = to.of(kind, name_of<T>, "raycast"), any = to.of(kind, name_of<T>, "raycast_any"),
            all = to.of(kind, name_of<T>, "raycast_all"), segments = to.of(kind, name_of<T>, "raycast_segments");
    for (const std::uint64_t family : scene_families) {
        const auto set = make(family);
        const auto tree = abut::make_bvh(on, set);
        const abut::rays<T> rays(shapes_of_family<abut::ray<T>>(91, family, n));
        first.add_list(abut::raycast(on, tree, rays));
        if constexpr (all_is_asked) {
            any.add_list(abut::raycast_any(on, tree, rays));
            all.add_list(abut::raycast_all(on, tree, rays));
            segments.add_list(
                abut::raycast(on, set, abut::segments<T>(shapes_of_family<abut::segment<T>>(92, family, n / 8))));
        }
    }
}

template <class S>
auto set_of(std::uint64_t stream) {
    return [stream](std::uint64_t family) { return abut::shapes<S>(shapes_of_family<S>(stream, family, 60)); };
}

template <abut::scalar T>
void ask(table& to) {
    ask_set<T>(to, "rays-triangles", 2000, set_of<abut::triangle<T>>(93));
    ask_set<T>(to, "rays-spheres", 1000, set_of<abut::sphere<T>>(94));
    ask_set<T>(to, "rays-boxes", 2000, set_of<abut::aabb<T>>(95));
    ask_set<T>(to, "rays-capsules", 150, set_of<abut::capsule<T>>(96));
    ask_set<T>(to, "rays-cylinders", 250, set_of<abut::cylinder<T>>(97));
    ask_set<T>(to, "rays-cones", 200, set_of<abut::cone<T>>(98));
    ask_set<T>(to, "rays-hulls", 64, [](std::uint64_t family) {
        std::vector<std::vector<abut::vec3<T>>> lists;
        for (std::uint64_t i = 0; i < 60; ++i) {
            lists.push_back(shapes_of_family<abut::vec3<T>>(200 + i, family, 1 + i % 12));
        }
        return abut::hulls<T>(lists);
    });
    ask_set<T>(to, "rays-mesh", 1000, [](std::uint64_t family) { return cubes<T>(99, 4, family % 2 == 0); });
}

}  // namespace

void ask_rays(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
