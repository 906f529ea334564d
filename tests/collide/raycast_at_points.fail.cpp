// SPDX-License-Identifier: MIT
// expect: abut: raycast looks for triangles, spheres, boxes, capsules, cylinders, cones or hulls
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::raycast(abut::serial{}, abut::points<float>(), abut::rays<float>())) (void)hit.t;
}
