// SPDX-License-Identifier: MIT
#pragma once

// pair_rule::representative_triangles and orphan_sets: the index of a mesh in motion for the rules that find pairs of
// features by pairs of faces, and how queries look in it. make_impact_index (collide/impact_index.hpp) makes one.

#include <cstddef>
#include <type_traits>
#include <utility>

#include <abut/collide/features.hpp>
#include <abut/collide/first_impact.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/collide/timed_search.hpp>
#include <abut/experimental/orphan_sets.hpp>
#include <abut/experimental/representatives.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/refit.hpp>
#include <abut/shape/motion.hpp>

namespace abut {

/// @addtogroup motion
///@{

/// A mesh in motion with one tree, over its faces, of boxes around the whole step, and what `Rule` knows of its faces. Made
/// by make_impact_index<Rule>; `refit` brings it to the next step. Immutable; copies share everything, and steps of one mesh
/// share what is known of faces.
template <scalar T, memory_space Space, pair_rule Rule>
class face_impact_index {
public:
    static constexpr pair_rule rule = Rule;                                ///< how pairs of features are found
    static constexpr bool keeps_orphans = Rule == pair_rule::orphan_sets;  ///< whether it has a list of orphans
    using scalar_type = T;                                                 ///< float or double
    using memory_space = Space;                                            ///< where the memory lies
    using mesh_type = moving_set<abut::mesh<T, Space>>;                    ///< the mesh in motion
    using edges_type = moving_set<edge_mesh<T, Space>>;                    ///< its edges
    /// In the place of orphans, for rules without them.
    struct no_orphans {};
    /// The list of orphans.
    using orphans_type = std::conditional_t<keeps_orphans, detail::orphan_pairs<Space>, no_orphans>;

    /// For make_impact_index: of parts that go together, which is not checked.
    face_impact_index(bvh<mesh_type, Space> faces, edges_type edges, detail::face_parts<Space> parts, orphans_type orphans)
        : faces_(std::move(faces)), edges_(std::move(edges)), parts_(std::move(parts)), orphans_(std::move(orphans)) {}

    /// Number of faces.
    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    /// The CUDA device that the index lies on; -1 for the host.
    [[nodiscard]] int device() const { return faces_.device(); }
    /// The mesh in motion.
    [[nodiscard]] const mesh_type& mesh() const { return faces_.set(); }
    /// The tree over its faces.
    [[nodiscard]] const bvh<mesh_type, Space>& faces() const { return faces_; }
    /// Its edges, without a tree.
    [[nodiscard]] const edges_type& edges() const { return edges_; }
    /// For queries: which features have been given to which faces, and the orphans.
    ///@{
    [[nodiscard]] const detail::face_parts<Space>& parts() const { return parts_; }
    [[nodiscard]] const orphans_type& orphans() const { return orphans_; }
    ///@}

