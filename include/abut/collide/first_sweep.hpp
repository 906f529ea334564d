// SPDX-License-Identifier: MIT
#pragma once

// first_impact of shapes that go along ways: which two touch first, when and where.
//
// By definition these are the two with the least time, as narrow/sweep_time.hpp gives it, and of equal ones those with the
// least ids. All who look share the least time so far. Two trees are walked together, the pairs of nodes that may meet soonest
// first. Otherwise shapes of one side look in the other along rays as thick as they are, as those of `sweep` do; what stays
// looks in an index that goes from where it seems to come itself.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include <abut/collide/distance.hpp>
#include <abut/collide/sweep.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/shape/moved.hpp>
#include <abut/shape/pair_reach.hpp>
#include <abut/traverse/ordered_pair_walk.hpp>
#include <abut/traverse/seeds.hpp>

namespace abut {

/// Which two shapes touch first, one of which goes along a way.
/// @ingroup queries
template <scalar T>
struct sweep_impact {
    std::uint32_t a;  ///< id in the first argument
    std::uint32_t b;  ///< id in the second one
    T t;              ///< when, from 0 to 1: t times the way is gone
    vec3<T> point;    ///< where, on the shape that stays
    vec3<T> normal;   ///< of length 1, out of the shape that stays; zero where both overlap at the start

    friend constexpr bool operator==(const sweep_impact&, const sweep_impact&) = default;
};

namespace detail {

/// Offers when two shapes touch first, of which b's goes if `GoesB` says so, or else a's.
template <class A, bool GoesB, class View>
struct offer_first_touch {
    View both;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::uint32_t mover, std::uint32_t met, Best& best) const {
        if (!is_wanted_by_row<GoesB>(both, mover, met)) return;
        const std::uint64_t key = pack_row<GoesB>(both, mover, met);
        // Nothing is sooner than the start. Threads of a device do not know whose the bound is.
        if constexpr (requires { best.known(); }) {
            if (!(best.known().value > 0) && best.known().key <= key) return;
        }
        if constexpr (GoesB) {
            offer(both.b[mover], both.a[met], key, best);
        } else {
            offer(both.a[mover], both.b[met], key, best);
        }
    }

private:
    template <class Mover, class Met, class Best>
    ABUT_HD static void offer(const Mover& mover, const Met& met, std::uint64_t key, Best& best) {
        const double bound = best.bound();
        const time_bounds time = sweep_bounds<A>(mover, met, bound);
        if (time.first < 0 || time.first > bound) return;
        best.offer(time.is_one() ? time.last : sweep_time<A>(mover, met), key);
    }
};

/// What a row, or a pair of leaves, has offered.
template <bool FromMet, class Offer, class Best>
struct offer_found {
    const Offer& offer;
    Best& best;
    std::uint32_t row;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::uint32_t found) const { FromMet ? offer(found, row, best) : offer(row, found, best); }
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::uint32_t mover, std::uint32_t met) const { offer(mover, met, best); }
};

/// Each row, which goes along a way, looks for what it touches first. `FromMet` says that it is a shape that stays, seen from
/// the others.
template <bool FromMet, class Walk, class Frame, class Rows, class Offer>
struct look_along_ways {
    static constexpr std::size_t grain = 16;
    Walk walk;
    Frame frame;
    Rows rows;
    Offer offer;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        line_reach_of<Walk, typename Rows::scalar_type> reach(sweep_seen(frame, rows[i]));
        walk(reach, best, offer_found<FromMet, Offer, Best>{offer, best, static_cast<std::uint32_t>(i)});
    }
};
/// Two trees, of which the first goes, down from pairs of nodes.
template <class Walk, class Reach, class Offer>
struct walk_trees_on_way {
    static constexpr std::size_t grain = 16;
    Walk walk;
    Reach reach;
    Offer offer;
    seeds_below<Walk> from;

    template <class Best>
    void operator()(std::size_t i, Best& best) const {
        constexpr std::uint32_t nowhere = decltype(from.a)::nowhere;
        const auto at = from(i);
        if (at.a == nowhere || at.b == nowhere) return;
        Reach mine = reach;
        walk(at, mine, best, offer_found<false, Offer, Best>{offer, best, 0});
    }
};

/// Rows look in an operand.
template <bool FromMet, class Policy, class X, class Rows, class Offer, class Best>
void look_in(const Policy& on, const X& x, const Rows& rows, const Offer& offer, Best& best) {
    using T = typename Rows::scalar_type;
    const auto frame = frame_of(x, length_unit<T>{});
    const auto look = [&](const auto& walk) {
        using walk_type = std::remove_cvref_t<decltype(walk)>;
        for_each_ordered(on, rows.size(),
                         look_along_ways<FromMet, walk_type, std::remove_const_t<decltype(frame)>, Rows, Offer>{walk, frame, rows, offer},
                         best);
    };
    if constexpr (X::has_tree) {
        look(ordered_walk_of(x));
    } else {
        look(walk_all_boxes<decltype(x.shapes())>{x.shapes()});
    }
}

