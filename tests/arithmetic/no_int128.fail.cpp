// SPDX-License-Identifier: MIT
// options: -m32 -msse2 -mfpmath=sse
// expect: abut needs integers of 128 bits
// errors: 2
#include <abut/config.hpp>
