// SPDX-License-Identifier: MIT
// options: -std=c++17
// expect: abut needs C\+\+20 or newer: compile with -std=c\+\+20
// errors: 2
#include <abut/abut.hpp>

int main() { return static_cast<int>(abut::mesh<float>().size()); }
