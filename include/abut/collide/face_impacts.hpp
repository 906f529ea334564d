// SPDX-License-Identifier: MIT
#pragma once

// The index of a mesh in motion for the rules that find pairs of features by pairs of faces (pair_rule.hpp), and how queries
// look in it. make_impact_index (impacts.hpp) makes one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/options.hpp>
#include <abut/collide/orphan_sets.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/representatives.hpp>
#include <abut/index/bvh.hpp>
#include <abut/shape/motion.hpp>

namespace abut {

/// A mesh in motion with one tree, over its faces, of boxes around the whole step, and what `Rule` knows of its faces. Made
/// by make_impact_index<Rule>; `refit` brings it to the next step. Immutable; copies share everything, and steps of one mesh
/// share what is known of faces.
template <scalar T, memory_space Space, pair_rule Rule>
class face_impact_index {
public:
    static constexpr pair_rule rule = Rule;
    static constexpr bool keeps_orphans = Rule == pair_rule::orphan_sets;
    using scalar_type = T;
    using memory_space = Space;
    using mesh_type = moving_set<abut::mesh<T, Space>>;
    using edges_type = moving_set<edge_mesh<T, Space>>;
    struct no_orphans {};
    using orphans_type = std::conditional_t<keeps_orphans, detail::orphan_pairs<Space>, no_orphans>;

    face_impact_index(bvh<mesh_type, Space> faces, edges_type edges, detail::face_parts<Space> parts, orphans_type orphans)
        : faces_(std::move(faces)), edges_(std::move(edges)), parts_(std::move(parts)), orphans_(std::move(orphans)) {}

