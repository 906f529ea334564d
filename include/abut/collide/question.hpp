// SPDX-License-Identifier: MIT
#pragma once

// A question about pairs of shapes is a value: a relation that two shapes have or have not, and an answer, which says what of
// the pairs that have it the caller wants. It is asked of arguments of a form: two sets, one set among itself, a list of posed
// pairs, bodies. Each form makes one pairing of its arguments, which finds the pairs that come near each other (pairing.hpp,
// self_pairing.hpp, list_pairing.hpp). An executor (executor.hpp) asks: a policy here, at once; others in devices/ and
// distributed/. So a relation, an answer, a form and an executor are one file each, and all combine.
//
// A relation derives from `relation` and has
//   judge<A>()                a pair_judge (judge.hpp) that decides whether two shapes have it
//   decides<S, U>()           consteval: whether it can be asked of these shapes; a static_assert says why not
// and where it differs from the default
//   check(function)           throws where its numbers are none
//   nearness<T>()             how near boxes have to come (nearness.hpp)
//   agreed()                  a number that all ranks have to give alike
//   sight(), sight_of_others()  as what shapes of one set are seen that is asked about alone: its own, and those that another
//                             part of the same set has sent
//
// An answer has
//   find<A>(on, pairing, relation)  what a pairing gives; waits for it
//   takes<S, U>()             consteval: whether there is such an answer of these shapes
//   kind                      how answers of parts become one: `total` (numbers are added up), `list` (joined in the order of
//                             the form), or `visits` (nothing is left to do)
// and a list also found_type<Form, T>, what it holds, and judge<A>(relation), which also knows that of a pair.
//
// A form has
//   pair_type, contact_type<T>, crossing_type<T>, order   how what is found is named, and in which order lists are
//   can_be_asked<Policy, Question, Filter>()   consteval: whether the policy takes the arguments
//   pair_up(on, relation, options, in_order, function)   the pairing

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/executor.hpp>
#include <abut/collide/merge.hpp>
#include <abut/collide/pair_up.hpp>
#include <abut/collide/search.hpp>
#include <abut/collide/self_pairing.hpp>

namespace abut {

template <scalar T>
struct contact;  // narrow/directions.hpp
template <scalar T>
struct crossing;  // shape/crossing.hpp

namespace detail {

// --- relations

/// What most relations have in common: shapes that have it touch.
struct relation {
    void check(const char*) const {}
    template <scalar T>
    [[nodiscard]] near_enough_to_touch nearness() const {
        return {};
    }
    [[nodiscard]] as_they_are sight() const { return {}; }
    [[nodiscard]] as_they_are sight_of_others() const { return {}; }
};

/// Two shapes have a point in common.
struct touching : relation {
    template <arithmetic A>
    [[nodiscard]] touch<A> judge() const {
        return {};
    }
    template <class S, class U>
    static consteval bool decides() {
        constexpr bool both_go = is_swept<S> && is_swept<U>;
        static_assert(!both_go, "abut: shapes of one argument go along ways, and those of the other stay: the difference of two "
                                "ways need be no number");
        constexpr bool is = both_go || decidable<S, U>;
        static_assert(is, "abut: queries between sets of these two shapes are not supported; a shape of your own needs decide<A>(s, t) and "
                          "resolve(s, t) beside it (docs/extending.md)");
        return is && !both_go;
    }
};

// --- answers

/// How answers of parts become one.
enum class answer_kind : unsigned char { total, list, visits };

/// A judge that knows the ids of a pair.
template <class Judge>
struct naming : Judge {
    template <class View>
    ABUT_HD auto answer(const View& both, std::uint64_t key) const {
        return both.ids(key);
    }
};

/// Hands pairs to a user's visitor.
template <class View, class Visitor>
struct visit_pair {
    View both;
    Visitor visitor;
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint64_t key) const { return visitor(both.ids(key)) != visit::stop; }
};

/// Whether for_each_pair takes the visitor.
template <class Policy, class Visitor, class Pair>
consteval bool is_visitor() {
    constexpr bool is = answers<Policy, Visitor, visit, Pair>();
    static_assert(
        is,
        "abut: a visitor is called as visitor(pair) const, and returns abut::visit::proceed or abut::visit::stop; the "
        "pair is an index_pair, or a tagged_pair where the query is of a list");
    return is;
}

/// What answers have that any two shapes can give.
struct of_any_shapes {
    template <class S, class U>
    static consteval bool takes() {
        return true;
    }
};

/// Whether there is any pair.
struct whether : of_any_shapes {
    static constexpr answer_kind kind = answer_kind::total;
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] bool find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        execution::work_flag<space_of<Policy>> found(on);
        search(on, pairing, how.template judge<A>(), found);
        return found.raised();
    }
    template <class, class>
    static bool nothing() {
        return false;
    }
};

