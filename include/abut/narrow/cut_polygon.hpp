// SPDX-License-Identifier: MIT
#pragma once

// What is left of a triangle when half-spaces are cut off, and a point in the middle of it.

#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut::detail::contact_math {

/// A convex polygon, a segment or a point, by its corners in turn.
struct cut_polygon {
    point at[9];
    int count;

    /// Keeps what is at most `slack` beyond a plane, or the points that are least beyond. `side.beyond(p)` is how far p is,
    /// and `side.onto(p)` puts a point that is hardly off the plane on it.
    template <class Side>
    ABUT_NOINLINE ABUT_HD constexpr void cut(const Side& side, double slack) {
        double beyond[9]{}, least_beyond = infinity<double>;
        for (int i = 0; i < count; ++i) {
            beyond[i] = side.beyond(at[i]);
            least_beyond = least(least_beyond, beyond[i]);
        }
        const double most = greatest(slack, least_beyond);
        cut_polygon kept{{}, 0};
        for (int i = 0; i < count; ++i) {
            const int j = i + 1 == count ? 0 : i + 1;
            const bool stays = beyond[i] <= most, next_stays = beyond[j] <= most;
            if (stays) kept.add(at[i]);
            if (stays == next_stays || most > slack) continue;
            const double weight = beyond[i] / plain_sum(beyond[i], -beyond[j]);
            const point passing = on_segment(at[i], at[j], into_unit(one_double::of(weight)));
            kept.add(beyond[i] < 0 || beyond[j] < 0 ? side.onto(passing) : passing);
        }
        *this = kept;
    }

    /// The centre of gravity of its boundary; of a segment, which is gone along twice, the middle. It moves by no more than
    /// a few times as much as the corners do, also where the polygon is thin and the centre of its area would jump, and
    /// corners that lie together count as one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr point middle() const {
        double around = 0;
        point sum{0, 0, 0};  // of the sides' middles from the first corner, twice, by their lengths
        for (int i = 0; i < count; ++i) {
            const int j = i + 1 == count ? 0 : i + 1;
            const point side = plain_difference(at[j], at[i]);
            const point from = plain_difference(at[i], at[0]), to = plain_difference(at[j], at[0]);
            const double length = root(one_double{plain_dot(side, side)}).high;
            around = plain_sum(around, length);
            sum = {plain_sum(sum.x, plain_product(length, plain_sum(from.x, to.x))),
                   plain_sum(sum.y, plain_product(length, plain_sum(from.y, to.y))),
                   plain_sum(sum.z, plain_product(length, plain_sum(from.z, to.z)))};
        }
        if (!(around > 0)) return at[0];
        const double twice = 2 * around;
        return {plain_sum(at[0].x, sum.x / twice), plain_sum(at[0].y, sum.y / twice), plain_sum(at[0].z, sum.z / twice)};
    }

private:
    ABUT_HD constexpr void add(const point& p) {
        if (count < 9) at[count++] = p;
    }
};

}  // namespace abut::detail::contact_math
