// SPDX-License-Identifier: MIT
#pragma once

namespace abut::test {

/// What an executable needs and does not find, or null. needs_nothing.cpp and needs_device.cpp define it, one of which is
/// linked to each executable.
const char* what_is_missing();

}  // namespace abut::test
