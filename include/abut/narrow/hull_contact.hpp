// SPDX-License-Identifier: MIT
#pragma once

// Contacts of convex hulls, with each other and with shapes around a core of points. A hull a moved by more than the overlap
// along n, max n.q - min n.p over points q of b and p of a, is apart from b; the contact's normal is the unit vector n of
// the least overlap. That is the way from the origin to the nearest point of the boundary of all differences a - b. It is
// found as by G. van den Bergen (Proximity queries and penetration depth computation on 3D game objects, 2001): a polytope
// of differences grows where its nearest face is, until that is a face of all differences.
//
// Which faces a new corner sees is decided exactly: in doubles, where the answer is sure, and else in integers. So the
// polytope is convex and closed at any time, whatever is thin or flat, and nothing needs a tolerance. Faces that lie in one
// plane are as they come: only what is strictly behind a face is seen from there. Normals are rounded from integers too. The
// origin may be outside of the polytope: a face that it is beyond has a negative distance, and grows first.
//
// It ends: each step adds a corner of the hull of all differences. It ends early, at `most_corners`, so that a device knows
// the room. The least overlap of the directions that were tried is then what is taken: a depth that separates all the same.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/hull_distance.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_depth.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Points of the second shape at the corners of a polytope's face.
struct points_of_face {
    std::uint32_t id[3];
};

/// Differences of two hulls' points, as a polytope asks for them.
template <scalar T>
class hull_minus_hull {
public:
    using scalar_type = T;
    using integers = typename nearest_in_hulls<T>::integers;
    using number = typename integers::number;

    ABUT_HD constexpr hull_minus_hull(const hull<T>& a, const hull<T>& b, const integers& x,
                                      const contact_math::common_scale& scale)
        : a_(a), b_(b), x_(x), scale_(scale) {}

    [[nodiscard]] ABUT_HD constexpr vec3<number> exactly(std::uint32_t i, std::uint32_t j) const {
        return x_.difference(i, j);
    }
    /// At the common scale.
    [[nodiscard]] ABUT_HD constexpr contact_math::point at(std::uint32_t i, std::uint32_t j) const {
        return contact_math::plain_difference(scale_(a_[i]), scale_(b_[j]));
    }
    /// The difference that lies farthest back along a way.
    template <int Room>
    ABUT_HD constexpr void look_back(const vec3<rolled_int<Room>>& way, std::uint32_t& i, std::uint32_t& j) const {
        const rolled_int<3 * 2>* const type = nullptr;
        x_.look_back({held_as(way.x, type), held_as(way.y, type), held_as(way.z, type)}, i, j);
    }
    /// A face is all that there is to know.
    [[nodiscard]] ABUT_HD static constexpr double depth_beside(const points_of_face&) { return infinity<double>; }

private:
    const hull<T>&a_, &b_;
    const integers& x_;
    const contact_math::common_scale& scale_;
};

/// The polytope that grows in the differences of two shapes. It takes some 4 KiB, and no other memory.
template <class Differences>
class expanding_polytope {
public:
    using number = typename Differences::number;
    using point = contact_math::point;

    /// Corners of the polytope; a closed polytope of triangles with n corners has 2n - 4 of them.
    static constexpr int most_corners = 48, most_faces = 2 * most_corners - 4;

    ABUT_HD constexpr explicit expanding_polytope(Differences& of) : of_(of) {}

    /// Begins with a difference, or up to four that are affinely independent.
    ABUT_HD constexpr void append(std::uint32_t i, std::uint32_t j) {
        of_a_[corners_] = i;
        of_b_[corners_] = j;
        ++corners_;
        largest_ = greatest(largest_, magnitudes(at(corners_ - 1)));
    }

