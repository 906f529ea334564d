// SPDX-License-Identifier: MIT
#pragma once

// Queries of a scene of many bodies: which shapes of one body touch which of another. A tree over boxes around the placed
// bodies (bodies.hpp) finds the pairs of bodies that may touch, and these are asked about all together, as the entries of a
// list (list_pairing.hpp). Near pairs stay in the policy's memory; the host learns their number. Not for pairs within one
// body: those are self_pairs of its index. The fronts are those of two arguments (query.hpp, contacts.hpp, within.hpp).

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <abut/collide/bodies.hpp>
#include <abut/collide/contacts.hpp>
#include <abut/collide/list_pairing.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/shape/crossing.hpp>

namespace abut {

/// @defgroup many_bodies Which bodies of a scene touch
///
/// `any`, `count`, `pairs`, `for_each_pair` and `contacts` of many bodies: which shapes of one body touch which of another;
/// `within`, `count_within`, `any_within` and `for_each_within`: which are no farther than a distance from which.
/// A body is `posed(index, pose)`, of an index made by `make_bvh`. Any number of bodies may share an index, and they may be
/// over empty sets. Queries take a `std::vector` of posed indices, of which they make `bodies` for the call. A scene that is
/// asked more than once is made once, by make_bodies, and brought to other poses by `refit`. Bodies of different kinds of
/// indices are one scene as well (mixed_bodies), and those of two scenes are asked about with `between`.
///
/// A body is not paired with itself. Its own pairs are the same under every pose, but for the rounding of placed
/// coordinates: `self_pairs(on, index)` gives them once for all bodies of that index. Two bodies share no vertices, also if
/// they share a mesh: whatever touches is reported.
///
/// @par Memory
/// Indices and `bodies` lie in the policy's memory, and a list of posed indices in host memory. A `result` lies in the
/// policy's memory, 16 bytes a pair, and 44 a contact in float and 72 in double. Each pair of bodies whose boxes meet, or
/// are no farther apart than the distance, takes 80 bytes in the policy's memory in float, and 144 in double, for the call.
/// Bodies that are farther apart cost one box each in a tree.
///
/// @par Errors
/// - `invalid_geometry`, whose message names the body: a pose is no rotation, or placed coordinates overflow. Poses
///   are looked at when bodies are made and when they are refitted.
/// - `error`: an index, or bodies, lie on another device; a distance is negative, infinite or NaN.
/// - `capacity_error`: there are 2^31 bodies or more; an index has more than 2^30 shapes (2^29 in wide_layout); or
///   the bits of two ids and of the number of pairs of bodies whose boxes are near are more than 64.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Each call returns when its answer is complete; under `cuda` it waits for the policy's stream, several times.
///
/// @par Example
/// @snippet queries.cpp many_bodies
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

/// A contact of two bodies: the first four are as in body_pair, the rest is as in contact<T>.
template <scalar T>
struct body_contact {
    std::uint32_t body_a;  ///< position of the first body
    std::uint32_t body_b;  ///< position of the second one, which is higher
    std::uint32_t a;       ///< id in the first body's set
    std::uint32_t b;       ///< id in the second one's
    vec3<T> point;         ///< of both shapes, in the world
    vec3<T> normal;        ///< of length 1, from b to a
    T depth;               ///< 0 or more, in units of length

