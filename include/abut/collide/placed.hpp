// SPDX-License-Identifier: MIT
#pragma once

// Bodies as kernels see them: each is an index under a pose, and many share an index. The views of distinct indices lie in
// the policy's memory once; a body has a number among them and a pose. Lists of pairs (list.hpp) and scenes (bodies.hpp)
// consist of such bodies. Poses are checked here, where they lie.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/shape/posed.hpp>

namespace abut::detail {

template <class Index>
inline constexpr bool is_tree = false;
template <class Set, memory_space Space, class Layout>
inline constexpr bool is_tree<bvh<Set, Space, Layout>> = true;

/// Whether bodies can be of all these indices.
template <class Policy, class Index, class... More>
consteval bool can_be_listed() {
    // Of a const index posed_pair or posed_object has said what is wrong.
    static_assert(is_tree<Index> || std::is_const_v<Index>,
                  "abut: a list of pairs or of bodies holds indices made by make_bvh");
    if constexpr (!is_tree<Index>) {
        return false;
    } else if constexpr (!lies_there<Policy, Index>()) {
        return false;
    } else if constexpr (sizeof...(More) > 0) {
        return can_be_listed<Policy, More...>();
    } else {
        return true;
    }
}

/// What kernels see of an index.
template <class Index>
struct placed_object {
    using tree_view = typename Index::view_type;
    using shapes_view = decltype(view_of(std::declval<const Index&>().set()));

    tree_view tree;
    shapes_view shapes;
    aabb<typename Index::scalar_type> bounds;  ///< of all shapes; empty where there are none
};

template <class Index>
placed_object<Index> as_object(const Index& index) {
    return {index.view(), view_of(index.set()), index.bounds()};
}

/// What the shapes of an index are under a pose.
template <class Index>
using shape_in_world = placed_shape<typename Index::shape_type>;

/// What kernels see of bodies.
template <class Index>
struct placed_view {
    using object_type = placed_object<Index>;
    using shape_type = shape_in_world<Index>;

    const object_type* objects;
    const std::uint32_t* object_of;  ///< of each body
    const rigid<typename Index::scalar_type>* poses;

    [[nodiscard]] ABUT_HD const object_type& object(std::uint32_t body) const { return objects[object_of[body]]; }
    /// A shape of a body, of which the number of the object is known.
    [[nodiscard]] ABUT_HD shape_type shape(std::uint32_t body, std::uint32_t object, std::uint32_t id) const {
        return place(poses[body], objects[object].shapes[id]);
    }
};

/// All of bodies but their poses.
template <class Index>
struct placed_objects {
    using Space = typename Index::memory_space;

    std::vector<Index> indices;
    execution::buffer<placed_object<Index>, Space> objects;  ///< of the indices
    execution::buffer<std::uint32_t, Space> object_of;       ///< of each body
    std::size_t most_shapes = 0;                             ///< of a body
    bool all_have_nodes = true;                              ///< no tree has fewer than two shapes
};

/// Bodies in the policy's memory. Copies share it.
template <class Index>
struct placed_bodies {
    using pose_buffer = execution::buffer<rigid<typename Index::scalar_type>, typename Index::memory_space>;

    std::shared_ptr<const placed_objects<Index>> objects;
    std::shared_ptr<const pose_buffer> poses;

    [[nodiscard]] std::size_t size() const { return poses->size(); }
    [[nodiscard]] placed_view<Index> view() const {
        return {objects->objects.data(), objects->object_of.data(), poses->data()};
    }
};

/// Bodies on the host, on their way to the policy's memory. Indices that share their nodes are one.
template <class Index>
struct gathered_bodies {
    std::vector<Index> indices;
    std::vector<std::uint32_t> object_of;
    std::vector<rigid<typename Index::scalar_type>> poses;

