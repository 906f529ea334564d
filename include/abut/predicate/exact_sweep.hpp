// SPDX-License-Identifier: MIT
#pragma once

// Has a shape that goes along a vector touched another one by some time? One question for all kinds of shapes, in integers of
// any length: each is a core, the hull of some points, and what is within a radius of that.
//
// Let a go along w, and let r be the sum of the radii. By the time t the core of a has passed through the hull of its points
// and of the same points moved by t w. The shapes have touched if and only if that hull is within r of the core of b. Where t
// is a floating-point number, the moved points are integers of some unit, so that the search of gjk.hpp decides it, as it
// does for two hulls at rest (capsule_hull.hpp). No root is taken: a time, which may be one of a quadratic, is compared with
// floating-point numbers alone.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/predicate/capsule_hull.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/predicate/hull_numbers.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// A core that goes along a way and one that stays, and the radii around them.
template <scalar T>
struct cores_on_way {
    const hull<T>& a;
    T radius_a;
    vec3<T> way;
    const hull<T>& b;
    T radius_b;
};

/// mantissa 2^exponent, from 0 to 2^54 in mantissa.
struct binary_time {
    std::int64_t mantissa;
    int exponent;

    /// A double of 0 or more, given by its bits.
    ABUT_HD static constexpr binary_time at(std::uint64_t bits) {
        const int biased = static_cast<int>(bits >> 52);
        const auto fraction = static_cast<std::int64_t>(bits & ((std::uint64_t{1} << 52) - 1));
        return {fraction + (biased > 0 ? std::int64_t{1} << 52 : 0), (biased > 1 ? biased : 1) - 1075};
    }
    /// Halfway to the next double.
    [[nodiscard]] ABUT_HD constexpr binary_time halfway_on() const { return {2 * mantissa + 1, exponent - 1}; }
    /// With as few digits as will do.
    [[nodiscard]] ABUT_HD constexpr binary_time reduced() const {
        if (mantissa == 0) return {0, 0};
        const int zeros = lowest_bit(mantissa);
        return {mantissa >> zeros, exponent + zeros};
    }
};

/// The unit of all numbers, as unit_of_hulls, of a time that is `reduced`.
template <scalar T>
struct unit_of_sweep {
    unit_of_hulls<T> unit;

    ABUT_HD constexpr unit_of_sweep(const cores_on_way<T>& x, const binary_time& until)
        : unit(x.a, x.b, x.radius_a, static_cast<double>(x.radius_b)) {
        const T ways[] = {x.way.x, x.way.y, x.way.z};
        for (const T w : ways) {
            const binary_parts p = take_apart(w);
            if (p.mantissa == 0 || until.mantissa == 0) continue;
            const int low = p.exponent + until.exponent, high = low + p.bits + 54;
            unit.low = low < unit.low ? low : unit.low;
            unit.high = high > unit.high ? high : unit.high;
        }
    }
};

/// Bits beside those of a number, as spare_bits: a point that is moved is a sum already.
inline constexpr int spare_bits_of_sweep = spare_bits + 1;

/// Limbs that are enough for any finite input and any time.
template <scalar T>
inline constexpr int limbs_of_any_sweep = (float_format<T>::max_exponent - float_format<T>::min_exponent +
                                           float_format<T>::digits + 1130 + spare_bits_of_sweep + 63) /
                                          64;

/// The core that has gone some way, with its points where they began first, and the other one, as search_origin reads them.
template <int Room, scalar T>
class passed_in_integers {
public:
    using number = rolled_int<Room>;
    static constexpr int most_steps = 0x7fffffff;  // it ends

    ABUT_HD constexpr passed_in_integers(const cores_on_way<T>& x, const binary_time& until, const unit_of_hulls<T>& unit)
        : x_(x), low_(unit.low), limbs_((unit.width() + spare_bits_of_sweep + 63) / 64),
          gone_{product(x.way.x, until), product(x.way.y, until), product(x.way.z, until)} {}

