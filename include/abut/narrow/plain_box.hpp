// SPDX-License-Identifier: MIT
#pragma once

// The first stage of distances and contacts between a box under a pose and a point or a sphere, as plain_ways.hpp is of
// other pairs: of hulls of eight points in the order of a box's corners, which rounding may leave somewhat askew. In the
// frame of three edges the feature that is nearest to the centre is plain; the way from it is measured between the corners
// themselves; and no corner lies ahead of the feature along the way, or the answer is left to hull_distance.hpp and
// hull_contact.hpp. Not for hulls that are no boxes.
//
// A face's four corners need not lie in one plane: of both ways to divide it in triangles the one is taken that has all
// corners behind it, and the foot inside but for 2^-45 of it. A corner may be ahead by 2u size, where `size` is the sum of
// magnitudes of the centre and the edges as they are seen from the first corner, and of the radius, below 8D. So the
// distance is within 16uD of that of the feature, and within 30uD of the true one, with the roundings that plain_ways.hpp
// counts.

#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/narrow/round_contact.hpp>
#include <abut/predicate/certified_corner_box.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>

namespace abut::detail {

/// Of a box and a point beside it, where the box is nearest to that, on a feature of it. `Box` knows the corners:
///   part_of(k)         how far the way from the feature's first corner leads along its edge k
///   has_all_behind(i)  whether no corner lies farther `ahead` than corner i, but for rounding
template <scalar T>
struct plain_box_feature {
    plain_place<T> nearest{};
    vec3<double> way{}, ahead{};  ///< from there to the point; of any length, along it, but orthogonal to an edge or a face
    double size = 0;
    bool is_good = false;

    /// From the feature of a corner and those that are free edges, the bits of `free`, away from it.
    template <class Box, class Corner>
    ABUT_INLINE ABUT_HD constexpr void look(Box& box, const Corner& corner_at, const vec3<T>& center, int corner, int free) {
        using contact_math::plain_difference;
        using contact_math::plain_dot;
        const int one = free & -free, other = free - one;
        nearest.from = corner_at(corner);
        way = ahead = plain_way_to(nearest.from, center);
        if (free == 0) {
            is_good = box.has_all_behind(corner);
        } else if (other == 0) {
            const vec3<double> edge = plain_way_to(nearest.from, corner_at(corner + free));
            const double per_square = 1 / plain_dot(edge, edge);
            const double part = into_unit_of_doubles(plain_product(plain_dot(way, edge), per_square));
            nearest.along = plain_times(part, edge);
            way = ahead = plain_step(way, -part, edge);
            // At an end of the edge the way is not orthogonal to that, of hulls that are no boxes.
            if (part > 0 && part < 1) ahead = plain_step(way, -plain_product(plain_dot(way, edge), per_square), edge);
            is_good = box.has_all_behind(corner);
        } else {
            // A triangle of one of the face's corners and both beside it, or the other one.
            const double x = box.part_of(one), y = box.part_of(other);
            int from = x < y ? corner + other : corner + one;
            for (int tried = 0; tried < 2 && !is_good; ++tried, from = plain_sum(x, y) <= 1 ? corner : corner + free) {
                nearest.from = corner_at(from);
                const vec3<double> u = plain_way_to(nearest.from, corner_at(from ^ one)),
                                   v = plain_way_to(nearest.from, corner_at(from ^ other)), n = plain_cross(u, v),
                                   seen = plain_way_to(nearest.from, center);
                const double height = plain_dot(n, seen), square = plain_dot(n, n);
                const double of_u = plain_dot(n, plain_cross(seen, v)), of_v = plain_dot(n, plain_cross(u, seen));
                if (!(least(of_u, of_v, plain_sum(square, -plain_sum(of_u, of_v))) >= -0x1p-45 * square)) continue;
                way = plain_times(height / square, n);
                ahead = height < 0 ? contact_math::negated(n) : n;
                nearest.along = plain_difference(seen, way);
                is_good = box.has_all_behind(from);
            }
        }
        is_good = is_good && plain_dot(way, way) > 0x1p-40 * plain_product(size, size);
    }
    /// Whether what lies beyond, times the length of `ahead`, is no more than rounding of shapes of that size.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr bool is_rounding(double beyond, double of_size) const {
        const double slack = 0x1p-52 * of_size;
        return beyond <= 0 || beyond * beyond <= slack * slack * contact_math::plain_dot(ahead, ahead);
    }
};

