// SPDX-License-Identifier: MIT
#pragma once

// The least way between a cylinder or a cone and a point, a segment, a triangle or a box, in double, as in nearest_ways.hpp.
// Let u be the unit roundoff and D the largest distance between a point of one and a point of the other.
//
// Corners are first seen as heights along the axis and ways across it, once. What that rounds is as if each corner was moved
// by a few u D, and moves a distance by no more. From here on the edges are those between corners as seen.
//
// An edge. The distance from a convex solid is convex along a line, and outside its slope is n . e, where e is the edge and
// n the way from the foot, over its length. So the least distance is looked for by the sign of the slope, between two places
// at which it is surely negative and surely positive. At a place with the distance d the least one is no less than
// d - |slope| w, where w is as far as the least may be from there: the search is over when that is below 2u D. A slope is
// known but for what rounding leaves in n, and that is added to it: some u where the foot is inside of a flat end or of a
// side, but u D / d on a rim. Where the sign is not known and the search not over, all is done again in sums of two doubles.
// There the slope is off by c u^2 D |e| / d, and below 2u D a distance is taken for the least: above it, the sign is known
// once w is below D / c |e|. So it always ends, and the least distance is off by 2u D however the edge lies: needles, thin
// solids and edges that are nearly parallel to a side or to a rim need no special care.
//
// A face, if the least way begins inside of it. Then the way is orthogonal to the face, and ends where the solid reaches
// farthest along the normal: on a rim, opposite to the normal's part across the axis, or at a cone's apex. Candidates are
// those points and the ends' centres, on both sides. Each is a point of the solid, and so is no nearer than the least but
// for rounding. Let z be where the least way ends and z' the candidate for the normal n' as it is rounded. The segment from
// z to z' lies in the solid. If the foot of z' is in the face too, z' is nearer along n', and so along n farther by no more
// than (n - n') . (z' - z). If it is not, the foot of the segment leaves the face on the way, at an edge, whose least way is
// longer than the least of all by no more than that of the part of the segment before. The normal of a triangle as long as L
// and as high as H is tilted by c u L / H, about the longest side: within the face that is a height of c u L. The same is
// true of faces that are parallel to an end or to a side: there the centres, the rims and the edges tell.
//
// A box has six faces, along the axes, on which each candidate has its foot coordinate by coordinate.
//
// If the two touch, a point of both is found in the same way: on an edge; or else the solid has all that it has of the
// face's plane inside of the face, so that any point tells: the one where the plane passes between the solid's farthest
// points on both of its sides. Of a box that holds the solid an end tells.

#include <cstddef>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/nearest_ways.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A place on an edge, as a share of it.
struct place_on_edge {
    double t = 0;
    double length = infinity<double>;  ///< from the solid
    bool is_sure = true;               ///< that it is the least
    vec3<double> across{0, 0, 0};
    double height = 0, from_axis = 0, along = 0, out = 0;
};

/// Looks for the place on an edge that is nearest to a solid.
template <class N>
class edge_search {
public:
    /// `size` is no more than D, and not much less.
    ABUT_HD constexpr edge_search(const revolution_profile& solid, const place_by_axis& a, const place_by_axis& b,
                                  double size)
        : solid_(solid),
          a_(a),
          b_(b),
          rise_(N::difference(b.height, a.height)),
          turn_(contact_math::between<N>(a.across, b.across)),
          enough_(0x1p-52 * size) {
        using namespace contact_math;
        const auto length = [](const point& v) { return root(one_double{plain_dot(v, v)}).high; };
        climb_ = absolute(rise_.high);
        swing_ = length(rounded_off(turn_));
        most_along_ = greatest(absolute(a.height), absolute(b.height), solid.height);
        most_out_ = greatest(length(a.across), length(b.across));
    }

