// SPDX-License-Identifier: MIT
#pragma once

// When a line meets a triangle, of any finite input, by quotients of integers that are rounded once.
//
// Let o be the line's origin, d its direction, and A, B, C the ways from o to the corners. The line meets the triangle where
// it passes the three sides in no two opposite senses: where the signs of (A x B).d, (B x C).d and (C x A).d are none of
// them opposite. Their sum is n.d, with the normal n. If it is not 0, the point that is met is at t = (A x B).C / n.d.
//
// If all three are 0, the line lies in the plane of the triangle, or the triangle has no area. What the line meets is then
// an interval of t, whose ends are where it meets sides: at t = (A x e) / (d x e) for a side from A to A + e, in any
// coordinate in which d x e is not 0, if A and A + e are not on one side of the line; or, for a side along the line, at the
// ends of that side. A ray meets the interval first at 0, if the interval holds 0, or at its lesser end.
//
// A direction of 0 asks whether o lies in the triangle. So it does if and only if a line from o to a corner meets it at 0.
//
// A point is inside of a closed mesh if the way up from it crosses an odd number of triangles. That has to be asked of a way
// that meets neither edges nor corners. So o is moved aside by (e, e^2, 0), for an e that is as small as need be: a sign
// that is 0 becomes that of what e changes, and if that is 0 that of what e^2 changes (H. Edelsbrunner, E. Muecke,
// Simulation of Simplicity, 1990). Both faces at an edge ask about the same sign, so that the way crosses one of them or
// none or both as a line that is really moved aside does.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/rolled_int.hpp>
#include <abut/config.hpp>

namespace abut::detail {

/// Numbers of the input as integers of w bits: differences, areas, and volumes or sums of three of these, each with its sign
/// and a bit to be moved by.
template <scalar T>
struct rolled_numbers {
    static constexpr int limbs(int bits) { return (bits + 63) / 64; }
    static constexpr int most = float_format<T>::max_exponent - float_format<T>::min_exponent + float_format<T>::digits;
    using length = rolled_int<limbs(most + 3)>;
    using area = rolled_int<limbs(2 * most + 5)>;
    using volume = rolled_int<limbs(3 * most + 9)>;
};

ABUT_HD constexpr int next_axis(int k) { return k == 2 ? 0 : k + 1; }

/// What the way up from a point meets of a triangle: nothing, its inside, which it crosses, or the triangle at the point
/// itself.
enum class met_above : int { nothing, leaving, entering, start, unknown };

template <scalar T>
class exact_line {
    using length = typename rolled_numbers<T>::length;
    using area = typename rolled_numbers<T>::area;
    using volume = typename rolled_numbers<T>::volume;

public:
    /// The origin, the corners, and two points whose difference is the direction; the line ends at a time of 1, or never.
    ABUT_HD constexpr exact_line(const aligned<18>& x, bool has_end) : has_end_(has_end) {
        const int w = x.width() > 1 ? x.width() : 1;
        of_length_ = (w + 3 + 63) / 64, of_area_ = (2 * w + 5 + 63) / 64, of_volume_ = (3 * w + 9 + 63) / 64;
        has_direction_ = false;
        ABUT_ROLLED
        for (int k = 0; k < 12; ++k) {
            const int axis = k % 3, point = k / 3;
            length& way = point < 3 ? to_[point][axis] : along_[axis];
            way.clear(of_length_);
            way.add(x, point < 3 ? 3 + k : 12 + axis);
            way.add(x, point < 3 ? axis : 15 + axis, true);
            if (point == 3) has_direction_ = has_direction_ || way.sign() != 0;
        }
        if (!has_direction_) {
            for (int k = 0; k < 3; ++k) along_[k].add(to_[0][k]);
        }
    }

    /// The least time of 0 or more at which it meets the triangle, or a negative number if it does not.
    [[nodiscard]] ABUT_HD constexpr double first_time() {
        volume speed, height;
        speed.clear(of_volume_);
        height.clear(of_volume_);
        bool any_left = false, any_right = false;
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) {
            volume passing;
            passing.clear(of_volume_);
            ABUT_ROLLED
            for (int k = 0; k < 3; ++k) {
                area c;
                cross(to_[i], to_[next_axis(i)], k, c);
                passing.add(c, along_[k]);
                if (i == 0) height.add(c, to_[2][k]);
            }
            const int side = passing.sign();
            any_left = any_left || side > 0;
            any_right = any_right || side < 0;
            speed.add(passing);
        }
        if (any_left && any_right) return -1;
        if (any_left || any_right) {
            offer(height, speed);
        } else {
            ABUT_ROLLED
            for (int i = 0; i < 3; ++i) meet_side(to_[i], to_[next_axis(i)]);
        }
        if (begins_before_ && ends_after_) return 0;
        return has_direction_ && least_ < infinity<double> ? least_ : -1;
    }

