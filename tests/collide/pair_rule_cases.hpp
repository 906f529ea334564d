// SPDX-License-Identifier: MIT
#pragma once

// What the rules of pairs promise on every policy: the impacts of all are the same, bit for bit; each pair of features whose
// boxes overlap, and that shares no vertex, is tested once, as a plain loop over all features says; and orphans are the
// pairs that a plain loop over all faces finds. Of meshes with all that makes orphans, and all that is no manifold.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/pair_rules.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

/// Faces over so many vertices.
struct topology {
    std::string name;
    std::uint32_t vertices;
    std::vector<face> faces;
};

/// n triangles around vertex 0, the last and the first of which share an edge or not.
inline topology fan(std::uint32_t n, bool closed) {
    topology made{closed ? "closed fan" : "open fan", closed ? n + 1 : n + 2, {}};
    for (std::uint32_t i = 0; i < n; ++i) made.faces.push_back({0, i + 1, closed && i + 1 == n ? 1 : i + 2});
    return made;
}
inline topology strip(std::uint32_t n) {
    topology made{"strip", n + 2, {}};
    for (std::uint32_t i = 0; i < n; ++i) made.faces.push_back({i, i + 1, i + 2});
    return made;
}
inline topology sheet(std::uint32_t n) {
    topology made{"sheet", (n + 1) * (n + 1), {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            made.faces.push_back({a, b, b + 1});
            made.faces.push_back({a, b + 1, a + 1});
        }
    }
    return made;
}
/// n faces around one edge.
inline topology book(std::uint32_t n) {
    topology made{"book", n + 2, {}};
    for (std::uint32_t i = 0; i < n; ++i) made.faces.push_back({0, 1, i + 2});
    return made;
}
/// Faces over vertices drawn at random: edges of many faces, faces that name a vertex twice, faces that occur twice.
inline topology any_faces(std::uint32_t vertices, std::size_t faces, std::uint64_t seed) {
    uniform random(seed);
    topology made{"any faces", vertices, {}};
    const auto v = [&] { return static_cast<std::uint32_t>(random.below(vertices)); };
    for (std::size_t f = 0; f < faces; ++f) {
        const std::uint32_t a = v(), b = v(), c = v();
        made.faces.push_back({a, b, f % 7 == 0 ? a : c});
        if (f % 11 == 0) made.faces.push_back({c, a, b});
    }
    return made;
}
/// Two, side by side, with a vertex of no face between them.
inline topology beside(const topology& a, const topology& b) {
    topology made{a.name + " beside " + b.name, a.vertices + 1 + b.vertices, a.faces};
    for (const face& f : b.faces) {
        made.faces.push_back({f[0] + a.vertices + 1, f[1] + a.vertices + 1, f[2] + a.vertices + 1});
    }
    return made;
}

inline std::vector<topology> all_topologies() {
    const topology tetrahedron{"tetrahedron", 4, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    const topology pyramid{"pyramid", 5, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 3, 2}, {1, 4, 3}}};
    const torus<float> ring(7, 6, 3, 1);
    std::vector<topology> all{{"nothing", 0, {}},
                              {"vertices alone", 5, {}},
                              {"one face", 3, {{0, 1, 2}}},
                              {"one face and a vertex", 4, {{0, 1, 3}}},
                              {"one point", 3, {{1, 1, 1}}},
                              {"needles", 6, {{0, 1, 1}, {2, 3, 2}, {4, 4, 5}, {0, 2, 4}}},
                              {"two faces", 6, {{0, 1, 2}, {3, 4, 5}}},
                              {"one face twice", 4, {{0, 1, 2}, {2, 1, 0}}},
                              tetrahedron,
                              pyramid,
                              fan(9, false),
                              fan(9, true),
                              strip(12),
                              book(5),
                              sheet(6),
                              {"torus", static_cast<std::uint32_t>(ring.vertices.size()), ring.faces},
                              beside(tetrahedron, pyramid),
                              beside(fan(6, true), book(4)),
                              beside(sheet(3), strip(5))};
    for (const std::uint32_t n : {5u, 9u, 20u, 40u}) all.push_back(any_faces(n, 30, 20270301 + n));
    all.push_back(beside(any_faces(30, 25, 20270302), sheet(4)));
    return all;
}

