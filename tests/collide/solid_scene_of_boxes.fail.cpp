// SPDX-License-Identifier: MIT
// expect: abut: solids are closed meshes: trees of meshes
#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const std::vector boxes{abut::posed(abut::make_bvh(on, abut::boxes<float>()), {})};
    const std::vector meshes{abut::posed(abut::make_bvh(on, abut::mesh<float>()), {})};
    return static_cast<int>(abut::overlaps(on, abut::make_bodies(on, meshes, boxes)).size());
}
