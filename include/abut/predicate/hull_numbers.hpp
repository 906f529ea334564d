// SPDX-License-Identifier: MIT
#pragma once

// Two convex hulls in the kinds of numbers that the search of gjk.hpp works in: the input's type (`fast`), double with
// certificates (`filtered`), and integers of as many limbs as the input needs. The last begins where the one in double
// ended, so that it mostly has to confirm.
//
// Why the certificates hold. u = 2^-52, so that every bound holds in each rounding mode, with and without contraction.
//
// Apart. Points are seen from the first point of a; r are the true ones and M the largest magnitude of a coordinate. A
// computed coordinate is within u of itself, so a computed g . r is within 5u |g| M, with the sum of magnitudes |g|, and the
// difference of a least and a greatest one within 12u |g| M. The code takes 16u.
//
// Touching. The origin is inside of a tetrahedron of differences if the four determinants of three of them, with alternating
// signs, are all positive or all negative. A computed one is within 8u of the sum of its products' magnitudes; the code
// takes 16u. And two equal points touch.
//
// Underflow: a float that is read as 0 is off by less than 2^-126, and so a difference by less than 2^-125; products lose
// less than 2^-1020. Overflow makes a comparison false, since what may overflow is compared with 2^1000 first.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/predicate/certified_ball.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/kept_points.hpp>
#include <abut/shape/corners.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/shape.hpp>

namespace abut::detail {

/// A hull in the place of its points.
template <scalar T>
struct hull_itself {
    const hull<T>& of;
    ABUT_HD constexpr const hull<T>& as_hull() const { return of; }
};
/// The points whose hull a shape is, where they are at hand.
///@{
template <scalar T>
ABUT_HD constexpr hull_itself<T> points_of(const hull<T>& h) {
    return {h};
}
template <has_corners S>
ABUT_HD constexpr auto points_of(const S& s) {
    return core_of(s);
}
///@}

/// Shapes that are hulls of points, of the scalar type T.
template <class S, class T>
concept made_of_points = std::same_as<scalar_type_of<S>, T> && requires(const S& s) {
    points_of(s).as_hull();
};

/// Of what differences lose where small numbers are read as 0.
template <scalar T>
inline constexpr double lost_of_differences = std::same_as<T, float> ? 0x1p-120 : 0x1p-1000;

/// The sign of p . (q x r), of differences of input of type T, or 0 where it is not certain.
template <scalar T>
ABUT_HD constexpr int certain_side(const vec3<double>& p, const vec3<double>& q, const vec3<double>& r) {
    const vec3<double> a = absolute(p), b = absolute(q), c = absolute(r);
    const double sum = a.x * (b.y * c.z + b.z * c.y) + a.y * (b.z * c.x + b.x * c.z) + a.z * (b.x * c.y + b.y * c.x);
    const double length = greatest(magnitudes(p), magnitudes(q), magnitudes(r)), lost = lost_of_differences<T>;
    const double bound = 0x1p-48 * sum + (lost * 0x1p4 * length * length + 0x1p-960), volume = dot(p, cross(q, r));
    if (!(length < 0x1p300)) return 0;
    return volume > bound ? 1 : volume < -bound ? -1 : 0;
}

/// The largest magnitude of a coordinate in a box.
ABUT_HD constexpr double farthest_coordinate(const aabb<double>& box) {
    const vec3<double> far = greatest(absolute(box.lower), absolute(box.upper));
    return greatest(far.x, far.y, far.z);
}

/// Whether the tetrahedron of four differences holds the origin, for certain.
template <scalar T>
ABUT_HD constexpr bool hold_origin(const vec3<double> (&w)[4]) {
    const int side = certain_side<T>(w[1], w[2], w[3]);
    return side != 0 && certain_side<T>(w[0], w[3], w[2]) == side && certain_side<T>(w[0], w[1], w[3]) == side &&
           certain_side<T>(w[0], w[2], w[1]) == side;
}

/// Two hulls in numbers of type F: the input's own, for `fast`, or double with the certificates above.
template <bool Certified, scalar T>
class hulls_in_floats {
public:
    using number = std::conditional_t<Certified, double, T>;
    static constexpr int most_steps = 64;

