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
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/features.hpp>
#include <abut/collide/keys.hpp>
#include <abut/collide/pair_rule.hpp>
#include <abut/collide/routes.hpp>
#include <abut/collide/timed_search.hpp>
#include <abut/experimental/face_parts.hpp>
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

/// Hands on the pairs of features that two faces tell, by their numbers. `Within` one mesh no pair has a vertex in common.
/// `near` compares their boxes as those of trees are compared.
template <bool Within, class V, class Rule, class Overlap>
struct expand_faces {
    using T = typename V::scalar_type;
    using swept = swept_face<T>;
    using seen = seen_face<decltype(std::declval<const Rule&>().look_at(0))>;
    faces_with_parts<V> a, b;
    pair_key faces;
    feature_key keys;
    Rule rule;
    Overlap near;

    ABUT_CALLS_ANY
    template <class Found>
    ABUT_HD void operator()(std::uint64_t key, Found& found) const {
        const seen t = look_at(a, faces.a(key)), s = look_at(b, faces.b(key));
        if (rule.leaves_out(t, s)) return;
        const swept at_t = a.swept(t.corners), at_s = b.swept(s.corners);
        for (int k = 0; k < 3; ++k) {
            if (has_vertex(t, at_t, k, s, at_s)) found.push(keys.pack(feature_pair::vertex_face, t.corners.of[k], s.id));
        }
        for (int k = 0; k < 3; ++k) {
            if (!has_vertex(s, at_s, k, t, at_t)) continue;
            found.push(Within ? keys.pack(feature_pair::vertex_face, s.corners.of[k], t.id)
                              : keys.pack(feature_pair::face_vertex, t.id, s.corners.of[k]));
        }
        for (int k = 0; k < 3; ++k) {
            if (!rule.may_tell(t, side_features + k) || !near(at_t.edge[k], at_s.face)) continue;
            for (int l = 0; l < 3; ++l) {
                if (!has_edges(t, at_t, k, s, at_s, l)) continue;
                const std::uint32_t d = t.part.edge[k], e = s.part.edge[l];
                const bool turn = Within && e < d;
                found.push(keys.pack(feature_pair::edge_edge, turn ? e : d, turn ? d : e));
            }
        }
    }
    [[nodiscard]] ABUT_HD bool leaves_out(std::uint64_t key) const {
        return rule.leaves_out(look_at(a, faces.a(key)), look_at(b, faces.b(key)));
    }
    ABUT_INLINE void prefetch(std::uint64_t key, int step) const {
        a.faces.prefetch(faces.a(key), step);
        b.faces.prefetch(faces.b(key), step);
        if (step == 0) ABUT_PREFETCH(a.parts + faces.a(key)), ABUT_PREFETCH(b.parts + faces.b(key));
    }

private:
    [[nodiscard]] ABUT_HD seen look_at(const faces_with_parts<V>& of, std::uint32_t f) const {
        return {f, corners_of(of.faces.t0.faces, f), of.parts[f], rule.look_at(f)};
    }
    [[nodiscard]] ABUT_HD bool has_vertex(const seen& t, const swept& at_t, int k, const seen& s, const swept& at_s) const {
        return rule.may_tell_vertex(t, k, s) && near(at_t.vertex[k], at_s.face) && !(Within && s.has(t.corners.of[k])) &&
               rule.tells_vertex(t, k, s);
    }
    [[nodiscard]] ABUT_HD bool has_edges(const seen& t, const swept& at_t, int k, const seen& s, const swept& at_s,
                                         int l) const {
        if (!rule.may_tell_edges(t, k, s, l) || !near(at_t.edge[k], at_s.edge[l])) return false;
        if constexpr (Within) {
            const std::uint32_t v = t.from(k), w = t.to(k), x = s.from(l), y = s.to(l);
            if ((v == x) | (v == y) | (w == x) | (w == y)) return false;
        }
        return rule.tells_edges(t, k, s, l);
    }
};

// --- from features to what is found ------------------------------------------------------------------------------------

