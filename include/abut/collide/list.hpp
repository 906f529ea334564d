// SPDX-License-Identifier: MIT
#pragma once

// Queries of a list: many pairs of posed indices in one call, for scenes of many bodies, of which each pair alone is too
// little work for a device. Each query says of each entry what it would say of its two indices alone. The fronts are those of
// two arguments (query.hpp, contacts.hpp, within.hpp); how pairs are found is in list_pairing.hpp.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/list_pairing.hpp>
#include <abut/collide/placed.hpp>
#include <abut/collide/question.hpp>
#include <abut/shape/crossing.hpp>

namespace abut {

/// @defgroup lists Queries of a list of posed pairs
///
/// `any`, `count`, `pairs`, `for_each_pair` and `contacts` of many pairs of posed indices in one call. Each says of an entry
/// what it would say of the entry's two indices alone. So do `within`, `count_within`, `any_within` and `for_each_within`
/// with a distance, and `distance`. For many bodies, of which each pair alone is too little work for a device, where the
/// caller knows which may meet. Where not, see @ref many_bodies.
///
/// @par Memory
/// Indices lie in the policy's memory, and the list itself in host memory. A `result` lies in the policy's memory, sorted by
/// entry, then a, then b, unless the options say otherwise. The call copies the poses to the policy's memory, and takes
/// there some 200 bytes an entry in float.
///
/// @par Errors
/// - `invalid_geometry`, whose message names the entry: a pose is no rotation, or placed coordinates overflow.
/// - `error`: an index lies on another device; a distance is negative, infinite or NaN.
/// - `capacity_error`: the bits of a position and of two ids are more than 64 (split the list then), or an index has more
///   than 2^30 shapes (2^29 in wide_layout).
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Each call returns when its answer is complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp lists
///@{

/// Two indices over sets (make_bvh), each under a pose: posed(index, pose). Any number of entries may share an index.
template <class IndexA, class IndexB = IndexA>
struct posed_pair {
    static_assert(!std::is_const_v<IndexA> && !std::is_const_v<IndexB>,
                  "abut: posed_pair of the type of a const index: leave out const where the index is made, or write "
                  "posed_pair<std::remove_const_t<decltype(index)>>");
    posed_object<std::remove_const_t<IndexA>> a;  ///< the first one
    posed_object<std::remove_const_t<IndexB>> b;  ///< the second one
};

/// Two shapes that touch: `pair` is the position in the list, `a` and `b` are ids in its sets.
struct tagged_pair {
    std::uint32_t pair;  ///< position in the list
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one

    friend constexpr bool operator==(const tagged_pair&, const tagged_pair&) = default;
    friend constexpr auto operator<=>(const tagged_pair&, const tagged_pair&) = default;
};

/// A contact of an entry: `pair` is the position in the list, the rest is as in contact<T>.
template <scalar T>
struct tagged_contact {
    std::uint32_t pair;  ///< position in the list
    std::uint32_t a;     ///< id in the entry's first set
    std::uint32_t b;     ///< id in its second one
    vec3<T> point;       ///< of both shapes, in the world
    vec3<T> normal;      ///< of length 1, from b to a
    T depth;             ///< 0 or more, in units of length

