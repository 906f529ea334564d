// SPDX-License-Identifier: MIT
#pragma once

// The families of pairs of each two kinds of shapes that predicates.cu does not make on a device itself. They are those of
// tests/predicate and of narrow/hull_hit_time.test.cpp. Shares of hits are those of the host's tests or lower, since some of
// these take other numbers of pairs.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <vector>

#include "cuda/copied_pairs.hpp"
#include "support/families.hpp"
#include "support/hull_families.hpp"
#include "support/ray_oracle.hpp"
#include "support/revolution_pairs.hpp"
#include "support/samples.hpp"
#include "support/shared_faces.hpp"
#include "support/solid_pairs.hpp"
#include "support/triangle_families.hpp"
#include "support/within_pairs.hpp"

namespace abut::test {

/// Families from ABUT_FIRST_FAMILY on: each(f) decides all pairs of family number f.
template <class T, class Name, class Each>
void check_each_family(int count, double least_share, const Name& name, const Each& each) {
    const int first = first_family();
    REQUIRE(first >= 0);
    REQUIRE(first < count);
    for (int f = first; f < count; ++f) {
        const copied_counts sum = each(f);
        check_counts<T>(name(f), sum);
        check_share(least_share, sum);
    }
}

/// Of kinds that take turns: how many of n samples are number `kind` of `kinds`.
inline std::size_t turns_of(std::size_t n, int kind, int kinds) {
    const auto of = static_cast<std::size_t>(kinds), number = static_cast<std::size_t>(kind);
    return n > number ? (n - number - 1) / of + 1 : 0;
}

// --- triangles --------------------------------------------------------------------------------------------------------

/// make(family, k) is pair number k of a family.
template <class T, class Name, class Policy, class Make>
void check_made_pairs(const Policy& on, int count, const Name& name, const Make& make) {
    check_each_family<T>(count, 0.05, name, [&](int f) {
        const auto pairs = make_pairs(sample_count(), [&](std::uint64_t k) { return make(f, k); });
        return decide_copied<whether_they_meet, T>(on, pairs);
    });
}

template <class T, class Policy, class Make>
void check_of_triangle_pairs(const Policy& on, const Make& make) {
    const auto name = [](int f) { return name_of(static_cast<triangle_family>(f)); };
    check_made_pairs<T>(on, triangle_family_count, name, [&](int f, std::uint64_t k) {
        return make(make_triangle_pair<T>(sample_seed, static_cast<triangle_family>(f), k), k);
    });
}

template <class T, class Policy>
void check_segments_and_triangles(const Policy& on) {
    check_of_triangle_pairs<T>(on, [](const triangle_pair<T>& p, std::uint64_t k) {
        return copied_pair<segment<T>, triangle<T>>{segment_beside_triangle(p, k), p.b, 0};
    });
}
template <class T, class Policy>
void check_points_and_triangles(const Policy& on) {
    check_of_triangle_pairs<T>(on, [](const triangle_pair<T>& p, std::uint64_t k) {
        return copied_pair<vec3<T>, triangle<T>>{point_beside_triangle(p, k), p.b, 0};
    });
}
template <class T, class Policy>
void check_rays_and_triangles(const Policy& on) {
    const auto name = [](int f) { return name_of(static_cast<triangle_family>(f)); };
    check_made_pairs<T>(on, triangle_family_count, name, [&](int f, std::uint64_t k) {
        const auto p = make_ray_pair<T>(sample_seed, static_cast<triangle_family>(f), k);
        return copied_pair<ray<T>, triangle<T>>{p.r, p.t, 0};
    });
}

/// Faces of a mesh. Of all families together some meet, for each number of shared vertices: that is asked on the host.
template <class T, class Policy>
void check_faces(const Policy& on) {
    copied_counts all;
    for (int f = 0; f < places_count; ++f) {
        const auto pairs = make_pairs((sample_count() + 3) / 4, [f](std::uint64_t k) {
            const auto p = make_face_pair<T>(static_cast<places>(f), k);
            return copied_pair<detail::mesh_face<T>, detail::mesh_face<T>>{p.f, p.g, 0};
        });
        const copied_counts sum = decide_copied<whether_they_meet, T>(on, pairs);
        check_counts<T>(name_of(static_cast<places>(f)), sum);
        all += sum;
    }
    check_share(0.05, all);
}

// --- without a triangle -----------------------------------------------------------------------------------------------

template <class T, class Policy>
void check_balls(const Policy& on) {
    const auto name = [](int f) { return name_of(static_cast<family>(f)); };
    check_made_pairs<T>(on, family_count, name, [](int f, std::uint64_t k) {
        const auto p = make_pair<T>(sample_seed, static_cast<family>(f), k);
        return copied_pair<sphere<T>, segment<T>>{p.s, segment_beside_ball(p, k), 0};
    });
    check_made_pairs<T>(on, family_count, name, [](int f, std::uint64_t k) {
        const auto p = two_balls(make_pair<T>(sample_seed, static_cast<family>(f), k), k);
        return copied_pair<sphere<T>, sphere<T>>{p.s, p.o, 0};
    });
}

/// All kinds by turns; each(kind, family) decides the pairs of a kind.
template <class T, class Each>
void check_solid_families(int kinds, double least_share_of_kind, const Each& each) {
    std::vector<copied_counts> of_kind(static_cast<std::size_t>(kinds));
    const auto name = [](int f) { return name_of(static_cast<solid_family>(f)); };
    check_each_family<T>(solid_family_count, 0.05, name, [&](int f) {
        copied_counts sum;
        for (int kind = 0; kind < kinds; ++kind) {
            const copied_counts of_both = each(kind, static_cast<solid_family>(f));
            of_kind[static_cast<std::size_t>(kind)] += of_both;
            sum += of_both;
        }
        return sum;
    });
    if (first_family() > 0) return;  // the shares of kinds are those of all families
    for (int kind = 0; kind < kinds; ++kind) {
        CAPTURE(kind);
        check_share(least_share_of_kind, of_kind[static_cast<std::size_t>(kind)]);
    }
}

template <class T, class Policy>
void check_solids(const Policy& on) {
    check_solid_families<T>(solid_pair_kinds, 0.05, [&](int kind, solid_family f) {
        copied_counts counts;
        // The first pair says of which shapes all are.
        with_solid_pair<T>(kind, sample_seed, f, 0, [&]<class S, class U>(const S&, const U&) {
            const auto pairs = make_pairs(turns_of(sample_count(), kind, solid_pair_kinds), [f](std::uint64_t k) {
                const auto p = make_solid_pair<S, U>(sample_seed, f, k);
                return copied_pair<S, U>{p.s, p.t, 0};
            });
            counts = decide_copied<whether_they_meet, T>(on, pairs);
        });
        return counts;
    });
}

// --- cylinders and cones ------------------------------------------------------------------------------------------------

/// With points, segments, triangles, boxes, balls and planes, with cylinders and capsules, and cones with each other.
template <class Solid, class Policy>
void check_revolutions(const Policy& on) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    const auto name = [](int f) { return name_of(static_cast<revolution_family>(f)); };
    const auto check = [&](double least_share, const auto& beside) {
        using other = decltype(beside(revolution_case<T>{}, std::uint64_t{}));
        check_each_family<T>(revolution_family_count, least_share, name, [&](int f) {
            std::vector<copied_pair<Solid, other>> pairs;
            for (std::uint64_t k = 0; k < (sample_count() + 5) / 6; ++k) {
                const auto c = make_revolution_case<T>(sample_seed + 3, static_cast<revolution_family>(f), k, is_cone);
                const copied_pair<Solid, other> p{solid_of<Solid>(c.axis, c.radius), beside(c, k), 0};
                if (is_valid(p.s) && is_valid(p.t)) pairs.push_back(p);
            }
            return decide_copied<whether_they_meet, T>(on, pairs);
        });
    };
    using pair = revolution_case<T>;
    check(0.002, [](const pair& c, std::uint64_t) { return c.corner[0]; });  // few points are in a solid of a short axis
    check(0.02, [](const pair& c, std::uint64_t) { return segment<T>{c.corner[0], c.corner[1]}; });
    check(0.02, [](const pair& c, std::uint64_t) { return triangle<T>{c.corner[0], c.corner[1], c.corner[2]}; });
    check(0.02, [](const pair& c, std::uint64_t) { return bounds(segment<T>{c.corner[0], c.corner[1]}); });
    check(0.02, [](const pair& c, std::uint64_t k) { return ball_beside(c, is_cone, k); });
    check(0.02, [](const pair& c, std::uint64_t k) { return plane_beside(c, k); });
    check(0.02, [](const pair& c, std::uint64_t k) { return cylinder_beside(c, is_cone, k); });
    check(0.02, [](const pair& c, std::uint64_t k) {
        const cylinder<T> s = cylinder_beside(c, is_cone, k);
        return capsule<T>{s.axis, s.radius};
    });
    if constexpr (is_cone) {
        check(0.02, [](const pair& c, std::uint64_t k) {
            const cylinder<T> s = cylinder_beside(c, is_cone, k);
            return cone<T>{s.axis.a, s.axis.b, s.radius};
        });
    }
}

