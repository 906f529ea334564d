// SPDX-License-Identifier: MIT
#pragma once

// pairs(policy, list): many pairs of posed indices in one call, for scenes of many bodies, of which each pair alone is too
// little work for a device. All trees are walked together, down from all pairs of roots, and decided in the same stages as a
// query of two (collide/search.hpp).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/query.hpp>

namespace abut {

/// Two indices over sets (make_bvh), each under a pose: posed(index, pose). Any number of entries may share an index.
template <class IndexA, class IndexB = IndexA>
struct posed_pair {
    posed_object<IndexA> a;
    posed_object<IndexB> b;
};

/// Two shapes that touch: `pair` is the position in the list, `a` and `b` are ids in its sets.
struct tagged_pair {
    std::uint32_t pair, a, b;

    friend constexpr bool operator==(const tagged_pair&, const tagged_pair&) = default;
    friend constexpr auto operator<=>(const tagged_pair&, const tagged_pair&) = default;
};

/// Options of pairs(policy, list).
struct batch_options {
    /// Sorted by pair, then a, then b. Without it the order is any, and may differ from call to call.
    bool sorted = true;
};

namespace detail {

/// An entry of the list in the policy's memory.
template <class TreeA, class TreeB, class ShapesA, class ShapesB>
struct batch_member {
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

/// A number for a member and two ids.
struct batch_key {
    /// A shape of a member.
    struct place {
        std::uint32_t member, id;
    };
    int member_bits, a_bits, b_bits;

    [[nodiscard]] int bits() const { return member_bits + a_bits + b_bits; }
    ABUT_HD std::uint64_t pack(std::uint32_t member, std::uint32_t a, std::uint32_t b) const {
        return (std::uint64_t{member} << a_bits | a) << b_bits | b;
    }
    ABUT_HD std::uint32_t member(std::uint64_t key) const { return static_cast<std::uint32_t>(key >> (a_bits + b_bits)); }
    ABUT_HD place query(std::uint64_t key) const { return {member(key), low(key >> b_bits, a_bits)}; }
    ABUT_HD place target(std::uint64_t key) const { return {member(key), low(key, b_bits)}; }

private:
    ABUT_HD static std::uint32_t low(std::uint64_t key, int bits) {
        return static_cast<std::uint32_t>(key & ((std::uint64_t{1} << bits) - 1));
    }
};

/// All members' shapes of one side.
template <class Member>
struct shapes_a_of {
    const Member* members;
    ABUT_HD auto operator[](const batch_key::place& at) const { return members[at.member].a[at.id]; }
    ABUT_INLINE void prefetch(const batch_key::place& at, int step) const { members[at.member].a.prefetch(at.id, step); }
};
template <class Member>
struct shapes_b_of {
    const Member* members;
    ABUT_HD auto operator[](const batch_key::place& at) const { return members[at.member].b[at.id]; }
    ABUT_INLINE void prefetch(const batch_key::place& at, int step) const { members[at.member].b.prefetch(at.id, step); }
};

/// What the stages of a search see (search.hpp).
template <class Member>
struct batch_sides {
    using query_shape = typename decltype(Member::a)::shape_type;
    using target_shape = typename decltype(Member::b)::shape_type;
    static_assert(decidable<query_shape, target_shape>, "abut: queries between sets of these two shapes are not supported");
    shapes_a_of<Member> queries;
    shapes_b_of<Member> targets;
    batch_key key;
};

/// Volumes of a member's two frames.
template <scalar T>
struct frames_at {
    const relative_pose<T>* b_to_a;
    template <class Volume>
    ABUT_HD bool operator()(const Volume& a, const Volume& b) const {
        return overlaps_posed(a, *b_to_a, b);
    }
    ABUT_INLINE ABUT_HD auto operator()(const box_lanes<T>& a, const box_lanes<T>& b) const {
        return overlaps(a, *b_to_a, b);
    }
};

// What the walk of a member finds, handed to a policy's emitter; see query.hpp.

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
template <class Emitter>
struct push_member_key {
    Emitter& emitter;
    std::uint32_t member;
    const batch_key& key;
    ABUT_CALLS_ANY
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, std::uint32_t a, std::uint32_t b) const {
        emitter.push(k, is, key.pack(member, a, b));
    }
};

/// One step down two trees of a member.
template <class Member>
struct expand_member {
    using T = typename Member::T;
    using walk = pair_walk<decltype(Member::tree_a), decltype(Member::tree_b), frames_at<T>>;
    struct item {
        std::uint32_t member;
        typename walk::item nodes;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = walk::most_children, most_depth = walk::most_depth;