/// How many there are.
struct how_many : of_any_shapes {
    static constexpr answer_kind kind = answer_kind::total;
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] std::uint64_t find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        execution::work_count<space_of<Policy>> hits(on);
        search(on, pairing, how.template judge<A>(), hits);
        return hits.total();
    }
    template <class, class>
    static std::uint64_t nothing() {
        return 0;
    }
};

/// All of them, by their ids.
struct all_pairs : of_any_shapes {
    static constexpr answer_kind kind = answer_kind::list;
    template <class Form, scalar>
    using found_type = typename Form::pair_type;
    template <arithmetic A, class Relation>
    [[nodiscard]] auto judge(const Relation& how) const {
        return naming<decltype(how.template judge<A>())>{how.template judge<A>()};
    }
    template <arithmetic A, class Policy, class Pairing, class Relation>
    [[nodiscard]] auto find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        const auto names = judge<A>(how);
        return answers_to(on, pairing, names, find_keys(on, pairing, names));
    }
    template <class Form, class Policy>
    static auto nothing() {
        return result<typename Form::pair_type, space_of<Policy>>();
    }
};

/// Each to a visitor; of several devices, to that which visitor(k) makes for each.
template <class Visitor>
struct visits : of_any_shapes {
    static constexpr answer_kind kind = answer_kind::visits;
    const Visitor& visitor;

    template <arithmetic A, class Policy, class Pairing, class Relation>
    void find(const Policy& on, const Pairing& pairing, const Relation& how) const {
        using view = typename Pairing::view_type;
        require_callable(on, visitor, decltype(pairing.view().ids(0)){});
        const visit_pair<view, Visitor> each{pairing.view(), visitor};
        execution::work_visit<visit_pair<view, Visitor>, space_of<Policy>> hits(on, each);
        search(on, pairing, how.template judge<A>(), hits);
    }
    template <class, class>
    static void nothing() {}
};
template <class Visitor>
visits<Visitor> visited_by(const Visitor& visitor) {
    return {{}, visitor};
}

// --- questions

template <arithmetic A, class Relation, class Answer>
struct question {
    using arithmetic_type = A;
    using answer_type = Answer;
    static constexpr answer_kind kind = Answer::kind;
    Relation relation;
    Answer answer;

    template <class S, class U>
    static consteval bool takes() {
        if constexpr (Relation::template decides<S, U>()) {
            return Answer::template takes<S, U>();
        } else {
            return false;
        }
    }
    template <class Policy, class Pairing>
    auto find(const Policy& on, const Pairing& pairing) const {
        return answer.template find<A>(on, pairing, relation);
    }
};
template <arithmetic A, class Relation, class Answer>
question<A, Relation, Answer> ask_for(const Relation& relation, const Answer& answer) {
    return {relation, answer};
}

// --- forms of arguments

template <class X>
using scalar_of_argument = scalar_type_of<typename shape_of_argument<X>::type>;

/// Two arguments.
template <class X, class Y>
struct two {
    using pair_type = index_pair;
    template <scalar T>
    using contact_type = contact<T>;
    template <scalar T>
    using crossing_type = crossing<T>;
    using order = by_ids;
    const X& a;
    const Y& b;

