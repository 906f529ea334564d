// SPDX-License-Identifier: MIT
// expect: abut: expected an array whose elements are the shape's numbers and nothing else, in its scalar type
#include <array>
#include <vector>

#include <abut/abut.hpp>

int main() {
    const std::vector<std::array<double, 3>> vertices;
    const std::vector<std::array<int, 3>> faces;
    return static_cast<int>(abut::mesh<float>(vertices, faces).size());
}
