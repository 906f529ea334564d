// SPDX-License-Identifier: MIT
#pragma once

// Sets and indices on several devices: a copy on each, or a part on each.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/operand.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/parts.hpp>
#include <abut/execution/team.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/turning.hpp>

namespace abut {

/// @addtogroup devices
///@{

/// The same set, index or scene of bodies on each device.
template <class X>
class replicated {
public:
    using scalar_type = typename X::scalar_type;  ///< float or double

    /// One for each device, in their order: copies of one set, or what is made of such copies by the same calls.
    explicit replicated(std::vector<X> copies) : copies_(std::move(copies)) {}
    /// Of what is no X but can be one: a body at rest is one in motion.
    template <class Y>
        requires(!std::same_as<X, Y> && std::convertible_to<const Y&, X>)
    replicated(const replicated<Y>& other) {  // NOLINT
        for (int k = 0; k < other.devices(); ++k) copies_.push_back(other[k]);
    }
    /// What lies on the k-th device.
    [[nodiscard]] const X& operator[](int k) const { return copies_[static_cast<std::size_t>(k)]; }
    /// Number of devices.
    [[nodiscard]] int devices() const { return static_cast<int>(copies_.size()); }
    /// Number of shapes, or of bodies.
    [[nodiscard]] std::size_t size() const { return copies_.empty() ? 0 : copies_.front().size(); }

private:
    std::vector<X> copies_;
};

/// Ids of a part's shapes in the whole set: a list of them in memory of the device, or numbers from one on.
struct part_ids {
    const std::uint32_t* list = nullptr;  ///< null if they are first, first + 1, ...
    std::uint32_t first = 0;              ///< of the shape that has id 0 in the part

    /// The id in the whole set of the part's shape i.
    [[nodiscard]] ABUT_HD std::uint32_t operator()(std::uint32_t i) const { return list == nullptr ? first + i : list[i]; }
};

/// A set of which each device has a part, or an index of each part.
template <class X>
class divided {
public:
    using shape_type = typename detail::shape_of_argument<X>::type;                  ///< what a shape is
    using scalar_type = scalar_type_of<shape_type>;                                  ///< float or double
    using memory_space = typename X::memory_space;                                   ///< where parts lie
    using ids_type = detail::shared_array<std::uint32_t, typename X::memory_space>;  ///< an array of ids

    /// Of parts that the devices have, one for each in their order: sets, or views of the caller's memory, each on its
    /// device. In the whole set the shapes of the first part come first, then those of the second, and so on. Nothing is
    /// copied. Throws capacity_error for 2^32 - 1 shapes or more in all.
    explicit divided(std::vector<X> parts) : parts_(std::move(parts)) {
        for (const X& part : parts_) {
            first_.push_back(static_cast<std::uint32_t>(size_));
            size_ += part.size();
            if (size_ >= no_id) {
                throw capacity_error("abut::divided: parts of " + std::to_string(size_) +
                                     " shapes; expected fewer than 2^32 - 1 in all");
            }
        }
    }
    /// The same, and for each shape of a part the id in the whole set, ascending. `bounds` is the library's own, of where
    /// the parts are.
    divided(std::vector<X> parts, std::vector<ids_type> ids, std::vector<detail::part_bounds<scalar_type>> bounds = {})
        : divided(std::move(parts)) {
        ids_ = std::move(ids);
        bounds_ = std::move(bounds);
    }
    /// What is made of the parts of `whole`, shape for shape: trees of them, or the same under a pose.
    template <class Y>
    divided(std::vector<X> parts, const divided<Y>& whole, std::vector<detail::part_bounds<scalar_type>> bounds = {})
        : divided(std::move(parts), whole.ids_, std::move(bounds)) {}

    /// What lies on the k-th device.
    [[nodiscard]] const X& operator[](int k) const { return parts_[static_cast<std::size_t>(k)]; }
    /// The ids of its shapes in the whole set, as that device reads them.
    [[nodiscard]] part_ids ids(int k) const {
        const auto i = static_cast<std::size_t>(k);
        return ids_.empty() ? part_ids{nullptr, first_[i]} : part_ids{ids_[i].data(), 0};
    }
    /// Where the parts are, if that is known: for the library.
    [[nodiscard]] const std::vector<detail::part_bounds<scalar_type>>& bounds() const { return bounds_; }
    /// Number of devices.
    [[nodiscard]] int devices() const { return static_cast<int>(parts_.size()); }
    /// Number of shapes of the whole set.
    [[nodiscard]] std::size_t size() const { return size_; }

private:
    template <class>
    friend class divided;

