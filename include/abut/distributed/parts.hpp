// SPDX-License-Identifier: MIT
#pragma once

// Parts of sets on ranks: where they are, and how shapes of one rank come to the ranks whose shapes they come near.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <mpi.h>

#include <abut/collide/operand.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/equal_elements.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

// --- where parts are ---------------------------------------------------------------------------------------------------

/// Boxes around as many groups of neighbours in a part. One box would do; where ids follow space, several leave out more.
inline constexpr std::size_t part_boxes = 16;

/// A part of a set, as other ranks know it.
template <scalar T>
struct part_bounds {
    std::uint64_t size = 0;
    aabb<T> around = empty_box<T>();
    aabb<T> groups[part_boxes];  ///< empty ones where there are fewer shapes

    /// Whether something in the box may touch a shape of the part.
    [[nodiscard]] ABUT_HD bool reaches(const aabb<T>& box) const {
        if (!overlaps(around, box)) return false;
        bool reached = false;
        for (std::size_t k = 0; k < part_boxes; ++k) reached |= overlaps(groups[k], box);
        return reached;
    }
    /// Whether shapes of two parts may touch.
    [[nodiscard]] bool is_near(const part_bounds& other) const {
        return std::any_of(other.groups, other.groups + part_boxes, [this](const aabb<T>& box) { return reaches(box); });
    }
};

template <shape_view Shapes>
struct box_of_shape_from {
    Shapes shapes;
    std::size_t first;
    ABUT_HD auto operator()(std::size_t i) const { return bounds(shapes[first + i]); }
};

template <class Policy, shape_view Shapes>
auto bounds_of_part(const Policy& on, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    part_bounds<T> part;
    part.size = shapes.size();
    for (std::size_t k = 0; k < part_boxes; ++k) {
        const std::size_t first = shapes.size() * k / part_boxes, last = shapes.size() * (k + 1) / part_boxes;
        const box_of_shape_from<Shapes> box{shapes, first};
        part.groups[k] = first < last ? reduce(on, last - first, empty_box<T>(), merge_boxes{}, box) : empty_box<T>();
        part.around = merge(part.around, part.groups[k]);
    }
    return part;
}

/// All parts of a set.
template <scalar T>
struct parts_of_set {
    std::vector<part_bounds<T>> of_rank;
    std::vector<std::uint64_t> first_id;  ///< of each rank's shapes

    [[nodiscard]] const part_bounds<T>& operator[](int rank) const { return of_rank[static_cast<std::size_t>(rank)]; }
    [[nodiscard]] std::uint64_t first_of(int rank) const { return first_id[static_cast<std::size_t>(rank)]; }
};

template <scalar T>
parts_of_set<T> gathered_parts(const own_communicator& ranks, const part_bounds<T>& mine) {
    parts_of_set<T> all{gathered(ranks, mine), {}};
    std::uint64_t first = 0;
    for (const part_bounds<T>& part : all.of_rank) {
        all.first_id.push_back(first);
        first += part.size;
    }
    return all;
}

// --- what goes where ---------------------------------------------------------------------------------------------------

/// Shapes that may touch one of another rank's.
template <shape_view Shapes>
struct comes_near {
    Shapes shapes;
    part_bounds<typename Shapes::scalar_type> there;
    ABUT_HD bool operator()(std::size_t i) const { return there.reaches(bounds(shapes[i])); }
};

template <shape_view Shapes>
struct pack_shape {
    Shapes shapes;
    const std::uint32_t* ids;
    typename Shapes::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = shapes[ids[i]]; }
};

/// Room for values of a message: in the policy's memory, and where that is not the host's, on the host as well.
template <class Policy, class T>
class message_room {
public:
    message_room(const Policy& on, std::size_t n) : there_(on, n), here_(serial{}, host_policy<Policy> ? 0 : n) {}

    /// In the policy's memory.
    [[nodiscard]] T* there() { return there_.data(); }
    /// For MPI.
    [[nodiscard]] T* here() { return host_policy<Policy> ? there_.data() : here_.data(); }
    void bring_here(const Policy& on, std::size_t n) {
        if constexpr (!host_policy<Policy>) download(on, there_.data(), n, here_.data());
    }
    void bring_there(const Policy& on, std::size_t n) {
        if constexpr (!host_policy<Policy>) upload(on, here_.data(), n, there_.data());
    }

private:
    execution::buffer_of<Policy, T> there_;
    execution::buffer<T, host_space> here_;
};

