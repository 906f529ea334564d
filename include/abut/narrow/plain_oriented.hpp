// SPDX-License-Identifier: MIT
#pragma once

// Oriented boxes beside points and spheres, by those corners alone that the answer is measured between: what plain_box.hpp says
// of all eight, to the bit, or nothing. Then that is asked.
//
// In the box's own frame the feature that is nearest to the point is plain, and where it is sure to be the one that
// plain_box.hpp takes, only its corners are placed. Let c be the box's centre, a_k the columns of its rotation R, h_k the half
// lengths and H their sum, d the way from c to the point, and x_k = a_k.d; E = R^T R - 1 has rows no longer than 3 2^-10, since
// rows of R are those of a rotation within 2^-10 (rotation_tolerance). Corners are off by less than `lost` from the sums of the
// h_k a_k, and so are d and what is computed from it. For edge k of plain_box.hpp, the computed q.p / 2 h_k differs from x_k +
// h_k, and half of q.q from 2 h_k, by less than 3 2^-10 H + 8 lost size / h_k together, which is below 2^-8 H where the least
// h_k is above 2^13 lost size / H. So a point whose |x_k| is farther than 2^-8 H from each h_k is beyond the same faces there.
// What it is along edges inside a face is known alike, within 2^-8 H over the least h_k. And along the way from the feature
// any corner that does not belong to it is behind by h_k 2^-9 H at least, or of a face by h_k of the length of that way, which is
// more than products lose: whether all corners are behind is up to those of the feature.
//
// A point that is within the box by 2^-7 H at least leaves it through the face that is nearest in the box's frame, if the others
// are farther by 2^-6 H: a normal of a face, across two edges, is within 3 2^-10 of a_k, so that how far the point is from the face
// is known within 6.1 2^-10 H. So one normal of three is computed, and how far four corners of eight reach along it. All corners are
// placed: whether they are near enough to a box's is told by them.
//
// Sizes are bounds of `size` of plain_box.hpp: that is between |d| + radius + 0.9 H and |d| + radius + 5.25 H, with sums of
// magnitudes. What holds with the worse of both holds with it.

#include <concepts>
#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_box.hpp>
#include <abut/narrow/plain_ways.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::detail {

/// Corners of an oriented box, each when it is asked for.
template <scalar T>
struct lazy_corners {
    double part[3][2][3], shift[3];

    ABUT_INLINE ABUT_HD constexpr explicit lazy_corners(const oriented_box<T>& s) : part{}, shift{} {
        const double h[] = {static_cast<double>(s.half.x), static_cast<double>(s.half.y), static_cast<double>(s.half.z)};
        for (int k = 0; k < 3; ++k) {
            for (int r = 0; r < 3; ++r) {
                part[k][1][r] = plain_product(static_cast<double>(s.rotation[3 * r + k]), h[k]);
                part[k][0][r] = -part[k][1][r];
            }
        }
        shift[0] = static_cast<double>(s.center.x), shift[1] = static_cast<double>(s.center.y), shift[2] = static_cast<double>(s.center.z);
    }
    /// As `coordinates_under` has it.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr vec3<T> operator()(int i) const {
        const double *const x = part[0][i & 1], *const y = part[1][(i >> 1) & 1], *const z = part[2][i >> 2];
        const auto at = [&](int r) {
            return rounded(static_cast<T>(plain_sum(plain_sum(plain_sum(x[r], y[r]), z[r]), shift[r])));
        };
        return {at(0), at(1), at(2)};
    }
};

template <scalar T>
struct plain_oriented_box : plain_box_feature<T> {
    using plain_box_feature<T>::size;  ///< no less than of plain_corner_box
    double least_size = 0;             ///< no more than that
    int count = 0;                     ///< of the feature's corners
    int across = -1, side = 0;         ///< the edge that a point inside leaves along, 0 to 2, if that is sure; 1 at its last end
    vec3<double> p, q[4];              ///< the point and these, as they are seen from the first corner, if `count` is above 1

