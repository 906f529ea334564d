// SPDX-License-Identifier: MIT
#pragma once

// relation, overlaps: what two solids have in common: whether their interiors meet, and how they lie to each other. Solids are
// closed meshes. How two are decided is in solid_regions.hpp; here is what is asked, and what many bodies need.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/collide/solid_regions.hpp>
#include <abut/collide/touching_bodies.hpp>

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

// --- many bodies

/// Shapes of an entry by the number of the entry.
struct names_of_open_entries : names_of_entries_of_bodies {
    template <scalar T>
    ABUT_HD static tagged_crossing<T> tagged(const pair_of_entry& of, const crossing<T>& c) {
        return {of.pair, of.a, of.b, c};
    }
};

/// How a body or an entry is called in messages, by its number in the whole.
template <class Position>
struct name_of_solid {
    const char* what;
    Position position;
    [[nodiscard]] std::string operator()(std::uint32_t i) const { return what + (" " + std::to_string(position(i))) + ", face"; }
};

/// Bodies on the host, each made when it is asked for.
template <class Policy, class Index, class Name>
class bodies_on_host {
public:
    using T = typename Index::scalar_type;

    bodies_on_host(const Policy& on, const placed_bodies<Index>& all, const char* function, const Name& name)
        : on_(on), objects_(*all.objects), function_(function), name_(name), object_of_(all.size()), poses_(all.size()),
          faces_(all.size()), made_(all.size()), one_part_(all.objects->indices.size()), is_closed_(one_part_.size(), 0) {
        download(on, all.objects->object_of.data(), all.size(), object_of_.data());
        download(on, all.poses->data(), all.size(), poses_.data());
    }
    const solid_on_host<T>& operator[](std::uint32_t i) {
        if (!made_[i]) made_[i] = std::make_unique<solid_on_host<T>>(faces(i).first, function_, name_(i));
        return *made_[i];
    }
    /// The faces of a body, and the box around them.
    const std::pair<std::vector<mesh_face<T>>, aabb<T>>& faces(std::uint32_t i) {
        if (!faces_[i]) {
            const auto shapes = view_of(objects_.indices[object_of_[i]].set());
            const placed_shapes<std::remove_const_t<decltype(shapes)>> placed{{shapes, poses_[i]}};
            auto all = faces_on_host(on_, placed);
            const aabb<T> box = box_of(all);
            faces_[i].emplace(std::move(all), box);
        }
        return *faces_[i];
    }
    /// The faces of a body that is taken by a rule. Throws where it is not closed.
    const std::vector<mesh_face<T>>& faces_by_rule(std::uint32_t i, const solid_options& options) {
        const auto& all = faces(i).first;
        if (!options.known_solid && std::exchange(is_closed_[object_of_[i]], 1) == 0) require_turns(all, *options.rule, function_, name_(i));
        return all;
    }
    /// A box around a body, which may be larger than that around its faces.
    [[nodiscard]] aabb<T> known_box(std::uint32_t i) const {
        return world_box(poses_[i], objects_.indices[object_of_[i]].bounds());
    }
    /// Whether a body's surface is of one part. It is the same of all bodies of an index.
    bool has_one_part(std::uint32_t i) {
        std::optional<bool>& has = one_part_[object_of_[i]];
        if (!has) has = (*this)[i].surface().parts() <= 1;
        return *has;
    }
    /// Throws where the surface of a body's index passes through itself.
    void require_solids(const std::vector<index_pair>& entries, bool second) {
        std::vector<char> looked(objects_.indices.size(), 0);
        for (const index_pair& e : entries) {
            const std::uint32_t i = second ? e.b : e.a, object = object_of_[i];
            if (std::exchange(looked[object], 1) != 0) continue;
            require_simple(on_, objects_.indices[object], function_, name_(i));
            (void)(*this)[i];
        }
    }

private:
    template <class View>
    struct placed_shapes {
        posed_view<View> placed;
        [[nodiscard]] const posed_view<View>& shapes() const { return placed; }
    };
    const Policy& on_;
    const placed_objects<Index>& objects_;
    const char* function_;
    Name name_;
    std::vector<std::uint32_t> object_of_;
    std::vector<rigid<T>> poses_;
    std::vector<std::optional<std::pair<std::vector<mesh_face<T>>, aabb<T>>>> faces_;
    std::vector<std::unique_ptr<solid_on_host<T>>> made_;
    std::vector<std::optional<bool>> one_part_;  ///< of each index
    std::vector<char> is_closed_;                ///< of each index: that was looked at
};