    /// By numbers of indices, which are in range.
    gathered_bodies(std::vector<Index> of, std::span<const std::uint32_t> index_of,
                    std::span<const rigid<typename Index::scalar_type>> at)
        : indices(std::move(of)), object_of(index_of.begin(), index_of.end()), poses(at.begin(), at.end()) {}
    /// Of `n` bodies, by body(i).
    template <class Body>
    gathered_bodies(std::size_t n, const Body& body) {
        std::unordered_map<const void*, std::uint32_t> known;
        object_of.reserve(n);
        poses.reserve(n);
        for (std::size_t i = 0; i < n; ++i) {
            const posed_object<Index>& one = body(i);
            const auto [at, fresh] = known.try_emplace(&one.object.stored(), static_cast<std::uint32_t>(indices.size()));
            if (fresh) indices.push_back(one.object);
            object_of.push_back(at->second);
            poses.push_back(one.pose);
        }
    }
};

/// The views of indices in the policy's memory, and which body has which; throws where an index lies on another device. The
/// numbers are below that of the indices.
template <class Policy, class Index>
std::shared_ptr<const placed_objects<Index>> make_objects(const Policy& on, std::vector<Index> indices,
                                                          const std::vector<std::uint32_t>& object_of,
                                                          const char* function) {
    auto made = std::make_shared<placed_objects<Index>>();
    std::vector<placed_object<Index>> views;
    views.reserve(indices.size());
    for (const Index& index : indices) {
        require_same_device(on, index, function);
        views.push_back(as_object(index));
        made->most_shapes = std::max(made->most_shapes, index.size());
        made->all_have_nodes = made->all_have_nodes && index.size() > 1;
    }
    made->indices = std::move(indices);
    made->objects = execution::buffer_of<Policy, placed_object<Index>>(on, views.size());
    upload(on, views.data(), views.size(), made->objects.data());
    made->object_of = execution::buffer_of<Policy, std::uint32_t>(on, object_of.size());
    upload(on, object_of.data(), object_of.size(), made->object_of.data());
    synchronize(on);  // until then the host's memory is read
    return made;
}

/// Whether a pose may be refused, or may place a shape beyond the largest number. Where this says no, it is certain.
template <class Index>
struct may_be_refused {
    placed_view<Index> all;
    ABUT_HD bool operator()(std::size_t i) const {
        const auto body = static_cast<std::uint32_t>(i);
        const auto& object = all.object(body);
        return !is_surely_rigid(all.poses[body]) ||
               (object.tree.size() > 0 && !stays_finite(all.poses[body], object.bounds));
    }
};

/// Throws for the first body whose pose is none, or where its shapes overflow; `name(i)` is its name.
template <class Policy, class Index, class Name>
void check_poses(const Policy& on, const placed_bodies<Index>& bodies, const char* function, const Name& name) {
    const placed_view<Index> all = bodies.view();
    execution::buffer_of<Policy, std::uint32_t> which(on, bodies.size());
    const std::size_t n = compact(on, bodies.size(), may_be_refused<Index>{all}, which.data());
    std::vector<std::uint32_t> suspects(n);
    download(on, which.data(), n, suspects.data());
    for (const std::uint32_t i : suspects) {
        rigid<typename Index::scalar_type> pose;
        std::uint32_t object = 0;
        download(on, all.poses + i, 1, &pose);
        download(on, all.object_of + i, 1, &object);
        const Index& index = bodies.objects->indices[object];
        const std::string where = std::string(function) + ": " + name(i);
        check(pose, where);
        if (index.size() == 0 || stays_finite(pose, index.bounds())) continue;
        using shapes = typename placed_object<Index>::shapes_view;
        check(on, posed_view<shapes>{view_of(index.set()), pose}, where.c_str());
    }
}

/// Bodies in the policy's memory, checked.
template <class Policy, class Index, class Name>
placed_bodies<Index> place_bodies(const Policy& on, gathered_bodies<Index> from, const char* function, const Name& name) {
    using poses = typename placed_bodies<Index>::pose_buffer;
    poses there(on, from.poses.size());
    upload(on, from.poses.data(), from.poses.size(), there.data());
    placed_bodies<Index> placed{make_objects(on, std::move(from.indices), from.object_of, function),
                                std::make_shared<const poses>(std::move(there))};
    check_poses(on, placed, function, name);
    return placed;
}

}  // namespace abut::detail
