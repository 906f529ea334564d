// SPDX-License-Identifier: MIT
#pragma once

// bodies: many posed indices as one argument of queries, with a tree over the boxes around them that is refitted as they
// move. What is asked of them is in body_pairs.hpp.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/placed.hpp>
#include <abut/error.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/quality.hpp>
#include <abut/index/refit.hpp>
#include <abut/shape/box_measure.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/shape/view.hpp>

namespace abut {

namespace detail {

struct parts_of_bodies;

/// What a `bodies` shares with its copies.
template <class Index>
struct body_state {
    using T = typename Index::scalar_type;
    using Space = typename Index::memory_space;
    using tree_type = bvh<boxes_view<T, Space>, Space>;

    placed_bodies<Index> placed;
    std::shared_ptr<const execution::buffer<std::uint32_t, Space>> with_shapes;  ///< bodies that have some, ascending
    execution::buffer<aabb<T>, Space> boxes;                                     ///< around these in the world
    tree_type tree;                                                              ///< over the boxes
    bvh_quality when_built;                                                      ///< surfaces alone
};

}  // namespace detail

/// @addtogroup many_bodies
///@{

/// Poses in an array of the caller's in the policy's memory, as `refit` takes them. Not copied until then.
template <scalar T, memory_space Space = host_space>
struct poses_view {
    const rigid<T>* first = nullptr;  ///< of `count` in a row
    std::size_t count = 0;            ///< one for each body
};

/// Many posed indices in the policy's memory, and a tree over the boxes around them in the world. Made by make_bodies;
/// `refit` brings it to other poses. `Index` is what make_bvh makes. The views of the indices are kept once, and 52 bytes a
/// body beside them in float, and some 90 for the tree. Immutable; copies share everything, and any number of threads may
/// query it.
template <class Index>
class bodies {
public:
    using index_type = Index;                                  ///< what bodies are of
    using scalar_type = typename Index::scalar_type;           ///< float or double
    using memory_space = typename Index::memory_space;         ///< where the memory lies
    using boxes_type = boxes_view<scalar_type, memory_space>;  ///< boxes around bodies
    using tree_type = bvh<boxes_type, memory_space>;           ///< over those

    /// Number of bodies.
    [[nodiscard]] std::size_t size() const { return state_->placed.size(); }
    /// The indices, which bodies may share.
    [[nodiscard]] const std::vector<Index>& indices() const { return state_->placed.objects->indices; }
    /// The tree over the boxes of all bodies that have shapes, in their order. `quality` says how good it is.
    [[nodiscard]] const tree_type& tree() const { return state_->tree; }
    /// The CUDA device that the bodies lie on; -1 for the host.
    [[nodiscard]] int device() const { return state_->placed.poses->device(); }

private:
    friend struct detail::parts_of_bodies;
    explicit bodies(std::shared_ptr<const detail::body_state<Index>> state) : state_(std::move(state)) {}

