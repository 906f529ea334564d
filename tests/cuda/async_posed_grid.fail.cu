// SPDX-License-Identifier: MIT
// expect: abut: a grid under a pose is for calls that wait: make a tree of the set, or place it
// errors: 1
#include <abut/cuda.hpp>

void pass(const abut::spheres<float, abut::device_space>& balls, abut::async_value<bool>& into) {
    const abut::cuda on;
    abut::any_async(on, abut::posed(abut::make_grid(on, balls), {}), balls, into);
}