/// Vertices in a box, some of them without motion, some in the place of another.
template <class T>
std::vector<vec3<T>> drawn_places(std::uint32_t n, uniform& random) {
    std::vector<vec3<T>> places;
    for (std::uint32_t i = 0; i < n; ++i) {
        const bool again = i > 0 && random.below(8) == 0;
        places.push_back(again ? places[random.below(i)] : random.point<T>(-1, 1));
    }
    return places;
}
/// A step that is small beside the mesh.
template <class T>
std::vector<vec3<T>> moved_places(const std::vector<vec3<T>>& from, uniform& random, double reach) {
    std::vector<vec3<T>> to;
    for (const vec3<T>& p : from) to.push_back(random.below(6) == 0 ? p : p + random.point<T>(-reach, reach));
    return to;
}

template <class T>
moving_set<mesh<T>> drawn_step(const topology& of, uniform& random, double reach = 0.3) {
    const auto t0 = drawn_places<T>(of.vertices, random), t1 = moved_places(t0, random, reach);
    const mesh<T> first(t0, of.faces);
    return moving(first, first.with_vertices(serial{}, t1));
}

/// Two numbers of features.
using feature_list = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// A judge by which all features touch at once: what it finds is what would be tested.
struct let_all_touch {
    template <class S, class U>
    ABUT_HD verdict decide(const S&, const U&) const {
        return verdict::yes;
    }
    template <class S, class U>
    ABUT_HD double time(const S&, const U&) const {
        return 0;
    }
    template <class S, class U>
    double time_on_host(const S&, const U&) const {
        return 0;
    }
};

inline bool share_a_vertex(std::initializer_list<std::uint32_t> a, std::initializer_list<std::uint32_t> b) {
    return std::any_of(a.begin(), a.end(), [&](auto v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}
inline bool share_a_vertex(const face& f, const face& g) { return share_a_vertex({f[0], f[1], f[2]}, {g[0], g[1], g[2]}); }
inline bool has_edge(const face& f, const edge& e) {
    const auto has = [&](std::uint32_t v) { return std::find(f.begin(), f.end(), v) != f.end(); };
    return has(e[0]) && has(e[1]);
}

template <class V, class W, class Wanted>
feature_list all_pairs(const V& a, const W& b, const Wanted& wanted) {
    feature_list found;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            if (wanted(i, j) && overlaps(bounds(a[i]), bounds(b[j]))) found.emplace_back(i, j);
        }
    }
    return found;
}

/// The pairs that a query has to test, by kind.
struct truth_of_pairs {
    feature_list vertex_face, face_vertex, edge_edge;
};
template <class T>
truth_of_pairs self_truth_of_pairs(const moving_set<mesh<T>>& m) {
    const auto rim = edges(serial{}, m);
    const auto f = m.t0().view().faces;
    const auto e = rim.t0().view().edges;
    return {all_pairs(vertices(m).view(), m.view(),
                      [&](auto v, auto i) {
                          return !share_a_vertex({v}, {f[i][0], f[i][1], f[i][2]});
                      }),
            {},
            all_pairs(rim.view(), rim.view(), [&](auto i, auto j) {
                return i < j && !share_a_vertex({e[i][0], e[i][1]}, {e[j][0], e[j][1]});
            })};
}
template <class T>
truth_of_pairs truth_of_two(const moving_set<mesh<T>>& a, const moving_set<mesh<T>>& b) {
    const auto all = [](auto, auto) { return true; };
    return {all_pairs(vertices(a).view(), b.view(), all), all_pairs(a.view(), vertices(b).view(), all),
            all_pairs(edges(serial{}, a).view(), edges(serial{}, b).view(), all)};
}

