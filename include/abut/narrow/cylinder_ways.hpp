// SPDX-License-Identifier: MIT
#pragma once

// The least way between a cylinder and another one, or a cone, in double, as in revolution_ways.hpp; u and D are those of
// its head. The other one is the solid: all that is said of it is that it is convex. The least way begins on one of the
// cylinder's two discs or on its side, inside.
//
// The side. There the way, made longer by the radius, is the least way between the solid and the axis, which is an edge. Let
// z be where the search for that ends on the solid: then the cylinder is as near to z. If it is not, z is beyond an end, and
// between z and where the least way ends is a point of the solid that is over that end's plane, and no farther from the axis
// than z: it is as near to the disc.
//
// A disc. The distance g from the solid is convex on it. With the centre as origin, y goes against the gradient there, and x
// across: g is no less than at the centre where y < 0. Let G(x) be the least g on the chord at x where y > 0, or is 0. It is
// convex, and its least is looked for by the sign of its slope. Mostly g falls along the whole chord. Then G(x) is g on the
// rim, and the slope of that is G's. If g rises at the rim, the least on the chord is looked for. Let g have slopes
// (p, -q) and (r, s) at two places on it, where q and s are positive: the mean of both tangents that has no slope along the
// chord is a lower bound of g all over the disc. The search on the chord ends where that is no more than 2u D below the
// least that is known of the disc; its slope then has the sign that is needed. If g rises all along the chord, the least is
// on the side of the centre. Places on the rim are x = 2t / (1 + t^2), y = (1 - t^2) / (1 + t^2), so that they are exact but
// for the rounding of N.
//
// What rounding leaves in a slope is that of edges: it is large by a rim that is near. As there, the search is over where
// the tangent says so, rounding included, to 2u D, and is done again in sums of two doubles where that does not tell. Slopes
// along a chord need not be 0 where they are taken to be: that lowers the bound by what rounding leaves, which has to be
// below 8u D. What the disc is made of are three vectors, as seen by the solid, that are rounded once: a disc that is moved,
// or turned into an ellipse, by a few u D.

#include <concepts>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/exact_stages.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/nearest_ways.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/narrow/revolution_ways.hpp>
#include <abut/predicate/revolution.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A place on a disc as seen from its centre, and the way from a solid to it.
struct place_on_disc {
    double length = infinity<double>;
    bool is_sure = true;  ///< that none is nearer
    vec3<double> at{0, 0, 0};
    way_from_foot from_solid{};
};

/// Where to look next for the least of a convex function between two places, and what it is at least, by the tangents
/// there. First it is where the slope of the square is 0, if that is a line; then where the tangents meet, as if the
/// function had a kink; then, if neither took half, in the middle.
struct next_place {
    enum class turn { secant, meeting, middle };
    double bound = 0, share = 0.5;  ///< share of the width
    turn at = turn::secant;

    ABUT_HD constexpr void look(double lower, double slope_at_lower, double upper, double slope_at_upper, double width) {
        const double bend = plain_sum(slope_at_upper, -slope_at_lower),
                     meet = plain_sum(plain_sum(lower, -upper) / width, slope_at_upper) / bend;
        bound = plain_sum(lower, plain_product(plain_product(slope_at_lower, width), meet));
        const double of_lower = plain_product(slope_at_lower, lower), of_upper = plain_product(slope_at_upper, upper);
        share = at == turn::secant ? of_lower / plain_sum(of_lower, -of_upper) : at == turn::meeting ? meet : 0.5;
    }
    ABUT_HD constexpr void narrow(double taken, double width) {
        took_half_ = (at == turn::meeting && took_half_) || taken >= width / 2;
        at = at == turn::secant ? turn::meeting : at == turn::meeting && !took_half_ ? turn::middle : turn::secant;
    }

private:
    bool took_half_ = false;
};

/// Looks for the place on a disc that is nearest to a solid.
template <class N>
class disc_search {
public:
    /// `center` as seen from the solid's first end; `size` is no more than D, and not much less.
    ABUT_HD constexpr disc_search(const revolution_profile& solid, const vec3<double>& center, const vec3<double>& normal,
                                  double radius, double size)
        : solid_(solid), normal_(normal), radius_(radius), enough_(0x1p-52 * size), center_(solid, center) {
        using namespace contact_math;
        const auto length = [](const point& v) { return root(one_double{plain_dot(v, v)}).high; };
        climb_ = plain_product(radius, length(plain_cross(normal, solid.axis)));
        most_along_ = greatest(plain_sum(absolute(center_.height), climb_), solid.height);
        most_out_ = plain_sum(length(center_.across), radius);
    }

