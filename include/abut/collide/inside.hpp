// SPDX-License-Identifier: MIT
#pragma once

// inside: which of many points are inside of a closed mesh; signed_distance: how far they are from its surface.
//
// By definition a point that is on no triangle is inside if the way up from it, moved aside by as little as need be, crosses
// an odd number of triangles (narrow/crossing.hpp). The walk is that of a ray.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/flag.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/collide/validate.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/crossing.hpp>
#include <abut/shape/half_edges.hpp>
#include <abut/shape/ray_reach.hpp>
#include <abut/traverse/from_each.hpp>

namespace abut {

/// Where a point is.
/// @ingroup queries
enum class containment : std::uint8_t {
    outside,    ///< 0
    inside,     ///< 1
    on_surface  ///< 2: on a triangle of the mesh, its edges and corners too
};

/// Options of `inside` and `signed_distance`.
/// @ingroup queries
struct inside_options {
    /// The caller knows that the mesh is closed, and it is not looked at. Of a mesh that is not, answers mean nothing.
    flag known_closed = false;
};

namespace detail {

/// How a frame sees the ray up from a point.
template <class Frame, scalar T>
ABUT_HD auto line_upward(const Frame& frame, const vec3<T>& p) {
    return line_seen(frame, p, vec3<T>{0, 0, 1}, infinity<double>);
}

/// A walk up from each of many points.
template <arithmetic A, class Walk, class Frame, shape_view Shapes, shape_view Points>
struct walk_upward {
    using T = typename Points::scalar_type;
    Walk walk;
    Frame frame;
    Shapes shapes;
    Points points;
    containment* out;

    struct look {
        vec3<T> p;
        bool is_odd = false, is_on = false;

