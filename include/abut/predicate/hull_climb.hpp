// SPDX-License-Identifier: MIT
#pragma once

// The point of a hull that lies farthest back along a way, by climbing along the hull's edges (collide/hull_edges.hpp) instead
// of reading all points. The answer is that of reading all, to the bit: kept_points.hpp says which one that is. Not for hulls
// without edges.
//
// Why it is. Points p are placed by x -> R x + t; f(p) is the way's exact product with the exact image of p, and h(p) the
// computed one with the computed point: |h(p) - f(p)| <= e for all. The points are the corners of a convex polytope, with its
// edges known exactly, and f is linear: so from each corner edges lead down, never up in f, to the least one. Let v be any
// corner and m the one of the least h. Both reach the least of f by corners w with f(w) <= max(f(v), f(m)) <= h(v) + e, so
// h(w) <= h(v) + 2e. Going from v along edges to all corners that are no higher than h(v) + 2e thus comes by m. Where v is a
// corner at which no edge leads down, these are few: v alone, or the corners of a face across the way. Where there are more
// than there is room for, all points are read. How v was found does not matter. And where all that v has edges to is higher in
// f by more than 2e, v is it: the corner that is next to the least is one of these.
//
// e: let S be the largest magnitude of a coordinate as seen, W that of products and sums where points are placed, u = 2^-53, and
// P the sum of the coordinates' largest magnitudes where they are not placed. A placed double is off by 4u W, a placed float by
// 2^-24 W; the difference with the origin by u S; the product by 4u of the sum of its magnitudes. Small floats that are read as
// 0 are off by less than 2^-126. With the sum of magnitudes |n| the code takes 2e = |n| (2^-49 S + 2^-49 W, or with floats
// 2^-22 W, + 2^-120 or 2^-1000) + 2^-1060: what underflows is below that. In the frame where points are not placed, the way is
// off by 5u |n|, and a product with it by 10u |n| P: 2^-47 |n| P for two, which leaves as much again for sums.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::detail {

template <scalar T>
class hull_climb {
public:
    using point = vec3<double>;

    /// Of no hull.
    hull_climb() = default;
    /// Of a hull that has edges and outlives this.
    ABUT_HD constexpr void begin(const hull<T>& h) {
        of_ = &h;
        at_ = h.edges[0];
        aabb<double> box = empty_box<double>();
        for (int k = 0; k < 6; ++k) box = merge(box, bounds(widened(raw(h.edges[k]))));
        middle_ = 0.5 * box.lower + 0.5 * box.upper;
        const point half = box.upper - middle_;
        half_ = h.is_placed ? 1.75 * greatest(half.x, half.y, half.z) : greatest(half.x, half.y, half.z);
        raw_ = magnitudes(greatest(absolute(box.lower), absolute(box.upper)));
        placed_ = h.is_placed ? 2 * raw_ + magnitudes(widened(h.pose.translation)) : 0;
        see_from({0, 0, 0});
    }
    ABUT_HD constexpr void see_from(const point& origin) {
        origin_ = origin;
        const point c = absolute(middle());
        size_ = greatest(c.x, c.y, c.z) + 1.01 * half_ + 0x1p-20 * placed_;
    }
    /// Point i as it is seen.
    [[nodiscard]] ABUT_HD constexpr point operator[](std::size_t i) const {
        const vec3<T> p = (*of_)[i];
        return {plain_sum(rounded(static_cast<double>(p.x)), -origin_.x), plain_sum(rounded(static_cast<double>(p.y)), -origin_.y),
                plain_sum(rounded(static_cast<double>(p.z)), -origin_.z)};
    }
    /// About the middle of the box around the points, as it is seen.
    [[nodiscard]] ABUT_HD constexpr point middle() const {
        if (!of_->is_placed) return middle_ - origin_;
        const auto& r = of_->pose.rotation;
        return point{dot(widened(row(r, 0)), middle_), dot(widened(row(r, 1)), middle_), dot(widened(row(r, 2)), middle_)} +
               (widened(of_->pose.translation) - origin_);
    }
    /// No less than any coordinate's magnitude, and not much more.
    [[nodiscard]] ABUT_HD constexpr double size() const { return size_; }
    /// The smallest box around the points as they are seen.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr aabb<double> box() const {
        aabb<double> box = empty_box<double>();
        ABUT_ROLLED
        for (int k = 0; k < 6; ++k) box = merge(box, bounds(last_along(k)));
        return box;
    }
    /// A box within that, around the points that are first and last along an axis where they are not placed.
    [[nodiscard]] ABUT_HD constexpr aabb<double> inner_box() const {
        aabb<double> box = empty_box<double>();
        ABUT_ROLLED
        for (int k = 0; k < 6; ++k) box = merge(box, bounds((*this)[of_->edges[k]]));
        return box;
    }
    /// The largest magnitude of a coordinate. Looks no way along which there is none, as the box tells that is not placed.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr double largest() const {
        const point c = middle();
        double most = 0;
        ABUT_ROLLED
        for (int k = 0; k < 6; ++k) {
            const double there = k % 3 == 0 ? c.x : k % 3 == 1 ? c.y : c.z;
            if ((k < 3 ? -there : there) + 1.01 * half_ + 0x1p-20 * placed_ < most) continue;
            const point p = absolute(last_along(k));
            most = greatest(most, p.x, p.y, p.z);
        }
        return most;
    }
    /// Where a point has a lesser product with the way than `lowest` is: the least product, and the first that has it.
    ABUT_NOINLINE ABUT_HD constexpr void look_back(const point& way, double& lowest, std::uint32_t& first) const {
        constexpr int room = 16;
        constexpr double lost = std::same_as<T, float> ? 0x1p-120 : 0x1p-1000, off = std::same_as<T, float> ? 0x1p-22 : 0x1p-49;
        const double margin = magnitudes(way) * (0x1p-49 * size_ + (off * placed_ + lost)) + 0x1p-1060;
        const point in_frame = way_in_frame(way);
        const double off_in_frame = 0x1p-47 * raw_ * magnitudes(way);
        double low = 0, next_above = 0;
        std::uint32_t at[room] = {descend(in_frame, low, next_above)};
        double height[room] = {height_of(way, at[0])}, least = height[0];
        std::uint32_t best = at[0];
        const bool is_alone = next_above > margin + off_in_frame && next_above < infinity<double>;
        int count = !(margin < 0x1p900) ? room : is_alone ? 0 : 1;
        low = low + (2 * margin + off_in_frame);  // what is higher there is so by more than the margin
        for (int k = 0; k < count && count < room; ++k) {
            if (!(height[k] <= least + margin)) continue;
            for (const std::uint32_t *next = begin_of(at[k]), *const end = begin_of(at[k] + 1); next != end; ++next) {
                if (dot(in_frame, widened(raw(*next))) > low || has(at, count, *next)) continue;
                const double x = height_of(way, *next);
                if (!(x <= least + margin)) continue;
                if (x < least || (x == least && *next < best)) least = x, best = *next;
                if (count == room - 1) {
                    count = room;
                    break;
                }
                at[count] = *next;
                height[count++] = x;
            }
        }
        if (count == room) read_all(way, least = infinity<double>, best = 0);
        at_ = best;
        if (least < lowest) lowest = least, first = best;
    }

