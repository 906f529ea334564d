// SPDX-License-Identifier: MIT
// expect: abut: points, segments, triangles, spheres, capsules, cylinders, cones, boxes, oriented boxes and hulls can be swept
#include <abut/abut.hpp>

int main() {
    using planes = abut::shapes<abut::plane<float>>;
    for (const auto& hit : abut::sweep(abut::serial{}, planes(), planes(), abut::points<float>())) (void)hit.t;
}