    /// Unless no place is nearer than `best`.
    ABUT_HD constexpr place_on_disc find(double best) {
        best_ = best;
        const seen middle = look(N::of(0), N::of(0));
        if (lay_axes(middle)) return found_;
        double from = -1, to = 1;
        slope_of_chords lower{}, upper{};
        next_place next;
        for (int step = 0; step < most_steps; ++step) {
            const double width = plain_sum(to, -from);
            double t = to;
            if (lower.is_known && upper.is_known) {
                const double x = x_of(from), gap = plain_sum(x_of(to), -x);
                next.look(lower.bound, lower.slope, upper.bound, upper.slope, gap);
                if (is_least(next.bound, plain_product(plain_sum(lower.noise, upper.noise), gap))) return found_;
                t = next.at == next_place::turn::meeting ? t_of(plain_sum(x, plain_product(next.share, gap)))
                                                         : plain_sum(from, plain_product(next.share, width));
            }
            if (!(t > from && t < to)) t = plain_sum(from, width / 2);
            if (!(t > from && t < to)) return found_;
            const slope_of_chords at = look_along(t);
            const bool falls = falls_at(at), rises = rises_at(at);
            const double before = plain_sum(t, -from), after = plain_sum(to, -t),
                         rest = falls   ? after
                                : rises ? before
                                        : width;
            if (is_least(at.bound, plain_product(2 * plain_sum(absolute(at.slope), at.noise), rest))) return found_;
            if (!falls && !rises) {
                found_.is_sure = found_.is_sure && is_settled_beside(t, enough_ / (8 * at.noise), from, to);
                return found_;
            }
            next.narrow(falls ? before : after, width);
            (falls ? from : to) = t;
            (falls ? lower : upper) = at;
        }
        found_.is_sure = false;
        return found_;
    }

private:
    static constexpr bool is_long = std::same_as<N, contact_math::two_doubles>;
    static constexpr double off = is_long ? 0x1p-100 : 0x1p-51;  ///< of N, with all that adds up
    static constexpr int most_steps = is_long ? 120 : 32;

    const revolution_profile& solid_;
    vec3<double> normal_;
    double radius_, enough_, climb_ = 0, most_along_ = 0, most_out_ = 0, best_ = 0;
    vec3<double> x_{0, 0, 0}, y_{0, 0, 0};    ///< of the disc's radius
    place_by_axis center_, of_x_{}, of_y_{};  ///< as seen by the solid
    place_on_disc found_;

    /// The direction of the way to a place, along the solid's axis and by what is across it, and its slopes along x and y.
    struct seen {
        double length = 0, noise = 0;
        N along{}, out{}, by_x{}, by_y{};
        vec3<N> across{};
    };
    /// How the least on a chord changes with x, and what the tangent there says that it is, or more.
    struct slope_of_chords {
        double slope = 0, noise = 0, bound = 0;
        bool is_known = false;  ///< else only the sign of the slope is
    };

