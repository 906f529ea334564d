// SPDX-License-Identifier: MIT
#pragma once

// The splitter of bvh_builder::mean_split: shapes are divided along the axis in which their middles vary most, at the mean
// of the middles (Bäckman, "Collision Detection of Triangle Meshes using GPU", 2011, section 5.3.2).

#include <cstddef>

#include <abut/index/top_down.hpp>

namespace abut::detail {

/// Goes left if a key lies below a position.
template <scalar T>
struct below_position {
    int axis;
    double position;
    bool operator()(const shape_ref<T>& ref) const { return static_cast<double>(ref.key(axis)) < position; }
};

template <scalar T>
struct mean_splitter {
    below_position<T> operator()(const shape_ref<T>* refs, const subtree<T>& part) const {
        // Keys are measured from the middle of their box, in units of its longest half side: no square overflows, and what
        // underflows is small beside the largest.
        const vec3<double> lower = widened(part.keys.lower), upper = widened(part.keys.upper);
        const vec3<double> middle = 0.5 * lower + 0.5 * upper, half = 0.5 * upper - 0.5 * lower;
        const double longest = greater(greater(half.x, half.y), half.z);
        const double unit = lesser(1 / longest, largest_finite<double>);
        vec3<double> sum{0, 0, 0}, squares{0, 0, 0};
        for (std::size_t i = 0; i < part.count; ++i) {
            const vec3<double> off = unit * (widened(refs[i].key()) - middle);
            sum = sum + off;
            squares = squares + vec3<double>{off.x * off.x, off.y * off.y, off.z * off.z};
        }
        const double n = static_cast<double>(part.count);
        const vec3<double> mean = (1 / n) * sum;
        const vec3<double> variance{squares.x / n - mean.x * mean.x, squares.y / n - mean.y * mean.y,
                                    squares.z / n - mean.z * mean.z};
        const int axis = variance.x >= variance.y && variance.x >= variance.z ? 0 : variance.y >= variance.z ? 1 : 2;
        return {axis, coordinate(middle, axis) + coordinate(mean, axis) / unit};
    }

private:
    static vec3<double> widened(const vec3<T>& v) {
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }
};

}  // namespace abut::detail
