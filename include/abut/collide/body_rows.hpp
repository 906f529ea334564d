// SPDX-License-Identifier: MIT
#pragma once

// Bodies that points and lines ask (row_questions.hpp): a walk through the tree over the boxes around bodies, and from each
// box that is reached through the body's own tree. What is kept has the body's number above the shape's id, so that of
// equals the least body comes first, and of one body the least id: the answer is the best of what each body says alone.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/collide/bodies.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/placed.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/index/ties.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/traverse/ordered_walk.hpp>

namespace abut::detail {

/// What a point in the world sees of bodies: the boxes around them, and each in its own frame.
template <scalar T>
struct ball_to_bodies : shrinking_ball<T> {
    template <class Tree>
    [[nodiscard]] ABUT_HD shrinking_ball<T> seen_by(const rigid<T>& pose, const aabb<T>& box) const {
        return object_frame<T>(this->map.unit, pose, box).ball_around(this->center);
    }
};
template <scalar T>
struct frame_of_bodies : world_frame<T> {
    [[nodiscard]] ABUT_HD ball_to_bodies<T> ball_around(const vec3<T>& p) const { return {world_frame<T>::ball_around(p)}; }
};
/// And a line.
template <scalar T>
struct line_to_bodies : ray_reach<T> {
    line_in_frame<T> line;

    line_to_bodies() = default;
    ABUT_HD explicit line_to_bodies(const line_in_frame<T>& l) : ray_reach<T>(l), line(l) {}
    template <class Tree>
    [[nodiscard]] ABUT_HD auto seen_by(const rigid<T>& pose, const aabb<T>& box) const {
        const object_frame<T> frame(1, pose, box);
        return line_reach_of<ordered_tree_walk<Tree>, T>(line_seen(frame, line.origin, line.direction, line.last));
    }
};

/// A walk through the tree over bodies, and through those of the bodies that are reached.
template <class Index>
struct ordered_body_walk {
    using T = typename Index::scalar_type;
    using tree_of_boxes = typename body_state<Index>::tree_type::view_type;
    using tree_of_body = typename Index::view_type;

    tree_of_boxes boxes;
    const std::uint32_t* with_shapes;
    placed_view<Index> all;
    const std::vector<Index>* objects;  ///< on a host
    ties_of_objects* ties = nullptr;  ///< on a host

    ABUT_CALLS_ANY
    template <class Reach, class Best, class Visitor>
    ABUT_HD void operator()(Reach& reach, Best& best, const Visitor& visitor) const {
        ordered_tree_walk<tree_of_boxes>{boxes}(reach, best, [&](std::uint32_t k) {
            const std::uint32_t body = with_shapes[k];
            const placed_object<Index>& object = all.object(body);
            auto inside = reach.template seen_by<tree_of_body>(all.poses[body], object.bounds);
            const auto visit = [&](std::uint32_t id) { return visitor(body_key(body, id)); };
            if constexpr (std::same_as<typename Index::memory_space, host_space>) {
                if (ties != nullptr) {
                    ties_of_body<placed_object<Index>> watch{*ties, all.object_of[body], object, body_key(body, 0)};
                    ordered_tree_walk<tree_of_body, decltype(watch)>{object.tree, &watch}(inside, best, visit);
                    return;
                }
            }
            ordered_tree_walk<tree_of_body>{object.tree}(inside, best, visit);
        });
    }
    /// The next copies of the shapes of an object, if walks pass over these.
    [[nodiscard]] const std::uint32_t* copies_with(std::uint64_t key) const {
        const std::uint32_t k = all.object_of[body_of_key(key)];
        return ties != nullptr && ties->is_known(k) ? ties->known(k).copies : nullptr;
    }
};
template <class Index>
struct id_in_walk<ordered_body_walk<Index>> {
    using type = std::uint64_t;
};
template <class Index, scalar T>
struct line_reach<ordered_body_walk<Index>, T> {
    using type = line_to_bodies<T>;
};

struct watch_of_bodies : ties_of_objects {
    template <class Index>
    watch_of_bodies(bool chains, ordered_body_walk<Index>& walk) : ties_of_objects(*walk.objects, chains) {
        walk.ties = this;
    }
};
template <class Policy, bool Alike, class Index, class Asked>
auto watch_ties(std::size_t, [[maybe_unused]] bool chains, [[maybe_unused]] ordered_body_walk<Index>& walk, const Asked&) {
    if constexpr (host_policy<Policy> && Alike) {
        return watch_of_bodies(chains, walk);
    } else {
        return 0;
    }
}

/// All shapes of bodies, by their keys.
template <class Index>
struct shapes_of_bodies {
    using scalar_type = typename Index::scalar_type;
    using shape_type = shape_in_world<Index>;
    using memory_space = typename Index::memory_space;

    placed_view<Index> all;
    std::size_t bodies;  ///< that have shapes

    [[nodiscard]] ABUT_HD std::size_t size() const { return bodies; }  ///< 0 where there is none to ask
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t key) const {
        const std::uint32_t body = body_of_key(key);
        return all.shape(body, all.object_of[body], static_cast<std::uint32_t>(key));
    }
};

/// Bodies as what rows ask. They are no operand of pairs (body_pairs.hpp).
template <class Index>
struct asked_bodies {
    static constexpr bool is_indexed = true, has_tree = false, is_posed = false;
    bodies<Index> of;

    [[nodiscard]] const body_state<Index>& state() const { return parts_of_bodies::of(of); }
    [[nodiscard]] shapes_of_bodies<Index> shapes() const { return {state().placed.view(), state().tree.size()}; }
};
template <class Index>
struct id_in_operand<asked_bodies<Index>> {
    using type = body_and_id;
};
template <class Index>
ordered_body_walk<Index> ordered_walk_of(const asked_bodies<Index>& x) {
    const auto& placed = x.state().placed;
    return {x.state().tree.view(), x.state().with_shapes->data(), placed.view(), &placed.objects->indices};
}
template <class Index, scalar T>
frame_of_bodies<T> frame_of(const asked_bodies<Index>&, const length_unit<T>& unit) {
    return {{unit.length(1)}};
}
/// Of bodies and of points.
template <class Policy, class Index, shape_view Points>
double largest_coordinate(const Policy& on, const asked_bodies<Index>& x, const Points& points) {
    const auto& tree = x.state().tree;
    return greatest(largest_coordinate(on, points), tree.size() == 0 ? 0.0 : largest_coordinate(tree.bounds()));
}

template <class Index>
inline constexpr bool is_bodies<bodies<Index>> = true;
template <class Index>
inline constexpr bool is_bodies<std::vector<posed_object<Index>>> = true;
template <class Index>
struct shape_of_argument<bodies<Index>> {
    using type = shape_in_world<Index>;
};
template <class Index>
struct shape_of_argument<std::vector<posed_object<Index>>> {
    using type = shape_in_world<Index>;
};
template <class Policy, class Index, class Question>
auto make_asked(const Policy& on, const bodies<Index>& all, const Question& question) {
    require_same_device(on, all, question.function);
    return asked_bodies<Index>{all};
}
template <class Policy, class Index, class Question>
auto make_asked(const Policy& on, const std::vector<posed_object<Index>>& list, const Question& question) {
    return asked_bodies<Index>{bodies_of(on, list, question.function)};
}

}  // namespace abut::detail
