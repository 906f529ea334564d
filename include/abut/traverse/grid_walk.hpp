// SPDX-License-Identifier: MIT
#pragma once

// One query against a grid: the cells under the query's box, level by level.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/align.hpp>
#include <abut/index/grid.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

template <class Grid>
struct grid_walk {
    using scalar_type = typename Grid::scalar_type;
    using frame = grid_frame<scalar_type>;
    Grid grid;

    /// False if the query touches nothing in the grid.
    template <class Reach>
    ABUT_HD bool may_touch(Reach& reach) const {
        return reach(grid.frame->bounds);
    }

    /// Where a walk that rests goes on: at an item of a cell of a level. It begins at the lowest cell of the first
    /// one.
    struct cursor {
        int level = 0;
        vec3<std::int32_t> cell = {-1, -1, -1};
        std::uint32_t item = 0;  ///< of the cell; or of all, where the query is larger than the grid
    };

    /// Calls visitor(shape id) -> visit for every shape whose box the query reaches, until it says stop. Rests where rests()
    /// says so, which it is asked after each shape; then it returns true, and another call with the same query goes on from
    /// `at`. At its end it returns false.
    template <class Reach, class Rests, class Visitor>
    ABUT_HD bool for_each(Reach& reach, cursor& at, const Rests& rests, Visitor&& visitor) const {
        const aabb<scalar_type> box = reach.bounds();
        const vec3<std::int32_t> lower = grid.frame->cell(box.lower), upper = grid.frame->cell(box.upper);
        if (cells_under(lower, upper) > static_cast<double>(grid.size())) {
            return in_items(0, grid.size(), at.item, reach, rests, visitor) == outcome::rested;
        }
        cursor now = at;
        now.level = level_in_use(now.level);
        if (now.level == frame::levels) return false;
        cell_range cells = range(now.level, lower, upper);
        if (now.cell.x < 0) now.cell = cells.first;
        // One loop through the cells of all levels: the lanes of a warp, which are at different levels, meet at each cell.
        for (;;) {
            const std::uint64_t slot = grid.find(frame::key(now.level, now.cell));
            if (slot != grid.slots) {
                const outcome o = in_items(grid.starts[slot], grid.starts[slot + 1], now.item, reach, rests, visitor);
                if (o != outcome::done) {
                    at = now;
                    return o == outcome::rested;
                }
            }
            // To the next cell, without a branch where lanes would part.
            now.item = 0;
            const bool next_y = ++now.cell.z > cells.last.z;
            now.cell.z = next_y ? cells.first.z : now.cell.z;
            now.cell.y += static_cast<int>(next_y);
            const bool next_x = now.cell.y > cells.last.y;
            now.cell.y = next_x ? cells.first.y : now.cell.y;
            now.cell.x += static_cast<int>(next_x);
            if (now.cell.x > cells.last.x) {
                now.level = level_in_use(now.level + 1);
                if (now.level == frame::levels) return false;
                cells = range(now.level, lower, upper);
                now.cell = cells.first;
            }
        }
    }

private:
    struct cell_range {
        vec3<std::int32_t> first, last;
    };

    /// The first level from `level` on in which shapes lie; `levels` if there is none.
    [[nodiscard]] ABUT_HD int level_in_use(int level) const {
        const std::uint32_t left = grid.frame->levels_in_use >> level;
        return left == 0 ? frame::levels : level + lowest_bit(std::int64_t{left});
    }

    /// Cells of a level in which a shape lies that can touch a query over these base cells: the query's own and, since a
    /// shape is kept at its lower corner and spans at most one cell more than that, the next lower ones.
    ABUT_HD static cell_range range(int level, const vec3<std::int32_t>& lower, const vec3<std::int32_t>& upper) {
        const auto down = [&](std::int32_t c) { return greatest((c >> level) - 1, 0); };
        return {{down(lower.x), down(lower.y), down(lower.z)}, {upper.x >> level, upper.y >> level, upper.z >> level}};
    }

    /// In double: the number of cells may be larger than any integer.
    ABUT_HD double cells_under(const vec3<std::int32_t>& lower, const vec3<std::int32_t>& upper) const {
        double sum = 0;
        for (int level = level_in_use(0); level < frame::levels; level = level_in_use(level + 1)) {
            const auto [first, last] = range(level, lower, upper);
            sum += (last.x - first.x + 1.0) * (last.y - first.y + 1.0) * (last.z - first.z + 1.0);
        }
        return sum;
    }

    enum class outcome { done, rested, stopped };

    /// Of the items from `begin` on, those behind the first `seen`.
    template <class Reach, class Rests, class Visitor>
    ABUT_HD outcome in_items(std::size_t begin, std::size_t end, std::uint32_t& seen, Reach& reach, const Rests& rests,
                             Visitor& visitor) const {
        for (std::size_t i = begin + seen; i < end; ++i) {
            const grid_item<scalar_type> item = grid.items[i];
            if (!reach(item.box)) continue;
            if (visitor(item.id) == visit::stop) return outcome::stopped;
            if (rests()) {
                seen = static_cast<std::uint32_t>(i + 1 - begin);
                return outcome::rested;
            }
        }
        return outcome::done;
    }
};

}  // namespace abut::detail
