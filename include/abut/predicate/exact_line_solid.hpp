// SPDX-License-Identifier: MIT
#pragma once

// Whether a line meets a solid, and at what time first, of any finite input: in integers, by the polynomials of
// line_solid.hpp. They are computed in place, so that a kernel takes little time to compile and no number is copied.
//
// Times are fractions. What lies between two planes goes from one fraction to another one; so [x, y] is what is left of the
// time from 0 to 1 or without end. If q(x) <= 0, the line meets the part at x first. Else, if a > 0, it does so if q falls
// at x, and q(y) <= 0, or q rises at y and has roots: at the lesser root. If a <= 0, then if q(y) <= 0: at the root at which
// q falls. No root is taken: whether it is at a time z or before that is told by the signs of q and its slope at z.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/config.hpp>
#include <abut/predicate/line_solid.hpp>
#include <abut/shape/line_of.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Where a line meets a part of a solid first: nowhere, at a fraction, or at a root.
enum class first_met : int { nothing, fraction, root };

/// over / under, both of as many limbs. Under is above 0; 1 / 0 is infinite.
template <int Room>
struct long_fraction {
    rolled_int<Room> over, under;

    ABUT_HD constexpr void set(std::int64_t a, std::int64_t b) {
        over.clear(1);
        under.clear(1);
        add_shifted(over.limb, 1, a, 0, false);
        add_shifted(under.limb, 1, b, 0, false);
    }
    /// -a / b
    template <int A>
    ABUT_NOINLINE ABUT_HD constexpr void set_negative(const rolled_int<A>& a, const rolled_int<A>& b) {
        const bool is_negative = b.sign() < 0;
        over.clear(a.count);
        under.clear(a.count);
        over.add(a, !is_negative);
        under.add(b, is_negative);
    }
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool is_less_than(const long_fraction& other) const {
        rolled_int<2 * Room> difference;
        difference.clear(over.count + other.under.count);
        difference.add(over, other.under);
        difference.add(other.over, under, true);
        return difference.sign() < 0;
    }
};

/// Vectors of integers.
///@{
template <int A, int B, int C>
ABUT_NOINLINE ABUT_HD constexpr void set_dot(rolled_int<C>& r, const rolled_int<A> (&a)[3], const rolled_int<B> (&b)[3]) {
    r.clear(a[0].count + b[0].count);
    ABUT_ROLLED
    for (int i = 0; i < 3; ++i) r.add(a[i], b[i]);
}
template <int A, int B, int C>
ABUT_NOINLINE ABUT_HD constexpr void set_cross(rolled_int<C> (&r)[3], const rolled_int<A> (&a)[3],
                                               const rolled_int<B> (&b)[3]) {
    ABUT_ROLLED
    for (int k = 0; k < 3; ++k) {
        const int i = k == 2 ? 0 : k + 1, j = i == 2 ? 0 : i + 1;
        r[k].clear(a[0].count + b[0].count);
        r[k].add(a[i], b[j]);
        r[k].add(a[j], b[i], true);
    }
}
template <int A, int B, int C>
ABUT_NOINLINE ABUT_HD constexpr void set_product(rolled_int<C>& r, const rolled_int<A>& a, const rolled_int<B>& b) {
    r.clear(a.count + b.count);
    r.add(a, b);
}
template <int A, int B, int C>
ABUT_NOINLINE ABUT_HD constexpr void set_product(rolled_int<C> (&r)[3], const rolled_int<A>& a,
                                                 const rolled_int<B> (&b)[3]) {
    ABUT_ROLLED
    for (int i = 0; i < 3; ++i) set_product(r[i], a, b[i]);
}
///@}

template <scalar T>
class line_in_solid {
public:
    static constexpr int most = float_format<T>::max_exponent + float_format<T>::digits - float_format<T>::min_exponent,
                         room = (most + 4 + 63) / 64;
    /// Room for products of two numbers, and for all doubles.
    static constexpr int time_room = 2 * room > 18 ? 2 * room : 18;
    using fraction = long_fraction<time_room>;

    /// The numbers of a line and a solid, as values_of gives them.
    template <std::size_t V>
    ABUT_HD constexpr line_in_solid(const T (&value)[V], bool has_end) : has_end_(has_end) {
        const aligned<V> x(value);
        const int width = x.width() > 0 ? x.width() : 0, limbs = (width + 4 + 63) / 64;
        const auto difference = [&](auto& r, int i, int k) {
            r.clear(limbs);
            r.add(x, i);
            r.add(x, k, true);
        };
        ABUT_ROLLED
        for (int k = 0; k < 3; ++k) {
            difference(w_[k], k, 9 + k);
            difference(e_[k], 3 + k, 6 + k);
            difference(d_[k], 12 + k, 9 + k);
        }
        r_.clear(limbs);
        if constexpr (V > 15) r_.add(x, 15);
    }

    /// A part of a solid that is around an axis.
    ABUT_NOINLINE ABUT_HD constexpr first_met meet(solid_part part) {
        begin();
        if (part == solid_part::ball || part == solid_part::last_ball) {
            set_ball(part == solid_part::last_ball);
        } else {
            product s, k, length;
            set_dot(s, w_, d_);
            set_dot(k, e_, d_);
            set_dot(length, d_, d_);
            if (part == solid_part::cylinder) {
                set_cylinder(length);
            } else {
                set_cone(s, k);
                set_bend_of_cone(length);
            }
            clip(s, k, length);
        }
        if (is_empty()) return first_met::nothing;
        if (value_at(first_) <= 0) return first_met::fraction;
        if (a_.sign() > 0) {
            if (slope_at(first_) >= 0) return first_met::nothing;
            const bool is_met = value_at(last_) <= 0 || (slope_at(last_) > 0 && m_.sign() >= 0);
            return is_met ? first_met::root : first_met::nothing;
        }
        // A time without end is left to a direction of 0 alone, of which q is constant.
        if (last_.under.sign() == 0) return first_met::nothing;
        return value_at(last_) <= 0 ? first_met::root : first_met::nothing;
    }