    [[nodiscard]] ABUT_HD constexpr vec3<number> difference(std::uint32_t i, std::uint32_t j) const {
        const auto n = static_cast<std::uint32_t>(x_.a.count);
        const vec3<number> d = between(x_.b[j], x_.a[i < n ? i : i - n]);
        if (i < n) return d;
        return {d.x + gone_.x, d.y + gone_.y, d.z + gone_.z};
    }
    ABUT_HD constexpr void look_back(const vec3<rolled_int<3 * Room>>& way, std::uint32_t& i, std::uint32_t& j) const {
        i = farthest(x_.a, way, -1);
        if (sign_of_dot(way, gone_) < 0) i += static_cast<std::uint32_t>(x_.a.count);
        j = farthest(x_.b, way, 1);
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<rolled_int<3 * Room>>& way, std::uint32_t i,
                                                   std::uint32_t j) const {
        return sign_of_dot(way, difference(i, j)) > 0;
    }
    ABUT_HD constexpr verdict holds_origin(const vec3<number> (&)[4], const difference_simplex&) const {
        return verdict::yes;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }
    /// The sum of the radii.
    [[nodiscard]] ABUT_HD constexpr number reach() const {
        number r;
        r.begin(limbs_);
        add(r, x_.radius_a, false);
        add(r, x_.radius_b, false);
        return r;
    }

private:
    ABUT_HD constexpr void add(number& r, T x, bool negated) const {
        const binary_parts p = take_apart(x);
        if (p.mantissa != 0) add_shifted(r.limb, limbs_, p.mantissa, p.exponent - low_, negated);
    }
    [[nodiscard]] ABUT_HD constexpr number between(T from, T to) const {
        number r;
        r.begin(limbs_);
        add(r, to, false);
        add(r, from, true);
        return r;
    }
    [[nodiscard]] ABUT_HD constexpr vec3<number> between(const vec3<T>& from, const vec3<T>& to) const {
        return {between(from.x, to.x), between(from.y, to.y), between(from.z, to.z)};
    }
    /// x times a time, whose digits are taken nine at a time: so many more has a mantissa room for.
    [[nodiscard]] ABUT_HD constexpr number product(T x, const binary_time& time) const {
        number r;
        r.begin(limbs_);
        const binary_parts p = take_apart(x);
        if (p.mantissa == 0) return r;
        std::int64_t rest = time.mantissa;
        ABUT_ROLLED
        for (int up = p.exponent + time.exponent - low_; rest != 0; up += 9, rest >>= 9) {
            const std::int64_t digits = rest & 511;
            if (digits != 0) add_shifted(r.limb, limbs_, p.mantissa * digits, up, false);
        }
        return r;
    }
    /// The first of the points that lie farthest along a way, or for a sense of -1 against it.
    ABUT_NOINLINE ABUT_HD constexpr std::uint32_t farthest(const hull<T>& h, const vec3<rolled_int<3 * Room>>& way,
                                                           int sense) const {
        std::uint32_t best = 0;
        vec3<T> at = h[0];
        ABUT_ROLLED
        for (std::size_t k = 1; k < h.count; ++k) {
            const vec3<T> p = h[k];
            if (sign_of_dot(way, between(at, p)) != sense) continue;
            best = static_cast<std::uint32_t>(k);
            at = p;
        }
        return best;
    }

    const cores_on_way<T>& x_;
    int low_, limbs_;
    vec3<number> gone_;
};

/// Whether they have touched by that time, in differences of up to `Room` limbs; `unknown` where they need more. The search
/// begins at a simplex and leaves there what it came to, for the next time.
template <int Room, scalar T>
ABUT_NOINLINE ABUT_HD constexpr verdict touched_in_integers(const cores_on_way<T>& x, const binary_time& until,
                                                            difference_simplex& at) {
    const unit_of_sweep<T> of(x, until);
    if (of.unit.width() + spare_bits_of_sweep > 64 * Room) return verdict::unknown;
    const passed_in_integers<Room, T> passed(x, until, of.unit);
    vec3<rolled_int<Room>> w[4];
    if (search_origin<sought::nearest>(passed, at, w) == verdict::yes) return verdict::yes;
    return to_verdict(is_feature_within(w, at.count, passed.reach()));
}

/// Whether they have touched by that time: decides every finite input.
template <scalar T>
ABUT_HD constexpr bool has_touched_by(const cores_on_way<T>& x, const binary_time& until, difference_simplex& at) {
    const binary_time time = until.reduced();
    const verdict v = touched_in_integers<3>(x, time, at);
    if (v != verdict::unknown) return v == verdict::yes;
    return touched_in_integers<limbs_of_any_sweep<T>>(x, time, at) == verdict::yes;
}

/// When they touch first, rounded to the nearest double, of two that are as near to the lesser; or a negative number if not
/// by 1. It is found among all doubles by halving their number, near `hint` first.
template <scalar T>
ABUT_NOINLINE ABUT_HD constexpr double exact_sweep_time(const cores_on_way<T>& x, double hint) {
    difference_simplex at;
    constexpr std::uint64_t one = 0x3ff0000000000000;
    if (has_touched_by(x, {0, 0}, at)) return 0;
    if (!has_touched_by(x, {1, 0}, at)) return -1;
    // The rounded time is above low, as a signed number, and not above high.
    std::int64_t low = -1, high = static_cast<std::int64_t>(one);
    const auto is_at_most = [&](std::int64_t bits) {
        return has_touched_by(x, binary_time::at(static_cast<std::uint64_t>(bits)).halfway_on(), at);
    };
    const bool has_hint = hint > 0 && hint < 1;
    std::int64_t probe = has_hint ? static_cast<std::int64_t>(ABUT_BIT_CAST(std::uint64_t, hint)) : 0, step = 1;
    bool gallops = has_hint;
    ABUT_ROLLED
    while (high - low > 1) {
        const std::int64_t k = gallops && probe > low && probe < high ? probe : low + (high - low) / 2;
        const bool was = is_at_most(k);
        (was ? high : low) = k;
        if (gallops) {
            probe = was ? k - step : k + step;
            gallops = step < std::int64_t{1} << 40;
            step *= 8;
            // Between both ends that galloping found there is nothing but halving.
            if (low > -1 && high < static_cast<std::int64_t>(one)) gallops = false;
        }
    }
    return ABUT_BIT_CAST(double, static_cast<std::uint64_t>(high));
}

}  // namespace abut::detail
