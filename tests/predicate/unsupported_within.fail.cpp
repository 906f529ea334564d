// SPDX-License-Identifier: MIT
// expect: abut::within does not support this pair of shapes .*cylinders and cones go with points, spheres and planes
#include <abut/predicate/within.hpp>

bool near(const abut::cylinder<float>& s, const abut::triangle<float>& t) { return abut::within(s, t, 1); }
