// SPDX-License-Identifier: MIT
#pragma once

// What each of many points or rays asks, in a stream (async.hpp): nearest, raycast, raycast_any. There are as many answers as
// rows, so all that a caller can get wrong is known before.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

#include <abut/collide/async.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/error.hpp>

namespace abut::detail {

struct write_rows_state {
    std::uint64_t count;
    async_state* out;
    ABUT_HD void operator()(std::size_t) const { *out = {count, count, 0}; }
};

/// Whether a question of rows in a stream takes both.
template <class Policy, class Question, class X, class Rows>
consteval bool can_ask_rows_async() {
    if constexpr (!has_stream<Policy>()) {
        return false;
    } else if constexpr (is_bodies<X>) {
        static_assert(!is_bodies<X>, "abut: bodies are for calls that wait");
        return false;
    } else if constexpr (is_row_of_points<Rows>) {
        static_assert(!is_row_of_points<Rows>,
                      "abut: a call that does not wait takes points that lie on the device: a set, or a points_view over them");
        return false;
    } else if constexpr (Question::template takes<Policy, X, Rows, true>()) {
        constexpr bool takes = Question::template takes_in_stream<scalar_of_argument<X>>;
        static_assert(takes, "abut: this question needs the host between its kernels, in this scalar type: it is for calls that wait");
        constexpr bool x = can_be_asked_async<Policy, X>(), rows = can_be_asked_async<Policy, Rows>();
        return takes && x && rows;
    } else {
        return false;
    }
}

template <class Policy, class Outcome, class Question, class X, class Rows>
void ask_rows(const async<Policy, Outcome>& stream, const Question& question, const X& index, const Rows& rows) {
    if constexpr (can_ask_rows_async<Policy, Question, X, Rows>()) {
        using found = found_by<Question, X, std::uint32_t>;
        static_assert(std::same_as<Outcome, async_result<found, space_of<Policy>>>,
                      "abut: the result is of another type than what rows ask for: an async_result of neighbor, of ray_hit, or of "
                      "std::uint8_t");
        const Policy& on = stream.policy();
        Outcome& into = stream.into();
        const std::string name = std::string(question.function) + "_async";
        check_outcome(on, into, name);
        const auto x = make_operand<input::trusted>(on, index, name.c_str());
        const auto from = make_operand<input::trusted>(on, rows, name.c_str());
        question.check(on, x, from, nullptr);
        std::size_t count = from.shapes().size();
        if constexpr (requires { question.count; }) count *= question.count;
        if (count > into.capacity()) {
            throw capacity_error(name + ": there are " + std::to_string(count) + " answers, and room for " +
                                 std::to_string(into.capacity()));
        }
        question.in_stream(on, x, from, async_parts::items(into));
        auto& room = async_parts::room(into);
        for_each_index(on, 1, write_rows_state{count, room.state.data()});
        room.again = [on, question, index, rows] { return ask_rows(on, question, index, rows); };
    }
}

}  // namespace abut::detail
