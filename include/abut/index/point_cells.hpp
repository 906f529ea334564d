// SPDX-License-Identifier: MIT
#pragma once

// Points in the cubes of one lattice, for many questions by small shapes on a host: made for one call, or kept with a grid
// (grid_options::clearances). Not an index by itself. Rows of cells along x lie one after another, with the places of their points
// side by side, so that what a ball covers of a row is one range, four points at a time. Each cell knows a distance that no
// point is within of it, and a point that is near: most balls are decided by these two.
//
// All is measured in cells, in single precision whatever the points are in, and compared with a margin that is more than all of
// the rounding; what lies between is for others to decide. With u half a unit in the last place of float, a place q = (x -
// lower) s carries (1 + u)^3, a difference of places 4u of both, its square's root 3u more, a radius 2u. In sum that is below 21u
// (|c| + cells along the longest side + r), with |c| the sum of the centre's coordinates, in any rounding mode below 42u, and what
// is done with a row of cells adds less than 4u of r. The margin is 64u. Denormals, flushed or not, are below 2^-26 of a cell.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/shape/bounds.hpp>

namespace abut::detail {

/// A ball in cells.
struct ball_in_cells {
    float x, y, z, radius, margin;
};

template <scalar T>
class point_cells {
public:
    /// Of all points of a view in host memory, for about so many balls. A point takes 16 bytes and a cell 9, and while they are
    /// made 4 and 8 more; there are half as many cells as points and 64, or as many for very many balls. Time: some 50 ns a
    /// point, and 200 to 700 for very many. None where the points are in one place, or where their extent or its inverse is near
    /// the end of the numbers.
    template <class Points>
    point_cells(const Points& points, std::size_t balls) {
        const std::size_t n = points.size();
        aabb<T> box = empty_box<T>();
        for (std::size_t i = 0; i < n; ++i) box = merge(box, bounds(points[i]));
        const bool many = balls / 16 > n;
        if (!divide(box, (many ? 1 : 0.5) * static_cast<double>(n) + 64)) return;

        std::vector<std::uint32_t> cell_of(n);
        starts_.assign(cells() + 1, 0);
        for (std::size_t i = 0; i < n; ++i) {
            const vec3<float> p = place(points[i]);
            cell_of[i] = static_cast<std::uint32_t>(number(cell(0, p.x), cell(1, p.y), cell(2, p.z)));
            ++starts_[cell_of[i] + 1];
        }
        for (std::size_t c = 0; c < cells(); ++c) starts_[c + 1] += starts_[c];
        for (std::vector<float>& axis : at_) axis.assign(n + 3, 0);
        ids_.resize(n);
        std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
        for (std::size_t i = 0; i < n; ++i) {
            const vec3<float> p = place(points[i]);
            const std::uint32_t to = next[cell_of[i]]++;
            at_[0][to] = p.x, at_[1][to] = p.y, at_[2][to] = p.z;
            ids_[to] = static_cast<std::uint32_t>(i);
        }
        measure_clearances();
        find_near();
        if (many) look_closer();
    }
    point_cells(const point_cells&) = delete;
    point_cells& operator=(const point_cells&) = delete;

    /// Whether there are any.
    [[nodiscard]] bool is_there() const { return !ids_.empty(); }
    [[nodiscard]] std::size_t bytes() const {
        return 4 * (starts_.size() + near_.size() + ids_.size() + 3 * at_[0].size()) + clear_.size();
    }

    [[nodiscard]] ball_in_cells in_cells(const vec3<T>& center, T radius) const {
        const vec3<float> c = place(center);
        const float r = static_cast<float>(radius * per_unit_);
        return {c.x, c.y, c.z, r, 0x1p-18f * (magnitudes(c) + r + longest_)};
    }
    /// Whether a ball touches nothing beyond doubt, as the cell of its centre tells. From outside all cells the way to the
    /// nearest one of them makes no acute angle with that on to a point.
    [[nodiscard]] bool is_clear(const ball_in_cells& b) const {
        const float x = outside(0, b.x), y = outside(1, b.y), z = outside(2, b.z), reach = b.radius + b.margin;
        const float clear = static_cast<float>(clear_[number(cell(0, b.x), cell(1, b.y), cell(2, b.z))]) / 8;
        return reach * reach < x * x + y * y + z * z + clear * clear;
    }
    /// A point near the ball's centre, for has_surely and id.
    [[nodiscard]] std::uint32_t near(const ball_in_cells& b) const {
        return near_[number(cell(0, b.x), cell(1, b.y), cell(2, b.z))];
    }
    [[nodiscard]] bool has_surely(const ball_in_cells& b, std::uint32_t k) const {
        const float x = b.x - at_[0][k], y = b.y - at_[1][k], z = b.z - at_[2][k], inner = greatest(b.radius - b.margin, 0.0f);
        return x * x + y * y + z * z < inner * inner;
    }
    [[nodiscard]] std::uint32_t id(std::uint32_t k) const { return ids_[k]; }

