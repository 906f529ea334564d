// SPDX-License-Identifier: MIT
// expect: abut: such shapes cannot be posed, for want of place
#include <abut/abut.hpp>

int main() { return static_cast<int>(abut::posed(abut::shapes<abut::plane<float>>(), {}).size()); }
