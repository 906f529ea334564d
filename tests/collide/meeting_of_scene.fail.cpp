// SPDX-License-Identifier: MIT
// expect: abut: first_meeting is asked of two bodies; of a scene of bodies ask first_meetings
#include <vector>

#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const auto ball = abut::make_bvh(on, abut::spheres<float>{{{0, 0, 0}, 1}});
    const abut::rigid<float> here;
    const auto scene = abut::make_bodies(on, std::vector{abut::posed(ball, here)});
    return abut::first_meeting(on, scene, ball, {.tolerance = 0.1}) ? 1 : 0;
}
