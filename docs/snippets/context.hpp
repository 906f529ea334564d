// SPDX-License-Identifier: MIT
#pragma once

// What the pages' fragments of code see without saying so: each is the body of a member function of a struct that derives
// from `context` (tests/project/pages.py).

#if defined(__CUDACC__)
#include <abut/cuda.hpp>
#else
#include <abut/abut.hpp>
#endif

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <vector>

// A page names what it shows, used or not, and a fragment may have its own `on`.
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wshadow"

namespace manual {

/// Whether the policy of this unit can run here.
inline bool can_run() {
#if defined(__CUDACC__)
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::printf("abut skips: no CUDA device\n");
        return false;
    }
#endif
    return true;
}

/// Tells which block prints what follows.
inline void mark(int block) { std::printf("\x1e%d\n", block); }

/// The surface of a box whose sides are 2 half long.
inline abut::mesh<float> box(abut::vec3<float> center, float half) {
    std::vector<abut::vec3<float>> vertices;
    for (unsigned i = 0; i < 8; ++i) {
        const auto side = [&](unsigned bit) { return (i >> bit & 1) != 0 ? half : -half; };
        vertices.push_back({center.x + side(0), center.y + side(1), center.z + side(2)});
    }
    return {vertices,
            {{0, 2, 1},
             {1, 2, 3},
             {4, 5, 6},
             {5, 7, 6},
             {0, 1, 4},
             {1, 5, 4},
             {2, 6, 3},
             {3, 6, 7},
             {0, 4, 2},
             {2, 4, 6},
             {1, 3, 5},
             {3, 7, 5}}};
}

/// A level sheet of 2 n n triangles over [-1, 1] x [-1, 1].
inline std::vector<abut::vec3<float>> sheet_vertices(unsigned n, float height) {
    std::vector<abut::vec3<float>> vertices;
    for (unsigned i = 0; i <= n; ++i) {
        for (unsigned j = 0; j <= n; ++j) {
            const auto at = [n](unsigned k) { return 2.0f * static_cast<float>(k) / static_cast<float>(n) - 1.0f; };
            vertices.push_back({at(i), at(j), height});
        }
    }
    return vertices;
}
inline std::vector<abut::face> sheet_faces(unsigned n) {
    std::vector<abut::face> faces;
    for (unsigned i = 0; i < n; ++i) {
        for (unsigned j = 0; j < n; ++j) {
            const unsigned first = i * (n + 1) + j, next = first + n + 1;
            faces.push_back({first, next, first + 1});
            faces.push_back({first + 1, next, next + 1});
        }
    }
    return faces;
}

/// Something is done with what was found.
template <class... Values>
void use(const Values&...) {}

struct context {
#if defined(__CUDACC__)
    abut::cuda on;
#else
    abut::openmp on;
#endif
    // Two meshes, balls, and where one mesh is.
    abut::mesh<float> mesh = box({0, 0, 0}, 1);
    abut::mesh<float> tool = box({0, 0, 0}, 0.5f);
    abut::spheres<float> balls{{{{0, 0, 2}, 1}, {{5, 5, 5}, 1}, {{1, 1, 1}, 0}}};
    abut::rigid<float> pose{.translation = {1, 0, 0}};

    // A sheet that falls by 1 in each step.
    std::vector<abut::face> faces = sheet_faces(4);
    std::vector<abut::vec3<float>> positions_t0 = sheet_vertices(4, 1.5f), positions_t1 = sheet_vertices(4, 0.5f);
    abut::mesh<float> cloth{positions_t0, faces};
};

}  // namespace manual

using manual::use;
