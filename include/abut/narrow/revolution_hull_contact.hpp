// SPDX-License-Identifier: MIT
#pragma once

// Contacts of a cylinder or a cone and a convex hull: the least move in any direction. A polytope grows in the differences
// of their points, as in hull_contact.hpp. The solid's points are those that were farthest along a way, in double at the
// common scale. Where a face is the nearest, the hull's points there are corners beside which the least move is looked for
// as in revolution_contact.hpp. So it is known to all digits when the corners that matter are found. No move is shorter than
// the way to the nearest face. So it ends where a move is known that is no longer, but for rounding, or with `most_corners`;
// then corners of all faces are looked at that are nearer than that move.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/rolled_int.hpp>
#include <abut/narrow/common_unit.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/hull_contact.hpp>
#include <abut/narrow/hull_distance.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_hull_and_solid.hpp>
#include <abut/narrow/plain_least_move.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/predicate/revolution_hull.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

namespace contact_math {

/// A hull, as seen from some point.
template <scalar T>
struct seen_hull {
    const hull<T>& of;
    const point& origin;
    const common_scale& scale;
    [[nodiscard]] ABUT_HD constexpr double reach(const point& n) const { return greatest_height(of, n, origin, scale); }
};

}  // namespace contact_math

/// Differences of a solid's points and a hull's, as a polytope asks for them.
template <scalar T>
class solid_minus_hull {
public:
    using scalar_type = T;
    using integers = typename nearest_in_hulls<T>::integers;
    using number = typename integers::number;
    using point = contact_math::point;
    using ways = contact_math::ways_out_of_solid<T, contact_math::seen_hull<T>>;

    /// What is offered goes to `found`.
    template <solid_of_revolution S>
    ABUT_HD constexpr solid_minus_hull(const S& s, const hull<T>& h, const contact_math::seen_round_solid& solid,
                                       const point& origin, const contact_math::common_scale& scale, ways& found)
        : points_{origin},
          end_{axis_of(s).a},
          asked_{&end_, 1},
          hull_(h),
          x_(asked_, h, unit_around(s, h)),
          solid_(solid),
          origin_(origin),
          scale_(scale),
          found_(found) {}
    solid_minus_hull(const solid_minus_hull&) = delete;
    solid_minus_hull& operator=(const solid_minus_hull&) = delete;

    [[nodiscard]] ABUT_HD constexpr vec3<number> exactly(std::uint32_t i, std::uint32_t j) const {
        return x_.between(hull_[j], points_[i], scale_.exponent);
    }
    [[nodiscard]] ABUT_HD constexpr point at(std::uint32_t i, std::uint32_t j) const {
        return contact_math::plain_difference(points_[i], scale_(hull_[j]));
    }
    template <int Room>
    ABUT_HD constexpr void look_back(const vec3<rolled_int<Room>>& way, std::uint32_t& i, std::uint32_t& j) {
        using namespace contact_math;
        const rolled_int<3 * 2>* const type = nullptr;
        x_.look_back({held_as(way.x, type), held_as(way.y, type), held_as(way.z, type)}, i, j);
        const point seen = solid_.farthest(unit_vector(as<one_double>(rounded_way(way, -1))));
        i = count_;
        points_[i] = plain_step(origin_, 1, seen);
        if (count_ + 1 < room) ++count_;
    }
    /// The least move that is known, after those beside some points of the hull were looked at.
    [[nodiscard]] ABUT_HD constexpr double depth_beside(points_of_face face) {
        std::uint32_t(&id)[3] = face.id;
        if (id[1] < id[0]) swap(id[0], id[1]);
        if (id[2] < id[1]) swap(id[1], id[2]);
        if (id[1] < id[0]) swap(id[0], id[1]);
        bool is_known = false;
        for (int k = 0; k < known_count_; ++k) {
            const std::uint32_t(&known)[3] = known_[k].id;
            is_known = is_known || (known[0] == id[0] && known[1] == id[1] && known[2] == id[2]);
        }
        if (!is_known) {
            if (known_count_ < most_known) known_[known_count_++] = face;
            const corner_hull<T, 3> corners{{hull_[id[0]], hull_[id[1]], hull_[id[2]]}};
            const contact_math::seen_corners<3> at(corners.at, origin_, scale_);
            found_.offer_corners(corners, at.at);
        }
        return found_.depth();
    }

private:
    static constexpr std::uint32_t room = 64;  ///< more than a polytope of 48 corners asks for
    static constexpr int most_known = 32;      ///< others are looked at again

    ABUT_HD static constexpr void swap(std::uint32_t& a, std::uint32_t& b) {
        const std::uint32_t c = a;
        a = b, b = c;
    }

    /// With two bits for points on the rims.
    template <solid_of_revolution S>
    ABUT_HD static constexpr unit_of_hulls<T> unit_around(const S& s, const hull<T>& h) {
        const corner_hull<T, 2> ends = points_of(axis_of(s));
        unit_of_hulls<T> unit(ends.as_hull(), h, s.radius);
        unit.high += 2;
        unit.low = -(1 << 20);
        return nearest_in_hulls<T>::shortened(unit);
    }

