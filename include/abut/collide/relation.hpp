// SPDX-License-Identifier: MIT
#pragma once

// relation, overlaps: what two solids have in common: whether their interiors meet, and how they lie to each other. Solids are
// closed meshes. How two are decided is in solid_regions.hpp, and how many are asked about in solid_entries.hpp; here is what is asked.

#include <concepts>
#include <cstdint>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/collide/solid_entries.hpp>
#include <abut/collide/solid_regions.hpp>

namespace abut {

/// How two solids lie to each other: the eight relations of the region connection calculus (D. Randell, Z. Cui, A. Cohn, A
/// spatial logic based on regions and connection, 1992), of the first one to the second one.
/// @ingroup solids
enum class solid_relation : unsigned char {
    disconnected,                ///< they have no point in common
    externally_connected,        ///< their surfaces touch, and their interiors do not meet
    partially_overlapping,       ///< their interiors meet, and each has some that is outside of the other
    equal,                       ///< they are the same points
    tangential_part,             ///< the first is in the second, and their surfaces touch
    nontangential_part,          ///< the first is in the interior of the second
    tangential_part_inverse,     ///< the second is in the first, and their surfaces touch
    nontangential_part_inverse,  ///< the second is in the interior of the first
};

/// Two bodies that are not disconnected, and how the first lies to the second.
/// @ingroup solids
struct body_relation {
    std::uint32_t body_a;     ///< position of the first body
    std::uint32_t body_b;     ///< position of the second one, which is higher
    solid_relation relation;  ///< of the first to the second

    friend constexpr bool operator==(const body_relation&, const body_relation&) = default;
};

namespace detail {

inline solid_relation named(const common_regions& found, bool touches) {
    if (!found.both) return touches ? solid_relation::externally_connected : solid_relation::disconnected;
    if (found.first_alone && found.second_alone) return solid_relation::partially_overlapping;
    if (found.second_alone) return touches ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (found.first_alone) {
        return touches ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    }
    return solid_relation::equal;
}

// --- lists and scenes (solid_entries.hpp)

/// How both of an entry lie to each other.
template <arithmetic A>
struct relation_of_entries {
    static constexpr const char* function = "abut::relation";
    template <scalar>
    using answer = solid_relation;
    template <scalar>
    using told = body_relation;
    solid_options options;

    template <class Entries>
    [[nodiscard]] std::vector<solid_relation> find(Entries& entries) const {
        std::vector<solid_relation> found;
        for (const auto& [regions, touch] : entries.template regions<A>(options, true, [](const common_regions& all) { return all.all(); })) {
            found.push_back(named(regions, touch));
        }
        return found;
    }
    static bool is_told(solid_relation of) { return of != solid_relation::disconnected; }
    static body_relation tell(const index_pair& of, solid_relation is) { return {of.a, of.b, is}; }
};

/// Whether their interiors meet.
template <arithmetic A>
struct overlap_of_entries {
    static constexpr const char* function = "abut::overlaps";
    template <scalar>
    using answer = std::uint8_t;
    template <scalar>
    using told = index_pair;
    solid_options options;

    template <class Entries>
    [[nodiscard]] std::vector<std::uint8_t> find(Entries& entries) const {
        std::vector<std::uint8_t> found;
        for (const auto& of : entries.template regions<A>(options, false, [](const common_regions& all) { return all.both; })) {
            found.push_back(of.found.both ? 1 : 0);
        }
        return found;
    }
    static bool is_told(std::uint8_t of) { return of != 0; }
    static index_pair tell(const index_pair& of, std::uint8_t) { return of; }
};

}  // namespace detail

/// @defgroup solids What solids have in common
///
/// `relation` and `overlaps` of two solids: closed meshes, boxes, hulls, spheres and capsules. Whether their interiors meet, whether one is in the other, and
/// whether their surfaces touch, all of it exactly.
///
/// A solid is what a closed mesh bounds: each edge has two faces, which go along it in opposite directions, no face is without
/// area, and the surface neither passes through itself nor touches itself but where faces share vertices. It may have many
/// parts, handles and hollows. A part is of faces that share vertices. A point is in the solid as `inside` says, whichever way
/// the faces of each part are turned. Bodies whose vertices
/// in one place have different numbers are not closed: `welded` joins them.
///
/// @par Memory
/// As in @ref queries, arguments lie in the policy's memory. Where surfaces touch and faces do not pass through each other,
/// the faces of both come to the host, where they take up to 200 bytes each, and 150 more where a part of a surface touches
/// nothing; crossings of what touches take 120 bytes each in float and 192 in double. Of ranks (@ref distributed), and of what is
/// divided among devices (@ref devices), triangles and the pairs that touch come together on the host of the first rank, or of
/// the caller: 36 bytes a face in float, 72 in double and 16 a pair, beside what was said.
///
/// @par Errors
/// - `invalid_geometry`: a mesh is no solid. The message has a face and says why. Without `known_solid` that is found out in
///   each call, before anything else; it mostly takes longer than the question.
/// - `invalid_geometry`: with a `rule`, a mesh is not closed or, but for `parity`, has faces turned against each other.
/// - `error`: a `rule`, of a sphere or a capsule and a mesh.
/// - `capacity_error`: more than 715,827,882 faces or pairs come to the first rank.
/// - Those of @ref queries.
///
/// @par Synchronisation
/// Each call returns when its answer is known; under `cuda` it waits for the policy's stream. All ranks make each call.
///
/// @par Example
/// @snippet queries.cpp relation
///@{

/// How the solid `a` lies to the solid `b`, exactly, for every finite input: the same with `filtered` and `exact`, on each
/// policy, and of every index. `a` and `b` are meshes, views of meshes or trees of these; or a box, an oriented box or a hull,
/// which is taken by its `boundary`; or a sphere or a capsule of positive radius; posed or not. Under a pose it is decided of the
/// placed coordinates. A solid without faces is empty, and disconnected from every other one. Cylinders and cones are not taken.
///
/// Of several devices (@ref devices) both are on each device, or divided, or in host memory. Of ranks (@ref distributed) each has a
/// part of both, and all get the answer. In parts vertices in one place are one, and triangles of a soup will do; boxes, spheres
/// and the like are for devices and ranks their `boundary`, or not taken.
///
/// Where faces pass through each other, no more than a first pair of them is looked for. Else each place in which the surfaces
/// touch is looked at, on one thread of the host: a corner of n faces on one of m takes up to n^2 + m^2 steps. A sphere or a
/// capsule takes some microseconds for each face that it touches, until it meets one with its interior; and for each vertex of a
/// solid that it may have in it.
///
///     if (abut::relation(on, mesh, other) == abut::solid_relation::externally_connected) std::puts("they only touch");
template <arithmetic A = filtered, executor On, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] solid_relation relation(const On& on, const X& a, const Y& b, const solid_options& options = {}) {
    const auto all_known = [](const auto& regions) { return regions.all(); };
    const auto [found, touches] = ask_solids(on, detail::regions_until<A>("abut::relation", options, true, all_known), a, b);
    return detail::named(found, touches);
}

