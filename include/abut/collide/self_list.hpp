// SPDX-License-Identifier: MIT
#pragma once

// Self pairs of a list of bodies: which shapes of one body touch which of another, for a scene of many bodies under poses.
// A tree over boxes around the placed bodies finds the pairs of bodies that may touch, and these are asked about all
// together, as a list of pairs (list.hpp). Not for pairs within one body: those are self_pairs of its index.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/shape/relative_pose.hpp>

namespace abut {

/// @defgroup body_lists Which bodies of a scene touch
///
/// `self_pairs`, `count_self_pairs` and `any_self_pairs` of a list of bodies: which shapes of one body touch which of
/// another. A body is `posed(index, pose)`, of an index made by `make_bvh`. Any number of bodies may share an index, and
/// they may be over empty sets.
///
/// A body is not paired with itself. Its own pairs are the same under every pose, but for the rounding of placed
/// coordinates: `self_pairs(on, index)` gives them once for all bodies of that index. Two bodies share no vertices, also if
/// they share a mesh: whatever touches is reported. Bodies of one shape are searched one after another.
///
/// @par Memory
/// Indices lie in the policy's memory, and the list itself in host memory. A `result` lies in the policy's memory, 16 bytes
/// a pair. Each pair of bodies whose boxes meet takes a few hundred bytes in host memory and as many in the policy's. Bodies
/// that are far apart cost one box each in a tree.
///
/// @par Errors
/// - `invalid_geometry`, whose message names the body: a pose is no rotation, or placed coordinates overflow.
/// - `error`: an index lies on another device.
/// - `capacity_error`: there are 2^31 bodies or more, or the bits of two ids and of the number of pairs of bodies whose
///   boxes meet are more than 64.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Each call returns when its answer is complete; under `cuda` it waits for the policy's stream, several times.
///
/// @par Example
/// @snippet queries.cpp body_lists
///@{

/// Two shapes of two bodies that touch: shape `a` of body `body_a`, and shape `b` of body `body_b`; body_a < body_b. Bodies
/// go by their positions in the list, shapes by their ids in the bodies' sets.
struct body_pair {
    std::uint32_t body_a;  ///< position of the first body
    std::uint32_t body_b;  ///< position of the second one, which is higher
    std::uint32_t a;       ///< id in the first body's set
    std::uint32_t b;       ///< id in the second one's

    friend constexpr bool operator==(const body_pair&, const body_pair&) = default;
    friend constexpr auto operator<=>(const body_pair&, const body_pair&) = default;
};

/// The filter that keeps every pair of shapes of two bodies.
struct keep_all_bodies {
    /// For every pair.
    keep_all_bodies() = default;
    /// No other filter becomes this one: does not compile.
    template <class F>
    ABUT_HD constexpr keep_all_bodies(const F&) {
        detail::refuse_unnamed_options<F>();
    }
    /// true
    ABUT_HD constexpr bool operator()(body_pair) const { return true; }
};

/// Options of self queries of a list of bodies; with a filter write `body_options{.filter = f}` (see query_options). See
/// list_options.
template <class Filter = keep_all_bodies, schedule Schedule = schedule::shared_list>
struct body_options {
    /// Results sorted by body_a, then body_b, a and b. Without it the order is any, and may differ from call to call.
    bool sorted = true;
    /// filter(body_pair) -> bool: pairs for which it is false are neither tested nor reported. As in query_options.
    Filter filter = {};
    /// As in query_options.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// As in query_options, for the walk of the bodies' trees.
    schedule_options scheduling = {};
};

namespace detail {

/// Two bodies that may touch, by their positions: a < b.
using two_bodies = index_pair;

/// Pairs of bodies, as entries of a list_pairing.
template <class Policy, class Index>
struct body_entries {
    using index_a = Index;
    using index_b = Index;
    static constexpr const char* noun = "pairs of bodies whose boxes meet";
    struct entry {
        const posed_object<Index>&a, &b;
    };

    const std::vector<posed_object<Index>>* bodies;
    std::vector<two_bodies> which;
    execution::buffer_of<Policy, two_bodies> there;  ///< the same in the policy's memory

