// SPDX-License-Identifier: MIT
#pragma once

// Questions of many points or lines (collide/row_questions.hpp) to shapes whose parts lie on many ranks: nearest, raycast,
// raycast_any, inside; raycast_all is in row_lists.hpp. A rank asks its own part first. Then its points or lines go to each
// other rank whose part may change what is known, and answers come back.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/inside.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/parts.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>

#include <mpi.h>

namespace abut::detail {

/// Ids of a rank's shapes in the whole set.
struct ids_from {
    std::uint64_t first;
    ABUT_HD std::uint64_t operator()(std::uint32_t i) const { return first + i; }
};

/// Rows whose answers a part may change.
template <shape_view Rows, class Question>
struct may_be_changed {
    using T = typename Rows::scalar_type;
    Rows rows;
    Question question;
    const typename Question::answer* best;
    part_bounds<T> part;
    ABUT_HD bool operator()(std::size_t i) const {
        return question.may_change(rows[i], best + i * question.per_row(), part);
    }
};

/// How far a box of points reaches. The distance of two boxes is computed as that of a point from a box, and is no larger.
template <scalar T>
struct reach_of_block {
    shrinking_ball<T> ball;
    aabb<T> around;
    ABUT_HD T least_in(const aabb<T>& box) const {
        const vec3<T> away = greatest(vec3<T>{}, greatest(around.lower - box.upper, box.lower - around.upper));
        return dot(away, away);
    }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return ball.keeps(least); }
};
/// Of points: some neighbours, and the largest measure that one of them has.
template <scalar T>
struct block_looking {
    aabb<T> box;
    double worst;

    [[nodiscard]] ABUT_HD bool may_be_near(const part_bounds<T>& part, const length_unit<T>& unit) const {
        auto ball = world_frame<T>{unit.length(1)}.ball_around(box.lower);
        if (worst < infinity<double>) ball.shrink_to(worst);
        return may_keep(part, reach_of_block<T>{ball, box});
    }
};
template <shape_view Points>
struct write_blocks_looking {
    using T = typename Points::scalar_type;
    Points points;
    const measured_neighbor<T>* best;
    std::size_t count;
    block_looking<T>* blocks;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t first = k * block_size, left = points.size() - first;
        block_looking<T> block{empty_box<T>(), 0};
        for (std::size_t i = first; i < first + (left < block_size ? left : block_size); ++i) {
            block.box = merge(block.box, bounds(points[i]));
            block.worst = greatest(block.worst, best[(i + 1) * count - 1].measure);
        }
        blocks[k] = block;
    }
};
template <scalar T>
struct may_block_be_near {
    const block_looking<T>* blocks;
    length_unit<T> unit;
    part_bounds<T> part;
    ABUT_HD bool operator()(std::size_t k) const { return blocks[k].may_be_near(part, unit); }
};

/// Finds the blocks of rows that a part may have something for: of lines, which reach far, all are looked at.
template <class Policy, class Question, shape_view Rows>
class rows_looking {
public:
    rows_looking() = default;
    rows_looking(const Policy& policy, std::size_t n) : ids_(policy, n) {}
    void look(const Policy&, const Question&, const Rows&, const typename Question::answer*) {}
    /// The rows of which a part may change the answers, to ids(). Returns how many these are.
    std::size_t choose(const Policy& on, const may_be_changed<Rows, Question>& may) {
        return compact(on, may.rows.size(), may, ids_.data());
    }
    [[nodiscard]] const std::uint32_t* ids() const { return ids_.data(); }

private:
    execution::buffer_of<Policy, std::uint32_t> ids_;
};
template <class Policy, scalar T, shape_view Rows>
class rows_looking<Policy, nearest_in_parts<T>, Rows> {
public:
    rows_looking() = default;
    rows_looking(const Policy& policy, std::size_t n)
        : ids_(policy, n), blocks_(policy, blocks_of(n)), near_(policy, blocks_of(n)) {}
    /// What blocks still look for.
    void look(const Policy& on, const nearest_in_parts<T>& question, const Rows& rows, const measured_neighbor<T>* best) {
        for_each_index(on, blocks_.size(), write_blocks_looking<Rows>{rows, best, question.count, blocks_.data()});
    }
    std::size_t choose(const Policy& on, const may_be_changed<Rows, nearest_in_parts<T>>& may) {
        const may_block_be_near<T> may_block{blocks_.data(), may.question.unit, may.part};
        const std::size_t blocks = compact(on, blocks_.size(), may_block, near_.data());
        const in_blocks<may_be_changed<Rows, nearest_in_parts<T>>> in{may, near_.data(), may.rows.size()};
        const std::size_t chosen = compact(on, blocks * block_size, in, ids_.data());
        for_each_index(on, chosen, write_ids_in_blocks<may_be_changed<Rows, nearest_in_parts<T>>>{in, ids_.data()});
        return chosen;
    }
    [[nodiscard]] const std::uint32_t* ids() const { return ids_.data(); }

private:
    execution::buffer_of<Policy, std::uint32_t> ids_;
    execution::buffer_of<Policy, block_looking<T>> blocks_;
    execution::buffer_of<Policy, std::uint32_t> near_;
};

