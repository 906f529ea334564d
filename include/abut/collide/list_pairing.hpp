// SPDX-License-Identifier: MIT
#pragma once

// Who pairs up in a query of many pairs of bodies: the counterpart of `pairing` for two operands. All trees are walked
// together, down from all pairs of roots. Who asks says by a functor which two bodies an entry is of, and by a type how
// shapes of an entry are named; all else is one for lists of pairs (list.hpp) and scenes of bodies (body_pairs.hpp).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/nearness.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pair_up.hpp>
#include <abut/collide/placed.hpp>
#include <abut/narrow/contact.hpp>
#include <abut/shape/relative_pose.hpp>
#include <abut/traverse/bvh_walk.hpp>
#include <abut/traverse/posed_walk.hpp>

namespace abut::detail {

/// How the trees of an entry lie to each other: 64 bytes in float, one fetch.
template <scalar T>
struct alignas(16) list_member {
    std::uint32_t object_a, object_b;
    vec3<T> rotation[3], translation;
    T deviation, slack;

    /// For walks.
    [[nodiscard]] ABUT_INLINE ABUT_HD two_frames<T> frames() const {
        return {{{rotation[0], rotation[1], rotation[2]},
                 {absolute(rotation[0]), absolute(rotation[1]), absolute(rotation[2])},
                 translation,
                 deviation,
                 slack}};
    }
};

/// Finds out how an entry lies. `Entries` says which two bodies it is of: entries(i) is an index_pair.
template <class IndexA, class IndexB, class Entries, class Nearness>
struct make_member {
    using T = typename IndexA::scalar_type;
    placed_view<IndexA> a;
    placed_view<IndexB> b;
    Entries entries;
    index_pair* bodies;
    list_member<T>* members;
    Nearness near;

    ABUT_HD void operator()(std::size_t i) const {
        const index_pair of = entries(i);
        const std::uint32_t object_a = a.object_of[of.a], object_b = b.object_of[of.b];
        const relative_pose<T> r =
            make_relative_pose(a.poses[of.a], a.objects[object_a].bounds, b.poses[of.b], b.objects[object_b].bounds);
        bodies[i] = of;
        members[i] = {object_a,      object_b,    {r.rotation[0], r.rotation[1], r.rotation[2]},
                      r.translation, r.deviation, near.slack(r.slack)};
    }
};

/// A pair of shapes by the number of its entry and two ids.
struct entry_pair {
    std::uint32_t entry, a, b;
};

/// Its number: the entry above the two ids.
struct list_key {
    int entry_bits;
    pair_key pair;

    [[nodiscard]] int bits() const { return entry_bits + pair.bits(); }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t entry, std::uint32_t a, std::uint32_t b) const {
        return (std::uint64_t{entry} << pair.a_bits | a) << pair.b_bits | b;
    }
    [[nodiscard]] ABUT_HD entry_pair unpack(std::uint64_t key) const {
        const auto entry = static_cast<std::uint32_t>(key >> (pair.a_bits + pair.b_bits));
        return {entry, pair.a(key) & static_cast<std::uint32_t>((std::uint64_t{1} << pair.a_bits) - 1), pair.b(key)};
    }
};

/// What a kernel sees of a list, as pair_view of two operands. `Names` says how pairs and contacts are named:
/// Names::pair(entry, bodies, a, b), Names::tagged(pair, contact).
template <class Names, class IndexA, class IndexB, class Filter>
struct list_view {
    using T = typename IndexA::scalar_type;
    using shape_type_a = shape_in_world<IndexA>;
    using shape_type_b = shape_in_world<IndexB>;

    placed_view<IndexA> a;
    placed_view<IndexB> b;
    const index_pair* bodies;  ///< of each entry
    const list_member<T>* members;
    list_key key;
    Filter filter;

