// SPDX-License-Identifier: MIT
// expect: abut: points, segments, triangles, spheres, capsules, boxes, oriented boxes and hulls can be swept
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::sweep(abut::serial{}, abut::mesh<float>(), abut::cylinders<float>(), abut::points<float>())) (void)hit.t;
}