// --- within a distance --------------------------------------------------------------------------------------------------

/// Cylinders and cones, with spheres and points, where a ball beside one gives of its radius to the distance, and so of
/// whole numbers is exactly as far; and with planes.
template <class Solid, class Policy>
void check_revolutions_within(const Policy& on) {
    using T = scalar_type_of<Solid>;
    constexpr bool is_cone = std::same_as<Solid, cone<T>>;
    const auto name = [](int f) { return name_of(static_cast<revolution_family>(f)); };
    const auto check = [&](const auto& beside) {
        using other = decltype(beside(sphere<T>{}, revolution_case<T>{}, std::uint64_t{}));
        check_each_family<T>(revolution_family_count, 0.02, name, [&](int f) {
            std::vector<copied_pair<Solid, other>> pairs;
            for (std::uint64_t k = 0; k < (sample_count() + 11) / 12; ++k) {
                const auto c = make_revolution_case<T>(sample_seed + 9, static_cast<revolution_family>(f), k, is_cone);
                const Solid s = solid_of<Solid>(c.axis, c.radius);
                sphere<T> ball = ball_beside(c, is_cone, k);
                if (!is_valid(s) || !is_valid(ball)) continue;
                const auto whole = static_cast<double>(ball.radius);
                ball.radius = k % 3 == 0 ? ball.radius / 3 : ball.radius / 4;
                const other t = beside(ball, c, k);
                pairs.push_back({s, t, whole - static_cast<double>(detail::radius_around_core(t))});
            }
            return decide_copied<whether_they_are_within, T>(on, pairs);
        });
    };
    using pair = revolution_case<T>;
    check([](const sphere<T>& ball, const pair&, std::uint64_t) { return ball; });
    check([](const sphere<T>& ball, const pair&, std::uint64_t) { return ball.center; });
    check([](const sphere<T>&, const pair& c, std::uint64_t k) { return plane_beside(c, k); });
}