template <class Question>
struct merge_some_answers {
    Question question;
    const std::uint32_t* rows;
    const typename Question::answer* answers;
    typename Question::answer* best;
    ABUT_HD void operator()(std::size_t i) const {
        question.merge(best + rows[i] * question.per_row(), answers + i * question.per_row());
    }
};

/// The ranks' rows and shapes, ready to be asked about.
template <class Local, class Operand, class Asking, class Question>
class rows_of_ranks {
public:
    using answer = typename Question::answer;
    using view = std::remove_const_t<decltype(std::declval<const Asking&>().shapes())>;
    using row = typename view::shape_type;
    using T = typename view::scalar_type;

    rows_of_ranks(const distributed<Local>& policy, const Operand& x, const Asking& asking, const parts_of_set<T>& parts,
                  const std::vector<std::uint64_t>& rows_of_rank, const Question& question)
        : on_(policy),
          local_(policy.local()),
          x_(x),
          asking_(asking),
          parts_(parts),
          rows_of_rank_(rows_of_rank),
          question_(question),
          most_rows_(std::max<std::size_t>(1, most_answers / question.per_row())) {}

    /// finish(answers) makes of this rank's answers what the caller wants.
    template <class Finish>
    auto find(const Finish& finish) {
        const own_communicator& ranks = on_.ranks();
        const int me = ranks.rank(), all = ranks.size();
        const std::size_t n = asking_.shapes().size();
        attempts attempt;
        attempt([&] {
            best_ = execution::buffer_of<Local, answer>(local_, n * question_.per_row());
            looking_ = rows_looking<Local, Question, view>(local_, n);
            rooms_.emplace(local_, std::min(n, most_rows_), most_of_others(), question_.per_row());
            question_.ask(local_, x_, asking_, ids_from{parts_.first_of(me)}, best_.data());
            looking_.look(local_, question_, asking_.shapes(), best_.data());
        });
        attempt.settle(ranks);
        for (int round = 1; round < all; ++round) exchange((me + round) % all, (me - round + all) % all, attempt);
        std::optional<decltype(finish(std::move(best_)))> found;
        attempt([&] { found.emplace(finish(std::move(best_))); });
        attempt.settle(ranks);
        return std::move(*found);
    }

private:
    using row_room = message_room<Local, row>;
    using answer_room = message_room<Local, answer>;
    /// Of a message, unless one row has more.
    static constexpr std::size_t most_answers = std::size_t{1} << 16;

    struct rooms {
        row_room asked, asking;
        answer_room answered, answering;
        rooms(const Local& policy, std::size_t mine, std::size_t others, std::size_t per_row)
            : asked(policy, mine),
              asking(policy, others),
              answered(policy, mine * per_row),
              answering(policy, others * per_row) {}
    };

