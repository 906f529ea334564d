// SPDX-License-Identifier: MIT
// expect: abut: scenes in motion lie on one machine, and need the host: ranks and async take none
#include <abut/abut.hpp>
#include <abut/collide/async.hpp>

using tree = decltype(abut::make_bvh(abut::serial{}, abut::spheres<float>{}));

void ask(const abut::async<abut::serial, int>& stream, const abut::bodies_motion<tree>& frame) {
    abut::first_meetings(stream, frame, abut::scene_meeting_options<>{.tolerance = 0.1});
}
