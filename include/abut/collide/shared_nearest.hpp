// SPDX-License-Identifier: MIT
#pragma once

// The nearest pairs of shapes of two trees, or of the trees of many entries at once, by threads that share the work: what a
// device does for `distance` (distance.hpp, list_distance.hpp). A host walks each pair of trees alone, nearest first.
//
// A first bound comes from many short looks: from a pair of nodes always on to the nearest pair of children. Then pairs of
// nodes are opened by the verb for_each_descendant, as for the queries of pairs, but where a pair of boxes is surely farther
// apart than the least distance of its entry so far, which is a word that all threads lower. Opening passes over nothing
// that may be as good, so that the least distance is the same whatever the order. Which of equally distant pairs has the
// least key is found afterwards: of those that were as near as anything when they were measured, or, where there were too
// many to be kept, by opening all once more with the bound that is known by then. So memory has a bound.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/keys.hpp>
#include <abut/collide/list_pairing.hpp>
#include <abut/collide/shares.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/generic.hpp>
#include <abut/narrow/measure_apart.hpp>
#include <abut/shape/pair_reach.hpp>
#include <abut/traverse/ordered_pair_walk.hpp>
#include <abut/traverse/seeds.hpp>

namespace abut::detail {

/// What is known by now of the nearest of each slot, which is an entry, or all of them: the least distance, as the bits of a double, whose order is that of numbers from 0 on; and
/// the way between two shapes that were as near at some time, in the world, in floats. It is a hint: its three numbers may
/// come from two ways.
struct nearest_so_far {
    std::uint64_t* least;
    std::uint32_t* way;  ///< three of each slot

    [[nodiscard]] ABUT_HD double bound(std::uint32_t slot) const {
        return ABUT_BIT_CAST(double, execution::atomic_load(least + slot));
    }
    [[nodiscard]] ABUT_HD vec3<double> along(std::uint32_t slot) const {
        const std::uint32_t* const at = way + 3 * std::size_t{slot};
        return {static_cast<double>(ABUT_BIT_CAST(float, execution::atomic_load(at))),
                static_cast<double>(ABUT_BIT_CAST(float, execution::atomic_load(at + 1))),
                static_cast<double>(ABUT_BIT_CAST(float, execution::atomic_load(at + 2)))};
    }
    ABUT_HD void lower(std::uint32_t slot, const distance_and_way& found) const {
        execution::atomic_min(least + slot, ABUT_BIT_CAST(std::uint64_t, found.distance));
        std::uint32_t* const at = way + 3 * std::size_t{slot};
        execution::atomic_store(at, ABUT_BIT_CAST(std::uint32_t, static_cast<float>(found.way.x)));
        execution::atomic_store(at + 1, ABUT_BIT_CAST(std::uint32_t, static_cast<float>(found.way.y)));
        execution::atomic_store(at + 2, ABUT_BIT_CAST(std::uint32_t, static_cast<float>(found.way.z)));
    }
};

// Who is asked: scene.seeds() pairs of nodes, scene.seed(i); of an entry scene.walk_of(entry) and scene.reach_of(entry), which
// has no bound yet; its scene.slot_of(entry); scene.pack(entry, id, id), scene.entry_of(key), scene.shape_a(key) and
// scene.shape_b(key).

struct entry_and_nodes {
    static constexpr std::uint32_t nowhere = static_cast<std::uint32_t>(-1);
    std::uint32_t entry;
    tree_pair nodes;
    [[nodiscard]] ABUT_HD bool is() const { return nodes.a != nowhere && nodes.b != nowhere; }
};

/// Two trees, down from pairs of nodes at a depth, or from a part of these.
template <class Walk, class Reach, class View, class Part>
struct two_trees {
    using T = typename Walk::T;
    Walk walk;
    Reach reach;
    View both;
    seeds_below<Walk> from;
    Part part;

