// SPDX-License-Identifier: MIT
// expect: abut::intersects does not support this pair of shapes
#include <abut/predicate/intersects.hpp>

bool touch(const abut::ray<float>& r, const abut::segment<float>& s) { return abut::intersects(r, s); }
