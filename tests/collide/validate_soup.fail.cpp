// SPDX-License-Identifier: MIT
// expect: abut::validate: expected a mesh or a mesh_view
#include <abut/abut.hpp>

int main() { return static_cast<int>(abut::validate(abut::serial{}, abut::triangle_soup<float>()).edges); }
