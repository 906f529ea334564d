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

    /// Calls visitor(shape id) -> visit for every shape whose box the query reaches, until it says stop.
    template <class Reach, class Visitor>
    ABUT_HD void for_each(Reach& reach, Visitor&& visitor) const {
        const aabb<scalar_type> box = reach.bounds();
        const vec3<std::int32_t> lower = grid.frame->cell(box.lower), upper = grid.frame->cell(box.upper);
        if (cells_under(lower, upper) > static_cast<double>(grid.size())) {
            in_items(0, grid.size(), reach, visitor);
            return;
        }
        for (int level = 0; level < frame::levels; ++level) {
            if ((grid.frame->levels_in_use >> level & 1) == 0) continue;
            const auto [first, last] = range(level, lower, upper);
            for (std::int32_t x = first.x; x <= last.x; ++x) {
                for (std::int32_t y = first.y; y <= last.y; ++y) {
                    for (std::int32_t z = first.z; z <= last.z; ++z) {
                        const std::uint64_t slot = grid.find(frame::key(level, {x, y, z}));
                        if (slot == grid.slots) continue;
                        if (in_items(grid.starts[slot], grid.starts[slot + 1], reach, visitor) == visit::stop) return;
                    }
                }
            }
        }
    }

private:
    struct cell_range {
        vec3<std::int32_t> first, last;
    };

    /// Cells of a level in which a shape lies that can touch a query over these base cells: the query's own and, since a
    /// shape is kept at its lower corner and spans at most one cell more than that, the next lower ones.
    ABUT_HD static cell_range range(int level, const vec3<std::int32_t>& lower, const vec3<std::int32_t>& upper) {
        const auto down = [&](std::int32_t c) { return greater((c >> level) - 1, 0); };
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

    template <class Reach, class Visitor>
    ABUT_HD visit in_items(std::size_t begin, std::size_t end, Reach& reach, Visitor& visitor) const {
        for (std::size_t i = begin; i < end; ++i) {
            const grid_item<scalar_type> item = grid.items[i];
            if (reach(item.box) && visitor(item.id) == visit::stop) return visit::stop;
        }
        return visit::proceed;
    }
};

}  // namespace abut::detail
