// SPDX-License-Identifier: MIT
#pragma once

// Impacts that begin where the last query of a mesh, or of a pair of them, came to its ends (front.hpp).

#include <optional>

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/config.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/experimental/front.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// Where queries of one mesh, or of one pair of them, came to their ends, for each kind of features, for the next step to
/// begin there (front.hpp). They belong to the topologies of indices, so they are for indices that are refitted.
struct impact_fronts {
    front vertex_face;  ///< of vertices of the first mesh and faces of the second
    front face_vertex;  ///< of faces of the first mesh and vertices of the second
    front edge_edge;    ///< of edges

    /// Empty, each with these options.
    explicit impact_fronts(const front_options& options = {})
        : vertex_face(options), face_vertex(options), edge_edge(options) {}
};

///@}

namespace detail {

struct given_fronts {
    impact_fronts& all;

    template <feature_pair Kind, class Policy, class Expand, class A, class B, class Run>
    void walk(const Policy& on, const Expand& expand, const A& a, const B& b, const Run& run) const {
        front& ends = Kind == feature_pair::vertex_face   ? all.vertex_face
                      : Kind == feature_pair::face_vertex ? all.face_vertex
                                                          : all.edge_edge;
        const execution::scheduled<schedule::static_partition> how{};
        from_front::walk(ends, on, how, expand, a.shape_of_tree(), b.shape_of_tree(), run);
    }
};

}  // namespace detail

/// @addtogroup motion
///@{

/// `impacts` from fronts, which are left at this step's ends.
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto impacts(const Policy& on, const X& a, const Y& b, const impact_options& options, impact_fronts& fronts) {
    return detail::impacts_between<A>(on, a, b, options, detail::given_fronts{fronts});
}
/// `self_impacts` from fronts, which are left at this step's ends.
template <motion_arithmetic A = filtered, execution_policy Policy, class X>
[[nodiscard]] auto self_impacts(const Policy& on, const X& x, const impact_options& options, impact_fronts& fronts) {
    return detail::impacts_within<A>(on, x, options, detail::given_fronts{fronts});
}
/// `first_impact` from fronts, which are left at the ends of the part of the step that was looked at last.
template <motion_arithmetic A = filtered, execution_policy Policy, class X, class Y>
[[nodiscard]] auto first_impact(const Policy& on, const X& a, const Y& b, const impact_options& options,
                                impact_fronts& fronts) {
    constexpr const char* function = "abut::first_impact";
    return detail::first_between<A>(on, a, b, options, detail::given_fronts{fronts}, function);
}
/// `first_self_impact` from fronts, as of `first_impact`.
template <motion_arithmetic A = filtered, execution_policy Policy, class X>
[[nodiscard]] auto first_self_impact(const Policy& on, const X& a, const impact_options& options, impact_fronts& fronts) {
    constexpr const char* function = "abut::first_self_impact";
    return detail::first_within<A>(on, a, options, detail::given_fronts{fronts}, function);
}

///@}

}  // namespace abut