    std::vector<X> parts_;
    std::vector<std::uint32_t> first_;  ///< ids of the parts' first shapes, where there are no others
    std::vector<ids_type> ids_;
    std::vector<detail::part_bounds<scalar_type>> bounds_;
    std::size_t size_ = 0;
};

///@}

namespace detail {

template <class X>
inline constexpr bool is_replicated = false;
template <class X>
inline constexpr bool is_replicated<replicated<X>> = true;
template <class X>
inline constexpr bool is_divided = false;
template <class X>
inline constexpr bool is_divided<divided<X>> = true;
/// A mesh in motion of which each device has a part (divide_mesh.hpp).
template <class X>
inline constexpr bool is_divided_mesh = false;
/// What lies on the devices of a call.
template <class X>
inline constexpr bool is_on_devices = is_replicated<X> || is_divided<X> || is_divided_mesh<X>;
/// Whether each device may be brought to another step without a look at the others.
template <class X>
inline constexpr bool refits_alone = true;
/// What has shapes, and so may be posed.
template <class X>
concept has_shape_type = requires {
    typename shape_of_argument<X>::type;
};

/// What a device is asked about.
template <class X>
const auto& on_device(const X& x, int k) {
    if constexpr (is_on_devices<X>) {
        return x[k];
    } else {
        return x;
    }
}
template <class X>
using type_on_device = std::remove_cvref_t<decltype(on_device(std::declval<const X&>(), 0))>;

/// f(k) of each device, made on all at a time.
template <class Team, class F>
auto each_of(const Team& team, const F& f) {
    using made = decltype(f(0));
    std::vector<std::optional<made>> there(static_cast<std::size_t>(team.size()));
    execution::on_each(team, [&](int k) { there[static_cast<std::size_t>(k)].emplace(f(k)); });
    std::vector<made> all;
    all.reserve(there.size());
    for (auto& one : there) all.push_back(std::move(*one));
    return all;
}

/// The share of a search that falls to the k-th device, where each has all of what is searched.
template <class Team>
search_part share_of(const Team& team, int k) {
    return {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(team.size())};
}

template <class Team, class X>
void require_as_many(const Team& team, const X& x, const char* function) {
    if constexpr (is_on_devices<X>) {
        if (x.devices() != team.size()) {
            throw error(std::string(function) + ": the argument lies on " + std::to_string(x.devices()) +
                        " devices, the call is to " + std::to_string(team.size()));
        }
    }
}

/// The first of the k-th of some parts of n elements.
inline std::size_t first_of_part(std::size_t n, int k, int parts) {
    const auto p = static_cast<std::size_t>(parts), i = static_cast<std::size_t>(k);
    return n / p * i + (n % p < i ? n % p : i);
}

template <shape_view Shapes>
struct box_along_curve {
    Shapes shapes;
    const std::uint32_t* order;
    ABUT_HD auto operator()(std::size_t i) const { return bounds(shapes[order[i]]); }
};
template <scalar T>
part_bounds<T> bounds_of_boxes(std::size_t shapes, const std::vector<aabb<T>>& boxes) {
    part_bounds<T> part;
    part.size = shapes;
    for (aabb<T>& box : part.groups) box = empty_box<T>();
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        part.groups[k] = boxes[k];
        part.around = merge(part.around, boxes[k]);
    }
    return part;
}

/// The boxes of trees, one each.
template <class Tree>
auto bounds_of_trees(const std::vector<Tree>& trees) {
    std::vector<part_bounds<typename Tree::scalar_type>> all;
    for (const Tree& tree : trees) {
        all.push_back(bounds_of_boxes(
            tree.size(), tree.size() > 0 ? std::vector{tree.bounds()} : std::vector<decltype(tree.bounds())>()));
    }
    return all;
}

/// Parts of a set along a curve. `source` is the policy in whose memory the set lies, hand_over(p, n, policy, q) copies from
/// there to a device.
template <class Team, class Source, shape_view Shapes, class HandOver>
auto divide_along_curve(const Team& team, const Source& source, const Shapes& all, const HandOver& hand_over) {
    using shape_type = typename Shapes::shape_type;
    using local = typename Team::local_policy;
    using set = shapes<shape_type, space_of<local>>;
    using ids_type = typename divided<set>::ids_type;
    const auto order = order_on_curve(source, all);
    synchronize(source);
    using T = typename Shapes::scalar_type;
    std::vector<set> sets;
    std::vector<ids_type> ids;
    std::vector<part_bounds<T>> bounds;
    for (int k = 0; k < team.size(); ++k) {  // one after another: the source has room for one part
        const std::size_t first = first_of_part(all.size(), k, team.size());
        const std::size_t n = first_of_part(all.size(), k + 1, team.size()) - first;
        std::vector<aabb<T>> boxes(std::min(part_boxes, n));
        for (std::size_t g = 0; g < boxes.size(); ++g) {
            const int group = static_cast<int>(g), groups = static_cast<int>(boxes.size());
            const std::size_t from = first_of_part(n, group, groups), to = first_of_part(n, group + 1, groups);
            boxes[g] = reduce(source, to - from, empty_box<T>(), merge_boxes{},
                              box_along_curve<Shapes>{all, order.data() + first + from});
        }
        execution::buffer_of<Source, std::uint32_t> mine(source, n);
        execution::buffer_of<Source, shape_type> packed(source, n);
        copy(source, order.data() + first, n, mine.data());
        sort_keys(source, mine, id_bits(all.size()));  // so that what is sorted by the ids of a part is sorted by all
        for_each_index(source, n, pack_shape<Shapes>{all, mine.data(), packed.data()});
        synchronize(source);
        execution::buffer_of<local, shape_type> there(team[k], n);
        execution::buffer_of<local, std::uint32_t> ids_there(team[k], n);
        hand_over(packed.data(), n, team[k], there.data());
        hand_over(mine.data(), n, team[k], ids_there.data());
        sets.push_back(set_parts::shapes_of(std::move(there)));
        ids.push_back(ids_type(std::move(ids_there)));
        bounds.push_back(bounds_of_boxes(n, boxes));
    }
    return divided<set>(std::move(sets), std::move(ids), std::move(bounds));
}

/// Calls divide(source, hand_over): `source` is the policy in whose memory a set lies, a policy of the host if that is host
/// memory, and hand_over(p, n, policy, q) copies n elements from there to a device. Throws in the name of `function` if the
/// set lies on a device that is none of these.
template <class Team, class Set, class Divide>
auto where_it_lies(const Team& team, const Set& set, const char* function, const Divide& divide) {
    using local = typename Team::local_policy;
    if constexpr (std::same_as<typename Set::memory_space, host_space> && !host_policy<local>) {
        return divide(openmp{}, [](const auto* from, std::size_t n, const local& to, auto* there) {
            upload(to, from, n, there);
            synchronize(to);
        });
    } else {
        int at = 0;
        while (at < team.size() && set.size() > 0 && device_of(team[at]) != set.device()) ++at;
        if (at == team.size()) {
            throw error(std::string(function) + ": the set lies on device " + std::to_string(set.device()) +
                        ", which is none of these devices");
        }
        const local& source = team[at];
        return divide(source, [&](const auto* from, std::size_t n, const local& to, auto* there) {
            copy_across(source, from, n, to, there);
        });
    }
}

}  // namespace detail