/// The relation of each entry of a pairing. `both_are_one`: a's bodies are b's.
template <arithmetic A, class Policy, class Pairing, class Name>
std::vector<solid_relation> relations_of_entries(const Policy& on, const Pairing& pairing, const std::vector<index_pair>& entries,
                                                 const solid_options& options, const char* function, const Name& name) {
    using index_a = std::remove_cvref_t<decltype(pairing.a.objects->indices.front())>;
    using index_b = std::remove_cvref_t<decltype(pairing.b.objects->indices.front())>;
    using T = typename Pairing::T;
    const std::size_t n = entries.size();
    std::vector<solid_relation> found(n, solid_relation::partially_overlapping);
    bodies_on_host<Policy, index_a, Name> bodies_a(on, pairing.a, function, name);
    std::optional<bodies_on_host<Policy, index_b, Name>> others;
    const bool is_one = static_cast<const void*>(pairing.a.objects.get()) == static_cast<const void*>(pairing.b.objects.get()) &&
                        static_cast<const void*>(pairing.a.poses.get()) == static_cast<const void*>(pairing.b.poses.get());
    if (!is_one) others.emplace(on, pairing.b, function, name);
    const auto with_bodies = [&](const auto& f) {
        if constexpr (std::same_as<index_a, index_b>) {
            if (is_one) return f(bodies_a);
        }
        return f(*others);
    };
    if (options.rule) {
        with_bodies([&](auto& bodies_b) {
            for (std::size_t i = 0; i < n; ++i) {
                const auto &a = bodies_a.faces_by_rule(entries[i].a, options), &b = bodies_b.faces_by_rule(entries[i].b, options);
                const auto [regions, touch] = regions_by_rule(a, b, *options.rule, [](const common_regions& all) { return all.all(); });
                found[i] = named(regions, touch);
            }
        });
        return found;
    }
    if (!options.known_solid) {
        bodies_a.require_solids(entries, false);
        if constexpr (std::same_as<index_a, index_b>) {
            if (is_one) bodies_a.require_solids(entries, true);
        }
        if (others) others->require_solids(entries, true);
    }
    // Which entries are beside each other, and so whether they touch is all that is asked of them. Others are looked at later.
    std::vector<std::uint32_t> beside(n, 0), not_beside(n, 1), touch(n), pass(n);
    with_bodies([&](auto& bodies_b) {
        for (std::size_t i = 0; i < n; ++i) {
            const auto [a, b] = entries[i];
            if (!are_nearly_beside(bodies_a.known_box(a), bodies_b.known_box(b))) continue;
            if (!are_beside(bodies_a.faces(a).second, bodies_b.faces(b).second)) continue;
            beside[i] = 1;
            not_beside[i] = 0;
        }
    });
    execution::buffer_of<Policy, std::uint32_t> marks(on, n);
    upload(on, not_beside.data(), n, marks.data());
    mark_entries<A>(on, pairing, touching{}, marks.data());
    download(on, marks.data(), n, touch.data());
    upload(on, beside.data(), n, marks.data());
    mark_entries<A>(on, pairing, passing_through{}, marks.data());
    download(on, marks.data(), n, pass.data());
    using closing = until_found_pairing<Pairing, names_of_open_entries>;
    const typename closing::filter until{{}, pairing.options.filter, marks.data()};
    auto sorted = with_filter(pairing.options, until);
    sorted.sorted = true;
    const auto contacts = to_host(all_crossings{}.find<A>(on, closing{pairing, sorted}, touching{}));
    std::vector<crossing<T>> some;
    const auto relation_of = [&](auto& bodies_b, const index_pair& e) {
        if (some.empty() && bodies_a.has_one_part(e.a) && bodies_b.has_one_part(e.b)) {
            // One in the other, or apart.
            const aabb<T>&box_a = bodies_a.faces(e.a).second, &box_b = bodies_b.faces(e.b).second;
            if (!contains(box_a, box_b) && !contains(box_b, box_a)) return solid_relation::disconnected;
        }
        if (are_beside(bodies_a.faces(e.a).second, bodies_b.faces(e.b).second)) return named({false, true, true}, !some.empty());
        const solid_on_host<T>&a = bodies_a[e.a], &b = bodies_b[e.b];
        const auto all_known = [](const common_regions& regions) { return regions.all(); };
        if (a.surface().size() == 0 || b.surface().size() == 0) return solid_relation::disconnected;
        return named(regions_of_solids<T>(a, b, some, all_known), !some.empty());
    };
    for (std::size_t i = 0, k = 0; i < n; ++i) {
        some.clear();
        for (; k < contacts.size() && contacts[k].pair == i; ++k) {
            some.push_back(contacts[k].common);
            some.back().a = contacts[k].a;
            some.back().b = contacts[k].b;
        }
        if (beside[i] != 0) {
            found[i] = named({false, true, true}, touch[i] != 0);
        } else if (pass[i] == 0) {
            found[i] = with_bodies([&](auto& bodies_b) { return relation_of(bodies_b, entries[i]); });
        }
    }
    return found;
}
/// Which bodies the entries of a pairing are.
template <class Policy, class Pairing>
std::vector<index_pair> entries_of(const Policy& on, const Pairing& pairing) {
    std::vector<index_pair> entries(pairing.members.size());
    download(on, pairing.bodies.data(), entries.size(), entries.data());
    return entries;
}

