// SPDX-License-Identifier: MIT
#pragma once

// Queries of a list: many pairs of posed indices in one call, for scenes of many bodies, of which each pair alone is too
// little work for a device. Each query says of each entry what it would say of its two indices alone. All trees are walked
// together, down from all pairs of roots.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/query.hpp>

namespace abut {

/// @defgroup lists Queries of a list of posed pairs
///
/// `any`, `count`, `pairs`, `for_each_pair` and `contacts` of many pairs of posed indices in one call. Each says of an entry
/// what it would say of the entry's two indices alone. For scenes of many bodies, of which each pair alone is too little
/// work for a device. Entries in which a tree has one shape are searched one after another.
///
/// @par Memory
/// Indices lie in the policy's memory, and the list itself in host memory. A `result` lies in the policy's memory, sorted by
/// entry, then a, then b, unless the options say otherwise. The call takes a few hundred bytes an entry.
///
/// @par Errors
/// - `invalid_geometry`, whose message names the entry: a pose is no rotation, or placed coordinates overflow.
/// - `error`: an index lies on another device.
/// - `capacity_error`: the bits of a position and of two ids are more than 64. Split the list then.
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
    posed_object<IndexA> a;  ///< the first one
    posed_object<IndexB> b;  ///< the second one
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

/// The filter that keeps every pair of every entry.
struct keep_all_tagged {
    /// For every pair.
    keep_all_tagged() = default;
    /// No other filter becomes this one: does not compile.
    template <class F>
    ABUT_HD constexpr keep_all_tagged(const F&) {
        detail::refuse_unnamed_options<F>();
    }
    /// true
    ABUT_HD constexpr bool operator()(tagged_pair) const { return true; }
};

/// Options of queries of a list; with a filter write `list_options{.filter = f}` (see query_options). The schedule is
/// that of query_options; entries of a tree of one shape have none.
template <class Filter = keep_all_tagged, schedule Schedule = schedule::shared_list>
struct list_options {
    /// Results sorted by pair, then a, then b. Without it the order is any, and may differ from call to call.
    bool sorted = true;
    /// filter(tagged_pair) -> bool: pairs for which it is false are neither tested nor reported. As in query_options.
    Filter filter = {};
    /// As in query_options.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// Of contacts alone; as in contact_options.
    bool discard_sideways = false;
    /// As in query_options.
    schedule_options scheduling = {};
};

namespace detail {

/// An entry of the list in the policy's memory.
template <class TreeA, class TreeB, class ShapesA, class ShapesB>
struct list_member {
    using T = typename TreeA::scalar_type;
    TreeA tree_a;
    TreeB tree_b;
    posed_view<ShapesA> a;
    posed_view<ShapesB> b;
    relative_pose<T> b_to_a;
};

template <class Member>
struct relate_frames {
    Member* members;
    const std::uint32_t* walked;
    ABUT_HD void operator()(std::size_t i) const {
        Member& m = members[walked[i]];
        m.b_to_a = make_relative_pose(m.a.pose, m.tree_a.root_bounds(), m.b.pose, m.tree_b.root_bounds());
    }
};

/// A pair's number, below that of its entry.
struct list_key {
    int member_bits;
    pair_key pair;

    [[nodiscard]] int bits() const { return member_bits + pair.bits(); }
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t member, std::uint32_t a, std::uint32_t b) const {
        return (std::uint64_t{member} << pair.a_bits | a) << pair.b_bits | b;
    }
    [[nodiscard]] ABUT_HD tagged_pair unpack(std::uint64_t key) const {
        const auto member = static_cast<std::uint32_t>(key >> (pair.a_bits + pair.b_bits));
        return {member, pair.a(key) & static_cast<std::uint32_t>((std::uint64_t{1} << pair.a_bits) - 1), pair.b(key)};
    }
};

/// What a kernel sees of a list, as pair_view of two operands.
template <class Member, class Filter>
struct list_view {
    using shape_type_a = typename decltype(Member::a)::shape_type;
    using shape_type_b = typename decltype(Member::b)::shape_type;
    const Member* members;
    list_key key;
    Filter filter;

