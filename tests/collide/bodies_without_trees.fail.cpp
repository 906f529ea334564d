// SPDX-License-Identifier: MIT
// expect: abut: a list of pairs or of bodies holds indices made by make_bvh
#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    const auto grid = abut::make_grid(on, abut::triangle_soup<float>());
    const std::vector bodies{abut::posed(grid, {})};
    return abut::any(on, bodies);
}
