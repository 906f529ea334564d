// SPDX-License-Identifier: MIT
#pragma once

// What the examples of the reference check of their own results.

#include <cstdio>
#include <cstdlib>

/// Ends the program where an example does not do what it says. (clang 14 cannot take std::source_location from libstdc++.)
inline void expect(bool holds, int line = __builtin_LINE()) {
    if (holds) return;
    std::fprintf(stderr, "line %d: not as expected\n", line);
    std::exit(EXIT_FAILURE);
}
