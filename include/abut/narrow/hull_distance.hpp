// SPDX-License-Identifier: MIT
#pragma once

// How far apart two convex hulls are, and where: hulls of points, the shapes that are hulls of their corners, and what is
// within a radius of these. The search of predicate/gjk.hpp for the feature of all differences that is nearest to the
// origin, first in doubles whose operations are rounded one by one, then in integers, which confirm it. The squared distance
// and the weights of the points that it lies between are quotients of integers; they become doubles at the end. So nothing
// is lost where hulls are thin, or nearly parallel, and the bits are the same on every compiler and device.
//
// Where it is known whether the shapes touch, the doubles often do. Any vector v tells that no two points of the hulls are
// nearer to each other than its least product with a difference of their points, over |v|. And where v is a mean of
// differences, two points are as near as |v|. Where both numbers nearly agree, |v| is the distance, however thin a feature
// is. Let u be 2^-53 and D the largest difference. The mean is off by less than 9u D, so that much may be missing in the
// upper bound. Two points that are farthest along v are told by products that are off by 4u |v| D, each of which can mistake
// two points by twice that, and their difference's product is off by as much again: 20u D in the lower bound. If the two are
// 4u D apart at most, the distance is no less than |v| - 28u D and no more than |v| + 9u D. And of hulls that touch, a mean
// that is no longer than 4u D tells a point of each that are no farther apart than 13u D.
//
// So the doubles mostly tell whether the shapes touch, and then nobody else is asked. D is no more than 4 times the largest
// coordinate L, so that 28u D is below 2^-46 L: shapes are apart if what is measured is longer than their radii by 2^-44 L.
// That the origin is inside of a tetrahedron has the certificate of hull_numbers.hpp.
//
// Integers of two words for each degree do, for any input: what of a coordinate is below 2^-124 of the largest one is cut
// off. That changes a distance by less than 2^-120 of the largest coordinate, which is far below what rounding does. It may
// make hulls meet that do not touch: so integers are not what tells whether shapes do.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

namespace contact_math {

// What the search asks of a number, in namespace of the number.
ABUT_HD constexpr int sign(one_double x) { return (x.high > 0) - (x.high < 0); }
ABUT_HD constexpr int sign_of_dot(const vec3<one_double>& a, const vec3<one_double>& b) { return sign(dot(a, b)); }

/// value 2^exponent
struct far_double {
    double value;
    int exponent;
};

/// The magnitude of an integer, in its first 64 bits.
template <int Room>
ABUT_HD constexpr far_double magnitude_of(rolled_int<Room> n) {
    n.drop_sign();
    const int bits = bits_of_limbs(n.limb, n.count);
    if (bits == 0) return {0, 0};
    const int cut = bits > 64 ? bits - 64 : 0, whole = cut / 64, part = cut % 64;
    std::uint64_t top = n.limb[whole] >> part;
    if (part != 0 && whole + 1 < n.count) top |= n.limb[whole + 1] << (64 - part);
    return {static_cast<double>(top), cut};
}

/// The unit vector along one of integers: within 2^-50 of itself in each coordinate.
template <int Room>
ABUT_HD constexpr point unit_of(const vec3<rolled_int<Room>>& v) {
    return unit_vector(as<one_double>(rounded_way(v, 1)));
}

/// x 2^e for any e.
ABUT_HD constexpr double scaled_far(double x, int e) { return e < -2040 ? 0 : scaled(x, e > 2040 ? 2040 : e); }

}  // namespace contact_math

/// Two hulls in doubles whose operations are rounded one by one; where squares of squares would leave the range, in another
/// unit.
template <scalar T>
class hulls_in_plain_doubles {
public:
    using number = contact_math::one_double;
    static constexpr int most_steps = 64;

