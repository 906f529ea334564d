// SPDX-License-Identifier: MIT
#pragma once

// overlaps, relation: what two solids have in common: whether their interiors meet, and how they lie to each other. Solids are
// closed meshes. Faces that cross decide at once. Where surfaces only touch, each point in which they do is looked at: near it
// both solids are cones (predicate/solid_cones.hpp). Parts of a surface that do not touch the other one are inside of it or
// outside as one of their vertices is.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/boundary.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/question.hpp>
#include <abut/collide/solid_on_host.hpp>
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

/// Options of `relation` and `overlaps`.
/// @ingroup solids
struct solid_options {
    /// The caller knows that both are solids, and that is not looked at. Of others the answer means nothing, or
    /// invalid_geometry is thrown.
    flag known_solid = false;
};

namespace detail {

/// Whether two triangles pass through each other: with points of a segment that is inside of both.
ABUT_HD constexpr bool pass_through(const shared_corners& all) {
    return all.count() == 2 && !all.is_flat() && place_between(all.in_first(0), all.in_first(1)) == inside_of_triangle &&
           place_between(all.in_second(0), all.in_second(1)) == inside_of_triangle;
}

/// Whether two triangles pass through each other.
template <arithmetic A>
struct passes {
    template <scalar T>
    ABUT_HD verdict decide(const triangle<T>& s, const triangle<T>& t) const {
        // In general position triangles that touch do.
        if constexpr (std::same_as<A, exact>) return verdict::unknown;
        return abut::decide<filtered>(s, t);
    }
    template <scalar T>
    ABUT_HD verdict finish(const triangle<T>& s, const triangle<T>& t) const {
        if constexpr (!std::same_as<A, exact>) {
            if (const shared_corners first = certified_corners(s, t); first.is_known()) return to_verdict(pass_through(first));
        }
        const shared_corners found = exact_corners(s, t);
        return found.is_known() ? to_verdict(pass_through(found)) : verdict::unknown;
    }
    template <scalar T>
    bool resolve(const triangle<T>& s, const triangle<T>& t) const {
        return pass_through(shared_by<A>(s, t));
    }
};
struct passing_through : touching {
    template <arithmetic A>
    [[nodiscard]] passes<A> judge() const {
        return {};
    }
};

inline solid_relation named(const common_regions& found, bool touches) {
    if (!found.both) return touches ? solid_relation::externally_connected : solid_relation::disconnected;
    if (found.first_alone && found.second_alone) return solid_relation::partially_overlapping;
    if (found.second_alone) return touches ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (found.first_alone) {
        return touches ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    }
    return solid_relation::equal;
}

/// Whether relation and overlaps take the arguments.
template <class X, class Y>
consteval bool are_solids() {
    constexpr bool are = has_faces<X> && has_faces<Y>;
    static_assert(are, "abut: solids are closed meshes (a mesh, a mesh_view, or a tree of one), boxes, oriented boxes and hulls, posed or not");
    return are;
}

/// A box around an argument that knows one: a tree, posed or not. Of all space around any other.
template <class X>
auto known_box([[maybe_unused]] const X& x) {
    using T = scalar_of_argument<X>;
    if constexpr (requires { x.bounds(); }) {
        return x.bounds();
    } else if constexpr (requires { world_box(x.pose, x.object.bounds()); }) {
        return world_box(x.pose, x.object.bounds());
    } else {
        constexpr T far = infinity<T>;
        return aabb<T>{{-far, -far, -far}, {far, far, far}};
    }
}

/// What two solids have in common, until that is enough, and, if that is wanted, whether their surfaces touch. `faces` gives
/// the faces of both on the host; it is asked only where faces of both do not pass through each other.
template <arithmetic A, class Policy, class X, class Y, class Enough, class Faces>
std::pair<common_regions, bool> regions_of(const Policy& on, const X& x, const Y& y, const solid_options& options, bool wants_touching,
                                           const char* function, const Enough& is_enough, const Faces& faces) {
    const auto a = make_operand(on, x, function);
    const auto b = make_operand(on, y, function);
    const query_options<> all;
    using T = scalar_of_argument<X>;
    const auto pairing = pair_operands(on, a, b, all);
    if (!options.known_solid) {
        require_simple(on, x, function);
        require_simple(on, y, function);
    }
    using answer = std::pair<common_regions, bool>;
    const bool has_a = a.shapes().size() > 0, has_b = b.shapes().size() > 0;
    if (!has_a || !has_b) return answer(common_regions{false, has_a, has_b}, false);
    const auto pass = [&] { return ask_for<A>(passing_through{}, whether{}).find(on, pairing); };
    const auto beside = [&] {
        return answer(common_regions{false, true, true}, wants_touching && ask_for<A>(touching{}, whether{}).find(on, pairing));
    };
    const answer of_passing(common_regions{true, true, true}, true);
    if (options.known_solid && are_beside(known_box(x), known_box(y))) return beside();
    if (options.known_solid && pass()) return of_passing;
    auto [faces_a, faces_b] = faces();
    const bool are_boxes_beside = are_beside(box_of(faces_a), box_of(faces_b));
    if (options.known_solid && are_boxes_beside) return beside();
    const solid_on_host<T> solid_a(std::move(faces_a), function), solid_b(std::move(faces_b), function);
    if (are_boxes_beside) return beside();
    if (!options.known_solid && pass()) return of_passing;
    const std::vector<crossing<T>> contacts = to_host(ask_for<A>(touching{}, all_crossings{}).find(on, pairing));
    return answer(regions_of_solids<T>(solid_a, solid_b, contacts, is_enough), !contacts.empty());
}

/// Whether the interiors of two solids meet.
template <arithmetic A, class Policy, class X, class Y, class Faces>
bool have_common_interior(const Policy& on, const X& x, const Y& y, const solid_options& options, const char* function, const Faces& faces) {
    const auto is_enough = [](const common_regions& regions) { return regions.both; };
    return regions_of<A>(on, x, y, options, false, function, is_enough, faces).first.both;
}

// --- many bodies

/// Shapes of an entry by the number of the entry.
struct names_of_open_entries : names_of_entries_of_bodies {
    template <scalar T>
    ABUT_HD static tagged_crossing<T> tagged(const pair_of_entry& of, const crossing<T>& c) {
        return {of.pair, of.a, of.b, c};
    }
};

/// The relation of each entry of a pairing. `both_are_one`: a's bodies are b's.
template <arithmetic A, class Policy, class Pairing>
std::vector<solid_relation> relations_of_entries(const Policy& on, const Pairing& pairing, const std::vector<index_pair>& entries,
                                                 const solid_options& options, const char* function, const char* what) {
    using index_a = std::remove_cvref_t<decltype(pairing.a.objects->indices.front())>;
    using index_b = std::remove_cvref_t<decltype(pairing.b.objects->indices.front())>;
    using T = typename Pairing::T;
    const std::size_t n = entries.size();
    std::vector<solid_relation> found(n, solid_relation::partially_overlapping);
    bodies_on_host<Policy, index_a> bodies_a(on, pairing.a, function, what);
    std::optional<bodies_on_host<Policy, index_b>> others;
    const bool is_one = static_cast<const void*>(pairing.a.objects.get()) == static_cast<const void*>(pairing.b.objects.get()) &&
                        static_cast<const void*>(pairing.a.poses.get()) == static_cast<const void*>(pairing.b.poses.get());
    if (!is_one) others.emplace(on, pairing.b, function, what);
    if (!options.known_solid) {
        bodies_a.require_solids(entries, false);
        if constexpr (std::same_as<index_a, index_b>) {
            if (is_one) bodies_a.require_solids(entries, true);
        }
        if (others) others->require_solids(entries, true);
    }
    const auto with_bodies = [&](const auto& f) {
        if constexpr (std::same_as<index_a, index_b>) {
            if (is_one) return f(bodies_a);
        }
        return f(*others);
    };
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

}  // namespace detail

/// @defgroup solids What solids have in common
///
/// `relation` and `overlaps` of two solids: closed meshes. Whether their interiors meet, whether one is in the other, and
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
/// nothing; crossings of what touches take 120 bytes each in float and 192 in double.
///
/// @par Errors
/// - `invalid_geometry`: a mesh is no solid. The message has a face and says why. Without `known_solid` that is found out in
///   each call, before anything else; it takes longer than the question, as a rule.
/// - Those of @ref queries.
///
/// @par Synchronisation
/// Each call returns when its answer is known; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp relation
///@{

/// How the solid `a` lies to the solid `b`, exactly, for every finite input: the same with `filtered` and `exact`, on each
/// policy, and of every index. `a` and `b` are meshes, views of meshes or trees of these, or a box, an oriented box or a hull,
/// which is taken by its `boundary`; posed or not. Under a pose it is decided of the placed coordinates. A solid without faces is empty, and disconnected from every other one.
///
/// Where faces pass through each other, no more than a first pair of them is looked for. Else each place in which the surfaces
/// touch is looked at, on one thread of the host: a corner of n faces on one of m takes up to n^2 + m^2 steps.
///
///     if (abut::relation(on, mesh, other) == abut::solid_relation::externally_connected) std::puts("they only touch");
template <arithmetic A = filtered, execution_policy Policy, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] solid_relation relation(const Policy& on, const X& a, const Y& b, const solid_options& options = {}) {
    if constexpr (detail::is_polytope<X> || detail::is_polytope<Y>) {
        constexpr const char* function = "abut::relation";
        return relation<A>(on, detail::as_solid(on, a, function), detail::as_solid(on, b, function), options);
    } else if constexpr (detail::are_solids<X, Y>()) {
        constexpr const char* function = "abut::relation";
        const auto is_enough = [](const auto& regions) { return regions.all(); };
        const auto faces = [&] { return detail::faces_of_both(on, a, b, function); };
        const auto [found, touches] = detail::regions_of<A>(on, a, b, options, true, function, is_enough, faces);
        return detail::named(found, touches);
    } else {
        return solid_relation::disconnected;
    }
}

