// SPDX-License-Identifier: MIT
#pragma once

// A ball as a closed mesh, which several benchmarks have in their scenes.

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <abut/shape/set.hpp>

namespace bench {

/// A ball of radius 1 in rings.
inline abut::mesh<float> ball(int rings, int around) {
    constexpr double pi = 3.14159265358979323846;
    std::vector<abut::vec3<float>> v{{0, 0, 1}};
    std::vector<std::array<std::uint32_t, 3>> f;
    for (int i = 1; i < rings; ++i) {
        for (int k = 0; k < around; ++k) {
            const double a = pi * i / rings, b = 2 * pi * k / around;
            v.push_back({static_cast<float>(std::sin(a) * std::cos(b)), static_cast<float>(std::sin(a) * std::sin(b)),
                         static_cast<float>(std::cos(a))});
        }
    }
    v.push_back({0, 0, -1});
    const auto last = static_cast<std::uint32_t>(v.size() - 1);
    const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(1 + (i - 1) * around + k % around); };
    for (int k = 0; k < around; ++k) {
        f.push_back({0, at(1, k), at(1, k + 1)});
        f.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
        for (int i = 1; i + 1 < rings; ++i) {
            f.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            f.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return {std::move(v), std::move(f)};
}

}  // namespace bench
