// SPDX-License-Identifier: MIT
// expect: abut: points, segments, triangles, spheres, capsules, boxes, oriented boxes and hulls can turn; cylinders, cones, planes and rays cannot
#include <abut/collide/turning.hpp>

int main() {
    const abut::serial on;
    const auto index = abut::make_bvh(on, abut::cylinders<float>{{{{0, 0, 0}, {0, 0, 1}}, 1}});
    const abut::rigid<float> here;
    return abut::first_meeting(on, abut::moving(abut::posed(index, here), abut::posed(index, here)), index, {.tolerance = 0.1}) ? 1 : 0;
}
