// SPDX-License-Identifier: MIT
#pragma once

// Questions of many points or lines (collide/row_questions.hpp) to several devices. Where each device has all shapes, the
// rows are shared out; where shapes are divided, each device answers all rows of its part, and the first one merges the
// answers.

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/operand.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/devices/divide.hpp>
#include <abut/execution/team.hpp>

namespace abut::detail {

/// So many rows after each other go to one device, and the next ones to the next.
inline constexpr std::size_t rows_together = 4096;

/// The rows of a part, of `parts`.
struct rows_of_part {
    std::size_t part, parts;
    /// How many there are, of n.
    [[nodiscard]] std::size_t count(std::size_t n) const {
        const std::size_t round = rows_together * parts, rest = n % round, first = rows_together * part;
        return n / round * rows_together + (rest > first ? std::min(rest - first, rows_together) : 0);
    }
    /// Which is the i-th.
    [[nodiscard]] ABUT_HD std::size_t operator()(std::size_t i) const {
        return (i / rows_together * parts + part) * rows_together + i % rows_together;
    }
};
template <class Team>
rows_of_part rows_of(const Team& team, int k) {
    return {static_cast<std::size_t>(k), static_cast<std::size_t>(team.size())};
}

template <shape_view Rows>
struct take_rows_of_part {
    Rows rows;
    rows_of_part mine;
    typename Rows::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = rows[mine(i)]; }
};
template <class Found>
struct put_rows_of_part {
    const Found* found;
    rows_of_part theirs;
    std::size_t per_row;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[theirs(i / per_row) * per_row + i % per_row] = found[i]; }
};

/// What is asked, and who asks, on a device.
template <class X, class Rows>
struct asked_there {
    X shapes;
    Rows rows;
};

/// Both on each device. make_rows(policy, rows, function) makes an operand of what a device has of the rows.
template <class Team, class X, class Rows, class MakeRows>
auto asked_on_each(const Team& team, const X& index, const Rows& rows, const char* function, const MakeRows& make_rows) {
    static_assert(!is_divided<Rows>,
                  "abut: on several devices points, rays and segments are replicated or in host memory, not divided");
    require_as_many(team, index, function);
    require_as_many(team, rows, function);
    return each_of(team, [&](int k) {
        auto x = make_operand(team[k], on_device(index, k), function);
        auto from = make_rows(team[k], on_device(rows, k), function);
        return asked_there<decltype(x), decltype(from)>{std::move(x), std::move(from)};
    });
}

/// use(rows) of a device's share of the rows, which is copied for it.
template <class Team, class Rows, class Use>
auto with_share_of_rows(const Team& team, int k, const Rows& rows, const Use& use) {
    const auto& on = team[k];
    const auto all = rows.shapes();
    using view_type = std::remove_const_t<decltype(all)>;
    using row = typename view_type::shape_type;
    using local = typename Team::local_policy;
    const rows_of_part mine = rows_of(team, k);
    execution::buffer_of<local, row> some(on, mine.count(all.size()));
    for_each_index(on, some.size(), take_rows_of_part<view_type>{all, mine, some.data()});
    using view = shapes_view<row, space_of<local>>;
    return use(plain_operand<view>{view(some.data(), some.size())});
}

/// What the devices answer, in memory of the first. finish(policy, answers) makes of answers in memory of a policy what the
/// caller wants of them, as many.
template <class Team, class There, class X, class Question, class Finish>
auto answers_of_devices(const Team& team, const std::vector<There>& there, const X& index, const Question& question,
                        const Finish& finish) {
    using local = typename Team::local_policy;
    using answers = execution::buffer_of<local, typename Question::answer>;
    const std::size_t rows = there.front().rows.shapes().size(), n = rows * question.per_row();
    const local& first = team[0];
    const auto ask = [&](int k, const auto& mine, const part_ids& ids) {
        answers all(team[k], mine.shapes().size() * question.per_row());
        question.ask(team[k], there[static_cast<std::size_t>(k)].shapes, mine, ids, all.data());
        return all;
    };
    if constexpr (is_divided<X>) {
        auto found =
            each_of(team, [&](int k) { return ask(k, there[static_cast<std::size_t>(k)].rows, index.ids(k)); });
        answers best = std::move(found.front()), other(first, found.size() > 1 ? n : 0);
        for (std::size_t k = 1; k < found.size(); ++k) {
            copy_across(team[static_cast<int>(k)], found[k].data(), n, first, other.data());
            found[k] = {};
            for_each_index(first, rows, merge_answers<Question>{question, other.data(), best.data()});
            synchronize(first);
        }
        return finish(first, std::move(best));
    } else {
        if (team.size() == 1) return finish(first, ask(0, there.front().rows, part_ids{}));
        auto found = each_of(team, [&](int k) {
            return with_share_of_rows(team, k, there[static_cast<std::size_t>(k)].rows,
                                      [&](const auto& mine) { return finish(team[k], ask(k, mine, part_ids{})); });
        });
        using list = typename decltype(found)::value_type;
        list all(first, n);
        for (int k = 0; k < team.size(); ++k) {
            list& some = found[static_cast<std::size_t>(k)];
            list came(first, some.size());
            copy_across(team[k], some.data(), some.size(), first, came.data());
            some = {};
            for_each_index(first, came.size(),
                           put_rows_of_part<typename list::value_type>{came.data(), rows_of(team, k), question.per_row(), all.data()});
            synchronize(first);
        }
        return all;
    }
}

/// Answers as they are.
struct take_answers {
    template <class Policy, class Answers>
    Answers operator()(const Policy&, Answers answers) const {
        return answers;
    }
};

}  // namespace abut::detail
