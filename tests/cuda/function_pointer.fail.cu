// SPDX-License-Identifier: MIT
// expect: a pointer to a function of the host cannot be called on a device: pass a functor marked ABUT_HD
#include <cstdint>

#include <abut/execution/cuda.hpp>

bool filter(std::uint32_t a, std::uint32_t b) { return a < b; }
void pass() { require_callable(abut::cuda{}, &filter, std::uint32_t{}, std::uint32_t{}); }