    ABUT_NOINLINE ABUT_HD constexpr seen look(const N& x, const N& y) {
        using namespace contact_math;
        const N height = N::of(center_.height) + (x * N::of(of_x_.height) + y * N::of(of_y_.height));
        const vec3<N> across = as<N>(center_.across) + (scale(x, as<N>(of_x_.across)) + scale(y, as<N>(of_y_.across)));
        const N rho = root(dot(across, across));
        const half_plane_way<N> w = solid_.way_to(height, rho, most_along_, most_out_, off);
        seen s{w.length, 0, w.normal_along, N::of(0), N::of(0), N::of(0), across};
        double loose_out = plain_sum(w.normal_out.high, w.loose_out);
        if (rho.high > 0) {
            s.out = w.normal_out / rho;
            loose_out = plain_sum(loose_out, plain_product(s.out.high, most_out_));
        }
        s.by_x = s.along * N::of(of_x_.height) + s.out * dot(across, as<N>(of_x_.across));
        s.by_y = s.along * N::of(of_y_.height) + s.out * dot(across, as<N>(of_y_.across));
        s.noise = plain_product(
            off, plain_sum(plain_product(climb_, plain_sum(1.0, w.loose_along)), plain_product(radius_, loose_out)));
        if (w.length < found_.length) {
            found_.length = w.length;
            found_.at = plain_step(plain_step(vec3<double>{0, 0, 0}, x.high, x_), y.high, y_);
            found_.from_solid = way_from_solid(solid_, height.high, rounded_off(across), rho.high, w.along.high, w.out.high);
        }
        return s;
    }
    ABUT_HD static constexpr bool falls_at(const slope_of_chords& s) { return s.slope < -s.noise; }
    ABUT_HD static constexpr bool rises_at(const slope_of_chords& s) { return s.slope > s.noise; }
    /// Whether the sign of the slope is known on both sides of a place.
    ABUT_HD constexpr bool is_settled_beside(double t, double width, double from, double to) {
        const double before = plain_sum(t, -width), after = plain_sum(t, width);
        return (before <= from || falls_at(look_along(before))) && (after >= to || rises_at(look_along(after)));
    }
    /// Whether places that are not below a bound by more than `fall` are no better than what is known.
    [[nodiscard]] ABUT_HD constexpr bool is_least(double bound, double fall) const {
        return plain_sum(bound, -fall) >= plain_sum(least(found_.length, best_), -enough_);
    }
    /// Where rounding leaves less than a bound, by a rest, it has to be of no matter.
    ABUT_HD constexpr void neglect(double bound, double rest) {
        if (!(plain_sum(bound, -rest) >= plain_sum(least(found_.length, best_), -4 * enough_))) found_.is_sure = false;
    }

    /// Lays y against the slope at the centre, unless no place on the disc is better.
    ABUT_HD constexpr bool lay_axes(const seen& middle) {
        using namespace contact_math;
        const vec3<N> normal = as<N>(normal_), axis = as<N>(solid_.axis);
        // What is across the axis is off by some u of the height along it. Near the axis that is not little beside it.
        const N along = middle.along - middle.out * dot(middle.across, axis);
        const vec3<N> slope = scale(along, axis) + scale(middle.out, middle.across);
        const vec3<N> flat = cross(normal, cross(slope, normal));
        const double fall = plain_product(radius_, root(dot(flat, flat)).high);
        if (is_least(middle.length, plain_sum(fall, middle.noise))) return true;
        neglect(middle.length, middle.noise);
        const vec3<double> up = negated(unit_vector(flat)), none{0, 0, 0};
        y_ = plain_step(none, radius_, up);
        x_ = plain_step(none, radius_, plain_cross(normal_, up));
        of_x_ = place_by_axis(solid_, x_);
        of_y_ = place_by_axis(solid_, y_);
        return false;
    }
    ABUT_HD static constexpr double x_of(double t) { return 2 * t / plain_sum(1.0, plain_product(t, t)); }
    ABUT_HD static constexpr double t_of(double x) {
        const double square = plain_product(plain_sum(1.0, x), plain_sum(1.0, -x));
        return x / plain_sum(1.0, contact_math::root(contact_math::one_double{greatest(square, 0.0)}).high);
    }
    ABUT_HD constexpr slope_of_chords look_along(double t) {
        const N one = N::of(1), q = N::of(t), d = one + q * q;
        const N x = (q + q) / d, y = N::difference(1, t) * (one + q) / d;
        seen high = look(x, y);
        if (!(high.by_y.high > high.noise)) {
            if (high.by_y.high > -high.noise) neglect(high.length, 2 * high.noise);
            return {(high.by_x - high.by_y * x / y).high, 2 * high.noise / y.high, high.length, true};
        }
        seen low = look(x, N::of(0));
        if (!(low.by_y.high < -low.noise)) {
            neglect(low.length, low.noise);
            return {t < 0 ? -1.0 : 1.0, 0, 0, false};
        }
        double from = 0, to = y.high;
        next_place next;
        for (int step = 0;; ++step) {
            const double width = plain_sum(to, -from);
            next.look(low.length, low.by_y.high, high.length, high.by_y.high, width);
            const N slope = (low.by_x * high.by_y - high.by_x * low.by_y) / (high.by_y - low.by_y);
            const slope_of_chords found{slope.high, greatest(low.noise, high.noise), next.bound, true};
            double middle = plain_sum(from, plain_product(width, next.share));
            if (!(middle > from && middle < to)) middle = plain_sum(from, width / 2);
            if (step == most_steps || is_least(next.bound, 0) || !(middle > from && middle < to)) {
                neglect(next.bound, 2 * found.noise);
                return found;
            }
            const seen s = look(x, N::of(middle));
            if (!(absolute(s.by_y.high) > s.noise)) {
                neglect(s.length, 2 * s.noise);
                return {s.by_x.high, s.noise, s.length, true};
            }
            const bool falls = s.by_y.high < 0;
            next.narrow(falls ? plain_sum(middle, -from) : plain_sum(to, -middle), width);
            (falls ? from : to) = middle;
            (falls ? low : high) = s;
        }
    }
};

