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
#include <type_traits>
#include <vector>

#include <abut/collide/crossings.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/question.hpp>
#include <abut/index/bvh.hpp>
#include <abut/collide/solid_surface.hpp>

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

/// Two solids on the host, and what is known of them.
template <scalar T>
class two_solids {
public:
    two_solids(std::vector<mesh_face<T>> a, std::vector<mesh_face<T>> b, const char* function)
        : a_(std::move(a), function), b_(std::move(b), function) {}

    /// What is common near the points in which surfaces touch, until `is_enough` says so of what is found.
    template <class Enough>
    void look_near(const std::vector<crossing<T>>& contacts, const Enough& is_enough) {
        struct place {
            mesh_feature a, b;
            std::uint32_t face_a, face_b;
            unsigned char in_a, in_b;
        };
        std::vector<place> places;
        for (const crossing<T>& c : contacts) {
            const auto add = [&](unsigned in_a, unsigned in_b) {
                crossing<T> one = c;
                one.in_a[0] = static_cast<unsigned char>(in_a);
                one.in_b[0] = static_cast<unsigned char>(in_b);
                places.push_back({one.feature_a(0), one.feature_b(0), c.a, c.b, one.in_a[0], one.in_b[0]});
            };
            for (int i = 0; i < c.count; ++i) {
                add(c.in_a[i], c.in_b[i]);
                const int j = i + 1 == c.count ? 0 : i + 1;
                if (i < j || c.count > 2) add(place_between(c.in_a[i], c.in_a[j]), place_between(c.in_b[i], c.in_b[j]));
            }
            if (c.count > 2) add(inside_of_triangle, inside_of_triangle);
            touched_a_[a_.part_of(c.a)] = touched_b_[b_.part_of(c.b)] = 1;
        }
        const auto name = [](const place& p) { return std::array<mesh_feature, 2>{p.a, p.b}; };
        std::sort(places.begin(), places.end(), [&](const place& p, const place& q) { return name(p) < name(q); });
        touches_ = !contacts.empty();
        for (std::size_t i = 0; i < places.size() && !is_enough(found_); ++i) {
            if (i > 0 && name(places[i]) == name(places[i - 1])) continue;
            const place& p = places[i];
            found_ |= regions_of_cones(a_.cone_at(p.face_a, p.in_a), b_.cone_at(p.face_b, p.in_b));
        }
    }
    /// And what is known of parts that touch nothing.
    void look_at_parts(const std::vector<mesh_face<T>>& faces_a, const std::vector<mesh_face<T>>& faces_b) {
        look_at_parts(a_, touched_a_, faces_b, {true, false, true}, {false, true, false});
        look_at_parts(b_, touched_b_, faces_a, {true, true, false}, {false, false, true});
    }

    [[nodiscard]] const common_regions& found() const { return found_; }
    [[nodiscard]] bool touches() const { return touches_; }

private:
    void look_at_parts(const solid_surface<T>& of, const std::vector<char>& touched, const std::vector<mesh_face<T>>& other,
                       const common_regions& if_inside, const common_regions& if_outside) {
        std::vector<vec3<T>> vertices;
        for (std::uint32_t p = 0; p < of.parts(); ++p) {
            if (touched[p] == 0) vertices.push_back(of.vertex_of_part(p));
        }
        if (vertices.empty()) return;
        std::vector<triangle<T>> corners;
        for (const auto& f : other) corners.push_back(f.corners);
        const auto tree = make_bvh(serial{}, triangle_soup<T>(std::move(corners)));
        execution::buffer_of<serial, containment> where(serial{}, vertices.size());
        const auto rows = make_operand(serial{}, points<T>(std::move(vertices)), "abut::relation");
        look_upward<filtered>(serial{}, make_operand(serial{}, tree, "abut::relation"), rows, where.data());
        for (std::size_t i = 0; i < where.size(); ++i) found_ |= where.data()[i] == containment::inside ? if_inside : if_outside;
    }

    solid_surface<T> a_, b_;
    std::vector<char> touched_a_ = std::vector<char>(a_.parts(), 0), touched_b_ = std::vector<char>(b_.parts(), 0);
    common_regions found_;
    bool touches_ = false;
};

/// Throws where a surface passes through itself or touches itself.
template <class Policy, class X>
void require_simple(const Policy& on, const X& x, const char* function) {
    const auto pairs = to_host(self_pairs(on, x));
    if (pairs.empty()) return;
    throw invalid_geometry(function, "face", pairs.front().a,
                           "the surface passes through itself or touches itself at this face; the other face is",
                           pairs.front().b);
}