    /// Calls visitor(id, surely) -> bool for all points that a ball may have, until it says false; `surely` where it has one
    /// beyond doubt.
    template <class Visitor>
    void for_each(const ball_in_cells& b, const Visitor& visitor) const {
        using many = lanes<float>;
        const float reach = b.radius + b.margin, inner = greatest(b.radius - b.margin, 0.0f), limit = reach * reach;
        if (!(limit < most_limit)) return all_of(visitor);
        const many cx = many::all(b.x), cy = many::all(b.y), cz = many::all(b.z), outer = many::all(limit),
                   within = many::all(inner * inner);
        const auto row = [&](std::uint32_t from, std::uint32_t end) {
            for (std::uint32_t i = from; i < end; i += 4) {
                const many dx = cx - many::load(at_[0].data() + i), dy = cy - many::load(at_[1].data() + i),
                           dz = cz - many::load(at_[2].data() + i), square = dx * dx + dy * dy + dz * dz;
                const typename many::mask kept[] = {square <= outer};
                unsigned left = bits_of(kept) & ((1u << least(end - i, 4u)) - 1);
                if (left == 0) continue;
                const typename many::mask sure[] = {square >= within};
                for (const unsigned unsure = bits_of(sure); left != 0; left &= left - 1) {
                    const unsigned k = lowest_bit(left);
                    if (!visitor(ids_[i + k], (unsure >> k & 1) == 0)) return false;
                }
            }
            return true;
        };
        const int z0 = cell(2, b.z - reach), z1 = cell(2, b.z + reach);
        if (reach < 1) {
            const auto x0 = static_cast<std::size_t>(cell(0, b.x - reach)), x1 = static_cast<std::size_t>(cell(0, b.x + reach)) + 1;
            const int y0 = cell(1, b.y - reach), y1 = cell(1, b.y + reach);
            for (int k = z0; k <= z1; ++k) {
                for (int j = y0; j <= y1; ++j) {
                    const std::size_t first = number(0, j, k);
                    if (!row(starts_[first + x0], starts_[first + x1])) return;
                }
            }
            return;
        }
        for (int i = 0; i <= z1 - z0; ++i) {
            const int k = (z0 + z1) / 2 + from_middle(i);
            const float away_z = beside(k, b.z), left_z = limit - away_z * away_z;
            if (left_z < 0) continue;
            const float half_y = std::sqrt(left_z);
            const int y0 = cell(1, b.y - half_y), y1 = cell(1, b.y + half_y);
            std::size_t first = number(0, y0, k);
            for (int j = y0; j <= y1; ++j, first += static_cast<std::size_t>(count_[0])) {
                const float away_y = beside(j, b.y), half = std::sqrt(greatest(left_z - away_y * away_y, 0.0f));
                if (!row(starts_[first + static_cast<std::size_t>(cell(0, b.x - half))],
                         starts_[first + static_cast<std::size_t>(cell(0, b.x + half)) + 1])) {
                    return;
                }
            }
        }
    }
    /// Calls visitor(id) -> bool for points that may be in a box, and others, until it says false.
    template <class Visitor>
    void for_each(const aabb<T>& box, const Visitor& visitor) const {
        const vec3<float> lower = place(box.lower), upper = place(box.upper);
        const float margin = in_cells(box.lower, T(0)).margin + in_cells(box.upper, T(0)).margin;
        if (!(margin < 1)) return all_of([&](std::uint32_t id, bool) { return visitor(id); });
        const int x0 = cell(0, lower.x - margin), x1 = cell(0, upper.x + margin), y0 = cell(1, lower.y - margin),
                  y1 = cell(1, upper.y + margin), z0 = cell(2, lower.z - margin), z1 = cell(2, upper.z + margin);
        const int x = (x0 + x1) / 2, y = (y0 + y1) / 2, z = (z0 + z1) / 2, clear = clear_[number(x, y, z)];
        if (64.0 * (squared(x1 - x) + squared(y1 - y) + squared(z1 - z)) < clear * clear) return;
        for (int i = 0; i <= z1 - z0; ++i) {
            for (int h = 0; h <= y1 - y0; ++h) {
                const int j = y + from_middle(h), k = z + from_middle(i);
                for (std::uint32_t at = starts_[number(x0, j, k)], end = starts_[number(x1, j, k) + 1]; at < end; ++at) {
                    if (!visitor(ids_[at])) return;
                }
            }
        }
    }

private:
    static constexpr float most_limit = 0x1p40f;
    static constexpr int most_clear = 31;  ///< cells, in eighths a byte
    T lower_[3] = {}, per_unit_ = 0;
    float last_[3] = {}, longest_ = 0;  ///< of cells, by axis: the last one's number; and how many along the longest side
    int count_[3] = {};                 ///< of cells, by axis
    std::vector<std::uint32_t> starts_, ids_;
    std::vector<float> at_[3];
    std::vector<std::uint32_t> near_;   ///< of a cell, a point near its middle
    std::vector<std::uint8_t> clear_;   ///< of a cell, eighths of a cell's width, rounded down, that no point is within of it

