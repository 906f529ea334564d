// SPDX-License-Identifier: MIT
#pragma once

// distance: how far apart two sets are, where, and which two shapes are the nearest.
//
// First it is decided whether any shapes touch, by the engine of all queries (first_touches.hpp). So a distance is 0 exactly where
// `any` is true. Only where none touch is anything measured: by definition the answer is then the pair with the least
// distance as narrow/distance.hpp computes it in double, and of equal ones the one with the least ids. Everything else here
// moves time and no answer: which index there is, and in what order pairs are taken. Lists of pairs are in
// list_distance.hpp.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/executor.hpp>
#include <abut/collide/first_touches.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/pair_up.hpp>
#include <abut/collide/placed.hpp>
#include <abut/collide/shared_nearest.hpp>
#include <abut/error.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/index/least_ids.hpp>
#include <abut/narrow/measure_apart.hpp>
#include <abut/shape/pair_reach.hpp>
#include <abut/traverse/ordered_pair_walk.hpp>
#include <abut/traverse/seeds.hpp>

namespace abut {

/// Options of `distance`.
/// @ingroup queries
struct distance_options {
    /// Only what is nearer than this is looked for. What is farther is not measured, so that a small bound saves time. 0 or
    /// more; nothing is nearer than 0.
    double below = infinity<double>;
};

/// A `separation` with ids in sets of many parts.
/// @ingroup distributed
template <scalar T>
struct global_separation {
    std::uint64_t a;  ///< id of the first shape
    std::uint64_t b;  ///< id of the second one
    vec3<T> point_a;  ///< of the first shape, in the world
    vec3<T> point_b;  ///< of the second one
    T distance;       ///< between the two, rounded to T; 0 where they touch

    friend constexpr bool operator==(const global_separation&, const global_separation&) = default;
};

namespace detail {

// --- what does not touch: the least distance ---------------------------------------------------------------------------

/// Offers a sink what is measured of two shapes, in the order of the arguments, and turns the reach to where better was
/// found. What the reach sees first is the second of them if it is `Reversed`.
template <bool Reversed, class Best, class Reach>
struct offer_distance {
    Best& best;
    Reach& reach;
    vec3<double> along{0, 0, 0};  ///< the way between the nearest so far

    ABUT_CALLS_ANY
    /// Whether they are as near as the best.
    template <class S, class U>
    ABUT_HD bool operator()(const S& s, const U& t, std::uint64_t key) {
        const double bound = best.bound();
        const distance_and_way found = measure_apart{}.look(s, t, bound, along);
        best.offer(found.distance, key);
        if (!(found.distance < bound)) return found.distance == bound && bound < infinity<double>;
        along = found.way;
        reach.turn_to(Reversed ? vec3<double>{-along.x, -along.y, -along.z} : along);
        return false;
    }
};

/// What a walk through two trees does with a pair of shapes. `InWorld` says that the trees' boxes are there.
template <bool InWorld, class View, class Best, class Reach>
struct offer_pair {
    View both;
    offer_distance<false, Best, Reach>& offer;

    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t id_a, std::uint32_t id_b) const {
        return offer(both.a[id_a], both.b[id_b], both.pack(id_a, id_b));
    }
    [[nodiscard]] bool may_come_first(std::uint32_t id_a, std::uint32_t id_b) const {
        return both.pack(id_a, id_b) < offer.best.known().key;
    }
    /// No distance is measured below that of the boxes (narrow/distance.hpp).
    template <scalar T>
    [[nodiscard]] bool may_be_nearer(const aabb<T>& a, const aabb<T>& b) const requires InWorld {
        return gap_of_boxes(a, b) < offer.best.known().value;
    }
};

/// Two trees, down from pairs of nodes.
template <class Walk, class Reach, class View, bool InWorld>
struct walk_two {
    Walk walk;
    Reach reach;
    View both;
};
/// From all at a depth.
template <class Walk, class Reach, class View, bool InWorld>
struct walk_from_depth : walk_two<Walk, Reach, View, InWorld> {
    static constexpr std::size_t grain = 16;
    seeds_below<Walk> from;
    bool once;  ///< one pair of shapes below each, for a first bound

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        const auto at = from(i);
        constexpr std::uint32_t nowhere = decltype(from.a)::nowhere;
        if (at.a == nowhere || at.b == nowhere) return;
        Reach mine = this->reach;
        offer_distance<false, Best, Reach> offer{best, mine};
        const offer_pair<InWorld, View, Best, Reach> visitor{this->both, offer};
        once ? this->walk.descend(at, mine, best, visitor) : this->walk(at, mine, best, visitor);
    }
};
/// Of a host: from the roots, so many steps; and from what is left then.
///@{
template <class Walk, class Reach, class View, bool InWorld>
struct walk_alone : walk_two<Walk, Reach, View, InWorld> {
    using heap = typename Walk::template nearest_first<1024>;
    heap& pending;
    std::size_t most;

