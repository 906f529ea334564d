// SPDX-License-Identifier: MIT
#pragma once

// Sets that are divided anew among ranks, along a Morton curve: each rank gets as many shapes, and neighbours in space.
// Parts are then far from each other, and little has to be sent.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/options.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/packed_shapes.hpp>
#include <abut/index/morton.hpp>
#include <abut/index/operand.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/set.hpp>

#include <mpi.h>

namespace abut {

/// A rank's part of a set that was divided anew.
/// @ingroup distributed
template <shape_set Set>
struct redistributed_part {
    Set set;                                                 ///< its shapes, along the curve
    result<std::uint64_t, typename Set::memory_space> ids;  ///< of each, its id in the set as it was
};

namespace detail {

template <shape_view Shapes>
struct write_codes_and_ids {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    aabb<T> around;
    std::uint64_t* codes;
    std::uint32_t* ids;
    ABUT_HD void operator()(std::size_t i) const {
        codes[i] = morton_code<std::uint64_t>(bounds(shapes[i]), around);
        ids[i] = static_cast<std::uint32_t>(i);
    }
};
struct write_global_ids {
    const std::uint32_t* ids;
    std::uint64_t first;
    std::uint64_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = first + ids[i]; }
};
struct gather_global_ids {
    const std::uint64_t* ids;
    const std::uint32_t* places;
    std::uint64_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = ids[places[i]]; }
};

/// Shapes along the curve: their codes and places.
template <class Policy>
struct curve_of_part {
    execution::buffer_of<Policy, std::uint64_t> codes;
    execution::buffer_of<Policy, std::uint32_t> order;

    template <shape_view Shapes, scalar T>
    curve_of_part(const Policy& policy, const Shapes& shapes, const aabb<T>& around)
        : codes(policy, shapes.size()), order(policy, shapes.size()) {
        for_each_index(policy, shapes.size(), write_codes_and_ids<Shapes>{shapes, around, codes.data(), order.data()});
        sort_by_key(policy, codes, order, morton_bits<std::uint64_t>);
    }
};

/// Where the parts of all ranks begin among a rank's own codes, which ascend: each rank gets as many of all codes, and of
/// equal ones those of the first ranks come first.
class division_of_codes {
public:
    /// Room for so many ranks.
    void make_room(int ranks) {
        inner_ = ranks - 1;
        const auto parts = static_cast<std::size_t>(ranks);
        for (auto* values : {&code_, &tried_, &counts_, &all_, &equal_, &equal_before_}) values->assign(parts, 0);
        first_.assign(parts + 1, 0);
    }
    /// The first of each rank's part, and the number of codes.
    [[nodiscard]] const std::vector<std::uint64_t>& first() const { return first_; }

    /// Bisects the codes, the beginnings of all parts at a time. All ranks call it.
    void divide(const own_communicator& ranks, const std::vector<std::uint64_t>& codes) {
        const auto parts = static_cast<std::size_t>(ranks.size()), inner = static_cast<std::size_t>(inner_);
        const auto below = [&](std::uint64_t code) {
            return static_cast<std::uint64_t>(std::lower_bound(codes.begin(), codes.end(), code) - codes.begin());
        };
        const std::uint64_t here = codes.size();
        std::uint64_t total = 0;
        check_mpi(MPI_Allreduce(&here, &total, 1, MPI_UINT64_T, MPI_SUM, ranks.get()), "MPI_Allreduce");
        const auto wanted = [&](std::size_t k) { return total / parts * (k + 1) + total % parts * (k + 1) / parts; };

        // The code of the first shape of each part but the first: the largest with no more than wanted below it.
        for (std::uint64_t bit = std::uint64_t{1} << (morton_bits<std::uint64_t> - 1); bit > 0; bit >>= 1) {
            for (std::size_t k = 0; k < inner; ++k) counts_[k] = below(tried_[k] = code_[k] | bit);
            sum_counts(ranks);
            for (std::size_t k = 0; k < inner; ++k) {
                if (all_[k] <= wanted(k)) code_[k] = tried_[k];
            }
        }
        for (std::size_t k = 0; k < inner; ++k) {
            counts_[k] = below(code_[k]);
            equal_[k] = below(code_[k] + 1) - counts_[k];
        }
        sum_counts(ranks);
        check_mpi(MPI_Exscan(equal_.data(), equal_before_.data(), inner_, MPI_UINT64_T, MPI_SUM, ranks.get()), "MPI_Exscan");
        for (std::size_t k = 0; k < inner; ++k) {
            const std::uint64_t before = ranks.rank() == 0 ? 0 : equal_before_[k], missing = wanted(k) - all_[k];
            first_[k + 1] = counts_[k] + std::min(equal_[k], missing > before ? missing - before : 0);
        }
        first_[parts] = here;
    }

private:
    void sum_counts(const own_communicator& ranks) {
        check_mpi(MPI_Allreduce(counts_.data(), all_.data(), inner_, MPI_UINT64_T, MPI_SUM, ranks.get()), "MPI_Allreduce");
    }
    int inner_ = 0;  ///< parts but the first
    std::vector<std::uint64_t> code_, tried_, counts_, all_, equal_, equal_before_, first_;
};

