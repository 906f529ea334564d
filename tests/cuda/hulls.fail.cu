// SPDX-License-Identifier: MIT
// expect: abut: convex hulls are for host policies; on devices their queries have been seen to fail
// errors: 1
#include <abut/cuda.hpp>

std::size_t pass(const abut::mesh<float>& mesh, const abut::hulls<float>& parts) {
    return abut::pairs(abut::cuda{}, mesh, parts).size();
}