    [[nodiscard]] ABUT_HD shape_type_a shape_a(std::uint64_t k) const {
        const entry_pair at = key.unpack(k);
        return a.shape(bodies[at.entry].a, members[at.entry].object_a, at.a);
    }
    [[nodiscard]] ABUT_HD shape_type_b shape_b(std::uint64_t k) const {
        const entry_pair at = key.unpack(k);
        return b.shape(bodies[at.entry].b, members[at.entry].object_b, at.b);
    }
    [[nodiscard]] ABUT_HD auto ids(std::uint64_t k) const { return name(key.unpack(k)); }
    [[nodiscard]] ABUT_HD auto name(const entry_pair& at) const {
        return Names::pair(at.entry, bodies[at.entry], at.a, at.b);
    }
    template <class Found>
    [[nodiscard]] ABUT_HD auto tagged(std::uint64_t k, const Found& found) const {
        return Names::tagged(ids(k), found);
    }
    [[nodiscard]] ABUT_HD corner_ids vertices_a(std::uint64_t k) const {
        const entry_pair at = key.unpack(k);
        return vertices_of_shape(a.objects[members[at.entry].object_a].shapes, at.a);
    }
    [[nodiscard]] ABUT_HD corner_ids vertices_b(std::uint64_t k) const {
        const entry_pair at = key.unpack(k);
        return vertices_of_shape(b.objects[members[at.entry].object_b].shapes, at.b);
    }
    ABUT_INLINE void prefetch(std::uint64_t k, int step) const {
        const entry_pair at = key.unpack(k);
        prefetch_shape(a.objects[members[at.entry].object_a].shapes, at.a, step);
        prefetch_shape(b.objects[members[at.entry].object_b].shapes, at.b, step);
    }
};

/// The ids of one entry, for the ways to candidates (routes.hpp).
template <class View>
struct ids_of_entry {
    const View& list;
    std::uint32_t entry;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t a, std::uint32_t b) const { return list.key.pack(entry, a, b); }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t a, std::uint32_t b) const {
        return list.filter(list.name(entry_pair{entry, a, b}));
    }
};

template <class Item, class Emitter>
struct add_entry_item {
    Emitter& emitter;
    std::uint32_t entry;
    ABUT_CALLS_ANY
    template <class Number, class Nodes>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Nodes& next) const {
        emitter.add(k, is, Item{entry, next});
    }
};

/// Entries that are looked at in one way: these, or all.
struct some_entries {
    const std::uint32_t* which;  ///< null for all
    std::size_t count;
    [[nodiscard]] ABUT_HD std::uint32_t operator[](std::size_t i) const {
        return which == nullptr ? static_cast<std::uint32_t>(i) : which[i];
    }
};

/// A filter that may say of an entry that no more of it is wanted: is_open(entry).
struct closes_entries {};
template <class View>
ABUT_HD bool is_open(const View& list, [[maybe_unused]] std::uint32_t entry) {
    if constexpr (std::derived_from<decltype(View::filter), closes_entries>) {
        return list.filter.is_open(entry);
    } else {
        return true;
    }
}

/// One step down the two trees of an entry. A filter that is asked of subtrees (routes.hpp) has tables by objects.
template <class View, class TreeA, class TreeB>
struct expand_entry {
    using T = typename View::T;
    using walk = pair_walk<TreeA, TreeB, two_frames<T>>;
    struct item {
        std::uint32_t entry;
        typename walk::item nodes;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = walk::most_children, most_depth = walk::most_depth;

    View list;
    some_entries walked;  ///< both trees have nodes

    [[nodiscard]] std::size_t seeds() const { return walked.count; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        const list_member<T>& m = list.members[walked[i]];
        return {walked[i], {list.a.objects[m.object_a].tree.root().index(), list.b.objects[m.object_b].tree.root().index()}};
    }
    ABUT_INLINE void prefetch(const item& at) const {
        const list_member<T>& m = list.members[at.entry];
        const pair_walk<TreeA, TreeB, same_frame> nodes{
            list.a.objects[m.object_a].tree, list.b.objects[m.object_b].tree, {}};
        nodes.prefetch({at.nodes.a, at.nodes.b});
    }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        if (!is_open(list, at.entry)) return;
        const list_member<T> m = list.members[at.entry];
        const walk both{list.a.objects[m.object_a].tree, list.b.objects[m.object_b].tree, m.frames()};
        const ids_of_entry<View> ids{list, at.entry};
        if (!may_be_wanted(ids, m, both, at.nodes)) return;
        both.expand(at.nodes, add_entry_item<item, sink>{emitter, at.entry},
                    push_pair<false, sink, ids_of_entry<View>>{emitter, ids});
    }

private:
    [[nodiscard]] ABUT_INLINE ABUT_HD bool may_be_wanted([[maybe_unused]] const ids_of_entry<View>& ids,
                                                         [[maybe_unused]] const list_member<T>& m,
                                                         [[maybe_unused]] const walk& both,
                                                         [[maybe_unused]] const typename walk::item& at) const {
        if constexpr (asked_of_subtrees<View>) {
            if (list.filter.least_a == nullptr) return !list.filter.is_enough();
            return ids.wanted(least_id_below(both.a, at.a, list.filter.least_a[m.object_a]),
                              least_id_below(both.b, at.b, list.filter.least_b[m.object_b]));
        } else {
            return true;
        }
    }
};