/// @addtogroup devices
///@{

/// A copy of a set on each device. A set on one of the devices is shared there, and goes to the others through host memory.
/// Waits for the copies.
template <execution::policy_team Team, shape_set Set>
[[nodiscard]] auto replicate(const Team& team, const Set& set) {
    return replicated(detail::each_of(team, [&](int k) { return set.copied_to(team[k]); }));
}

/// Divides a set: each device gets as many shapes as the others, or one more, and they are neighbours along a Hilbert curve.
/// Parts hold shapes as they are, in the order of their ids: faces become triangles. Of each the id in `set` is kept, 4
/// bytes. `set` lies on one of the devices or in host memory; there it may be larger than a device's memory. That side needs
/// besides it 16 bytes a shape, and room for one part. Waits for all. Throws error if the set lies on a device that is none
/// of these.
template <execution::policy_team Team, shape_set Set>
[[nodiscard]] auto divide(const Team& team, const Set& set) {
    return detail::where_it_lies(team, set, "abut::divide", [&](const auto& source, const auto& hand_over) {
        return detail::divide_along_curve(team, source, set.view(), hand_over);
    });
}

/// A tree on each device: of the same set, or of its part of a divided one. Trees of one set are the same on all devices.
/// Options are those of `make_bvh` under one policy. Returns a `replicated` or a `divided` tree; waits for all.
template <execution::policy_team Team, class X, class... Options>
[[nodiscard]] auto make_bvh(const Team& team, const X& x, const Options&... options) {
    detail::require_as_many(team, x, "abut::make_bvh");
    auto trees = detail::each_of(team, [&](int k) {
        if constexpr (shape_set<X>) {
            return make_bvh(team[k], x.copied_to(team[k]), options...);
        } else {
            return make_bvh(team[k], detail::on_device(x, k), options...);
        }
    });
    if constexpr (detail::is_divided<X>) {
        auto bounds = x.bounds().empty() ? detail::bounds_of_trees(trees) : x.bounds();
        return divided<typename decltype(trees)::value_type>(std::move(trees), x, std::move(bounds));
    } else {
        return replicated(std::move(trees));
    }
}