template <class T, class Policy>
void check_solids_within(const Policy& on) {
    constexpr int kinds = within_pair_kinds;
    check_solid_families<T>(kinds, 0.1, [&](int kind, solid_family f) {
        copied_counts counts;
        with_within_pair<T>(kind, sample_seed + 5, f, 0, [&]<class S, class U>(const S&, const U&) {
            const auto pairs = make_pairs(turns_of((sample_count() + 31) / 32, kind, kinds), [f](std::uint64_t k) {
                const auto p = make_solid_pair<S, U>(sample_seed + 5, f, k);
                return copied_pair<S, U>{p.s, p.t, distance_near(oracle::least_distance(p.s, p.t), k)};
            });
            counts = decide_copied<whether_they_are_within, T>(on, pairs);
        });
        return counts;
    });
}

inline constexpr int round_pair_kinds = 6;

template <class T, class Policy>
void check_round_within(const Policy& on) {
    const auto name = [](int f) {
        return f < triangle_family_count ? name_of(static_cast<triangle_family>(f)) : "whole distances";
    };
    check_each_family<T>(within_family_count, 0.05, name, [&](int f) {
        copied_counts sum;
        for (int kind = 0; kind < round_pair_kinds; ++kind) {
            const auto number = static_cast<std::uint64_t>(kind);
            with_shapes(make_round_pair<T>(sample_seed, f, 0), number, [&]<class S, class U>(const S&, const U&) {
                const std::size_t n = turns_of((sample_count() + 7) / 8, kind, round_pair_kinds);
                const auto pairs = make_pairs(n, [f, number](std::uint64_t i) {
                    copied_pair<S, U> made{};
                    const std::uint64_t k = i * round_pair_kinds + number;
                    const auto p = make_round_pair<T>(sample_seed, f, k);
                    with_shapes(p, number, [&]<class A, class B>(const A& s, const B& t) {
                        if constexpr (std::same_as<A, S> && std::same_as<B, U>) {
                            made = {s, t, distance_near(exact_gap(s, t).least_double(), i)};
                        }
                    });
                    return made;
                });
                sum += decide_copied<whether_they_are_within, T>(on, pairs);
            });
        }
        return sum;
    });
}

