// SPDX-License-Identifier: MIT
#pragma once

// Pairs of features within one mesh, found by pairs of faces that share no vertex: those that lie apart. Of a mesh nearly
// all pairs of faces whose boxes overlap are of neighbours, which are then left out. A pair of features is told by the first
// pair of faces apart that has it. Those that no such pair has, orphans, are known from the faces alone: they are listed
// once, and looked at one by one. They are at borders, and around vertices with all faces nearby as in a fan or a
// tetrahedron.
//
// Each pair is told once. Let v be a vertex with faces T(v), and f a face without v. If all of T(v) share a vertex with f,
// then (v, f) is in the list, and no pair of faces tells it. If not, let t be the least of T(v) that does not. Any face of
// T(v) that is apart from f could tell; of these t alone does. Its box is around v's: so if the boxes of v and f overlap,
// those of t and f do, and the walk finds {t, f}, once. Two edges d < e likewise, with the least (t, s) of T(d) x T(e), t
// before s; as faces that share d or e are not apart, a pair of faces has d and e in one order alone.
//
// To be the first costs little: the face that a feature has been given to is the first of all, so a face tells of what it
// has been given without a question. Of its other features it tells only if the face that has been given them is not apart:
// each face knows the vertices of those (given_faces), so that few comparisons rule out nearly all others.

#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/experimental/representatives.hpp>

namespace abut::detail {

ABUT_HD inline bool are_apart(const corner_ids& f, const corner_ids& g) {
    bool apart = true;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) apart &= f.of[i] != g.of[j];
    }
    return apart;
}

/// Of a face, to whom its features have been given: the other two vertices of the face that has been given corner k, and the
/// third vertex of the one that has been given side k. Of its own features they are its own vertices.
struct alignas(16) given_faces {
    std::uint32_t of_corner[3][2], of_side[3];
};

struct write_given_faces {
    strided<face> faces;
    const face_part* parts;
    incidence_view vertices, edges;
    given_faces* out;
    ABUT_HD void operator()(std::size_t f) const {
        const corner_ids c = corners_of(faces, f);
        given_faces made{};
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = vertices.places[vertices.begin(c.of[k])];
            const corner_ids given = corners_of(faces, corner / 3);
            made.of_corner[k][0] = given.of[(corner + 1) % 3];
            made.of_corner[k][1] = given.of[(corner + 2) % 3];
            if (parts[f].edge[k] == 0xffffffff) continue;
            const std::uint32_t side = edges.places[edges.begin(parts[f].edge[k])];
            made.of_side[k] = corners_of(faces, side / 3).of[(side + 2) % 3];
        }
        out[f] = made;
    }
};

/// The rule (see tell_where_given).
struct tell_where_first_apart {
    static constexpr std::uint32_t none = 0xffffffff;
    struct two_faces {
        std::uint32_t t, s;
        [[nodiscard]] ABUT_HD bool are(std::uint32_t f, std::uint32_t g) const { return t == f && s == g; }
    };
    strided<face> faces;
    incidence_view vertices, edges;
    const given_faces* given;

    /// The first face of v that is apart from f, or none.
    [[nodiscard]] ABUT_HD std::uint32_t first_apart(std::uint32_t v, std::uint32_t f) const {
        const corner_ids of_f = corners_of(faces, f);
        for (std::uint32_t i = vertices.begin(v); i < vertices.end(v); ++i) {
            if (are_apart(corners_of(faces, vertices.face(i)), of_f)) return vertices.face(i);
        }
        return none;
    }
    /// The first faces of edges d and e that are apart.
    [[nodiscard]] ABUT_HD two_faces first_two_apart(std::uint32_t d, std::uint32_t e) const {
        for (std::uint32_t i = edges.begin(d); i < edges.end(d); ++i) {
            const corner_ids of_t = corners_of(faces, edges.face(i));
            for (std::uint32_t j = edges.begin(e); j < edges.end(e); ++j) {
                if (are_apart(of_t, corners_of(faces, edges.face(j)))) return {edges.face(i), edges.face(j)};
            }
        }
        return {none, none};
    }