    [[nodiscard]] std::size_t cells() const { return number(0, 0, count_[2]); }
    [[nodiscard]] std::size_t number(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] static double squared(int x) { return static_cast<double>(x) * x; }
    /// 0, 1, -1, 2, -2, ...
    [[nodiscard]] static int from_middle(int i) { return i % 2 != 0 ? (i + 1) / 2 : -(i / 2); }
    /// How far a place is beside a cell, along an axis.
    [[nodiscard]] static float beside(int at, float x) {
        const float from = static_cast<float>(at);
        return greatest(from - x, x - (from + 1), 0.0f);
    }
    [[nodiscard]] vec3<float> place(const vec3<T>& p) const {
        return {static_cast<float>((p.x - lower_[0]) * per_unit_), static_cast<float>((p.y - lower_[1]) * per_unit_),
                static_cast<float>((p.z - lower_[2]) * per_unit_)};
    }
    /// The cell of a place, the nearest one of what is outside; of NaN the first.
    [[nodiscard]] int cell(int axis, float x) const { return static_cast<int>(least(greatest(x, 0.0f), last_[axis])); }

    [[nodiscard]] float outside(int axis, float x) const { return greatest(-x, x - (last_[axis] + 1), 0.0f); }

    template <class Visitor>
    void all_of(const Visitor& visitor) const {
        for (const std::uint32_t id : ids_) {
            if (!visitor(id, false)) return;
        }
    }

    /// Cubes, `most` at most.
    bool divide(const aabb<T>& box, double most) {
        lower_[0] = box.lower.x, lower_[1] = box.lower.y, lower_[2] = box.lower.z;
        const vec3<double> side = widened(box.upper) - widened(box.lower);
        const double sides[] = {side.x, side.y, side.z}, longest = std::max({side.x, side.y, side.z});
        const T extent = greatest(box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z);
        if (!(extent < T(0.25) / smallest_normal<T>) || !(longest * 0x1p-10 > static_cast<double>(smallest_normal<T>) * 0x1p30)) {
            return false;
        }
        for (double across = 1000;; across *= 0.9) {  // cells along the longest side
            per_unit_ = static_cast<T>(across / longest);
            double all = 1;
            for (int k = 0; k < 3; ++k) {
                count_[k] = static_cast<int>(static_cast<float>(static_cast<T>(sides[k]) * per_unit_)) + 1;
                last_[k] = static_cast<float>(count_[k] - 1);
                all *= count_[k];
            }
            longest_ = static_cast<float>(std::max({count_[0], count_[1], count_[2]}));
            if (all <= most) return true;
        }
    }

    /// By axis, one after another, squares: the distance from cell to cell is that of |i - j| - 1 cells along each axis.
    void measure_clearances() {
        const std::size_t n = cells();
        constexpr auto none = static_cast<std::uint16_t>(most_clear * most_clear);
        std::vector<std::uint16_t> square(n), line;
        for (std::size_t c = 0; c < n; ++c) square[c] = starts_[c] < starts_[c + 1] ? 0 : none;
        for (int axis = 0; axis < 3; ++axis) {
            const auto stride = axis == 0 ? std::size_t{1} : number(0, axis == 1, axis == 2);
            const int length = count_[axis];
            line.resize(static_cast<std::size_t>(length));
            for (std::size_t c = 0; c < n; ++c) {
                if (c / stride % static_cast<std::size_t>(length) != 0) continue;
                for (int i = 0; i < length; ++i) line[static_cast<std::size_t>(i)] = square[c + static_cast<std::size_t>(i) * stride];
                for (int i = 0; i < length; ++i) {
                    int best = line[static_cast<std::size_t>(i)];
                    for (int t = 1; t < length && (t - 1) * (t - 1) < best; ++t) {
                        const int way = (t - 1) * (t - 1);
                        if (i >= t) best = least(best, line[static_cast<std::size_t>(i - t)] + way);
                        if (i + t < length) best = least(best, line[static_cast<std::size_t>(i + t)] + way);
                    }
                    square[c + static_cast<std::size_t>(i) * stride] = static_cast<std::uint16_t>(best);
                }
            }
        }
        clear_.resize(n);
        for (std::size_t c = 0; c < n; ++c) clear_[c] = static_cast<std::uint8_t>(8 * std::sqrt(static_cast<double>(square[c])));
    }

