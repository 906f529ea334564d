// SPDX-License-Identifier: MIT
#pragma once

// How much certainty a caller pays for, as a type: `fast`, `filtered` or `exact`. And the three-valued answers that all
// predicates are written in.

#include <concepts>
#include <type_traits>

#include <abut/config.hpp>

namespace abut {

/// @defgroup arithmetics How certain an answer is
///
/// The first template argument of queries and predicates. docs/numerics.md says what each promises and what it costs.
///@{

/// Plain floating point in the input's own type: measured, not promised. Wrong near contact and at extreme scales.
struct fast {};
/// The default. Floating point with a forward error bound, exact integers where the bound cannot decide: never wrong.
struct filtered {};
/// Exact integers at once: the same answers as `filtered`, without its filter. It checks the filter and shows its price.
struct exact {};

/// How a query or a predicate decides: `fast`, `filtered` or `exact`.
template <class A>
concept arithmetic = std::same_as<A, fast> || std::same_as<A, filtered> || std::same_as<A, exact>;

/// Scalars that geometry is given in. Mixing them does not compile.
template <class T>
concept scalar = std::same_as<T, float> || std::same_as<T, double>;

/// What a stage of a predicate knows. `unknown` sends the pair on to the next stage; the last stage never says it.
enum class verdict : unsigned char {
    no,      ///< the shapes do not touch
    yes,     ///< they do
    unknown  ///< this stage cannot tell
};

/// yes for true, no for false.
ABUT_HD constexpr verdict to_verdict(bool answer) { return answer ? verdict::yes : verdict::no; }

/// Kleene's disjunction: yes if either side is, no if both are.
ABUT_HD constexpr verdict operator||(verdict a, verdict b) {
    if (a == verdict::yes || b == verdict::yes) return verdict::yes;
    return a == verdict::no && b == verdict::no ? verdict::no : verdict::unknown;
}

/// Kleene's conjunction: no if either side is, yes if both are.
ABUT_HD constexpr verdict operator&&(verdict a, verdict b) {
    if (a == verdict::no || b == verdict::no) return verdict::no;
    return a == verdict::yes && b == verdict::yes ? verdict::yes : verdict::unknown;
}

///@}

}  // namespace abut
