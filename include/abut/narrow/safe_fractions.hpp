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
// Rounding. g and m are right by definition. u = 2^-52, X the largest coordinate of x_i relative to one of the points, D
// that of the ways. s_i - m is off by less than 8u |g| X and c_i by 5u |g| D, |g| the sum of magnitudes: 2^-46 is eight
// times that. g is scaled to coordinates of 1 at most, so that what underflows, or is a denormal float that a mode reads as
// 0, is below `tiny`. The quotient is rounded down by 2^-48. Where coordinates are beyond 2^200, nothing that moves may.

#include <concepts>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/motion.hpp>
#include <abut/shape/outward.hpp>

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
            const vec3<double> u = place_[1] - place_[0], v = place_[3] - place_[2], w = place_[2] - place_[0];
            const parts_of_edges at = nearest_on_edges(u, v, w);
            return at.of_u * u - w - at.of_v * v;
        } else {
            return nearest_to_origin(place_[0] - place_[1], place_[0] - place_[2], place_[0] - place_[3]);
        }
    }
    /// Across the face, or both edges: known to many digits where the other is not, as of needles.
    [[nodiscard]] ABUT_HD constexpr vec3<double> across() const {
        const vec3<double> n = Edges ? cross(place_[1] - place_[0], place_[3] - place_[2])
                                     : cross(place_[2] - place_[1], place_[3] - place_[1]);
        return dot(n, place_[0] - place_[of_first]) < 0 ? -1.0 * n : n;
    }

    [[nodiscard]] ABUT_HD constexpr bool part_by(const vec3<double>& normal, double separation,
                                                 safe_fractions& found) const {
        const double size = largest_coordinate(normal);
        if (!(size > 0 && size < infinity<double>)) return false;
        const vec3<double> g{normal.x / size, normal.y / size, normal.z / size};
        const double sum = magnitudes(g), lost_at = 0x1p-46 * sum * extent_ + tiny,
                     lost_way = 0x1p-46 * sum * longest_ + tiny;
        const double kept = separation > 0 ? 0.5 * (1 + 0x1p-40) * separation * length_above(g) : 0;

        double side[4]{}, closing[4]{}, low = infinity<double>, high = -infinity<double>, fastest[2] = {0, 0};
        for (int i = 0; i < 4; ++i) {
            const bool first = i < of_first;
            side[i] = dot(g, place_[i]);
            closing[i] = rests_[i] ? 0 : (first ? -1.0 : 1.0) * dot(g, way_[i]) + lost_way;
            (first ? low : high) = first ? least(side[i], low) : greatest(side[i], high);
            fastest[first ? 0 : 1] = greatest(closing[i], fastest[first ? 0 : 1]);
        }
        const double room = low - high - 2 * (lost_at + kept);
        if (!(room > 0)) return false;
        // What each needs and a little more, so that both sides are sure to be off the plane.
        const auto share = [&](double needed) { return least(needed / room * (1 + 0x1p-10) + 0x1p-10, 0.5); };
        const double of_1 = share(fastest[0]), of_2 = share(fastest[1]), part_of_1 = of_2 < 0.5 ? 1 - of_2 : of_1;
        const double plane = low - lost_at - kept - part_of_1 * room;
        for (int i = 0; i < 4; ++i) {
            const double left = (i < of_first ? side[i] - plane : plane - side[i]) - lost_at - kept;
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
