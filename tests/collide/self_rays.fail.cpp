// SPDX-License-Identifier: MIT
// expect: abut: self queries of sets of these shapes are not supported
#include <abut/abut.hpp>

int main() { return static_cast<int>(abut::self_pairs(abut::serial{}, abut::rays<float>()).size()); }