    ABUT_HD constexpr hulls_in_floats(const hull<T>& a, const hull<T>& b)
        : a_(a), b_(b), origin_(a[0]), kept_a_(a), kept_b_(b) {
        const vec3<number> middle_a = middle_of(a, kept_a_), middle_b = middle_of(b, kept_b_);
        middle_way_ = middle_a - middle_b;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<number> way_between_middles() const { return middle_way_; }
    [[nodiscard]] ABUT_HD constexpr vec3<number> difference(std::uint32_t i, std::uint32_t j) const {
        return seen(a_[i], b_[j]);
    }
    ABUT_HD constexpr void look_back(const vec3<number>& way, std::uint32_t& i, std::uint32_t& j) const {
        look_back(a_, kept_a_, way, i);
        look_back(b_, kept_b_, {-way.x, -way.y, -way.z}, j);
    }
    /// How far a difference lies ahead of the origin along a way, times the length of the way.
    [[nodiscard]] ABUT_HD constexpr number ahead(const vec3<number>& way, std::uint32_t i, std::uint32_t j) const {
        return dot(way, seen(a_[i], origin_)) - dot(way, seen(b_[j], origin_));
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<number>& way, std::uint32_t i, std::uint32_t j) const {
        if constexpr (Certified) {
            const double length = magnitudes(way), reach = length * size_;
            return reach < 0x1p1000 && ahead(way, i, j) > 0x1p-48 * reach + (lost_of_differences<T> * length + 0x1p-1000);
        } else {
            return ahead(way, i, j) > 0;
        }
    }
    /// The largest magnitude of a coordinate, as points are seen.
    [[nodiscard]] ABUT_HD constexpr double size() const { return size_; }
    ABUT_HD constexpr verdict holds_origin(const vec3<number> (&w)[4], const difference_simplex& at) const {
        if constexpr (!Certified) {
            return verdict::yes;
        } else {
            return at.count == 4 && hold_origin<T>(w) ? verdict::yes : when_lost(at);
        }
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex& at) const {
        if constexpr (!Certified) return verdict::yes;
        bool shared = false;
        for (int k = 0; k < at.count; ++k) shared = shared || same_bits(a_[at.a[k]], b_[at.b[k]]);
        return shared ? verdict::yes : verdict::unknown;
    }

private:
    ABUT_HD static constexpr vec3<number> seen(const vec3<T>& p, const vec3<T>& from) {
        if constexpr (Certified) {
            return relative_to(from, p);
        } else {
            return p - from;
        }
    }
    ABUT_HD constexpr void look_back(const hull<T>& h, const kept_points<number, T>& kept, const vec3<number>& way,
                                     std::uint32_t& first) const {
        number back = infinity<number>;
        kept.look_back(way, back, first);
        for (std::size_t k = kept.size(); k < h.count; ++k) {
            const number x = dot(way, seen(h[k], origin_));
            if (x < back) back = x, first = static_cast<std::uint32_t>(k);
        }
    }
    /// The mean of a hull's points, which on the way are seen from the origin and count for the size of all. For `fast` they
    /// are added one by one, as a device does.
    ABUT_HD constexpr vec3<number> middle_of(const hull<T>& h, kept_points<number, T>& kept) {
        vec3<number> sum{0, 0, 0};
        kept.see_from({static_cast<number>(origin_.x), static_cast<number>(origin_.y), static_cast<number>(origin_.z)});
        if constexpr (Certified) {
            size_ = greatest(size_, kept.size_of_all());
            sum = kept.sum();
        } else {
            for (std::size_t i = 0; i < kept.size(); ++i) sum = sum + kept[i];
        }
        for (std::size_t i = kept.size(); i < h.count; ++i) {
            const vec3<number> r = seen(h[i], origin_);
            if constexpr (Certified) size_ = greatest(size_, absolute(r.x), absolute(r.y), absolute(r.z));
            sum = sum + r;
        }
        return (1 / static_cast<number>(h.count)) * sum;
    }
    ABUT_HD static constexpr bool same_bits(T x, T y) {
        using word = typename float_format<T>::word;
        return ABUT_BIT_CAST(word, x) == ABUT_BIT_CAST(word, y);
    }
    ABUT_HD static constexpr bool same_bits(const vec3<T>& p, const vec3<T>& q) {
        return same_bits(p.x, q.x) && same_bits(p.y, q.y) && same_bits(p.z, q.z);
    }

    const hull<T>&a_, &b_;
    vec3<T> origin_;
    vec3<number> middle_way_{0, 0, 0};
    double size_ = 0;
    kept_points<number, T> kept_a_, kept_b_;
};

/// The unit of two hulls' coordinates, and how many bits the largest takes in it.
template <scalar T>
struct unit_of_hulls {
    int low = 1 << 20, high = -(1 << 20);