    /// The unit vector of the least overlap, within 2^-50 in each coordinate.
    [[nodiscard]] ABUT_HD constexpr point least_way() {
        complete();
        if (corners_ < 4) (void)of_.depth_beside({of_b_[0], of_b_[corners_ > 1 ? 1 : 0], of_b_[corners_ > 2 ? 2 : 0]});
        if (corners_ == 1) return {0, 0, 1};
        if (corners_ == 2) {
            return contact_math::any_orthogonal(
                contact_math::as<contact_math::two_doubles>(rounded_way(exactly(1) - exactly(0), 1)));
        }
        if (corners_ == 3) return contact_math::unit_of(inward(0, 1, 2));
        raise();
        grow();
        return best_.normal;
    }

private:
    struct face {
        point normal;            ///< a unit vector, inwards
        double distance;         ///< of the origin, inwards
        std::uint8_t corner[3];  ///< counterclockwise, as seen from outside
        std::uint8_t across[3];  ///< the face beyond the edge from this corner to the next
        std::uint8_t is_seen;    ///< 1 if from the new corner, 2 if not, 0 where that was not asked
    };

    [[nodiscard]] ABUT_HD constexpr point at(int k) const { return of_.at(of_a_[k], of_b_[k]); }
    [[nodiscard]] ABUT_HD constexpr vec3<number> exactly(int k) const { return of_.exactly(of_a_[k], of_b_[k]); }
    /// Orthogonal to a face whose corners are counterclockwise as seen from outside.
    [[nodiscard]] ABUT_HD constexpr auto inward(int p, int q, int r) const {
        const vec3<number> from = exactly(p);
        return cross(exactly(r) - from, exactly(q) - from);
    }

    /// Appends the difference that lies farthest back along a way, if it lies behind the first corner.
    template <int Room>
    ABUT_HD constexpr bool append_behind(const vec3<rolled_int<Room>>& way) {
        std::uint32_t i = 0, j = 0;
        of_.look_back(way, i, j);
        if (sign_of_dot(way, of_.exactly(i, j) - exactly(0)) >= 0) return false;
        append(i, j);
        return true;
    }
    /// Of the three axes, or what `v` is crossed with.
    [[nodiscard]] ABUT_HD static constexpr vec3<number> axis(int k, int sense) {
        vec3<number> v;
        v.x.begin(1), v.y.begin(1), v.z.begin(1);
        (k == 0 ? v.x : k == 1 ? v.y : v.z).limb[0] = sense > 0 ? 1 : ~std::uint64_t{0};
        return v;
    }
    /// Appends corners up to four that are affinely independent, or as many as there are.
    ABUT_NOINLINE ABUT_HD constexpr void complete() {
        for (int k = 0; k < 6 && corners_ == 1; ++k) append_behind(axis(k / 2, k % 2 == 0 ? 1 : -1));
        // All that is orthogonal to a line is spanned by the products with the axes.
        for (int k = 0; k < 6 && corners_ == 2; ++k) {
            append_behind(cross(axis(k / 2, k % 2 == 0 ? 1 : -1), exactly(1) - exactly(0)));
        }
        if (corners_ == 3 && !append_behind(inward(0, 1, 2))) append_behind(inward(0, 2, 1));
    }

