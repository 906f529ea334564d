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

namespace abut::detail {

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
auto ask_least(const distributed<Local>& on, const ask_distance& question, const X& x, const Y& y) {
    if constexpr (can_be_apart<Local, X, Y>()) {
        using T = scalar_type_of<typename shape_of_argument<X>::type>;
        const char* const function = question.function;
        const double below = question.options.below;
        const Local& local = on.local();
        attempts attempt;
        attempt([&] { check(question.options, function); });
        attempt.settle(on.ranks());
        least_apart<T> least(below);
        ask_all_parts(on, x, y, function, [&](int, const auto& a, const auto& b, const global_ids& ids) {
            least.look_for_touch(local, pair_up_apart(local, a, b, function), ids);
        });
        auto best = least_of_ranks(on.ranks(), least.best());
        if (!best.is_one() && below > 0) {
            ask_all_parts(
                on, x, y, function,
                [&](int, const auto& a, const auto& b, const global_ids& ids) {
                    least.look_for_nearest(local, pair_up_apart(local, a, b, function), ids);
                },
                [&](const auto& bounds) { return grown_by(bounds, least.reach()); },
                [&] { least.learn(least_of_ranks(on.ranks(), least.bound())); });
            best = least_of_ranks(on.ranks(), least.best());
        }
        return least.template answer<global_separation<T>>(best, below);
    } else {
        return std::optional<global_separation<float>>();
    }
}

}  // namespace abut::detail