/// A tree of one shape has no nodes to walk: that shape looks in the other tree.
template <class View, class TreeA, class TreeB, class Nearness>
struct look_up_entry {
    using T = typename View::T;
    using candidate = std::uint64_t;
    using cursor_a = typename bvh_walk<TreeA>::cursor;
    using cursor_b = typename bvh_walk<TreeB>::cursor;
    using cursor = std::conditional_t<(sizeof(cursor_a) > sizeof(cursor_b)), cursor_a, cursor_b>;

    View list;
    some_entries looked;  ///< one tree is of one shape, and the other one has some
    Nearness near;

    /// To find out takes as long as to begin.
    [[nodiscard]] ABUT_HD static bool may_find(std::size_t) { return true; }
    ABUT_CALLS_ANY
    template <class Emitter, class... Sinks>
    ABUT_HD bool operator()(std::size_t i, cursor& at, const Emitter& emitter, Sinks&... sinks) const {
        const ids_of_entry<View> ids{list, looked[i]};
        return with(i, [&](const auto& walk, auto& reach, auto row_is_b) {
            return walk.for_each(
                reach, at, [&] { return emitter.is_full(); },
                [&](std::uint32_t found) {
                    constexpr bool rows_are_b = decltype(row_is_b)::value;
                    if (is_wanted_by_row<rows_are_b>(ids, 0, found)) emitter.push(pack_row<rows_are_b>(ids, 0, found));
                    return execution::is_over(sinks...) ? visit::stop : visit::proceed;
                });
        });
    }

private:
    /// f(walk, reach, row_is_b) of the larger tree and the shape of the smaller one.
    ABUT_CALLS_ANY
    template <class F>
    ABUT_HD bool with(std::size_t i, const F& f) const {
        const std::uint32_t entry = looked[i];
        const list_member<T>& m = list.members[entry];
        const index_pair of = list.bodies[entry];
        const auto& object_a = list.a.objects[m.object_a];
        const auto& object_b = list.b.objects[m.object_b];
        if (object_b.tree.size() == 1) {
            const posed_walk<bvh_walk<TreeA>> walk({object_a.tree}, list.a.poses[of.a], object_a.bounds);
            auto reach = near.reach(list.b.shape(of.b, m.object_b, 0));
            return f(walk, reach, std::true_type{});
        }
        const posed_walk<bvh_walk<TreeB>> walk({object_b.tree}, list.b.poses[of.b], object_b.bounds);
        auto reach = near.reach(list.a.shape(of.a, m.object_a, 0));
        return f(walk, reach, std::false_type{});
    }
};

/// Whether both trees of an entry have nodes; or, of `OneShape`, shapes, but one of them no nodes.
template <class View, bool OneShape>
struct is_entry_with {
    View list;
    ABUT_HD bool operator()(std::size_t i) const {
        const auto& m = list.members[i];
        const std::size_t a = list.a.objects[m.object_a].tree.size(), b = list.b.objects[m.object_b].tree.size();
        const std::size_t least = a < b ? a : b;
        return OneShape ? least == 1 : least > 1;
    }
};

/// The schedule of options.
template <template <class, schedule, class...> class Options, class Filter, schedule Schedule, class... More>
execution::scheduled<Schedule> scheduled_by(const Options<Filter, Schedule, More...>& options) {
    return {options.scheduling};
}

/// Judges the candidates of all entries that `list` sees, by loops that `run` runs (judged_loops in search.hpp).
template <class Policy, class Pairing, class View, class Options, class Run>
void judge_entries(const Policy& on, const Pairing& of, const View& list, const Options& options, const Run& run) {
    using tree_a = typename Pairing::tree_a;
    using tree_b = typename Pairing::tree_b;
    const some_entries all{nullptr, of.members.size()};
    const expand_entry<View, tree_a, tree_b> step{list,
                                                  of.all_walked ? all : some_entries{of.walked.data(), of.walked.size()}};
    const auto how = scheduled_by(options);
    run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, step, judge, sinks...); });
    if (of.looked.size() == 0) return;
    const look_up_entry<View, tree_a, tree_b, decltype(Pairing::near)> each{list, {of.looked.data(), of.looked.size()}, of.near};
    run([&](const auto& judge, auto&... sinks) { return for_each_candidate(on, of.looked.size(), each, judge, sinks...); });
}

