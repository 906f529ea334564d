// SPDX-License-Identifier: MIT
//
// A second file of the program: whatever the headers define has to be inline.

#include <abut/cuda.hpp>

static_assert(abut::execution_policy<abut::cuda>);
