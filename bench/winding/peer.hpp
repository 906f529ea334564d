// SPDX-License-Identifier: MIT
#pragma once

// What the peers of bench/winding.cpp share: a list of them, and what each is asked.

#include <functional>
#include <string>
#include <vector>

#include <abut/shape/view.hpp>

namespace winding_peer {

struct surface {
    std::string name;
    std::vector<abut::vec3<float>> vertices;
    std::vector<abut::face> faces;
};
/// Answers all points at an accuracy.
using ask = std::function<void(const std::vector<abut::vec3<float>>&, double accuracy, std::vector<double>&)>;

struct library {
    std::string name, version;
    std::vector<double> accuracies;  ///< that are measured; the first is the library's default
    std::function<ask(const surface&)> make;
};

inline std::vector<library>& libraries() {
    static std::vector<library> all;
    return all;
}

}  // namespace winding_peer
