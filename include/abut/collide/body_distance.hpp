// SPDX-License-Identifier: MIT
#pragma once

// distance of bodies: the nearest two shapes of two different ones. First it is decided which bodies touch (body_pairs.hpp).
// Where none do, neighbours along a curve are measured, which gives a bound, and then the bodies whose boxes are no farther
// apart than that. What is decided and measured of two bodies is what distance.hpp says of their posed indices.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/body_pairs.hpp>
#include <abut/collide/distance.hpp>
#include <abut/collide/list_distance.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/shape/outward.hpp>

namespace abut {

/// A `separation` of two bodies: shape `a` of body `body_a`, and shape `b` of body `body_b`; body_a < body_b.
/// @ingroup many_bodies
template <scalar T>
struct body_separation {
    std::uint32_t body_a;  ///< position of the first body
    std::uint32_t body_b;  ///< position of the second one, which is higher
    std::uint32_t a;       ///< id in the first body's set
    std::uint32_t b;       ///< id in the second one's
    vec3<T> point_a;       ///< of the first shape, in the world
    vec3<T> point_b;       ///< of the second one
    T distance;            ///< between the two, rounded to T; 0 where they touch

    friend constexpr bool operator==(const body_separation&, const body_separation&) = default;
};

namespace detail {

/// In place of a second argument: bodies are asked about each other.
struct each_other {};

/// Neighbours in an order of bodies.
struct next_in_order {
    const std::uint32_t *order, *with_shapes;
    ABUT_HD index_pair operator()(std::size_t i) const {
        const std::uint32_t a = with_shapes[order[i]], b = with_shapes[order[i + 1]];
        return a < b ? index_pair{a, b} : index_pair{b, a};
    }
};

struct entry_touch {
    const std::uint64_t* first;
    ABUT_HD execution::least_value operator()(std::size_t i) const { return {0, first[i]}; }
};

template <class View>
struct write_body_separation {
    using T = typename View::T;
    View list;
    std::uint64_t key;
    bool touch;
    body_separation<T>* out;
    ABUT_HD void operator()(std::size_t) const {
        const entry_pair at = list.key.unpack(key);
        const index_pair of = list.bodies[at.entry];
        const separation<T> found = separation_of(list.shape_a(key), list.shape_b(key), touch);
        *out = {of.a, of.b, at.a, at.b, found.point_a, found.point_b, found.distance};
    }
};

/// All pairs of bodies whose boxes are near each other, as entries of a list.
template <class Policy, class Index, class Nearness>
auto pair_up_near(const Policy& on, const body_state<Index>& state, const char* function, const Nearness& near) {
    const int bits = id_bits(state.tree.size());
    const pair_key key{bits, bits};
    const auto keys = find_near(on, state.tree, key, true, whole_search{}, near);
    return pair_up_entries<names_of_entries>(
        on, state.placed, state.placed, keys.size(), near_bodies{keys.data(), key, state.with_shapes->data()},
        list_options<before_first_touch<list_key>>{}, function, "pairs of bodies whose boxes are near", near);
}

/// What a key of a pairing of bodies says.
template <class Policy, class Pairing>
auto separation_of_bodies(const Policy& on, const Pairing& pairing, std::uint64_t key, bool touch) {
    const auto view = pairing.view();
    using view_type = std::remove_const_t<decltype(view)>;
    using found_type = body_separation<typename view_type::T>;
    execution::buffer_of<Policy, found_type> there(on, 1);
    for_each_index(on, 1, write_body_separation<view_type>{view, key, touch, there.data()});
    found_type found{};
    download(on, there.data(), 1, &found);
    return found;
}

/// The least of all entries, of which nothing touches, that is no farther than a bound.
template <class Policy, class Pairing>
execution::least_value nearest_of_entries(const Policy& on, const Pairing& pairing, double bound) {
    const auto view = pairing.view();
    using view_type = std::remove_const_t<decltype(view)>;
    const std::size_t n = pairing.members.size();
    execution::buffer_of<Policy, std::uint64_t> none(on, n);
    fill(on, none.data(), n, no_pair);
    execution::best_of_all<space_of<Policy>> best(on, bound);
    for_each_ordered(on, n, walk_entry<view_type, typename Pairing::tree_a, typename Pairing::tree_b>{view, none.data()},
                     best);
    return best.least();
}

template <execution_policy Policy, class Index>
auto ask_least(const Policy& on, const ask_distance& question, const bodies<Index>& all, each_other) {
    using T = typename Index::scalar_type;
    using answer = std::optional<body_separation<T>>;
    constexpr bool are = can_be_measured<Policy, Index, Index>();
    if constexpr (are) {
        const double below = question.options.below;
        check(question.options, question.function);
        require_same_device(on, all, question.function);
        const body_state<Index>& state = parts_of_bodies::of(all);
        const std::size_t n = state.with_shapes->size();
        if (n < 2 || !(below > 0)) return answer();
        auto touching = pair_up_near(on, state, question.function, near_enough_to_touch{});
        const std::size_t near = touching.members.size();
        const auto touches = first_touches(on, touching, near);
        const execution::least_value first =
            reduce(on, near, execution::least_value{}, execution::lesser_value{}, entry_touch{touches.data()});
        if (first.key != no_pair) return answer(separation_of_bodies(on, touching, first.key, true));

        double bound = bound_below<T>(below);
        const auto order = order_on_curve(on, typename bodies<Index>::boxes_type(state.boxes.data(), n));
        const auto neighbours = pair_up_entries<names_of_entries>(
            on, state.placed, state.placed, n - 1, next_in_order{order.data(), state.with_shapes->data()},
            list_options<before_first_touch<list_key>>{}, question.function, "bodies", near_enough_to_touch{});
        bound = least(bound, nearest_of_entries(on, neighbours, bound).value);
        const T reach = rounded_up<T>(
            least(bound * (1 + 64 * static_cast<double>(unit_roundoff<T>)), static_cast<double>(largest_finite<T>)));
        const auto pairing = pair_up_near(on, state, question.function, near_in_distance<T>{distance_frame<T>(reach)});
        const execution::least_value found = nearest_of_entries(on, pairing, bound);
        if (found.key == no_pair) return answer();
        const body_separation<T> apart = separation_of_bodies(on, pairing, found.key, false);
        const bool is = static_cast<double>(apart.distance) < below || below == infinity<double>;
        return is ? answer(apart) : answer();
    } else {
        return answer();
    }
}
template <execution_policy Policy, class Index>
auto ask_least(const Policy& on, const ask_distance& question, const std::vector<posed_object<Index>>& list,
               each_other all) {
    if constexpr (can_be_listed<Policy, Index>()) {
        return ask_least(on, question, bodies_of(on, list, question.function), all);
    } else {
        return std::optional<body_separation<float>>();
    }
}

}  // namespace detail

/// How far apart the nearest two shapes of two different bodies are: a std::optional<body_separation<T>>. Of each two bodies
/// it is what `distance` says of their posed indices; of equal distances, and of those that touch, it has the least bodies,
/// then the least ids. It is empty where fewer than two bodies have shapes, and where nothing is nearer than
/// `options.below`.
///
/// Of several devices and of ranks: not yet; ask what lies on one, or the list of the pairs that may be near.
///
///     if (const auto apart = abut::distance(on, bodies)) use(apart->body_a, apart->body_b, apart->distance);
/// @ingroup many_bodies
template <execution_policy Policy, many_bodies Bodies>
[[nodiscard]] auto distance(const Policy& on, const Bodies& all, const distance_options& options = {}) {
    return ask_least(on, detail::ask_distance{options}, all, detail::each_other{});
}

}  // namespace abut