    [[nodiscard]] ABUT_HD shape_type_a shape_a(std::uint64_t k) const {
        const tagged_pair at = key.unpack(k);
        return members[at.pair].a[at.a];
    }
    [[nodiscard]] ABUT_HD shape_type_b shape_b(std::uint64_t k) const {
        const tagged_pair at = key.unpack(k);
        return members[at.pair].b[at.b];
    }
    [[nodiscard]] ABUT_HD tagged_pair ids(std::uint64_t k) const { return key.unpack(k); }
    template <class T>
    [[nodiscard]] ABUT_HD tagged_contact<T> tagged(std::uint64_t k, const contact<T>& c) const {
        const tagged_pair at = key.unpack(k);
        return {at.pair, at.a, at.b, c.point, c.normal, c.depth};
    }
    ABUT_INLINE void prefetch(std::uint64_t k, int step) const {
        const tagged_pair at = key.unpack(k);
        members[at.pair].a.prefetch(at.a, step);
        members[at.pair].b.prefetch(at.b, step);
    }
};

/// The ids of one entry, for the ways to candidates (pairing.hpp).
template <class View>
struct ids_of_member {
    View list;
    std::uint32_t member;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t a, std::uint32_t b) const { return list.key.pack(member, a, b); }
    ABUT_CALLS_ANY
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t a, std::uint32_t b) const {
        return list.filter(tagged_pair{member, a, b});
    }
};

/// Volumes of a member's two frames.
template <scalar T>
struct frames_at {
    const relative_pose<T>* b_to_a;
    template <class Volume>
    ABUT_INLINE ABUT_HD bool operator()(const Volume& a, const Volume& b) const {
        return overlaps_posed(a, *b_to_a, b);
    }
    ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T>& a, const box_lanes<T>& b) const {
        return overlaps(a, *b_to_a, b);
    }
};

template <class Item, class Emitter>
struct add_member_item {
    Emitter& emitter;
    std::uint32_t member;
    ABUT_CALLS_ANY
    template <class Number, class Nodes>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Nodes& next) const {
        emitter.add(k, is, Item{member, next});
    }
};

/// One step down two trees of a member.
template <class Member, class Filter>
struct expand_member {
    using walk = pair_walk<decltype(Member::tree_a), decltype(Member::tree_b), frames_at<typename Member::T>>;
    using ids = ids_of_member<list_view<Member, Filter>>;
    struct item {
        std::uint32_t member;
        typename walk::item nodes;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = walk::most_children, most_depth = walk::most_depth;

    list_view<Member, Filter> list;
    const std::uint32_t* walked;  ///< entries of which both trees have nodes: `n` of them
    std::size_t n;

    [[nodiscard]] ABUT_HD walk walk_of(std::size_t i) const {
        const Member& m = list.members[i];
        return {m.tree_a, m.tree_b, {&m.b_to_a}};
    }
    [[nodiscard]] std::size_t seeds() const { return n; }
    ABUT_INLINE void prefetch(const item& at) const { walk_of(at.member).prefetch(at.nodes); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return {walked[i], walk_of(walked[i]).seed(0)}; }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        const ids of_member{list, at.member};
        walk_of(at.member).expand(at.nodes, add_member_item<item, sink>{emitter, at.member},
                                  push_pair<false, sink, ids>{emitter, of_member});
    }
};

/// Entries as the caller lists them. The source of entries of a list_pairing has these members.
template <class IndexA, class IndexB>
struct listed_entries {
    using index_a = IndexA;
    using index_b = IndexB;
    static constexpr const char* noun = "entries";
    const std::vector<posed_pair<IndexA, IndexB>>* list;

    [[nodiscard]] std::size_t size() const { return list->size(); }
    /// Two posed indices, a and b.
    [[nodiscard]] const posed_pair<IndexA, IndexB>& operator[](std::size_t i) const { return (*list)[i]; }
};

