// SPDX-License-Identifier: MIT
// expect: abut: between takes scenes of one kind each; of several kinds make one scene, whose filter says which bodies meet
#include <abut/abut.hpp>

using balls = decltype(abut::make_bvh(abut::serial{}, abut::spheres<float>{}));
using faces = decltype(abut::make_bvh(abut::serial{}, abut::mesh<float>{}));

void ask(const abut::mixed_bodies<balls, faces>& scene, const abut::bodies<balls>& other) { abut::between(scene, other); }