/// In sums of two doubles. Seldom called: out of line.
ABUT_NOINLINE ABUT_HD constexpr place_on_disc search_disc_closely(const revolution_profile& solid,
                                                                  const vec3<double>& center, const vec3<double>& normal,
                                                                  double radius, double size, double best) {
    return disc_search<contact_math::two_doubles>(solid, center, normal, radius, size).find(best);
}

/// Gathers ways to a solid, from discs too.
template <scalar T, bool Touching>
class disc_way_finder : public revolution_way_finder<T, Touching> {
    using base = revolution_way_finder<T, Touching>;

public:
    using base::base;

    /// From a disc with a normal of length 1.
    ABUT_HD constexpr void offer_disc(const vec3<T>& center, const vec3<double>& seen, const vec3<double>& normal,
                                      double radius) {
        place_on_disc at =
            disc_search<contact_math::one_double>(this->solid_, seen, normal, radius, this->size_).find(this->length_);
        if (!at.is_sure) at = search_disc_closely(this->solid_, seen, normal, radius, this->size_, this->length_);
        if (!(at.length < this->length_)) return;
        this->offer(at.from_solid.foot, at.from_solid.way, center, at.at);
    }
};

/// Gathers the ways from the side and the discs of a cylinder, t, to a solid.
template <scalar T>
class cylinder_way_finder : public disc_way_finder<T, false> {
    using base = disc_way_finder<T, false>;

public:
    template <solid_of_revolution S>
    ABUT_HD constexpr cylinder_way_finder(const S& s, const cylinder<T>& t, const length_unit<T>& in) : base(s, in) {
        const revolution_profile cylinder(t, in);
        this->size_ = greatest(this->size_, cylinder.radius);
        const segment<T>& axis = t.axis;
        const vec3<double> first = this->see(axis.a), last = this->see(axis.b);
        this->offer_edge(axis.a, this->place_of(first), this->place_of(last), way_between(axis.a, axis.b, in));
        const vec3<double> z = this->best.to_a;
        const way_from_foot side = way_from_solid(cylinder, plain_difference(z, first));
        this->offer(z, contact_math::negated(side.way), axis.a, side.foot);
        this->offer_disc(axis.a, first, cylinder.axis, cylinder.radius);
        this->offer_disc(axis.b, last, cylinder.axis, cylinder.radius);
    }
};

/// Which of two cylinders, or of two cones, comes first: an order of their numbers.
template <solid_of_revolution S>
ABUT_HD constexpr bool precedes(const S& s, const S& t) {
    if (s.radius != t.radius) return s.radius < t.radius;
    const auto a = axis_of(s), b = axis_of(t);
    const auto of_s = in_a_row(a.a, a.b), of_t = in_a_row(b.a, b.b);
    for (int i = 0; i < 6; ++i) {
        if (of_s.value[i] != of_t.value[i]) return of_s.value[i] < of_t.value[i];
    }
    return false;
}

template <scalar T>
ABUT_HD constexpr nearest_way<T> reversed(const nearest_way<T>& w) {
    return {w.square, contact_math::negated(w.way), w.from_b, w.from_a, w.to_b, w.to_a};
}

/// Between two cylinders that have axes: the same in either order. The discs of the first are searched.
template <bool Touching, scalar T>
ABUT_HD constexpr nearest_way<T> nearest_way_from(const cylinder<T>& s, const cylinder<T>& t, const length_unit<T>& unit) {
    const bool swap = precedes(s, t);
    const nearest_way<T> best = cylinder_way_finder<T>(swap ? t : s, swap ? s : t, unit).best;
    return swap ? reversed(best) : best;
}

/// Between a cone and a cylinder that have axes.
template <bool Touching, scalar T>
ABUT_HD constexpr nearest_way<T> nearest_way_from(const cone<T>& s, const cylinder<T>& t, const length_unit<T>& unit) {
    return cylinder_way_finder<T>(s, t, unit).best;
}

}  // namespace abut::detail
