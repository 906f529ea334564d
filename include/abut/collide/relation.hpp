// SPDX-License-Identifier: MIT
#pragma once

// overlaps, relation: what two solids have in common: whether their interiors meet, and how they lie to each other. Solids are
// closed meshes. Faces that cross decide at once. Where surfaces only touch, each point in which they do is looked at: near it
// both solids are cones (predicate/solid_cones.hpp). Parts of a surface that do not touch the other one are inside of it or
// outside as one of their vertices is.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/boundary.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/question.hpp>
#include <abut/index/bvh.hpp>
#include <abut/collide/solid_surface.hpp>
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

/// What of a triangle a segment lies in that runs between two places of it.
ABUT_HD constexpr place_in_triangle place_between(place_in_triangle p, place_in_triangle q) {
    if (p == q) return p;
    if (p > q) return place_between(q, p);
    if (q < side_of_triangle) return side_between(p, q);
    if (q == inside_of_triangle || p >= side_of_triangle) return inside_of_triangle;
    const unsigned from = q - side_of_triangle, to = from == 2 ? 0 : from + 1;
    return p == from || p == to ? q : inside_of_triangle;
}
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

template <class View, scalar T>
struct copy_face {
    View shapes;
    mesh_face<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const corner_ids v = vertices_of_shape(shapes, static_cast<std::uint32_t>(i));
        out[i] = {shapes[i], {v.of[0], v.of[1], v.of[2]}};
    }
};
/// The faces of an operand, where they are placed, in host memory.
template <class Policy, class Operand>
auto faces_on_host(const Policy& on, const Operand& x) {
    const auto shapes = x.shapes();
    using T = typename std::remove_const_t<decltype(shapes)>::scalar_type;
    execution::buffer_of<Policy, mesh_face<T>> faces(on, shapes.size());
    for_each_index(on, shapes.size(), copy_face<std::remove_const_t<decltype(shapes)>, T>{shapes, faces.data()});
    std::vector<mesh_face<T>> here(shapes.size());
    download(on, faces.data(), here.size(), here.data());
    return here;
}

template <scalar T>
aabb<T> box_of(const std::vector<mesh_face<T>>& faces) {
    aabb<T> box = empty_box<T>();
    for (const auto& f : faces) box = merge(box, bounds(f.corners));
    return box;
}

/// A solid on the host. Not for several threads at a time.
template <scalar T>
class solid_on_host {
public:
    solid_on_host(std::vector<mesh_face<T>> faces, const char* function, const std::string& element = "face")
        : surface_(std::move(faces), function, element) {}

    [[nodiscard]] const solid_surface<T>& surface() const { return surface_; }
    /// Whether points that are not on the surface are inside.
    [[nodiscard]] std::vector<bool> have_inside(std::vector<vec3<T>> vertices) const {
        const serial on;
        if (!tree_ && vertices.size() <= few) {
            std::vector<bool> are;
            for (const vec3<T>& v : vertices) are.push_back(surface_.has_inside(v));
            return are;
        }
        if (!tree_) {
            std::vector<triangle<T>> corners;
            corners.reserve(surface_.size());
            for (const mesh_face<T>& f : surface_.faces()) corners.push_back(f.corners);
            tree_.emplace(make_bvh(on, triangle_soup<T>(std::move(corners))));
        }
        return are_inside(on, *tree_, vertices, "abut::relation");
    }

private:
    using tree_type = decltype(make_bvh(serial{}, triangle_soup<T>()));

    static constexpr std::size_t few = 8;  ///< points for which all faces are looked at sooner than a tree is made
    solid_surface<T> surface_;
    mutable std::optional<tree_type> tree_;
};

/// What two solids have in common of which no faces pass through each other, from what faces do have in common, until that is
/// enough.
template <scalar T, class Enough>
common_regions regions_of_solids(const solid_on_host<T>& a, const solid_on_host<T>& b, std::span<const crossing<T>> contacts,
                                 const Enough& is_enough) {
    const solid_surface<T>&of_a = a.surface(), &of_b = b.surface();
    std::vector<char> touched_a(of_a.parts(), 0), touched_b(of_b.parts(), 0);
    struct contact_place {
        std::array<mesh_feature, 2> name;
        std::uint32_t face_a, face_b;
        place_in_triangle in_a, in_b;
    };
    std::vector<contact_place> places;
    for (crossing<T> c : contacts) {
        const auto add = [&](place_in_triangle in_a, place_in_triangle in_b) {
            c.in_a[0] = static_cast<unsigned char>(in_a);
            c.in_b[0] = static_cast<unsigned char>(in_b);
            places.push_back({{c.feature_a(0), c.feature_b(0)}, c.a, c.b, in_a, in_b});
        };
        const crossing<T> all = c;
        for (int i = 0; i < all.count; ++i) {
            add(all.in_a[i], all.in_b[i]);
            const int j = i + 1 == all.count ? 0 : i + 1;
            if (i < j || all.count > 2) add(place_between(all.in_a[i], all.in_a[j]), place_between(all.in_b[i], all.in_b[j]));
        }
        if (all.count > 2) add(inside_of_triangle, inside_of_triangle);
        touched_a[of_a.part_of(c.a)] = touched_b[of_b.part_of(c.b)] = 1;
    }
    std::sort(places.begin(), places.end(), [](const auto& p, const auto& q) { return p.name < q.name; });
    common_regions found;
    for (std::size_t i = 0; i < places.size() && !is_enough(found); ++i) {
        const contact_place& p = places[i];
        if (i > 0 && p.name == places[i - 1].name) continue;
        found |= regions_of_cones(of_a.cone_at(p.face_a, p.in_a), of_b.cone_at(p.face_b, p.in_b));
    }
    // Parts that touch nothing.
    const auto look_at_parts = [&](const solid_surface<T>& of, const std::vector<char>& touched, const solid_on_host<T>& other,
                                   const common_regions& if_inside, const common_regions& if_outside) {
        std::vector<vec3<T>> vertices;
        for (std::uint32_t p = 0; p < of.parts(); ++p) {
            if (touched[p] == 0) vertices.push_back(of.vertex_of_part(p));
        }
        if (vertices.empty() || is_enough(found)) return;
        for (const bool is : other.have_inside(std::move(vertices))) found |= is ? if_inside : if_outside;
    };
    look_at_parts(of_a, touched_a, b, {true, false, true}, {false, true, false});
    look_at_parts(of_b, touched_b, a, {true, true, false}, {false, false, true});
    return found;
}