    [[nodiscard]] ABUT_HD given_faces look_at(std::uint32_t f) const { return given[f]; }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool leaves_out(const Face& t, const Face& s) {
        return !are_apart(t.corners, s.corners);
    }
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell(const Face& t, int feature) {
        return t.part.is_new(feature);
    }
    /// The face that has been given the corner is t; or it is not apart from s. Of itself the corner is not of s.
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell_vertex(const Face& t, int k, const Face& s) {
        const std::uint32_t* const other = t.looked.of_corner[k];
        return t.part.has_been_given(k) || (t.part.is_new(k) && (s.has(other[0]) || s.has(other[1])));
    }
    /// The faces that have been given the sides are t and s; or they are not apart. Of themselves the sides are.
    template <class Face>
    [[nodiscard]] ABUT_HD static bool may_tell_edges(const Face& t, int k, const Face& s, int l) {
        const std::uint32_t x = t.looked.of_side[k], a = t.from(k), b = t.to(k);
        const std::uint32_t y = s.looked.of_side[l], c = s.from(l), d = s.to(l);
        const bool meet = (x == y) | (x == c) | (x == d) | (y == a) | (y == b);
        return both_given(t, k, s, l) || (t.part.is_new(side_features + k) && s.part.is_new(side_features + l) && meet);
    }
    template <class Face>
    [[nodiscard]] ABUT_HD bool tells_vertex(const Face& t, int k, const Face& s) const {
        return t.part.has_been_given(k) || first_apart(t.corners.of[k], s.id) == t.id;
    }
    template <class Face>
    [[nodiscard]] ABUT_HD bool tells_edges(const Face& t, int k, const Face& s, int l) const {
        if (both_given(t, k, s, l)) return true;
        const std::uint32_t d = t.part.edge[k], e = s.part.edge[l];
        return d < e ? first_two_apart(d, e).are(t.id, s.id) : first_two_apart(e, d).are(s.id, t.id);
    }

private:
    template <class Face>
    [[nodiscard]] ABUT_HD static bool both_given(const Face& t, int k, const Face& s, int l) {
        return t.part.has_been_given(side_features + k) && s.part.has_been_given(side_features + l);
    }
};

/// The pairs of features of one mesh that no two faces apart have, as keys, ascending.
template <memory_space Space>
struct orphan_pairs {
    feature_incidences<Space> faces_of;
    shared_array<given_faces, Space> given;
    shared_array<std::uint64_t, Space> keys;

    [[nodiscard]] tell_where_first_apart rule(const strided<face>& faces) const {
        return {faces, faces_of.vertices.view(), faces_of.edges.view(), given.data()};
    }
};

/// Finds the orphans among the features that have been given to face t and its neighbours. An orphan's features have been
/// given to faces that are not apart.
struct find_orphans {
    tell_where_first_apart rule;
    const face_part* parts;
    strided<edge> edges;
    feature_key key;

    ABUT_CALLS_ANY
    template <class Found>
    ABUT_HD void operator()(std::size_t i, Found& found) const {
        const auto t = static_cast<std::uint32_t>(i);
        const corner_ids of_t = corners_of(rule.faces, t);
        const face_part part = parts[t];
        for (int k = 0; k < 3; ++k) {
            if (!part.is_new(k)) continue;
            const std::uint32_t w = of_t.of[k];
            for (std::uint32_t at = rule.vertices.begin(w); at < rule.vertices.end(w); ++at) {
                const std::uint32_t s = rule.vertices.face(at);
                if (s != t && is_met_first(of_t, k, at, s)) look_at(of_t, part, s, found);
            }
        }
    }

private:
    /// Whether a neighbour has not been met before, by a lower corner or as the same corner twice.
    [[nodiscard]] ABUT_HD bool is_met_first(const corner_ids& of_t, int k, std::uint32_t at, std::uint32_t s) const {
        if (at > rule.vertices.begin(of_t.of[k]) && rule.vertices.face(at - 1) == s) return false;
        const corner_ids of_s = corners_of(rule.faces, s);
        for (int before = 0; before < k; ++before) {
            if (has(of_s, of_t.of[before])) return false;
        }
        return true;
    }
    [[nodiscard]] ABUT_HD static bool has(const corner_ids& c, std::uint32_t v) {
        return (v == c.of[0]) | (v == c.of[1]) | (v == c.of[2]);
    }
    ABUT_CALLS_ANY
    template <class Found>
    ABUT_HD void look_at(const corner_ids& of_t, const face_part& part, std::uint32_t s, Found& found) const {
        constexpr auto none = tell_where_first_apart::none;
        const corner_ids of_s = corners_of(rule.faces, s);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = of_t.of[k];
            if (part.has_been_given(k) && !has(of_s, v) && rule.first_apart(v, s) == none) {
                found.push(key.pack(feature_pair::vertex_face, v, s));
            }
        }
        const face_part other = parts[s];
        for (int k = 0; k < 3; ++k) {
            if (!part.has_been_given(side_features + k)) continue;
            const std::uint32_t d = part.edge[k];
            for (int l = 0; l < 3; ++l) {
                const std::uint32_t e = other.edge[l];
                if (other.has_been_given(side_features + l) && d < e &&
                    share_no_vertex(corners_at(edges, d), corners_at(edges, e)) && rule.first_two_apart(d, e).t == none) {
                    found.push(key.pack(feature_pair::edge_edge, d, e));
                }
            }
        }
    }
};