    template <class Best>
    void operator()(std::size_t, Best& best) const {
        Reach mine = this->reach;
        offer_distance<false, Best, Reach> offer{best, mine};
        const offer_pair<InWorld, View, Best, Reach> visitor{this->both, offer};
        this->walk.begin({this->walk.a.root().index(), this->walk.b.root().index()}, pending, mine, best, visitor);
        this->walk.go_on(pending, most, mine, best, visitor);
    }
};
template <class Walk, class Reach, class View, bool InWorld>
struct walk_from_rest : walk_two<Walk, Reach, View, InWorld> {
    static constexpr std::size_t grain = 4;
    const typename Walk::entry* from;  ///< null for the roots

    template <class Best>
    void operator()(std::size_t i, Best& best) const {
        Reach mine = this->reach;
        offer_distance<false, Best, Reach> offer{best, mine};
        const offer_pair<InWorld, View, Best, Reach> visitor{this->both, offer};
        if (from == nullptr) {
            this->walk({this->walk.a.root().index(), this->walk.b.root().index()}, mine, best, visitor);
        } else {
            this->walk.below(from[i], mine, best, visitor);
        }
    }
};
///@}

/// What of an ordered walk falls to a part of a search. Neighbours that are walked at a time all have work, or none.
template <class Walk>
struct ordered_walk_of_part : Walk {
    static constexpr std::size_t together = 32;
    search_part mine;
    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        if (mine.has(i / together)) Walk::operator()(i, best);
    }
};
template <class Walk>
const Walk& walk_of_part(const Walk& walk, const whole_search&) {
    return walk;
}
template <class Walk>
ordered_walk_of_part<Walk> walk_of_part(const Walk& walk, const search_part& part) {
    return {walk, part};
}

/// What shapes in the world see of an index, by the box around each: `box` for trees, `ball` for grids.
template <scalar T>
struct world_sight {
    [[nodiscard]] ABUT_HD auto box(const aabb<T>& query) const { return near_one_box<near_boxes<T>, T>{{}, query}; }
};
template <scalar T>
struct object_sight {
    rigid<T> pose;
    aabb<T> around;
    [[nodiscard]] ABUT_HD auto box(const aabb<T>& query) const {
        return near_one_box<near_posed_boxes<T>, T>{near_posed_boxes<T>(rigid<T>{}, query, pose, around), query};
    }
};

/// What a shape that looks does with one that it comes to. `InWorld` says that boxes of the walk are there.
template <bool RowsAreB, bool InWorld, class View, class Shape, class Best, class Reach>
struct offer_to_row {
    using T = scalar_type_of<Shape>;
    const View& both;
    const Shape& shape;
    std::uint32_t row;
    aabb<T> box;
    offer_distance<RowsAreB, Best, Reach>& offer;

    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t found) const {
        if constexpr (RowsAreB) {
            return offer(both.a[found], shape, both.pack(found, row));
        } else {
            return offer(shape, both.b[found], both.pack(row, found));
        }
    }
    [[nodiscard]] bool may_come_first(std::uint32_t id) const {
        return (RowsAreB ? both.pack(id, row) : both.pack(row, id)) < offer.best.known().key;
    }
    /// No distance is measured below that of the boxes (narrow/distance.hpp).
    [[nodiscard]] bool may_be_nearer(const aabb<T>& other) const requires InWorld {
        return gap_of_boxes(box, other) < offer.best.known().value;
    }
};

