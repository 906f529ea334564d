// SPDX-License-Identifier: MIT
#pragma once

// The splitter of bvh_builder::mean_split: shapes are divided along the axis in which their middles vary most, at the mean
// of the middles (Bäckman, "Collision Detection of Triangle Meshes using GPU", 2011, section 5.3.2).

#include <cstddef>

#include <abut/arithmetic/magnitude.hpp>
#include <abut/index/top_down.hpp>
#include <abut/shape/box_measure.hpp>

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
        const vec3<double> middle = 0.5 * widened(part.keys.lower) + 0.5 * widened(part.keys.upper);
        const double unit = surface_unit(longest(half_sides<double>(part.keys)));
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
};

}  // namespace abut::detail
