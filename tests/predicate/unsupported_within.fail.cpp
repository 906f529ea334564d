// SPDX-License-Identifier: MIT
// expect: abut::within does not support this pair of shapes .*not rays, nor two planes
#include <abut/predicate/within.hpp>

bool near(const abut::ray<float>& s, const abut::triangle<float>& t) { return abut::within(s, t, 1); }
