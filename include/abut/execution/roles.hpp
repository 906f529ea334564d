// SPDX-License-Identifier: MIT
#pragma once

// What a verb asks of the functors that it is given: a concept for each role. A verb refuses a functor that does not play
// its role with one line that names the concept (execution/generic.hpp).
//
// Concepts see syntax. These hold for all roles besides:
// - Functors are called concurrently, through a const object, and in no order. They keep no state of their own.
// - A call takes constant time, unless the role says otherwise.
// - A functor that runs on a device is trivially copyable, and its functions are ABUT_HD. No concept can see the latter:
//   what users supply goes through the verb require_callable.
// - What a functor finds goes to the sinks of the verb's queues (execution/work_queue.hpp), which come last in a call.
//   A loop may run again when a queue proves too small. So a functor with a queue writes elsewhere only what a second run
//   would write too.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/config.hpp>
#include <abut/execution/group.hpp>

namespace abut::execution {

// --- sinks -------------------------------------------------------------------------------------------------------------

/// Takes values.
template <class S, class T>
concept value_sink = requires(S& sink, const T& value) {
    sink.push(value);
};

/// Takes numbers, of which the sum is wanted.
template <class S>
concept sum_sink = requires(S& sink, std::uint32_t k) {
    sink.add(k);
};

/// One value is enough.
template <class S>
concept is_flag = requires(S& sink) {
    sink.raise();
};

/// What it takes spares work, so candidates for it are judged as soon as they are found.
template <class S>
concept is_eager = is_flag<S> || requires { requires S::eager; };

/// May tell a loop to end early.
template <class S>
concept may_stop = requires(const S& sink) {
    { sink.raised() } -> std::convertible_to<bool>;
};

/// What a loop with queues is given (execution/work_queue.hpp): it names the sink that functors see.
template <class Q>
concept loop_queue = requires {
    typename Q::sink;
};

template <loop_queue Queue>
using sink_of = typename Queue::sink;

// --- loops over indices --------------------------------------------------------------------------------------------------

/// f(i, sink...): the work of index i.
template <class F, class... Sinks>
concept index_functor = requires(const F& f, std::size_t i, Sinks&... sinks) {
    f(i, sinks...);
};

/// f(i): whether index i is wanted. The same each time it is asked.
template <class F>
concept index_test = requires(const F& f, std::size_t i) {
    { f(i) } -> std::convertible_to<bool>;
};

/// f(i): the value of index i. It is asked for once, and may be stored elsewhere on the way.
template <class F, class T>
concept index_value = requires(const F& f, std::size_t i) {
    { f(i) } -> std::convertible_to<T>;
};

/// c(a, b): associative and commutative, as far as rounding lets it be.
template <class C, class T>
concept combiner = requires(const C& c, const T& a, const T& b) {
    { c(a, b) } -> std::convertible_to<T>;
};

/// f(group): the work of a group of neighbours (execution/group.hpp), in steps between barriers. F::shared is the memory
/// that the members share; on a device nothing is written to it before the functor runs. F::members is how many these are,
/// subgroup_size or, where it is not said, group_size.
template <class F>
concept group_functor = std::default_initializable<typename F::shared> &&
    requires(const F& f, const group<typename F::shared, group_size_of<F>>& members) {
    f(members);
};

// --- candidates and their judges -----------------------------------------------------------------------------------------

namespace archetype {

/// What a walk pushes candidates into. Says whether there is little room left.
template <class Candidate>
struct walk_emitter {
    void push(const Candidate& c) const;
    [[nodiscard]] bool is_full() const;
};

/// What an expander hands items and candidates to: both are taken where `is` is true. `k` is a number, or a type whose
/// `value` is one, so that a device can keep what it names in registers.
template <class Item, class Candidate>
struct expander_emitter {
    template <class Number>
    void add(Number k, bool is, const Item& item);
    template <class Number>
    void push(Number k, bool is, const Candidate& c);
};

}  // namespace archetype

/// judge(c, sink...): decides a candidate, and says whether it could; if not, judge.finish(c, sink...) does, some time
/// later. The first is short, and the second may take long. A judge that lives on the host may have prefetch(c, step), a
/// hint that c comes soon: step 0, and some time later step 1.
template <class J, class Candidate, class... Sinks>
concept candidate_judge = requires(const J& judge, const Candidate& c, Sinks&... sinks) {
    { judge(c, sinks...) } -> std::convertible_to<bool>;
    judge.finish(c, sinks...);
};

/// walk.may_find(i): whether index i may have candidates; a short test that most indices may fail.
/// walk(i, at, emitter, sink...): hands on the candidates of i by emitter.push(c). A walk that has handed on two asks
/// emitter.is_full() before it hands on more. If so, it returns true; it is called again with the same `at`, which began as
/// it is made by default, and goes on from there. At its end it returns false. It may take long, and looks at its sinks to
/// end early.
template <class W, class... Sinks>
concept candidate_walk = std::default_initializable<typename W::cursor> && std::copyable<typename W::candidate> &&
    requires(const W& walk, std::size_t i, typename W::cursor& at,
             const archetype::walk_emitter<typename W::candidate>& emitter, Sinks&... sinks) {
    { walk.may_find(i) } -> std::convertible_to<bool>;
    { walk(i, at, emitter, sinks...) } -> std::convertible_to<bool>;
};

/// Work that makes work. It begins with expand.seed(i) for every i < expand.seeds(). expand(item, emitter) hands on what an
/// item makes, by emitter.add(k, is, item) and emitter.push(k, is, candidate). In one call each k < most_children is used
/// once at most by either; most_children is a constant, and any number on the host. An item descends from most_depth others
/// at most. expand.prefetch(item) is a hint for the host that the item comes soon.
template <class E>
concept expander = std::copyable<typename E::item> && std::copyable<typename E::candidate> &&
    requires(const E& expand, std::size_t i, const typename E::item& item,
             archetype::expander_emitter<typename E::item, typename E::candidate>& emitter) {
    { E::most_children + 0u } -> std::same_as<unsigned>;
    { E::most_depth + 0u } -> std::same_as<unsigned>;
    { expand.seeds() } -> std::convertible_to<std::size_t>;
    { expand.seed(i) } -> std::convertible_to<typename E::item>;
    expand.prefetch(item);
    expand(item, emitter);
};

/// All pairs of a row i and a column j for which tile.passes(reach, column), a short test: row = tile.load_row(i), reach =
/// tile.reach_of(row), column = tile.load_column(j). tile(row, i, column, j, sink...) judges a pair that passes, and what it
/// leaves open goes to tile.finish(tile.candidate_of(i, j), sink...). tile.rows_in_memory() is where rows lie one after
/// another, or null.
template <class F, class... Sinks>
concept tile_functor = requires(const F& tile, std::size_t i, const typename F::row& row, const typename F::column& column,
                                const typename F::candidate& c, Sinks&... sinks) {
    { tile.rows_in_memory() } -> std::convertible_to<const typename F::row*>;
    { tile.load_row(i) } -> std::convertible_to<typename F::row>;
    { tile.load_column(i) } -> std::convertible_to<typename F::column>;
    { tile.passes(tile.reach_of(row), column) } -> std::convertible_to<bool>;
    { tile.candidate_of(i, i) } -> std::convertible_to<typename F::candidate>;
    { tile(row, i, column, i, sinks...) } -> std::convertible_to<bool>;
    tile.finish(c, sinks...);
};

// --- the least that plays each role ------------------------------------------------------------------------------------

/// Declared, never called: a policy is asked whether it takes these (execution_policy).
namespace archetype {

struct functor {
    void operator()(std::size_t, auto&...) const;
};
struct test {
    bool operator()(std::size_t) const;
};
struct value {
    unsigned operator()(std::size_t) const;
};
struct combine {
    unsigned operator()(unsigned, unsigned) const;
};
struct group_functor {
    struct shared {};
    void operator()(const group<shared>&) const;
};
struct judge {
    bool operator()(unsigned, auto&...) const;
    void finish(unsigned, auto&...) const;
};
struct walk {
    using candidate = unsigned;
    struct cursor {};
    [[nodiscard]] bool may_find(std::size_t) const;
    bool operator()(std::size_t, cursor&, const auto& emitter, auto&...) const;
};
struct expander {
    using item = unsigned;
    using candidate = unsigned;
    static constexpr unsigned most_children = 1, most_depth = 1;
    [[nodiscard]] std::size_t seeds() const;
    [[nodiscard]] item seed(std::size_t) const;
    void prefetch(item) const;
    void operator()(item, auto& emitter) const;
};
struct tile {
    using row = unsigned;
    using column = unsigned;
    using candidate = unsigned;
    [[nodiscard]] const row* rows_in_memory() const;
    [[nodiscard]] row load_row(std::size_t) const;
    [[nodiscard]] column load_column(std::size_t) const;
    [[nodiscard]] row reach_of(row) const;
    [[nodiscard]] bool passes(row, column) const;
    [[nodiscard]] candidate candidate_of(std::size_t, std::size_t) const;
    bool operator()(row, std::size_t, column, std::size_t, auto&...) const;
    void finish(candidate, auto&...) const;
};

}  // namespace archetype

}  // namespace abut::execution
