// SPDX-License-Identifier: MIT

#include <abut/cuda.hpp>

#include <cstdio>

#include "also.hpp"

int main() {
    const auto one = hits_by_cpp(), other = hits_by_cu();
    std::size_t met = 0;
    for (std::size_t i = 0; i < one.size() / 2; ++i) {
        met += one[i] != abut::no_id;
        if (one[i] == one[i + one.size() / 2] && other == one) continue;
        std::printf("rays through a wide tree differ: %zu\n", i);
        return 1;
    }
    if (met < 50) return 2;
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
