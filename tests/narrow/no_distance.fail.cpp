// SPDX-License-Identifier: MIT
// expect: abut: there is no distance of this pair of shapes
#include <abut/narrow/distance.hpp>

float gap(const abut::plane<float>& a, const abut::plane<float>& b) { return abut::distance(a, b).distance; }
