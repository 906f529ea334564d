// SPDX-License-Identifier: MIT
#pragma once

// How far a ray or a segment reaches that looks for what it meets first: a prune functor that tightens (point_reach.hpp), by
// when the ray passes the two planes of a box in each coordinate.
//
// The direction is divided by a power of two, 2^e, that brings its largest coordinate to [1, 2); times become 2^e times as
// long. A plane p is passed at (p - o) / s, where o is the origin's coordinate and s the direction's. With the inverse v of s
// that is p v - o v, one product and one sum, with o v computed once. Let u be the roundoff; roundings may be off by 2u, in
// any mode.
//
//   v is off by 2u of itself, which is 2u of the time, and p v, o v and both sums are off by 2u each. Since |p v| is not above
//   the time's magnitude and |o v| in sum, the time is off by less than 7u of itself and 7u |o v| in all, and where the origin
//   is off by `slack` by (1 + 8u) slack |v| more.
//   What is flushed to zero is below 4 m, where m is the smallest normal number.
//
// What does not grow with the time, `lost`, is 16u |o v| + (1 + 32u) (slack + 8 m) |v|; |v| is above 1/2. So o v comes in two forms:
// entries are `lost` earlier, and exits `lost` later. By what is left, an entry may seem the later by 15u of an exit that is
// not before it: the exit is taken 32u later, and 4 m. Products with p may overflow, to infinite times of the right sign, while
// |o v| + lost is below `most`, an eighth of the largest number. An entry is held below `most`, which the true one is above
// if it overflows, and a limit that is not below that is none.
//
// Where the direction is 0 in a coordinate the origin has to lie between both planes, but for slack + 8 m and for 8u of that and of
// the origin. Where it is less than 2^-60 of the
// largest, or o v is too large, the planes say nothing: m p - infinity and m p + infinity are what they come to, also where p
// is infinite.

#include <cstddef>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/shape/primitive.hpp>

namespace abut {

namespace detail {

/// x 2^e, for a result and an e of which doubles are in reach; in two steps, since 2^e itself may not be.
ABUT_HD constexpr double times_power_of_two(double x, int e) {
    const int half = e / 2;
    return plain_product(plain_product(x, power_of_two<double>(half)), power_of_two<double>(e - half));
}

/// The exponent of a normal number x > 0: 2^e <= x < 2^(e + 1).
template <scalar T>
ABUT_HD constexpr int exponent_of_normal(T x) {
    using format = float_format<T>;
    return static_cast<int>(ABUT_BIT_CAST(typename format::word, x) >> (format::digits - 1)) + format::min_exponent +
           format::digits - 2;
}

/// A power of two that brings the largest coordinate of a direction, a normal number, to [1, 2).
template <scalar T>
struct direction_scale {
    int exponent;
    T first, second;  ///< in two steps, since 2^-e need not be a normal number

    ABUT_HD explicit direction_scale(T largest)
        : exponent(exponent_of_normal(largest)), first(power_of_two<T>(-exponent / 2)),
          second(power_of_two<T>(-exponent - -exponent / 2)) {}
    [[nodiscard]] ABUT_HD T divide(T x) const { return plain_product(plain_product(x, first), second); }
};

/// A ray or a segment as a frame sees it.
template <scalar T>
struct line_in_frame {
    using scalar_type = T;

    vec3<T> origin, direction;
    double last;  ///< the time at which it ends, or infinity
    T slack;      ///< by how much a point of it may be off
};

template <scalar T>
struct ray_reach {
    vec3<T> inverse;             ///< of the direction's coordinates; m where they say nothing
    vec3<T> at_lower, at_upper;  ///< what is added for lower and for upper planes
    aabb<T> around;              ///< of the coordinates in which the direction is 0; infinite in the others
    T limit;
    int exponent;    ///< e
    bool is_narrow;  ///< whether it is 0 in any coordinate

    static constexpr T most = largest_finite<T> / 8;