    template <class Policy, class Question, class Filter>
    static consteval bool can_be_asked() {
        if constexpr (!can_both_be_asked<Policy, X, Y>()) {
            return false;
        } else if constexpr (!Question::template takes<typename shape_of_argument<X>::type,
                                                       typename shape_of_argument<Y>::type>()) {
            return false;
        } else {
            return is_filter<Policy, Filter>();
        }
    }
    template <input Input = input::checked, class Policy, class Relation, class Options>
    auto pair_up(const Policy& on, const Relation& how, const Options& options, bool, const char* function) const {
        return detail::pair_up<Input>(on, a, b, options, function, how.template nearness<scalar_of_argument<X>>());
    }
};
template <class X, class Y>
two(const X&, const Y&) -> two<X, Y>;

/// One, about its own pairs.
template <class X>
struct alone {
    using pair_type = index_pair;
    template <scalar T>
    using crossing_type = crossing<T>;
    using order = by_ids;
    const X& x;

    template <class Policy, class Question, class Filter>
    static consteval bool can_be_asked() {
        if constexpr (!detail::can_be_asked<Policy, X>()) {
            return false;
        } else if constexpr (!Question::template takes<typename shape_of_argument<X>::type,
                                                       typename shape_of_argument<X>::type>()) {
            return false;
        } else {
            return is_filter<Policy, Filter>();
        }
    }
    template <input Input = input::checked, class Policy, class Relation, class Options>
    auto pair_up(const Policy& on, const Relation& how, const Options& options, bool, const char* function) const {
        return pair_up_self<Input>(on, x, options, function, how.sight(), how.template nearness<scalar_of_argument<X>>());
    }
};
template <class X>
alone(const X&) -> alone<X>;

/// In place of a second argument: the query is of the first one alone.
struct itself {};
/// A part of what is asked about alone, an operand, and shapes that come from another part of it.
template <class Policy, operand X, shape_view Others, class Relation, class Options>
auto pair_up_with_others(const Policy& on, const X& x, const Others& others, const Relation& how, const Options& options,
                         const char* function) {
    check_options(on, options, function);
    return pair_operands(on, see(x, how.sight()), see(make_operand(on, others, function), how.sight_of_others()), options,
                         how.template nearness<typename Others::scalar_type>());
}

/// Arguments of which each is a list or a scene by itself: list.hpp and body_pairs.hpp say what its form is (`type`), and what
/// options it takes (`options`, and `takes<Options>`).
template <class X>
struct form_of_scene;
template <class X>
concept scene = requires {
    typename form_of_scene<X>::options;
};
template <class Options, class X>
concept options_of = form_of_scene<X>::template takes<Options>;
template <class X>
using default_options = typename form_of_scene<X>::options;
template <class X>
auto whole(const X& scene) {
    return typename form_of_scene<X>::type{scene};
}

/// The scalar of a form's arguments, which can be asked.
template <class Form>
struct scalar_of_form : std::type_identity<typename Form::scalar_type> {};
template <class X, class Y>
struct scalar_of_form<two<X, Y>> : std::type_identity<scalar_of_argument<X>> {};
template <class X>
struct scalar_of_form<alone<X>> : std::type_identity<scalar_of_argument<X>> {};

// --- one policy, at once

template <execution_policy Policy, class Question, class Form, class Options>
auto ask_pairs(const Policy& on, const Question& question, const Form& form, const Options& options, const char* function) {
    if constexpr (Form::template can_be_asked<Policy, Question, decltype(Options::filter)>()) {
        if constexpr (Question::kind == answer_kind::visits) {
            using visitor = std::remove_cvref_t<decltype(question.answer.visitor)>;
            if constexpr (!is_visitor<Policy, visitor, typename Form::pair_type>()) return;
        }
        question.relation.check(function);
        const bool in_order = Question::kind == answer_kind::list && options.sorted;
        return question.find(on, form.pair_up(on, question.relation, options, in_order, function));
    } else {
        return Question::answer_type::template nothing<Form, Policy>();
    }
}

}  // namespace detail

}  // namespace abut
