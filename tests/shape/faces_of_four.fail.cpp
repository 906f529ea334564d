// SPDX-License-Identifier: MIT
// expect: abut: expected an array of vertex indices: of abut::face, std::array<int, 3> and the like
#include <array>
#include <vector>

#include <abut/abut.hpp>

int main() {
    const std::vector<std::array<float, 3>> vertices;
    const std::vector<std::array<int, 4>> quads;
    return static_cast<int>(abut::mesh<float>(vertices, quads).size());
}