inline solid_relation named(const common_regions& found, bool touches) {
    if (!found.both) return touches ? solid_relation::externally_connected : solid_relation::disconnected;
    if (found.first_alone && found.second_alone) return solid_relation::partially_overlapping;
    if (found.second_alone) return touches ? solid_relation::tangential_part : solid_relation::nontangential_part;
    if (found.first_alone) {
        return touches ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
    }
    return solid_relation::equal;
}

/// Throws where a surface passes through itself or touches itself.
template <class Policy, class X>
void require_simple(const Policy& on, const X& x, const char* function, const std::string& element = "face") {
    const auto pairs = to_host(self_pairs(on, x));
    if (pairs.empty()) return;
    throw invalid_geometry(function, element, pairs.front().a,
                           "the surface passes through itself or touches itself at this face; the other face is",
                           pairs.front().b);
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

/// What two solids have in common, until that is enough, and whether their surfaces touch.
template <arithmetic A, class Policy, class X, class Y, class Enough>
std::pair<common_regions, bool> regions_of(const Policy& on, const X& x, const Y& y, const solid_options& options,
                                           const char* function, const Enough& is_enough) {
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
    const answer of_passing(common_regions{true, true, true}, true), of_apart(common_regions{false, true, true}, false);
    if (options.known_solid && !overlaps(known_box(x), known_box(y))) return of_apart;
    if (options.known_solid && pass()) return of_passing;
    auto faces_a = faces_on_host(on, a), faces_b = faces_on_host(on, b);
    if (options.known_solid && !overlaps(box_of(faces_a), box_of(faces_b))) return of_apart;
    const solid_on_host<T> solid_a(std::move(faces_a), function), solid_b(std::move(faces_b), function);
    if (!options.known_solid && pass()) return of_passing;
    const std::vector<crossing<T>> contacts = to_host(ask_for<A>(touching{}, all_crossings{}).find(on, pairing));
    return answer(regions_of_solids<T>(solid_a, solid_b, contacts, is_enough), !contacts.empty());
}

// --- many bodies

/// Shapes of an entry by the number of the entry.
struct names_of_open_entries : names_of_entries_of_bodies {
    template <scalar T>
    ABUT_HD static tagged_crossing<T> tagged(const pair_of_entry& of, const crossing<T>& c) {
        return {of.pair, of.a, of.b, c};
    }
};

/// Bodies on the host, each made when it is asked for.
template <class Policy, class Index>
class bodies_on_host {
public:
    using T = typename Index::scalar_type;

    bodies_on_host(const Policy& on, const placed_bodies<Index>& all, const char* function, const char* what)
        : on_(on), objects_(*all.objects), function_(function), what_(what), object_of_(all.size()), poses_(all.size()),
          faces_(all.size()), made_(all.size()), one_part_(all.objects->indices.size()) {
        download(on, all.objects->object_of.data(), all.size(), object_of_.data());
        download(on, all.poses->data(), all.size(), poses_.data());
    }
    const solid_on_host<T>& operator[](std::uint32_t i) {
        if (!made_[i]) made_[i] = std::make_unique<solid_on_host<T>>(faces(i).first, function_, element(i));
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
            require_simple(on_, objects_.indices[object], function_, element(i));
            (void)(*this)[i];
        }
    }

private:
    template <class View>
    struct placed_shapes {
        posed_view<View> placed;
        [[nodiscard]] const posed_view<View>& shapes() const { return placed; }
    };
    [[nodiscard]] std::string element(std::uint32_t i) const { return std::string(what_) + " " + std::to_string(i) + ", face"; }

    const Policy& on_;
    const placed_objects<Index>& objects_;
    const char *function_, *what_;
    std::vector<std::uint32_t> object_of_;
    std::vector<rigid<T>> poses_;
    std::vector<std::optional<std::pair<std::vector<mesh_face<T>>, aabb<T>>>> faces_;
    std::vector<std::unique_ptr<solid_on_host<T>>> made_;
    std::vector<std::optional<bool>> one_part_;  ///< of each index
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
    execution::buffer_of<Policy, std::uint32_t> marks(on, n);
    mark_entries<A>(on, pairing, passing_through{}, marks.data());
    std::vector<std::uint32_t> pass(n);
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
        if (pass[i] != 0) continue;
        if constexpr (std::same_as<index_a, index_b>) {
            if (is_one) {
                found[i] = relation_of(bodies_a, entries[i]);
                continue;
            }
        }
        found[i] = relation_of(*others, entries[i]);
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
        const auto [found, touches] = detail::regions_of<A>(on, a, b, options, "abut::relation",
                                                                   [](const auto& regions) { return regions.all(); });
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
        const auto is_enough = [](const auto& regions) { return regions.both; };
        return detail::regions_of<A>(on, a, b, options, "abut::overlaps", is_enough).first.both;
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
