// SPDX-License-Identifier: MIT
#pragma once

// By which rule queries of meshes in motion (impacts.hpp) find their pairs of features. It changes times and memory, and no
// answer.

namespace abut {

/// @addtogroup motion
///@{

/// Which features of two meshes meet.
enum class feature_pair : unsigned char {
    vertex_face,  ///< a vertex of the first mesh and a face of the second
    face_vertex,  ///< a face of the first mesh and a vertex of the second
    edge_edge     ///< two edges
};

/// How pairs of features are found, each once: a template argument of make_impact_index.
enum class pair_rule : unsigned char {
    /// Features have trees of their own: vertices, edges and faces.
    feature_trees,
    /// One tree, over faces. Each vertex and each edge is given to one of its faces, and of two faces those features meet
    /// that have been given to them (S. Curtis, R. Tamstorf, D. Manocha, Fast collision detection for deformable models
    /// using representative-triangles, I3D 2008): <abut/experimental/pair_rules.hpp>.
    representative_triangles,
    /// One tree, over faces. Within one mesh faces that share a vertex are left out, and the pairs of features that only
    /// such faces have, the orphans, are a list that is made with the index (M. Tang, S. Curtis, S.-E. Yoon, D. Manocha,
    /// Interactive continuous collision detection between deformable models using connectivity-based culling, SPM 2008).
    /// Two meshes have no vertex in common: between them it is representative_triangles. In the same header.
    orphan_sets
};

///@}

}  // namespace abut