/// Whether relation and overlaps take the arguments.
template <class X, class Y>
consteval bool are_solids() {
    constexpr bool are = has_faces<X> && has_faces<Y>;
    static_assert(are, "abut: solids are closed meshes: a mesh, a mesh_view, or a tree of one, posed or not");
    return are;
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
    if (a.shapes().size() == 0 || b.shapes().size() == 0) {
        return {{false, a.shapes().size() > 0, b.shapes().size() > 0}, false};
    }
    const auto pass = [&] { return ask_for<A>(passing_through{}, whether{}).find(on, pairing); };
    if (options.known_solid && pass()) return {{true, true, true}, true};
    const auto faces_a = faces_on_host(on, a), faces_b = faces_on_host(on, b);
    if (options.known_solid && !overlaps(box_of(faces_a), box_of(faces_b))) return {{false, true, true}, false};
    two_solids<T> solids(faces_a, faces_b, function);
    if (!options.known_solid && pass()) return {{true, true, true}, true};
    solids.look_near(to_host(ask_for<A>(touching{}, all_crossings{}).find(on, pairing)), is_enough);
    if (!is_enough(solids.found())) solids.look_at_parts(faces_a, faces_b);
    return {solids.found(), solids.touches()};
}

}  // namespace detail

/// @defgroup solids What solids have in common
///
/// `relation` and `overlaps` of two solids: closed meshes. Whether their interiors meet, whether one is in the other, and
/// whether their surfaces touch, all of it exactly.
///
/// A solid is what a closed mesh bounds: each edge has two faces, which go along it in opposite directions, no face is without
/// area, and the surface neither passes through itself nor touches itself but where faces share vertices. It may have many
/// parts, handles and hollows. A point is in it as `inside` says, whichever way the faces are turned. Bodies whose vertices
/// in one place have different numbers are not closed: `welded` joins them.
///
/// @par Memory
/// As in @ref queries: arguments lie in the policy's memory. Where surfaces touch and faces do not pass through each other,
/// the faces of both come to the host, where they take up to 150 bytes each, and crossings of what touches 120 bytes each in
/// float and 192 in double.
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
/// policy, and of every index. `a` and `b` are meshes, views of meshes or trees of these, posed or not; under a pose it is
/// decided of the placed coordinates. A solid without faces is empty, and disconnected from every other one.
///
/// Where faces pass through each other, no more than a first pair of them is looked for. Else each place in which the surfaces
/// touch is looked at, on one thread of the host: a corner of n faces on one of m takes n m steps.
///
///     abut::mesh<double> wall = ..., pipe = ...;
///     if (abut::relation(on, wall, pipe) == abut::solid_relation::externally_connected) puts("they only touch");
template <arithmetic A = filtered, execution_policy Policy, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] solid_relation relation(const Policy& on, const X& a, const Y& b, const solid_options& options = {}) {
    if constexpr (detail::are_solids<X, Y>()) {
        const auto [found, touches] = detail::regions_of<A>(on, a, b, options, "abut::relation",
                                                                   [](const auto& regions) { return regions.all(); });
        if (!found.both) return touches ? solid_relation::externally_connected : solid_relation::disconnected;
        if (found.first_alone && found.second_alone) return solid_relation::partially_overlapping;
        if (found.second_alone) return touches ? solid_relation::tangential_part : solid_relation::nontangential_part;
        if (found.first_alone) {
            return touches ? solid_relation::tangential_part_inverse : solid_relation::nontangential_part_inverse;
        }
        return solid_relation::equal;
    } else {
        return solid_relation::disconnected;
    }
}

/// Whether the interiors of two solids meet: whether their relation is neither `disconnected` nor `externally_connected`.
/// Looks at no more than it has to.
template <arithmetic A = filtered, execution_policy Policy, class X, class Y>
    requires(!std::same_as<A, fast>)
[[nodiscard]] bool overlaps(const Policy& on, const X& a, const Y& b, const solid_options& options = {}) {
    if constexpr (detail::are_solids<X, Y>()) {
        const auto is_enough = [](const auto& regions) { return regions.both; };
        return detail::regions_of<A>(on, a, b, options, "abut::overlaps", is_enough).first.both;
    } else {
        return false;
    }
}

///@}

}  // namespace abut