    ABUT_NOINLINE ABUT_HD constexpr plain_oriented_box(const oriented_box<T>& s, const vec3<T>& center, double radius) {
        if (ABUT_CONSTANT_EVALUATED()) return;  // nothing may overflow there
        const vec3<double> d = plain_way_to(s.center, center), h = widened(s.half);
        const vec3<double> at{dot(widened(column(s.rotation, 0)), d), dot(widened(column(s.rotation, 1)), d),
                              dot(widened(column(s.rotation, 2)), d)},
            beyond = absolute(at) - h, clear = absolute(beyond);
        const int free = (beyond.x < 0 ? 1 : 0) + (beyond.y < 0 ? 2 : 0) + (beyond.z < 0 ? 4 : 0);
        const double halves = h.x + h.y + h.z, margin = 0x1p-8 * halves;
        if (!(least(clear.x, clear.y, clear.z) > margin)) return;
        const double lowest = least(h.x, h.y, h.z), away = plain_magnitudes(d) + radius;
        size = away + 5.25 * halves;
        least_size = away + 0.9 * halves;
        const double lost = (std::same_as<T, float> ? 0x1p-22 : 0x1p-49) * (magnitudes(widened(s.center)) + halves) + 0x1p-49 * size;
        if (!(are_plain_sizes<T>(size) && lowest * halves > 0x1p13 * lost * size && lowest > 0x1p-30 * size)) return;
        if (free == 7) {
            const int k = clear.x <= clear.y && clear.x <= clear.z ? 0 : clear.y <= clear.z ? 1 : 2;
            const double nearest_face = least(clear.x, clear.y, clear.z), along = k == 0 ? at.x : k == 1 ? at.y : at.z,
                         others = least(nearest_face + 2 * absolute(along), k == 0 ? clear.y : clear.x, k == 2 ? clear.y : clear.z);
            if (nearest_face > 2 * margin && others - nearest_face > 4 * margin && are_plain_sizes<T>(least_size)) across = k, side = along > 0;
            return;
        }
        corner_ = ((at.x > 0 ? 1 : 0) + (at.y > 0 ? 2 : 0) + (at.z > 0 ? 4 : 0)) & ~free;
        if (free == 0) {
            count = 1;
            this->nearest.from = lazy_corners<T>(s)(corner_);
            this->way = this->ahead = plain_way_to(this->nearest.from, center);
            this->is_good = contact_math::plain_dot(this->way, this->way) > 0x1p-40 * plain_product(size, size);
            return;
        }
        one_ = free & -free, other_ = free - one_;
        if (other_ == 0) {
            look_from<2>(s, center);
        } else {
            const double x = one_ == 1 ? at.x / h.x : at.y / h.y, y = other_ == 2 ? at.y / h.y : at.z / h.z, sure = 2 * margin / lowest;
            along_[0] = 0.5 * x + 0.5, along_[1] = 0.5 * y + 0.5;
            if (absolute(x - y) > sure && absolute(x + y) > sure) look_from<4>(s, center);
        }
    }
    /// By how much a sphere around the point overlaps the box along -n, where n is about the way from the feature.
    [[nodiscard]] ABUT_HD constexpr double overlap(const oriented_box<T>& s, const vec3<T>& center, double radius, const vec3<double>& n) const {
        using contact_math::plain_dot;
        if (count > 1) return plain_sum(plain_sum(radius, -plain_dot(n, p)), farthest(n));
        const vec3<T> first = lazy_corners<T>(s)(0);
        return plain_sum(plain_sum(radius, -plain_dot(n, plain_way_to(first, center))), plain_dot(n, plain_way_to(first, this->nearest.from)));
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double part_of(int k) const { return along_[k == one_ ? 0 : 1]; }
    /// With the least size, and where more would do it is not known.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr bool has_all_behind(int i) {
        const double beyond = plain_sum(farthest(this->ahead), -contact_math::plain_dot(this->ahead, q[slot(i)]));
        const bool has = this->is_rounding(beyond, least_size);
        is_open_ = is_open_ || (!has && this->is_rounding(beyond, size));
        return has;
    }

private:
    /// How far a corner lies along n, of an edge or a face.
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr double farthest(const vec3<double>& n) const {
        double most = contact_math::plain_dot(n, q[0]);
        for (int i = 1; i < count; ++i) most = greatest(most, contact_math::plain_dot(n, q[i]));
        return most;
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD constexpr int slot(int i) const {
        return ((i & one_) != 0 ? 1 : 0) + ((i & other_) != 0 ? 2 : 0);
    }
    /// Of an edge or a face.
    template <int N>
    ABUT_INLINE ABUT_HD constexpr void look_from(const oriented_box<T>& s, const vec3<T>& center) {
        const lazy_corners<T> corner_of(s);
        const vec3<T> first = corner_of(0);
        vec3<T> corners[std::size_t{N}];
        for (int i = 0; i < N; ++i) {
            corners[i] = corner_of(corner_ + ((i & 1) != 0 ? one_ : 0) + ((i & 2) != 0 ? other_ : 0));
            q[i] = plain_way_to(first, corners[i]);
        }
        p = plain_way_to(first, center);
        count = N;
        this->look(*this, [&](int i) -> const vec3<T>& { return corners[slot(i)]; }, center, corner_, one_ + other_);
        this->is_good = this->is_good && !is_open_;
    }

    bool is_open_ = false;
    int corner_ = 0, one_ = 0, other_ = 0;  ///< where the feature begins, and the bits of its edges
    double along_[2]{};                     ///< where the point is along these
};

/// An oriented box, and a point or a sphere beside it.
template <scalar T, class U>
    requires(corners_of_core<U> == 1 && std::same_as<scalar_type_of<U>, T>)
struct plain_pair<oriented_box<T>, U> : plain_gap {
    plain_oriented_box<T> box;