/// Each shape of one operand looks in the other, which has a walk of its own (ordered_walk.hpp).
template <bool RowsAreB, bool InWorld, class Walk, class Sight, class View>
struct look_from_shapes {
    static constexpr std::size_t grain = 16;
    Walk walk;
    Sight sight;
    View both;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        const auto shape = shape_of_row(i);
        const auto box = bounds(shape);
        auto reach = sight.reach_of(box);
        offer_distance<RowsAreB, Best, decltype(reach)> offer{best, reach};
        walk(reach, best, offer_to_row<RowsAreB, InWorld, View, std::remove_const_t<decltype(shape)>, Best, decltype(reach)>{
                              both, shape, static_cast<std::uint32_t>(i), box, offer});
    }

private:
    [[nodiscard]] ABUT_HD auto shape_of_row(std::size_t i) const {
        if constexpr (RowsAreB) {
            return both.b[i];
        } else {
            return both.a[i];
        }
    }
};

/// Sights of trees are boxes.
template <class Frame>
struct sight_of_tree : Frame {
    template <scalar T>
    [[nodiscard]] ABUT_HD auto reach_of(const aabb<T>& query) const {
        return Frame::box(query);
    }
};
/// Those of grids are balls, of a frame of nearest.hpp.
template <class Frame>
struct sight_of_grid : Frame {
    template <scalar T>
    [[nodiscard]] ABUT_HD auto reach_of(const aabb<T>& query) const {
        const auto middle = [](T lower, T upper) {
            const T m = T(0.5) * lower + T(0.5) * upper;
            return is_finite(m) ? m : T(0);
        };
        const vec3<T> c{middle(query.lower.x, query.upper.x), middle(query.lower.y, query.upper.y),
                        middle(query.lower.z, query.upper.z)};
        const vec3<double> half = greatest(widened(c) - widened(query.lower), widened(query.upper) - widened(c));
        return near_ball_of_box<T>(Frame::ball_around(c), std::sqrt(dot(half, half)) * (1 + 0x1p-50));
    }
};
/// Of plain sets: all boxes are looked at.
struct sight_of_list {
    template <scalar T>
    [[nodiscard]] ABUT_HD auto reach_of(const aabb<T>& query) const {
        return near_one_box<near_boxes<T>, T>{{}, query};
    }
};
/// How many levels down two trees are dealt out: so that each of `concurrency` threads finds some.
inline int depth_of_seeds(int concurrency) { return concurrency <= 1 ? 0 : concurrency <= 16 ? 5 : 6; }

