// SPDX-License-Identifier: MIT
//
// The nearest of all parts is the nearest of the whole set, bit for bit, and of equal ones the least id.

#include <abut/mpi.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "distributed/world.hpp"
#include "support/poses.hpp"

namespace abut::test {

namespace {

template <scalar T>
std::vector<global_neighbor<T>> as_global(const std::vector<neighbor<T>>& all) {
    std::vector<global_neighbor<T>> out;
    for (const auto& n : all) out.push_back({n.id == no_id ? no_global_id : n.id, n.point, n.distance});
    return out;
}

/// This rank's points and shapes, against one machine with all of them.
template <class Local, class X, class Whole, class Points, class AllPoints>
void check_nearest(const distributed<Local>& on, const X& x, const Whole& whole, const Points& points,
                   const AllPoints& all) {
    const auto expected = as_global(nearest(serial{}, whole, all).to_host());
    CHECK(lists_of_all(on.ranks(), nearest(on, x, points).to_host()) == expected);
}

template <scalar T>
std::vector<vec3<T>> random_points(std::size_t n, T size, std::mt19937& random) {
    // On a lattice, so that many shapes are equally near.
    std::uniform_int_distribution<int> cell(-8, 8);
    std::vector<vec3<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        const auto coordinate = [&] { return size * static_cast<T>(cell(random)) / 8; };
        const T x = coordinate(), y = coordinate(), z = coordinate();
        all.push_back({x, y, z});
    }
    return all;
}

template <class Local, scalar T>
void check_scene(const distributed<Local>& on, T size, division of_shapes, division of_points) {
    CAPTURE(size, static_cast<int>(of_shapes), static_cast<int>(of_points), on.size());
    std::mt19937 random(7);
    const auto points = random_points<T>(300, size, random);
    const auto corners = random_points<T>(600, size, random);
    std::vector<triangle<T>> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    const auto mine = part_of(points, of_points, on.rank(), on.size());
    const triangle_soup<T> whole(triangles), part(part_of(triangles, of_shapes, on.rank(), on.size()));
    check_nearest(on, part, whole, mine, points);
    const auto tree = make_bvh(on.local(), part);
    check_nearest(on, tree, whole, mine, points);
    rigid<T> pose{};
    construction::set_rotation(pose, 0.8L, 0.1L, -0.5L, 0.2L);
    pose.translation = {size / 3, -size / 5, size};
    check_nearest(on, posed(tree, pose), posed(whole, pose), mine, points);
    const abut::points<T> cloud(corners), part_of_cloud(part_of(corners, of_shapes, on.rank(), on.size()));
    check_nearest(on, make_bvh(on.local(), part_of_cloud), cloud, abut::points<T>(mine), points);
}

}  // namespace

TEST_CASE("distributed: nearest of all parts") {
    const distributed on(world(), serial{});
    for (const division how : divisions) {
        check_scene(on, 4.0f, how, division::even);
        check_scene(on, 4.0f, division::uneven, how);
    }
}

TEST_CASE("distributed: nearest in double, at the ends of the range too") {
    const distributed on(world(), openmp{2});
    for (const double size : {1.0, 0x1p-1000, 0x1p1000}) check_scene(on, size, division::even, division::uneven);
}

namespace {

/// A long row, in which most points are far from most parts; some places have no shapes, so that points there look far.
template <scalar T>
void check_row(std::uint32_t seed) {
    const distributed on(world(), serial{});
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(0, 2000), side(0, 16);
    const auto row = [&](std::size_t n, bool gaps, int width) {
        std::vector<vec3<T>> all;
        while (all.size() < n) {
            const int x = cell(random);
            if (gaps && x / 50 % 2 == 1) continue;
            const int y = side(random), z = side(random);
            all.push_back({static_cast<T>(x) / 8, static_cast<T>(y) / 8, static_cast<T>(z) / 8});
        }
        // Neighbours as far as `width`; within that in any order.
        const auto at = [&](const vec3<T>& p) { return static_cast<int>(p.x) / width; };
        std::stable_sort(all.begin(), all.end(), [&](const auto& p, const auto& q) { return at(p) < at(q); });
        return all;
    };
    const auto corners = row(800, true, 1), from = row(3000, false, 11);
    for (const division how : {division::even, division::uneven}) {
        CAPTURE(static_cast<int>(how), on.size());
        const points<T> whole(corners), part(part_of(corners, how, on.rank(), on.size()));
        check_nearest(on, make_bvh(on.local(), part), whole, part_of(from, division::even, on.rank(), on.size()), from);
    }
}

}  // namespace

TEST_CASE("distributed: nearest of parts that are far from each other") {
    for (const std::uint32_t seed : {31u, 32u, 33u}) check_row<float>(seed);
    check_row<double>(34);
}

TEST_CASE("distributed: more points than a message takes") {
    const distributed on(world(), serial{});
    std::mt19937 random(8);
    const auto points = random_points<float>(70'000, 4.0f, random);
    const auto corners = random_points<float>(50, 4.0f, random);
    const abut::points<float> whole(corners), part(part_of(corners, division::all_on_first, on.rank(), on.size()));
    const auto mine = part_of(points, division::all_on_last, on.rank(), on.size());
    check_nearest(on, make_bvh(on.local(), part), whole, mine, points);
}

TEST_CASE("distributed: nearest where there is nothing, and where a rank fails") {
    const distributed on(world(), serial{});
    const spheres<float> none;
    const std::vector<vec3<float>> points{{1, 2, 3}};
    const auto found = nearest(on, none, points).to_host();
    const global_neighbor<float> nobody{no_global_id, {1, 2, 3}, std::numeric_limits<float>::infinity()};
    CHECK(on_all(on.ranks(), found.size() == 1 && found[0] == nobody));

    const spheres<float> ball(std::vector<sphere<float>>{{{static_cast<float>(on.rank()), 0, 0}, 0.25f}});
    const int bad = on.size() - 1;
    std::vector<vec3<float>> broken = points;
    if (on.rank() == bad) broken[0].x = std::numeric_limits<float>::infinity();
    int thrown = 0;
    try {
        (void)nearest(on, ball, broken);
    } catch (const distributed_error& e) {
        thrown = e.rank() == bad ? 2 : 3;
    } catch (const invalid_geometry&) {
        thrown = 1;
    }
    CHECK(on_all(on.ranks(), thrown == (on.rank() == bad ? 1 : 2)));
    CHECK(on_all(on.ranks(),
                 nearest(on, ball, points).to_host()[0].id == std::min<std::uint64_t>(1, static_cast<std::uint64_t>(bad))));
}

}  // namespace abut::test
