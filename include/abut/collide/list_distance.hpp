// SPDX-License-Identifier: MIT
#pragma once

// distance of a list: how far apart the two indices of each entry are, many pairs in one call. A host has a thread walk each
// entry; threads of a device share the trees of all entries (shared_nearest.hpp). What is decided and measured is that of
// two arguments (distance.hpp).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/distance.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/list_each.hpp>

namespace abut {

namespace detail {

/// Walks the trees of an entry in which nothing touches.
template <class View, class TreeA, class TreeB>
struct walk_entry {
    static constexpr std::size_t grain = 1;
    using T = typename View::T;
    static constexpr bool walks_trees = std::same_as<typename TreeA::memory_space, host_space>;
    View list;
    const std::uint64_t* touches;
    ties_of_objects *ties_a, *ties_b;  ///< null on a device

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        if (touches[i] != no_pair) return;
        const auto entry = static_cast<std::uint32_t>(i);
        const index_pair of = list.bodies[entry];
        const auto& a = list.a.object(of.a);
        const auto& b = list.b.object(of.b);
        if (a.tree.size() == 0 || b.tree.size() == 0) return;
        const std::uint32_t k_a = list.a.object_of[of.a], k_b = list.b.object_of[of.b];
        if (b.tree.size() == 1) {  // a tree of one shape has no nodes to walk
            look<true>(list.b.shape(of.b, k_b, 0), a, k_a, ties_a, list.a.poses[of.a], entry, best);
        } else if (a.tree.size() == 1) {
            look<false>(list.a.shape(of.a, k_a, 0), b, k_b, ties_b, list.b.poses[of.b], entry, best);
        } else if constexpr (walks_trees) {
            near_posed_boxes<T> reach(list.a.poses[of.a], a.bounds, list.b.poses[of.b], b.bounds);
            offer_distance<false, Best, near_posed_boxes<T>> offer{best, reach};
            ties_of_two watch(ties_a->of(k_a), a, ties_b->of(k_b), b);
            const ordered_pair_walk<TreeA, TreeB> walk{a.tree, b.tree, &watch};
            walk({a.tree.root().index(), b.tree.root().index()}, reach, best, [&](std::uint32_t id_a, std::uint32_t id_b) {
                const std::uint64_t key = list.key.pack(entry, id_a, id_b);
                return offer(list.shape_a(key), list.shape_b(key), key);
            });
        }
    }

private:
    /// The only shape of one body, which is b if `RowIsB`, looks in the other.
    ABUT_CALLS_ANY
    template <bool RowIsB, class Shape, class Object, class Best>
    ABUT_HD void look(const Shape& shape, const Object& object, [[maybe_unused]] std::uint32_t k,
                      [[maybe_unused]] ties_of_objects* ties, const rigid<T>& pose, std::uint32_t entry, Best& best) const {
        auto reach = object_sight<T>{pose, object.bounds}.box(bounds(shape));
        offer_distance<RowIsB, Best, decltype(reach)> offer{best, reach};
        const auto visit = [&](std::uint32_t found) {
            const std::uint64_t key = RowIsB ? list.key.pack(entry, found, 0) : list.key.pack(entry, 0, found);
            return offer(list.shape_a(key), list.shape_b(key), key);
        };
        ordered_tree_walk<std::remove_cvref_t<decltype(object.tree)>> walk{object.tree};
        if constexpr (walks_trees) {
            ties_of_two watch(ties->of(k), object, ties->of(k), object);
            walk.watch = &watch;
            walk(reach, best, visit);
        } else {
            walk(reach, best, visit);
        }
    }
};

/// The answers, one of each entry.
template <class View>
struct write_separations {
    using T = typename View::T;
    View list;
    const std::uint64_t* touches;
    const execution::least_value* nearest;
    double below;
    separation<T>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const bool touch = touches[i] != no_pair;
        const std::uint64_t key = touch ? touches[i] : nearest[i].key;
        out[i] = {no_id, no_id, {0, 0, 0}, {0, 0, 0}, infinity<T>};
        if (key == no_pair) return;
        const entry_pair at = list.key.unpack(key);
        separation<T> found = separation_of(list.shape_a(key), list.shape_b(key), touch);
        found.a = at.a;
        found.b = at.b;
        if (is_below(found, below)) out[i] = found;
    }
};

/// Whether nothing touches in an entry, to be added up.
struct is_entry_open {
    some_entries walked;
    const std::uint64_t* touches;
    ABUT_HD unsigned operator()(std::size_t i) const { return touches[walked[i]] == no_pair; }
};
struct add_counts {
    ABUT_HD unsigned operator()(unsigned a, unsigned b) const { return a + b; }
};
/// What the trees of entries have, in the place of what was found otherwise.
struct take_nearest_of_trees {
    some_entries walked;
    const std::uint64_t *touches, *least, *keys;
    execution::least_value* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint32_t entry = walked[i];
        if (touches[entry] == no_pair && keys[entry] != no_pair) out[entry] = {ABUT_BIT_CAST(double, least[entry]), keys[entry]};
    }
};

