// SPDX-License-Identifier: MIT
#pragma once

// Queries of several devices answer as one policy does: the same pairs, contacts and neighbours, bit for bit, in the same
// order, whatever lies where.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/devices/bodies.hpp>
#include <abut/devices/impacts.hpp>
#include <abut/devices/query.hpp>
#include <abut/devices/rows.hpp>

#include "support/catch.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace device_cases {

template <scalar T>
struct scene {
    std::vector<triangle<T>> triangles;
    std::vector<sphere<T>> spheres;
};

/// Small shapes in a cube, half of them on a lattice, where many touch in one point exactly. If `skewed`, three of four lie
/// in a corner.
template <scalar T>
scene<T> random_scene(std::size_t triangles, std::size_t spheres, bool skewed, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<T> place(0, 8), length(T(0.1), T(0.8));
    std::uniform_int_distribution<int> cell(0, 16);
    scene<T> all;
    const auto draw = [&](std::size_t i) {
        vec3<T> p{place(random), place(random), place(random)};
        T r = length(random);
        if (i % 2 == 0) {
            p = {static_cast<T>(cell(random)) / 2, static_cast<T>(cell(random)) / 2, static_cast<T>(cell(random)) / 2};
            r = T(0.5);
        }
        const T scale = skewed && i % 4 != 0 ? T(0.125) : T(1);
        return std::pair(scale * p, scale * r);
    };
    for (std::size_t i = 0; i < triangles; ++i) {
        const auto [p, r] = draw(i);
        all.triangles.push_back({p, {p.x + r, p.y, p.z}, {p.x, p.y + r, p.z + (i % 3 == 0 ? T(0) : r)}});
    }
    for (std::size_t i = 0; i < spheres; ++i) {
        const auto [p, r] = draw(i);
        all.spheres.push_back({p, r / 2});
    }
    return all;
}

struct keep_some {
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const { return (a + 3 * b) % 5 != 0; }
};
struct keep_none {
    ABUT_HD bool operator()(std::uint32_t, std::uint32_t) const { return false; }
};

/// Counts the pairs and adds up their numbers; stops after `most`.
struct sum_up {
    std::uint64_t* sums;
    std::uint64_t most;
    ABUT_HD visit operator()(const index_pair& pair) const {
        execution::atomic_add(sums + 1, std::uint64_t{pair.a} * 1000003u + pair.b);
        return execution::atomic_add(sums, std::uint64_t{1}) + 1 < most ? visit::proceed : visit::stop;
    }
};
inline std::uint64_t sum_of(const std::vector<index_pair>& pairs) {
    std::uint64_t sum = 0;
    for (const index_pair& p : pairs) sum += std::uint64_t{p.a} * 1000003u + p.b;
    return sum;
}

/// Number of visits on each device, and the sum of what they add up.
template <class Team, class A, class B>
std::pair<std::vector<std::uint64_t>, std::uint64_t> visits(const Team& team, const A& a, const B& b, std::uint64_t most) {
    using local = typename Team::local_policy;
    std::vector<execution::buffer_of<local, std::uint64_t>> sums;
    for (int k = 0; k < team.size(); ++k) {
        sums.emplace_back(team[k], 2);
        fill(team[k], sums.back().data(), 2, std::uint64_t{0});
        synchronize(team[k]);
    }
    for_each_pair(team, a, b, [&](int k) { return sum_up{sums[static_cast<std::size_t>(k)].data(), most}; });
    std::vector<std::uint64_t> counts;
    std::uint64_t sum = 0;
    for (const auto& there : sums) {
        const auto here = there.to_host();
        counts.push_back(here.data()[0]);
        sum += here.data()[1];
    }
    return {counts, sum};
}

/// The pairs that arguments on all devices have, against those of whole sets.
template <class Team, class A, class B>
void check_pairs(const Team& team, const A& a, const B& b, const std::vector<index_pair>& expected) {
    CHECK(to_host(pairs(team, a, b)) == expected);
    CHECK(count(team, a, b) == expected.size());
    CHECK(any(team, a, b) == !expected.empty());
}

