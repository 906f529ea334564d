// SPDX-License-Identifier: MIT
#pragma once

// How walks go on: what a visitor wants next, and in which order two trees are walked down together.

namespace abut {

/// @addtogroup queries
///@{

/// What a visitor wants next. Stopping is best effort where visitors run concurrently.
enum class visit : unsigned char {
    proceed,  ///< go on
    stop      ///< call it no more, as soon as that is known everywhere
};

/// How a query of two trees comes by its candidates: which of two nodes whose boxes meet is opened, that is, replaced by its
/// children, and in which order that is done. The choice moves speed, never results; docs/hierarchies.md says which to take.
/// Those of experimental/ are for programs that include the header which is named here.
enum class traversal : unsigned char {
    /// Both nodes, depth first (pair_walk.hpp). Take it unless you have measured that another pays.
    both_at_once,
    /// The first argument's node as long as it has children, and only then the other's, depth first. For comparisons:
    /// <abut/experimental/descent_rules.hpp>.
    one_first,
    /// The node with the larger box, depth first (rule_walk.hpp). Take it where one set is small beside the other, a tool
    /// in a landscape: of a hundredth of its triangles or less it takes half the time (docs/results/meshes.md).
    larger_first,
    /// The node of the tree that was not opened last, depth first. It stands between both_at_once and larger_first:
    /// <abut/experimental/descent_rules.hpp>.
    alternate,
    /// Both nodes, level by level, from all pairs of nodes at query_options::start_depth on. For comparisons; each level
    /// takes memory for its pairs of nodes: <abut/experimental/breadth_first.hpp>.
    breadth_first,
    /// Both nodes, from where the last query with query_options::front came to its ends, or from the roots. For scenes
    /// that move a little from query to query, of trees that are refitted: <abut/experimental/front.hpp>.
    from_front
};

/// The deepest level at which breadth_first begins: it compares 2^20 pairs of boxes there.
inline constexpr int most_start_depth = 10;

///@}

}  // namespace abut
