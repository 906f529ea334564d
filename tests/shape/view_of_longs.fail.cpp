// SPDX-License-Identifier: MIT
// expect: abut: a view reads vertex indices of 32 bits as they are; make a set of others, which copies them
#include <array>
#include <cstdint>
#include <vector>

#include <abut/abut.hpp>

int main() {
    const std::vector<abut::vec3<float>> vertices;
    const std::vector<std::array<std::int64_t, 3>> faces;
    return static_cast<int>(abut::mesh_view<float>(vertices.data(), 0, faces.data(), 0).size());
}