    /// The first four corners, of a volume, as a polytope.
    ABUT_HD constexpr void raise() {
        // The fourth is inside of the first face, as seen from outside of that.
        if (sign_of_dot(inward(0, 1, 2), exactly(3) - exactly(0)) < 0) {
            const std::uint32_t i = of_a_[1], j = of_b_[1];
            of_a_[1] = of_a_[2], of_b_[1] = of_b_[2];
            of_a_[2] = i, of_b_[2] = j;
        }
        constexpr std::uint8_t corner[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
        constexpr std::uint8_t across[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
        for (int f = 0; f < 4; ++f) {
            put(f, corner[f][0], corner[f][1], corner[f][2]);
            for (int k = 0; k < 3; ++k) faces_[f].across[k] = across[f][k];
        }
        face_count_ = 4;
    }
    ABUT_HD constexpr void put(int f, std::uint8_t p, std::uint8_t q, std::uint8_t r) {
        face& made = faces_[f];
        made.normal = contact_math::unit_of(inward(p, q, r));
        made.distance = -contact_math::plain_dot(made.normal, at(p));
        made.corner[0] = p, made.corner[1] = q, made.corner[2] = r;
        made.is_seen = 0;
    }

    /// Until the nearest face is one of all differences, or there are as many corners as there may be. Then what is beside
    /// the faces that are nearer than any way known may still be a shorter one.
    ABUT_NOINLINE ABUT_HD constexpr void grow() {
        double depth = infinity<double>;
        if (grow_up_to(depth)) return;
        ABUT_ROLLED
        for (int f = 0; f < face_count_; ++f) {
            if (faces_[f].distance < depth) depth = least(depth, of_.depth_beside(points_of(faces_[f])));
        }
    }
    [[nodiscard]] ABUT_HD constexpr points_of_face points_of(const face& f) const {
        return {of_b_[f.corner[0]], of_b_[f.corner[1]], of_b_[f.corner[2]]};
    }
    /// Whether that is as deep as the shapes are.
    ABUT_HD constexpr bool grow_up_to(double& depth) {
        for (;;) {
            int nearest = 0;
            for (int f = 1; f < face_count_; ++f) {
                if (faces_[f].distance < faces_[nearest].distance) nearest = f;
            }
            const face& f = faces_[nearest];
            const auto way = inward(f.corner[0], f.corner[1], f.corner[2]);
            std::uint32_t i = 0, j = 0;
            of_.look_back(way, i, j);
            append(i, j);
            best_.offer(f.normal, -contact_math::plain_dot(f.normal, at(corners_ - 1)));
            depth = least(depth, best_.depth, of_.depth_beside(points_of(f)));
            // No direction has less than the distance of the nearest face.
            if (!(depth - f.distance > least_gain())) return true;
            if (sign_of_dot(way, exactly(corners_ - 1) - exactly(f.corner[0])) >= 0) return true;
            if (corners_ > most_corners) return false;
            wrap(nearest);
        }
    }
    /// What is not worth a step, as depths are rounded to T.
    [[nodiscard]] ABUT_HD constexpr double least_gain() const {
        return static_cast<double>(unit_roundoff<typename Differences::scalar_type>) / 2 * largest_;
    }

    /// Whether the last corner is strictly beyond a face. A product is within 2^-48 of the largest difference: the normal is
    /// within 2^-50 in each coordinate, and so are differences of themselves. The code takes 2^-45, and 2^-116 for what is
    /// cut off in integers (hull_distance.hpp).
    [[nodiscard]] ABUT_HD constexpr bool is_beyond(const face& f) const {
        const double side = plain_sum(contact_math::plain_dot(f.normal, at(corners_ - 1)), f.distance);
        const double bound = 0x1p-45 * largest_ + 0x1p-116;
        if (side > bound) return false;
        if (side < -bound) return true;
        return sign_of_dot(inward(f.corner[0], f.corner[1], f.corner[2]), exactly(corners_ - 1) - exactly(f.corner[0])) < 0;
    }

    /// Takes the last corner in, which is beyond face `first`: what it sees makes way for faces from its border to the
    /// corner. The border is one cycle, since the polytope is convex.
    ABUT_NOINLINE ABUT_HD constexpr void wrap(int first) {
        std::uint8_t seen[most_faces] = {}, from[most_corners] = {}, to[most_corners] = {}, outside[most_corners] = {},
                     place_from[most_corners] = {};
        int seen_count = 0, border = 0;
        faces_[first].is_seen = 1;
        seen[seen_count++] = static_cast<std::uint8_t>(first);
        for (int k = 0; k < seen_count; ++k) {
            const face& f = faces_[seen[k]];
            for (int e = 0; e < 3; ++e) {
                face& next = faces_[f.across[e]];
                if (next.is_seen == 0) {
                    next.is_seen = is_beyond(next) ? 1 : 2;
                    if (next.is_seen == 1) seen[seen_count++] = f.across[e];
                }
                if (next.is_seen != 2) continue;
                from[border] = f.corner[e];
                to[border] = f.corner[e == 2 ? 0 : e + 1];
                outside[border++] = f.across[e];
            }
        }
        // Two more than make way, in their places and behind all.
        for (int k = 0; k < border; ++k) {
            const int place = k < seen_count ? seen[k] : face_count_++;
            place_from[from[k]] = static_cast<std::uint8_t>(place);
        }
        const auto last = static_cast<std::uint8_t>(corners_ - 1);
        for (int k = 0; k < border; ++k) {
            const std::uint8_t place = place_from[from[k]];
            face& beyond = faces_[outside[k]];
            beyond.is_seen = 0;
            for (int e = 0; e < 3; ++e) {
                if (beyond.corner[e] == to[k] && beyond.corner[e == 2 ? 0 : e + 1] == from[k]) beyond.across[e] = place;
            }
            put(place, from[k], to[k], last);
            faces_[place].across[0] = outside[k];
            faces_[place].across[1] = place_from[to[k]];
            faces_[place_from[to[k]]].across[2] = place;
        }
    }

    Differences& of_;
    std::uint32_t of_a_[most_corners + 1] = {}, of_b_[most_corners + 1] = {};
    face faces_[most_faces] = {};
    int corners_ = 0, face_count_ = 0;
    double largest_ = 0;  ///< sum of coordinates' magnitudes, of all corners
    contact_math::least_overlap best_;
};

/// Whether a hull's points come before those of another one: an order, so that two hulls have one contact.
template <scalar T>
ABUT_HD constexpr bool comes_before(const hull<T>& a, const hull<T>& b) {
    if (a.count != b.count) return a.count < b.count;
    for (std::size_t i = 0; i < a.count; ++i) {
        const vec3<T> p = a[i], q = b[i];
        if (p.x != q.x) return p.x < q.x;
        if (p.y != q.y) return p.y < q.y;
        if (p.z != q.z) return p.z < q.z;
    }
    return true;
}

/// The greatest n.p over points of a hull, seen from an origin.
template <scalar T>
ABUT_HD constexpr double greatest_height(const hull<T>& h, const contact_math::point& n, const contact_math::point& origin,
                                         const contact_math::common_scale& scale) {
    double most = -infinity<double>;
    for (std::size_t i = 0; i < h.count; ++i) {
        most = greatest(most, contact_math::plain_dot(n, contact_math::plain_difference(scale(h[i]), origin)));
    }
    return most;
}

/// Of hulls that meet.
template <scalar T>
ABUT_HD constexpr contact_math::point least_way_of_hulls(const hull<T>& a, const hull<T>& b,
                                                         const typename nearest_in_hulls<T>::integers& x,
                                                         const difference_simplex& at,
                                                         const contact_math::common_scale& scale) {
    hull_minus_hull<T> differences(a, b, x, scale);
    expanding_polytope polytope(differences);
    for (int k = 0; k < at.count; ++k) polytope.append(at.a[k], at.b[k]);
    return polytope.least_way();
}

/// Of a hull, and one with a radius around it, as doubles know them. Where the cores do not touch, they go apart along the
/// way between the points that are nearest to each other.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact_in_doubles<T> find_contact_in_doubles(const hull<T>& a, const hull<T>& b, T radius,
                                                                                  bool may_be_apart = false) {
    using namespace contact_math;
    const point origin = widened(a[0]);
    const plain_points<T> seen_a(a, origin), seen_b(b, origin);
    const auto around = static_cast<double>(radius);
    plain_simplex at;
    contact_in_doubles<T> known;
    if (may_be_apart && are_clearly_beyond(seen_a, seen_b, around)) {
        known.touch = verdict::no;
        return known;
    }
    const plain_nearest nearest = search_in_doubles(seen_a, seen_b, at, {0, 0, 0}, around);
    if (nearest.are_surely_beyond(around)) known.touch = verdict::no;
    if (!nearest.knows_shared_point()) return known;
    plain_way_out out{negated(nearest.along), -nearest.length, true};
    if (nearest.meet) {
        out = way_out_in_doubles<T>(seen_a, seen_b, at, nearest.size);
    } else {
        if (!(radius > 0 && nearest.length > 0)) return known;
    }
    const point n = as_stored_direction<T>(unit_vector(as<two_doubles>(out.normal)));
    const double overlap = plain_dot(n, plain_difference(seen_b.farthest(n), seen_a.farthest(negated(n))));
    const double enough = plain_product(0x1p-50 + static_cast<double>(unit_roundoff<T>) / 2, nearest.size);
    if (!(out.is_sure && plain_sum(overlap, -out.depth) <= enough)) return known;
    const double depth = plain_sum(overlap, around);
    known.is_known = true;
    if (known.touch == verdict::unknown) known.touch = touch_of_cores(nearest, out.depth, around);
    known.found = {0, 0, from_seen<T>(origin, nearest.on_a), {static_cast<T>(n.x), static_cast<T>(n.y), static_cast<T>(n.z)},
             rounded_within<T>(depth > 0 ? depth : 0)};
    return known;
}

/// The same, and in integers where doubles do not know it.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_of_hulls(const hull<T>& a, const hull<T>& b, T radius,
                                                            const contact_math::common_scale& scale) {
    using namespace contact_math;
    if (const auto known = find_contact_in_doubles(a, b, radius); known.is_known) return known.found;
    using measured_pair = measured_hull_pair<T>;
    const measured_pair measured(a, T(0), b, radius);
    const auto& nearest = measured.nearest;
    const typename nearest_in_hulls<T>::integers x(a, b, nearest.unit_of(a, b));
    const bool meet = radius == 0 || nearest.length == 0;
    const point way_out = meet ? least_way_of_hulls(a, b, x, nearest.at, scale) : nearest.direction(x);
    const point n = as_stored_direction<T>(unit_vector(as<two_doubles>(way_out)));
    const point origin = scale(b[0]);
    const double of_b = plain_sum(greatest_height(b, n, origin, scale), scale(radius));
    least_overlap way;
    way.offer(n, plain_sum(of_b, greatest_height(a, negated(n), origin, scale)));
    contact<T> found = assembled<T>(scale, {0, 0, 0}, way);
    found.point = measured.point_on_a();
    return found;
}