/// All pairs of two trees of two shapes or more.
template <class Policy, class Pairing, class Walk, class Reach, class Best>
void walk_two_trees(const Policy& on, const Pairing& pairing, Walk walk, const Reach& reach, Best& best) {
    const auto both = pairing.view();
    using view = std::remove_const_t<decltype(both)>;
    constexpr bool is_shared = !std::same_as<std::remove_cvref_t<decltype(pairing.part)>, whole_search>;
    constexpr bool in_world = !decltype(pairing.a)::is_posed && !decltype(pairing.b)::is_posed;
    if constexpr (host_policy<Policy> && !is_shared) {
        const auto& a = pairing.a.tree_with_least_ids();
        const auto& b = pairing.b.tree_with_least_ids();
        const auto of_a = as_object(a);
        const auto of_b = as_object(b);
        ties_of_two watch(a.ties(), of_a, b.ties(), of_b);
        if (own_least_ids(a) != nullptr && own_least_ids(b) != nullptr) watch.begin_with(own_least_ids(a), own_least_ids(b));
        walk.watch = &watch;
        if (concurrency(on) == 1) {
            const walk_from_rest<Walk, Reach, view, in_world> all{{walk, reach, both}, nullptr};
            return for_each_ordered(serial{}, 1, all, best);
        }
        // The calling thread begins alone, so that what is done soon costs no more than on one thread.
        constexpr std::size_t break_even = 256;  // steps: some 50 us
        using alone = walk_alone<Walk, Reach, view, in_world>;
        typename alone::heap rest;
        for_each_ordered(serial{}, 1, alone{{walk, reach, both}, rest, break_even}, best);
        std::sort_heap(rest.at, rest.at + rest.count, rest.is_farther);
        std::reverse(rest.at, rest.at + rest.count);
        const walk_from_rest<Walk, Reach, view, in_world> others{{walk, reach, both}, rest.at};
        for_each_ordered(on, static_cast<std::size_t>(rest.count), others, best);
    } else if constexpr (host_policy<Policy>) {
        const auto from_depth = [&](int level, bool once, const auto& part) {
            const seeds_below<Walk> from(walk, level);
            const walk_from_depth<Walk, Reach, view, in_world> below{{walk, reach, both}, from, once};
            for_each_ordered(on, from.count(), walk_of_part(below, part), best);
        };
        // Whoever begins without a bound looks in vain: many short looks find a good one. It is worth the same to each part.
        from_depth(4, true, whole_search{});
        from_depth(std::max(depth_of_seeds(concurrency(on)), 6), false, pairing.part);
    } else {
        const auto below = [&](int level, const auto& part) {
            return two_trees<Walk, Reach, view, std::remove_cvref_t<decltype(part)>>{
                walk, reach, both, seeds_below<Walk>(walk, level), part};
        };
        const shared_nearest<Policy> found(on, 1, best.bound(), below(4, whole_search{}), below(is_shared ? 6 : 5, pairing.part),
                                           shared_nearest<Policy>::enough_for_one);
        best.offer(found.of_one());
    }
}

/// The shapes of one operand look in the other.
template <bool RowsAreB, class Policy, class Pairing, class Index, class Best>
void look_for_nearest_pair(const Policy& on, const Pairing& pairing, const Index& x, std::size_t rows, Best& best) {
    const auto both = pairing.view();
    using T = typename decltype(both.a)::scalar_type;
    const auto look = [&](auto walk, const auto& sight) {
        using walk_type = decltype(walk);
        [[maybe_unused]] auto watch = watch_ties<Policy, true>(64, false, walk, x);
        if constexpr (requires { watch.few; }) watch.few = 0;
        using sight_type = std::remove_cvref_t<decltype(sight)>;
        constexpr bool in_world = !decltype(pairing.a)::is_posed && !decltype(pairing.b)::is_posed;
        const look_from_shapes<RowsAreB, in_world, walk_type, sight_type, std::remove_const_t<decltype(both)>> each{walk, sight, both};
        for_each_ordered(on, rows, walk_of_part(each, pairing.part), best);
    };
    if constexpr (!Index::is_indexed) {
        look(walk_all_boxes<decltype(x.shapes())>{x.shapes()}, sight_of_list{});
    } else if constexpr (!Index::has_tree) {
        const auto frame = frame_of(x, length_unit<T>{});
        look(ordered_walk_of(x), sight_of_grid<std::remove_const_t<decltype(frame)>>{frame});
    } else if constexpr (Index::is_posed) {
        look(ordered_walk_of(x), sight_of_tree<object_sight<T>>{{x.pose, x.around}});
    } else {
        look(ordered_walk_of(x), sight_of_tree<world_sight<T>>{});
    }
}