    /// A box.
    ABUT_NOINLINE ABUT_HD constexpr first_met meet_box() {
        begin();
        ABUT_ROLLED
        for (int k = 0; k < 3; ++k) clip(w_[k], e_[k], d_[k]);
        return is_empty() ? first_met::nothing : first_met::fraction;
    }

    /// When it is met first, if that is a fraction.
    [[nodiscard]] ABUT_HD constexpr fraction& first() { return first_; }
    /// If that is a root, whether it is at the time z > 0 or before that.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr bool has_met_at(const fraction& z) const {
        const int value = value_at(z), slope = slope_at(z);
        return a_.sign() > 0 ? value <= 0 || slope >= 0 : value <= 0 && slope < 0;
    }

private:
    using number = rolled_int<room>;
    using product = rolled_int<2 * room>;
    using triple = rolled_int<3 * room>;

    ABUT_HD constexpr void begin() {
        first_.set(0, 1);
        last_.set(1, has_end_ ? 1 : 0);
        is_apart_ = false;
    }
    [[nodiscard]] ABUT_HD constexpr bool is_empty() const { return is_apart_ || last_.is_less_than(first_); }

    /// To where 0 <= height + t rise <= most.
    template <int A>
    ABUT_NOINLINE ABUT_HD constexpr void clip(const rolled_int<A>& height, const rolled_int<A>& rise,
                                              const rolled_int<A>& highest) {
        rolled_int<A> over;
        over.clear(height.count);
        over.add(height);
        over.add(highest, true);
        const int s = rise.sign();
        if (s == 0) {
            is_apart_ = is_apart_ || height.sign() < 0 || over.sign() > 0;
            return;
        }
        fraction time;
        time.set_negative(s > 0 ? height : over, rise);
        if (first_.is_less_than(time)) first_.set_negative(s > 0 ? height : over, rise);
        time.set_negative(s > 0 ? over : height, rise);
        if (time.is_less_than(last_)) last_.set_negative(s > 0 ? over : height, rise);
    }

    ABUT_NOINLINE ABUT_HD constexpr void set_ball(bool at_last) {
        number w[3];
        product x[3], rr;
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) {
            w[i].clear(r_.count);
            w[i].add(w_[i]);
            if (at_last) w[i].add(d_[i], true);
        }
        set_dot(a_, e_, e_);
        set_dot(b_, w, e_);
        set_dot(c_, w, w);
        c_.add(r_, r_, true);
        set_cross(x, w, e_);
        set_product(rr, r_, r_);
        set_product(m_, rr, a_);
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) m_.add(x[i], x[i], true);
    }
    ABUT_NOINLINE ABUT_HD constexpr void set_cylinder(const product& length) {
        product x[3], g[3], rr;
        triple along, opens[3];
        set_cross(x, w_, d_);
        set_cross(g, e_, d_);
        set_product(rr, r_, r_);
        set_dot(a_, g, g);
        set_dot(b_, x, g);
        set_dot(c_, x, x);
        c_.add(rr, length, true);
        set_dot(along, w_, g);
        set_product(opens, r_, g);
        set_dot(m_, opens, opens);
        m_.add(along, along, true);
    }
    ABUT_NOINLINE ABUT_HD constexpr void set_cone(const product& s, const product& k) {
        product across[3];
        triple x[3], g[3], out, opens;
        set_cross(across, w_, d_);
        set_cross(x, across, d_);
        set_cross(across, e_, d_);
        set_cross(g, across, d_);
        set_product(out, r_, s);
        set_product(opens, r_, k);
        set_dot(a_, g, g);
        a_.add(opens, opens, true);
        set_dot(b_, x, g);
        b_.add(out, opens, true);
        set_dot(c_, x, x);
        c_.add(out, out, true);
    }
    ABUT_NOINLINE ABUT_HD constexpr void set_bend_of_cone(const product& length) {
        product normal[3];
        triple turned[3], along;
        rolled_int<4 * room> reach[3];
        rolled_int<6 * room> square;
        set_cross(normal, w_, e_);
        set_cross(turned, normal, d_);
        set_dot(along, normal, d_);
        set_product(reach, r_, turned);
        set_product(square, along, along);
        set_dot(m_, reach, reach);
        m_.add(length, square, true);
    }

    /// The sign of q.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int value_at(const fraction& z) const {
        rolled_int<6 * room + time_room> part;
        rolled_int<6 * room + 2 * time_room> value;
        set_product(part, a_, z.over);
        part.add(b_, z.under);
        part.add(b_, z.under);
        set_product(value, part, z.over);
        set_product(part, c_, z.under);
        value.add(part, z.under);
        return value.sign();
    }
    /// That of its slope.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int slope_at(const fraction& z) const {
        rolled_int<6 * room + time_room> slope;
        set_product(slope, a_, z.over);
        slope.add(b_, z.under);
        return slope.sign();
    }

    number w_[3], e_[3], d_[3], r_;
    rolled_int<6 * room> a_, b_, c_;
    rolled_int<8 * room> m_;
    fraction first_, last_;
    bool has_end_, is_apart_ = false;
};

}  // namespace abut::detail
