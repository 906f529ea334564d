// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <cstdio>

int main() {
    const abut::mesh<float> tetrahedron{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const abut::spheres<float> balls{{{{1, 1, -2}, 2}, {{9, 9, 9}, 1}, {{4, 0, 0}, 0}}};

    const abut::openmp on;  // or abut::serial; or, with <abut/cuda.hpp> in a .cu file, abut::cuda
    const auto index = abut::make_bvh(on, tetrahedron);
    for (const auto [face, ball] : abut::to_host(abut::pairs(on, index, balls))) {
        std::printf("face %u touches ball %u\n", face, ball);
    }
    std::printf("%s\n", abut::any<abut::fast>(on, index, balls) ? "fast agrees" : "fast does not");
}
