// SPDX-License-Identifier: MIT
#pragma once

// What impacts, self_impacts and first_impact promise on every policy: the pairs and times of a plain loop over all features
// and time_of_impact, whose own truth is tests/narrow. For frames of soft bodies, cloths and lattices, one after another.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/impact_fronts.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"
#include "support/scenes.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

/// A mesh at two times, before it is one.
template <class T>
struct frame {
    std::vector<vec3<T>> t0, t1;
    std::vector<face> faces;

    [[nodiscard]] moving_set<mesh<T>> as_set() const {
        const mesh<T> first(t0, faces);
        return moving(first, first.with_vertices(serial{}, t1));
    }
    [[nodiscard]] mesh<T> at_rest() const { return {t0, faces}; }
    /// Each edge once, in order; independent of abut::edges.
    [[nodiscard]] std::vector<edge> edges() const {
        std::set<edge> all;
        for (const face& f : faces) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t a = f[i], b = f[(i + 1) % 3];
                if (a != b) all.insert({std::min(a, b), std::max(a, b)});
            }
        }
        return {all.begin(), all.end()};
    }
};

/// An impact with the ids of its features, by which impacts are in order.
template <class T>
struct found_impact {
    std::uint32_t first, second;
    impact<T> what;

    [[nodiscard]] auto order() const { return std::tuple(what.kind, first, second); }
};
template <class T>
using impact_list = std::vector<found_impact<T>>;

template <class T>
std::vector<impact<T>> in_order(impact_list<T> all) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.order() < b.order(); });
    std::vector<impact<T>> r;
    for (const auto& one : all) r.push_back(one.what);
    return r;
}

/// By kind and vertices: where the order of features is not to be looked at.
template <class T>
std::vector<impact<T>> as_set(std::vector<impact<T>> all) {
    std::sort(all.begin(), all.end(), [](const impact<T>& a, const impact<T>& b) {
        return std::tuple(a.kind, a.vertices, a.time) < std::tuple(b.kind, b.vertices, b.time);
    });
    return all;
}

/// The same of the arguments in the other order.
template <class T>
impact_list<T> mirrored(impact_list<T> all) {
    for (auto& one : all) {
        std::swap(one.first, one.second);
        auto& v = one.what.vertices;
        if (one.what.kind == feature_pair::edge_edge) {
            v = {v[2], v[3], v[0], v[1]};
        } else {
            one.what.kind =
                one.what.kind == feature_pair::vertex_face ? feature_pair::face_vertex : feature_pair::vertex_face;
        }
    }
    return all;
}

/// Both meshes as one, the second's vertices and faces after the first's.
template <class T>
frame<T> joined(const frame<T>& a, const frame<T>& b) {
    frame<T> r = a;
    r.t0.insert(r.t0.end(), b.t0.begin(), b.t0.end());
    r.t1.insert(r.t1.end(), b.t1.begin(), b.t1.end());
    const auto n = static_cast<std::uint32_t>(a.t0.size());
    for (const face& f : b.faces) r.faces.push_back({f[0] + n, f[1] + n, f[2] + n});
    return r;
}

/// What self_impacts of that has to say.
template <class T>
impact_list<T> joined(const frame<T>& a, const impact_list<T>& between, const impact_list<T>& self_a,
                      const impact_list<T>& self_b) {
    const auto vertices = static_cast<std::uint32_t>(a.t0.size()), faces = static_cast<std::uint32_t>(a.faces.size()),
               edges = static_cast<std::uint32_t>(a.edges().size());
    impact_list<T> r = self_a;
    for (auto one : self_b) {
        const bool is_edges = one.what.kind == feature_pair::edge_edge;
        one.first += is_edges ? edges : vertices;
        one.second += is_edges ? edges : faces;
        for (std::uint32_t& v : one.what.vertices) v += vertices;
        r.push_back(one);
    }
    for (auto one : between) {
        auto& v = one.what.vertices;
        switch (one.what.kind) {
            case feature_pair::vertex_face:
                one.second += faces;
                for (std::size_t i = 1; i < 4; ++i) v[i] += vertices;
                break;
            case feature_pair::face_vertex:
                std::swap(one.first, one.second);
                one.first += vertices;
                v[0] += vertices;
                one.what.kind = feature_pair::vertex_face;
                break;
            default:
                one.second += edges;
                v[2] += vertices;
                v[3] += vertices;
        }
        r.push_back(one);
    }
    return r;
}

// --- the plain loops
// ---------------------------------------------------------------------------------------------------------

/// How far apart boxes around points are, along the axis where they are farthest; 0 or less where they touch.
template <class T>
class swept_box {
public:
    swept_box(const frame<T>& m, const std::uint32_t* ids, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) {
            for (const auto* all : {&m.t0, &m.t1}) {
                const vec3<T>& p = (*all)[ids[i]];
                const std::array<double, 3> x{p.x, p.y, p.z};
                for (std::size_t k = 0; k < 3; ++k) {
                    low_[k] = std::min(low_[k], x[k]);
                    high_[k] = std::max(high_[k], x[k]);
                }
            }
        }
    }
    [[nodiscard]] double gap(const swept_box& b) const {
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < 3; ++k) most = std::max({most, low_[k] - b.high_[k], b.low_[k] - high_[k]});
        return most;
    }