    /// Of which it is known whether they touch, or not.
    ABUT_HD constexpr hulls_in_plain_doubles(const hull<T>& a, const hull<T>& b, verdict known)
        : a_(a),
          b_(b),
          kept_a_(a, fewest_climbed(known)),
          kept_b_(b, fewest_climbed(known)),
          box_a_(box_around(a, kept_a_, kept_a_.inner_box())),
          box_b_(box_around(b, kept_b_, kept_b_.inner_box())),
          are_boxes_whole_(!kept_a_.are_climbed() && !kept_b_.are_climbed()) {
        const double sure = greatest(farthest_coordinate(box_a_), farthest_coordinate(box_b_));
        largest_ = sure;
        if (kept_a_.are_climbed()) largest_ = greatest(largest_, kept_a_.size_of_all());
        if (kept_b_.are_climbed()) largest_ = greatest(largest_, kept_b_.size_of_all());
        if (std::same_as<T, double> && (largest_ > 0x1p200 || sure < 0x1p-200)) {
            if (!are_boxes_whole_) {
                box_a_ = box_around(a, kept_a_, kept_a_.box());
                box_b_ = box_around(b, kept_b_, kept_b_.box());
                are_boxes_whole_ = true;
                largest_ = greatest(farthest_coordinate(box_a_), farthest_coordinate(box_b_));
            }
            const bool far = largest_ > 0x1p200 || largest_ < 0x1p-200;
            if (largest_ > 0 && far) down_ = -contact_math::exponent_of(largest_) - 2;
        }
        keep_as_seen(kept_a_, b[0]);
        keep_as_seen(kept_b_, a[0]);
    }
    /// Around the hulls, if they are whole; or around some points of each.
    ///@{
    [[nodiscard]] ABUT_HD constexpr aabb<T> box_a() const { return narrowed(box_a_); }
    [[nodiscard]] ABUT_HD constexpr aabb<T> box_b() const { return narrowed(box_b_); }
    [[nodiscard]] ABUT_HD constexpr bool are_boxes_whole() const { return are_boxes_whole_; }
    ///@}
    /// Around a hull.
    ABUT_NOINLINE ABUT_HD static constexpr aabb<T> whole_box(const hull<T>& h) {
        const kept_points<double, T> kept(h);
        return narrowed(box_around(h, kept, kept.box()));
    }
    [[nodiscard]] ABUT_HD constexpr vec3<number> difference(std::uint32_t i, std::uint32_t j) const {
        return seen(widened(a_[i]), widened(b_[j]));
    }
    /// Points are seen from one of the other hull, from which none is farther than the largest difference.
    ABUT_HD constexpr void look_back(const vec3<number>& way, std::uint32_t& i, std::uint32_t& j) const {
        look_back(a_, kept_a_, b_, way, i);
        look_back(b_, kept_b_, a_, {-way.x, -way.y, -way.z}, j);
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<number>&, std::uint32_t, std::uint32_t) const { return false; }
    ABUT_HD constexpr verdict holds_origin(const vec3<number> (&)[4], const difference_simplex&) const {
        return verdict::yes;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }

    /// The least product of v with a difference, but for rounding.
    [[nodiscard]] ABUT_HD constexpr number least_product(const vec3<number>& v) const {
        std::uint32_t i = 0, j = 0;
        look_back(v, i, j);
        return dot(v, difference(i, j));
    }
    /// A length in units of the hulls, times a power of two.
    [[nodiscard]] ABUT_HD constexpr double length_of(const number& x, int exponent) const {
        return contact_math::scaled(x.high, exponent - down_);
    }
    /// No coordinate is larger.
    [[nodiscard]] ABUT_HD constexpr double largest() const { return largest_; }
    /// Whether hulls whose distance was measured are farther apart than some length, for sure.
    [[nodiscard]] ABUT_HD constexpr bool are_surely_beyond(double length, double measured) const {
        const double off = 0x1p-44 * (largest_ + length) + 8 * lost_of_differences<T>;
        return down_ == 0 && measured - length > off;
    }
    /// Whether they meet, for sure, where a simplex of differences seems to hold the origin.
    [[nodiscard]] ABUT_HD constexpr bool surely_meet(const vec3<number> (&w)[4], const difference_simplex& at) const {
        if (down_ != 0 || at.count != 4) return false;
        vec3<double> v[4];
        for (int k = 0; k < 4; ++k) v[k] = contact_math::rounded_off(w[k]);
        return hold_origin<T>(v);
    }

private:
    ABUT_HD constexpr vec3<number> seen(vec3<double> p, vec3<double> from) const {
        if (down_ != 0) p = contact_math::scaled(p, down_), from = contact_math::scaled(from, down_);
        return contact_math::between<number>(from, p);
    }
    /// Of numbers that are of T.
    ABUT_HD static constexpr aabb<T> narrowed(const aabb<double>& box) {
        const vec3<double>&l = box.lower, &u = box.upper;
        return {{static_cast<T>(l.x), static_cast<T>(l.y), static_cast<T>(l.z)},
                {static_cast<T>(u.x), static_cast<T>(u.y), static_cast<T>(u.z)}};
    }
    ABUT_HD static constexpr std::size_t fewest_climbed(verdict known) {
        using kept = kept_points<double, T>;
        return known == verdict::yes ? kept::fewest_climbed_for_numbers : kept::fewest_climbed;
    }
    /// That of the kept points, and of the others.
    ABUT_HD static constexpr aabb<double> box_around(const hull<T>& h, const kept_points<double, T>& kept, aabb<double> box) {
        for (std::size_t i = kept.size(); i < h.count; ++i) box = merge(box, bounds(widened(h[i])));
        return box;
    }
    ABUT_HD constexpr void keep_as_seen(kept_points<double, T>& kept, const vec3<T>& from) const {
        if (down_ == 0) return kept.see_from(widened(from));
        kept.replace([&](const vec3<double>& p) { return contact_math::rounded_off(seen(p, widened(from))); });
    }
    ABUT_HD constexpr void look_back(const hull<T>& h, const kept_points<double, T>& kept, const hull<T>& other,
                                     const vec3<number>& way, std::uint32_t& first) const {
        number back{infinity<double>};
        kept.look_back(contact_math::rounded_off(way), back.high, first);
        if (kept.size() == h.count) return;
        const vec3<double> from = widened(other[0]);
        for (std::size_t k = kept.size(); k < h.count; ++k) {
            const number x = dot(way, seen(widened(h[k]), from));
            if (x < back) back = x, first = static_cast<std::uint32_t>(k);
        }
    }