    [[nodiscard]] std::size_t most_of_others() const {
        const std::uint64_t most = *std::max_element(rows_of_rank_.begin(), rows_of_rank_.end());
        return static_cast<std::size_t>(std::min<std::uint64_t>(most, most_rows_));
    }

    /// Asks `target`, and answers `source`, some rows at a time. Each knows how many there are before.
    void exchange(int target, int source, attempts& attempt) {
        enum tag { tag_count, tag_rows, tag_answers };
        const MPI_Comm comm = on_.ranks().get();
        const view rows = asking_.shapes();
        const std::size_t per_row = question_.per_row();
        const bool asks = rows.size() > 0 && parts_[target].size > 0;
        const bool is_asked = rows_of_rank_[static_cast<std::size_t>(source)] > 0 && parts_[on_.rank()].size > 0;
        std::uint64_t out = 0, in = 0;
        MPI_Request requests[2];
        int open = 0;
        const auto wait = [&] {
            check_mpi(MPI_Waitall(open, requests, MPI_STATUSES_IGNORE), "MPI_Waitall");
            open = 0;
        };
        const auto send = [&](const void* data, std::uint64_t count, MPI_Datatype type, int to, tag which) {
            check_mpi(MPI_Isend(data, static_cast<int>(count), type, to, which, comm, &requests[open++]), "MPI_Isend");
        };
        const auto receive = [&](void* data, std::uint64_t count, MPI_Datatype type, int from, tag which) {
            check_mpi(MPI_Irecv(data, static_cast<int>(count), type, from, which, comm, &requests[open++]), "MPI_Irecv");
        };
        if (is_asked) receive(&in, 1, MPI_UINT64_T, source, tag_count);
        if (asks) {
            attempt([&] { out = looking_.choose(local_, {rows, question_, best_.data(), parts_[target]}); });
            send(&out, 1, MPI_UINT64_T, target, tag_count);
        }
        wait();
        for (std::uint64_t first = 0; first < std::max(out, in); first += most_rows_) {
            const auto part = [&](std::uint64_t total) {
                return static_cast<std::size_t>(first < total ? std::min<std::uint64_t>(total - first, most_rows_) : 0);
            };
            const std::size_t asked = part(out), asking = part(in);
            if (asking > 0) receive(rooms_->asking.here(), asking, row_type_.get(), source, tag_rows);
            if (asked > 0) {
                attempt([&] {
                    for_each_index(local_, asked, pack_shape<view>{rows, looking_.ids() + first, rooms_->asked.there()});
                    rooms_->asked.bring_here(local_, asked);
                });
                if (attempt.failed()) rooms_->asked.give_up(asked);
                send(rooms_->asked.here(), asked, row_type_.get(), target, tag_rows);
            }
            wait();
            if (asked > 0) receive(rooms_->answered.here(), asked * per_row, answer_type_.get(), target, tag_answers);
            if (asking > 0) {
                attempt([&] {
                    rooms_->asking.bring_there(local_, asking);
                    using came = shapes_view<row, space_of<Local>>;
                    question_.ask(local_, x_, plain_operand<came>{came(rooms_->asking.there(), asking)},
                                  ids_from{parts_.first_of(on_.rank())}, rooms_->answering.there());
                    rooms_->answering.bring_here(local_, asking * per_row);
                });
                send(rooms_->answering.here(), asking * per_row, answer_type_.get(), source, tag_answers);
            }
            wait();
            if (asked == 0) continue;
            attempt([&] {
                rooms_->answered.bring_there(local_, asked * per_row);
                for_each_index(local_, asked,
                               merge_some_answers<Question>{question_, looking_.ids() + first, rooms_->answered.there(),
                                                            best_.data()});
                synchronize(local_);
            });
        }
        if (out > 0) attempt([&] { looking_.look(local_, question_, rows, best_.data()); });
    }

    const distributed<Local>& on_;
    const Local& local_;
    const Operand& x_;
    const Asking& asking_;
    const parts_of_set<T>& parts_;
    const std::vector<std::uint64_t>& rows_of_rank_;
    Question question_;
    std::size_t most_rows_;
    message_type<row> row_type_;
    message_type<answer> answer_type_;
    execution::buffer_of<Local, answer> best_;
    rows_looking<Local, Question, view> looking_;
    std::optional<rooms> rooms_;
};