    /// There and back through all cells, each takes a neighbour's point if that is nearer to its middle.
    void find_near() {
        const std::size_t n = cells(), row = static_cast<std::size_t>(count_[0]), plane = number(0, 0, 1);
        constexpr auto none = static_cast<std::uint32_t>(-1);
        near_.assign(n, none);
        std::vector<float> nearest(n, infinity<float>);
        const auto offer = [&](std::size_t c, float x, float y, float z, std::uint32_t k) {
            if (k == none) return;
            x -= at_[0][k], y -= at_[1][k], z -= at_[2][k];
            if (const float square = x * x + y * y + z * z; square < nearest[c]) nearest[c] = square, near_[c] = k;
        };
        const auto each = [&](bool back, const auto& act) {
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t c = back ? n - 1 - i : i, x = c % row, y = c % plane / row, z = c / plane;
                act(c, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, static_cast<float>(z) + 0.5f,
                    back ? x + 1 < row : x > 0, back ? y + 1 < plane / row : y > 0, back ? z + 1 < n / plane : z > 0);
            }
        };
        each(false, [&](std::size_t c, float x, float y, float z, bool, bool, bool) {
            for (std::uint32_t k = starts_[c]; k < starts_[c + 1]; ++k) offer(c, x, y, z, k);
        });
        for (const bool back : {false, true, false, true}) {
            each(back, [&](std::size_t c, float x, float y, float z, bool has_x, bool has_y, bool has_z) {
                if (has_x) offer(c, x, y, z, near_[back ? c + 1 : c - 1]);
                if (has_y) offer(c, x, y, z, near_[back ? c + row : c - row]);
                if (has_z) offer(c, x, y, z, near_[back ? c + plane : c - plane]);
            });
        }
        for (std::uint32_t& k : near_) k = k == none ? 0 : k;
    }

    /// Of cells that are near points the distance from points, and not from cells with points.
    void look_closer() {
        constexpr float far = 5;
        const std::size_t n = cells(), row = static_cast<std::size_t>(count_[0]), plane = number(0, 0, 1);
        for (std::size_t c = 0; c < n; ++c) {
            if (clear_[c] > 8 * far || starts_[c] < starts_[c + 1]) continue;
            const auto x = static_cast<int>(c % row), y = static_cast<int>(c % plane / row), z = static_cast<int>(c / plane);
            const auto square = [](float a, float b, float d) { return a * a + b * b + d * d; };
            const auto from = [&](std::uint32_t k) {
                return square(beside(x, at_[0][k]), beside(y, at_[1][k]), beside(z, at_[2][k]));
            };
            float best = from(near_[c]);
            const int reach = static_cast<int>(std::sqrt(best)) + 1;
            const auto least_in = [](int d) { return static_cast<float>(greatest(d < 0 ? -d - 1 : d - 1, 0)); };
            for (int dz = greatest(-reach, -z); dz <= least(reach, count_[2] - 1 - z); ++dz) {
                for (int dy = greatest(-reach, -y); dy <= least(reach, count_[1] - 1 - y); ++dy) {
                    const float left = best - square(least_in(dz), least_in(dy), 0);
                    if (!(left > 0)) continue;
                    const int half = static_cast<int>(std::sqrt(left)) + 1;
                    const std::size_t at = number(0, y + dy, z + dz);
                    for (std::uint32_t k = starts_[at + static_cast<std::size_t>(greatest(x - half, 0))],
                                       end = starts_[at + static_cast<std::size_t>(least(x + half, count_[0] - 1)) + 1];
                         k < end; ++k) {
                        best = least(best, from(k));
                    }
                }
            }
            clear_[c] = static_cast<std::uint8_t>(least(8 * std::sqrt(best), 255.0f));
        }
    }
};

}  // namespace abut::detail