    [[nodiscard]] std::size_t size() const { return which.size(); }
    [[nodiscard]] entry operator[](std::size_t i) const { return {(*bodies)[which[i].a], (*bodies)[which[i].b]}; }
};

ABUT_HD constexpr body_pair name_bodies(const two_bodies* bodies, tagged_pair of) {
    return {bodies[of.pair].a, bodies[of.pair].b, of.a, of.b};
}

/// A filter of pairs of bodies, for a list.
template <class Filter>
struct filter_bodies {
    const two_bodies* bodies;
    Filter filter;
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(tagged_pair of) const { return filter(name_bodies(bodies, of)); }
};

/// Finds out whether two shapes touch, and knows their ids and whose they are.
template <arithmetic A>
struct touch_and_name_bodies : touch<A> {
    const two_bodies* bodies;
    template <class View>
    ABUT_HD auto answer(const View& both, std::uint64_t key) const {
        return name_bodies(bodies, both.ids(key));
    }
};

/// The judge of boxes.
struct boxes_meet {
    template <scalar T>
    ABUT_HD verdict decide(const aabb<T>& a, const aabb<T>& b) const {
        return to_verdict(overlaps(a, b));
    }
    template <scalar T>
    ABUT_HD verdict finish(const aabb<T>& a, const aabb<T>& b) const {
        return decide(a, b);
    }
    template <scalar T>
    bool resolve(const aabb<T>& a, const aabb<T>& b) const {
        return overlaps(a, b);
    }
};

/// A box around a placed body, which has shapes. Sets hold finite boxes; cut off at the largest numbers, boxes that overlap
/// still do.
template <class Index>
auto placed_box(const posed_object<Index>& body) {
    using T = typename Index::scalar_type;
    constexpr T far = largest_finite<T>;
    const aabb<T> box = world_box(body.pose, body.object.bounds());
    return aabb<T>{greatest(box.lower, vec3<T>{-far, -far, -far}), least(box.upper, vec3<T>{far, far, far})};
}

/// The pairs of bodies whose boxes meet, ascending.
template <class Policy, class Index>
std::vector<two_bodies> near_bodies(const Policy& on, const std::vector<posed_object<Index>>& bodies) {
    using T = typename Index::scalar_type;
    std::vector<aabb<T>> around;
    std::vector<std::uint32_t> ids;  // bodies that have shapes
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].size() == 0) continue;
        around.push_back(placed_box(bodies[i]));
        ids.push_back(static_cast<std::uint32_t>(i));
    }
    const auto tree = make_bvh(on, boxes<T, space_of<Policy>>(on, std::span<const aabb<T>>(around)));
    using operand = indexed_operand<std::remove_const_t<decltype(tree)>>;
    const int bits = id_bits(ids.size());
    const self_pairing<operand, keep_all, traversal::both_at_once, default_schedule<traversal::both_at_once>, as_they_are> pairing{
        {tree}, {}, {bits, bits}, {}};
    const auto keys = find_keys(on, pairing, boxes_meet{});
    std::vector<std::uint64_t> found(keys.size());
    download(on, keys.data(), keys.size(), found.data());
    std::vector<two_bodies> near;
    near.reserve(found.size());
    for (const std::uint64_t key : found) near.push_back({ids[pairing.key.a(key)], ids[pairing.key.b(key)]});
    return near;
}

/// Bodies, ready to be asked, as long as they live; errors are thrown in the name of `function`.
template <class Policy, class Index, class Filter, schedule Schedule>
auto pair_up_bodies(const Policy& on, const std::vector<posed_object<Index>>& bodies,
                    const body_options<Filter, Schedule>& options, const char* function) {
    require_callable(on, options.filter, body_pair{});
    check_count(bodies.size(), function);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        check_entry(on, bodies[i], function, [i] { return "body " + std::to_string(i); });
    }
    body_entries<Policy, Index> entries{&bodies, near_bodies(on, bodies), {}};
    entries.there = execution::buffer_of<Policy, two_bodies>(on, entries.size());
    upload(on, entries.which.data(), entries.size(), entries.there.data());
    const list_options<filter_bodies<Filter>, Schedule> of_list{.sorted = options.sorted,
                                                                .filter = {entries.there.data(), options.filter},
                                                                .most_pairs = options.most_pairs,
                                                                .scheduling = options.scheduling};
    return pair_up_entries(on, std::move(entries), of_list, function);
}

}  // namespace detail

/// All pairs of shapes of two different bodies that touch, each once: a result of body_pair, in the policy's memory.
///
///     std::vector<abut::posed_object<decltype(gear)>> bodies{posed(gear, here), posed(gear, there)};
///     for (const auto& hit : to_host(abut::self_pairs(on, bodies))) use(hit.body_a, hit.a, hit.body_b, hit.b);
template <arithmetic A = filtered, execution_policy Policy, class Index, class Filter = keep_all_bodies,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto self_pairs(const Policy& on, const std::vector<posed_object<Index>>& bodies,
                              const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        const auto pairing = detail::pair_up_bodies(on, bodies, options, "abut::self_pairs");
        const detail::touch_and_name_bodies<A> judge{{}, pairing.list.there.data()};
        return detail::answers_to(on, pairing, judge, detail::find_keys(on, pairing, judge));
    } else {
        return result<body_pair, space_of<Policy>>();
    }
}

/// The number of pairs that self_pairs reports. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class Index, class Filter = keep_all_bodies,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count_self_pairs(const Policy& on, const std::vector<posed_object<Index>>& bodies,
                                             const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        return detail::count_of<A>(on, detail::pair_up_bodies(on, bodies, options, "abut::count_self_pairs"));
    } else {
        return 0;
    }
}

/// Whether there is such a pair. Stops at the first one found.
template <arithmetic A = filtered, execution_policy Policy, class Index, class Filter = keep_all_bodies,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any_self_pairs(const Policy& on, const std::vector<posed_object<Index>>& bodies,
                                  const body_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, Index>()) {
        return detail::any_of<A>(on, detail::pair_up_bodies(on, bodies, options, "abut::any_self_pairs"));
    } else {
        return false;
    }
}

///@}

}  // namespace abut