    const Member* members;
    const std::uint32_t* walked;  ///< entries of which both trees have nodes: `n` of them
    std::size_t n;
    batch_key key;

    [[nodiscard]] ABUT_HD walk walk_of(std::size_t i) const {
        return {members[i].tree_a, members[i].tree_b, {&members[i].b_to_a}};
    }
    [[nodiscard]] std::size_t seeds() const { return n; }
    ABUT_INLINE void prefetch(const item& at) const { walk_of(at.member).prefetch(at.nodes); }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return {walked[i], walk_of(walked[i]).seed(0)}; }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        using sink = std::remove_reference_t<Emitter>;
        walk_of(at.member).expand(at.nodes, add_member_item<item, sink>{emitter, at.member},
                                  push_member_key<sink>{emitter, at.member, key});
    }
};

struct unpack_tagged {
    batch_key key;
    const std::uint64_t* keys;
    tagged_pair* out;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t k = keys[i];
        out[i] = {key.member(k), key.query(k).id, key.target(k).id};
    }
};

template <class Index>
inline constexpr bool is_tree = false;
template <class Set, memory_space Space, class Layout>
inline constexpr bool is_tree<bvh<Set, Space, Layout>> = true;

/// What a query of two does with a side (make_side), without a copy of the index.
template <class Policy, class Index>
void check_entry(const Policy& on, const posed_object<Index>& x, const char* function) {
    check(x.pose, function);
    require_same_device(on, x.object, function);
    if (x.size() == 0 || stays_finite(x.pose, x.object.bounds())) return;
    const auto shapes = view_of(x.object.set());
    check(on, posed_view<std::remove_const_t<decltype(shapes)>>{shapes, x.pose}, function);
}
/// An error names the entry.
template <class Policy, class Index>
void check_entry(const Policy& on, const posed_object<Index>& x, std::size_t i) {
    try {
        check_entry(on, x, "abut::pairs");
    } catch (const error&) {
        check_entry(on, x, ("abut::pairs: entry " + std::to_string(i) + " of the list").c_str());
        throw;
    }
}

/// The keys of all pairs of the entries that are walked, unsorted.
template <arithmetic A, class Policy, class Member>
auto keys_of_batch(const Policy& on, const std::vector<Member>& members, const std::vector<std::uint32_t>& walked,
                   const batch_key& key) {
    const std::size_t n = walked.size();
    execution::buffer_of<Policy, Member> there(on, members.size());
    execution::buffer_of<Policy, std::uint32_t> which(on, n);
    upload(on, members.data(), members.size(), there.data());
    upload(on, walked.data(), n, which.data());
    for_each_index(on, n, relate_frames<Member>{there.data(), which.data()});
    const batch_sides<Member> both{{there.data()}, {there.data()}, key};
    const expand_member<Member> expand{there.data(), which.data(), n, key};
    // Room for what is likely; it grows by itself.
    key_queue<Policy> hits(on, std::clamp(512 * n, std::size_t{1} << 16, std::size_t{1} << 22));
    search<A>(on, both, hits, [&](const auto& settle, auto& late, auto& wide, auto& found) {
        for_each_descendant(on, expand, decide_key<A, batch_sides<Member>>{both}, settle, late, wide, found);
    });
    return hits;
}

}  // namespace detail

