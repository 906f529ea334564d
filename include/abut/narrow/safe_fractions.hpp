// SPDX-License-Identifier: MIT
#pragma once

// How far the four points of two features may go alone, so that the features stay apart.
//
// A plane between the features at t = 0 keeps them apart: whoever of the first feature stays on its own side, and whoever of
// the second on the other, the features do, since they are hulls of their points. So each point may go up to the plane. How
// far it goes is a matter of its own way, and of nobody else's.
//
// With a normal g, any at all, let s_i = g . x_i, and let the first feature be above: the least of its s is greater than the
// greatest of the other's. The plane is at m between these. A point of the first that goes a part f of its way d_i has
//     g . (x_i + f d_i) - m = (s_i - m) - f c_i,  c_i = -g . d_i,
// which is above 0 for all f in [0, F] if F c_i < s_i - m. Likewise of the second with signs turned. For a distance h to be
// kept, both sides take h |g| / 2 off s_i - m: then there is a slab of that width between them.
//
// The plane is in the middle of the gap, or leaves to a side that needs less than half of it what that side needs, and the
// rest to the other. With g between the two nearest points, half of the gap over the length of a way is the bound by spheres
// of A. H. Chen, J. Hsu, Z. Liu, M. Macklin, Y. Yang, C. Yuksel, Offset geometric contact (2025): a point that stays in the
// sphere of half the distance around its place has not come to the middle. So the plane allows no less than that.
//
// Rounding. Each operation is rounded by itself, so that the bits are the same everywhere. g and m are right by definition. u = 2^-52, X the largest coordinate of x_i relative to one of the points, D
// that of the ways. s_i - m is off by less than 8u |g| X and c_i by 5u |g| D, |g| the sum of magnitudes: 2^-46 is eight
// times that. g is scaled to coordinates of 1 at most, so that what underflows, or is a denormal float that a mode reads as
// 0, is below `tiny`. The quotient is rounded down by 2^-48. Where coordinates are beyond 2^200, nothing that moves may.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/motion.hpp>

namespace abut::detail {

/// Parts of their ways, of the points of two features in their order.
struct safe_fractions {
    double of[4];

    [[nodiscard]] ABUT_HD constexpr double smallest() const { return least(of[0], of[1], of[2], of[3]); }
};

/// Of the features of four points, of which the first, or of Edges the first two, are one and the rest the other.
template <bool Edges, scalar T>
class parting_plane {
public:
    ABUT_HD constexpr explicit parting_plane(const moving_points<T>& p) {
        for (int i = 0; i < 4; ++i) {
            place_[i] = relative_to(p.t0[Edges ? 2 : 1], p.t0[i]);
            way_[i] = relative_to(p.t0[i], p.t1[i]);
            rests_[i] = is_same_number(p.t0[i].x, p.t1[i].x) && is_same_number(p.t0[i].y, p.t1[i].y) &&
                        is_same_number(p.t0[i].z, p.t1[i].z);
            extent_ = greatest(largest_coordinate(place_[i]), extent_);
            longest_ = greatest(largest_coordinate(way_[i]), longest_);
        }
    }

    /// How far all may go so that the features stay farther apart than `separation`. A point that does not move may go all
    /// of its way; others of features that no plane is sure to part may not move.
    [[nodiscard]] ABUT_HD constexpr safe_fractions fractions(double separation) const {
        safe_fractions found{};
        if (extent_ < 0x1p200 && longest_ < 0x1p200) {
            if (part_by(from_second_to_first(), separation, found)) return found;
            if (part_by(across(), separation, found)) return found;
        }
        for (int i = 0; i < 4; ++i) found.of[i] = rests_[i] ? 1 : 0;
        return found;
    }

private:
    static constexpr int of_first = Edges ? 2 : 1;  ///< points of the first feature
    static constexpr double tiny = std::same_as<T, float> ? 0x1p-120 : 0x1p-1000;

