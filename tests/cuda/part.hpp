// SPDX-License-Identifier: MIT
#pragma once

// Programs that take ptxas many minutes can be compiled in parts, at the same time: with -DABUT_PART=0, 1 and so on each has a
// part of the checks. Without it a program has all of them.

namespace abut::test {

/// In a template: `if constexpr (is_in_part(k))`.
constexpr bool is_in_part([[maybe_unused]] int k) {
#ifdef ABUT_PART
    return k == ABUT_PART;
#else
    return true;
#endif
}

}  // namespace abut::test