/// The orphans of a mesh by all its faces.
template <class T>
truth_of_pairs orphan_truth(const moving_set<mesh<T>>& m) {
    const auto rim = edges(serial{}, m);
    const auto f = m.t0().view().faces;
    const auto e = rim.t0().view().edges;
    truth_of_pairs found;
    for (std::uint32_t v = 0; v < m.t0().view().vertices.count; ++v) {
        for (std::uint32_t i = 0; i < f.count; ++i) {
            bool has_face = false, is_told = share_a_vertex({v}, {f[i][0], f[i][1], f[i][2]});
            for (std::uint32_t t = 0; t < f.count; ++t) {
                if (!share_a_vertex({v}, {f[t][0], f[t][1], f[t][2]})) continue;
                has_face = true;
                is_told |= !share_a_vertex(f[t], f[i]);
            }
            if (has_face && !is_told) found.vertex_face.emplace_back(v, i);
        }
    }
    for (std::uint32_t i = 0; i < e.count; ++i) {
        for (std::uint32_t j = i + 1; j < e.count; ++j) {
            bool is_told = share_a_vertex({e[i][0], e[i][1]}, {e[j][0], e[j][1]});
            for (std::uint32_t t = 0; t < f.count; ++t) {
                for (std::uint32_t s = 0; s < f.count && has_edge(f[t], e[i]); ++s) {
                    is_told |= has_edge(f[s], e[j]) && !share_a_vertex(f[t], f[s]);
                }
            }
            if (!is_told) found.edge_edge.emplace_back(i, j);
        }
    }
    return found;
}

/// By kind, ascending.
inline truth_of_pairs unpacked(std::vector<std::uint64_t> keys, const detail::feature_key& key) {
    std::sort(keys.begin(), keys.end());
    truth_of_pairs made;
    for (const std::uint64_t k : keys) {
        const feature_pair kind = key.kind(k);
        feature_list& list = kind == feature_pair::vertex_face   ? made.vertex_face
                             : kind == feature_pair::face_vertex ? made.face_vertex
                                                                 : made.edge_edge;
        list.emplace_back(key.a(k), key.b(k));
    }
    return made;
}
/// The pairs of features that a query of two indices, or `Within` one, tests.
template <bool Within, class Policy, class Index>
truth_of_pairs tested_pairs(const Policy& on, const Index& x, const Index& y) {
    const auto both = detail::features_of_two<Within>(x, y, "test");
    detail::timed_queue<Policy> hits(on);
    detail::time_by_faces<Within>(on, x, y, both, let_all_touch{}, detail::near_enough_to_touch{}, hits);
    auto buffer = hits.take();
    std::vector<detail::timed_key> timed(buffer.size());
    buffer.read(timed.data());
    std::vector<std::uint64_t> keys;
    for (const auto& hit : timed) keys.push_back(hit.key);
    return unpacked(keys, both.key);
}
template <class Index>
truth_of_pairs orphans_of(const Index& index) {
    return unpacked(index.orphans().keys.to_host(), detail::features_of_two<true>(index, index, "test").key);
}
inline void check_tested(const truth_of_pairs& tested, const truth_of_pairs& expected) {
    CHECK(tested.vertex_face == expected.vertex_face);
    CHECK(tested.face_vertex == expected.face_vertex);
    CHECK(tested.edge_edge == expected.edge_edge);
}

/// What rules were seen to do, so that a test of nothing is noticed.
struct rules_seen {
    std::size_t impacts = 0, tested = 0, orphans = 0;
};

template <pair_rule Rule, class T, class Policy>
void check_rule_within(const Policy& on, const moving_set<mesh<T>>& step, const moving_set<mesh<T>>& next,
                       const std::vector<impact<T>>& expected, const std::vector<impact<T>>& expected_next,
                       rules_seen& seen) {
    const auto check = [&](const auto& index, const auto& of, const auto& impacts_of) {
        CHECK(to_host(self_impacts(on, index)) == impacts_of);
        const auto earliest = [](const auto& i, const auto& j) { return i.time < j.time; };
        const auto first = std::min_element(impacts_of.begin(), impacts_of.end(), earliest);
        const auto found = first_self_impact(on, index);
        CHECK(found.has_value() == (first != impacts_of.end()));
        if (found) CHECK(*found == *first);
        auto any_order = to_host(self_impacts(on, index, {.sorted = false}));
        CHECK(any_order.size() == impacts_of.size());
        CHECK(std::is_permutation(any_order.begin(), any_order.end(), impacts_of.begin(), impacts_of.end()));
        check_tested(tested_pairs<true>(on, index, index), self_truth_of_pairs(of));
    };
    const auto index = make_impact_index<Rule>(on, step);
    check(index, step, expected);
    const auto moved = refit(on, index, next);
    check(moved, next, expected_next);
    CHECK(moved.parts().parts.data() == index.parts().parts.data());
    if constexpr (Rule == pair_rule::orphan_sets) {
        const auto orphans = orphan_truth(step);
        check_tested(orphans_of(index), orphans);
        seen.orphans += orphans.vertex_face.size() + orphans.edge_edge.size();
        CHECK(moved.orphans().keys.data() == index.orphans().keys.data());
    }
}