/// Offers all that may touch first.
template <class Policy, operand Mover, operand Met, class Offer, class Best>
void look_for_first_touch(const Policy& on, const Mover& mover, const Met& met, const Offer& offer, Best& best) {
    const auto movers = mover.shapes();
    const auto those_met = met.shapes();
    if constexpr (Mover::has_tree && is_moved_operand<Mover>) {
        const auto look_back = [&] {
            const moved_view<std::remove_const_t<decltype(those_met)>> back{those_met, {-mover.way.x, -mover.way.y, -mover.way.z}};
            look_in<true>(on, mover.operand, back, offer, best);
        };
        if constexpr (!Met::has_tree) {
            return look_back();
        } else {
            if constexpr (host_policy<Policy> && !Mover::is_posed && !Met::is_posed) {
                const ordered_pair_walk<decltype(mover.tree()), decltype(met.tree())> walk{mover.tree(), met.tree()};
                using walk_type = std::remove_const_t<decltype(walk)>;
                const std::size_t n = movers.size(), m = those_met.size();
                if (n > 1 && m > 1 && n <= walk.most_shapes && m <= walk.most_shapes) {
                    using reach = boxes_that_meet<typename decltype(mover.tree())::scalar_type>;
                    const walk_trees_on_way<walk_type, reach, Offer> down{
                        walk, reach(mover.way), offer, seeds_below<walk_type>(walk, depth_of_seeds(concurrency(on)))};
                    return for_each_ordered(on, down.from.count(), down, best);
                }
            }
            if (those_met.size() < movers.size()) return look_back();
        }
    }
    look_in<false>(on, met, movers, offer, best);
}

/// Whether first_impact takes both arguments, of which one has ways.
template <class Policy, class X, class Y>
consteval bool can_touch_first() {
    if constexpr (!can_both_be_asked<Policy, X, Y>()) {
        return false;
    } else {
        constexpr bool one_goes = goes_on_ways<X> != goes_on_ways<Y>;
        static_assert(one_goes, "abut: shapes of one argument go along ways, and those of the other stay: the difference of two "
                                "ways need be no number");
        constexpr bool has_walk = !is_grid<X> && !is_grid<Y>;
        static_assert(has_walk, "abut: first_impact of shapes on their ways takes trees, sets or shapes, and no grid");
        if constexpr (one_goes && has_walk) {
            using mover = typename shape_of_argument<std::conditional_t<goes_on_ways<X>, X, Y>>::type;
            using met = typename shape_of_argument<std::conditional_t<goes_on_ways<X>, Y, X>>::type;
            return can_go_and_be_met<mover, met>();
        } else {
            return false;
        }
    }
}

}  // namespace detail

/// Which two shapes touch first where those of one argument go along a way, when and where: a std::optional<sweep_impact<T>>,
/// which is empty where nothing touches from t = 0 to 1. Of several pairs at one time it is the one with the least id in `a`,
/// then in `b`. What touches at the start does so at 0.
///
/// One argument is `moving(x, way)` of a set, a view, an index or one shape, or shapes with a way each, as `shapes<swept<S>>`. The
/// other one stays: a set, a view, a tree of any layout or one shape, posed or not. Shapes are those of `sweep`. Times, points and
/// normals are those that it has of the two shapes. Trees are not rebuilt.
///
/// With `filtered` and `exact` decided exactly, as `sweep` says, and the same bits on every policy and for every index. `fast` is
/// approximate. With `{.filter = f}` pairs for which f(id in a, id in b) is false are left out. A policy answers.
///
/// @par Memory
/// As in @ref queries. Nothing is stored for each pair. For a device the stack is that of `sweep`.
///
/// @par Errors
/// As in @ref queries, and `invalid_geometry` where a way is not finite.
///
/// @par Synchronisation
/// Returns when the answer is complete; under `cuda` it waits for the policy's stream.
///
///     const auto tool = abut::moving(index, abut::vec3<float>{0, 0, -2});
///     if (const auto first = abut::first_impact(on, tool, mesh)) stop_at(first->t);
///
/// @ingroup queries
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all>
    requires(detail::goes_on_ways<X> || detail::goes_on_ways<Y>)
[[nodiscard]] auto first_impact(const Policy& on, const X& a, const Y& b, const sweep_options<Filter>& options = {}) {
    using namespace detail;
    if constexpr (can_touch_first<Policy, X, Y>() && is_filter<Policy, Filter>()) {
        using T = scalar_type_of<typename shape_of_argument<X>::type>;
        constexpr bool goes_b = goes_on_ways<Y>;
        query_options<Filter> both_ways{};
        both_ways.filter = options.filter;
        const auto pairing = pair_up(on, a, b, both_ways, "abut::first_impact");
        const auto both = pairing.view();
        using view = std::remove_const_t<decltype(both)>;
        if (both.a.size() == 0 || both.b.size() == 0) return std::optional<sweep_impact<T>>();
        execution::best_of_all<space_of<Policy>> best(on, 1.0);
        const offer_first_touch<A, goes_b, view> offer{both};
        if constexpr (goes_b) {
            look_for_first_touch(on, pairing.b, pairing.a, offer, best);
        } else {
            look_for_first_touch(on, pairing.a, pairing.b, offer, best);
        }
        const execution::least_value first = best.least();
        if (first.key == no_pair) return std::optional<sweep_impact<T>>();
        execution::buffer_of<Policy, std::uint64_t> keys(on, 1);
        upload(on, &first.key, 1, keys.data());
        const fetched_pairs<view> fetched(on, both, keys.data(), 1);
        const T t = rounded(time_as<T>(first.value));
        const auto place = [&] {
            if constexpr (goes_b) {
                return sweep_place_of(fetched[0].b, fetched[0].a, static_cast<double>(t));
            } else {
                return sweep_place_of(fetched[0].a, fetched[0].b, static_cast<double>(t));
            }
        }();
        return std::optional<sweep_impact<T>>(
            {pairing.key.a(first.key), pairing.key.b(first.key), t, place.point, place.normal});
    } else {
        return std::optional<sweep_impact<float>>();
    }
}

}  // namespace abut