/// Whether the interiors of two solids meet: whether their relation is neither `disconnected` nor `externally_connected`.
/// Looks at no more than it has to.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] bool overlaps(const Policy& on, const X& a, const Y& b, const solid_options& options = {}) {
    if constexpr (detail::is_polytope<X> || detail::is_polytope<Y>) {
        constexpr const char* function = "abut::overlaps";
        return overlaps<A>(on, detail::as_solid(on, a, function), detail::as_solid(on, b, function), options);
    } else if constexpr (detail::are_solids<X, Y>()) {
        constexpr const char* function = "abut::overlaps";
        return detail::have_common_interior<A>(on, a, b, options, function, [&] { return detail::faces_of_both(on, a, b, function); });
    } else {
        return false;
    }
}

/// Two bodies that are not disconnected, and how the first lies to the second.
struct body_relation {
    std::uint32_t body_a;     ///< position of the first body
    std::uint32_t body_b;     ///< position of the second one, which is higher
    solid_relation relation;  ///< of the first to the second

    friend constexpr bool operator==(const body_relation&, const body_relation&) = default;
};

/// The same of all bodies of a scene, `bodies` or a std::vector of posed trees of meshes: a std::vector in host memory, of all
/// two that are not disconnected, sorted by body_a, then body_b. `which` says as of `pairs` which bodies are looked at
/// (`body_options::bodies`); its other members are not used. A body that is no solid is named in the message. Whether a surface
/// passes through itself is looked at once for each index, in its own frame.
///
/// Which bodies have faces that pass through each other is found for all of them in one go, and so is where the others touch.
/// What follows is for one thread of the host. There each body that touches another one, or whose box does, takes up to 450
/// bytes a face.
template <arithmetic A = filtered, execution_policy Policy, many_bodies Scene, class Which = body_options<>>
    requires(!std::same_as<A, fast> && detail::are_body_options<Which>)