    ray_reach() = default;
    /// last: the time at which it ends, or infinity. slack: by how much a point of it may be off.
    ABUT_HD ray_reach(const vec3<T>& origin, const vec3<T>& direction, double last, T slack = 0)
        : inverse{}, at_lower{}, at_upper{}, around{}, limit(most), exponent(0), is_narrow(false) {
        constexpr T none = infinity<T>;
        const vec3<T> size = absolute(direction);
        const T largest = greatest(size.x, size.y, size.z);
        // Nothing is asked of a direction of denormal numbers, or of a segment's that overflows.
        const bool is_safe = largest >= smallest_normal<T> && largest <= largest_finite<T>;
        const direction_scale<T> scale(is_safe ? largest : T(1));
        exponent = scale.exponent;
        const T reach = slack + 8 * smallest_normal<T>;
        const auto prepare = [&](T vec3<T>::*x) {
            around.lower.*x = -none, around.upper.*x = none;
            inverse.*x = smallest_normal<T>, at_lower.*x = -none, at_upper.*x = none;
            if (is_zero(direction.*x)) {
                const T off = reach + 8 * unit_roundoff<T> * (absolute(origin.*x) + reach);
                around.lower.*x = origin.*x - off, around.upper.*x = origin.*x + off;
                is_narrow = true;
                return;
            }
            const T scaled = scale.divide(direction.*x);
            if (!is_safe || !(absolute(scaled) >= T(0x1p-60))) return;
            const T v = 1 / scaled, at = origin.*x * v;
            const T lost = 16 * unit_roundoff<T> * absolute(at) + (1 + 32 * unit_roundoff<T>)*(reach * absolute(v));
            if (!(absolute(at) + lost < most)) return;
            inverse.*x = v;
            at_lower.*x = v > 0 ? -at - lost : lost - at;
            at_upper.*x = v > 0 ? lost - at : -at - lost;
        };
        prepare(&vec3<T>::x);
        prepare(&vec3<T>::y);
        prepare(&vec3<T>::z);
        shrink_to(last);
    }

    ABUT_HD explicit ray_reach(const line_in_frame<T>& l) : ray_reach(l.origin, l.direction, l.last, l.slack) {}

