// SPDX-License-Identifier: MIT
// expect: abut: this view is over host memory and the policy works elsewhere; make a set of it first; or, where its arrays lie in device memory
// errors: 1
#include <abut/cuda.hpp>

auto pass(const abut::mesh<float>& mesh, const abut::sphere<float>* balls) {
    return abut::pairs(abut::cuda{}, mesh, abut::spheres_view<float>(balls, 1)).size();
}
