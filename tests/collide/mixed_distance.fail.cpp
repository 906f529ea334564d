// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type
#include <abut/abut.hpp>

bool apart(const abut::mesh<float>& a, const abut::mesh<double>& b) { return abut::distance(abut::serial{}, a, b).has_value(); }
