// SPDX-License-Identifier: MIT
// expect: abut: the tree and the set have different scalar types
#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const auto tree = abut::make_bvh(on, abut::mesh<float>());
    const auto moved = abut::refit(on, tree, abut::mesh<double>());
    return abut::any(on, moved, abut::mesh<float>()) ? 1 : 0;
}
