// SPDX-License-Identifier: MIT
#pragma once

// nearest of sets whose parts lie on many ranks. The least is by the measure of narrow/nearest_point.hpp and then by the id,
// as on one machine.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <abut/collide/nearest.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/rows.hpp>

#include <mpi.h>

namespace abut {

/// A `neighbor` with an id in a set of many parts. Where there are no shapes at all: `no_global_id`, the point asked about
/// and infinity.
/// @ingroup distributed
template <scalar T>
struct global_neighbor {
    std::uint64_t id;  ///< of the shape
    vec3<T> point;     ///< on the shape, in the world
    T distance;        ///< from the point asked about, rounded to T

    friend constexpr bool operator==(const global_neighbor&, const global_neighbor&) = default;
};

namespace detail {

template <scalar T>
struct write_global_neighbor {
    const measured_neighbor<T>* best;
    global_neighbor<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = {best[i].id, best[i].point, best[i].distance}; }
};

/// What is largest of all ranks.
inline double largest_of_ranks(const own_communicator& ranks, double mine) {
    double largest = 0;
    check_mpi(MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, ranks.get()), "MPI_Allreduce");
    return largest;
}

template <class Local, class X, class Points>
auto nearest_of_parts(const distributed<Local>& on, const X& index, const Points& points, std::size_t count,
                      const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    const Local& local = on.local();
    double largest = 0;
    const auto here = bring_rows_and_shapes(
        on, index, points, function,
        [](const auto& policy, const auto& rows, const char* name) { return make_points<T>(policy, rows, name); },
        [&](const auto& shapes, const auto& rows) {
            check_few(count, function);
            check_neighbors(rows.shapes().size(), count, function);
            if (count >= std::size_t{1} << 31) {  // the answers of one point are one message
                throw capacity_error(std::string(function) + ": count is " + std::to_string(count) +
                                     ", expected less than 2^31");
            }
            largest = largest_coordinate(local, shapes, rows.shapes());
        });
    require_one(on.ranks(), static_cast<double>(count), function, "counts");
    const ask_nearest<T> question{unit_of_magnitude<T>(largest_of_ranks(on.ranks(), largest)), count};
    return answers_of_ranks(on, here, question, [&](const auto& best) {
        execution::buffer_of<Local, global_neighbor<T>> out(local, best.size());
        for_each_index(local, best.size(), write_global_neighbor<T>{best.data(), out.data()});
        synchronize(local);
        return result<global_neighbor<T>, space_of<Local>>(std::move(out));
    });
}

}  // namespace detail

/// For each of this rank's `points` the nearest shape of all parts: a `result` of `global_neighbor`, in the order of the
/// points, 24 bytes each in float and 40 in double, in the local policy's memory. `index` is this rank's part, and `points`
/// this rank's points; both as of `nearest` under the local policy. Points go to ranks whose parts may hold something
/// nearer, at most 65,536 in a message.
///
/// The answers are those of one machine. In double, scenes whose coordinates differ by factors beyond 2^250 may differ in
/// the last bits under a pose.
/// @ingroup distributed
template <execution_policy Local, class X, class Points>
[[nodiscard]] auto nearest(const distributed<Local>& on, const X& index, const Points& points) {
    if constexpr (detail::can_be_near<Local, X, Points>()) {
        return detail::nearest_of_parts(on, index, points, 1, "abut::nearest");
    } else {
        return result<global_neighbor<float>, space_of<Local>>();
    }
}

/// For each of this rank's `points` the `count` nearest shapes of all parts, the nearest first: those of point i stand at
/// count * i and after, and where there are fewer shapes the last are `no_global_id`. Arguments are as of the nearest one;
/// each rank gives the same `count`. A message has at most 65,536 neighbours, or those of one point.
/// @ingroup distributed
template <execution_policy Local, class X, class Points>
[[nodiscard]] auto nearest(const distributed<Local>& on, const X& index, const Points& points, std::size_t count) {
    if constexpr (detail::can_be_near<Local, X, Points>()) {
        return detail::nearest_of_parts(on, index, points, count, "abut::nearest");
    } else {
        return result<global_neighbor<float>, space_of<Local>>();
    }
}

}  // namespace abut