    [[nodiscard]] std::size_t seeds() const { return from.count(); }
    [[nodiscard]] ABUT_HD entry_and_nodes seed(std::size_t i) const {
        if constexpr (!std::same_as<Part, whole_search>) {
            if (!part.has(i)) return {0, {entry_and_nodes::nowhere, 0}};
        }
        return {0, from(i)};
    }
    [[nodiscard]] ABUT_HD const Walk& walk_of(std::uint32_t) const { return walk; }
    [[nodiscard]] ABUT_HD Reach reach_of(std::uint32_t) const { return reach; }
    [[nodiscard]] ABUT_HD std::uint32_t slot_of(std::uint32_t) const { return 0; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t, std::uint32_t a, std::uint32_t b) const { return both.pack(a, b); }
    [[nodiscard]] ABUT_HD std::uint32_t entry_of(std::uint64_t) const { return 0; }
    [[nodiscard]] ABUT_HD auto shape_a(std::uint64_t key) const { return both.shape_a(key); }
    [[nodiscard]] ABUT_HD auto shape_b(std::uint64_t key) const { return both.shape_b(key); }
};

/// The trees of those entries of a list that have nodes, and in which nothing touches.
template <class View, class TreeA, class TreeB>
struct trees_of_entries {
    using T = typename View::T;
    using walk = ordered_pair_walk<TreeA, TreeB>;
    using reach = near_posed_boxes<T>;
    View list;
    some_entries walked;
    const reach* reaches;          ///< of each entry
    const std::uint64_t* touches;  ///< likewise; null where nothing does
    bool as_one;                   ///< the nearest of all entries is wanted
    int depth;                     ///< of seeds

    [[nodiscard]] std::size_t seeds() const { return walked.count << 2 * depth; }
    [[nodiscard]] ABUT_HD entry_and_nodes seed(std::size_t i) const {
        const std::uint32_t entry = walked[i >> 2 * depth];
        if (touches != nullptr && touches[entry] != static_cast<std::uint64_t>(-1)) return {entry, {entry_and_nodes::nowhere, 0}};
        const walk both = walk_of(entry);
        const std::size_t paths = std::size_t{1} << depth;
        return {entry, {descent_path<TreeA>{both.a, depth}.end(i % paths), descent_path<TreeB>{both.b, depth}.end(i / paths % paths)}};
    }
    [[nodiscard]] ABUT_HD walk walk_of(std::uint32_t entry) const {
        const list_member<T>& m = list.members[entry];
        return {list.a.objects[m.object_a].tree, list.b.objects[m.object_b].tree};
    }
    [[nodiscard]] ABUT_HD reach reach_of(std::uint32_t entry) const { return reaches[entry]; }
    [[nodiscard]] ABUT_HD std::uint32_t slot_of(std::uint32_t entry) const { return as_one ? 0 : entry; }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t entry, std::uint32_t a, std::uint32_t b) const {
        return list.key.pack(entry, a, b);
    }
    [[nodiscard]] ABUT_HD std::uint32_t entry_of(std::uint64_t key) const { return list.key.unpack(key).entry; }
    [[nodiscard]] ABUT_HD auto shape_a(std::uint64_t key) const { return list.shape_a(key); }
    [[nodiscard]] ABUT_HD auto shape_b(std::uint64_t key) const { return list.shape_b(key); }
};
template <class View>
struct make_reach {
    using T = typename View::T;
    View list;
    near_posed_boxes<T>* reaches;
    ABUT_HD void operator()(std::size_t i) const {
        const index_pair of = list.bodies[i];
        reaches[i] = near_posed_boxes<T>(list.a.poses[of.a], list.a.object(of.a).bounds, list.b.poses[of.b], list.b.object(of.b).bounds);
    }
};

template <class Scene>
ABUT_NOINLINE ABUT_HD distance_and_way measure_of_key(const Scene& scene, std::uint64_t key, double bound,
                                                      const vec3<double>& along) {
    return measure_apart{}.look(scene.shape_a(key), scene.shape_b(key), bound, along);
}

/// A first bound: one pair of shapes below each seed.
template <class Scene>
struct look_once {
    Scene scene;
    nearest_so_far known;

    struct best_of_slot {
        const nearest_so_far& known;
        std::uint32_t slot;
        [[nodiscard]] ABUT_HD double bound() const { return known.bound(slot); }
    };
    struct measure_pair {
        const Scene& scene;
        const nearest_so_far& known;
        std::uint32_t entry;
        ABUT_CALLS_ANY
        ABUT_HD void operator()(std::uint32_t a, std::uint32_t b) const {
            const std::uint32_t slot = scene.slot_of(entry);
            const double bound = known.bound(slot);
            const distance_and_way found = measure_of_key(scene, scene.pack(entry, a, b), bound, {0, 0, 0});
            if (found.distance < bound) known.lower(slot, found);
        }
    };
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        const entry_and_nodes at = scene.seed(i);
        if (!at.is()) return;
        auto reach = scene.reach_of(at.entry);
        scene.walk_of(at.entry).descend(at.nodes, reach, best_of_slot{known, scene.slot_of(at.entry)},
                                         measure_pair{scene, known, at.entry});
    }
};