    /// When it enters the box, or a time above every limit.
    ABUT_HD T least_in(const aabb<T>& box) const {
        constexpr T grown = 1 + 32 * unit_roundoff<T>, tiny = 4 * smallest_normal<T>;
        const auto one = [&](T vec3<T>::*x) { return box.lower.*x * inverse.*x + at_lower.*x; };
        const auto other = [&](T vec3<T>::*x) { return box.upper.*x * inverse.*x + at_upper.*x; };
        const T x = one(&vec3<T>::x), y = one(&vec3<T>::y), z = one(&vec3<T>::z), to_x = other(&vec3<T>::x),
                to_y = other(&vec3<T>::y), to_z = other(&vec3<T>::z);
        const T soonest = greater(greater(lesser(x, to_x), lesser(y, to_y)), greater(lesser(z, to_z), T(0)));
        const T in = lesser(soonest, most), out = lesser(lesser(greater(x, to_x), greater(y, to_y)), greater(z, to_z));
        if (in > out * grown + tiny || (is_narrow && !overlaps(around, box))) return infinity<T>;
        return in;
    }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return !(least > limit); }
    ABUT_HD bool operator()(const aabb<T>& box) const { return keeps(least_in(box)); }
    [[nodiscard]] ABUT_HD aabb<T> bounds() const { return around; }
    /// bound: a time, in the direction's own length.
    ABUT_HD void shrink_to(double bound) {
        if (bound == infinity<double>) return;
        limit = limit_of(bound, exponent);
    }
    /// The limit for such a bound, where times are 2^exponent times as long.
    ABUT_HD static T limit_of(double bound, int exponent) {
        if (bound >= largest_finite<double>) return most;
        constexpr double grown = 1 + 32 * static_cast<double>(unit_roundoff<T>);
        const double scaled = times_power_of_two(bound + smallest_normal<double>, exponent) * grown +
                              4 * static_cast<double>(smallest_normal<T>);
        return scaled < static_cast<double>(most) ? static_cast<T>(scaled) : most;
    }
};

/// The same reach for four boxes at a time, which has each of its numbers four times, so that a node costs no more than its
/// boxes. For processors. It is made of a line all coordinates at once and without branches on signs, which a processor
/// guesses wrong half of the time. Planes say nothing where a direction is a denormal number either. As with lanes, what two
/// compilers make of it has two names; and both lay it out alike, for other classes hold one.
///
/// Each node of a walk waits for what the one before it told, so as little as possible comes after the products. Exits have
/// a factor of their own, which is 48u larger. Nothing is added for times that are flushed to zero, since the origin's reach
/// is 16 m. Let p be the digits of a number. Where the origin is below 2^(p+2) m, that reach is added with an error below 8
/// m: differences that are 3 m off are moved by 4 m, and times by 2 m. Where it is not, the difference of it and a plane is
/// exact, and 0 or 4 m at least; or it is so large that m is less than u/2 of it. So no time is flushed that matters.
template <scalar T, class Register = typename register_of<T>::type>
class ray_reach_of_four {
    using many = lanes<T, Register>;

public:
    static constexpr bool takes_four = true;
    ABUT_INLINE ABUT_HD explicit ray_reach_of_four(const line_in_frame<T>& line) {
        const vec3<T> size = absolute(line.direction);
        const T largest = greatest(size.x, size.y, size.z);
        const bool is_safe = largest >= smallest_normal<T> && largest <= largest_finite<T>;
        const direction_scale<T> scale(is_safe ? largest : T(1));
        const many direction = many::of(line.direction.x, line.direction.y, line.direction.z, 0),
                   origin = many::of(line.origin.x, line.origin.y, line.origin.z, 0),
                   reach = many::all(line.slack + 16 * smallest_normal<T>), none = many::all(T(0)), one = many::all(T(1));
        const many scaled = direction * many::all(scale.first) * many::all(scale.second);
        const auto tells = (absolute(scaled) >= many::all(is_safe ? T(0x1p-60) : infinity<T>)) &
                           (absolute(direction) >= many::all(smallest_normal<T>));
        const auto back = none > scaled;
        const many above = origin - reach, below = origin + reach;
        const many in = select(back, above, below), out = select(back, below, above);
        const many factor = one / select(tells, scaled, one), grown = many::all(1 + 48 * unit_roundoff<T>);
        alignas(16) T row[4][4];
        select(tells, in, none).store(row[0]);
        select(tells, factor, none).store(row[1]);
        select(tells, out, many::all(-infinity<T>)).store(row[2]);
        select(tells, factor * grown, one).store(row[3]);
        const decltype(back) signs[1] = {back & tells};
        const unsigned backward = bits_of(signs);
        for (int axis = 0; axis < 3; ++axis) {
            const unsigned shift = 3 * (backward >> axis & 1);
            enters_[axis] = 4 * (static_cast<unsigned>(axis) + shift);
            leaves_[axis] = 4 * (static_cast<unsigned>(axis) + 3 - shift);
            many::all(row[0][axis]).store(in_[axis]);
            many::all(row[1][axis]).store(in_factor_[axis]);
            many::all(row[2][axis]).store(out_[axis]);
            many::all(row[3][axis]).store(out_factor_[axis]);
        }
        rounded(many::all(ray_reach<T>::most)).store(most_);
        exponent_ = scale.exponent;
        is_narrow_ = !(least(size.x, size.y, size.z) >= smallest_normal<T>);
        if (is_narrow_) around_ = ray_reach<T>(line).around;
        set_limit(line.last == infinity<double> ? ray_reach<T>::most : ray_reach<T>::limit_of(line.last, exponent_));
    }

