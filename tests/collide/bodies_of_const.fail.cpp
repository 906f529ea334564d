// SPDX-License-Identifier: MIT
// expect: abut: posed_object of the type of a const index: leave out const where the index is made
// errors: 2
#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const auto tree = abut::make_bvh(on, abut::triangle_soup<float>());
    const std::vector<abut::posed_object<decltype(tree)>> bodies{{tree, {}}};
    return abut::any(on, bodies);
}