/// One step down, as for_each_descendant takes it.
template <class Scene>
struct open_near_pairs {
    using T = typename Scene::T;
    struct item {
        std::uint32_t entry;
        tree_pair nodes;
        T least;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = 4, most_depth = bvh_max_depth;
    Scene scene;
    nearest_so_far known;

    template <class Emitter>
    struct hand_on {
        const Scene& scene;
        Emitter& emitter;
        std::uint32_t entry;
        ABUT_CALLS_ANY
        template <class Number, class Walk>
        ABUT_INLINE ABUT_HD void take(Number k, bool kept, const tree_pair& nodes, T least, const Walk& walk) const {
            const bool is_last = Walk::is_pair_of_leaves(nodes);
            emitter.add(k, kept && !is_last, item{entry, nodes, least});
            std::uint64_t key = 0;
            if (kept && is_last) key = scene.pack(entry, shape_of_leaf(walk.a, nodes.a), shape_of_leaf(walk.b, nodes.b));
            emitter.push(k, kept && is_last, key);
        }
    };

    [[nodiscard]] std::size_t seeds() const { return scene.seeds(); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        const entry_and_nodes at = scene.seed(i);
        return {at.entry, at.is() ? at.nodes : tree_pair{entry_and_nodes::nowhere, 0}, 0};
    }
    void prefetch(const item&) const {}
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        if (at.nodes.a == entry_and_nodes::nowhere) return;
        auto reach = scene.reach_of(at.entry);
        const std::uint32_t slot = scene.slot_of(at.entry);
        reach.shrink_to(known.bound(slot));
        if (!reach.keeps(at.least)) return;
        reach.turn_to(known.along(slot));
        const auto& walk = scene.walk_of(at.entry);
        const hand_on<std::remove_reference_t<Emitter>> hands{scene, emitter, at.entry};
        walk.open_four(at.nodes, reach, [&](auto k, bool kept, const tree_pair& nodes, T least) {
            hands.take(k, kept, nodes, least, walk);
        });
    }
};

/// Measures, and lowers what is known. Pairs that are as near as anything by then are kept, as far as there is room.
template <class Scene>
struct measure_near_pairs {
    Scene scene;
    nearest_so_far known;
    std::uint64_t* kept;
    std::uint64_t* count;
    std::uint64_t room;

    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint64_t key, auto&...) const {
        const std::uint32_t slot = scene.slot_of(scene.entry_of(key));
        const double bound = known.bound(slot);
        const distance_and_way found = measure_of_key(scene, key, bound, known.along(slot));
        if (!(found.distance <= bound)) return true;
        if (found.distance < bound) known.lower(slot, found);
        const std::uint64_t at = execution::atomic_add(count, std::uint64_t{1});
        if (at < room) kept[at] = key;
        return true;
    }
    ABUT_CALLS_ANY
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

/// Of pairs that are as near as the nearest of their slot the least key.
template <class Scene>
struct choose_least_key {
    Scene scene;
    nearest_so_far known;
    std::uint64_t* keys;  ///< of each slot

    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint64_t key, auto&...) const {
        const std::uint32_t slot = scene.slot_of(scene.entry_of(key));
        if (key >= execution::atomic_load(keys + slot)) return true;
        const double bound = known.bound(slot);
        if (measure_of_key(scene, key, bound, known.along(slot)).distance == bound) execution::atomic_min(keys + slot, key);
        return true;
    }
    ABUT_CALLS_ANY
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};
template <class Scene>
struct choose_among_kept {
    choose_least_key<Scene> choose;
    const std::uint64_t *kept, *count;
    std::uint64_t room;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t i) const {
        if (i < *count && *count <= room) choose(kept[i]);
    }
};
/// Nothing is known but a bound.
struct begin_nearest {
    std::size_t slots;
    std::uint64_t bound;
    std::uint64_t *least, *keys, *count;
    std::uint32_t* way;
    ABUT_HD void operator()(std::size_t i) const {
        if (i < slots) least[i] = bound, keys[i] = static_cast<std::uint64_t>(-1);
        if (i < 3 * slots) way[i] = 0;
        if (i == 0) *count = 0;
    }
};

