// SPDX-License-Identifier: MIT
#pragma once

// One query against a grid: the cells under the query's box, level by level.

#include <cstddef>
#include <cstdint>

#include <abut/index/grid.hpp>
#include <abut/traverse/reach.hpp>
#include <abut/traverse/visit.hpp>

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
        std::uint64_t item = 0;  ///< of the cell; or of all, where the query is larger than the grid
    };

    /// Calls visitor(shape id) -> visit for every shape whose box the query reaches, until it says stop. Rests where rests()
    /// says so, which it is asked after each shape; then it returns true, and another call with the same query goes on from
    /// `at`. At its end it returns false.
    template <class Reach, class Rests, class Visitor>
    ABUT_HD bool for_each(Reach& reach, cursor& at, const Rests& rests, Visitor&& visitor) const {
        const aabb<scalar_type> box = reach.bounds();
        const vec3<std::int32_t> lower = grid.frame->cell(box.lower), upper = grid.frame->cell(box.upper);
        if (cells_under(lower, upper) > static_cast<double>(grid.size())) {
            return in_items(0, grid.size(), at, reach, rests, visitor) == outcome::rested;
        }
        for (; at.level < frame::levels; ++at.level, at.cell.x = -1) {
            if ((grid.frame->levels_in_use >> at.level & 1) == 0) continue;
            const auto [first, last] = range(at.level, lower, upper);
            if (at.cell.x < 0) at.cell = first;
            for (; at.cell.x <= last.x; ++at.cell.x, at.cell.y = first.y) {
                for (; at.cell.y <= last.y; ++at.cell.y, at.cell.z = first.z) {
                    for (; at.cell.z <= last.z; ++at.cell.z, at.item = 0) {
                        const std::uint64_t slot = grid.find(frame::key(at.level, at.cell));
                        if (slot == grid.slots) continue;
                        const outcome o = in_items(grid.starts[slot], grid.starts[slot + 1], at, reach, rests, visitor);
                        if (o != outcome::done) return o == outcome::rested;
                    }
                }
            }
        }
        return false;
    }

private:
    struct cell_range {
        vec3<std::int32_t> first, last;
    };

    /// Cells of a level in which a shape lies that can touch a query over these base cells: the query's own and, since a
    /// shape is kept at its lower corner and spans at most one cell more than that, the next lower ones.
    ABUT_HD static cell_range range(int level, const vec3<std::int32_t>& lower, const vec3<std::int32_t>& upper) {
        const auto down = [&](std::int32_t c) { return greatest((c >> level) - 1, 0); };
        return {{down(lower.x), down(lower.y), down(lower.z)}, {upper.x >> level, upper.y >> level, upper.z >> level}};
    }

    /// In double: the number of cells may be larger than any integer.
    ABUT_HD double cells_under(const vec3<std::int32_t>& lower, const vec3<std::int32_t>& upper) const {
        double sum = 0;
        for (int level = 0; level < frame::levels; ++level) {
            if ((grid.frame->levels_in_use >> level & 1) == 0) continue;
            const auto [first, last] = range(level, lower, upper);
            sum += (last.x - first.x + 1.0) * (last.y - first.y + 1.0) * (last.z - first.z + 1.0);
        }
        return sum;
    }

    enum class outcome { done, rested, stopped };

    /// Of the items from `begin` on, those that the walk has not seen.
    template <class Reach, class Rests, class Visitor>
    ABUT_HD outcome in_items(std::size_t begin, std::size_t end, cursor& at, Reach& reach, const Rests& rests,
                             Visitor& visitor) const {
        for (std::size_t i = begin + at.item; i < end; ++i) {
            const grid_item<scalar_type> item = grid.items[i];
            if (!reach(item.box)) continue;
            if (visitor(item.id) == visit::stop) return outcome::stopped;
            if (rests()) {
                at.item = i + 1 - begin;
                return outcome::rested;
            }
        }
        return outcome::done;
    }
};

}  // namespace abut::detail