/// Hands shapes of each rank to the ranks whose parts they come near. All ranks call it.
///
/// It goes in rounds: in round k each rank sends to the k-th rank behind it and receives from the k-th before it. Both know
/// from the boxes of all parts whether there is a message, so ranks that are far apart exchange nothing. use(rank, shapes,
/// ids) is called for each message with shapes, in memory of the policy's that is used again after it: shapes of `rank`, and
/// their ids there. What it throws ends the call on all ranks.
template <execution_policy Local, scalar T, shape_view Shapes, class Use>
void exchange_near(const distributed<Local>& on, const parts_of_set<T>& looking, const parts_of_set<T>& sent,
                   const Shapes& shapes, attempts& attempt, const Use& use) {
    using shape_type = typename Shapes::shape_type;
    const own_communicator& ranks = on.ranks();
    const Local& local = on.local();
    const int me = ranks.rank(), all = ranks.size();
    const auto rank_in = [&](int round) { return (me + round + all) % all; };

    // How much goes where.
    enum tag { tag_count, tag_shapes, tag_ids };
    const auto count_type = MPI_UINT64_T;
    std::vector<std::uint64_t> to(static_cast<std::size_t>(all)), from(static_cast<std::size_t>(all));
    for (int round = 1; round < all; ++round) {
        const int target = rank_in(round);
        if (!looking[target].is_near(sent[me])) continue;
        attempt([&] {
            const one_if<comes_near<Shapes>> near{{shapes, looking[target]}};
            to[static_cast<std::size_t>(target)] = reduce(local, shapes.size(), std::uint64_t{0}, add_up_tallies{}, near);
        });
    }
    std::vector<MPI_Request> open;
    for (int rank = 0; rank < all; ++rank) {
        const auto k = static_cast<std::size_t>(rank);
        if (rank == me) continue;
        if (looking[me].is_near(sent[rank])) {
            open.emplace_back();
            check_mpi(MPI_Irecv(&from[k], 1, count_type, rank, tag_count, ranks.get(), &open.back()), "MPI_Irecv");
        }
        if (looking[rank].is_near(sent[me])) {
            open.emplace_back();
            check_mpi(MPI_Isend(&to[k], 1, count_type, rank, tag_count, ranks.get(), &open.back()), "MPI_Isend");
        }
    }
    check_mpi(MPI_Waitall(static_cast<int>(open.size()), open.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");

    // Room for the largest messages: from here on messages are sent whatever fails.
    using shape_room = message_room<Local, shape_type>;
    using id_room = message_room<Local, std::uint32_t>;
    std::vector<shape_room> shape_rooms;
    std::vector<id_room> id_rooms;
    attempt([&] {
        const std::uint64_t out = *std::max_element(to.begin(), to.end()), in = *std::max_element(from.begin(), from.end());
        shape_rooms.reserve(2);
        id_rooms.reserve(2);
        for (const std::uint64_t n : {out, in}) {
            shape_rooms.emplace_back(local, static_cast<std::size_t>(n));
            id_rooms.emplace_back(local, static_cast<std::size_t>(n));
        }
    });
    attempt.settle(ranks);

    const message_type<shape_type> shape_message;
    for (int round = 1; round < all; ++round) {
        const int target = rank_in(round), source = rank_in(-round);
        const std::uint64_t out = to[static_cast<std::size_t>(target)], in = from[static_cast<std::size_t>(source)];
        MPI_Request requests[4];
        int count = 0;
        const auto receive = [&](void* data, MPI_Datatype type, tag which) {
            check_mpi(MPI_Irecv(data, static_cast<int>(in), type, source, which, ranks.get(), &requests[count++]), "MPI_Irecv");
        };
        const auto send = [&](const void* data, MPI_Datatype type, tag which) {
            check_mpi(MPI_Isend(data, static_cast<int>(out), type, target, which, ranks.get(), &requests[count++]), "MPI_Isend");
        };
        if (in > 0) {
            receive(shape_rooms[1].here(), shape_message.get(), tag_shapes);
            receive(id_rooms[1].here(), MPI_UINT32_T, tag_ids);
        }
        if (out > 0) {
            attempt([&] {
                const auto n = static_cast<std::size_t>(out);
                compact(local, shapes.size(), comes_near<Shapes>{shapes, looking[target]}, id_rooms[0].there());
                for_each_index(local, n, pack_shape<Shapes>{shapes, id_rooms[0].there(), shape_rooms[0].there()});
                id_rooms[0].bring_here(local, n);
                shape_rooms[0].bring_here(local, n);
            });
            send(shape_rooms[0].here(), shape_message.get(), tag_shapes);
            send(id_rooms[0].here(), MPI_UINT32_T, tag_ids);
        }
        check_mpi(MPI_Waitall(count, requests, MPI_STATUSES_IGNORE), "MPI_Waitall");
        if (in == 0) continue;
        attempt([&] {
            const auto n = static_cast<std::size_t>(in);
            shape_rooms[1].bring_there(local, n);
            id_rooms[1].bring_there(local, n);
            use(source, shapes_view<shape_type, space_of<Local>>(shape_rooms[1].there(), n), id_rooms[1].there());
        });
    }
    attempt.settle(ranks);
}

}  // namespace abut::detail
