// SPDX-License-Identifier: MIT
// expect: abut: a hull alone lies in host memory and the policy works elsewhere; make a set, abut::hulls
// errors: 1
#include <abut/cuda.hpp>

auto pass(const abut::mesh<float>& mesh, const abut::hull<float>& points) {
    return abut::pairs(abut::cuda{}, mesh, points).size();
}