template <class Index>
consteval bool are_solid_bodies() {
    constexpr bool are = has_faces<Index>;
    static_assert(are, "abut: solids are closed meshes: trees of meshes");
    return are;
}

/// The relations of what is in a list or a scene: ask_relations is overloaded as ask_solids is.
template <arithmetic A>
struct ask_relations_of {
    static constexpr const char* function = "abut::relation";
    solid_options options;

    /// Of each entry of a list, `position` of which says where it is in the whole.
    template <class Policy, class List, class Position = own_positions>
    [[nodiscard]] std::vector<solid_relation> of_list(const Policy& on, const List& list, const Position& position = {}) const {
        const auto pairing = whole(list).pair_up(on, touching{}, list_options<>{}, true, function, position);
        return relations_of_entries<A>(on, pairing, entries_of(on, pairing), options, function, name_of_solid<Position>{"entry", position});
    }
    /// Of all two bodies that are not disconnected, in a part of the search.
    template <class Policy, class Scene, class Which, class Part = whole_search>
    [[nodiscard]] std::vector<body_relation> of_bodies(const Policy& on, const Scene& scene, const Which& which, const Part& part = {}) const {
        const auto pairing = whole(scene).pair_up(on, touching{}, which, true, function, part);
        const std::vector<index_pair> entries = entries_of(on, pairing);
        const auto relations = relations_of_entries<A>(on, pairing, entries, options, function, name_of_solid<same_number>{"body", {}});
        std::vector<body_relation> found;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (relations[i] != solid_relation::disconnected) found.push_back({entries[i].a, entries[i].b, relations[i]});
        }
        return found;
    }
};
template <execution_policy Policy, class Question, class Scene, class Which>
std::vector<body_relation> ask_relations(const Policy& on, const Question& question, const Scene& scene, const Which& which) {
    return question.of_bodies(on, scene, which);
}
template <execution_policy Policy, class Question, class IndexA, class IndexB>
std::vector<solid_relation> ask_relations(const Policy& on, const Question& question, const std::vector<posed_pair<IndexA, IndexB>>& list) {
    return question.of_list(on, list);
}

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

/// The same of all bodies of a scene, `bodies` or a std::vector of posed trees of meshes: a std::vector in host memory, of all
/// two that are not disconnected, sorted by body_a, then body_b. `which` says as of `pairs` which bodies are looked at
/// (`body_options::bodies`); its other members are not used. Several devices take bodies that each has, and each decides those
/// that its share of the search finds; ranks take none. A body that is no solid is named in the message. Whether a surface
/// passes through itself is looked at once for each index, in its own frame.
///
/// Which bodies have faces that pass through each other is found for all of them in one go, and so is where the others touch.
/// What follows is for one thread of the host. There each body that touches another one, or whose box does, takes up to 450
/// bytes a face.
template <arithmetic A = filtered, executor On, many_bodies Scene, class Which = body_options<>>
    requires(!std::same_as<A, fast> && detail::are_body_options<Which>)
[[nodiscard]] std::vector<body_relation> relation(const On& on, const Scene& scene, const solid_options& options = {},
                                                  const Which& which = {}) {
    std::vector<body_relation> found;
    if constexpr (detail::are_solid_bodies<typename detail::index_of_bodies<Scene>::type>()) {
        found = ask_relations(on, detail::ask_relations_of<A>{options}, scene, which);
    }
    return found;
}

/// The same of each entry of a list, in its order: a std::vector in host memory. Of several devices each decides its share of the
/// entries, and a rank gets the relations of its own ones.
template <arithmetic A = filtered, executor On, class IndexA, class IndexB>
    requires(!std::same_as<A, fast>)
[[nodiscard]] std::vector<solid_relation> relation(const On& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                                   const solid_options& options = {}) {
    if constexpr (detail::are_solid_bodies<IndexA>() && detail::are_solid_bodies<IndexB>()) {
        return ask_relations(on, detail::ask_relations_of<A>{options}, list);
    } else {
        return {};
    }
}

///@}

}  // namespace abut