private:
    static constexpr double far = std::numeric_limits<double>::infinity();
    std::array<double, 3> low_{far, far, far}, high_{-far, -far, -far};
};

/// All of one kind, with their boxes.
template <class T, std::size_t N>
struct features_of_frame {
    std::vector<std::array<std::uint32_t, N>> ids;
    std::vector<swept_box<T>> boxes;

    features_of_frame(const frame<T>& m, std::vector<std::array<std::uint32_t, N>> of) : ids(std::move(of)) {
        for (const auto& one : ids) boxes.emplace_back(m, one.data(), N);
    }
};
template <class T>
features_of_frame<T, 1> vertices_of(const frame<T>& m) {
    std::vector<std::array<std::uint32_t, 1>> all;
    for (std::uint32_t v = 0; v < m.t0.size(); ++v) all.push_back({v});
    return {m, all};
}

template <class T>
auto moving_vertex(const frame<T>& m, std::uint32_t v) {
    return moving(m.t0[v], m.t1[v]);
}
template <class T>
auto moving_face(const frame<T>& m, const face& f) {
    return moving(triangle<T>{m.t0[f[0]], m.t0[f[1]], m.t0[f[2]]}, triangle<T>{m.t1[f[0]], m.t1[f[1]], m.t1[f[2]]});
}
template <class T>
auto moving_edge(const frame<T>& m, const edge& e) {
    return moving(segment<T>{m.t0[e[0]], m.t0[e[1]]}, segment<T>{m.t1[e[0]], m.t1[e[1]]});
}

/// Vertices of `a` against faces of `b`, as vertex_face.
template <class A, class T>
void add_vertex_face(impact_list<T>& all, const frame<T>& a, const frame<T>& b, bool self,
                     const conservative_bounds& bounds) {
    const auto vertices = vertices_of(a);
    const features_of_frame<T, 3> faces(b, b.faces);
    for (std::uint32_t v = 0; v < vertices.ids.size(); ++v) {
        for (std::uint32_t f = 0; f < faces.ids.size(); ++f) {
            const face& c = faces.ids[f];
            if (self && (v == c[0] || v == c[1] || v == c[2])) continue;
            if (vertices.boxes[v].gap(faces.boxes[f]) > bounds.separation) continue;
            const double t = time_of_impact<A>(moving_vertex(a, v), moving_face(b, c), bounds);
            if (t >= 0) all.push_back({v, f, {feature_pair::vertex_face, {v, c[0], c[1], c[2]}, t}});
        }
    }
}
template <class A, class T>
void add_edge_edge(impact_list<T>& all, const frame<T>& a, const frame<T>& b, bool self, const conservative_bounds& bounds) {
    const features_of_frame<T, 2> edges_a(a, a.edges()), edges_b(b, b.edges());
    for (std::uint32_t i = 0; i < edges_a.ids.size(); ++i) {
        for (std::uint32_t j = self ? i + 1 : 0; j < edges_b.ids.size(); ++j) {
            const edge &e = edges_a.ids[i], &f = edges_b.ids[j];
            if (self && (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1])) continue;
            if (edges_a.boxes[i].gap(edges_b.boxes[j]) > bounds.separation) continue;
            const double t = time_of_impact<A>(moving_edge(a, e), moving_edge(b, f), bounds);
            if (t >= 0) all.push_back({i, j, {feature_pair::edge_edge, {e[0], e[1], f[0], f[1]}, t}});
        }
    }
}

template <class A = filtered, class T>
impact_list<T> impacts_by_loops(const frame<T>& a, const frame<T>& b,
                                const conservative_bounds& bounds = {.separation = 0}) {
    impact_list<T> all, back;
    add_vertex_face<A>(all, a, b, false, bounds);
    add_vertex_face<A>(back, b, a, false, bounds);
    for (auto& one : back) {
        one.what.kind = feature_pair::face_vertex;
        std::swap(one.first, one.second);
        all.push_back(one);
    }
    add_edge_edge<A>(all, a, b, false, bounds);
    return all;
}
template <class A = filtered, class T>
impact_list<T> self_impacts_by_loops(const frame<T>& a, const conservative_bounds& bounds = {.separation = 0}) {
    impact_list<T> all;
    add_vertex_face<A>(all, a, a, true, bounds);
    add_edge_edge<A>(all, a, a, true, bounds);
    return all;
}

// --- frames
// ------------------------------------------------------------------------------------------------------------------

enum class bodies : int { balls, tori, cloth, cubes, lattice_soup, tenths_soup, lattice_cloth, flat_soup, few_faces };
inline constexpr int bodies_count = static_cast<int>(bodies::few_faces) + 1;

/// On the host only.
inline const char* name_of(bodies b) {
    constexpr const char* names[bodies_count] = {"balls",       "tori",          "cloth",     "cubes",    "lattice soup",
                                                 "tenths soup", "lattice cloth", "flat soup", "few faces"};
    return names[static_cast<int>(b)];
}