/// Of each of n slots the least distance that is no more than a bound, and the least key of pairs as far apart; or no key.
template <class Policy>
class shared_nearest {
public:
    static constexpr std::size_t enough_room = std::size_t{1} << 16, enough_for_one = std::size_t{1} << 13;

    /// `first` is the scene from the seeds of which the short looks begin. Nothing is kept of more pairs than `room`.
    template <class First, class Scene>
    shared_nearest(const Policy& on, std::size_t n, double bound, const First& first, const Scene& scene,
                   std::size_t room = enough_room)
        : slots_(n), words_(on, 2 * n + 1) {
        execution::buffer_of<Policy, std::uint32_t> way(on, 3 * n);
        execution::buffer_of<Policy, std::uint64_t> kept(on, room);
        std::uint64_t* const count = words_.data() + 2 * n;
        for_each_index(on, 3 * n, begin_nearest{n, ABUT_BIT_CAST(std::uint64_t, bound), words_.data(), words_.data() + n, count, way.data()});
        const nearest_so_far known{words_.data(), way.data()};
        const std::size_t spread = spread_of(first.seeds());
        for_each_index(on, first.seeds() * spread, by_one_lane<look_once<First>>{{first, known}, spread});
        const open_near_pairs<Scene> open{scene, known};
        for_each_descendant(on, open, measure_near_pairs<Scene>{scene, known, kept.data(), count, room});
        const choose_least_key<Scene> choose{scene, known, words_.data() + n};
        for_each_index(on, room, choose_among_kept<Scene>{choose, kept.data(), count, room});
        // Of one slot all words come at once.
        const std::size_t from = n == 1 ? 0 : 2;
        download(on, n == 1 ? words_.data() : count, 3 - from, of_one_ + from);
        if (of_one_[2] > room) {
            for_each_descendant(on, open, choose);
            download(on, n == 1 ? words_.data() : count, 3 - from, of_one_ + from);
        }
    }
    /// By slots, in the policy's memory: bits of a double, and keys.
    ///@{
    [[nodiscard]] const std::uint64_t* least() const { return words_.data(); }
    [[nodiscard]] const std::uint64_t* keys() const { return words_.data() + slots_; }
    ///@}
    /// Of the only slot. Infinite, with no key, where nothing is no farther than the bound.
    [[nodiscard]] execution::least_value of_one() const {
        if (of_one_[1] == static_cast<std::uint64_t>(-1)) return {};
        return {ABUT_BIT_CAST(double, of_one_[0]), of_one_[1]};
    }

private:
    std::size_t slots_;
    execution::buffer_of<Policy, std::uint64_t> words_;  ///< least distances, keys, and how many pairs were kept
    std::uint64_t of_one_[3];                            ///< the same of one slot, on the host
};

/// Entries of a pairing both of whose trees have nodes.
template <class Pairing>
some_entries entries_with_nodes(const Pairing& pairing) {
    if (pairing.all_walked) return {nullptr, pairing.members.size()};
    return {pairing.walked.data(), pairing.walked.size()};
}
/// The nearest in the trees of those entries, of each entry or of all as one. Nothing touches in entries whose word of `touches`
/// is ~0, or in any where that is null; others are passed over.
template <class Policy, class Pairing>
shared_nearest<Policy> nearest_in_trees(const Policy& on, const Pairing& pairing, const std::uint64_t* touches, double bound,
                                        bool as_one, std::size_t room = shared_nearest<Policy>::enough_room) {
    const auto view = pairing.view();
    using view_type = std::remove_const_t<decltype(view)>;
    using trees = trees_of_entries<view_type, typename Pairing::tree_a, typename Pairing::tree_b>;
    const std::size_t n = pairing.members.size();
    const some_entries walked = entries_with_nodes(pairing);
    execution::buffer_of<Policy, typename trees::reach> reaches(on, n);
    for_each_index(on, n, make_reach<view_type>{view, reaches.data()});
    // Each entry has so many short looks, and so many seeds, that there are some thousands in all, but one of each at least.
    const auto depth = [&](std::size_t most) {
        int levels = 4;
        while (levels > 0 && walked.count << 2 * levels > most) --levels;
        return levels;
    };
    trees first{view, walked, reaches.data(), touches, as_one, depth(std::size_t{1} << 16)}, all = first;
    all.depth = depth(std::size_t{1} << 12);
    return shared_nearest<Policy>(on, as_one ? 1 : n, bound, first, all, room);
}

}  // namespace abut::detail
