// SPDX-License-Identifier: MIT
// expect: abut: this schedule of a device is in another header: include <abut/experimental/cuda_work_stealing.hpp>

#include <abut/cuda.hpp>

int main() {
    const abut::cuda on;
    const auto tree = make_bvh(on, abut::triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    return any(on, tree, tree, abut::query_options<abut::keep_all, abut::traversal::both_at_once, abut::schedule::work_stealing>{});
}