    /// When it enters each of four boxes, by their planes: lower x, y and z, and then upper ones, at a multiple of 16 bytes.
    /// Which of two the ray passes first is the same for all boxes. A bit for each box that is kept; of the others the times
    /// mean nothing.
    ///
    /// Where planes say nothing boxes are entered at 0 and left at infinity. An entry may have overflowed where the exit has
    /// not: what is left at `most`, or later, is kept. Infinite planes may make a time that is no number. The comparison with 0
    /// or with the limit passes over it; that of the other two coordinates may pass over both.
    ABUT_INLINE ABUT_HD unsigned least_in_four(const T (&planes)[6][4], T (&to)[4]) const {
        const T* const from = planes[0];
        const auto entered = [&](int k) {
            return (many::load_aligned(from + enters_[k]) - many::load_aligned(in_[k])) * many::load_aligned(in_factor_[k]);
        };
        const auto left = [&](int k) {
            return (many::load_aligned(from + leaves_[k]) - many::load_aligned(out_[k])) * many::load_aligned(out_factor_[k]);
        };
        const many most = many::load_aligned(most_);
        const many entry = greatest(greatest(entered(1), entered(2)), greatest(entered(0), many::all(T(0))));
        const many exit = least(least(left(1), left(2)), least(left(0), many::load_aligned(limit_)));
        auto kept = (exit >= entry) | (exit >= most);
        if (is_narrow_) {
            const vec3<T>&lower = around_.lower, &upper = around_.upper;
            const T below[] = {lower.x, lower.y, lower.z}, above[] = {upper.x, upper.y, upper.z};
            for (int k = 0; k < 3; ++k) {
                const many first = many::load(planes[k]), last = many::load(planes[k + 3]);
                kept = kept & !((first > many::all(above[k])) | (many::all(below[k]) > last));
            }
        }
        least(entry, most).store(to);
        const decltype(kept) row[1] = {kept};
        return bits_of(row);
    }
    [[nodiscard]] ABUT_HD bool keeps(T least) const { return !(least > limit_[0]); }
    ABUT_HD void shrink_to(double bound) {
        if (bound != infinity<double>) set_limit(ray_reach<T>::limit_of(bound, exponent_));
    }

private:
    ABUT_HD void set_limit(T limit) { many::all(limit).store(limit_); }

    alignas(16) T in_[3][4], in_factor_[3][4], out_[3][4], out_factor_[3][4];
    alignas(16) T limit_[4], most_[4];  ///< `most` from memory: g++ takes four instructions for the lesser of a constant
    std::size_t enters_[3], leaves_[3];  ///< where the planes of boxes begin that the ray passes first and last
    aabb<T> around_;                     ///< as of ray_reach, if narrow
    int exponent_;
    bool is_narrow_;  ///< whether it is 0, or a denormal number, in any coordinate
};

/// What a frame sees of a line in the world (point_reach.hpp).
template <scalar T>
ABUT_HD line_in_frame<T> line_seen(const world_frame<T>&, const vec3<T>& origin, const vec3<T>& direction, double last) {
    return {origin, direction, last, 0};
}
/// The origin is brought there as a ball's centre is, and what that may be off is its slack. The direction is off by no more
/// than a share of its length that is 5 times the pose's deviation, and rounding: at a time at which the line is near the
/// object, that is this share of how far both are apart.
template <scalar T>
ABUT_HD line_in_frame<T> line_seen(const object_frame<T>& frame, const vec3<T>& origin, const vec3<T>& direction,
                                   double last) {
    const auto seen = frame.ball_around(origin);
    const rigid<T>& pose = frame.pose;
    const vec3<double> d = widened(direction);
    const vec3<double> turned{dot(widened(column(pose.rotation, 0)), d), dot(widened(column(pose.rotation, 1)), d),
                              dot(widened(column(pose.rotation, 2)), d)};
    constexpr double u = static_cast<double>(unit_roundoff<T>);
    const double apart = magnitudes(widened(origin)) + 2 * magnitudes(widened(pose.translation)) + 2 * frame.size;
    const double slack = 2 * seen.map.slack + (16 * frame.deviation + 64 * u) * apart;
    // What is flushed to zero, or rounded to a denormal number, must be a small share of a ray's direction. A segment's own
    // points are off by as little.
    constexpr double least_turned = static_cast<double>(smallest_normal<T>) / u;
    const bool is_known = slack < static_cast<double>(largest_finite<T>) / 4 &&
                          magnitudes(turned) < static_cast<double>(largest_finite<T>) / 4 &&
                          (magnitudes(turned) >= least_turned || last != infinity<double> ||
                           (is_zero(direction.x) && is_zero(direction.y) && is_zero(direction.z)));
    if (!is_known) return {origin, {1, 1, 1}, infinity<double>, infinity<T>};
    return {seen.center, to_scalar<T>(turned), last, static_cast<T>(slack)};
}

/// What a line reaches that a frame sees.
template <class Frame, scalar T>
ABUT_HD ray_reach<T> reach_of_line(const Frame& frame, const vec3<T>& origin, const vec3<T>& direction, double last) {
    return ray_reach<T>(line_seen(frame, origin, direction, last));
}

}  // namespace detail

/// A ray reaches the boxes that it passes through.
template <scalar T>
ABUT_HD auto reach_of(const ray<T>& r) {
    return detail::ray_reach<T>(r.origin, r.direction, infinity<double>);
}

}  // namespace abut
