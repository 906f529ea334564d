// SPDX-License-Identifier: MIT
#pragma once

// What is asked of scenes of several kinds of bodies (mixed_bodies.hpp). Each question is asked of each kind alone and of
// each two by what bodies and `between` have (body_pairs.hpp, body_rows.hpp, body_distance.hpp), and what they say becomes
// one answer. Nothing is walked or decided here.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/body_distance.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/collide/body_rows.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/mixed_bodies.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/execution/atomic.hpp>

namespace abut::detail {

// --- pairs

template <class Bodies>
struct wants_bodies_of_parts {
    Bodies wanted;
    bodies_of_parts names;
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return wanted(names.first_a + a, names.first_b + b); }
};
/// A filter of two parts. It is made in one go: a lambda that captures, or is const, cannot be assigned.
template <class To, class Filter>
To made_for_part([[maybe_unused]] const Filter& filter, [[maybe_unused]] const bodies_of_parts& names) {
    if constexpr (std::same_as<To, keep_all>) {
        return {};
    } else {
        return {filter, names};
    }
}
/// The same options, whose filters are told of bodies of two parts. All members are named here, so that none is lost.
template <class Filter, schedule Schedule, class Bodies>
auto options_of_part(const body_options<Filter, Schedule, Bodies>& options, const bodies_of_parts& names) {
    constexpr bool all_shapes = std::same_as<Filter, keep_all>, all_bodies = std::same_as<Bodies, keep_all>;
    using filter = std::conditional_t<all_shapes, keep_all, call_of_part<Filter, bodies_of_parts>>;
    using wanted = std::conditional_t<all_bodies, keep_all, wants_bodies_of_parts<Bodies>>;
    const auto& [sorted, of_shapes, most_pairs, discard_sideways, scheduling, of_bodies] = options;
    return body_options<filter, Schedule, wanted>{
        sorted, made_for_part<filter>(of_shapes, names), most_pairs, discard_sideways, scheduling, made_for_part<wanted>(of_bodies, names)};
}

/// A visitor of parts, one after another: when it has stopped, no other part is looked at.
template <class Visitor>
struct visit_until_stopped {
    Visitor visitor;
    bodies_of_parts names;
    std::uint32_t* stopped;
    ABUT_CALLS_ANY
    ABUT_HD visit operator()(const body_pair& pair) const {
        if (visitor(names.named(pair)) != visit::stop) return visit::proceed;
        execution::atomic_or(stopped, 1);
        return visit::stop;
    }
};

/// Of executors other than a policy.
template <class On>
consteval bool refuse_mixed() {
    static_assert(
        sizeof(On) == 0,
        "abut: bodies of several kinds are asked by one policy; ask several devices or ranks about each two kinds");
    return false;
}

/// Mixed bodies as a form of arguments (question.hpp), which has one pairing for each two of its parts.
template <class... Indices>
struct form_of_mixed {
    using scalar_type = typename mixed_bodies<Indices...>::scalar_type;
    using pair_type = body_pair;
    template <scalar T>
    using contact_type = body_contact<T>;
    template <scalar T>
    using crossing_type = body_crossing<T>;
    using order = typename form_of_bodies<bodies<typename mixed_bodies<Indices...>::index_type>>::order;
    const mixed_bodies<Indices...>& all;

    template <class Policy, class, class>
    static consteval bool can_be_asked() {
        return refuse_mixed<Policy>();  // a policy does not ask that
    }
};
template <class... Indices>
struct form_of_scene<mixed_bodies<Indices...>> {
    using type = form_of_mixed<Indices...>;
    using options = body_options<>;
    template <class Options>
    static constexpr bool takes = are_body_options<Options>;
};

