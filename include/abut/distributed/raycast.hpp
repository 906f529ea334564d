// SPDX-License-Identifier: MIT
#pragma once

// raycast, raycast_any and raycast_all of sets whose parts lie on many ranks. For the first two rays go to one rank after
// another, as long as it may have something for them. For all hits they go to all ranks whose parts they pass, and lists
// come back.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <abut/collide/merge.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/distributed/rows.hpp>

#include <mpi.h>

namespace abut {

/// @addtogroup distributed
///@{

/// A `ray_hit` with an id in a set of many parts. Where nothing is met: `no_global_id` and infinity.
template <scalar T>
struct global_ray_hit {
    std::uint64_t id;  ///< of the shape
    T t;               ///< where: at origin + t direction, or a + t (b - a) of a segment

    friend constexpr bool operator==(const global_ray_hit&, const global_ray_hit&) = default;
};

/// A `hit_of_ray` with numbers in sets of many parts.
template <scalar T>
struct global_hit_of_ray {
    std::uint64_t ray;  ///< its number among the rays of all ranks
    std::uint64_t id;   ///< of the shape
    T t;                ///< where, as in ray_hit

    friend constexpr bool operator==(const global_hit_of_ray&, const global_hit_of_ray&) = default;
};

///@}

namespace detail {

template <scalar T>
struct write_global_hits {
    const execution::least_value* found;
    global_ray_hit<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const bool is = found[i].key != no_global_id;
        out[i] = {found[i].key, is ? time_as<T>(found[i].value) : infinity<T>};
    }
};
template <scalar T>
struct write_global_timed_hits {
    const timed_hit* found;
    std::uint64_t first_ray;
    global_hit_of_ray<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = {first_ray + found[i].line, found[i].id, time_as<T>(found[i].time)};
    }
};

template <class Local, class X, class Rays>
auto bring_rays_and_shapes(const distributed<Local>& on, const X& index, const Rays& rays, const char* function) {
    return bring_rows_and_shapes(
        on, index, rays, function,
        [](const auto& policy, const auto& rows, const char* name) { return make_operand(policy, rows, name); },
        [](const auto&, const auto&) {});
}

template <shape_view Lines>
struct line_passes {
    Lines lines;
    part_bounds<typename Lines::scalar_type> there;
    ABUT_HD bool operator()(std::size_t i) const { return may_meet(lines[i], there, infinity<double>); }
};
/// Lines that pass boxes of a part.
template <class Policy, shape_view Lines>
class lines_that_pass {
public:
    using view = Lines;
    using T = typename Lines::scalar_type;

    explicit lines_that_pass(const Lines& lines) : lines_(lines) {}
    [[nodiscard]] const Lines& shapes() const { return lines_; }
    [[nodiscard]] std::uint64_t count(const Policy& on, const part_bounds<T>& there) const {
        return reduce(on, lines_.size(), std::uint64_t{0}, add_up_tallies{}, one_if<line_passes<Lines>>{{lines_, there}});
    }
    void write_ids(const Policy& on, const part_bounds<T>& there, std::uint32_t* ids) const {
        (void)compact(on, lines_.size(), line_passes<Lines>{lines_, there}, ids);
    }

private:
    Lines lines_;
};

/// Lists of hits, one for each rank. use(hits, n) is called for what comes, in memory that is used again after it.
template <class Local, class Use>
class hit_parcels {
public:
    using sizes = std::array<std::uint64_t, 1>;
    using list = execution::buffer_of<Local, timed_hit>;

    hit_parcels(const Local& local, std::vector<list>& lists, const Use& use) : local_(local), lists_(lists), use_(use) {}

