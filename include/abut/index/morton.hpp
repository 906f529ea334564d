// SPDX-License-Identifier: MIT
#pragma once

// Morton codes: the interleaved bits of a point's position in a box. They only order the leaves of a tree; no decision
// depends on them, so floating point is good enough. It is not contracted: halves of denormal numbers are rounded, and trees
// are the same on every policy.

#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// Puts two zero bits before each of the lowest 10 bits.
ABUT_HD constexpr std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// Puts two zero bits before each of the lowest 21 bits.
ABUT_HD constexpr std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | (x << 32)) & 0x001f00000000ffffu;
    x = (x | (x << 16)) & 0x001f0000ff0000ffu;
    x = (x | (x << 8)) & 0x100f00f00f00f00fu;
    x = (x | (x << 4)) & 0x10c30c30c30c30c3u;
    return (x | (x << 2)) & 0x1249249249249249u;
}

template <class Code>
inline constexpr int morton_axis_bits = sizeof(Code) == 4 ? 10 : 21;
template <class Code>
inline constexpr int morton_bits = 3 * morton_axis_bits<Code>;

template <class T>
ABUT_HD constexpr T sum_of_halves(T a, T b) {
    return plain_sum(plain_product(a, T(0.5)), plain_product(b, T(0.5)));
}

/// Cell of x among 2^bits cells between lower and upper, clamped. Halves are taken first: upper - lower may overflow.
template <class Code, class T>
ABUT_HD constexpr Code morton_cell(T x, T lower, T upper) {
    constexpr T cells = static_cast<T>(Code{1} << morton_axis_bits<Code>);
    const T extent = sum_of_halves(upper, -lower);
    const T cell = extent > 0 ? sum_of_halves(x, -lower) / extent * cells : T{0};
    if (!(cell > 0)) return 0;
    return cell < cells ? static_cast<Code>(cell) : static_cast<Code>(cells) - 1;
}

/// Code of the middle of `box` within `scene`. Code: std::uint32_t (10 bits an axis) or std::uint64_t (21).
template <class Code, class T>
ABUT_HD constexpr Code morton_code(const aabb<T>& box, const aabb<T>& scene) {
    const Code x = morton_cell<Code>(sum_of_halves(box.lower.x, box.upper.x), scene.lower.x, scene.upper.x);
    const Code y = morton_cell<Code>(sum_of_halves(box.lower.y, box.upper.y), scene.lower.y, scene.upper.y);
    const Code z = morton_cell<Code>(sum_of_halves(box.lower.z, box.upper.z), scene.lower.z, scene.upper.z);
    return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}

}  // namespace abut::detail