    /// Between the points that are nearest to each other at t = 0; it need not be right.
    [[nodiscard]] ABUT_HD constexpr vec3<double> from_second_to_first() const {
        if constexpr (Edges) {
            const vec3<double> u = plain_difference(place_[1], place_[0]), v = plain_difference(place_[3], place_[2]),
                               w = plain_difference(place_[2], place_[0]);
            const double uu = plain_dot(u, u), uv = plain_dot(u, v), vv = plain_dot(v, v), uw = plain_dot(u, w), vw = plain_dot(v, w);
            const auto into_unit = [](double x) { return x > 0 ? least(x, 1.0) : 0.0; };  // 0 for NaN
            const auto less = [](double x, double y) { return plain_sum(x, -y); };
            const double s = into_unit(less(plain_product(uw, vv), plain_product(vw, uv)) /
                                       less(plain_product(uu, vv), plain_product(uv, uv)));
            const double of_v = into_unit(less(plain_product(uv, s), vw) / vv);
            const double of_u = into_unit(plain_sum(plain_product(uv, of_v), uw) / uu);
            const vec3<double> on_u = plain_step({0, 0, 0}, of_u, u), on_v = plain_step(w, of_v, v);
            return plain_difference(on_u, on_v);
        } else {
            const auto from_first = [&](int i) { return plain_difference(place_[i], place_[0]); };
            const vec3<double> foot = foot_on_triangle(from_first(1), from_first(2), from_first(3));
            return {-foot.x, -foot.y, -foot.z};
        }
    }
    /// Across the face, or both edges: known to many digits where the other is not, as of needles.
    [[nodiscard]] ABUT_HD constexpr vec3<double> across() const {
        const vec3<double> n = Edges ? plain_cross(plain_difference(place_[1], place_[0]), plain_difference(place_[3], place_[2]))
                                     : plain_cross(plain_difference(place_[2], place_[1]), plain_difference(place_[3], place_[1]));
        return plain_dot(n, plain_difference(place_[0], place_[of_first])) < 0 ? vec3<double>{-n.x, -n.y, -n.z} : n;
    }

    [[nodiscard]] ABUT_HD constexpr bool part_by(const vec3<double>& normal, double separation,
                                                 safe_fractions& found) const {
        const double size = largest_coordinate(normal);
        if (!(size > 0 && size < infinity<double>)) return false;
        const vec3<double> g{normal.x / size, normal.y / size, normal.z / size};
        const double sum = plain_sum(plain_sum(absolute(g.x), absolute(g.y)), absolute(g.z));
        const auto lost_of = [&](double most) { return plain_sum(plain_product(0x1p-46, plain_product(sum, most)), tiny); };
        const double lost_at = lost_of(extent_), lost_way = lost_of(longest_);
        const double length = contact_math::root(contact_math::one_double{plain_dot(g, g)}).high;  // from 1 to 2
        const double kept = separation > 0 ? plain_product(plain_product(0.5 * (1 + 0x1p-40), separation), length) : 0;

        double side[4]{}, closing[4]{}, low = infinity<double>, high = -infinity<double>, fastest[2] = {0, 0};
        for (int i = 0; i < 4; ++i) {
            const bool first = i < of_first;
            side[i] = plain_dot(g, place_[i]);
            const double along = plain_dot(g, way_[i]);
            closing[i] = rests_[i] ? 0 : plain_sum(first ? -along : along, lost_way);
            (first ? low : high) = first ? least(side[i], low) : greatest(side[i], high);
            fastest[first ? 0 : 1] = greatest(closing[i], fastest[first ? 0 : 1]);
        }
        const double lost = plain_sum(lost_at, kept), room = plain_sum(plain_sum(low, -high), -2 * lost);
        if (!(room > 0)) return false;
        // What each needs and a little more, so that both sides are sure to be off the plane.
        const auto share = [&](double needed) {
            return least(plain_sum(plain_product(needed / room, 1 + 0x1p-10), 0x1p-10), 0.5);
        };
        const double of_1 = share(fastest[0]), of_2 = share(fastest[1]), part_of_1 = of_2 < 0.5 ? 1 - of_2 : of_1;
        const double plane = plain_sum(plain_sum(low, -lost), -plain_product(part_of_1, room));
        for (int i = 0; i < 4; ++i) {
            const double off = plain_sum(side[i], -plane), left = plain_sum(i < of_first ? off : -off, -lost);
            if (!(left > 0)) return false;
            const double part = closing[i] > 0 ? (1 - 0x1p-48) * (left / closing[i]) : 1;
            found.of[i] = part < 1 ? part : 1;
        }
        return true;
    }

    vec3<double> place_[4], way_[4];
    bool rests_[4];
    double extent_ = 0, longest_ = 0;  ///< the largest coordinates
};

}  // namespace abut::detail