    /// For queries of a part of a step: boxes of the way until a time.
    template <class Policy>
    friend face_impact_index until(const Policy& on, const face_impact_index& index, double time) {
        const detail::trees_until<Policy, T> trees(on, index.mesh(), time);
        return {trees.of_elements(index.faces_, index.mesh().t0().view().faces), index.edges_, index.parts_, index.orphans_};
    }

private:
    bvh<mesh_type, Space> faces_;
    edges_type edges_;
    detail::face_parts<Space> parts_;
    orphans_type orphans_;
};

/// The index of another step of the same mesh, as of an impact_index.
template <execution_policy Policy, scalar T, memory_space Space, pair_rule Rule, memory_space From>
[[nodiscard]] face_impact_index<T, Space, Rule> refit(const Policy& on, const face_impact_index<T, Space, Rule>& index,
                                                      const moving_set<mesh<T, From>>& set) {
    const auto resident = detail::resident_of_index(on, index, set);
    return {refit(on, index.faces(), resident), detail::edges_over(index.edges(), resident), index.parts(), index.orphans()};
}

///@}

namespace detail {

template <scalar T, memory_space Space, pair_rule Rule>
inline constexpr bool is_impact_index<face_impact_index<T, Space, Rule>> = true;

/// The views of pairs of features of two indices, which may be one.
template <bool Within, class X>
auto features_of_two(const X& x, const X& y, const char* function) {
    using view = feature_pairs<typename X::scalar_type, typename X::memory_space>;
    return view({x.mesh(), x.edges()}, {y.mesh(), y.edges()}, Within, function);
}

template <class X>
using face_operand = indexed_operand<std::remove_cvref_t<decltype(std::declval<const X&>().faces())>>;
template <class X>
using face_view = faces_with_parts<std::remove_cvref_t<decltype(std::declval<const X&>().mesh().view())>>;

/// Pairs of faces of one index, and what tells of their features.
template <class X, class Nearness>
auto faces_of_one(const X& x, const feature_key& keys, const Nearness& near) {
    const face_operand<X> operand{x.faces()};
    const int bits = id_bits(x.size());
    const face_view<X> faces{x.mesh().view(), x.parts().parts.data()};
    const auto overlap = box_overlap(operand, operand, near);
    using pairs = self_pairing<face_operand<X>, keep_all, traversal::both_at_once, schedule::static_partition, Nearness>;
    const auto make = [&](const auto& rule) {
        using expand = expand_faces<true, decltype(faces.faces), std::remove_cvref_t<decltype(rule)>,
                                    std::remove_const_t<decltype(overlap)>>;
        return std::pair(pairs{operand, {bits, bits}, {}, near}, expand{faces, faces, {bits, bits}, keys, rule, overlap});
    };
    if constexpr (X::keeps_orphans) {
        return make(x.orphans().rule(faces.faces.t0.faces));
    } else {
        return make(tell_where_given{});
    }
}

/// And of two.
template <class X, class Nearness>
auto faces_of_two(const X& x, const X& y, const feature_key& keys, const Nearness& near) {
    using operand = face_operand<X>;
    const operand a{x.faces()}, b{y.faces()};
    const face_view<X> faces_x{x.mesh().view(), x.parts().parts.data()}, faces_y{y.mesh().view(), y.parts().parts.data()};
    const pair_key key{id_bits(x.size()), id_bits(y.size())};
    const auto overlap = box_overlap(a, b, near);
    using both = pairing<operand, operand, keep_all, traversal::both_at_once, schedule::static_partition, Nearness>;
    using expand = expand_faces<false, decltype(faces_x.faces), tell_where_given, std::remove_const_t<decltype(overlap)>>;
    return std::pair(both{a, b, key, {}, near}, expand{faces_x, faces_y, key, keys, {}, overlap});
}

/// Leaves in `hits` the pairs of features of two indices, or `Within` one, that touch, with their times.
template <bool Within, class Policy, class X, class View, class Judge, class Nearness>
void time_by_faces(const Policy& on, const X& x, const X& y, const View& both, const Judge& judge, const Nearness& near,
                   timed_queue<Policy>& hits) {
    if constexpr (Within) {
        const auto [pairing, expand] = faces_of_one(x, both.key, near);
        time_faces(on, pairing, expand, both, judge, hits);
        if constexpr (X::keeps_orphans) time_orphans(on, both, x.orphans().keys, judge, expand.near, hits);
    } else {
        const auto [pairing, expand] = faces_of_two(x, y, both.key, near);
        time_faces(on, pairing, expand, both, judge, hits);
        time_loose<true>(on, both, y.parts().loose, x.faces(), judge, near, hits);
    }
    time_loose<false>(on, both, x.parts().loose, y.faces(), judge, near, hits);
}

template <pair_rule Rule>
    requires(Rule == pair_rule::representative_triangles || Rule == pair_rule::orphan_sets)
struct impact_rule<Rule> {
    template <class Policy, scalar T, memory_space Space>
    static auto make(const Policy& on, const moving_set<mesh<T, Space>>& resident, const bvh_options& options,
                     const char* function) {
        using index = face_impact_index<T, Space, Rule>;
        auto edges = abut::edges(on, resident);
        const features_of_mesh<T, Space> features(resident, edges);
        auto [parts, faces_of] =
            make_face_parts(on, features.faces.t0.faces, features.edges.t0.edges, features.vertices.size(), function);
        typename index::orphans_type orphans{};
        if constexpr (index::keeps_orphans) {
            const feature_pairs<T, Space> both(features, features, true, function);
            orphans = make_orphans(on, both, parts, std::move(faces_of));
        }
        return index(make_bvh(on, resident, options), std::move(edges), std::move(parts), std::move(orphans));
    }
    template <bool Within, class Policy, class X, class Nearness, class Use>
    static auto with_search(const Policy& on, const X& x, const X& y, const Nearness& near, const char* function,
                            const Use& use) {
        const auto both = features_of_two<Within>(x, y, function);
        return use(both, [&](const auto& judge, timed_queue<Policy>& hits) {
            time_by_faces<Within>(on, x, y, both, judge, near, hits);
        });
    }
};

}  // namespace detail

}  // namespace abut
