// SPDX-License-Identifier: MIT
#pragma once

// penetration: how deep two solids are in each other, and a move that separates them, between proven bounds. The deepest points
// are found by the search in farthest_point.hpp. A move that separates is found by trying directions, each of which is bisected:
// whatever comes out was tested. What no move can be below is proven by the deepest points: a point of one solid that is so deep
// in the other has to come out. By a rule a face may bound nothing; then a point beside it is looked for that is in the solid.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/distance.hpp>
#include <abut/collide/executor.hpp>
#include <abut/collide/farthest_point.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/relation.hpp>
#include <abut/collide/solid_entries.hpp>
#include <abut/collide/solid_regions.hpp>
#include <abut/execution/disjoint_sets.hpp>

namespace abut {

/// @addtogroup solids
///@{

/// Options of `penetration`.
struct penetration_options {
    /// As of `relation`.
    flag known_solid = false;
    /// As of `hausdorff`.
    double tolerance = 0;
    /// As of `hausdorff`.
    std::uint64_t most_pieces = std::uint64_t{1} << 20;
    /// As of `relation`. Depths are measured from all faces then, those within a solid too.
    std::optional<inside_rule> rule{};
};

/// How deep two solids are in each other.
template <scalar T>
struct penetration_bounds {
    bool overlap = false;     ///< whether interiors meet; if not, all else is 0
    farthest_point a_in_b{};  ///< the deepest point of a's surface in b: how far it is from b's surface
    farthest_point b_in_a{};  ///< the deepest point of b's surface in a
    vec3<T> move{0, 0, 0};    ///< a moved by this is apart from b: tested
    double least = 0;         ///< proven: any move that separates them is at least so long
    double most = 0;          ///< the length of `move`, rounded up: the least move is no longer

    friend constexpr bool operator==(const penetration_bounds&, const penetration_bounds&) = default;
};

/// Two bodies whose interiors meet, and how deep they are in each other.
template <scalar T>
struct body_penetration {
    std::uint32_t body_a;          ///< position of the first body
    std::uint32_t body_b;          ///< position of the second one, which is higher
    penetration_bounds<T> bounds;  ///< `move` is that of body_a

    friend constexpr bool operator==(const body_penetration&, const body_penetration&) = default;
};

///@}

namespace detail {

/// Looks for a short move of a that takes it out of b.
template <class Policy, scalar T>
class separating_move {
public:
    separating_move(const Policy& on, const std::vector<triangle<T>>& a, const std::vector<triangle<T>>& b,
                    std::vector<vec3<T>> of_parts_a, std::vector<vec3<T>> of_parts_b, const unit_of_search& unit, inside_rule rule)
        : on_(on), a_(a), b_(b), of_parts_a_(std::move(of_parts_a)), of_parts_b_(std::move(of_parts_b)), unit_(unit), rule_(rule),
          tree_a_(make_bvh(on, copy_to(on, triangle_soup<T>(a)))), tree_b_(make_bvh(on, copy_to(on, triangle_soup<T>(b)))) {}