/// Offers `best` all pairs that may be the nearest. Nothing touches.
template <class Policy, class Pairing, class Best>
void look_for_nearest_pair(const Policy& on, const Pairing& pairing, Best& best) {
    const auto& a = pairing.a;
    const auto& b = pairing.b;
    using A = std::remove_cvref_t<decltype(a)>;
    using B = std::remove_cvref_t<decltype(b)>;
    const std::size_t n = a.shapes().size(), m = b.shapes().size();
    if constexpr (A::has_tree && B::has_tree) {
        const ordered_pair_walk<decltype(a.tree()), decltype(b.tree())> walk{a.tree(), b.tree()};
        if (n > 1 && m > 1 && n <= walk.most_shapes && m <= walk.most_shapes) {
            using T = typename decltype(a.tree())::scalar_type;
            using walk_type = std::remove_const_t<decltype(walk)>;
            constexpr bool by_volumes = walk_type::template compares_volumes<near_posed_boxes<T>>();
            if constexpr (A::is_posed || B::is_posed || by_volumes) {
                const auto at_a = placement_of(a), at_b = placement_of(b);
                const near_posed_boxes<T> reach(at_a.pose, at_a.around, at_b.pose, at_b.around);
                return walk_two_trees(on, pairing, walk, reach, best);
            } else {
                return walk_two_trees(on, pairing, walk, near_boxes<T>{}, best);
            }
        }
    }
    // In trees rather than in grids, and the fewer shapes look. Of plain sets the more, since they are shared out.
    constexpr bool alike = A::has_tree == B::has_tree && A::is_indexed == B::is_indexed;
    constexpr bool a_is_better = A::has_tree ? !B::has_tree : A::is_indexed && !B::is_indexed;
    const bool more_in_a = A::is_indexed ? n >= m : n < m;
    if constexpr (alike) {
        more_in_a ? look_for_nearest_pair<true>(on, pairing, a, m, best)
                  : look_for_nearest_pair<false>(on, pairing, b, n, best);
    } else if constexpr (a_is_better) {
        look_for_nearest_pair<true>(on, pairing, a, m, best);
    } else {
        look_for_nearest_pair<false>(on, pairing, b, n, best);
    }
}

// --- answers -----------------------------------------------------------------------------------------------------------

/// What a walk begins with, so that it loses nothing that is below once it is rounded to T.
template <scalar T>
double bound_below(double below) {
    constexpr double grown = 1 + 4 * static_cast<double>(unit_roundoff<T>);
    return below * grown + static_cast<double>(smallest_normal<T>);
}
template <scalar T>
ABUT_HD bool is_below(const separation<T>& found, double below) {
    return static_cast<double>(found.distance) < below || below == infinity<double>;
}

inline void check(const distance_options& options, const char* function) {
    if (options.below >= 0) return;
    const bool is_number = options.below < 0;
    throw error(std::string(function) + ": below is " + (is_number ? shortest(options.below) : "NaN") +
                "; expected a distance" + (is_number ? ", 0 or more" : ""));
}

/// The least key of two arguments' pairs that touch, or no_pair.
template <class Policy, class Pairing>
std::uint64_t first_touch(const Policy& on, Pairing& pairing) {
    std::uint64_t key = no_pair;
    download(on, first_touches(on, pairing, 1).data(), 1, &key);
    return key;
}
/// Of two arguments of which no shapes touch: what is nearest of what is no farther than the bound, and its key.
template <class Policy, class Pairing>
execution::least_value nearest_pair(const Policy& on, const Pairing& pairing, double bound) {
    execution::best_of_all<space_of<Policy>> best(on, bound);
    look_for_nearest_pair(on, pairing, best);
    return best.least();
}
/// How far apart the two shapes of a key are, and where. Ids are those of the pairing.
template <class Policy, class Pairing>
auto separation_of_key(const Policy& on, const Pairing& pairing, std::uint64_t key, bool touch) {
    execution::buffer_of<Policy, std::uint64_t> keys(on, 1);
    upload(on, &key, 1, keys.data());
    const fetched_pairs<typename Pairing::view_type> fetched(on, pairing.view(), keys.data(), 1);
    auto found = separation_of(fetched[0].a, fetched[0].b, touch);
    found.a = pairing.key.a(key);
    found.b = pairing.key.b(key);
    return found;
}