    /// Unless no place is nearer than `best`.
    ABUT_HD constexpr place_on_edge find(double best) const {
        seen lower = look(0), upper = look(1);
        const slope_sign at_lower = sign_of(lower), at_upper = sign_of(upper);
        if (at_lower == slope_sign::rises || is_least(lower, 1)) return lower.at;
        if (at_upper == slope_sign::falls || is_least(upper, 1)) return upper.at;
        if (at_lower == slope_sign::unknown || at_upper == slope_sign::unknown) return unsure(lower, upper);
        // No place is below both tangents.
        const double bend = plain_sum(upper.slope, -lower.slope),
                     meet = plain_sum(plain_sum(lower.at.length, -upper.at.length), upper.slope) / bend,
                     bound = plain_sum(lower.at.length, plain_product(lower.slope, meet));
        if (plain_sum(bound, -plain_sum(lower.noise, upper.noise)) > best) return nearer(lower, upper);
        bool halve = false;
        for (int step = 0; step < most_steps; ++step) {
            const double from = lower.at.t, to = upper.at.t, width = plain_sum(to, -from);
            if (width <= 0x1p-52) break;
            // The slope of the square is nearer to a line. A step that did not halve what is left is followed by one that
            // does.
            const double of_lower = plain_product(lower.slope, lower.at.length),
                         of_upper = plain_product(upper.slope, upper.at.length);
            double t = plain_sum(from, plain_product(width, of_lower / plain_sum(of_lower, -of_upper)));
            if (halve || !(t > from && t < to)) t = plain_sum(from, width / 2);
            const seen middle = look(t);
            const slope_sign sign = sign_of(middle);
            if (is_least(middle, sign == slope_sign::rises   ? plain_sum(t, -from)
                                 : sign == slope_sign::falls ? plain_sum(to, -t)
                                                             : width)) {
                return middle.at;
            }
            if (sign == slope_sign::unknown) return settled_beside(middle, lower, upper);
            sign == slope_sign::falls ? lower = middle : upper = middle;
            halve = !halve && plain_sum(upper.at.t, -lower.at.t) > width / 2;
        }
        return unsure(lower, upper);
    }

private:
    static constexpr bool is_long = std::same_as<N, contact_math::two_doubles>;
    static constexpr double off = is_long ? 0x1p-100 : 0x1p-51;  ///< of N, with all that adds up
    static constexpr int most_steps = is_long ? 120 : 32;

    const revolution_profile& solid_;
    const place_by_axis &a_, &b_;
    N rise_;
    vec3<N> turn_;
    double enough_, climb_ = 0, swing_ = 0, most_along_ = 0, most_out_ = 0;

    /// A place, and the slope there, over the whole edge, which is off by `noise` at most.
    struct seen {
        place_on_edge at;
        double slope = 0, noise = 0;
    };
    enum class slope_sign { falls, rises, unknown };

    ABUT_NOINLINE ABUT_HD constexpr seen look(double t) const {
        using namespace contact_math;
        const bool is_late = t > 0.5;
        const place_by_axis& from = is_late ? b_ : a_;
        const N step = N::of(is_late ? plain_sum(t, -1.0) : t);
        const N height = N::of(from.height) + step * rise_;
        const vec3<N> across = as<N>(from.across) + scale(step, turn_);
        const N rho = root(dot(across, across));
        const half_plane_way<N> w = solid_.way_to(height, rho, most_along_, most_out_, off);
        seen s{{t, w.length, true, rounded_off(across), height.high, rho.high, w.along.high, w.out.high}};
        N slope = w.normal_along * rise_;
        double loose_out = plain_sum(1.0, w.loose_out);
        if (rho.high > 0) {
            slope = slope + w.normal_out * (dot(across, turn_) / rho);
            loose_out = plain_sum(loose_out, plain_product(w.normal_out.high, most_out_) / rho.high);
        }
        s.slope = slope.high;
        s.noise = plain_product(
            off, plain_sum(plain_product(climb_, plain_sum(1.0, w.loose_along)), plain_product(swing_, loose_out)));
        return s;
    }
    ABUT_HD static constexpr slope_sign sign_of(const seen& s) {
        if (!(absolute(s.slope) > s.noise)) return slope_sign::unknown;
        return s.slope > 0 ? slope_sign::rises : slope_sign::falls;
    }
    /// As good as the least, if that is no farther away than `width`.
    [[nodiscard]] ABUT_HD constexpr bool is_least(const seen& s, double width) const {
        return s.at.length <= enough_ || plain_product(plain_sum(absolute(s.slope), s.noise), width) <= enough_;
    }
    /// Where the slope is too small for its sign to be known: if it is known on both sides near by, this is the least.
    ABUT_HD constexpr place_on_edge settled_beside(const seen& s, const seen& lower, const seen& upper) const {
        const double width = enough_ / (4 * s.noise);
        const double before = plain_sum(s.at.t, -width), after = plain_sum(s.at.t, width);
        place_on_edge found = s.at;
        found.is_sure = (before <= lower.at.t || sign_of(look(before)) == slope_sign::falls) &&
                        (after >= upper.at.t || sign_of(look(after)) == slope_sign::rises);
        return found;
    }
    ABUT_HD static constexpr place_on_edge nearer(const seen& lower, const seen& upper) {
        return lower.at.length < upper.at.length ? lower.at : upper.at;
    }
    ABUT_HD static constexpr place_on_edge unsure(const seen& lower, const seen& upper) {
        place_on_edge found = nearer(lower, upper);
        found.is_sure = is_long;
        return found;
    }
};