/// What a search in doubles tells of a hull and another shape, of which it is not known whether they touch.
///@{
template <scalar T, has_core_points<T> S>
ABUT_HD constexpr contact_in_doubles<T> search_contact(const hull<T>& h, const S& s) {
    const auto core = core_points_of(s);
    return find_contact_in_doubles(h, core.as_hull(), radius_around_core(s), true);
}
template <scalar T>
ABUT_HD constexpr contact_in_doubles<T> search_contact(const hull<T>& a, const hull<T>& b) {
    if (comes_before(a, b)) return find_contact_in_doubles(a, b, T(0), true);
    contact_in_doubles<T> known = find_contact_in_doubles(b, a, T(0), true);
    known.found = reversed(known.found);
    return known;
}
///@}

// All of shapes that are known to touch, with ids 0.

/// The least move in any direction. The point is one of both cores, or where these do not touch the hull's nearest one.
template <scalar T, has_core_points<T> S>
ABUT_HD constexpr contact<T> contact_between(const hull<T>& h, const S& s) {
    const auto core = core_points_of(s);
    return contact_of_hulls(h, core.as_hull(), radius_around_core(s), contact_math::common_scale(h, s));
}
/// In one order, so that the other one has the same contact reversed.
template <scalar T>
ABUT_HD constexpr contact<T> contact_between(const hull<T>& a, const hull<T>& b) {
    const contact_math::common_scale scale(a, b);
    return comes_before(a, b) ? contact_of_hulls(a, b, T(0), scale) : reversed(contact_of_hulls(b, a, T(0), scale));
}

/// Out to one side or the other, as for a triangle. The point is where the plane passes the line between the hull's lowest
/// and highest points.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr contact<T> contact_between(const plane<T>& s, const hull<T>& h) {
    using namespace contact_math;
    const common_scale scale(s, h);
    corner_hull<T, 2> ends{{h[0], h[0]}};
    two_doubles lowest{infinity<double>, 0}, highest{-infinity<double>, 0};
    for (std::size_t i = 0; i < h.count && !is_zero(widened(s.normal)); ++i) {
        const point at[1] = {scale(h[i])};
        const two_doubles height = plane_heights<1>(s, at, scale).height[0];
        if (height < lowest) lowest = height, ends.at[0] = h[i];
        if (highest < height) highest = height, ends.at[1] = h[i];
    }
    return contact_with_plane(s, ends, T(0), scale);
}

}  // namespace abut::detail
