// SPDX-License-Identifier: MIT
#pragma once

// What a query asks of its arguments before it touches them, and how it makes a pairing of them: gates at compile time, each
// with one line of the compiler, then its options, then both operands.

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/judge.hpp>
#include <abut/collide/nearness.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/routes.hpp>
#include <abut/error.hpp>

namespace abut::detail {

/// What is checked before the arguments of a query are: its options.
template <class Policy, class Filter, traversal Traversal, schedule Schedule>
void check_options(const Policy& on, const query_options<Filter, Traversal, Schedule>& options, const char* function) {
    constexpr bool begins_at_depth = way_down<Traversal>::begins_at_depth || Schedule != schedule::shared_list;
    if (begins_at_depth && (options.start_depth < 0 || options.start_depth > most_start_depth)) {
        throw error(std::string(function) + ": start_depth is " + std::to_string(options.start_depth) + ", not in 0.." +
                    std::to_string(most_start_depth));
    }
    way_down<Traversal>::check(options, function);
    require_callable(on, options.filter, std::uint32_t{}, std::uint32_t{});
}

/// Refuses shapes whose functions are the host's, where the policy cannot call them.
template <class S, class U, class Policy>
void require_functions_of_shapes(const Policy& on) {
    if constexpr (decidable<S, U>) {  // or else a pairing says so
        require_callable(on, functions_of_shapes_have_to_be_marked_ABUT_HD<S, U>{}, static_cast<const S*>(nullptr),
                         static_cast<const U*>(nullptr));
    }
}

/// Whether a filter, or on the host a visitor, can be called as it is. What a device calls, require_callable looks at.
template <class Policy, class F, class Answer, class... Arguments>
consteval bool answers() {
    if constexpr (host_policy<Policy>) {
        return requires(const F& f, Arguments... arguments) {
            { f(arguments...) } -> std::convertible_to<Answer>;
        };
    } else {
        return true;
    }
}
template <class Policy, class Filter>
consteval bool is_filter() {
    constexpr bool is = answers<Policy, Filter, bool, std::uint32_t, std::uint32_t>();
    static_assert(is, "abut: a filter is called as filter(id in a, id in b) const, two std::uint32_t, and returns bool");
    return is;
}

/// Whether pair_up takes both arguments.
template <class Policy, class X, class Y>
consteval bool can_both_be_asked() {
    if constexpr (!can_be_asked<Policy, X>()) {
        return false;
    } else if constexpr (!can_be_asked<Policy, Y>()) {
        return false;
    } else {
        return have_one_scalar<X, Y>();
    }
}

/// Whether it takes them and the filter, and what touches can be decided.
template <class Policy, class X, class Y, class Filter>
consteval bool can_pair() {
    if constexpr (can_both_be_asked<Policy, X, Y>()) {
        constexpr bool is = decidable<typename shape_of_argument<X>::type, typename shape_of_argument<Y>::type>;
        static_assert(is, "abut: queries between sets of these two shapes are not supported");
        return is && is_filter<Policy, Filter>();
    } else {
        return false;
    }
}

/// Two operands, ready to be paired.
template <class Policy, operand A, operand B, class Filter, traversal Traversal, schedule Schedule,
          class Nearness = near_enough_to_touch>
auto pair_operands(const Policy& on, A a, B b, const query_options<Filter, Traversal, Schedule>& options,
                   const Nearness& near = {}) {
    using shape_a = typename decltype(a.shapes())::shape_type;
    using shape_b = typename decltype(b.shapes())::shape_type;
    const pair_key key{id_bits(a.shapes().size()), id_bits(b.shapes().size())};
    require_functions_of_shapes<shape_a, shape_b>(on);
    return pairing<A, B, Filter, Traversal, Schedule, Nearness>{std::move(a), std::move(b), key, options, near};
}

/// Both arguments of a query, ready to be paired; errors are thrown in the name of `function`.
template <input Input = input::checked, class Policy, class X, class Y, class Filter, traversal Traversal, schedule Schedule,
          class Nearness = near_enough_to_touch>
auto pair_up(const Policy& on, const X& x, const Y& y, const query_options<Filter, Traversal, Schedule>& options,
             const char* function, const Nearness& near = {}) {
    check_options(on, options, function);
    auto a = make_operand<Input>(on, x, function);
    auto b = make_operand<Input>(on, y, function);
    return pair_operands(on, std::move(a), std::move(b), options, near);
}

}  // namespace abut::detail