/// A list that is asked about the pairs of its entries.
template <class Policy, class Names, class IndexA, class IndexB, class Options, class Nearness>
struct list_pairing {
    using T = typename IndexA::scalar_type;
    using tree_a = typename IndexA::view_type;
    using tree_b = typename IndexB::view_type;
    using view_type = list_view<Names, IndexA, IndexB, decltype(Options::filter)>;
    using expand = expand_entry<view_type, tree_a, tree_b>;
    static_assert(decidable<shape_in_world<IndexA>, shape_in_world<IndexB>>,
                  "abut: queries between sets of these two shapes are not supported");

    placed_bodies<IndexA> a;
    placed_bodies<IndexB> b;
    Options options;
    list_key key;
    Nearness near;
    execution::buffer_of<Policy, index_pair> bodies = {};       ///< of each entry
    execution::buffer_of<Policy, list_member<T>> members = {};  ///< likewise
    bool all_walked = true;                                     ///< each entry is; then the next two are empty
    execution::buffer_of<Policy, std::uint32_t> walked = {};    ///< entries of which both trees have nodes
    execution::buffer_of<Policy, std::uint32_t> looked = {};    ///< of which one has one shape, and the other one some

    [[nodiscard]] view_type view() const { return {a.view(), b.view(), bodies.data(), members.data(), key, options.filter}; }
    [[nodiscard]] std::size_t likely_hits() const {
        const std::size_t n = members.size();
        return std::clamp(512 * n, std::size_t{1} << 16, std::max(std::size_t{1} << 22, 32 * n));
    }

    template <class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        judge_entries(on, *this, view(), options, run);
    }
};

/// `n` entries of bodies that have been checked, ready to be asked; entries(i) says which two bodies entry i is of, in the
/// policy's memory. Errors are thrown in the name of `function`, of entries called `noun`.
template <class Names, class Policy, class IndexA, class IndexB, class Entries, class Options, class Nearness>
auto pair_up_entries(const Policy& on, const placed_bodies<IndexA>& a, const placed_bodies<IndexB>& b, std::size_t n,
                     const Entries& entries, const Options& options, const char* function, const char* noun,
                     const Nearness& near) {
    using pairing = list_pairing<Policy, Names, IndexA, IndexB, Options, Nearness>;
    using T = typename pairing::T;
    const std::size_t most_a = a.objects->most_shapes, most_b = b.objects->most_shapes;
    const list_key key{id_bits(n), {id_bits(most_a), id_bits(most_b)}};
    if (key.bits() > 64 || n > std::numeric_limits<std::uint32_t>::max()) {
        throw capacity_error(std::string(function) + ": a list of " + std::to_string(n) + " " + noun + " with up to " +
                             std::to_string(most_a) + " and " + std::to_string(most_b) +
                             " shapes; expected positions and ids of 64 bits together");
    }
    constexpr std::size_t most = pairing::expand::walk::most_shapes;
    if (most_a > most || most_b > most) {
        throw capacity_error(std::string(function) + ": a body has " + std::to_string(std::max(most_a, most_b)) +
                             " shapes; one of many has at most " + std::to_string(most));
    }
    pairing list{a, b, options, key, near};
    list.bodies = execution::buffer_of<Policy, index_pair>(on, n);
    list.members = execution::buffer_of<Policy, list_member<T>>(on, n);
    for_each_index(on, n,
                   make_member<IndexA, IndexB, Entries, Nearness>{a.view(), b.view(), entries, list.bodies.data(),
                                                                  list.members.data(), near});
    list.all_walked = a.objects->all_have_nodes && b.objects->all_have_nodes;
    if (!list.all_walked) {
        using view = typename pairing::view_type;
        const auto select = [&](const auto& test) {
            execution::buffer_of<Policy, std::uint32_t> which(on, n);
            which.shrink(compact(on, n, test, which.data()));
            return which;
        };
        list.walked = select(is_entry_with<view, false>{list.view()});
        list.looked = select(is_entry_with<view, true>{list.view()});
    }
    return list;
}

}  // namespace abut::detail