    /// And of a radius and a distance, if there are any.
    ABUT_HD constexpr unit_of_hulls(const hull<T>& a, const hull<T>& b, T radius = 0, double distance = 0) {
        include(a);
        include(b);
        include(radius);
        include(distance);
    }
    [[nodiscard]] ABUT_HD constexpr int width() const { return high > low ? high - low : 1; }

private:
    ABUT_HD constexpr void include(const hull<T>& h) {
        ABUT_ROLLED
        for (std::size_t i = 0; i < h.count; ++i) {
            const vec3<T> p = h[i];
            include(p.x);
            include(p.y);
            include(p.z);
        }
    }
    template <scalar F>
    ABUT_HD constexpr void include(F x) {
        const binary_parts p = take_apart(x);
        if (p.mantissa == 0) return;
        low = p.exponent < low ? p.exponent : low;
        high = p.exponent + p.bits > high ? p.exponent + p.bits : high;
    }
};

/// Bits beside those of a coordinate that differences of differences, a sign and sums of their products take.
inline constexpr int spare_bits = 4;

/// Limbs of a difference that are enough for any finite input.
template <scalar T>
inline constexpr int limbs_of_any = (float_format<T>::max_exponent - float_format<T>::min_exponent +
                                     float_format<T>::digits + spare_bits + 63) /
                                    64;

/// The bits that the magnitude of an integer takes.
template <int Room>
ABUT_HD constexpr int bits_of(rolled_int<Room> n) {
    n.drop_sign();
    return bits_of_limbs(n.limb, n.count);
}
/// n 2^-top times a sense of 1 or -1: within u = 2^-52 of itself, but for less than 2^-695 that is left out.
template <int Room>
ABUT_HD constexpr double rounded_part(rolled_int<Room> n, int top, int sense) {
    const int sign = n.sign() * sense;
    n.drop_sign();
    double sum = 0;
    ABUT_ROLLED
    for (int i = 0; i < n.count; ++i) {
        const int e = 64 * i - top;
        if (e <= -760 || n.limb[i] == 0) continue;  // a limb is below 2^(e + 64)
        sum += static_cast<double>(n.limb[i]) * ABUT_BIT_CAST(double, static_cast<std::uint64_t>(e + 1023) << 52);
    }
    return sign < 0 ? -sum : sum;
}
/// A vector of integers, or its opposite for a sense of -1, with its largest coordinate brought to 1.
template <int Room>
ABUT_NOINLINE ABUT_HD constexpr vec3<double> rounded_way(const vec3<rolled_int<Room>>& v, int sense) {
    const int top = greatest(bits_of(v.x), bits_of(v.y), bits_of(v.z));
    return {rounded_part(v.x, top, sense), rounded_part(v.y, top, sense), rounded_part(v.z, top, sense)};
}

/// Two hulls in integers, whose differences have no more than `Room` limbs. With coordinates below 2^w a difference of
/// differences is below 2^(w + 2), and sums of products of d of them below 2^(d (w + 2) + d): so w + 4 bits for each factor
/// leave room for the sum and its sign.
///
/// Where they are `Sifted`, points are compared in double first, and only those that rounding leaves open in integers. The
/// answer is the same.
template <int Room, scalar T, bool Sifted>
class hulls_in_integers {
public:
    using number = rolled_int<Room>;
    static constexpr int most_steps = 0x7fffffff;  // it ends

    ABUT_HD constexpr hulls_in_integers(const hull<T>& a, const hull<T>& b, const unit_of_hulls<T>& unit)
        : a_(a), b_(b), low_(unit.low), limbs_((unit.width() + spare_bits + 63) / 64) {}

    [[nodiscard]] ABUT_HD constexpr vec3<number> difference(std::uint32_t i, std::uint32_t j) const {
        return between(b_[j], a_[i]);
    }
    ABUT_HD constexpr void look_back(const vec3<rolled_int<3 * Room>>& way, std::uint32_t& i, std::uint32_t& j) const {
        i = farthest(a_, way, -1);
        j = farthest(b_, way, 1);
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<rolled_int<3 * Room>>& way, std::uint32_t i,
                                                   std::uint32_t j) const {
        return sign_of_dot(way, difference(i, j)) > 0;
    }
    /// The sum of a radius and a distance.
    [[nodiscard]] ABUT_HD constexpr number reach(T radius, double distance) const {
        number r;
        r.begin(limbs_);
        add(r, radius, false);
        add(r, distance, false);
        return r;
    }
    ABUT_HD constexpr verdict holds_origin(const vec3<number> (&)[4], const difference_simplex&) const {
        return verdict::yes;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }

