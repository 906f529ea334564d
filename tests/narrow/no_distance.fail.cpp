// SPDX-License-Identifier: MIT
// expect: abut: there is no distance of this pair of shapes
#include <abut/narrow/distance.hpp>

float gap(const abut::aabb<float>& a, const abut::aabb<float>& b) { return abut::distance(a, b).distance; }
