// SPDX-License-Identifier: MIT
// expect: abut::intersects does not support this pair of shapes
#include <abut/predicate/intersects.hpp>

bool touch(const abut::cylinder<float>& s, const abut::cone<float>& t) { return abut::intersects(s, t); }
