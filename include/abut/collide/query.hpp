// SPDX-License-Identifier: MIT
#pragma once

// any, count, pairs, for_each_pair: which shapes of one set touch which of another; or of each entry of a list, or of each two
// bodies. What is asked, of what and by whom is in question.hpp.

#include <cstdint>

#include <abut/collide/question.hpp>

namespace abut {

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

/// Whether any shape of `a` touches any shape of `b`. Stops soon after the first pair found. Ranks give the same answer on
/// each; one that has found a pair looks for no other.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto any(const On& on, const X& a, const Y& b,
                       const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::whether{}), detail::two{a, b}, options, "abut::any");
}

/// The same of a list of posed pairs (@ref lists ): whether the shapes of any entry touch; or of bodies (@ref many_bodies ):
/// whether any shape of a body touches any of another.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto any(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::whether{}), detail::whole(scene), options, "abut::any");
}

/// Number of pairs that touch and that the filter wants. Stores none of them. Of ranks the number of all, the same on each.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto count(const On& on, const X& a, const Y& b,
                                  const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::how_many{}), detail::two{a, b}, options,
                     "abut::count");
}

/// The same of all entries of a list, or of all pairs of two bodies.
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto count(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::how_many{}), detail::whole(scene), options,
                     "abut::count");
}

/// All pairs that touch, each once: a `result` of `index_pair`, 8 bytes each, in the policy's memory; sorted by a, then b,
/// unless the options say otherwise. Empty where none touch. Of several devices it lies in memory of the first. Of ranks it
/// is of `global_pair`, 16 bytes each, of the pairs of the rank's own a-shapes: the lists of all ranks, one after another,
/// are the list of one machine.
template <arithmetic A = filtered, executor On, class X, class Y, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
[[nodiscard]] auto pairs(const On& on, const X& a, const Y& b,
                         const query_options<Filter, Traversal, Schedule>& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_pairs{}), detail::two{a, b}, options,
                     "abut::pairs");
}

/// The same of a list, a `result` of `tagged_pair`, which has the entry's position, 12 bytes each (of ranks
/// `global_tagged_pair`, 16); or of bodies, of `body_pair`, 16 bytes each.
///
///     std::vector<abut::posed_pair<decltype(gear)>> list{{posed(gear, here), posed(gear, there)}};
///     for (const auto& hit : to_host(abut::pairs(on, list))) use(hit.pair, hit.a, hit.b);
///     std::vector<abut::posed_object<decltype(gear)>> bodies{posed(gear, here), posed(gear, there)};
///     for (const auto& hit : to_host(abut::pairs(on, bodies))) use(hit.body_a, hit.a, hit.body_b, hit.b);
template <arithmetic A = filtered, executor On, detail::scene Scene, detail::options_of<Scene> Options = detail::default_options<Scene>>
[[nodiscard]] auto pairs(const On& on, const Scene& scene, const Options& options = {}) {
    return ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::all_pairs{}), detail::whole(scene), options,
                     "abut::pairs");
}

/// Calls visitor(index_pair) -> visit once for every pair that touches, as soon as it is known, in no order, concurrently,
/// in the policy's space. `visit::stop` is best effort: pairs in flight still come. Stores no pairs, so memory does not grow
/// with their number. Under cuda the visitor is a trivially copyable functor with an ABUT_HD operator(), or with nvcc's
/// `--extended-lambda` a lambda that is marked so and captures by value (see query_options).
///
/// Several devices are given visitor_of(k), which is called on the host, once for each device, and returns the visitor of
/// that device; `visit::stop` ends the visits of that device. A visitor of ranks is called with a `global_pair` of the rank's
/// own a-shapes, and stops that rank.
///
///     abut::for_each_pair(on, mesh, ball, [=] ABUT_HD(abut::index_pair pair) {
///         touched[pair.b] = 1;  // on a device, device memory
///         return abut::visit::proceed;
///     });
template <arithmetic A = filtered, executor On, class X, class Y, class Visitor, class Filter = keep_all,
          traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
    requires(!detail::scene<X>)
void for_each_pair(const On& on, const X& a, const Y& b, const Visitor& visitor,
                   const query_options<Filter, Traversal, Schedule>& options = {}) {
    ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::visited_by(visitor)), detail::two{a, b}, options,
              "abut::for_each_pair");
}

/// The same of a list, with a tagged_pair (of ranks a global_tagged_pair), or of bodies, with a body_pair.
template <arithmetic A = filtered, executor On, detail::scene Scene, class Visitor,
          detail::options_of<Scene> Options = detail::default_options<Scene>>
void for_each_pair(const On& on, const Scene& scene, const Visitor& visitor, const Options& options = {}) {
    ask_pairs(on, detail::ask_for<A>(detail::touching{}, detail::visited_by(visitor)), detail::whole(scene), options,
              "abut::for_each_pair");
}

///@}

}  // namespace abut