/// Where the vertices of a body are at the beginning of a step.
struct body {
    std::vector<vec3<double>> at;
    std::vector<face> faces;
};

inline body make_sheet(std::uint32_t n, double side, double height) {
    body b;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) b.at.push_back({side * i / n, side * j / n, height});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, c = a + n + 1;
            b.faces.push_back({a, c, c + 1});
            b.faces.push_back({a, c + 1, a + 1});
        }
    }
    return b;
}

inline body make_soup(draws& d, int vertices, int faces) {
    body b;
    b.at.resize(static_cast<std::size_t>(vertices));
    for (int f = 0; f < faces; ++f) {
        const auto v = [&] { return static_cast<std::uint32_t>(d.below(vertices)); };
        const std::uint32_t i = v(), j = v(), k = v();
        b.faces.push_back({i, j, k});
    }
    return b;
}

/// Body 0 or 1 of a scene.
inline body make_body(draws& d, bodies kind, int side, int size) {
    body b;
    switch (kind) {
        case bodies::balls: {
            const auto ball = ball_surface<double>(size, 0.8);
            b = {ball.vertices, ball.faces};
            for (auto& p : b.at) p.x += side == 0 ? -1 : 1;
            break;
        }
        case bodies::tori: {
            const auto n = static_cast<std::uint32_t>(4 + 3 * size);
            const torus<double> t(n, n - 1, 1, 0.35);
            b = {t.vertices, t.faces};
            if (side == 1) {
                for (auto& p : b.at) p = {p.x + 1, p.z, p.y};
            }
            break;
        }
        case bodies::cloth:
            b = make_sheet(static_cast<std::uint32_t>(2 + 3 * size), 2, side == 0 ? 0.6 : 0.0);
            break;
        case bodies::cubes: {
            const cube_surface cube(1 + size % 2);
            b.faces = cube.faces;
            for (const auto& p : cube.vertices) {
                b.at.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
            }
            break;
        }
        case bodies::lattice_cloth:
            b = make_sheet(static_cast<std::uint32_t>(2 + 2 * size), 2 + 2 * size, side);
            break;
        case bodies::few_faces:
            b = make_soup(d, 1 + d.below(4), d.below(4));
            break;
        default:
            b = make_soup(d, 6 + 3 * size, 6 + 5 * size);
    }
    return b;
}

inline void step(draws& d, bodies kind, int side, body& b) {
    const auto jitter = [&d](double r) {
        const double x = d.uniform(-r, r), y = d.uniform(-r, r);
        return vec3<double>{x, y, d.uniform(-r, r)};
    };
    const auto lattice = [&d](int n) {
        const double x = d.below(n), y = d.below(n);
        return vec3<double>{x, y, static_cast<double>(d.below(n))};
    };
    const vec3<double> whole = lattice(3) - vec3<double>{1, 1, 1};
    const double crumple = d.power_of_ten(-3, 0) * 0.4;
    for (auto& p : b.at) {
        switch (kind) {
            case bodies::balls:
                p = p + vec3<double>{side == 0 ? 0.25 : -0.25, 0, 0} + jitter(crumple);
                break;
            case bodies::tori:
                p = p + jitter(crumple);
                break;
            case bodies::cloth:
                p = p + (side == 0 ? vec3<double>{0, 0, -0.3} : vec3<double>{0, 0, 0}) +
                    jitter(side == 0 ? crumple : crumple / 8);
                break;
            case bodies::cubes:
                p = p + whole;
                break;
            case bodies::lattice_cloth:
                p = p + (d.below(3) == 0 ? lattice(3) - vec3<double>{1, 1, 1} : whole);
                break;
            case bodies::tenths_soup:
                p = 0.1 * lattice(5);
                break;
            case bodies::flat_soup: {
                const vec3<double> q = lattice(6);
                p = {q.x, q.y, q.x - 2 * q.y};
                break;
            }
            default:
                p = lattice(4);
        }
    }
}

/// Frames of two bodies that move, and what is true of them.
template <class T>
struct impact_case {
    bodies kind;
    std::uint64_t scene;
    bool follows;  ///< on the one before, of the same faces
    frame<T> a, b;
    impact_list<T> between, self_a, self_b;
};

inline constexpr int frames_of_scene = 6;

