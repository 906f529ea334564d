// SPDX-License-Identifier: MIT
// expect: abut: both sides of a query need the same scalar type, float or double
#include <abut/abut.hpp>

int main() {
    const abut::openmp on;
    const auto tree = abut::make_bvh(on, abut::mesh<float>());
    for (const auto& c : abut::contacts(on, tree, abut::spheres<double>())) (void)c.depth;
}