    const hull<T>&a_, &b_;
    double largest_ = 0;  ///< coordinate, or not much more
    int down_ = 0;
    kept_points<double, T> kept_a_, kept_b_;
    aabb<double> box_a_, box_b_;
    bool are_boxes_whole_;
};

/// Points of two hulls that are as near to each other as any, as means of the hulls' points, and their distance; or, where
/// the hulls seem to touch, of one point of both, and 0. Where differences of coordinates, or a radius around one hull, might
/// be more than a double holds, lengths and ways are 2^-down of themselves.
template <scalar T>
struct nearest_in_hulls {
    difference_simplex at;
    double weight[4] = {1, 0, 0, 0};
    int down = 0;
    double length = 0;
    aabb<T> box_a, box_b;  ///< around the hulls, if they are whole; or around some points of each
    bool are_boxes_whole = true;

    /// Where it is known whether the shapes touch, another feature may be taken that is as near, but for rounding.
    ABUT_NOINLINE ABUT_HD constexpr nearest_in_hulls(const hull<T>& a, const hull<T>& b, double radii = 0,
                                                     verdict known = verdict::unknown) {
        vec3<contact_math::one_double> rough[4];
        const hulls_in_plain_doubles<T> doubles(a, b, known);
        down = down_for(greatest(doubles.largest(), radii));
        const verdict seems = search(doubles, rough);
        finish(a, b, doubles, rough, seems, known);
    }
    /// The same where it is not known whether shapes touch, of which the hulls are the cores and which reach `radii` around
    /// them. `touch` is set to that: what the doubles do not tell for sure, `ask()` does.
    template <class Ask>
    ABUT_NOINLINE ABUT_HD constexpr nearest_in_hulls(const hull<T>& a, const hull<T>& b, double radii, const Ask& ask,
                                                     bool& touch) {
        vec3<contact_math::one_double> rough[4];
        const hulls_in_plain_doubles<T> doubles(a, b, verdict::unknown);
        down = down_for(greatest(doubles.largest(), radii));
        const verdict seems = search(doubles, rough);
        if (seems != verdict::yes && measure_in_doubles(doubles, rough, verdict::no) &&
            doubles.are_surely_beyond(radii, length)) {
            touch = false;
            return;
        }
        touch = (seems == verdict::yes && doubles.surely_meet(rough, at)) || ask();
        finish(a, b, doubles, rough, seems, to_verdict(touch));
    }
    /// What the hulls are in integers.
    using integers = hulls_in_integers<2, T, true>;
    ABUT_HD static constexpr unit_of_hulls<T> unit_of(const hull<T>& a, const hull<T>& b) {
        return shortened(unit_of_hulls<T>(a, b));
    }
    /// With no more digits than these integers hold.
    ABUT_HD static constexpr unit_of_hulls<T> shortened(unit_of_hulls<T> unit) {
        unit.low = greatest(unit.low, unit.high - (64 * room - spare_bits));
        return unit;
    }
    /// The unit vector from b's point to a's, of hulls that do not touch: within 2^-50 in each coordinate, however near they
    /// are.
    [[nodiscard]] ABUT_HD constexpr vec3<double> direction(const integers& x) const {
        vec3<number> w[4];
        for (int k = 0; k < at.count; ++k) w[k] = x.difference(at.a[k], at.b[k]);
        nearest_feature<number> feature;
        (void)feature.find(w, at.count, (1u << at.count) - 1);
        return contact_math::unit_of(feature.way);
    }
    /// And so far beyond, 2^-down of it; rounded together, since both may be small where coordinates are large.
    ///@{
    [[nodiscard]] ABUT_HD constexpr vec3<double> point_on_a(const hull<T>& a, const vec3<double>& beyond) const {
        return mean(a, at.a, beyond);
    }
    [[nodiscard]] ABUT_HD constexpr vec3<double> point_on_b(const hull<T>& b, const vec3<double>& beyond) const {
        return mean(b, at.b, beyond);
    }
    ///@}
    /// From a's point to b's: of differences, which are rounded once, and so as long as the distance wherever rounding lets
    /// it.
    [[nodiscard]] ABUT_HD constexpr vec3<double> way(const hull<T>& a, const hull<T>& b) const {
        vec3<double> sum{0, 0, 0};
        for (int k = 0; k < at.count; ++k) {
            const vec3<double> w = contact_math::plain_difference(shrunk(b[at.b[k]]), shrunk(a[at.a[k]]));
            sum = plain_step(sum, weight[k], w);
        }
        return sum;
    }

private:
    static constexpr int room = 2;
    using number = rolled_int<room>;