/// Six frames in a row for each scene. Made once, for all policies.
template <class T>
const std::vector<impact_case<T>>& impact_cases() {
    static const std::vector<impact_case<T>> all = [] {
        const std::uint64_t scenes = sample_count() / 50 + 9;
        std::vector<impact_case<T>> made(scenes * frames_of_scene);
        const auto make = [&made](std::uint64_t scene) {
            const auto kind = static_cast<bodies>(scene % bodies_count);
            draws d(20270301, 200 + static_cast<std::uint64_t>(kind), scene);
            const int size = scene % 50 == 0 ? 2 : static_cast<int>(scene / bodies_count % 2);
            body of[2];
            for (int side = 0; side < 2; ++side) {
                of[side] = make_body(d, kind, side, size);
                step(d, kind, side, of[side]);
            }
            for (int k = 0; k < frames_of_scene; ++k) {
                impact_case<T> c{kind, scene, k > 0, {}, {}, {}, {}, {}};
                for (int side = 0; side < 2; ++side) {
                    const auto rounded = [&] {
                        std::vector<vec3<T>> r;
                        for (const auto& p : of[side].at) {
                            r.push_back({static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
                        }
                        return r;
                    };
                    frame<T>& f = side == 0 ? c.a : c.b;
                    f.faces = of[side].faces;
                    f.t0 = rounded();
                    step(d, kind, side, of[side]);
                    f.t1 = rounded();
                }
                c.between = impacts_by_loops(c.a, c.b);
                c.self_a = self_impacts_by_loops(c.a);
                c.self_b = self_impacts_by_loops(c.b);
                made[scene * frames_of_scene + static_cast<std::uint64_t>(k)] = std::move(c);
            }
        };
        in_threads<std::size_t>(scenes, [&](std::uint64_t first, std::uint64_t last, std::size_t& count) {
            for (std::uint64_t scene = first; scene < last; ++scene) make(scene), ++count;
        });
        return made;
    }();
    return all;
}

// --- checks
// ------------------------------------------------------------------------------------------------------------------

/// Not by CHECK(a == b), which would print thousands of rows.
template <class T>
void check_same(const char* what, const std::vector<impact<T>>& found, const std::vector<impact<T>>& expected) {
    if (found == expected) {
        SUCCEED();
        return;
    }
    const auto at = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
    CAPTURE(what, found.size(), expected.size(), at.first - found.begin());
    const auto print = [](const char* which, const impact<T>& i) {
        std::printf("%s: kind %d, vertices %u %u %u %u, time %a\n", which, static_cast<int>(i.kind), i.vertices[0],
                    i.vertices[1], i.vertices[2], i.vertices[3], i.time);
    };
    if (at.first != found.end()) print("found", *at.first);
    if (at.second != expected.end()) print("expected", *at.second);
    FAIL_CHECK("other impacts than by plain loops");
}

/// Whether each of `some` is among `all`, there no later.
template <class T>
std::size_t missed_or_late(const std::vector<impact<T>>& some, const std::vector<impact<T>>& all, bool any_time = false) {
    std::map<std::pair<feature_pair, std::array<std::uint32_t, 4>>, double> times;
    for (const auto& i : all) {
        const auto [at, is_new] = times.try_emplace({i.kind, i.vertices}, i.time);
        if (!is_new) at->second = std::min(at->second, i.time);
    }
    std::size_t bad = 0;
    for (const auto& i : some) {
        const auto at = times.find({i.kind, i.vertices});
        bad += at == times.end() || (!any_time && at->second > i.time);
    }
    return bad;
}

/// The earliest, and of equal ones the first.
template <class T>
std::optional<impact<T>> first_of(const std::vector<impact<T>>& all) {
    std::optional<impact<T>> first;
    for (const auto& i : all) {
        if (!first || i.time < first->time) first = i;
    }
    return first;
}

/// `conservative` misses none and is never late, and finds what is near. Bits may differ from policy to policy.
template <class Policy, class T>
void check_conservative(const Policy& on, const impact_case<T>& c) {
    const auto a = c.a.as_set(), b = c.b.as_set();
    const auto between = in_order(c.between), self = in_order(c.self_a);
    const impact_options careful{.sorted = true, .bounds = {.tolerance = 1e-3}};
    CHECK(missed_or_late(between, to_host(impacts<conservative>(on, a, b, careful))) == 0);
    CHECK(missed_or_late(self, to_host(self_impacts<conservative>(on, a, careful))) == 0);
    const double apart = c.scene % 2 == 0 ? 0.05 : 0.3;
    const auto near = to_host(impacts<conservative>(on, a, b, {.bounds = {.tolerance = 0.01, .separation = apart}}));
    const auto near_self = to_host(self_impacts<conservative>(on, a, {.bounds = {.tolerance = 0.01, .separation = apart}}));
    CHECK(missed_or_late(between, near) == 0);
    if constexpr (host_policy<Policy>) {  // which rounds as the loops do
        const conservative_bounds less{.tolerance = 0.01, .separation = apart * (1 - 1e-5)},
            more{.tolerance = 0.01, .separation = apart * (1 + 1e-5)};
        CHECK(missed_or_late(in_order(impacts_by_loops<conservative>(c.a, c.b, less)), near, true) == 0);
        CHECK(missed_or_late(near, in_order(impacts_by_loops<conservative>(c.a, c.b, more)), true) == 0);
        CHECK(missed_or_late(in_order(self_impacts_by_loops<conservative>(c.a, less)), near_self, true) == 0);
        CHECK(missed_or_late(near_self, in_order(self_impacts_by_loops<conservative>(c.a, more)), true) == 0);
    }
}

/// How much is compiled for a policy: nvcc takes half a minute for each arithmetic.
enum class ways : int { exact_too, conservative_too, all };

/// All ways to ask, of one frame.
template <ways Ways, class Policy, class T>
void check_all_ways(const Policy& on, const impact_case<T>& c) {
    const auto a = c.a.as_set(), b = c.b.as_set();
    const auto between = in_order(c.between), back = in_order(mirrored(c.between)), self = in_order(c.self_a);
    const auto there = make_impact_index(on, a);
    check_same("mirrored", to_host(impacts(on, b, a)), back);
    if constexpr (Ways == ways::all || Ways == ways::exact_too) {
        check_same("exact", to_host(impacts<exact>(on, a, b)), between);
        check_same("exact, self", to_host(self_impacts<exact>(on, a)), self);
    }
    if constexpr (Ways == ways::all) {
        for (const auto& i : to_host(impacts<fast>(on, a, b))) {
            if (!(i.time >= 0 && i.time <= 1)) FAIL_CHECK("fast: time " << i.time);
        }
    }
    check_same("index and set", to_host(impacts(on, there, b)), between);
    check_same("set and index", to_host(impacts(on, b, there)), back);
    check_same("set on the spot", to_host(impacts(on, a.copied_to(on), b.copied_to(on))), between);
    check_same("unsorted", as_set(to_host(impacts(on, a, there, {.sorted = false}))),
               as_set(to_host(impacts(on, there, a))));
    check_same("unsorted, self", as_set(to_host(self_impacts(on, there, {.sorted = false}))), as_set(self));
    CHECK(first_impact(on, a, b) == first_of(between));
    CHECK(first_impact(on, there, b, {.sorted = false}) == first_of(between));
    CHECK(first_self_impact(on, a) == first_of(self));
    CHECK(first_self_impact(on, there, {.sorted = false}) == first_of(self));
    if constexpr (Ways == ways::all) {
        CHECK(first_impact<exact>(on, a, b) == first_of(between));
        CHECK(first_impact<fast>(on, a, b) == first_of(to_host(impacts<fast>(on, a, b))));
        CHECK(first_self_impact<fast>(on, a) == first_of(to_host(self_impacts<fast>(on, a))));
        const impact_options apart{.bounds = {.tolerance = 0.01, .separation = 0.1}};
        CHECK(first_impact<conservative>(on, a, b, apart) == first_of(to_host(impacts<conservative>(on, a, b, apart))));
        CHECK(first_self_impact<conservative>(on, a, apart) == first_of(to_host(self_impacts<conservative>(on, a, apart))));
        CHECK(first_impact<conservative>(on, a, b) == first_of(to_host(impacts<conservative>(on, a, b))));
    }
    const frame<T> rests{c.b.t0, c.b.t0, c.b.faces};
    const auto with_rest = in_order(impacts_by_loops(c.a, rests));
    check_same("against one at rest", to_host(impacts(on, a, c.b.at_rest())), with_rest);
    check_same("against the index of one at rest", to_host(impacts(on, there, make_impact_index(on, c.b.at_rest()))),
               with_rest);
    const frame<T> whole = joined(c.a, c.b);
    check_same("joined", to_host(self_impacts(on, whole.as_set())), in_order(joined(c.a, c.between, c.self_a, c.self_b)));

    if constexpr (Ways != ways::exact_too) check_conservative(on, c);
}

/// Vertices and faces in another order: the same impacts under other names.
template <class Policy, class T>
void check_permuted(const Policy& on, const impact_case<T>& c) {
    uniform random(c.scene + 5);
    std::vector<std::uint32_t> old(c.a.t0.size()), now(c.a.t0.size());
    for (std::uint32_t v = 0; v < old.size(); ++v) old[v] = v;
    old = shuffled(old, random);
    frame<T> other;
    for (std::uint32_t v = 0; v < old.size(); ++v) {
        now[old[v]] = v;
        other.t0.push_back(c.a.t0[old[v]]);
        other.t1.push_back(c.a.t1[old[v]]);
    }
    for (const face& f : c.a.faces) other.faces.push_back({now[f[0]], now[f[1]], now[f[2]]});
    other.faces = shuffled(other.faces, random);
    auto self = in_order(c.self_a);
    for (auto& i : self) {
        for (auto& v : i.vertices) v = now[v];
        if (i.kind != feature_pair::edge_edge) continue;
        auto& v = i.vertices;
        if (v[0] > v[1]) std::swap(v[0], v[1]);
        if (v[2] > v[3]) std::swap(v[2], v[3]);
        if (std::pair(v[2], v[3]) < std::pair(v[0], v[1])) v = {v[2], v[3], v[0], v[1]};
    }
    check_same("permuted", as_set(to_host(self_impacts(on, other.as_set()))), as_set(self));
}

/// Points in motion among faces in motion.
template <class Policy, class T>
void check_moving_pairs(const Policy& on, const impact_case<T>& c) {
    std::vector<index_pair> expected;
    for (const auto& one : c.between) {
        if (one.what.kind == feature_pair::vertex_face) expected.push_back({one.first, one.second});
    }
    std::sort(expected.begin(), expected.end());
    const auto a = c.a.as_set().copied_to(on);
    CHECK(to_host(pairs(on, vertices(a), make_bvh(on, c.b.as_set().copied_to(on)))) == expected);
}

/// Sets in motion in queries of all kinds.
template <class Policy, class T>
void check_generic_queries(const Policy& on, const impact_case<T>& c) {
    std::vector<index_pair> expected, edge_pairs;
    for (const auto& one : c.between) {
        if (one.what.kind == feature_pair::vertex_face) expected.push_back({one.first, one.second});
        if (one.what.kind == feature_pair::edge_edge) edge_pairs.push_back({one.first, one.second});
    }
    std::sort(expected.begin(), expected.end());
    std::sort(edge_pairs.begin(), edge_pairs.end());
    const auto a = c.a.as_set().copied_to(on), b = c.b.as_set().copied_to(on);
    const auto tree = make_bvh(on, b);
    const auto points_of_a = moving(vertices(a.t0()), vertices(a.t1()));
    CHECK(to_host(pairs(on, points_of_a, tree)) == expected);
    CHECK(to_host(pairs<exact>(on, points_of_a, tree)) == expected);
    CHECK(to_host(pairs(on, vertices(a), b)) == expected);
    CHECK(to_host(pairs(on, make_bvh(on, points_of_a), refit(on, tree, b))) == expected);
    CHECK(count(on, points_of_a, tree) == expected.size());
    CHECK(any(on, points_of_a, tree) == !expected.empty());
    auto back = expected;
    for (index_pair& p : back) std::swap(p.a, p.b);
    std::sort(back.begin(), back.end());
    CHECK(to_host(pairs(on, tree, points_of_a)) == back);
    CHECK(to_host(pairs(on, edges(on, a), make_bvh(on, edges(on, b)))) == edge_pairs);
    CHECK(count(on, edges(on, a), edges(on, b)) == edge_pairs.size());
}

/// All frames: as they come, and by indices that are refitted from frame to frame. Some of them in all ways, each of which
/// nvcc compiles anew.
template <class T, ways Ways = ways::all, class Policy>
void check_all_impacts(const Policy& on, std::size_t from = 0, std::size_t each = 1) {
    const auto& all = impact_cases<T>();
    std::optional<impact_index<T, space_of<Policy>>> of_a, of_b;
    std::size_t pairs = 0, self = 0;
    std::array<std::size_t, bodies_count> of_kind{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const impact_case<T>& c = all[i];
        if ((i / frames_of_scene + from) % each != 0) continue;
        CAPTURE(name_of(c.kind), c.scene, i % frames_of_scene);
        const auto a = c.a.as_set(), b = c.b.as_set();
        const auto between = in_order(c.between), self_a = in_order(c.self_a), self_b = in_order(c.self_b);
        of_a = c.follows ? refit(on, *of_a, a) : make_impact_index(on, a);
        of_b = c.follows ? refit(on, *of_b, b) : make_impact_index(on, b);
        check_same("indices", to_host(impacts(on, *of_a, *of_b)), between);
        check_same("index, self", to_host(self_impacts(on, *of_b)), self_b);
        if (i % 2 == 0) {
            check_same("sets", to_host(impacts(on, a, b)), between);
            check_same("self", to_host(self_impacts(on, a)), self_a);
        }
        if (i % 13 == 5) check_permuted(on, c);
        if (i % 11 == 3) check_all_ways<Ways>(on, c);
        if constexpr (Ways == ways::all) {
            if (i % 11 == 7) check_generic_queries(on, c);
        }
        pairs += between.size();
        self += self_a.size() + self_b.size();
        of_kind[static_cast<std::size_t>(c.kind)] += between.size() + self_a.size();
    }
    std::printf("impacts: %zu between meshes, %zu within\n", pairs, self);
    for (std::size_t k = 0; k < of_kind.size(); ++k) {
        CAPTURE(name_of(static_cast<bodies>(k)));
        CHECK((of_kind[k] > 0 || each > 1));
    }
    CHECK(pairs > all.size());
    CHECK(self > all.size());
}

/// Meshes of which little is there.
template <class T, ways Ways = ways::all, class Policy>
void check_small_impacts(const Policy& on) {
    const frame<T> nothing{}, no_faces{{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {0, 0, 0}}, {}};
    const frame<T> one{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}, {{0, 1, 2}}};
    const frame<T> falls{
        {{T(0.5), T(0.5), 1}, {3, 3, 1}, {3, 4, 1}}, {{T(0.5), T(0.5), -1}, {3, 3, -1}, {3, 4, -1}}, {{0, 1, 2}}};
    // A face that names a vertex twice has an edge, and is one; a face of one vertex is a point.
    const frame<T> twice{{{T(0.5), -1, 1}, {T(0.5), 1, 1}}, {{T(0.5), -1, -1}, {T(0.5), 1, -1}}, {{0, 1, 0}, {1, 1, 1}}};
    const frame<T> loose{{{T(0.5), T(0.5), 1}}, {{T(0.5), T(0.5), -1}}, {}};  // a vertex of no face
    const std::vector<frame<T>> all{nothing, no_faces, one, falls, twice, loose};
    std::size_t hits = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(i);
        check_same("small, self", to_host(self_impacts(on, all[i].as_set())), in_order(self_impacts_by_loops(all[i])));
        if constexpr (Ways != ways::exact_too) {
            CHECK(to_host(self_impacts<conservative>(on, all[i].as_set(), {.bounds = {.separation = 1}})).size() ==
                  self_impacts_by_loops<conservative>(all[i], {.separation = 1}).size());
        }
        for (std::size_t j = 0; j < all.size(); ++j) {
            CAPTURE(j);
            const auto expected = in_order(impacts_by_loops(all[i], all[j]));
            check_same("small", to_host(impacts(on, all[i].as_set(), all[j].as_set())), expected);
            CHECK(first_impact(on, all[i].as_set(), all[j].as_set()) == first_of(expected));
            CHECK(first_self_impact(on, all[i].as_set()) == first_of(in_order(self_impacts_by_loops(all[i]))));
            if constexpr (Ways != ways::exact_too) {
                CHECK(to_host(impacts<conservative>(on, all[i].as_set(), all[j].as_set(), {.bounds = {.separation = 1}}))
                          .size() == impacts_by_loops<conservative>(all[i], all[j], {.separation = 1}).size());
            }
            hits += expected.size();
        }
    }
    CHECK(hits > 10);
    // One vertex is over the face, and meets it at 1/3; two edges from there meet its long side.
    const auto met = to_host(impacts(on, falls.as_set(), one.as_set()));
    REQUIRE(met.size() == 3);
    CHECK(met[0].kind == feature_pair::vertex_face);
    CHECK(met[0].vertices == std::array<std::uint32_t, 4>{0, 0, 1, 2});
    CHECK(met[1].vertices == std::array<std::uint32_t, 4>{0, 1, 1, 2});
    CHECK(met[2].vertices == std::array<std::uint32_t, 4>{0, 2, 1, 2});
    for (const auto& i : met) CHECK(i.time == std::floor(std::ldexp(1.0, 40) / 3) * 0x1p-40);
}