    /// Along a direction: nothing comes of it that is not shorter than what was found before. `least` is below any move, and
    /// moves are told apart by `tolerance`, both in the unit of the search.
    bool try_along(const vec3<double>& direction, double least, double tolerance) {
        const double size = length_of(direction);
        if (!(size > 0) || !(size < infinity<double>)) return false;
        const vec3<double> u{direction.x / size, direction.y / size, direction.z / size};
        double apart = reach(b_, u) + reach(a_, {-u.x, -u.y, -u.z}) + room;
        if (is_found_) apart = std::min(apart, length_ * (1 - 0x1p-7));
        // Short moves first: out of a dent they lead, and somewhat longer ones may lead into the other solid again.
        double within = least;
        bool is_known = false;
        for (double length = 1.125 * std::max(least, tolerance); !is_known && length < apart; length *= 2) {
            is_known = is_free(along(u, length));
            (is_known ? apart : within) = length;
        }
        for (int k = 0; !is_known && !is_free(along(u, apart)); ++k) {
            if (is_found_ || k == 40) return false;
            apart += std::ldexp(room, k);
        }
        for (int k = 0; k < 40 && apart - within > tolerance; ++k) {
            const double middle = 0.5 * (within + apart);
            (is_free(along(u, middle)) ? apart : within) = middle;
        }
        is_found_ = true;
        move_ = along(u, apart);
        length_ = length_of(unit_.bring(widened(move_))) * (1 + 0x1p-50);
        return true;
    }
    /// The same along the normals of those two faces that are nearest to each other after the best move so far, and across an
    /// edge of each.
    bool improve(double least, double tolerance) {
        const auto near = distance(on_, posed(tree_a_, pose_of(move_)), tree_b_);
        if (!near) return false;
        std::array<std::array<vec3<double>, 3>, 2> sides;
        for (std::size_t k = 0; k < 2; ++k) {
            const triangle<T>& t = k == 0 ? a_[near->a] : b_[near->b];
            const vec3<double> p = unit_.bring(widened(t.a)), q = unit_.bring(widened(t.b)), r = unit_.bring(widened(t.c));
            sides[k] = {q - p, r - q, p - r};
        }
        std::vector<vec3<double>> ways{cross(sides[1][0], sides[1][1]), cross(sides[0][0], sides[0][1])};
        for (const vec3<double>& u : sides[0]) {
            for (const vec3<double>& v : sides[1]) ways.push_back(cross(u, v));
        }
        bool better = false;
        for (const vec3<double>& n : ways) better |= try_along(dot(n, unit_.bring(widened(move_))) < 0 ? vec3<double>{-n.x, -n.y, -n.z} : n, least, tolerance);
        return better;
    }
    [[nodiscard]] const vec3<T>& move() const { return move_; }
    [[nodiscard]] double length() const { return length_; }

private:
    /// For roundings of placed points, in the unit of the search.
    static constexpr double room = std::same_as<T, float> ? 0x1p-21 : 0x1p-48;

    static rigid<T> pose_of(const vec3<T>& move) {
        rigid<T> pose;
        pose.translation = move;
        return pose;
    }
    [[nodiscard]] vec3<T> along(const vec3<double>& u, double length) const {
        const vec3<double> v = unit_.back(length * u);
        return {rounded(static_cast<T>(v.x)), rounded(static_cast<T>(v.y)), rounded(static_cast<T>(v.z))};
    }
    [[nodiscard]] double reach(const std::vector<triangle<T>>& faces, const vec3<double>& u) const {
        double most = -infinity<double>;
        for (const triangle<T>& t : faces) {
            const vec3<T> corners[] = {t.a, t.b, t.c};
            for (const vec3<T>& p : corners) most = std::max(most, dot(u, unit_.bring(widened(p))));
        }
        return most;
    }
    template <class X>
    bool has_inside(const X& x, const std::vector<vec3<T>>& points) const {
        const std::vector<bool> are = are_inside(on_, x, points, "abut::penetration", rule_);
        return std::find(are.begin(), are.end(), true) != are.end();
    }
    /// Whether nothing touches, and no part of a surface is in the other solid.
    [[nodiscard]] bool is_free(const vec3<T>& move) const {
        const auto moved = posed(tree_a_, pose_of(move));
        if (any(on_, moved, tree_b_)) return false;
        std::vector<vec3<T>> of_a;
        for (const vec3<T>& p : of_parts_a_) of_a.push_back(place(moved.pose, p));
        return !has_inside(tree_b_, of_a) && !has_inside(moved, of_parts_b_);
    }