    friend constexpr bool operator==(const tagged_contact&, const tagged_contact&) = default;
};

/// Options of queries of a list; with a filter write `list_options{.filter = f}` (see query_options). The schedule is
/// that of query_options.
template <class Filter = keep_all, schedule Schedule = schedule::shared_list>
struct list_options {
    /// Results sorted by pair, then a, then b. Without it the order is any, and may differ from call to call.
    flag sorted = true;
    /// filter(tagged_pair) -> bool: pairs for which it is false are neither tested nor reported. As in query_options.
    Filter filter = {};
    /// As in query_options.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// Of contacts alone; as in contact_options.
    flag discard_sideways = false;
    /// As in query_options.
    schedule_options scheduling = {};
};

namespace detail {

/// How shapes of an entry are named where a list is the caller's.
struct names_of_entries {
    ABUT_HD static tagged_pair pair(std::uint32_t entry, const index_pair&, std::uint32_t a, std::uint32_t b) {
        return {entry, a, b};
    }
    template <scalar T>
    ABUT_HD static tagged_contact<T> tagged(const tagged_pair& of, const contact<T>& c) {
        return {of.pair, of.a, of.b, c.point, c.normal, c.depth};
    }
    template <scalar T>
    ABUT_HD static tagged_crossing<T> tagged(const tagged_pair& of, const crossing<T>& c) {
        return {of.pair, of.a, of.b, c};
    }
};

/// Entry i is of the i-th body of each side.
struct bodies_side_by_side {
    ABUT_HD index_pair operator()(std::size_t i) const {
        const auto body = static_cast<std::uint32_t>(i);
        return {body, body};
    }
};

/// Positions of entries in the caller's list: as they are.
struct own_positions {
    std::size_t operator()(std::size_t i) const { return i; }
};

// Entries of a longer list, as one of several devices or ranks has some. `Positions` says where entry i is in the whole
// list, and position.named(found) what was found is there.

/// A filter or a visitor, which is told of entries by what they are in the whole list.
template <class Call, class Positions>
struct call_of_part {
    Call call;
    Positions position;
    ABUT_CALLS_ANY
    template <class Found>
    ABUT_HD auto operator()(const Found& of) const {
        return call(position.named(of));
    }
};
template <class Found, class Named, class Positions>
struct name_entries {
    const Found* found;
    Positions position;
    Named* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = position.named(found[i]); }
};
/// What was found of some entries, with what these are in the whole list. Waits for it.
template <class Policy, class Found, class Positions>
auto found_of_part(const Policy& on, const result<Found, space_of<Policy>>& some, const Positions& position) {
    using named = decltype(position.named(Found{}));
    execution::buffer_of<Policy, named> all(on, some.size());
    for_each_index(on, some.size(), name_entries<Found, named, Positions>{some.data(), position, all.data()});
    synchronize(on);
    return result<named, space_of<Policy>>(std::move(all));
}
/// The same options with another filter. All members are named here, so that none is lost.
template <class Filter, schedule Schedule, class Other>
list_options<Other, Schedule> with_filter(const list_options<Filter, Schedule>& options, const Other& filter) {
    const auto& [sorted, old, most_pairs, discard_sideways, scheduling] = options;
    return {sorted, filter, most_pairs, discard_sideways, scheduling};
}
template <class Filter, schedule Schedule, class Positions>
auto options_of_part(const list_options<Filter, Schedule>& options, const Positions& position) {
    if constexpr (std::same_as<Filter, keep_all>) {
        return options;
    } else {
        return with_filter(options, call_of_part<Filter, Positions>{options.filter, position});
    }
}

/// A list, ready to be asked; errors are thrown in the name of `function`, and have the positions of entries.
template <class Policy, class IndexA, class IndexB, class Filter, schedule Schedule, class Positions = own_positions,
          class Nearness = near_enough_to_touch>
auto pair_up(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
             const list_options<Filter, Schedule>& options, const char* function, const Positions& position = {},
             const Nearness& near = {}) {
    require_callable(on, options.filter, tagged_pair{});
    const auto name = [&](std::size_t i) { return "entry " + std::to_string(position(i)) + " of the list"; };
    const auto side = [&]<class Index>(posed_object<Index> posed_pair<IndexA, IndexB>::*which) {
        const auto body = [&](std::size_t i) -> const posed_object<Index>& { return list[i].*which; };
        return place_bodies(on, gathered_bodies<Index>(list.size(), body), function, name);
    };
    return pair_up_entries<names_of_entries>(on, side(&posed_pair<IndexA, IndexB>::a), side(&posed_pair<IndexA, IndexB>::b),
                                             list.size(), bodies_side_by_side{}, options, function, "entries", near);
}

/// A list as a form of arguments (question.hpp).
template <class IndexA, class IndexB>
struct form_of_list {
    using index_a = IndexA;
    using index_b = IndexB;
    using scalar_type = typename IndexA::scalar_type;
    using pair_type = tagged_pair;
    template <scalar T>
    using contact_type = tagged_contact<T>;
    template <scalar T>
    using crossing_type = tagged_crossing<T>;
    struct order {
        template <class Found>
        ABUT_HD bool operator()(const Found& x, const Found& y) const {
            return x.pair != y.pair ? x.pair < y.pair : by_ids{}(x, y);
        }
    };
    const std::vector<posed_pair<IndexA, IndexB>>& list;

    template <class Policy, class Question, class>
    static consteval bool can_be_asked() {
        if constexpr (can_be_listed<Policy, IndexA, IndexB>()) {
            return Question::template takes<shape_in_world<IndexA>, shape_in_world<IndexB>>();
        } else {
            return false;
        }
    }
    template <class Policy, class Relation, class Options, class Positions = own_positions>
    auto pair_up(const Policy& on, const Relation& how, const Options& options, bool, const char* function,
                 const Positions& position = {}) const {
        return detail::pair_up(on, list, options, function, position,
                               how.template nearness<typename IndexA::scalar_type>());
    }
};
template <class Options>
inline constexpr bool are_list_options = false;
template <class Filter, schedule Schedule>
inline constexpr bool are_list_options<list_options<Filter, Schedule>> = true;
template <class IndexA, class IndexB>
struct form_of_scene<std::vector<posed_pair<IndexA, IndexB>>> {
    using type = form_of_list<IndexA, IndexB>;
    using options = list_options<>;
    template <class Options>
    static constexpr bool takes = are_list_options<Options>;
};

}  // namespace detail

///@}

}  // namespace abut
