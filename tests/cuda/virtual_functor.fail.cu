// SPDX-License-Identifier: MIT
// expect: virtual functions of an object that was made on the host cannot be called on a device
#include <cstdint>

#include <abut/config.hpp>
#include <abut/execution/cuda.hpp>

struct filter {
    ABUT_HD virtual bool operator()(std::uint32_t a, std::uint32_t b) const { return a < b; }
};
void pass() { require_callable(abut::cuda{}, filter{}, std::uint32_t{}, std::uint32_t{}); }