/// A list that is asked about the pairs of its entries; the counterpart of `pairing`.
template <class Policy, class Entries, class Filter, schedule Schedule>
struct list_pairing {
    using IndexA = typename Entries::index_a;
    using IndexB = typename Entries::index_b;
    using member = list_member<typename IndexA::view_type, typename IndexB::view_type,
                               decltype(view_of(std::declval<const IndexA&>().set())),
                               decltype(view_of(std::declval<const IndexB&>().set()))>;
    using view_type = list_view<member, Filter>;
    using expand = expand_member<member, Filter>;
    static_assert(decidable<typename view_type::shape_type_a, typename view_type::shape_type_b>,
                  "abut: queries between sets of these two shapes are not supported");

    Entries list;
    list_options<Filter, Schedule> options;
    list_key key;
    execution::buffer_of<Policy, member> members;
    execution::buffer_of<Policy, std::uint32_t> walked;  ///< entries of which both trees have nodes
    std::vector<std::uint32_t> rest;                     ///< other entries that have shapes
    std::vector<member> from_members;                    ///< what was uploaded, for as long as that takes
    std::vector<std::uint32_t> from_walked;

    [[nodiscard]] view_type view() const { return {members.data(), key, options.filter}; }
    [[nodiscard]] std::size_t likely_hits() const {
        return std::clamp(512 * walked.size(), std::size_t{1} << 16, std::size_t{1} << 22);
    }

    template <class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        const expand step{view(), walked.data(), walked.size()};
        const execution::scheduled<Schedule> how{options.scheduling};
        run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, step, judge, sinks...); });
        // Trees of one shape have no nodes to walk: what b has looks in a.
        for (const std::uint32_t i : rest) {
            const auto& [a, b] = list[i];
            using shapes_b = decltype(member::b);
            const posed_walk<bvh_walk<typename IndexA::view_type>> walk({a.object.view()}, a.pose, a.object.bounds());
            const shapes_b rows{view_of(b.object.set()), b.pose};
            look<true>(on, walk, rows, ids_of_member<view_type>{view(), i}, run);
        }
    }
};

/// What make_operand does with an argument, without a copy of the index.
template <class Policy, class Index>
void check_entry(const Policy& on, const posed_object<Index>& x, const char* function) {
    check(x.pose, function);
    require_same_device(on, x.object, function);
    if (x.size() == 0 || stays_finite(x.pose, x.object.bounds())) return;
    const auto shapes = view_of(x.object.set());
    check(on, posed_view<std::remove_const_t<decltype(shapes)>>{shapes, x.pose}, function);
}
/// An error names the entry: by `name()`.
template <class Policy, class Index, class Name>
void check_entry(const Policy& on, const posed_object<Index>& x, const char* function, const Name& name) {
    try {
        check_entry(on, x, function);
    } catch (const error&) {
        check_entry(on, x, (std::string(function) + ": " + name()).c_str());
        throw;
    }
}

template <class Index>
inline constexpr bool is_tree = false;
template <class Set, memory_space Space, class Layout>
inline constexpr bool is_tree<bvh<Set, Space, Layout>> = true;

/// Whether all can be in a list.
template <class Policy, class Index, class... More>
consteval bool can_be_listed() {
    static_assert(is_tree<Index>, "abut: a list of pairs or of bodies holds indices made by make_bvh");
    if constexpr (!is_tree<Index>) {
        return false;
    } else if constexpr (!lies_there<Policy, Index>()) {
        return false;
    } else if constexpr (sizeof...(More) > 0) {
        return can_be_listed<Policy, More...>();
    } else {
        return true;
    }
}

