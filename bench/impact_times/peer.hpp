// SPDX-License-Identifier: MIT
#pragma once

// What the peers of bench/impact_times.cpp share: a list of them, and what each is asked.

#include <functional>
#include <string>
#include <vector>

#include <abut/arithmetic/vec.hpp>

namespace impact_peer {

/// Corners at both ends of a step: a vertex and a face, or two edges.
struct features {
    abut::vec3<double> t0[4], t1[4];
};
enum class kind { vertex_face, edge_edge };

struct library {
    std::string name, version;
    /// Times of all, into a list that is as long; -1 where there is none.
    std::function<void(kind, const std::vector<features>&, std::vector<double>&)> times;
};

inline std::vector<library>& libraries() {
    static std::vector<library> all;
    return all;
}

}  // namespace impact_peer