template <execution_policy Policy, class Question, class... Indices, class Options>
auto ask_pairs(const Policy& on, const Question& question, const form_of_mixed<Indices...>& form, const Options& options,
               const char* function) {
    using answer = typename Question::answer_type;
    using T = typename form_of_mixed<Indices...>::scalar_type;
    question.relation.check(function);
    require_same_device(on, form.all, function);
    const auto ask = [&](const auto& two, const auto& asked) {
        return ask_pairs(on, asked, whole(two.scene()), options_of_part(options, two.names), function);
    };
    if constexpr (Question::kind == answer_kind::list) {
        using found = typename answer::template found_type<form_of_mixed<Indices...>, T>;
        found_lists<Policy, found> lists;
        for_each_two_parts(form.all, [&](const auto& two) {
            auto some = ask(two, question);
            lists.push_back(two.names.first_b == 0 ? std::move(some) : found_of_part(on, some, two.names));
            return false;
        });
        return joined(on, std::move(lists), options.sorted, typename form_of_mixed<Indices...>::order{});
    } else if constexpr (Question::kind == answer_kind::visits) {
        using visitor = std::remove_cvref_t<decltype(question.answer.visitor)>;
        if constexpr (is_visitor<Policy, visitor, body_pair>()) {
            execution::buffer_of<Policy, std::uint32_t> stopped(on, 1);
            fill(on, stopped.data(), 1, std::uint32_t{0});
            for_each_two_parts(form.all, [&](const auto& two) {
                const visit_until_stopped<visitor> each{question.answer.visitor, two.names, stopped.data()};
                ask(two, ask_for<typename Question::arithmetic_type>(question.relation, visited_by(each)));
                std::uint32_t is_over = 0;
                download(on, stopped.data(), 1, &is_over);
                return is_over != 0;
            });
        }
    } else {
        auto total = answer::template nothing<form_of_mixed<Indices...>, Policy>();
        constexpr bool is_flag = std::same_as<decltype(total), bool>;
        for_each_two_parts(form.all, [&](const auto& two) {
            total = static_cast<decltype(total)>(total + ask(two, question));
            return is_flag && total != 0;
        });
        return total;
    }
}

// --- rows

/// f(asked_bodies, bodies_from) of each part.
template <class Policy, class Question, class... Indices, class F>
void for_each_asked(const Policy& on, const Question& question, const mixed_bodies<Indices...>& all, const F& f) {
    [&]<std::size_t... K>(std::index_sequence<K...>) {
        (f(make_asked(on, all.template part<K>(), question), bodies_from{all.first(K)}), ...);
    }
    (std::index_sequence_for<Indices...>());
}
/// f(rows, largest) if the policy takes them, with the largest number of all parts.
template <class Policy, class Question, class... Indices, class Rows, class F>
auto with_rows(const Policy& on, const Question& question, const mixed_bodies<Indices...>& all, const Rows& rows,
               const F& f) {
    using T = typename mixed_bodies<Indices...>::scalar_type;
    if constexpr ((Question::template takes<Policy, bodies<Indices>, Rows, true>() && ...)) {
        const auto from = question.template make_rows<T>(on, rows, question.function);
        double largest = 0;
        for_each_asked(on, question, all, [&](const auto& x, const bodies_from&) {
            question.check(on, x, from, nullptr);
            largest = greatest(largest, question.largest(on, x, from));
        });
        return f(from, largest);
    } else {
        return no_answer<Question, body_and_id, space_of<Policy>>();
    }
}

template <execution_policy Policy, class Question, class... Indices, class Rows>
auto ask_rows(const Policy& on, const Question& question, const mixed_bodies<Indices...>& all, const Rows& rows) {
    using T = typename mixed_bodies<Indices...>::scalar_type;
    using found = typename Question::template found<T, body_and_id>;
    return with_rows(on, question, all, rows, [&](const auto& from, double largest) {
        const auto asked = question.template in_parts<T>(largest);
        using asked_type = std::remove_const_t<decltype(asked)>;
        const std::size_t n = from.shapes().size();
        execution::buffer_of<Policy, typename asked_type::answer> best(on, n * asked.per_row()), other(on, best.size());
        for_each_asked(on, question, all, [&](const auto& x, const bodies_from& names) {
            asked.ask(on, x, from, names, names.first == 0 ? best.data() : other.data());
            if (names.first != 0) for_each_index(on, n, merge_answers<asked_type>{asked, other.data(), best.data()});
        });
        return result<found, space_of<Policy>>(named_answers<found>(on, asked, std::move(best)));
    });
}
template <execution_policy Policy, class Question, class... Indices, class Rows>
auto ask_row_lists(const Policy& on, const Question& question, const mixed_bodies<Indices...>& all, const Rows& rows) {
    using hit = typename Question::template found<typename mixed_bodies<Indices...>::scalar_type, body_and_id>;
    return with_rows(on, question, all, rows, [&](const auto& from, double) {
        found_lists<Policy, timed_hit> lists;
        for_each_asked(on, question, all, [&](const auto& x, const bodies_from& names) {
            lists.emplace_back(question.ask(on, x, from, name_timed_hit{same_number{}, names}));
        });
        const auto hits = joined(on, std::move(lists), true, by_line_and_time{});
        execution::buffer_of<Policy, hit> out(on, hits.size());
        for_each_index(on, hits.size(), write_timed_hits<hit>{hits.data(), {}, out.data()});
        synchronize(on);
        return result<hit, space_of<Policy>>(std::move(out));
    });
}

