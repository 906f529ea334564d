// SPDX-License-Identifier: MIT
// expect: abut: raycast looks for triangles or hulls: a mesh, a triangle_soup, hulls, or a tree of one
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::raycast(abut::serial{}, abut::spheres<float>(), abut::rays<float>())) (void)hit.t;
}
