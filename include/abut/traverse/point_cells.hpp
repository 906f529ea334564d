// SPDX-License-Identifier: MIT
#pragma once

// Points in the cells of one grid, for many questions by small shapes on a host, made for one call. Not an index that a caller
// keeps (grid.hpp, bvh.hpp). Rows of cells along x lie one after another, with the coordinates of their points side by side, so
// that what a box covers of a row is one range, four points at a time. Each cell knows how many cells around it are empty: a
// small shape in free space looks at one byte.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/sphere.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

template <scalar T>
class point_cells {
public:
    /// Of all points of a view in host memory, of which there is one at least. Linear time, 19 bytes a point in single precision
    /// and 31 in double, and 6 more while it is made.
    template <class Points>
    explicit point_cells(const Points& points) {
        const std::size_t n = points.size();
        aabb<T> box = empty_box<T>();
        for (std::size_t i = 0; i < n; ++i) box = merge(box, bounds(points[i]));
        divide(box, static_cast<double>(n));

        std::vector<std::uint32_t> cell_of(n);
        starts_.assign(cells() + 1, 0);
        for (std::size_t i = 0; i < n; ++i) {
            const vec3<T> p = points[i];
            cell_of[i] = static_cast<std::uint32_t>(number(place(0, p.x), place(1, p.y), place(2, p.z)));
            ++starts_[cell_of[i] + 1];
        }
        for (std::size_t c = 0; c < cells(); ++c) starts_[c + 1] += starts_[c];
        for (std::vector<T>& axis : at_) axis.assign(n + 3, T(0));
        ids_.resize(n);
        std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < n; ++i) {
            const vec3<T> p = points[i];
            const std::uint32_t to = next[cell_of[i]]++;
            at_[0][to] = p.x, at_[1][to] = p.y, at_[2][to] = p.z;
            ids_[to] = static_cast<std::uint32_t>(i);
        }
        measure_gaps();
    }

    /// Calls visitor(id, surely) -> visit for points that a reach (shape/reach.hpp) may keep, until it says stop; `surely`
    /// where a ball has the point beyond doubt. The cells of a coordinate rise with it, whatever is rounded: so what lies in a
    /// box is in the cells from its lower to its upper corner.
    template <class Reach, class Visitor>
    void for_each(const Reach& reach, const Visitor& visitor) const {
        const aabb<T> box = around(reach);
        const int x0 = place(0, box.lower.x), x1 = place(0, box.upper.x), y0 = place(1, box.lower.y), y1 = place(1, box.upper.y),
                  z0 = place(2, box.lower.z), z1 = place(2, box.upper.z);
        const int x = (x0 + x1) / 2, y = (y0 + y1) / 2, z = (z0 + z1) / 2, gap = gaps_[number(x, y, z)];
        if (greatest(x1 - x, y1 - y, z1 - z) < gap) return;
        // From the middle outwards: that is where a shape is likely to meet something.
        for (int i = 0; i <= z1 - z0; ++i) {
            const int k = z + from_middle(i);
            for (int h = 0; h <= y1 - y0; ++h) {
                const int j = y + from_middle(h);
                const bool is_empty = greatest(h + 1, i + 1) / 2 < gap && x1 - x < gap;
                if (!is_empty && !in_row(reach, number(x0, j, k), number(x1, j, k), visitor)) return;
            }
        }
    }