    /// In doubles.
    ABUT_HD constexpr verdict search(const hulls_in_plain_doubles<T>& doubles, vec3<contact_math::one_double> (&rough)[4]) {
        box_a = doubles.box_a();
        box_b = doubles.box_b();
        are_boxes_whole = doubles.are_boxes_whole();
        return search_origin<sought::nearest>(doubles, at, rough);
    }
    /// From where the search in doubles came to.
    ABUT_HD constexpr void finish(const hull<T>& a, const hull<T>& b, const hulls_in_plain_doubles<T>& doubles,
                                  const vec3<contact_math::one_double> (&rough)[4], verdict seems, verdict known) {
        const bool may_do = known != verdict::unknown && !(known == verdict::no && seems == verdict::yes);
        if (may_do && measure_in_doubles(doubles, rough, known)) return;
        const unit_of_hulls<T> unit = unit_of(a, b);
        const integers x(a, b, unit);
        vec3<number> w[4];
        const bool meet = search_origin<sought::nearest>(x, at, w) == verdict::yes;
        measure(w, meet, unit.low);
    }
    ABUT_HD static constexpr int down_for(double largest) { return std::same_as<T, double> && largest > 0x1p1000 ? 8 : 0; }
    ABUT_HD constexpr vec3<double> shrunk(const vec3<T>& p) const {
        return down == 0 ? widened(p) : contact_math::scaled(widened(p), -down);
    }
    ABUT_HD constexpr vec3<double> mean(const hull<T>& h, const std::uint32_t (&ids)[4], vec3<double> sum) const {
        const vec3<double> first = shrunk(h[ids[0]]);
        for (int k = 1; k < at.count; ++k) {
            sum = plain_step(sum, weight[k], contact_math::plain_difference(shrunk(h[ids[k]]), first));
        }
        const vec3<double> p = plain_step(first, 1, sum);
        return down == 0 ? p : contact_math::scaled(p, down);
    }

