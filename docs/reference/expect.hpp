// SPDX-License-Identifier: MIT
#pragma once

// What the examples of the reference check of their own results.

#include <cstdio>
#include <cstdlib>
#include <source_location>

/// Ends the program where an example does not do what it says.
inline void expect(bool holds, const std::source_location& at = std::source_location::current()) {
    if (holds) return;
    std::fprintf(stderr, "%s:%u: not as expected\n", at.file_name(), static_cast<unsigned>(at.line()));
    std::exit(EXIT_FAILURE);
}