[[nodiscard]] std::vector<body_relation> relation(const Policy& on, const Scene& scene, const solid_options& options = {},
                                                  const Which& which = {}) {
    std::vector<body_relation> found;
    if constexpr (detail::are_solid_bodies<typename detail::index_of_bodies<Scene>::type>()) {
        constexpr const char* function = "abut::relation";
        const auto pairing = detail::whole(scene).pair_up(on, detail::touching{}, which, true, function);
        const std::vector<index_pair> entries = detail::entries_of(on, pairing);
        const auto relations = detail::relations_of_entries<A>(on, pairing, entries, options, function, "body");
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (relations[i] != solid_relation::disconnected) found.push_back({entries[i].a, entries[i].b, relations[i]});
        }
    }
    return found;
}

/// The same of each entry of a list, in its order: a std::vector in host memory.
template <arithmetic A = filtered, execution_policy Policy, class IndexA, class IndexB>
    requires(!std::same_as<A, fast>)
[[nodiscard]] std::vector<solid_relation> relation(const Policy& on, const std::vector<posed_pair<IndexA, IndexB>>& list,
                                                   const solid_options& options = {}) {
    if constexpr (detail::are_solid_bodies<IndexA>() && detail::are_solid_bodies<IndexB>()) {
        constexpr const char* function = "abut::relation";
        const auto pairing = detail::whole(list).pair_up(on, detail::touching{}, list_options<>{}, true, function);
        return detail::relations_of_entries<A>(on, pairing, detail::entries_of(on, pairing), options, function, "entry");
    } else {
        return {};
    }
}

///@}

}  // namespace abut
