// SPDX-License-Identifier: MIT
//
// usage: bench_families --benchmark_out=cpu.json
//
// What an answer that is right costs over `fast`, of each kind of pairs, in each family of the tests: pairs decided one by
// one, but for a hull and a ray, hulls within a distance, and faces of one mesh. The families of two triangles are
// bench_triangles's. A pair with a hull is timed with the making of the other shape of points. Names:
//
//   KIND/SCALAR/FAMILY    KIND is two shapes, as sphere_triangle; within_ before them: whether they are within a distance;
//                         motion_ before a vertex and a face or two edges: whether they touch in a step
//
// Rows are those of bench/in_turn.hpp.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "../tests/support/families.hpp"
#include "../tests/support/hull_families.hpp"
#include "../tests/support/motion_families.hpp"
#include "../tests/support/other_shapes.hpp"
#include "../tests/support/ray_oracle.hpp"
#include "../tests/support/revolution_pairs.hpp"
#include "../tests/support/solid_pairs.hpp"
#include "../tests/support/triangle_families.hpp"
#include "../tests/support/within_pairs.hpp"
#include "google.hpp"
#include "in_turn.hpp"

namespace {

namespace test = abut::test;
using abut::vec3;

constexpr std::uint64_t seed = 41;

template <abut::scalar T, class S>
constexpr const char* name_of_shape() {
    if constexpr (std::is_same_v<S, vec3<T>>) return "point";
    if constexpr (std::is_same_v<S, abut::segment<T>>) return "segment";
    if constexpr (std::is_same_v<S, abut::triangle<T>>) return "triangle";
    if constexpr (std::is_same_v<S, abut::sphere<T>>) return "sphere";
    if constexpr (std::is_same_v<S, abut::capsule<T>>) return "capsule";
    if constexpr (std::is_same_v<S, abut::plane<T>>) return "plane";
    if constexpr (std::is_same_v<S, abut::aabb<T>>) return "box";
    if constexpr (std::is_same_v<S, abut::ray<T>>) return "ray";
    if constexpr (std::is_same_v<S, abut::cylinder<T>>) return "cylinder";
    if constexpr (std::is_same_v<S, abut::cone<T>>) return "cone";
    return "hull";
}
template <abut::scalar T, class S, class U>
std::string name_of_kind() {
    return std::string(name_of_shape<T, S>()) + "_" + name_of_shape<T, U>();
}

/// How many pairs of a family, and how often each arithmetic decides them all.
struct size {
    std::size_t pairs = 2048;
    int runs = 9;
};

/// make(k) is pair number k, as ask<A>(pair) -> bool takes it.
template <abut::scalar T, class Make, class Ask>
void add(const std::string& kind, const std::string& family, const size& of, const Make& make, const Ask& ask) {
    const std::string name = kind + "/" + bench::scalar_name<T> + "/" + family;
    const auto run = [=](benchmark::State& state) {
        std::vector<decltype(make(std::uint64_t{0}))> pairs;
        for (std::uint64_t k = 0; k < of.pairs; ++k) pairs.push_back(make(k));
        bench::in_turn(state, pairs.size(), [&]<class A>(A) {
            std::uint64_t hits = 0;
            for (const auto& p : pairs) hits += ask(A{}, p) ? 1 : 0;
            return hits;
        });
    };
    benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->Iterations(of.runs);
}

template <class S, class U>
struct pair_of {
    S s;
    U t;
    double distance = 0;
};
inline constexpr auto whether_they_meet = []<class A, class P>(A, const P& p) { return abut::intersects<A>(p.s, p.t); };
inline constexpr auto whether_they_are_within = []<class A, class P>(A, const P& p) {
    return abut::within<A>(p.s, p.t, p.distance);
};

/// make(family, k) is a pair_of<S, U>.
template <abut::scalar T, class S, class U, class Family, class Make>
void add_families(int count, const Make& make) {
    for (int f = 0; f < count; ++f) {
        const auto family = static_cast<Family>(f);
        add<T>(
            name_of_kind<T, S, U>(), name_of(family), {}, [=](std::uint64_t k) { return make(family, k); },
            whether_they_meet);
    }
}

template <abut::scalar T>
void add_beside_triangles() {
    using abut::aabb, abut::capsule, abut::plane, abut::ray, abut::segment, abut::sphere, abut::triangle;
    using test::family, test::triangle_family, test::shape_family;
    add_families<T, sphere<T>, triangle<T>, family>(test::family_count, [](family f, std::uint64_t k) {
        const auto p = test::make_pair<T>(seed, f, k);
        return pair_of<sphere<T>, triangle<T>>{p.s, p.t};
    });
    const auto add_shape = []<template <class> class Shape>(pair_of<Shape<T>, triangle<T>>) {
        add_families<T, Shape<T>, triangle<T>, shape_family>(test::shape_family_count, [](shape_family f, std::uint64_t k) {
            const auto p = test::make_shape_pair<Shape, T>(seed, f, k);
            return pair_of<Shape<T>, triangle<T>>{p.s, p.t};
        });
    };
    add_shape(pair_of<aabb<T>, triangle<T>>{});
    add_shape(pair_of<plane<T>, triangle<T>>{});
    add_shape(pair_of<capsule<T>, triangle<T>>{});
    add_families<T, segment<T>, triangle<T>, triangle_family>(
        test::triangle_family_count, [](triangle_family f, std::uint64_t k) {
            const auto p = test::make_triangle_pair<T>(seed, f, k);
            return pair_of<segment<T>, triangle<T>>{test::segment_beside_triangle(p, k), p.b};
        });
    add_families<T, vec3<T>, triangle<T>, triangle_family>(
        test::triangle_family_count, [](triangle_family f, std::uint64_t k) {
            const auto p = test::make_triangle_pair<T>(seed, f, k);
            return pair_of<vec3<T>, triangle<T>>{test::point_beside_triangle(p, k), p.b};
        });
    add_families<T, ray<T>, triangle<T>, triangle_family>(test::triangle_family_count,
                                                          [](triangle_family f, std::uint64_t k) {
                                                              const auto p = test::make_ray_pair<T>(seed, f, k);
                                                              return pair_of<ray<T>, triangle<T>>{p.r, p.t};
                                                          });
    add_families<T, sphere<T>, segment<T>, family>(test::family_count, [](family f, std::uint64_t k) {
        const auto p = test::make_pair<T>(seed, f, k);
        return pair_of<sphere<T>, segment<T>>{p.s, test::segment_beside_ball(p, k)};
    });
    add_families<T, sphere<T>, sphere<T>, family>(test::family_count, [](family f, std::uint64_t k) {
        const auto p = test::two_balls(test::make_pair<T>(seed, f, k), k);
        return pair_of<sphere<T>, sphere<T>>{p.s, p.o};
    });
}

template <abut::scalar T>
void add_solids() {
    for (int f = 0; f < test::solid_family_count; ++f) {
        const auto family = static_cast<test::solid_family>(f);
        const std::string name = test::name_of(family);
        for (int kind = 0; kind < test::solid_pair_kinds; ++kind) {
            test::with_solid_pair<T>(kind, seed, family, 0, [&]<class S, class U>(const S&, const U&) {
                add<T>(
                    name_of_kind<T, S, U>(), name, {},
                    [=](std::uint64_t k) {
                        const auto p = test::make_solid_pair<S, U>(seed, family, k);
                        return pair_of<S, U>{p.s, p.t};
                    },
                    whether_they_meet);
            });
        }
        // The distance that the oracle finds takes long.
        for (int kind = 0; kind < test::within_pair_kinds; ++kind) {
            test::with_within_pair<T>(kind, seed, family, 0, [&]<class S, class U>(const S&, const U&) {
                add<T>(
                    "within_" + name_of_kind<T, S, U>(), name, {256, 9},
                    [=](std::uint64_t k) {
                        const auto p = test::make_solid_pair<S, U>(seed, family, k);
                        return pair_of<S, U>{p.s, p.t, test::distance_near(test::oracle::least_distance(p.s, p.t), k)};
                    },
                    whether_they_are_within);
            });
        }
    }
}

template <abut::scalar T>
void add_round_within() {
    for (int f = 0; f < test::within_family_count; ++f) {
        const std::string name =
            f < test::triangle_family_count ? test::name_of(static_cast<test::triangle_family>(f)) : "whole distances";
        for (std::uint64_t kind = 0; kind < 6; ++kind) {
            test::with_shapes(test::make_round_pair<T>(seed, f, 0), kind, [&]<class S, class U>(const S&, const U&) {
                add<T>(
                    "within_" + name_of_kind<T, S, U>(), name, {256, 9},
                    [=](std::uint64_t k) {
                        pair_of<S, U> made{};
                        test::with_shapes(
                            test::make_round_pair<T>(seed, f, k), kind, [&]<class V, class W>(const V& s, const W& t) {
                                if constexpr (std::is_same_v<S, V> && std::is_same_v<U, W>) {
                                    made = {s, t, test::distance_near(test::exact_gap(s, t).least_double(), k)};
                                }
                            });
                        return made;
                    },
                    whether_they_are_within);
            });
        }
    }
}

/// Points of the families of two hulls, as hulls and the shapes of bench/trade.cpp.
template <abut::scalar T>
void add_hulls() {
    for (int f = 0; f < test::hull_family_count; ++f) {
        const auto family = static_cast<test::hull_family>(f);
        for (int kind = 0; kind < test::kinds_beside_hulls; ++kind) {
            const auto name = [&] {
                std::string shape;
                test::with_shape_beside_hull(kind, test::make_hull_pair<T>(seed, family, 0), 0,
                                             [&]<class H, class U>(const H&, const U&) { shape = name_of_shape<T, U>(); });
                return "hull_" + shape;
            }();
            const std::size_t pairs = 512 / test::thinned_by(family) + 8;
            add<T>(
                name, test::name_of(family), {pairs, 9},
                [=](std::uint64_t k) {
                    return std::pair{test::make_hull_pair<T>(seed, family, k), k};
                },
                [=]<class A>(A, const std::pair<test::hull_pair<T>, std::uint64_t>& p) {
                    bool meet = false;
                    test::with_shape_beside_hull(kind, p.first, p.second, [&](const auto& h, const auto& other) {
                        meet = abut::intersects<A>(h, other);
                    });
                    return meet;
                });
        }
    }
}

template <test::motion_kind Kind, abut::scalar T>
void add_motion(const char* kind) {
    for (int f = 0; f < test::motion_family_count; ++f) {
        const auto family = static_cast<test::motion_family>(f);
        add<T>(
            kind, test::name_of(family), {64, 3},
            [=](std::uint64_t k) { return test::make_motion<T>(seed, Kind, family, k); },
            []<class A>(A, const test::motion<T>& m) {
                const auto &p = m.t0, &q = m.t1;
                if constexpr (Kind == test::motion_kind::vertex_face) {
                    return abut::time_of_impact<A>(
                               abut::motion<vec3<T>>{p[0], q[0]},
                               abut::motion<abut::triangle<T>>{{p[1], p[2], p[3]}, {q[1], q[2], q[3]}}) >= 0;
                } else {
                    return abut::time_of_impact<A>(abut::motion<abut::segment<T>>{{p[0], p[1]}, {q[0], q[1]}},
                                                   abut::motion<abut::segment<T>>{{p[2], p[3]}, {q[2], q[3]}}) >= 0;
                }
            });
    }
}

/// A cylinder or a cone with each other shape that it is decided with. beside(case, k) is that.
template <class Solid, class Beside>
void add_revolutions_beside(const Beside& beside) {
    using T = abut::scalar_type_of<Solid>;
    using other = decltype(beside(test::revolution_case<T>{}, std::uint64_t{}));
    // Integers take milliseconds for a pair of two of them.
    const bool both_are_round = !std::is_same_v<other, abut::sphere<T>> && requires(const other& o) { o.radius; };
    const size of = both_are_round ? size{64, 3} : size{256, 5};
    for (int f = 0; f < test::revolution_family_count; ++f) {
        const auto family = static_cast<test::revolution_family>(f);
        add<T>(
            name_of_kind<T, Solid, other>(), test::name_of(family), of,
            [=](std::uint64_t k) {
                for (;; k += of.pairs) {  // the first that is valid
                    const auto c = test::make_revolution_case<T>(seed, family, k, std::is_same_v<Solid, abut::cone<T>>);
                    const pair_of<Solid, other> p{test::solid_of<Solid>(c.axis, c.radius), beside(c, k)};
                    if (is_valid(p.s) && is_valid(p.t)) return p;
                }
            },
            whether_they_meet);
    }
}
template <class Solid>
void add_revolutions() {
    using T = abut::scalar_type_of<Solid>;
    using pair = test::revolution_case<T>;
    constexpr bool is_cone = std::is_same_v<Solid, abut::cone<T>>;
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t) { return c.corner[0]; });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t) { return abut::segment<T>{c.corner[0], c.corner[1]}; });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t) {
        return abut::triangle<T>{c.corner[0], c.corner[1], c.corner[2]};
    });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t) {
        return bounds(abut::segment<T>{c.corner[0], c.corner[1]});
    });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t k) { return test::ball_beside(c, is_cone, k); });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t k) { return test::plane_beside(c, k); });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t k) { return test::cylinder_beside(c, is_cone, k); });
    add_revolutions_beside<Solid>([](const pair& c, std::uint64_t k) {
        const auto s = test::cylinder_beside(c, is_cone, k);
        return abut::capsule<T>{s.axis, s.radius};
    });
    if constexpr (is_cone) {
        add_revolutions_beside<Solid>([](const pair& c, std::uint64_t k) {
            const auto s = test::cylinder_beside(c, is_cone, k);
            return abut::cone<T>{s.axis.a, s.axis.b, s.radius};
        });
    }
}

template <abut::scalar T>
void add_all() {
    add_beside_triangles<T>();
    add_solids<T>();
    add_round_within<T>();
    add_hulls<T>();
    add_revolutions<abut::cylinder<T>>();
    add_revolutions<abut::cone<T>>();
    add_motion<test::motion_kind::vertex_face, T>("motion_vertex_face");
    add_motion<test::motion_kind::edge_edge, T>("motion_edge_edge");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        add_all<float>();
        add_all<double>();
        return bench::run_registered("bench_families", argc, argv);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_families: %s\n", problem.what());
        return 1;
    }
}
