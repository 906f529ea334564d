// SPDX-License-Identifier: MIT
#pragma once

// Questions of lines whose answers are lists (raycast_all, spans) to sets whose parts lie on many ranks: lines go to all ranks
// whose parts they pass, and lists come back.

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

namespace abut::detail {

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
template <class Local, class Hit, class Use>
class hit_parcels {
public:
    using sizes = std::array<std::uint64_t, 1>;
    using list = execution::buffer_of<Local, Hit>;

    hit_parcels(const Local& local, const char* function, std::vector<list>& lists, const Use& use)
        : local_(local), function_(function), lists_(lists), use_(use) {}

    [[nodiscard]] sizes measure(int to) const {
        const std::size_t n = lists_[static_cast<std::size_t>(to)].size();
        if (n >= std::size_t{1} << 31) {
            throw capacity_error(std::string(function_) + ": " + std::to_string(n) +
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
    const char* function_;
    std::vector<list>& lists_;
    const Use& use_;
    message_type<Hit> type_;
    std::optional<message_room<Local, Hit>> out_, in_;
};

/// Numbers that lines had where they came from.
struct part_lines {
    const std::uint32_t* numbers;
    ABUT_HD std::size_t operator()(std::size_t i) const { return numbers[i]; }
};

/// All hits of this rank's lines: some lists, each in order.
template <class Local, class Question, class Here>
auto all_hits_of_ranks(const distributed<Local>& on, const Question& question, const Here& here) {
    using lines_type = std::remove_cvref_t<decltype(here.rows->shapes())>;
    using item = typename Question::template item<typename lines_type::scalar_type>;
    using list = execution::buffer_of<Local, item>;
    const Local& local = on.local();
    const ids_from ids{here.parts.first_of(on.rank())};
    found_lists<Local, item> found;
    std::vector<list> for_others;
    parcel_room<std::array<std::uint64_t, 1>> lines_room, hits_room;
    attempts attempt;
    attempt([&] {
        lines_room.make_room(on.size());
        hits_room.make_room(on.size());
        for_others.resize(static_cast<std::size_t>(on.size()));
        const name_timed_hit name{same_number{}, ids};
        found.emplace_back(question.ask(local, *here.shapes, *here.rows, name));
    });
    attempt.settle(on.ranks());

    const auto asks = [&](int from, int to) {
        return here.rows_of_rank[static_cast<std::size_t>(from)] > 0 && here.parts[to].size > 0;
    };
    const auto answer = [&](int from, const auto& came, const std::uint32_t* numbers) {
        const plain_operand<std::remove_cvref_t<decltype(came)>> rows{came};
        const name_timed_hit name{part_lines{numbers}, ids};
        for_others[static_cast<std::size_t>(from)] = question.ask(local, *here.shapes, rows, name);
    };
    shape_parcels lines(local, lines_that_pass<Local, lines_type>(here.rows->shapes()), here.parts, answer);
    exchange_parcels(on, attempt, lines_room, asks, lines);

    const auto keep = [&](const item* hits, std::size_t n) {
        list some(local, n);
        copy(local, hits, n, some.data());
        synchronize(local);
        found.emplace_back(std::move(some));
    };
    hit_parcels<Local, item, decltype(keep)> hits(local, Question::function, for_others, keep);
    exchange_parcels(
        on, attempt, hits_room, [&](int from, int to) { return asks(to, from); }, hits);
    return found;
}

template <class Local, class Question, class X, class Rows>
auto ask_row_lists(const distributed<Local>& on, const Question& question, const X& index, const Rows& rows) {
    if constexpr (can_ask_ranks<Local, Question, X, Rows>()) {
        using hit = found_by<Question, X, std::uint64_t>;
        const auto here = bring_rows_and_shapes(on, question, index, rows);
        auto lists = all_hits_of_ranks(on, question, here);
        std::uint64_t first_ray = 0;
        for (int k = 0; k < on.rank(); ++k) first_ray += here.rows_of_rank[static_cast<std::size_t>(k)];
        return make_of_answers(on, by_its_policy{}, [&](const Local& local) {
            using item = typename Question::template item<scalar_of_argument<X>>;
            const auto hits = joined<Local, item>(local, std::move(lists), true, by_line_and_time{});
            return question.template finish<hit>(local, *here.rows, hits, first_ray);
        });
    } else {
        return no_answer<Question, std::uint64_t, space_of<Local>>();
    }
}

}  // namespace abut::detail