    /// From the search in doubles. False, with nothing changed, where these do not tell enough.
    ABUT_NOINLINE ABUT_HD constexpr bool measure_in_doubles(const hulls_in_plain_doubles<T>& x,
                                                            const vec3<contact_math::one_double> (&w)[4], verdict known) {
        using contact_math::one_double;
        one_double share[4] = {{1}, {0}, {0}, {0}};
        if (at.count == 2) {
            const auto e = w[1] - w[0];
            share[0] = dot(e, w[1]);
            share[1] = -dot(e, w[0]);
        } else if (at.count == 3) {
            const auto normal = cross(w[1] - w[0], w[2] - w[0]);
            for (int k = 0; k < 3; ++k) share[k] = dot(normal, cross(w[k == 2 ? 0 : k + 1], w[k == 0 ? 2 : k - 1]));
        } else if (at.count == 4) {
            for (int k = 0; k < 4; ++k) {
                const one_double volume = dot(w[(k + 1) & 3], cross(w[(k + 2) & 3], w[(k + 3) & 3]));
                share[k] = k % 2 == 0 ? volume : -volume;
            }
        }
        const one_double sum = (share[0] + share[1]) + (share[2] + share[3]);
        vec3<one_double> v = w[0];
        double largest = 0, part[4] = {};
        for (int k = 0; k < at.count; ++k) {
            const one_double p = share[k] / sum;
            part[k] = p.high;
            if (!(p.high >= 0 && p.high <= 1)) return false;
            if (k > 0) v = v + vec3<one_double>{p * (w[k].x - w[0].x), p * (w[k].y - w[0].y), p * (w[k].z - w[0].z)};
            largest = greatest(largest, dot(w[k], w[k]).high);
        }
        if (!(largest > 0x1p-600 && largest < 0x1p900)) return false;
        const one_double far = root(dot(v, v));
        const double size = root(one_double{largest}).high;
        length = 0;
        if (known == verdict::no || far.high > 0x1p-51 * size) {
            // Integers measure what is much less than D.
            if (!(far.high > 0x1p-10 * size)) return false;
            // What lies between: along the way, or along the normal of a triangle, which is known to more digits.
            const auto shows = [&](const vec3<one_double>& n, const one_double& length_of_n) {
                return (far - x.least_product(n) / length_of_n).high <= 0x1p-51 * size;
            };
            if (!shows(v, far)) {
                if (at.count != 3) return false;
                auto n = cross(w[1] - w[0], w[2] - w[0]);
                if (dot(n, w[0]).high < 0) n = cross(w[2] - w[0], w[1] - w[0]);
                if (!shows(n, root(dot(n, n)))) return false;
            }
            length = x.length_of(far, -down);
        }
        for (int k = 0; k < at.count; ++k) weight[k] = part[k];
        return true;
    }
    ABUT_HD constexpr void measure(const vec3<number> (&w)[4], bool meet, int unit) {
        using contact_math::far_double;
        using contact_math::magnitude_of;
        far_double share[4] = {{1, 0}, {0, 0}, {0, 0}, {0, 0}}, over{0, 0}, under{1, 0};
        const vec3<number> e = w[1 < at.count ? 1 : 0] - w[0];
        if (at.count == 1) {
            over = magnitude_of(dot(w[0], w[0]));
        } else if (at.count == 2) {
            const auto moment = cross(w[0], e);
            share[0] = magnitude_of(dot(e, w[1]));
            share[1] = magnitude_of(dot(e, w[0]));
            over = magnitude_of(dot(moment, moment));
            under = magnitude_of(dot(e, e));
        } else if (at.count == 3) {
            const auto normal = cross(e, w[2] - w[0]);
            const auto height = dot(normal, w[0]);
            for (int k = 0; k < 3; ++k) {
                const int l = k == 2 ? 0 : k + 1, m = l == 2 ? 0 : l + 1;
                share[k] = magnitude_of(dot(normal, cross(w[l], w[m])));
            }
            over = magnitude_of(height * height);
            under = magnitude_of(dot(normal, normal));
        } else {
            for (int k = 0; k < 4; ++k) {
                share[k] = magnitude_of(dot(w[(k + 1) & 3], cross(w[(k + 2) & 3], w[(k + 3) & 3])));
            }
        }
        weigh(share);
        if (!meet) length = root_of_quotient(over, under, unit - down);
    }
    ABUT_HD constexpr void weigh(const contact_math::far_double (&share)[4]) {
        int highest = -1;
        for (int k = 0; k < at.count; ++k) {
            if (share[k].value > 0 && share[k].exponent > highest) highest = share[k].exponent;
        }
        double sum = 0;
        for (int k = 0; k < at.count; ++k) {
            weight[k] = contact_math::scaled_far(share[k].value, share[k].exponent - highest);
            sum = plain_sum(sum, weight[k]);
        }
        for (int k = 0; k < at.count; ++k) weight[k] /= sum;
    }
    /// The root of a quotient, times 2^unit.
    ABUT_HD static constexpr double root_of_quotient(const contact_math::far_double& over,
                                                     const contact_math::far_double& under, int unit) {
        int exponent = over.exponent - under.exponent;
        double quotient = over.value / under.value;
        if (exponent % 2 != 0) {
            quotient = plain_product(quotient, 2.0);
            --exponent;
        }
        return contact_math::scaled_far(contact_math::root(contact_math::one_double{quotient}).high, exponent / 2 + unit);
    }
};

