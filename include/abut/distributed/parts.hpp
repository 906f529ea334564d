// SPDX-License-Identifier: MIT
#pragma once

// Parts of sets on ranks: where they are, and how shapes of one rank come to the ranks whose shapes they come near.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/parts.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/packed_shapes.hpp>

#include <mpi.h>

namespace abut::detail {

/// All parts of a set.
template <scalar T>
class parts_of_set {
public:
    /// Room for the parts of so many ranks.
    void make_room(int ranks) {
        of_rank_.resize(static_cast<std::size_t>(ranks));
        first_id_.resize(of_rank_.size());
    }
    /// After make_room on all ranks.
    void gather(const own_communicator& ranks, const part_bounds<T>& mine) {
        detail::gather(ranks, mine, of_rank_);
        std::uint64_t first = 0;
        for (std::size_t k = 0; k < of_rank_.size(); ++k) {
            first_id_[k] = first;
            first += of_rank_[k].size;
        }
    }
    /// What comes near enough to each part of another set, in room for as many.
    template <class Reach>
    void take_grown(const parts_of_set& other, const Reach& reach) {
        std::transform(other.of_rank_.begin(), other.of_rank_.end(), of_rank_.begin(), reach);
    }
    [[nodiscard]] const part_bounds<T>& operator[](int rank) const { return of_rank_[static_cast<std::size_t>(rank)]; }
    /// The id of a rank's first shape.
    [[nodiscard]] std::uint64_t first_of(int rank) const { return first_id_[static_cast<std::size_t>(rank)]; }

private:
    std::vector<part_bounds<T>> of_rank_;
    std::vector<std::uint64_t> first_id_;
};

// --- what goes where ---------------------------------------------------------------------------------------------------

/// What exchange_parcels keeps of each rank: the sizes of parcels to it and from it, and what is under way.
template <class Sizes>
struct parcel_room {
    std::vector<Sizes> to, from;
    std::vector<MPI_Request> open;

