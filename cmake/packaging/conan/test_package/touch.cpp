// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>

#include <cstdio>

int main() {
    const abut::mesh<float> mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}}, {{0, 1, 2}, {3, 4, 5}});
    const abut::spheres<float> spheres({{{5, 5, 5}, 1}, {{0, 0, 1}, 1}});
    const auto hits = abut::to_host(abut::pairs(abut::serial{}, mesh, spheres));
    for (const auto& hit : hits) std::printf("touching: %u %u\n", hit.a, hit.b);
}
