// SPDX-License-Identifier: MIT
#pragma once

// Impacts that begin where the last query of a mesh, or of a pair of them, came to its ends (front.hpp): what `impacts`,
// `self_impacts`, `first_impact` and `first_self_impact` take as their last argument.

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/experimental/front.hpp>

namespace abut {

/// Where queries of one mesh, or of one pair of them, came to their ends, for each kind of features, for the next step to
/// begin there (front.hpp). They belong to the topologies of indices, so they are for indices that are refitted.
/// @ingroup motion
struct impact_fronts {
    front vertex_face;  ///< of vertices of the first mesh and faces of the second
    front face_vertex;  ///< of faces of the first mesh and vertices of the second
    front edge_edge;    ///< of edges

    /// Empty, each with these options.
    explicit impact_fronts(const front_options& options = {})
        : vertex_face(options), face_vertex(options), edge_edge(options) {}
};

}  // namespace abut
