// SPDX-License-Identifier: MIT
// expect: abut: the index lies in other memory than the policy works in; make it with the same policy
// errors: 1
#include <abut/cuda.hpp>

auto pass(const abut::mesh<float>& mesh, const abut::spheres<float>& balls) {
    return abut::count(abut::cuda{}, abut::make_bvh(abut::serial{}, mesh), balls);
}
