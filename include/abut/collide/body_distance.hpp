// SPDX-License-Identifier: MIT
#pragma once

// distance of bodies: the nearest two shapes of two different ones. First it is decided which bodies touch (body_pairs.hpp).
// Where none do, neighbours along a curve are measured, which gives a bound, and then the bodies whose boxes are no farther
// apart than that. What is decided and measured of two bodies is what distance.hpp says of their posed indices.

#include <array>
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

/// All pairs of bodies whose boxes are near each other, or a part of them, as entries of a list.
template <class Policy, class Index, class Nearness, class Part>
auto pair_up_near(const Policy& on, const body_state<Index>& state, const char* function, const Nearness& near,
                  const Part& part) {
    const int bits = id_bits(state.tree.size());
    const pair_key key{bits, bits};
    const std::uint32_t* const of = state.with_shapes->data();
    const auto keys = find_near(on, state.tree, key, true, part, near);
    return pair_up_entries<names_of_entries>(
        on, state.placed, state.placed, keys.size(), near_bodies{keys.data(), key, of, of},
        list_options<before_first_touch<list_key>>{}, function, noun_of_near, near);
}

/// And of bodies of one scene with those of another.
template <class Policy, class IndexA, class IndexB, class Nearness>
auto pair_up_near(const Policy& on, const body_state<IndexA>& a, const body_state<IndexB>& b, const char* function,
                  const Nearness& near) {
    const pair_key key{id_bits(a.tree.size()), id_bits(b.tree.size())};
    const auto keys = find_near(on, a.tree, b.tree, key, true, whole_search{}, near, keep_all{});
    return pair_up_entries<names_of_entries>(
        on, a.placed, b.placed, keys.size(), near_bodies{keys.data(), key, a.with_shapes->data(), b.with_shapes->data()},
        list_options<before_first_touch<list_key>>{}, function, noun_of_near, near);
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

/// The least of all entries, of which nothing touches, that is no farther than a bound. Ties: as of walk_entries.
template <class Policy, class Pairing>
execution::least_value nearest_of_entries(const Policy& on, const Pairing& pairing, double bound, ties_of_objects* ties) {
    const std::size_t n = pairing.members.size();
    execution::buffer_of<Policy, std::uint64_t> none(on, n);
    fill(on, none.data(), n, no_pair);
    execution::best_of_all<space_of<Policy>> best(on, bound);
    walk_entries(on, pairing, none.data(), best, ties);
    if constexpr (!host_policy<Policy>) {
        if (entries_with_nodes(pairing).count > 0) {
            best.offer(nearest_in_trees(on, pairing, nullptr, least(bound, best.least().value), true).of_one());
        }
    }
    return best.least();
}

/// The nearest two so far: 0 of what touches.
template <scalar T>
struct bodies_apart {
    double measure = infinity<double>;
    std::optional<body_separation<T>> found = {};

    [[nodiscard]] bool comes_before(const bodies_apart& other) const {
        if (!found || !other.found) return found.has_value();
        if (measure != other.measure) return measure < other.measure;
        const auto ids = [](const body_separation<T>& x) { return std::array{x.body_a, x.body_b, x.a, x.b}; };
        return ids(*found) < ids(*other.found);
    }
};

/// The first of the entries whose bodies touch.
template <class Policy, class Pairing>
auto first_touching(const Policy& on, Pairing pairing) {
    bodies_apart<typename Pairing::T> best;
    const std::size_t n = pairing.members.size();
    const auto touches = first_touches(on, pairing, n);
    const execution::least_value first =
        reduce(on, n, execution::least_value{}, execution::lesser_value{}, entry_touch{touches.data()});
    if (first.key != no_pair) best = {0, separation_of_bodies(on, pairing, first.key, true)};
    return best;
}
/// Of a part of all pairs.
template <class Policy, class Index, class Part>
auto touching_bodies(const Policy& on, const bodies<Index>& all, const char* function, const Part& part) {
    return first_touching(on, pair_up_near(on, parts_of_bodies::of(all), function, near_enough_to_touch{}, part));
}

/// Of bodies of which none touch: the nearest two, no farther than `bound`; pair_up(near) pairs up those that are near.
template <scalar T, class Policy, class PairUp>
bodies_apart<T> nearest_within(const Policy& on, double bound, ties_of_objects* ties, const PairUp& pair_up) {
    const T reach = rounded_up<T>(
        least(bound * (1 + 64 * static_cast<double>(unit_roundoff<T>)), static_cast<double>(largest_finite<T>)));
    const auto pairing = pair_up(near_in_distance<T>{distance_frame<T>(reach)});
    const execution::least_value found = nearest_of_entries(on, pairing, bound, ties);
    bodies_apart<T> best;
    if (found.key != no_pair) best = {found.value, separation_of_bodies(on, pairing, found.key, false)};
    return best;
}

/// Of bodies of which none touch: the nearest two below a bound, of a part of all pairs.
template <class Policy, class Index, class Part>
auto nearest_bodies(const Policy& on, const bodies<Index>& all, double below, const char* function, const Part& part) {
    using T = typename Index::scalar_type;
    const body_state<Index>& state = parts_of_bodies::of(all);
    const std::size_t n = state.with_shapes->size();
    const auto order = order_on_curve(on, typename bodies<Index>::boxes_type(state.boxes.data(), n));
    const auto neighbours = pair_up_entries<names_of_entries>(
        on, state.placed, state.placed, n - 1, next_in_order{order.data(), state.with_shapes->data()},
        list_options<before_first_touch<list_key>>{}, function, "bodies", near_enough_to_touch{});
    ties_of_objects ties(state.placed.objects->indices);
    const double most = bound_below<T>(below), bound = least(most, nearest_of_entries(on, neighbours, most, &ties).value);
    return nearest_within<T>(on, bound, &ties, [&](const auto& near) { return pair_up_near(on, state, function, near, part); });
}

/// The distance of bodies, by the best of all parts: of_parts(look) is the best that look(on, bodies, part) finds.
template <scalar T, class OfParts>
std::optional<body_separation<T>> least_of_bodies(const ask_distance& question, std::size_t bodies,
                                                  const OfParts& of_parts) {
    const double below = question.options.below;
    const char* const function = question.function;
    if (bodies < 2 || !(below > 0)) return std::nullopt;
    bodies_apart<T> best = of_parts(
        [&](const auto& on, const auto& all, const auto& part) { return touching_bodies(on, all, function, part); });
    if (!best.found) {
        best = of_parts([&](const auto& on, const auto& all, const auto& part) {
            return nearest_bodies(on, all, below, function, part);
        });
    }
    const bool is = best.found && (static_cast<double>(best.found->distance) < below || below == infinity<double>);
    return is ? best.found : std::nullopt;
}

template <execution_policy Policy, class Index>
auto ask_least(const Policy& on, const ask_distance& question, const bodies<Index>& all, each_other) {
    using T = typename Index::scalar_type;
    if constexpr (can_be_measured<Policy, Index, Index>()) {
        check(question.options, question.function);
        require_same_device(on, all, question.function);
        return least_of_bodies<T>(question, parts_of_bodies::of(all).with_shapes->size(),
                                  [&](const auto& look) { return look(on, all, whole_search{}); });
    } else {
        return std::optional<body_separation<T>>();
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
/// Several devices (@ref devices), each of which has all bodies, share out the pairs of bodies. Bodies of ranks lie on one
/// machine each: ask those of a rank by its local policy.
///
///     if (const auto apart = abut::distance(on, bodies)) use(apart->body_a, apart->body_b, apart->distance);
/// @ingroup many_bodies
template <executor On, class Bodies>
    requires(many_bodies<Bodies> || detail::is_mixed_bodies<Bodies>)
[[nodiscard]] auto distance(const On& on, const Bodies& all, const distance_options& options = {}) {
    return ask_least(on, detail::ask_distance{options}, all, detail::each_other{});
}

}  // namespace abut
