// SPDX-License-Identifier: MIT
// expect: `within` takes sets of .*cylinders and cones with points, spheres and planes
#include <abut/abut.hpp>

std::uint64_t near(const abut::cones<float>& a, const abut::boxes<float>& b) {
    return abut::count_within(abut::serial{}, a, b, 1);
}