/// Each entry in which nothing touches is walked; on a device those alone of which a tree has one shape. What is found out of
/// ties in objects that both sides share, `ties` keeps.
template <class Policy, class Pairing, class Best>
void walk_entries(const Policy& on, const Pairing& pairing, const std::uint64_t* touches, Best& best,
                  [[maybe_unused]] ties_of_objects* ties = nullptr) {
    const auto view = pairing.view();
    walk_entry<std::remove_const_t<decltype(view)>, typename Pairing::tree_a, typename Pairing::tree_b> walk{view, touches, ties, ties};
    std::optional<ties_of_objects> of_a, of_b;
    if constexpr (host_policy<Policy>) {
        if (ties == nullptr) {
            walk.ties_a = &of_a.emplace(pairing.a.objects->indices);
            walk.ties_b = &of_b.emplace(pairing.b.objects->indices);
        }
    }
    for_each_ordered(on, pairing.members.size(), walk, best);
}

/// Whether distance takes a list of these indices.
template <class Policy, class IndexA, class IndexB>
consteval bool can_be_measured() {
    if constexpr (can_be_listed<Policy, IndexA, IndexB>()) {
        constexpr bool are = measurable<shape_in_world<IndexA>, shape_in_world<IndexB>>;
        static_assert(are, "abut: there is no distance of sets of these two shapes");
        return are;
    } else {
        return false;
    }
}

template <class Policy, class IndexA, class IndexB, class Positions = own_positions>
auto distances_of(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, const distance_options& options,
                  const char* function, const Positions& position = {}) {
    using T = typename IndexA::scalar_type;
    check(options, function);
    auto pairing = pair_up(on, list, list_options<before_first_touch<list_key>>{}, function, position);
    const std::size_t n = list.size();
    const auto touches = first_touches(on, pairing, n);
    const auto view = pairing.view();
    using view_type = std::remove_const_t<decltype(view)>;
    // Nothing is below 0: then no entry is looked at.
    execution::best_of_each<space_of<Policy>> best(on, n, bound_below<T>(options.below > 0 ? options.below : 0));
    walk_entries(on, pairing, touches.data(), best);
    if constexpr (!host_policy<Policy>) {
        const some_entries walked = entries_with_nodes(pairing);
        const auto open = [&] { return reduce(on, walked.count, 0u, add_counts{}, is_entry_open{walked, touches.data()}); };
        if (walked.count > 0 && options.below > 0 && open() > 0) {
            const auto found = nearest_in_trees(on, pairing, touches.data(), bound_below<T>(options.below), false);
            for_each_index(on, walked.count, take_nearest_of_trees{walked, touches.data(), found.least(), found.keys(), best.data()});
            synchronize(on);
        }
    }
    execution::buffer_of<Policy, separation<T>> out(on, n);
    for_each_index(on, n, write_separations<view_type>{view, touches.data(), best.data(), options.below, out.data()});
    synchronize(on);
    return result<separation<T>, space_of<Policy>>(std::move(out));
}

/// How far apart the two indices of each entry are, as an answer of each (list_each.hpp).
struct distance_of_each {
    template <class Form>
    using found_type = separation<typename Form::scalar_type>;
    template <class Policy, class Form>
    static consteval bool can_be_asked() {
        return can_be_measured<Policy, typename Form::index_a, typename Form::index_b>();
    }
    template <class Policy, class Form, class Positions>
    auto find(const Policy& on, const Form& form, const distance_options& options, const char* function,
              const Positions& position) const {
        return distances_of(on, form.list, options, function, position);
    }
};

}  // namespace detail

/// @addtogroup lists
///@{

/// How far apart the two indices of each entry are: a `result` of separation<T>, one of each entry in their order, 36 bytes
/// each in float and 64 in double. An entry in which an index is empty, or in which nothing is nearer than `options.below`,
/// has `no_id` for both ids and an infinite distance. Otherwise it is what `distance` says of the two indices alone. Ranks
/// are told of their own entries.
///
///     for (const auto& apart : abut::to_host(abut::distance(on, list))) clearance = std::min(clearance, apart.distance);
template <executor On, class IndexA, class IndexB>
[[nodiscard]] auto distance(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                            const distance_options& options = {}) {
    return ask_entries(on, detail::distance_of_each{}, detail::whole(list), options, "abut::distance");
}

///@}

}  // namespace abut