/// Whether `distance` takes both arguments.
template <class Policy, class X, class Y>
consteval bool can_be_apart() {
    if constexpr (!can_pair<Policy, X, Y, keep_all>()) {
        return false;
    } else {
        constexpr bool are = measurable<typename shape_of_argument<X>::type, typename shape_of_argument<Y>::type>;
        static_assert(are, "abut: there is no distance of sets of these two shapes");
        return are;
    }
}

/// How far two sets are apart: a question that executors answer by overloads of ask_least.
struct ask_distance {
    static constexpr const char* function = "abut::distance";
    distance_options options;
};
template <execution_policy Policy, class X, class Y>
auto ask_least(const Policy& on, const ask_distance& question, const X& x, const Y& y) {
    if constexpr (can_be_apart<Policy, X, Y>()) {
        using T = scalar_type_of<typename shape_of_argument<X>::type>;
        using answer = std::optional<separation<T>>;
        const double below = question.options.below;
        check(question.options, question.function);
        auto pairing = pair_up(on, x, y, query_options<before_first_touch<pair_key>>{}, question.function);
        if (pairing.a.shapes().size() == 0 || pairing.b.shapes().size() == 0 || !(below > 0)) return answer();
        std::uint64_t key = first_touch(on, pairing);
        const bool touch = key != no_pair;
        if (!touch) key = nearest_pair(on, pairing, bound_below<T>(below)).key;
        if (key == no_pair) return answer();
        const separation<T> found = separation_of_key(on, pairing, key, touch);
        return is_below(found, below) ? answer(found) : answer();
    } else {
        return std::optional<separation<float>>();
    }
}

}  // namespace detail

/// How far apart two sets are: a std::optional<separation<T>> with the ids of the two nearest shapes, a point of each, and
/// the distance. It is 0 exactly where `any` is true; then both points are one that the two shapes share. Of pairs that are
/// equally far apart, and of those that touch, it has the one with the least id in `a`, then in `b`. It is empty where a set
/// is, and where nothing is nearer than `options.below`.
///
/// Arguments are those of `any`, of shapes of which distance(s, t) takes pairs. Two trees are walked together, the nearest
/// pairs of nodes first. Without a tree on either side each shape of one looks in the other.
///
/// The same bits on every policy, for every index and any number of threads. Distances are computed in double; those that
/// differ by less than docs/numerics/distances.md says may be taken for each other. Points and distance are those of
/// `distance` of the two shapes.
///
/// Of several devices (@ref devices), where both arguments are divided, and of ranks (@ref distributed) each searches its
/// own parts first; then shapes of b go to whose a-shapes may be as near to them as what was found: to all, where no rank
/// has shapes of both sets. Of ranks the answer is a `global_separation`, the same on all; each gives the same options.
///
/// @par Memory
/// As in @ref queries. Nothing is stored for each pair. On a host, of lists and bodies too: where many pairs of two trees are
/// equally far apart, the trees keep 8 bytes for each shape from then on, which makes the calls that follow fast. Where many
/// touch, or rows ask, a call takes as much while it works, unless the trees keep their least ids; and 4 more for a moment.
/// Under `cuda` two trees take half a megabyte, and each entry of a list some 210 bytes in float and 370 in double.
///
/// @par Errors
/// As in @ref queries, and `error` where `below` is negative or NaN.
///
/// @par Synchronisation
/// Returns when the answer is complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp distance
///
/// @ingroup queries
template <executor On, class X, class Y>
[[nodiscard]] auto distance(const On& on, const X& a, const Y& b, const distance_options& options = {}) {
    return ask_least(on, detail::ask_distance{options}, a, b);
}

}  // namespace abut