/// Many vertices fall onto two faces, more than first_impact times at once: all at one time, or the last of them first.
template <class T, class Policy>
void check_first_of_many(const Policy& on) {
    const std::vector<vec3<T>> corners{{-1, -1, 0}, {99, -1, 0}, {-1, 99, 0}, {99, 99, 0}};
    const frame<T> floor{corners, corners, {{0, 1, 2}, {3, 2, 1}}};
    for (const bool level : {true, false}) {
        for (const int side : {1, -1}) {  // a walk comes to the first or to the last vertices early
            CAPTURE(level, side);
            frame<T> rain;
            for (int i = 0; i < 900; ++i) {
                const T x = static_cast<T>(15 + side * (i % 30 - 15)), y = static_cast<T>(15 + side * (i / 30 - 15));
                const T height = level ? T(1) : T(4) - static_cast<T>(i) / 300;
                rain.t0.push_back({x, y, height});
                rain.t1.push_back({x, y, height - 4});
            }
            const auto falls = rain.as_set();
            const auto rests = floor.at_rest();
            const auto all = to_host(impacts(on, falls, rests));
            REQUIRE(all.size() >= 900);
            const auto first = first_impact(on, falls, rests);
            CHECK(first == first_of(all));
            REQUIRE(first.has_value());
            CHECK(first->time == (level ? 0.25 : std::floor(std::ldexp(static_cast<double>(rain.t0[899].z), 38)) * 0x1p-40));
            CHECK(first->vertices[0] == (level ? 0u : 899u));
        }
    }
}

