// SPDX-License-Identifier: MIT
// expect: abut: motions are asked of one policy: several devices, ranks and async take none
#include "host_team.hpp"

int main() {
    const abut::serial on;
    const auto ball = abut::make_bvh(on, abut::spheres<float>{{{0, 0, 0}, 1}});
    const std::vector balls{abut::posed(ball, abut::rigid<float>())};
    const auto scene = abut::make_bodies(on, balls);
    abut::first_meetings(abut::test::host_team<abut::serial>(2), abut::moving(scene, scene), {.tolerance = 0.1});
}
