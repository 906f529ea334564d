// SPDX-License-Identifier: MIT
#pragma once

// distance of sets whose parts lie on many ranks. First all look for what touches. Where nothing does, each rank measures
// its own parts, and the least that any has found says which shapes may still be nearer and have to come.

#include <cstdint>
#include <optional>
#include <vector>

#include <abut/collide/apart.hpp>
#include <abut/collide/distance.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/query.hpp>

#include <mpi.h>

namespace abut {

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

/// The least of all ranks. All of them call it.
template <scalar T>
pair_apart<T> least_of_ranks(const own_communicator& ranks, const pair_apart<T>& mine) {
    attempts attempt;
    std::vector<pair_apart<T>> all;
    attempt([&] { all.resize(static_cast<std::size_t>(ranks.size())); });
    attempt.settle(ranks);
    gather(ranks, mine, all);
    pair_apart<T> best = mine;
    for (const pair_apart<T>& one : all) {
        if (one.comes_before(best)) best = one;
    }
    return best;
}
inline double least_of_ranks(const own_communicator& ranks, double mine) {
    double least = 0;
    check_mpi(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE, MPI_MIN, ranks.get()), "MPI_Allreduce");
    return least;
}

template <class Local, class X, class Y>
auto distance_of_parts(const distributed<Local>& on, const X& x, const Y& y, const distance_options& options,
                       const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    const Local& local = on.local();
    attempts attempt;
    attempt([&] { check(options, function); });
    attempt.settle(on.ranks());
    least_apart<T> least(options.below);
    ask_all_parts(on, x, y, function, [&](int, const auto& a, const auto& b, const global_ids& ids) {
        least.look_for_touch(local, pair_up_apart(local, a, b, function), ids);
    });
    auto best = least_of_ranks(on.ranks(), least.best());
    if (!best.is_one() && options.below > 0) {
        ask_all_parts(
            on, x, y, function,
            [&](int, const auto& a, const auto& b, const global_ids& ids) {
                least.look_for_nearest(local, pair_up_apart(local, a, b, function), ids);
            },
            [&](const auto& bounds) { return grown_by(bounds, least.reach()); },
            [&] { least.learn(least_of_ranks(on.ranks(), least.bound())); });
        best = least_of_ranks(on.ranks(), least.best());
    }
    const bool is = best.is_one() && options.below > 0 && is_below(best.found, options.below);
    const separation<T>& found = best.found;
    const global_separation<T> named{best.a, best.b, found.point_a, found.point_b, found.distance};
    return is ? std::optional<global_separation<T>>(named) : std::optional<global_separation<T>>();
}

}  // namespace detail

/// How far apart two sets are, as `distance` says on one machine that has the whole sets, bit for bit: a
/// std::optional<global_separation<T>>, the same on all ranks. Arguments are this rank's parts, as those of `distance` under
/// the local policy; each rank gives the same options. Shapes of b go to the ranks whose a-shapes may be as near to them as
/// what is known: all of them where no rank has shapes of both sets.
/// @ingroup distributed
template <execution_policy Local, class X, class Y>
[[nodiscard]] auto distance(const distributed<Local>& on, const X& a, const Y& b, const distance_options& options = {}) {
    if constexpr (detail::can_be_apart<Local, X, Y>()) {
        return detail::distance_of_parts(on, a, b, options, "abut::distance");
    } else {
        return std::optional<global_separation<float>>();
    }
}

}  // namespace abut