/// In sums of two doubles. Seldom called: out of line.
ABUT_NOINLINE ABUT_HD constexpr place_on_edge search_closely(const revolution_profile& solid, const place_by_axis& a,
                                                             const place_by_axis& b, double size, double best) {
    return edge_search<contact_math::two_doubles>(solid, a, b, size).find(best);
}

/// Gathers candidates and keeps the least; of equal ones the first. If `Touching`, a point of both is wanted.
template <scalar T, bool Touching>
class revolution_way_finder {
public:
    template <solid_of_revolution S>
    ABUT_HD constexpr revolution_way_finder(const S& s, const length_unit<T>& in)
        : unit(in), first_(axis_of(s).a), solid_(s, in), size_(greatest(solid_.height / 2, solid_.radius)) {}

    length_unit<T> unit;
    nearest_way<T> best{};

    [[nodiscard]] ABUT_HD constexpr vec3<double> see(const vec3<T>& p) {
        const vec3<double> seen = way_between(first_, p, unit);
        size_ = greatest(size_, contact_math::largest_of(seen));
        return seen;
    }
    [[nodiscard]] ABUT_HD constexpr place_by_axis place_of(const vec3<double>& seen) const { return {solid_, seen}; }

    ABUT_HD constexpr void offer_point(const vec3<T>& p, const vec3<double>& seen) {
        const way_from_foot found = way_from_solid(solid_, seen);
        offer(found.foot, found.way, p, {0, 0, 0});
    }
    /// From corner a, which is p, to corner b.
    ABUT_HD constexpr void offer_edge(const vec3<T>& p, const place_by_axis& a, const place_by_axis& b,
                                      const vec3<double>& edge) {
        place_on_edge at = edge_search<contact_math::one_double>(solid_, a, b, size_).find(length_);
        if (!at.is_sure) at = search_closely(solid_, a, b, size_, length_);
        if (!(at.length <= length_)) return;
        const vec3<double> along{plain_product(at.t, edge.x), plain_product(at.t, edge.y), plain_product(at.t, edge.z)};
        if (at.length > 0) {
            const way_from_foot found = way_from_solid(solid_, at.height, at.across, at.from_axis, at.along, at.out);
            offer(found.foot, found.way, p, along);
        } else {
            offer(plain_step(at.across, at.height, solid_.axis), {0, 0, 0}, p, along);
        }
    }
    /// From the solid's farthest points along a normal of length 1, and against it, to what they find on a face: a way, if
    /// `way_to(z, way)` finds one. Centres come first, as the better of points that are as near.
    template <class Way>
    ABUT_HD constexpr void offer_face(const vec3<double>& normal, const Way& way_to) {
        using namespace contact_math;
        const point aside = unit_vector(as<one_double>(part_across(normal, solid_.axis)));
        const point none{0, 0, 0};
        ABUT_ROLLED
        for (int end = 0; end < 2; ++end) {
            const point center = plain_step(none, end == 0 ? 0 : solid_.height, solid_.axis);
            const double reach = end == 0 && solid_.is_cone ? 0 : solid_.radius;
            for (int k = 0; k < (reach > 0 ? 3 : 1); ++k) {
                const point z = plain_step(center, k == 0 ? 0 : k == 1 ? -reach : reach, aside);
                point way{};
                if (way_to(z, way)) offer(z, way, first_, plain_step(z, 1, way));
            }
        }
    }
    /// And where the face's plane, at a height along the normal, passes between those points.
    template <class Way>
    ABUT_HD constexpr void offer_section(const vec3<double>& normal, double level, const Way& way_to) {
        using namespace contact_math;
        const point aside = unit_vector(as<one_double>(part_across(normal, solid_.axis)));
        point low{}, high{};
        double lowest = infinity<double>, highest = -infinity<double>;
        ABUT_ROLLED
        for (int end = 0; end < 2; ++end) {
            const point center = plain_step(point{0, 0, 0}, end == 0 ? 0 : solid_.height, solid_.axis);
            const double reach = end == 0 && solid_.is_cone ? 0 : solid_.radius;
            for (int side = -1; side < 2; side += 2) {
                const point z = plain_step(center, side * reach, aside);
                const double h = plain_sum(plain_dot(normal, z), -level);
                if (h < lowest) lowest = h, low = z;
                if (h > highest) highest = h, high = z;
            }
        }
        if (!(lowest < 0 && highest > 0)) return;
        const point z = plain_step(low, -lowest / plain_sum(highest, -lowest), plain_difference(high, low));
        point way{};
        if (way_to(z, way)) offer(z, way, first_, plain_step(z, 1, way));
    }

protected:
    vec3<T> first_;
    revolution_profile solid_;
    double size_, length_ = infinity<double>;