/// Bodies of some thousand faces, against the answer of another policy.
template <class T>
struct large_scene {
    frame<T> a, b;

    explicit large_scene(int levels, double crumple = 0.03) {
        draws d(20270302, 220, static_cast<std::uint64_t>(levels));
        const auto ball = ball_surface<double>(levels, 1);
        for (int side = 0; side < 2; ++side) {
            frame<T>& f = side == 0 ? a : b;
            f.faces = ball.faces;
            for (const auto& p : ball.vertices) {
                const auto at = [&](double shift) {
                    const double x = p.x + shift + d.uniform(-crumple, crumple), y = p.y + d.uniform(-crumple, crumple),
                                 z = p.z + d.uniform(-crumple, crumple);
                    return vec3<T>{static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
                };
                f.t0.push_back(at(side == 0 ? -0.8 : 0.8));
                f.t1.push_back(at(side == 0 ? -0.4 : 0.4));
            }
        }
    }
};

/// The same bits as serial's, again and again.
template <class T, class Policy>
void check_large_impacts(const Policy& on) {
    const large_scene<T> s(5, 0.07);
    const auto a = s.a.as_set(), b = s.b.as_set();
    const auto between = to_host(impacts(serial{}, a, b)), self = to_host(self_impacts(serial{}, a));
    CHECK(between.size() > 2000);
    CHECK(self.size() > 2000);
    const auto of_a = make_impact_index(on, a), of_b = make_impact_index(on, b);
    for (int k = 0; k < 20; ++k) {
        check_same("between", to_host(impacts(on, of_a, of_b)), between);
        check_same("within", to_host(self_impacts(on, of_a)), self);
        CHECK(first_impact(on, of_a, of_b) == first_of(between));
        CHECK(first_self_impact(on, of_a) == first_of(self));
    }
    check_same("from the host", to_host(impacts(on, a, b)), between);
}

/// What is known of impacts of each kind: the meshes' points come together against a normal that goes from b to a.
template <class T, class Policy>
void check_details(const Policy& on) {
    const large_scene<T> s(4, 0.07);
    const auto a = s.a.as_set(), b = s.b.as_set();
    const auto check = [&](const auto& found, const auto& details, const frame<T>& of_a, const frame<T>& of_b) {
        const auto all = to_host(found);
        const auto known = to_host(details);
        REQUIRE((all.size() > 100 && known.size() == all.size()));
        std::size_t far = 0, wrong_speed = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            vec3<double> sum[2] = {{0, 0, 0}, {0, 0, 0}}, way = {0, 0, 0};
            for (std::size_t k = 0; k < 4; ++k) {
                const bool in_a =
                    all[i].kind == feature_pair::edge_edge ? k < 2 : (k == 0) == (all[i].kind == feature_pair::vertex_face);
                const frame<T>& m = in_a ? of_a : of_b;
                const double weight = known[i].weights.of[k];
                const auto add = [](vec3<double>& to, double by, const vec3<T>& p) {
                    to =
                        to + by * vec3<double>{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
                };
                const vec3<T>&from = m.t0[all[i].vertices[k]], &to = m.t1[all[i].vertices[k]];
                add(sum[in_a ? 0 : 1], weight * (1 - all[i].time), from);
                add(sum[in_a ? 0 : 1], weight * all[i].time, to);
                add(way, in_a ? weight : -weight, to);
                add(way, in_a ? -weight : weight, from);
            }
            for (const auto& p : sum) {
                const vec3<double> off = p - known[i].point;
                far += !(std::sqrt(dot(off, off)) <= known[i].gap);
            }
            wrong_speed += !(std::abs(known[i].speed + dot(known[i].normal, way)) <= 1e-12 && known[i].speed >= 0);
        }
        CHECK(far == 0);
        CHECK(wrong_speed == 0);
    };
    const auto of_a = make_impact_index(on, a);
    const auto between = impacts(on, of_a, b);
    check(between, impact_details(on, between, of_a, b), s.a, s.b);
    const auto within_one = self_impacts(on, of_a);
    check(within_one, impact_details(on, within_one, a, of_a), s.a, s.a);
    const auto with_rest = impacts(on, b, s.a.at_rest());
    check(with_rest, impact_details(on, with_rest, b, s.a.at_rest()), s.b, frame<T>{s.a.t0, s.a.t0, s.a.faces});
    CHECK(impact_details(on, impacts(on, a, mesh<T>()), a, mesh<T>()).size() == 0);
    const auto few = impacts(on, a, b);
    bool refused = false;
    try {
        (void)impact_details(on, few, a, mesh<T>());
    } catch (const error& e) {
        refused = std::string(e.what()).find("abut::impact_details: impact 0 is none of meshes of ") == 0;
    }
    CHECK(refused);
}

/// All boxes overlap: 9.6 million candidates, more than a device gathers of meshes so small at a time. It looks for parts of
/// them.
template <class T, class Policy>
void check_many_candidates(const Policy& on) {
    draws d(20270307, 98, sizeof(T));
    const auto crossing = [&] {
        frame<T> f;
        for (std::uint32_t i = 0; i < 800; ++i) {
            const vec3<double> from{d.uniform(-1, 0), d.uniform(-1, 0), d.uniform(-1, 0)};
            const vec3<double> to{d.uniform(0, 1), d.uniform(0, 1), d.uniform(0, 1)};
            for (int k = 0; k < 3; ++k) {
                const auto near = [&](double x, double way) { return static_cast<T>(x + way * d.uniform(0, 0.01)); };
                f.t0.push_back({near(from.x, -1), near(from.y, -1), near(from.z, -1)});
                f.t1.push_back({near(to.x, 1), near(to.y, 1), near(to.z, 1)});
            }
            f.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        return f;
    };
    const frame<T> a = crossing(), b = crossing();
    const auto of_a = make_impact_index(on, a.as_set()), of_b = make_impact_index(on, b.as_set());
    const auto expected = to_host(impacts(openmp{}, a.as_set(), b.as_set()));
    CHECK(expected.size() > 10);
    check_same("from the roots", to_host(impacts(on, of_a, of_b)), expected);
    impact_fronts fronts;
    for (int k = 0; k < 2; ++k) check_same("from fronts", to_host(impacts(on, of_a, of_b, {}, fronts)), expected);
}

}  // namespace abut::test
