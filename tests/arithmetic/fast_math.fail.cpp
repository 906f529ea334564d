// SPDX-License-Identifier: MIT
// expect: abut: exact decisions need IEEE arithmetic
#define __FAST_MATH__ 1
#include <abut/arithmetic/error_free.hpp>
