// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type, float or double
#include <abut/cuda.hpp>

bool any_of(const abut::mesh<float>& mesh, const abut::spheres<double>& balls) {
    return abut::any(abut::cuda{}, mesh, balls);
}
