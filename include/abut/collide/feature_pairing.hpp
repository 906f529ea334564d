// SPDX-License-Identifier: MIT
#pragma once

// The pairs of features that trees over vertices, faces and edges find (pair_rule::feature_trees), and of which the boxes
// come near each other. The trees of all kinds of pairs are walked together: a small mesh has too little work for a device
// as it is, and one walk after another would wait for the end of each.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/features.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/collide/routes.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/collide/shares.hpp>
#include <abut/traverse/pair_walk.hpp>
#include <abut/traverse/seeds.hpp>
#include <abut/traverse/self_walk.hpp>

namespace abut::detail {

/// The pairs of one kind, for the ways to candidates (routes.hpp).
template <class View>
struct ids_of_kind {
    View both;
    feature_pair kind;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t i, std::uint32_t j) const { return both.key.pack(kind, i, j); }
    [[nodiscard]] ABUT_HD bool wanted(std::uint32_t i, std::uint32_t j) const { return both.wanted(kind, i, j); }
};

/// The trees of one mesh.
template <class Tree>
struct trees_of_features {
    Tree vertices, faces, edges;

    /// The one that the first feature of a pair is in, or the second.
    [[nodiscard]] ABUT_HD const Tree& first(feature_pair kind) const {
        return kind == feature_pair::vertex_face ? vertices : kind == feature_pair::face_vertex ? faces : edges;
    }
    [[nodiscard]] ABUT_HD const Tree& second(feature_pair kind) const {
        return kind == feature_pair::vertex_face ? faces : kind == feature_pair::face_vertex ? vertices : edges;
    }
};

template <class Item, class Emitter>
struct add_features {
    Emitter& emitter;
    feature_pair kind;
    ABUT_CALLS_ANY
    template <class Number, class Nodes>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, const Nodes& next) const {
        emitter.add(k, is, Item{next.a, next.b, kind});
    }
};
template <bool InOrder, class Emitter, class View>
struct push_features {
    Emitter& emitter;
    const View& both;
    feature_pair kind;
    ABUT_CALLS_ANY
    template <class Number>
    ABUT_INLINE ABUT_HD void operator()(Number k, bool is, std::uint32_t i, std::uint32_t j) const {
        const bool turn = InOrder && kind == feature_pair::edge_edge && j < i;
        const std::uint32_t a = turn ? j : i, b = turn ? i : j;
        emitter.push(k, is && both.wanted(kind, a, b), both.key.pack(kind, a, b));
    }
};

/// One step down two trees of two meshes, or `Within` one, of which the trees of edges are walked with themselves. Begins
/// at a depth.
template <bool Within, class Tree, class Overlap, class View>
struct expand_features {
    using pairs = pair_walk<Tree, Tree, Overlap>;
    using own_pairs = self_walk<Tree, Overlap>;
    struct item {
        std::uint32_t a, b;  ///< as of pair_walk
        feature_pair kind;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = pairs::most_children, most_depth = pairs::most_depth;
    static constexpr std::size_t most_shapes = pairs::most_shapes;
    static constexpr std::uint32_t nowhere = descent_path<Tree>::nowhere;

    trees_of_features<Tree> a, b;
    Overlap overlap;
    View both;
    seeds_below<pairs> vertex_face, face_vertex;
    seeds_below<std::conditional_t<Within, own_pairs, pairs>> edge_edge;
    std::size_t of_vertices = 0, of_faces = 0, of_edges = 0;  ///< seeds of each kind

    expand_features(const trees_of_features<Tree>& trees_a, const trees_of_features<Tree>& trees_b, const Overlap& near,
                    const View& view, int depth)
        : a(trees_a),
          b(trees_b),
          overlap(near),
          both(view),
          vertex_face(walk_of(feature_pair::vertex_face), depth),
          face_vertex(walk_of(feature_pair::face_vertex), depth),
          edge_edge(edge_walk(), depth) {
        if (has_nodes(feature_pair::vertex_face)) of_vertices = vertex_face.count();
        if (!Within && has_nodes(feature_pair::face_vertex)) of_faces = face_vertex.count();
        if (has_nodes(feature_pair::edge_edge)) of_edges = edge_edge.count();
    }

