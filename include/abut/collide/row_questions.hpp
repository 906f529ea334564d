// SPDX-License-Identifier: MIT
#pragma once

// Questions that many points or lines (rows) ask, each by itself: what is nearest, what a line meets first, whether it meets
// anything, whether a point is inside. A question is a type; executors (executor.hpp) answer it by overloads of ask_rows, of
// which that of a policy is here. devices/rows.hpp and distributed/rows.hpp are for shapes in parts: each part answers all
// that it is asked, and answers of two parts become one, so that nothing depends on how shapes are divided.
//
// A question has
//   function                          in whose name it throws
//   takes<Policy, X, Rows, Whole>()   whether arguments will do; X is a whole set or a part. Says in one line why not
//   found<T, Id>                      what a caller gets of a row, by how shapes are named (by_id)
//   filters                           whether numbers of rows matter: those of an operand (numbers_of), or places
//   make_rows<T>(on, rows, function)  the rows as an operand
//   check(on, x, rows, holder)        throws where it may not be asked; `holder`, or null, says who lacks some shapes
//   largest(on, x, rows)              a number of which the greatest, of all parts, goes into the answer
//   at_once(on, x, rows, largest)     a `result` of found, of a whole set
//   in_parts<T>(largest)              what parts are asked, if the answer can be made of theirs; that has
//     answer                          what one part says of a row; a row has per_row() of them
//     ask(on, x, rows, ids, out)      what shapes x answer to rows, both operands, in the policy's memory; ids(i) is
//                                     the id in the whole set of the part's shape i
//     merge(best, other)              takes into a row's answers those that another part gives
//     may_change(row, best, part)     whether a part, by its boxes, may have an answer that changes these
//     named<Found>(answer)            what a caller gets

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/executor.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/parts.hpp>
#include <abut/execution/buffer.hpp>