template <class Team, class A, class B, class WholeA, class WholeB>
void check_queries(const Team& team, const A& a, const B& b, const WholeA& whole_a, const WholeB& whole_b) {
    const auto expected = to_host(pairs(serial{}, whole_a, whole_b));
    CHECK(expected.size() > 100);
    check_pairs(team, a, b, expected);
    CHECK(to_host(pairs<exact>(team, a, b)) == expected);
    CHECK(to_host(contacts(team, a, b)) == to_host(contacts(serial{}, whole_a, whole_b)));

    auto unsorted = to_host(pairs(team, a, b, {.sorted = false}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);

    std::vector<index_pair> by_device;
    for (const auto& there : pairs_by_device(team, a, b)) {
        const auto some = to_host(there);
        CHECK(std::is_sorted(some.begin(), some.end()));
        by_device.insert(by_device.end(), some.begin(), some.end());
    }
    std::sort(by_device.begin(), by_device.end());
    CHECK(by_device == expected);

    std::vector<index_pair> some;
    std::copy_if(expected.begin(), expected.end(), std::back_inserter(some),
                 [](const index_pair& pair) { return keep_some{}(pair.a, pair.b); });
    CHECK(some.size() < expected.size());
    CHECK(to_host(pairs(team, a, b, query_options<keep_some>{.filter = {}})) == some);
    CHECK(count(team, a, b, query_options<keep_some>{.filter = {}}) == some.size());
    CHECK(!any(team, a, b, query_options<keep_none>{.filter = {}}));

    const auto [counts, sum] = visits(team, a, b, static_cast<std::uint64_t>(-1));
    std::uint64_t all = 0;
    for (const std::uint64_t n : counts) all += n;
    CHECK(all == expected.size());
    CHECK(sum == sum_of(expected));
}

/// The pairs of shapes of one set that is divided, against those of the whole.
template <class Team, class X, class Whole>
void check_self_pairs(const Team& team, const X& x, const Whole& whole) {
    const auto expected = to_host(self_pairs(serial{}, whole));
    CHECK(expected.size() > 40);
    CHECK(to_host(self_pairs(team, x)) == expected);
    CHECK(count_self_pairs(team, x) == expected.size());
    auto unsorted = to_host(self_pairs(team, x, {.sorted = false}));
    std::sort(unsorted.begin(), unsorted.end());
    CHECK(unsorted == expected);
    const self_options<keep_some> some{.filter = {}};
    CHECK(to_host(self_pairs(team, x, some)) == to_host(self_pairs(serial{}, whole, some)));
}

/// Parts that devices are given: as the shapes lie, of different sizes, one of them empty if there are three.
template <class Shape, class Team>
auto given_parts(const Team& team, const std::vector<Shape>& all) {
    using set = shapes<Shape, space_of<typename Team::local_policy>>;
    std::vector<set> parts;
    std::span<const Shape> left(all);
    for (int k = 0; k < team.size(); ++k) {
        const std::size_t n = k + 1 == team.size() ? left.size() : k == 1 ? 0 : left.size() / 3;
        parts.emplace_back(team[k], left.first(n));
        left = left.subspan(n);
    }
    return divided(std::move(parts));
}
/// Views of them.
template <class Set>
auto views_of(const divided<Set>& parts) {
    std::vector<typename Set::view_type> views;
    for (int k = 0; k < parts.devices(); ++k) views.push_back(parts[k].view());
    return divided(std::move(views));
}

template <scalar T, class Team>
void check_scenes(const Team& team) {
    for (const bool skewed : {false, true}) {
        CAPTURE(skewed, team.size());
        const auto all = random_scene<T>(700, 500, skewed, 20261124);
        const triangle_soup<T> a(all.triangles);
        const spheres<T> b(all.spheres);
        const auto there_a = replicate(team, a);
        const auto there_b = replicate(team, b);
        const auto tree_a = make_bvh(team, a);
        const auto tree_b = make_bvh(team, there_b);
        const auto part_a = divide(team, a);
        const auto part_b = divide(team, b);
        const auto forest_a = make_bvh(team, part_a);
        const auto forest_b = make_bvh(team, part_b);
        CHECK((part_a.size() == a.size() && forest_b.size() == b.size() && tree_a.size() == a.size()));

        check_queries(team, tree_a, tree_b, a, b);
        check_queries(team, forest_a, forest_b, a, b);
        const auto expected = to_host(pairs(serial{}, a, b));
        check_pairs(team, there_a, there_b, expected);
        check_pairs(team, there_a, tree_b, expected);
        check_pairs(team, forest_a, tree_b, expected);
        check_pairs(team, tree_a, forest_b, expected);
        check_pairs(team, part_a, part_b, expected);
        check_pairs(team, part_a, forest_b, expected);
        check_pairs(team, forest_a, part_b, expected);
        check_pairs(team, tree_a, b, expected);
        check_pairs(team, part_a, b, expected);
        check_pairs(team, make_bvh(team, divide(team, there_a[0])), there_b, expected);
        const auto given_a = given_parts(team, all.triangles);
        const auto given_b = given_parts(team, all.spheres);
        CHECK((given_a.size() == a.size() && given_b.devices() == team.size()));
        check_pairs(team, given_a, given_b, expected);
        check_pairs(team, make_bvh(team, given_a), make_bvh(team, given_b), expected);
        check_pairs(team, make_bvh(team, given_a), forest_b, expected);
        check_pairs(team, tree_a, make_bvh(team, given_b), expected);
        CHECK(to_host(pairs(team, all.triangles[5], views_of(given_b))) == to_host(pairs(serial{}, all.triangles[5], b)));

        draws d(7, 0, 0);
        auto pose = make_rotation<T>(d);
        pose.translation = {T(0.25), T(-0.5), T(0.125)};
        check_pairs(team, posed(tree_a, pose), tree_b, to_host(pairs(serial{}, posed(a, pose), b)));
        check_pairs(team, posed(forest_a, pose), forest_b, to_host(pairs(serial{}, posed(a, pose), b)));
        check_pairs(team, forest_a, posed(forest_b, pose), to_host(pairs(serial{}, a, posed(b, pose))));
        check_pairs(team, tree_a, all.spheres[3], to_host(pairs(serial{}, a, all.spheres[3])));

        using shared = query_options<keep_all, traversal::both_at_once, schedule::shared_list>;
        CHECK(to_host(pairs(team, tree_a, tree_b, shared{.start_depth = 99})) == expected);
        check_pairs(team, posed(part_a, pose), part_b, to_host(pairs(serial{}, posed(a, pose), b)));

        CHECK(to_host(self_pairs(team, tree_a)) == to_host(self_pairs(serial{}, a)));
        CHECK(to_host(self_pairs(team, there_b)) == to_host(self_pairs(serial{}, b)));
        CHECK(count_self_pairs(team, tree_a) == self_pairs(serial{}, a).size());
        check_self_pairs(team, forest_a, a);
        check_self_pairs(team, forest_b, b);
        check_self_pairs(team, make_bvh(team, given_a), a);
        check_self_pairs(team, make_bvh(team, given_b), b);
        CHECK(to_host(self_pairs(team, part_a)) == to_host(self_pairs(serial{}, a)));

        auto later = all.triangles;
        for (std::size_t i = 0; i < later.size(); ++i) {
            for (vec3<T>* const p : {&later[i].a, &later[i].b, &later[i].c}) p->x += T(0.5) * static_cast<T>(i % 3);
        }
        const triangle_soup<T> later_a(later);
        const auto moved = refit(team, make_bvh(team, given_a), given_parts(team, later));
        check_pairs(team, moved, forest_b, to_host(pairs(serial{}, later_a, b)));
        CHECK(to_host(self_pairs(team, moved)) == to_host(self_pairs(serial{}, later_a)));
        CHECK(message_of([&] { (void)refit(team, forest_a, divide(team, later_a)); }) ==
              "abut::refit: part 0 of the step has other shapes than that of the trees; expected parts with the same array of "
              "ids, or both without one");
        CHECK(to_host(self_pairs(team, posed(forest_a, pose))) == to_host(self_pairs(serial{}, posed(a, pose))));
    }
}

/// Faces that share vertices, of two surfaces, and of one with itself.
template <scalar T, class Team>
void check_meshes(const Team& team) {
    const auto data = ball_surface<T>(3, 1.0), other = ball_surface<T>(2, 1.0);
    const mesh<T> a(data.vertices, data.faces), b(other.vertices, other.faces);
    const auto tree_a = make_bvh(team, a);
    const auto tree_b = make_bvh(team, b);
    const auto expected = to_host(pairs(serial{}, a, b));
    CHECK(expected.size() > 100);
    check_pairs(team, tree_a, tree_b, expected);
    check_pairs(team, make_bvh(team, divide(team, a)), make_bvh(team, divide(team, b)), expected);
    auto both = data;
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    for (const auto& v : other.vertices) both.vertices.push_back({v.x + T(0.5), v.y, v.z});
    for (const auto& [i, j, k] : other.faces) both.faces.push_back({first + i, first + j, first + k});
    const mesh<T> balls(both.vertices, both.faces);
    CHECK(to_host(self_pairs(team, tree_a)) == to_host(self_pairs(serial{}, a)));
    // Divided faces know the places of their vertices and not their numbers.
    const self_options<> by_places{.coincident = coincident_vertices::merged};
    const auto folded = to_host(self_pairs(serial{}, balls, by_places));
    CHECK(folded.size() > 50);
    CHECK(to_host(self_pairs(team, make_bvh(team, divide(team, balls)), by_places)) == folded);

    // Each device gets its share of the work of surfaces that touch everywhere.
    const auto there = pairs_by_device(team, tree_a, tree_a);
    std::size_t all = 0, most = 0;
    for (const auto& some : there) {
        all += some.size();
        most = std::max(most, some.size());
    }
    CHECK(most * there.size() <= all + all / 2);
}

/// Where nearly all shapes crowd in a corner, far below the root of a tree, the work there falls to all devices.
template <scalar T, class Team>
void check_corner(const Team& team) {
    auto all = random_scene<T>(6000, 6000, false, 77);
    const T scale = T(1) / 128;
    for (std::size_t i = 0; i < all.triangles.size(); ++i) {
        if (i % 16 == 0) continue;
        auto& [a, b, c] = all.triangles[i];
        a = scale * a, b = scale * b, c = scale * c;
        all.spheres[i] = {scale * all.spheres[i].center, scale * all.spheres[i].radius};
    }
    const triangle_soup<T> a(all.triangles);
    const spheres<T> b(all.spheres);
    const auto tree_a = make_bvh(team, a);
    const auto tree_b = make_bvh(team, b);
    check_pairs(team, tree_a, tree_b, to_host(pairs(serial{}, make_bvh(serial{}, a), make_bvh(serial{}, b))));
    std::size_t sum = 0, most = 0;
    for (const auto& some : pairs_by_device(team, tree_a, tree_b)) {
        sum += some.size();
        most = std::max(most, some.size());
    }
    CHECK(sum > 10'000);
    CHECK(most * static_cast<std::size_t>(team.size()) <= sum + sum / 4);
}

/// Parts so large that others look at them closely: tiles of a square, and balls on another one that crosses it aslant.
template <scalar T, class Team>
void check_large(const Team& team) {
    // So that each part is large; three are with 900.
    const std::size_t side =
        team.size() <= 3 ? 900 : 520 * static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(team.size()))));
    constexpr T step = T(1) / 1024;
    std::vector<triangle<T>> tiles(side * side);
    std::vector<sphere<T>> balls(side * side);
    for (std::size_t k = 0; k < side * side; ++k) {
        const T x = static_cast<T>(k % side) * step, y = static_cast<T>(k / side) * step;
        tiles[k] = {{x, y, 0}, {x + step / 2, y, 0}, {x, y + step / 2, step / 4}};
        balls[k] = {{x, (x + y) / 2, y - T(0.375)}, step / 2};
    }
    const triangle_soup<T> a(tiles);
    const spheres<T> b(balls);
    const auto parts_a = make_bvh(team, divide(team, a));
    for (int k = 0; k < team.size(); ++k) {
        CHECK(abut::detail::close_boxes(team[k], abut::detail::make_operand(team[k], parts_a[k], "check_large")).size() >
              200);
    }
    const auto expected = to_host(pairs(serial{}, make_bvh(serial{}, a), make_bvh(serial{}, b)));
    CHECK(expected.size() > 500);
    check_pairs(team, parts_a, make_bvh(team, divide(team, b)), expected);
}

