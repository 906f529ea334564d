// SPDX-License-Identifier: MIT
#pragma once

// Of two triangles that cross each other's planes, which corner is alone on its side, and in which order to take the others.

#include <abut/config.hpp>

namespace abut::detail {

/// A triangle's corners from the one that is alone on its side of a plane, in the order in which the other's lone corner is
/// above. A bit of `above` says that a corner is above the other's plane, one of `other_above` that one of the other's is
/// above this one's; one bit or two of each are set. Which corner it is nobody can predict: it is looked up in two-bit
/// tables, since a branch would cost more than all the arithmetic.
struct lone_corner {
    unsigned alone, next, last;

    ABUT_HD constexpr lone_corner(unsigned above, unsigned other_above)
        : alone(0b01'10'10'01'00'00u >> 2 * above & 3), next(0), last(0) {
        const unsigned at = 2 * alone + (0b0001'0110u >> other_above & 1) * 8;  // one bit: the lone corner is above
        next = 0b00'10'01'00'01'00'10u >> at & 3;
        last = 0b01'00'10'00'00'10'01u >> at & 3;
    }
};

}  // namespace abut::detail