    friend constexpr bool operator==(const body_contact&, const body_contact&) = default;
};

/// Options of queries of many bodies; with a filter write `body_options{.filter = f}` (see query_options). See list_options.
template <class Filter = keep_all, schedule Schedule = schedule::shared_list, class Bodies = keep_all>
struct body_options {
    /// Results sorted by body_a, then body_b, a and b. Without it the order is any, and may differ from call to call.
    flag sorted = true;
    /// filter(body_pair) -> bool: pairs for which it is false are neither tested nor reported. As in query_options.
    Filter filter = {};
    /// As in query_options.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// Of contacts alone; as in contact_options.
    flag discard_sideways = false;
    /// As in query_options, for the walk of the bodies' trees.
    schedule_options scheduling = {};
    /// bodies(body_a, body_b) -> bool, two std::uint32_t: two bodies for which it is false are not looked at. It is asked once
    /// of each two whose boxes are near, and so costs nothing beside a filter of shapes: a matrix of allowed collisions goes
    /// here. As a filter it is trivially copyable, ABUT_HD under cuda, and called concurrently.
    Bodies bodies = {};
};

namespace detail {

template <class X>
inline constexpr bool is_many_bodies = false;
template <class Index>
inline constexpr bool is_many_bodies<bodies<Index>> = true;
template <class Index>
inline constexpr bool is_many_bodies<std::vector<posed_object<Index>>> = true;
/// Of several kinds (mixed_bodies.hpp).
template <class X>
inline constexpr bool is_mixed_bodies = false;

}  // namespace detail

/// What queries of a scene take: `bodies`, or a std::vector of posed indices.
template <class X>
concept many_bodies = detail::is_many_bodies<X>;

/// Two scenes, of which each body of the one is asked about with each of the other: a scene of its own, which queries of pairs
/// take. So bodies of different kinds of indices meet. Made by `between`.
template <many_bodies A, many_bodies B>
struct bodies_between {
    A a;  ///< body_a is one of these, and may be the higher number
    B b;  ///< body_b is one of these
};
/// Each body of `a` with each of `b`. `bodies` share what they hold; a list of posed indices is copied. Where both are one
/// scene, each body meets itself too.
///
///     const auto hits = abut::pairs(on, abut::between(robots, crates));  // body_a is a robot, body_b a crate
template <many_bodies A, many_bodies B>
[[nodiscard]] bodies_between<A, B> between(const A& a, const B& b) {
    return {a, b};
}

namespace detail {

template <class X>
inline constexpr bool is_bodies_between = false;
template <class A, class B>
inline constexpr bool is_bodies_between<bodies_between<A, B>> = true;

/// What bodies are of.
template <class Bodies>
struct index_of_bodies;
template <class Index>
struct index_of_bodies<bodies<Index>> : std::type_identity<Index> {};
template <class Index>
struct index_of_bodies<std::vector<posed_object<Index>>> : std::type_identity<Index> {};
template <class A, class B>
struct index_of_bodies<bodies_between<A, B>> : index_of_bodies<A> {};
/// And what those are of that they meet.
template <class Bodies>
struct other_index_of_bodies : index_of_bodies<Bodies> {};
template <class A, class B>
struct other_index_of_bodies<bodies_between<A, B>> : index_of_bodies<B> {};

/// The same options with another filter of shapes. All members are named here, so that none is lost.
template <class Filter, schedule Schedule, class Bodies, class Other>
body_options<Other, Schedule, Bodies> with_filter(const body_options<Filter, Schedule, Bodies>& options, const Other& filter) {
    const auto& [sorted, old, most_pairs, discard_sideways, scheduling, bodies] = options;
    return {sorted, filter, most_pairs, discard_sideways, scheduling, bodies};
}

/// How shapes of an entry are named where the entries are pairs of bodies.
struct names_of_bodies {
    ABUT_HD static body_pair pair(std::uint32_t, const index_pair& bodies, std::uint32_t a, std::uint32_t b) {
        return {bodies.a, bodies.b, a, b};
    }
    template <scalar T>
    ABUT_HD static body_contact<T> tagged(const body_pair& of, const contact<T>& c) {
        return {of.body_a, of.body_b, of.a, of.b, c.point, c.normal, c.depth};
    }
    template <scalar T>
    ABUT_HD static body_crossing<T> tagged(const body_pair& of, const crossing<T>& c) {
        return {of.body_a, of.body_b, of.a, of.b, c};
    }
};

/// The judge of boxes, which are near each other as a frame tells (traverse/pair_walk.hpp).
template <class Frame>
struct judge_boxes {
    Frame frame;
    template <scalar T>
    ABUT_HD verdict decide(const aabb<T>& a, const aabb<T>& b) const {
        return to_verdict(frame(a, b));
    }
    template <scalar T>
    ABUT_HD verdict finish(const aabb<T>& a, const aabb<T>& b) const {
        return decide(a, b);
    }
    template <scalar T>
    bool resolve(const aabb<T>& a, const aabb<T>& b) const {
        return frame(a, b);
    }
};

/// The pairs of bodies whose boxes are near, as numbers of two leaves.
struct near_bodies {
    const std::uint64_t* keys;
    pair_key key;
    const std::uint32_t *of_a, *of_b;  ///< bodies that have shapes
    ABUT_HD index_pair operator()(std::size_t i) const { return {of_a[key.a(keys[i])], of_b[key.b(keys[i])]}; }
};

/// A filter of bodies, of the leaves of two trees.
template <class Bodies>
struct wants_bodies {
    Bodies wanted;
    const std::uint32_t *of_a, *of_b;
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return wanted(of_a[a], of_b[b]); }
};
template <class Policy, class Bodies>
auto filter_of_leaves(const Policy& on, const Bodies& wanted, const std::uint32_t* of_a, const std::uint32_t* of_b) {
    require_callable(on, wanted, std::uint32_t{}, std::uint32_t{});
    if constexpr (std::same_as<Bodies, keep_all>) {
        return wanted;
    } else {
        return wants_bodies<Bodies>{wanted, of_a, of_b};
    }
}

/// The keys of all pairs of boxes of a pairing that are near each other, or of a part of them; ascending if they are to be.
template <class Policy, class Pairing, class Frame, class Part>
auto keys_of_near(const Policy& on, const Pairing& pairing, const Frame& frame, std::size_t boxes, bool sorted,
                  const Part& part) {
    const judge_boxes<Frame> judge{frame};
    key_queue<Policy> found(on, std::max(8 * boxes, std::size_t{1} << 16));
    if constexpr (std::same_as<Part, whole_search>) {
        search(on, pairing, judge, found);
    } else {
        search(on, in_part(pairing, part), judge, found);
    }
    auto keys = found.take();
    if (sorted) sort_keys(on, keys, pairing.key.bits());
    return keys;
}
inline constexpr schedule schedule_of_bodies = default_schedule<traversal::both_at_once>;
/// Of one tree.
template <class Policy, class Tree, class Part = whole_search, class Nearness = near_enough_to_touch, class Filter = keep_all>
auto find_near(const Policy& on, const Tree& tree, const pair_key& key, bool sorted, const Part& part = {},
               const Nearness& near = {}, const Filter& wanted = {}) {
    const self_pairing<indexed_operand<Tree>, Filter, traversal::both_at_once, schedule_of_bodies, Nearness> pairing{
        {tree}, key, {.filter = wanted}, near};
    return keys_of_near(on, pairing, box_overlap(pairing.x, pairing.x, near), tree.size(), sorted, part);
}
/// Of two.
template <class Policy, class TreeA, class TreeB, class Part, class Nearness, class Filter>
auto find_near(const Policy& on, const TreeA& a, const TreeB& b, const pair_key& key, bool sorted, const Part& part,
               const Nearness& near, const Filter& wanted) {
    const pairing<indexed_operand<TreeA>, indexed_operand<TreeB>, Filter, traversal::both_at_once, schedule_of_bodies, Nearness>
        both{{a}, {b}, key, {.filter = wanted}, near};
    return keys_of_near(on, both, box_overlap(both.a, both.b, near), a.size() + b.size(), sorted, part);
}

template <class X>
inline constexpr bool is_list_of_bodies = false;
template <class Index>
inline constexpr bool is_list_of_bodies<std::vector<posed_object<Index>>> = true;
/// Bodies as they are, or of a list.
template <class Policy, class X>
auto kept_bodies(const Policy& on, const X& x, const char* function) {
    if constexpr (is_list_of_bodies<X>) {
        return bodies_of(on, x, function);
    } else {
        return x;
    }
}

inline constexpr const char* noun_of_near = "pairs of bodies whose boxes are near";

/// Bodies, ready to be asked, of all pairs that are near each other or of a part of those; errors are thrown in the name of
/// `function`. Keys of results ascend as bodies do if entries are `sorted`.
template <class Policy, class Index, class Options, class Part, class Nearness>
auto pair_up_bodies(const Policy& on, const bodies<Index>& all, const Options& options, bool sorted, const char* function,
                    const Part& part, const Nearness& near) {
    require_callable(on, options.filter, body_pair{});
    require_same_device(on, all, function);
    const body_state<Index>& state = parts_of_bodies::of(all);
    const std::uint32_t* const of = state.with_shapes->data();
    const int bits = id_bits(state.tree.size());
    const pair_key key{bits, bits};
    const auto keys = find_near(on, state.tree, key, sorted, part, near, filter_of_leaves(on, options.bodies, of, of));
    return pair_up_entries<names_of_bodies>(on, state.placed, state.placed, keys.size(), near_bodies{keys.data(), key, of, of},
                                            options, function, noun_of_near, near);
}
template <class Policy, class Index, class Options, class Part, class Nearness>
auto pair_up_bodies(const Policy& on, const std::vector<posed_object<Index>>& list, const Options& options, bool sorted,
                    const char* function, const Part& part, const Nearness& near) {
    return pair_up_bodies(on, kept_bodies(on, list, function), options, sorted, function, part, near);
}
template <class Policy, class A, class B, class Options, class Part, class Nearness>
auto pair_up_bodies(const Policy& on, const bodies_between<A, B>& both, const Options& options, bool sorted,
                    const char* function, const Part& part, const Nearness& near) {
    if constexpr (is_list_of_bodies<A> || is_list_of_bodies<B>) {
        const auto a = kept_bodies(on, both.a, function);
        const auto b = kept_bodies(on, both.b, function);
        return pair_up_bodies(on, between(a, b), options, sorted, function, part, near);
    } else {
        require_callable(on, options.filter, body_pair{});
        require_same_device(on, both.a, function);
        require_same_device(on, both.b, function);
        const auto& a = parts_of_bodies::of(both.a);
        const auto& b = parts_of_bodies::of(both.b);
        const std::uint32_t *const of_a = a.with_shapes->data(), *const of_b = b.with_shapes->data();
        const pair_key key{id_bits(a.tree.size()), id_bits(b.tree.size())};
        const auto keys =
            find_near(on, a.tree, b.tree, key, sorted, part, near, filter_of_leaves(on, options.bodies, of_a, of_b));
        return pair_up_entries<names_of_bodies>(on, a.placed, b.placed, keys.size(),
                                                near_bodies{keys.data(), key, of_a, of_b}, options, function, noun_of_near,
                                                near);
    }
}

/// Bodies as a form of arguments (question.hpp).
template <class Bodies>
struct form_of_bodies {
    using index_a = typename index_of_bodies<Bodies>::type;
    using index_b = typename other_index_of_bodies<Bodies>::type;
    using scalar_type = typename index_a::scalar_type;
    using pair_type = body_pair;
    template <scalar T>
    using contact_type = body_contact<T>;
    template <scalar T>
    using crossing_type = body_crossing<T>;
    struct order {
        template <class Found>
        ABUT_HD bool operator()(const Found& x, const Found& y) const {
            if constexpr (!std::same_as<Found, index_pair>) {  // which is two bodies
                if (x.body_a != y.body_a) return x.body_a < y.body_a;
                if (x.body_b != y.body_b) return x.body_b < y.body_b;
            }
            return by_ids{}(x, y);
        }
    };
    const Bodies& all;

    template <class Policy, class Question, class>
    static consteval bool can_be_asked() {
        if constexpr (can_be_listed<Policy, index_a, index_b>()) {
            return Question::template takes<shape_in_world<index_a>, shape_in_world<index_b>>();
        } else {
            return false;
        }
    }
    template <class Policy, class Relation, class Options, class Part = whole_search>
    auto pair_up(const Policy& on, const Relation& how, const Options& options, bool in_order, const char* function,
                 const Part& part = {}) const {
        return pair_up_bodies(on, all, options, in_order, function, part,
                              how.template nearness<scalar_type>());
    }
};
template <class Options>
inline constexpr bool are_body_options = false;
template <class Filter, schedule Schedule, class Wanted>
inline constexpr bool are_body_options<body_options<Filter, Schedule, Wanted>> = true;
template <class Bodies>
    requires(many_bodies<Bodies> || is_bodies_between<Bodies>)
struct form_of_scene<Bodies> {
    using type = form_of_bodies<Bodies>;
    using options = body_options<>;
    template <class Options>
    static constexpr bool takes = are_body_options<Options>;
};

}  // namespace detail

///@}

}  // namespace abut
