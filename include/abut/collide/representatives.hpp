// SPDX-License-Identifier: MIT
#pragma once

// Pairs of features found by pairs of faces: of two faces whose boxes overlap, those features meet that a rule tells there,
// and whose own boxes overlap. The rule of representatives: each vertex and each edge is given to the first of its faces,
// and is told where that face is. So each pair of features is told by one pair of faces, whose boxes overlap if those of the
// features do. The other rule is in orphan_sets.hpp.
//
// Two features of one face share a vertex, so no face has to be paired with itself. Vertices of no face look in the tree
// over faces one by one.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/collide/face_parts.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/pairing.hpp>
#include <abut/collide/search.hpp>
#include <abut/collide/self_pairing.hpp>
#include <abut/shape/motion.hpp>

namespace abut::detail {

// --- from two faces to their features ----------------------------------------------------------------------------------

/// A face in motion by the boxes of its features.
template <scalar T>
struct swept_face {
    aabb<T> vertex[3], edge[3], face;
};

/// Moving faces, and what they know of their features.
template <class V>
struct faces_with_parts {
    using T = typename V::scalar_type;
    V faces;
    const face_part* parts;

    [[nodiscard]] ABUT_HD swept_face<T> swept(const corner_ids& c) const {
        swept_face<T> made;
        for (int k = 0; k < 3; ++k) {
            made.vertex[k] = bounds(segment<T>{faces.t0.vertices[c.of[k]], faces.t1.vertices[c.of[k]]});
        }
        for (int k = 0; k < 3; ++k) made.edge[k] = merge(made.vertex[k], made.vertex[(k + 1) % 3]);
        made.face = merge(made.edge[0], made.vertex[2]);
        return made;
    }
};

/// The numbers of pairs of features, as those of trees over features are.
struct feature_keys {
    pair_key vertex_face, face_vertex, edge_edge;
};

/// The rule of representatives. A rule has, of faces t and s of two meshes or of one:
///   look_at(f)                     what it wants to know of face f
///   leaves_out(t, s)               whether it is not for these faces to tell of anything
///   may_tell(t, feature)           whether t may tell of one of its features at all; a short test, as the next two
///   may_tell_vertex(t, k, s)       whether both may tell of corner k of t and the face s
///   may_tell_edges(t, k, s, l)     and of side k of t and side l of s
///   tells_vertex(t, k, s)          whether they do: asked of those that may, whose boxes overlap, and that share no vertex
///   tells_edges(t, k, s, l)
struct tell_where_given {
    struct nothing {};
    [[nodiscard]] ABUT_HD static nothing look_at(std::uint32_t) { return {}; }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool leaves_out(const Face&, const Face&) {
        return false;
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell(const Face& t, int feature) {
        return t.part.has_been_given(feature);
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell_vertex(const Face& t, int k, const Face&) {
        return t.part.has_been_given(k);
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell_edges(const Face& t, int k, const Face& s, int l) {
        return t.part.has_been_given(side_features + k) && s.part.has_been_given(side_features + l);
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool tells_vertex(const Face&, int, const Face&) {
        return true;
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool tells_edges(const Face&, int, const Face&, int) {
        return true;
    }
};

/// A face as a rule sees it.
template <class Looked>
struct seen_face {
    std::uint32_t id;
    corner_ids corners;
    face_part part;
    Looked looked;

    [[nodiscard]] ABUT_HD bool has(std::uint32_t v) const {
        return (v == corners.of[0]) | (v == corners.of[1]) | (v == corners.of[2]);
    }
    /// The vertices of side k.
    [[nodiscard]] ABUT_HD std::uint32_t from(int k) const { return corners.of[k]; }
    [[nodiscard]] ABUT_HD std::uint32_t to(int k) const { return corners.of[(k + 1) % 3]; }
};

/// Hands on the pairs of features that two faces tell: each(kind, key), of a constant and a number. In self queries (`Self`)
/// the two are faces of one mesh, and no pair has a vertex in common. `near` compares their boxes as those of trees are
/// compared.
template <bool Self, class V, class Rule, class Overlap>
struct expand_faces {
    static constexpr bool is_self = Self;
    using T = typename V::scalar_type;
    using swept = swept_face<T>;
    using seen = seen_face<decltype(std::declval<const Rule&>().look_at(0))>;
    faces_with_parts<V> a, b;
    pair_key faces;
    feature_keys keys;
    Rule rule;
    Overlap near;

    ABUT_CALLS_ANY
    template <class Each>
    ABUT_HD void operator()(std::uint64_t key, const Each& each) const {
        const seen t = look_at(a, faces.a(key)), s = look_at(b, faces.b(key));
        if (rule.leaves_out(t, s)) return;
        const swept at_t = a.swept(t.corners), at_s = b.swept(s.corners);
        for (int k = 0; k < 3; ++k) {
            if (has_vertex(t, at_t, k, s, at_s)) {
                each(kind<feature_pair::vertex_face>{}, keys.vertex_face.pack(t.corners.of[k], s.id));
            }
        }
        for (int k = 0; k < 3; ++k) {
            if (!has_vertex(s, at_s, k, t, at_t)) continue;
            if constexpr (Self) {
                each(kind<feature_pair::vertex_face>{}, keys.vertex_face.pack(s.corners.of[k], t.id));
            } else {
                each(kind<feature_pair::face_vertex>{}, keys.face_vertex.pack(t.id, s.corners.of[k]));
            }
        }
        for (int k = 0; k < 3; ++k) {
            if (!rule.may_tell(t, side_features + k) || !near(at_t.edge[k], at_s.face)) continue;
            for (int l = 0; l < 3; ++l) {
                if (!has_edges(t, at_t, k, s, at_s, l)) continue;
                const std::uint32_t d = t.part.edge[k], e = s.part.edge[l];
                each(kind<feature_pair::edge_edge>{}, Self && e < d ? keys.edge_edge.pack(e, d) : keys.edge_edge.pack(d, e));
            }
        }
    }
    [[nodiscard]] ABUT_HD bool leaves_out(std::uint64_t key) const {
        return rule.leaves_out(look_at(a, faces.a(key)), look_at(b, faces.b(key)));
    }
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const {
        a.faces.prefetch(faces.a(key), step);
        b.faces.prefetch(faces.b(key), step);
        if (step == 0) __builtin_prefetch(a.parts + faces.a(key)), __builtin_prefetch(b.parts + faces.b(key));
    }

private:
    template <feature_pair Kind>
    using kind = std::integral_constant<feature_pair, Kind>;

    [[nodiscard]] ABUT_HD seen look_at(const faces_with_parts<V>& of, std::uint32_t f) const {
        return {f, corners_of(of.faces.t0.faces, f), of.parts[f], rule.look_at(f)};
    }
    [[nodiscard]] ABUT_HD bool has_vertex(const seen& t, const swept& at_t, int k, const seen& s, const swept& at_s) const {
        return rule.may_tell_vertex(t, k, s) && near(at_t.vertex[k], at_s.face) && !(Self && s.has(t.corners.of[k])) &&
               rule.tells_vertex(t, k, s);
    }
    [[nodiscard]] ABUT_HD bool has_edges(const seen& t, const swept& at_t, int k, const seen& s, const swept& at_s,
                                         int l) const {
        if (!rule.may_tell_edges(t, k, s, l) || !near(at_t.edge[k], at_s.edge[l])) return false;
        if constexpr (Self) {
            const std::uint32_t v = t.from(k), w = t.to(k), x = s.from(l), y = s.to(l);
            if ((v == x) | (v == y) | (w == x) | (w == y)) return false;
        }
        return rule.tells_edges(t, k, s, l);
    }
};

// --- from features to what is found ------------------------------------------------------------------------------------

/// Reports a pair of features to the sink of its kind.
template <class VertexFace, class FaceVertex, class EdgeEdge>
struct report_features {
    VertexFace& vertex_face;
    FaceVertex& face_vertex;
    EdgeEdge& edge_edge;

    ABUT_CALLS_ANY
    template <feature_pair Kind>
    ABUT_HD void operator()(std::integral_constant<feature_pair, Kind>, std::uint64_t key) const {
        if constexpr (Kind == feature_pair::vertex_face) {
            report(vertex_face, key);
        } else if constexpr (Kind == feature_pair::face_vertex) {
            report(face_vertex, key);
        } else {
            report(edge_edge, key);
        }
    }
};

/// Takes what is decided at once, on a host, before it is reported.
template <class Judge, class Hits>
struct decide_at_once {
    const Judge& judge;
    Hits& hits;
    void push(std::uint64_t key) const {
        if (!judge(key, hits)) judge.finish(key, hits);
    }
};

/// A judge of pairs of faces that looks at all of their features, and leaves those that it finds in sinks of their kinds, of
/// which self queries have no second one.
template <class Expand>
struct gather_features {
    Expand expand;

    ABUT_CALLS_ANY
    template <class VertexFace, class EdgeEdge>
    ABUT_HD bool operator()(std::uint64_t key, VertexFace& vertex_face, EdgeEdge& edge_edge) const {
        expand(key, report_features<VertexFace, VertexFace, EdgeEdge>{vertex_face, vertex_face, edge_edge});
        return true;
    }
    ABUT_CALLS_ANY
    template <class VertexFace, class FaceVertex, class EdgeEdge>
    ABUT_HD bool operator()(std::uint64_t key, VertexFace& vertex_face, FaceVertex& face_vertex, EdgeEdge& edge_edge) const {
        expand(key, report_features<VertexFace, FaceVertex, EdgeEdge>{vertex_face, face_vertex, edge_edge});
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const { expand.prefetch(key, step); }
};
/// The same of pairs of faces that have been gathered.
template <class Expand>
struct gather_features_of {
    gather_features<Expand> gather;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class... Sinks>
    ABUT_HD void operator()(std::size_t i, Sinks&... sinks) const {
        gather(keys[i], sinks...);
    }
};

/// The views of pairs of features by their keys.
template <class VertexFace, class FaceVertex, class EdgeEdge>
struct views_of_features {
    VertexFace vertex_face;
    FaceVertex face_vertex;
    EdgeEdge edge_edge;

    [[nodiscard]] feature_keys keys() const { return {vertex_face.key, face_vertex.key, edge_edge.key}; }
};

/// A judge of pairs of faces that decides their features at once, on a host.
template <class Expand, class Views, class Judge>
struct decide_features {
    Expand expand;
    judge_key<decltype(Views::vertex_face), Judge> vertex_face;
    judge_key<decltype(Views::face_vertex), Judge> face_vertex;
    judge_key<decltype(Views::edge_edge), Judge> edge_edge;

    decide_features(const Expand& faces, const Views& views, const Judge& judge)
        : expand(faces),
          vertex_face{views.vertex_face, judge, {}},
          face_vertex{views.face_vertex, judge, {}},
          edge_edge{views.edge_edge, judge, {}} {}

    template <class Hits>
    bool operator()(std::uint64_t key, Hits& of_vertices, Hits& of_edges) const {
        return (*this)(key, of_vertices, of_vertices, of_edges);
    }
    template <class Hits>
    bool operator()(std::uint64_t key, Hits& of_vertices, Hits& of_faces, Hits& of_edges) const {
        using v = decide_at_once<decltype(vertex_face), Hits>;
        using f = decide_at_once<decltype(face_vertex), Hits>;
        using e = decide_at_once<decltype(edge_edge), Hits>;
        const v to_vertices{vertex_face, of_vertices};
        const f to_faces{face_vertex, of_faces};
        const e to_edges{edge_edge, of_edges};
        expand(key, report_features<const v, const f, const e>{to_vertices, to_faces, to_edges});
        return true;
    }
    void finish(std::uint64_t, auto&...) const {}
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const { expand.prefetch(key, step); }
};

/// Some of the shapes of a view.
template <class V>
struct chosen_view {
    using scalar_type = typename V::scalar_type;
    using shape_type = typename V::shape_type;
    using memory_space = typename V::memory_space;
    V all;
    const std::uint32_t* which;
    std::size_t count;
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    [[nodiscard]] ABUT_HD shape_type operator[](std::size_t i) const { return all[which[i]]; }
};
template <bool RowsAreB, class View>
struct ids_of_chosen {
    View both;
    const std::uint32_t* which;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t i, std::uint32_t j) const {
        return RowsAreB ? both.pack(i, which[j]) : both.pack(which[i], j);
    }
    [[nodiscard]] ABUT_HD static constexpr bool wanted(std::uint32_t, std::uint32_t) { return true; }
};

/// Vertices of no face look for faces: the first operand of `both` is the vertices, or with RowsAreB the second.
template <bool RowsAreB, class Policy, class View, class Tree, class Judge, class Nearness>
void find_loose(const Policy& on, const View& both, const shared_array<std::uint32_t, space_of<Policy>>& loose,
                const Tree& faces, const Judge& judge, const Nearness& near_enough, key_queue<Policy>& hits) {
    if (loose.size() == 0 || faces.size() == 0) return;
    const auto run_over = [&](const auto& vertices, const auto& run) {
        const chosen_view<std::remove_cvref_t<decltype(vertices)>> rows{vertices, loose.data(), loose.size()};
        const ids_of_chosen<RowsAreB, View> ids{both, loose.data()};
        look<RowsAreB>(on, indexed_operand<Tree>{faces}.walk(), rows, ids, run, near_enough);
    };
    const auto look_all = [&](const auto& run) { RowsAreB ? run_over(both.b, run) : run_over(both.a, run); };
    if constexpr (host_policy<Policy>) {
        const judge_key<View, Judge> decide{both, judge, {}};
        look_all([&](const auto& loop) { loop(decide, hits); });
    } else {
        key_queue<Policy> near(on);
        look_all([&](const auto& loop) { loop(gather_candidate{}, near); });
        judge_gathered(on, both, judge, near.data(), near.size(), hits);
    }
}

/// On a device: pairs of faces are gathered by a walk; then come their features whose boxes overlap, and then, with full
/// warps, what the judge's first try says of these. Where more pairs of faces are found than may be gathered, it goes on
/// with parts of them. pass(n, gather) takes n pairs of faces, of which `gather`, the functor of a loop, hands on the
/// features.
template <class Policy, class Pairing, class Expand, class Pass>
void expand_gathered(const Policy& on, const Pairing& pairing, const Expand& expand, part_of_open part,
                     execution::buffer_of<Policy, std::uint64_t>& room, const Pass& pass) {
    const std::size_t count = gather_part(on, pairing, part, room);
    if (count <= room.size()) {
        pass(count, gather_features_of<Expand>{{expand}, room.data()});
        return;
    }
    const auto more = static_cast<std::uint32_t>(2 * count / room.size() + 1);
    for (std::uint32_t k = 0; k < more; ++k) expand_gathered(on, pairing, expand, part.split(k, more), room, pass);
}

/// Pairs of faces that a device gathers at a time: 64 for each face, 64 MiB of them at least and 512 at most.
template <class Policy>
auto room_for_faces(const Policy& on, std::size_t faces) {
    return execution::buffer_of<Policy, std::uint64_t>(on, std::clamp(64 * faces, least_gathered, most_gathered));
}

/// Queues of pairs of features, by their kinds.
template <class Policy>
using feature_queues = std::array<key_queue<Policy>, 3>;

/// Runs a loop with the queues of features that there are.
template <bool Self, class Policy, class Loop>
void with_queues(feature_queues<Policy>& queues, const Loop& loop) {
    if constexpr (Self) {
        loop(queues[0], queues[2]);
    } else {
        loop(queues[0], queues[1], queues[2]);
    }
}

/// Leaves in `hits` what a judge finds of the features of faces that come near each other.
template <class Policy, class Pairing, class Expand, class Views, class Judge>
void search_features(const Policy& on, const Pairing& pairing, const Expand& expand, const Views& views, const Judge& judge,
                     feature_queues<Policy>& hits) {
    constexpr bool self = Expand::is_self;
    if constexpr (host_policy<Policy>) {
        const decide_features<Expand, Views, Judge> decide(expand, views, judge);
        pairing.judge_candidates(on, [&](const auto& loop) {
            with_queues<self, Policy>(hits, [&](auto&... queues) { loop(decide, queues...); });
        });
    } else {
        auto room = room_for_faces(on, std::max(expand.a.faces.size(), expand.b.faces.size()));
        expand_gathered(on, pairing, expand, {}, room, [&](std::size_t count, const auto& gather) {
            feature_queues<Policy> near{key_queue<Policy>(on, count), key_queue<Policy>(on, self ? 1 : count),
                                        key_queue<Policy>(on, count)};
            with_queues<self, Policy>(near, [&](auto&... queues) { for_each_index(on, count, gather, queues...); });
            const auto judge_all = [&](const auto& both, std::size_t kind) {
                judge_gathered(on, both, judge, near[kind].data(), near[kind].size(), hits[kind]);
            };
            judge_all(views.vertex_face, 0);
            if constexpr (!self) judge_all(views.face_vertex, 1);
            judge_all(views.edge_edge, 2);
        });
    }
}

}  // namespace abut::detail
