// SPDX-License-Identifier: MIT
#pragma once

// inside: which of many points are inside of a closed mesh; winding_number<exact>: how often its surface goes round them;
// signed_distance: how far they are from it.
//
// By definition a point that is on no triangle is inside if the way up from it, moved aside by as little as need be, crosses
// an odd number of triangles (narrow/crossing.hpp). The surface goes round it as often as that way leaves it by triangles that
// face up, less as often as it enters it by those that face down. The walk is that of a ray.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/collide/flag.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/collide/validate.hpp>
#include <abut/collide/winding_number.hpp>
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

/// What is inside, by how often the surface goes round a point. In all but `parity` faces have to be turned alike.
/// @ingroup queries
enum class inside_rule : std::uint8_t {
    parity,   ///< an odd number of times, whichever way faces are turned: what two bodies have in common is outside
    nonzero,  ///< any number but 0: what bodies have in common is inside, and a hollow is not if its faces face into it
    positive  ///< 1 or more: what is turned inside out has no inside
};

/// Options of `inside`, `signed_distance` and `spans`.
/// @ingroup queries
struct inside_options {
    /// The caller knows that the mesh is closed, and it is not looked at. Of a mesh that is not, answers mean nothing.
    flag known_closed = false;
    /// Of a mesh in parts `inside` and `signed_distance` have `parity` only.
    inside_rule rule = inside_rule::parity;
    /// Refuses a mesh in which all faces of a body are there twice, or more often, so that they cancel and it has no inside. It
    /// takes a search for faces with the same vertices where the mesh is looked at. By default in builds without NDEBUG.
#ifdef NDEBUG
    flag check = false;
#else
    flag check = true;
#endif
};

/// How often a closed surface goes round a point.
/// @ingroup queries
struct winding_count {
    std::int32_t turns = 0;   ///< 0 on the surface
    bool on_surface = false;  ///< on a triangle of the mesh, its edges and corners too

    /// Whether both say the same.
    bool operator==(const winding_count&) const = default;
};

namespace detail {

/// Whether points are inside that a surface goes round so often.
ABUT_HD constexpr bool is_in_by(inside_rule rule, std::int32_t turns) {
    return rule == inside_rule::parity ? turns % 2 != 0 : rule == inside_rule::nonzero ? turns != 0 : turns > 0;
}

/// What is told of crossings.
template <class Answer>
ABUT_HD Answer answer_of_crossings(std::int32_t turns, bool is_on, inside_rule rule) {
    if constexpr (std::same_as<Answer, winding_count>) {
        return {is_on ? 0 : turns, is_on};
    } else {
        return is_on ? containment::on_surface : is_in_by(rule, turns) ? containment::inside : containment::outside;
    }
}

/// How a frame sees the ray up from a point.
template <class Frame, scalar T>
ABUT_HD auto line_upward(const Frame& frame, const vec3<T>& p) {
    return line_seen(frame, p, vec3<T>{0, 0, 1}, infinity<double>);
}

/// A walk up from each of many points.
template <arithmetic A, class Answer, class Walk, class Frame, shape_view Shapes, shape_view Points>
struct walk_upward {
    using T = typename Points::scalar_type;
    Walk walk;
    Frame frame;
    Shapes shapes;
    Points points;
    inside_rule rule;
    Answer* out;

    struct look {
        vec3<T> p;
        std::int32_t turns = 0;
        bool is_on = false;

