// SPDX-License-Identifier: MIT
// expect: `within` takes sets of .*cylinders and cones, and planes with any of these; not rays
#include <abut/abut.hpp>

std::uint64_t near(const abut::cones<float>& a, const abut::rays<float>& b) {
    return abut::count_within(abut::serial{}, a, b, 1);
}
