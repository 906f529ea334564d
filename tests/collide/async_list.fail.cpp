// SPDX-License-Identifier: MIT
// expect: abut: lists need the host between their kernels: they are for calls that wait
#include <abut/abut.hpp>
#include <abut/collide/async.hpp>

#include <vector>

using tree = decltype(abut::make_bvh(abut::serial{}, abut::spheres<float>{}));

void ask(const abut::async<abut::serial, int>& stream, const std::vector<abut::moving_pair<tree>>& list) {
    abut::any_each(stream, list, {.tolerance = 0.1});
}