// --- hulls ------------------------------------------------------------------------------------------------------------

/// A hull, the other shape or hull, and a distance, before their points are in one list.
template <class T, class U>
struct listed_pair {
    point_list<T> points;
    U other;
    double distance = 0;
};

template <class T>
points_at<T> append(std::vector<vec3<T>>& all, const point_list<T>& points) {
    const points_at<T> at{static_cast<std::uint32_t>(all.size()), static_cast<std::uint32_t>(points.size())};
    all.insert(all.end(), points.begin(), points.end());
    return at;
}

template <class Question, class T, class Policy, class U>
copied_counts decide_listed(const Policy& on, const std::vector<listed_pair<T, U>>& listed) {
    std::vector<vec3<T>> points;
    constexpr bool are_hulls = std::same_as<U, point_list<T>>;
    std::vector<copied_pair<points_at<T>, std::conditional_t<are_hulls, points_at<T>, U>>> pairs;
    for (const auto& p : listed) {
        const points_at<T> at = append(points, p.points);
        if constexpr (are_hulls) {
            pairs.push_back({at, append(points, p.other), p.distance});
        } else {
            pairs.push_back({at, p.other, p.distance});
        }
    }
    return decide_copied<Question, T>(on, pairs, points);
}

/// The points of a hull, or the other shape as it is.
template <class S, class T>
const S& listed(const S& s, const point_list<T>&) {
    return s;
}
template <class T>
const point_list<T>& listed(const hull<T>&, const point_list<T>& points) {
    return points;
}

/// All kinds of shapes beside hulls by turns; n(f) samples of a family, made(f, k) their points, and distance(h, other, k).
template <class Question, class T, class Policy, class Made, class Distance>
copied_counts decide_beside_hulls(const Policy& on, int kind, std::size_t n, const Made& made, const Distance& distance) {
    copied_counts counts;
    constexpr int kinds = kinds_beside_hulls;
    const auto number = static_cast<std::uint64_t>(kind);
    with_shape_beside_hull(kind, made(0), 0, [&]<class V>(const hull<T>&, const V&) {
        using U = std::conditional_t<std::same_as<V, hull<T>>, point_list<T>, V>;
        const auto pairs = make_pairs(turns_of(n, kind, kinds), [&](std::uint64_t i) {
            listed_pair<T, U> pair;
            const std::uint64_t k = i * kinds + number;
            const hull_pair<T> both = made(k);
            with_shape_beside_hull(kind, both, k, [&]<class W>(const hull<T>& h, const W& other) {
                if constexpr (std::same_as<V, W>) pair = {both.a, listed(other, both.b), distance(h, other, i)};
            });
            return pair;
        });
        counts = decide_listed<Question, T>(on, pairs);
    });
    return counts;
}

inline constexpr int few_points_count = static_cast<int>(std::size(families_of_few_points));

/// Hulls against each kind of shape, made of points of the families of pairs of hulls; then capsules and spheres next to
/// contact, planes, and rays, each in families of its own.
///@{
template <class T, class Policy>
void check_hulls_and_others(const Policy& on) {
    std::vector<copied_counts> of_kind(kinds_beside_hulls);
    const auto name = [](int f) { return name_of(static_cast<hull_family>(f)); };
    check_each_family<T>(hull_family_count, 0.05, name, [&](int i) {
        const auto f = static_cast<hull_family>(i);
        copied_counts sum;
        for (int kind = 0; kind < kinds_beside_hulls; ++kind) {
            const copied_counts counts = decide_beside_hulls<whether_they_meet, T>(
                on, kind, sample_count() / thinned_by(f) + 20,
                [f](std::uint64_t k) { return make_hull_pair<T>(sample_seed, f, k); },
                [](const auto&, const auto&, std::uint64_t) { return 0.0; });
            of_kind[static_cast<std::size_t>(kind)] += counts;
            sum += counts;
        }
        return sum;
    });
    if (first_family() > 0) return;
    for (int kind = 0; kind < kinds_beside_hulls; ++kind) {
        CAPTURE(kind);
        check_share(0.05, of_kind[static_cast<std::size_t>(kind)]);
    }
}