        ABUT_CALLS_ANY
        template <class Sink>
        ABUT_HD void operator()(const walk_upward& all, std::uint32_t id, Sink& sink) {
            if (is_on) return;
            const met_above found = crossing_of<A>(p, all.shapes[id]);
            is_odd ^= found == met_above::crossing;
            is_on = found == met_above::start;
            if (is_on) sink.stop();
        }
        template <class Sink>
        ABUT_HD void end(const walk_upward& all, std::size_t i, Sink&) const {
            all.out[i] = is_on ? containment::on_surface : is_odd ? containment::inside : containment::outside;
        }
    };
    ABUT_HD look start(std::size_t i) const { return {points[i]}; }
    ABUT_HD auto seen(std::size_t i) const { return line_upward(frame, points[i]); }
};

/// The first face at an edge of an odd number of faces, if half-edge i is that edge's first; and how many they are.
struct face_at_odd_edge {
    sorted_half_edges table;
    ABUT_HD execution::least_value operator()(std::size_t i) const {
        if (!table.is_edge(i) || !table.is_first(i)) return {};
        const mesh_edge edge = mesh_edge_of{table}(static_cast<std::uint32_t>(i));
        if (edge.faces % 2 == 0) return {};
        return {static_cast<double>(edge.first_face), edge.faces};
    }
};

template <class Policy, scalar T, memory_space Space>
void require_closed(const Policy& on, const mesh_view<T, Space>& mesh, const char* function) {
    check_sides(mesh.size(), function);
    const half_edge_table<Policy> sorted(on, mesh, id_bits(mesh.vertices.count));
    const sorted_half_edges table = sorted.view();
    const execution::least_value first =
        reduce(on, table.count, execution::least_value{}, execution::lesser_value{}, face_at_odd_edge{table});
    if (first == execution::least_value{}) return;
    throw invalid_geometry(function, "face", static_cast<std::size_t>(first.value),
                           "the mesh is not closed: an edge of this face has an odd number of faces",
                           static_cast<double>(first.key));
}
template <class Policy, class View>
void require_closed(const Policy& on, const posed_view<View>& mesh, const char* function) {
    require_closed(on, mesh.shapes, function);
}

template <class X>
inline constexpr bool has_faces = is_mesh<X>;
template <class Set, memory_space Space, class Layout>
inline constexpr bool has_faces<bvh<Set, Space, Layout>> = is_mesh<Set>;
template <class Object>
inline constexpr bool has_faces<posed_object<Object>> = has_faces<Object>;

/// Whether `inside` takes both arguments, of which the first is a whole mesh or a part: parts are triangles.
template <arithmetic A, class Policy, class X, class Points, bool Whole>
consteval bool can_contain() {
    constexpr bool is_decided = !std::same_as<A, fast>;
    static_assert(is_decided, "abut: inside is decided by `filtered` or `exact`");
    if constexpr (Whole) {
        constexpr bool is_mesh_or_tree = has_faces<X>;
        static_assert(is_mesh_or_tree, "abut: inside looks into a closed mesh: a mesh, a mesh_view, or a tree of one");
        if constexpr (is_decided && is_mesh_or_tree) return can_be_near<Policy, X, Points>();
        return false;
    } else if constexpr (is_decided && can_be_near<Policy, X, Points>()) {
        using shape_type = typename shape_of_argument<X>::type;
        constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
        static_assert(are, "abut: inside looks into a closed mesh: the parts of one are triangles");
        return are;
    } else {
        return false;
    }
}

/// Writes where each point is, of shapes that bound a body.
template <arithmetic A, class Policy, class Operand, class Queries>
void look_upward(const Policy& on, const Operand& x, const Queries& queries, containment* out) {
    const auto there = x.shapes();
    const auto from = queries.shapes();
    using T = typename std::remove_const_t<decltype(from)>::scalar_type;
    if (there.size() == 0) return fill(on, out, from.size(), containment::outside);
    const auto walk = ordered_walk_of(x);
    const auto frame = frame_of(x, length_unit<T>{});
    using walk_type = walk_upward<A, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                                  std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(from)>>;
    execution::until_stopped until;
    for_each_ordered(on, from.size(), from_each{walk_type{walk, frame, there, from, out}}, until);
}

/// Where a point is: of a part, whether the way up from it crosses an odd number of the part's triangles.
template <arithmetic A>
struct ask_inside : question_of_points {
    template <scalar, class>
    using found = containment;
    using answer = containment;
    const char* function = "abut::inside";
    bool known_closed = false;

    template <class Policy, class X, class Points, bool Whole>
    static consteval bool takes() {
        return can_contain<A, Policy, X, Points, Whole>();
    }
    template <class Policy, class X, class Points>
    void check(const Policy& on, const X& x, const Points&, const char* holder) const {
        if (known_closed) return;
        if (holder != nullptr) {
            throw error(std::string(function) + ": no " + holder +
                        " to find out whether it is closed; expected {.known_closed = true}");
        }
        if constexpr (requires { require_closed(on, x.shapes(), function); }) require_closed(on, x.shapes(), function);
    }
    template <class Policy, class X, class Points>
    auto at_once(const Policy& on, const X& x, const Points& points, double) const {
        execution::buffer_of<Policy, answer> out(on, points.shapes().size());
        ask(on, x, points, same_key{}, out.data());
        return result<answer, space_of<Policy>>(std::move(out));
    }
    template <scalar T>
    [[nodiscard]] ask_inside in_parts(double) const {
        return *this;
    }
    template <class Policy, class Operand, class Rows, class Ids>
    void ask(const Policy& on, const Operand& x, const Rows& rows, const Ids&, answer* out) const {
        look_upward<A>(on, x, rows, out);
        synchronize(on);
    }
    ABUT_HD void merge(answer* best, const answer* other) const {
        const bool is_on = *best == containment::on_surface || *other == containment::on_surface;
        *best = is_on ? containment::on_surface : *best == *other ? containment::outside : containment::inside;
    }
    template <scalar T>
    ABUT_HD bool may_change(const vec3<T>& p, const answer* best, const part_bounds<T>& part) const {
        return *best != containment::on_surface && may_meet(ray<T>{p, {0, 0, 1}}, part, infinity<double>);
    }
};

template <class Neighbor>
struct write_signed {
    const Neighbor* nearest;
    const containment* where;
    Neighbor* out;

