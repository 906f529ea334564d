// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <string>

namespace abut::test {

/// Whether the environment's ABUT_REQUIRE, words with spaces between, names `what`: then nothing may be skipped for want of
/// it.
inline bool is_required(const std::string& what) {
    const char* const list = std::getenv("ABUT_REQUIRE");
    return list != nullptr && (" " + std::string(list) + " ").find(" " + what + " ") != std::string::npos;
}

/// What an executable needs and does not find, or null. needs_nothing.cpp and needs_device.cpp define it, one of which is
/// linked to each executable.
const char* what_is_missing();

}  // namespace abut::test
