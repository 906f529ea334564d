// SPDX-License-Identifier: MIT

#include <abut/cuda.hpp>

#include <cstdio>

int main() {
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::printf("abut skips: no CUDA device\n");
        return 0;
    }
    const abut::mesh<float> mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}}, {{0, 1, 2}, {3, 4, 5}});
    const abut::spheres<float> spheres({{{5, 5, 5}, 1}, {{0, 0, 1}, 1}});
    for (const auto& hit : abut::to_host(abut::pairs(abut::cuda{}, mesh, spheres))) {
        std::printf("touching: %u %u\n", unsigned(hit.a), unsigned(hit.b));
    }
}