    /// Number of faces.
    [[nodiscard]] std::size_t size() const { return faces_.size(); }
    [[nodiscard]] int device() const { return faces_.device(); }
    [[nodiscard]] const mesh_type& mesh() const { return faces_.set(); }
    [[nodiscard]] const bvh<mesh_type, Space>& faces() const { return faces_; }
    [[nodiscard]] const edges_type& edges() const { return edges_; }
    [[nodiscard]] const detail::face_parts<Space>& parts() const { return parts_; }
    [[nodiscard]] const orphans_type& orphans() const { return orphans_; }

private:
    bvh<mesh_type, Space> faces_;
    edges_type edges_;
    detail::face_parts<Space> parts_;
    orphans_type orphans_;
};

namespace detail {

/// Of a mesh in the policy's memory.
template <pair_rule Rule, class Policy, scalar T>
auto make_face_impact_index(const Policy& on, const moving_set<mesh<T, space_of<Policy>>>& resident,
                            const bvh_options& options, const char* function) {
    using index = face_impact_index<T, space_of<Policy>, Rule>;
    auto edges = abut::edges(on, resident);
    const auto view = resident.t0().view();
    const strided<edge> edges_seen = edges.t0().view().edges;
    auto [parts, faces_of] = make_face_parts(on, view.faces, edges_seen, view.vertices.count, function);
    typename index::orphans_type orphans{};
    if constexpr (index::keeps_orphans) {
        orphans = make_orphans(on, view.faces, edges_seen, view.vertices.count, parts, std::move(faces_of));
    }
    return index(make_bvh(on, resident, options), std::move(edges), std::move(parts), std::move(orphans));
}

/// The views of pairs of features of two indices, of which both may be the same.
template <class X>
auto features_of_two(const X& x, const X& y) {
    const auto vertices_x = vertices(x.mesh()).view(), vertices_y = vertices(y.mesh()).view();
    const auto faces_x = x.mesh().view(), faces_y = y.mesh().view();
    const auto edges_x = x.edges().view(), edges_y = y.edges().view();
    using points = std::remove_const_t<decltype(vertices_x)>;
    using faces = std::remove_const_t<decltype(faces_x)>;
    using edges = std::remove_const_t<decltype(edges_x)>;
    const auto key = [](const auto& a, const auto& b) { return pair_key{id_bits(a.size()), id_bits(b.size())}; };
    return views_of_features<pair_view<points, faces, keep_all>, pair_view<faces, points, keep_all>,
                             pair_view<edges, edges, keep_all>>{{vertices_x, faces_y, key(vertices_x, faces_y), {}},
                                                                {faces_x, vertices_y, key(faces_x, vertices_y), {}},
                                                                {edges_x, edges_y, key(edges_x, edges_y), {}}};
}

template <class X>
using face_operand = indexed_operand<std::remove_cvref_t<decltype(std::declval<const X&>().faces())>>;
template <class X>
using face_view = faces_with_parts<std::remove_cvref_t<decltype(std::declval<const X&>().mesh().view())>>;

/// Pairs of faces of one index, and what tells of their features.
template <class X, class Nearness>
auto faces_of_one(const X& x, const Nearness& near) {
    const face_operand<X> operand{x.faces()};
    const int bits = id_bits(x.size());
    const face_view<X> faces{x.mesh().view(), x.parts().parts.data()};
    const feature_keys keys = features_of_two(x, x).keys();
    const auto overlap = box_overlap(operand, operand, near);
    using pairs =
        self_pairing<face_operand<X>, keep_all, traversal::both_at_once, schedule::static_partition, as_they_are, Nearness>;
    const auto make = [&](const auto& rule) {
        using expand = expand_faces<true, decltype(faces.faces), std::remove_cvref_t<decltype(rule)>,
                                    std::remove_const_t<decltype(overlap)>>;
        return std::pair(pairs{operand, {}, {bits, bits}, {}, near},
                         expand{faces, faces, {bits, bits}, keys, rule, overlap});
    };
    if constexpr (X::keeps_orphans) {
        return make(x.orphans().rule(faces.faces.t0.faces));
    } else {
        return make(tell_where_given{});
    }
}

/// And of two.
template <class X, class Nearness>
auto faces_of_two(const X& x, const X& y, const Nearness& near) {
    using operand = face_operand<X>;
    const operand a{x.faces()}, b{y.faces()};
    const face_view<X> faces_x{x.mesh().view(), x.parts().parts.data()}, faces_y{y.mesh().view(), y.parts().parts.data()};
    const pair_key key{id_bits(x.size()), id_bits(y.size())};
    const auto overlap = box_overlap(a, b, near);
    using both = pairing<operand, operand, keep_all, traversal::both_at_once, schedule::static_partition, Nearness>;
    using expand = expand_faces<false, decltype(faces_x.faces), tell_where_given, std::remove_const_t<decltype(overlap)>>;
    return std::pair(both{a, b, key, {}, near}, expand{faces_x, faces_y, key, features_of_two(x, y).keys(), {}, overlap});
}

/// What a judge finds, as keys of pairs of features, by kinds.
template <class Policy>
using keys_by_kind = std::array<execution::buffer_of<Policy, std::uint64_t>, 3>;

template <class Policy, class Views>
keys_by_kind<Policy> take_keys(const Policy& on, feature_queues<Policy>& hits, const Views& views, bool sorted) {
    const feature_keys keys = views.keys();
    const int bits[] = {keys.vertex_face.bits(), keys.face_vertex.bits(), keys.edge_edge.bits()};
    keys_by_kind<Policy> taken;
    for (std::size_t kind = 0; kind < 3; ++kind) {
        taken[kind] = hits[kind].take();
        if (sorted) sort_keys(on, taken[kind], bits[kind]);
    }
    return taken;
}

template <class Policy>
feature_queues<Policy> make_feature_queues(const Policy& on, std::size_t faces) {
    const std::size_t likely = std::max(faces / 4, std::size_t{1} << 20);
    return {key_queue<Policy>(on, likely), key_queue<Policy>(on, likely), key_queue<Policy>(on, likely)};
}

/// The pairs of features of one index.
template <class Policy, class X, class Judge, class Nearness>
keys_by_kind<Policy> find_features(const Policy& on, const X& x, const Judge& judge, const Nearness& near, bool sorted) {
    const auto views = features_of_two(x, x);
    const auto [pairing, expand] = faces_of_one(x, near);
    auto hits = make_feature_queues(on, x.size());
    search_features(on, pairing, expand, views, judge, hits);
    find_loose<false>(on, views.vertex_face, x.parts().loose, x.faces(), judge, near, hits[0]);
    if constexpr (X::keeps_orphans) {
        search_orphans(on, views.vertex_face, x.orphans().vertex_face, judge, expand.near, hits[0]);
        search_orphans(on, views.edge_edge, x.orphans().edge_edge, judge, expand.near, hits[2]);
    }
    return take_keys(on, hits, views, sorted);
}

/// And of two.
template <class Policy, class X, class Judge, class Nearness>
keys_by_kind<Policy> find_features(const Policy& on, const X& x, const X& y, const Judge& judge, const Nearness& near,
                                   bool sorted) {
    const auto views = features_of_two(x, y);
    const auto [pairing, expand] = faces_of_two(x, y, near);
    auto hits = make_feature_queues(on, std::max(x.size(), y.size()));
    search_features(on, pairing, expand, views, judge, hits);
    find_loose<false>(on, views.vertex_face, x.parts().loose, y.faces(), judge, near, hits[0]);
    find_loose<true>(on, views.face_vertex, y.parts().loose, x.faces(), judge, near, hits[1]);
    return take_keys(on, hits, views, sorted);
}

}  // namespace detail

}  // namespace abut
