// SPDX-License-Identifier: MIT
// expect: abut: a host policy cannot read a set in device memory
#include <abut/abut.hpp>

auto ask(const abut::mesh<float, abut::device_space>& m) { return abut::pairs(abut::serial{}, m, m).size(); }
