// SPDX-License-Identifier: MIT
#pragma once

// Scenes from the least to the richest, to see what each step costs: what is not asked for costs nothing. A scene is one
// query; its program is compiled with nothing else where FOOTPRINT_SCENE says which (bench/footprint.py does that). Without
// that a scene has its elementary tests as well, so that they can be timed: of all pairs whose boxes meet, with neither
// tests of boxes nor the walk that finds the pairs.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../docs/examples/scene.hpp"

namespace footprint {

/// Spheres against a mesh, a mesh against another, a mesh in motion against itself.
enum asked : int {
    spheres_any_no_index,
    spheres_any,
    spheres_count,
    spheres_own_radii,
    spheres_pairs,
    spheres_posed,
    spheres_contacts,
    meshes_any_no_index,
    meshes_any,
    meshes_count,
    meshes_pairs,
    meshes_posed,
    meshes_contacts,
    moving_first,
    moving_all,
    moving_conservative,
    scenes
};

inline constexpr const char* name_of[scenes] = {
    "spheres/any, equal radii, no index",
    "spheres/any, equal radii",
    "spheres/count, equal radii",
    "spheres/count, own radii",
    "spheres/pairs, own radii",
    "spheres/pairs, own radii, posed",
    "spheres/contacts, own radii, posed",
    "meshes/any, no index",
    "meshes/any",
    "meshes/count",
    "meshes/pairs",
    "meshes/pairs, posed",
    "meshes/contacts, posed",
    "moving/first impact",
    "moving/all impacts",
    "moving/all impacts, `conservative`",
};

/// What is measured of a scene beside its time.
struct sizes {
    double elements = 0;     ///< of the sets that are asked about
    double set_bytes = 0;    ///< of all of them
    double index_bytes = 0;  ///< of trees
    double answer = 0;       ///< so that nothing is optimised away, and for a look
};

inline constexpr abut::rigid<float> pose{{1, 0, 0, 0, 0.8f, -0.6f, 0, 0.6f, 0.8f}, {5, 6, 7}};
inline constexpr std::size_t few_balls = 1000, balls = 100'000;

template <class Policy>
auto torus_mesh(const Policy& on, float shift = 0, std::uint32_t around = 96, std::uint32_t across = 82) {
    auto torus = scene::torus<float>(around, across);
    for (auto& v : torus.vertices) v = {v.x + shift, v.y + shift / 2, v.z + shift / 3};
    return abut::mesh<float>(torus.vertices, torus.faces).copied_to(on);
}

template <class Mesh>
double bytes_of(const Mesh& mesh) {
    return static_cast<double>(sizeof(abut::vec3<float>) * mesh.view().vertices.count + sizeof(abut::face) * mesh.size());
}

/// The torus of the scenes in motion, whose one side is pushed through the other in the middle.
inline auto pushed_torus() {
    auto torus = scene::torus<float>(96, 82);
    const abut::mesh<float> before(torus.vertices, torus.faces);
    auto later = torus.vertices;
    for (auto& v : later) {
        if (v.x > 0) v.x -= 130 * std::exp(-v.y * v.y / 1000);
    }
    return abut::moving(before, before.with_vertices(abut::serial{}, later));
}

inline std::vector<abut::sphere<float>> balls_of_own_radii(const std::vector<abut::vec3<float>>& centers) {
    std::vector<abut::sphere<float>> all;
    for (std::size_t i = 0; i < centers.size(); ++i) all.push_back({centers[i], static_cast<float>(1 + i % 5)});
    return all;
}

/// A query that can be asked again, with the sizes of what it asks about.
struct prepared {
    std::function<double()> ask;
    sizes of;
};

template <int Scene, class Policy>
prepared prepare(const Policy& on) {
    const auto number = [](auto n) { return static_cast<double>(n); };
    if constexpr (Scene <= spheres_contacts) {
        const auto mesh = torus_mesh(on);
        constexpr bool no_index = Scene == spheres_any_no_index, own = Scene >= spheres_own_radii;
        const std::size_t n = no_index ? few_balls : balls;
        // With `any` all balls are away from the torus, so that all of them are looked at.
        auto centers = scene::centers<float>(n);
        if (Scene <= spheres_any) {
            for (auto& c : centers) c.z += c.z < 0 ? -100 : 100;
        }
        const auto with_spheres = [&](const auto& set, double bytes) {
            sizes of{number(n), bytes, 0, 0};
            if constexpr (no_index) {
                return prepared{[=] { return number(abut::any(on, mesh, set)); }, of};
            } else {
                const auto tree = abut::make_bvh(on, mesh);
                of.index_bytes = number(tree.bytes());
                const auto ask = [=] {
                    if constexpr (Scene == spheres_any)
                        return number(abut::any(on, tree, set));
                    else if constexpr (Scene <= spheres_own_radii)
                        return number(abut::count(on, tree, set));
                    else if constexpr (Scene == spheres_pairs)
                        return number(abut::pairs(on, tree, set).size());
                    else if constexpr (Scene == spheres_posed)
                        return number(abut::pairs(on, abut::posed(tree, pose), set).size());
                    else
                        return number(abut::contacts(on, abut::posed(tree, pose), set).size());
                };
                return prepared{ask, of};
            }
        };
        if constexpr (own) {
            return with_spheres(abut::spheres<float>(balls_of_own_radii(centers)).copied_to(on),
                                number(n * sizeof(abut::sphere<float>)));
        } else {
            return with_spheres(abut::equal_spheres<float>(centers, 3).copied_to(on), number(n * sizeof(abut::vec3<float>)));
        }
    } else if constexpr (Scene <= meshes_contacts) {
        // A copy that meets the other in a ring, or where `any` is asked none.
        constexpr bool no_index = Scene == meshes_any_no_index;
        constexpr std::uint32_t part = no_index ? 4 : 1;
        const auto a = torus_mesh(on, 0, 96 / part, 82 / part);
        const auto b = torus_mesh(on, Scene <= meshes_any ? 400.0f : 30.0f, 96 / part, 82 / part);
        sizes of{number(a.size() + b.size()), bytes_of(a) + bytes_of(b), 0, 0};
        if constexpr (no_index) {
            return {[=] { return number(abut::any(on, a, b)); }, of};
        } else {
            const auto of_a = abut::make_bvh(on, a), of_b = abut::make_bvh(on, b);
            of.index_bytes = number(of_a.bytes() + of_b.bytes());
            const auto ask = [=] {
                if constexpr (Scene == meshes_any)
                    return number(abut::any(on, of_a, of_b));
                else if constexpr (Scene == meshes_count)
                    return number(abut::count(on, of_a, of_b));
                else if constexpr (Scene == meshes_pairs)
                    return number(abut::pairs(on, of_a, of_b).size());
                else if constexpr (Scene == meshes_posed)
                    return number(abut::pairs(on, of_a, abut::posed(of_b, pose)).size());
                else
                    return number(abut::contacts(on, of_a, abut::posed(of_b, pose)).size());
            };
            return {ask, of};
        }
    } else {
        const auto torus = pushed_torus();
        const auto index = abut::make_impact_index(on, torus.copied_to(on));
        const auto& before = torus.t0();
        const sizes of{number(before.size()), 2 * bytes_of(before) - number(sizeof(abut::face) * before.size()), 0, 0};
        const auto ask = [=] {
            if constexpr (Scene == moving_first)
                return number(abut::first_self_impact(on, index).has_value());
            else if constexpr (Scene == moving_all)
                return number(abut::self_impacts(on, index).size());
            else
                return number(abut::self_impacts<abut::conservative>(on, index).size());
        };
        return {ask, of};
    }
}

#ifndef FOOTPRINT_SCENE
// What is asked about a pair.
struct touch_test {
    template <class S, class U>
    ABUT_HD double operator()(const S& s, const U& t) const {
        return abut::intersects(s, t) ? 1 : 0;
    }
};
struct contact_test {
    template <class S, class U>
    ABUT_HD double operator()(const S& s, const U& t) const {
        const auto contact = abut::contact_of(s, t);
        return contact ? static_cast<double>(contact->depth) : -1;
    }
};
template <abut::motion_arithmetic A>
struct time_test {
    template <class S, class U>
    ABUT_HD double operator()(const S& s, const U& t) const {
        const abut::detail::time_in_motion<A> judge{};
        return judge.decide(s, t) == abut::verdict::no ? -1 : judge.time(s, t);
    }
};

template <class S, class U>
struct shape_pair {
    S s;
    U t;
};
template <class Test, class Pair>
struct test_pair {
    const Pair* pairs;
    std::size_t count;
    double* answers;
    ABUT_HD void operator()(std::size_t i) const {
        const Pair& pair = pairs[i % count];
        answers[i] = Test{}(pair.s, pair.t);
    }
};

/// Tests that can be run again. On a device there are a million or so, all pairs again and again: a launch for a few
/// thousand would measure the launch.
struct tests {
    double count = 0;
    std::function<void()> run;
};
template <class Test, class Policy, class Pair>
tests tests_of(const Policy& on, const std::vector<Pair>& pairs) {
    struct room {
        abut::execution::buffer_of<Policy, Pair> pairs;
        abut::execution::buffer_of<Policy, double> answers;
    };
    const std::size_t n = pairs.size(), all = abut::host_policy<Policy> || n == 0 ? n : n * ((std::size_t{1} << 20) / n + 1);
    const auto there = std::make_shared<room>(room{{on, n}, {on, all}});
    upload(on, pairs.data(), n, there->pairs.data());
    synchronize(on);
    const test_pair<Test, Pair> test{there->pairs.data(), n, there->answers.data()};
    return {static_cast<double>(all), [=] {
                (void)there;
                for_each_index(on, all, test);
            }};
}

/// The shapes of two views in host memory whose boxes meet, of pairs that are wanted.
template <class A, class B, class Wanted>
auto pairs_near(const A& a, const B& b, const Wanted& wanted) {
    const auto boxes_of = [](const auto& shapes) {
        std::vector<abut::aabb<float>> boxes;
        for (std::size_t i = 0; i < shapes.size(); ++i) boxes.push_back(bounds(shapes[i]));
        return boxes;
    };
    const auto of_a = boxes_of(a), of_b = boxes_of(b);
    const abut::serial on;
    const abut::boxes_view<float> view_a(of_a.data(), of_a.size()), view_b(of_b.data(), of_b.size());
    const auto found = abut::pairs(on, abut::make_bvh(on, view_a), view_b);
    std::vector<shape_pair<std::remove_cvref_t<decltype(a[0])>, std::remove_cvref_t<decltype(b[0])>>> near;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const abut::index_pair ids = found.data()[i];
        if (wanted(ids.a, ids.b)) near.push_back({a[ids.a], b[ids.b]});
    }
    return near;
}

