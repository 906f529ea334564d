// SPDX-License-Identifier: MIT
// expect: abut: bodies of several kinds are asked by one policy; ask several devices or ranks about each two kinds
#include "host_team.hpp"

int main() {
    const abut::serial on;
    const std::vector balls{abut::posed(abut::make_bvh(on, abut::spheres<float>()), {})};
    const std::vector boxes{abut::posed(abut::make_bvh(on, abut::boxes<float>()), {})};
    abut::any(abut::test::host_team<abut::serial>(2), abut::make_bodies(on, balls, boxes));
}
