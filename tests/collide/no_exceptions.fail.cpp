// SPDX-License-Identifier: MIT
// options: -fno-exceptions
// expect: abut reports errors by exceptions: compile without -fno-exceptions
// errors: 2
#include <abut/abut.hpp>

int main() { return static_cast<int>(abut::mesh<float>().size()); }