/// How far corners, as they are seen from the first one, are from sums of edges.
ABUT_INLINE ABUT_HD constexpr double off_from_edges(const vec3<double> (&q)[8]) {
    double off = 0;
    for (int i = 3; i < 8; ++i) {
        if (i == 4) continue;
        vec3<double> sum{0, 0, 0};
        for (int k = 1; k < 8; k *= 2) {
            if ((i & k) != 0) sum = plain_step(sum, 1, q[k]);
        }
        off = greatest(off, plain_magnitudes(contact_math::plain_difference(q[i], sum)));
    }
    return off;
}
/// The most that it may be.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr double most_off(T magnitude) {
    return 8 * static_cast<double>(unit_roundoff<T>) * static_cast<double>(magnitude);
}
/// The normal of the faces across edge k, 0 to 2: along that edge, or of the second one against it.
template <scalar T>
ABUT_INLINE ABUT_HD constexpr vec3<double> normal_across(const vec3<double> (&q)[8], int k) {
    using namespace contact_math;
    const point v = plain_cross(q[k == 0 ? 2 : 1], q[k == 2 ? 2 : 4]);
    return plain_normal<T>(plain_times(1 / root(one_double{plain_dot(v, v)}).high, v));
}

/// The corners of a box and a point, as they are seen from the first corner.
template <scalar T>
struct plain_corner_box : plain_box_feature<T> {
    using plain_box_feature<T>::size;
    vec3<double> q[8]{}, p{};
    double off = 0;  ///< how far corners are from sums of edges
    bool is_inside = false;