/// What this rank has of a question, and what all know of each other's parts.
template <class Operand, class Asking, scalar T>
struct asked_here {
    std::optional<Operand> shapes;
    std::optional<Asking> rows;
    parts_of_set<T> parts;
    std::vector<std::uint64_t> rows_of_rank;
    double largest = 0;  ///< of all ranks
};

/// The same, of arguments. All ranks call it; it throws on all or on none.
template <class Local, class Question, class X, class Rows>
auto bring_rows_and_shapes(const distributed<Local>& on, const Question& question, const X& index, const Rows& rows) {
    using T = scalar_of_argument<X>;
    const Local& local = on.local();
    const auto make_shapes = [&] { return make_operand(local, index, question.function); };
    const auto make_rows = [&] { return question.template make_rows<T>(local, rows, question.function); };
    asked_here<decltype(make_shapes()), decltype(make_rows()), T> here;
    part_bounds<T> mine;
    attempts attempt;
    attempt([&] {
        here.parts.make_room(on.size());
        here.rows_of_rank.resize(static_cast<std::size_t>(on.size()));
        here.shapes.emplace(make_shapes());
        here.rows.emplace(make_rows());
        mine = bounds_of_part(local, here.shapes->shapes());
        question.check(local, *here.shapes, *here.rows, "rank has all of a mesh");
        if constexpr (requires { question.count; }) {
            if (question.count >= std::size_t{1} << 31) {  // the answers of one point are one message
                throw capacity_error(std::string(question.function) + ": count is " + std::to_string(question.count) +
                                     ", expected less than 2^31");
            }
        }
        here.largest = question.largest(local, *here.shapes, *here.rows);
    });
    attempt.settle(on.ranks());
    here.parts.gather(on.ranks(), mine);
    gather(on.ranks(), std::uint64_t{here.rows->shapes().size()}, here.rows_of_rank);
    if constexpr (requires { question.count; }) {
        const double mine_of_all = here.largest;
        require_one(on.ranks(), static_cast<double>(question.count), question.function, "counts");
        check_mpi(MPI_Allreduce(&mine_of_all, &here.largest, 1, MPI_DOUBLE, MPI_MAX, on.ranks().get()), "MPI_Allreduce");
    }
    return here;
}

/// Whether ranks take both arguments.
template <class Local, class Question, class X, class Rows>
consteval bool can_ask_ranks() {
    static_assert(!Question::filters, "abut: ranks take no filter of rows: those of other ranks have no numbers there");
    if constexpr (refuse_bodies<is_bodies<X>>() && !Question::filters) return Question::template takes<Local, X, Rows, false>();
    return false;
}

/// Of ranks.
template <class Local, class Question, class X, class Rows>
auto ask_rows(const distributed<Local>& on, const Question& question, const X& index, const Rows& rows) {
    if constexpr (can_ask_ranks<Local, Question, X, Rows>()) {
        using found = found_by<Question, X, std::uint64_t>;
        const auto here = bring_rows_and_shapes(on, question, index, rows);
        const auto in_parts = question.template in_parts<scalar_of_argument<X>>(here.largest);
        return rows_of_ranks(on, *here.shapes, *here.rows, here.parts, here.rows_of_rank, in_parts).find([&](auto answers) {
            return result<found, space_of<Local>>(named_answers<found>(on.local(), in_parts, std::move(answers)));
        });
    } else {
        return no_answer<Question, std::uint64_t, space_of<Local>>();
    }
}

/// What is made of answers may fail on one rank.
template <class Local, class Use>
auto make_of_answers(const distributed<Local>& on, by_its_policy, const Use& use) {
    std::optional<decltype(use(on.local()))> made;
    attempts attempt;
    attempt([&] { made.emplace(use(on.local())); });
    attempt.settle(on.ranks());
    return std::move(*made);
}

}  // namespace abut::detail