    std::shared_ptr<const detail::body_state<Index>> state_;
};

///@}

namespace detail {

/// What queries see of bodies.
struct parts_of_bodies {
    template <class Index>
    static const body_state<Index>& of(const bodies<Index>& all) {
        return *all.state_;
    }
    template <class Index>
    static bodies<Index> make(body_state<Index> state) {
        return bodies<Index>(std::make_shared<const body_state<Index>>(std::move(state)));
    }
};

template <class Index>
struct has_shapes {
    placed_view<Index> all;
    ABUT_HD bool operator()(std::size_t i) const { return all.object(static_cast<std::uint32_t>(i)).tree.size() > 0; }
};

/// Boxes around placed bodies, which have shapes. Sets hold finite boxes; cut off at the largest numbers, boxes that overlap
/// still do.
template <class Index>
struct write_world_boxes {
    using T = typename Index::scalar_type;
    placed_view<Index> all;
    const std::uint32_t* with_shapes;
    aabb<T>* boxes;
    ABUT_HD void operator()(std::size_t i) const {
        constexpr T far = largest_finite<T>;
        const std::uint32_t body = with_shapes[i];
        const aabb<T> box = world_box(all.poses[body], all.object(body).bounds);
        boxes[i] = {greatest(box.lower, vec3<T>{-far, -far, -far}), least(box.upper, vec3<T>{far, far, far})};
    }
};

/// Of all boxes of a tree, the root's too, and of that alone.
struct surfaces {
    double all = 0, root = 0;
};
struct add_surfaces {
    ABUT_HD surfaces operator()(const surfaces& a, const surfaces& b) const { return {a.all + b.all, a.root + b.root}; }
};
/// Of the root (0) and of both children of each node.
template <bvh_layout Tree>
struct surfaces_of_node {
    Tree tree;
    ABUT_HD surfaces operator()(std::size_t i) const {
        if (i == 0) {
            const double root = surface(tree.root_bounds());
            return {root, root};
        }
        const auto node = tree.fetch(static_cast<std::uint32_t>(i - 1));
        return {surface(tree.bounds(node, 0)) + surface(tree.bounds(node, 1)), 0};
    }
    ABUT_HD static double surface(const aabb<typename Tree::scalar_type>& box) {
        return half_surface(half_sides<double>(box));
    }
};

/// What needs_rebuild asks for, measured where the tree lies. Numbers that overflow compare as better.
template <class Policy, class Tree>
bvh_quality surfaces_of(const Policy& on, const Tree& tree) {
    const auto view = tree.view();
    const surfaces sum = tree.size() == 0 ? surfaces{}
                                          : reduce(on, tree.size(), surfaces{}, add_surfaces{},
                                                   surfaces_of_node<std::remove_const_t<decltype(view)>>{view});
    return {.sah_cost = sum.all / sum.root, .surface = 8 * sum.all};
}

/// Boxes around bodies that have been checked.
template <class Policy, class Index>
auto box_bodies(const Policy& on, const placed_bodies<Index>& placed,
                const execution::buffer<std::uint32_t, space_of<Policy>>& with_shapes) {
    using T = typename Index::scalar_type;
    execution::buffer_of<Policy, aabb<T>> boxes(on, with_shapes.size());
    for_each_index(on, boxes.size(), write_world_boxes<Index>{placed.view(), with_shapes.data(), boxes.data()});
    return boxes;
}

/// Bodies that have been checked, with a new tree.
template <class Policy, class Index>
bodies<Index> build_bodies(const Policy& on, placed_bodies<Index> placed,
                           std::shared_ptr<const execution::buffer<std::uint32_t, space_of<Policy>>> with_shapes,
                           execution::buffer_of<Policy, aabb<typename Index::scalar_type>> boxes) {
    const typename bodies<Index>::boxes_type view(boxes.data(), boxes.size());
    auto tree = make_bvh(on, view);
    const bvh_quality quality = surfaces_of(on, tree);
    return parts_of_bodies::make<Index>(
        {std::move(placed), std::move(with_shapes), std::move(boxes), std::move(tree), quality});
}
template <class Policy, class Index>
bodies<Index> build_bodies(const Policy& on, placed_bodies<Index> placed) {
    using numbers = execution::buffer_of<Policy, std::uint32_t>;
    numbers with_shapes(on, placed.size());
    with_shapes.shrink(compact(on, placed.size(), has_shapes<Index>{placed.view()}, with_shapes.data()));
    auto boxes = box_bodies(on, placed, with_shapes);
    return build_bodies<Policy, Index>(on, std::move(placed), std::make_shared<const numbers>(std::move(with_shapes)),
                                       std::move(boxes));
}

inline std::string name_of_body(std::size_t i) { return "body " + std::to_string(i); }

/// Of a list, in the name of `function`; `name(i)` is that of a body.
template <class Policy, class Index, class Name = decltype(&name_of_body)>
bodies<Index> bodies_of(const Policy& on, const std::vector<posed_object<Index>>& list, const char* function,
                        const Name& name = name_of_body) {
    check_count(list.size(), function);
    const auto body = [&](std::size_t i) -> const posed_object<Index>& { return list[i]; };
    return build_bodies(on, place_bodies(on, gathered_bodies<Index>(list.size(), body), function, name));
}

/// Bodies under other poses, with the refitted tree.
template <class Index>
struct moved_bodies {
    body_state<Index> state;
    bool wants_new_tree;
};
/// The same bodies under poses in the policy's memory, which are not checked yet.
template <class Policy, class Index, class Name = decltype(&name_of_body)>
moved_bodies<Index> move_bodies(const Policy& on, const bodies<Index>& all,
                                execution::buffer_of<Policy, rigid<typename Index::scalar_type>> poses,
                                const Name& name = name_of_body) {
    using state = body_state<Index>;
    const state& old = parts_of_bodies::of(all);
    placed_bodies<Index> placed{old.placed.objects,
                                std::make_shared<const typename placed_bodies<Index>::pose_buffer>(std::move(poses))};
    check_poses(on, placed, "abut::refit", name);
    auto boxes = box_bodies(on, placed, *old.with_shapes);
    const box_view<typename state::T, typename state::Space> shapes{boxes.data(), boxes.size()};
    typename state::tree_type tree({boxes.data(), boxes.size()}, refit_storage(on, old.tree.stored(), shapes));
    const bool is_worse = needs_rebuild(old.when_built, surfaces_of(on, tree));
    return {{std::move(placed), old.with_shapes, std::move(boxes), std::move(tree), old.when_built}, is_worse};
}
/// And from host memory.
template <class Policy, class Index>
moved_bodies<Index> move_bodies(const Policy& on, const bodies<Index>& all,
                                std::span<const rigid<typename Index::scalar_type>> poses) {
    execution::buffer_of<Policy, rigid<typename Index::scalar_type>> there(on, poses.size());
    upload(on, poses.data(), poses.size(), there.data());
    return move_bodies(on, all, std::move(there));
}
template <class Policy, class Index>
bodies<Index> settle_bodies(const Policy& on, moved_bodies<Index> moved, bool new_tree) {
    body_state<Index>& state = moved.state;
    if (!new_tree) return parts_of_bodies::make<Index>(std::move(state));
    return build_bodies<Policy, Index>(on, std::move(state.placed), std::move(state.with_shapes), std::move(state.boxes));
}
template <class Policy, class Index>
bodies<Index> settle_bodies(const Policy& on, moved_bodies<Index> moved) {
    const bool new_tree = moved.wants_new_tree;
    return settle_bodies(on, std::move(moved), new_tree);
}

/// Throws where there are not as many poses as bodies, or the bodies lie on another device.
template <class Policy, class Bodies>
void check_refit(const Policy& on, const Bodies& all, std::size_t poses) {
    constexpr const char* function = "abut::refit";
    if (poses != all.size()) {
        throw error(std::string(function) + ": there are " + std::to_string(all.size()) + " bodies and " +
                    std::to_string(poses) + " poses");
    }
    require_same_device(on, all, function);
}

}  // namespace detail

/// @addtogroup many_bodies
///@{

/// Bodies of a list: posed(index, pose) each. Indices that are copies of one are kept once. Linear time on the calling
/// thread, a tree and several loops by the policy.
template <execution_policy Policy, class Index>
[[nodiscard]] auto make_bodies(const Policy& on, const std::vector<posed_object<Index>>& list) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        return detail::bodies_of(on, list, "abut::make_bodies");
    } else {
        return detail::refused();
    }
}