    void make_room(int ranks) {
        to.resize(static_cast<std::size_t>(ranks));
        from.resize(to.size());
        open.reserve(2 * to.size() + 16);
    }
};

/// Hands parcels of each rank to other ranks. All ranks call it, each with a room that it has made; it throws on all of them
/// or on none.
///
/// It goes in rounds: in round k each rank sends to the k-th rank behind it and receives from the k-th before it. Both know
/// from the boxes of all parts whether there is a parcel, so ranks that are far apart exchange nothing: goes(from, to) is
/// the same on both. A parcel is some arrays. `parcels` says how long they are, makes room for the longest once, and then
/// packs and unpacks them in that room:
///   measure(to) -> sizes             how long the arrays for a rank are, std::array<std::uint64_t, N>; all 0 for no parcel
///   make_room(out, in)               for arrays of that many elements at most
///   pack(to, sizes)                  writes the arrays for a rank
///   send(sizes, f), receive(sizes, f)  f(address on the host, number, MPI type) for each array
///   unpack(from, sizes)              uses what has come
template <class Local, class Goes, class Parcels>
void exchange_parcels(const distributed<Local>& on, attempts& attempt, parcel_room<typename Parcels::sizes>& room,
                      const Goes& goes, Parcels& parcels) {
    using sizes = typename Parcels::sizes;
    auto &to = room.to, &from = room.from;
    auto& open = room.open;
    constexpr int arrays = int{std::tuple_size_v<sizes>};
    const own_communicator& ranks = on.ranks();
    const int me = ranks.rank(), all = ranks.size();
    const auto rank_in = [&](int round) { return (me + round + all) % all; };
    enum tag { tag_sizes, tag_is_whole, tag_arrays };

    // How much goes where.
    for (int round = 1; round < all; ++round) {
        const int target = rank_in(round), source = rank_in(-round);
        if (goes(source, me)) {
            auto& coming = from[static_cast<std::size_t>(source)];
            open.emplace_back();
            check_mpi(MPI_Irecv(coming.data(), arrays, MPI_UINT64_T, source, tag_sizes, ranks.get(), &open.back()),
                      "MPI_Irecv");
        }
        if (goes(me, target)) {
            auto& going = to[static_cast<std::size_t>(target)];
            attempt([&] { going = parcels.measure(target); });
            open.emplace_back();
            check_mpi(MPI_Isend(going.data(), arrays, MPI_UINT64_T, target, tag_sizes, ranks.get(), &open.back()),
                      "MPI_Isend");
        }
    }
    check_mpi(MPI_Waitall(static_cast<int>(open.size()), open.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");

    // From here on parcels are sent whatever fails.
    attempt([&] {
        sizes most_out{}, most_in{};
        for (int rank = 0; rank < all; ++rank) {
            for (std::size_t k = 0; k < std::size_t{arrays}; ++k) {
                most_out[k] = std::max(most_out[k], to[static_cast<std::size_t>(rank)][k]);
                most_in[k] = std::max(most_in[k], from[static_cast<std::size_t>(rank)][k]);
            }
        }
        parcels.make_room(most_out, most_in);
    });
    attempt.settle(ranks);

    for (int round = 1; round < all; ++round) {
        const int target = rank_in(round), source = rank_in(-round);
        const sizes out = to[static_cast<std::size_t>(target)], in = from[static_cast<std::size_t>(source)];
        open.clear();
        int is_whole_in = 0, is_whole_out = 0;  // what was not packed is not unpacked
        int which = tag_arrays;
        if (in != sizes{}) {
            open.emplace_back();
            check_mpi(MPI_Irecv(&is_whole_in, 1, MPI_INT, source, tag_is_whole, ranks.get(), &open.back()), "MPI_Irecv");
            parcels.receive(in, [&](void* data, std::uint64_t n, MPI_Datatype type) {
                open.emplace_back();
                const int count = static_cast<int>(n);
                check_mpi(MPI_Irecv(data, count, type, source, which++, ranks.get(), &open.back()), "MPI_Irecv");
            });
        }
        which = tag_arrays;
        if (out != sizes{}) {
            attempt([&] { parcels.pack(target, out); });
            is_whole_out = attempt.failed() ? 0 : 1;
            if (attempt.failed()) parcels.give_up();
            open.emplace_back();
            check_mpi(MPI_Isend(&is_whole_out, 1, MPI_INT, target, tag_is_whole, ranks.get(), &open.back()), "MPI_Isend");
            parcels.send(out, [&](const void* data, std::uint64_t n, MPI_Datatype type) {
                open.emplace_back();
                const int count = static_cast<int>(n);
                check_mpi(MPI_Isend(data, count, type, target, which++, ranks.get(), &open.back()), "MPI_Isend");
            });
        }
        check_mpi(MPI_Waitall(static_cast<int>(open.size()), open.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
        if (is_whole_in != 0) attempt([&] { parcels.unpack(source, in); });
    }
    attempt.settle(ranks);
}

/// Room for shapes and their ids, on their way out and in: what parcels of such have in common.
template <class Local, class Shape, class Id>
class shape_rooms {
public:
    using sizes = typename packed_shapes<Local, Shape>::sizes;

    explicit shape_rooms(const Local& local) : local_(local) {}
    void make_room(const sizes& out, const sizes& in) {
        out_.emplace(local_, out);
        in_.emplace(local_, in);
    }
    template <class F>
    void send(const sizes& size, const F& f) {
        hand_over(*out_, size, f);
    }
    template <class F>
    void receive(const sizes& size, const F& f) {
        hand_over(*in_, size, f);
    }

protected:
    struct room {
        packed_shapes<Local, Shape> shapes;
        message_room<Local, Id> ids;
        room(const Local& local, const sizes& size, in_message is = in_message::yes)
            : shapes(local, size, is), ids(local, static_cast<std::size_t>(size[0]), is) {}
        void bring_here(const Local& local, const sizes& size) {
            shapes.bring_here(local, size);
            ids.bring_here(local, static_cast<std::size_t>(size[0]));
        }
        void bring_there(const Local& local, const sizes& size) {
            shapes.bring_there(local, size);
            ids.bring_there(local, static_cast<std::size_t>(size[0]));
        }
    };
    const Local& local_;
    std::optional<room> out_, in_;

public:
    /// What could not be packed is sent all the same.
    void give_up() {
        out_->shapes.give_up();
        out_->ids.give_up();
    }

private:
    template <class F>
    void hand_over(room& all, const sizes& size, const F& f) {
        all.shapes.hand_over(size, element_type_, f);
        f(all.ids.here(), size[0], id_type_.get());
    }
    message_type<typename packed_shapes<Local, Shape>::element> element_type_;
    message_type<Id> id_type_;
};

/// Shapes that parts of other ranks ask for, with their ids: `Chosen` counts them and writes these (near_shapes in
/// collide/parts.hpp). use(rank, shapes, ids) is called for what comes from a rank, in memory of the policy's that is used
/// again after it.
template <class Local, class Chosen, class Use>
class shape_parcels : public shape_rooms<Local, typename Chosen::view::shape_type, std::uint32_t> {
    using shape_type = typename Chosen::view::shape_type;
    using rooms = shape_rooms<Local, shape_type, std::uint32_t>;
    using rooms::local_, rooms::out_, rooms::in_;

public:
    using T = typename Chosen::T;
    using sizes = typename rooms::sizes;

    shape_parcels(const Local& local, Chosen chosen, const parts_of_set<T>& looking, const Use& use)
        : rooms(local), chosen_(std::move(chosen)), looking_(looking), use_(use) {}

    [[nodiscard]] sizes measure(int to) {
        return packed_shapes<Local, shape_type>::measure(local_, chosen_, looking_[to]);
    }
    void pack(int to, const sizes& size) {
        std::uint32_t* const ids = out_->ids.there();
        chosen_.write_ids(local_, looking_[to], ids);
        out_->shapes.pack(local_, chosen_.shapes(), ids, static_cast<std::size_t>(size[0]));
        out_->bring_here(local_, size);
    }
    void unpack(int from, const sizes& size) {
        in_->bring_there(local_, size);
        use_(from, in_->shapes.view(size), in_->ids.there());
        synchronize(local_);
    }

private:
    Chosen chosen_;
    const parts_of_set<T>& looking_;
    const Use& use_;
};

}  // namespace abut::detail