// --- distance

/// The nearest two bodies: of_one(part, best) and of_two(part, part, best) look within a part and between two.
template <class Policy, class... Indices, class OfOne, class OfTwo>
auto nearest_of_mixed(const mixed_bodies<Indices...>& all, const OfOne& of_one, const OfTwo& of_two) {
    bodies_apart<typename mixed_bodies<Indices...>::scalar_type> best;
    for_each_two_parts(all, [&]<bool One, class A, class B>(const two_parts<One, A, B>& two) {
        if constexpr (can_be_measured<Policy, A, B>()) {
            auto one = best;
            if constexpr (One) {
                one = of_one(two.a, best);
            } else {
                one = of_two(parts_of_bodies::of(two.a), parts_of_bodies::of(two.b), best);
            }
            if (one.found) one.found = two.names.named(*one.found);
            if (one.comes_before(best)) best = one;
        }
        return false;
    });
    return best;
}
/// As body_distance.hpp says of one kind.
template <class Policy, class... Indices>
auto touching_bodies(const Policy& on, const mixed_bodies<Indices...>& all, const char* function, const whole_search& part) {
    return nearest_of_mixed<Policy>(
        all, [&](const auto& one, const auto&) { return touching_bodies(on, one, function, part); },
        [&](const auto& a, const auto& b, const auto&) {
            return first_touching(on, pair_up_near(on, a, b, function, near_enough_to_touch{}));
        });
}
/// Within parts first: bodies of one are then no nearer to each other than the bound, so that few of another are near to
/// each.
template <class Policy, class... Indices>
auto nearest_bodies(const Policy& on, const mixed_bodies<Indices...>& all, double below, const char* function,
                    const whole_search& part) {
    using T = typename mixed_bodies<Indices...>::scalar_type;
    return nearest_of_mixed<Policy>(
        all,
        [&](const auto& one, const auto& best) {
            return nearest_bodies(on, one, least(below, best.measure), function, part);
        },
        [&](const auto& a, const auto& b, const auto& best) {
            return nearest_within<T>(on, bound_below<T>(least(below, best.measure)), nullptr,
                                     [&](const auto& near) { return pair_up_near(on, a, b, function, near); });
        });
}
template <execution_policy Policy, class... Indices>
auto ask_least(const Policy& on, const ask_distance& question, const mixed_bodies<Indices...>& all, each_other) {
    check(question.options, question.function);
    require_same_device(on, all, question.function);
    return least_of_bodies<typename mixed_bodies<Indices...>::scalar_type>(
        question, all.size(), [&](const auto& look) { return look(on, all, whole_search{}); });
}

// --- several devices, which have no bodies of several kinds

template <execution::policy_team Team, class... Indices>
void ask_pairs(const Team&, const auto&, const form_of_mixed<Indices...>&, const auto&, const char*) {
    refuse_mixed<Team>();
}
template <execution::policy_team Team, class... Indices>
void ask_rows(const Team&, const auto&, const mixed_bodies<Indices...>&, const auto&) {
    refuse_mixed<Team>();
}
template <execution::policy_team Team, class... Indices>
void ask_row_lists(const Team&, const auto&, const mixed_bodies<Indices...>&, const auto&) {
    refuse_mixed<Team>();
}
template <execution::policy_team Team, class... Indices>
void ask_least(const Team&, const ask_distance&, const mixed_bodies<Indices...>&, each_other) {
    refuse_mixed<Team>();
}

}  // namespace abut::detail