    /// A leaf alone has no place (traverse/pair_walk.hpp).
    [[nodiscard]] bool has_nodes(feature_pair kind) const {
        const std::size_t n = a.first(kind).size(), m = b.second(kind).size();
        return std::min(n, m) > 1 && std::max(n, m) <= most_shapes;
    }
    [[nodiscard]] std::size_t seeds() const { return of_vertices + of_faces + of_edges; }
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const {
        if (i < of_vertices) return item_of(feature_pair::vertex_face, vertex_face(i));
        if (i < of_vertices + of_faces) return item_of(feature_pair::face_vertex, face_vertex(i - of_vertices));
        return item_of(feature_pair::edge_edge, edge_edge(i - of_vertices - of_faces));
    }
    ABUT_INLINE void prefetch(const item& at) const { walk_of(at.kind).prefetch({at.a, at.b}); }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_INLINE ABUT_HD void operator()(const item& at, Emitter&& emitter) const {
        if (at.a == nowhere || at.b == nowhere) return;
        using sink = std::remove_reference_t<Emitter>;
        const add_features<item, sink> add{emitter, at.kind};
        const push_features<Within, sink, View> push{emitter, both, at.kind};
        if constexpr (Within) {
            const bool two = at.kind != feature_pair::edge_edge || at.a != at.b;
            own_pairs::expand(walk_of(at.kind), {at.a, at.b}, two, add, push);
        } else {
            walk_of(at.kind).expand({at.a, at.b}, add, push);
        }
    }

private:
    [[nodiscard]] ABUT_INLINE ABUT_HD pairs walk_of(feature_pair kind) const {
        return {a.first(kind), b.second(kind), overlap};
    }
    [[nodiscard]] auto edge_walk() const {
        if constexpr (Within) {
            return own_pairs(a.edges, overlap);
        } else {
            return walk_of(feature_pair::edge_edge);
        }
    }
    template <class Nodes>
    [[nodiscard]] ABUT_HD static item item_of(feature_pair kind, const Nodes& at) {
        return {at.a, at.b, kind};
    }
};

/// Where the queries of a step begin: at the roots, or at fronts (experimental/impact_fronts.hpp), of each kind.
struct no_fronts {};
struct given_fronts {
    front *vertex_face, *face_vertex, *edge_edge;
};

/// The pairs that a part of a search asks about, where it does not ask about all.
template <class Part, class Pairs>
auto asked_of_part(const Part& part, const Pairs& both) {
    if constexpr (requires { part.asked_of(both); }) {
        return part.asked_of(both);
    } else {
        return both;
    }
}

/// The features of two meshes, or `Within` one, that are asked about their pairs; as `pairing` of two operands.
template <bool Within, class Index, class Nearness, class Fronts, class Part = whole_search>
struct feature_pairing {
    using T = typename Index::scalar_type;
    using all_pairs = feature_pairs<T, typename Index::memory_space>;
    using view_type = decltype(asked_of_part(std::declval<const Part&>(), std::declval<const all_pairs&>()));
    static constexpr int depth_on_device = 6, depth_of_parts = 8;

    const Index &x, &y;
    view_type both;
    Nearness near;
    Fronts fronts;
    Part part;

    feature_pairing(const Index& of_x, const Index& of_y, const Nearness& how_near, const Fronts& from, const char* function,
                    const Part& of_all = {})
        : x(of_x),
          y(of_y),
          both(asked_of_part(of_all, all_pairs(features(of_x), features(of_y), Within, function))),
          near(how_near),
          fronts(from),
          part(of_all) {}

    [[nodiscard]] const view_type& view() const { return both; }