/// What lies on each device, brought to another step as `refit` of one policy does: trees of a set, or impact indices, to
/// `step`, which is a set on each device or in host memory. Waits for all.
template <execution::policy_team Team, class X, class Step>
    requires detail::refits_alone<X>
[[nodiscard]] auto refit(const Team& team, const replicated<X>& all, const Step& step) {
    detail::require_as_many(team, all, "abut::refit");
    detail::require_as_many(team, step, "abut::refit");
    return replicated(detail::each_of(team, [&](int k) { return refit(team[k], all[k], detail::on_device(step, k)); }));
}

/// Trees of parts, each brought to its part of another step, as `refit` of one policy does. Parts of the step hold the same
/// shapes: they are the caller's own, as those of the tree (the constructors of `divided`). What `divide` makes of another
/// step has other shapes in its parts, and is refused by an `error`. Waits for all.
template <execution::policy_team Team, class X, class Step>
    requires detail::refits_alone<X>
[[nodiscard]] auto refit(const Team& team, const divided<X>& all, const divided<Step>& step) {
    detail::require_as_many(team, all, "abut::refit");
    detail::require_as_many(team, step, "abut::refit");
    for (int k = 0; k < team.size(); ++k) {
        if (all.ids(k).list != step.ids(k).list) {
            throw error("abut::refit: part " + std::to_string(k) +
                        " of the step has other shapes than that of the trees; expected parts with the same array of ids, or "
                        "both without one");
        }
    }
    auto trees = detail::each_of(team, [&](int k) { return refit(team[k], all[k], step[k]); });
    auto bounds = detail::bounds_of_trees(trees);
    return divided<typename decltype(trees)::value_type>(std::move(trees), all, std::move(bounds));
}

/// The set or tree on each device, moved by a pose.
///@{
template <detail::has_shape_type X>
[[nodiscard]] auto posed(const replicated<X>& object, const rigid<typename X::scalar_type>& pose) {
    std::vector<posed_object<X>> placed;
    for (int k = 0; k < object.devices(); ++k) placed.push_back(posed(object[k], pose));
    return replicated(std::move(placed));
}
template <class X>
[[nodiscard]] auto posed(const divided<X>& object, const rigid<scalar_type_of<typename divided<X>::shape_type>>& pose) {
    std::vector<posed_object<X>> placed;
    for (int k = 0; k < object.devices(); ++k) placed.push_back(posed(object[k], pose));
    return divided<posed_object<X>>(std::move(placed), object);
}
///@}

/// The index on each device, on its way from one pose to another.
template <class X>
[[nodiscard]] auto moving(const replicated<posed_object<X>>& at_t0, const replicated<posed_object<X>>& at_t1,
                          const turning<typename posed_object<X>::scalar_type>& about = {}) {
    std::vector<posed_motion<X>> ways;
    for (int k = 0; k < at_t0.devices(); ++k) ways.push_back(moving(at_t0[k], at_t1[k], about));
    return replicated(std::move(ways));
}

///@}

}  // namespace abut
