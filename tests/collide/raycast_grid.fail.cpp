// SPDX-License-Identifier: MIT
// expect: abut: raycast takes a tree, a set or one shape, and no grid
#include <abut/abut.hpp>

int main() {
    for (const auto& hit : abut::raycast(abut::serial{}, abut::make_grid(abut::serial{}, abut::mesh<float>()), abut::rays<float>())) (void)hit.t;
}