    /// Judges all pairs that come near each other, by loops that `run` runs: run(loop) with loop(judge, queues...).
    template <class Policy, class Run>
    void judge_candidates(const Policy& on, const Run& run) const {
        const auto trees_x = trees(x), trees_y = trees(y);
        const auto overlap = overlap_of();
        using tree = std::remove_cvref_t<decltype(trees_x.faces)>;
        using expand_type = expand_features<Within, tree, std::remove_const_t<decltype(overlap)>, view_type>;
        const expand_type expand(trees_x, trees_y, overlap, both, depth(host_policy<Policy> ? 0 : depth_on_device));
        if constexpr (std::same_as<Fronts, no_fronts>) {
            // Features in motion are crowded in places, and work is dealt out evenly again and again
            // (docs/results/motion.md).
            const execution::scheduled<schedule::static_partition> how{};
            const auto walk = [&](const auto& step) {
                run([&](const auto& judge, auto&... sinks) { return for_each_descendant(on, how, step, judge, sinks...); });
            };
            if (expand.seeds() > 0) {
                if constexpr (std::same_as<Part, whole_search>) {
                    walk(expand);
                } else {
                    walk(step_of_part(expand, part));
                }
            }
        }
        judge_kind<feature_pair::vertex_face>(on, expand, x.vertices(), y.faces(), both.a.vertices, run);
        if constexpr (!Within) judge_kind<feature_pair::face_vertex>(on, expand, x.faces(), y.vertices(), both.a.faces, run);
        judge_kind<feature_pair::edge_edge>(on, expand, x.edges(), y.edges(), both.a.edges, run);
    }

private:
    /// Deep enough that the hash deals out pairs of nodes evenly, where there are parts.
    [[nodiscard]] int depth(int of_whole) const {
        if constexpr (!std::same_as<Part, whole_search>) {
            if (part.parts > 1) return depth_of_parts;
        }
        return of_whole;
    }
    static features_of_mesh<T, typename Index::memory_space> features(const Index& of) {
        return {of.mesh(), of.edges().set()};
    }
    static auto trees(const Index& of) {
        return trees_of_features<decltype(of.faces().view())>{of.vertices().view(), of.faces().view(), of.edges().view()};
    }
    [[nodiscard]] auto overlap_of() const {
        using operand = indexed_operand<std::remove_cvref_t<decltype(x.faces())>>;
        return box_overlap(operand{x.faces()}, operand{y.faces()}, near);
    }

    /// Pairs of one kind that are not found by the walk of all.
    template <feature_pair Kind, class Policy, class Expand, class TreeX, class TreeY, class Rows, class Run>
    void judge_kind(const Policy& on, const Expand& expand, const TreeX& of_x, const TreeY& of_y, const Rows& rows,
                    const Run& run) const {
        constexpr bool of_one = Within && Kind == feature_pair::edge_edge;
        const ids_of_kind<view_type> ids{both, Kind};
        if (expand.has_nodes(Kind)) {
            if constexpr (!std::same_as<Fronts, no_fronts>) {
                const query_options<keep_all, traversal::from_front, schedule::static_partition> from{
                    .front = Kind == feature_pair::vertex_face   ? fronts.vertex_face
                             : Kind == feature_pair::face_vertex ? fronts.face_vertex
                                                                 : fronts.edge_edge};
                const auto walk_from = [&](const auto& walk, const auto& of_pairs) {
                    using walk_type = std::remove_cvref_t<decltype(walk)>;
                    const expand_pair<false, walk_type, std::remove_cvref_t<decltype(of_pairs)>> step{walk, of_pairs};
                    descend(on, indexed_operand<TreeX>{of_x}, indexed_operand<TreeY>{of_y}, step, from, run);
                };
                if constexpr (of_one) {
                    walk_from(typename Expand::own_pairs(of_x.view(), expand.overlap),
                              ids_in_order<ids_of_kind<view_type>>{ids});
                } else {
                    walk_from(typename Expand::pairs{of_x.view(), of_y.view(), expand.overlap}, ids);
                }
            }
        } else if (of_x.size() > 0 && of_y.size() > 0) {
            const auto walk = indexed_operand<TreeY>{of_y}.walk();
            if constexpr (of_one) {
                look<false>(on, walk, rows, ids_that_ascend<ids_of_kind<view_type>>{ids}, run, near, part);
            } else {
                look<false>(on, walk, rows, ids, run, near, part);
            }
        }
    }
};

}  // namespace abut::detail