/// The tests of a scene; of one that asks for `any`, where no boxes meet, those that `count` has.
template <int Scene, class Policy>
std::vector<tests> scene_tests(const Policy& on) {
    const auto all = [](std::uint32_t, std::uint32_t) { return true; };
    const auto placed = [](const auto& view) {
        using view_type = std::remove_cvref_t<decltype(view)>;
        if constexpr (Scene == spheres_posed || Scene == spheres_contacts || Scene == meshes_posed ||
                      Scene == meshes_contacts) {
            return abut::posed_view<view_type>{view, pose};
        } else {
            return view;
        }
    };
    using test = std::conditional_t<Scene == spheres_contacts || Scene == meshes_contacts, contact_test, touch_test>;
    const abut::serial host;
    if constexpr (Scene <= spheres_contacts) {
        const auto mesh = torus_mesh(host);
        const auto centers = scene::centers<float>(balls);
        if constexpr (Scene >= spheres_own_radii) {
            const abut::spheres<float> set(balls_of_own_radii(centers));
            return {tests_of<test>(on, pairs_near(placed(mesh.view()), set.view(), all))};
        } else {
            const abut::equal_spheres<float> set(centers, 3);
            return {tests_of<test>(on, pairs_near(mesh.view(), set.view(), all))};
        }
    } else if constexpr (Scene <= meshes_contacts) {
        const auto a = torus_mesh(host), b = torus_mesh(host, 30);
        return {tests_of<test>(on, pairs_near(a.view(), placed(b.view()), all))};
    } else {
        using timed = time_test<std::conditional_t<Scene == moving_conservative, abut::conservative, abut::filtered>>;
        const auto index = abut::make_impact_index(host, pushed_torus());
        const auto faces = index.mesh().t0().view().faces;
        const auto edges = index.edges().set().t0().view().edges;
        const auto vertex_face =
            pairs_near(index.vertices().set().view(), index.faces().set().view(), [&](std::uint32_t v, std::uint32_t f) {
                return abut::detail::share_no_vertex(v, abut::detail::corners_at(faces, f));
            });
        const auto edge_edge =
            pairs_near(index.edges().set().view(), index.edges().set().view(), [&](std::uint32_t i, std::uint32_t j) {
                return i < j &&
                       abut::detail::share_no_vertex(abut::detail::corners_at(edges, i), abut::detail::corners_at(edges, j));
            });
        return {tests_of<timed>(on, vertex_face), tests_of<timed>(on, edge_edge)};
    }
}

inline double count_of(const std::vector<tests>& all) {
    double n = 0;
    for (const tests& t : all) n += t.count;
    return n;
}
inline void run(const std::vector<tests>& all) {
    for (const tests& t : all) t.run();
}
#endif

/// visit(name, scene, tests) for all scenes, or visit(name, scene) for the one that is compiled alone.
template <class Policy, class Visit>
void for_each_scene(const Policy& on, const Visit& visit) {
#ifdef FOOTPRINT_SCENE
    visit(name_of[FOOTPRINT_SCENE], prepare<FOOTPRINT_SCENE>(on));
#else
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (visit(name_of[I], prepare<static_cast<int>(I)>(on), scene_tests<static_cast<int>(I)>(on)), ...);
    }
    (std::make_index_sequence<scenes>{});
#endif
}

}  // namespace footprint