/// Shapes that go to other ranks for good, along the curve, and their ids.
template <class Local, shape_view Shapes>
class part_parcels : public shape_rooms<Local, typename Shapes::shape_type, std::uint64_t> {
    using rooms = shape_rooms<Local, typename Shapes::shape_type, std::uint64_t>;
    using rooms::local_, rooms::out_, rooms::in_;

public:
    using shape_type = typename Shapes::shape_type;
    using packed = packed_shapes<Local, shape_type>;
    using sizes = typename rooms::sizes;
    /// Shapes and ids that stay.
    struct part {
        sizes size{};
        typename rooms::room values;
        part(const Local& local, const sizes& n) : size(n), values(local, n, in_message::no) {}
        /// Writes those of another room, from `at` on, which is advanced.
        void put(const Local& local, typename rooms::room& from, const sizes& n, sizes& at) {
            copy(local, from.ids.there(), static_cast<std::size_t>(n[0]), values.ids.there() + at[0]);
            values.shapes.put(local, from.shapes, n, at);
        }
    };

    part_parcels(const Local& local, const Shapes& shapes, const std::uint32_t* order, std::uint64_t first_id,
                 const std::vector<std::uint64_t>& first)
        : rooms(local), shapes_(shapes), order_(order), first_id_(first_id), first_(first), from_(first.size() - 1) {}

    [[nodiscard]] sizes measure(int to) const {
        const auto k = static_cast<std::size_t>(to);
        return packed::measure(local_, shapes_, order_ + first_[k], static_cast<std::size_t>(first_[k + 1] - first_[k]));
    }
    void pack(int to, const sizes& size) {
        write(to, size, *out_);
        out_->bring_here(local_, size);
    }
    void unpack(int from, const sizes& size) {
        in_->bring_there(local_, size);
        part came(local_, size);
        sizes at{};
        came.put(local_, *in_, size, at);
        synchronize(local_);
        from_[static_cast<std::size_t>(from)].emplace(std::move(came));
    }

    /// All that came, in the order of the ranks, with what stays here.
    part all(int me, const char* function) {
        part stays(local_, measure(me));
        write(me, stays.size, stays.values);
        from_[static_cast<std::size_t>(me)].emplace(std::move(stays));
        sizes total{}, at{};
        for (const auto& one : from_) {
            for (std::size_t k = 0; one && k < total.size(); ++k) total[k] += one->size[k];
        }
        for (const std::uint64_t n : total) check_count(static_cast<std::size_t>(n), function);
        part whole(local_, total);
        for (auto& one : from_) {
            if (one) whole.put(local_, one->values, one->size, at);
        }
        synchronize(local_);
        from_.clear();
        return whole;
    }

private:
    void write(int to, const sizes& size, typename rooms::room& out) {
        const std::uint32_t* const order = order_ + first_[static_cast<std::size_t>(to)];
        const auto n = static_cast<std::size_t>(size[0]);
        out.shapes.pack(local_, shapes_, order, n);
        for_each_index(local_, n, write_global_ids{order, first_id_, out.ids.there()});
    }

