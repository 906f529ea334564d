// SPDX-License-Identifier: MIT
// expect: abut: calls that do not wait look for impacts of indices alone: make_impact_index, or an async_index
// errors: 1
#include <abut/cuda.hpp>

void pass(const abut::mesh<float, abut::device_space>& mesh, abut::async_value<double>& into) {
    const abut::cuda on;
    abut::safe_self_step(abut::async(on, into), abut::moving(mesh, mesh));
}