template <class T, class Policy>
void check_balls_and_hulls(const Policy& on) {
    for (const hull_family f : families_of_few_points) {
        const std::size_t n = sample_count() / 20 / (f == hull_family::exponents ? 4 : 1) + 1;
        const auto capsules = make_pairs(n, [f](std::uint64_t k) {
            const auto c = make_round_case<T>(sample_seed, f, k);
            return listed_pair<T, capsule<T>>{c.points, {{c.core.front(), c.core.back()}, c.radius}};
        });
        std::vector<listed_pair<T, sphere<T>>> spheres;
        for (const auto& c : capsules) {
            if (c.other.axis.a == c.other.axis.b) spheres.push_back({c.points, {c.other.axis.a, c.other.radius}});
        }
        const copied_counts sum = decide_listed<whether_they_meet, T>(on, capsules);
        check_counts<T>(name_of(f), sum);
        CHECK(is_share_above(0.05, sum.hits, sum.pairs));
        if (f != hull_family::denormal) CHECK(is_share_above(0.05, sum.pairs - sum.hits, sum.pairs));
        if (!spheres.empty()) check_counts<T>("  of these, spheres", decide_listed<whether_they_meet, T>(on, spheres));
    }
}

template <class T, class Policy>
void check_planes_and_hulls(const Policy& on) {
    const auto pairs = make_pairs((sample_count() + 3) / 4, [](std::uint64_t k) {
        const auto c = make_plane_case<T>(sample_seed, k);
        return listed_pair<T, plane<T>>{c.points, c.p};
    });
    const copied_counts sum = decide_listed<whether_they_meet, T>(on, pairs);
    check_counts<T>("planes", sum);
    check_share(0.1, sum);
}

template <class T, class Policy>
void check_rays_and_hulls(const Policy& on) {
    for (const hull_family f : families_of_few_points) {
        const std::size_t n = sample_count() / (f == hull_family::exponents ? 15 : 5) + 1;
        const auto pairs = make_pairs(n, [f](std::uint64_t k) {
            const auto c = make_line_case<T>(sample_seed, f, k);
            return listed_pair<T, ray<T>>{c.points, c.r};
        });
        const copied_counts sum = decide_listed<whether_they_meet, T>(on, pairs);
        check_counts<T>(name_of(f), sum);
        check_share(0.05, sum);
    }
}
///@}

template <class T, class Policy>
void check_hulls_within(const Policy& on) {
    std::vector<copied_counts> of_kind(kinds_beside_hulls);
    const auto name = [](int i) { return name_of(families_of_few_points[i]); };
    check_each_family<T>(few_points_count, 0.05, name, [&](int i) {
        const hull_family f = families_of_few_points[i];
        copied_counts sum;
        for (int kind = 0; kind < kinds_beside_hulls; ++kind) {
            const copied_counts counts = decide_beside_hulls<whether_they_are_within, T>(
                on, kind, sample_count() / (f == hull_family::exponents ? 64 : 12) + 20,
                [f](std::uint64_t k) { return make_few_points<T>(sample_seed + 7, f, k); },
                []<class U>(const hull<T>& h, const U& other, std::uint64_t k) {
                    return distance_near(hull_question<T, U>{h, other}.least_distance(), k);
                });
            of_kind[static_cast<std::size_t>(kind)] += counts;
            sum += counts;
        }
        return sum;
    });
    if (first_family() > 0) return;
    for (int kind = 0; kind < kinds_beside_hulls; ++kind) {
        CAPTURE(kind);
        check_share(0.1, of_kind[static_cast<std::size_t>(kind)]);
    }
}

}  // namespace abut::test