/// Of `fast` and `conservative`, which report what they like of what they are asked; on hosts, since a device may round
/// otherwise.
template <pair_rule Rule, motion_arithmetic A, class T, class Policy>
void check_rule_by(const Policy& on, const moving_set<mesh<T>>& a, const moving_set<mesh<T>>& b,
                   const conservative_bounds& bounds = {}) {
    if constexpr (host_policy<Policy>) {
        const auto x = make_impact_index<Rule>(on, a), y = make_impact_index<Rule>(on, b);
        CHECK(to_host(self_impacts<A>(on, x, {.bounds = bounds})) ==
              to_host(self_impacts<A>(serial{}, a, {.bounds = bounds})));
        CHECK(to_host(impacts<A>(on, x, y, {.bounds = bounds})) == to_host(impacts<A>(serial{}, a, b, {.bounds = bounds})));
    }
}

template <pair_rule Rule, class T, class Policy>
void check_rule_between(const Policy& on, const moving_set<mesh<T>>& a, const moving_set<mesh<T>>& b,
                        const std::vector<impact<T>>& expected) {
    const auto x = make_impact_index<Rule>(on, a), y = make_impact_index<Rule>(on, b);
    CHECK(to_host(impacts(on, x, y)) == expected);
    CHECK(to_host(impacts(on, x, b)) == expected);
    CHECK(to_host(impacts(on, a, y)) == expected);
    const auto first = first_impact(on, x, y);
    CHECK(first.has_value() == !expected.empty());
    CHECK(first == first_impact(serial{}, a, b));
    check_tested(tested_pairs<false>(on, x, y), truth_of_two(a, b));
}

/// A mesh, the step after, and another mesh.
template <class T>
struct rule_case {
    topology of;
    moving_set<mesh<T>> step, next, other;
    std::vector<impact<T>> within, within_next, between;
};
template <class T>
const std::vector<rule_case<T>>& rule_cases() {
    static const std::vector<rule_case<T>> all = [] {
        uniform random(20270303);
        std::vector<rule_case<T>> made;
        const auto topologies = all_topologies();
        for (std::size_t i = 0; i < topologies.size(); ++i) {
            const topology& of = topologies[i];
            const auto step = drawn_step<T>(of, random),
                       other = drawn_step<T>(topologies[(i + 7) % topologies.size()], random);
            const auto t2 = drawn_places<T>(of.vertices, random);
            const auto next = moving(step.t1(), step.t1().with_vertices(serial{}, t2));
            made.push_back({of, step, next, other, to_host(self_impacts(serial{}, step)),
                            to_host(self_impacts(serial{}, next)), to_host(impacts(serial{}, step, other))});
        }
        return made;
    }();
    return all;
}

template <class T, class Policy>
void check_all_rules(const Policy& on) {
    using enum pair_rule;
    rules_seen seen;
    for (const rule_case<T>& c : rule_cases<T>()) {
        CAPTURE(c.of.name, c.of.vertices, c.of.faces.size());
        const auto truth = self_truth_of_pairs(c.step);
        seen.impacts += c.within.size() + c.between.size();
        seen.tested += truth.vertex_face.size() + truth.edge_edge.size();
        check_rule_within<representative_triangles>(on, c.step, c.next, c.within, c.within_next, seen);
        check_rule_within<orphan_sets>(on, c.step, c.next, c.within, c.within_next, seen);
        check_rule_between<representative_triangles>(on, c.step, c.other, c.between);
        check_rule_between<orphan_sets>(on, c.step, c.other, c.between);
        check_rule_by<orphan_sets, fast>(on, c.step, c.other);
        check_rule_by<representative_triangles, conservative>(on, c.step, c.other, {.separation = 0.05});
        check_rule_by<orphan_sets, conservative>(on, c.step, c.other, {.separation = 0.05});
    }
    std::printf("pair rules: %zu pairs tested within meshes, %zu impacts, %zu orphans\n", seen.tested, seen.impacts,
                seen.orphans);
    CHECK(seen.tested > 5000);
    CHECK(seen.impacts > 2000);
    CHECK(seen.orphans > 1000);
}

}  // namespace abut::test
