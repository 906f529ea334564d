// SPDX-License-Identifier: MIT
#pragma once

// What impacts look in: a mesh in motion with its edges, and trees. Made by make_impact_index, by the rule that it is given
// (pair_rule.hpp), and brought to the next step by refit.

#include <concepts>
#include <cstddef>
#include <utility>

#include <abut/collide/pair_rule.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/refit.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/motion.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// A mesh in motion with what `impacts` looks in: its edges, and trees over its faces, its edges and its vertices, of boxes
/// around the whole step. Made by make_impact_index; `refit` brings it to the next step. Immutable; copies share everything.
template <scalar T, memory_space Space>
class impact_index {
public:
    static constexpr pair_rule rule = pair_rule::feature_trees;  ///< how pairs of features are found
    using scalar_type = T;                                       ///< float or double
    using memory_space = Space;                                  ///< where the memory lies
    using mesh_type = moving_set<abut::mesh<T, Space>>;          ///< the mesh in motion
    using edges_type = moving_set<edge_mesh<T, Space>>;          ///< its edges
    using vertices_type = moving_set<points<T, Space>>;          ///< its vertices

    /// For make_impact_index: of trees over the features of one mesh, which is not checked.
    impact_index(bvh<mesh_type, Space> faces, bvh<edges_type, Space> edges, bvh<vertices_type, Space> vertices)
        : faces_(std::move(faces)), edges_(std::move(edges)), vertices_(std::move(vertices)) {}

    /// Number of faces.
    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    /// The CUDA device that the index lies on; -1 for the host.
    [[nodiscard]] int device() const { return faces_.device(); }
    /// The mesh in motion.
    [[nodiscard]] const mesh_type& mesh() const { return faces_.set(); }
    /// The trees over faces, edges and vertices.
    ///@{
    [[nodiscard]] const bvh<mesh_type, Space>& faces() const { return faces_; }
    [[nodiscard]] const bvh<edges_type, Space>& edges() const { return edges_; }
    [[nodiscard]] const bvh<vertices_type, Space>& vertices() const { return vertices_; }
    ///@}

private:
    bvh<mesh_type, Space> faces_;
    bvh<edges_type, Space> edges_;
    bvh<vertices_type, Space> vertices_;
};

///@}

namespace detail {

/// How an index of a rule is made, of a mesh in the policy's memory. Other rules are specialised in experimental/, and say
/// also how features are searched (with_search_of_indices in impacts.hpp) and how far (`until` in first_impact.hpp).
template <pair_rule Rule>
struct impact_rule {
    static_assert(Rule == pair_rule::feature_trees,
                  "abut: this pair_rule is in another header: include <abut/experimental/pair_rules.hpp>");
    template <class Policy, scalar T, memory_space Space>
    static auto make(const Policy& on, const moving_set<mesh<T, Space>>& resident, const bvh_options& options, const char*) {
        return impact_index<T, Space>(make_bvh(on, resident, options), make_bvh(on, edges(on, resident), options),
                                      make_bvh(on, vertices(resident), options));
    }
};

}  // namespace detail

/// @addtogroup motion
///@{

/// An index of a mesh in motion, or of one at rest, in the policy's memory: an impact_index, or by one of the rules of
/// faces a face_impact_index (experimental/pair_rules.hpp). Queries go by the rule of the index that they are given, and by
/// feature_trees where there is none. Throws as `edges` and make_bvh do.
///
///     const auto index = abut::make_impact_index<abut::pair_rule::orphan_sets>(on, step);
///     const auto found = abut::self_impacts(on, index);
template <pair_rule Rule = pair_rule::feature_trees, execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto make_impact_index(const Policy& on, const moving_set<mesh<T, Space>>& set,
                                     const bvh_options& options = {}) {
    constexpr const char* function = "abut::make_impact_index";
    return detail::impact_rule<Rule>::make(on, detail::make_resident(on, set, function), options, function);
}
/// Of a mesh at rest, which is at t = 1 where it is at t = 0.
template <pair_rule Rule = pair_rule::feature_trees, execution_policy Policy, scalar T, memory_space Space>
[[nodiscard]] auto make_impact_index(const Policy& on, const mesh<T, Space>& at_rest, const bvh_options& options = {}) {
    return make_impact_index<Rule>(on, moving_set<mesh<T, Space>>(at_rest, at_rest), options);
}