    ABUT_HD constexpr void offer(const vec3<double>& on_solid, const vec3<double>& way, const vec3<T>& from_b,
                                 const vec3<double>& to_b) {
        const double square = plain_dot(way, way);
        if (!(square < best.square)) return;
        best = {square, way, first_, from_b, on_solid, to_b};
        length_ = contact_math::root(contact_math::one_double{square}).high;
    }
};

/// Of length 1, or 0. Orthogonal to the longest edge, whatever rounding tilts it about that.
ABUT_HD constexpr vec3<double> normal_of(const face_of_edges& face) {
    using namespace contact_math;
    const vec3<double> bc = plain_difference(face.ac, face.ab);
    const double of_ab = plain_dot(face.ab, face.ab), of_ac = plain_dot(face.ac, face.ac), of_bc = plain_dot(bc, bc);
    const vec3<double>& longest = of_ab >= of_ac && of_ab >= of_bc ? face.ab : of_ac >= of_bc ? face.ac : bc;
    const auto unit = [](const vec3<double>& v) { return unit_vector(as<one_double>(v)); };
    return unit(part_across(unit(face.n), unit(longest)));
}

/// From a cylinder or a cone to a hull of corners.
template <bool Touching, solid_of_revolution S, scalar T, int N>
ABUT_HD constexpr nearest_way<T> nearest_way_from(const S& s, const corner_hull<T, N>& b, const length_unit<T>& unit) {
    revolution_way_finder<T, Touching> found(s, unit);
    vec3<double> seen[std::size_t{N}]{};
    for (int i = 0; i < N; ++i) seen[i] = found.see(b.at[i]);
    if constexpr (N == 1) {
        found.offer_point(b.at[0], seen[0]);
        return found.best;
    } else {
        if constexpr (N == 3) {
            const vec3<double> ab = way_between(b.at[0], b.at[1], unit), ac = way_between(b.at[0], b.at[2], unit);
            const face_of_edges face(ab, ac);
            const vec3<double> normal = normal_of(face);
            if (!contact_math::is_zero(normal)) {
                found.offer_face(normal, [&](const vec3<double>& z, vec3<double>& way) {
                    return face.has_foot(plain_difference(seen[0], z), way);
                });
                if constexpr (Touching) {
                    found.offer_section(normal, plain_dot(normal, seen[0]), [&](const vec3<double>& z, vec3<double>& way) {
                        way = foot_on_triangle(plain_difference(seen[0], z), plain_difference(seen[1], z),
                                               plain_difference(seen[2], z));
                        return true;
                    });
                }
            }
        }
        place_by_axis place[std::size_t{N}]{};
        for (int i = 0; i < N; ++i) place[i] = found.place_of(seen[i]);
        ABUT_ROLLED
        for (int i = 0; i < b.edges; ++i) {
            found.offer_edge(b.at[i], place[i], place[i + 1 == N ? 0 : i + 1], hull_edge(b, i, unit));
        }
        return found.best;
    }
}

/// To a solid box.
template <bool Touching, solid_of_revolution S, scalar T>
ABUT_HD constexpr nearest_way<T> nearest_way_from(const S& s, const aabb<T>& box, const length_unit<T>& unit) {
    revolution_way_finder<T, Touching> found(s, unit);
    const auto corner = [&](int i) {
        return vec3<T>{(i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                       (i & 4) != 0 ? box.upper.z : box.lower.z};
    };
    place_by_axis place[8]{};
    for (int i = 0; i < 8; ++i) place[i] = found.place_of(found.see(corner(i)));
    const vec3<double> lower = found.see(box.lower), upper = found.see(box.upper);
    const auto to_box = [&](const vec3<double>& z, vec3<double>& way) {
        way = plain_difference(held(z, lower, upper), z);
        return true;
    };
    ABUT_ROLLED
    for (int axis = 0; axis < 3; ++axis) {
        const vec3<double> normal{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
        found.offer_face(normal, to_box);
        if constexpr (Touching) {
            found.offer_section(normal, plain_dot(normal, lower), to_box);
            found.offer_section(normal, plain_dot(normal, upper), to_box);
        }
    }
    ABUT_ROLLED
    for (int axis = 1; axis < 8; axis *= 2) {
        ABUT_ROLLED
        for (int i = 0; i < 8; ++i) {
            if ((i & axis) != 0) continue;
            found.offer_edge(corner(i), place[i], place[i | axis], way_between(corner(i), corner(i | axis), unit));
        }
    }
    return found.best;
}

}  // namespace abut::detail
