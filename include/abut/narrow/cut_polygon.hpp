// SPDX-License-Identifier: MIT
#pragma once

// What is left of a triangle when half-spaces are cut off, and a point in the middle of it.

#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/nearest.hpp>
#include <abut/narrow/numbers.hpp>

namespace abut::detail::contact_math {

/// A convex polygon, a segment or a point, by its corners in turn.
template <class N>
struct cut_polygon {
    vec3<N> at[9];
    int count;

    ABUT_HD constexpr explicit cut_polygon(const corners& t) : at{as<N>(t.at[0]), as<N>(t.at[1]), as<N>(t.at[2])}, count(3) {}

    /// Keeps what is at most `slack` beyond a plane, or the points that are least beyond. `side.beyond(p)` is how far p is,
    /// and `side.onto(p)` puts a point that is hardly off the plane on it.
    template <class Side>
    ABUT_NOINLINE ABUT_HD constexpr void cut(const Side& side, double slack) {
        N beyond[9]{};
        double least_beyond = infinity<double>;
        for (int i = 0; i < count; ++i) {
            beyond[i] = side.beyond(at[i]);
            least_beyond = least(least_beyond, beyond[i].high);
        }
        const double most = greatest(slack, least_beyond);
        const cut_polygon whole = *this;
        count = 0;
        for (int i = 0; i < whole.count; ++i) {
            const int j = i + 1 == whole.count ? 0 : i + 1;
            const vec3<N>&from = whole.at[i], &to = whole.at[j];
            const double over = beyond[i].high, next_over = beyond[j].high;
            const bool stays = over <= most, next_stays = next_over <= most;
            if (stays) add(from);
            if (stays == next_stays || most > slack) continue;
            const vec3<N> passing = from + scale(into_unit(beyond[i] / (beyond[i] - beyond[j])), to - from);
            add(over < 0 || next_over < 0 ? side.onto(passing) : passing);
        }
    }

    /// The centre of gravity of its boundary; of a segment, which is gone along twice, the middle. It moves by no more than
    /// a few times as much as the corners do, also where the polygon is thin and the centre of its area would jump, and
    /// corners that lie together count as one.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr point middle() const {
        const point first = rounded_off(at[0]);
        double around = 0;
        point sum{0, 0, 0};  // of the sides' middles from the first corner, twice, by their lengths
        for (int i = 0; i < count; ++i) {
            const int j = i + 1 == count ? 0 : i + 1;
            const point side = rounded_off(at[j] - at[i]);
            const point from = rounded_off(at[i] - at[0]), to = rounded_off(at[j] - at[0]);
            const double length = root(one_double{plain_dot(side, side)}).high;
            around = plain_sum(around, length);
            sum = {plain_sum(sum.x, plain_product(length, plain_sum(from.x, to.x))),
                   plain_sum(sum.y, plain_product(length, plain_sum(from.y, to.y))),
                   plain_sum(sum.z, plain_product(length, plain_sum(from.z, to.z)))};
        }
        if (!(around > 0)) return first;
        const double twice = 2 * around;
        return {plain_sum(first.x, sum.x / twice), plain_sum(first.y, sum.y / twice), plain_sum(first.z, sum.z / twice)};
    }

private:
    ABUT_HD constexpr void add(const vec3<N>& p) {
        if (count < 9) at[count++] = p;
    }
};

}  // namespace abut::detail::contact_math