    /// Of a line along z, from the point upward.
    [[nodiscard]] ABUT_HD constexpr met_above meets_above() {
        is_timed_ = false;
        const bool meets = first_time() >= 0;
        if (begins_before_ && ends_after_) return met_above::start;
        if (!meets) return met_above::nothing;
        int sides = 0;
        ABUT_ROLLED
        for (int i = 0; i < 3; ++i) sides += side_if_moved(to_[i], to_[next_axis(i)]);
        return sides == 3 ? met_above::leaving : sides == -3 ? met_above::entering : met_above::nothing;
    }

private:
    /// On which side of the line of two corners, seen along z, the origin is if it is moved: A.x B.y - A.y B.x, then what
    /// becomes of it if A and B have (e, e^2) taken off.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr int side_if_moved(const length (&a)[3], const length (&b)[3]) const {
        area side;
        cross(a, b, 2, side);
        if (side.sign() != 0) return side.sign();
        length change;
        change.clear(of_length_);
        change.add(a[1]);
        change.add(b[1], true);
        if (change.sign() != 0) return change.sign();
        change.clear(of_length_);
        change.add(b[0]);
        change.add(a[0], true);
        return change.sign();
    }

    /// Coordinate k of a x b.
    ABUT_NOINLINE ABUT_HD constexpr void cross(const length (&a)[3], const length (&b)[3], int k, area& r) const {
        const int i = next_axis(k), j = next_axis(i);
        r.clear(of_area_);
        r.add(a[i], b[j]);
        r.add(a[j], b[i], true);
    }

    /// The line meets the triangle, or a part of its rim, at this time.
    template <class N>
    ABUT_NOINLINE ABUT_HD constexpr void offer(N& numerator, N& denominator) {
        const int sign = numerator.sign() * denominator.sign();
        begins_before_ = begins_before_ || sign <= 0;
        ends_after_ = ends_after_ || sign >= 0;
        if (sign <= 0) return;
        numerator.drop_sign();
        denominator.drop_sign();
        if (has_end_ && limbs_less(denominator.limb, numerator.limb, numerator.count)) return;
        least_ = is_timed_ ? least(divide_magnitudes(numerator.limb, denominator.limb, numerator.count), least_) : 1;
    }

    /// The side from p to q, which is in one plane with the line.
    ABUT_NOINLINE ABUT_HD constexpr void meet_side(const length (&p)[3], const length (&q)[3]) {
        length edge[3];
        bool is_on_line = true;
        ABUT_ROLLED
        for (int k = 0; k < 3; ++k) {
            edge[k].clear(of_length_);
            edge[k].add(q[k]);
            edge[k].add(p[k], true);
        }
        ABUT_ROLLED
        for (int k = 0; k < 3; ++k) {
            area turn, beside;
            cross(along_, edge, k, turn);
            cross(p, along_, k, beside);
            is_on_line = is_on_line && beside.sign() == 0;
            const int sense = turn.sign();
            if (sense == 0) continue;
            if (beside.sign() * sense < 0) return;
            cross(q, along_, k, beside);
            if (beside.sign() * sense > 0) return;
            cross(p, edge, k, beside);
            return offer(beside, turn);
        }
        if (!is_on_line) return;
        int k = 0;
        while (k < 2 && along_[k].sign() == 0) ++k;
        if (along_[k].sign() == 0) return offer_origin();
        length numerator, denominator;
        ABUT_ROLLED
        for (int end = 0; end < 2; ++end) {
            numerator.clear(of_length_);
            numerator.add(end == 0 ? p[k] : q[k]);
            denominator.clear(of_length_);
            denominator.add(along_[k]);
            offer(numerator, denominator);
        }
    }

    ABUT_HD constexpr void offer_origin() { begins_before_ = ends_after_ = true; }

    length to_[3][3], along_[3];
    int of_length_ = 0, of_area_ = 0, of_volume_ = 0;  ///< limbs
    bool has_end_, has_direction_ = false, is_timed_ = true, begins_before_ = false, ends_after_ = false;
    double least_ = infinity<double>;
};

}  // namespace abut::detail