namespace detail {

/// A mesh in motion in the policy's memory, if it has the faces of an index.
template <class Policy, class Index, class Set>
auto resident_of_index(const Policy& on, const Index& index, const Set& set) {
    constexpr const char* function = "abut::refit";
    auto resident = make_resident(on, set, function);
    check_motion_sizes(index.mesh().t0().view(), resident.t0().view(), function);
    check_elements(on, index.mesh().t0().view(), resident.t0().view(), function);
    return resident;
}
/// The same edges over the vertices of another step.
template <scalar T, memory_space Space>
moving_set<edge_mesh<T, Space>> edges_over(const moving_set<edge_mesh<T, Space>>& edges,
                                           const moving_set<mesh<T, Space>>& step) {
    const auto at = [&](const mesh<T, Space>& time) { return set_parts::with_points(edges.t0(), vertices(time)); };
    return {at(step.t0()), at(step.t1())};
}

}  // namespace detail

/// The index of another step of the same mesh: its trees have the topology of `index`, its boxes are those of `set`, which
/// has the same faces. Results are right however far the mesh has moved; `quality` of the trees
/// tells when to make a new index. Throws error for other faces, and as `refit` of a tree does.
template <execution_policy Policy, scalar T, memory_space Space, memory_space From>
[[nodiscard]] impact_index<T, Space> refit(const Policy& on, const impact_index<T, Space>& index,
                                           const moving_set<mesh<T, From>>& set) {
    const auto resident = detail::resident_of_index(on, index, set);
    return {refit(on, index.faces(), resident), refit(on, index.edges(), detail::edges_over(index.edges().set(), resident)),
            refit(on, index.vertices(), vertices(resident))};
}

///@}

namespace detail {

/// The rule by which a query of these goes: that of the indices among them.
template <class X>
inline constexpr bool is_impact_index = false;
template <scalar T, memory_space Space>
inline constexpr bool is_impact_index<impact_index<T, Space>> = true;
template <class X, class Y>
consteval pair_rule rule_of() {
    if constexpr (is_impact_index<X>) {
        return X::rule;
    } else if constexpr (is_impact_index<Y>) {
        return Y::rule;
    } else {
        return pair_rule::feature_trees;
    }
}

/// Whether impact_operand takes it.
template <class Policy, class X>
consteval bool can_move() {
    if constexpr (std::same_as<X, refused>) {
        return false;
    } else if constexpr (is_impact_index<X>) {
        return lies_there<Policy, X>();
    } else {
        constexpr bool is = requires(const Policy& on, const X& x) { make_impact_index(on, x); };
        static_assert(
            is, "abut: impacts are of meshes, at rest or in motion (abut::moving), or of indices of such, without a pose");
        return is;
    }
}
/// Whether an impact query takes both.
template <class Policy, class X, class Y>
consteval bool can_meet() {
    if constexpr (!can_move<Policy, X>()) {
        return false;
    } else if constexpr (!can_move<Policy, Y>()) {
        return false;
    } else {
        constexpr bool one_scalar = std::same_as<typename X::scalar_type, typename Y::scalar_type>;
        static_assert(one_scalar, "abut: both sides of a query need the same scalar type, float or double");
        if constexpr (is_impact_index<X> && is_impact_index<Y>) {
            constexpr bool one_rule = X::rule == Y::rule;
            static_assert(one_rule, "abut: both indices of a query have to be made by the same pair_rule");
            return one_scalar && one_rule;
        }
        return one_scalar;
    }
}

/// What `x` is to an impact query, which it can be: an index, if need be made for the query.
template <pair_rule Rule, class Policy, class X>
auto impact_operand(const Policy& on, const X& x, const char* function) {
    if constexpr (is_impact_index<X>) {
        require_same_device(on, x, function);
        return x;
    } else {
        return make_impact_index<Rule>(on, x);
    }
}

}  // namespace detail

}  // namespace abut