    [[nodiscard]] sizes measure(int to) const {
        const std::size_t n = lists_[static_cast<std::size_t>(to)].size();
        if (n >= std::size_t{1} << 31) {
            throw capacity_error("abut::raycast_all: " + std::to_string(n) +
                                 " hits of one rank's rays in the part of another, expected fewer than 2^31");
        }
        return {n};
    }
    void make_room(const sizes& out, const sizes& in) {
        out_.emplace(local_, static_cast<std::size_t>(out[0]));
        in_.emplace(local_, static_cast<std::size_t>(in[0]));
    }
    void pack(int to, const sizes& size) {
        list& mine = lists_[static_cast<std::size_t>(to)];
        copy(local_, mine.data(), mine.size(), out_->there());
        out_->bring_here(local_, static_cast<std::size_t>(size[0]));
        synchronize(local_);
        mine = {};
    }
    void give_up() { out_->give_up(); }
    template <class F>
    void send(const sizes& size, const F& f) {
        f(out_->here(), size[0], type_.get());
    }
    template <class F>
    void receive(const sizes& size, const F& f) {
        f(in_->here(), size[0], type_.get());
    }
    void unpack(int, const sizes& size) {
        const auto n = static_cast<std::size_t>(size[0]);
        in_->bring_there(local_, n);
        use_(in_->there(), n);
        synchronize(local_);
    }

private:
    const Local& local_;
    std::vector<list>& lists_;
    const Use& use_;
    message_type<timed_hit> type_;
    std::optional<message_room<Local, timed_hit>> out_, in_;
};

/// Numbers that lines had where they came from.
struct part_lines {
    const std::uint32_t* numbers;
    ABUT_HD std::size_t operator()(std::size_t i) const { return numbers[i]; }
};

/// All hits of this rank's lines: some lists, each in order.
template <arithmetic A, class Local, class Here>
auto all_hits_of_ranks(const distributed<Local>& on, const Here& here) {
    using list = execution::buffer_of<Local, timed_hit>;
    using lines_type = std::remove_cvref_t<decltype(here.rows->shapes())>;
    const Local& local = on.local();
    const ids_from ids{here.parts.first_of(on.rank())};
    found_lists<Local, timed_hit> found;
    std::vector<list> for_others;
    parcel_room<std::array<std::uint64_t, 1>> lines_room, hits_room;
    attempts attempt;
    attempt([&] {
        lines_room.make_room(on.size());
        hits_room.make_room(on.size());
        for_others.resize(static_cast<std::size_t>(on.size()));
        const name_timed_hit<same_number, ids_from> name{{}, ids};
        found.emplace_back(look_for_all_hits<A, timed_hit>(local, lines_and_shapes{*here.shapes, *here.rows}, name));
    });
    attempt.settle(on.ranks());

    const auto asks = [&](int from, int to) {
        return here.rows_of_rank[static_cast<std::size_t>(from)] > 0 && here.parts[to].size > 0;
    };
    const auto answer = [&](int from, const auto& came, const std::uint32_t* numbers) {
        const plain_operand<std::remove_cvref_t<decltype(came)>> rows{came};
        const name_timed_hit<part_lines, ids_from> name{{numbers}, ids};
        for_others[static_cast<std::size_t>(from)] =
            look_for_all_hits<A, timed_hit>(local, lines_and_shapes{*here.shapes, rows}, name);
    };
    shape_parcels lines(local, lines_that_pass<Local, lines_type>(here.rows->shapes()), here.parts, answer);
    exchange_parcels(on, attempt, lines_room, asks, lines);

    const auto keep = [&](const timed_hit* hits, std::size_t n) {
        list some(local, n);
        copy(local, hits, n, some.data());
        synchronize(local);
        found.emplace_back(std::move(some));
    };
    hit_parcels hits(local, for_others, keep);
    exchange_parcels(on, attempt, hits_room, [&](int from, int to) { return asks(to, from); }, hits);
    return found;
}

}  // namespace detail

/// @addtogroup distributed
///@{