    ABUT_HD void operator()(std::size_t i) const {
        out[i] = nearest[i];
        if (where[i] == containment::inside) out[i].distance = -out[i].distance;
        if (where[i] == containment::on_surface) out[i].distance = 0;
    }
};

}  // namespace detail

/// For each of `points` whether it is inside of a closed mesh: a `result` of `containment`, in the order of the points. A
/// point on a triangle, on an edge or on a corner is `on_surface`. Any other is inside if a way from it to infinity crosses
/// the surface an odd number of times, whichever way the faces are turned. So a hollow in a solid is outside, and so is what
/// two bodies in one mesh have in common.
///
/// Decided exactly, for every finite input, with `filtered` as with `exact`; the same on every policy. Ways that meet edges
/// and corners fool nothing. Under a pose it is decided of the placed coordinates.
///
/// `mesh` is a mesh, a mesh_view, or a tree of any layout over one, posed or not. `points` are as of `nearest`. Closed means
/// that every edge is one of an even number of faces, by the numbers of its vertices. Vertices that lie in one place and
/// have two numbers make a mesh that is not closed; `welded` joins them. What is closed is found out in each call; it takes
/// a sort of all sides of the faces. `{.known_closed = true}` leaves it out.
///
/// Of several devices (@ref devices) the answer lies in memory of the first one, which finds out whether the mesh is closed.
/// Of a divided mesh, and of ranks (@ref distributed), of which each has a part, nobody can: the caller has to know it, and
/// parts may be of triangles.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 1 byte a point. Scratch takes 72 bytes a face, while it is
/// found out whether the mesh is closed.
///
/// @par Errors
/// - `invalid_geometry`: the mesh is not closed (the message has a face and how many faces one of its edges has); a view or
///   a
///   row of points holds no geometry, or a pose is no rotation.
/// - `error`: a set or an index lies on another device; a mesh in parts is not said to be closed.
/// - `capacity_error`: a view or a row has 2^31 elements or more, or there are more than 1,431,655,765 faces.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp inside
///
/// @ingroup queries
template <arithmetic A = filtered, executor On, class X, class Points>
[[nodiscard]] auto inside(const On& on, const X& mesh, const Points& points, const inside_options& options = {}) {
    return ask_rows(on, detail::ask_inside<A>{{}, "abut::inside", bool(options.known_closed)}, mesh, points);
}

/// For each of `points` what `nearest` says of it, with a distance that is below 0 where the point is `inside`, and 0 where
/// it is on the surface.
///
/// Arguments and options are those of `inside`. The sign is exact; distances are those of `nearest`.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 20 bytes a point in float and 40 in double; scratch takes as
/// much again, and what `inside` takes.
///
/// @par Errors
/// Those of `inside`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp signed_distance
///
/// @ingroup queries
template <executor On, class X, class Points>
[[nodiscard]] auto signed_distance(const On& on, const X& mesh, const Points& points, const inside_options& options = {}) {
    constexpr const char* function = "abut::signed_distance";
    const auto where = ask_rows(on, detail::ask_inside<filtered>{{}, function, bool(options.known_closed)}, mesh, points);
    const auto near = ask_rows(on, detail::ask_nearest<false>{{}, function}, mesh, points);
    return make_of_answers(on, detail::by_its_policy{}, [&](const auto& local) {
        using local_policy = std::remove_cvref_t<decltype(local)>;
        using found = typename std::remove_cvref_t<decltype(near)>::value_type;
        execution::buffer_of<local_policy, found> out(local, near.size());
        for_each_index(local, near.size(), detail::write_signed<found>{near.data(), where.data(), out.data()});
        synchronize(local);
        return result<found, space_of<local_policy>>(std::move(out));
    });
}

}  // namespace abut
