// SPDX-License-Identifier: MIT
#pragma once

// The splitter of bvh_builder::sah: the surface area heuristic over bins (Wald, "On fast Construction of SAH-based Bounding
// Volume Hierarchies", 2007). Shapes are sorted into bins by their middles, along each axis, and divided between the two
// bins where the surface of each side's box times its number of shapes adds up to least.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/index/top_down.hpp>
#include <abut/shape/box_measure.hpp>

namespace abut::detail {

/// Which bin a key falls into.
template <scalar T>
struct bin_grid {
    vec3<T> lower, per_unit;
    T last;

    bin_grid(const aabb<T>& keys, int bins) : lower(keys.lower), last(static_cast<T>(bins - 1)) {
        // A little less than the number of bins, so that the upper end falls into the last one. An axis without extent has
        // one bin in use, as has one that is so short that keys may be off by a bin: by 2 m, m being the smallest normal
        // number, where they are computed again in another way and something is flushed to zero.
        const T n = static_cast<T>(bins) * (1 - 8 * unit_roundoff<T>);
        const auto over = [n](T extent) { return extent > 8 * n * smallest_normal<T> ? n / extent : 0; };
        const vec3<T> extent = keys.upper - keys.lower;
        per_unit = {over(extent.x), over(extent.y), over(extent.z)};
    }
    /// NaN falls into the last bin.
    [[nodiscard]] int operator()(T key, int axis) const {
        return static_cast<int>(least((key - coordinate(lower, axis)) * coordinate(per_unit, axis), last));
    }
};

/// Goes left if a key falls into one of the first bins.
template <scalar T>
struct below_bin {
    bin_grid<T> grid;
    int axis, bin;
    bool operator()(const shape_ref<T>& ref) const { return grid(ref.key(axis), axis) < bin; }
};

template <scalar T>
struct sah_splitter {
    static constexpr int most_bins = 16;

    below_bin<T> operator()(const shape_ref<T>* refs, const subtree<T>& part) const {
        // Few shapes need few bins, and most subtrees have few.
        const int bins = static_cast<int>(std::min<std::size_t>(most_bins, 4 + part.count / 16));
        const bin_grid<T> grid(part.keys, bins);
        bin all[3][most_bins];
        for (auto& axis : all) std::fill(axis, axis + bins, bin{empty_box<T>(), 0});
        for (std::size_t i = 0; i < part.count; ++i) {
            const shape_ref<T> ref = refs[i];
            const vec3<T> key = ref.key();
            for (int axis = 0; axis < 3; ++axis) {
                bin& b = all[axis][grid(coordinate(key, axis), axis)];
                b.box = merge(b.box, ref.box);
                ++b.count;
            }
        }
        const scaled_area area(part.box);
        below_bin<T> best{grid, 0, 0};  // sends nothing to the left: where no cost is a number, this stays
        T least = infinity<T>;
        for (int axis = 0; axis < 3; ++axis) {
            if (coordinate(grid.per_unit, axis) > 0) sweep(all[axis], bins, axis, area, best, least);
        }
        return best;
    }

private:
    struct bin {
        aabb<T> box;
        std::uint32_t count;
    };

    /// Half the surface of a box, in units that neither overflow nor all underflow, and next to nothing for the length of
    /// its sides: it counts where shapes lie in a line and no box has a surface.
    struct scaled_area {
        T unit;
        explicit scaled_area(const aabb<T>& box) { unit = surface_unit(longest(half_sides<T>(box))); }
        T operator()(const aabb<T>& box) const {
            const vec3<T> sides = unit * half_sides<T>(box);
            return half_surface(sides) + T(0x1p-20) * (sides.x + sides.y + sides.z);
        }
    };

    static T cost_of(const bin& side, const scaled_area& area) {
        return side.count > 0 ? static_cast<T>(side.count) * area(side.box) : infinity<T>;
    }

    static void sweep(const bin* of, int bins, int axis, const scaled_area& area, below_bin<T>& best, T& least) {
        T right_cost[most_bins];
        bin side{empty_box<T>(), 0};
        for (int i = bins - 1; i > 0; --i) {
            side = {merge(side.box, of[i].box), side.count + of[i].count};
            right_cost[i] = cost_of(side, area);
        }
        side = {empty_box<T>(), 0};
        for (int i = 1; i < bins; ++i) {
            side = {merge(side.box, of[i - 1].box), side.count + of[i - 1].count};
            const T cost = cost_of(side, area) + right_cost[i];
            if (cost < least) {
                least = cost;
                best.axis = axis;
                best.bin = i;
            }
        }
    }
};

}  // namespace abut::detail
