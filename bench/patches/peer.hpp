// SPDX-License-Identifier: MIT
#pragma once

// What bench/patches.cpp and its peers share: a scene of two meshes, and what a method says of a frame.

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <abut/shape/rigid.hpp>
#include <abut/shape/set.hpp>

namespace patches_peer {

struct answer {
    bool is_known = false;
    abut::vec3<double> normal{}, center{};
    double depth = 0;
    std::size_t found = 0;  ///< patches or contacts
};

struct scene {
    std::string name;
    abut::mesh<float> a, b;
    std::function<abut::rigid<float>(double)> pose;  ///< of a, at a time in [0, 1]
    double size;
};

using method = std::function<answer(const abut::rigid<float>&)>;

/// Peers register themselves here, by name: what makes a method for a scene.
inline std::vector<std::pair<std::string, method (*)(const scene&)>>& peers() {
    static std::vector<std::pair<std::string, method (*)(const scene&)>> all;
    return all;
}

}  // namespace patches_peer