private:
    /// A point that is first in x, y or z, for k of 0 to 2, or last.
    [[nodiscard]] ABUT_HD constexpr point last_along(int k) const {
        std::uint32_t i = of_->edges[k];
        if (of_->is_placed) {
            const double one = k < 3 ? 1 : -1;
            const point way{k % 3 == 0 ? one : 0, k % 3 == 1 ? one : 0, k % 3 == 2 ? one : 0}, in_frame = way_in_frame(way);
            double lowest = infinity<double>;
            for (int e = 0; e < 6; ++e) {
                const double x = dot(in_frame, widened(raw(of_->edges[e])));
                if (x < lowest) lowest = x, at_ = of_->edges[e];
            }
            look_back(way, lowest = infinity<double>, i);
        }
        return (*this)[i];
    }
    [[nodiscard]] ABUT_HD constexpr const std::uint32_t* begin_of(std::size_t i) const { return of_->edges + of_->edges[6 + i]; }
    [[nodiscard]] ABUT_HD static constexpr bool has(const std::uint32_t* at, int count, std::uint32_t i) {
        for (int k = 0; k < count; ++k) {
            if (at[k] == i) return true;
        }
        return false;
    }
    [[nodiscard]] ABUT_HD constexpr double height_of(const point& way, std::size_t i) const {
        const point p = (*this)[i];
        return plain_sum(plain_sum(plain_product(way.x, p.x), plain_product(way.y, p.y)), plain_product(way.z, p.z));
    }
    [[nodiscard]] ABUT_HD constexpr vec3<T> raw(std::size_t i) const { return of_->unplaced(i); }
    /// From where the last search came to, by heights in the frame in which points are not placed: a corner, its
    /// height, and by how much the lowest one that it has an edge to is higher.
    [[nodiscard]] ABUT_HD constexpr std::uint32_t descend(const point& way, double& height, double& next_above) const {
        std::uint32_t at = at_;
        height = dot(way, widened(raw(at)));
        for (bool better = true; better;) {
            better = false;
            next_above = infinity<double>;
            for (const std::uint32_t *next = begin_of(at), *const end = begin_of(at + 1); next != end; ++next) {
                const double x = dot(way, widened(raw(*next)));
                next_above = least(next_above, x - height);
                if (x < height) height = x, at = *next, better = true;
            }
        }
        return at;
    }
    [[nodiscard]] ABUT_HD constexpr point way_in_frame(const point& way) const {
        if (!of_->is_placed) return way;
        const auto& r = of_->pose.rotation;
        return {dot(way, widened(column(r, 0))), dot(way, widened(column(r, 1))), dot(way, widened(column(r, 2)))};
    }
    ABUT_NOINLINE ABUT_HD constexpr void read_all(const point& way, double& least, std::uint32_t& best) const {
        ABUT_ROLLED
        for (std::size_t i = 0; i < of_->count; ++i) {
            const double x = height_of(way, i);
            if (x < least) least = x, best = static_cast<std::uint32_t>(i);
        }
    }

    const hull<T>* of_ = nullptr;
    point origin_{0, 0, 0}, middle_{0, 0, 0};  ///< the middle of the box that is not placed
    double half_ = 0, raw_ = 0, placed_ = 0, size_ = 0;
    mutable std::uint32_t at_ = 0;
};

}  // namespace abut::detail