    point points_[room];
    vec3<T> end_;  ///< of the axis: what is asked for as a hull
    hull<T> asked_;
    const hull<T>& hull_;
    integers x_;
    const contact_math::seen_round_solid& solid_;
    point origin_;
    const contact_math::common_scale& scale_;
    ways& found_;
    points_of_face known_[most_known] = {};  ///< in order
    int known_count_ = 0;
    std::uint32_t count_ = 1;
};

/// A solid that has an axis with a length, and a hull.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact_math::least_overlap way_out_of_hull(const S& s, const hull<T>& h,
                                                                            const contact_math::common_scale& scale) {
    using namespace contact_math;
    const point origin = scale(axis_of(s).a);
    const seen_round_solid solid(s, origin, scale);
    const seen_hull<T> seen{h, origin, scale};
    ways_out_of_solid<T, seen_hull<T>> pair(solid, seen);
    pair.offer_ends();
    solid_minus_hull<T> differences(s, h, solid, origin, scale, pair);
    expanding_polytope polytope(differences);
    polytope.append(0, 0);
    pair.offer_both(polytope.least_way());
    return pair.way();
}

/// Of n points whose hull touches something convex that reaches out of it: three, which may be equal, whose triangle touches.
/// They are the ends of a range of points and one of that. hull(first, n) says whether the hull of so many of the points touches,
/// and face(i, j, k) whether a triangle does.
///
/// Let `last` be the first number up to which the points' hull touches, and `first` the last one from which those up to `last` do.
/// Some triangle of theirs touches, and without one of both ends nothing does: so both are corners of it. Two searches by halves
/// find them, by 2 log2 n questions about hulls, and at most n about triangles find the third.
template <class Hull, class Face>
ABUT_HD constexpr points_of_face touching_points(std::size_t n, const Hull& hull, const Face& face) {
    std::size_t last = n - 1, first = 0;
    for (std::size_t below = 0; below < last;) {
        const std::size_t middle = below + (last - below) / 2;
        if (hull(0, middle + 1)) {
            last = middle;
        } else {
            below = middle + 1;
        }
    }
    for (std::size_t above = last; first < above;) {
        const std::size_t middle = above - (above - first) / 2;
        if (hull(middle, last + 1 - middle)) {
            first = middle;
        } else {
            above = middle - 1;
        }
    }
    std::size_t amid = first;
    while (amid < last && !face(first, amid, last)) ++amid;
    return {{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(amid), static_cast<std::uint32_t>(last)}};
}

/// Of a hull that a solid touches, but not its axis, a triangle of points that the solid touches: one of those at which a
/// search ends; or where rounding leaves that open, of `touching_points`.
template <solid_of_revolution S, scalar T>
ABUT_NOINLINE ABUT_HD constexpr triangle<T> touching_triangle_of(const S& s, const hull<T>& h) {
    using namespace contact_math;
    const common_scale scale(s, h);
    const point origin = scale(axis_of(s).a);
    const seen_round_solid solid(s, origin, scale);
    typename plain_hull_and_solid<T>::places asked;
    const plain_hull_and_solid<T> x(h, solid, origin, scale, asked);
    const difference_simplex at = x.search();
    const int faces = at.count == 4 ? 4 : 1;
    for (int but = 0; but < faces; ++but) {
        const triangle<T> t = face_without(h, at, faces == 4 ? but : 3);
        if (touch_exactly(s, t)) return t;
    }
    const aabb<T> around = bounds(s);
    const auto of = [&](std::size_t i, std::size_t j, std::size_t k) { return triangle<T>{h[i], h[j], h[k]}; };
    const points_of_face found = touching_points(
        h.count, [&](std::size_t first, std::size_t n) { return touch_exactly(s, h.part(first, n)); },
        [&](std::size_t i, std::size_t j, std::size_t k) {
            const triangle<T> t = of(i, j, k);
            return overlaps(around, bounds(t)) && touch_exactly(s, t);
        });
    return of(found.id[0], found.id[1], found.id[2]);
}

/// A point of both, which touch. The solid has an axis with a length.
template <solid_of_revolution S, scalar T>
ABUT_HD constexpr vec3<T> shared_point_of(const S& s, const hull<T>& h) {
    const segment<T> axis = axis_of(s);
    if (!touch_exactly(h, axis)) return shared_point_of(s, touching_triangle_of(s, h));
    return with_measured_hulls(h, axis, true, [](const auto& m) { return m.shared_point(); });
}

/// As of hulls, whether they touch or not.
template <solid_of_revolution S, scalar T>
requires std::same_as<T, scalar_type_of<S>> ABUT_HD constexpr contact_in_doubles<T> search_contact(const S& s, const hull<T>& h) {
    return is_point(axis_of(s)) ? contact_in_doubles<T>{} : find_contact_in_doubles(s, h, true);
}

/// The normal points to the solid.
template <solid_of_revolution S, scalar T>
requires std::same_as<T, scalar_type_of<S>> ABUT_HD constexpr contact<T> contact_between(const S& s, const hull<T>& h) {
    if (is_point(axis_of(s))) return contact_with_ball(ball_around(s), h);
    const contact_math::common_scale scale(s, h);
    if (const auto known = find_contact_in_doubles(s, h); known.is_known) return known.found;
    contact<T> found = contact_math::assembled<T>(scale, {0, 0, 0}, way_out_of_hull(s, h, scale));
    found.point = shared_point_of(s, h);
    return found;
}

}  // namespace abut::detail
