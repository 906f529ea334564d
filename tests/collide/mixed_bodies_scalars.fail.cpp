// SPDX-License-Identifier: MIT
// expect: abut: the bodies of a scene have one scalar type, float or double
#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const std::vector balls{abut::posed(abut::make_bvh(on, abut::spheres<float>()), {})};
    const std::vector boxes{abut::posed(abut::make_bvh(on, abut::boxes<double>()), {})};
    return static_cast<int>(abut::make_bodies(on, balls, boxes).size());
}
