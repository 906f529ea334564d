// SPDX-License-Identifier: MIT
#pragma once

// The numbers of bench_peers and bench_arm_cuda.

#include <cmath>
#include <cstdint>

#include "peer.hpp"

namespace peers {

struct draws {
    std::uint64_t state = 12;
    double operator()(double low, double high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
    }
    vec3 way() {
        for (;;) {
            const vec3 p{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
            const double n = dot(p, p);
            if (n > 0.01 && n <= 1) return (1 / std::sqrt(n)) * p;
        }
    }
    abut::rigid<double> turned(const vec3& to) {
        const vec3 u = way(), w = cross(u, way()), v = (1 / std::sqrt(dot(w, w))) * w, t = cross(u, v);
        return {{u.x, v.x, t.x, u.y, v.y, t.y, u.z, v.z, t.z}, to};
    }
};

}  // namespace peers
