// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair: which shapes of one set touch which of another.

#include <cstdint>

#include <abut/collide/pair_up.hpp>
#include <abut/collide/search.hpp>

namespace abut {

namespace detail {

/// Finds out whether two shapes touch, and knows their ids.
template <arithmetic A>
struct touch_and_name : touch<A> {
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

// The queries, of any pairing: two arguments (below) or a list of them (list.hpp). Whether shapes touch is what is decided,
// unless another judge is given.

template <arithmetic A, class Policy, class Pairing, class Judge = touch<A>>
bool any_of(const Policy& on, const Pairing& pairing, const Judge& judge = {}) {
    execution::work_flag<space_of<Policy>> found(on);
    search(on, pairing, judge, found);
    return found.raised();
}

template <arithmetic A, class Policy, class Pairing, class Judge = touch<A>>
std::uint64_t count_of(const Policy& on, const Pairing& pairing, const Judge& judge = {}) {
    execution::work_count<space_of<Policy>> hits(on);
    search(on, pairing, judge, hits);
    return hits.total();
}

template <arithmetic A, class Policy, class Pairing, class Judge = touch_and_name<A>>
auto pairs_of(const Policy& on, const Pairing& pairing, const Judge& judge = {}) {
    return answers_to(on, pairing, judge, find_keys(on, pairing, judge));
}

template <arithmetic A, class Policy, class Pairing, class Visitor, class Judge = touch<A>>
void visit_pairs_of(const Policy& on, const Pairing& pairing, const Visitor& visitor, const Judge& judge = {}) {
    using view = typename Pairing::view_type;
    require_callable(on, visitor, decltype(pairing.view().ids(0)){});
    const visit_pair<view, Visitor> visits{pairing.view(), visitor};
    execution::work_visit<visit_pair<view, Visitor>, space_of<Policy>> hits(on, visits);
    search(on, pairing, judge, hits);
}

}  // namespace detail

/// @defgroup queries Which shapes of two sets touch
///
/// `any`, `count`, `pairs` and `for_each_pair` of two arguments. Each is a set, a view, one shape, or an index over a set
/// (`make_bvh`, `make_grid`), posed or not. Where neither is an index, all shapes are compared with all, in tiles. Touching
/// counts. `filtered`, the default, and `exact` decide it exactly, for every finite input; `fast` is approximate. Ids are
/// positions in the sets. Answers do not depend on the policy, the number of threads or the index.
///
/// @par Memory
/// A set or a view lies in the policy's memory, an index as well. A set in host memory is copied to the device for the call
/// under `cuda`; a view is not, and does not compile. A `result` lies in the policy's memory, sorted by a, then b, unless
/// the options say otherwise; `to_host` copies it. `any`, `count` and `for_each_pair` store no pairs.
///
/// @par Errors
/// - `invalid_geometry`: a view or a single shape holds a number that is none, which is looked at in each call; a pose is no
///   rotation; or placed coordinates overflow.
/// - `error`: a set, a view or an index lies on another device; a `start_depth` is out of range; or `from_front` has none.
/// - `capacity_error`: a view has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`, and on a host what a filter or a visitor throws.
///
/// Two kinds of shapes that cannot be decided, and scalars that differ, do not compile.
///
/// @par Synchronisation
/// Each call returns when its answer is complete. Under `cuda` it waits for the policy's stream, and for no other. Any
/// number of threads of the host may query the same sets and indices at a time.
///
/// @par Example
/// @snippet queries.cpp queries
///@{

/// Whether any shape of `a` touches any shape of `b`. Stops soon after the first pair found.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] bool any(const Policy& on, const X& a, const Y& b,
                       const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair<Policy, X, Y, Filter>()) {
        return detail::any_of<A>(on, detail::pair_up(on, a, b, options, "abut::any"));
    } else {
        return false;
    }
}

/// Number of pairs that touch and that the filter wants. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] std::uint64_t count(const Policy& on, const X& a, const Y& b,
                                  const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair<Policy, X, Y, Filter>()) {
        return detail::count_of<A>(on, detail::pair_up(on, a, b, options, "abut::count"));
    } else {
        return 0;
    }
}

/// All pairs that touch, each once: a `result` of `index_pair`, 8 bytes each, in the policy's memory; sorted by a, then b,
/// unless the options say otherwise. Empty where none touch.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
[[nodiscard]] auto pairs(const Policy& on, const X& a, const Y& b,
                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair<Policy, X, Y, Filter>()) {
        return detail::pairs_of<A>(on, detail::pair_up(on, a, b, options, "abut::pairs"));
    } else {
        return result<index_pair, space_of<Policy>>();
    }
}

/// Calls visitor(index_pair) -> visit once for every pair that touches, as soon as it is known, in no order, concurrently,
/// in the policy's space. `visit::stop` is best effort: pairs in flight still come. Stores no pairs, so memory does not grow
/// with their number. Under cuda the visitor is a trivially copyable functor with an ABUT_HD operator(), or with nvcc's
/// `--extended-lambda` a lambda that is marked so and captures by value (see query_options).
///
///     abut::for_each_pair(on, mesh, ball, [=] ABUT_HD(abut::index_pair pair) {
///         touched[pair.b] = 1;  // on a device, device memory
///         return abut::visit::proceed;
///     });
template <arithmetic A = filtered, execution_policy Policy, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
void for_each_pair(const Policy& on, const X& a, const Y& b, const Visitor& visitor,
                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    if constexpr (detail::can_pair<Policy, X, Y, Filter>() && detail::is_visitor<Policy, Visitor, index_pair>()) {
        detail::visit_pairs_of<A>(on, detail::pair_up(on, a, b, options, "abut::for_each_pair"), visitor);
    }
}

///@}

}  // namespace abut