    Shapes shapes_;
    const std::uint32_t* order_;
    std::uint64_t first_id_;
    const std::vector<std::uint64_t>& first_;
    std::vector<std::optional<part>> from_;
};

template <class Local, class Set>
auto redistributed(const distributed<Local>& on, const Set& set, const char* function) {
    const own_communicator& ranks = on.ranks();
    const Local& local = on.local();
    attempts attempt;
    const auto bring = [&] { return make_resident(local, set, function); };
    std::optional<decltype(bring())> here;
    using view_type = decltype(view_of(*here));
    using shape_type = typename view_type::shape_type;
    using T = typename view_type::scalar_type;
    part_bounds<T> mine;
    parts_of_set<T> parts;
    parcel_room<sizes_of_shapes<shape_type>> room;
    division_of_codes division;
    attempt([&] {
        parts.make_room(ranks.size());
        room.make_room(ranks.size());
        division.make_room(ranks.size());
        here.emplace(bring());
        mine = bounds_of_part(local, view_of(*here));
    });
    attempt.settle(ranks);
    const view_type view = view_of(*here);
    parts.gather(ranks, mine);
    aabb<T> around = empty_box<T>();
    for (int rank = 0; rank < ranks.size(); ++rank) around = merge(around, parts[rank].around);

    std::optional<curve_of_part<Local>> curve;
    std::optional<part_parcels<Local, view_type>> parcels;
    std::vector<std::uint64_t> codes;
    attempt([&] {
        curve.emplace(local, view, around);
        codes.resize(view.size());
        download(local, curve->codes.data(), codes.size(), codes.data());
        parcels.emplace(local, view, curve->order.data(), parts.first_of(ranks.rank()), division.first());
    });
    attempt.settle(ranks);
    division.divide(ranks, codes);
    exchange_parcels(
        on, attempt, room, [](int, int) { return true; }, *parcels);

    redistributed_part<typename packed_shapes<Local, shape_type>::set> part;
    attempt([&] {
        auto came = parcels->all(ranks.rank(), function);
        const auto all = came.values.shapes.view(came.size);
        const std::size_t n = all.size();
        const curve_of_part<Local> order(local, all, around);
        packed_shapes<Local, shape_type> sorted(local, came.size, in_message::no);
        sorted.pack(local, all, order.order.data(), n);
        execution::buffer_of<Local, std::uint64_t> ids(local, n);
        for_each_index(local, n, gather_global_ids{came.values.ids.there(), order.order.data(), ids.data()});
        synchronize(local);
        part = {sorted.take(), result<std::uint64_t, space_of<Local>>(std::move(ids))};
    });
    attempt.settle(ranks);
    return part;
}

}  // namespace detail

/// Divides a set anew: each rank gets as many shapes as the others, or one more, and they are neighbours along a Morton
/// curve (63 bits) through the middles of their boxes. `set` is this rank's part: a set or a view. Returns a
/// `redistributed_part`: its new part, shapes as they are (faces become triangles, spheres of one radius spheres), or `hulls`
/// of hulls, and for each the id that it had, 8 bytes each, in the local policy's memory. Equal places keep the order of
/// their ids. Other shapes, as queries need less to be sent then; it does not change answers but for the ids, which are
/// positions in the new parts.
///
/// Besides the result a rank holds its codes twice, 8 bytes each, and its shapes three times while they come. Throws
/// capacity_error where a rank gets 2^31 points of hulls or more.
/// @ingroup distributed
template <execution_policy Local, class Set>
[[nodiscard]] auto redistribute(const distributed<Local>& on, const Set& set) {
    if constexpr (detail::can_reside<Local, Set>()) {
        return detail::redistributed(on, set, "abut::redistribute");
    } else {
        return detail::refused{};
    }
}

}  // namespace abut