/// Nothing, fewer shapes than devices, and what comes from nowhere.
template <scalar T, class Team>
void check_small(const Team& team) {
    const auto all = random_scene<T>(60, 50, false, 5);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{60}}) {
        for (const std::size_t m : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{50}}) {
            CAPTURE(n, m, team.size());
            const triangle_soup<T> a(
                std::vector<triangle<T>>(all.triangles.begin(), all.triangles.begin() + static_cast<std::ptrdiff_t>(n)));
            const spheres<T> b(
                std::vector<sphere<T>>(all.spheres.begin(), all.spheres.begin() + static_cast<std::ptrdiff_t>(m)));
            const auto expected = to_host(pairs(serial{}, a, b));
            check_pairs(team, make_bvh(team, a), make_bvh(team, b), expected);
            check_pairs(team, make_bvh(team, divide(team, a)), make_bvh(team, divide(team, b)), expected);
            check_pairs(team, divide(team, a), replicate(team, b), expected);
            check_pairs(team, replicate(team, a), replicate(team, b), expected);
            CHECK(to_host(self_pairs(team, make_bvh(team, b))) == to_host(self_pairs(serial{}, b)));
        }
    }
}

/// A visitor that stops is asked little more on its device.
template <scalar T, class Team>
void check_stops(const Team& team) {
    const auto data = ball_surface<T>(5, 1.0);
    const mesh<T> a(data.vertices, data.faces);
    const auto tree = make_bvh(team, a);
    const auto [counts, sum] = visits(team, tree, tree, 1);
    for (const std::uint64_t n : counts) CHECK((n >= 1 && n < 20'000));
    const auto forest = make_bvh(team, divide(team, a));
    for (const std::uint64_t n : visits(team, forest, forest, 1).first) CHECK((n >= 1 && n < 20'000));
    CHECK(count(team, tree, tree) > 50'000);
}

template <class Call>
std::string message_of(const Call& call) {
    try {
        call();
    } catch (const error& e) {
        return e.what();
    }
    return "";
}

template <scalar T, class Team>
void check_errors(const Team& team, const Team& larger) {
    const auto all = random_scene<T>(20, 20, false, 6);
    const triangle_soup<T> a(all.triangles);
    const spheres<T> b(all.spheres);
    const auto tree = make_bvh(team, a);
    const std::string n = std::to_string(team.size()), m = std::to_string(larger.size());
    CHECK(message_of([&] { (void)count(larger, tree, b); }) ==
          "abut::count: the argument lies on " + n + " devices, the call is to " + m);
    CHECK(message_of([&] { (void)nearest(larger, tree, std::vector<vec3<T>>(3)); }) ==
          "abut::nearest: the argument lies on " + n + " devices, the call is to " + m);
    CHECK(message_of([&] { (void)make_bvh(larger, divide(team, a)); }) ==
          "abut::make_bvh: the argument lies on " + n + " devices, the call is to " + m);
    rigid<T> mirror;
    mirror.rotation[0] = -1;
    CHECK_THROWS_AS((void)pairs(team, posed(tree, mirror), b), invalid_geometry);
    CHECK(message_of([&] { (void)first_impact(larger, make_impact_index(team, mesh<T>()), mesh<T>()); }) ==
          "abut::first_impact: the argument lies on " + n + " devices, the call is to " + m);
    CHECK_THROWS_AS((void)pairs(team, tree, b, {.start_depth = 99}), error);
    CHECK(count(team, tree, b) == count(serial{}, a, b));  // nothing is left behind
}

template <scalar T>
std::vector<vec3<T>> some_points(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<T> place(-4, 12);
    std::uniform_int_distribution<int> cell(0, 16);
    std::vector<vec3<T>> points;
    for (std::size_t i = 0; i < n; ++i) {
        points.push_back({place(random), place(random), place(random)});
        if (i % 2 == 0) {  // many shapes are as near as the nearest
            points.back() = {static_cast<T>(cell(random)) / 2, static_cast<T>(cell(random)) / 2,
                             static_cast<T>(cell(random)) / 2};
        }
    }
    return points;
}

template <scalar T, class Team>
void check_nearest(const Team& team) {
    const auto all = random_scene<T>(900, 1, false, 8);
    const triangle_soup<T> a(all.triangles);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{70}, std::size_t{9'000}}) {
        CAPTURE(n, team.size());
        const auto from = some_points<T>(n, 9);
        const points<T> set(from);
        const auto expected = to_host(nearest(serial{}, make_bvh(serial{}, a), from));
        CHECK(to_host(nearest(team, make_bvh(team, a), from)) == expected);
        CHECK(to_host(nearest(team, make_bvh(team, a), replicate(team, set))) == expected);
        CHECK(to_host(nearest(team, make_bvh(team, divide(team, a)), from)) == expected);
        CHECK(to_host(nearest(team, make_bvh(team, divide(team, a)), set)) == expected);
        CHECK(to_host(nearest(team, make_bvh(team, given_parts(team, all.triangles)), set)) == expected);
        draws d(8, 0, 0);
        const auto pose = make_rotation<T>(d);
        CHECK(to_host(nearest(team, posed(make_bvh(team, divide(team, a)), pose), from)) ==
              to_host(nearest(serial{}, posed(make_bvh(serial{}, a), pose), from)));
    }
    const auto none = to_host(nearest(team, make_bvh(team, divide(team, triangle_soup<T>())), some_points<T>(5, 1)));
    CHECK(std::all_of(none.begin(), none.end(), [](const neighbor<T>& x) { return x.id == no_id; }));
}

/// A mesh in motion whose vertices each go their own way, half of them from one place of a lattice to another.
template <scalar T>
moving_set<mesh<T>> shaken(const surface_data<T>& data, vec3<T> by, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<T> offset(T(-0.5), T(0.5));
    auto t0 = data.vertices, t1 = data.vertices;
    for (std::size_t i = 0; i < t0.size(); ++i) {
        const auto shake = [&] { return vec3<T>{offset(random), offset(random), offset(random)}; };
        const auto on_lattice = [](vec3<T> p) {
            return vec3<T>{std::round(8 * p.x) / 8, std::round(8 * p.y) / 8, std::round(8 * p.z) / 8};
        };
        t1[i] = t1[i] + by + shake();
        t0[i] = t0[i] + shake();
        if (i % 2 == 0) t0[i] = on_lattice(t0[i]), t1[i] = on_lattice(t1[i]);
    }
    const mesh<T> first(t0, data.faces);
    return moving(first, first.with_vertices(serial{}, t1));
}

/// Meshes in motion: what meets, and what first.
template <scalar T, class Team>
void check_impacts(const Team& team) {
    const auto a = shaken(ball_surface<T>(3, 1.0), vec3<T>{T(0.5), 0, 0}, 1);
    const auto b = shaken(ball_surface<T>(2, 0.75), vec3<T>{T(-0.5), T(0.25), 0}, 2);
    const auto expected = to_host(impacts(serial{}, a, b));
    const auto within = to_host(self_impacts(serial{}, a));
    CAPTURE(team.size(), expected.size(), within.size());
    CHECK((expected.size() > 500 && within.size() > 500));

    const auto index_a = make_impact_index(team, a);
    const auto index_b = make_impact_index(team, replicate(team, b));
    CHECK(to_host(impacts(team, index_a, index_b)) == expected);
    CHECK(to_host(self_impacts(team, index_a)) == within);
    CHECK(first_impact(team, index_a, index_b) == first_impact(serial{}, a, b));
    CHECK(first_self_impact(team, index_a) == first_self_impact(serial{}, a));
    CHECK(safe_step(team, index_a, index_b) == safe_step(serial{}, a, b));
    const conservative_bounds kept{.tolerance = 0.01, .separation = 0.01};
    CHECK(safe_self_step(team, index_a, kept) == safe_self_step(serial{}, a, kept));
    const auto parts_a = divide_mesh(team, a), parts_b = divide_mesh(team, b);
    CHECK(to_host(impacts(team, parts_a, make_impact_index(team, parts_b))) == expected);
    CHECK(first_impact(team, parts_a, parts_b) == first_impact(serial{}, a, b));
    CHECK(to_host(self_impacts(team, parts_a)) == within);
    CHECK(first_self_impact(team, parts_a) == first_self_impact(serial{}, a));

    const auto later = shaken(ball_surface<T>(3, 1.0), vec3<T>{0, T(0.5), 0}, 3);
    const auto moved = refit(team, index_a, later);
    CHECK(to_host(impacts(team, moved, b)) == to_host(impacts(serial{}, later, b)));

    const auto late = [&](T x0, T x1) {
        const auto data = ball_surface<T>(1, 0.75);
        auto t0 = data.vertices, t1 = data.vertices;
        for (auto& p : t0) p.x += x0;
        for (auto& p : t1) p.x += x1;
        const mesh<T> first(t0, data.faces);
        return moving(first, first.with_vertices(serial{}, t1));
    };
    for (const T x0 : {T(-3), T(-12), T(-90)}) {  // later and later, the last not at all
        const auto comes = late(x0, x0 < T(-80) ? x0 + 1 : T(3));
        const auto first = first_impact(serial{}, comes, b);
        CHECK((first ? first->time > 1.0 / 16 : x0 < T(-80)));
        CHECK(first_impact(team, comes, b) == first);
    }
    CHECK(first_impact(team, a, mesh<T>()) == std::nullopt);
    if constexpr (host_policy<typename Team::local_policy>) {
        auto unsorted = to_host(impacts(team, a, b, {.sorted = false}));
        const auto before = [](const impact<T>& x, const impact<T>& y) {
            return std::tuple(x.kind, x.vertices, x.time) < std::tuple(y.kind, y.vertices, y.time);
        };
        auto in_order = expected;
        std::sort(unsorted.begin(), unsorted.end(), before);
        std::sort(in_order.begin(), in_order.end(), before);
        CHECK(unsorted == in_order);
        CHECK(to_host(impacts<exact>(team, a, b.t0())) == to_host(impacts<exact>(serial{}, a, b.t0())));
        const impact_options near{.bounds = {.tolerance = 0x1p-10, .separation = 0.0625}};
        CHECK(to_host(impacts<conservative>(team, a, b, near)) == to_host(impacts<conservative>(serial{}, a, b, near)));
        const mesh<T> one(std::vector<vec3<T>>{{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}, std::vector<face>{{0, 1, 2}});
        CHECK(to_host(impacts(team, a, one)) == to_host(impacts(serial{}, a, one)));  // a tree without nodes
        CHECK(to_host(impacts(team, one, a)) == to_host(impacts(serial{}, one, a)));
    }
}

struct keep_some_bodies {
    ABUT_HD bool operator()(const body_pair& p) const { return (p.body_a + p.body_b + p.a + p.b) % 3 != 0; }
};

/// Counts pairs of bodies.
struct count_bodies {
    std::uint64_t* count;
    ABUT_HD visit operator()(const body_pair&) const {
        execution::atomic_add(count, std::uint64_t{1});
        return visit::proceed;
    }
};

/// Bodies, of a few indices.
template <scalar T, class Team>
void check_some_bodies(const Team& team, std::uint32_t bodies) {
    const auto large = ball_surface<T>(2, 1.0), small = ball_surface<T>(1, 0.5);
    const std::vector<mesh<T>> sets{mesh<T>(large.vertices, large.faces), mesh<T>(small.vertices, small.faces),
                                    mesh<T>()};
    std::vector<replicated<decltype(make_bvh(team[0], sets[0]))>> indices;
    std::vector<bvh<mesh<T>, host_space>> whole;
    for (const auto& set : sets) {
        indices.push_back(make_bvh(team, set));
        whole.push_back(make_bvh(serial{}, set));
    }
    std::vector<std::uint32_t> index_of;
    std::vector<rigid<T>> poses, later;
    for (std::uint32_t i = 0; i < bodies; ++i) {
        draws d(11, 0, i);
        index_of.push_back(i % 7 == 3 ? 2 : i % 2);
        poses.push_back(make_rotation<T>(d));
        later.push_back(make_rotation<T>(d));
        for (auto* pose : {&poses.back(), &later.back()}) {
            pose->translation = {static_cast<T>(d.uniform(0, 5)), static_cast<T>(d.uniform(0, 5)), static_cast<T>(d.below(5))};
        }
    }
    const auto alone = make_bodies(serial{}, whole, index_of, poses);
    const auto all = make_bodies(team, indices, index_of, poses);
    const auto expected = to_host(pairs(serial{}, alone));
    CAPTURE(team.size(), expected.size());
    CHECK((all.size() == poses.size() && (bodies < 60 || expected.size() > 500)));
    CHECK((to_host(pairs(team, all)) == expected));
    CHECK(count(team, all) == expected.size());
    const auto moved = refit(team, all, later);
    CHECK((to_host(pairs(team, moved)) == to_host(pairs(serial{}, refit(serial{}, alone, later)))));
    if constexpr (host_policy<typename Team::local_policy>) {
        CHECK(any(team, all) == !expected.empty());
        std::vector<std::uint64_t> visits(static_cast<std::size_t>(team.size()));
        for_each_pair(team, all, [&](int k) { return count_bodies{&visits[static_cast<std::size_t>(k)]}; });
        CHECK(std::accumulate(visits.begin(), visits.end(), std::size_t{0}) == expected.size());
        CHECK((to_host(contacts(team, all)) == to_host(contacts(serial{}, alone))));
        const body_options<keep_some_bodies> with_filter{.filter = {}};
        CHECK((to_host(pairs(team, all, with_filter)) == to_host(pairs(serial{}, alone, with_filter))));
        auto unsorted = to_host(pairs(team, all, {.sorted = false}));
        std::sort(unsorted.begin(), unsorted.end());
        CHECK((unsorted == expected));
        const auto near = to_host(within(serial{}, alone, 0.0625));
        CHECK((bodies < 60 || near.size() > expected.size() + 200));
        CHECK((to_host(within(team, all, 0.0625)) == near));
        CHECK(count_within(team, all, 0.0625) == near.size());
        CHECK(any_within(team, all, 0.0625) == !near.empty());
        visits.assign(visits.size(), 0);
        for_each_within(team, all, 0.0625, [&](int k) { return count_bodies{&visits[static_cast<std::size_t>(k)]}; });
        CHECK(std::accumulate(visits.begin(), visits.end(), std::size_t{0}) == near.size());
        CHECK((to_host(within(team, all, 0.0625, with_filter)) == to_host(within(serial{}, alone, 0.0625, with_filter))));
        CHECK(message_of([&] { (void)count_within(team, all, -1); }).find("abut::count_within") == 0);
        for (rigid<T>& pose : later) pose.translation.x += static_cast<T>(9 * (&pose - later.data()));
        CHECK(!any(team, refit(team, all, later)));
    }
}

template <scalar T, class Team>
void check_bodies(const Team& team) {
    for (const std::uint32_t bodies : {0u, 1u, 2u, 3u, 60u}) check_some_bodies<T>(team, bodies);
}

/// Of what check_scenes looks at, what takes different ways: few kinds of queries, so that nvcc ends.
template <scalar T, class Team>
void check_each_way(const Team& team) {
    for (const bool skewed : {false, true}) {
        CAPTURE(skewed, team.size());
        const auto all = random_scene<T>(7000, 5000, skewed, 20261125);
        const triangle_soup<T> a(all.triangles);
        const spheres<T> b(all.spheres);
        const auto whole_a = make_bvh(serial{}, a);
        const auto whole_b = make_bvh(serial{}, b);
        const auto expected = to_host(pairs(serial{}, whole_a, whole_b));
        check_queries(team, make_bvh(team, a), make_bvh(team, b), whole_a, whole_b);
        check_pairs(team, make_bvh(team, divide(team, a)), make_bvh(team, divide(team, b)), expected);
        CHECK(to_host(pairs(team, replicate(team, a), replicate(team, b))) == expected);
        CHECK(to_host(pairs(team, make_bvh(team, a), b)) == expected);
        CHECK(to_host(pairs(team, make_bvh(team, given_parts(team, all.triangles)),
                            make_bvh(team, given_parts(team, all.spheres)))) == expected);
        draws d(7, 0, 0);
        auto pose = make_rotation<T>(d);
        pose.translation = {T(0.25), T(-0.5), T(0.125)};
        CHECK(to_host(pairs(team, posed(make_bvh(team, divide(team, a)), pose), make_bvh(team, b))) ==
              to_host(pairs(serial{}, posed(whole_a, pose), whole_b)));
        CHECK(to_host(self_pairs(team, make_bvh(team, a))) == to_host(self_pairs(serial{}, whole_a)));
        CHECK(to_host(self_pairs(team, make_bvh(team, divide(team, a)))) == to_host(self_pairs(serial{}, whole_a)));
    }
}

}  // namespace device_cases

/// All cases of a team.
template <scalar T, class Team>
void check_devices(const Team& team) {
    device_cases::check_scenes<T>(team);
    device_cases::check_meshes<T>(team);
    device_cases::check_corner<T>(team);
    if (team.size() < 4) device_cases::check_large<T>(team);
    device_cases::check_small<T>(team);
    device_cases::check_stops<T>(team);
    device_cases::check_nearest<T>(team);
    device_cases::check_impacts<T>(team);
    device_cases::check_bodies<T>(team);
}

}  // namespace abut::test