/// All pairs of shapes that touch, of each entry of `list`: what pairs(policy, entry.a, entry.b) would say of each, in one
/// call, tagged with the entry's position. In the policy's memory. An entry may be of an empty set. Entries of a tree of one
/// shape are searched one after another. Returns when the result is there. Throws invalid_geometry, whose message names the
/// entry (a rotation that is none, a placed coordinate that overflows), error (an index on another device), capacity_error
/// (where the bits of a position and of two ids are more than 64: split the list), std::bad_alloc and cuda_error.
///
///     std::vector<abut::posed_pair<decltype(gear)>> list{{posed(gear, here), posed(gear, there)}};
///     for (const auto& hit : to_host(abut::pairs(on, list))) use(hit.pair, hit.a, hit.b);
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB>
[[nodiscard]] auto pairs(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                         const batch_options& options = {}) {
    using outcome = result<tagged_pair, space_of<Policy>>;
    static_assert(detail::is_tree<IndexA> && detail::is_tree<IndexB>,
                  "abut: a list of pairs holds indices made by make_bvh");
    static_assert(std::same_as<typename IndexA::memory_space, space_of<Policy>> &&
                      std::same_as<typename IndexB::memory_space, space_of<Policy>>,
                  "abut: an index lies in other memory than the policy works in; make it with the same policy");
    using member = detail::batch_member<typename IndexA::view_type, typename IndexB::view_type,
                                        decltype(detail::view_of(list[0].a.object.set())),
                                        decltype(detail::view_of(list[0].b.object.set()))>;
    const std::size_t n = list.size();
    std::vector<member> members;
    std::vector<std::uint32_t> walked, rest;
    members.reserve(n);
    std::size_t most_a = 0, most_b = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto& [a, b] = list[i];
        detail::check_entry(on, a, i);
        detail::check_entry(on, b, i);
        const std::size_t size_a = a.size(), size_b = b.size();
        most_a = std::max(most_a, size_a);
        most_b = std::max(most_b, size_b);
        members.push_back({a.object.view(),
                           b.object.view(),
                           {detail::view_of(a.object.set()), a.pose},
                           {detail::view_of(b.object.set()), b.pose},
                           {}});
        const bool nodes =
            std::min(size_a, size_b) > 1 && std::max(size_a, size_b) <= detail::expand_member<member>::walk::most_shapes;
        if (std::min(size_a, size_b) > 0) (nodes ? walked : rest).push_back(static_cast<std::uint32_t>(i));
    }
    const detail::batch_key key{detail::id_bits(n), detail::id_bits(most_a), detail::id_bits(most_b)};
    if (key.bits() > 64 || n > std::numeric_limits<std::uint32_t>::max()) {
        throw capacity_error("abut::pairs: a list of " + std::to_string(n) + " entries with up to " +
                             std::to_string(most_a) + " and " + std::to_string(most_b) +
                             " shapes; expected positions and ids of 64 bits together");
    }
    auto hits = detail::keys_of_batch<A>(on, members, walked, key);
    // Trees of one shape have no nodes to walk.
    std::vector<std::uint64_t> more;
    for (const std::uint32_t i : rest) {
        for (const index_pair& ids : to_host(pairs<A>(on, list[i].a, list[i].b, query_options<>{.sorted = false})))
            more.push_back(key.pack(i, ids.a, ids.b));
    }
    if (!more.empty()) {
        detail::key_queue<Policy> others(on, more);
        hits.absorb(on, others);
    }
    auto keys = hits.take();
    if (options.sorted) sort_keys(on, keys, key.bits());
    execution::buffer_of<Policy, tagged_pair> tagged(on, keys.size());
    for_each_index(on, keys.size(), detail::unpack_tagged{key, keys.data(), tagged.data()});
    synchronize(on);
    return outcome(std::move(tagged));
}

}  // namespace abut