/// The features of pairs of faces that have been gathered, by their kinds.
template <class Expand>
struct gather_features_of {
    Expand expand;
    const std::uint64_t* pairs;
    ABUT_CALLS_ANY
    template <class Vertices, class Edges>
    ABUT_HD void operator()(std::size_t i, Vertices& vertices, Edges& edges) const {
        const push_by_kind<Vertices, Edges> found{expand.keys, vertices, edges};
        expand(pairs[i], found);
    }
};
/// A judge of pairs of faces that times their features at once, on a host.
template <class Expand, class View, class Judge>
struct time_features {
    Expand expand;
    time_at_once<View, Judge> judge;

    template <class Hits>
    bool operator()(std::uint64_t key, Hits& hits) const {
        const time_pushed<View, Judge, Hits> found{judge, hits};
        expand(key, found);
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
/// Vertices of no face look for faces: those of a, or with RowsAreB of b.
template <bool RowsAreB, class View>
struct ids_of_chosen {
    View both;
    const std::uint32_t* which;
    [[nodiscard]] ABUT_HD std::uint64_t pack(std::uint32_t i, std::uint32_t j) const {
        return RowsAreB ? both.key.pack(feature_pair::face_vertex, i, which[j])
                        : both.key.pack(feature_pair::vertex_face, which[i], j);
    }
    [[nodiscard]] ABUT_HD static constexpr bool wanted(std::uint32_t, std::uint32_t) { return true; }
};
template <bool RowsAreB, class Policy, class View, class Tree, class Judge, class Nearness>
void time_loose(const Policy& on, const View& both, const shared_array<std::uint32_t, space_of<Policy>>& loose,
                const Tree& faces, const Judge& judge, const Nearness& near_enough, timed_queue<Policy>& hits) {
    if (loose.size() == 0 || faces.size() == 0) return;
    const auto vertices = RowsAreB ? both.b.vertices : both.a.vertices;
    const chosen_view<std::remove_const_t<decltype(vertices)>> rows{vertices, loose.data(), loose.size()};
    const ids_of_chosen<RowsAreB, View> ids{both, loose.data()};
    const auto look_all = [&](const auto& run) {
        look<RowsAreB>(on, indexed_operand<Tree>{faces}.walk(), rows, ids, run, near_enough);
    };
    if constexpr (host_policy<Policy>) {
        const time_at_once<View, Judge> time{both, judge};
        look_all([&](const auto& loop) { loop(time, hits); });
    } else {
        auto room = room_for_candidates(on, std::max(loose.size(), faces.size()), std::size_t{1} << 24);
        std::size_t count = 0;
        gather_in_parts(
            room.size(), [&](part_of_open part) { return count = gather_one_kind(on, look_all, part, room); },
            [&] {
                time_candidates(on, both, judge, {room.data(), nullptr, count, 0}, hits);
            });
    }
}

/// Leaves in `hits` what a judge times of the features of faces that come near each other. On a device pairs of faces are
/// gathered by a walk, 2^24 at most at a time; then come their features whose boxes overlap, 15 of each at most, and two as
/// a rule; and then, with full warps, these are judged.
template <class Policy, class Pairing, class Expand, class View, class Judge>
void time_faces(const Policy& on, const Pairing& pairing, const Expand& expand, const View& both, const Judge& judge,
                timed_queue<Policy>& hits) {
    static_assert(feature_judge<Judge, View>, "abut: time_faces: the judge is no timing_judge of pairs of features");
    if constexpr (host_policy<Policy>) {
        const time_features<Expand, View, Judge> time{expand, {both, judge}};
        pairing.judge_candidates(on, [&](const auto& loop) { loop(time, hits); });
    } else {
        auto room = room_for_candidates(on, std::max(expand.a.faces.size(), expand.b.faces.size()), std::size_t{1} << 24);
        std::size_t count = 0;
        const auto find_faces = [&](const auto& run) { pairing.judge_candidates(on, run); };
        const auto gather_faces = [&](part_of_open part) { return count = gather_one_kind(on, find_faces, part, room); };
        gather_in_parts(room.size(), gather_faces, [&] {
            key_queue<Policy> vertices(on, count), edges(on, count);
            for_each_index(on, count, gather_features_of<Expand>{expand, room.data()}, vertices, edges);
            time_candidates(on, both, judge, in_two_queues(vertices, edges), hits);
        });
    }
}

}  // namespace abut::detail
