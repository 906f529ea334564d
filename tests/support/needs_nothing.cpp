// SPDX-License-Identifier: MIT
#include "support/needs.hpp"

const char* abut::test::what_is_missing() { return nullptr; }