private:
    static constexpr int most_gap = 255;
    T lower_[3], per_unit_[3], last_[3];  ///< of cells, by axis: where the first begins, how many a unit has, the last one's number
    int count_[3];                        ///< of cells, by axis
    std::vector<std::uint32_t> starts_, ids_;
    std::vector<T> at_[3];
    std::vector<std::uint8_t> gaps_;  ///< of a cell, how many cells away the next point's is, along the axis where it is farthest

    [[nodiscard]] std::size_t cells() const { return number(0, 0, count_[2]); }
    [[nodiscard]] std::size_t number(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(x);
    }
    /// 0, 1, -1, 2, -2, ...
    [[nodiscard]] static int from_middle(int i) { return i % 2 != 0 ? (i + 1) / 2 : -(i / 2); }
    /// The cell of a coordinate, the nearest one of what is outside. No number, of an axis of one cell, is in the first.
    [[nodiscard]] int place(int axis, T x) const {
        return static_cast<int>(least(greatest((x - lower_[axis]) * per_unit_[axis], T(0)), last_[axis]));
    }

    template <class Reach>
    [[nodiscard]] static aabb<T> around(const Reach& reach) {
        return reach.bounds();
    }
    /// Of a ball a box that is a little larger, and takes less time: rounding costs less than what it is grown by.
    [[nodiscard]] static aabb<T> around(const ball_reach<T>& reach) {
        const vec3<T>& c = reach.ball.center;
        const T r = reach.ball.radius;
        const T grown = r + (8 * unit_roundoff<T> * (magnitudes(c) + r) + 2 * smallest_normal<T>);
        return {{c.x - grown, c.y - grown, c.z - grown}, {c.x + grown, c.y + grown, c.z + grown}};
    }

    /// Cubes, of which there are about half as many as points.
    void divide(const aabb<T>& box, double n) {
        lower_[0] = box.lower.x, lower_[1] = box.lower.y, lower_[2] = box.lower.z;
        const vec3<double> side = widened(box.upper) - widened(box.lower);
        const double sides[] = {side.x, side.y, side.z}, longest = std::max({side.x, side.y, side.z});
        const double most = n / 2 + 64;
        for (double across = 1024;; across *= 0.8) {  // cells along the longest side
            double all = 1;
            for (int k = 0; k < 3; ++k) {
                const double share = longest > 0 ? sides[k] / longest : 0;
                count_[k] = std::max(static_cast<int>(share * across), 1);
                per_unit_[k] = count_[k] > 1 ? static_cast<T>(count_[k] / sides[k]) : T(0);
                last_[k] = static_cast<T>(count_[k] - 1);
                all *= count_[k];
            }
            if (all <= most) return;
        }
    }

    /// The next cell with a point is one farther away than that of some neighbour: there and back through all cells.
    void measure_gaps() {
        gaps_.resize(cells());
        for (std::size_t c = 0; c < cells(); ++c) gaps_[c] = starts_[c] < starts_[c + 1] ? 0 : most_gap;
        for (const int step : {-1, 1}) {
            const std::size_t n = cells();
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t c = step < 0 ? i : n - 1 - i;
                if (gaps_[c] == 0) continue;
                const auto row = static_cast<std::size_t>(count_[0]), plane = row * static_cast<std::size_t>(count_[1]);
                const int x = static_cast<int>(c % row), y = static_cast<int>(c / row % static_cast<std::size_t>(count_[1])),
                          z = static_cast<int>(c / plane);
                int least = gaps_[c];
                for (int k = 0; k < 13; ++k) {  // half of the 26 neighbours: those before it
                    const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
                    const int u = x - step * dx, v = y - step * dy, w = z - step * dz;
                    if (u < 0 || v < 0 || w < 0 || u >= count_[0] || v >= count_[1] || w >= count_[2]) continue;
                    least = std::min(least, gaps_[number(u, v, w)] + 1);
                }
                gaps_[c] = static_cast<std::uint8_t>(least);
            }
        }
    }

    /// Points of cells from first to last of a row, which one range holds. False where the visitor says stop.
    template <class Reach, class Visitor>
    bool in_row(const Reach& reach, std::size_t first, std::size_t last, const Visitor& visitor) const {
        const std::uint32_t end = starts_[last + 1];
        for (std::uint32_t i = starts_[first]; i < end; i += 4) {
            const unsigned all = (1u << least(end - i, 4u)) - 1;
            const some_of_four found = among(reach, i);
            for (unsigned kept = found.kept & all; kept != 0; kept &= kept - 1) {
                const unsigned k = lowest_bit(kept);
                if (visitor(ids_[i + k], (found.surely >> k & 1) != 0) == visit::stop) return false;
            }
        }
        return true;
    }
    /// Which of four points a reach may keep, and which beyond doubt, a bit each.
    struct some_of_four {
        unsigned kept, surely;
    };
    template <class Reach>
    [[nodiscard]] some_of_four among(const Reach& reach, std::uint32_t i) const {
        unsigned kept = 0;
        for (unsigned k = 0; k < 4; ++k) {
            const vec3<T> p{at_[0][i + k], at_[1][i + k], at_[2][i + k]};
            kept |= static_cast<unsigned>(reach(aabb<T>{p, p})) << k;
        }
        return {kept, 0};
    }
    /// Of a ball by lanes, with the bound of ball_reach, which is of both sides: what it adds to the square is taken off twice.
    [[nodiscard]] some_of_four among(const ball_reach<T>& reach, std::uint32_t i) const {
        using many = lanes<T>;
        const vec3<T>& c = reach.ball.center;
        const many x = many::all(c.x) - many::load(at_[0].data() + i), y = many::all(c.y) - many::load(at_[1].data() + i),
                   z = many::all(c.z) - many::load(at_[2].data() + i), square = x * x + y * y + z * z;
        const T within = reach.limit - (64 * unit_roundoff<T> * reach.limit + 8 * smallest_normal<T>);
        const typename many::mask kept[] = {square <= many::all(reach.limit)}, surely[] = {square <= many::all(within)};
        return {bits_of(kept), bits_of(surely)};
    }
};

}  // namespace abut::detail