/// The orphans of faces, in the policy's memory. Time is as the sum of the squares of the numbers of faces that vertices
/// have, and a fan of n faces has about n^2 orphans.
template <class Policy, class View>
orphan_pairs<space_of<Policy>> make_orphans(const Policy& on, const View& both, const face_parts<space_of<Policy>>& parts,
                                            feature_incidences<space_of<Policy>> faces_of) {
    const strided<face> faces = both.a.faces.t0.faces;
    orphan_pairs<space_of<Policy>> made{std::move(faces_of), {}, {}};
    execution::buffer_of<Policy, given_faces> given(on, faces.count);
    for_each_index(on, faces.count,
                   write_given_faces{faces, parts.parts.data(), made.faces_of.vertices.view(), made.faces_of.edges.view(),
                                     given.data()});
    made.given = shared_array<given_faces, space_of<Policy>>(std::move(given));
    key_queue<Policy> found(on, 2 * faces.count);
    for_each_index(on, faces.count, find_orphans{made.rule(faces), parts.parts.data(), both.a.edges.t0.edges, both.key},
                   found);
    auto keys = found.take();
    sort_keys(on, keys, both.key.bits());
    synchronize(on);
    made.keys = shared_array<std::uint64_t, space_of<Policy>>(std::move(keys));
    return made;
}

/// Whether the boxes of two features come near each other.
template <class Overlap>
struct boxes_are_near {
    Overlap near;
    template <class S, class U>
    ABUT_HD bool operator()(const S& s, const U& t) const {
        return near(bounds(s), bounds(t));
    }
};
/// Hands on orphans whose boxes do; times them where they are found, on a host.
template <class View, class Overlap>
struct gather_orphan {
    View both;
    boxes_are_near<Overlap> near;
    const std::uint64_t* keys;
    ABUT_CALLS_ANY
    template <class Vertices, class Edges>
    ABUT_HD void operator()(std::size_t i, Vertices& vertices, Edges& edges) const {
        if (both.with_shapes(keys[i], near)) push_by_kind<Vertices, Edges>{both.key, vertices, edges}.push(keys[i]);
    }
};
template <class View, class Judge, class Overlap>
struct time_orphan {
    time_at_once<View, Judge> judge;
    boxes_are_near<Overlap> near;
    const std::uint64_t* keys;
    template <class Hits>
    void operator()(std::size_t i, Hits& hits) const {
        if (judge.both.with_shapes(keys[i], near)) time_pushed<View, Judge, Hits>{judge, hits}.push(keys[i]);
    }
};

template <class Policy, class View, class Judge, class Overlap>
void time_orphans(const Policy& on, const View& both, const shared_array<std::uint64_t, space_of<Policy>>& orphans,
                  const Judge& judge, const Overlap& near, timed_queue<Policy>& hits) {
    if constexpr (host_policy<Policy>) {
        for_each_index(on, orphans.size(), time_orphan<View, Judge, Overlap>{{both, judge}, {near}, orphans.data()}, hits);
    } else {
        key_queue<Policy> vertices(on, orphans.size()), edges(on, orphans.size());
        for_each_index(on, orphans.size(), gather_orphan<View, Overlap>{both, {near}, orphans.data()}, vertices, edges);
        time_candidates(on, both, judge, in_two_queues(vertices, edges), hits);
    }
}

}  // namespace abut::detail