    ABUT_INLINE ABUT_HD constexpr plain_pair(const oriented_box<T>& s, const U& t)
        : plain_gap{0, static_cast<double>(radius_around_core(t))}, box(s, core_of(t).at[0], radius_b) {
        size = box.size, is_good = box.is_good;
        if (is_good) length = contact_math::root(contact_math::one_double{contact_math::plain_dot(box.way, box.way)}).high;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& way() const { return box.way; }
    [[nodiscard]] ABUT_HD constexpr const plain_place<T>& on_a(const oriented_box<T>&) const { return box.nearest; }
    [[nodiscard]] ABUT_HD constexpr plain_place<T> on_b(const U& t) const { return {core_of(t).at[0]}; }
};

/// Of a point inside, with what is around it, as plain_box.hpp has it.
template <scalar T, class U>
ABUT_NOINLINE ABUT_HD constexpr first_contact<T> contact_through_face(const oriented_box<T>& s, const U& t, double radius,
                                                                      const plain_oriented_box<T>& box) {
    using namespace contact_math;
    const vec3<T>& h = s.half;
    const placed_box<T> placed = box_under(s.rotation, s.center, vec3<T>{-h.x, -h.y, -h.z}, h);
    const vec3<T>(&corner)[8] = placed.corners;
    vec3<double> q[8];
    for (int i = 0; i < 8; ++i) q[i] = i == 0 ? vec3<double>{0, 0, 0} : plain_way_to(corner[0], corner[i]);
    const double off = off_from_edges(q), halves = magnitudes(widened(h));
    // The largest magnitude of all where that of two corners, which is no larger, does not tell.
    const auto is_off_by_more = [&](T magnitude) { return off > most_off(magnitude); };
    if (is_off_by_more(greatest(magnitude_of(corner[0]), magnitude_of(corner[7]))) &&
        is_off_by_more(greatest(magnitude_of(points_of(placed).as_hull()), magnitude_of(t))))
        return {};
    if (4 * off + 0x1p-44 * box.size > 0x1p-10 * halves) return {};
    const vec3<double> p = plain_way_to(corner[0], core_of(t).at[0]);
    const point n = normal_across<T>(q, box.across);
    const bool is_ahead = (box.side == 1) != (box.across == 1);
    double most = -infinity<double>;  // along the way out
    for (int i = 0; i < 8; ++i) {
        if (((i >> box.across) & 1) == box.side) most = greatest(most, is_ahead ? plain_dot(n, q[i]) : -plain_dot(n, q[i]));
    }
    const double amid = plain_dot(n, p), depth = plain_sum(plain_sum(radius, is_ahead ? -amid : amid), most);
    return {verdict::yes, plain_contact(core_of(t).at[0], is_ahead ? negated(n) : n, depth)};
}

template <scalar T, class U>
    requires has_plain_pair<oriented_box<T>, U>
ABUT_INLINE ABUT_HD constexpr first_contact<T> first_contact_of(const oriented_box<T>& s, const U& t,
                                                                  const plain_pair<oriented_box<T>, U>& both) {
    using namespace contact_math;
    if (both.box.across >= 0) return contact_through_face(s, t, both.radius_b, both.box);
    const verdict touch = both.touch();
    if (touch != verdict::yes) return first_contact<T>{touch};
    const auto overlap = [&](const vec3<double>& n) { return both.box.overlap(s, core_of(t).at[0], both.radius_b, n); };
    return contact_of_feature<T>(both, overlap, [&](double excess) {
        return is_tolerable(excess, both.box.least_size / 25, both.box.nearest.from, t);
    });
}

}  // namespace abut::detail