/// Bodies of indices by their numbers: body i is indices[index_of[i]] under poses[i]. For scenes of so many bodies that a
/// list of them is large: each element of a list is an index, and this is 52 bytes a body in float. Throws error where the
/// two arrays are not of one length, and invalid_geometry for a number that no index has; else as the group says.
template <execution_policy Policy, class Index>
[[nodiscard]] auto make_bodies(const Policy& on, const std::vector<Index>& indices,
                               std::type_identity_t<std::span<const std::uint32_t>> index_of,
                               std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        constexpr const char* function = "abut::make_bodies";
        if (index_of.size() != poses.size()) {
            throw error(std::string(function) + ": there are " + std::to_string(index_of.size()) +
                        " numbers of indices and " + std::to_string(poses.size()) + " poses");
        }
        detail::check_count(poses.size(), function);
        for (std::size_t i = 0; i < index_of.size(); ++i) {
            if (index_of[i] < indices.size()) continue;
            throw invalid_geometry(function, "body", i,
                                   "its index is out of range, there are " + std::to_string(indices.size()), index_of[i]);
        }
        return detail::build_bodies(on, detail::place_bodies(on, detail::gathered_bodies<Index>{indices, index_of, poses},
                                                             function, detail::name_of_body));
    } else {
        return detail::refused();
    }
}

/// The same bodies under other poses, as many, one for each body. `all` stays as it is. The tree over their boxes is
/// refitted; where boxes have grown to more than 1.5 times their surface since it was built, in all or beside the root's
/// (needs_rebuild), a new one is built. The choice moves speed, never results. Throws error where there are not as many
/// poses as bodies, or they lie on another device; else as the group says. Under `cuda` the poses of a span are copied from
/// host memory, 48 bytes each in float; a poses_view is over device memory, of which the poses are copied there.
///
///     auto all = abut::make_bodies(on, list);
///     while (next_frame()) {
///         all = abut::refit(on, all, poses);
///         use(abut::pairs(on, all));
///     }
///@{
template <execution_policy Policy, class Index>
[[nodiscard]] auto refit(const Policy& on, const bodies<Index>& all,
                         std::type_identity_t<std::span<const rigid<typename Index::scalar_type>>> poses) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        detail::check_refit(on, all, poses.size());
        return detail::settle_bodies(on, detail::move_bodies(on, all, poses));
    } else {
        return detail::refused();
    }
}
template <execution_policy Policy, class Index, memory_space Space>
[[nodiscard]] auto refit(const Policy& on, const bodies<Index>& all,
                         const poses_view<typename Index::scalar_type, Space>& poses) {
    constexpr bool there = std::same_as<Space, space_of<Policy>>;
    static_assert(there, "abut: the poses lie in other memory than the policy works in");
    if constexpr (there && detail::can_be_listed<Policy, Index>()) {
        detail::check_refit(on, all, poses.count);
        require_access(on, poses.first, "abut::refit");
        execution::buffer_of<Policy, rigid<typename Index::scalar_type>> own(on, poses.count);
        copy(on, poses.first, poses.count, own.data());
        return detail::settle_bodies(on, detail::move_bodies(on, all, std::move(own)));
    } else {
        return detail::refused();
    }
}
///@}

///@}

}  // namespace abut
