// SPDX-License-Identifier: MIT
#pragma once

// A pair of features that move: what the families draw and the oracle of continuous collision detection answers.

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace abut::test {

enum class motion_kind : int { vertex_face, edge_edge };

/// On the host only.
inline const char* name_of(motion_kind kind) { return kind == motion_kind::vertex_face ? "vertex-face" : "edge-edge"; }

/// Four points at t = 0 and at t = 1, in between on straight lines at constant speed: a vertex and the corners of a face, or
/// the ends of an edge and those of another.
template <scalar T>
struct motion {
    vec3<T> t0[4], t1[4];

    friend constexpr bool operator==(const motion&, const motion&) = default;
};

}  // namespace abut::test
