// SPDX-License-Identifier: MIT
// expect: abut: sweep takes a tree, a set or one shape, and no grid
#include <abut/abut.hpp>

int main() {
    for (const auto& hit :
         abut::sweep(abut::serial{}, abut::make_grid(abut::serial{}, abut::mesh<float>()), abut::spheres<float>(), abut::points<float>()))
        (void)hit.t;
}
