// SPDX-License-Identifier: MIT
// expect: abut: a call that does not wait takes sets that lie on the device: copy_to\(policy, set\) first
// errors: 1
#include <abut/cuda.hpp>

void pass(const abut::mesh<float>& mesh, const abut::spheres<float, abut::device_space>& balls,
          abut::async_value<bool>& into) {
    abut::any_async(abut::cuda{}, mesh, balls, into);
}