namespace abut {

/// The id of no shape in a set of many parts.
/// @ingroup distributed
inline constexpr std::uint64_t no_global_id = static_cast<std::uint64_t>(-1);

namespace detail {

/// Bodies (body_rows.hpp): what they have in common with one set is that rows ask them. Shapes have keys, with the number of
/// the body above that of the shape.
///@{
template <class X>
inline constexpr bool is_bodies = false;
struct body_and_id {};
ABUT_HD constexpr std::uint64_t body_key(std::uint32_t body, std::uint32_t id) { return std::uint64_t{body} << 32 | id; }
ABUT_HD constexpr std::uint32_t body_of_key(std::uint64_t key) { return static_cast<std::uint32_t>(key >> 32); }
///@}

/// Of three types that of an answer which names shapes by ids of one set, of bodies, or of many parts.
template <class Id, class OfSet, class OfBodies, class OfParts>
using by_id = std::conditional_t<std::is_same_v<Id, std::uint32_t>, OfSet,
                                 std::conditional_t<std::is_same_v<Id, body_and_id>, OfBodies, OfParts>>;
/// How an operand's shapes are named.
template <class Operand>
struct id_in_operand {
    using type = std::uint32_t;
};
template <class Operand>
using operand_id = typename id_in_operand<Operand>::type;

/// What rows ask as an operand, and whether it can be one.
template <class Policy, class X, class Question>
auto make_asked(const Policy& on, const X& x, const Question& question) {
    return make_operand(on, x, question.function);
}
template <class Policy, class X>
consteval bool can_be_asked_by_rows() {
    if constexpr (is_bodies<X> && requires { typename X::index_type; }) {
        return lies_there<Policy, X>();
    } else if constexpr (is_bodies<X>) {  // a list of them
        return lies_there<Policy, decltype(X::value_type::object)>();
    } else {
        return can_be_asked<Policy, X>();
    }
}

/// The numbers of rows: their places, unless an operand has others.
struct same_number {
    ABUT_HD std::size_t operator()(std::size_t i) const { return i; }
};
template <class Rows>
auto numbers_of(const Rows& rows) {
    if constexpr (requires { rows.numbers; }) {
        return rows.numbers;
    } else {
        return same_number{};
    }
}
/// The ids of a whole set: keys as they are.
struct same_key {
    ABUT_HD std::uint64_t operator()(std::uint64_t key) const { return key; }
};
/// Or of bodies, of which others come before.
struct bodies_from {
    std::uint32_t first = 0;
    ABUT_HD std::uint64_t operator()(std::uint64_t key) const { return key + body_key(first, 0); }
};
/// The id in the whole of what has a key in a part; the key of a set is an id.
template <class Ids>
ABUT_HD std::uint64_t in_whole(const Ids& ids, std::uint64_t key) {
    if constexpr (std::same_as<Ids, same_key> || std::same_as<Ids, bodies_from>) {
        return ids(key);
    } else {
        return ids(static_cast<std::uint32_t>(key));
    }
}
/// A filter that is asked of a part's shapes.
template <class Filter, class Ids>
struct filter_of_part {
    Filter filter;
    Ids ids;
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool operator()(std::uint32_t row, std::uint32_t id) const {
        return filter(row, static_cast<std::uint32_t>(ids(id)));
    }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool operator()(std::uint32_t row, std::uint32_t body, std::uint32_t id) const {
        return filter(row, ids.first + body, id);
    }
};
template <class Filter, class Ids>
auto filter_in_part(const Filter& filter, const Ids& ids) {
    if constexpr (std::same_as<Filter, keep_all> || std::same_as<Ids, same_key>) {
        return filter;
    } else {
        return filter_of_part<Filter, Ids>{filter, ids};
    }
}
/// Whether a filter of rows and shapes can be called. What a device calls is not looked at.
template <class Policy, class Filter, bool Bodies>
consteval bool is_row_filter() {
    if constexpr (!host_policy<Policy>) {
        return true;
    } else if constexpr (Bodies) {
        constexpr bool is = requires(const Filter& f, std::uint32_t i) {
            { f(i, i, i) } -> std::convertible_to<bool>;
        };
        static_assert(is,
                      "abut: this filter is called as filter(row, body, id) const, three std::uint32_t, and returns bool");
        return is;
    } else {
        constexpr bool is = requires(const Filter& f, std::uint32_t i) {
            { f(i, i) } -> std::convertible_to<bool>;
        };
        static_assert(is, "abut: this filter is called as filter(row, id) const, two std::uint32_t, and returns bool");
        return is;
    }
}

/// What of a question is so for most of them.
struct row_question {
    static constexpr bool filters = false;  ///< it has a filter that is given numbers of rows
    template <scalar>
    static constexpr bool takes_in_stream = false;
    template <class Policy, class X, class Rows>
    void check(const Policy&, const X&, const Rows&, const char* /*holder*/) const {}
    template <class Policy, class X, class Rows>
    [[nodiscard]] double largest(const Policy&, const X&, const Rows&) const {
        return 0;
    }
    [[nodiscard]] ABUT_HD std::size_t per_row() const { return 1; }
};

template <class X>
using scalar_of_argument = scalar_type_of<typename shape_of_argument<X>::type>;
/// What comes of a question to X, with ids of one type.
template <class Question, class X, class Id>
using found_by = typename Question::template found<scalar_of_argument<X>, Id>;
/// The empty answer of an executor that does not take its arguments: a static_assert has said why.
template <class Question, class Id, memory_space Space>
using no_answer = result<typename Question::template found<float, Id>, Space>;

/// Of a policy, which has all shapes.
template <execution_policy Policy, class Question, class X, class Rows>
auto ask_rows(const Policy& on, const Question& question, const X& index, const Rows& rows) {
    if constexpr (Question::template takes<Policy, X, Rows, true>()) {
        const auto x = make_asked(on, index, question);
        const auto from = question.template make_rows<scalar_of_argument<X>>(on, rows, question.function);
        question.check(on, x, from, nullptr);
        return question.at_once(on, x, from, question.largest(on, x, from));
    } else {
        return no_answer<Question, std::uint32_t, space_of<Policy>>();
    }
}

/// For what is made of answers: use(policy) by the policy in whose memory they lie.
struct by_its_policy {};
template <execution_policy Policy, class Use>
auto make_of_answers(const Policy& on, by_its_policy, const Use& use) {
    return use(on);
}

// Of parts.

/// Whether a part may hold what a reach keeps (shrinking_reach).
template <scalar T, class Reach>
ABUT_HD bool may_keep(const part_bounds<T>& part, const Reach& reach) {
    if (!reach.keeps(reach.least_in(part.around))) return false;
    bool may = false;
    for (std::size_t k = 0; k < part_boxes; ++k) {
        const aabb<T>& box = part.groups[k];
        may |= box.lower.x <= box.upper.x && reach.keeps(reach.least_in(box));
    }
    return may;
}

template <class Question>
struct merge_answers {
    Question question;
    const typename Question::answer* other;
    typename Question::answer* best;
    ABUT_HD void operator()(std::size_t row) const {
        question.merge(best + row * question.per_row(), other + row * question.per_row());
    }
};
template <class Question, class Found>
struct name_answers {
    Question question;
    const typename Question::answer* answers;
    Found* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = question.template named<Found>(answers[i]); }
};
/// Answers as a caller gets them.
template <class Found, class Policy, class Question>
auto named_answers(const Policy& on, const Question& question,
                   execution::buffer_of<Policy, typename Question::answer> answers) {
    if constexpr (std::is_same_v<Found, typename Question::answer>) {
        return answers;
    } else {
        execution::buffer_of<Policy, Found> out(on, answers.size());
        for_each_index(on, answers.size(), name_answers<Question, Found>{question, answers.data(), out.data()});
        synchronize(on);
        return out;
    }
}

}  // namespace detail

}  // namespace abut
