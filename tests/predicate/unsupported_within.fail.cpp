// SPDX-License-Identifier: MIT
// expect: abut::within does not support this pair of shapes .*rays go with what they
#include <abut/predicate/within.hpp>

bool near(const abut::ray<float>& s, const abut::segment<float>& t) { return abut::within(s, t, 1); }
