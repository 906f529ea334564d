// SPDX-License-Identifier: MIT
// expect: abut: breadth_first, from_front and static_partition need the host between their kernels
// errors: 1
#include <abut/cuda.hpp>

void pass(const abut::spheres<float, abut::device_space>& balls, abut::async_value<bool>& into) {
    using options = abut::query_options<abut::keep_all, abut::traversal::both_at_once, abut::schedule::static_partition>;
    abut::any_async(abut::cuda{}, balls, balls, into, options{});
}