/// For each of this rank's `rays` the shape of all parts that it meets first: a `result` of `global_ray_hit`, in the
/// order of the rays, in the local policy's memory; 16 bytes each. `index` is this rank's part, and `rays` this rank's rays
/// or segments; both as of `raycast` under the local policy. Rays go to ranks whose parts they may meet before what is
/// known, at most 65,536 in a message. The answers are those of one machine, bit for bit.
template <arithmetic A = filtered, execution_policy Local, class X, class Rays>
[[nodiscard]] auto raycast(const distributed<Local>& on, const X& index, const Rays& rays) {
    if constexpr (detail::can_be_met<Local, X, Rays>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<X>::type>;
        const Local& local = on.local();
        const auto here = detail::bring_rays_and_shapes(on, index, rays, "abut::raycast");
        return detail::answers_of_ranks(on, here, detail::ask_first_hit<A>{}, [&](const auto& found) {
            execution::buffer_of<Local, global_ray_hit<T>> out(local, found.size());
            for_each_index(local, found.size(), detail::write_global_hits<T>{found.data(), out.data()});
            synchronize(local);
            return result<global_ray_hit<T>, space_of<Local>>(std::move(out));
        });
    } else {
        return result<global_ray_hit<float>, space_of<Local>>();
    }
}

/// For each of this rank's `rays` whether it meets any shape of all parts: a `result` of `std::uint8_t`, 1 or 0.
/// Arguments are those of `raycast`. A ray that has met something goes nowhere else.
template <arithmetic A = filtered, execution_policy Local, class X, class Rays>
[[nodiscard]] auto raycast_any(const distributed<Local>& on, const X& index, const Rays& rays) {
    using answer = result<std::uint8_t, space_of<Local>>;
    if constexpr (detail::can_be_met<Local, X, Rays>()) {
        const auto here = detail::bring_rays_and_shapes(on, index, rays, "abut::raycast_any");
        return detail::answers_of_ranks(on, here, detail::ask_any_hit<A>{},
                                        [](auto found) { return answer(std::move(found)); });
    } else {
        return answer();
    }
}

/// All shapes of all parts that each of this rank's `rays` meets: a `result` of `global_hit_of_ray`, sorted by the ray's
/// number, then by t, then by id. The lists of all ranks, one after another, are the list of one machine. Arguments are
/// those of `raycast`.
///
/// A rank holds the hits of others' rays in its part until all rays have come, 24 bytes each, besides its own, of which it
/// holds 48 bytes more. Throws capacity_error for 2^31 such hits or more of one rank's rays in one other part.
template <arithmetic A = filtered, execution_policy Local, class X, class Rays>
[[nodiscard]] auto raycast_all(const distributed<Local>& on, const X& index, const Rays& rays) {
    if constexpr (detail::can_be_met<Local, X, Rays>()) {
        using T = scalar_type_of<typename detail::shape_of_argument<X>::type>;
        const Local& local = on.local();
        const auto here = detail::bring_rays_and_shapes(on, index, rays, "abut::raycast_all");
        auto lists = detail::all_hits_of_ranks<A>(on, here);
        std::uint64_t first_ray = 0;
        for (int k = 0; k < on.rank(); ++k) first_ray += here.rows_of_rank[static_cast<std::size_t>(k)];
        result<global_hit_of_ray<T>, space_of<Local>> found;
        detail::attempts attempt;
        attempt([&] {
            const auto hits =
                detail::joined<Local, detail::timed_hit>(local, std::move(lists), true, detail::by_line_and_time{});
            execution::buffer_of<Local, global_hit_of_ray<T>> out(local, hits.size());
            for_each_index(local, hits.size(),
                           detail::write_global_timed_hits<T>{hits.data(), first_ray, out.data()});
            synchronize(local);
            found = result<global_hit_of_ray<T>, space_of<Local>>(std::move(out));
        });
        attempt.settle(on.ranks());
        return found;
    } else {
        return result<global_hit_of_ray<float>, space_of<Local>>();
    }
}

///@}

}  // namespace abut