/// Whether the interiors of two solids meet: whether their relation is neither `disconnected` nor `externally_connected`.
/// Looks at no more than it has to.
template <arithmetic A = filtered, executor On, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] bool overlaps(const On& on, const X& a, const Y& b, const solid_options& options = {}) {
    return ask_solids(on, detail::common_interior<A>("abut::overlaps", options), a, b).found.both;
}

/// The relation of all bodies of a scene, `bodies` of one kind or of several, two scenes (`between`), or a std::vector of posed
/// trees of meshes: a std::vector in host memory, of all two that are not disconnected, sorted by body_a, then body_b. `which` says as of `pairs` which bodies are looked at
/// (`body_options::bodies`); its other members are not used. Several devices take bodies that each has, of one kind, and each decides those
/// that its share of the search finds; ranks take none. A body that is no solid is named in the message. Whether a surface
/// passes through itself is looked at once for each index, in its own frame; by a rule, where it does is found once for each body.
///
/// Which bodies have faces that pass through each other is found for all of them in one go, and so is where the others touch.
/// What follows is for one thread of the host. There each body that touches another one, or whose box does, takes up to 450
/// bytes a face; by a rule up to 300, and 120 for each crossing within it in float, 192 in double. Bodies of several kinds are
/// asked about one after another, each two kinds for themselves.
template <arithmetic A = filtered, executor On, detail::scene_of_bodies Scene, class Which = body_options<>>
    requires(!std::same_as<A, fast> && detail::are_body_options<Which>)
[[nodiscard]] std::vector<body_relation> relation(const On& on, const Scene& scene, const solid_options& options = {},
                                                  const Which& which = {}) {
    return detail::told_of_solids(on, detail::relation_of_entries<A>{options}, scene, which);
}

/// The relation of each entry of a list, in its order: a std::vector in host memory. The list may be of several kinds, each a
/// std::variant of posed_pairs. Of several devices each decides its share of the
/// entries, and a rank gets the relations of its own ones; these take lists of one kind.
template <arithmetic A = filtered, executor On, detail::list_of_pairs List>
    requires(!std::same_as<A, fast>)
[[nodiscard]] std::vector<solid_relation> relation(const On& on, const List& list, const solid_options& options = {}) {
    return detail::answers_of_solids(on, detail::relation_of_entries<A>{options}, list);
}

/// Which two bodies of a scene have interiors that meet: a std::vector of `index_pair` in host memory, sorted. Scenes are those
/// of `relation`. Where faces pass through each other, or boxes are beside each other, nothing else is looked at; nor is whether
/// any surfaces touch.
///
///     for (const auto [a, b] : abut::overlaps(on, scene)) use(a, b);
template <arithmetic A = filtered, executor On, detail::scene_of_bodies Scene, class Which = body_options<>>
    requires(!std::same_as<A, fast> && detail::are_body_options<Which>)
[[nodiscard]] std::vector<index_pair> overlaps(const On& on, const Scene& scene, const solid_options& options = {}, const Which& which = {}) {
    return detail::told_of_solids(on, detail::overlap_of_entries<A>{options}, scene, which);
}

/// The same of each entry of a list: one byte of each, in its order, 1 where interiors meet, else 0: a std::vector in host memory.
/// Lists are those of `relation`.
template <arithmetic A = filtered, executor On, detail::list_of_pairs List>
    requires(!std::same_as<A, fast>)
[[nodiscard]] std::vector<std::uint8_t> overlaps(const On& on, const List& list, const solid_options& options = {}) {
    return detail::answers_of_solids(on, detail::overlap_of_entries<A>{options}, list);
}

///@}

}  // namespace abut