    plain_corner_box() = default;
    ABUT_NOINLINE ABUT_HD constexpr plain_corner_box(const vec3<T>* h, const vec3<T>& center, double radius)
        : p(plain_way_to(h[0], center)) {
        using contact_math::plain_difference;
        using contact_math::plain_dot;
        size = plain_step_from(-radius, plain_magnitudes(p));
        for (int i = 1; i < 8; ++i) q[i] = plain_way_to(h[0], h[i]);
        for (int k = 1; k < 8; k *= 2) size = plain_sum(size, plain_magnitudes(q[k]));
        if (!are_plain_sizes<T>(size)) return;
        const double all = plain_product(size, size);
        int corner = 0, free = 0;
        bool are_edges = true;
        for (int k = 1; k < 8; k *= 2) {
            const double square = plain_dot(q[k], q[k]), along = plain_dot(q[k], p);
            are_edges = are_edges && square > 0x1p-60 * all;
            // Without branches, which nobody can predict.
            const int is_beyond = along >= square ? 1 : 0, is_amid = (along > 0 ? 1 : 0) - is_beyond;
            corner += k * is_beyond;
            free += k * is_amid;
        }
        if (!are_edges) return;
        if (free != 7) {
            this->look(*this, [&](int i) -> const vec3<T>& { return h[i]; }, center, corner, free);
            return;
        }
        is_inside = true;
        off = off_from_edges(q);
    }
    /// How far a corner lies along n.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double farthest(const vec3<double>& n) const {
        double most = 0;
        for (int i = 1; i < 8; ++i) most = greatest(most, contact_math::plain_dot(n, q[i]));
        return most;
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double part_of(int k) const {
        return contact_math::plain_dot(this->way, q[k]) / contact_math::plain_dot(q[k], q[k]);
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr bool has_all_behind(int i) const {
        return this->is_rounding(plain_sum(farthest(this->ahead), -contact_math::plain_dot(this->ahead, q[i])), size);
    }
};

/// A hull, and a point or a sphere.
template <scalar T, class U>
    requires(corners_of_core<U> == 1 && std::same_as<scalar_type_of<U>, T>)
struct plain_pair<hull<T>, U> : plain_gap {
    plain_corner_box<T> box;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const hull<T>& s, const U& t)
        : plain_gap{0, static_cast<double>(radius_around_core(t))},
          box(s.count != 8 ? plain_corner_box<T>() : with_eight_points(s, [&](const vec3<T>* h) {
              return plain_corner_box<T>(h, core_of(t).at[0], radius_b);
          })) {
        size = box.size, is_good = box.is_good;
        if (is_good) length = contact_math::root(contact_math::one_double{contact_math::plain_dot(box.way, box.way)}).high;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return box.way; }
    [[nodiscard]] ABUT_HD constexpr const plain_place<T>& on_a(const hull<T>&) const { return box.nearest; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const { return {core_of(t).at[0]}; }
};

/// The contact of a sphere that touches a box and has its centre beside it, along the way from the feature, if is_small(excess)
/// says that its depth is the least. overlap(n) is that along -n.
template <scalar T, class S, class U, class Overlap, class IsSmall>
ABUT_INLINE ABUT_HD constexpr first_contact<T> contact_of_feature(const plain_pair<S, U>& both, const Overlap& overlap,
                                                                  const IsSmall& is_small) {
    using namespace contact_math;
    const auto& box = both.box;
    const point n = plain_normal<T>(plain_times(1 / root(one_double{plain_dot(box.ahead, box.ahead)}).high, box.ahead));
    const double depth = overlap(n), excess = plain_sum(depth, -plain_sum(both.radius_b, -both.length));
    if (!is_small(excess)) return {};
    return {verdict::yes, plain_contact(box.nearest.at(0, n), negated(n), depth)};
}

/// As of a box and a sphere (box_contact.hpp). A centre inside leaves along one of three normals, each the product of two
/// edges. Corners that are off by a few roundings of themselves move overlaps by as much, which contact_bound covers.
template <scalar T, class U>
    requires has_plain_pair<hull<T>, U>
ABUT_INLINE ABUT_HD constexpr first_contact<T> first_contact_of(const hull<T>& s, const U& t,
                                                                  const plain_pair<hull<T>, U>& both) {
    using namespace contact_math;
    first_contact<T> answer{both.touch()};
    if (answer.touch == verdict::no) return answer;
    const auto& box = both.box;
    const double radius = both.radius_b;
    const auto overlap = [&](const point& n) {
        return plain_sum(plain_sum(radius, -plain_dot(n, box.p)), box.farthest(n));
    };
    if (answer.touch == verdict::yes)
        return contact_of_feature<T>(both, overlap, [&](double excess) { return is_tolerable(excess, box.size / 25, s, t); });
    if (box.is_inside && box.off <= most_off(greatest(magnitude_of(s), magnitude_of(t)))) {
        const double sure = plain_sum(radius, plain_sum(4 * box.off, 0x1p-44 * box.size));
        least_overlap way;
        for (int k = 0; k < 3; ++k) {
            const point n = normal_across<T>(box.q, k);
            const extent over = extent_of(box.q, n, point{0, 0, 0});
            const double amid = plain_dot(n, box.p), ahead = plain_sum(plain_sum(radius, -amid), over.upper),
                         behind = plain_sum(plain_sum(radius, amid), -over.lower);
            if (!(ahead > sure && behind > sure)) return answer;
            way.offer(negated(n), ahead);
            way.offer(n, behind);
        }
        answer = {verdict::yes, plain_contact(core_of(t).at[0], way.normal, way.depth)};
    }
    return answer;
}

}  // namespace abut::detail