        ABUT_CALLS_ANY
        template <class Sink>
        ABUT_HD void operator()(const walk_upward& all, std::uint32_t id, Sink& sink) {
            if (is_on) return;
            const met_above found = crossing_of<A>(p, all.shapes[id]);
            turns += found == met_above::leaving ? 1 : found == met_above::entering ? -1 : 0;
            is_on = found == met_above::start;
            if (is_on) sink.stop();
        }
        template <class Sink>
        ABUT_HD void end(const walk_upward& all, std::size_t i, Sink&) const {
            all.out[i] = answer_of_crossings<Answer>(turns, is_on, all.rule);
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

/// The same of an edge that its faces do not go along as often one way as the other.
struct face_at_turned_edge {
    sorted_half_edges table;
    ABUT_HD execution::least_value operator()(std::size_t i) const {
        if (!table.is_edge(i) || !table.is_first(i)) return {};
        std::int64_t forward = table.backward(i) ? -1 : 1;
        for (std::size_t k = 1; table.goes_on(i, k); ++k) forward += table.backward(i + k) ? -1 : 1;
        if (forward == 0) return {};
        const auto more = static_cast<std::uint64_t>(forward < 0 ? -forward : forward);
        return {static_cast<double>(mesh_edge_of{table}(static_cast<std::uint32_t>(i)).first_face), more};
    }
};

/// Throws where the faces of a body, which are all that have vertices in common, cancel: each as often as it takes.
template <class Policy, scalar T, memory_space Space>
void refuse_doubled(const Policy& on, const mesh_view<T, Space>& mesh, const sorted_half_edges& table, const char* function,
                    inside_rule rule) {
    const std::uint64_t most =
        reduce(on, table.count, std::uint64_t{0}, add_up_tallies{}, one_if<may_be_duplicate>{{table}});
    const std::vector<duplicate_face> doubled = find_duplicates(on, table, most);
    if (doubled.empty()) return;
    const auto here = set_of(on, mesh).copied_to(serial{});
    const strided<face> faces = here.view().faces;
    const auto counts = [&](std::size_t f) { return spans_triangle(corners_of(faces, f), mesh.vertices.count); };
    std::vector<std::int32_t> turns(faces.count, 1);  // of the first face with some vertices: of all of them
    for (const duplicate_face& d : doubled) {
        turns[d.of] += d.reversed && rule != inside_rule::parity ? -1 : 1;
        turns[d.face] = 0;
    }
    id_buffer<serial> parents(serial{}, mesh.vertices.count);
    const execution::disjoint_sets bodies = make_disjoint_sets(serial{}, parents);
    for (std::size_t f = 0; f < faces.count; ++f) {
        const corner_ids c = corners_of(faces, f);
        if (!counts(f)) continue;
        bodies.unite(c.of[0], c.of[1]);
        bodies.unite(c.of[1], c.of[2]);
    }
    std::vector<char> has_surface(mesh.vertices.count, 0);
    const auto body_of = [&](std::size_t f) { return bodies.root(corners_of(faces, f).of[0]); };
    for (std::size_t f = 0; f < faces.count; ++f) {
        const bool is_left = rule == inside_rule::parity ? turns[f] % 2 != 0 : turns[f] != 0;
        if (is_left && counts(f)) has_surface[body_of(f)] = 1;
    }
    for (const duplicate_face& d : doubled) {
        if (has_surface[body_of(d.face)] != 0) continue;
        throw invalid_geometry(function, "face", d.face,
                               "all faces of the body with this duplicate face are there twice and cancel, so that it has no inside; "
                               "the first face with these vertices is",
                               d.of);
    }
}

/// Throws where a mesh is not closed, and if `turned` matters, where faces at an edge are turned against each other; and if
/// asked, where bodies are doubled.
template <class Policy, scalar T, memory_space Space>
void require_closed(const Policy& on, const mesh_view<T, Space>& mesh, const char* function, bool turned = false,
                    bool doubled = false, inside_rule rule = inside_rule::parity, const std::string& element = "face") {
    check_sides(mesh.size(), function);
    const half_edge_table<Policy> sorted(on, mesh, id_bits(mesh.vertices.count));
    const sorted_half_edges table = sorted.view();
    const execution::least_value first =
        reduce(on, table.count, execution::least_value{}, execution::lesser_value{}, face_at_odd_edge{table});
    if (!(first == execution::least_value{})) {
        throw invalid_geometry(function, element, static_cast<std::size_t>(first.value),
                               "the mesh is not closed: an edge of this face has an odd number of faces",
                               static_cast<double>(first.key));
    }
    if (doubled) refuse_doubled(on, mesh, table, function, rule);
    if (!turned) return;
    const execution::least_value other =
        reduce(on, table.count, execution::least_value{}, execution::lesser_value{}, face_at_turned_edge{table});
    if (other == execution::least_value{}) return;
    throw invalid_geometry(function, element, static_cast<std::size_t>(other.value),
                           "faces at an edge of this face are turned against each other: more go along it one way than the "
                           "other, by",
                           static_cast<double>(other.key));
}
template <class Policy, class View>
    requires(is_mesh<View>)
void require_closed(const Policy& on, const posed_view<View>& mesh, const char* function, bool turned = false,
                    bool doubled = false, inside_rule rule = inside_rule::parity) {
    require_closed(on, mesh.shapes, function, turned, doubled, rule);
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
    static_assert(is_decided, "abut: inside and winding numbers are decided by `filtered` or `exact`");
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
template <arithmetic A, class Policy, class Operand, class Queries, class Answer>
void look_upward(const Policy& on, const Operand& x, const Queries& queries, Answer* out,
                 inside_rule rule = inside_rule::parity) {
    const auto there = x.shapes();
    const auto from = queries.shapes();
    using T = typename std::remove_const_t<decltype(from)>::scalar_type;
    if (there.size() == 0) return fill(on, out, from.size(), answer_of_crossings<Answer>(0, false, rule));
    const auto walk = ordered_walk_of(x);
    const auto frame = frame_of(x, length_unit<T>{});
    using walk_type = walk_upward<A, Answer, std::remove_const_t<decltype(walk)>, std::remove_const_t<decltype(frame)>,
                                  std::remove_const_t<decltype(there)>, std::remove_const_t<decltype(from)>>;
    execution::until_stopped until;
    for_each_ordered(on, from.size(), from_each{walk_type{walk, frame, there, from, rule, out}}, until);
}

/// Of each point, in host memory, whether it is inside of a surface that is known to be closed: a tree of triangles, posed or not.
template <class Policy, class X, scalar T>
std::vector<bool> are_inside(const Policy& on, const X& surface, const std::vector<vec3<T>>& asked, const char* function,
                             inside_rule rule = inside_rule::parity) {
    const auto x = make_operand(on, surface, function);
    const auto set = copy_to(on, points<T>(asked));
    const auto rows = make_operand(on, set, function);
    execution::buffer_of<Policy, containment> where(on, asked.size());
    look_upward<filtered>(on, x, rows, where.data(), rule);
    std::vector<containment> here(asked.size());
    download(on, where.data(), here.size(), here.data());
    std::vector<bool> are(here.size());
    for (std::size_t i = 0; i < are.size(); ++i) are[i] = here[i] == containment::inside;
    return are;
}

/// Where a point is, or how often the surface goes round it: of a part, what the way up from it crosses of the part's triangles.
template <arithmetic A, class Answer = containment>
struct ask_inside : question_of_points {
    template <scalar, class>
    using found = Answer;
    using answer = Answer;
    const char* function = "abut::inside";
    inside_options options{};

    template <class Policy, class X, class Points, bool Whole>
    static consteval bool takes() {
        return can_contain<A, Policy, X, Points, Whole>();
    }
    template <class Policy, class X, class Points>
    void check(const Policy& on, const X& x, const Points&, const char* holder) const {
        if (holder != nullptr && options.rule != inside_rule::parity) {
            throw error(std::string(function) + ": no " + holder + " to go by another rule than inside_rule::parity");
        }
        if (options.known_closed) return;
        if (holder != nullptr) {
            throw error(std::string(function) + ": no " + holder +
                        " to find out whether it is closed; expected {.known_closed = true}");
        }
        const bool turned = std::same_as<Answer, winding_count> || options.rule != inside_rule::parity;
        if constexpr (requires { require_closed(on, x.shapes(), function); }) {
            require_closed(on, x.shapes(), function, turned, bool(options.check), options.rule);
        }
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
        look_upward<A>(on, x, rows, out, options.rule);
        synchronize(on);
    }
    ABUT_HD static bool is_on(containment c) { return c == containment::on_surface; }
    ABUT_HD static bool is_on(const winding_count& c) { return c.on_surface; }
    ABUT_HD static std::int32_t turns_of(containment c) { return c == containment::inside ? 1 : 0; }
    ABUT_HD static std::int32_t turns_of(const winding_count& c) { return c.turns; }
    ABUT_HD void merge(answer* best, const answer* other) const {
        *best = answer_of_crossings<answer>(turns_of(*best) + turns_of(*other), is_on(*best) || is_on(*other), inside_rule::parity);
    }
    template <scalar T>
    ABUT_HD bool may_change(const vec3<T>& p, const answer* best, const part_bounds<T>& part) const {
        return !is_on(*best) && may_meet(ray<T>{p, {0, 0, 1}}, part, infinity<double>);
    }
};

/// `Where` is a containment, or a winding number.
template <class Neighbor, class Where>
struct write_signed {
    const Neighbor* nearest;
    const Where* where;
    Neighbor* out;

    ABUT_HD void operator()(std::size_t i) const {
        out[i] = nearest[i];
        if constexpr (std::same_as<Where, containment>) {
            if (where[i] == containment::inside) out[i].distance = -out[i].distance;
            if (where[i] == containment::on_surface) out[i].distance = 0;
        } else if (absolute(where[i]) > 0.5 && out[i].distance > 0) {
            out[i].distance = -out[i].distance;
        }
    }
};

/// Distances with the signs of another answer, of the same executor.
template <executor On, class Near, class Where>
auto with_signs(const On& on, const Near& near, const Where& where) {
    return make_of_answers(on, by_its_policy{}, [&](const auto& local) {
        using local_policy = std::remove_cvref_t<decltype(local)>;
        using found = typename Near::value_type;
        execution::buffer_of<local_policy, found> out(local, near.size());
        for_each_index(local, near.size(), write_signed<found, typename Where::value_type>{near.data(), where.data(), out.data()});
        synchronize(local);
        return result<found, space_of<local_policy>>(std::move(out));
    });
}

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
/// a sort of all sides of the faces. `{.known_closed = true}` leaves it out. `rule` says what is inside where bodies of one
/// mesh overlap; `check` refuses bodies all of whose faces are doubled.
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
/// - `invalid_geometry`: the mesh is not closed (the message has a face and how many faces one of its edges has), faces at an
///   edge are turned against each other and the rule is not `parity`, or all faces of a body are doubled and `check` is set; a
///   view or a row of points holds no geometry, or a pose is no rotation.
/// - `error`: a set or an index lies on another device; a mesh in parts is not said to be closed, or the rule of it is not
///   `parity`.
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
    return ask_rows(on, detail::ask_inside<A>{{}, "abut::inside", options}, mesh, points);
}

/// For each of `points` how often the surface of a closed mesh goes round it, exactly: a `result` of `winding_count`, in the
/// order of the points. It is 1 inside of a mesh that faces outward, and 0 outside. Where two bodies of one mesh overlap it is
/// 2, and in a hollow, whose faces face into it, it is 0: so it tells what bodies have in common from holes, which `inside`
/// does not. Turned inside out it is -1. A point on a triangle, an edge or a corner is `on_surface`, as for `inside`.
///
/// Decided as `inside` is, with `filtered` as with `exact`: for every finite input, the same on every policy. Arguments,
/// options, memory and errors are those of `inside`, 8 bytes a point; and where faces at an edge are turned against each
/// other (as many of them have to go along it one way as the other), `invalid_geometry` is thrown.
///
/// @par Memory
/// As in @ref queries. The result lies in the policy's memory, 8 bytes a point; scratch is that of `inside`.
///
/// @par Errors
/// Those of `inside`.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
/// @par Example
/// @snippet queries.cpp winding_number_exact
///
/// @ingroup queries
template <arithmetic A, executor On, class X, class Points>
[[nodiscard]] auto winding_number(const On& on, const X& mesh, const Points& points, const inside_options& options = {}) {
    using question = detail::ask_inside<A, winding_count>;
    return ask_rows(on, question{{}, "abut::winding_number", {.known_closed = options.known_closed, .check = false}}, mesh, points);
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
    const auto where = ask_rows(on, detail::ask_inside<filtered>{{}, function, options}, mesh, points);
    const auto near = ask_rows(on, detail::ask_nearest<false>{{}, function}, mesh, points);
    return detail::with_signs(on, near, where);
}

/// The same of a mesh that need not be closed, as scans are, or soups with holes: a point is inside where `winding_number`,
/// within the tolerance, says that the surface goes round it by more than a half, either way. So the sign may be wrong where
/// that is close to a half, as in the middle of a hole; elsewhere 0.1 is enough. Of a point on the surface the distance is 0.
///
/// Arguments and errors are those of `winding_number` and of `nearest`; a winding index is no argument. On one policy.
///
///     const auto near = abut::signed_distance(on, scan, points, abut::winding_options{.tolerance = 0.1});
///
/// @ingroup queries
template <execution_policy On, class X, class Points, std::same_as<winding_options> Options>
[[nodiscard]] auto signed_distance(const On& on, const X& mesh, const Points& points, const Options& options) {
    const auto turns = winding_number(on, mesh, points, options);
    return detail::with_signs(on, ask_rows(on, detail::ask_nearest<false>{{}, "abut::signed_distance"}, mesh, points), turns);
}

}  // namespace abut
