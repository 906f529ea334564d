// SPDX-License-Identifier: MIT

#include <abut/cuda_devices.hpp>

#include "expect.hpp"
#include "run_on_device.hpp"

namespace {

void run() {
    const abut::spheres<float> balls{{{{1, 1, 2}, 2}, {{4, 4, 3}, 3}, {{4, 4, 9}, 1}}};
    const abut::triangle_soup<float> ground{{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}}};
    //! [devices]
    const abut::cuda_devices all;                       // of this machine
    const auto tree = abut::make_bvh(all, balls);       // the same on each
    const auto found = abut::pairs(all, tree, ground);  // in memory of the first
    expect(abut::to_host(found).size() == 2);

    const auto parts = abut::make_bvh(all, abut::divide(all, balls));  // a part on each
    expect(abut::count(all, parts, ground) == 2);
    //! [devices]
}

}  // namespace

int main() { return run_on_device(run); }
