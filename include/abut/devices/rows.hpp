// SPDX-License-Identifier: MIT
#pragma once

// Questions of many points or lines (collide/row_questions.hpp) to several devices: nearest, raycast and its like, inside,
// winding_number. Where each device has all shapes, the rows are shared out; where shapes are divided, each device answers
// all rows of its part, and the first one merges the answers.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/inside.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/collide/winding_number.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/merge.hpp>
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

/// Both on each device.
template <class Team, class Question, class X, class Rows>
auto asked_on_each(const Team& team, const Question& question, const X& index, const Rows& rows) {
    require_as_many(team, index, question.function);
    require_as_many(team, rows, question.function);
    return each_of(team, [&](int k) {
        auto x = make_asked(team[k], on_device(index, k), question);
        auto from = question.template make_rows<scalar_of_argument<type_on_device<X>>>(team[k], on_device(rows, k),
                                                                                       question.function);
        return asked_there<decltype(x), decltype(from)>{std::move(x), std::move(from)};
    });
}

/// Whether several devices take both arguments.
template <class Team, class Question, class X, class Rows>
consteval bool can_ask_devices() {
    static_assert(!is_divided<Rows>,
                  "abut: on several devices points, rays and segments are replicated or in host memory, not divided");
    if constexpr (!is_divided<Rows>) {
        return Question::template takes<typename Team::local_policy, type_on_device<X>, type_on_device<Rows>,
                                        !is_divided<X>>();
    } else {
        return false;
    }
}

/// A device's share of the rows, with their numbers.
template <class View>
struct share_of_rows : plain_operand<View> {
    rows_of_part numbers;
};
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
    return use(share_of_rows<view>{{view(some.data(), some.size())}, mine});
}

/// Of a set that each device has: answers to the shares of the rows, in memory of the first.
template <class Team, class Question, class There>
auto answers_to_shares(const Team& team, const Question& question, const std::vector<There>& there, double largest) {
    using local = typename Team::local_policy;
    const auto ask = [&](int k, const auto& mine) {
        return question.at_once(team[k], there[static_cast<std::size_t>(k)].shapes, mine, largest);
    };
    if (team.size() == 1) return ask(0, there.front().rows);
    auto found = each_of(team, [&](int k) {
        return with_share_of_rows(team, k, there[static_cast<std::size_t>(k)].rows,
                                  [&](const auto& mine) { return ask(k, mine); });
    });
    using value = typename decltype(found)::value_type::value_type;
    std::size_t n = 0;
    for (const auto& some : found) n += some.size();
    const std::size_t rows = there.front().rows.shapes().size(), per_row = rows == 0 ? 1 : n / rows;
    execution::buffer_of<local, value> all(team[0], n);
    for (int k = 0; k < team.size(); ++k) {
        auto& some = found[static_cast<std::size_t>(k)];
        execution::buffer_of<local, value> came(team[0], some.size());
        copy_across(team[k], some.data(), some.size(), team[0], came.data());
        some = {};
        for_each_index(team[0], came.size(), put_rows_of_part<value>{came.data(), rows_of(team, k), per_row, all.data()});
        synchronize(team[0]);
    }
    return result<value, space_of<local>>(std::move(all));
}

/// Of a divided set: answers of each device to all rows, merged in memory of the first.
template <class Found, class Team, class Question, class There, class X>
auto answers_of_parts(const Team& team, const Question& question, const std::vector<There>& there, const X& index) {
    using local = typename Team::local_policy;
    using answers = execution::buffer_of<local, typename Question::answer>;
    const std::size_t rows = there.front().rows.shapes().size(), n = rows * question.per_row();
    const local& first = team[0];
    auto found = each_of(team, [&](int k) {
        const auto& mine = there[static_cast<std::size_t>(k)];
        answers all(team[k], n);
        question.ask(team[k], mine.shapes, mine.rows, index.ids(k), all.data());
        return all;
    });
    answers best = std::move(found.front()), other(first, found.size() > 1 ? n : 0);
    for (std::size_t k = 1; k < found.size(); ++k) {
        copy_across(team[static_cast<int>(k)], found[k].data(), n, first, other.data());
        found[k] = {};
        for_each_index(first, rows, merge_answers<Question>{question, other.data(), best.data()});
        synchronize(first);
    }
    return result<Found, space_of<local>>(named_answers<Found>(first, question, std::move(best)));
}

/// Of several devices.
template <execution::policy_team Team, class Question, class X, class Rows>
auto ask_rows(const Team& team, const Question& question, const X& index, const Rows& rows) {
    using there_type = type_on_device<X>;
    if constexpr (can_ask_devices<Team, Question, X, Rows>()) {
        const auto there = asked_on_each(team, question, index, rows);
        question.check(team[0], there.front().shapes, there.front().rows,
                       is_divided<X> ? "device has all of a divided mesh" : nullptr);
        double largest = 0;
        for (const double of_part : each_of(team, [&](int k) {
                 const auto& both = there[static_cast<std::size_t>(k)];
                 return question.largest(team[k], both.shapes, both.rows);
             })) {
            largest = greatest(largest, of_part);
        }
        if constexpr (is_divided<X>) {
            using T = scalar_of_argument<there_type>;
            return answers_of_parts<found_by<Question, there_type, std::uint32_t>>(
                team, question.template in_parts<T>(largest), there, index);
        } else {
            return answers_to_shares(team, question, there, largest);
        }
    } else {
        return no_answer<Question, std::uint32_t, space_of<typename Team::local_policy>>();
    }
}

/// Lists of the devices, each in order, which are merged.
template <execution::policy_team Team, class Question, class X, class Rows>
auto ask_row_lists(const Team& team, const Question& question, const X& index, const Rows& rows) {
    using local = typename Team::local_policy;
    if constexpr (can_ask_devices<Team, Question, X, Rows>()) {
        using there_type = type_on_device<X>;
        using hit = found_by<Question, there_type, std::conditional_t<is_bodies<there_type>, body_and_id, std::uint32_t>>;
        using list = result<typename Question::template item<scalar_of_argument<there_type>>, space_of<local>>;
        const auto there = asked_on_each(team, question, index, rows);
        question.check(team[0], there.front().shapes, there.front().rows,
                       is_divided<X> ? "device has all of a divided mesh" : nullptr);
        const list hits =
            on_first(team,
                     each_of(team,
                             [&](int k) {
                                 const auto& mine = there[static_cast<std::size_t>(k)];
                                 const auto look = [&](const auto& some, const auto& numbers, const auto& ids) {
                                     return list(question.ask(team[k], mine.shapes, some, name_timed_hit{numbers, ids}));
                                 };
                                 if constexpr (is_divided<X>) {
                                     return look(mine.rows, same_number{}, index.ids(k));
                                 } else {
                                     return with_share_of_rows(team, k, mine.rows, [&](const auto& some) {
                                         return look(some, rows_of(team, k), same_key{});
                                     });
                                 }
                             }),
                     true, by_line_and_time{});
        return question.template finish<hit>(team[0], there.front().rows, hits, 0);
    } else {
        return no_answer<Question, std::uint32_t, space_of<local>>();
    }
}

template <execution::policy_team Team, class Use>
auto make_of_answers(const Team& team, by_its_policy, const Use& use) {
    return use(team[0]);
}

}  // namespace abut::detail