/// A convex hull, and another one or a shape that is a hull of its corners, or what is within a radius of such a hull.
template <class S, class U>
concept measured_hulls = refers_to_memory<S> && requires(const U& t) {
    core_points_of(t);
};

/// Two such shapes, whose cores are hulls.
template <scalar T>
struct measured_hull_pair {
    nearest_in_hulls<T> nearest;
    double radius_a, radius_b;
    const hull<T>&a, &b;

    ABUT_HD constexpr measured_hull_pair(const hull<T>& of_a, T around_a, const hull<T>& of_b, T around_b,
                                         verdict known = verdict::unknown)
        : nearest(of_a, of_b, static_cast<double>(greatest(around_a, around_b)), known),
          radius_a(static_cast<double>(around_a)),
          radius_b(static_cast<double>(around_b)),
          a(of_a),
          b(of_b) {}
    /// Of which it is not known whether they touch.
    template <class Ask>
    ABUT_HD constexpr measured_hull_pair(const hull<T>& of_a, T around_a, const hull<T>& of_b, T around_b, const Ask& ask,
                                         bool& touch)
        : nearest(of_a, of_b, plain_sum(static_cast<double>(around_a), static_cast<double>(around_b)), ask, touch),
          radius_a(static_cast<double>(around_a)),
          radius_b(static_cast<double>(around_b)),
          a(of_a),
          b(of_b) {}

    [[nodiscard]] ABUT_HD constexpr double distance() const {
        if (nearest.down == 0) return plain_sum(nearest.length, -plain_sum(radius_a, radius_b));
        return contact_math::scaled(plain_sum(nearest.length, -plain_sum(shrunk(radius_a), shrunk(radius_b))), nearest.down);
    }
    [[nodiscard]] ABUT_HD constexpr vec3<double> way() const { return nearest.way(a, b); }
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_a() const { return narrowed(nearest.point_on_a(a, along_way(radius_a))); }
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_b() const { return narrowed(nearest.point_on_b(b, along_way(-radius_b))); }
    /// Of shapes that touch, one of which has no radius: a point of that one, which lies in both.
    [[nodiscard]] ABUT_HD constexpr vec3<T> shared_point() const { return radius_a == 0 ? point_on_a() : point_on_b(); }

private:
    [[nodiscard]] ABUT_HD constexpr vec3<double> along_way(double length) const {
        using namespace contact_math;
        return length == 0 ? point{0, 0, 0} : plain_step({0, 0, 0}, shrunk(length), unit_vector(as<one_double>(way())));
    }
    [[nodiscard]] ABUT_HD constexpr double shrunk(double length) const {
        return nearest.down == 0 ? length : contact_math::scaled(length, -nearest.down);
    }
    ABUT_HD static constexpr vec3<T> narrowed(const vec3<double>& p) {
        return {rounded_within<T>(p.x), rounded_within<T>(p.y), rounded_within<T>(p.z)};
    }
};

/// Calls f of the measured pair, of which it is known whether it touches. The hulls live as long as that takes.
template <class S, class U, class F>
ABUT_HD constexpr auto with_measured_hulls(const S& s, const U& t, bool touch, const F& f) {
    const auto points_a = core_points_of(s);
    const auto points_b = core_points_of(t);
    return f(measured_hull_pair<scalar_type_of<S>>(points_a.as_hull(), radius_around_core(s), points_b.as_hull(),
                                                   radius_around_core(t), to_verdict(touch)));
}
/// The same where that is not known, and ask() tells it: f is called of the pair and of whether it touches.
template <class S, class U, class Ask, class F>
ABUT_HD constexpr auto with_asked_hulls(const S& s, const U& t, const Ask& ask, const F& f) {
    const auto points_a = core_points_of(s);
    const auto points_b = core_points_of(t);
    using T = scalar_type_of<S>;
    const hull<T>&a = points_a.as_hull(), &b = points_b.as_hull();  // which measured hulls refer to
    bool touch = false;
    const measured_hull_pair<T> m(a, radius_around_core(s), b, radius_around_core(t), ask, touch);
    return f(m, touch);
}

}  // namespace abut::detail