    /// From one point of the input to another.
    [[nodiscard]] ABUT_HD constexpr vec3<number> between(const vec3<T>& from, const vec3<T>& to) const {
        return {between(from.x, to.x), between(from.y, to.y), between(from.z, to.z)};
    }
    /// From there to a point times 2^exponent.
    [[nodiscard]] ABUT_HD constexpr vec3<number> between(const vec3<T>& from, const vec3<double>& to, int exponent) const {
        return {between(from.x, to.x, exponent), between(from.y, to.y, exponent), between(from.z, to.z, exponent)};
    }

private:
    template <scalar F>
    ABUT_HD constexpr number between(T from, F to, int exponent = 0) const {
        number r;
        r.begin(limbs_);
        add(r, to, false, exponent);
        add(r, from, true);
        return r;
    }
    /// Of x 2^exponent, what is below the unit is cut off.
    template <scalar F>
    ABUT_HD constexpr void add(number& r, F x, bool negated, int exponent = 0) const {
        const binary_parts p = take_apart(x);
        if (p.mantissa == 0) return;
        const int up = p.exponent + exponent - low_;
        if (up >= 0) {
            add_shifted(r.limb, limbs_, p.mantissa, up, negated);
        } else if (up > -63) {
            add_shifted(r.limb, limbs_, p.mantissa / (std::int64_t{1} << -up), 0, negated);
        }
    }
    /// The first of the points that lie farthest along a way, or for a sense of -1 against it.
    ABUT_NOINLINE ABUT_HD constexpr std::uint32_t farthest(const hull<T>& h, const vec3<rolled_int<3 * Room>>& way,
                                                           int sense) const {
        std::uint32_t best = 0;
        vec3<T> at = h[0];
        const rough_scan rough(at, way, sense);
        double height = 0, off = 0;  // of the best, as far as double tells
        ABUT_ROLLED
        for (std::size_t k = 1; k < h.count; ++k) {
            const vec3<T> p = h[k];
            double height_p = 0, off_p = 0;
            if constexpr (Sifted) {
                rough.measure(p, height_p, off_p);
                if (height_p + off_p < height - off) continue;
            }
            if (!(Sifted && height_p - off_p > height + off) && sign_of_dot(way, between(at, p)) != sense) continue;
            best = static_cast<std::uint32_t>(k);
            at = p;
            height = height_p;
            off = off_p;
        }
        return best;
    }
    /// Heights along a way in double, as seen from a first point, and by how much they may be off: a coordinate of the way
    /// is within u = 2^-52 of itself, one of a difference too, and so a height is within 7u of its products' magnitudes. The
    /// code takes 16u, twice that for the rounding of what is compared. The way's largest coordinate is brought to 1, and
    /// less than 2^-695 of it is left out. What is not a number leaves all open.
    struct rough_scan {
        vec3<T> first;
        vec3<double> way{0, 0, 0};

        ABUT_HD constexpr rough_scan(const vec3<T>& from, const vec3<rolled_int<3 * Room>>& along, int sense) : first(from) {
            if constexpr (Sifted) way = rounded_way(along, sense);
        }
        ABUT_HD constexpr void measure(const vec3<T>& p, double& height, double& off) const {
            constexpr double tiny = std::same_as<T, float> ? 0x1p-120 : 0x1p-960;
            const vec3<double> r = relative_to(first, p);
            height = dot(way, r);
            off = 0x1p-48 * dot(absolute(way), absolute(r)) + (0x1p-690 * magnitudes(r) + tiny);
            if (!(off < 0x1p900)) off = infinity<double>;
        }
    };

    const hull<T>&a_, &b_;
    int low_, limbs_;
};

/// Where the search in double comes to: a simplex for the one in integers to begin with. It decides nothing.
template <sought What, scalar T>
ABUT_NOINLINE ABUT_HD constexpr difference_simplex guess_simplex(const hull<T>& a, const hull<T>& b) {
    difference_simplex at;
    if (!ABUT_CONSTANT_EVALUATED()) {
        vec3<double> w[4];
        (void)search_origin<What>(hulls_in_floats<true, T>(a, b), at, w);
    }
    return at;
}

}  // namespace abut::detail