/// Entries that have been checked, ready to be asked.
template <class Policy, class Entries, class Filter, schedule Schedule>
auto pair_up_entries(const Policy& on, Entries list, const list_options<Filter, Schedule>& options, const char* function) {
    using pairing = list_pairing<Policy, Entries, Filter, Schedule>;
    using member = typename pairing::member;
    const std::size_t n = list.size();
    std::vector<member> members;
    std::vector<std::uint32_t> walked, rest;
    members.reserve(n);
    std::size_t most_a = 0, most_b = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto& [a, b] = list[i];
        const std::size_t size_a = a.size(), size_b = b.size();
        most_a = std::max(most_a, size_a);
        most_b = std::max(most_b, size_b);
        members.push_back(
            {a.object.view(), b.object.view(), {view_of(a.object.set()), a.pose}, {view_of(b.object.set()), b.pose}, {}});
        const bool nodes = std::min(size_a, size_b) > 1 && std::max(size_a, size_b) <= pairing::expand::walk::most_shapes;
        if (std::min(size_a, size_b) > 0) (nodes ? walked : rest).push_back(static_cast<std::uint32_t>(i));
    }
    const list_key key{id_bits(n), {id_bits(most_a), id_bits(most_b)}};
    if (key.bits() > 64 || n > std::numeric_limits<std::uint32_t>::max()) {
        throw capacity_error(std::string(function) + ": a list of " + std::to_string(n) + " " + Entries::noun +
                             " with up to " + std::to_string(most_a) + " and " + std::to_string(most_b) +
                             " shapes; expected positions and ids of 64 bits together");
    }
    execution::buffer_of<Policy, member> there(on, n);
    execution::buffer_of<Policy, std::uint32_t> which(on, walked.size());
    upload(on, members.data(), n, there.data());
    upload(on, walked.data(), walked.size(), which.data());
    for_each_index(on, walked.size(), relate_frames<member>{there.data(), which.data()});
    return pairing{std::move(list),    options,          key, std::move(there), std::move(which), std::move(rest),
                   std::move(members), std::move(walked)};
}

/// A list, ready to be asked, as long as it lives; errors are thrown in the name of `function`.
template <class Policy, class IndexA, class IndexB, class Filter, schedule Schedule>
auto pair_up(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
             const list_options<Filter, Schedule>& options, const char* function) {
    require_callable(on, options.filter, tagged_pair{});
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto name = [i] { return "entry " + std::to_string(i) + " of the list"; };
        check_entry(on, list[i].a, function, name);
        check_entry(on, list[i].b, function, name);
    }
    return pair_up_entries(on, listed_entries<IndexA, IndexB>{&list}, options, function);
}

}  // namespace detail

/// Whether the shapes of any entry touch. Stops at the first pair found.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all_tagged,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] bool any(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                       const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, IndexA, IndexB>()) {
        return detail::any_of<A>(on, detail::pair_up(on, list, options, "abut::any"));
    } else {
        return false;
    }
}

/// Number of pairs of shapes that touch, of all entries. Stores none of them.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all_tagged,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] std::uint64_t count(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                  const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, IndexA, IndexB>()) {
        return detail::count_of<A>(on, detail::pair_up(on, list, options, "abut::count"));
    } else {
        return 0;
    }
}

/// All pairs of shapes that touch, tagged with the entry's position. In the policy's memory, 12 bytes each.
///
///     std::vector<abut::posed_pair<decltype(gear)>> list{{posed(gear, here), posed(gear, there)}};
///     for (const auto& hit : to_host(abut::pairs(on, list))) use(hit.pair, hit.a, hit.b);
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all_tagged,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto pairs(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                         const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, IndexA, IndexB>()) {
        return detail::pairs_of<A>(on, detail::pair_up(on, list, options, "abut::pairs"));
    } else {
        return result<tagged_pair, space_of<Policy>>();
    }
}

/// Calls visitor(tagged_pair) -> visit once for every pair of shapes that touches; see for_each_pair of two arguments.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Visitor,
          class Filter = keep_all_tagged, schedule Schedule = schedule::shared_list>
void for_each_pair(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list, const Visitor& visitor,
                   const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, IndexA, IndexB>() && detail::is_visitor<Policy, Visitor, tagged_pair>()) {
        detail::visit_pairs_of<A>(on, detail::pair_up(on, list, options, "abut::for_each_pair"), visitor);
    }
}

/// The contacts of all pairs of shapes that touch, tagged with the entry's position; see contacts of two arguments. In the
/// policy's memory, 40 bytes each in float and 72 in double.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB, class Filter = keep_all_tagged,
          schedule Schedule = schedule::shared_list>
[[nodiscard]] auto contacts(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                            const list_options<Filter, Schedule>& options = {}) {
    if constexpr (detail::can_be_listed<Policy, IndexA, IndexB>()) {
        return detail::contacts_of<A>(on, detail::pair_up(on, list, options, "abut::contacts"), options.discard_sideways);
    } else {
        return result<tagged_contact<float>, space_of<Policy>>();
    }
}

///@}

}  // namespace abut