    using tree_type = decltype(make_bvh(std::declval<const Policy&>(), copy_to(std::declval<const Policy&>(), triangle_soup<T>())));
    const Policy& on_;
    const std::vector<triangle<T>>&a_, &b_;
    std::vector<vec3<T>> of_parts_a_, of_parts_b_;
    const unit_of_search& unit_;
    inside_rule rule_;
    tree_type tree_a_, tree_b_;
    bool is_found_ = false;
    vec3<T> move_{0, 0, 0};
    double length_ = infinity<double>;
};

/// A vertex of each part of a surface: of all faces that share vertices.
template <scalar T>
std::vector<vec3<T>> vertices_of_parts(const std::vector<mesh_face<T>>& faces) {
    std::uint32_t numbers = 0;
    for (const auto& f : faces) numbers = std::max({numbers, f.vertex[0] + 1, f.vertex[1] + 1, f.vertex[2] + 1});
    id_buffer<serial> parents(serial{}, numbers);
    const execution::disjoint_sets parts = execution::make_disjoint_sets(serial{}, parents);
    for (const auto& f : faces) parts.unite(f.vertex[0], f.vertex[1]), parts.unite(f.vertex[0], f.vertex[2]);
    std::vector<char> is_known(numbers, 0);
    std::vector<vec3<T>> vertices;
    for (const auto& f : faces) {
        if (std::exchange(is_known[parts.root(f.vertex[0])], 1) == 0) vertices.push_back(f.corners.a);
    }
    return vertices;
}
/// What no move can be below by a deepest point, in the unit of the search. By a rule a point of the solid has to be near it:
/// a step into its face, and by less to one side of it.
template <class Policy>
double depth_to_leave(const measured_surface<Policy>& of, const farthest_point& deepest, bool by_rule) {
    if (!by_rule || deepest.face == no_id) return deepest.lower;
    constexpr double step = 0x1p-30;
    const triangle<double>& t = of.face(deepest.face);
    const vec3<double> in = 0.5 * (0.5 * (t.a + t.b) + t.c) - deepest.point, up = cross(t.b - t.a, t.c - t.a);
    const double in_size = length_of(in), up_size = length_of(up);
    if (!(up_size > 0x1p-80)) return 0;
    const vec3<double> beside = deepest.point + (in_size > step ? step / in_size : 0) * in, aside = (step * 0x1p-8 / up_size) * up;
    const std::vector<bool> is = of.have_inside({beside + aside, beside - aside});
    return is[0] || is[1] ? std::max(0.0, deepest.lower - 2 * step) : 0;
}
/// Of two whose interiors meet.
template <class Policy, scalar T>
penetration_bounds<T> bounds_of_overlap(const Policy& on, const std::vector<mesh_face<T>>& faces_a, const std::vector<mesh_face<T>>& faces_b,
                                        const penetration_options& options) {
    const std::vector<triangle<T>> of_a = triangles_of_faces(faces_a), of_b = triangles_of_faces(faces_b);
    const inside_rule rule = options.rule.value_or(inside_rule::parity);
    penetration_bounds<T> found;
    found.overlap = true;
    unit_of_search unit;
    unit.see(of_a);
    unit.see(of_b);
    const double tolerance = unit.tolerance(options.tolerance);
    const measured_surface<Policy> x(on, unit.bring(of_a), rule), y(on, unit.bring(of_b), rule);
    const farthest_point deepest_a = farthest_search<Policy>(x, y, true).run(tolerance, options.most_pieces),
                         deepest_b = farthest_search<Policy>(y, x, true).run(tolerance, options.most_pieces);
    const double least = std::max(depth_to_leave(x, deepest_a, options.rule.has_value()), depth_to_leave(y, deepest_b, options.rule.has_value()));
    separating_move<Policy, T> move(on, of_a, of_b, vertices_of_parts(faces_a), vertices_of_parts(faces_b), unit, rule);
    std::vector<vec3<double>> ways{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const auto middle = [&](const std::vector<triangle<T>>& of) {
        aabb<T> box = empty_box<T>();
        for (const triangle<T>& t : of) box = merge(box, bounds(t));
        return 0.5 * (unit.bring(widened(box.lower)) + unit.bring(widened(box.upper)));
    };
    ways.push_back(middle(of_a) - middle(of_b));
    if (deepest_a.face != no_id) ways.push_back(deepest_a.nearest - deepest_a.point);
    if (deepest_b.face != no_id) ways.push_back(deepest_b.point - deepest_b.nearest);
    for (const vec3<double>& way : ways) move.try_along(way, least, tolerance);
    for (int k = 0; k < 16 && move.improve(least, tolerance); ++k) {
    }
    found.a_in_b = unit.back(deepest_a);
    found.b_in_a = unit.back(deepest_b);
    found.move = move.move();
    found.least = unit.length_back(least);
    found.most = unit.length_back(move.length());
    return found;
}

/// Those of lists and scenes (solid_entries.hpp).
struct penetration_of_entries {
    static constexpr const char* function = "abut::penetration";
    template <scalar T>
    using answer = penetration_bounds<T>;
    template <scalar T>
    using told = body_penetration<T>;
    penetration_options options;

    template <class Entries>
    [[nodiscard]] auto find(Entries& entries) const {
        using T = typename Entries::T;
        unit_of_search::check_tolerance(options.tolerance, function);
        const solid_options known{.known_solid = options.known_solid, .rule = options.rule};
        const auto regions = entries.template regions<filtered>(known, false, [](const common_regions& all) { return all.both; });
        std::vector<penetration_bounds<T>> found(entries.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!regions[i].found.both) continue;
            found[i] = bounds_of_overlap<std::remove_cvref_t<decltype(entries.policy())>, T>(
                entries.policy(), entries.a().faces(entries[i].a).first, entries.b().faces(entries[i].b).first, options);
        }
        return found;
    }
    template <scalar T>
    static bool is_told(const penetration_bounds<T>& of) {
        return of.overlap;
    }
    template <scalar T>
    static body_penetration<T> tell(const index_pair& of, const penetration_bounds<T>& bounds) {
        return {of.a, of.b, bounds};
    }
};

}  // namespace detail

/// @addtogroup solids
///@{

/// How deep two solids are in each other, and a move that takes `a` out of `b`.
///
/// - The deepest point of a's surface in b, and of b's in a: of each the distance from the other surface, between bounds that
///   differ by `options.tolerance` or less unless `options.most_pieces` were looked at. Where no point of one surface is found in
///   the other solid, `face` is no_id.
/// - `move`: after it nothing touches, and neither solid is in the other. That was tested, of a placed first and moved then.
///   `most` is its length. `least` is proven: the depth of the deepest point. These two may differ by more than the tolerance: to
///   find the least move of solids with dents is as hard as to find their Minkowski sum. Directions that are tried are the axes,
///   between the middles, out by the deepest points, and normals of faces that come nearest.
///
/// By `options.rule` the deepest points are of all faces, how far from all faces of the other one, also of those that lie within a
/// solid or bound nothing. `least` is proven all the same, and the lesser for it: of a deepest point beside which the solid is not
/// found nothing comes. After `move` no faces touch at all.
///
/// `a` and `b` are what `relation` takes but for spheres and capsules, and are refused as there. The same bits on every policy and number of threads. Memory
/// and time as of `hausdorff`; besides, some hundred queries of whether both touch. Returns when all is known; under `cuda` it
/// waits for the policy's stream. Throws as `relation` and `hausdorff` do.
///
///     const auto d = abut::penetration(on, part, other);
///     if (d.overlap) std::printf("between %g and %g\n", d.least, d.most);
template <execution_policy Policy, class X, class Y>
[[nodiscard]] auto penetration(const Policy& on, const X& a, const Y& b, const penetration_options& options = {}) {
    constexpr const char* function = "abut::penetration";
    if constexpr (detail::is_polytope<X> || detail::is_polytope<Y>) {
        return penetration(on, detail::as_solid(on, a, function), detail::as_solid(on, b, function), options);
    } else if constexpr (detail::are_solids<X, Y>()) {
        using T = detail::scalar_of_argument<X>;
        detail::unit_of_search::check_tolerance(options.tolerance, function);
        detail::faces_of_solids<T> faces(detail::faces_on_host(on, detail::make_operand(on, a, function)),
                                      detail::faces_on_host(on, detail::make_operand(on, b, function)));
        const solid_options known{.known_solid = options.known_solid, .rule = options.rule};
        const detail::solids_by_policy<Policy, X, Y> solids(on, a, b, function, &faces);
        if (!detail::common_interior<filtered>(function, known).find(solids).found.both) return penetration_bounds<T>();
        return detail::bounds_of_overlap<Policy, T>(on, faces.first, faces.second, options);
    }
}

/// The same of each entry of a list, in its order: a std::vector of `penetration_bounds` in host memory. Which entries overlap is
/// asked of all in one go; the others are searched one after another. Lists are those of `relation`. Of several devices each has its
/// share, and a rank gets those of its own entries.
template <executor On, detail::list_of_pairs List>
[[nodiscard]] auto penetration(const On& on, const List& list, const penetration_options& options = {}) {
    return detail::answers_of_solids(on, detail::penetration_of_entries{options}, list);
}

/// The same of all bodies of a scene: a std::vector of `body_penetration` in host memory, of all two whose interiors meet, sorted by
/// body_a, then body_b. Scenes and `which` are those of `relation`.
///
///     for (const auto& [a, b, depth] : abut::penetration(on, scene)) use(a, b, depth.least);
template <executor On, detail::scene_of_bodies Scene, class Which = body_options<>>
    requires(detail::are_body_options<Which>)
[[nodiscard]] auto penetration(const On& on, const Scene& scene, const penetration_options& options = {}, const Which& which = {}) {
    return detail::told_of_solids(on, detail::penetration_of_entries{options}, scene, which);
}

///@}

}  // namespace abut
